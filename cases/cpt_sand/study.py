"""The pressure on a cone over its depth beside the limit pressure of a spherical cavity: the table of the README.

    .venv/bin/python cases/cpt_sand/study.py [OUT]

The limit pressure of soil with cohesion and friction is that of Yu & Houlsby (*Finite cavity expansion in dilatant soils: loading analysis*,
Géotechnique 41, 1991) at the mean stress at the depth of the tip.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
YOUNG, POISSON, COHESION, FRICTION, DILATION = 30000.0, 0.25, 1.0, 32.0, 0.0
UNIT_WEIGHT, K0, RADIUS = 10.0, 0.5, 1.0


def limit_pressure(mean: float) -> float:
    """Of a spherical cavity (kPa) in soil under a mean stress (kPa)."""
    m = 2.0
    phi, psi = math.radians(FRICTION), math.radians(DILATION)
    shear = YOUNG / (2 * (1 + POISSON))
    strength = 2 * COHESION * math.cos(phi) / (1 - math.sin(phi))
    alpha, beta = ((1 + math.sin(x)) / (1 - math.sin(x)) for x in (phi, psi))
    yields = strength + (alpha - 1) * mean
    gamma = alpha * (beta + m) / (m * (alpha - 1) * beta)
    delta = yields / (2 * (m + alpha) * shear)
    eta = math.exp((beta + m) * (1 - 2 * POISSON) * yields / (YOUNG * (alpha - 1) * beta))
    xi = (1 + m) * delta / ((1 + POISSON) * (alpha - 1) * beta) * (alpha * beta + m * (1 - 2 * POISSON) + 2 * POISSON - m * POISSON * (alpha + beta))

    def series(ratio: float) -> float:
        terms = (xi**n / math.factorial(n) / (n - gamma) * (ratio ** (n - gamma) - 1) for n in range(100))
        return sum(terms)

    # The radius grows without bounds where the sum is this.
    wanted = eta / gamma * (1 - delta) ** ((beta + m) / beta)
    low, high = 1.0, 2.0
    while series(high) < wanted:
        high *= 2
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if series(middle) < wanted else (low, middle)
    return (alpha * (1 + m) / (m + alpha) * low * yields - strength) / (alpha - 1)


def main() -> None:
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "out"
    with (out / "history.csv").open(newline="") as file:
        rows = list(csv.reader(file))[1:]
    depth, force = -np.array([row[1] for row in rows], dtype=float), np.array([row[3] for row in rows], dtype=float)
    print("| tip at [m] | load [kN] | q [kPa] | limit pressure [kPa] | ratio |\n|---|---|---|---|---|")
    for at in range(1, 1 + math.floor(depth[-1] + 1e-9)):
        load = force[abs(depth - at) < 0.1501].mean()
        pressure, limit = load / (math.pi * RADIUS**2), limit_pressure(UNIT_WEIGHT * at * (1 + 2 * K0) / 3)
        print(f"| {at} | {load:.0f} | {pressure:.0f} | {limit:.0f} | {pressure / limit:.2f} |")


if __name__ == "__main__":
    main()
