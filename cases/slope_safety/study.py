"""The factor of safety of the slope over the mesh: the table of the README.

    .venv/bin/python cases/slope_safety/study.py [size of the cells in m …]     # without: 2 1 0.7

The run-out that the case ends with is cut short.
"""

import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import variant

FINITE_ELEMENTS, BISHOP = 1.4, 1.380  # as Griffiths & Lane (1999) have them


def factor(h):
    """The bracket of the factor of safety on cells of h (m)."""
    with variant("slope_safety", {"mesh.parameters.h": h, "phases.failure.duration": 0.02}) as out:
        found = re.search(r"factor of safety (\S+) to (\S+) ", (out / "solve.log").read_text())
    return float(found[1]), float(found[2])


def main():
    sizes = [float(size) for size in sys.argv[1:]] or [2.0, 1.0, 0.7]
    print("| h (m) | factor of safety | over 1.4 | over 1.380 |\n|---|---|---|---|")
    for h in sizes:
        low, high = factor(h)
        over = [f"{100 * (0.5 * (low + high) / exact - 1):+.1f} %" for exact in (FINITE_ELEMENTS, BISHOP)]
        print(f"| {h:g} | {low:.3f} … {high:.3f} | {over[0]} | {over[1]} |", flush=True)


if __name__ == "__main__":
    main()
