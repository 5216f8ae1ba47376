"""Soil and water: consolidation after Terzaghi, and what water bears of weights."""

import math

from geometry import Face, Section, box
from ground import EXACT, G, WATER, oedometer
from scene import Scene, below, near, typed


def degree(factor):
    """Of consolidation, of a layer that drains on one side, at the time factor T = c_v t/H² (Terzaghi 1925).

    >>> [round(degree(factor), 4) for factor in (0.05, 0.197, 1)]
    [0.2523, 0.5003, 0.9313]
    """
    terms = ((2 * n + 1) * math.pi / 2 for n in range(200))
    return 1 - sum(2 / m**2 * math.exp(-(m**2) * factor) for m in terms)


def consolidation(dice):
    """Clay under a load at once, drained above, below or on both sides, or by layers of sand: excess pressure and settlement of Terzaghi."""
    drains = dice.choice(["top", "bottom", "both", "sand above", "sand below", "sand"])
    height = dice.scale(0.5, 10)
    h = height / (12 if drains in ("both", "sand") else 8)
    width = typed(h * dice.choice([1, 2, 3]), 4)
    sand = typed(height / 4, 3)
    clay = {
        "model": "linear_elastic",
        "young": dice.scale(500, 20000),
        "poisson": dice.number(0, 0.4, 2),
        "density": 0,
        "drainage": "undrained",
        "permeability": dice.scale(1e-10, 1e-7),
        "porosity": dice.number(0.3, 0.6, 2),
        "water_bulk_modulus": 2.2e6,
    }
    modulus = oedometer(clay)
    low = sand if drains in ("sand below", "sand") else 0.0
    top = low + height
    roof = top + (sand if drains in ("sand above", "sand") else 0.0)
    faces = [Face("clay", box(0, width, low, top), h), Face("air", box(0, width, roof, roof + 3 * h), h)]
    regions = {"clay": {"kind": "mpm", "material": "clay"}, "air": {"kind": "buffer"}}
    materials = {"clay": clay}
    if low:
        faces.append(Face("lower sand", box(0, width, 0, low), h))
    if roof > top:
        faces.append(Face("upper sand", box(0, width, top, roof), h))
    for face in faces[2:]:
        regions[face.name] = {"kind": "mpm", "material": "sand"}
        materials["sand"] = {"model": "linear_elastic", "young": typed(20 * clay["young"]), "poisson": 0.2, "density": 0}
    section = Section(
        faces,
        {"bottom": [((0, 0), (width, 0))], "sides": [((x, 0), (x, roof + 3 * h)) for x in (0, width)]},
        quadrangles=dice.chance(0.5),
        regular=dice.chance(0.5),
    )
    path = height / 2 if drains in ("both", "sand") else height
    diffusivity = clay["permeability"] * modulus / WATER
    load = typed(modulus * dice.scale(0.001, 0.02))
    factor = dice.number(0.1, 0.8, 2)
    end = typed(factor * path**2 / diffusivity, 4)
    case = {
        "geometry": "plane_strain",
        "regions": regions,
        "materials": materials,
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}},
        # The first tenth, when the pressure falls fast, in as many steps as the rest.
        "phases": [
            {"name": name, "analysis": "consolidation", "duration": part * end, "step": {"initial": part * end / 20}, "tractions": [{"surface": "all", "ty": -load}]}
            for name, part in [("first", 0.1), ("then", 0.9)]
        ],
        "output": {"fields": ["stress", "displacement", "pore_pressure"], "history": [{"name": "clay", "on": "clay", "quantities": ["uy", "pore_pressure"]}, {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }
    if drains in ("bottom", "both"):
        case["supports"]["bottom"]["pore_pressure"] = 0
    if drains in ("top", "both"):
        case["drained_surface"] = dice.choice(["all", "clay"])
    elif drains in ("sand above", "sand") and dice.chance(0.5):
        case["drained_surface"] = "all"
    factor = diffusivity * end / path**2

    def answers(result):
        # Twenty steps of backward Euler after a start of twenty short ones, and eight cells (docs/reference/phases.md: a hundred equal
        # steps err by a few tenths of a per cent), and the strain, which cells and c_v follow.
        slack = 0.02 + load / modulus
        checks = [
            near("mean excess pressure over the load", result.last("clay.pore_pressure") / load, 1 - degree(factor), slack),
            near("force of the base over that of the load", result.last("bottom.reaction_y") / (load * width), 1, EXACT),
        ]
        if not low:
            # Drained from above the lower half settles less than half; from below, more. Over the height the mean is known in
            # closed form for drains on both sides only.
            settled = load / modulus * height * degree(factor) / 2
            if drains == "both":
                checks.append(near("mean settlement of the clay", -result.last("clay.uy"), settled, (0.02 + slack) * settled))
        return checks

    return Scene(section, case, answers, f"drained: {drains}, T {factor:.2f}", 1 if dice.chance(0.2) else 2)


def submerged(dice):
    """A layer that settles under water: buoyant weight γ − γ_w as stress, (γ − γ_w)H²/3M as the mean settlement."""
    height, weight = dice.scale(0.5, 20), dice.number(13, 22)
    h = height / dice.randint(4, 8)
    width = typed(height * dice.uniform(0.3, 1.5))
    level = typed(height * dice.uniform(1, 3))
    soil = {"model": "linear_elastic", "young": typed(weight * height * dice.scale(20, 500)), "poisson": dice.number(0, 0.4, 2), "unit_weight": weight}
    roof = typed(1.3 * height)
    section = Section(
        [Face("soil", box(0, width, 0, height), h), Face("air", box(0, width, height, roof), h)],
        {"bottom": [((0, 0), (width, 0))], "sides": [((x, 0), (x, roof)) for x in (0, width)]},
        quadrangles=dice.chance(0.4),
        regular=dice.chance(0.4),
    )
    case = {
        "geometry": "plane_strain",
        "regions": {"soil": {"kind": dice.choice(["mpm", "mpm", "fem"]), "material": "soil"}, "air": {"kind": "buffer"}},
        "materials": {"soil": soil},
        "supports": {"bottom": {"uy": 0}, "sides": {"ux": 0}},
        "gravity": {"y": -G},
        "water": {"level": level, "phreatic_level": level},
        "phases": [{"name": "settle", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1}}],
        "output": {"history": [{"name": "soil", "on": "soil", "quantities": ["uy"]}, {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }
    buoyant = weight - WATER
    modulus = oedometer(soil)
    strain = buoyant * height / modulus
    order = 1 if dice.chance(0.2) else 2

    def answers(result):
        soil = result.soil
        # Water has its pressure at the depth after the settlement: that is the strain's part of the pressure. Of first order a
        # cell has the mean of its stress.
        slack = WATER * height * strain + (weight * h / 2 if order == 1 else 1e-3 * buoyant * height)
        settled = buoyant * height**2 / (3 * modulus)
        error = (2 * strain * (1 + WATER / buoyant) + (0.3 * h / height if order == 1 else 0.005)) * settled
        return [
            below("effective stress less the buoyant weight, at most", abs(soil.yy + buoyant * (height - soil.origin[:, 1])).max(), slack),
            near("mean settlement", -result.last("soil.uy"), settled, error),
        ]

    return Scene(section, case, answers, f"under {level / height:.1f} H of water", order)


def sunken(dice):
    """A rigid block on the ground under water: the ground bears its weight less that of the water in its place."""
    width, height = dice.number(0.5, 2, 2), dice.number(0.4, 1.5, 2)
    h = typed(width / dice.randint(4, 6), 2)
    side = typed(width * dice.uniform(0.8, 1.5), 2)
    depth = typed(width * dice.uniform(0.8, 1.5), 2)
    total = 2 * side + width
    level = typed(height * dice.choice([0.5, 0.8, 1.5, 4]))
    density = dice.number(2, 4, 2)
    water = WATER * width * min(height, level)
    weight = density * G * width * height
    pressure = (weight - water) / width
    section = Section(
        [
            Face("ground", box(0, total, -depth, 0), h),
            Face("air", box(0, total, 0, height), h),
            Face("block", box(side, side + width, 0, height), h, structure=True),
        ],
        {"bottom": [((0, -depth), (total, -depth))], "sides": [((x, -depth), (x, height)) for x in (0, total)]},
        quadrangles=dice.chance(0.3),
    )
    case = {
        "geometry": "plane_strain",
        "regions": {"ground": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}, "block": {"kind": "structure", "material": "concrete", "rigid": True}},
        "materials": {
            "soil": {"model": "linear_elastic", "young": typed(pressure * dice.scale(200, 3000)), "poisson": dice.number(0.1, 0.4, 2), "density": 0},
            "concrete": {"model": "linear_elastic", "young": 3e7, "poisson": 0.2, "density": density},
        },
        "contacts": [{"structure": "block", "soil": "ground", "friction": dice.choice([0, 0.4])}],
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}, "block": {"ux": 0, "rotation": 0}},
        "gravity": {"y": -G},
        "water": {"level": level},
        "phases": [{"name": "rest", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.25}, "gravity": 1}],
        "output": {"history": [{"name": "block", "on": "block", "quantities": ["uy", "contact_y"]}, {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }

    def answers(result):
        # The block sinks a little, and what it sinks is under water, too.
        sunk = abs(result.last("block.uy")) * WATER * width
        slack = 0.002 * weight + sunk
        # The ground is squeezed by block and water, and displaces that much less.
        squeezed = (weight / width + WATER * level) / case["materials"]["soil"]["young"] * WATER * total * depth
        return [
            near("force of the ground on the block", result.last("block.contact_y"), weight - water, slack),
            # In excess of the water pressure (docs/reference/loads.md): the ground without weight is lifted by its own.
            near("force of the base", result.last("bottom.reaction_y"), weight - water - WATER * total * depth, slack + squeezed),
        ]

    return Scene(section, case, answers, f"level at {level / height:.1f} of its height")
