"""What the bottom bears in the pool, and how far the slope slides when it is drawn down: the numbers of the README.

    .venv/bin/python cases/submerged_slope/study.py [size of the cells in m]     # without: 1.25
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant

BUOYANT = (16.2 - 9.81) * 125  # weight of the clay in the water [kN/m]
POOL, DRAWN = 1.0, 11.0  # when it is full, and when it is empty [s]


def run(h):
    """What the bottom bears in the pool over the buoyant weight, and of the drawdown the time (s) and the mean way (m) of the clay."""
    with variant("submerged_slope", {"mesh.parameters.h": h}) as out:
        table = history(out)
    full = int(np.argmin(np.abs(table["time"] - POOL)))
    way = np.hypot(table["soil.ux"], table["soil.uy"])
    return table["bottom.reaction_y"][full] / BUOYANT, table["time"], way


def main():
    h = float(sys.argv[1]) if sys.argv[1:] else 1.25
    bears, time, way = run(h)
    print(f"in the pool the bottom bears {bears:.5f} of the buoyant weight of {BUOYANT:.2f} kN/m")
    for at, what in [(POOL, "in the pool"), (DRAWN, "as the pool is empty"), (DRAWN + 1, "a second later"), (time[-1], "at the end")]:
        print(f"moved in the mean by {way[np.argmin(np.abs(time - at))]:.4f} m {what}")
    slides = time[np.argmax(way > 2 * way[np.argmin(np.abs(time - POOL))])]
    print(f"twice as far as in the pool with the level at {5.5 * (1 - (slides - POOL) / 10):.2f} m")


if __name__ == "__main__":
    main()
