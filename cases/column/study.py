"""The column against its closed form: the tables of the README, and reference.csv.

    .venv/bin/python cases/column/study.py                                       # the tables, about 10 s
    .venv/bin/python cases/column/study.py --reference > cases/column/reference.csv

The closed form is that of src/analytical/self_weight_column.rs, computed here in another way, from the balance
itself: at the original depth Z the Cauchy stress is -w Z, so the stretch l solves E ln(l)/l = -w Z, and the
displacement is the integral of l - 1 from the base.
"""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import Failed, last_frame, variant, write_csv

HEIGHT, UNIT_WEIGHT = 10.0, 20.0  # m, kN/m³, as in case.yaml
RATIOS = [0.01, 0.05, 0.1, 0.2, 0.5, 1.0]


def young(r):
    """Young's modulus (kPa) that gives r = w H / E."""
    return UNIT_WEIGHT * HEIGHT / r


def stretch(depth, r):
    """The root l of ln(l)/l = -w Z/E, by Newton's method on -ln(l)."""
    q = UNIT_WEIGHT * depth / young(r)
    x = np.log1p(q)
    for _ in range(50):
        x = x - (x - q * np.exp(-x)) / (1 + q * np.exp(-x))
    return np.exp(-x)


def displacement(depth, r):
    """Displacement (m), upwards positive, at original depths (m): Gauss-Legendre from the base."""
    place, weight = np.polynomial.legendre.leggauss(40)
    half = 0.5 * (HEIGHT - depth)
    z = depth[:, None] + half[:, None] * (1 + place)
    return half * ((stretch(z, r) - 1) @ weight)


def reference():
    depth = np.linspace(0, HEIGHT, 17)
    rows = [(r, z, u, -UNIT_WEIGHT * z) for r in RATIOS for z, u in zip(depth, displacement(depth, r))]
    write_csv("r [-],depth [m],displacement [m],stress [kPa]", rows)


def errors(cells, r, points=3, restore="never", quadrature="resampled", quads=0, width=None):
    """Mean errors of the stress over w H and of the displacement over the settlement, weighted by volume."""
    import pyvista

    h = HEIGHT / cells
    settings = {
        "mesh.parameters.h": h,
        "mesh.parameters.width": width or h,
        "mesh.parameters.quads": quads,
        "regions.soil.points_per_cell": points,
        "materials.soil.young": young(r),
        "numerics.restore": restore,
        "numerics.quadrature": quadrature,
    }
    with variant("column", settings) as out:
        start, end = pyvista.read(out / "points.vtu"), last_frame(out)
    depth = HEIGHT - start["origin [m]"][:, 1]
    weight = start["initial_volume [m3]"] / start["initial_volume [m3]"].sum()
    stress = np.abs(end["stress [kPa]"][:, 1] + UNIT_WEIGHT * depth) / (UNIT_WEIGHT * HEIGHT)
    moved = np.abs(end["displacement [m]"][:, 1] - displacement(depth, r))
    return weight @ stress, weight @ moved / -displacement(np.zeros(1), r)[0]


def main():
    if sys.argv[1:] == ["--reference"]:
        return reference()
    print("never restored, 16 cells: mean error of the stress over w H and of the displacement over the settlement")
    for r in RATIOS:
        print("  r {:<5} stress {:.1e}  displacement {:.1e}".format(r, *errors(16, r, width=1.25)))
    print("never restored, 8, 16, 32 cells on meshes alike, one cell wide: errors, and order of the displacement")
    for r in [0.01, 1.0]:
        for points, quads, weights in [(3, 0, "resampled"), (12, 0, "resampled"), (16, 0, "resampled"), (16, 0, "points"), (16, 1, "resampled")]:
            e = [errors(cells, r, points, quadrature=weights, quads=quads) for cells in [8, 16, 32]]
            kind = "Q9" if quads else "T6"
            text = "  ".join("{:.1e} {:.1e}".format(*both) for both in e)
            print(f"  r {r:<5} {points:>2} points a {kind}, {weights}  {text}  order {0.5 * math.log2(e[0][1] / e[2][1]):.2f}")
    print("plain MPM, restored in every step, the volumes of the points as weights, 8, 16, 32 cells: errors")
    for r in [0.01, 0.5, 1.0]:
        for points in [3, 12, 16]:
            texts = []
            for cells in [8, 16, 32]:
                try:
                    texts.append("{:.1e} {:.1e}".format(*errors(cells, r, points, "every_step", "points")))
                except Failed:
                    texts.append("breaks down".ljust(15))
            print(f"  r {r:<5} {points:>2} points a T6  " + "  ".join(texts))


if __name__ == "__main__":
    main()
