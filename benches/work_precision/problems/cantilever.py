"""The cantilever of 10 m × 1 m that bends down by eight tenths of its length."""

import copy

import numpy as np

from program import ROOT
from reference import Field

from . import Problem, Series, Variant

LENGTH, DEPTH, TIP, STEPS = 10.0, 1.0, 0.5, 50
LOAD, GRAVITY = 100.0, 10.0  # [kN/m], [m/s²]

SCENE = {
    "title": "Cantilever in a grid that it bends through",
    "geometry": "plane_strain",
    "mesh": {"geo": str(ROOT / "benches/work_precision/beam.geo"), "parameters": {"h": 0.25}},
    "regions": {
        "beam": {"kind": "mpm", "material": "light", "points_per_cell": 16},
        "tip": {"kind": "mpm", "material": "heavy", "points_per_cell": 16},
        "room": {"kind": "buffer"},
    },
    "materials": {
        "light": {"model": "linear_elastic", "young": 12000, "poisson": 0.2, "density": 0},
        "heavy": {"model": "linear_elastic", "young": 12000, "poisson": 0.2, "density": LOAD / (GRAVITY * DEPTH * TIP)},
    },
    "supports": {"clamp": {"ux": 0, "uy": 0}},
    "gravity": {"y": -GRAVITY},
    "phases": [
        {
            "name": "load",
            "analysis": "quasi_static",
            "duration": 1,
            "step": {"initial": 1 / STEPS},
            "gravity": {"rate": 1},
        }
    ],
    "output": {"fields": ["stress", "displacement", "mass"]},
}
REFERENCE = {}


def within_tip(places):
    return places[:, 0] > LENGTH - TIP


def lagrangian(h):
    """The same beam alone on a grid of fine cells that is never restored."""
    scene = copy.deepcopy(SCENE)
    scene["mesh"]["parameters"] = {"h": h, "room": 0}
    del scene["regions"]["room"]
    for region in scene["regions"].values():
        region["points_per_cell"] = 3
    scene["numerics"] = {"restore": "never"}
    return Field(scene, {"phases[0].step.initial": 0.05}).mean(within_tip)


def prepare():
    coarse, fine = lagrangian(0.125), lagrangian(0.0625)
    REFERENCE["tip"] = fine
    return (
        f"Reference: {fine[0]:.5f} m and {fine[1]:.5f} m with cells of 1/16 of the depth, never restored; "
        f"{coarse[0]:.5f} m and {coarse[1]:.5f} m with 1/8."
    )


def relative(tip):
    exact = REFERENCE["tip"]
    return {"ux": abs(float(tip[0] / exact[0] - 1)), "uy": abs(float(tip[1] / exact[1] - 1))}


def errors(run, _settings):
    start, end = run.points()
    chosen = within_tip(start["origin [m]"])
    weight = start["initial_volume [m3]"][chosen]
    return relative(np.average(end["displacement [m]"][chosen], axis=0, weights=weight))


def peer_errors(points):
    chosen = within_tip(points["origin"])
    return relative(np.average(points["displacement"][chosen], axis=0, weights=points["volume"][chosen]))


def variant(at, h, points=None, steps=STEPS):
    settings = {"mesh.parameters.h": h, "phases[0].step.initial": 1 / steps}
    if points:
        settings |= {"regions.beam.points_per_cell": points, "regions.tip.points_per_cell": points}
    return Variant(at, settings, {"h": h, "steps": steps, "points": points or 16})


PROBLEM = Problem(
    name="cantilever",
    title="Cantilever",
    text=(
        "10 m × 1 m, clamped at x = 0, E = 12 MPa, ν = 0.2, plane strain, in 50 steps. The load of 100 kN/m is the weight of "
        "the last half metre, the same dead load in every program and on every grid; "
        "the errors are those of that half metre's mean displacement, each component relative to the reference."
    ),
    scene=SCENE,
    measures={"uy": "error of the tip's deflection [-]", "ux": "error of the tip's shortening [-]"},
    series=[
        Series("h", "cells over the depth", [variant(round(DEPTH / h), h) for h in [0.5, 0.25, 0.125]], quick=(0, 1)),
        Series("points, h = 0.25 m", "points a cell", [variant(p, 0.25, p) for p in [4, 9, 16, 25]], quick=()),
        Series("steps, h = 0.25 m", "steps", [variant(s, 0.25, steps=s) for s in [25, 50, 100, 200]], quick=()),
    ],
    errors=errors,
    points_paths=["regions.beam.points_per_cell", "regions.tip.points_per_cell"],
    peer="cantilever",
    peer_errors=peer_errors,
    prepare=prepare,
)
