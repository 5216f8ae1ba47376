"""Bearing of a pipe that sinks into clay under its own weight."""

from collections.abc import Callable
from pathlib import Path

import numpy as np


# The weight of the clay that a pipe displaces counts with this factor, because clay heaves beside it (DNV-RP-F114, second model; Merifield, White &
# Randolph 2009 say why). The load with clay of a sixth of the weight agrees, see cases/jet_trench/README.md.
HEAVE = 1.5


def buoyancy(depth: np.ndarray) -> np.ndarray:
    """Area of the segment of a circle below a depth of its invert, over D², both over D."""
    x = np.clip(depth, 0, 1)
    return (np.arcsin(np.sqrt(4 * x * (1 - x))) * np.where(x > 0.5, -1, 1) + np.where(x > 0.5, np.pi, 0) - 2 * (1 - 2 * x) * np.sqrt(x * (1 - x))) / 4


def curve(out: Path, diameter: float, strength: float, weight: float) -> np.ndarray:
    """Depth of the invert over D and (V − 1.5 γ′ A_s)/(s_u D), A_s the area of the pipe below the seabed: rows of them, of steps with reduced strength."""
    names, *rows = [line.split(",") for line in (out / "history.csv").read_text().splitlines()]
    history = dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).T))
    reduced = history["strength_reduction"] > 1
    depth = -history["pipe.uy"][reduced] / diameter
    load = 2 * history["pipe.contact_y"][reduced] - HEAVE * weight * diameter**2 * buoyancy(depth)
    return np.column_stack([depth, load * history["strength_reduction"][reduced] / (strength * diameter)])


def bearing(at: float, diameter: float, strength: float, weight: float) -> Callable[[Path], float]:
    """That load at a depth over D."""
    return lambda out: float(np.interp(at, *curve(out, diameter, strength, weight).T))
