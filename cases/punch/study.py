"""Error of the limit load of rigid punches over the size of the cells, and how hard Newton's method had to work.

    .venv/bin/python cases/punch/study.py [size of the cells at the edge in m …]     # without: 0.2 0.1 0.05 0.025

Prints the table of README.md; a few minutes.
"""

import csv
import math
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import variant

STRENGTH = 100.0
STRIP = (2 + math.pi) * STRENGTH
CIRCLE = math.pi * STRENGTH
EXACT = {
    ("punch", 0): STRIP,
    ("punch", 1): STRIP,
    ("circular_punch", 0): 5.689 * CIRCLE,
    ("circular_punch", 1): 6.05 * CIRCLE,
}


def solve(case: str, h: float, factor: float) -> tuple[float, str]:
    """The last load (kN), and iterations a step."""
    with variant(case, {"mesh.parameters.h": h, "contacts[0].adhesion_factor": factor}) as out:
        with open(out / "history.csv", newline="") as file:
            load = -float(list(csv.reader(file))[-1][2])
        log = (out / "solve.log").read_text()
    counts = sorted(int(n) for n in re.findall(r" iterations (\d+) ", log))
    steps = [float(dt) for dt in re.findall(r" dt (\S+) ", log)]
    return load, f"{counts[len(counts) // 2]}, {counts[-1]}, {min(steps):.3g}"


def main() -> None:
    print("| case | α | h | over the limit load | iterations in the median, at most, shortest step |")
    for (case, factor), exact in EXACT.items():
        for h in [float(size) for size in sys.argv[1:]] or [0.2, 0.1, 0.05, 0.025]:
            load, effort = solve(case, h, factor)
            print(f"| {case} | {factor} | {h} | {100 * (load / exact - 1):+.1f} % | {effort} |", flush=True)


if __name__ == "__main__":
    main()
