"""The column under its own weight, l0 = 50 m, compressed to half its height and to 30 % at the base."""

import numpy as np

from program import GEO

from . import Problem, Series, Variant

HEIGHT, YOUNG, DENSITY, GRAVITY, STEPS = 50.0, 10.0, 0.08, 10.0, 40
WEIGHT = DENSITY * GRAVITY * HEIGHT  # of the whole column [kPa]

SCENE = {
    "title": "Column under its own weight, 50 m of very soft matter",
    "geometry": "plane_strain",
    "mesh": {"geo": str(GEO / "column.geo"), "parameters": {"height": HEIGHT, "width": 1, "h": 1}},
    "regions": {"soil": {"kind": "mpm", "material": "soil", "points_per_cell": 16}},
    "materials": {"soil": {"model": "linear_elastic", "young": YOUNG, "poisson": 0, "density": DENSITY}},
    "supports": {"bottom": {"uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}},
    "gravity": {"y": -GRAVITY},
    "phases": [
        {
            "name": "gravity",
            "analysis": "quasi_static",
            "duration": 1,
            "step": {"initial": 1 / STEPS},
            "gravity": {"rate": 1},
        }
    ],
    "output": {"fields": ["stress", "displacement", "mass"]},
}


def stress_error(height, stress, volume):
    """Σ|σ_yy − exact| V0 / (ρ g l0 ΣV0); the stress (kPa) is −ρ g Z at the original depth Z = l0 − height (m)."""
    exact = -DENSITY * GRAVITY * (HEIGHT - height)
    return float((np.abs(stress - exact) * volume).sum() / (WEIGHT * volume.sum()))


def errors(run, _settings):
    start, end = run.points()
    height, volume = start["origin [m]"][:, 1], start["initial_volume [m3]"]
    return {"stress": stress_error(height, end["stress [kPa]"][:, 1], volume)}


def peer_errors(points):
    return {"stress": stress_error(points["origin"][:, 1], points["stress"][:, 1], points["volume"])}


def variant(at, cells, wide=1, steps=STEPS, points=None, peer=True):
    h = HEIGHT / cells
    settings = {"mesh.parameters.h": h, "mesh.parameters.width": wide * h, "phases[0].step.initial": 1 / steps}
    if points:
        settings["regions.soil.points_per_cell"] = points
    arguments = {"cells": cells, "wide": wide, "steps": steps, "points": points or 4}
    return Variant(at, settings, arguments if peer and (points or 4) != 12 else {})


SIZES = [8, 16, 32, 64, 128]
# GIMP of AMPLE (Coombs & Augarde 2020) and cpGIMP of GeoWarp, four points a cell, 40 steps.
OTHERS = {
    "AMPLE": dict(zip(SIZES, [(1.29e-2, 5.2), (3.66e-3, 11.0), (1.05e-3, 20.6), (4.4e-4, 40.6), (2.0e-4, 176.0)])),
    "GeoWarp": dict(zip(SIZES, [(1.29e-2, 1.20), (3.66e-3, 1.41), (1.05e-3, 1.98), (4.4e-4, 2.86), (2.0e-4, 5.4)])),
}
PROBLEM = Problem(
    name="column",
    title="Self-weight column",
    text=(
        "l0 = 50 m, E = 10 kPa, ν = 0, ρ = 0.08 t/m³, g = 10 m/s², gravity in 40 steps, six-node triangles with one or three "
        "cells over the width. The error is Σ|σ_yy − exact| V0 / (ρ g l0 ΣV0), the exact stress −ρ g Z."
    ),
    scene=SCENE,
    measures={"stress": "mean stress error over ρ g l0 [-]"},
    series=[
        Series("h, one cell wide", "cells over the height", [variant(n, n) for n in SIZES]),
        Series("h, three cells wide", "cells over the height", [variant(n, n, 3, peer=False) for n in SIZES]),
        Series("points, 32 cells", "points a cell", [variant(p, 32, points=p) for p in [4, 9, 12, 16, 25]]),
        Series("steps, 32 cells", "steps", [variant(s, 32, steps=s) for s in [10, 20, 40, 80, 160]], quick=(2, 4)),
        Series(
            "every count of cells",
            "cells over the height",
            [variant(n, n, peer=False) for n in range(40, 81)],
            schemes=["default", "resampled", "ddmp"],
            quick=(),
        ),
    ],
    errors=errors,
    points_paths=["regions.soil.points_per_cell"],
    peer="column",
    peer_errors=peer_errors,
    others=OTHERS,
)
