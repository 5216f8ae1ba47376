"""Load on a structure at given ways of it, and how hard Newton's method had to work: the tables of the penetration cases.

    .venv/bin/python benches/verification/loads.py OUT [OUT ...] --on wall --at 0.25 0.5 1 [--within 0.02] [--over 1]

OUT are folders of runs whose history has `uy` and `contact_y` of the structure. A value is the mean of all steps within a distance (m) of the way that the structure has gone
since the last turn of its motion, divided by `--over` (kN); one row a direction of motion.
"""

import argparse
import csv
import re
import statistics
from pathlib import Path


def legs(ways: list[float], loads: list[float]) -> list[list[tuple[float, float]]]:
    """Way (m) and load (kN) of the steps of each leg of the motion, the way counted from where the leg begins."""
    legs, start, before, ahead = [[]], 0.0, 0.0, 0.0
    for way, load in zip(ways, loads):
        step = way - before
        if step * ahead < 0:
            legs.append([])
            start = before
        if step != 0:
            ahead = step
        legs[-1].append((abs(way - start), load))
        before = way
    return legs


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", nargs="+", type=Path)
    parser.add_argument("--on", required=True, help="the name of the structure in the history")
    parser.add_argument("--at", required=True, nargs="+", type=float, help="ways (m)")
    parser.add_argument("--within", type=float, default=0.02, help="distance (m)")
    parser.add_argument("--over", type=float, default=1.0, help="what loads are divided by (kN)")
    chosen = parser.parse_args()
    print("| run | leg | " + " | ".join(f"{way:g}" for way in chosen.at) + " | iterations, median and most | steps, halved |")
    print("|---" * (len(chosen.at) + 4) + "|")
    for out in chosen.out:
        with open(out / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        ways, loads = ([float(row[f"{chosen.on}.{name}"]) for row in rows] for name in ("uy [m]", "contact_y [kN]"))
        log = (out / "solve.log").read_text()
        counts = [int(n) for n in re.findall(r" iterations (\d+) ", log)]
        for number, leg in enumerate(legs(ways, loads), 1):
            near = [[load for way, load in leg if abs(way - at) <= chosen.within * (1 + 1e-9)] for at in chosen.at]
            values = " | ".join(f"{statistics.mean(loads) / chosen.over:.2f}" if loads else "-" for loads in near)
            print(f"| {out.name} | {number} | {values} | {statistics.median(counts):g}, {max(counts)} | {len(counts)}, {log.count('halved:')} |")


if __name__ == "__main__":
    main()
