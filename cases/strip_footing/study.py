"""Error of the limit load over mesh, points a cell, settlement and Poisson's ratio, for both footings.

    .venv/bin/python cases/strip_footing/study.py [strip_footing|circular_footing ...]

Prints the tables of the two README files. About two minutes.
"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import PROGRAM, ROOT

STRENGTH = 100.0
EXACT = {"strip_footing": (2 + math.pi) * STRENGTH, "circular_footing": 5.689 * STRENGTH * math.pi}


def solve(case: str, h: float, points: int, settlement: float, poisson: float) -> list[tuple[float, float]]:
    """Settlement and reaction of every step."""
    settings = [
        f"mesh.parameters.h={h}",
        f"regions.soil.points_per_cell={points}",
        f"phases[0].prescribe.footing.uy.rate={-settlement}",
        f"materials.clay.poisson={poisson}",
    ]
    with tempfile.TemporaryDirectory() as out:
        for stage in ["mesh", "seed", "solve"]:
            command = [PROGRAM, stage, ROOT / "cases" / case, "-o", out]
            for setting in settings:
                command += ["--set", setting]
            subprocess.run(command, check=True, capture_output=True)
        with open(Path(out) / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
    return [(-float(row[1]), -float(row[2])) for row in rows[1:]]


def error(case: str, curve: list[tuple[float, float]], settlement: float) -> float:
    """Percent over the limit load at a settlement."""
    load = min(curve, key=lambda point: abs(point[0] - settlement))[1]
    return 100 * (load / EXACT[case] - 1)


def main() -> None:
    for case in sys.argv[1:] or list(EXACT):
        print(f"{case}: percent over the limit load at a settlement of 2 mm, 4 mm")
        for h, points, poisson in [
            (0.1, 3, 0.49),
            (0.05, 3, 0.49),
            (0.025, 3, 0.49),
            (0.05, 6, 0.49),
            (0.05, 16, 0.49),
            (0.05, 3, 0.4999),
        ]:
            curve = solve(case, h, points, 0.004, poisson)
            errors = "  ".join(f"{error(case, curve, s):+5.2f}" for s in [0.002, 0.004])
            print(f"  h {h:<6} points a cell {points:<3} Poisson {poisson:<7} {errors}", flush=True)
        curve = solve(case, 0.05, 3, 0.016, 0.49)
        print(f"  h 0.05, 3 points, pushed further: {error(case, curve, 0.008):+5.2f} at 8 mm, ", end="")
        print(f"{error(case, curve, 0.016):+5.2f} at 16 mm")


if __name__ == "__main__":
    main()
