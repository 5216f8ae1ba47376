"""The pile: vertical stress of the soil around it on its way down, for one or more runs side by side.

    python paraview/pile.py [OUT ...] [-o PICTURE] [--depths D ...] [--wide W] [--deep D]

Each OUT is the output folder of one run, a column of the picture with what is its own of the folder's name; D are the depths of the pile in m,
a row each (0.6, 1.2 and 1.6 without), W and D bound the part of the soil that is drawn. Finite elements of soil
lie behind the points in the same colours; the outline is that of the structure.
In ParaView itself: `paraview OUT/points.pvd OUT/structures.pvd`, colour both by `stress [kPa]`, component YY.
"""

import argparse
import os
from pathlib import Path

from common import INK, ROOT, Series, face, field, history, outline, quantity, save, stop

import numpy as np
import pyvista as pv


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", nargs="*", type=Path, default=[ROOT / "cases" / "pile" / "out"],
                        help="output folders of mpm export (default: cases/pile/out)")
    parser.add_argument("-o", "--picture", type=Path, help="default: picture.png in the first OUT")
    parser.add_argument("--depths", nargs="+", type=float, default=[0.6, 1.2, 1.6], help="of the pile [m]")
    parser.add_argument("--wide", type=float, default=3, help="width of the part that is drawn [m]")
    parser.add_argument("--deep", type=float, default=3, help="depth of the part that is drawn [m]")
    given = parser.parse_args()
    given.picture = given.picture or given.out[0] / "picture.png"
    return given


class Run:
    """The series of one output folder, and how deep the pile is in each frame."""

    def __init__(self, out, name):
        self.name = name
        self.points, self.structures = Series(out / "points.pvd"), Series(out / "structures.pvd")
        table = history(out / "history.csv")
        way = -quantity(table, "uy")[1]
        self.depths = np.interp(self.points.times, table["time [s]"], way, left=0)

    def at(self, depth):
        """Soil and elements at the frame that is nearest to `depth`, and its depth."""
        i = int(np.argmin(np.abs(self.depths - depth)))
        return self.points.frame(i), self.structures.frame(i), self.depths[i]


def stress(frame):
    found = field(frame, "stress.yy")
    if found is None:
        stop("the frames have no stress; add it to output.fields and export again")
    return found


def parts(elements):
    """The finite elements of soil, which come first to hold the bottom, and the structure, the highest region."""
    regions = elements.cell_data["region [-]"]
    tops = {r: elements.extract_cells(np.flatnonzero(regions == r)).bounds[3] for r in np.unique(regions)}
    pile = max(tops, key=tops.get)
    others = np.flatnonzero(regions != pile)
    return (elements.extract_cells(others) if len(others) else None), elements.extract_cells(np.flatnonzero(regions == pile))


def inside(frame, box):
    x = frame.points
    return (x[:, 0] < box[1]) & (x[:, 1] > box[2]) & (x[:, 1] < box[3])


def shares(points, name):
    """A square around each point as large as the points about it are apart, coloured by the stress."""
    cloud, neighbours = pv.PolyData(points.points), 6
    cloud[name] = stress(points)[1]
    near = [cloud.find_closest_point(x, n=min(neighbours + 1, cloud.n_points)) for x in cloud.points]
    far = [np.linalg.norm(cloud.points[n] - x, axis=1).max() for n, x in zip(near, cloud.points)]
    cloud["side"] = np.sqrt(np.pi / (neighbours + 0.5)) * np.array(far)
    square = pv.Plane(i_size=1, j_size=1, i_resolution=1, j_resolution=1)
    return cloud.glyph(geom=square, orient=False, scale="side")


def draw(given, runs):
    panels = [[run.at(depth) for run in runs] for depth in given.depths]
    name = stress(panels[0][0][0])[0]
    low = np.concatenate([stress(points)[1] for row in panels for points, _, _ in row])
    limits = np.percentile(low, 0.5), min(0.0, np.percentile(low, 99.5))
    above = 0.3 * given.deep
    gap, head, label, bar = 24, 64, 28, 100
    cell = (1280 - gap) / len(runs) - gap
    scale = min(cell / given.wide, 420 / (given.deep + above))
    tall = scale * (given.deep + above) + label + gap
    size = 1280, int(head + len(panels) * tall + bar)
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    plotter.add_text("Pile: vertical stress of the soil", position=(gap, size[1] - 44), font_size=14, color=INK)
    box = (0, given.wide, -given.deep, above, -1, 1)
    for row, items in enumerate(panels):
        for column, (points, elements, depth) in enumerate(items):
            left = gap + column * (cell + gap) + 0.5 * (cell - scale * given.wide)
            top = size[1] - head - row * tall
            plotter.add_text(f"{runs[column].name}, {depth:.2f} m", position=(left, top - label + 6), font_size=10, color=INK)
            place = np.array([[scale, 0, 0, left], [0, scale, 0, top - label - scale * above], [0, 0, scale, 0], [0, 0, 0, 1]])

            def add(mesh, z=0, **options):
                mesh = mesh.clip_box(box, invert=False) if mesh.n_cells else mesh
                if mesh.n_cells:
                    plotter.add_mesh(mesh.transform(place, inplace=False).translate((0, 0, z)), **options)

            coloured = dict(scalars=name, clim=limits, cmap="viridis", lighting=False, show_scalar_bar=False)
            soil, pile = parts(elements)
            if soil is not None:
                soil.point_data[name] = stress(soil)[1]
                add(soil, **coloured)
            points = points.extract_points(inside(points, box), include_cells=False)
            add(shares(points, name), z=1, **coloured)
            scale_of = plotter.mapper
            add(outline(pile), z=2, color=INK, line_width=2)
    plotter.add_text(f"{name}\n{low.min():.3g} to {low.max():.3g}", position=(gap, 16), font_size=12, color=INK)
    plotter.add_scalar_bar(title="", mapper=scale_of, color=INK, n_labels=5, fmt="%.3g", label_font_size=18, width=0.6,
                           height=60 / size[1], position_x=0.3, position_y=14 / size[1])
    face(plotter, size)
    save(plotter, given.picture)


def names(outs):
    """What the folders are called apart from what all of them begin with; one alone has the name of its case."""
    folders = [out.resolve() for out in outs]
    if len(folders) == 1:
        return [folders[0].parent.name if folders[0].name == "out" else folders[0].name]
    shared = len(os.path.commonprefix([folder.name for folder in folders]))
    return [folder.name[shared:].lstrip("-") or folder.name for folder in folders]


def main():
    given = arguments()
    draw(given, [Run(*run) for run in zip(given.out, names(given.out))])


if __name__ == "__main__":
    main()
