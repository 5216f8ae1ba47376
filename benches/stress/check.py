"""What a run left behind, held against what every run must keep to."""

import math
import re

import numpy as np

STEP = re.compile(r"^step (\d+) \S+ t (\S+) dt (\S+) iterations (\d+) residuals ([-+.\deE a-zA-Z]*?) by (\w+) mass (\S+)")
ENDED = "the analysis ends here"
TOLERANCE = 1.05e-8  # of Newton, as the log rounds it
ACCEPTABLE = 1e-3  # of soil with friction that follows prescribed displacements


def log(text, finished, duration, mass):
    """Faults of solve.log, of a case of the mass [t].

    >>> line = "step 1 load t {} dt 1.0e0 iterations 1 residuals 1.0e0 {} by Cholesky mass {} elastic {}"
    >>> def faults(time="1.0", residual="1.0e-9", mass="2.000000000000e0", elastic="0.0", finished=True, end=""):
    ...     return log("\\n".join([line.format(time, residual, mass, elastic), end]), finished, 1.0, 2.0)
    >>> faults()
    []
    >>> faults(residual="2.0e-8")
    ['step 1 was accepted with the residual 2e-08']
    >>> faults(elastic="0.0 accepted with the residual 2.0e-4", residual="2.0e-4")
    []
    >>> faults(mass="2.000000000100e0")
    ['mass 2.000000000100e0 t in step 1 beside 2.0 t']
    >>> faults(elastic="NaN")[0][:12], faults(residual="inf")[0][:12]
    ('not finite: ', 'not finite: ')
    >>> faults(time="0.5"), faults(time="0.5", finished=False)
    (['done at t = 0.5 of 1.0'], ['ended early without a message in the log'])
    >>> faults(time="0.5", finished=False, end="the analysis ends here: Newton: ...")
    []
    >>> faults(time="0.5", end="factor of safety 1.20 to 1.21 (phase `load`): ...")
    []
    """
    faults, time, last = [], 0.0, None
    lines = text.splitlines()
    for line in lines:
        # Messages and methods may hold letters; the numbers themselves must be finite.
        if re.search(r"(?<![a-zA-Z])(nan|inf)(?![a-zA-Z])", line, re.IGNORECASE) and not line.startswith(("  halved", ENDED)):
            faults.append(f"not finite: {line[:100]}")
        match = STEP.match(line)
        if not match:
            if line.startswith("step "):
                faults.append(f"unknown line: {line[:100]}")
            continue
        last = float(match[2])
        if last <= time:
            faults.append(f"time stands still in step {match[1]}")
        time = last
        residual = float(match[5].split()[-1])
        # What the log says was accepted before the goal was reached.
        if not residual <= (ACCEPTABLE if "accepted with the residual" in line else TOLERANCE):
            faults.append(f"step {match[1]} was accepted with the residual {residual:g}")
        if abs(float(match[7]) - mass) > 1e-11 * mass:
            faults.append(f"mass {match[7]} t in step {match[1]} beside {mass} t")
    # A search for failure ends the run where it finds it.
    searched = any(line.startswith("factor of safety") for line in lines)
    if finished and not searched and not (last is not None and math.isclose(last, duration, rel_tol=1e-8, abs_tol=1e-9)):
        faults.append(f"done at t = {last} of {duration}")
    if not finished and not (lines and any(line.startswith(ENDED) for line in lines[-2:])):
        faults.append("ended early without a message in the log")
    return faults


def history(text):
    """Faults of history.csv."""
    rows = np.array([line.split(",") for line in text.splitlines()[1:]], dtype=float)
    return [] if np.isfinite(rows).all() else ["history.csv: not finite"]


def frames(out, start, count):
    """Faults of the `start` (points.vtu) and of the exported points and grids: all finite, nothing of the `count` material points lost or inside out.

    Points are split and merged: their mass stays.
    """
    import pyvista

    faults = []
    if start["mass [t]"].min() < 0 or start["initial_volume [m3]"].min() <= 0:
        faults.append("points.vtu: a mass or volume is not positive")
    seeded = start["mass [t]"][:count].sum()
    for path in sorted((out / "vtu").glob("*.vtu")):
        data = pyvista.read(path)
        arrays = {"positions": data.points, **{name: data.point_data[name] for name in data.point_data}}
        for name, values in arrays.items():
            # There is no gap where no soil is near.
            if not name.startswith("contact_gap") and not np.isfinite(values).all():
                faults.append(f"{path.name}: {name} is not finite")
        if path.name.startswith("points"):
            mass = data["mass [t]"].sum()
            if abs(mass - seeded) > 1e-11 * seeded:
                faults.append(f"{path.name}: points of {mass} t, {seeded} t were seeded")
            for name in data.point_data:
                if name.startswith("deformation_gradient"):
                    ratio = np.linalg.det(np.asarray(data[name]).reshape(-1, 3, 3))
                    if ratio.min() <= 0:
                        faults.append(f"{path.name}: det F = {ratio.min():.2e}")
    return faults
