"""Stress in the full silo beside Janssen, and the rate of discharge beside Beverloo: the tables of the README, and its picture.

    .venv/bin/python cases/silo/study.py OUT [-o PICTURE]
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pyvista

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

DENSITY, GRAVITY, FRICTION = 1.6, 9.81, 0.364  # of the sand, and at the walls [t/m³, m/s², -]
HALF, SLOT, HEIGHT = 0.5, 0.15, 1.5  # half of the width of silo and slot, height of the sand [m]
REST = 0.3 / 0.7  # ν/(1 − ν): horizontal over vertical stress of elastic soil that does not widen [-]
FULL = 1.0  # when the silo is opened [s]
WITHIN = 0.1  # of a depth, where the stress is averaged [m]
BEVERLOO = 0.58 * 4 / np.pi * 2**0.5  # of a slot by its hydraulic diameter, which is twice its width [-]


def janssen(depth: np.ndarray) -> np.ndarray:
    """The mean vertical stress (kPa) at a depth (m)."""
    rise = FRICTION * REST / HALF
    return DENSITY * GRAVITY / rise * (1 - np.exp(-rise * depth))


def frames(out: Path) -> list[tuple[float, pyvista.DataSet]]:
    """The material points at each time (s)."""
    reader = pyvista.get_reader(str(out / "points.pvd"))
    found = []
    for time in reader.time_values:
        reader.set_active_time_value(time)
        found.append((time, reader.read()[0]))
    return found


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", type=Path)
    arguments.add_argument("-o", "--picture", type=Path)
    given = arguments.parse_args()
    of, points = history(given.out), frames(given.out)
    full = np.argmin(abs(of["time"] - FULL))
    floor = -of["floor.contact_y"][full] - of["gate.contact_y"][full]
    side, shear = of["wall.contact_x"][full], -of["wall.contact_y"][full]
    print(f"floor and gate {floor:.2f} kN/m, Janssen {HALF * janssen(HEIGHT):.2f}; wall {shear:.2f} kN/m; their sum over the weight {(floor + shear) / (DENSITY * GRAVITY * HALF * HEIGHT):.6f}")
    print(f"friction of the wall: {shear / side:.3f} of {FRICTION}")
    filled = next(p for t, p in points if abs(t - FULL) < 1e-6)
    y, stress = filled.points[:, 1], -filled["stress [kPa]"][:, 1]
    print("| depth (m) | vertical stress (kPa) | Janssen |\n|---|---|---|")
    for depth in (0.3, 0.6, 0.9, 1.2):
        near = abs(HEIGHT - y - depth) < WITHIN
        print(f"| {depth} | {stress[near].mean():.2f} | {janssen(depth):.2f} |")

    time = np.array([t for t, _ in points if t >= FULL - 1e-6]) - FULL
    mass = np.array([p["mass [t]"][p.points[:, 1] > 0].sum() for t, p in points if t >= FULL - 1e-6])
    head = mass / (DENSITY * HALF)
    unit = 0.5 * DENSITY * GRAVITY**0.5 * (2 * SLOT) ** 1.5
    print(f"\nBeverloo: C = {BEVERLOO:.2f}, {BEVERLOO * unit:.3f} t/s\n| mean height of the sand (m) | rate (t/s) | C |\n|---|---|---|")
    for top, bottom in ((1.4, 1.15), (1.15, 0.9), (0.9, 0.65), (0.65, 0.4)):
        within = (head <= top) & (head >= bottom)
        if within.sum() > 1:
            rate = -np.polyfit(time[within], mass[within], 1)[0]
            print(f"| {top} to {bottom} | {rate:.3f} | {rate / unit:.2f} |")
    print(f"in the end {mass[-1]:.3f} t of {mass[0]:.3f} t are left above the floor")
    if given.picture:
        import matplotlib

        matplotlib.use("agg")
        import matplotlib.pyplot as plt

        fig, axes = plt.subplots(figsize=(6, 3), layout="constrained")
        axes.plot(time, mass, label="mpm")
        axes.plot(time, np.maximum(mass[0] - BEVERLOO * unit * time, 0), "--", label="Beverloo")
        axes.set(xlabel="time after the opening (s)", ylabel="sand above the floor (t)", ylim=(0, None))
        axes.legend()
        fig.savefig(given.picture, dpi=150)


if __name__ == "__main__":
    main()
