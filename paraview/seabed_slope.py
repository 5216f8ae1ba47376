"""The seabed slope: how it fails and runs out, in four moments from the first to the last.

    python paraview/seabed_slope.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/points.pvd`, colour by `plastic_strain [-]`, press Play.
"""

from common import Series, arguments, first_of, panels, pick


def main():
    given = arguments("seabed_slope", __doc__.split("\n")[0])
    points = Series(given.out / "points.pvd")
    chosen = pick(points, 4)
    frames = [points.frame(i) for i in chosen]
    name = first_of(frames[-1], ["plastic_strain", "displacement"])
    last = frames[-1]
    grid = Series(given.out / "grid.pvd").frame(0)
    panels(given.picture, f"Seabed slope: {last.n_points} material points",
           frames, [f"t = {points.times[i]:.3g} s" for i in chosen], name, grid=grid,
           colours="YlOrBr" if name == "plastic_strain" else "viridis")


if __name__ == "__main__":
    main()
