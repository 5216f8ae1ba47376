"""The cantilever against the elastica: the tables of the README, and reference.csv.

    .venv/bin/python cases/cantilever/study.py                                           # the tables, about 15 s
    .venv/bin/python cases/cantilever/study.py --reference > cases/cantilever/reference.csv

The elastica is that of src/analytical/elastica.rs, computed here in another way: EI θ″ = -P cos θ with no moment
at the tip gives EI θ′² = 2 P (sin θ_L - sin θ), and quadrature over the slope θ gives the length, the deflection
and the reach. Its unknown, the slope θ_L of the tip, is found by bisection.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant, write_csv

LENGTH, RIGIDITY = 20.0, 1000.0  # m, kNm² a metre, as in case.yaml


def integrals(slope):
    """∫ (1, sin θ, cos θ) / √(2 (sin θ_L - sin θ)) dθ to the slope θ_L of the tip."""
    place, weight = np.polynomial.legendre.leggauss(80)
    # θ = θ_L (1 - s²) takes the singularity at the tip away.
    s, weight = 0.5 * (1 + place), 0.5 * weight
    theta = slope * (1 - s * s)
    # sin θ_L - sin θ, written without cancellation.
    gap = 2 * np.cos(0.5 * (slope + theta)) * np.sin(0.5 * slope * s * s)
    density = weight * 2 * slope * s / np.sqrt(2 * gap)
    return density.sum(), density @ np.sin(theta), density @ np.cos(theta)


def elastica(load):
    """Deflection and shortening of the tip over L, at the load P L²/EI."""
    low, high = 0.0, 0.5 * np.pi
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if integrals(middle)[0] < np.sqrt(load) else (low, middle)
    root, down, along = integrals(low)
    return down / root, 1 - along / root


def reference():
    loads = np.arange(1, 21) * 0.25
    write_csv("PL2/EI [-],deflection/L [-],shortening/L [-]", [(load, *elastica(load)) for load in loads])


def tip(h=0.5, points=3, depth=1.0, quads=0):
    """Deflection and shortening over L at P L²/EI = 0.25, 0.5 … 5; E grows with thinner beams to keep EI."""
    settings = {
        "mesh.parameters.h": h,
        "mesh.parameters.depth": depth,
        "mesh.parameters.quads": quads,
        "regions.beam.points_per_cell": points,
        "materials.elastic.young": 12 * RIGIDITY / depth**3,
        "phases[0].tractions[0].ty.rate": -5 * RIGIDITY / LENGTH**2 / depth,
        "output.every": 1,
    }
    with variant("cantilever", settings) as out:
        table = history(out)
    at = [int(np.argmin(np.abs(5 * table["time"] - load))) for load in np.arange(1, 21) * 0.25]
    return -table["tip.uy"][at] / LENGTH, -table["tip.ux"][at] / LENGTH


def percent(found, load):
    """Errors of the tip in percent of the elastica."""
    index = round(load / 0.25) - 1
    return [100 * (value[index] / exact - 1) for value, exact in zip(found, elastica(load))]


def main():
    if sys.argv[1:] == ["--reference"]:
        return reference()
    print("percent over the elastica, deflection and shortening")
    found = tip()
    for load in [0.25, 0.5, 1, 2, 3, 5]:
        print("  PL²/EI {:<5} {:+.3f} {:+.3f}".format(load, *percent(found, load)))
    print("at PL²/EI = 5, over size of the cells and points in them")
    for h in [1, 0.5, 0.25]:
        for points, quads in [(3, 0), (6, 0), (12, 0), (16, 0), (16, 1)]:
            errors = percent(tip(h, points, quads=quads), 5)
            print("  h {:<5} {:>2} points a {} {:+.3f} {:+.3f}".format(h, points, "Q9" if quads else "T6", *errors))
    print("at PL²/EI = 0.25 and 5, over the slenderness; h is half the depth")
    deflections = []
    for depth in [2, 1, 0.5]:
        found = tip(0.5 * depth, depth=depth)
        deflections.append(found[0][-1])
        small, large = percent(found, 0.25), percent(found, 5)
        shear = 100 * 0.6 * (depth / LENGTH) ** 2
        print(f"  L/h {LENGTH / depth:<4g} {small[0]:+.3f} (Timoshenko's shear at small load {shear:+.3f})  {large[0]:+.3f}")
    limit = (4 * deflections[2] - deflections[1]) / 3
    print(f"  h/L to 0, as (h/L)²: {100 * (limit / elastica(5)[0] - 1):+.4f} at PL²/EI = 5")


if __name__ == "__main__":
    main()
