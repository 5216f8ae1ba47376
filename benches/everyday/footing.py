"""Limit loads of footings on clay and on soil with friction.

Strips: 2 + π (Prandtl 1920, Hill 1950). Circles: 5.689 smooth, 6.048 rough (Shield 1955; Eason & Shield 1960). Strength that grows
with depth: the method of characteristics (Davis & Booker 1973, Houlsby & Wroth 1983), computed for this program.
N_q = e^(π tan φ) tan²(45° + φ/2), N_c = (N_q − 1) cot φ (Prandtl 1921, Reissner 1924), N_γ by characteristics (Martin 2005).
"""

import math

from geometry import Face, Section, box
from ground import G
from scene import Check, Scene, typed

# q/s_u0 of smooth and rough strips and circles over kB/s_u0 (kD/s_u0).
GROWTH = [0, 1, 2, 4, 6, 8]
FACTORS = {
    ("plane_strain", 0): [5.1416, 5.9818, 6.6608, 7.8187, 8.8393, 9.7812],
    ("plane_strain", 1): [5.1416, 6.6092, 7.5969, 9.1304, 10.421, 11.583],
    ("axisymmetric", 0): [5.6893, 6.2464, 6.7225, 7.5561, 8.3002, 8.9898],
    ("axisymmetric", 1): [6.0482, 6.9460, 7.6265, 8.7403, 9.6950, 10.560],
}
# N_γ of rough strips over φ (Martin 2005), for q = γB N_γ/2.
WEIGHT = {20: 2.84, 25: 6.49}


def _footing(dice, half, wide, deep, h, soil, geometry, sink, roughness, case):
    """Half of a rigid footing, from the axis on, that is pushed into the ground."""
    air = typed(0.5 * half)
    thick = typed(0.4 * half)
    near, far = typed(1.4 * half), 3 * h
    faces = [
        Face("soil", [(0, -deep), (wide, -deep), (wide, 0), (near, 0), (0, 0)], [far, far, far, h, h]),
        Face("air", [(0, 0), (near, 0), (wide, 0), (wide, air), (0, air)], [h, h, far, far, far]),
        Face("footing", box(0, half, 0, thick), h, structure=True),
    ]
    curves = {
        "axis": [((0, -deep), (0, air))],
        "side": [((wide, -deep), (wide, air))],
        "bottom": [((0, -deep), (wide, -deep))],
    }
    motion = {"uy": {"rate": -sink}}
    if geometry == "plane_strain":
        motion |= {"ux": 0, "rotation": 0}
    return Section(faces, curves, quadrangles=dice.chance(0.25)), {
        "geometry": geometry,
        "regions": {"soil": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}, "footing": {"kind": "structure", "material": "concrete", "rigid": True}},
        "materials": {"soil": soil, "concrete": {"model": "linear_elastic", "young": 3e7, "poisson": 0.2, "density": 0}},
        "contacts": [{"structure": "footing", "soil": "soil", **roughness}],
        "supports": {"axis": {"ux": 0}, "side": {"ux": 0}, "bottom": {"ux": 0, "uy": 0}},
        "phases": [{"name": "push", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.1}, "prescribe": {"footing": motion}}],
        "output": {"history": [{"name": "footing", "on": "footing", "quantities": ["uy", "contact_y"]}]},
        **case,
    }


def clay(dice):
    """Strips and circles on clay, smooth and rough, strength constant or growing with depth: the limit load."""
    geometry = dice.choice(["plane_strain", "axisymmetric"])
    rough = dice.choice([0, 1])
    half = dice.scale(0.3, 3)
    strength = dice.scale(2, 100)
    growth = dice.choice([0, 0, 1, 2, 4])
    cells = dice.choice([4, 5])
    h = typed(half / cells)
    soil = {"model": "tresca", "poisson": dice.choice([0.49, 0.495, 0.3]), "density": 0}
    rigidity = dice.choice([500, 1000, 2000])
    if growth:
        gradient = typed(growth * strength / (2 * half))
        soil |= {"shear_strength": {"top": strength, "gradient": gradient}, "young": {"top": rigidity * strength, "gradient": rigidity * gradient}}
    else:
        soil |= {"shear_strength": strength, "young": rigidity * strength}
    factor = FACTORS[geometry, rough][GROWTH.index(growth)]
    # An elastic footing sinks by about q B/E: three times that brings out the limit.
    sink = typed(3 * factor * 2 * half / rigidity)
    case = {}
    if dice.chance(0.5):
        soil.pop("density")
        soil["unit_weight"] = dice.number(4, 18, 2)
        case = {"gravity": {"y": -G}, "initial_stress": {"k0": 1}}
    weight = soil.get("unit_weight", 0)
    section, case = _footing(dice, half, 5 * half, 3 * half, h, soil, geometry, sink, {"adhesion_factor": rough}, case)
    area = math.pi * half**2 if geometry == "axisymmetric" else half
    order = 2

    def answers(result):
        force = result.last("footing.contact_y") / area
        # Cells smear the edge of the footing over one of them, so that it is up to half a cell wider on a side, and below the surface they
        # are larger than along it, by a quarter in the mean around the footing; strength that grows
        # is that of half a cell deeper. Sunk by w it has the weight of the soil beside it, and the load of its depth (Skempton: a
        # factor 1 + 0.2 w/B, twice that with rough sides), and heaved soil.
        wider = (1 + 0.5 * 1.25 / cells) ** (2 if geometry == "axisymmetric" else 1) * (1 + growth / 4 / cells)
        limit = factor * strength
        deep = 1 + 0.4 * sink / half + growth * sink / half / 2
        return [Check("pressure over the limit", (force / limit), 0.97, (wider * deep * limit + weight * sink) / limit)]

    return Scene(section, case, answers, f"{geometry}, α {rough}, kB/s_u {growth}", order)


def friction(dice):
    """A strip on soil with cohesion and friction, with a surcharge beside it or with weight: c N_c + q N_q + γB N_γ/2."""
    half = dice.scale(0.3, 3)
    angle = dice.choice([*WEIGHT, dice.number(5, 25, 2), dice.number(5, 25, 2)])
    tangent = math.tan(math.radians(angle))
    nq = math.exp(math.pi * tangent) * math.tan(math.radians(45 + angle / 2)) ** 2
    nc = (nq - 1) / tangent
    cohesion = dice.scale(1, 50)
    surcharge = dice.choice([0, typed(cohesion * dice.uniform(0.2, 2))])
    weight = 0.0
    if angle in WEIGHT:
        surcharge, weight = 0, typed(cohesion / half * dice.uniform(0.2, 2))
    limit = cohesion * nc + surcharge * nq + weight * half * WEIGHT.get(angle, 0)
    cells = 4
    h = typed(half / cells)
    modulus = typed(limit * dice.choice([100, 200, 400]))
    sink = typed(3 * limit * 2 * half / modulus)
    soil = {"model": "mohr_coulomb", "young": modulus, "poisson": dice.number(0.2, 0.35, 2), "cohesion": cohesion, "friction": angle, "dilation": angle, "density": 0}
    # Prandtl's mechanism ends at B e^(π/2 tan φ) tan(45° + φ/2) beyond the edge.
    exit = 2 * half * math.exp(math.pi / 2 * tangent) * math.tan(math.radians(45 + angle / 2))
    wide, deep = typed(half + 1.3 * exit), typed(0.8 * exit + half)
    section, case = _footing(dice, half, wide, deep, h, soil, "plane_strain", sink, {"friction": typed(tangent, 2) if weight else dice.choice([0, typed(tangent, 2)])}, {})
    if weight:
        soil.pop("density")
        soil["unit_weight"] = weight
        case |= {"gravity": {"y": -G}, "initial_stress": {"k0": 1}}
    if surcharge:
        edge = half + h / 2
        beside = {"surface": "all", "ty": -surcharge, "where": {"x": [edge, 2 * wide], "y": [-deep, 10 * half]}}
        push = case["phases"][0]
        sides = {**push["prescribe"]["footing"], "uy": 0}
        first = {**push, "name": "surcharge", "step": {"initial": 0.5}, "tractions": [beside | {"ty": {"rate": -surcharge}}], "prescribe": {"footing": sides}}
        push["tractions"] = [beside]
        case["phases"] = [first, push]

    def answers(result):
        pressure = result.last("footing.contact_y") / half
        # As on clay, and the sunk footing has the heaved soil beside it. The sum of three limits is below that of all together, by
        # a fifth at the most (Davis & Booker 1971).
        wider = 1 + 0.5 / cells * (1 + tangent * math.pi / 2)
        together = 1.2 if weight else 1.0
        return [Check("pressure over the limit", pressure / limit, 0.95, wider * together * (1 + sink / half * (1 + nq / 5)))]

    return Scene(section, case, answers, f"φ {angle}, q/c {surcharge / cohesion:.2g}, γB/2c {weight * half / cohesion:.2g}")
