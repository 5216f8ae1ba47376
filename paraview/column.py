"""The column under its own weight: before and after, coloured by the vertical stress it carries.

    python paraview/column.py [OUT] [-o PICTURE]

To look at it in ParaView: `paraview OUT/points.pvd`, colour by `stress [kPa]`, component YY.
"""

from common import Series, arguments, first_of, panels, pick


def main():
    given = arguments("column", __doc__.split("\n")[0])
    points = Series(given.out / "points.pvd")
    chosen = pick(points, 3)
    frames = [points.frame(i) for i in chosen]
    name = first_of(frames[-1], ["stress.yy", "mean_stress", "displacement"])
    panels(given.picture, "Column under its own weight", frames, [f"t = {points.times[i]:.3g} s" for i in chosen],
           name, columns=3)


if __name__ == "__main__":
    main()
