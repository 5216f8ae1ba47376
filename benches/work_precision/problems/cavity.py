"""The cylindrical cavity, expanded from a0 to 5 a0 in incompressible Tresca soil.

The wall of the cavity is free, and the soil is drawn outwards at its rim: in an incompressible material that differs from
a pressure p in the cavity by a uniform pressure alone. With A = a² − a0², a point that is at r now was at
√(r² − A), so that its hoop strain is ε = −½ ln(1 − A/r²), and

    σ_θθ − σ_rr = min(4 G ε, 2 s_u),     p = ∫_a^b (σ_θθ − σ_rr) dr / r

over the soil from its wall a to its rim b = √(b0² + A). With s = A/r² the elastic part of the integral is
G (Li₂(s_p) − Li₂(s_b)), s_p = 1 − exp(−s_u/G) at the border of the plastic part, whose share is 2 s_u ln(r_p/a). For
b → ∞ this is the closed form of the infinite soil, with the limit s_u (1 + ln(G/s_u)).

The curve that draws the soil is the rim itself, and its area grows. With a scheme that needs a grid in its first shape the
soil flows through the fixed curve of radius b0. What is outside by then is in balance by itself, with a free rim, so that
the integral from a to b is the jump of σ_rr at the curve: its reaction over 2π b0 times the thickness, whatever the soil
outside bears.

At ν = 0.4999 the soil swells a little as it is drawn: A is the flow through the curve less ∫ 2 r σ_m/K dr, a third of it
in the first step and a thousandth in the last. The mean stress σ_m is that of the incompressible solution, σ_rr + (σ_θθ − σ_rr)/2.
"""

import math

import numpy as np

from program import ROOT

from . import Problem, Series, Variant

STRENGTH, MODULUS = 100.0, 100.0 * 100 / 3  # s_u and G [kPa]
RADIUS, END, RIM, STEPS = 1.0, 5.0, 60.0, 200


def dilogarithm(s):
    """Li₂(s) = Σ sⁿ/n² for 0 ≤ s < 1."""
    n = np.arange(1, 4000)
    return float(np.sum(s**n / n**2))


def pressure(flow, rim):
    """p − p0 (kPa) when A = a² − a0² is `flow` (m²) and the soil ends at `rim` (m)."""
    wall = math.sqrt(RADIUS**2 + flow)
    border = 1 - math.exp(-STRENGTH / MODULUS)
    inner, outer = flow / wall**2, flow / rim**2
    if inner <= border:
        return MODULUS * (dilogarithm(inner) - dilogarithm(outer))
    if outer >= border:
        return 2 * STRENGTH * math.log(rim / wall)
    plastic = 2 * STRENGTH * math.log(math.sqrt(flow / border) / wall)
    return plastic + MODULUS * (dilogarithm(border) - dilogarithm(outer))


def swelling(flow, rim, bulk):
    """∫ 2 r σ_m/K dr (m²) from the wall to `rim` (m), by the trapezoidal rule over ln r; K is `bulk` (kPa)."""
    r = np.geomspace(math.sqrt(RADIUS**2 + flow), rim, 2000)
    deviator = np.minimum(-2 * MODULUS * np.log1p(-flow / r**2), 2 * STRENGTH)
    step = math.log(r[1] / r[0])
    radial = np.concatenate(([0], np.cumsum(0.5 * step * (deviator[1:] + deviator[:-1]))))
    share = 2 * r**2 * (radial + 0.5 * deviator) / bulk
    return float(0.5 * step * (share[1:] + share[:-1]).sum())


def opened(flow, rim, bulk):
    """A = a² − a0² (m²) when `flow` (m²) has passed the curve at `rim` (m)."""
    low, high = 0.0, flow
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + swelling(middle, rim, bulk) < flow else (low, middle)
    return low


def errors(run, settings):
    history = run.history()
    thickness, poisson = settings["mesh.parameters.h"], settings["materials.clay.poisson"]
    bulk = 2 * MODULUS * (1 + poisson) / (3 * (1 - 2 * poisson))
    fixed = settings.get("numerics.gradient", "mpm") in ("bspline", "ugimp", "cpgimp", "composite")
    travels = settings.get("numerics.restore") == "never" or not fixed
    off, limit = [], STRENGTH * (1 + math.log(MODULUS / STRENGTH))
    for moved, reaction in zip(history["outer.ux"], history["outer.reaction_x"]):
        # A curve at rest is passed by the flow b0 du, one that travels by b0 u + u²/2.
        flow = 2 * RIM * moved + (moved * moved if travels else 0)
        curve = RIM + moved if travels else RIM
        flow = opened(flow, curve, bulk)
        if RADIUS**2 + flow >= (1.05 * RADIUS) ** 2:
            found = reaction / (2 * math.pi * curve * thickness)
            off.append(abs(found - pressure(flow, math.sqrt(RIM**2 + flow))) / limit)
    return {"mean": float(np.mean(off)), "largest": float(np.max(off))}


def variant(at, h, points=None, steps=STEPS, poisson=0.4999):
    settings = {
        "mesh.parameters.h": h,
        "materials.clay.poisson": poisson,
        "materials.clay.young": 2 * (1 + poisson) * MODULUS,
        "phases[0].step.initial": 1 / steps,
    }
    if points:
        settings |= {"regions.near.points_per_cell": points, "regions.far.points_per_cell": points}
    return Variant(at, settings)


PROBLEM = Problem(
    name="cavity",
    title="Cylindrical cavity",
    text=(
        "`cases/cavity`: axisymmetric Tresca soil, G/s_u = 33.3, ν = 0.4999, expanded from a0 to 5 a0 in 200 steps; the free wall "
        "passes through the cells. The closed form takes the finite size of the soil (60 a0) into account. "
        "Errors of p − p0 over its limit s_u (1 + ln(G/s_u)), for a/a0 from 1.05 to 5."
    ),
    scene=ROOT / "cases/cavity",
    measures={"mean": "mean error of the pressure [-]", "largest": "largest error of the pressure [-]"},
    series=[
        Series("h", "a0/h", [variant(round(1 / h), h) for h in [0.5, 0.25, 0.125]], quick=(0, 1)),
        Series("points, h = a0/4", "points a cell", [variant(p, 0.25, p) for p in [4, 9, 16, 25]], quick=()),
        Series("steps, h = a0/4", "steps", [variant(s, 0.25, steps=s) for s in [100, 200, 400]], quick=()),
    ],
    errors=errors,
    points_paths=["regions.near.points_per_cell", "regions.far.points_per_cell"],
)

if __name__ == "__main__":
    # The table of the infinite soil at a/a0 = 1.05, 1.1, 1.5, 2, 5.
    print([round(pressure(a * a - 1, 1e9) / STRENGTH, 3) for a in [1.05, 1.1, 1.5, 2, 5]])
