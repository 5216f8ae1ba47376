#!/usr/bin/env python3
"""Runs every verification of the repository and writes docs/verification.md.

    .venv/bin/python benches/verification/run.py [--quick] [--only STUDY …]

Closed forms and limit loads over series of meshes, with errors, rates, tolerances and run times; then the tests, each with
what it prints. --quick leaves out the tests and the finest meshes, and writes nothing; --only prints some studies of cases. Needs `make build`; see
`make verification`.
"""

import argparse
import math
import re
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "work_precision"), str(HERE)]

import studies  # noqa: E402
from problems import cantilever, cavity, column, footing, slump  # noqa: E402
from program import PROGRAM, Failed, Refused, execute, solved  # noqa: E402
from schemes import SCHEMES, missing  # noqa: E402

PAGE = ROOT / "docs/verification.md"
# The tests that hold the program against closed forms, properties and limit loads: topics of tests/, and which of their tests.
TESTS = {"mpm": "", "terms": "", "material": "", "contact": "", "water": "", "cli": "resume::"}
# Problem, largest error that the last mesh may have by measure, and where that is from.
SERIES = [
    (column.PROBLEM, {"stress": 6e-5}, "second order on the way to 2.5e-5 at 128 cells"),
    (slump.PROBLEM, {"displacement": 5e-4, "stress": 1e-3}, "at h = 1/16"),
    (cantilever.PROBLEM, {"uy": 2e-3, "ux": 2e-3}, "both components of the tip"),
    (footing.PROBLEM, {"load": 0.03}, "limit loads, at h = B/32"),
    (cavity.PROBLEM, {"largest": 0.02}, "over the curve, at h = a0/8"),
]
# Resampled quadrature, and finite elements; `make bench` has the classical weights beside them.
COMPARED = [scheme for scheme in SCHEMES if scheme.name in ("default", "resampled", "never")]
LAST = {"column": 4, "slump": 2}  # variants of the series that count, where not all do

INTRODUCTION = """# Verification

`make verification` runs all problems and writes this page. *Order* is log₂ of the ratio of errors on meshes whose cell sizes differ by a factor of two.
A tolerance applies to the last mesh of its row; **no** means that it is not met. Seconds
are wall time of the solve stage on one thread; other load on the machine is not taken into account.
"""


def orders(errors):
    """log₂ of the ratios of neighbours, where both are there."""
    pairs = list(zip(errors, errors[1:]))
    return [f"{math.log2(a / b):.1f}" if a and b else "–" for a, b in pairs]


def verdict(error, tolerance):
    if error is None:
        return f"{tolerance:.1e}: **no**, it fails"
    return f"{tolerance:.1e}: {'yes' if error <= tolerance else '**no**'}"


def convergence(problem, tolerances, why, quick):
    """The tables of a problem: a row a scheme and measure."""
    remark = problem.prepare() if problem.prepare else ""
    series = problem.series[0]
    variants = series.variants[: LAST.get(problem.name)]
    if quick:
        variants = variants[:2]
    head = ", ".join(f"{variant.at:g}" for variant in variants)
    lines = [f"### {problem.title}", "", problem.text, *([remark] if remark else []), f"Tolerance: {why}.", ""]
    lines += [f"| scheme | measure | {series.axis}: {head} | order | tolerance | seconds |", "|---|---|---|---|---|---|"]
    for scheme in COMPARED:
        if missing(scheme):
            continue
        rows, seconds = [], []
        for variant in variants:
            settings = {**variant.settings, **scheme.settings}
            for path in problem.points_paths:
                settings.setdefault(path, scheme.points)
            try:
                with solved(problem.scene, settings) as run:
                    rows.append(problem.errors(run, settings))
                    seconds.append(f"{run.wall:.2f}")
            except (Failed, Refused):
                rows.append({})
                seconds.append("–")
        for key, tolerance in tolerances.items():
            errors = [row.get(key) for row in rows]
            found = ", ".join("fails" if e is None else f"{e:.1e}" for e in errors)
            about = problem.measures[key].removesuffix(" [-]")
            lines.append(
                f"| {scheme.name} | {about} | {found} | {', '.join(orders(errors))} | {verdict(errors[-1], tolerance)} | {', '.join(seconds)} |"
            )
        print(f"{problem.name}, {scheme.name}: {rows}", flush=True)
    return [*lines, ""]


def plain(test):
    """The name of a test without the modules of slow ones, which may be files or stand in a file."""
    return test.replace("slow::", "")


def explanations(topic):
    """First sentence of the documentation of each test of a topic, by the test's plain name."""
    folder = ROOT / "tests" / topic
    found = {}
    for file in sorted(folder.rglob("*.rs")):
        text = file.read_text()
        head = " ".join(line[3:].strip() for line in text.splitlines() if line.startswith("//!"))
        module = "::".join(part for part in file.relative_to(folder).with_suffix("").parts if part != "mod")
        for match in re.finditer(r"((?:^ *///.*\n)*) *#\[test\]\n(?: *#\[.*\n)* *fn (\w+)", text, re.MULTILINE):
            about = " ".join(line.strip()[3:].strip() for line in match[1].splitlines()) or head
            found[plain(f"{module}::{match[2]}")] = re.split(r"(?<=[a-z)])\. ", about)[0].rstrip(".")
    return found


def tests(name, which):
    """A table of the tests of a topic, each run alone, and what they print."""
    cargo = ["cargo", "test", "--release", "--quiet", "--test", "all", "--"]
    listed = execute([*cargo, "--list", f"{name}::{which}"])
    names = re.findall(rf"^{name}::(\S+): test$", listed.out, re.MULTILINE)
    about = explanations(name)
    lines, printed = [f"### tests/{name}", "", "| test | what | result | seconds |", "|---|---|---|---|"], []
    for test in names:
        start = time.perf_counter()
        done = execute([*cargo, "--exact", f"{name}::{test}", "--nocapture", "--test-threads=1"])
        seconds = time.perf_counter() - start
        result = "passed" if done.status == 0 else "**failed**"
        what = about.get(plain(test), "").replace("|", "/")
        lines.append(f"| `{test}` | {what} | {result} | {seconds:.1f} |")
        noise = r"^(running \d+ test|test result|test .* \.\.\. ok$|\.$|ok$|$)"
        said = [re.sub(r"^test \S+ \.\.\. ", "", line) for line in done.out.replace(f"{ROOT}/", "").splitlines()]
        said = [line.rstrip() for line in said if not re.match(noise, line.strip())]
        if said and done.status == 0:
            printed += [f"{test}", *(f"  {line}" for line in said)]
        print(f"{name}: {test}: {result}", flush=True)
    if printed:
        lines += ["", "```text", *printed, "```"]
    return [*lines, ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few meshes, no tests, nothing written")
    parser.add_argument("--only", nargs="+", metavar="STUDY", help="only these studies of cases, such as terzaghi; nothing written")
    arguments = parser.parse_args()
    start = time.perf_counter()
    if arguments.only:
        for study in (study for study in studies.SMALL + studies.LARGE if study.__name__ in arguments.only):
            print("\n".join(study(arguments.quick)), flush=True)
        return
    version = execute([str(PROGRAM), "--version"]).out.strip()
    lines = [INTRODUCTION, f"Version: {version}.", "", "## Closed forms, on a grid that is never restored", ""]
    for study in studies.SMALL:
        lines += study(arguments.quick)
    lines += ["## Water, slopes and collapse", ""]
    for study in studies.LARGE:
        lines += study(arguments.quick)
    lines += ["## Large deformation", ""]
    for problem, tolerances, why in SERIES:
        lines += convergence(problem, tolerances, why, arguments.quick)
    if not arguments.quick:
        lines += ["## Tests", "", "Each test is run alone; the seconds include its start. What the tests print is below each table.", ""]
        for name, which in TESTS.items():
            lines += tests(name, which)
    lines.append(f"All of it took {(time.perf_counter() - start) / 60:.0f} minutes.")
    if arguments.quick:
        print("\n".join(lines))
    else:
        PAGE.write_text("\n".join(lines) + "\n")
        print(f"wrote {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
