"""The collapse of the column in time, and what mesh and step change: the tables of the README.

    .venv/bin/python cases/column_collapse/study.py            # all of them
    .venv/bin/python cases/column_collapse/study.py OUT        # of a run that is there, the first one
"""

import sys
from pathlib import Path

import numpy as np
import pyvista

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import Failed, variant

WIDTH, HEIGHT = 0.2, 0.1
BIN = 0.01  # of the profile [m]
WITHIN = 0.99  # share of the bars that lies within the toe
AT_REST = HEIGHT / 50  # what has moved less has not failed [m]
COARSE = {"mesh.parameters.h": 0.02}
PLACES = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5)  # of the profile [m]
VARIANTS = {
    "h = 25 mm": {"mesh.parameters.h": 0.025},
    "h = 20 mm": COARSE,
    "h = 20 mm, steps of 1 ms at most": COARSE | {"phases.collapse.step.max": 0.001},
    "h = 10 mm": {},
    "h = 25 mm, friction of 31°": {"mesh.parameters.h": 0.025, "materials.bars.friction": 31},
}


class Shape:
    """The shape of the points: thickness by columns, as the bars have it when they lie as close as at first."""

    def __init__(self, place, displacement, volume):
        columns = np.floor(place[:, 0] / BIN + 1e-9).astype(int)
        self.thickness = np.bincount(columns, weights=volume) / BIN
        order = np.argsort(place[:, 0])
        share = np.cumsum(volume[order]) / volume.sum()
        self.toe = place[order[np.searchsorted(share, WITHIN)], 0]
        self.farthest = place[:, 0].max()
        # Among what has not moved: where it ends at the top and at the base.
        origin = place - displacement
        still = np.hypot(displacement[:, 0], displacement[:, 1]) < AT_REST

        def ends(layer):
            moved = origin[layer & ~still, 0]
            return moved.min() if len(moved) else WIDTH

        self.crest = ends(origin[:, 1] > 0.9 * HEIGHT)
        self.base = ends(origin[:, 1] < 0.1 * HEIGHT)


def shapes(out):
    """Time of the collapse (s) and shape of every frame of it."""
    volume = np.asarray(pyvista.read(out / "points.vtu")["initial_volume [m3]"])
    reader = pyvista.get_reader(str(out / "points.pvd"))
    for number, time in enumerate(reader.time_values):
        if time > 1 - 1e-9:
            reader.set_active_time_point(number)
            points = reader.read()[0]
            yield time - 1, Shape(points.points[:, :2], np.asarray(points["displacement [m]"])[:, :2], volume)


def run_out(settings):
    """Run-out over the width at the end of a variant."""
    with variant("column_collapse", settings) as out:
        *_, (_, last) = shapes(out)
    return (last.toe - WIDTH) / WIDTH


def tell(shape):
    return (
        f"{1000 * shape.toe:.0f} | {(shape.toe - WIDTH) / WIDTH:.2f} | {1000 * shape.farthest:.0f} | {1000 * shape.thickness[0]:.0f} "
        f"| {1000 * shape.crest:.0f} | {1000 * shape.base:.0f} |"
    )


def profile(shape):
    """Thickness (mm) over 20 mm about each of the places."""
    of = np.append(shape.thickness, np.zeros(100))
    columns = (round(x / BIN) for x in PLACES)
    return " | ".join(f"{500 * (of[max(c - 1, 0)] + of[c]):.0f}" for c in columns)


HEAD = "toe (mm) | run-out over width | farthest (mm) | at the wall (mm) | crest (mm) | base (mm) |"


def in_time(out):
    print(f"| time (s) | {HEAD}\n|---|---|---|---|---|---|---|")
    for time, shape in shapes(out):
        print(f"| {time:.1f} | {tell(shape)}")


def main():
    if len(sys.argv) > 1:
        in_time(Path(sys.argv[1]))
        return
    ends, profiles = [], []
    for name, settings in VARIANTS.items():
        try:
            with variant("column_collapse", settings) as out:
                print(f"\n{name}")
                in_time(out)
                *_, (_, last) = shapes(out)
                ends.append(f"| {name} | {tell(last)}")
                profiles.append(f"| {name} | {profile(last)} |")
        except Failed as why:
            ends.append(f"| {name} | {why} |")
    print(f"\n| at the end | {HEAD}\n|---|---|---|---|---|---|---|", *ends, sep="\n")
    places = " | ".join(f"{1000 * x:.0f}" for x in PLACES)
    print(f"\n| thickness (mm) at x (mm) | {places} |\n|---|" + "---|" * len(PLACES), *profiles, sep="\n")


if __name__ == "__main__":
    main()
