"""The force on the blade beside what rubs on the floor: the table of the README.

    .venv/bin/python cases/bulldozing/study.py OUT [OUT …]

Means over time, over 0.1 m of the way, nan where a run has not come to; the floor's force is told over the last of it.
"""

import csv
import sys
from pathlib import Path

import numpy as np


def main() -> None:
    print("| run | 0.3 … 0.4 m | 0.5 … 0.6 m | 0.7 … 0.8 m | floor from 0.2 m on: mean, least, most | steps halved, of all |\n|---|---|---|---|---|---|")
    for out in map(Path, sys.argv[1:]):
        with (out / "history.csv").open(newline="") as file:
            names, *rows = csv.reader(file)
        columns = dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).T))
        steps, way = np.diff(columns["time"], prepend=0), columns["blade.ux"]

        def mean(name: str, begin: float, end: float, columns=columns, steps=steps, way=way) -> float:
            within = (way > begin) & (way <= end)
            return -np.average(columns[name][within], weights=steps[within]) if within.any() else np.nan

        forces = [f"{mean('blade.contact_x', begin, begin + 0.1):.3f}" for begin in (0.3, 0.5, 0.7)]
        floor = -columns["floor.contact_y"][way > min(0.2, 0.9 * way[-1])]
        log = (out / "solve.log").read_text()
        halved, all_steps = log.count("halved:"), sum(line.startswith("step ") for line in log.splitlines())
        print(f"| {out} | {' | '.join(forces)} | {mean('floor.contact_y', 0.2, 1):.2f}, {floor.min():.2f}, {floor.max():.2f} | {halved} of {all_steps} |")


if __name__ == "__main__":
    main()
