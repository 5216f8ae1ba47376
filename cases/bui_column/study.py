"""The deposit and the failure line of runs beside those of the experiment: the table of the README, and its picture.

    .venv/bin/python cases/bui_column/study.py OUT [OUT ...] [-o PICTURE]

The surface is the highest material point within 5 mm of a place. Soil has failed if it moved by more than 1 mm.
"""

import argparse
import csv
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyvista

WITHIN = 0.005  # of a place, where the highest point is taken [m]
FAILED = 0.001  # displacement [m]
SHARE = 0.995  # of the bars that lie within the toe


def experiment(name: str) -> np.ndarray:
    """The places (m) of a line of the experiment."""
    with (Path(__file__).with_name("experiment.csv")).open() as file:
        rows = [(row[f"{name}_x [mm]"], row[f"{name}_y [mm]"]) for row in csv.DictReader(file)]
    return np.array([row for row in rows if row[0]], dtype=float) / 1000


class Deposit:
    """The bars at the end of a run."""

    def __init__(self, out: Path):
        reader = pyvista.get_reader(str(out / "points.pvd"))
        reader.set_active_time_point(len(reader.time_values) - 1)
        points = reader.read()[0]
        self.place, moved = points.points[:, :2], points["displacement [m]"][:, :2]
        self.start, self.failed = self.place - moved, np.hypot(*moved.T) > FAILED
        mass = points["mass [t]"]
        order = np.argsort(self.place[:, 0])
        share = np.cumsum(mass[order]) / mass.sum()
        self.toe = self.place[order[np.searchsorted(share, SHARE)], 0]
        self.speed = np.median(np.hypot(*points["velocity [m/s]"][:, :2].T))

    def surface(self, places: np.ndarray) -> np.ndarray:
        """The height (m) of the deposit at some x (m)."""
        return np.array([self.place[abs(self.place[:, 0] - x) < WITHIN, 1].max(initial=0.0) for x in places])

    def failure(self, places: np.ndarray) -> np.ndarray:
        """The height (m), before the collapse, below which the bars stay."""

        def height(x):
            near = abs(self.start[:, 0] - x) < WITHIN
            return self.start[near & self.failed, 1].min(initial=self.start[near, 1].max())

        return np.array([height(x) for x in places])


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", nargs="+", type=Path)
    arguments.add_argument("-o", "--picture", type=Path)
    given = arguments.parse_args()
    surface, failure = experiment("surface"), experiment("failure")
    print("| run | surface, r.m.s. and largest difference (mm) | failure line, r.m.s. and largest (mm) | toe (m) | median speed (mm/s) |\n|---|---|---|---|---|")
    fig, axes = plt.subplots(figsize=(7, 2.4), layout="constrained")
    axes.plot(*(1000 * surface.T), "k^", ms=4, label="experiment, surface")
    axes.plot(*(1000 * failure.T), "kv", mfc="none", ms=4, label="experiment, failure line")
    for out in given.out:
        deposit = Deposit(out)
        texts = []
        for line, found in ((surface, deposit.surface), (failure, deposit.failure)):
            off = 1000 * (found(line[:, 0]) - line[:, 1])
            texts.append(f"{np.sqrt((off**2).mean()):.1f}, {abs(off).max():.1f}")
        print(f"| {out.name} | {texts[0]} | {texts[1]} | {deposit.toe:.3f} | {1000 * deposit.speed:.1f} |")
        x = np.arange(0, deposit.place[:, 0].max(), WITHIN)
        (drawn,) = axes.plot(1000 * x, 1000 * deposit.surface(x), lw=1, label=out.name)
        x = x[x < 0.19]
        axes.plot(1000 * x, 1000 * deposit.failure(x), "--", lw=1, color=drawn.get_color())
    axes.set(xlabel="mm", ylabel="mm", aspect="equal", xlim=(0, 620), ylim=(0, 110))
    axes.legend(fontsize=7)
    if given.picture:
        fig.savefig(given.picture, dpi=150)


if __name__ == "__main__":
    main()
