"""The seabed slope: how it fails and runs out, in three moments, the last at rest; the line is the first surface.

    python paraview/seabed_slope.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/points.pvd`, colour by `plastic_strain [-]`, press Play.
"""

import numpy as np

from common import Series, arguments, field, first_of, panels, surface_line

# Plastic strain [-] from which on all is of one colour: the base of the slide has several times that.
MUCH = 2.0
# Moments [s] beside the last one: the slip surface is there, and half the way is done.
MOMENTS = 2.0, 4.0


def main():
    given = arguments("seabed_slope", __doc__.split("\n")[0])
    points = Series(given.out / "points.pvd")
    times = np.array(points.times)
    chosen = sorted({int(np.argmin(abs(times - t))) for t in (*MOMENTS, times[-1])})
    frames = [points.frame(i) for i in chosen]
    last = frames[-1]
    name = first_of(last, ["plastic_strain", "displacement"])
    plastic = name == "plastic_strain"
    limits = (0.0, min(MUCH, field(last, name)[1].max())) if plastic else None
    grid = Series(given.out / "grid.pvd").frame(0)
    panels(given.picture, f"Seabed slope: {last.n_points} material points", frames,
           [f"t = {times[i]:.3g} s" for i in chosen], name, grid=grid, limits=limits,
           colours="YlOrBr" if plastic else "viridis", line=surface_line(points.frame(0)), fill=1.5)


if __name__ == "__main__":
    main()
