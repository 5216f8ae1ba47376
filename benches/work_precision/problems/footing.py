"""The strip footing on Tresca soil, pushed to its limit load."""

import math

from program import ROOT

from . import Problem, Series, Variant

STRENGTH = 100.0  # [kPa]
EXACT = (2 + math.pi) * STRENGTH  # on half a footing 1 m wide [kN/m]
STEPS = 50


def errors(run, _settings):
    return {"load": abs(float(-run.history()["footing.reaction_y"][-1] / EXACT - 1))}


def variant(at, h, points=None, steps=STEPS, poisson=0.4999):
    settings = {
        "mesh.parameters.h": h,
        "materials.clay.poisson": poisson,
        "phases[0].step.initial": 1 / steps,
        "phases[0].step.max": 1 / steps,
        "numerics": {},
    }
    if points:
        settings["regions.soil.points_per_cell"] = points
    return Variant(at, settings)


PROBLEM = Problem(
    name="footing",
    title="Smooth strip footing",
    text=(
        "`cases/strip_footing` (Tresca, E = 10⁴ s_u, B = 2 m) at ν = 0.4999, pushed by B/500 in 50 steps; h is the size of "
        "the cells at the edge. The error is that of the last load, N_c = 2 + π being exact."
    ),
    scene=ROOT / "cases/strip_footing",
    measures={"load": "error of the limit load [-]"},
    series=[
        Series("h", "B/h", [variant(round(2 / h), h) for h in [0.25, 0.125, 0.0625]], quick=(0, 1)),
        Series("points, h = B/16", "points a cell", [variant(p, 0.125, p) for p in [4, 9, 16, 25]], quick=()),
        Series("steps, h = B/16", "steps", [variant(s, 0.125, steps=s) for s in [25, 50, 100, 200]], quick=()),
    ],
    errors=errors,
    points_paths=["regions.soil.points_per_cell"],
)
