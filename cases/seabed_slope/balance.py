"""The books of a run of the seabed slope: run-out, rest, mass, momentum, energy.

    .venv/bin/python cases/seabed_slope/balance.py [OUT]

Prints the numbers of the README from the log and the frames in OUT (default: out/ beside the case).
"""

import re
import sys
from pathlib import Path

import numpy as np

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "paraview"))
from common import Series, stop

NAMES = ["t", "dt", "mass", "elastic", "potential", "kinetic", "momentum", "imbalance"]
DENSITY, TOP, GRADIENT, HEIGHT = 1.65, 1.5, 0.3, 5.0  # of case.yaml
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


def main():
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else CASE / "out"
    s, points = steps(out / "solve.log"), Series(out / "points.pvd")
    first, last = points.frame(0), points.frame(-1)
    distance = lambda a, b: np.linalg.norm(a.points - b.points, axis=1).max()
    front = last.points[last.points[:, 1] > 0.1, 0].max()
    print(f"run-out: farthest point {distance(first, last):.2f} m, front at x = {front:.2f} m, "
          f"crest line sunk by {HEIGHT - last.points[abs(last.points[:, 0] + 5) < 0.25, 1].max():.2f} m")

    peak = s["kinetic"].max()
    quiet = s["t"] > s["t"][-1] - 5
    earlier = points.frame(int(np.argmin(abs(np.array(points.times) - s["t"][-1] + 5))))
    mean = np.hypot(s["px"], s["py"]) / s["mass"]
    print(f"rest: kinetic energy {peak:.2f} kJ at its peak at {s['t'][s['kinetic'].argmax()]:.2f} s, at most "
          f"{s['kinetic'][quiet].max() / peak:.1e} of that in the last 5 s, "
          f"mean velocity then at most {100 * mean[quiet].max():.2f} cm/s, no point moved more than "
          f"{1000 * distance(earlier, last):.1f} mm")
    print(f"mass: {s['mass'][0]:.6f} t, changes by {np.ptp(s['mass']) / s['mass'][0]:.1e}")
    largest = abs(s["px"]).max()
    total = max(abs(np.cumsum(s["ix"])).max(), abs(np.cumsum(s["iy"])).max())
    print(f"momentum: largest {largest:.2f} t m/s, imbalances add up to at most {total:.2f} t m/s")

    # Gravity grows over the first second; the log has the potential of the full one.
    end = s["t"] - 0.5 * s["dt"]
    work = np.sum(np.minimum(end[1:], 1) * -np.diff(s["potential"]))
    seeds = points_of(out)
    strength = TOP + GRADIENT * (HEIGHT - first.points[:, 1])
    plastic = np.sum(seeds / DENSITY * np.sqrt(3) * strength * last.point_data["plastic_strain [-]"])
    rest = s["kinetic"][-1] + s["elastic"][-1]
    print(f"energy: gravity gave {work:.2f} kJ, plastic flow took {plastic:.2f} kJ, kinetic and elastic energy at the end "
          f"{rest:.2f} kJ; {100 * (work - plastic - rest) / work:.2f} % are missing")

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


def points_of(out):
    """The mass of every point [t]."""
    import pyvista

    return pyvista.read(out / "points.vtu").point_data["mass [t]"]


if __name__ == "__main__":
    main()
