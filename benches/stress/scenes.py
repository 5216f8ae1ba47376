"""Random scenes for the stability campaign, each wholly determined by the seed and its number.

A class of scenes is a function of a random generator that returns a case; the entries that all share (mesh, kind of cells,
scheme) are drawn here. Sizes are small: a scene takes a second or less, one with a body that goes deep a few.
"""

import math
import random

from schemes import SCHEMES

CLASSES = {}


def kind_of_scene(function):
    CLASSES[function.__name__] = function
    return function


def choose_mesh(r, regular=False):
    """Cells of both orders, triangles and quadrangles, regular and not."""
    kind = r.choice([2, 3]) if regular else r.choice([0, 0, 0, 1, 2, 3])
    order = r.choice([1, 2, 2, 2])
    mesh = {"order": order, "parameters": {"kind": kind, "algorithm": r.choice([5, 6, 8])}}
    if order == 2 and kind in (1, 3) and r.random() < 0.4:
        mesh["incomplete"] = True
    return mesh


def body(r, mesh, width, height, room=None, **material):
    """A case with a body of the size (m) and, with `room` (box width, box height, x, y), empty cells around it."""
    box = room or (width, height, 0, 0)
    mesh["parameters"] |= {"width": width, "height": height, "box_width": box[0], "box_height": box[1], "x": box[2], "y": box[3]}
    mesh["parameters"].setdefault("h", round(r.uniform(0.2, 0.35) * min(width, height), 4))
    mesh["geo"] = "body.geo"
    points = r.choice([3, 6, 7, 12, 4, 9, 16, 16, 16, 25]) if mesh["parameters"]["kind"] in (0, 2) else r.choice([4, 9, 16, 25])
    regions = {"body": {"kind": "mpm", "material": "matter", "points_per_cell": points}}
    if room:
        regions["room"] = {"kind": "buffer"}
    return {
        "geometry": r.choice(["plane_strain", "plane_strain", "axisymmetric"]),
        "mesh": mesh,
        "regions": regions,
        "materials": {"matter": material},
        "output": {"fields": ["mass", "stress", "displacement", "velocity", "deformation_gradient"]},
    }


def poisson(r):
    return r.choice([0, round(r.uniform(0, 0.45), 3), 0.49, 0.499, 0.4999])


def elastic(r, young=None):
    return {"model": "linear_elastic", "young": young or 10 ** r.uniform(1, 6), "poisson": poisson(r), "density": 1.0}


def soil(r, strength, young):
    """A plastic material whose strength (kPa) is about that; friction from 0 to 45 degrees."""
    common = {"young": young, "poisson": poisson(r), "density": 1.0}
    model = r.choice(["tresca", "von_mises", "mohr_coulomb", "mohr_coulomb", "mohr_coulomb"])
    if model == "tresca":
        return {"model": model, "shear_strength": strength, **common}
    if model == "von_mises":
        return {"model": model, "yield_stress": math.sqrt(3) * strength, **common}
    friction = r.choice([0, 0.01, round(r.uniform(1, 45), 2), 45])
    cohesion = strength * r.choice([1, 0.1, 0.01])
    more = {"tension": 0.1 * cohesion} if r.random() < 0.3 else {}
    dilation = friction * r.choice([0, 0, 0.3, 1])
    return {"model": model, "cohesion": cohesion, "friction": friction, "dilation": round(dilation, 3), **more, **common}


def phase(analysis, duration, steps, **more):
    step = {"initial": duration / steps, "min": duration / steps / 30}
    return {"name": "load", "analysis": analysis, "duration": duration, "step": step, **more}


@kind_of_scene
def settle(r):
    """A confined or free body under growing gravity, compressed to 30 % of its height at the most."""
    ratio = r.choice([0.05, 0.5, 1.0, 2.0, 4.0])
    free = ratio <= 0.5 and r.random() < 0.5
    case = body(r, choose_mesh(r), 1, 1, (1.6, 1, 0, 0) if free else None, **elastic(r, 10 / ratio))
    if not free:
        case["materials"]["matter"]["poisson"] = r.choice([0, 0.2])
    case["supports"] = {"lower": {"uy": 0}, "left": {"ux": 0}, **({} if free else {"right": {"ux": 0}})}
    case["gravity"] = {"y": -10}
    case["phases"] = [phase("quasi_static", 1, r.choice([1, 5, 20, 40]), gravity={"rate": 1})]
    return case


@kind_of_scene
def press(r):
    """A body between smooth plates that come together to 30 % of its height; the upper one is a fixed curve of the grid."""
    case = body(r, choose_mesh(r), 1, 1, **elastic(r))
    down = r.uniform(0.2, 0.7)
    case["supports"] = {"lower": {"uy": 0}, "left": {"ux": 0}}
    if case["materials"]["matter"]["poisson"] <= 0.3 and r.random() < 0.5:
        case["supports"]["right"] = {"ux": 0}
    steps = r.choice([10, 20, 40])
    case["phases"] = [phase("quasi_static", 1, steps, prescribe={"head": {"uy": {"rate": -down}}})]
    return case


@kind_of_scene
def shear(r):
    """A block whose upper side moves along, by up to twice its height."""
    matter = soil(r, 10, 1000) if r.random() < 0.5 else elastic(r)
    case = body(r, choose_mesh(r), 2, 1, (6, 1, 1, 0), **matter)
    case["geometry"] = "plane_strain"
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "upper": {"uy": 0}}
    case["phases"] = [phase("quasi_static", 1, 40, prescribe={"head": {"ux": {"rate": r.uniform(0.1, 2)}}})]
    return case


@kind_of_scene
def spin(r):
    """A free elastic body that turns several times."""
    turns, steps = r.choice([0.5, 1, 2, 3]), r.choice([12, 20, 30])
    mesh = choose_mesh(r)
    mesh["parameters"]["h"] = round(r.uniform(0.25, 0.4), 3)
    case = body(r, mesh, 1, 0.7, (2.4, 2.4, 0.7, 0.85), **elastic(r))
    case["geometry"] = "plane_strain"
    # Slow against the speed of sound: it keeps its shape.
    rate = 0.05 * math.sqrt(case["materials"]["matter"]["young"])
    case["initial_velocity"] = {"body": {"gradient": [[0, -rate], [rate, 0]], "centre": {"x": 1.2, "y": 1.2}}}
    duration = 2 * math.pi * turns / rate
    case["numerics"] = {"spectral_radius": r.choice([0, 0.5, 0.9, 1])}
    case["phases"] = [phase("dynamic", duration, max(1, round(steps * turns)))]
    return case


@kind_of_scene
def throw(r):
    """A body thrown against floor and wall, in steps of up to 100 times the time a wave takes through a cell."""
    matter = soil(r, 10 ** r.uniform(0, 2), 10 ** r.uniform(2, 4)) if r.random() < 0.6 else elastic(r)
    case = body(r, choose_mesh(r), 1, 1, (3, 2, 0.5, 0.5), **matter)
    if case["geometry"] == "axisymmetric":
        case["mesh"]["parameters"] |= {"x": 0}
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}, "upper": {"uy": 0}}
    speed = r.uniform(0.5, 3)
    across = 0 if case["geometry"] == "axisymmetric" else speed * r.choice([0, 1])
    case["initial_velocity"] = {"body": {"velocity": {"x": across, "y": -speed}}}
    case["gravity"] = {"y": r.choice([0, -10])}
    wave = case["mesh"]["parameters"]["h"] / math.sqrt(case["materials"]["matter"]["young"])
    step = r.choice([1, 10, 100]) * wave
    steps = min(60, max(4, round(1 / step)))
    case["numerics"] = {"spectral_radius": r.choice([0, 0.5, 0.9, 1])}
    case["phases"] = [phase("dynamic", steps * step, steps)]
    return case


@kind_of_scene
def collapse(r):
    """A block of soil that gravity brings down, slowly (to its limit load) or in motion."""
    strength = 10 ** r.uniform(-1, 1)
    case = body(r, choose_mesh(r), 1, 1, (2.5, 1.2, 0, 0), **soil(r, strength, 100 * 10 ** r.uniform(0, 2)))
    rough = {"ux": 0, "uy": 0} if r.random() < 0.5 else {"uy": 0}
    case["supports"] = {"lower": rough, "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    if r.random() < 0.5:
        case["phases"] = [phase("quasi_static", 1, 20, gravity={"rate": 1})]
    else:
        case["numerics"] = {"spectral_radius": r.choice([0, 0.6, 0.9])}
        case["phases"] = [phase("dynamic", r.choice([0.5, 1.0]), r.choice([10, 30, 60]))]
    return case


@kind_of_scene
def edges(r):
    """A regular lattice of points whose every step ends with points on edges and corners of a regular mesh, or hairs off them."""
    mesh = choose_mesh(r, regular=True)
    mesh["parameters"]["h"] = 0.25
    case = body(r, mesh, 1, 0.5, (2, 1.5, 0.5, 0.5), **elastic(r))
    case["geometry"] = "plane_strain"
    # Equal points lie on multiples of h/12 (triangles) or h/2n (quadrangles).
    points = case["regions"]["body"]["points_per_cell"]
    part = 0.25 / 12 if mesh["parameters"]["kind"] == 2 else 0.25 / (2 * math.isqrt(points))
    off = r.choice([0, 0, 1e-15, 1e-12, 1e-9])
    a, b = r.choice([(1, 0), (0, 1), (1, 1), (-1, 1), (2, 1)])
    case["initial_velocity"] = {"body": {"velocity": {"x": a * part * (1 + off), "y": b * part * (1 - off)}}}
    steps = min(r.choice([8, 11]), math.floor(0.45 / (part * max(abs(a), abs(b)))))
    case["phases"] = [phase("dynamic", steps, steps)]
    return case


@kind_of_scene
def slivers(r):
    """A body shifted over the edge of a cell by a hair, under a little gravity."""
    mesh = choose_mesh(r, regular=r.random() < 0.5)
    mesh["parameters"]["h"] = 0.25
    case = body(r, mesh, 1, 0.5, (2, 1.5, 0.5, 0), **elastic(r, 1000))
    case["geometry"] = "plane_strain"
    hair = r.choice([0.3, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12]) * 0.25
    case["initial_velocity"] = {"body": {"velocity": {"x": hair, "y": hair * r.choice([0, 1])}}}
    settle = phase("quasi_static", 1, 4, gravity={"rate": 1}, prescribe={"head": {"ux": {"rate": 0}}})
    settle["name"] = "settle"
    case["supports"] = {"lower": {"uy": 0}}
    case["gravity"] = {"y": -0.01}
    case["phases"] = [phase("dynamic", 1, 5), settle]
    return case


@kind_of_scene
def footing(r):
    """The head of a block of soil pushed into it, ν up to 0.4999."""
    strength = 10.0
    case = body(r, choose_mesh(r), 0.5, 1, (2, 1, 0, 0), **soil(r, strength, 10000))
    case["regions"]["room"] = {"kind": "mpm", "material": "matter", "points_per_cell": case["regions"]["body"]["points_per_cell"]}
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["phases"] = [phase("quasi_static", 1, 20, prescribe={"head": {"uy": {"rate": -r.choice([0.002, 0.02, 0.05])}}})]
    return case


@kind_of_scene
def contrast(r):
    """Two matters side by side whose stiffnesses differ by up to 10⁶."""
    case = body(r, choose_mesh(r), 0.5, 1, (1.5, 1, 0.5, 0), **elastic(r, 10.0**r.choice([4, 6, 8])))
    case["regions"]["room"] = {"kind": "mpm", "material": "soft", "points_per_cell": case["regions"]["body"]["points_per_cell"]}
    case["materials"]["soft"] = elastic(r, 100)
    case["supports"] = {"lower": {"uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    case["phases"] = [phase("quasi_static", 1, 10, gravity={"rate": 1})]
    if r.random() < 0.4:
        case["phases"] = [phase("dynamic", 0.5, r.choice([5, 20]))]
    return case


@kind_of_scene
def load(r):
    """A body in room whose moving surface is loaded: pressure, shear and tractions, on all of it or in a box."""
    matter = soil(r, 10, 1000) if r.random() < 0.5 else elastic(r, 10 ** r.uniform(2, 4))
    case = body(r, choose_mesh(r), 1, 1, (2.5, 1.6, 0, 0), **matter)
    case["supports"] = {"lower": r.choice([{"uy": 0}, {"ux": 0, "uy": 0}]), "left": {"ux": 0}, "right": {"ux": 0}}
    most = 10 ** r.uniform(-0.5, 1.5)
    loads = {"pressure": {"rate": most}, "ty": {"rate": -most}, "shear": {"rate": r.choice([-0.3, 0.3]) * most}}
    load = {"surface": r.choice(["all", "body"]), **dict(r.sample(sorted(loads.items()), r.choice([1, 2])))}
    if r.random() < 0.6:
        load["where"] = {"x": [-0.1, r.uniform(0.3, 1.2)], "y": [0.5, 1.5]}
    analysis = r.choice(["quasi_static", "quasi_static", "dynamic"])
    case["phases"] = [phase(analysis, 1, r.choice([10, 20, 40]), tractions=[load])]
    return case


@kind_of_scene
def pool(r):
    """A body in a pool that rises or falls, with or without water in its pores up to the same or another level."""
    matter = soil(r, 10 ** r.uniform(0.3, 1.5), 10 ** r.uniform(3, 4)) if r.random() < 0.7 else elastic(r, 10 ** r.uniform(2, 4))
    case = body(r, choose_mesh(r), 1, 1, (2.5, 1.4, 0, 0), **(matter | {"density": 2.0}))
    case["supports"] = {"lower": r.choice([{"uy": 0}, {"ux": 0, "uy": 0}]), "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    if r.random() < 0.5:
        case["initial_stress"] = {"k0": r.uniform(0.3, 1)}
    first, last = r.uniform(-0.5, 2), r.uniform(-0.5, 2)
    case["water"] = {"level": first}
    move = phase(r.choice(["quasi_static", "dynamic"]), 1, r.choice([5, 20]), water_level={"table": [[0, first], [1, last]]})
    if r.random() < 0.5:
        case["water"]["phreatic_level"] = r.choice([first, r.uniform(-0.5, 2)])
        move["phreatic_level"] = r.choice([case["water"]["phreatic_level"], {"table": [[0, case["water"]["phreatic_level"]], [1, last]]}])
    case["phases"] = [phase("quasi_static", 1, 4) | {"name": "rest"}, move]
    return case


@kind_of_scene
def drain(r):
    """Soil whose water flows, or cannot, while weight or a load on its surface squeezes it, and then moves with inertia."""
    matter = soil(r, 10 ** r.uniform(0.5, 2), 10 ** r.uniform(2, 4)) if r.random() < 0.5 else elastic(r, 10 ** r.uniform(2, 4))
    matter["poisson"] = r.choice([0, 0.2, 0.3, 0.49])
    matter |= {"drainage": "undrained", "permeability": r.choice([0, 10 ** r.uniform(-9, -2), {"x": 1e-4, "y": 1e-6}])}
    if r.random() < 0.5:
        matter |= {"porosity": 0.4, "water_bulk_modulus": 10 ** r.uniform(4, 6)}
    free = r.random() < 0.5
    case = body(r, choose_mesh(r), 1, 1, (2, 1.4, 0, 0) if free else (1, 1.4, 0, 0), **matter)
    case["output"]["fields"].append("pore_pressure")
    case["supports"] = {"lower": {"uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["supports"][r.choice(["lower", "left", "right"])]["pore_pressure"] = 0
    case["gravity"] = {"y": -10}
    loads = [{"surface": "body", "pressure": 10 ** r.uniform(-1, 1)}] if r.random() < 0.5 else []
    if r.random() < 0.3:
        case["initial_pore_pressure"] = {"body": r.choice([5, -5, {"top": 0, "gradient": 10, "datum": 1}])}
    steps = r.choice([3, 10])
    case["phases"] = [
        phase("quasi_static", 1, steps, tractions=loads, gravity={"rate": 1}) | {"name": "squeeze"},
        phase("consolidation", 10 ** r.uniform(-2, 6), steps, tractions=loads) | {"name": "wait"},
    ]
    if r.random() < 0.4:
        case["phases"].append(phase("dynamic", 0.2, 10, gravity=r.choice([1, 2])) | {"name": "shake"})
    if r.random() < 0.5:
        case["drained_surface"] = r.choice(["all", "body"])
        if r.random() < 0.5 and "pore_pressure" not in case["supports"]["right"]:
            # What covers the surface does not drain.
            del case["supports"]["right"]
            case["contacts"] = [{"wall": "right", "soil": "body", "friction": r.choice([0, 0.3])}]
    return case


@kind_of_scene
def stages(r):
    """Soil under its weight, then with another material, on a wall that is taken away, with its strength reduced, or left to fall."""
    strength = 10 ** r.uniform(0.9, 2)
    case = body(r, choose_mesh(r), 1, 1, (2.5, 1.4, 0, 0), **soil(r, strength, 10 ** r.uniform(3, 4)))
    case["supports"] = {"lower": {"uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    case["materials"]["other"] = soil(r, strength * 10 ** r.uniform(-0.7, 0.7), 10 ** r.uniform(2, 5))
    rest = phase("quasi_static", 1, 10, gravity={"rate": 1}) | {"name": "rest"}
    kinds = {
        "reduce": phase("strength_reduction", 1, 10),
        "change": phase(r.choice(["quasi_static", "dynamic"]), 1, 10, materials={"body": "other"}),
        "auto": phase("auto", 2, 20, gravity={"table": [[0, 1], [1, 10 ** r.uniform(0, 1)]]}),
        "weaken": phase("dynamic", 1, 20, strength_reduction=r.uniform(1, 5), reset_displacements=True),
    }
    if r.random() < 0.4:
        if r.random() < 0.5:
            # All of the weight is there from the first step on.
            case["initial_stress"], rest["gravity"] = {"k0": 0.5}, 1
        case["contacts"] = [{"wall": "lower", "soil": "body", "friction": r.choice([0, 0.5])}]
        del case["supports"]["lower"]
        kinds["drop"] = phase("dynamic", 0.3, 10, deactivate=["lower"])
    names = r.sample(sorted(kinds), 2)
    # The search ends when it has found what it looks for: it comes last, so that the time of the end is known.
    names.sort(key=lambda name: name == "reduce")
    case["phases"] = [rest] + [kinds[name] | {"name": name} for name in names]
    return case


@kind_of_scene
def brittle(r):
    """Soil that softens as it shears, and is stronger where it shears fast, pressed, pulled along or brought down."""
    more = {"rate": r.uniform(0, 0.2), "reference_rate": 10 ** r.uniform(-6, -1)} if r.random() < 0.5 else {}
    strength = 10 ** r.uniform(0, 1.3)
    matter = {"model": "tresca_softening", "young": strength * 10 ** r.uniform(1.5, 2.7), "poisson": poisson(r), "density": 1.0}
    matter |= {"shear_strength": strength, "remoulded": r.uniform(0.05, 1), "ductility": 10 ** r.uniform(-1, 1.5), **more}
    case = body(r, choose_mesh(r), 1, 1, (2.5, 1, 0, 0), **matter)
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    kind = r.choice(["press", "along", "fall"])
    if kind == "fall":
        case["gravity"] = {"y": -10}
        analysis = r.choice(["quasi_static", "dynamic"])
        case["phases"] = [phase(analysis, 1, 20, gravity={"rate": r.uniform(1, 3)})]
    else:
        motion = {"uy": {"rate": -r.uniform(0.05, 0.4)}} if kind == "press" else {"ux": {"rate": r.uniform(0.1, 1)}}
        case["phases"] = [phase("quasi_static", 1, 20, prescribe={"head": motion})]
    return case


@kind_of_scene
def clay(r):
    """Modified Cam-Clay, half of it with κ*, over- and normally consolidated, drained and not, from K0 or no stress; pressed, pulled along or under its weight."""
    pressure = 10 ** r.uniform(0.5, 2)
    matter = {"model": "cam_clay", "young": pressure * 10 ** r.uniform(1, 2.5), "poisson": r.choice([0, 0.2, 0.3]), "density": 2.0}
    matter |= {"critical_slope": r.uniform(0.5, 1.5), "preconsolidation": pressure, "plastic_compressibility": r.uniform(0.02, 0.3)}
    kind = r.choice(["press", "along", "weight"])
    if r.random() < 0.4:
        matter |= {"drainage": "undrained", **r.choice([{}, {"permeability": 1e-6}])}
    case = body(r, choose_mesh(r), 1, 1, None if kind == "press" else (2.5, 1, 0, 0), **matter)
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    case["initial_stress"] = {"k0": r.uniform(0.4, 1)}
    motion = {"press": {"uy": {"rate": -r.uniform(0.02, 0.3)}}, "along": {"ux": {"rate": r.uniform(0.02, 0.5)}}}
    if kind == "weight":
        analysis = r.choice(["quasi_static", "dynamic"])
        case["phases"] = [phase(analysis, 1, 20, gravity={"table": [[0, 1], [1, r.uniform(0, 5)]]})]
    else:
        case["phases"] = [phase("quasi_static", 1, 20, prescribe={"head": motion[kind]})]
    if r.random() < 0.5:
        del case["materials"]["matter"]["young"]
        case["materials"]["matter"] |= {"swelling": 10 ** r.uniform(-3, -1.3), "least_pressure": r.choice([0.1, 1])}
        if r.random() < 0.3:
            del case["initial_stress"]
    return case


def undrained(r, strength, growth=0.0, model=None, **more):
    """Undrained clay of the strength (kPa) at the surface, which grows by `growth` (kPa/m) with the depth."""
    stiffness = r.choice([50, 200, 500])
    model = model or r.choice(["tresca", "tresca", "von_mises"])
    factor = math.sqrt(3) if model == "von_mises" else 1

    def profile(scale):
        return {"top": scale * strength, "gradient": scale * growth, "datum": 0} if growth else scale * strength

    name = "yield_stress" if model == "von_mises" else "shear_strength"
    common = {"young": profile(stiffness), "poisson": r.choice([0.49, 0.49, 0.49, 0.499, 0.45]), "density": 0.6}
    return {"model": model, name: profile(factor), **common, **more}


def interface(r, strength):
    """What acts between the body and the clay: nothing, friction, adhesion; they part, do not, or do at a tension."""
    shear = r.choice(
        [
            {},
            {"friction": round(r.uniform(0.1, 0.6), 2)},
            {"adhesion": round(r.uniform(0.2, 1) * strength, 3)},
            {"adhesion_factor": r.choice([0.3, 0.5, 0.7])},
            {"adhesion_factor": 1},
            {"friction": 0.3, "adhesion_factor": 0.5},
        ]
    )
    return {**shear, "tension": r.choice(["cut_off", "cut_off", "no_separation", "no_separation", {"limit": round(r.uniform(0.5, 5) * strength, 3)}])}


def ground(r, shape, way, **more):
    """Level clay, half of it heavy, and a rigid body one metre wide of the shape of ground.geo, which is to go `way` (m)."""
    mesh = choose_mesh(r)
    h = r.choice([0.2, 0.25, 0.25])
    sizes = {"width": 2, "depth": way + 1.25, "air": 0.5 + 0.3 * way, "cover": 1, "thickness": h, "layer": 0, **more}
    lengths = {name: round(h * math.ceil(size / h - 1e-9), 4) for name, size in sizes.items() if name != "buried"}
    if shape == 3:
        lengths["thickness"] = round(r.uniform(0.3, 1) * h, 3)
    angle = r.choice([30, 60, 60, 90, 120])
    if sizes.get("buried"):
        lengths["depth"] = round(lengths["cover"] + 1.25 + (1 if shape == 0 else 2 * h), 4)
        if shape == 0:
            mesh["parameters"]["kind"] %= 2
    mesh["parameters"] |= {"shape": shape, "way": way, "angle": angle, "h": h, "coarse": r.choice([1, 2, 3]), **sizes, **lengths}
    mesh["geo"] = "ground.geo"
    strength = 10 ** r.uniform(0.3, 1.5)
    growth = strength * r.choice([0, 0, 0.5, 2])
    points = r.choice([3, 6, 7, 12, 4, 9, 16, 16, 16]) if mesh["parameters"]["kind"] in (0, 2) else r.choice([4, 9, 16, 16])
    case = {
        "geometry": r.choice(["plane_strain", "axisymmetric"]),
        "mesh": mesh,
        "regions": {
            "clay": {"kind": "mpm", "material": "clay", "points_per_cell": points},
            "air": {"kind": "buffer"},
            "body": {"kind": "structure", "material": "steel", "rigid": True},
        },
        "materials": {
            "clay": undrained(r, strength, growth),
            "steel": {"model": "linear_elastic", "young": 2e8, "poisson": 0.2, "density": 7.8},
        },
        "contacts": [{"structure": "body", "soil": "clay", **interface(r, strength)}],
        "supports": {"axis": {"ux": 0}, "side": {"ux": 0}, "bottom": {"ux": 0, "uy": 0}},
        "output": {
            "fields": ["mass", "stress", "displacement", "velocity", "deformation_gradient"],
            "history": [{"name": "body", "on": "body", "quantities": ["uy", "reaction_y", "contact_y"]}],
        },
    }
    if sizes.get("buried"):
        case["regions"]["hole"] = {"kind": "buffer"}
    if r.random() < 0.6:
        case["gravity"] = {"y": -10}
        case["initial_stress"] = {"k0": 1}
    return case, strength, growth


def move(r, case, way, name="push", analysis=None):
    """The body moves up by `way` (m), without inertia or, with it, by 0.3 to 3 m/s; in steps of a fifth of a cell or two."""
    analysis = analysis or r.choice(["quasi_static"] * 5 + ["dynamic"])
    speed = 10 ** r.uniform(-0.5, 0.5) if analysis == "dynamic" else 1.0
    step = r.choice([0.2, 0.4]) * case["mesh"]["parameters"]["h"] / speed
    plane = {} if case["geometry"] == "axisymmetric" else {"ux": 0, "rotation": 0}
    return {
        "name": name,
        "analysis": analysis,
        "duration": abs(way) / speed,
        "step": {"initial": step / 4, "min": step / 30, "max": step},
        "prescribe": {"body": {**plane, "uy": {"rate": math.copysign(speed, way)}}},
    }


def penetrate(r, shape):
    way = r.choice([0.5, 1, 1, 1.5])
    case, _, _ = ground(r, shape, way)
    case["phases"] = [move(r, case, -way)]
    return case


@kind_of_scene
def round_body(r):
    """A rigid bar or ball pushed 0.5 to 1.5 times its width into clay."""
    return penetrate(r, 0)


@kind_of_scene
def flat_body(r):
    """The same of a flat strip or disc with a shaft."""
    return penetrate(r, 1)


@kind_of_scene
def pointed_body(r):
    """The same of a wedge or cone of 30 to 120° with a shaft."""
    return penetrate(r, 2)


@kind_of_scene
def thin_body(r):
    """The same of two sheets or a tube, 0.3 to 1 cell thick."""
    return penetrate(r, 3)


@kind_of_scene
def layers(r):
    """The same of all these shapes into clay upon clay of 0.2 to 5 times its strength."""
    way = r.choice([0.5, 1])
    case, strength, _ = ground(r, r.randrange(4), way, layer=r.choice([0.25, 0.5, 1]))
    case["regions"]["lower"] = {**case["regions"]["clay"], "material": "lower"}
    case["materials"]["lower"] = undrained(r, strength * r.choice([0.2, 0.5, 2, 5]))
    case["contacts"][0]["soil"] = ["clay", "lower"]
    case["phases"] = [move(r, case, -way)]
    return case


@kind_of_scene
def sensitive(r):
    """The same into clay that softens as it shears to a third to a twentieth of its strength, and is stronger where it shears fast."""
    way = r.choice([0.5, 1])
    case, strength, growth = ground(r, r.randrange(4), way)
    more = {"remoulded": r.choice([0.05, 0.1, 0.2, 0.33]), "ductility": 10 ** r.uniform(-0.5, 1.5)}
    if r.random() < 0.4:
        more |= {"rate": r.uniform(0.02, 0.2), "reference_rate": 10 ** r.uniform(-6, -1)}
    case["materials"]["clay"] = undrained(r, strength, growth, model="tresca_softening", **more)
    case["phases"] = [move(r, case, -way)]
    return case


@kind_of_scene
def pull_out(r):
    """A buried plate or bar, round or not, bonded to the clay or parting from it, pulled upwards, some until it is out, or pushed down."""
    way, cover = r.choice([0.25, 0.5]), r.choice([0.5, 1])
    shape = r.choice([0, 1, 1])
    if r.random() < 0.2:
        way = cover + 0.75
    case, _, _ = ground(r, shape, way, buried=1, cover=cover, air=0.5 + max(0, way - cover + 0.5))
    case["phases"] = [move(r, case, way if r.random() < 0.8 else -min(way, 0.5), "pull")]
    return case


@kind_of_scene
def back(r):
    """A body of any of these shapes pushed in, pulled back or out, and pushed in again."""
    way = r.choice([0.25, 0.5])
    case, _, _ = ground(r, r.randrange(4), way)
    up = way * r.choice([0.1, 0.5, 1, 1.2])
    analysis = "quasi_static"
    case["phases"] = [move(r, case, -way, "push", analysis), move(r, case, up, "pull", analysis), move(r, case, -up, "again", analysis)]
    return case


@kind_of_scene
def sand(r):
    """A column of dry sand without cohesion, φ from 20 to 45°, that falls and runs out to rest, over two to four times the time of its fall."""
    height = r.choice([0.5, 1, 1, 2])
    friction = round(r.uniform(20, 45), 1)
    matter = {"model": "mohr_coulomb", "cohesion": 0, "friction": friction, "dilation": r.choice([0, 0, 0, 5])}
    matter |= {"young": 20 * height * 10 ** r.uniform(1.5, 3), "poisson": r.choice([0.2, 0.3]), "density": 2.0}
    case = body(r, choose_mesh(r), 1, height, (2 + 2 * height, 1.2 * height, 0, 0), **matter)
    case["mesh"]["parameters"]["h"] = round(r.uniform(0.15, 0.3) * min(1, height), 3)
    case["supports"] = {"lower": {"ux": 0, "uy": 0}, "left": {"ux": 0}, "right": {"ux": 0}}
    case["gravity"] = {"y": -10}
    if r.random() < 0.8:
        case["initial_stress"] = {"k0": round(1 - math.sin(math.radians(friction)), 3)}
    if r.random() < 0.2:
        # The floor is a rigid wall.
        case["supports"].pop("lower")
        case["contacts"] = [{"wall": "lower", "soil": "body", "friction": r.choice([0.2, 0.5])}]
    fall = math.sqrt(2 * height / 10)
    case["phases"] = [phase("dynamic", r.choice([2, 3, 4]) * fall, r.choice([60, 100])) | {"name": "fall"}]
    if r.random() < 0.4:
        case["phases"].append(phase("quasi_static", 1, 2) | {"name": "rest"})
    return case


def scene(seed, number, schemes=None):
    """Class, scheme and case of scene `number`; classes and schemes take turns."""
    r = random.Random(f"{seed} {number}")
    names = list(CLASSES)
    name = names[number % len(names)]
    case = CLASSES[name](r)
    schemes = schemes or SCHEMES
    scheme = schemes[(number // len(names) + number) % len(schemes)]
    case["numerics"] = {**case.get("numerics", {}), **dict(scheme.numerics)}
    if scheme.grid:
        # Regular quadrilaterals of the order that the scheme is for.
        case["mesh"]["order"] = dict(scheme.grid)["mesh.order"]
        case["mesh"].pop("incomplete", None)
        case["mesh"]["parameters"]["kind"] = 3
    if scheme.first:
        # Domains and squares are of equal points.
        for region in case["regions"].values():
            if region.get("points_per_cell") in (3, 6, 7, 12):
                region["points_per_cell"] = 16
    case["title"] = f"Stability campaign, seed {seed}, scene {number}: {name}, {scheme.name}"
    return name, scheme.name, case
