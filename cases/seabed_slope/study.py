"""Does the slope stand or fail where limit equilibrium says? Strengths scaled to factors of safety around 1.

    .venv/bin/python cases/seabed_slope/study.py [--sizes H …] [--factors F …]

Prints the table of the README; some minutes.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from limit_equilibrium import of_case, search

ROOT = Path(__file__).resolve().parents[2]
CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "pipeline"))
from variants import last_frame, variant


def moved(slope, scale, h):
    """The largest distance [m] a point has moved after 6 s."""
    settings = {
        "mesh.parameters.h": h,
        "mesh.parameters.crest": 10,
        "phases.fail.duration": 6,
        "materials.clay.shear_strength": f"{{top: {scale * slope.top}, gradient: {scale * slope.gradient}, datum: {slope.height}}}",
    }
    with variant("seabed_slope", settings) as out:
        return np.linalg.norm(last_frame(out).point_data["displacement [m]"], axis=1).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sizes", type=float, nargs="+", default=[1, 0.5])
    parser.add_argument("--factors", type=float, nargs="+", default=[0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2])
    given = parser.parse_args()
    slope = of_case(CASE / "case.yaml")
    case, _ = search(slope)
    print(f"factor of safety of the case: {case:.4f}")
    print(f"factor of safety, largest displacement [m] after 6 s on cells of {' and '.join(f'{h:g}' for h in given.sizes)} m")
    for factor in given.factors:
        distances = [moved(slope, factor / case, h) for h in given.sizes]
        print(f"  {factor:4.2f}  " + "  ".join(f"{d:.3f}" for d in distances), flush=True)


if __name__ == "__main__":
    main()
