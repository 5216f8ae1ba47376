"""Load of the deep footing over its strength, by depth, and how hard Newton's method had to work.

    .venv/bin/python cases/footing_deep/study.py OUT [OUT ...]

Reads the folders of runs and prints the tables of README.md. The load at a depth is the mean of the steps within 0.05 B of it.
"""

import csv
import re
import statistics
import sys
from pathlib import Path

DEPTHS = [0.1, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 1.95]
WIDTH, STRENGTH = 1.0, 1.0


def curve(out: Path) -> list[tuple[float, float]]:
    """Depth over B and load over s_u B of every step."""
    with open(out / "history.csv", newline="") as file:
        rows = list(csv.reader(file))[1:]
    return [(-float(row[1]) / WIDTH, -2 * float(row[2]) / (STRENGTH * WIDTH)) for row in rows]


def main() -> None:
    print("| run | " + " | ".join(f"{d:g} B" for d in DEPTHS) + " | iterations, median and most | steps, halved, shortest |")
    print("|---" * (len(DEPTHS) + 3) + "|")
    for out in map(Path, sys.argv[1:]):
        steps, log = curve(out), (out / "solve.log").read_text()
        near = [[load for depth, load in steps if abs(depth - d) <= 0.05] for d in DEPTHS]
        loads = " | ".join(f"{statistics.mean(loads):.2f}" if loads else "-" for loads in near)
        counts = [int(n) for n in re.findall(r" iterations (\d+) ", log)]
        sizes = [float(dt) for dt in re.findall(r" dt (\S+) ", log)]
        effort = f"{statistics.median(counts):g}, {max(counts)} | {len(counts)}, {log.count('halved')}, {min(sizes):.3g} m"
        print(f"| {out.name} | {loads} | {effort} |")
    for name, law in [("5 (1 + 0.2 D/B)", lambda d: 5 * (1 + 0.2 * d)), ("5.14 (1 + 0.27 √(D/B))", lambda d: 5.14 * (1 + 0.27 * d**0.5))]:
        print(f"| {name} | " + " | ".join(f"{law(d):.2f}" for d in DEPTHS) + " | | |")


if __name__ == "__main__":
    main()
