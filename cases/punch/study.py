"""Error of the limit load of rigid punches over the size of the cells, and how hard Newton's method had to work.

    .venv/bin/python cases/punch/study.py

Prints the table of README.md. Runs the release build; a few minutes.
"""

import csv
import math
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
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
    settings = [f"mesh.parameters.h={h}", f"contacts[0].adhesion_factor={factor}"]
    with tempfile.TemporaryDirectory() as out:
        for stage in ["mesh", "seed", "solve"]:
            command = [ROOT / "target/release/mpm", stage, ROOT / "cases" / case, "-o", out]
            for setting in settings:
                command += ["--set", setting]
            subprocess.run(command, check=True, capture_output=True)
        with open(Path(out) / "history.csv", newline="") as file:
            load = -float(list(csv.reader(file))[-1][2])
        log = (Path(out) / "solve.log").read_text()
    counts = sorted(int(n) for n in re.findall(r" iterations (\d+) ", log))
    steps = [float(dt) for dt in re.findall(r" dt (\S+) ", log)]
    return load, f"{counts[len(counts) // 2]}, {counts[-1]}, {min(steps):.3g}"


def main() -> None:
    print("| case | α | h | over the limit load | iterations in the median, at most, shortest step |")
    for (case, factor), exact in EXACT.items():
        for h in [0.2, 0.1, 0.05, 0.025]:
            load, effort = solve(case, h, factor)
            print(f"| {case} | {factor} | {h} | {100 * (load / exact - 1):+.1f} % | {effort} |", flush=True)


if __name__ == "__main__":
    main()
