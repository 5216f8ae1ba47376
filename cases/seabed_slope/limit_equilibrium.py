"""Factor of safety of the slope by limit equilibrium: slip circles in undrained clay (phi = 0).

    python cases/seabed_slope/limit_equilibrium.py              the slope of case.yaml
    python cases/seabed_slope/limit_equilibrium.py --check      against published numbers

Moments about the centre of a circle: what holds is R * integral of s_u along the arc, what drives is the weight of
the soil above the arc times its lever (Fellenius 1927, Taylor 1937). With phi = 0 nothing else enters, so there
are no slices and no assumptions about forces between them. The factor of safety is the least ratio over all circles
that enter through the crest and leave through the slope or the plain, no deeper than the firm base.
It is an upper bound: each circle is a mechanism, and the slip surface need not be one.

The toe is at (0, 0), the slope rises to the left up to the crest at y = height; lengths in m, stresses in kPa.
"""

import argparse
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Nodes and weights for integrals over [0, 1].
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
NODES, WEIGHTS = 0.5 * (NODES[:, None] + 1), 0.5 * WEIGHTS[:, None]


@dataclass
class Slope:
    height: float
    angle: float  # degrees
    base: float  # of soil below the toe, down to the firm base
    crest: float  # length, beyond which no circle enters
    plain: float  # length, beyond which no circle leaves
    weight: float  # unit weight [kN/m3], of the submerged soil under water
    top: float  # strength at the crest [kPa]
    gradient: float  # of the strength, growing downwards [kPa/m]

    @property
    def run(self):
        return 0.0 if self.angle == 90 else self.height / np.tan(np.radians(self.angle))

    def ground(self, x):
        """The height of the ground."""
        if self.run == 0:
            return np.where(x < 0, self.height, 0.0)
        return np.clip(-x / self.run, 0, 1) * self.height

    def strength(self, y):
        return self.top + self.gradient * (self.height - y)


@dataclass
class Circles:
    """Any number of circles: centres, radii, and where they enter through the crest and leave. Arrays."""

    x: np.ndarray
    y: np.ndarray
    radius: np.ndarray
    enter: np.ndarray
    leave: np.ndarray

    @property
    def deepest(self):
        """The least height of the arc."""
        return np.where(self.leave > self.x, self.y - self.radius, 0.0)


def circles(slope, enter, leave, sagitta):
    """The circles through the crest at `enter` and the ground at `leave`, with the sagitta over their chords."""
    low = slope.ground(leave)
    chord = np.hypot(leave - enter, slope.height - low)
    radius = chord * (0.25 + sagitta**2) / (2 * sagitta)
    above = (radius - sagitta * chord) / chord
    x = 0.5 * (enter + leave) + above * (slope.height - low)
    y = 0.5 * (slope.height + low) + above * (leave - enter)
    return Circles(x, y, radius, enter, leave)


def touching(slope, enter, leave):
    """The sagittas over their chords of the circles that touch the firm base, by bisection; 0.5 where none does."""
    low, high = np.full(enter.shape, 1e-3), np.full(enter.shape, 0.5)
    for _ in range(40):
        middle = 0.5 * (low + high)
        above = circles(slope, enter, leave, middle).deepest > -slope.base
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return low


def safety(slope, c):
    """The factors of safety; infinite where a circle is not admissible."""
    good = (c.y >= slope.height) & (c.deepest >= -slope.base - 1e-9)
    good &= (c.leave - c.x < c.radius) & (c.x - c.enter < c.radius)
    good &= (c.enter >= -slope.run - slope.crest) & (c.leave <= slope.plain)
    # The ground has corners at the crest and the toe: integrate between them.
    ends = [c.enter, np.clip(-slope.run, c.enter, c.leave), np.clip(0.0, c.enter, c.leave), c.leave]
    drive = 0.0
    for x0, x1 in zip(ends, ends[1:]):
        x = x0 + (x1 - x0) * NODES
        depth = slope.ground(x) - c.y + np.sqrt(np.maximum(c.radius**2 - (x - c.x) ** 2, 0))
        good &= (depth > -1e-9).all(axis=0)
        drive = drive + (x1 - x0) * np.sum(WEIGHTS * depth * (c.x - x), axis=0)
    first, last = (np.arcsin(np.clip((x - c.x) / c.radius, -1, 1)) for x in (c.enter, c.leave))
    y = c.y - c.radius * np.cos(first + (last - first) * NODES)
    hold = c.radius**2 * (last - first) * np.sum(WEIGHTS * slope.strength(y), axis=0)
    good &= drive > 0
    return np.where(good, hold / (slope.weight * np.where(good, drive, 1.0)), np.inf)


def search(slope):
    """The least factor of safety and its circle: a grid over entry, exit and sagitta, refined around the best."""
    low = np.array([-slope.run - slope.crest, -0.9 * slope.run, 0.005])
    high = np.array([-slope.run - 1e-6 * slope.height, slope.plain, 0.5])
    best, found, centre, width = np.inf, None, 0.5 * (low + high), 0.5 * (high - low)
    for count in [41] + [9] * 25:
        axes = [np.clip(m + w * np.linspace(-1, 1, count), l, h) for m, w, l, h in zip(centre, width, low, high)]
        axes[1] = np.append(axes[1], 0.0)  # circles through the toe
        enter, leave, sagitta = (a.ravel() for a in np.meshgrid(*axes, indexing="ij"))
        for s in (sagitta, touching(slope, enter, leave)):
            c = circles(slope, enter, leave, s)
            f = safety(slope, c)
            i = np.argmin(f)
            if f[i] < best:
                best, centre = f[i], np.array([enter[i], leave[i], s[i]])
                found = Circles(c.x[i], c.y[i], c.radius[i], c.enter[i], c.leave[i])
        if found is None:
            raise SystemExit("no admissible circle")
        width = width * (0.15 if count == 41 else 0.7)
    return best, found


def of_case(path):
    """The slope of the case file, with the lengths of its `.geo` where the case does not give them."""
    text = path.read_text()

    def number(pattern):
        found = re.search(pattern + r" *(-?[0-9.]+)", text)
        if not found:
            raise SystemExit(f"{path}: there is no number after {pattern!r}")
        return float(found[1])

    geo = (path.parent / "../../geo/seabed_slope.geo").read_text()
    lengths = {name: float(re.search(rf"{name} *= *\{{([0-9.]+)", geo)[1])
               for name in ("height", "angle", "base", "crest", "plain")}
    for name in lengths:
        if re.search(rf"\b{name}:", text):
            lengths[name] = number(rf"\b{name}:")
    return Slope(weight=-number("gravity: {y:") * number("density:"), top=number("shear_strength: {top:"),
                 gradient=number(r"shear_strength: {top: [0-9.]+, gradient:"), **lengths)


# Taylor (1937): 1/N for toe circles that do not dip below the toe, and for deep circles at any angle below 53 degrees.
TAYLOR = [(90, 1e-3, 0.261), (75, 1e-3, 0.219), (60, 1e-3, 0.191), (45, 20.0, 0.181), (30, 40.0, 0.181)]


def check():
    """Compares with published numbers and a closed form; returns whether all agree."""
    good = True
    print("stability number N = F * weight * height / s_u of constant strength, Taylor (1937)")
    for angle, base, published in TAYLOR:
        slope = Slope(5, angle, base, 6 * base + 15, 6 * base + 15, 1.0, 1.0, 0.0)
        n = search(slope)[0] * slope.height
        good &= abs(n * published - 1) < 0.005
        print(f"  angle {angle:2d}, base {base / 5:.0f} heights below the toe: N = {n:.3f}, published {1 / published:.2f}")
    print("plane through the toe, strength k y below the crest: F * weight / k, flattest circles and closed form")
    for angle, plane in [(90, 45.0), (60, 30.0), (45, 22.5)]:
        slope = Slope(5, angle, 1.0, 100, 100, 1.0, 0.0, 1.0)
        cot = lambda degrees: 1 / np.tan(np.radians(degrees))
        exact = 1 / (np.sin(np.radians(plane)) ** 2 * (cot(plane) - cot(angle)))
        f = safety(slope, circles(slope, np.array([-slope.height * cot(plane)]), np.array([0.0]), 1e-5))[0]
        good &= abs(f / exact - 1) < 1e-3
        print(f"  angle {angle:2d}, plane {plane:4.1f}: {f:.4f}, closed form {exact:.4f}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true", help="compare with published numbers instead")
    if parser.parse_args().check:
        raise SystemExit(0 if check() else "the numbers do not agree")
    slope = of_case(Path(__file__).with_name("case.yaml"))
    least, c = search(slope)
    print(f"factor of safety {least:.4f}")
    print(f"circle: centre ({c.x:.2f}, {c.y:.2f}) m, radius {c.radius:.2f} m, "
          f"from x = {c.enter:.2f} m on the crest to x = {c.leave:.2f} m, down to y = {c.deepest:.2f} m")


if __name__ == "__main__":
    main()
