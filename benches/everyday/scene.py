"""A scene, its run by the program as a user runs it, and the verdict on what it left."""

import csv
import json
import math
import os
import random
import re
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from program import PROGRAM, execute  # noqa: E402

TIMEOUT = 120  # [s] of the processor for a run
RIGHT, SAID, ENDED, SILENT = VERDICTS = ["right", "refused or said", "ended with a message", "wrong in silence"]


def typed(value, digits=3):
    """A number as one types it, of some digits."""
    return float(f"{value:.{digits}g}")


class Dice(random.Random):
    """Random numbers as one types them."""

    def number(self, low, high, digits=3):
        """Uniform between the two."""
        return typed(self.uniform(low, high), digits)

    def scale(self, low, high, digits=2):
        """Uniform in its logarithm."""
        return typed(math.exp(self.uniform(math.log(low), math.log(high))), digits)

    def chance(self, share):
        return self.random() < share


@dataclass
class Check:
    """A number of a run, and between which bounds the answer has it."""

    what: str
    found: float
    low: float
    high: float

    @property
    def right(self):
        return self.low <= self.found <= self.high  # of a NaN neither

    def __str__(self):
        return f"{self.what} {self.found:.6g}, not {self.low:.6g} to {self.high:.6g}"


def near(what, found, answer, tolerance):
    """The answer, give or take an absolute tolerance."""
    return Check(what, float(found), answer - tolerance, answer + tolerance)


def below(what, found, limit):
    """A magnitude, such as the largest error at all points."""
    return Check(what, float(found), -math.inf, float(limit))


@dataclass
class Scene:
    """What a user writes, and what is known of the result."""

    section: object  # geometry.Section
    case: dict  # case.yaml but its mesh
    answers: object  # function of a Result: list of Check
    about: str = ""  # for the list of scenes
    order: int = 2
    spread: float = 0.02  # by which results may differ on another mesh of the same size, over their largest value
    least: dict = field(default_factory=dict)  # the least of the largest value that differences are told over, by unit
    threads: int = 1
    unique: bool = True  # whether the motion is: at a limit load forces are alone

    def write(self, folder):
        case = {**self.case, "mesh": {"geo": "section.geo", "order": self.order}}
        (folder / "section.geo").write_text(self.section.geo())
        (folder / "case.yaml").write_text(json.dumps(case, indent=1) + "\n")


@dataclass
class Result:
    """What a run left."""

    scene: Scene
    folder: Path
    status: int
    text: str  # what it printed
    seconds: float  # of the processor, of all its threads
    warnings: list = field(default_factory=list)

    @property
    def out(self):
        return self.folder / "out"

    @cached_property
    def log(self):
        return (self.out / "solve.log").read_text()

    @cached_property
    def units(self):
        head = (self.out / "history.csv").read_text().splitlines()[0].split(",")
        return {name.split(" [")[0]: name.split(" [")[1].rstrip("]") for name in head}

    @cached_property
    def history(self):
        """The columns of history.csv, by their names without units."""
        rows = (self.out / "history.csv").read_text().splitlines()[1:]
        return dict(zip(self.units, np.array([row.split(",") for row in rows], dtype=float).T))

    def last(self, name):
        return self.history[name][-1]

    @property
    def gain(self):
        """What is held beyond what was supplied [kJ], after each step, by energy.csv."""
        with open(self.out / "energy.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        sums = [{side: sum(float(value) for name, value in row.items() if name.startswith(side)) for side in ("held", "supplied")} for row in rows]
        return np.array([of["held"] - of["supplied"] for of in sums])

    @cached_property
    def soil(self):
        """The soil in the last frame: material points, and the nodes of `fem`."""
        # Regions are numbered as the .geo has them.
        names = list(dict.fromkeys(face.name for face in self.scene.section.faces))
        regions = self.scene.case["regions"]
        return Soil(self.out, [n for n, name in enumerate(names) if regions[name]["kind"] == "fem"])


class Soil:
    """Places [m], first places, displacements, stresses (xx, yy, zz, xy) and excess pore pressures [kPa] of the last frame, masses [t].

    Of finite elements those of some regions. Pressures and masses are 0 where the output has none.
    """

    def __init__(self, out, regions):
        import pyvista

        parts = []
        for kind in ["points", "structures"]:
            frames = sorted((out / "vtu").glob(f"{kind}_*.vtu"))
            if frames:
                data = pyvista.read(frames[-1])
                these = np.full(data.n_points, kind == "points")
                if kind == "structures":
                    cells = np.isin(data.cell_data["region [-]"], regions)
                    these[data.cell_connectivity[np.repeat(cells, np.diff(data.cell_offsets))]] = True
                if these.any():
                    water, mass = (data.point_data.get(name, np.zeros(data.n_points)) for name in ("pore_pressure [kPa]", "mass [t]"))
                    parts.append(tuple(field[these] for field in (data.points, data["displacement [m]"], data["stress [kPa]"], water, mass)))
        place, moved, stress, self.pore_pressure, self.mass = (np.concatenate([part[n] for part in parts]) for n in range(5))
        self.place, self.displacement, self.stress = place[:, :2].astype(float), moved[:, :2], stress
        self.origin = self.place - self.displacement
        self.xx, self.yy, self.zz, self.xy = stress[:, :4].T


def run(scene, folder, kill=None):
    """Runs a scene in a folder; with `kill`, once it is killed after so many steps, and then resumed."""
    folder.mkdir(parents=True, exist_ok=True)
    scene.write(folder)
    command = [PROGRAM, "run", folder, "--threads", scene.threads]
    spent = 0.0
    if kill is not None:
        spent = killed(command, folder, kill)
        command.append("--resume")
    done = execute(command, timeout=TIMEOUT)
    # A warning is repeated at the end of a run.
    warnings = list(dict.fromkeys(re.findall(r"^\s*warning: (.*)", done.out, re.MULTILINE)))
    return Result(scene, folder, done.status, done.out, spent + done.cpu, warnings)


def killed(command, folder, steps):
    """Starts a run and kills it once its log has so many steps, or lets it end before; returns its seconds."""
    start = time.perf_counter()
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    while process.poll() is None and time.perf_counter() < start + TIMEOUT:
        logs = list(folder.glob("out/solve.log"))
        if any(log.read_text().count("\nstep ") >= steps for log in logs):
            os.killpg(process.pid, signal.SIGKILL)
            break
        time.sleep(0.002)
    process.wait()
    return time.perf_counter() - start


def invariants(result):
    """What holds in every run: all finite, mass kept, all time done."""
    log = result.log
    text = re.sub(r"^(?:warning: |  ).*$", "", log, flags=re.MULTILINE)
    checks = [below("numbers of the log that are not finite", len(re.findall(r"(?<![\w])(?:nan|inf)(?![\w])", text, re.IGNORECASE)), 0)]
    mass = np.array([float(value) for value in re.findall(r"^step .* mass (\S+)", log, re.MULTILINE)])
    if not any("remove" in phase for phase in result.scene.case["phases"]):
        checks.append(below("change of the mass, relative", np.ptp(mass) / max(mass.max(), 1e-300), 1e-11))
    checks.append(below("numbers of the history that are not finite", sum(not np.isfinite(column).all() for column in result.history.values()), 0))
    return checks


def verdict(result, checks):
    """How a run ended, from its exit status, its checks (a function, not called where it did not end well), and what it said; with remarks."""
    if result.status in (1, 2):
        reason = next((line.strip() for line in result.text.splitlines() if "error" in line), "")
        if not reason or "panicked" in result.text:
            return SILENT, [f"exit {result.status}: {result.text[-300:]}"]
        return (ENDED if result.status == 1 else SAID), [reason]
    if result.status:
        return SILENT, [f"status {result.status}: {result.text[-300:]}"]
    wrong = [str(check) for check in [*invariants(result), *checks()] if not check.right]
    if not wrong:
        return RIGHT, []
    said = result.warnings or checked(result.folder)
    return (SAID if said else SILENT), wrong + [f"warning: {line}" for line in said]


def checked(folder):
    """The warnings of `mpm check`."""
    text = execute([PROGRAM, "check", folder], timeout=TIMEOUT).out
    return re.findall(r"^\s*(?:\S+: )?warning: (.*)", text, re.MULTILINE)
