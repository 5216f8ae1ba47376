#!/usr/bin/env python3
"""Ordinary scenes with known answers: each is right, refused, or the program says what is wrong with it.

    .venv/bin/python benches/everyday/run.py [--seed 1] [--count 740] [--write]
    .venv/bin/python benches/everyday/run.py --seed 1 --only 17        # one scene again; its folder is printed and kept

Two scenes at a time, each as a user runs it: case.yaml and .geo, `mpm run`, history.csv and the frames. The families of scenes are in
the files beside this one. Prints every scene that is not right, with the command that repeats it, and a table; ends with 1 if a
scene is wrong in silence. Scenes that are not right are kept in target/everyday. Needs `make build`; see `make everyday`.
"""

import argparse
import itertools
import os
import re
import resource
import shutil
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import families  # noqa: E402
from program import ROOT, version  # noqa: E402
from scene import ENDED, RIGHT, SAID, SILENT, VERDICTS  # noqa: E402

KEPT = ROOT / "target/everyday"
PAGE = ROOT / "docs/everyday.md"
LONG = 6  # [s] of the processor, from which a scene is printed


def spent():
    """Seconds of the processor, of this process and of those that it started."""
    return sum(use.ru_utime + use.ru_stime for use in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def one(task):
    """Number, family, verdict, seconds of the processor and remarks of a scene, whose folder is kept where it is not right."""
    seed, number, names, keep = task
    name = names[number % len(names)]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "scene"
        start = spent()
        about, verdict, remarks = families.judge(name, f"{seed} {name} {number // len(names)}", folder)
        seconds = spent() - start
        if verdict != RIGHT or keep:
            kept = KEPT / f"{seed}-{number}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
    remarks = [remark.replace(str(folder), f"target/everyday/{seed}-{number}") for remark in remarks]
    return number, name, about, verdict, seconds, remarks


def tally(rows):
    """Lines of a table: verdicts by family."""
    lines = ["| kind | scenes | " + " | ".join(VERDICTS) + " |", "|---" * (len(VERDICTS) + 2) + "|"]
    for name in [*families.KINDS, "all"]:
        of = [row for row in rows if name in (row[1], "all")]
        if of:
            count = Counter(row[3] for row in of)
            lines.append(f"| {name.replace('_', ' ')} | {len(of)} | " + " | ".join(str(count[verdict]) for verdict in VERDICTS) + " |")
    return lines


def kind(remark):
    """A remark without its numbers and places, to count it."""
    text = re.sub(r"^(error|warning): ", "", remark)
    text = re.sub(r"\S*(case\.yaml|target/)\S*:? ?", "", text)
    text = re.split(r"; |: | \(|, ", text)[0]
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", text)[:110]


def page(rows, seed, seconds):
    """docs/everyday.md."""
    lines = [
        "# Ordinary scenes with known answers",
        "",
        f"Made by `make everyday SEED={seed}` with {version()}: {len(rows)} random scenes in {seconds:.0f} s, two at a time.",
        "",
        "Each scene is a `case.yaml` with its `.geo`, as a user writes them, run by `mpm run`. Its answer is known: a closed form, a limit load, a balance,",
        "or another scene that must have the same result. The families and their answers are in `benches/everyday/`, each with its tolerance and why it is",
        "that. In every run all numbers are finite and the mass is kept.",
        "",
        "| verdict | |",
        "|---|---|",
        f"| {RIGHT} | all checks hold |",
        f"| {SAID} | the program refuses the scene, or its result is wrong and `mpm run` or `mpm check` warns |",
        f"| {ENDED} | the analysis ends early, with a message |",
        f"| {SILENT} | a check does not hold, and nothing is said; or a panic, or more than two minutes of the processor |",
        "",
        *tally(rows),
        "",
        "| kind | what must hold |",
        "|---|---|",
        *(f"| {name.replace('_', ' ')} | {what} |" for name, what in families.KINDS.items()),
        "",
    ]
    for verdict in VERDICTS[1:]:
        of = [row for row in rows if row[3] == verdict]
        if of:
            said = Counter((row[1].replace("_", " "), kind(next((r for r in row[5] if r.startswith(("warning", "error"))), row[5][0]))) for row in of)
            lines += [f"## {verdict.capitalize()}", "", "| kind | scenes | message |" if verdict != SILENT else "| kind | scenes | first check |", "|---|---|---|"]
            lines += [f"| {name} | {count} | {text.replace('|', '/')} |" for (name, text), count in said.most_common()]
            lines.append("")
    PAGE.write_text("\n".join(lines).rstrip() + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=740, help="scenes")
    parser.add_argument("--jobs", type=int, default=min(2, len(os.sched_getaffinity(0))), help="scenes at a time")
    parser.add_argument("--kinds", nargs="+", choices=list(families.KINDS), help="scenes of these kinds only")
    parser.add_argument("--only", type=int, action="append", help="a scene by its number")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    arguments = parser.parse_args()
    names = list(families.KINDS)
    wanted = (number for number in itertools.count() if names[number % len(names)] in (arguments.kinds or names))
    numbers = arguments.only or list(itertools.islice(wanted, arguments.count))
    start = time.perf_counter()
    rows = []
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(one, [(arguments.seed, number, names, bool(arguments.only)) for number in numbers]):
            rows.append(row)
            number, name, about, verdict, seconds, remarks = row
            if verdict != RIGHT or arguments.only or seconds > LONG:
                print(f"{number} {name} ({about}): {verdict.upper() if verdict == SILENT else verdict}, {seconds:.1f} s", flush=True)
                for remark in remarks[:6]:
                    print(f"    {remark[:300]}")
                print(f"    again: .venv/bin/python benches/everyday/run.py --seed {arguments.seed} --only {number}; its case: target/everyday/{arguments.seed}-{number}")
    seconds = time.perf_counter() - start
    print("\n".join(tally(rows)))
    print(f"{len(rows)} scenes in {seconds:.0f} s, {sum(row[4] for row in rows):.0f} s of the processor")
    if arguments.write:
        page(rows, arguments.seed, seconds)
        print(f"wrote {PAGE.relative_to(ROOT)}")
    return 1 if any(row[3] == SILENT for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
