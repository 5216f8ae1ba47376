"""Limit loads over the angle of friction, with and without dilation, smooth and rough: the tables of the README.

    .venv/bin/python cases/footing_on_sand/study.py [surcharge|weight] [--size H] [--angles DEGREES …] [-j JOBS]

A minute for each on two processors (-j 2).

N_q = e^(π tan φ) tan²(45° + φ/2) (Prandtl 1921, Reissner 1924). N_γ, for a pressure of γ B N_γ/2, by characteristics (Martin, *Exact bearing capacity
calculations using the method of characteristics*, 2005); between its angles ln N_γ is interpolated. Soil that does not dilate has a lower limit by
tan φ* = sin φ cos ψ/(1 − sin φ sin ψ) (Davis 1968).
"""

import argparse
import csv
import math
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import PROGRAM, ROOT

ANGLES = [20, 30, 35]
WIDTH = 2.0
# Dilating soil without stress heaves beside the edge by many times the settlement, and heavy heaps make it stronger: so E is large where it has weight.
YOUNG = {False: 1e6, True: 1e8}
SURCHARGE, UNIT_WEIGHT = 10.0, 18.0
# The settlement over q B/E at which the load is read.
SETTLEMENT = 5.0
MARTIN = {
    "smooth": ([15, 20, 25, 30, 35, 40], [0.6991, 1.579, 3.461, 7.653, 17.58, 43.19]),
    "rough": ([15, 20, 25, 30, 35, 40], [1.181, 2.839, 6.491, 14.75, 34.48, 85.57]),
}


def surcharge_factor(angle: float) -> float:
    """N_q (-) of an angle of friction (degrees)."""
    return math.exp(math.pi * math.tan(math.radians(angle))) * math.tan(math.radians(45 + angle / 2)) ** 2


def weight_factor(angle: float, base: str) -> float:
    """N_γ (-) of an angle of friction (degrees)."""
    angles, factors = MARTIN[base]
    return float(np.exp(np.polyval(np.polyfit(angles, np.log(factors), len(angles) - 1), angle)))


def without_dilation(angle: float) -> float:
    """Davis' angle φ* (degrees) for ψ = 0."""
    return math.degrees(math.atan(math.sin(math.radians(angle))))


def solve(angle: int, dilation: int, base: str, weight: bool, h: float) -> tuple[float, float, int, float]:
    """The bearing capacity factor at the end, the largest one, the number of halved steps, and the time (s)."""
    exact = weight_factor(angle, base) * UNIT_WEIGHT * WIDTH / 2 if weight else surcharge_factor(angle) * SURCHARGE
    settlement = SETTLEMENT * exact * WIDTH / YOUNG[weight]
    settings = [
        f"mesh.parameters.h={h}",
        f"materials.sand.friction={angle}",
        f"materials.sand.dilation={dilation}",
        f"phases.push.prescribe.footing.uy.rate={-settlement:.9f}",
        f"materials.sand.young={YOUNG[weight]}",
    ]
    if base == "rough":
        settings.append(f"contacts[0].friction={math.tan(math.radians(angle)):.4f}")
    if weight:
        settings += [f"materials.sand.density={UNIT_WEIGHT / 9.81:.6f}", "gravity={y: -9.81}", "initial_stress={k0: 0.5}"]
        settings += ["phases.surcharge.tractions[0].ty.rate=0", "phases.push.tractions[0].ty=0"]
    with tempfile.TemporaryDirectory() as out:
        command = [PROGRAM, "run", ROOT / "cases/footing_on_sand", "-o", out, "--threads", "1"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
        log = (Path(out) / "solve.log").read_text()
        with open(Path(out) / "history.csv", newline="") as file:
            loads = [float(row[2]) / (WIDTH / 2) for row in list(csv.reader(file))[1:]]
        time = next((line.split()[2] for line in done.stdout.splitlines() + log.splitlines() if line.startswith("solved in")), "nan")
    if done.returncode != 0:
        print(f"did not run to the end: {angle} {dilation} {base} {weight} {h}: {done.stderr.splitlines()[-1][:300]}")
    factor = [q / (UNIT_WEIGHT * WIDTH / 2) if weight else q / SURCHARGE + 1 for q in loads]
    return factor[-1], max(factor), log.count("halved:"), float(time)


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("which", nargs="*", default=["surcharge", "weight"])
    arguments.add_argument("-j", "--jobs", type=int, default=1)
    arguments.add_argument("--size", type=float, default=0.1)
    arguments.add_argument("--angles", type=int, nargs="+", default=ANGLES)
    given = arguments.parse_args()
    for which in given.which:
        weight = which == "weight"
        runs = [
            (angle, dilation, base, weight, given.size)
            for base in (["smooth", "rough"] if weight else ["smooth"])
            for angle in given.angles
            for dilation in ([angle] if weight else [angle, 0])
        ]
        print(f"{which}\n| base | φ | ψ | found | largest | characteristics, φ | φ* | found over that of φ | halved | s |\n|---|---|---|---|---|---|---|---|---|---|")
        with ThreadPoolExecutor(given.jobs) as pool:
            for (angle, dilation, base, *_), (found, largest, halved, time) in zip(runs, pool.map(lambda run: solve(*run), runs)):
                of = (lambda a, base=base: weight_factor(a, base)) if weight else surcharge_factor
                lower = f"{of(without_dilation(angle)):.2f}" if dilation == 0 else ""
                print(f"| {base} | {angle}° | {dilation}° | {found:.2f} | {largest:.2f} | {of(angle):.2f} | {lower} | {found / of(angle):.3f} | {halved} | {time:.0f} |", flush=True)


if __name__ == "__main__":
    main()
