"""Mandel's strip against its closed form: the table of the README, and reference.csv.

    .venv/bin/python cases/mandel/study.py                                    # the table
    .venv/bin/python cases/mandel/study.py --reference > cases/mandel/reference.csv

The closed form is that of src/analytical/mandel.rs.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant, write_csv

# As in case.yaml and mandel.geo: m, kPa, s, kN/m.
YOUNG, FORCE, HEIGHT = 1000.0, 0.1, 0.2
STORAGE, MOBILITY = 0.5 / 2.2e6, 8.829e-7 / 9.81
FACTORS = [0.01, 0.1, 0.5, 1.0]
ENDS = [100, 1000, 5000, 10000]  # of the phases [s]


class Strip:
    """Half of a strip 2 m wide."""

    def __init__(self, poisson, storage=STORAGE):
        self.poisson = poisson
        self.shear = YOUNG / (2 * (1 + poisson))
        bulk = YOUNG / (3 * (1 - 2 * poisson))
        whole = bulk + 1 / storage
        self.undrained = (3 * whole - 2 * self.shear) / (2 * (3 * whole + self.shear))
        self.first = FORCE / (1 + bulk * storage) * (1 + self.undrained) / 3
        modulus = 2 * self.shear * (1 - poisson) / (1 - 2 * poisson)
        self.coefficient = MOBILITY / (1 / modulus + storage)
        self.roots = self.find((1 - poisson) / (self.undrained - poisson))

    @staticmethod
    def find(ratio):
        """The roots of tan a = ratio a, one in each [nπ, (n + ½)π]."""
        n = np.arange(400)
        low, high = np.maximum(np.pi * n, 1e-6), np.pi * (n + 0.5)
        for _ in range(200):
            middle = 0.5 * (low + high)
            below = (np.sin(middle) - ratio * middle * np.cos(middle)) * (-1.0) ** n < 0
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return low

    def pressure(self, time):
        """In the middle (kPa)."""
        a = self.roots
        terms = np.sin(a) / (a - np.sin(a) * np.cos(a)) * (1 - np.cos(a)) * np.exp(-(a**2) * self.coefficient * time)
        return 2 * self.first * float(np.sum(terms))

    def shortening(self, time):
        """Strain between the plates."""
        a = self.roots
        left = float(np.sum(np.sin(a) * np.cos(a) / (a - np.sin(a) * np.cos(a)) * np.exp(-(a**2) * self.coefficient * time)))
        return FORCE / (2 * self.shear) * ((1 - self.poisson) - 2 * (1 - self.undrained) * left)


def reference():
    """p/p0 in the middle for incompressible water."""
    strips = [Strip(poisson, 1e-15) for poisson in (0.0, 0.2)]
    rows = [(t, *(s.pressure(t / s.coefficient) / s.first for s in strips)) for t in FACTORS]
    write_csv("T [-],nu = 0 [-],nu = 0.2 [-]", rows)


def errors(poisson, h):
    """At each of the times the pressure in the middle over p0, its error, and that of the settlement of the plate."""
    strip = Strip(poisson)
    with variant("mandel", {"materials.clay.poisson": poisson, "mesh.parameters.h": h}) as out:
        table = history(out)
    found = []
    for end in ENDS:
        row = int(np.argmin(np.abs(table["time"] - end)))
        time = table["time"][row]
        pressure = table["middle.pore_pressure"][row] / strip.first
        down = -table["plate.uy"][row] / (HEIGHT * strip.shortening(time)) - 1
        found.append((pressure, pressure - strip.pressure(time) / strip.first, down))
    return found


def compare(poisson, h):
    """A row of the table, the errors in per cent."""
    cells = [f"{pressure:.4f} ({100 * middle:+.2f}) / {100 * down:+.2f}" for pressure, middle, down in errors(poisson, h)]
    print(f"| ν = {poisson}, h = {h} m | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    if "--reference" in sys.argv:
        reference()
    else:
        print("| | t = 100 s | 1000 s | 5000 s | 10 000 s |")
        print("|---|---|---|---|---|")
        for poisson in (0.2, 0.0):
            compare(poisson, 0.05)
