"""A stiff elastic block thrown through the grid, turning as it flies: a parabola, a turn, and no stress but that of the turn."""

import numpy as np

from program import GEO

from . import Problem, Series, Variant

SIDE, SPEED, LIFT, SPIN, GRAVITY, END = 1.0, 4.0, 3.0, 2.0, 10.0, 0.6  # [m], [m/s], [m/s], [rad/s], [m/s2], [s]
YOUNG, DENSITY, STEPS = 1.0e4, 1.0, 120
CENTRE = np.array([1.5, 1.5])  # of the block before the throw [m]

SCENE = {
    "title": "Block thrown through the grid",
    "geometry": "plane_strain",
    "mesh": {"geo": str(GEO.parent / "benches/work_precision/throw.geo"), "parameters": {"h": 0.25}},
    "regions": {"block": {"kind": "mpm", "material": "soil", "points_per_cell": 16}, "room": {"kind": "buffer"}},
    "materials": {"soil": {"model": "linear_elastic", "young": YOUNG, "poisson": 0.3, "density": DENSITY}},
    "gravity": {"y": -GRAVITY},
    "initial_velocity": {
        "block": {
            "velocity": {"x": SPEED, "y": LIFT},
            "gradient": [[0, -SPIN], [SPIN, 0]],
            "centre": {"x": float(CENTRE[0]), "y": float(CENTRE[1])},
        }
    },
    "phases": [{"name": "flight", "analysis": "dynamic", "duration": END, "step": {"initial": END / STEPS, "max": END / STEPS}}],
    "numerics": {"spectral_radius": 1.0},
    "output": {"fields": ["velocity", "displacement", "stress", "mass"]},
}


def errors(run, _settings):
    start, end = run.points()
    origin, mass = start["origin [m]"][:, :2], end["mass [t]"]
    place, velocity = end.points[:, :2], end["velocity [m/s]"][:, :2]
    at = CENTRE + np.array([SPEED * END, LIFT * END - 0.5 * GRAVITY * END**2])
    centre = np.average(place, axis=0, weights=mass)
    mean = np.average(velocity, axis=0, weights=mass)
    arm, away = place - centre, velocity - mean
    spin = (mass * (arm[:, 0] * away[:, 1] - arm[:, 1] * away[:, 0])).sum()
    first = SPIN * (mass * ((origin - CENTRE) ** 2).sum(axis=1)).sum()
    kinetic = 0.5 * (mass * (away**2).sum(axis=1)).sum()
    return {
        "spin": abs(float(spin / first - 1)),
        "energy": abs(float(kinetic / (0.5 * SPIN * first) - 1)),
        "centre": float(np.linalg.norm(centre - at)) / SIDE,
    }


def variant(cells):
    return Variant(cells, {"mesh.parameters.h": SIDE / cells})


PROBLEM = Problem(
    name="thrown",
    title="Thrown block",
    text=(
        "A block of 1 m, E = 10 MPa, thrown with 4 and 3 m/s and turning with 2 rad/s, in 120 steps of 5 ms without numerical damping: it flies "
        "2.4 m and turns by 69°. Errors: its angular momentum, the energy of its turn, and the place of its centre over its side. "
    ),
    scene=SCENE,
    measures={"spin": "error of the angular momentum [-]", "energy": "error of the energy of the turn [-]", "centre": "error of the place over the side [-]"},
    series=[Series("h", "cells over the side", [variant(n) for n in [4, 8]], quick=(0,))],
    errors=errors,
    points_paths=["regions.block.points_per_cell"],
)
