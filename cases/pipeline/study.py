"""Vertical and horizontal resistance of runs of the pipe, and the curves of its way.

    .venv/bin/python cases/pipeline/study.py [OUT ...] [-o CHART]

Each OUT is the output folder of a run (without: what there is of all runs of `cases/pipeline/variants.py`). Prints Markdown tables and draws the depth of the
pipe and its horizontal resistance over its way sideways to CHART (.svg or .png; without, curves.svg in the first OUT).

*V* is the vertical force of the soil when the pipe is pressed down farthest, *imbalance* the largest difference in an accepted step of later
phases between that force and its median, over the median, which is the weight of the pipe as it is meshed. *Breakout* is the horizontal resistance when the pipe has gone a fiftieth of its diameter
sideways; *H* the mean over the last metre, or what there is of it. What a run did not reach is `-`. A second table has depth and horizontal resistance on
the way.
"""

import argparse
import os
import re
import sys
from pathlib import Path

import numpy as np

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "pipeline"))
from variants import history

DIAMETER = 0.8  # [m]
WAYS = (0.016, 0.2, 0.4, 0.8, 1.2, 1.6, 2.4, 3.0, 3.5, 4.5, 5.6)  # [m]


class Run:
    """The history of an output folder, in its phases."""

    def __init__(self, out):
        self.out, self.name = out, out.name
        columns = history(out)
        self.way, self.depth = columns["core.ux"], -columns["core.uy"]
        self.vertical, self.horizontal = columns["pipe.contact_y"], -columns["pipe.contact_x"]
        self.pressed = int(np.argmax(self.depth[self.way < 1e-9]))
        self.pulled = self.way > 1e-9

    def imbalance(self):
        later = self.vertical[self.pressed + 1:]
        return np.abs(later / np.median(later) - 1).max() if len(later) else None

    def at(self, way, values):
        """A value of the pull at a way sideways."""
        return np.interp(way, self.way[self.pulled], values[self.pulled]) if self.way[-1] > way - 1e-9 else None

    def breakout(self):
        return self.at(DIAMETER / 50, self.horizontal)

    def residual(self):
        last = self.way > max(self.way[-1] - 1, DIAMETER / 50)
        return np.trapezoid(self.horizontal[last], self.way[last]) / np.ptp(self.way[last]) if last.sum() > 1 else None

    def seconds(self):
        """The time that the run took, if it was noted."""
        file = self.out / "run.txt"
        found = re.search(r"(\S+) s:", file.read_text()) if file.exists() else None
        return float(found[1]) if found else None


def number(value, form):
    return "-" if value is None else format(value, form)


def table(runs):
    header = ["run", "V [kN/m]", "imbalance", "breakout [kN/m]", "least depth [m]", "H [kN/m]", "depth at the end [m]", "reached [m]", "s"]
    print(f"| {' | '.join(header)} |\n|{'---|' * len(header)}")
    for run in runs:
        least = run.depth[run.pulled].min() if run.pulled.any() else None
        row = [run.name, f"{run.vertical[run.pressed]:.2f}", number(run.imbalance(), ".1e"), number(run.breakout(), ".2f"),
               number(least, ".3f"), number(run.residual(), ".2f"), f"{run.depth[-1]:.3f}", f"{run.way[-1]:.2f}",
               number(run.seconds(), ".0f")]
        print(f"| {' | '.join(row)} |")


def ways(runs):
    print(f"\n| way sideways [m] | {' | '.join(map(str, WAYS))} |\n|{'---|' * (len(WAYS) + 1)}")
    for run in runs:
        for name, values, form in ((f"{run.name}: depth [m]", run.depth, ".3f"), ("resistance [kN/m]", run.horizontal, ".2f")):
            print(f"| {name} | {' | '.join(number(run.at(way, values), form) for way in WAYS)} |")


def curves(runs, chart):
    import matplotlib

    matplotlib.use("svg" if chart.suffix == ".svg" else "agg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mpm", "font.size": 10})
    from matplotlib import pyplot

    figure, (above, below) = pyplot.subplots(2, figsize=(8, 7), sharex=True, layout="constrained")
    for run in runs:
        above.plot(run.way[run.pulled], -run.depth[run.pulled], label=run.name, linewidth=1.2)
        below.plot(run.way[run.pulled], run.horizontal[run.pulled], label=run.name, linewidth=1.2)
    above.set(ylabel="vertical displacement [m]")
    below.set(xlabel="horizontal displacement [m]", ylabel="horizontal resistance [kN/m]", ylim=(0, None), xlim=(0, None))
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.legend()
    beside = chart.with_name(f".{chart.stem}.tmp-{os.getpid()}{chart.suffix}")
    figure.savefig(beside, metadata={"Date": None} if chart.suffix == ".svg" else None)
    os.replace(beside, chart)
    print(chart)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", nargs="*", type=Path, help="default: cases/pipeline/out and what there is of its variants")
    parser.add_argument("-o", "--chart", type=Path, help="default: curves.svg in the first OUT")
    given = parser.parse_args()
    variants = [out for out in sorted(CASE.glob("out-*")) if (out / "history.csv").exists()]
    outs = given.out or [CASE / "out", *variants]
    lacking = [str(out) for out in outs if not (out / "history.csv").exists()]
    if lacking:
        sys.exit(f"{', '.join(lacking)}: no history.csv; run `cases/pipeline/variants.py` first")
    runs = [Run(out.resolve()) for out in outs]
    table(runs)
    ways(runs)
    curves(runs, given.chart or runs[0].out / "curves.svg")


if __name__ == "__main__":
    main()
