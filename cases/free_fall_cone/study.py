"""Depth, time and force of the cone beside those by its bearing resistance: the table of the README, and its picture.

    .venv/bin/python cases/free_fall_cone/study.py OUT [OUT ...] [-o PICTURE]
"""

import argparse
import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

RADIUS, HEIGHT, SPEED, GRAVITY = 0.05, 0.36, 3.0, 9.81  # of the cone [m, m/s, m/s²]
STRENGTH, DENSITY = 5.0, 1.6  # of the clay [kPa, t/m³]
TIP = RADIUS / math.tan(math.radians(30))  # its height [m]
AREA = math.pi * RADIUS**2
MASS = 3.5 * AREA * (HEIGHT - 2 / 3 * TIP)
# Load (kN) of cases/cone over the depth of its tip (m), for 10 kPa, 6 kN/m³ and a radius of 1 m.
BEARING = np.array([[0, 0], [1, 74], [1.73, 194], [2, 226], [3, 315], [4, 387], [4.95, 463]])
DRAG = 0.335  # of a cone of 60° with a cavity behind it


def displaced(z, radius, tip):
    """Volume (m³) of a cone of height `tip` under a shaft, down to z."""
    inside = np.minimum(z, tip)
    return math.pi * radius**2 * (inside**3 / (3 * tip**2) + np.maximum(z - tip, 0))


def bearing(z):
    """The resistance (kN) of clay to the slow cone with its tip at z (m), with the weight of the clay in its place."""
    deep = z / RADIUS
    factor = (np.interp(deep, *BEARING.T) - 6 * displaced(deep, 1, TIP / RADIUS)) / 10
    return factor * STRENGTH * RADIUS**2 + DENSITY * GRAVITY * displaced(z, RADIUS, TIP)


def drag(z, v):
    """The force (kN) that sets clay in motion at the velocity v (m/s)."""
    return 0.5 * DRAG * DENSITY * v**2 * AREA * np.minimum(z / TIP, 1) ** 2


def motion(coefficient):
    """Time, depth and force until the cone stops, of m dv/dt = m g − F, in small steps; the drag times `coefficient`."""
    rows, t, z, v, dt = [], 0.0, 0.0, SPEED, 1e-5
    while v > 0:
        force = bearing(z) + coefficient * drag(z, v)
        rows.append((t, z, force))
        v += dt * (GRAVITY - force / MASS)
        z += dt * v
        t += dt
    return np.array(rows).T


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", nargs="+", type=Path)
    arguments.add_argument("-o", "--picture", type=Path)
    given = arguments.parse_args()
    print("| | depth (m) | time (s) | energy of the force over that of the cone | impulse over change of momentum | roughness of the force |\n|---|---|---|---|---|---|")
    forms = [("bearing alone", motion(0)), ("bearing and drag", motion(1))]
    for name, (time, depth, _) in forms:
        print(f"| {name} | {depth[-1]:.4f} | {time[-1]:.4f} | 1 | 1 | |")
    curves = []
    for out in given.out:
        of = history(out)
        time, depth, speed, force = (np.concatenate(([start], of[column])) for start, column in ((0, "time"), (0, "cone.uy"), (-SPEED, "cone.vy"), (0, "cone.contact_y")))
        depth = -depth
        stop = int(depth.argmax())
        steps, upto = np.diff(time), slice(1, stop + 1)
        # The force of a step acts all through it.
        impulse = np.sum((force[1:] - MASS * GRAVITY) * steps) / (MASS * (speed[-1] + SPEED))
        work = np.sum((force[1:] * np.diff(depth))[:stop]) / (MASS * (SPEED**2 / 2 - speed[stop] ** 2 / 2 + GRAVITY * depth[stop]))
        tenth = max(int(round(0.1 * stop)), 1)
        smooth = np.convolve(force[upto], np.ones(tenth) / tenth, "valid")
        middle = force[upto][tenth // 2 : tenth // 2 + len(smooth)]
        rough = abs(middle - smooth)[smooth > 0.2 * force[upto].max()].max() / force[upto].max()
        curves.append((out.name, depth[upto], force[upto]))
        print(f"| {out.name} | {depth[stop]:.4f} | {time[stop]:.4f} | {work:.4f} | {impulse:.5f} | {100 * rough:.1f} % |")
    if given.picture:
        import matplotlib

        matplotlib.use("agg")
        import matplotlib.pyplot as plt

        fig, axes = plt.subplots(figsize=(5, 3), layout="constrained")
        for name, depth, force in curves:
            axes.plot(depth, force, label=name)
        for name, (_, depth, force) in forms:
            axes.plot(depth, force, "--", lw=1, label=name)
        axes.set(xlabel="depth of the tip (m)", ylabel="force of the clay (kN)")
        axes.legend(fontsize=8)
        fig.savefig(given.picture, dpi=150)


if __name__ == "__main__":
    main()
