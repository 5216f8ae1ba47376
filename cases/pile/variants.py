"""Runs the pile as it is, with other adhesion and with other schemes, on one mesh with the same points.

    .venv/bin/python cases/pile/variants.py [NAME ...] [-o OUT] [--threads N] [--set PATH=VALUE ...]

OUT (cases/pile/out without) is the folder of the pile as it is; each NAME (all without) gets a folder OUT-NAME beside it.
What has not changed is not run again. A run that cannot go on is told, exported as far as it came, and the others follow.
`make pile-variants` runs all, draws them and prints their tables.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASE = ROOT / "cases" / "pile"
PROGRAM = os.environ.get("MPM", str(ROOT / "target/release/mpm"))

# What differs from case.yaml. `mpm` and `ddmp` are the methods of the literature, whose points weigh their volumes.
VARIANTS = {
    "smooth": {"contacts[0].adhesion_factor": 0},
    "rough": {"contacts[0].adhesion_factor": 1},
    "mpm": {"numerics.gradient": "mpm", "numerics.quadrature": "points"},
    "ddmp": {"numerics.gradient": "ddmp", "numerics.quadrature": "points"},
}
# The mesh and the points, and what says that they are up to date.
SHARED = ("mesh.msh", "points.vtu", ".stamp-mesh", ".stamp-seed")


def folder(out, name):
    """The output folder of a variant; that of the case as it is has no name."""
    return out.with_name(f"{out.name}-{name}") if name else out


def mpm(stage, out, settings, threads):
    command = [PROGRAM, stage, str(CASE), "-o", str(out)] + (["--threads", str(threads)] if threads else [])
    command += [f"--set={path}={value}" for path, value in settings]
    try:
        return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    except FileNotFoundError:
        sys.exit(f"{PROGRAM}: there is no such program; run `make build`, or set MPM to its path")


def run(name, out, given):
    """True where the run came to its end."""
    target = folder(out, name)
    settings = given + list(VARIANTS.get(name, {}).items())
    if name:
        target.mkdir(parents=True, exist_ok=True)
        for file in SHARED:
            shutil.copy2(out / file, target / file)
    print(f"--- {target}", flush=True)
    done = mpm("run", target, settings, arguments.threads)
    print(done.stdout, end="", flush=True)
    if done.returncode not in (0, 1):
        sys.exit(done.returncode)
    # The line with the time; where nothing was solved, that of the time before stays.
    times = [line for line in done.stdout.splitlines() if line.startswith(("solved in", "ended after"))]
    if times:
        (target / "run.txt").write_text(times[-1] + "\n")
    if done.returncode == 0:
        return True
    exported = mpm("export", target, settings, arguments.threads)
    if exported.returncode:
        sys.exit(exported.returncode)
    print(exported.stdout, end="", flush=True)
    return False


def main():
    out = arguments.out.resolve()
    settings = [entry.split("=", 1) for entry in arguments.set]
    failed = [] if run("", out, settings) else [out.name]
    for name in arguments.names or VARIANTS:
        if not run(name, out, settings):
            failed.append(folder(out, name).name)
    if failed:
        print(f"not to the end: {', '.join(failed)} (their messages are above; what they came to is exported)")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", choices=[[], *VARIANTS], default=[], help="variants beside the case as it is")
    parser.add_argument("-o", "--out", type=Path, default=CASE / "out", help="default: cases/pile/out")
    parser.add_argument("--threads", type=int)
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for all of them")
    arguments = parser.parse_args()
    main()
