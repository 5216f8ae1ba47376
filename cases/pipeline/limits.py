"""The pipe in a trench of its own shape, so that nothing heaves beside it, against the formulas for that.

    .venv/bin/python cases/pipeline/limits.py [--quick]

Prints a Markdown table, for clay of one strength without weight and for that of the case: *V*, the vertical force when the pipe has gone 0.017 m down
from 0.12 m, and the *breakout*, the horizontal one under the weight of the pipe when it has gone 0.016 m sideways, each beside the formula with the strength
at the invert: V/(D s_u) = 5.66 (w/D)^0.32 smooth, 7.4 (w/D)^0.4 rough; H_max/(D s_u) = 2.72 (w/D)^0.78, 3.26 (w/D)^0.82, and the envelope of
vertical and horizontal force H/H_max = β v^β1 (1 − v)^β2 (Merifield, White & Randolph 2008; Randolph & White 2008), without terms of weight. --quick: the first row.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant

DIAMETER, PLACED, WEIGHT = 0.8, 0.12, 3.468
DOWN, SIDEWAYS = 0.017, 0.016
PRESS = "{name: press, analysis: quasi_static, duration: %g, step: {initial: 0.0005, max: 0.002}, prescribe: {core: {ux: 0, uy: {rate: -1}}}}"
RELEASE = "{name: release, analysis: quasi_static, duration: 1, step: {initial: 0.25}, prescribe: {core: {ux: 0}}}"
PULL = "{name: pull, analysis: quasi_static, duration: 0.018, step: {initial: 0.0005, max: 0.003}, prescribe: {core: {ux: {rate: 1}}}}"
UNIFORM = {
    "materials.clay.shear_strength": 2.732,
    "materials.clay.young": 1366,
    "materials.clay.unit_weight": 0,
    "initial_stress": "null",
}


def found(settings, phases):
    """The history of a run in the trench."""
    trench = {"mesh.parameters": f"{{h: 0.1, placed: {PLACED}, way: 0.8}}", "phases": f"[{', '.join(phases)}]"}
    with variant("pipeline", {**settings, **trench}) as out:
        return history(out)


def vertical(alpha, depth, strength):
    factor, power = {0: (5.66, 0.32), 1: (7.4, 0.4)}[alpha]
    return factor * (depth / DIAMETER) ** power * DIAMETER * strength


def horizontal(alpha, depth, strength):
    factor, power = {0: (2.72, 0.78), 1: (3.26, 0.82)}[alpha]
    x, v = depth / DIAMETER, WEIGHT / vertical(alpha, depth, strength)
    b1, b2 = (0.8 - 0.15 * alpha) * (1.2 - x), 0.35 * (2.5 - x)
    beta = (b1 + b2) ** (b1 + b2) / (b1**b1 * b2**b2)
    return factor * x**power * DIAMETER * strength * beta * v**b1 * (1 - v) ** b2


def main():
    print("| clay | α | V [kN/m] | formula | breakout [kN/m] | envelope |\n|---|---|---|---|---|---|")
    quick = "--quick" in sys.argv[1:]
    for name, clay in (("one strength, no weight", UNIFORM), ("as in the case", {}))[: 1 if quick else 2]:
        for alpha in (0,) if quick else (0, 1):
            settings = {**clay, "contacts[0].adhesion_factor": alpha}
            down = found(settings, [PRESS % 0.018])
            side = found(settings, [PRESS % 0.002, RELEASE, PULL])
            pulled = side["core.ux"] > 1e-9
            v = np.interp(DOWN, -down["core.uy"], down["pipe.contact_y"])
            h = np.interp(SIDEWAYS, side["core.ux"][pulled], -side["pipe.contact_x"][pulled])
            deep = PLACED + DOWN
            strength = (lambda w: 2.732) if clay else (lambda w: 2.3 + 3.6 * w)
            print(f"| {name} | {alpha} | {v:.2f} | {vertical(alpha, deep, strength(deep)):.2f} | {h:.2f} "
                  f"| {horizontal(alpha, PLACED, strength(PLACED)):.2f} |", flush=True)


if __name__ == "__main__":
    main()
