"""Columns of sand of several heights, plane and round: the tables of the README.

    .venv/bin/python cases/sand_column/study.py            # all of them
    .venv/bin/python cases/sand_column/study.py OUT        # in time, of a run that is there
"""

import sys
from pathlib import Path

import numpy as np
import pyvista

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import Failed, variant

WIDTH = 0.1  # of the column [m]
WITHIN = 0.995  # share of the sand that lies within the toe


def law(ratio, is_round):
    """Run-out over the width after Lube, Huppert, Sparks & Freundt (2004, 2005)."""
    if is_round:
        return 1.24 * ratio if ratio < 1.7 else 1.6 * ratio**0.5
    return 1.2 * ratio if ratio < 1.8 else 1.9 * ratio ** (2 / 3)


def settings(ratio=0.5, is_round=False, h=0.0125, step=0.002):
    """Those of a column `ratio` times as high as it is wide."""
    room = WIDTH * (2 * law(ratio, is_round) + 1.2)
    cells = {"width": WIDTH, "height": WIDTH * ratio, "room": round(room / h) * h, "above": 0.05, "h": h}
    chosen = {f"mesh.parameters.{name}": value for name, value in cells.items()}
    chosen |= {"phases.collapse.step.max": step}
    return chosen | ({"geometry": "axisymmetric"} if is_round else {})


VARIANTS = {
    "a = 0.5": (0.5, False, settings(0.5)),
    "a = 0.5, cells of 8.3 mm": (0.5, False, settings(0.5, h=0.1 / 12)),
    "a = 1, cells of 25 mm": (1, False, settings(1, h=0.025)),
    "**a = 1**": (1, False, settings(1)),
    "a = 1, steps of 1 ms": (1, False, settings(1, step=0.001)),
    "a = 1, φ = 20°": (1, False, settings(1) | {"materials.sand.friction": 20}),
    "a = 1, φ = 38°": (1, False, settings(1) | {"materials.sand.friction": 38}),
    "a = 2": (2, False, settings(2)),
    "a = 4": (4, False, settings(4)),
    "round, a = 0.5": (0.5, True, settings(0.5, True)),
}


class Shape:
    """The shape of the sand."""

    def __init__(self, points):
        place, velocity = points.points[:, :2], np.asarray(points["velocity [m/s]"])[:, :2]
        mass = np.asarray(points["mass [t]"])
        order = np.argsort(place[:, 0])
        share = np.cumsum(mass[order]) / mass.sum()
        self.toe = place[order[min(np.searchsorted(share, WITHIN), len(order) - 1)], 0]
        self.farthest = place[:, 0].max()
        self.top = place[place[:, 0] < 0.2 * WIDTH, 1].max()
        self.speed = np.median(np.hypot(velocity[:, 0], velocity[:, 1]))
        # The slope of the surface between a fifth and four fifths of the height at the axis.
        columns = np.arange(0, self.farthest, 0.1 * WIDTH)
        heights = [place[np.abs(place[:, 0] - x) < 0.1 * WIDTH, 1].max(initial=0.0) for x in columns]
        middle = [(x, y) for x, y in zip(columns, heights) if 0.2 * self.top < y < 0.8 * self.top]
        slope = np.polyfit(*zip(*middle), 1)[0] if len(middle) > 2 else np.nan
        self.angle = np.degrees(np.arctan(-slope))

    def run_out(self):
        return (self.toe - WIDTH) / WIDTH


def shapes(out):
    """Time since the face went (s) and shape of every frame."""
    reader = pyvista.get_reader(str(out / "points.pvd"))
    for number, time in enumerate(reader.time_values):
        if time > 1 - 1e-9:
            reader.set_active_time_point(number)
            yield time - 1, Shape(reader.read()[0])


def run_out(name):
    """Run-out over the width at the end of a variant, and that of the law."""
    ratio, is_round, chosen = VARIANTS[name]
    with variant("sand_column", chosen) as out:
        *_, (_, last) = shapes(out)
    return last.run_out(), law(ratio, is_round)


def main():
    if len(sys.argv) > 1:
        print("| time (s) | toe (m) | farthest (m) | height at the axis (m) | slope (°) | median speed (m/s) |\n|---|---|---|---|---|---|")
        for time, shape in shapes(Path(sys.argv[1])):
            print(f"| {time:.1f} | {shape.toe:.3f} | {shape.farthest:.3f} | {shape.top:.3f} | {shape.angle:.0f} | {shape.speed:.1e} |")
        return
    print("| column | run-out over width | law | farthest | height at the axis over that at first | slope (°) | steps, halved |\n|---|---|---|---|---|---|---|")
    for name, (ratio, is_round, chosen) in VARIANTS.items():
        try:
            with variant("sand_column", chosen) as out:
                *_, (_, last) = shapes(out)
                log = (out / "solve.log").read_text()
                steps = f"{log.count(' collapse t ')}, {log.count('halved:')}"
                farthest = (last.farthest - WIDTH) / WIDTH
                print(f"| {name} | {last.run_out():.2f} | {law(ratio, is_round):.2f} | {farthest:.2f} | {last.top / WIDTH / ratio:.2f} | {last.angle:.0f} | {steps} |", flush=True)
        except Failed as why:
            print(f"| {name} | {why} |", flush=True)


if __name__ == "__main__":
    main()
