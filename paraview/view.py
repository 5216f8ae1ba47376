"""Draws the soil of any case as a body, coloured by a field, with its structures and the surface that is known.

    python paraview/view.py OUT --field stress.yy -o PICTURE

In ParaView the same opens as `paraview OUT/soil.pvd OUT/structures.pvd`. `mpm plot CASE --field stress.yy` draws it without Python.
"""

import argparse
from pathlib import Path

import numpy as np

from common import INK, Series, face, field, pv, save, stop

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("out", type=Path, help="output folder of mpm export")
parser.add_argument("--field", help="a field, with its component if it has several (default: the first of the soil)")
parser.add_argument("--time", type=float, help="time in s (default: the last)")
parser.add_argument("--mesh", action="store_true", help="draw the lines of the grid")
parser.add_argument("-o", "--picture", type=Path, help="default: OUT/view.png")
given = parser.parse_args()

soil = Series(given.out / "soil.pvd")
number = len(soil) - 1 if given.time is None else int(np.argmin([abs(t - given.time) for t in soil.times]))
body = soil.frame(number)
name = given.field or next((full.partition(" [")[0] for full in body.point_data), None)
found = field(body, name) if name else None
if found is None:
    stop(f"the soil has no field {name}; it has {', '.join(body.point_data) or 'none'}")
full, values = found
body.point_data[full] = values


def other(series):
    """The same frame of another series, if there is one."""
    path = given.out / f"{series}.pvd"
    return Series(path).frame(number) if path.exists() else None


structures, surface, grid = other("structures"), other("surface"), other("grid")
if structures is not None:
    # Finite elements of soil are part of the body.
    of_soil = set(np.unique(body.cell_data["region [-]"]))
    own = [c for c, region in enumerate(structures.cell_data["region [-]"]) if region not in of_soil]
    structures = structures.extract_cells(own) if own else None
x0, x1, y0, y1 = body.bounds[:4]
if structures is not None:
    s0, s1, t0, t1 = structures.bounds[:4]
    x0, x1, y0, y1 = min(x0, s0), max(x1, s1), min(y0, t0), max(y1, t1)

gap, head, bar = 24, 64, 110
scale = min((1280 - 2 * gap) / (x1 - x0), 900 / (y1 - y0))
size = 1280, max(300, int(head + scale * (y1 - y0) + bar + gap))
place = np.array([[scale, 0, 0, 0.5 * (size[0] - scale * (x1 - x0)) - scale * x0], [0, scale, 0, bar - scale * y0],
                  [0, 0, scale, 0], [0, 0, 0, 1]])
plotter = pv.Plotter(off_screen=True, window_size=size)
plotter.set_background("white")


def draw(mesh, height, **how):
    return plotter.add_mesh(mesh.transform(place, inplace=False).translate((0, 0, height)), lighting=False, **how)


finite = values[np.isfinite(values)]
low, high = (finite.min(), finite.max()) if len(finite) else (0, 1)
signed = low < 0 < high
limits = (-max(-low, high), max(-low, high)) if signed else (low, high)
coloured = draw(body, 0, scalars=full, clim=limits, cmap="coolwarm" if signed else "viridis", show_scalar_bar=False,
                nan_color="#ebebeb")
if given.mesh and grid is not None:
    clipped = grid.extract_all_edges().clip_box((x0, x1, y0, y1, -1, 1), invert=False)
    draw(clipped, 1, color=INK, line_width=0.5, opacity=0.4)
if structures is not None:
    draw(structures, 2, color="#a8a8a8")
    edges = structures.extract_surface(algorithm="dataset_surface").extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    draw(edges, 3, color=INK, line_width=1.5)
if surface is not None and surface.n_points:
    draw(surface, 4, color=INK, line_width=1.5)
plotter.add_text(f"{given.out.name}, t = {soil.times[number]:g} s", position=(gap, size[1] - 44), font_size=14, color=INK)
title = name + " [" + full.partition(" [")[2]
plotter.add_text(f"{title}\n{low:.3g} to {high:.3g}", position=(gap, 16), font_size=12, color=INK)
plotter.add_scalar_bar(title="", mapper=coloured.mapper, color=INK, n_labels=5, fmt="%.3g", label_font_size=18, width=0.6,
                       height=60 / size[1], position_x=0.35, position_y=14 / size[1])
face(plotter, size)
save(plotter, given.picture or given.out / "view.png")
