"""The same scene in another way: shifted, mirrored, turned, in other units, split, on another mesh, resumed, with more threads.

The histories of both must agree. A column may differ by a part of the largest value of its unit, as `SAME` and `spread` say.
"""

import copy
from dataclasses import replace

from geometry import Face, clipped
from places import SAME, mirror, on_same_mesh, same, shift, turn, units
from scene import Check, typed

EMPTY = 1e-3  # empty cells have 1e-5 of the stiffness of the soil (docs/reference/numerics.md), and some of them are stretched far


def instrumented(scene):
    """The scene with all of its soil, and all that holds it, in its history."""
    scene = replace(scene, case=copy.deepcopy(scene.case))
    history = scene.case.setdefault("output", {}).setdefault("history", [])
    names = {entry["name"] for entry in history}
    axes = "xy" if scene.case["geometry"] == "plane_strain" else "y"
    for name, region in scene.case["regions"].items():
        if region["kind"] in ("mpm", "fem") and f"all of {name}" not in names:
            history.append({"name": f"all of {name}", "on": name, "quantities": [f"u{axis}" for axis in axes]})
    for name, held in scene.case.get("supports", {}).items():
        if name in scene.section.curves:
            history.append({"name": f"holds {name}", "on": name, "quantities": [f"reaction_{axis}" for axis in "xy" if f"u{axis}" in held]})
    return scene


def compared(result, other, tolerance, column):
    """Checks of the last row of two histories; `column(name, unit)` has the name in the other one, or none, and the factor from it."""
    units = {name: unit for name, unit in result.units.items() if name != "time" and (unit == "kN" or result.scene.unique)}
    largest = dict(result.scene.least)
    for name, unit in units.items():
        largest[unit] = max(largest.get(unit, 0.0), abs(result.history[name]).max())
    checks = []
    for name, unit in units.items():
        theirs, factor = column(name, unit)
        if theirs is None or largest[unit] < 1e-12:
            continue
        found = other.last(theirs) * factor / largest[unit]
        here = result.last(name) / largest[unit]
        checks.append(Check(f"{theirs} of the other over the largest of its kind", found, here - tolerance, here + tolerance))
    return checks


def split_region(dice, scene):
    """A region parted in two of the same soil, its new name at times forgotten in a contact."""
    section = scene.section
    fields = [face for face in section.faces if scene.case["regions"][face.name]["kind"] in ("mpm", "fem")]
    face = dice.choice(fields)
    coordinate = dice.choice([0, 1])
    ends = [corner[coordinate] for corner in face.corners]
    limit = typed(min(ends) + dice.uniform(0.35, 0.65) * (max(ends) - min(ends)), 4)
    name = f"{face.name} b"
    h = min(face.sizes())
    parts = [Face(of, clipped(face.corners, coordinate, limit, above), h) for of, above in ((face.name, False), (name, True))]
    faces = [part for one in section.faces for part in (parts if one is face else [one])]
    case = copy.deepcopy(scene.case)
    case["regions"][name] = case["regions"][face.name]
    for contact in list(case.get("contacts", [])):
        soils = contact.get("soil", [])
        soils = [soils] if isinstance(soils, str) else soils
        # One forgets the new name in a contact: the result must be the same, or the program says so.
        if dice.chance(0.2):
            continue
        if face.name in soils:
            contact["soil"] = [*soils, name]
        elif contact.get("against") == face.name:
            case["contacts"].append({**contact, "against": name})
    if face.name in case.get("initial_velocity", {}):
        case["initial_velocity"][name] = case["initial_velocity"][face.name]
    if case.get("drained_surface") == face.name:
        case["drained_surface"] = "all"
    for phase in case["phases"]:
        loads = phase.get("tractions", [])
        phase["tractions"] = [*loads, *({**load, "surface": name} for load in loads if load.get("surface") == face.name)]
    # What is of the region as a whole has no counterpart.
    of_region = {entry["name"] for entry in case["output"]["history"] if entry["on"] == face.name}
    other = replace(scene, section=replace(section, faces=faces, regular=False), case=case)
    return other, scene.spread, lambda column, unit: (None if column.rsplit(".", 1)[0] in of_region else column, 1.0)


def later(value, time):
    """A value in time from a later time on, where it began at 0."""
    if isinstance(value, dict) and "rate" in value:
        return {"table": [[0, value["rate"] * time], [1e6, value["rate"] * (time + 1e6)]]}
    if isinstance(value, dict) and "table" in value:
        (t0, a), (t1, b) = value["table"]
        return {"table": [[0, a + (b - a) * (time - t0) / (t1 - t0)], [t1 - time, b]]}
    return value


def split_phase(dice, scene):
    """The last phase parted in two."""
    case = copy.deepcopy(scene.case)
    whole = case["phases"].pop()
    count = round(whole["duration"] / whole["step"]["initial"])
    part = max(1, round(count * dice.uniform(0.3, 0.7))) / count * whole["duration"]
    if count < 2:
        part = whole["duration"] / 2
    first, second = copy.deepcopy(whole) | {"duration": part}, copy.deepcopy(whole) | {"duration": whole["duration"] - part, "name": "goes on"}
    if "gravity" in whole:
        second["gravity"] = later(whole["gravity"], part)
    for load in second.get("tractions", []):
        for key in ("tx", "ty", "pressure"):
            if key in load:
                load[key] = later(load[key], part)
    # Displacements count from the beginning of a phase: a rate goes on. A phase begins without an extrapolation, its first step from
    # other start values: what differs is the tolerance of Newton's method, and what contact leaves.
    case["phases"] += [first, second]
    follows = count >= 2 and scene.unique
    return replace(scene, case=case), (SAME if "contacts" not in case else 1e-4) if follows else scene.spread, same


def ended(value, time):
    """The last value of one in time."""
    if isinstance(value, dict) and "rate" in value:
        return value["rate"] * time
    return value["table"][-1][1] if isinstance(value, dict) and "table" in value else value


def hold(dice, scene):
    """A phase more, in which nothing changes."""
    case = copy.deepcopy(scene.case)
    last = case["phases"][-1]
    still = copy.deepcopy(last) | {"name": "hold", "duration": 1, "step": {"initial": 0.5}}
    if "gravity" in still and dice.chance(0.5):
        # What one writes who thinks of it as of a value; and what one forgets.
        still["gravity"] = ended(still["gravity"], last["duration"])
    else:
        still.pop("gravity", None)
    for load in still.get("tractions", []):
        for key in ("tx", "ty", "pressure"):
            if key in load:
                load[key] = ended(load[key], last["duration"])
    for motion in still.get("prescribe", {}).values():
        motion.update(dict.fromkeys(motion, 0))
    case["phases"].append(still)
    # A grid that is reset has the state of the points anew, which moves them a little (docs/numerics.md, loads on the surface: 5e-3).
    # A contact that is held creeps back by what its shear was given in excess.
    return replace(scene, case=case), scene.spread if "contacts" in case else 5e-3, same


def more_air(dice, scene):
    """More empty cells above."""
    regions = scene.case["regions"]
    grid = [face for face in scene.section.faces if not face.structure]
    if all(regions[face.name]["kind"] != "buffer" for face in grid):
        return shift(dice, scene)
    top = max(y for face in grid if regions[face.name]["kind"] != "buffer" for _, y in face.corners)
    factor = dice.uniform(1.3, 2)

    def raised(x, y):
        return (x, y if y <= top else top + (y - top) * factor)

    moved = scene.section.moved(raised)
    faces = [after if not before.structure else before for before, after in zip(scene.section.faces, moved.faces)]
    return replace(scene, section=replace(moved, faces=faces)), on_same_mesh(scene, EMPTY), same


def other_mesh(dice, scene):
    """Another mesh of about the same size, of the other shape of cells."""
    section = scene.section.moved(lambda x, y: (x, y), dice.uniform(0.8, 0.95))
    return replace(scene, section=replace(section, regular=False, quadrangles=not section.quadrangles)), scene.spread, same


def elements(dice, scene):
    """Finite elements in place of material points, where nothing moves far."""
    case = copy.deepcopy(scene.case)
    for region in case["regions"].values():
        if region["kind"] == "mpm":
            region["kind"] = "fem"
            region.pop("points_per_cell", None)
    return replace(scene, case=case), scene.spread, same


def smooth_walls(dice, scene):
    """Smooth walls in place of the supports of the sides."""
    case = copy.deepcopy(scene.case)
    section = replace(scene.section, curves=dict(scene.section.curves))
    case["supports"].pop("sides")
    soils = [name for name, region in case["regions"].items() if region["kind"] == "mpm"]
    gone = {entry["name"] for entry in case["output"]["history"] if entry["on"] in ("sides", "held")}
    for name, line in zip(("left wall", "right wall"), section.curves.pop("sides")):
        section.curves[name] = [line]
        case.setdefault("contacts", []).append({"wall": name, "soil": soils})
    section.curves.pop("held", None)
    for phase in case["phases"]:
        # A pressure acts as water does: where it is more than the soil presses on a wall it enters between both, and supports would pull.
        phase["tractions"] = [{"surface": "all", "ty": {"rate": -t["pressure"]["rate"]}} if "pressure" in t else t for t in phase.get("tractions", [])]
    case["output"]["history"] = [entry for entry in case["output"]["history"] if entry["name"] not in gone]
    return replace(scene, section=section, case=case), scene.spread, lambda name, unit: (None if name.rsplit(".", 1)[0] in gone else name, 1.0)


def threads(dice, scene):
    """Two threads: the same bytes."""
    return replace(scene, threads=2), 0.0, same


def resumed(dice, scene):
    """Killed in its midst and resumed: the same bytes."""
    return scene, 0.0, same


# Relations, with the families whose scenes they are tried on.
COLUMNS = ["oedometer_load", "oedometer_plate", "self_weight", "submerged", "undrained", "strip_load"]
GROUND = ["gravity", "dipping", "infinite_slope"]
MOTION = ["impact", "incline"]
ALL = [*COLUMNS, *GROUND, *MOTION, "rankine", "consolidation", "sunken"]
RELATIONS = {
    "shift": (shift, [*ALL, "shaft"]),
    "mirror": (mirror, ALL),
    "turn": (turn, ["oedometer_load", "oedometer_plate", "self_weight", *GROUND, *MOTION]),
    "units": (units, [*ALL, "shaft"]),
    "split_region": (split_region, ["oedometer_load", "oedometer_plate", "self_weight", "undrained", "dipping", "rankine", "consolidation", "janssen"]),
    "split_phase": (split_phase, ["oedometer_load", "oedometer_plate", "self_weight", *GROUND, "rankine", "shaft"]),
    "hold": (hold, ["oedometer_load", "oedometer_plate", "self_weight", "undrained", *GROUND, "submerged", "shaft"]),
    "more_air": (more_air, [*COLUMNS, *GROUND, "rankine", "consolidation"]),
    "other_mesh": (other_mesh, [*COLUMNS, "dipping", "infinite_slope", "rankine", "consolidation", "sunken"]),
    "elements": (elements, ["dipping", "infinite_slope", "gravity"]),
    "smooth_walls": (smooth_walls, ["oedometer_load", "self_weight"]),
    "threads": (threads, [*ALL, "janssen"]),
    "resumed": (resumed, ["oedometer_plate", "self_weight", "rankine", "janssen", "impact", "incline", "consolidation"]),
}
