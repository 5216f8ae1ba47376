"""What a spudcan leaves above itself, and its bearing capacity factor deep in the clay.

The can is that of geo/spudcan.geo with its default inclinations of 13° and a rim of 0.05 D; its depth is that of its widest section below the seabed, y = 0.

    .venv/bin/python benches/gallery/cavity.py OUT [OUT …]      # both by depth
"""

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Can:
    """A can, and the clay of one strength that it is pushed into at 1 m/s from its tip at the seabed on."""

    diameter: float  # m
    strength: float  # kPa
    weight: float  # submerged, kN/m³

    @property
    def area(self) -> float:
        return np.pi * self.diameter**2 / 4

    @property
    def cone(self) -> float:
        """Height of the cone below the widest section, and of that above the rim (m)."""
        return self.diameter / 2 * np.tan(np.radians(13))

    @property
    def rim(self) -> float:
        return 0.05 * self.diameter

    def frames(self, out: Path) -> Iterator[tuple[float, float]]:
        """Depth of the can over D, and volume of the clay upon it over its area (m), in each frame."""
        import pyvista

        reader = pyvista.get_reader(str(out / "points.pvd"))
        for time in reader.time_values:
            reader.set_active_time_value(time)
            points = reader.read()[0]
            (x, y), depth = np.asarray(points.points)[:, :2].T, time - self.cone
            radius = self.diameter / 2
            upon = (x < radius) & (y > -depth + self.rim + self.cone * (1 - x / radius))
            yield depth / self.diameter, 9.81 * float(points["mass [t]"][upon].sum()) / (self.weight * self.area)

    def curve(self, out: Path) -> np.ndarray:
        """Depth over D, mean depth of the cavity over D, and N_c: rows of them.

        The cavity is what is open between the can and the seabed, as if it were a cylinder of the can's diameter. N_c is the load, less the weight of the clay
        that the can and the cavity have displaced, over s_u A.
        """
        names, *rows = [line.split(",") for line in (out / "history.csv").read_text().splitlines()]
        history = dict(zip(names, np.array(rows, dtype=float).T))
        found = []
        for depth, upon in self.frames(out):
            if depth <= 0.1:
                continue
            open_above = depth * self.diameter - self.rim - self.cone / 3 - upon
            displaced = depth * self.diameter + self.cone / 3 - upon
            near = np.abs(-history["can.uy [m]"] - self.cone - depth * self.diameter) <= 0.05 * self.diameter
            load = history["can.contact_y [kN]"][near].mean()
            found.append([depth, open_above / self.diameter, (load / self.area - self.weight * displaced) / self.strength])
        return np.array(found)

    def cavity(self) -> Callable[[Path], float]:
        """Mean depth over D of the cavity above the can, when clay of 0.01 D, on average, lies on the can: when it begins to flow back."""

        def found(out: Path) -> float:
            depth, open_above = self.curve(out)[:, :2].T
            upon = depth - (self.rim + self.cone / 3) / self.diameter - open_above
            first = int(np.argmax(upon > 0.01))
            return float(np.interp(0.01, upon[first - 1 : first + 1], open_above[first - 1 : first + 1]))

        return found

    def factor(self, depth: float) -> Callable[[Path], float]:
        """N_c at a depth over D."""
        return lambda out: float(np.interp(depth, *self.curve(out)[:, [0, 2]].T))


if __name__ == "__main__":
    for folder in sys.argv[1:]:
        text = (Path(folder) / "provenance/solve.json").read_text()
        given = [float(part.split("=")[1].split('"')[0]) for part in text.split() if "shear_strength=" in part]
        can = Can(12, given[0] if given else 20, 7)
        print(f"{folder}: s_u {can.strength:g} kPa\n| d/D | cavity/D | N_c |\n|---|---|---|")
        for row in can.curve(Path(folder))[::4]:
            print("| {:.2f} | {:.3f} | {:.2f} |".format(*row))
