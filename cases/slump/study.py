"""The slump of the block, quasi-static and in motion: the numbers of the README.

    .venv/bin/python cases/slump/study.py [size of the cells in m …]     # without: 0.5 1 2
"""

import re
import sys
from pathlib import Path

import numpy as np
import pyvista

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import Failed, history, variant

WIDTH, HEIGHT = 8.0, 8.0  # of the half block [m]
EARLY = 0.3  # factor up to which the block is elastic
MOTION = {
    "phases.gravity.analysis": "dynamic",
    "phases.gravity.gravity": 1,
    "phases.gravity.step": "{initial: 0.02, min: 1.0e-4, max: 0.1}",
    "phases.gravity.duration": 8,
    "numerics.spectral_radius": 0.6,
    "supports.bottom": "{ux: 0, uy: 0}",
}


def quasi_static(h):
    with variant("slump", {"mesh.parameters.h": h} | ({"phases.gravity.step.initial": 0.05} if h > 1 else {})) as out:
        table = history(out)
    factor, down = table["time"], -table["block.uy"]
    slope = down[np.argmin(abs(factor - EARLY))] / EARLY
    begins = factor[np.argmax(down > 1.25 * slope * factor)]
    print(f"h = {h:g} m, quasi-static: the mean of the block comes down by {slope:.3f} m a unit of the factor at first, by a quarter "
          f"more than that from {begins:.3f} on; by {np.interp(0.4, factor, down):.2f} m at 0.4 and {down[-1]:.2f} m at {factor[-1]:.3f}")


def motion(h):
    with variant("slump", {"mesh.parameters.h": h} | MOTION) as out:
        kinetic = [float(e) for e in re.findall(r"^step .* kinetic (\S+)", (out / "solve.log").read_text(), re.MULTILINE)]
        reader = pyvista.get_reader(str(out / "points.pvd"))
        shapes = {}
        for time in (4.0, 8.0):
            reader.set_active_time_point(int(np.argmin(abs(np.array(reader.time_values) - time))))
            places = reader.read()[0].points
            shapes[time] = places[:, 0].max(), places[:, 1].max()
    (foot, top), (early_foot, early_top) = shapes[8.0], shapes[4.0]
    print(f"h = {h:g} m, in motion: foot at {foot:.2f} m, top at {100 * top / HEIGHT:.0f} %; from 4 s on {1000 * abs(foot - early_foot):.1f} and "
          f"{1000 * abs(top - early_top):.1f} mm; kinetic energy in the end {100 * kinetic[-1] / max(kinetic):.2f} % of its peak")


def main():
    for h in [float(size) for size in sys.argv[1:]] or [0.5, 1.0, 2.0]:
        for run in (quasi_static, motion):
            try:
                run(h)
            except Failed as why:
                print(f"h = {h:g} m: {why}")


if __name__ == "__main__":
    main()
