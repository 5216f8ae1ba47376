#!/usr/bin/env python3
"""How far edges may stretch until the grid is restored (`max_stretch`): errors for several limits; prints a table.

    .venv/bin/python benches/work_precision/stretch.py [--quick]

Column: error over that of restoring in every step, mean and largest over meshes of 8 to 64 cells, one and three wide, in 40
steps and (8, 16 and 32 cells) in 160. Cantilever: errors of the tip, two cells over the depth. Slump: mean errors at
h = 1/16. Sixteen points a cell. Needs `make build`; about eight minutes. --quick: columns of 8 cells alone, one limit.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from problems import cantilever, column, slump  # noqa: E402
from program import solved  # noqa: E402

LIMITS = [1.15, 1.2, 1.25, 1.3, 1.35, 1.4, 1.5, 2]
MESHES = {40: [8, 12, 16, 20, 24, 28, 32, 48, 64], 160: [8, 16, 32]}


def errors(module, variant, restore):
    """The errors of a problem restored so."""
    problem = module.PROBLEM
    settings = {**variant.settings, "numerics.restore": restore}
    for path in problem.points_paths:
        settings.setdefault(path, 16)
    with solved(problem.scene, settings) as run:
        return list(problem.errors(run, settings).values())


def columns(restore):
    """The stress errors of all columns, by the number of steps."""
    return {
        steps: np.array(
            [
                errors(column, column.variant(n, n, wide, steps), restore)[0]
                for n in sizes
                for wide in (1, 3)
            ]
        )
        for steps, sizes in MESHES.items()
    }


def row(name, restore, every, others):
    found = columns(restore)
    ratios = [found[steps] / every[steps] for steps in MESHES]
    cells = [f"{r.mean():.2f}, {r.max():.2f}" for r in ratios]
    for module, variant in others:
        cells.append(", ".join(f"{value:.1e}" for value in errors(module, variant, restore)))
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def main():
    limits, others = LIMITS, [(cantilever, cantilever.variant(2, 0.5)), (slump, slump.PROBLEM.series[0].variants[1])]
    if "--quick" in sys.argv[1:]:
        limits, others = [1.3], []
        MESHES.update({steps: [8] for steps in MESHES})
    for module, _ in others:
        print(module.PROBLEM.prepare())
    print("| max_stretch | column, 40 steps | 160 steps | cantilever | slump |")
    print("|---|---|---|---|---|")
    every = columns("every_step")
    row("every step", "every_step", every, others)
    for limit in limits:
        row(limit, {"min_quality": 0.5, "max_stretch": limit}, every, others)


if __name__ == "__main__":
    main()
