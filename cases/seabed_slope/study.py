"""Does the slope stand or fail where limit equilibrium says? Strengths scaled to factors of safety around 1.

    .venv/bin/python cases/seabed_slope/study.py

Prints the table of the README. Runs the release build; some minutes.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from limit_equilibrium import of_case, search

ROOT = Path(__file__).resolve().parents[2]
CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "paraview"))
from common import Series


def moved(slope, scale, h):
    """The largest distance [m] a point has moved after 6 s."""
    settings = [
        f"mesh.parameters.h={h}",
        "mesh.parameters.crest=10",
        "phases.fail.duration=6",
        f"materials.clay.shear_strength={{top: {scale * slope.top}, gradient: {scale * slope.gradient}, datum: {slope.height}}}",
    ]
    with tempfile.TemporaryDirectory() as out:
        command = [ROOT / "target/release/mpm", "run", CASE, "-o", out]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, capture_output=True)
        last = Series(Path(out) / "points.pvd").frame(-1)
        return np.linalg.norm(last.point_data["displacement [m]"], axis=1).max()


def main():
    slope = of_case(CASE / "case.yaml")
    case, _ = search(slope)
    print(f"factor of safety of the case: {case:.4f}")
    print("factor of safety, largest displacement [m] after 6 s on cells of 1 and 0.5 m")
    for factor in (0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2):
        distances = [moved(slope, factor / case, h) for h in (1, 0.5)]
        print(f"  {factor:4.2f}  " + "  ".join(f"{d:.3f}" for d in distances), flush=True)


if __name__ == "__main__":
    main()
