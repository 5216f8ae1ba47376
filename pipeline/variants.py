"""Runs variants of a case and reads what they wrote: what the `study.py` of the cases share.

The program is $MPM, else target/release/mpm of the repository; results go to a temporary folder.
"""

import csv
import os
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("MPM", str(ROOT / "target/release/mpm"))


class Failed(Exception):
    """The run ended before its time; says why."""


@contextmanager
def variant(case, settings):
    """The output folder of `mpm run cases/CASE` with the entries `settings` {path: value}; kept while in use."""
    with tempfile.TemporaryDirectory() as out:
        command = [PROGRAM, "run", ROOT / "cases" / case, "-o", out]
        command += [f"--set={path}={value}" for path, value in settings.items()]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except FileNotFoundError:
            sys.exit(f"{PROGRAM}: there is no such program; run `make build`, or set MPM to its path")
        if done.returncode == 1:
            raise Failed(done.stderr.strip().splitlines()[-1])
        if done.returncode:
            sys.exit(done.stderr)
        yield Path(out)


def last_frame(out):
    """The points at the end of a run, as PyVista reads them."""
    import pyvista

    reader = pyvista.get_reader(str(out / "points.pvd"))
    reader.set_active_time_point(len(reader.time_values) - 1)
    return reader.read()[0]


def history(out):
    """The columns of history.csv, by their names without units."""
    with open(out / "history.csv", newline="") as file:
        names, *rows = list(csv.reader(file))
    return dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).T))


def write_csv(header, rows):
    """Prints a table as CSV: twelve digits, and nothing below 1e-15."""
    print(header)
    for row in rows:
        print(",".join(f"{round(value, 15) + 0.0:.12g}" for value in row))
