#!/usr/bin/env python3
"""Work and precision: errors against the seconds of the solve stage, for every scheme; writes docs/benchmarks.md.

    .venv/bin/python benches/work_precision/run.py [PROBLEM ...] [--quick] [--first] [--alone] [--report]

Each run has one thread, pinned to one core. The numbers of a problem go to docs/benchmarks/<problem>.csv, replacing
earlier ones, and tables and pictures are made from those files. Needs `make build`; see `make bench`.
"""

import argparse
import csv
import os
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import peers  # noqa: E402
import report  # noqa: E402
from problems import cantilever, cavity, column, footing, slump, thrown  # noqa: E402
from program import ROOT, Failed, Refused, solved, version  # noqa: E402
from schemes import SCHEMES, missing  # noqa: E402

PROBLEMS = {p.PROBLEM.name: p.PROBLEM for p in (column, slump, cantilever, footing, cavity, thrown)}
CORE = max(os.sched_getaffinity(0))
HEAD = ["series", "scheme", "at", "wall [s]", "cpu [s]", "iterations", "steps", "halvings", "nonzeros a row", "peak [MB]", "note"]


def one(problem, scheme, variant, repeats):
    """The row of a run: its measures, or why there are none."""
    settings = {**variant.settings, **scheme.settings}
    for path in problem.points_paths:
        settings.setdefault(path, scheme.points)
    row = {"scheme": scheme.name, "at": variant.at}
    try:
        with solved(problem.scene, settings, repeats, CORE) as run:
            row |= {"wall [s]": round(run.wall, 4), "cpu [s]": round(run.cpu, 4)}
            row |= {"iterations": sum(run.iterations), "steps": len(run.iterations), "halvings": run.halvings}
            row |= {"nonzeros a row": run.nonzeros, "peak [MB]": round(run.peak, 1)}
            row |= {key: float(f"{error:.4e}") for key, error in problem.errors(run, settings).items()}
    except (Failed, Refused) as error:
        row["note"] = str(error).replace(f"{ROOT}/", "")
    return row


def peer(problem, variant):
    """The row of the peer, or None where it has no such scene."""
    if not variant.peer:
        return None
    row = {"scheme": "Kratos MPM", "at": variant.at}
    try:
        result, points = peers.run(problem.peer, variant.peer, CORE)
        row |= {"wall [s]": round(result["wall"], 4), "cpu [s]": round(result["cpu"], 4)}
        row |= {"iterations": result["iterations"], "steps": result["steps"], "note": result["note"]}
        row |= {key: float(f"{error:.4e}") for key, error in problem.peer_errors(points).items()}
    except Failed as error:
        row["note"] = str(error)
    return row


def bench(problem, schemes, arguments):
    """All rows of a problem, written as they come."""
    print(f"{problem.title}", flush=True)
    remark = f"Made by {version()}. {problem.prepare() if problem.prepare else ''}".strip()
    print(f"  {remark}", flush=True)
    path = report.DATA / f"{problem.name}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    others = []
    if arguments.schemes and path.exists():
        with open(path, newline="") as file:
            done = {scheme.name for scheme in schemes}
            others = [row for row in csv.DictReader(file.readlines()[1:]) if row["scheme"] not in done]
        kept = dict.fromkeys(row["scheme"] for row in others)
        if kept:
            remark = f"{remark} Of an earlier series, whose seconds are not those of the rest: {', '.join(f'*{name}*' for name in kept)}.".strip()
    with open(path.with_suffix(".part"), "w", newline="") as file:
        file.write(f"# {remark}\n")
        writer = csv.DictWriter(file, HEAD[:3] + list(problem.measures) + HEAD[3:], lineterminator="\n")
        writer.writeheader()
        for series in problem.series[: 1 if arguments.first else None]:
            variants = [series.variants[i] for i in series.quick] if arguments.quick else series.variants
            rows = [
                (lambda s=scheme, v=variant: one(problem, s, v, 1 if arguments.quick else 3))
                for scheme in schemes
                if (scheme.name in series.schemes if series.schemes else not scheme.first or series is problem.series[0])
                for variant in variants
            ]
            writer.writerows(row for row in others if row["series"] == series.name)
            if problem.peer and not arguments.alone and not arguments.schemes and not series.schemes:
                rows += [(lambda v=variant: peer(problem, v)) for variant in variants]
            for make in rows:
                row = make()
                if row:
                    row["series"] = series.name
                    writer.writerow(row)
                    file.flush()
                    found = " ".join(f"{key} {row[key]:.2e}" for key in problem.measures if key in row)
                    print(f"  {series.name}: {row['scheme']} {row['at']}: {found} {row.get('wall [s]', '')} s {row.get('note', '')}", flush=True)
    path.with_suffix(".part").replace(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", help=", ".join(PROBLEMS))
    parser.add_argument("--quick", action="store_true", help="few runs of each series, once each")
    parser.add_argument("--first", action="store_true", help="the first series of each problem only, over the size of the cells")
    parser.add_argument("--alone", action="store_true", help="without Kratos")
    parser.add_argument("--report", action="store_true", help="tables and pictures from the numbers that are there")
    parser.add_argument("--schemes", help="names, separated by semicolons; the rows of all others, Kratos among them, stay as they were")
    arguments = parser.parse_args()
    unknown = set(arguments.problems) - set(PROBLEMS)
    if unknown:
        sys.exit(f"unknown problem {', '.join(unknown)}; there are {', '.join(PROBLEMS)}")
    if not arguments.report:
        wanted = arguments.schemes.split(";") if arguments.schemes else [s.name for s in SCHEMES]
        schemes = []
        for scheme in SCHEMES:
            reason = missing(scheme)
            if reason:
                print(f"{scheme.name}: not available ({reason})")
            elif scheme.name in wanted:
                schemes.append(scheme)
        if not arguments.alone and not arguments.schemes and not peers.install():
            arguments.alone = True
        start = time.perf_counter()
        for name in arguments.problems or PROBLEMS:
            bench(PROBLEMS[name], schemes, arguments)
        print(f"done in {time.perf_counter() - start:.0f} s")
    report.write(PROBLEMS, SCHEMES, missing)


if __name__ == "__main__":
    main()
