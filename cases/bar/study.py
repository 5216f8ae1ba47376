"""The bar against its closed form: the tables of the README, and reference.csv.

    .venv/bin/python cases/bar/study.py                                    # the tables, about 15 s
    .venv/bin/python cases/bar/study.py --reference > cases/bar/reference.csv

The closed form is that of src/analytical/vibrating_bar.rs for the first mode.
"""

import math
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant, write_csv

# As in case.yaml: m, kPa, t/m³, m/s.
LENGTH, DEPTH, YOUNG, DENSITY, VELOCITY = 1.0, 0.05, 100.0, 1.0, 0.001
WAVE_NUMBER = math.pi / (2 * LENGTH)
FREQUENCY = WAVE_NUMBER * math.sqrt(YOUNG / DENSITY)
PERIOD = 2 * math.pi / FREQUENCY
ENERGY = 0.25 * DENSITY * VELOCITY**2 * LENGTH * DEPTH


def reference():
    """Free end and support over two periods."""
    rows = []
    for time in np.arange(41) * 0.02:
        sine, cosine = math.sin(FREQUENCY * time), math.cos(FREQUENCY * time)
        reaction = -YOUNG * VELOCITY * WAVE_NUMBER / FREQUENCY * sine * DEPTH
        rows.append((time, VELOCITY / FREQUENCY * sine, VELOCITY * cosine, reaction))
    write_csv("time [s],free.ux [m],free.vx [m/s],fixed.reaction_x [kN]", rows)


def vibrate(step, duration=20 * PERIOD, points=6, h=0.05, spectral_radius=1):
    """The history, and the energy (kJ) after each step."""
    settings = {
        "mesh.parameters.h": h,
        "regions.bar.points_per_cell": points,
        "numerics.spectral_radius": spectral_radius,
        "phases[0].duration": duration,
        "phases[0].step.initial": step,
        "output.every": duration,
    }
    with variant("bar", settings) as out:
        table = history(out)
        log = (out / "solve.log").read_text()
    energies = re.findall(r"elastic (\S+) potential \S+ kinetic (\S+)", log)
    return table, np.array(energies, dtype=float).sum(axis=1)


def period(table):
    """The period (s) from the upward crossings of zero by the free end, interpolated."""
    t, u = table["time"], table["free.ux"]
    up = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    crossings = t[up] + (t[up + 1] - t[up]) * u[up] / (u[up] - u[up + 1])
    return (crossings[-1] - crossings[0]) / (len(crossings) - 1)


def main():
    if sys.argv[1:] == ["--reference"]:
        return reference()
    print("period over 20 periods, percent over the exact one, and over that of the trapezoidal rule; energy")
    errors = []
    for points, h, steps in [(6, 0.05, 20), (6, 0.05, 41), (6, 0.05, 80), (6, 0.1, 41), (16, 0.05, 41), (3, 0.05, 41)]:
        table, energy = vibrate(PERIOD / steps, points=points, h=h)
        found, own = period(table), math.pi * PERIOD / steps / math.atan(math.pi / steps)
        print(f"  {steps} steps, h {h:<4} {points:>2} points a cell: {100 * (found / PERIOD - 1):+.4f}"
              f" {100 * (found / own - 1):+.4f}; energy kept to {np.abs(energy / energy[0] - 1).max():.0e},"
              f" {energy[0] / ENERGY - 1:+.0e} from the exact one")
        errors.append(found / PERIOD - 1)
    print(f"  order in the step, from 20 to 80 steps: {0.5 * math.log2(errors[0] / errors[2]):.2f}")
    print("200 steps of 100 times the CFL limit: largest energy over the first, last over the first")
    for radius in [1, 0.5, 0]:
        _, energy = vibrate(0.25, 50, spectral_radius=radius)
        print(f"  spectral radius {radius:<4} {energy.max() / energy[0]:.6f} {energy[-1] / energy[0]:.1e}")


if __name__ == "__main__":
    main()
