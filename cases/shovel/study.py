"""Force on the blade beside that of a wedge of soil before it: the table of the README, and its picture.

    .venv/bin/python cases/shovel/study.py OUT [-o PICTURE] [--sand]
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pyvista

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

STRENGTH, WEIGHT, CUT = 10.0, 18.0, 0.5  # of the clay, and depth of the trench [kPa, kN/m³, m]
COHESION, FRICTION = 0.0, np.radians(30)  # of the sand [kPa, -]
WIDE = 0.05  # of a strip in which the highest point tells the surface [m]
ANGLES = np.radians(np.arange(15, 66, 0.5))  # of the plane under the wedge [-]


def wedge(x: np.ndarray, height: np.ndarray, cohesion: float, friction: float) -> float:
    """The least force (kN/m) on a smooth blade by which soil of a height (m) above the tip at distances x (m) from the blade slides up a plane from its tip."""

    def force(angle: float) -> float:
        inside = height > x * np.tan(angle)
        end = len(x) if inside.all() else np.argmin(inside)
        weight = WEIGHT * np.trapezoid(height[:end] - x[:end] * np.tan(angle), x[:end])
        return weight * np.tan(angle + friction) + cohesion * x[end - 1] / np.cos(angle) * np.cos(friction) / np.cos(angle + friction)

    return min(force(angle) for angle in ANGLES if angle + friction < np.radians(85))


def level(height: float, cohesion: float, friction: float) -> float:
    """Rankine's force (kN/m) on a smooth wall before level soil."""
    k = np.tan(np.pi / 4 + friction / 2) ** 2
    return k * WEIGHT * height**2 / 2 + 2 * cohesion * k**0.5 * height


def frames(out: Path) -> list[tuple[float, np.ndarray, np.ndarray, float]]:
    """The way of the blade (m) of each frame of the push, the surface before it, and the area (m²) of the soil above the first one."""
    reader, found, of = pyvista.get_reader(str(out / "points.pvd")), [], history(out)
    for time in (time for time in reader.time_values if time > 1 + 1e-6):
        reader.set_active_time_value(time)
        points = reader.read()[0]
        x, y = points.points[:, 0], points.points[:, 1]
        area = points["mass [t]"] * 9.81 / WEIGHT
        way = np.interp(time, of["time"], of["blade.ux"])
        strips = way + WIDE * np.arange(int((x.max() - way) / WIDE))
        top = np.array([y[(x >= a) & (x < a + WIDE)].max() for a in strips])
        middle = strips - way + WIDE / 2
        fine = np.linspace(0, middle[-1], 2000)
        found.append((way, fine, np.interp(fine, middle, top) + 0.5 * np.sqrt(np.median(area)) + CUT, area[y > 0].sum()))
    return found


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", type=Path)
    arguments.add_argument("-o", "--picture", type=Path)
    arguments.add_argument("--sand", action="store_true")
    given = arguments.parse_args()
    of = history(given.out)
    pushed = of["time"] > 1
    way, force = of["blade.ux"][pushed], -of["blade.contact_x"][pushed]
    cohesion, friction = (COHESION, FRICTION) if given.sand else (STRENGTH, 0.0)
    first = level(CUT, cohesion, friction)
    print(f"at the beginning, level ground: {first:.2f} kN/m, wedge {wedge(np.linspace(0, 3, 2000), np.full(2000, CUT), cohesion, friction):.2f}")
    print("| way (m) | height at the blade (m) | force (kN/m) | wedge (kN/m) | heap over way times depth |\n|---|---|---|---|---|")
    rows = [(0.0, first)]
    for at, x, height, heap in frames(given.out):
        around = abs(way - at) < 0.03
        rows.append((at, wedge(x, height, cohesion, friction)))
        print(f"| {at:.2f} | {height[0]:.2f} | {force[around].mean():.1f} | {rows[-1][1]:.1f} | {heap / (CUT * at):.3f} |")
    if given.picture:
        import matplotlib

        matplotlib.use("agg")
        import matplotlib.pyplot as plt

        fig, axes = plt.subplots(figsize=(6, 3), layout="constrained")
        axes.plot(way, force, label="mpm")
        axes.plot(*np.array(rows).T, "o--", label="wedge under the surface that was found")
        axes.set(xlabel="way of the blade (m)", ylabel="force (kN/m)", ylim=(0, None), xlim=(0, None))
        axes.legend()
        fig.savefig(given.picture, dpi=150)


if __name__ == "__main__":
    main()
