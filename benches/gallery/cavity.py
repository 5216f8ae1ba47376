"""Depth of the cavity that a spudcan leaves above itself."""

from collections.abc import Callable
from pathlib import Path

import numpy as np


def cavity(diameter: float) -> Callable[[Path], float]:
    """Depth below the seabed (y = 0), over the diameter, of the clay above the can in the last frame: the mean over rings within 0.8 of the radius."""

    def found(out: Path) -> float:
        import pyvista

        reader = pyvista.get_reader(str(out / "points.pvd"))
        reader.set_active_time_value(reader.time_values[-1])
        x, y = np.asarray(reader.read()[0].points)[:, :2].T
        edges = np.linspace(0, 0.4 * diameter, 9)
        tops = [y[(x >= a) & (x < b)].max() for a, b in zip(edges, edges[1:])]
        middles = (edges[1:] + edges[:-1]) / 2
        return -float(np.average(tops, weights=middles)) / diameter

    return found
