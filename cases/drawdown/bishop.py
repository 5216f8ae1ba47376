#!/usr/bin/env python3
"""Factors of safety of the slope of this case by Bishop's simplified method, with the water at one level inside and outside.

    .venv/bin/python cases/drawdown/bishop.py

Soil below the level has its buoyant weight, which is the same as its whole weight with the pressure of the water around and inside
of it. The least factor over circles is found from a coarse net of them by ever smaller steps.
"""

import itertools
import math

import numpy as np

HEIGHT, TAN = 10.0, 0.5  # of the slope [m], its inclination; its toe is on the base
COHESION, FRICTION = 10.0, math.tan(math.radians(20))  # [kPa]
SOIL, WATER = 20.0, 9.81  # unit weights [kN/m³]
SLICES = 400


def ground(x):
    """Height of the ground [m]; the toe is at 0, and the slope rises to the left."""
    return np.clip(-x * TAN, 0.0, HEIGHT)


def factor(x, y, radius, level):
    """Bishop's factor for a circle, infinite where it cuts no soil that wants to slide."""
    if radius > y or radius <= 0:
        return math.inf
    edges = np.linspace(x - radius, x + radius, SLICES + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    bottom = y - np.sqrt(radius**2 - (middle - x) ** 2)
    inside = ground(middle) > bottom
    if inside.sum() < 10 or y <= ground(middle[inside]).max():
        return math.inf
    edges = np.linspace(middle[inside][0] - radius / SLICES, middle[inside][-1] + radius / SLICES, SLICES + 1)
    middle, width = 0.5 * (edges[1:] + edges[:-1]), edges[1] - edges[0]
    bottom = y - np.sqrt(np.maximum(radius**2 - (middle - x) ** 2, 0))
    depth = np.maximum(ground(middle) - bottom, 0)
    below = np.clip(level - bottom, 0, depth)
    weight = width * (SOIL * depth - WATER * below)
    sine = (x - middle) / radius  # the soil slides to the right
    cosine = np.sqrt(1 - sine**2)
    drives = (weight * sine).sum()
    if drives <= 0:
        return math.inf
    bears = COHESION * width * (depth > 0) + weight * FRICTION
    value = 1.5
    for _ in range(50):
        before, slope = value, cosine + sine * FRICTION / value
        if slope.min() < 0.1:
            return math.inf
        value = (bears / slope).sum() / drives
        if abs(value - before) < 1e-7:
            break
    return value


def least(level):
    """The least factor over circles."""
    net = itertools.product(np.linspace(-25, 5, 13), np.linspace(11, 45, 13), np.linspace(8, 45, 20))
    best = min(((factor(*c, level), c) for c in net), key=lambda found: found[0])
    step = 1.5
    while step > 0.005:
        around = [tuple(c + step * d for c, d in zip(best[1], move)) for move in itertools.product((-1, 0, 1), repeat=3)]
        found = min(((factor(*c, level), c) for c in around), key=lambda found: found[0])
        best, step = (found, step) if found[0] < best[0] - 1e-9 else (best, step / 2)
    return best


if __name__ == "__main__":
    print("| L/H | factor | centre x | centre y | radius |\n|---|---|---|---|---|")
    for down in (0.0, 0.4, 0.7, 1.0):
        value, (x, y, radius) = least(HEIGHT * (1 - down))
        print(f"| {down} | {value:.3f} | {x:.2f} | {y:.2f} | {radius:.2f} |")
