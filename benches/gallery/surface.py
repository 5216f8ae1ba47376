"""The area that the surface of the soil encloses."""

from collections.abc import Callable
from pathlib import Path


def enclosed(out: Path, last: bool) -> float:
    """The area (m²) within the polylines of surface.pvd, soil on their left, in the first or last frame."""
    import numpy as np
    import pyvista

    reader = pyvista.get_reader(str(out / "surface.pvd"))
    reader.set_active_time_value(reader.time_values[-1 if last else 0])
    lines = reader.read()[0]
    area, cells = 0.0, lines.lines
    while len(cells):
        count, cells = cells[0], cells[1:]
        x, y = np.asarray(lines.points)[cells[:count], :2].T
        area += 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
        cells = cells[count:]
    return area


def kept() -> Callable[[Path], float]:
    """The area of the last frame over that of the first."""
    return lambda out: enclosed(out, True) / enclosed(out, False)
