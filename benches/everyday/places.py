"""The same scene elsewhere: shifted, mirrored, turned, in other units of length and force."""

import copy
from dataclasses import replace

from scene import typed

SAME = 1e-6  # on the same mesh, in the same steps: Newton's method ends at 1e-8 of the forces


def same(name, unit):
    return name, 1.0


def on_same_mesh(scene, tolerance):
    return tolerance if scene.section.regular else max(scene.spread, tolerance)


def scaled(value, factor):
    """A number, a rate, a table, a profile or a range, times a factor."""
    if isinstance(value, list):
        return [entry * factor for entry in value]
    if isinstance(value, dict):
        if "table" in value:
            return {"table": [[time, entry * factor] for time, entry in value["table"]]}
        return {key: scaled(entry, factor) if key in ("rate", "top", "least") else entry for key, entry in value.items()}
    return value * factor


def turned(components, source, keys):
    """Components of a vector in other axes; `source`: {new axis: (old axis, factor)}, `keys`: those of x and y."""
    old = {axis: components[key] for axis, key in zip("xy", keys) if key in components}
    new = {key: entry for key, entry in components.items() if key not in keys}
    for axis, key in zip("xy", keys):
        there, factor = source[axis]
        if there in old:
            new[key] = scaled(old[there], factor)
    return new


def reoriented(scene, place, source, turn):
    """The scene with all places mapped, and the vectors of its case in new axes; `turn`: sign of rotations."""
    case = copy.deepcopy(scene.case)
    case["supports"] = {name: turned(held, source, ("ux", "uy")) for name, held in case.get("supports", {}).items()}
    if "gravity" in case:
        case["gravity"] = turned(case["gravity"], source, "xy")
    for motion in case.get("initial_velocity", {}).values():
        motion["velocity"] = turned(motion["velocity"], source, "xy")
    for phase in case["phases"]:
        phase["tractions"] = [turned(load, source, ("tx", "ty")) for load in phase.get("tractions", [])]
        for load in phase["tractions"]:
            if "where" in load:
                box = turned(load["where"], {axis: (there, 1.0) for axis, (there, _) in source.items()}, "xy")
                load["where"] = {axis: sorted(end * source[axis][1] for end in ends) for axis, ends in box.items()}
        for name, motion in phase.get("prescribe", {}).items():
            motion = turned(motion, source, ("ux", "uy"))
            if "rotation" in motion:
                motion["rotation"] = scaled(motion["rotation"], turn)
            phase["prescribe"][name] = motion
    # The new axis and the factor of a component of old.
    back = {there: (axis, factor) for axis, (there, factor) in source.items()}

    def column(name, unit):
        front, quantity = name.rsplit(".", 1)
        if quantity[-1] in "xy" and quantity[:-1] in ("u", "v", "reaction_", "contact_"):
            axis, factor = back[quantity[-1]]
            return f"{front}.{quantity[:-1]}{axis}", factor
        return name, turn if quantity in ("rotation", "contact_moment") else 1.0

    for entry in case["output"]["history"]:
        names = [column(f"a.{quantity}", "")[0].split(".")[1] for quantity in entry["quantities"]]
        entry["quantities"] = names
    return replace(scene, section=scene.section.moved(place), case=case), column


def shift(dice, scene):
    """The scene elsewhere."""
    extent = scene.section.extent()
    dx = 0.0 if scene.case["geometry"] == "axisymmetric" else typed(extent * dice.uniform(-5, 5))
    dy = typed(extent * dice.uniform(-5, 5))
    case = copy.deepcopy(scene.case)
    for key in ("level", "phreatic_level"):
        if key in case.get("water", {}):
            case["water"][key] += dy
    for load in (load for phase in case["phases"] for load in phase.get("tractions", []) if "where" in load):
        load["where"] = {axis: [end + {"x": dx, "y": dy}[axis] for end in ends] for axis, ends in load["where"].items()}
    for material in case["materials"].values():
        for value in material.values():
            if isinstance(value, dict) and "top" in value:
                value["datum"] = value.get("datum", 0) + dy
    other = replace(scene, section=scene.section.moved(lambda x, y: (x + dx, y + dy)), case=case)
    return other, on_same_mesh(scene, SAME), same


def mirror(dice, scene):
    """The scene from behind."""
    if scene.case["geometry"] != "plane_strain":
        return shift(dice, scene)
    other, column = reoriented(scene, lambda x, y: (-x, y), {"x": ("x", -1.0), "y": ("y", 1.0)}, -1.0)
    # The diagonals of regular triangles are not mirrored.
    return other, on_same_mesh(scene, SAME) if scene.section.quadrangles else scene.spread, column


def turn(dice, scene):
    """The scene turned by 90°, gravity and all."""
    case = scene.case
    if case["geometry"] != "plane_strain" or "initial_stress" in case or "water" in case:
        return shift(dice, scene)
    other, column = reoriented(scene, lambda x, y: (-y, x), {"x": ("y", -1.0), "y": ("x", 1.0)}, 1.0)
    return other, on_same_mesh(scene, SAME), column


LENGTHS = {"level", "phreatic_level", "ux", "uy", "datum", "permeability"}
STRESSES = {"young", "shear_strength", "cohesion", "yield_stress", "tension", "ty", "tx", "pressure", "water_bulk_modulus"}


def units(dice, scene):
    """The scene in other units of length and force, such as mm and N."""
    length = dice.choice([1000.0, 100.0, 3.28084])
    force = dice.choice([1000.0, 0.001, 0.224809, 101.972])
    factors = {name: length for name in LENGTHS} | {name: force / length**2 for name in STRESSES}
    factors |= {"unit_weight": force / length**3, "water_unit_weight": force / length**3, "density": force / length**4}

    def converted(value, key=None):
        if isinstance(value, dict):
            if "gradient" in value:  # of a profile
                return converted({name: entry for name, entry in value.items() if name != "gradient"}, key) | {"gradient": value["gradient"] * factors[key] / length}
            return {name: converted(entry, key if name in ("rate", "table", "top", "least") else name) for name, entry in value.items()}
        if key in factors and isinstance(value, list):
            return [[time, entry * factors[key]] for time, entry in value]
        return value * factors[key] if key in factors else value

    case = copy.deepcopy(scene.case)
    case["materials"] = {name: converted(material) for name, material in case["materials"].items()}
    for material in case["materials"].values():
        if "permeability" in material:
            material["water_unit_weight"] = 9.81 * factors["unit_weight"]
    if "water" in case:
        case["water"] = converted({"unit_weight": 9.81} | case["water"])
    if "gravity" in case:
        case["gravity"] = {axis: entry * length for axis, entry in case["gravity"].items()}
    for motion in case.get("initial_velocity", {}).values():
        motion["velocity"] = {axis: entry * length for axis, entry in motion["velocity"].items()}
    for phase in case["phases"]:
        phase["tractions"] = [converted(load) for load in phase.get("tractions", [])]
        for load in phase["tractions"]:
            if "where" in load:
                load["where"] = {axis: scaled(ends, length) for axis, ends in load["where"].items()}
        phase["prescribe"] = {name: converted(motion) for name, motion in phase.get("prescribe", {}).items()}
    other = replace(scene, section=scene.section.moved(lambda x, y: (x * length, y * length), length), case=case)
    forces = force if case["geometry"] == "axisymmetric" else force / length
    by_unit = {"m": length, "m/s": length, "kN": forces, "kPa": force / length**2, "rad": 1.0, "-": 1.0}
    # Gmsh numbers nodes otherwise in other units, so that cells begin at other corners and have their points elsewhere: forces of two sides that
    # cancel show that.
    return other, on_same_mesh(scene, 10 * SAME), lambda name, unit: (name, 1 / by_unit[unit])
