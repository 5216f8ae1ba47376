"""The column under its own weight: stress and displacement of its points over the height, beside the closed form.

    python paraview/column.py [OUT] [-o PICTURE] [--ratio R]

R is the case's r = w H / E, one of those in `cases/column/reference.csv` (default 0.5, that of `case.yaml`).
To look at it in ParaView: `paraview OUT/grid.pvd` coloured by `displacement [m]`, or `OUT/points.pvd` by
`stress [kPa]`, component YY.
"""

import csv

import numpy as np
import pyvista as pv

from common import ROOT, Series, arguments, field, first_of, save, stop


def reference(ratio):
    """Depths [m], displacements [m] and vertical stresses [kPa] of the closed form."""
    path = ROOT / "cases/column/reference.csv"
    with open(path, newline="") as file:
        rows = np.array([[float(x) for x in row] for row in list(csv.reader(file))[1:]])
    rows = rows[np.isclose(rows[:, 0], ratio)]
    if not len(rows):
        stop(f"{path}: has nothing for r = {ratio:g}; make it with cases/column/study.py --reference")
    return rows[:, 1:].T


def main():
    given = arguments("column", __doc__.split("\n")[0], ratio="w H / E of the case")
    frame = Series(given.out / "points.pvd").frame(-1)
    depth, moved, carried = reference(given.ratio or 0.5)
    height = depth.max() - depth + moved
    first_of(frame, ["stress"])
    y = frame.points[:, 1]
    stress_name, stress = field(frame, "stress.yy")
    panels = [(stress_name, stress, carried)]
    if field(frame, "displacement"):
        full = field(frame, "displacement")[0]
        panels.append((f"vertical {full}", frame.point_data[full][:, 1], moved))
    plotter = pv.Plotter(off_screen=True, window_size=(1280, 720), shape=(1, len(panels)), border=False)
    for k, (name, found, exact) in enumerate(panels):
        plot = pv.Chart2D(x_label=name, y_label="height above the base [m]")
        plot.title = "Column under its own weight"
        plot.line(exact, height, color="#c03020", width=2, label="closed form")
        plot.scatter(found, y, color="#1f4e9c", size=6, label="material points")
        plot.y_range = [0, 1.2 * max(y.max(), height.max())]
        plot.legend_visible = True
        plotter.subplot(0, k)
        plotter.set_background("white")
        plotter.add_chart(plot)
    save(plotter, given.picture)


if __name__ == "__main__":
    main()
