#!/usr/bin/env python3
"""What a scene does not use costs nothing: instructions of the column, counted by valgrind; writes docs/unused.md.

    .venv/bin/python benches/unused/run.py [--base REVISION]

Two comparisons. *Before and now*: the program of a revision in which the optional parts did not exist, built in a folder of its
own, and the program of today, both solving the same column by the same plain method. *Used and not*: the program of
today with an entry of the case that makes a term do something, or ask for nothing. Needs `make build`, valgrind and git.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "work_precision")]

from program import PROGRAM, execute, options  # noqa: E402
from schemes import SCHEMES, missing  # noqa: E402

PAGE = ROOT / "docs/unused.md"
# The last revision without fitted weights, surfaces, ghost penalty, restoration by quality, DDMP and pressure.
BASE = "19ae71f"
LIMIT = 0.01  # the share of instructions that may be added
COLUMN = ROOT / "cases/column"
COARSE = {"mesh.parameters.h": 1.25, "regions.soil.points_per_cell": 16}
RUNS = {"restored in every step": {"numerics.restore": "every_step"}, "never restored": {"numerics.restore": "never"}}
# Entries that name what the column does without anyway, for the revisions that know them.
PLAIN = {"numerics.quadrature": "points", "numerics.gradient": "mpm", "numerics.pressure": "none"}
INERT = {
    "a traction of nothing": {"phases[0].tractions": [{"on": "surface", "ty": 0}]},
    "a prescribed displacement of nothing": {"phases[0].prescribe": {"bottom": {"uy": 0}}},
}


def instructions(program, settings):
    """Instructions of the solve stage: all of it, reading and writing included."""
    with tempfile.TemporaryDirectory() as name:
        sets = options({**COARSE, **settings})
        common = [COLUMN, "-o", name, "--threads", 1, *sets]
        for stage in ["mesh", "seed"]:
            done = execute([program, stage, *common])
            if done.status:
                sys.exit(done.out)
        valgrind = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
        done = execute([*valgrind, program, "solve", *common])
        if done.status:
            sys.exit(done.out)
        iterations = sum(int(n) for n in re.findall(r"^step .* iterations (\d+) ", (Path(name) / "solve.log").read_text(), re.MULTILINE))
        return int(re.search(r"I\s+refs:\s+([\d,]+)", done.out)[1].replace(",", "")), iterations


def build(revision):
    """The program of a revision, built under target/; the checkout is temporary."""
    found = subprocess.run(["git", "rev-parse", "--short", revision], cwd=ROOT, capture_output=True, text=True, check=True)
    revision = found.stdout.strip()
    kept = ROOT / "target/unused" / revision / "mpm"
    if not kept.exists():
        with tempfile.TemporaryDirectory() as name:
            source = Path(name) / "source"
            subprocess.run(["git", "worktree", "add", "--detach", source, revision], cwd=ROOT, check=True, capture_output=True)
            try:
                target = ROOT / "target/unused/build"
                # The build finds Gmsh in .venv of its own checkout.
                (source / ".venv").symlink_to((ROOT / ".venv").resolve())
                command = ["cargo", "build", "--release", "--target-dir", target]
                subprocess.run(command, cwd=source, check=True)
            finally:
                subprocess.run(["git", "worktree", "remove", "--force", source], cwd=ROOT, check=False)
            kept.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(target / "release/mpm", kept)
    return revision, kept


def known(settings):
    """Those of the entries that the program of today takes."""
    check = [PROGRAM, "check", COLUMN]
    return {path: value for path, value in settings.items() if execute([*check, *options({path: value})]).status == 0}


def row(label, count, iterations, base, base_iterations, judged):
    share = count / base - 1
    same = "" if iterations == base_iterations else f", {iterations} iterations beside {base_iterations}"
    verdict = ("yes" if share < LIMIT else "**no**") if judged else ""
    return f"| {label} | {count / 1e6:.1f} | {100 * share:+.2f} %{same} | {verdict} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--base", default=BASE, help="revision to compare with")
    arguments = parser.parse_args()
    revision, old = build(arguments.base)
    plain = known(PLAIN)
    lines = [
        "# Cost of features that a case does not use",
        "",
        "Made by `make bench-unused`: instructions (millions) of `mpm solve` for `cases/column` with 8 cells over the height, 16 points a cell,",
        "one thread, counted by valgrind's cachegrind. The count includes the whole stage: reading, steps, frames, checkpoints. It repeats to about",
        "2e-4. It ignores the effect of caches, and valgrind does not support AVX-512, which the sparse solver may use otherwise.",
        "",
        f"**Compared with an early version.** Revision {revision} had no ghost penalty, no grid reset by quality, no smoothed gradients and no pressure",
        "field. The present program has them, and they are switched off here. Everything else that was added since, such as messages and",
        "checks, is included in its count. The aim is less than 1 % more than that version.",
        "",
        "| column | now | over before | less than 1 % |",
        "|---|---|---|---|",
    ]
    references = {}
    for label, settings in RUNS.items():
        before = instructions(old, settings)
        now = instructions(PROGRAM, {**plain, **settings})
        references[label] = now
        lines.append(row(label, *now, *before, True))
        print(lines[-1], flush=True)
    lines += [
        "",
        "**With and without a feature.** The present program, relative to the column restored in every step (never, for the traction). A traction or",
        "displacement of zero has the cost of its term; the schemes are listed for comparison. There is no limit.",
        "",
        "| column with | now | over without | |",
        "|---|---|---|---|",
    ]
    for label, settings in INERT.items():
        kind = "never restored" if "traction" in label else "restored in every step"
        count = instructions(PROGRAM, {**plain, **RUNS[kind], **settings})
        lines.append(row(label, *count, *references[kind], False))
        print(lines[-1], flush=True)
    for scheme in SCHEMES:
        if scheme.name in ("default", "plain", "never") or missing(scheme):
            continue
        count = instructions(PROGRAM, scheme.settings)
        lines.append(row(f"scheme *{scheme.name}*", *count, *references["restored in every step"], False))
        print(lines[-1], flush=True)
    PAGE.write_text("\n".join(lines) + "\n")
    print(f"wrote {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
