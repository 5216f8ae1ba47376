"""Load over penetration of runs of the pile, its ripple, and the noise of the stress below the base.

    .venv/bin/python cases/pile/study.py [OUT ...] [-o CHART] [--depths D ...] [--cell H]

Each OUT is the output folder of a run (all of `cases/pile/variants.py` without). Prints Markdown tables and draws the curves to CHART
(.svg or .png; without, curves.svg in the first OUT). What a run did not reach is `-`.

The stress at the base is what the tractions along the lowest 0.1 m of the pile, its base and the round edge, bear upwards, over the area of the base.
*Noise* at a depth of the pile: the root mean square of σ_yy of the soil points about its own smooth field, in the box
below the base as wide as the pile (1 m; half of it in axisymmetry) and 1.5 m deep. The smooth field at a point is the quadratic fitted by least
squares to the points below the base within two cells of it. The second number leaves out the layer under the base that is a cell
thick. *Ripple*: that of the load about the cubic fitted to the curve within
0.2 m of each place, from there on where the curve reaches as far to both sides.
"""

import argparse
import os
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

CASE = Path(__file__).resolve().parent
RADIUS = 0.5  # of the pile [m]
EDGE = 0.1  # radius of the edge of its base [m]
BOX = 1.5  # depth of the box [m]
HALF = 0.2  # half the length of the curve that a cubic is fitted to [m]
STEP = 0.01  # between the places on the curve [m]


class Run:
    """The history and the frames of an output folder."""

    def __init__(self, out):
        self.out, self.name = out, out.name
        columns = history(out)
        self.depth, self.load = -columns["head.uy"], columns["pile.contact_y"]
        self.time = columns["time"]

    def pressure(self, depth):
        """Load over the area of the base (kPa)."""
        if depth > self.depth[-1] + 1e-9:
            return None
        return np.interp(depth, self.depth, self.load) / (np.pi * RADIUS**2)

    def frame(self, series, depth):
        """What a series shows where the pile is at a depth, if it does."""
        import pyvista

        reader = pyvista.get_reader(str(self.out / f"{series}.pvd"))
        depths = np.interp(reader.time_values, self.time, self.depth, left=0)
        i = int(np.argmin(np.abs(depths - depth)))
        if abs(depths[i] - depth) > 1e-6:
            return None
        reader.set_active_time_point(i)
        return reader.read()[0]

    def base(self, depth):
        """Stress at the base (kPa)."""
        frame = self.frame("contact", depth)
        if frame is None:
            return None
        from_node, to_node = frame.cells.reshape(-1, 3)[:, 1:].T
        traction = next(frame.point_data[name] for name in frame.point_data if name.startswith("contact_traction ["))[:, 1]
        middle = (frame.points[from_node] + frame.points[to_node]) / 2
        length = np.linalg.norm(frame.points[to_node] - frame.points[from_node], axis=1)
        upwards = (traction[from_node] + traction[to_node]) / 2 * length * 2 * np.pi * middle[:, 0]
        return np.sum(upwards[middle[:, 1] < np.min(frame.points[:, 1]) + EDGE + 1e-6]) / (np.pi * RADIUS**2)

    def noise(self, depth, cell):
        """Root mean square (kPa) of σ_yy about its smooth field in the box, and a cell and more below the base."""
        frame, radius = self.frame("points", depth), 2 * cell
        if frame is None:
            return None
        stress = next(frame.point_data[name] for name in frame.point_data if name.startswith("stress ["))[:, 1]
        x = frame.points[:, :2]
        near = (x[:, 0] < RADIUS + radius) & (x[:, 1] < -depth) & (x[:, 1] > -depth - BOX - radius)
        x, stress = x[near], stress[near]
        inside = np.flatnonzero((x[:, 0] < RADIUS) & (x[:, 1] > -depth - BOX))
        off = np.array([stress[p] - smooth(x - x[p], stress, radius) for p in inside])
        return [np.sqrt(np.mean(off[x[inside, 1] < -depth - below] ** 2)) for below in (0, cell)]

    def ripple(self):
        """Root mean square of the load about its trend, over its mean (-)."""
        at = np.arange(self.depth[0], self.depth[-1], STEP)
        load = np.interp(at, self.depth, self.load)
        count = round(HALF / STEP)
        window = np.arange(-count, count + 1) * STEP
        middle = np.arange(count, len(at) - count)
        if len(middle) == 0:
            return None
        off = [load[i] - np.polynomial.Polynomial.fit(window, load[i - count : i + count + 1], 3)(0) for i in middle]
        return np.sqrt(np.mean(np.square(off))) / np.mean(load[middle])

    def seconds(self):
        """The time that the run took, if it was noted."""
        file = self.out / "run.txt"
        found = re.search(r"(\S+) s:", file.read_text()) if file.exists() else None
        return float(found[1]) if found else None


def smooth(way, values, radius):
    """The quadratic nearest to `values` at the places within `radius`, where `way` is zero."""
    close = np.einsum("ij,ij->i", way, way) < radius**2
    a, b = way[close].T / radius
    powers = np.stack([np.ones_like(a), a, b, a * a, a * b, b * b], axis=1)
    return np.linalg.lstsq(powers, values[close], rcond=None)[0][0]


def number(value, form):
    return "-" if value is None else format(value, form)


def table(header, rows):
    print(f"| {' | '.join(header)} |\n|{'---|' * len(header)}")
    for row in rows:
        print(f"| {' | '.join(row)} |")
    print()


def curves(runs, chart):
    import matplotlib

    matplotlib.use("svg" if chart.suffix == ".svg" else "agg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mpm", "font.size": 10})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(8, 5), layout="constrained")
    for run in runs:
        axes.plot(run.depth, run.load / (np.pi * RADIUS**2), label=run.name, linewidth=1.2)
    axes.set(xlabel="penetration [m]", ylabel="load over the area of the base [kPa]", ylim=(0, None), xlim=(0, None))
    axes.grid(alpha=0.3)
    axes.legend()
    beside = chart.with_name(f".{chart.stem}.tmp-{os.getpid()}{chart.suffix}")
    figure.savefig(beside, metadata={"Date": None} if chart.suffix == ".svg" else None)
    os.replace(beside, chart)
    print(chart)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", nargs="*", type=Path, help="default: cases/pile/out and those beside it")
    parser.add_argument("-o", "--chart", type=Path, help="default: curves.svg in the first OUT")
    parser.add_argument("--depths", nargs="+", type=float, default=[0.6, 1.2, 1.6], help="of the pile [m]")
    parser.add_argument("--cell", type=float, default=0.2, help="size of the cells around the pile [m]")
    given = parser.parse_args()
    outs = given.out or [CASE / "out", *(CASE / f"out-{name}" for name in ("smooth", "rough", "mpm", "ddmp"))]
    lacking = [str(out) for out in outs if not (out / "points.pvd").exists()]
    if lacking:
        sys.exit(f"{', '.join(lacking)}: no points.pvd; run `cases/pile/variants.py` first")
    runs = [Run(out.resolve()) for out in outs]

    print("Load over the area of the base [kPa], the ripple of the load, how far the pile came and how long it took:\n")
    at = [f"{depth:g} m" for depth in given.depths]
    rows = []
    for run in runs:
        loads = [number(run.pressure(depth), ".2f") for depth in given.depths]
        rows.append([run.name, *loads, number(run.ripple(), ".2%"), f"{run.depth[-1]:.2f} m", number(run.seconds(), ".0f")])
    table(["run", *at, "ripple", "reached", "s"], rows)

    print("Stress at the base [kPa]:\n")
    rows = [[run.name, *(number(run.base(depth), ".2f") for depth in given.depths)] for run in runs]
    table(["run", *at], rows)

    print("Noise: rms of σ_yy about its smooth field below the base [kPa], all / a cell and more below it:\n")
    rows = []
    for run in runs:
        noise = [run.noise(depth, given.cell) for depth in given.depths]
        rows.append([run.name, *("-" if n is None else f"{n[0]:.3f} / {n[1]:.3f}" for n in noise)])
    table(["run", *at], rows)
    curves(runs, given.chart or runs[0].out / "curves.svg")


if __name__ == "__main__":
    main()
