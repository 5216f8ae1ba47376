"""The cantilever: its bent shapes over the loading, coloured by displacement.

    python paraview/cantilever.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/points.pvd`, colour by `displacement [m]`, press Play.
"""

from common import Series, arguments, first_of, panels, pick


def main():
    given = arguments("cantilever", __doc__.split("\n")[0])
    points = Series(given.out / "points.pvd")
    chosen = pick(points, 4)
    frames = [points.frame(i) for i in chosen]
    name = first_of(frames[-1], ["displacement", "deviatoric_stress"])
    panels(given.picture, "Cantilever under a load at its tip", frames,
           [f"t = {points.times[i]:.3g} s" for i in chosen], name, columns=2)


if __name__ == "__main__":
    main()
