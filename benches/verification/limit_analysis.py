"""Upper bound of the load on a rigid body of rectangular section in weightless clay (Tresca, s_u = 1 kPa) that it cannot part from.

    .venv/bin/python benches/verification/limit_analysis.py --body X0 X1 Y0 Y1 [--round] [--adhesion A] [--size H] [--growth G] [--width W] [--beneath D]
        [--layer DEPTH RATIO]

The body lies between X0 and X1 and between Y0 and Y1 (m); clay lies from the axis of symmetry x = 0 to W and from D below the body to its surface y = 0.
A body that ends at y = 0 goes through the surface. It moves by one downwards; the load upwards is the same. With --layer the strength of the clay below DEPTH (m)
is 1/RATIO kPa.

Velocities are quadratic in triangles, with sizes H at the corners of the body that grow by G from cell to cell. The work done on the flow is least for the velocities
that keep the volume (at the corners of straight triangles in plane strain, which makes it a strict bound; at three points within them with --round)
and is `s_u |γ|`, and `A s_u` times the slip on the body (Makrodimopoulos & Martin 2007). A second-order cone programme finds it. It lies above the exact load by a part
proportional to H: twice the value with H/2 less that with H is nearer. Prints the load over s_u (m², per metre or full turn), of both halves in plane strain.
Needs numpy, scipy and clarabel: .venv/bin/pip install scipy clarabel
"""

import argparse
import math

import clarabel
import numpy as np
import scipy.sparse as sparse
from scipy.optimize import brentq

SAME = 1e-8


def sizes(length: float, size: float, growth: float) -> np.ndarray:
    """Places from `size` to `length`, at distances that grow."""
    count = max(1, int(np.ceil(np.log(1 + length * (growth - 1) / size) / np.log(growth))))
    total = lambda q: size * sum(q**i for i in range(count)) - length
    ratio = brentq(total, 1 + 1e-9, growth + 1) if total(1 + 1e-9) < 0 else 1.0
    places = np.cumsum([ratio**i for i in range(count)])
    return length * places / places[-1]


def line(low: float, begin: float, end: float, high: float, size: float, growth: float) -> np.ndarray:
    """Places along an axis, finest at both ends of the body."""
    parts = [np.array([low, begin, end, high])]
    parts += [begin - sizes(begin - low, size, growth)] if begin > low else []
    parts += [end + sizes(high - end, size, growth)] if high > end else []
    half = sizes((end - begin) / 2, size, growth) if low < begin or high > end else np.array([])
    parts += [begin + half] if begin > low else []
    parts += [end - half] if high > end else []
    if begin <= low or high <= end:  # The body begins on the axis, or goes through the surface.
        parts += [end - sizes(end - begin, size, growth)] if begin <= low else [begin + sizes(end - begin, size, growth)]
    places = np.sort(np.concatenate(parts))
    return places[np.append(True, np.diff(places) > 0.2 * size)]


def layered(places: np.ndarray, interface: float, body: float) -> np.ndarray:
    """Places with one at an interface of layers below a body, and distances that grow from there by a half."""
    reach = [0.03 * 1.5**k for k in range(8)]
    near = [interface, *(interface - r for r in reach), *(interface + r for r in reach if interface + r < body - 0.05)]
    far = [y for y in places if y >= body or y == places[0] or min(abs(y - n) for n in near) > 0.02]
    return np.unique(np.round(np.append(far, [n for n in near if n > places[0]]), 9))


def shape(r: float, s: float) -> tuple[np.ndarray, np.ndarray]:
    """Values and derivatives of the six functions of a triangle."""
    l, d = np.array([1 - r - s, r, s]), np.array([[-1.0, -1], [1, 0], [0, 1]])
    sides = [(0, 1), (1, 2), (2, 0)]
    value = np.concatenate([l * (2 * l - 1), [4 * l[a] * l[b] for a, b in sides]])
    slope = np.array([(4 * l[k] - 1) * d[k] for k in range(3)] + [4 * (l[a] * d[b] + l[b] * d[a]) for a, b in sides])
    return value, slope


class Program:
    """minimise c·x where equations are zero, inequalities at most zero, and (x_k, a, b) in cones."""

    def __init__(self) -> None:
        self.cost: list[float] = []
        self.rows: dict[str, list] = {"zero": [], "least": [], "cone": []}

    def unknown(self, cost: float = 0.0) -> int:
        self.cost.append(cost)
        return len(self.cost) - 1

    def solve(self) -> tuple[str, float]:
        kinds = [("zero", clarabel.ZeroConeT), ("least", clarabel.NonnegativeConeT)]
        cones = [cone(len(self.rows[kind])) for kind, cone in kinds]
        cones += [clarabel.SecondOrderConeT(3) for _ in range(len(self.rows["cone"]) // 3)]
        rows = [row for kind in ("zero", "least", "cone") for row in self.rows[kind]]
        entries = [(i, k, v) for i, (terms, _) in enumerate(rows) for k, v in terms.items()]
        i, k, v = zip(*entries)
        count = len(self.cost)
        matrix = sparse.csc_matrix((v, (i, k)), shape=(len(rows), count))
        settings = clarabel.DefaultSettings()
        settings.verbose, settings.max_threads = False, 1
        right = np.array([-constant for _, constant in rows])
        found = clarabel.DefaultSolver(sparse.csc_matrix((count, count)), np.array(self.cost), matrix, right, cones, settings).solve()
        return str(found.status), found.obj_val


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--body", required=True, nargs=4, type=float)
    parser.add_argument("--round", action="store_true", help="axisymmetry")
    parser.add_argument("--adhesion", type=float, default=1.0)
    parser.add_argument("--size", type=float, default=0.01)
    parser.add_argument("--growth", type=float, default=1.33)
    parser.add_argument("--width", type=float, default=5.0)
    parser.add_argument("--beneath", type=float, default=2.0)
    parser.add_argument("--layer", nargs=2, type=float, metavar=("DEPTH", "RATIO"), default=[math.inf, 1.0])
    chosen = parser.parse_args()
    depth, ratio = chosen.layer
    x0, x1, y0, y1 = chosen.body
    base = y0 - chosen.beneath
    xs = line(0.0, x0, x1, chosen.width, chosen.size, chosen.growth)
    ys = line(base, y0, y1, 0.0, chosen.size, chosen.growth)
    if depth < math.inf:
        ys = layered(ys, -depth, y0)
    within = lambda x, y: x0 - SAME <= x <= x1 + SAME and y0 - SAME <= y <= y1 + SAME

    number: dict[tuple[int, int], int] = {}
    place: list[tuple[float, float]] = []

    def node(x: float, y: float) -> int:
        key = (round(x * 1e9), round(y * 1e9))
        if key not in number:
            number[key] = len(place)
            place.append((x, y))
        return number[key]

    triangles = []
    for a, b in zip(xs, xs[1:]):
        for c, d in zip(ys, ys[1:]):
            middle = ((a + b) / 2, (c + d) / 2)
            if within(*middle):
                continue
            corners = [(a, c), (b, c), (b, d), (a, d)]
            for k in range(4):
                v = np.array([corners[k], corners[(k + 1) % 4], middle])
                sides = [(v[i] + v[(i + 1) % 3]) / 2 for i in range(3)]
                triangles.append(([node(*p) for p in (*v, *sides)], v))

    given: dict[int, float] = {}
    for n, (x, y) in enumerate(place):
        if x < SAME or x > chosen.width - SAME:
            given[2 * n] = 0.0
        if y < base + SAME:
            given[2 * n] = given[2 * n + 1] = 0.0
        if within(x, y):
            if min(abs(x - x0), abs(x - x1)) < SAME:
                given[2 * n] = 0.0
            if min(abs(y - y0), abs(y - y1)) < SAME and not (y1 > -SAME and y > y1 - SAME and y > y0 + SAME):
                given[2 * n + 1] = -1.0
    program = Program()
    unknown = {k: program.unknown() for k in range(2 * len(place)) if k not in given}

    def linear(*parts: tuple[float, dict[int, float]]) -> tuple[dict[int, float], float]:
        terms: dict[int, float] = {}
        constant = 0.0
        for factor, part in parts:
            for k, v in part.items():
                if k in given:
                    constant += factor * v * given[k]
                elif v != 0.0:
                    terms[unknown[k]] = terms.get(unknown[k], 0.0) + factor * v
        return terms, constant

    def at_most(value: tuple[dict[int, float], float], bound: int) -> None:
        """|value| ≤ x_bound"""
        for sign in (1.0, -1.0):
            terms = {k: sign * v for k, v in value[0].items()}
            program.rows["least"].append((terms | {bound: -1.0}, sign * value[1]))

    points = [(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)] if chosen.round else [(0, 0), (1, 0), (0, 1)]
    for nodes, v in triangles:
        jacobian = np.array([v[1] - v[0], v[2] - v[0]]).T
        strength = 1.0 if v[:, 1].mean() > -depth else 1.0 / ratio
        area, inverse = abs(np.linalg.det(jacobian)) / 2, np.linalg.inv(jacobian)
        for value, slope in (shape(*p) for p in points):
            gradient = slope @ inverse
            radius = value @ np.array([place[n][0] for n in nodes])
            weight = strength * area / 3 * (2 * np.pi * radius if chosen.round else 2.0)
            xx = {2 * n: g[0] for n, g in zip(nodes, gradient)}
            yy = {2 * n + 1: g[1] for n, g in zip(nodes, gradient)}
            shear = {2 * n: g[1] for n, g in zip(nodes, gradient)} | {2 * n + 1: g[0] for n, g in zip(nodes, gradient)}
            hoop = {2 * n: w / radius for n, w in zip(nodes, value)} if chosen.round else {}
            volume = linear((1, xx), (1, yy), (1, hoop))
            if volume[0]:
                program.rows["zero"].append(volume)
            rate = program.unknown(0.0 if chosen.round else weight)  # At least the difference of the principal rates in the plane.
            cone = [({}, 0.0), linear((1, xx), (-1, yy)), linear((1, shear))]
            cone[0] = ({rate: 1.0}, 0.0)
            # clarabel: b − A x in the cone.
            program.rows["cone"] += [({k: -w for k, w in terms.items()}, -constant) for terms, constant in cone]
            if chosen.round:  # Twice the largest principal rate.
                most, around = program.unknown(weight), program.unknown()
                at_most(linear((1, hoop)), around)
                program.rows["least"] += [({rate: 1.0, around: 1.0, most: -1.0}, 0.0), ({around: 2.0, most: -1.0}, 0.0)]
    gauss = [(0.5 - np.sqrt(0.15), 5 / 18), (0.5, 4 / 9), (0.5 + np.sqrt(0.15), 5 / 18)]
    for nodes, v in triangles if chosen.adhesion > 0 else []:
        ends, strength = v[:2], 1.0 if v[:, 1].mean() > -depth else 1.0 / ratio
        for k, sides in ((1, (x0, x1)), (0, (y0, y1))):
            other = 1 - k
            on = all(within(*p) and min(abs(p[other] - s) for s in sides) < SAME for p in ends)
            if not on or abs(ends[0][other] - ends[1][other]) > SAME:
                continue
            for t, w in gauss:
                values = [(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)]
                radius = (1 - t) * ends[0][0] + t * ends[1][0]
                length = strength * w * np.linalg.norm(ends[1] - ends[0]) * (2 * np.pi * radius if chosen.round else 2.0)
                slip = linear((1, {2 * nodes[i] + k: value for i, value in zip((0, 1, 3), values)}))
                at_most((slip[0], slip[1] + k), program.unknown(chosen.adhesion * length))
    status, work = program.solve()
    print(f"size {chosen.size:g}, {len(triangles)} triangles: {status}, load over s_u {work:.4f}")


if __name__ == "__main__":
    main()
