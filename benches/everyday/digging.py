"""Soil that is dug out of elastic ground: whole layers, or a pit beside one side.

Where whole layers go, what is left bears the weight above it, and its sides unload by ν/(1 − ν) of that; the base bears what is left in any case.
"""

import numpy as np
from geometry import Face, clipped
from ground import EXACT, G, HISTORY, Ground, elastic
from scene import Scene, below, near


def dig(dice):
    """The upper layers go at once or in turn, or a part of the uppermost one."""
    ground = Ground(dice, level_base=True)
    while ground.kinds.count("mpm") < 2:
        ground = Ground(dice, level_base=True)
    k0 = dice.number(0.4, 1.1, 2)
    soils = [elastic(dice, ground.scale, weight) for weight in ground.weights]
    left, weight = list(ground.weights), ground.weight
    regions = ground.regions(dice, [f"soil{n}" for n in range(len(soils))])
    width, top = ground.width, ground.names[-1]
    if pit := not ground.section.regular and dice.chance(0.5):
        share = dice.number(0.3, 0.7)
        face = next(face for face in ground.section.faces if face.name == top)
        x = ground.left + share * width
        parts = [Face(name, clipped(face.corners, 0, x, above), face.h) for name, above in (("pit", False), (top, True))]
        n = ground.section.faces.index(face)
        ground.section.faces[n : n + 1] = parts
        regions["pit"] = dict(regions[top])
        stages = [["pit"]]
        weight -= share * width * (ground.levels[-1] - ground.levels[-2]) * ground.weights[-1]
    else:
        count = dice.randint(1, ground.kinds.count("mpm") - 1)
        gone = ground.names[-count:][::-1]
        for name in gone:
            left[ground.names.index(name)] = 0.0
        stages = [[name] for name in gone] if dice.chance(0.5) else [gone]
        weight = sum(gamma * width * (high - low) for gamma, low, high in zip(left, ground.levels, ground.levels[1:]))
    phase = {"analysis": "quasi_static", "duration": 1, "step": {"initial": 0.5}}
    case = {
        "geometry": "plane_strain",
        "regions": regions,
        "materials": {f"soil{n}": soil for n, soil in enumerate(soils)},
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}},
        "gravity": {"y": -G},
        "initial_stress": {"k0": k0},
        "phases": [{"name": f"dig {n + 1}", **phase, "remove": stage} for n, stage in enumerate(stages)],
        "output": {"history": HISTORY},
    }
    strain = ground.scale / min(soil["young"] for soil in soils)

    def answers(result):
        checks = [near("reaction of the base", result.last("bottom.reaction_y"), weight, EXACT * ground.weight)]
        if pit:
            return checks
        soil = result.soil
        before, after = (-ground.weight_above(soil.origin[:, 1], weights) for weights in (ground.weights, left))
        layer = np.clip(np.searchsorted(ground.levels, soil.origin[:, 1]) - 1, 0, len(soils) - 1)
        ratio = np.array([soil["poisson"] / (1 - soil["poisson"]) for soil in soils])[layer]
        cell = max(ground.weights) * ground.h
        tolerance = cell if ground.order == 1 else ground.scale * (1e-3 + 2 * strain)
        inner = np.min([abs(soil.origin[:, 1] - level) for level in ground.levels], axis=0) > 1e-6 * ground.depth
        sideways = k0 * before + ratio * (after - before)
        return checks + [
            below("vertical stress less the weight above, at most", abs(soil.yy - after)[inner].max(), tolerance),
            below("horizontal stress, error at most", abs(soil.xx - sideways)[inner].max(), tolerance),
        ]

    what = "a pit" if pit else f"{sum(map(len, stages))} of {len(ground.names)} layers"
    return Scene(ground.section, case, answers, f"dig {what}, {len(stages)} phases", ground.order)
