"""Way and normal force of the disc against rolling without slip.

    .venv/bin/python cases/rolling_disc/study.py OUT [OUT ...]

Reads the folders of runs and prints the table of README.md.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

SLOPE, GRAVITY, MASS = math.radians(20), 9.81, math.pi * 0.5**2
START = 0.1  # of the mean and the range, after the release [s]


def main() -> None:
    print("| run | way after 1 s | normal force over m g cos θ: mean | least … most |\n|---|---|---|---|")
    for out in map(Path, sys.argv[1:]):
        of = history(out)
        time = of["time"] - (of["time"][-1] - 1)
        rest = abs(time).argmin()
        moved = math.hypot(*(of[f"disc.{u}"][-1] - of[f"disc.{u}"][rest] for u in ("ux", "uy")))
        way = moved / (0.5 * 2 / 3 * GRAVITY * math.sin(SLOPE)) - 1
        normal = of["disc.contact_x"] * math.sin(SLOPE) + of["disc.contact_y"] * math.cos(SLOPE)
        over = normal[time > START] / (MASS * GRAVITY * math.cos(SLOPE))
        print(f"| {out.name} | {100 * way:+.2f} % | {over.mean():.3f} | {over.min():.2f} … {over.max():.2f} |")


if __name__ == "__main__":
    main()
