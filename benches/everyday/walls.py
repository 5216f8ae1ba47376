"""Earth pressure on walls, bins after Janssen, shafts of piles."""

import math

from geometry import Face, Section, box
from ground import G
from scene import Check, Scene, near, typed


def davis(angle, dilation):
    """What soil has of its friction and cohesion along slip planes on which its volume follows its dilation (Davis 1968), as a part.

    tan φ* = sin φ cos ψ/(1 − sin φ sin ψ). Soil that dilates by less than its angle of friction does not have its whole strength in every mechanism,
    and its limit loads are between those with φ and φ*.
    """
    phi, psi = math.radians(angle), math.radians(dilation)
    return math.cos(phi) * math.cos(psi) / (1 - math.sin(phi) * math.sin(psi))


def active(weight, height, cohesion, angle, dilation):
    """Rankine's active force [kN/m] on a smooth wall that parts from the soil down to where its pressure would be tension.

    At φ = 37°, ψ = 0, 4 and 8 cells over the height, a wall had 1.08 and 1.09 of Rankine's, with ψ = 12.3° and 37° 0.98.

    >>> [round(active(10, 2, 0, 30, dilation), 3) for dilation in (30, 0)]
    [6.667, 7.639]
    """
    share = davis(angle, dilation)
    coefficient = math.tan(math.pi / 4 - math.atan(share * math.tan(math.radians(angle))) / 2) ** 2
    parted = 2 * share * cohesion / (math.sqrt(coefficient) * weight)
    return coefficient * weight * max(height - parted, 0) ** 2 / 2


def resists(weight, height, cohesion, angle, dilation):
    """Rankine's passive force [kN/m] on a smooth wall. At φ = 34°, ψ = 0, c = 5 kPa, 5 cells over the height, a wall had 0.94 of that with φ.

    >>> [round(resists(10, 2, 0, 30, dilation), 3) for dilation in (30, 0)]
    [60.0, 52.361]
    """
    share = davis(angle, dilation)
    coefficient = math.tan(math.pi / 4 + math.atan(share * math.tan(math.radians(angle))) / 2) ** 2
    return coefficient * weight * height**2 / 2 + 2 * share * cohesion * math.sqrt(coefficient) * height


def rankine(dice):
    """A smooth wall pushed into soil or moved away from it: Rankine's passive or active force."""
    passive = dice.chance(0.5)
    clay = passive and dice.chance(0.4)
    height, weight = dice.scale(0.5, 8), dice.number(14, 21)
    length = typed(height * dice.uniform(1, 1.6))
    h = typed(height / dice.choice([4, 5]))
    strain = 0.01
    if clay:
        strength = typed(weight * height * dice.uniform(0.2, 1))
        soil = {"model": "tresca", "poisson": dice.choice([0.3, 0.49]), "shear_strength": strength}
        coefficient, cohesive = 1.0, 2 * strength
        most = weight * height + cohesive
    else:
        angle = dice.number(20, 38, 2)
        cohesion = dice.choice([0, 0.5, 1, 5]) if passive else dice.choice([0, *3 * [typed(0.02 * weight * height, 2)]])
        soil = {"model": "mohr_coulomb", "poisson": dice.number(0.2, 0.35, 2), "cohesion": cohesion, "friction": angle, "dilation": dice.choice([0, typed(angle / 3, 2)])}
        coefficient = math.tan(math.radians(45 + (angle if passive else -angle) / 2)) ** 2
        cohesive = 2 * cohesion * math.sqrt(coefficient)
        most = max(coefficient, 1) * weight * height + cohesive
    # Everywhere at yield at a third of the way.
    soil |= {"young": typed(3 * most / strain), "unit_weight": weight}
    way = strain * length if passive else -strain * length
    room = typed(max(3 * h, 0.3 * height))
    roof = typed(height + 2 * h)
    faces = [Face("soil", box(0, length, 0, height), h), Face("air", box(0, length, height, roof), h)]
    regions = {"soil": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}}
    materials = {"soil": soil}
    sides, left = [((length, 0), (length, roof))], 0.0
    prescribe = {"ux": {"rate": way}}
    if dice.chance(0.6) or not passive:
        left = -room
        faces += [Face("air", box(-room, 0, 0, roof), h), Face("wall", box(-0.6 * room, 0, 0, 0.5 * (height + roof)), h, structure=True)]
        faces[2].corners.insert(2, (0, height))
        regions["wall"] = {"kind": "structure", "material": "steel", "rigid": True}
        materials["steel"] = {"model": "linear_elastic", "young": 2e8, "poisson": 0.3, "density": 0}
        contact = {"structure": "wall", "soil": "soil"}
        prescribe |= {"uy": 0, "rotation": 0}
    else:
        contact = {"wall": "wall", "soil": "soil"}
    curves = {"bottom": [((left, 0), (length, 0))], "side": sides}
    if left == 0:
        curves["wall"] = [((0, 0), (0, roof))]
    section = Section(faces, curves, quadrangles=dice.chance(0.3))
    case = {
        "geometry": "plane_strain",
        "regions": regions,
        "materials": materials,
        "contacts": [contact],
        "supports": {"bottom": {"uy": 0}, "side": {"ux": 0}},
        "gravity": {"y": -G},
        "initial_stress": {"k0": 1 if clay else dice.choice([0.5, 0.7])},
        "phases": [{"name": "move", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.1}, "prescribe": {"wall": prescribe}}],
        "output": {"history": [{"name": "wall", "on": "wall", "quantities": ["ux", "contact_x"]}, {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }

    def answers(result):
        # The height follows the strain, the force its square.
        if clay:
            least = most = weight * height**2 / 2 + 2 * strength * height
        else:
            force = resists if passive else active
            least, most = sorted(force(weight, height, soil["cohesion"], angle, dilation) for dilation in (angle, soil["dilation"]))
        spread = 0.02 + 2 * strain
        return [
            Check("force on the wall", -result.last("wall.contact_x"), (1 - spread) * least, (1 + spread) * most),
            near("force of the base", result.last("bottom.reaction_y"), weight * height * length, 1e-3 * weight * height * length),
        ]

    kind = "clay" if clay else "sand"
    return Scene(section, case, answers, f"{'passive' if passive else 'active'}, {kind}, {'structure' if left else 'wall of the grid'}", spread=0.02 + 2 * strain, unique=False)


def janssen(dice):
    """Soil in a bin with rough walls: base and walls bear the weight, the base as much as Janssen has with K from active to 1."""
    half, weight = dice.scale(0.1, 3), dice.number(14, 20)
    height = typed(2 * half * dice.uniform(1, 4))
    h = typed(half / dice.choice([2, 3]))
    friction = dice.number(0.1, 0.5, 2)
    angle = dice.number(28, 40, 2)
    soil = {"model": "mohr_coulomb", "young": typed(weight * height * dice.scale(50, 500)), "poisson": dice.number(0.2, 0.35, 2), "cohesion": dice.choice([0, 0.01, 0.1]), "friction": angle, "unit_weight": weight}
    if dice.chance(0.3):
        soil = {"model": "linear_elastic", **{key: soil[key] for key in ("young", "poisson", "unit_weight")}}
    roof = typed(height + 2 * h)
    section = Section(
        [Face("soil", box(-half, half, 0, height), h), Face("air", box(-half, half, height, roof), h)],
        {"base": [((-half, 0), (half, 0))], "left": [((-half, 0), (-half, roof))], "right": [((half, 0), (half, roof))]},
        quadrangles=dice.chance(0.4),
        regular=dice.chance(0.3),
    )
    case = {
        "geometry": "plane_strain",
        "regions": {"soil": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}},
        "materials": {"soil": soil},
        "contacts": [{"wall": wall, "soil": "soil", "friction": friction} for wall in ("left", "right")],
        "supports": {"base": {"uy": 0}},
        "gravity": {"y": -G},
        "phases": [{"name": "fill", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.1}, "gravity": {"rate": 1}}],
        "output": {
            "history": [
                {"name": "base", "on": "base", "quantities": ["reaction_y"]},
                *({"name": wall, "on": wall, "quantities": ["contact_x", "contact_y"]} for wall in ("left", "right")),
            ]
        },
    }
    total = 2 * half * height * weight

    def base(ratio):
        return 2 * half * weight * half / (friction * ratio) * (1 - math.exp(-friction * ratio * height / half))

    least = min(math.tan(math.radians(45 - angle / 2)) ** 2, soil["poisson"] / (1 - soil["poisson"]))

    def answers(result):
        walls = [result.last(f"{wall}.contact_y") for wall in ("left", "right")]
        return [
            near("force of base and walls", result.last("base.reaction_y") - sum(walls), total, 1e-4 * total),
            # Friction is not at its limit at the foot, which does not move: over half a width it bears less.
            Check("force of the base over the weight", result.last("base.reaction_y") / total, 0.95 * base(1) / total, 1.05 * min(base(least) + friction * least * weight * half * half, total) / total),
            near("forces of the walls, sum over the weight", (result.last("left.contact_x") + result.last("right.contact_x")) / total, 0, 0.03),
        ]

    return Scene(section, case, answers, f"{soil['model']}, {height / half / 2:.1f} widths high, μ {friction}")


def shaft(dice):
    """A rigid pile pulled up in clay: α s_u on its shaft."""
    radius = dice.number(0.2, 1, 2)
    length = typed(radius * dice.uniform(3, 6))
    h = typed(radius / 2)
    strength, factor = dice.scale(5, 100), dice.choice([0.3, 0.5, 0.8, 1])
    wide, deep, gap, head = typed(6 * radius), typed(2.5 * radius), typed(radius), typed(1.5 * radius)
    outer = [(radius, -length - gap), (wide, -length - gap), (wide, 0), (radius, 0)]
    faces = [
        Face("lower", [(0, -length - gap - deep), (wide, -length - gap - deep), (wide, -length - gap), (radius, -length - gap), (0, -length - gap)], h),
        Face("clay", outer, h),
        Face("hole", box(0, radius, -length - gap, 0), h),
        Face("air", [(0, 0), (radius, 0), (wide, 0), (wide, head), (0, head)], h),
        Face("pile", box(0, radius, -length, 0.7 * head), h, structure=True),
    ]
    roof, floor = head, -length - gap - deep
    section = Section(faces, {"axis": [((0, floor), (0, roof))], "side": [((wide, floor), (wide, roof))], "bottom": [((0, floor), (wide, floor))]})
    way = typed(0.03 * radius)
    clay = {"model": "tresca", "young": 400 * strength, "poisson": dice.choice([0.3, 0.49]), "shear_strength": strength, "density": 0}
    case = {
        "geometry": "axisymmetric",
        "regions": {
            "lower": {"kind": "mpm", "material": "clay"},
            "clay": {"kind": "mpm", "material": "clay"},
            "hole": {"kind": "buffer"},
            "air": {"kind": "buffer"},
            "pile": {"kind": "structure", "material": "steel", "rigid": True},
        },
        "materials": {"clay": clay, "steel": {"model": "linear_elastic", "young": 2e8, "poisson": 0.3, "density": 0}},
        "contacts": [{"structure": "pile", "soil": ["clay", "lower"], "adhesion_factor": factor, "tension": "no_separation"}],
        "supports": {"axis": {"ux": 0}, "side": {"ux": 0}, "bottom": {"ux": 0, "uy": 0}},
        "phases": [{"name": "pull", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.1}, "prescribe": {"pile": {"uy": {"rate": way}}}}],
        "output": {"history": [{"name": "pile", "on": "pile", "quantities": ["uy", "contact_y"]}]},
    }

    # At the tip and at the ground line a contact node has half a cell of the pile at the most that is not in the clay.
    spread = h / length + 0.01

    def answers(result):
        force = factor * strength * 2 * math.pi * radius * length
        return [Check("force on the shaft", -result.last("pile.contact_y"), (1 - spread) * force, (1 + spread) * force)]

    return Scene(section, case, answers, f"α {factor}, L/R {length / radius:.1f}", spread=spread)
