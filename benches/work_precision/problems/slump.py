"""The elastic block that slumps under its own weight on a smooth base."""

import copy

import numpy as np

from program import GEO
from reference import Field

from . import Problem, Series, Variant

WEIGHT, STEPS = 10.0, 40  # ρ g H [kPa]

SCENE = {
    "title": "Elastic block under its own weight",
    "geometry": "plane_strain",
    "mesh": {"geo": str(GEO / "slump.geo"), "parameters": {"half_width": 1, "height": 1, "room": 0.5, "h": 0.0625}},
    "regions": {"block": {"kind": "mpm", "material": "soil", "points_per_cell": 16}, "room": {"kind": "buffer"}},
    "materials": {"soil": {"model": "linear_elastic", "young": 2 * WEIGHT, "poisson": 0.3, "density": 1}},
    "supports": {"bottom": {"uy": 0}, "axis": {"ux": 0}},
    "gravity": {"y": -WEIGHT},
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
REFERENCE = {}


def lagrangian(h):
    """The block alone on a grid of fine cells that is never restored."""
    scene = copy.deepcopy(SCENE)
    scene["mesh"]["parameters"] |= {"h": h, "room": 0}
    del scene["regions"]["room"]
    scene["regions"]["block"]["points_per_cell"] = 3
    scene["numerics"] = {"restore": "never"}
    return Field(scene, {"phases[0].step.initial": 0.2})


def compare(origin, displacement, stress, volume):
    """Mean and largest displacement error over the largest displacement, mean error of σ_yy over ρ g H."""
    u, sigma, inside = REFERENCE["field"].at(origin)
    largest = np.linalg.norm(REFERENCE["field"].cloud["displacement"], axis=1).max()
    weight = volume[inside] / volume[inside].sum()
    away = np.linalg.norm(displacement[inside] - u[inside], axis=1) / largest
    off = np.abs(stress[inside, 1] - sigma[inside, 1]) / WEIGHT
    return {"displacement": float(weight @ away), "largest": float(away.max()), "stress": float(weight @ off)}


def prepare():
    coarse, fine = lagrangian(1 / 32), lagrangian(1 / 64)
    REFERENCE["field"] = fine
    found = compare(coarse.cloud.points, coarse.cloud["displacement"], coarse.cloud["stress"], coarse.volume)
    return (
        "Reference: cells of 1/64, never restored; from it cells of 1/32 differ by "
        f"{found['displacement']:.1e} (displacement, mean), {found['largest']:.1e} (largest) and {found['stress']:.1e} (stress)."
    )


def errors(run, _settings):
    start, end = run.points()
    return compare(start["origin [m]"], end["displacement [m]"], end["stress [kPa]"], start["initial_volume [m3]"])


def peer_errors(points):
    return compare(points["origin"], points["displacement"], points["stress"], points["volume"])


def variant(at, cells, points=None, steps=STEPS):
    settings = {"mesh.parameters.h": 1 / cells, "phases[0].step.initial": 1 / steps}
    if points:
        settings["regions.block.points_per_cell"] = points
    return Variant(at, settings, {"cells": cells, "steps": steps, "points": points or 16})


PROBLEM = Problem(
    name="slump",
    title="Elastic slump",
    text=(
        "A block of half width 1 m and height 1 m on a smooth base, ν = 0.3, ρ g H / E = 0.5, gravity in 40 steps. "
        "Displacement errors are over its largest value (0.4 H about), those of σ_yy over ρ g H."
    ),
    scene=SCENE,
    measures={
        "displacement": "mean displacement error over the largest displacement [-]",
        "largest": "largest displacement error over the largest displacement [-]",
        "stress": "mean error of σ_yy over ρ g H [-]",
    },
    series=[
        Series("h", "cells over the height", [variant(n, n) for n in [8, 16, 32]], quick=(0, 1)),
        Series("points, h = 1/16", "points a cell", [variant(p, 16, p) for p in [4, 9, 16, 25]], quick=()),
        Series("steps, h = 1/16", "steps", [variant(s, 16, steps=s) for s in [10, 20, 40, 80, 160]], quick=()),
    ],
    errors=errors,
    points_paths=["regions.block.points_per_cell"],
    peer="slump",
    peer_errors=peer_errors,
    prepare=prepare,
)
