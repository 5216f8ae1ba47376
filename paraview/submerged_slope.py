"""The slope whose pool is drawn down, in four moments; the line is its surface before.

    python paraview/submerged_slope.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/points.pvd OUT/surface.pvd`, colour the points by `plastic_strain [-]` and the
surface by `pressure [kPa]`, with Glyphs of `traction [kPa]`.
"""

from common import Series, arguments, panels

# Levels of the colours [-], the same in all panels.
MUCH = 0.5
# Moments [s]: the pool full, half drawn down, empty, and the last one.
MOMENTS = 1.0, 6.0, 11.0


def main():
    given = arguments("submerged_slope", __doc__.split("\n")[0])
    points, surface = Series(given.out / "points.pvd"), Series(given.out / "surface.pvd")
    nearest = lambda t: min(range(len(points)), key=lambda i: abs(points.times[i] - t))
    chosen = sorted({nearest(t) for t in (*MOMENTS, points.times[-1])})
    frames = [points.frame(i) for i in chosen]
    panels(given.picture, "Slope whose pool is drawn down", frames, [f"t = {points.times[i]:.3g} s" for i in chosen],
           "plastic_strain", columns=2, limits=(0.0, MUCH), grid=Series(given.out / "grid.pvd").frame(0),
           colours="YlOrBr", line=surface.frame(0))


if __name__ == "__main__":
    main()
