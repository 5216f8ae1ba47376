#!/usr/bin/env python
"""The anchored wall of templates/excavation in mpm and in Kratos GeoMechanics, stage by stage.

    wall.py [elastic] [mohr_coulomb] [--h 0.25] [--across 1e6 --along 1e5] [--keep FOLDER]

*elastic*: linear elastic sand that is tied to the wall. *mohr_coulomb*: the case as it is. Kratos has finite elements with
small strains on the same drawing (kratos_wall.py), and interfaces with a stiffness where mpm has contact, 1e7 kPa/m in both
directions where the sand is tied, else 1e6 across and 1e5 along. Needs `make build`; Kratos is installed into
.venv-kratos-geo, or KRATOS_PYTHON is the Python that has it. Takes half a minute and three to six minutes.
"""

import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import gmsh
import numpy as np
import pyvista
import yaml

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MPM = Path(os.environ.get("MPM", ROOT / "target/release/mpm"))
HOME = ROOT / ".venv-kratos-geo"
CASE = ROOT / "templates/excavation"
WALL, THICK, DIGS, LEFT = 7.5, 0.5, (1.5, 3.5, 5.0), 8.0  # of excavation.geo
HEAVE_AT = -LEFT / 2


def kratos_python():
    if "KRATOS_PYTHON" in os.environ:
        return os.environ["KRATOS_PYTHON"]
    stamp, wanted = HOME / "requirements.txt", HERE / "requirements.txt"
    if not stamp.exists() or stamp.read_text() != wanted.read_text():
        print("installing Kratos into .venv-kratos-geo", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", HOME], check=True)
        subprocess.run([HOME / "bin/python", "-m", "pip", "install", "--quiet", "-r", wanted], check=True)
        stamp.write_text(wanted.read_text())
    return HOME / "bin/python"


def cells_of(surfaces):
    """Nodes of the cells of surfaces, anticlockwise, corners first."""
    found = []
    for surface in surfaces:
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(2, surface)):
            found.append(np.array(nodes, dtype=int).reshape(-1, {9: 6, 16: 8}[kind]))
    return np.vstack(found)


def draw(h):
    """The drawing of the case meshed for finite elements: nodes, and the cells of sand, lifts, wall and interfaces by name."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.onelab.setNumber("Parameters/h", [h])
    gmsh.open(str(CASE / "excavation.geo"))
    model = gmsh.model
    groups = {model.getPhysicalName(2, tag): list(model.getEntitiesForPhysicalGroup(2, tag)) for _, tag in model.getPhysicalGroups(2)}
    centre = {surface: model.occ.getCenterOfMass(2, surface) for surface in groups["sand"]}
    (wall,) = [s for s, (x, y, _) in centre.items() if abs(x) < 1e-6 and y > -WALL]
    for _, curve in model.getBoundary([(2, wall)], oriented=False):
        model.mesh.setTransfiniteCurve(curve, round(model.occ.getMass(1, curve) / h) + 1)
    corners = [p for _, p in model.getBoundary([(2, wall)], recursive=True) if round(model.getValue(0, p, [])[1], 6) in (0, -WALL)]
    corners.sort(key=lambda p: math.atan2(model.getValue(0, p, [])[1] + WALL / 2, model.getValue(0, p, [])[0]))
    model.mesh.setTransfiniteSurface(wall, cornerTags=corners)
    model.mesh.setRecombine(2, wall)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    model.mesh.generate(2)
    model.mesh.setOrder(2)
    tags, places, _ = model.mesh.getNodes()
    at = dict(zip((int(tag) for tag in tags), places.reshape(-1, 3)[:, :2]))
    soil = {"sand": cells_of([s for s in groups["sand"] if s != wall])}
    soil |= {name: cells_of(groups[name]) for name in ("lift1", "lift2", "lift3")}
    strip = cells_of([wall])
    gmsh.finalize()

    # The wall has nodes of its own, above those of the sand in number.
    outside = {tag: i for i, tag in enumerate(sorted({int(n) for cells in soil.values() for n in cells.flat}))}
    inside = {tag: len(outside) + i for i, tag in enumerate(sorted({int(n) for n in strip.flat}))}
    parts = {name: np.vectorize(outside.get)(cells) for name, cells in soil.items()}
    parts["wall"] = np.vectorize(inside.get)(strip)
    faces = {"face1": [], "face2": [], "face3": [], "faces": []}
    for cell in strip:
        for a, b, middle in ((0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)):
            x, y = at[cell[middle]]
            side = abs(abs(x) - THICK / 2) < 1e-6
            if not side and abs(y + WALL) > 1e-6:
                continue
            edge = [cell[a], cell[b], cell[middle]]
            lift = 0 if x > 0 or not side else next((i for i, depth in enumerate(DIGS, 1) if y > -depth), 0)
            faces[f"face{lift}" if lift else "faces"].append([outside[n] for n in edge] + [inside[n] for n in edge])
    parts |= {name: np.array(cells) for name, cells in faces.items()}
    nodes = np.array([at[tag] for tag in (*outside, *inside)])
    (head,) = [i for i in inside.values() if np.allclose(nodes[i], (0, -1))]
    for name in (*soil, "wall"):
        x, y = nodes[parts[name][:, :3]].transpose(2, 0, 1)
        if ((x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) < (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])).any():
            sys.exit(f"{name} has cells that run clockwise")
    return nodes, parts | {"anchor": np.array([[head]])}


def kratos(folder, model, case, h, across, along):
    """What Kratos finds at the end of each stage."""
    nodes, parts = draw(h)
    np.savez(folder / "mesh.npz", nodes=nodes, **parts)
    sand, plate, rod = case["materials"]["sand"], case["regions"]["wall"]["plate"], case["bars"]["anchor"]
    tied = model == "elastic"
    phases = [{"steps": round(p["duration"] / p["step"]["initial"])} for p in case["phases"]]
    roles = [{"dig": 1}, {"prestress": rod["prestress"]}, {"dig": 2, "anchor": True}, {"dig": 3, "anchor": True}]
    settings = {
        **{key: sand[key] for key in ("unit_weight", "young", "poisson", "cohesion", "friction", "dilation")},
        "model": model,
        "k0": 1 - math.sin(math.radians(sand["friction"])),
        "wall_friction": case["contacts"][0]["friction"],
        "normal_stiffness": across or (1e7 if tied else 1e6),
        "shear_stiffness": along or (1e7 if tied else 1e5),
        "wall_young": plate["EA"] / THICK,
        "wall_weight": plate["weight"],
        "t": THICK,
        "anchor_stiffness": rod["EA"] / (rod["to"][0]),
        "stages": [a | b for a, b in zip(phases, roles, strict=True)],
    }
    (folder / "settings.json").write_text(json.dumps(settings))
    results = folder / "results.json"
    command = [kratos_python(), ROOT / "benches/peers/kratos_wall.py", folder / "mesh.npz", folder / "settings.json", results]
    with open(folder / "kratos.log", "w") as log:
        subprocess.run([str(part) for part in command], check=True, stdout=log, stderr=log, env={**os.environ, "OMP_NUM_THREADS": "1"})
    found = json.loads(results.read_text())
    print(f"Kratos, {len(nodes)} nodes: {found['end']}, {found['seconds']:.0f} s, {sum(found['iterations'])} iterations")
    start = np.array(found["stages"][0]["displacement"])
    count = parts["wall"].min()  # nodes of the sand
    stages = []
    for stage, dug in zip(found["stages"][1:], (DIGS[0], *DIGS)):
        u = np.array(stage["displacement"]) - start
        axis = sorted((y, i) for i, (x, y) in enumerate(nodes) if i >= count and abs(x) < 1e-6)
        stages.append(measures(stage["anchor"], stage["moments"], [(y, u[i, 0]) for y, i in axis], nodes[:count], u[:count], dug))
    return stages


def mpm(folder, model, case, h):
    """What mpm finds at the end of each stage."""
    sand = dict(case["materials"]["sand"])
    command = [MPM, "run", CASE, "-o", folder / "out", "--threads", "1", "--set", f"mesh.parameters.h={h}"]
    if model == "elastic":
        k0 = 1 - math.sin(math.radians(sand["friction"]))
        kept = {key: sand[key] for key in ("young", "poisson", "unit_weight")}
        sets = {
            "materials.sand": json.dumps({"model": "linear_elastic"} | kept),
            "contacts[0]": json.dumps({"structure": "wall", "friction": 1000, "tension": "no_separation"}),
            "initial_stress.k0.sand": k0,
        }
        command += [part for key, value in sets.items() for part in ("--set", f"{key}={value}")]
    with open(folder / "mpm.log", "w") as log:
        subprocess.run([str(part) for part in command], check=True, stdout=log, stderr=log)
    plates, history = (list(csv.DictReader((folder / "out" / name).open())) for name in ("plates.csv", "history.csv"))
    frames = pyvista.get_reader(folder / "out/soil.pvd")
    stages = []
    for end, dug in enumerate((DIGS[0], *DIGS), 1):
        rows = [row for row in plates if abs(float(row["time [s]"]) - end) < 1e-6]
        y, u, moment = ([float(row[key]) for row in rows] for key in ("y [m]", "ux [m]", "M [kN m/m]"))
        anchor = next(float(row["anchor.force [kN]"]) for row in history if abs(float(row["time [s]"]) - end) < 1e-6)
        frames.set_active_time_value(min(frames.time_values, key=lambda time: abs(time - end)))
        soil = frames.read()[0]
        moved = np.array(soil.point_data["displacement [m]"])[:, :2]
        stages.append(measures(anchor, list(zip(y, moment)), list(zip(y, u)), np.array(soil.points)[:, :2] - moved, moved, dug))
    return stages


def measures(anchor, moments, axis, places, moved, dug):
    """The rows of the table: lengths in m and mm, forces of a metre."""
    depth, moment = np.array(moments).T
    y, u = np.array(axis).T
    # On the bottom of the pit, between the nodes of it on both sides.
    bottom = (abs(places[:, 1] + dug) < 2e-3) & (places[:, 0] < -THICK)
    order = np.argsort(places[bottom, 0])
    heave = np.interp(HEAVE_AT, places[bottom, 0][order], moved[bottom, 1][order])
    largest = np.argmin(moment)
    return {
        "anchor [kN/m]": anchor,
        "moment in the span [kNm/m]": moment[largest],
        "its depth [m]": -depth[largest],
        "wall, head [mm]": 1e3 * np.interp(0, y, u),
        "wall, anchor [mm]": 1e3 * np.interp(-1, y, u),
        "wall, most to the pit [mm]": 1e3 * u.min(),
        "wall, tip [mm]": 1e3 * np.interp(-WALL, y, u),
        "heave of the pit [mm]": 1e3 * heave,
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=["elastic", "mohr_coulomb"], help="elastic, mohr_coulomb")
    parser.add_argument("--h", type=float, default=0.25, help="size of the cells at the wall [m]")
    parser.add_argument("--across", type=float, help="stiffness of the interfaces of Kratos [kPa/m]")
    parser.add_argument("--along", type=float, help="the same, in shear")
    parser.add_argument("--keep", type=Path, help="a folder for the files of both")
    arguments = parser.parse_args()
    case = yaml.safe_load((CASE / "case.yaml").read_text())
    with tempfile.TemporaryDirectory() as name:
        for model in arguments.models:
            folder = (arguments.keep or Path(name)) / model
            folder.mkdir(parents=True, exist_ok=True)
            theirs = kratos(folder, model, case, arguments.h, arguments.across, arguments.along)
            ours = mpm(folder, model, case, arguments.h)
            print(f"\n{model}, h = {arguments.h} m\n\n| stage | what | mpm | Kratos | ratio |\n|---|---|---|---|---|")
            for phase, a, b in zip(case["phases"], ours, theirs):
                for key in a:
                    ratio = f"{a[key] / b[key]:.3f}" if abs(b[key]) > 0.1 else ""
                    print(f"| {phase['name']} | {key} | {a[key]:.2f} | {b[key]:.2f} | {ratio} |")
            print(flush=True)


if __name__ == "__main__":
    main()
