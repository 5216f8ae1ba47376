#!/usr/bin/env python3
"""Runs every verification of the repository; writes docs/verification.md and docs/verification-output.txt.

    .venv/bin/python benches/verification/run.py [--quick] [--only STUDY …]

The page has closed forms and limit loads over series of meshes, with references, errors, rates, tolerances and run times, and how
many tests pass; the text beside it has every test and what it prints. --quick leaves out the tests and the finest meshes, and writes
nothing; --only prints some studies of cases. Needs `make build`; see `make verification`.
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
from program import Failed, Refused, execute, solved, version  # noqa: E402
from schemes import SCHEMES, missing  # noqa: E402

PAGE = ROOT / "docs/verification.md"
OUTPUT = ROOT / "docs/verification-output.txt"
# The tests that hold the program against closed forms, properties and limit loads: topics of tests/, which of their tests, and what they hold.
TESTS = {
    "mpm": ("", "the method: equilibrium, flight, limit loads, slopes, grid resets, schemes, and cases on coarse cells"),
    "terms": ("", "single terms of the equations, each with its tangent"),
    "material": ("", "material models at points and in columns, cavitation, softening"),
    "contact": ("", "contact: sliding, lifting off, adhesion, rigid structures, Hertz, walls"),
    "water": ("", "consolidation, drained surfaces, water levels, loads of water"),
    "cli": ("slow::resume::", "runs that are killed and resumed end the same to the last bit"),
}
# Problem, largest error that the last mesh may have by measure, where that is from, and the reference where the problem does not compute it.
SERIES = [
    (column.PROBLEM, {"stress": 6e-5}, "second order on the way to 2.5e-5 at 128 cells", "equilibrium; the section stays as it is at ν = 0"),
    (slump.PROBLEM, {"displacement": 5e-4, "stress": 1e-3}, "at h = 1/16", None),
    (cantilever.PROBLEM, {"uy": 2e-3, "ux": 2e-3}, "both components of the tip", None),
    (footing.PROBLEM, {"load": 0.03}, "limit loads, at h = B/32", "Prandtl (1920)"),
    (cavity.PROBLEM, {"largest": 0.02}, "over the curve, at h = a0/8", "integral of equilibrium over the soil, derived in `benches/work_precision/problems/cavity.py`"),
]
# Resampled quadrature, and finite elements; `make bench` has the classical weights beside them.
COMPARED = [scheme for scheme in SCHEMES if scheme.name in ("default", "resampled", "never")]
RESETS = "Schemes: *default* has resampled quadrature and a grid that is reset by quality, *resampled* resets it in every step, *never* is finite elements."
LAST = {"column": 4, "slump": 2}  # variants of the series that count, where not all do

INTRODUCTION = """# Verification

`make verification` runs all problems and writes this page. *Order* is log₂ of the ratio of errors on meshes whose cell sizes differ by a factor of two.
A tolerance applies to the last mesh of its row; **no** means that it is not met. Seconds
are wall time of the solve stage on one thread; other load on the machine is not taken into account.
What these errors mean for a case of your own: [How far off is my result?](accuracy.md) The [gallery](gallery.md) has penetration and collapse beside published values.
"""
TESTED = f"""Each test is run alone. [{OUTPUT.name}]({OUTPUT.name}) has every test with what it holds and the numbers that it prints.

| tests | of | number | passed | print numbers | minutes |
|---|---|---|---|---|---|"""


def orders(errors):
    """log₂ of the ratios of neighbours, where both are there."""
    pairs = list(zip(errors, errors[1:]))
    return [f"{math.log2(a / b):.1f}" if a and b else "–" for a, b in pairs]


def verdict(error, tolerance):
    if error is None:
        return f"{tolerance:.1e}: **no**, it fails"
    return f"{tolerance:.1e}: {'yes' if error <= tolerance else '**no**'}"


def convergence(problem, tolerances, why, reference, quick):
    """The tables of a problem: a row a scheme and measure."""
    remark = f"Reference: {reference}." if reference else ""
    if problem.prepare:
        remark = problem.prepare() or remark
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


def tests(name, which, what):
    """A row about the tests of a topic, each run alone, and the text about them: each test, its result, what it holds and what it prints."""
    cargo = ["cargo", "test", "--release", "--quiet", "--test", "all", "--"]
    listed = execute([*cargo, "--list", f"{name}::{which}"])
    names = re.findall(rf"^{name}::(\S+): test$", listed.out, re.MULTILINE)
    about = explanations(name)
    text, failed, printing, start = [], [], 0, time.perf_counter()
    for test in names:
        done = execute([*cargo, "--exact", f"{name}::{test}", "--nocapture", "--test-threads=1"])
        result = "passed" if done.status == 0 else "failed"
        noise = r"^(running \d+ test|test result|test .* \.\.\. ok$|\.$|ok$|$)"
        said = [re.sub(r"^test \S+ \.\.\. ", "", line) for line in done.out.replace(f"{ROOT}/", "").splitlines()]
        said = [line.rstrip() for line in said if not re.match(noise, line.strip())]
        text += [f"{name}::{test}: {result}", f"  {about.get(plain(test), '')}".rstrip(), *(f"    {line}" for line in said)]
        failed += [f"`{test}`"] if done.status else []
        printing += bool(said)
        print(f"{name}: {test}: {result}", flush=True)
    passed = f"{len(names) - len(failed)}" + (f", **not** {', '.join(failed)}" if failed else "")
    minutes = (time.perf_counter() - start) / 60
    return f"| `tests/{name}` | {what} | {len(names)} | {passed} | {printing} | {minutes:.1f} |", text


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
    made_by = version()
    lines = [INTRODUCTION, f"Version: {made_by}.", "", "## Closed forms, on a grid that is never restored", ""]
    for study in studies.SMALL:
        lines += study(arguments.quick)
    lines += ["## Water, slopes and collapse", ""]
    for study in studies.LARGE:
        lines += study(arguments.quick)
    lines += ["## Large deformation", "", RESETS, ""]
    for problem, tolerances, why, reference in SERIES:
        lines += convergence(problem, tolerances, why, reference, arguments.quick)
    if arguments.quick:
        print("\n".join(lines))
        return
    lines += ["## Tests", "", TESTED]
    output = [f"Output of the tests. Version: {made_by}. Written by `make verification`.", ""]
    for name, (which, what) in TESTS.items():
        row, text = tests(name, which, what)
        lines.append(row)
        output += text
    lines += ["", f"All of it took {(time.perf_counter() - start) / 60:.0f} minutes."]
    for file, text in [(PAGE, lines), (OUTPUT, output)]:
        file.write_text("\n".join(text) + "\n")
        print(f"wrote {file.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
