"""Fields of a fine solution, at any original place."""

import numpy as np

from program import solved


class Field:
    """Displacement and stress of the points of a run, linear between them."""

    def __init__(self, scene, settings=None):
        import pyvista

        with solved(scene, settings) as run:
            start, end = run.points()
        # The arrays of the cloud lie at the original places.
        cloud = pyvista.PolyData(np.array(start["origin [m]"], dtype=float))
        cloud["displacement"] = end["displacement [m]"]
        cloud["stress"] = end["stress [kPa]"]
        self.volume = np.array(start["initial_volume [m3]"])
        self.cloud = cloud
        self.surface = cloud.delaunay_2d()

    def at(self, places):
        """Displacement (m) and stress (kPa) at original places (n × 3, m), and whether they lie within."""
        import pyvista

        found = pyvista.PolyData(np.array(places, dtype=float)).sample(self.surface)
        return found["displacement"], found["stress"], found["vtkValidPointMask"].astype(bool)

    def mean(self, inside):
        """Mean displacement (m) over the volume of the points whose original places satisfy `inside`."""
        chosen = inside(self.cloud.points)
        return np.average(self.cloud["displacement"][chosen], axis=0, weights=self.volume[chosen])
