"""How smooth the pressures of a contact are along it.

    .venv/bin/python benches/verification/contact_pressure.py OUT [OUT ...] [--from TIME] [--ends N]

Reads `contact.pvd` of runs (`mpm export`). Each line of contact is sampled at its contact nodes (the places where the linear
pressure has its kinks); every node that presses, with both neighbours on each side, is held against the quadratic of least
squares through these five, but for the first and last N (2) of a run of nodes that press, where the pressure is singular or
ends. Prints the largest and the root-mean-square distance over the mean pressure of the line, over all frames from TIME (s) on.
"""

import argparse
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pyvista


def chains(mesh: pyvista.UnstructuredGrid) -> list[list[int]]:
    """Points of the lines in their order."""
    found: list[list[int]] = []
    for k in range(mesh.n_cells):
        cell = [int(n) for n in mesh.get_cell(k).point_ids]
        if found and found[-1][-1] == cell[0]:
            found[-1] += cell[1:]
        else:
            found.append(cell)
    return found


def nodes(along: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Where the piecewise linear pressure has its kinks: places (m) and pressures (kPa). A kink lies within a piece of the line, where the
    lines of both sides meet."""
    slope = np.diff(pressure) / np.diff(along)
    same = np.abs(np.diff(slope)) <= 1e-6 * np.abs(pressure).max() / (along[-1] - along[0])
    pieces = sorted({k + i for k in np.flatnonzero(same) for i in (0, 1)})
    lines = [k for i, k in enumerate(pieces) if i == 0 or k > pieces[i - 1] + 1 or not same[k - 1]]
    if len(lines) < 2:
        return np.array([[along[k], pressure[k]] for k in (0, -1)])
    found = [[along[0], pressure[0]]]
    for k, other in zip(lines, lines[1:]):
        x = (pressure[other] - slope[other] * along[other] - pressure[k] + slope[k] * along[k]) / (slope[k] - slope[other])
        found.append([x, pressure[k] + slope[k] * (x - along[k])])
    return np.array([*found, [along[-1], pressure[-1]]])


def deviations(samples: np.ndarray, ends: int) -> list[float]:
    """Distance of each pressure from the quadratic through it and two neighbours on each side, over the mean pressure."""
    found: list[float] = []
    pressing = np.flatnonzero(samples[:, 1] != 0.0)
    for run in np.split(pressing, 1 + np.flatnonzero(np.diff(pressing) > 1)):
        inner = run[ends : len(run) - ends]
        if len(inner) == 0:
            continue
        mean = np.abs(samples[run, 1]).mean()
        for k in inner:
            five = samples[k - 2 : k + 3]
            if len(five) == 5 and k >= 2 and np.all(five[:, 1] != 0.0):
                fit = np.polyfit(five[:, 0] - five[2, 0], five[:, 1], 2)
                found.append((five[2, 1] - fit[2]) / mean)
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("out", nargs="+", type=Path)
    parser.add_argument("--from", dest="start", type=float, default=0.0)
    parser.add_argument("--ends", type=int, default=2)
    arguments = parser.parse_args()
    print("| run | frames | contact nodes | largest | r.m.s. |")
    print("|---|---|---|---|---|")
    for out in arguments.out:
        found, frames = [], 0
        for entry in ElementTree.parse(out / "contact.pvd").iter("DataSet"):
            if float(entry.get("timestep", "0")) < arguments.start:
                continue
            frames += 1
            mesh = pyvista.read(out / entry.attrib["file"])
            for chain in chains(mesh):
                place = mesh.points[chain][:, :2]
                along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(place, axis=0).T))])
                pressure = np.asarray(mesh.point_data["contact_pressure [kPa]"])[chain]
                if np.any(pressure != 0.0):
                    found += deviations(nodes(along, pressure), arguments.ends)
        found = np.array(found)
        most, rms = (np.abs(found).max(), np.sqrt((found**2).mean())) if len(found) else (np.nan, np.nan)
        print(f"| {out.name} | {frames} | {len(found)} | {100 * most:.1f} % | {100 * rms:.1f} % |")


if __name__ == "__main__":
    main()
