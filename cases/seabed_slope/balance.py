"""The books of a run of the seabed slope: run-out, rest, mass, momentum, energy.

    .venv/bin/python cases/seabed_slope/balance.py [OUT]

Prints the numbers of the README from the log, energy.csv and the frames in OUT (default: out/ beside the case).
"""

import csv
import re
import sys
from pathlib import Path

import numpy as np
import pyvista

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "paraview"))
from common import Series, stop

NAMES = ["t", "mass", "kinetic", "momentum", "imbalance"]
HEIGHT = 5.0  # of case.yaml [m]
NEAREST = 8  # points to compare one with


def steps(log):
    """The numbers of every step; momentum and imbalance have two components."""
    if not log.exists():
        stop(f"{log}: there is no such file; run `mpm run cases/seabed_slope` first")
    rows = []
    for line in log.read_text().splitlines():
        if line.startswith("step "):
            word = lambda name, count=1: [float(x) for x in re.search(rf" {name}((?: \S+){{{count}}})", line)[1].split()]
            rows.append(sum((word(n, 2 if n in NAMES[-2:] else 1) for n in NAMES), []))
    return dict(zip([*NAMES[:-2], "px", "py", "ix", "iy"], np.array(rows).T))


def energies(out):
    """The last row of energy.csv [kJ], by the names without units."""
    with open(out / "energy.csv", newline="") as file:
        names, *rows = list(csv.reader(file))
    return dict(zip((name.split(" [")[0] for name in names), map(float, rows[-1])))


def moved(before, after):
    """The largest way [m] of a point between two frames, of points that are in both: points are split and merged."""
    first = [pyvista.PolyData(frame.points - frame.point_data["displacement [m]"]) for frame in (before, after)]
    same = [first[0].find_closest_point(x) for x in first[1].points]
    both = np.linalg.norm(first[0].points[same] - first[1].points, axis=1) < 1e-5
    return np.linalg.norm(before.points[same] - after.points, axis=1)[both].max()


def main():
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else CASE / "out"
    s, points = steps(out / "solve.log"), Series(out / "points.pvd")
    last = points.frame(-1)
    front = last.points[last.points[:, 1] > 0.1, 0].max()
    way = np.linalg.norm(last.point_data["displacement [m]"], axis=1).max()
    print(f"run-out: farthest point {way:.2f} m, front at x = {front:.2f} m, "
          f"crest line sunk by {HEIGHT - last.points[abs(last.points[:, 0] + 5) < 0.25, 1].max():.2f} m")

    peak = s["kinetic"].max()
    quiet = s["t"] > s["t"][-1] - 5
    earlier = points.frame(int(np.argmin(abs(np.array(points.times) - s["t"][-1] + 5))))
    mean = np.hypot(s["px"], s["py"]) / s["mass"]
    print(f"rest: kinetic energy {peak:.2f} kJ at its peak at {s['t'][s['kinetic'].argmax()]:.2f} s, at most "
          f"{s['kinetic'][quiet].max() / peak:.1e} of that in the last 5 s, "
          f"mean velocity then at most {100 * mean[quiet].max():.2f} cm/s, no point moved more than "
          f"{1000 * moved(earlier, last):.1f} mm")
    print(f"mass: {s['mass'][0]:.6f} t, changes by {np.ptp(s['mass']) / s['mass'][0]:.1e}")
    largest = abs(s["px"]).max()
    total = max(abs(np.cumsum(s["ix"])).max(), abs(np.cumsum(s["iy"])).max())
    print(f"momentum: largest {largest:.2f} t m/s, imbalances add up to at most {total:.2f} t m/s")

    found = energies(out)
    work = found["supplied.gravity"]
    lost = sum(value for name, value in found.items() if name.startswith("numerical"))
    print(f"energy: gravity gave {work:.2f} kJ, plastic flow took {found['dissipated.plastic']:.2f} kJ, kinetic and stored energy at the end "
          f"{found['held.kinetic'] + found['held.stored']:.2f} kJ; {100 * lost / work:.2f} % went to the numerical terms")

    around = neighbours(last)
    stress = last.point_data["stress [kPa]"][:, :3].mean(axis=1)
    velocity = last.point_data["velocity [m/s]"]
    strays = stress - stress[around].mean(axis=1)
    alone = np.linalg.norm(velocity - velocity[around].mean(axis=1), axis=1)
    print(f"noise: the mean stress of a point is {np.sqrt((strays**2).mean()):.2f} kPa r.m.s. off that of the {NEAREST} nearest, "
          f"its velocity at most {alone.max():.2f} m/s")


def neighbours(frame):
    """The nearest points of each, by their numbers."""
    return np.array([[n for n in frame.find_closest_point(x, NEAREST + 1) if n != i][:NEAREST] for i, x in enumerate(frame.points)])


if __name__ == "__main__":
    main()
