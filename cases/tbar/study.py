"""Load of the bar over its strength, by depth, and how hard Newton's method had to work.

    .venv/bin/python cases/tbar/study.py OUT [OUT ...]

Reads the folders of runs and prints the table of README.md.
"""

import csv
import math
import re
import statistics
import sys
from pathlib import Path

DEPTHS = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5]
DIAMETER, STRENGTH, WEIGHT = 1.0, 2.0, 6.0


def curve(out: Path) -> list[tuple[float, float]]:
    """Depth of the invert over D and load over s_u D, less the weight of the soil in place of the bar, of every step."""
    with open(out / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    weight = WEIGHT * math.pi * DIAMETER**2 / 4
    load = [2 * float(row["bar.contact_y [kN]"]) - weight for row in rows]
    return [(-float(row["bar.uy [m]"]) / DIAMETER, f / (STRENGTH * DIAMETER)) for row, f in zip(rows, load)]


def main() -> None:
    print("| run | " + " | ".join(f"{d:g} D" for d in DEPTHS) + " | from 3 D on, mean and scatter | iterations, median and most | steps, halved |")
    print("|---" * (len(DEPTHS) + 4) + "|")
    for out in map(Path, sys.argv[1:]):
        steps, log = curve(out), (out / "solve.log").read_text()
        near = [[load for depth, load in steps if abs(depth - d) <= 0.25] for d in DEPTHS]
        loads = " | ".join(f"{statistics.mean(loads):.2f}" if loads else "-" for loads in near)
        deep = [load for depth, load in steps if depth >= 3]
        mean, scatter = (statistics.mean(deep), statistics.pstdev(deep)) if deep else (math.nan, math.nan)
        counts = [int(n) for n in re.findall(r" iterations (\d+) ", log)]
        print(f"| {out.name} | {loads} | {mean:.2f} ± {scatter:.2f} | {statistics.median(counts):g}, {max(counts)} | {len(counts)}, {log.count('halved:')} |")


if __name__ == "__main__":
    main()
