"""The pipe: where it and the soil are after some of its way, for one run.

    python paraview/pipeline.py [OUT] [-o PICTURE] [--ways W ...]

OUT is the output folder of the run; W are the ways of the pipe sideways in m, a row each (0.8, 1.6, 4.4 and 5.6 without; what the run
did not reach is left out, and where that is all, its end is drawn). Colours are the plastic strain of the soil up to 1; finite elements of soil lie behind the points, the outline
is that of the pipe. In ParaView itself: `paraview OUT/points.pvd OUT/structures.pvd`, colour the points by `plastic_strain [-]`.
"""

import argparse
from pathlib import Path

from common import INK, ROOT, Series, face, field, history, outline, quantity, save, spacing, squares, stop

import numpy as np
import pyvista as pv

MOST = 1.0  # plastic strain from which on colours stay the same [-]
WIDE = 1280  # of the picture [px]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", nargs="?", type=Path, default=ROOT / "cases" / "pipeline" / "out",
                        help="output folder of mpm export (default: cases/pipeline/out)")
    parser.add_argument("-o", "--picture", type=Path, help="default: picture.png in OUT")
    parser.add_argument("--ways", nargs="+", type=float, default=[0.8, 1.6, 4.4, 5.6], help="of the pipe, sideways [m]")
    given = parser.parse_args()
    given.picture = given.picture or given.out / "picture.png"
    return given


def frames(given):
    """Soil and elements of the frame nearest to each way that the run came to, with its way and height."""
    points, elements = Series(given.out / "points.pvd"), Series(given.out / "structures.pvd")
    table = history(given.out / "history.csv")
    at = [np.interp(points.times, table["time [s]"], quantity(table, name)[1], left=0) for name in ("ux", "uy")]
    found = []
    for way in given.ways:
        i = int(np.argmin(np.abs(at[0] - way)))
        if abs(at[0][i] - way) <= 0.05:
            found.append((points.frame(i), elements.frame(i), at[0][i], at[1][i]))
    return found or [(points.frame(-1), elements.frame(-1), at[0][-1], at[1][-1])]


def pipe_of(elements):
    """The cells of the structure, the highest of the regions."""
    regions = elements.cell_data["region [-]"]
    tops = {r: elements.extract_cells(np.flatnonzero(regions == r)).bounds[3] for r in np.unique(regions)}
    return elements.extract_cells(np.flatnonzero(regions == max(tops, key=tops.get)))


def main():
    given = arguments()
    rows = frames(given)
    box = -1.2, max(way for *_, way, _ in rows) + 1.4, -0.7, 1.0
    gap, head, label, bar = 24, 64, 28, 90
    scale = (WIDE - 2 * gap) / (box[1] - box[0])
    tall = scale * (box[3] - box[2]) + label + gap
    size = WIDE, int(head + len(rows) * tall + bar)
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    plotter.add_text("Pipe pulled across the seabed", position=(gap, size[1] - 44), font_size=14, color=INK)
    side = spacing(rows[0][0])
    for row, (points, elements, way, height) in enumerate(rows):
        top = size[1] - head - row * tall
        text = f"after {way:.2f} m sideways, {-height:.3f} m deep"
        plotter.add_text(text, position=(gap, top - label + 6), font_size=10, color=INK)
        place = np.array([[scale, 0, 0, gap - scale * box[0]], [0, scale, 0, top - label - scale * box[3]],
                          [0, 0, scale, 0], [0, 0, 0, 1]])

        def add(mesh, z=0, **options):
            mesh = mesh.clip_box((*box, -1, 1), invert=False) if mesh.n_cells else mesh
            if mesh.n_cells:
                plotter.add_mesh(mesh.transform(place, inplace=False).translate((0, 0, z)), **options)

        found = field(points, "plastic_strain")
        if found is None:
            stop("the frames have no plastic_strain; add it to output.fields and export again")
        coloured = dict(scalars=found[0], clim=(0, MOST), cmap="viridis", lighting=False, show_scalar_bar=False)
        x = points.points
        near = (x[:, 0] > box[0]) & (x[:, 0] < box[1]) & (x[:, 1] > box[2])
        soil = points.extract_points(near, include_cells=False)
        # Points of coarse cells stand for more than the squares of fine ones.
        add(squares(soil, 1.15 * side, found[0], field(soil, "plastic_strain")[1]), z=1, **coloured)
        add(outline(pipe_of(elements)), z=2, color=INK, line_width=2)
    plotter.add_text(found[0], position=(gap, 24), font_size=12, color=INK)
    plotter.add_scalar_bar(title="", color=INK, n_labels=5, fmt="%.3g", label_font_size=18, width=0.6,
                           height=50 / size[1], position_x=0.3, position_y=14 / size[1])
    face(plotter, size)
    save(plotter, given.picture)


if __name__ == "__main__":
    main()
