"""Runs the program on variants of a scene: what the benches share.

A scene is a folder with a case.yaml, or the case itself as a dictionary, written for the run. The program is $MPM,
else target/release/mpm of the repository.
"""

import json
import os
import re
import resource
import statistics
import subprocess
import tempfile
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
GEO = ROOT / "geo"
PROGRAM = Path(os.environ.get("MPM", ROOT / "target/release/mpm"))
LONG = 3.0  # seconds from which a run is not repeated


class Failed(Exception):
    """The analysis ended before its time; the message says why."""


class Refused(Exception):
    """The program does not take the case; the message says why."""


@dataclass
class Process:
    """A process that has ended."""

    status: int
    out: str
    wall: float  # [s]
    cpu: float  # [s], of all its threads
    peak: float  # [MB]

    @property
    def reason(self):
        """The first lines of what it said of its end."""
        lines = [line.strip() for line in self.out.splitlines() if line.strip()]
        errors = [line for line in lines if "error" in line.lower() or "panicked" in line]
        return (errors or lines or [f"status {self.status}"])[0]


def execute(command, environment=None, core=None, timeout=None):
    """Runs a command, on one core if it is given, and measures it; ends it after `timeout` seconds of the processor, or ten times as long."""

    def prepare():
        if core is not None:
            os.sched_setaffinity(0, {core})
        if timeout is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (timeout, timeout))

    start = time.perf_counter()
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(
            [str(part) for part in command],
            stdout=out,
            stderr=subprocess.STDOUT,
            env={**os.environ, **(environment or {})},
            preexec_fn=prepare,
        )
        if timeout is None:
            _, status, usage = os.wait4(process.pid, 0)
        else:
            while True:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if pid:
                    break
                if time.perf_counter() - start > 10 * timeout:
                    process.kill()
                    _, status, usage = os.wait4(process.pid, 0)
                    break
                time.sleep(0.01)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        out.seek(0)
        text = out.read()
    return Process(process.returncode, text, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def version():
    """What the program says of itself: its version, with the commit and the sources that it is built from."""
    return execute([PROGRAM, "--version"]).out.split("\n")[0].strip()


def options(settings):
    """The options `--set` of entries {path: value}."""
    return [part for path, value in settings.items() for part in ("--set", f"{path}={json.dumps(value)}")]


@dataclass
class Run:
    """A run of the program that came to its end."""

    out: Path
    wall: float  # of the solve stage [s]
    cpu: float
    peak: float  # [MB]
    iterations: list  # of Newton, a step
    halvings: int
    nonzeros: float  # a row of the largest matrix
    case: Path
    settings: list

    def history(self):
        """The columns of history.csv, by their names without units."""
        names, *rows = [line.split(",") for line in (self.out / "history.csv").read_text().splitlines()]
        return dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).T))

    def points(self):
        """Start and end of the points as PyVista reads them, in the same order.

        Where points were split or merged the start is that of the points at the end: where they were seeded, and for their volumes
        their masses, which are in the same ratio within a material (the output needs `mass`).
        """
        import pyvista

        done = execute([PROGRAM, "export", self.case, "-o", self.out, *self.settings])
        if done.status:
            raise Failed(done.reason)
        reader = pyvista.get_reader(str(self.out / "points.pvd"))
        reader.set_active_time_point(len(reader.time_values) - 1)
        start, end = pyvista.read(self.out / "points.vtu"), reader.read()[0]
        if start.n_points != end.n_points:
            start = {"origin [m]": end.points - end["displacement [m]"], "initial_volume [m3]": end["mass [t]"]}
        return start, end


@contextmanager
def solved(scene, settings=None, repeats=1, core=None):
    """The scene with its entries {path: value} changed, meshed, seeded and solved on one thread.

    Times are the medians of `repeats` solutions, or of one that takes long. Raises `Refused` or `Failed`.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case = folder
        if isinstance(scene, dict):
            (folder / "case.yaml").write_text(json.dumps(scene))
        else:
            case = Path(scene)
        out = folder / "out"
        sets = options(settings or {})
        times = []
        for stage in ["mesh", "seed"] + ["solve"] * repeats:
            if times and times[0].wall > LONG:
                break
            done = execute([PROGRAM, stage, case, "-o", out, "--threads", 1, *sets], core=core)
            if done.status == 2:
                raise Refused(done.reason)
            if done.status:
                raise Failed(done.reason)
            if stage == "solve":
                times.append(done)
        log = (out / "solve.log").read_text()
        iterations = [int(n) for n in re.findall(r"^step .* iterations (\d+) ", log, re.MULTILINE)]
        run = Run(
            out,
            statistics.median(t.wall for t in times),
            statistics.median(t.cpu for t in times),
            max(t.peak for t in times),
            iterations,
            len(re.findall(r"^  halved:", log, re.MULTILINE)),
            float((re.findall(r"([\d.]+) nonzeros a row", times[0].out) or ["nan"])[-1]),
            case,
            sets,
        )
        yield run
