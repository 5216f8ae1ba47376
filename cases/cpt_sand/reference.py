"""Closed forms for the cone in sand and in clay, and what a run found beside them: the tables of the README.

    .venv/bin/python cases/cpt_sand/reference.py [OUT ...] [--young 10000] [--dilation 0] [--face 0.3]

The limit pressure of a cavity in Mohr–Coulomb soil is that of Yu & Houlsby (1991), large strain, with elastic and plastic strain. `similarity` finds it again
without their series, from the velocities around a cavity that grows from nothing. The step to the resistance of a cone is one of three:

    Ladanyi & Johnston (1974)   the limit pressure of a sphere acts on the face, with its friction: 1 + tan δ/tan(half of the angle at the tip)
    Yasufuku & Hyde (1995)      a sphere beneath the base, in equilibrium with it: 1/(1 − sin φ)
    Vesic (1977)                a wedge beneath the base turns the stress; with his own limit pressure of a sphere
"""

import argparse
import csv
import math
from dataclasses import dataclass
from pathlib import Path

RADIUS, SURCHARGE = 0.018, 100.0  # of the case [m], [kPa]


@dataclass
class Sand:
    young: float = 10000.0  # [kPa]
    poisson: float = 0.3
    friction: float = 30.0  # [°]
    dilation: float = 0.0  # [°]
    face: float = 0.3  # tan δ

    @property
    def shear(self) -> float:
        """G (kPa)."""
        return self.young / 2 / (1 + self.poisson)

    @property
    def mean(self) -> float:
        """Mean stress under the surcharge between sides that are held (kPa)."""
        return SURCHARGE * (1 + 2 * self.poisson / (1 - self.poisson)) / 3

    @property
    def slopes(self) -> tuple[float, float]:
        """(1 + sin)/(1 − sin) of the angles of friction and dilation."""
        sines = (math.sin(math.radians(angle)) for angle in (self.friction, self.dilation))
        return tuple((1 + sine) / (1 - sine) for sine in sines)


def limit_pressure(sand: Sand, k: int) -> float:
    """Of a cylinder (k = 1) or a sphere (k = 2) by Yu & Houlsby, without cohesion (kPa)."""
    nu, young, p0 = sand.poisson, sand.young, sand.mean
    a, b = sand.slopes
    gamma = a * (b + k) / (k * (a - 1) * b)
    delta = (a - 1) * p0 / (2 * (k + a) * sand.shear)
    eta = math.exp((b + k) * (1 - 2 * nu) * (a - 1) * p0 * (1 + (2 - k) * nu) / (young * (a - 1) * b))
    xi = (1 - nu**2 * (2 - k)) * (1 + k) * delta / ((1 + nu) * (a - 1) * b)
    xi *= a * b + k * (1 - 2 * nu) + 2 * nu - k * nu * (a + b) / (1 - nu * (2 - k))

    def series(ratio: float) -> float:
        total, factor = 0.0, 1.0
        for n in range(300):
            factor *= xi / n if n else 1
            total += factor * math.log(ratio) if abs(n - gamma) < 1e-12 else factor / (n - gamma) * (ratio ** (n - gamma) - 1)
        return total

    low, high = 1.0, 2.0
    target = eta / gamma * (1 - delta) ** ((b + k) / b)
    while series(high) < target:
        high *= 1.2
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if series(middle) < target else (low, middle)
    return low * a * (1 + k) / (k + a) * p0


def similarity(sand: Sand, k: int) -> tuple[float, float]:
    """The same (kPa) by integration from the edge of the plastic soil inwards, and the radius of that edge over that of the cavity."""
    a, b = sand.slopes
    nu, rise = sand.poisson, (sand.slopes[0] - 1) * sand.mean / (1 + sand.slopes[0] / k)
    modulus, ratio = (sand.young / (1 - nu**2), nu / (1 - nu)) if k == 1 else (sand.young, nu)

    def rates(x: float, v: float, radial: float) -> tuple[float, float]:
        # Radii over that of the edge, velocities over that of the edge, which stays at x = 1: there the soil moves on with v − x.
        slope = -k * (radial - radial / a) / x
        along = (slope - k * ratio * slope / a) / modulus
        around = ((1 - ratio) if k == 2 else 1) * slope / a / modulus - ratio * slope / modulus
        return -(v - x) * along - k / b * (v / x + (v - x) * around), slope

    x, v, radial, step = 1.0, (1 + k) * rise / (2 * k * sand.shear), sand.mean + rise, -2e-5
    while v < x:
        dv, dr = rates(x, v, radial)
        half = x * math.exp(step / 2)
        dv, dr = rates(half, v + dv * x * step / 2, radial + dr * x * step / 2)
        v, radial, x = v + dv * half * step, radial + dr * half * step, x * math.exp(step)
    return radial, 1 / x


def cone(sand: Sand) -> dict[str, float]:
    """Resistance of a cone of 60° (kPa), by the step from the cavity to it."""
    sphere, angle = limit_pressure(sand, 2), math.radians(sand.friction)
    rigidity = sand.shear / (sand.mean * math.tan(angle))
    vesic = 3 / (3 - math.sin(angle)) * math.exp((math.pi / 2 - angle) * math.tan(angle)) * math.tan(math.pi / 4 + angle / 2) ** 2
    vesic *= rigidity ** (4 * math.sin(angle) / 3 / (1 + math.sin(angle)))
    return {
        "Ladanyi & Johnston": sphere * (1 + sand.face / math.tan(math.radians(30))),
        "Yasufuku & Hyde": sphere / (1 - math.sin(angle)),
        "Vesic": vesic * sand.mean,
    }


def teh_houlsby(rigidity: float, face: float, shaft: float, ratio: float, overburden: float) -> float:
    """N_c (-) of a cone in clay; `ratio`: horizontal over vertical stress, `overburden`: vertical stress over s_u."""
    return (1.67 + rigidity / 1500) * (1 + math.log(rigidity)) + 2.4 * face - 0.2 * shaft - 1.8 * (1 - ratio) * overburden / 2


def resistance(out: Path) -> list[tuple[float, float]]:
    """Way of the push over the radius, and the force at the tip over its area (kPa)."""
    with open(out / "history.csv", newline="") as file:
        rows = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
    start = next(row[1] for row in reversed(rows) if row[0] <= 1 + 1e-9)
    return [((start - row[1]) / RADIUS, row[2] / (math.pi * RADIUS**2)) for row in rows if row[0] > 1 + 1e-9]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", nargs="*", type=Path)
    for name in ("young", "dilation", "face"):
        parser.add_argument(f"--{name}", type=float, default=getattr(Sand, name))
    given = parser.parse_args()
    sand = Sand(young=given.young, dilation=given.dilation, face=given.face)
    for k, shape in ((2, "sphere"), (1, "cylinder")):
        again, edge = similarity(sand, k)
        print(f"limit pressure of a {shape}: {limit_pressure(sand, k):.0f} kPa ({again:.0f} by integration), plastic up to {edge:.1f} radii")
    for source, found in cone(sand).items():
        print(f"q_c by {source}: {found:.0f} kPa, {found / limit_pressure(sand, 2):.2f} times that of the sphere")
    print(f"N_c in clay (Teh & Houlsby): {teh_houlsby(500 / 2.98, 0.5, 0, 0.49 / 0.51, 4):.2f}")
    for out in given.out:
        curve = resistance(out)
        for end in range(1, math.ceil(curve[-1][0] - 0.01) + 1):
            within = [q for way, q in curve if end - 1 < way <= end + 1e-6]
            mean = sum(within) / len(within)
            print(f"{out.name}: {end - 1} to {end} R: {mean:.0f} kPa, {mean / limit_pressure(sand, 2):.2f} p_lim, N_c {(mean - SURCHARGE) / 25:.2f}, {min(within):.0f} to {max(within):.0f}")


if __name__ == "__main__":
    main()
