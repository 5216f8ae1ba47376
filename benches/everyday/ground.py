"""Ground at rest: K₀, gravity and water levels in layers.

Under level ground the weight above a place is the vertical stress there, at any strain (the area does not change), and the
horizontal one is K₀ times that; where gravity is turned on, soil that cannot move sideways has K = ν/(1 − ν) of the elastic
strains, and at yield that of Rankine's active state.
"""

import math

import numpy as np
from geometry import Face, Section, box
from scene import Scene, below, near, typed

G = 9.81
WATER = 9.81
EXACT = 1e-5  # of the weight: the tolerance of Newton's method (1e-8 of the forces) with room
SETTLED = 1e-5  # of the stress at the base, the same; over 1 − 2ν, as the pressure of nearly incompressible soil


class Ground:
    """Level layers, from the base up, in a section with vertical sides."""

    def __init__(self, dice, level_base=False, cells=(0.12, 0.3)):
        count = dice.randint(1, 3)
        self.width, self.depth = dice.scale(0.6, 30), dice.scale(0.5, 20)
        self.left = 0.0 if dice.chance(0.5) else dice.number(-20, 20)
        self.top = 0.0 if dice.chance(0.5) else dice.number(-5, 10)
        self.base = self.top - self.depth
        cuts = sorted(dice.sample(range(2, 10), count - 1))
        self.levels = [self.base, *(round(self.base + self.depth * cut / 10, 3) for cut in cuts), self.top]
        right = self.left + self.width
        # The lowest layer may have an uneven base, within its upper three quarters.
        low = self.levels[1] - self.levels[0]
        base = [(self.left, self.base), (right, self.base)]
        if not level_base and dice.chance(0.7):
            places = [self.left, *sorted(dice.number(self.left + 0.1 * self.width, right - 0.1 * self.width) for _ in range(dice.randint(0, 2))), right]
            base = [(x, round(self.base + dice.uniform(0, 0.7) * low, 2)) for x in places]
            if any(b[0] - a[0] < 0.05 * self.width for a, b in zip(base, base[1:])):
                base = [base[0], base[-1]]
        self.base_line = base
        self.h = max(dice.uniform(*cells) * math.sqrt(self.width * self.depth), max(self.width, self.depth) / 60)
        faces = [Face("layer1", [*base, (right, self.levels[1]), (self.left, self.levels[1])], self.h)]
        for n in range(1, count):
            faces.append(Face(f"layer{n + 1}", box(self.left, right, self.levels[n], self.levels[n + 1]), self.h))
        self.names = [face.name for face in faces]
        self.air = dice.chance(0.6)
        roof = self.top
        if self.air:
            roof = self.top + max(self.h, 0.2 * self.depth)
            faces.append(Face("air", box(self.left, right, self.top, roof), self.h))
        sides = [((x, y), (x, roof)) for x, y in (base[0], base[-1])]
        curves = {"bottom": list(zip(base, base[1:])), "sides": sides, "held": [*sides, *zip(base, base[1:])], "top": [((self.left, self.top), (right, self.top))]}
        self.section = Section(faces, curves)
        self.order = 1 if dice.chance(0.3) else 2
        self.section.quadrangles = dice.chance(0.3)
        self.section.regular = len(base) == 2 and dice.chance(0.4)
        # Finite elements hold what lies on them: the lowest layers.
        self.kinds = ["mpm"] * count
        if dice.chance(0.3):
            for n in range(dice.randint(1, count)):
                self.kinds[n] = "fem"
        self.weights = [dice.number(14, 22) for _ in range(count)]

    def regions(self, dice, materials):
        regions = {}
        for name, kind, material in zip(self.names, self.kinds, materials):
            regions[name] = {"kind": kind, "material": material}
            if kind == "mpm" and dice.chance(0.5):
                regions[name]["points_per_cell"] = dice.choice([4, 9, 16])
        if self.air:
            regions["air"] = {"kind": "buffer"}
        return regions

    def weight_above(self, y, weights=None):
        """Of the soil above heights [kPa]."""
        total = np.zeros_like(y)
        for low, high, weight in zip(self.levels, self.levels[1:], weights or self.weights):
            bottom = -math.inf if low == self.base else low
            total += weight * np.clip(high - np.maximum(y, bottom), 0, None)
        return total

    @property
    def weight(self):
        """Of all soil [kN/m]."""
        total = 0.0
        for (xa, ya), (xb, yb) in zip(self.base_line, self.base_line[1:]):
            heights = np.array([(ya + yb) / 2])
            total += (xb - xa) * self.weight_above(heights)[0]
        return total

    @property
    def scale(self):
        """The stress at the base [kPa]."""
        return self.weight_above(np.array([self.base]))[0]


HISTORY = [
    {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]},
    {"name": "held", "on": "held", "quantities": ["reaction_x"]},
]
REST = [{"name": "rest", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1}}]


def elastic(dice, stress, weight, poisson=None):
    """An elastic soil that strains little under a stress [kPa]."""
    poisson = dice.number(0.0, 0.4, 2) if poisson is None else poisson
    return {"model": "linear_elastic", "young": typed(dice.scale(30, 1000) * stress), "poisson": poisson, "unit_weight": weight}


def strong(dice, stress, k0, weight):
    """A soil of any model that bears a stress [kPa] at rest with the given K₀ without yield."""
    soil = elastic(dice, stress, weight)
    model = dice.choice(["linear_elastic", "tresca", "mohr_coulomb", "von_mises"])
    shear = abs(1 - k0) * stress / 2
    if model == "tresca":
        soil |= {"poisson": dice.choice([0.3, 0.49, 0.495]), "shear_strength": typed(dice.number(1.3, 4) * shear + 1)}
    elif model == "von_mises":
        soil["yield_stress"] = typed(dice.number(1.3, 4) * 2 * shear + 1)
    elif model == "mohr_coulomb":
        least = math.degrees(math.asin(abs(1 - k0) / (1 + k0)))
        soil |= {"friction": min(max(least + 5, 25), 45), "cohesion": dice.choice([0, 1, 5])}
    return soil | {"model": model}


def rest(dice):
    """K₀ in level layers over an even or uneven base, one for all or each its own: the weight above, K₀ times that, and nothing moves."""
    ground = Ground(dice, cells=(0.03, 0.2))
    k0 = dice.number(0.4, 1.1, 2)
    names = [f"soil{n}" for n in range(len(ground.weights))]
    by_name = dict.fromkeys(names, k0)
    if dice.chance(0.5):
        k0 = by_name = {name: dice.number(0.4, 1.1, 2) for name in names}
    materials = {name: strong(dice, ground.scale, by_name[name], weight) for name, weight in zip(names, ground.weights)}
    if ground.section.regular is False and dice.chance(0.4):
        split(dice, ground)
    soft = min(soil["young"] for soil in materials.values())
    stiffest = max(soil["poisson"] for soil in materials.values())
    supports = {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}}
    case = {
        "geometry": "axisymmetric" if ground.left == 0 and dice.chance(0.3) else "plane_strain",
        "regions": ground.regions(dice, materials),
        "materials": materials,
        "supports": supports,
        "gravity": {"y": -G},
        "initial_stress": {"k0": k0},
        "phases": REST,
        "output": {"history": HISTORY},
    }
    water = levels(dice, ground, case)

    def answers(result):
        soil = result.soil
        vertical = -ground.weight_above(soil.origin[:, 1]) + water(soil.origin[:, 1])
        # The water pressure has a kink at a table, which cells do not have within them: up to a quarter of γ_w h.
        slack = SETTLED / (1 - 2 * stiffest) * ground.scale + (WATER * ground.h / 4 if "water" in case and "level" not in case["water"] else 0)
        # Nodes between finite elements of two layers are there once in each.
        layers = [np.searchsorted(ground.levels[1:-1], soil.origin[:, 1] + side) for side in (-1e-6, 1e-6)]
        off = np.min([abs(soil.xx - np.array([by_name[name] for name in names])[layer] * vertical) for layer in layers], axis=0)
        checks = [
            below("vertical stress less the weight above, at most", abs(soil.yy - vertical).max(), slack),
            below("horizontal stress less K0 of it, at most", off.max(), slack),
            below("shear stress, at most", abs(soil.xy).max(), slack),
            below("displacement, at most", abs(soil.displacement).max(), slack / soft * ground.depth),
        ]
        if case["geometry"] == "plane_strain" and "water" not in case:
            checks.append(near("reaction of the base", result.last("bottom.reaction_y"), ground.weight, EXACT * ground.weight))
        return checks

    return Scene(ground.section, case, answers, f"K0 {k0}, {len(ground.names)} layers", ground.order, EXACT)


def split(dice, ground):
    """Parts a layer into two fields of the same soil, side by side."""
    from geometry import clipped

    face = dice.choice([face for face in ground.section.faces if face.name in ground.names])
    x = dice.number(ground.left + 0.3 * ground.width, ground.left + 0.7 * ground.width)
    parts = [Face(face.name, clipped(face.corners, 0, x, above), face.h) for above in (False, True)]
    n = ground.section.faces.index(face)
    ground.section.faces[n : n + 1] = parts


def levels(dice, ground, case):
    """Gives a case water, at times; returns the water pressure within the soil's stress, as a function of the height."""
    kind = dice.choice(["none", "none", "flooded", "table"])
    if kind == "none":
        return lambda y: np.zeros_like(y)
    if kind == "flooded":
        level = round(ground.top + dice.uniform(0, 1) * ground.depth, 2)
        case["water"] = {"level": level, "phreatic_level": level}
        return lambda y: WATER * (ground.top - y)
    # A table at the top of a layer: there the effective stress has its kink, and the cells have an edge.
    level = dice.choice(ground.levels[1:])
    case["water"] = {"phreatic_level": level}
    return lambda y: WATER * np.clip(level - y, 0, None)


def gravity(dice):
    """Gravity turned on in level layers, elastic or at yield: the weight above, K of elasticity or Rankine's active one."""
    ground = Ground(dice, level_base=True)
    materials, ratios = {}, []
    for n, weight in enumerate(ground.weights):
        soil = elastic(dice, ground.scale, weight)
        cohesion = slope = None
        if dice.chance(0.3):
            friction = dice.number(20, 40, 2)
            soil |= {"model": "mohr_coulomb", "friction": friction, "cohesion": dice.choice([0, 0.5, 5]), "dilation": dice.choice([0, typed(friction / 4)])}
            slope = math.tan(math.radians(45 - friction / 2)) ** 2
            cohesion = soil["cohesion"] * math.sqrt(slope)
        elif dice.chance(0.3):
            soil |= {"model": "tresca", "poisson": dice.choice([0.3, 0.49]), "shear_strength": typed(dice.number(0.1, 1) * ground.scale)}
            slope, cohesion = 1.0, soil["shear_strength"]
        materials[f"soil{n}"] = soil
        ratios.append((soil["poisson"] / (1 - soil["poisson"]), slope, cohesion))
    case = {
        "geometry": "plane_strain",
        "regions": ground.regions(dice, materials),
        "materials": materials,
        "supports": {"bottom": dice.choice([{"ux": 0, "uy": 0}, {"uy": 0}]), "sides": {"ux": 0}},
        "gravity": {"y": -G},
        "phases": [{"name": "gravity", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.25}, "gravity": {"rate": 1}}],
        "output": {"history": HISTORY},
    }
    oedometric = [oedometer(soil) for soil in materials.values()]
    strain = ground.scale / min(oedometric)
    plastic = any(soil["model"] != "linear_elastic" for soil in materials.values())

    def answers(result):
        soil = result.soil
        vertical = -ground.weight_above(soil.origin[:, 1])
        most, cell = ground.scale, max(ground.weights) * ground.h
        # Of second order the linear stress is within what cells hold, up to the strains; at yield its kink is not. Of first order
        # a cell has the mean of its stress.
        tolerance = cell if ground.order == 1 else most * (1e-3 + strain * ground.h / ground.depth) + (0.25 * cell if plastic else 0)
        checks = [
            near("reaction of the base", result.last("bottom.reaction_y"), ground.weight, EXACT * ground.weight),
            near("sum of the forces on both sides and the base", result.last("held.reaction_x"), 0, EXACT * ground.weight),
            below("vertical stress less the weight above, at most", abs(soil.yy - vertical).max(), tolerance),
        ]
        for n, (elastic_ratio, slope, cohesion) in enumerate(ratios):
            inner = (soil.origin[:, 1] > ground.levels[n]) & (soil.origin[:, 1] < ground.levels[n + 1])
            sideways = elastic_ratio * vertical[inner]
            if slope is not None:
                sideways = np.minimum(sideways, slope * vertical[inner] + 2 * cohesion)
            checks.append(below(f"horizontal stress of layer {n + 1}, error at most", abs(soil.xx[inner] - sideways).max(initial=0), tolerance))
        return checks

    return Scene(ground.section, case, answers, f"gravity, {', '.join(soil['model'] for soil in materials.values())}", ground.order)


def oedometer(soil):
    """The modulus of confined compression [kPa]."""
    young, poisson = soil["young"], soil["poisson"]
    return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
