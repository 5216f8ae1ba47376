"""Error of the limit load of the deep pipe over the size of the cells, and how hard Newton's method had to work.

    .venv/bin/python cases/deep_pipe/study.py [size of the cells at the pipe in m …] [--threads N]     # without: 0.2 0.1 0.05 0.025

Prints the table of README.md; some minutes.
"""

import argparse
import csv
import math
import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("MPM", str(ROOT / "target/release/mpm"))
STRENGTH, DIAMETER = 10.0, 1.0


def exact(factor: float) -> float:
    """N of Randolph & Houlsby."""
    delta = math.asin(factor)
    return math.pi + 2 * delta + 2 * math.cos(delta) + 4 * (math.cos(delta / 2) + math.sin(delta / 2))


def solve(h: float, factor: float, threads: list[str]) -> tuple[float, str]:
    """The last load over s_u D, and iterations a step in the median and at most."""
    with tempfile.TemporaryDirectory() as out:
        for stage in ["mesh", "seed", "solve"]:
            command = [PROGRAM, stage, ROOT / "cases/deep_pipe", "-o", out, *threads]
            command += ["--set", f"mesh.parameters.h={h}", "--set", f"contacts[0].adhesion_factor={factor}"]
            subprocess.run(command, check=True, capture_output=True)
        with open(Path(out) / "history.csv", newline="") as file:
            load = -2 * float(list(csv.reader(file))[-1][2])
        log = (Path(out) / "solve.log").read_text()
    counts = [int(n) for n in re.findall(r" iterations (\d+) ", log)]
    halved = log.count("halved")
    return load / (STRENGTH * DIAMETER), f"{statistics.median(counts):g} / {max(counts)}" + f", {halved} halved" * (halved > 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("sizes", nargs="*", type=float, default=[0.2, 0.1, 0.05, 0.025])
    parser.add_argument("--threads")
    given = parser.parse_args()
    threads = ["--threads", given.threads] if given.threads else []
    factors = [0, 0.5, 1]
    print("| h [m] | " + " | | ".join(f"α = {factor:g}" for factor in factors) + " | |\n|" + "---|" * (1 + 2 * len(factors)))
    for h in given.sizes:
        cells = []
        for factor in factors:
            load, effort = solve(h, factor, threads)
            cells += [f"{load:.3f} ({load / exact(factor) - 1:+.1%})", effort]
        print(f"| {h} | " + " | ".join(cells) + " |", flush=True)
    print("| exact | " + " | | ".join(f"{exact(factor):.3f}" for factor in factors) + " | |")


if __name__ == "__main__":
    main()
