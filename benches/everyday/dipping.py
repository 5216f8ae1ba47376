"""Ground that K₀ does not hold in equilibrium: layers that dip, slopes. Gravity turned on does."""

import math

import numpy as np
from geometry import Face, Section, box
from ground import EXACT, G, HISTORY, REST, elastic
from scene import Scene, below, near, typed


def dipping(dice):
    """Gravity turned on in dipping layers: the reaction is the weight, forces to the sides add up, and ∫σ_y dV is −∫γ y dV."""
    return _dipping(dice, False)


def dipping_rest(dice):
    """K₀ in dipping layers, which is no equilibrium: right by chance, or said."""
    return _dipping(dice, True)


def _dipping(dice, at_rest):
    width, depth = dice.scale(2, 20), dice.scale(1, 10)
    left, right = (depth * dice.number(0.25, 0.75, 2) for _ in range(2))
    if abs(left - right) < 0.1 * depth:
        right = left + 0.2 * depth
    h = max(math.sqrt(width * depth) * dice.uniform(0.15, 0.25), width / 20)
    weights = [dice.number(17, 22), dice.number(11, 16)]
    faces = [Face("lower", [(0, 0), (width, 0), (width, right), (0, left)], h), Face("upper", [(0, left), (width, right), (width, depth), (0, depth)], h)]
    areas = [width * (left + right) / 2, width * (depth - (left + right) / 2)]
    roof = depth
    regions = {name: {"kind": "mpm", "material": name} for name in ("lower", "upper")}
    if dice.chance(0.5):
        roof += 0.3 * depth
        faces.append(Face("air", box(0, width, depth, roof), h))
        regions["air"] = {"kind": "buffer"}
    curves = {"bottom": [((0, 0), (width, 0))], "sides": [((x, 0), (x, roof)) for x in (0, width)]}
    curves["held"] = curves["bottom"] + curves["sides"]
    section = Section(faces, curves, quadrangles=dice.chance(0.3), regular=dice.chance(0.3))
    scale = depth * max(weights)
    materials = {name: elastic(dice, scale, weight) | {"young": typed(dice.scale(50, 3000) * scale)} for name, weight in zip(("lower", "upper"), weights)}
    phase = {"name": "gravity", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1 if at_rest else 0.5}}
    case = {
        "geometry": "plane_strain",
        "regions": regions,
        "materials": materials,
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}},
        "gravity": {"y": -G},
        "phases": [phase if at_rest else phase | {"gravity": {"rate": 1}}],
        "output": {"fields": ["stress", "displacement", "mass"], "history": HISTORY},
    }
    if at_rest:
        case["initial_stress"] = {"k0": dice.number(0.4, 0.8, 2)}
    weight = areas[0] * weights[0] + areas[1] * weights[1]

    def answers(result):
        checks = [
            near("reaction of the base", result.last("bottom.reaction_y"), weight, EXACT * weight),
            near("sum of the horizontal reactions", result.last("held.reaction_x"), 0, EXACT * weight),
        ]
        # With the virtual displacement y: the vertical stress over the volume is the weight times its height above the base.
        soil = result.soil
        upper = soil.origin[:, 1] > left + (right - left) * soil.origin[:, 0] / width
        volume = soil.mass * G / np.where(upper, weights[1], weights[0])
        moment = (soil.mass * G * soil.origin[:, 1]).sum()
        strain = scale / min(soil["young"] for soil in materials.values())
        checks.append(near("vertical stress over the volume, over the moment of the weight", (soil.yy * volume).sum() / moment, -1, 1e-3 + 2 * strain))
        if at_rest:
            slack = 1e-3 * strain * depth
            checks.append(below("displacement, at most", abs(result.soil.displacement).max(), slack))
        return checks

    # Triangles of first order, one or two in a layer, are too stiff by some per cent.
    order = 1 if dice.chance(0.2) else 2
    return Scene(section, case, answers, "layers that dip", order, spread=0.02 if order == 2 else 0.1)


def slope_rest(dice):
    """K₀ under a slope, which is no equilibrium: right by chance, or said."""
    height = dice.scale(1, 10)
    run, h = height * dice.number(1, 4, 2), height / 4
    weight = dice.number(14, 22)
    width = run + 4 * height
    soil = [(0, 0), (width, 0), (width, 2 * height), (2 * height + run, 2 * height), (2 * height, height), (0, height)]
    section = Section(
        [Face("soil", soil, h), Face("air", [(0, height), (2 * height, height), (2 * height + run, 2 * height), (width, 2 * height), (width, 2.4 * height), (0, 2.4 * height)], h)],
        {"bottom": [((0, 0), (width, 0))], "sides": [((x, 0), (x, 2.4 * height)) for x in (0, width)]},
    )
    soil = elastic(dice, 2 * height * weight, weight)
    case = {
        "geometry": "plane_strain",
        "regions": {"soil": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}},
        "materials": {"soil": soil},
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}},
        "gravity": {"y": -G},
        "initial_stress": {"k0": dice.number(0.4, 1, 2)},
        "phases": REST,
        "output": {"history": [{"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }

    def answers(result):
        most = 2 * height * weight
        return [below("displacement, at most", abs(result.soil.displacement).max(), 1e-3 * most / soil["young"] * height)]

    return Scene(section, case, answers, f"1 in {run / height:.1f}")
