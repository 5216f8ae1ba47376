"""What the pictures share: reading a series, drawing soil points, putting panels beside each other.

The scripts use PyVista, so that a picture needs no ParaView and no display. In ParaView itself the same
series opens with `paraview OUT/points.pvd` (and `grid.pvd` for the background grid): press Apply, take the
representation "Point Gaussian" or "Points" and colour by `plastic_strain [-]` or `displacement [m]`.
"""

import argparse
import csv
import os
import sys
from ctypes.util import find_library
from pathlib import Path

# Without a display VTK tries X first and complains; EGL, or else OSMesa, draws into memory.
if "DISPLAY" not in os.environ:
    for library, window in (("EGL", "vtkEGLRenderWindow"), ("OSMesa", "vtkOSOpenGLRenderWindow")):
        if find_library(library):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", window)
            break
    else:
        sys.exit("pictures need libEGL or libOSMesa: apt-get install libegl1 libgl1-mesa-dri")

import numpy as np
import pyvista as pv

pv.OFF_SCREEN = True
ROOT = Path(__file__).resolve().parent.parent
INK = "#202020"


def arguments(case, description, **extra):
    """The output folder and the picture to write, from the command line; `extra` are further numbers."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("out", nargs="?", type=Path, default=ROOT / "cases" / case / "out",
                        help="output folder of mpm export (default: cases/%s/out)" % case)
    parser.add_argument("-o", "--picture", type=Path, help="default: OUT/picture.png")
    for name, text in extra.items():
        parser.add_argument("--" + name, type=float, help=text)
    given = parser.parse_args()
    given.picture = given.picture or given.out / "picture.png"
    return given


def stop(message):
    """Ends the script with one message and the exit status of wrong input."""
    print(message, file=sys.stderr)
    sys.exit(2)


class Series:
    """The frames of a `.pvd`."""

    def __init__(self, path):
        if not path.exists():
            stop(f"{path}: there is no such file; run `mpm export` first")
        self.reader = pv.get_reader(str(path))
        self.times = list(self.reader.time_values)

    def __len__(self):
        return len(self.times)

    def frame(self, i):
        self.reader.set_active_time_point(i % len(self))
        return self.reader.read()[0]


def field(frame, name):
    """The values of a field, whatever its unit, with the name that has the unit; None if absent.

    `stress.yy` is a component of a symmetric tensor, `displacement` the length of the vector.
    """
    wanted, _, component = name.partition(".")
    for full in frame.point_data:
        plain, _, unit = full.partition(" [")
        if plain == wanted:
            values = frame.point_data[full]
            if component:
                return f"{name} [{unit}", values[:, ("xx", "yy", "zz", "xy", "yz", "xz").index(component)]
            return full, values if values.ndim == 1 else np.linalg.norm(values, axis=1)
    return None


def first_of(frame, names):
    """The first of the fields that the frame has."""
    for name in names:
        if field(frame, name):
            return name
    stop(f"the frames have none of {', '.join(names)}; add one to output.fields and export again")


def spacing(points):
    """The side of the square that belongs to a point, from the circle that holds a dozen neighbours of some."""
    cloud, neighbours = pv.PolyData(points.points), 12
    some = cloud.points[:: max(1, cloud.n_points // 500)]
    radii = []
    for x in some:
        near = cloud.find_closest_point(x, n=min(neighbours + 1, cloud.n_points))
        radii.append(np.linalg.norm(cloud.points[near] - x, axis=1).max())
    return float(np.median(radii) * np.sqrt(np.pi / (neighbours + 0.5)))


def squares(points, size, name, values):
    """A square of the given size around each point, coloured by `values`."""
    cloud = pv.PolyData(points.points)
    cloud[name] = values
    square = pv.Plane(i_size=size, j_size=size, i_resolution=1, j_resolution=1)
    return cloud.glyph(geom=square, orient=False, scale=False)


def bounds_of(frames):
    """The rectangle around all frames: x0, x1, y0, y1."""
    corners = np.array([f.bounds[:4] for f in frames])
    return corners[:, 0].min(), corners[:, 1].max(), corners[:, 2].min(), corners[:, 3].max()


def outline(grid):
    """The boundary of the background grid, with its curved edges."""
    return grid.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface").extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False)


def surface_line(points, bins=150):
    """The upper outline of the points, as a line."""
    half, x, y = 0.5 * spacing(points), points.points[:, 0], points.points[:, 1]
    edges = np.linspace(x.min() - half, x.max() + half, bins + 1)
    number = np.clip(np.digitize(x, edges) - 1, 0, bins - 1)
    top = [(0.5 * (edges[k] + edges[k + 1]), y[number == k].max() + half, 0.0) for k in np.unique(number)]
    return pv.lines_from_points(np.array(top))


def panels(picture, title, frames, labels, name, columns=1, limits=None, grid=None, colours="viridis", line=None,
           fill=1.0):
    """Draws frames in panels of one scale, coloured by the field `name`, and saves the picture.

    All panels lie in one plane beside each other, in pixels; `grid` gives the outline to draw in each and `line`
    one more. `fill` is the side of a point over that of its share of the first frame.
    """
    found = [field(frame, name) for frame in frames]
    full = found[0][0]
    everything = np.concatenate([values for _, values in found])
    if limits is None:
        # A few extreme points would leave one colour to all others; the largest is said beside the scale.
        limits = np.percentile(everything, [0.5, 99.5])
        if limits[0] == limits[1]:
            limits = everything.min(), everything.max()
    x0, x1, y0, y1 = bounds_of(frames)
    rows = -(-len(frames) // columns)
    gap, head, label, bar = 24, 64, 32, 110
    cell = (1280 - gap) / columns - gap
    scale = min(cell / (x1 - x0), 640 / (y1 - y0))
    tall = scale * (y1 - y0) + label + gap
    size = 1280, int(head + rows * tall + bar)

    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    plotter.add_text(title, position=(gap, size[1] - 44), font_size=14, color=INK)
    h = spacing(frames[0])
    lines = outline(grid) if grid is not None else None
    clip = pv.Box((x0 - h, x1 + h, y0 - h, y1 + h, -1, 1))
    for k, (frame, (_, values), text) in enumerate(zip(frames, found, labels)):
        row, column = divmod(k, columns)
        left = gap + column * (cell + gap) + 0.5 * (cell - scale * (x1 - x0))
        top = size[1] - head - row * tall
        plotter.add_text(text, position=(left, top - label + 6), font_size=10, color=INK)
        place = np.array([[scale, 0, 0, left - scale * x0], [0, scale, 0, top - label - scale * y1],
                          [0, 0, scale, 0], [0, 0, 0, 1]])
        if lines is not None and lines.n_cells:
            inside = lines.clip_box(clip.bounds, invert=False)
            if inside.n_cells:
                plotter.add_mesh(inside.transform(place, inplace=False), color="#b0b0b0", line_width=1)
        if line is not None:
            plotter.add_mesh(line.transform(place, inplace=False).translate((0, 0, 1)), color=INK, line_width=2)
        plotter.add_mesh(squares(frame, fill * h, full, values).transform(place, inplace=False), scalars=full, clim=limits,
                         cmap=colours, lighting=False, show_scalar_bar=False)
    plotter.add_text(f"{full}\n{everything.min():.3g} to {everything.max():.3g}", position=(gap, 16), font_size=12, color=INK)
    plotter.add_scalar_bar(title="", color=INK, n_labels=5, fmt="%.3g", label_font_size=18, width=0.6,
                           height=60 / size[1], position_x=0.3, position_y=14 / size[1])
    face(plotter, size)
    save(plotter, picture)


def face(plotter, size):
    """Looks straight at a plane of `size` pixels whose lower left corner is the origin."""
    plotter.enable_parallel_projection()
    plotter.camera.focal_point = size[0] / 2, size[1] / 2, 0
    plotter.camera.position = size[0] / 2, size[1] / 2, 1000
    plotter.camera.up = 0, 1, 0
    plotter.camera.parallel_scale = size[1] / 2
    plotter.camera.clipping_range = 1, 2000


def save(plot, picture):
    """Writes a plot or chart beside its name and moves it there, so that no half picture is ever seen."""
    beside = picture.with_name(f".{picture.stem}.tmp-{os.getpid()}.png")
    plot.show(screenshot=str(beside))
    os.replace(beside, picture)
    print(picture)


def history(path):
    """The columns of a `history.csv`: names with units, and numbers."""
    if not path.exists():
        stop(f"{path}: there is no such file; run `mpm solve` first")
    with open(path, newline="") as file:
        names, *rows = list(csv.reader(file))
    return dict(zip(names, np.array(rows, dtype=float).reshape(-1, len(names)).T))


def quantity(table, name):
    """The first column that ends with `.name`, before its unit."""
    for full, values in table.items():
        if full.split(" [")[0].split(".")[-1] == name:
            return full, values
    stop(f"history.csv has no column {name}; add it to output.history")


def chart(picture, title, x, y, x_label, y_label, levels=()):
    """Draws y over x with horizontal `levels`, each a number and its name, and saves the picture."""
    plot = pv.Chart2D(x_label=x_label, y_label=y_label)
    plot.title = title
    plot.line(x, y, color="#1f4e9c", width=2.5, label="mpm")
    for (level, name), colour in zip(levels, ("#c03020", "#308030", "#806020")):
        plot.line([min(x), max(x)], [level, level], color=colour, style="--", width=1.5, label=name)
    plot.legend_visible = bool(levels)
    # Room for the legend above the curve.
    highest = max([max(y), *(level for level, _ in levels)])
    plot.y_range = [min(0, min(y)), 1.2 * highest]
    plotter = pv.Plotter(off_screen=True, window_size=(1000, 640))
    plotter.set_background("white")
    plotter.add_chart(plot)
    save(plotter, picture)


def pick(series, count):
    """Numbers of `count` frames over the whole time, the first and the last among them."""
    return sorted({round(i) for i in np.linspace(0, len(series) - 1, count)})
