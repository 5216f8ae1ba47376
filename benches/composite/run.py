#!/usr/bin/env python3
"""Composite points in one dimension: error and Newton iterations by tangent, and by how full a neighbour must be.

    .venv/bin/python benches/composite/run.py [cells …]     # without: 8 16 32 64

The self-weight column of docs/schemes.md (l0 = 50 m, E = 10 kPa, ρ g l0/E = 4, 40 steps with a reset in each, four points a cell), iterated
to a residual of 1e-8. It prints the two tables of docs/schemes.md, and needs NumPy only.
"""

import sys

import numpy as np

HEIGHT, YOUNG, STEPS, EACH, TOLERANCE = 50.0, 10.0, 40, 4, 1e-8
WEIGHT = 4 * YOUNG / HEIGHT  # [kPa/m]
SIZES = tuple(map(int, sys.argv[1:])) or (8, 16, 32, 64)


def hat(t):
    return np.clip(1 - np.abs(t), 0, None)


def hat_integral(t):
    t = np.clip(t, -1, 1)
    return np.where(t < 0, 0.5 * (1 + t) ** 2, 1 - 0.5 * (1 - t) ** 2)


def lagrange_slopes(places, x):
    """The derivatives at x of the polynomials that are one at a place and zero at the others."""
    slopes = []
    for i, own in enumerate(places):
        others = np.delete(places, i)
        products = [np.prod([x - b for b in np.delete(others, j)]) for j in range(len(others))]
        slopes.append(sum(products) / np.prod(own - others))
    return slopes


def functions(x, length, cell, h, cells, composite, filled):
    """Values and gradients of GIMP, and the gradients of strains, point by point and node by node."""
    last = cell.max()
    count = last + 2
    reach = np.minimum(x - np.maximum(0, (cell - 1) * h), np.minimum((last + 1) * h, (cell + 2) * h) - x)
    half = np.minimum(0.5 * length, reach)
    a, b, node = (x - half)[:, None], (x + half)[:, None], np.arange(count) * h
    value = (hat_integral((b - node) / h) - hat_integral((a - node) / h)) * h / (b - a)
    force = (hat((b - node) / h) - hat((a - node) / h)) / (b - a)
    if not composite:
        return value, force, force
    strain = force.copy()
    full = np.bincount(cell, weights=length, minlength=cells) >= filled * h
    for p, c in enumerate(cell):
        patch = np.arange(max(c - 1, 0), min(c + 3, cells + 1))
        if full[patch[:-1]].all():
            strain[p] = 0
            strain[p, patch] = lagrange_slopes(patch * h, x[p])
    return value, force, strain


def double_mapping(modulus, volume, value, cell, h):
    """The stiffness of two Gauss points a cell, with the moduli of the points mapped to the nodes and from there."""
    count = value.shape[1]
    nodal = (value.T @ (volume * modulus)) / np.maximum(value.T @ volume, 1e-300)
    held = np.bincount(cell, weights=volume, minlength=count)
    matrix = np.zeros((count, count))
    for c in range(count - 1):
        for xi in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
            n, slope = np.array([1 - xi, 1 + xi]) / 2, np.array([-1, 1]) / h
            weight = min(1, held[c] / h) * h / 2
            matrix[c : c + 2, c : c + 2] += weight * (n @ nodal[c : c + 2]) * np.outer(slope, slope)
    return matrix


def column(cells, composite=True, tangent="exact", filled=0.5):
    """Mean error of stress over ρ g l0, and Newton iterations a step."""
    h = HEIGHT / cells
    origin = (np.arange(cells * EACH) + 0.5) * h / EACH
    x, stretch, first, iterations = origin.copy(), np.ones(cells * EACH), h / EACH, 0
    for step in range(1, STEPS + 1):
        cell = np.minimum((x / h).astype(int), cells - 1)
        value, force, strain = functions(x, first * stretch, cell, h, cells, composite, filled)
        u = np.zeros(value.shape[1])
        while True:
            of_strain, of_force = 1 + strain @ u, 1 + force @ u
            stress = YOUNG * np.log(stretch * of_strain)
            inner = force.T @ (first * stress / of_force)
            residual = inner + value.T @ np.full(len(x), first * WEIGHT * step / STEPS)
            residual[0] = 0
            if np.abs(residual).max() < TOLERANCE * np.abs(inner[1:]).max():
                break
            iterations += 1
            if tangent == "exact":
                matrix = (force * (first * YOUNG / of_force / of_strain)[:, None]).T @ strain
                matrix -= (force * (first * stress / of_force**2)[:, None]).T @ force
            elif tangent == "of forces":
                matrix = (force * (first * (YOUNG - stress) / of_strain**2)[:, None]).T @ force
            else:
                modulus = (YOUNG - stress) / of_strain**2 / stretch
                matrix = double_mapping(modulus, first * stretch, value, cell, h)
            matrix[0], matrix[:, 0] = 0, 0
            matrix[0, 0] = 1
            way = -np.linalg.solve(matrix, residual)
            while (1 + strain @ (u + way)).min() < 0.05:
                way /= 2
            u += way
        stretch, x = stretch * of_strain, x + value @ u
    error = np.abs(YOUNG * np.log(stretch) / stretch + WEIGHT * (HEIGHT - origin)).mean()
    return error / (WEIGHT * HEIGHT), iterations / STEPS


def row(name, **options):
    found = [column(cells, **options) for cells in SIZES]
    print(f"| {name} | " + " | ".join(f"{error:.1e} / {iterations:.1f}" for error, iterations in found) + " |", flush=True)


def main():
    print("| error / iterations a step | " + " | ".join(f"{cells} cells" for cells in SIZES) + " |")
    print("|---" * (len(SIZES) + 1) + "|")
    row("`cpgimp`", composite=False)
    row("`composite`, exact tangent", tangent="exact")
    row("tangent with the gradients of forces on both sides", tangent="of forces")
    row("tangent by double mapping", tangent="double mapping")
    for filled in (0.01, 0.25, 0.75, 0.99):
        row(f"neighbours filled by {filled:.0%}", filled=filled)


if __name__ == "__main__":
    main()
