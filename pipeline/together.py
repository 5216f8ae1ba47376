"""Runs a case as it is and variants of it on one mesh with the same points: what the `variants.py` of the cases share.

    .venv/bin/python cases/CASE/variants.py [NAME ...] [-o OUT] [--threads N] [--set PATH=VALUE ...]

OUT (cases/CASE/out without) is the folder of the case as it is; each NAME (all without) gets a folder OUT-NAME beside it.
What has not changed is not run again. A run that cannot go on is told, exported as far as it came, and the others follow.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("MPM", str(ROOT / "target/release/mpm"))

# The mesh and the points, and what says that they are up to date.
SHARED = ("mesh.msh", "points.vtu", "provenance/mesh.json", "provenance/seed.json")


def folder(out, name):
    """The output folder of a variant; that of the case as it is has no name."""
    return out.with_name(f"{out.name}-{name}") if name else out


class Together:
    """A case, its variants {name: {path: value}} and what the command line says of them."""

    def __init__(self, case, variants, base, out):
        parser = argparse.ArgumentParser(description=f"runs variants of {case.name} on one mesh with the same points")
        parser.add_argument("names", nargs="*", choices=[[], *variants], default=[], help="variants beside the case as it is")
        parser.add_argument("-o", "--out", type=Path, default=case / out, help=f"default: {out} beside the case")
        parser.add_argument("--threads", type=int)
        parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for all of them")
        given = parser.parse_args()
        self.case, self.variants, self.threads = case, variants, given.threads
        self.out, self.names = given.out.resolve(), given.names or list(variants)
        self.settings = list(base.items()) + [entry.split("=", 1) for entry in given.set]

    def mpm(self, stage, out, settings, *options):
        command = [PROGRAM, stage, str(self.case), "-o", str(out), *options]
        command += ["--threads", str(self.threads)] if self.threads else []
        command += [f"--set={path}={value}" for path, value in settings]
        try:
            return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
        except FileNotFoundError:
            sys.exit(f"{PROGRAM}: there is no such program; run `make build`, or set MPM to its path")

    def one(self, name):
        """True where the run came to its end."""
        target = folder(self.out, name)
        settings = self.settings + list(self.variants.get(name, {}).items())
        own_mesh = any(path.startswith("mesh.") for path in self.variants.get(name, {}))
        if name and not own_mesh:
            (target / "provenance").mkdir(parents=True, exist_ok=True)
            for file in SHARED:
                shutil.copy2(self.out / file, target / file)
        print(f"--- {target}", flush=True)
        done = self.mpm("run", target, settings, "--fresh")
        print(done.stdout, end="", flush=True)
        if done.returncode not in (0, 1):
            sys.exit(done.returncode)
        # The line with the time; where nothing was solved, that of the time before stays.
        times = [line for line in done.stdout.splitlines() if line.startswith(("solved in", "ended after"))]
        if times:
            (target / "run.txt").write_text(times[-1] + "\n")
        if done.returncode == 0:
            return True
        if (target / "unfinished").exists():
            sys.exit(f"{target} has results of an earlier run, which this one does not replace; remove it and run again")
        exported = self.mpm("export", target, settings)
        if exported.returncode:
            sys.exit(exported.returncode)
        print(exported.stdout, end="", flush=True)
        return False


def run(case, variants, base=None, out="out"):
    """Runs the case in the folder `case` with the entries of `base` and its variants, as the command line says."""
    together = Together(case, variants, base or {}, out)
    failed = [folder(together.out, name).name for name in ["", *together.names] if not together.one(name)]
    if failed:
        print(f"not to the end: {', '.join(failed)} (their messages are above; what they came to is exported)")
