#!/usr/bin/env python3
"""The stability campaign: random scenes, each of which must end converged or with a clear error message.

    .venv/bin/python benches/stress/run.py [--seed 1] [--count 1000] [--write]
    .venv/bin/python benches/stress/run.py --only 17             # one scene again; its case goes to benches/stress/replay

Two scenes at a time, each on one thread. With --write the table of outcomes goes to docs/stress.md. A scene that breaks a
rule is kept as a case in benches/stress/failed/<seed>-<number>; `mpm run` replays it. Needs `make build`; see `make stress`.
"""

import argparse
import itertools
import json
import os
import re
import shutil
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "work_precision")]

import check  # noqa: E402
import scenes  # noqa: E402
from program import PROGRAM, ROOT, execute, version  # noqa: E402
from schemes import SCHEMES, missing  # noqa: E402

FAILED = HERE / "failed"
PAGE = ROOT / "docs/stress.md"
TIMEOUT = 120  # [s] for the solve stage
OUTCOMES = ["converged", "ended with a message", "rejected with a message", "fault"]


def judge(number, case, folder):
    """Outcome, seconds, and what there is to say, of a case in `folder`."""
    (folder / "case.yaml").write_text(json.dumps(case, indent=1))
    shutil.copy(HERE / case["mesh"]["geo"], folder)
    out = folder / "out"
    spent = 0.0
    for stage in ["mesh", "seed", "solve", "export"]:
        threads = [] if stage == "export" else ["--threads", 1]
        done = execute([PROGRAM, stage, folder, "-o", out, *threads], timeout=TIMEOUT)
        spent += done.wall
        if stage == "solve":
            solve = done
        if done.status < 0 and spent >= TIMEOUT:
            return "fault", spent, f"{stage} had not ended after {TIMEOUT} s"
        if "panicked" in done.out or done.status not in (0, 1, 2):
            return "fault", spent, f"{stage} ended with status {done.status}: {done.reason}"
        if done.status and not re.search("error: .{20}", done.out):
            return "fault", spent, f"{stage} ended with status {done.status} and says nothing"
        if done.status == 2:
            return "rejected with a message", spent, done.reason
        if done.status == 1 and stage != "solve":
            return "fault", spent, f"{stage}: {done.reason}"
    duration = sum(phase["duration"] for phase in case["phases"])
    import pyvista

    start = pyvista.read(out / "points.vtu")  # the integration points of bodies come after the material points
    log = (out / "solve.log").read_text()
    count = re.search(r"^(\d+) material points", log, re.MULTILINE)
    faults = check.log(log, solve.status == 0, duration, start["mass [t]"].sum())
    faults += check.history((out / "history.csv").read_text())
    faults += check.frames(out, start, int(count[1]) if count else start.n_points)
    if faults:
        return "fault", spent, "; ".join(faults[:3])
    if solve.status:
        return "ended with a message", spent, solve.reason
    return "converged", spent, ""


def one(task):
    """Number, class, scheme, outcome, seconds and remark of a scene."""
    seed, number, schemes = task
    name, scheme, case = scenes.scene(seed, number, schemes)
    with tempfile.TemporaryDirectory() as folder:
        outcome, spent, remark = judge(number, case, Path(folder))
    if outcome == "fault":
        kept = FAILED / f"{seed}-{number}"
        kept.mkdir(parents=True, exist_ok=True)
        case["mesh"]["geo"] = f"../../{case['mesh']['geo']}"
        (kept / "case.yaml").write_text(json.dumps(case, indent=1) + "\n")
    return number, name, scheme, outcome, spent, remark.replace(tempfile.gettempdir(), "")


def kind(remark):
    """A remark without its numbers and places, to count it."""
    text = re.sub(r"^error: ", "", remark)
    text = re.sub(r"\S*case\.yaml\S* ", "", text)
    text = text.split(";")[0].split(" (")[0]
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", text)[:110]


def tally(rows, column, order):
    """Lines of a table: outcomes over the values of a column."""
    lines = ["| | scenes | " + " | ".join(OUTCOMES) + " | longest [s] |", "|---" * (len(OUTCOMES) + 3) + "|"]
    for value in [*order, "all"]:
        of = [row for row in rows if value == "all" or row[column] == value]
        count = Counter(row[3] for row in of)
        if of:
            counts = " | ".join(str(count[outcome]) for outcome in OUTCOMES)
            lines.append(f"| {value} | {len(of)} | {counts} | {max(row[4] for row in of):.1f} |")
    return lines


def page(rows, seed, seconds, unavailable):
    """docs/stress.md."""
    lines = [
        "# Stability campaign",
        "",
        f"Made by `make stress` with {version()}: {len(rows)} random scenes from the seed {seed}, in {seconds:.0f} s, two at a time.",
        "`benches/stress/scenes.py` generates them: meshes of triangles and quadrangles of both orders, regular and not, all numbers of points, ",
        "plane strain and axisymmetry, every scheme, ν up to 0.4999, steps up to 100 times the Courant step, compression to 30 % of the ",
        "height, several turns, friction from 0 to 45°, points on edges and corners, loads on the moving surface, water around the soil and in ",
        "its pores, at rest and flowing, contact with a wall, phases that change materials or strength or take the wall away, softening and ",
        "critical-state soil; rigid bodies, round, flat, pointed and thin, that are pushed up to 1.5 widths into clay, softening and layered clay ",
        "too, and pulled out of it, with friction, adhesion or bond; and columns of dry sand that fall and come to rest.",
        "",
        "Each must end *converged* or with a *message*: what stopped the analysis, where, when, and a remedy, with all results",
        "until then kept. A *fault* is a panic, a signal, a run of more than two minutes, a number that is not finite, mass or points lost,",
        "det F ≤ 0, time that stands still, a step accepted with a residual above the tolerance (or where the log says so, the acceptable one), or an end without a message. The campaign",
        "checks exit status, messages, log, history and every exported frame, but not whether the numbers are accurate. Not all of these",
        "scenes have an equilibrium, and a classical material point method cannot converge in all; the program must then report that.",
        "",
    ]
    lines += ["## By class", "", *tally(rows, 1, scenes.CLASSES), ""]
    lines += ["| class | |", "|---|---|"]
    lines += [f"| {name} | {function.__doc__.strip()} |" for name, function in scenes.CLASSES.items()]
    lines += ["", "## By scheme", "", *tally(rows, 2, [scheme.name for scheme in SCHEMES]), ""]
    if unavailable:
        lines += [f"Not available yet: {', '.join(unavailable)}.", ""]
    for outcome in OUTCOMES[1:]:
        counts = Counter(kind(row[5]) for row in rows if row[3] == outcome)
        if counts:
            lines += [f"## {outcome.capitalize()}", "", "| scenes | message |", "|---|---|"]
            lines += [f"| {count} | {text.replace('|', '/')} |" for text, count in counts.most_common()]
            lines.append("")
    PAGE.write_text("\n".join(lines).rstrip().replace(" \n", "\n") + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=1000, help="scenes")
    parser.add_argument("--jobs", type=int, default=min(2, len(os.sched_getaffinity(0))), help="scenes at a time")
    parser.add_argument("--classes", nargs="+", choices=list(scenes.CLASSES), help="scenes of these classes only; those that do not converge are printed")
    parser.add_argument("--scheme", choices=[scheme.name for scheme in SCHEMES], help="all scenes by this scheme")
    parser.add_argument("--only", type=int, action="append", help="a scene by its number; its case is kept in benches/stress/replay")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    arguments = parser.parse_args()
    reasons = {scheme.name: missing(scheme) for scheme in SCHEMES}
    schemes = [scheme for scheme in SCHEMES if not reasons[scheme.name] and arguments.scheme in (None, scheme.name)]
    start = time.perf_counter()
    rows = []
    classes = list(scenes.CLASSES)
    wanted = (number for number in itertools.count() if classes[number % len(classes)] in (arguments.classes or classes))
    numbers = arguments.only or list(itertools.islice(wanted, arguments.count))
    if arguments.only:
        for number in numbers:
            _, _, case = scenes.scene(arguments.seed, number, schemes)
            case["mesh"]["geo"] = f"../../{case['mesh']['geo']}"
            kept = HERE / "replay" / f"{arguments.seed}-{number}"
            kept.mkdir(parents=True, exist_ok=True)
            (kept / "case.yaml").write_text(json.dumps(case, indent=1) + "\n")
            print(f"kept as {kept.relative_to(ROOT)}")
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for row in pool.map(one, [(arguments.seed, number, schemes) for number in numbers]):
            rows.append(row)
            if row[3] == "fault" or row[4] > 10 or arguments.only or (arguments.classes and row[3] != "converged"):
                print(f"{row[0]} {row[1]}, {row[2]}: {row[3]} after {row[4]:.1f} s: {row[5]}", flush=True)
    seconds = time.perf_counter() - start
    print("\n".join(tally(rows, 1, scenes.CLASSES)))
    print(f"{len(rows)} scenes in {seconds:.0f} s")
    if arguments.write:
        page(rows, arguments.seed, seconds, [name for name, reason in reasons.items() if reason])
        print(f"wrote {PAGE.relative_to(ROOT)}")
    return 1 if any(row[3] == "fault" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
