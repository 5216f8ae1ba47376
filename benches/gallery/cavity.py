"""What a spudcan leaves above itself, and its bearing capacity factor deep in the clay.

The can is that of geo/spudcan.geo with its default inclinations of 13° and a rim of 0.05 D; its depth is that of its widest section below the seabed, y = 0.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

SLOPE = np.tan(np.radians(13))
RIM = 0.05  # over D
MARGIN = 0.025  # over D; clay within it of the can has not flowed back


def frames(out: Path, first: float) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
    """Way of the can (m, the time at a rate of 1 m/s) from `first` on, positions x and y of the points, and their masses (t)."""
    import pyvista

    reader = pyvista.get_reader(str(out / "points.pvd"))
    for time in reader.time_values:
        if time >= first:
            reader.set_active_time_value(time)
            points = reader.read()[0]
            yield time, *np.asarray(points.points)[:, :2].T, points["mass [t]"]


def above(way: float, x: np.ndarray, y: np.ndarray, diameter: float, margin: float) -> np.ndarray:
    """Which points are above the upper side of the can, by more than a margin over D, and as far within its rim."""
    radius = diameter / 2
    depth = way - radius * SLOPE
    return (x < radius - margin * diameter) & (y > -depth + (RIM + margin) * diameter + (radius - x) * SLOPE)


def cavity(diameter: float) -> Callable[[Path], float]:
    """Depth over D at which clay first flows back onto the can: that of the cavity, which stays."""

    def found(out: Path) -> float:
        for way, x, y, _ in frames(out, diameter / 2 * SLOPE + (RIM + MARGIN) * diameter):
            if above(way, x, y, diameter, MARGIN).any():
                return (way - diameter / 2 * SLOPE) / diameter
        raise ValueError("no clay flows back onto the can")

    return found


def factor(diameter: float, depth: float, strength: float, weight: float) -> Callable[[Path], float]:
    """N_c at a depth over D: the load less the weight of clay that the can and the cavity above it have displaced, over s_u A."""

    def found(out: Path) -> float:
        radius = diameter / 2
        area = np.pi * radius**2
        way, x, y, mass = next(frames(out, depth * diameter + radius * SLOPE))
        names, *rows = [line.split(",") for line in (out / "history.csv").read_text().splitlines()]
        columns = dict(zip(names, np.array(rows, dtype=float).T))
        near = np.abs(-columns["can.uy [m]"] - way) <= 0.05 * diameter
        load = columns["can.contact_y [kN]"][near].mean()
        upon = above(way, x, y, diameter, 0)
        emptied = weight * area * (way - radius * SLOPE + radius * SLOPE / 3)  # below the seabed, down to the cone
        return (load - emptied + 9.81 * mass[upon].sum()) / (strength * area)

    return found
