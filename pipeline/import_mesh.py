#!/usr/bin/env python3
"""Converts a plane mesh of another program: whatever meshio reads (Exodus, VTU, Nastran, ...) becomes a Gmsh file whose
named physical groups are the sets of the source. A case takes it as `mesh: {file: mesh.msh}`. Files of Abaqus (.inp) and
MED (.med) it takes as they are.

    .venv/bin/python pipeline/import_mesh.py SOURCE mesh.msh [--surface soil=3 --curve bottom=7 ...]

Sets of surface cells become physical surfaces, the regions of a case; sets of line cells become physical
curves. Node sets become the physical curve of the cell edges whose nodes are all in the set. Sources that
number their parts instead of naming them (VTU, MED without families, Gmsh 2) are named with --surface and
--curve: NAME=NUMBER of the integer cell data found there. Cells of no set go into the region `domain`.
Cells kept: triangles and quadrilaterals of first and second order.
"""

import argparse
import os
import sys
import tempfile

import meshio
import numpy as np

# Cell types of meshio by dimension, with their edges (corner, corner[, middle]).
TRIANGLE = [(0, 1, 3), (1, 2, 4), (2, 0, 5)]
QUAD = [(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)]
SURFACES = {
    "triangle": (TRIANGLE, 2),
    "triangle6": (TRIANGLE, 3),
    "quad": (QUAD, 2),
    "quad8": (QUAD, 3),
    "quad9": (QUAD, 3),
}
LINES = {"line": 2, "line3": 3}
# Element types of Gmsh.
GMSH = {"line": 1, "line3": 8, "triangle": 2, "triangle6": 9, "quad": 3, "quad8": 16, "quad9": 10}


class Refused(Exception):
    """The source cannot be taken; the message says what to do."""


def named_numbers(arguments):
    pairs = {}
    for argument in arguments:
        name, _, number = argument.partition("=")
        if not name or not number.lstrip("-").isdigit():
            raise Refused(f"{argument}: expected NAME=NUMBER")
        pairs[int(number)] = name
    return pairs


def by_number(mesh, block, names):
    """Names of the cells of a block after the first integer cell data that knows the numbers; None if unnamed."""
    result = [None] * len(mesh.cells[block].data)
    for data in mesh.cell_data.values():
        values = np.asarray(data[block])
        if values.ndim == 1 and np.all(values == np.round(values)) and set(values.astype(int)) & set(names):
            for i, value in enumerate(values.astype(int)):
                result[i] = names.get(value)
            break
    return result


def group(mesh, surfaces, curves):
    """Cells and edges by group: lists of (name, type, nodes)."""
    # Gmsh's own sets (`gmsh:bounding_entities`) are no groups.
    sets = {name: data for name, data in mesh.cell_sets.items() if not name.startswith("gmsh:")}
    # Names that come with the file: {name: (number, dimension)}.
    named = {2: dict(surfaces), 1: dict(curves)}
    for name, (number, dimension) in mesh.field_data.items():
        named.get(int(dimension), {}).setdefault(int(number), name)
    cells, lines = [], []
    for block, part in enumerate(mesh.cells):
        if part.type not in SURFACES and part.type not in LINES:
            if part.type != "vertex":
                print(f"left out: {len(part.data)} cells of type {part.type}", file=sys.stderr)
            continue
        names = by_number(mesh, block, named[2 if part.type in SURFACES else 1])
        for name, members in sets.items():
            for i in np.asarray(members[block] if members[block] is not None else [], dtype=int):
                if part.type in SURFACES and names[i] not in (None, name):
                    raise Refused(f"cell {i} of {part.type} is in two sets, {names[i]} and {name}; leave it in one")
                names[i] = name
        for name, nodes in zip(names, part.data):
            if part.type in SURFACES:
                cells.append((name or "domain", part.type, tuple(map(int, nodes))))
            elif name:
                lines.append((name, part.type, tuple(map(int, nodes))))
    taken = {name for name, _, _ in lines}
    for name, nodes in mesh.point_sets.items():
        inside = set(map(int, nodes))
        found = set()
        for _, kind, cell in cells:
            edges, count = SURFACES[kind]
            for edge in edges:
                edge = tuple(cell[i] for i in edge[:count])
                key = tuple(sorted(edge))
                if inside.issuperset(edge) and name not in taken and key not in found:
                    found.add(key)
                    lines.append((name, "line" if count == 2 else "line3", edge))
    return cells, lines


def write(path, points, cells, lines):
    """MSH 4.1, one entity a physical group; nodes are listed with the first entity."""
    used = sorted({node for _, _, nodes in cells for node in nodes})
    number = {node: i + 1 for i, node in enumerate(used)}
    if any(node not in number for _, _, nodes in lines for node in nodes):
        raise Refused("a line set has nodes that belong to no cell; take it out of the source")
    groups = []
    for dimension, members in ((1, lines), (2, cells)):
        for tag, name in enumerate(dict.fromkeys(name for name, _, _ in members), 1):
            groups.append((dimension, tag, name, [m for m in members if m[0] == name]))
    x = points[used]
    box = " ".join(repr(float(v)) for v in (*x.min(axis=0), *x.max(axis=0)))
    blocks = []
    for dimension, tag, _, members in groups:
        for kind in dict.fromkeys(kind for _, kind, _ in members):
            blocks.append((dimension, tag, kind, [nodes for _, k, nodes in members if k == kind]))
    total = sum(len(block[3]) for block in blocks)
    out = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    out += [f'{dimension} {tag} "{name}"' for dimension, tag, name, _ in groups]
    out += ["$EndPhysicalNames", "$Entities"]
    out += [f"0 {sum(g[0] == 1 for g in groups)} {sum(g[0] == 2 for g in groups)} 0"]
    out += [f"{tag} {box} 1 {tag} 0" for _, tag, _, _ in groups]
    first = groups[-1]
    out += ["$EndEntities", "$Nodes", f"1 {len(used)} 1 {len(used)}", f"{first[0]} {first[1]} 0 {len(used)}"]
    out += [str(i + 1) for i in range(len(used))]
    out += [" ".join(repr(float(v)) for v in row) for row in x]
    out += ["$EndNodes", "$Elements", f"{len(blocks)} {total} 1 {total}"]
    element = 0
    for dimension, tag, kind, members in blocks:
        out.append(f"{dimension} {tag} {GMSH[kind]} {len(members)}")
        for nodes in members:
            element += 1
            out.append(f"{element} " + " ".join(str(number[node]) for node in nodes))
    out += ["$EndElements", ""]
    folder = os.path.dirname(os.path.abspath(path))
    os.makedirs(folder, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=folder, suffix=".msh", delete=False) as file:
        file.write("\n".join(out))
    os.replace(file.name, path)
    return groups


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("output")
    parser.add_argument("--surface", action="append", default=[], metavar="NAME=NUMBER")
    parser.add_argument("--curve", action="append", default=[], metavar="NAME=NUMBER")
    arguments = parser.parse_args()
    try:
        if arguments.source.lower().endswith((".inp", ".med")):
            name = os.path.basename(arguments.source)
            raise Refused(f"mpm reads it itself: write `mesh: {{file: {name}}}` in the case.yaml beside it, and run `mpm mesh`")
        try:
            mesh = meshio.read(arguments.source)
        except ImportError as error:  # h5py, netCDF4
            package = error.name or str(error)
            raise Refused(f"meshio needs the package {package} for it: {sys.executable} -m pip install {package}") from None
        except (Exception, SystemExit) as error:  # its readers let anything through
            raise Refused(f"meshio cannot read it: {error}") from None
        points = np.zeros((len(mesh.points), 3))
        points[:, : mesh.points.shape[1]] = mesh.points
        cells, lines = group(mesh, named_numbers(arguments.surface), named_numbers(arguments.curve))
        if not cells:
            raise Refused("it has no triangles or quadrilaterals")
        for dimension, _, name, members in write(arguments.output, points, cells, lines):
            print(f"{'surface' if dimension == 2 else 'curve'} {name}: {len(members)}")
    except (Refused, OSError) as error:
        print(f"{arguments.source}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
