"""The cantilever: its bent shapes over the loading on one picture, and the way of the elastica's tip.

    python paraview/cantilever.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/grid.pvd`, colour by `displacement [m]`, show edges, press Play.
"""

import csv

import numpy as np
import pyvista as pv

from common import INK, ROOT, Series, arguments, field, first_of, pick, save


def elastica(length):
    """Places of the tip, without load and under the loads of the case's reference."""
    with open(ROOT / "cases/cantilever/reference.csv", newline="") as file:
        rows = np.array([[float(x) for x in row] for row in list(csv.reader(file))[1:]])
    places = np.column_stack([length * (1 - rows[:, 2]), -length * rows[:, 1], np.full(len(rows), 0.1)])
    return np.vstack([[length, 0.0, 0.1], places])


def main():
    given = arguments("cantilever", __doc__.split("\n")[0])
    grid = Series(given.out / "grid.pvd")
    frames = [grid.frame(i) for i in pick(grid, 6)]
    name = first_of(frames[-1], ["displacement"])
    full, last = field(frames[-1], name)
    plotter = pv.Plotter(off_screen=True, window_size=(1280, 940))
    plotter.set_background("white")
    for frame in frames:
        shape = frame.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface")
        shape[full] = field(shape, name)[1]
        actor = plotter.add_mesh(shape, scalars=full, clim=(0, last.max()), cmap="viridis", lighting=False,
                                 show_scalar_bar=False)
        edges = frame.separate_cells().extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface")
        outlines = edges.extract_feature_edges(boundary_edges=True, feature_edges=False, manifold_edges=False,
                                               non_manifold_edges=False)
        plotter.add_mesh(outlines, color=INK, line_width=0.5, opacity=0.4)
    start = frames[0].bounds
    tips = elastica(start[1] - start[0]) + [start[0], 0.5 * (start[2] + start[3]), 0]
    plotter.add_mesh(pv.lines_from_points(tips), color="#c03020", line_width=2)
    plotter.add_mesh(pv.PolyData(tips), color="#c03020", point_size=7, render_points_as_spheres=True)
    plotter.add_text("Cantilever under a dead load at its tip; red: the tip of the elastica", position=(24, 892),
                     font_size=14, color=INK)
    plotter.add_text(full, position=(24, 20), font_size=12, color=INK)
    plotter.add_scalar_bar(title="", mapper=actor.mapper, color=INK, n_labels=5, fmt="%.3g", label_font_size=18,
                           width=0.6, height=0.06, position_x=0.3, position_y=0.015)
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.zoom(1.25)
    save(plotter, given.picture)


if __name__ == "__main__":
    main()
