"""Terzaghi's layer against its closed form: the tables of the README, and reference.csv.

    .venv/bin/python cases/terzaghi/study.py                                    # the tables
    .venv/bin/python cases/terzaghi/study.py --reference > cases/terzaghi/reference.csv

The closed form is that of src/analytical/terzaghi.rs.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, last_frame, variant, write_csv

# As in case.yaml: m, kPa, s.
HEIGHT, YOUNG, POISSON, LOAD = 1.0, 1000.0, 0.2, 0.1
MODULUS = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
STORAGE = 0.5 / 2.2e6
COEFFICIENT = 8.829e-7 / 9.81 / (1 / MODULUS + STORAGE)
FIRST = LOAD / (1 + MODULUS * STORAGE)
FACTORS = [0.01, 0.05, 0.1, 0.197, 0.5, 1.0]
ROOTS = np.pi * (np.arange(1000) + 0.5)


def isochrone(depth, factor):
    """p/p0 at a depth over the height."""
    return float(np.sum(2 / ROOTS * np.sin(ROOTS * depth) * np.exp(-(ROOTS**2) * factor)))


def degree(factor):
    """Degree of consolidation."""
    return 1 - float(np.sum(2 / ROOTS**2 * np.exp(-(ROOTS**2) * factor)))


def settlement(time):
    """Of the top (m)."""
    first, last = (LOAD - FIRST) / MODULUS, LOAD / MODULUS
    return HEIGHT * (first + (last - first) * degree(COEFFICIENT * time / HEIGHT**2))


def reference():
    """Degree of consolidation and pressure at the base and in the middle."""
    rows = [(t, degree(t), isochrone(1.0, t), isochrone(0.5, t)) for t in FACTORS]
    write_csv("T_v [-],degree [-],pressure at the base [-],pressure in the middle [-]", rows)


def errors(settings):
    """At each of the times the settlement over the closed form and the pressure at the base over that, in p0."""
    with variant("terzaghi", settings) as out:
        table = history(out)
    found = []
    for factor in FACTORS:
        row = int(np.argmin(np.abs(table["time"] - factor * 1e4)))
        time = table["time"][row]
        down = -table["top.uy"][row] / settlement(time) - 1
        base = table["base.pore_pressure"][row] / FIRST - isochrone(1.0, COEFFICIENT * time / HEIGHT**2)
        found.append((down, base))
    return found


def compare(title, settings):
    """A row of the table, in per cent."""
    print(f"| {title} | " + " | ".join(f"{100 * down:+.2f} / {100 * base:+.2f}" for down, base in errors(settings)) + " |", flush=True)


def first_step():
    """Largest pressure after a first step of T_v = 1e-8, over p0."""
    for h in (0.01, 0.05):
        settings = {"mesh.parameters.h": h}
        for i, factor in enumerate(FACTORS):
            settings |= {f"phases[{i}].duration": 1e-4 if i == 0 else 1e-12, f"phases[{i}].step.initial": 1e-4 if i == 0 else 1e-12}
        with variant("terzaghi", settings) as out:
            pressure = last_frame(out)["pore_pressure [kPa]"]
        print(f"first step of 1e-4 s, h = {h} m: {pressure.max() / FIRST:.4f} p0 at most")


if __name__ == "__main__":
    if "--reference" in sys.argv:
        reference()
    else:
        print("| | " + " | ".join(f"T_v = {factor}" for factor in FACTORS) + " |")
        print("|---" * (len(FACTORS) + 1) + "|")
        compare("this case", {})
        compare("h = 0.02 m", {"mesh.parameters.h": 0.02})
        compare("h = 0.04 m", {"mesh.parameters.h": 0.04})
        compare("finite elements, h = 0.02 m", {"mesh.parameters.h": 0.02, "regions.soil.kind": "fem", "numerics.restore": "every_step"})
        compare("axisymmetric, h = 0.02 m", {"mesh.parameters.h": 0.02, "geometry": "axisymmetric"})
        first_step()
