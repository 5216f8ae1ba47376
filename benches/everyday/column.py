"""Columns of soil that cannot move sideways, at large strain: by load, by a rigid plate, by a curve, under their weight.

Hencky's elasticity: the Cauchy stress at the stretch λ is M ln λ/λ, M the oedometer modulus, and the horizontal one ν/(1 − ν) of it
(docs/theory.md, 9). Under the weight alone λ = W(q)/q, q = γZ/M, W of Lambert (tests/analytical/self_weight_column.rs).
"""

import math

import numpy as np
from geometry import Face, Section, box
from ground import G, oedometer
from scene import Scene, below, near, typed

RESTORE = ["every_step", "never", {"min_quality": 0.5}]


def stretch(stress, modulus):
    """λ where M ln λ/λ is a stress, compression negative.

    >>> round(stretch(-100 * math.log(2) * 2, 100), 12)
    0.5
    """
    ratio, value = stress / modulus, 1.0
    for _ in range(60):
        value -= (math.log(value) - ratio * value) / (1 / value - ratio)
    return value


class Column:
    """Soil of one layer below air, in a section whose sides hold it."""

    def __init__(self, dice, kinds=("mpm",)):
        self.height = dice.scale(0.3, 10)
        self.width = round(self.height * dice.uniform(0.3, 1.5), 3)
        self.h = self.height / dice.randint(4, 8)
        self.room = typed(dice.number(0.3, 0.6, 2) * self.height)
        self.left = 0.0 if dice.chance(0.5) else dice.number(-5, 5)
        right = self.left + self.width
        top = self.height
        faces = [Face("soil", box(self.left, right, 0, top), self.h), Face("air", box(self.left, right, top, top + self.room), self.h)]
        curves = {
            "bottom": [((self.left, 0), (right, 0))],
            "sides": [((x, 0), (x, top + self.room)) for x in (self.left, right)],
            "top": [((self.left, top), (right, top))],
        }
        self.section = Section(faces, curves, quadrangles=dice.chance(0.4), regular=dice.chance(0.4))
        self.order = 1 if dice.chance(0.25) else 2
        self.soil = {"model": "linear_elastic", "young": dice.scale(100, 50000), "poisson": dice.number(0, 0.4, 2), "density": 0}
        self.modulus = oedometer(self.soil)
        self.axisymmetric = self.left == 0 and dice.chance(0.25)
        self.area = math.pi * self.width**2 if self.axisymmetric else self.width
        self.restore = dice.choice(RESTORE)
        self.case = {
            "geometry": "axisymmetric" if self.axisymmetric else "plane_strain",
            "regions": {"soil": {"kind": dice.choice(kinds), "material": "soil"}, "air": {"kind": "buffer"}},
            "materials": {"soil": self.soil},
            "supports": {"bottom": {"uy": 0}, "sides": {"ux": 0}},
            "numerics": {"restore": self.restore},
            "output": {
                "history": [
                    {"name": "soil", "on": "soil", "quantities": ["uy"]},
                    {"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]},
                    {"name": "sides", "on": "sides", "quantities": ["reaction_x"]},
                ]
            },
        }
        # Of second order a linear displacement is exact; what is lost is at resets and on the moving surface: 5e-3 (docs/numerics.md,
        # loads on the surface). Of first order the surface within cells is as uncertain as a tenth of a cell.
        self.tolerance = 0.01 if self.order == 2 else 0.1 * self.h / self.height + 0.01

    def uniform(self, result, stress):
        """Checks of a uniform state of a vertical stress (compression negative)."""
        soil = result.soil
        side = self.soil["poisson"] / (1 - self.soil["poisson"])
        squeezed = self.height * (1 - stretch(stress, self.modulus))
        slack = abs(stress) * self.tolerance
        return [
            near("force of the base", result.last("bottom.reaction_y"), -stress * self.area, slack * self.area),
            near("mean vertical stress", soil.yy.mean(), stress, slack),
            below("vertical stress, error at most", abs(soil.yy - stress).max(), 5 * slack),
            below("horizontal stress, error at most", abs(soil.xx - side * stress).max(), 5 * slack),
            near("mean settlement", -result.last("soil.uy"), squeezed / 2, self.tolerance * squeezed),
        ]

    def scene(self, answers, about):
        return Scene(self.section, self.case, answers, f"{about}, restore {self.restore}", self.order)


def load(dice):
    """Oedometer by a load on the surface: the stress is the load, the settlement that of Hencky's elasticity."""
    column = Column(dice)
    pressure = typed(column.modulus * dice.scale(0.01, 0.25))
    steps = dice.choice([5, 10, 20])
    if column.restore == "never":
        traction = {"on": "top", "ty": {"rate": -pressure}}
    else:
        traction = dice.choice([{"surface": "all", "ty": {"rate": -pressure}}, {"surface": "soil", "pressure": {"rate": pressure}}, {"surface": "all", "ty": {"table": [[0, 0], [1, -pressure]]}}])
    column.case["phases"] = [{"name": "load", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1 / steps}, "tractions": [traction]}]
    return column.scene(lambda result: column.uniform(result, -pressure), f"load of {pressure / column.modulus:.2g} M")


def plate(dice):
    """Oedometer by a rigid plate: its force is M ln λ/λ, at any strain."""
    column = Column(dice, ("mpm", "mpm", "fem"))
    right = column.left + column.width
    thickness = 0.25 * column.room
    column.section.faces.append(Face("plate", box(column.left, right, column.height, column.height + thickness), column.h, structure=True))
    way = dice.number(0.02, 0.35, 2) * column.height
    steps = max(5, math.ceil(6 * way / column.h))
    contact = {"structure": "plate", "soil": "soil"}
    if column.case["regions"]["soil"]["kind"] == "fem":
        contact = {"structure": "plate", "against": "soil"}
    elif dice.chance(0.2):
        contact.pop("soil")
    if dice.chance(0.4):
        contact["friction"] = 0.3
    column.case |= {
        "regions": column.case["regions"] | {"plate": {"kind": "structure", "material": "steel", "rigid": True}},
        "materials": column.case["materials"] | {"steel": {"model": "linear_elastic", "young": 2.0e8, "poisson": 0.3, "density": 0}},
        "contacts": [contact],
        "phases": [{"name": "press", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1 / steps}, "prescribe": {"plate": {"ux": 0, "uy": {"rate": -way}, "rotation": 0}}}],
    }
    if column.axisymmetric:
        column.case["phases"][0]["prescribe"] = {"plate": {"uy": {"rate": -way}}}
    column.case["output"]["history"].append({"name": "plate", "on": "plate", "quantities": ["uy", "contact_y"]})
    value = 1 - way / column.height
    stress = column.modulus * math.log(value) / value

    def answers(result):
        force = -stress * column.area
        return [near("force of the plate", result.last("plate.contact_y"), force, column.tolerance * force), *column.uniform(result, stress)]

    return column.scene(answers, f"plate to {value:.2f} of the height")


def curve(dice):
    """Oedometer by a prescribed curve of the soil: the same, or refused."""
    column = Column(dice, ("mpm", "fem"))
    way = dice.number(0.02, 0.4, 2) * column.height
    column.case["phases"] = [{"name": "press", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.05}, "prescribe": {"top": {"uy": {"rate": -way}}}}]
    column.case["output"]["history"].append({"name": "top", "on": "top", "quantities": ["uy", "reaction_y"]})
    value = 1 - way / column.height
    stress = column.modulus * math.log(value) / value

    def answers(result):
        force = stress * column.area
        return [near("force of the curve", result.last("top.reaction_y"), force, column.tolerance * -force), *column.uniform(result, stress)]

    return column.scene(answers, f"curve to {value:.2f} of the height")


def self_weight(dice):
    """A column under its own weight, compressed to 60 % at the most: stress γZ, settlement by Lambert's function."""
    column = Column(dice)
    ratio = dice.scale(0.01, 1)
    weight = typed(ratio * column.modulus / column.height)
    column.soil.pop("density")
    column.soil["unit_weight"] = weight
    steps = dice.choice([10, 20])
    column.case |= {
        "gravity": {"y": -G},
        "phases": [{"name": "gravity", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1 / steps}, "gravity": {"rate": 1}}],
    }

    def answers(result):
        soil = result.soil
        most = weight * column.height
        depths = (np.arange(2000) + 0.5) / 2000 * column.height
        stretches = np.array([stretch(-weight * depth, column.modulus) for depth in depths])
        # The mean displacement of the points, weighted by their volumes, is that over the height.
        moved = np.cumsum(((1 - stretches) * column.height / 2000)[::-1])[::-1]
        error = abs(soil.yy + weight * (column.height - soil.origin[:, 1]))
        # Of first order a cell has the mean of its stress, a quarter of its weight off on average. At an axis the errors of triangles
        # are larger (docs/numerics.md, known weaknesses).
        slack = 0.005 if column.order == 2 else 0.3 * column.h / column.height + 0.005
        return [
            near("force of the base", result.last("bottom.reaction_y"), most * column.area, 1e-5 * most * column.area),
            below("vertical stress, mean error", error.mean(), slack * most),
            below("vertical stress, error at most", error.max(), (12 if column.axisymmetric else 6) * slack * most),
            near("mean settlement", -result.last("soil.uy"), moved.mean(), slack * moved.mean() * 2),
        ]

    return column.scene(answers, f"weight of {ratio:.2g} M")


def undrained(dice):
    """A load on undrained clay that cannot move sideways: the water bears K_w/n over M + K_w/n of it, the volume hardly changes."""
    column = Column(dice)
    soil = column.soil
    soil["drainage"] = "undrained"
    young, poisson = soil["young"], soil["poisson"]
    if dice.chance(0.5):
        soil["undrained_poisson"] = of_both = dice.choice([0.49, 0.495, 0.499])
        shear = young / (2 * (1 + poisson))
        water = 2 * shear * ((1 + of_both) / (3 * (1 - 2 * of_both)) - (1 + poisson) / (3 * (1 - 2 * poisson)))
    else:
        soil |= {"porosity": dice.number(0.3, 0.6, 2), "water_bulk_modulus": typed(young * dice.scale(20, 300))}
        water = soil["water_bulk_modulus"] / soil["porosity"]
    whole = column.modulus + water
    pressure = typed(column.modulus * dice.scale(0.01, 0.1))
    column.case["numerics"] = {"restore": dice.choice(["every_step", {"min_quality": 0.5}])}
    column.case["phases"] = [{"name": "load", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.2}, "tractions": [{"surface": "all", "ty": {"rate": -pressure}}]}]
    column.case["output"]["fields"] = ["stress", "displacement", "pore_pressure"]

    def answers(result):
        soil = result.soil
        # The strain, of which the closed form is linear; and what is lost on the moving surface.
        slack = 5 * column.tolerance * pressure
        strain = pressure / whole
        settled = strain * column.height / 2
        return [
            near("force of the base", result.last("bottom.reaction_y"), pressure * column.area, 0.2 * slack * column.area),
            below("excess pore pressure, error at most", abs(soil.pore_pressure - water / whole * pressure).max(), slack),
            below("vertical effective stress, error at most", abs(soil.yy + column.modulus / whole * pressure).max(), slack),
            near("mean settlement", -result.last("soil.uy"), settled, (0.02 + 2 * strain + column.tolerance) * settled + 1e-5 * column.height),
        ]

    return column.scene(answers, f"load of {pressure / column.modulus:.2g} M, K_w/n {water / column.modulus:.2g} M")


def strip_load(dice):
    """A load on a part of the surface of elastic ground: the base bears all of it."""
    width, depth = dice.scale(2, 20), dice.scale(1, 10)
    h = typed(math.sqrt(width * depth) * dice.uniform(0.08, 0.15))
    axisymmetric = dice.chance(0.3)
    left = 0.0 if axisymmetric else dice.number(-5, 5)
    start = left + (0.0 if axisymmetric else typed(dice.uniform(0.1, 0.5) * width))
    end = start + typed(dice.uniform(0.1, 0.4) * width)
    soil = {"model": "linear_elastic", "young": dice.scale(1000, 50000), "poisson": dice.number(0, 0.45, 2), "density": 0}
    pressure = typed(soil["young"] * dice.scale(0.0003, 0.03))
    roof = 3 * h
    section = Section(
        [Face("soil", box(left, left + width, -depth, 0), h), Face("air", box(left, left + width, 0, roof), h)],
        {"bottom": [((left, -depth), (left + width, -depth))], "sides": [((x, -depth), (x, roof)) for x in (left, left + width)]},
        quadrangles=dice.chance(0.3),
    )
    load = {"surface": dice.choice(["all", "soil"]), "where": {"x": [start - (1 if axisymmetric else 0), end]}}
    load |= dice.choice([{"ty": {"rate": -pressure}}, {"pressure": {"rate": pressure}}])
    # Boxes are drawn around the surface, some of them closely.
    if dice.chance(0.7):
        load["where"]["y"] = [-h, h]
    case = {
        "geometry": "axisymmetric" if axisymmetric else "plane_strain",
        "regions": {"soil": {"kind": "mpm", "material": "soil"}, "air": {"kind": "buffer"}},
        "materials": {"soil": soil},
        "supports": {"bottom": {"ux": 0, "uy": 0}, "sides": {"ux": 0}},
        "phases": [{"name": "load", "analysis": "quasi_static", "duration": 1, "step": {"initial": 0.2}, "tractions": [load]}],
        "output": {"history": [{"name": "bottom", "on": "bottom", "quantities": ["reaction_y"]}]},
    }
    area = math.pi * end**2 if axisymmetric else end - start

    def answers(result):
        # The box is fixed in space: soil beneath its edges moves by some of the settlement, and the surface tilts.
        slack = 0.01 + 5 * pressure / soil["young"]
        return [near("force of the base over that of the load", result.last("bottom.reaction_y") / (pressure * area), 1, slack)]

    return Scene(section, case, answers, f"{'circle' if axisymmetric else 'strip'}, q/E {pressure / soil['young']:.2g}", 1 if dice.chance(0.2) else 2)
