#!/usr/bin/env python3
"""Runs the bank with its pool drawn down by four depths, and prints the factors of safety beside those of Bishop's method.

    .venv/bin/python cases/drawdown/variants.py [size of the cells in m …]     # without: 2 1 0.7

Each run goes to `out/h<size>-L<depth>` here. Needs `make build`.
"""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import bishop

CASE = Path(__file__).resolve().parent
PROGRAM = os.environ.get("MPM", CASE.parents[1] / "target/release/mpm")
DRAWN_DOWN = (0.0, 0.4, 0.7, 1.0)  # L/H
SIZE = 0.7  # of the cells in case.yaml [m]


def factor(size, down):
    """The bracket of the factor of safety; its end is infinite where the search found equilibrium up to its largest factor."""
    level = bishop.HEIGHT * (1 - down)
    folder = CASE / f"out/h{size:g}-L{10 * down:g}"
    settings = {"mesh.parameters.h": size, "water.level": level, "water.phreatic_level": level}
    for key in ("water_level", "phreatic_level"):
        settings[f"phases.drawdown.{key}"] = f"{{table: [[0, {bishop.HEIGHT}], [1, {level}]]}}"
    pairs = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([PROGRAM, "run", CASE, "-o", folder, *pairs], check=True, capture_output=True)
    log = (folder / "solve.log").read_text()
    if above := re.search(r"factor of safety above (\S+) ", log):
        return float(above[1]), math.inf
    line = re.search(r"factor of safety (\S+) to (\S+) ", log)
    return float(line[1]), float(line[2])


def main():
    sizes = [float(size) for size in sys.argv[1:]] or [2.0, 1.0, SIZE]
    print("| L/H | " + " | ".join(f"h = {size:g} m" for size in sizes) + " | Bishop |\n|---" + "|---" * (len(sizes) + 1) + "|")
    for down in DRAWN_DOWN:
        exact, _ = bishop.least(bishop.HEIGHT * (1 - down))
        cells = []
        for size in sizes:
            low, high = factor(size, down)
            error = 100 * (0.5 * (low + high) / exact - 1)
            cells.append(f"above {low:.3f}" if math.isinf(high) else f"{low:.3f} … {high:.3f} ({error:+.1f} %)")
        print(f"| {down} | " + " | ".join(cells) + f" | {exact:.3f} |", flush=True)


if __name__ == "__main__":
    main()
