"""The vibrating bar: its free end over the first and the last two periods, beside the closed form.

    python paraview/bar.py [OUT] [-o PICTURE]

The closed form is that of the case: an amplitude of v₀/ω and a period of 0.4 s. Reads `history.csv`.
To look at the bar in ParaView: `paraview OUT/points.pvd`, colour by `velocity [m/s]`, press Play.
"""

import numpy as np
import pyvista as pv

from common import arguments, history, quantity, save

VELOCITY, PERIOD = 0.001, 0.4  # m/s, s


def main():
    given = arguments("bar", __doc__.split("\n")[0])
    table = history(given.out / "history.csv")
    name, found = quantity(table, "ux")
    time = table["time [s]"]
    # At the start nothing has moved.
    time, found = np.insert(time, 0, 0.0), np.insert(found, 0, 0.0)
    plotter = pv.Plotter(off_screen=True, window_size=(1280, 560), shape=(1, 2), border=False)
    windows = [("first two periods", 0.0), ("last two periods", max(0.0, time[-1] - 2 * PERIOD))]
    for k, (title, start) in enumerate(windows):
        shown = (time >= start - 1e-9) & (time <= start + 2 * PERIOD + 1e-9)
        t = np.linspace(start, start + 2 * PERIOD, 400)
        exact = VELOCITY * PERIOD / (2 * np.pi) * np.sin(2 * np.pi * t / PERIOD)
        plot = pv.Chart2D(x_label="time [s]", y_label=name)
        plot.title = f"Vibrating bar, {title}"
        plot.line(t, exact, color="#c03020", width=1.5, label="closed form")
        plot.line(time[shown], found[shown], color="#1f4e9c", width=1.5, label="mpm")
        plot.scatter(time[shown], found[shown], color="#1f4e9c", size=7)
        plot.y_range = [1.2 * exact.min(), 1.6 * exact.max()]
        plot.legend_visible = True
        plotter.subplot(0, k)
        plotter.set_background("white")
        plotter.add_chart(plot)
    save(plotter, given.picture)


if __name__ == "__main__":
    main()
