#!/usr/bin/env python3
"""What each numerical constant of the solver does to results and iterations; writes docs/constants.md.

    .venv/bin/python benches/constants/run.py [--jobs N] [--only PATTERN] [--scenes NAME …] [--write]

A copy of the program is built in which every constant can be changed (`source.py`). Each scene runs with each constant that it reads at
half and at double its value, and is compared with the scene as it is. What was run is kept in target/constants, so that an interrupted
command goes on. Needs `make setup`.
"""

import argparse
import hashlib
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from source import KEPT, ROOT, build, constants

PAGE = ROOT / "docs/constants.md"
LATE = 3  # times as long as the scene as it is, after which a run is ended


@dataclass
class Scene:
    """A case in a coarse variant, and the column of its history that is compared."""

    case: str
    column: str
    settings: dict = field(default_factory=dict)


SCENES = {
    "column": Scene("column", "surface.uy", {"mesh.parameters.h": 1.25}),
    "slump": Scene("slump", "block.uy", {"mesh.parameters.h": 2}),
    "consolidation": Scene("terzaghi", "top.uy", {"mesh.parameters.h": 0.1}),
    "bar in clay": Scene("tbar", "bar.contact_y", {"mesh.parameters.h": 0.25, "phases.push.duration": 1, "phases.push.step.max": 0.05}),
    "pile": Scene("pile", "pile.contact_y", {"phases[0].duration": 0.1}),
    "anchor": Scene("plate_anchor", "plate.contact_y", {"mesh.parameters.h": 0.1, "phases[0].duration": 0.2}),
    "pipeline": Scene("pipeline", "pipe.contact_x", {"mesh.parameters": {"h": 0.16, "way": 0.4}, "phases[0].duration": 0.04, "phases[2].duration": 0.05}),
    "rolling disc": Scene("rolling_disc", "disc.ux", {"phases.roll.duration": 0.1}),
    "sand": Scene("sand_column", "sand.ux", {"mesh.parameters.h": 0.025, "phases.collapse.duration": 0.25, "phases.collapse.step.max": 0.004}),
    "slope": Scene("seabed_slope", "soil.ux", {"mesh.parameters.h": 1.25, "phases.fail.duration": 5}),
    "pool": Scene("submerged_slope", "soil.ux", {"mesh.parameters.h": 1.25, "phases[1].duration": 2, "phases[1].step": {"initial": 0.05}, "phases[1].water_level": {"table": [[0, 5.5], [2, 3]]}}),
    "ddmp": Scene("slump", "block.uy", {"mesh.parameters.h": 2, "numerics.gradient": "ddmp"}),
    "cpdi2": Scene("column", "surface.uy", {"mesh.parameters.h": 1.25, "numerics": {"gradient": "cpdi2", "restore": "every_step"}, "regions.soil.points_per_cell": 16}),
}


@dataclass
class Outcome:
    """A run: its history, its iterations, and why it ended where it did not come to its end."""

    time: np.ndarray
    values: np.ndarray
    iterations: int
    bits: bytes
    ended: str
    wall: float


def run(program, out, environment, column, timeout=None):
    """Solves what is meshed and seeded in a folder, elsewhere."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "out"
        shutil.copytree(out, folder)
        start = time.perf_counter()
        command = [program, "solve", *json.loads((out / "scene.json").read_text())["case"], "-o", folder, "--threads", "1"]
        try:
            done = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, timeout=timeout)
            ended = "" if done.returncode == 0 else (done.stderr.strip().splitlines() or ["it ended"])[0]
        except subprocess.TimeoutExpired:
            ended = f"not at its end after {LATE} times the time"
        wall = time.perf_counter() - start
        log = (folder / "solve.log").read_text()
        history = (folder / "history.csv").read_bytes()
        names, *rows = [line.split(",") for line in history.decode().splitlines()]
        table = dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).reshape(-1, len(names)).T))
        iterations = sum(int(n) for n in re.findall(r"^step .* iterations (\d+) ", log, re.MULTILINE))
        return Outcome(table["time"], table[column], iterations, history, ended, wall)


def prepared(program, folder, scene):
    """The scene, meshed and seeded."""
    sets = [part for path, value in scene.settings.items() for part in ("--set", f"{path}={json.dumps(value)}")]
    case = [str(ROOT / "cases" / scene.case), *sets]
    for stage in ["mesh", "seed"]:
        subprocess.run([program, stage, *case, "-o", folder], check=True, capture_output=True)
    (folder / "scene.json").write_text(json.dumps({"case": case}))


def varied(value, kind):
    """Half and double the value, or its distance from 1 where it is between a half and two."""
    if kind != "f64":
        return sorted({max(1, int(value) // 2), 2 * int(value)} - {int(value)})
    if 0.5 <= abs(value) < 2 and value != 1:
        left = abs(value) - 1
        return [math.copysign(1 + change * left if 1 + change * left > 0 else abs(value) / 2, value) for change in (0.5, 2)]
    return [value / 2, value * 2]


def change(base, other):
    """Root mean square of what the column differs, over that of the column, up to where both came."""
    end = min(base.time[-1], other.time[-1]) if len(other.time) else -1.0
    at = base.time[base.time <= end * (1 + 1e-12)]
    if len(at) == 0:
        return math.nan
    wanted = base.values[: len(at)]
    found = np.interp(at, other.time, other.values)
    return float(np.sqrt(np.mean((found - wanted) ** 2)) / max(np.sqrt(np.mean(wanted**2)), 1e-300))


def number(value):
    return f"{value:.4g}"


@dataclass
class Compared:
    """A run beside the scene as it is."""

    moved: float  # change of the result
    iterations: int
    ended: str
    same: bool  # history and iterations


class Runs:
    """Runs with a changed constant, each done once for a program and a scene."""

    def __init__(self, program, folders, bases):
        self.program, self.folders, self.bases = program, folders, bases
        self.file = KEPT / "runs.json"
        self.known = json.loads(self.file.read_text()) if self.file.exists() else {}
        self.lock = threading.Lock()
        self.build = hashlib.sha256(program.read_bytes()).hexdigest()[:16]

    def compared(self, key, changed, name):
        scene, base = SCENES[name], self.bases[name]
        entry = f"{self.build} {key}={changed!r} {scene.case} {json.dumps(scene.settings)}"
        with self.lock:
            known = self.known.get(entry)
        if known is None:
            environment = {"MPM_CONSTANTS": f"{key}={changed!r}"}
            outcome = run(self.program, self.folders[name], environment, scene.column, LATE * base.wall + 5)
            same = outcome.bits == base.bits and outcome.iterations == base.iterations
            known = [0.0 if same else change(base, outcome), outcome.iterations, outcome.ended, same]
            with self.lock:
                self.known[entry] = known
                self.file.write_text(json.dumps(self.known, indent=0))
        return Compared(*known)


def percent(value):
    if value == 0:
        return "0"
    if value >= 0.1:
        return f"{100 * value:.0f}"
    return f"{100 * value:.1f}" if value >= 1e-3 else f"{100 * value:.0e}".replace("e-0", "e-")


@dataclass
class Effect:
    """What a constant does, over all scenes that read it."""

    value: float
    scenes: int
    most: float = 0.0  # largest change of a result
    where: str = ""
    iterations: list = field(default_factory=list)  # change of the sum over the scenes, at each changed value
    ends: list = field(default_factory=list)  # runs that did not come to their end
    same: bool = True  # every history and every number of iterations

    def words(self):
        if self.same:
            return "nothing"
        return "0" if not self.most else f"{percent(self.most)} % ({self.where})"

    def counts(self):
        return ", ".join(f"{100 * change:+.1f} %" for change in self.iterations)


def effect(value, by_scene, bases):
    found = Effect(value, len(by_scene))
    sums = {}
    for scene, runs in by_scene.items():
        for i, (changed, compared) in enumerate(runs):
            found.same &= compared.same
            if compared.ended:
                found.ends.append(f"{scene} at {number(changed)}")
                continue
            if compared.moved > found.most:
                found.most, found.where = compared.moved, f"{scene} at {number(changed)}"
            before, after = sums.setdefault(i, (0, 0))
            sums[i] = (before + bases[scene].iterations, after + compared.iterations)
    found.iterations = [after / before - 1 for before, after in (sums[i] for i in sorted(sums)) if before]
    return found


def measured(chosen, scenes, jobs):
    """The effect of each constant, None of one that no scene reads; and the scenes as they are."""
    program = build()
    with tempfile.TemporaryDirectory() as name:
        folders = {scene: Path(name) / str(i) for i, scene in enumerate(scenes)}
        bases, read = {}, {}
        for scene, folder in folders.items():
            prepared(program, folder, SCENES[scene])
            file = Path(name) / "read"
            file.write_text("")
            bases[scene] = run(program, folder, {"MPM_CONSTANTS_READ": str(file)}, SCENES[scene].column)
            if bases[scene].ended:
                raise SystemExit(f"{scene}: {bases[scene].ended}")
            read[scene] = {key: float(value) for key, value in (line.split("=") for line in file.read_text().split())}
            print(f"{scene}: {bases[scene].wall:.1f} s, {bases[scene].iterations} iterations, {len(read[scene])} constants", flush=True)
        values = {key: value for known in read.values() for key, value in known.items()}
        found, runs = {}, Runs(program, folders, bases)
        with ThreadPoolExecutor(jobs) as pool:
            futures = {
                (constant.key, scene): [
                    (changed, pool.submit(runs.compared, constant.key, changed, scene))
                    for changed in varied(values[constant.key], constant.kind)
                ]
                for constant in chosen
                for scene in scenes
                if constant.key in read[scene]
            }
            for constant in chosen:
                done = {scene: [(changed, future.result()) for changed, future in futures[constant.key, scene]] for scene in scenes if (constant.key, scene) in futures}
                found[constant.key] = effect(values[constant.key], done, bases) if done else None
                told = found[constant.key]
                print(f"{constant.key}: " + (f"{told.words()}; iterations {told.counts()}; ends {told.ends}" if told else "not read"), flush=True)
        return found, bases


PAGE_BEGIN = """# Numerical constants

Made by `make constants` with version {version}, which builds a copy of the program in which every numerical constant of the solver can be changed, and runs
scenes with each at half and at double its value. (One between 0.5 and 2 has half and twice its distance from 1.) Each constant stands at
the head of its file under `src` with its reason. Constants of drawing, reading and speed are not here.

A *change* is the root mean square, over the steps, of what a result differs from that with the program as it is, relative to the result: the
largest over the scenes. The scenes are coarse, so that the 1400 runs take less than an hour on two cores. The sand falls apart, and a change in
the last digit moves its result by about 0.08 %: where that is the largest change, the constant itself may have no effect. *Nothing* says that histories and
iterations are the same to the last bit. Iterations are those of Newton's method in all scenes that use the constant, at half and at double its value.

| scene | case | changed | result | iterations |
|---|---|---|---|---|
"""


def overview(found):
    """How many constants do how much, in words."""
    told = {key: effect for key, effect in found.items() if effect}
    large = sorted((key for key, effect in told.items() if effect.most > 0.01), key=lambda key: -told[key].most)
    counts = [sum(effect.same for effect in told.values()), sum(not effect.same and effect.most <= 1e-3 for effect in told.values())]
    named = ", ".join(f"`{key}` ({percent(told[key].most)} %)" for key in large)
    return (
        f"Of {len(told)} constants that these scenes use {counts[0]} change nothing and {counts[1]} a tenth of a percent at most. Above "
        f"one percent are {named}."
    )


def cell(text):
    return text.replace("|", "\\|")


def page(chosen, found, bases):
    """The page of the manual."""
    begin, scenes = PAGE_BEGIN.split("\n\n| scene")
    version = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(), re.MULTILINE)[1]
    commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()
    lines = [begin.replace("{version}", f"{version} (of commit {commit})"), "", overview(found), "", "| scene" + scenes.rstrip("\n")]
    for name, base in bases.items():
        scene = SCENES[name]
        settings = ", ".join(f"`{path}={json.dumps(value)}`" for path, value in scene.settings.items())
        lines.append(f"| {name} | `{scene.case}` | {settings} | `{scene.column}` | {base.iterations} |")
    folder = ""
    for constant in chosen:
        told = found[constant.key]
        if told is None:
            continue
        if constant.file.split("/")[0] != folder:
            folder = constant.file.split("/")[0]
            lines += ["", f"## `{folder}`", "", "| constant | value | what it is | scenes | change | iterations | ends early |", "|---|---|---|---|---|---|---|"]
        name = f"`{constant.file.removeprefix(folder + '/')}` {constant.name}"
        lines.append(f"| {name} | {number(told.value)} | {cell(constant.why)} | {told.scenes} | {told.words()} | {told.counts()} | {', '.join(told.ends)} |")
    others = [f"`{constant.key}`" for constant in chosen if found[constant.key] is None]
    if others:
        lines += ["", "## Not used by these scenes", "", "Constants of schemes, terms and events that they do not have: " + ", ".join(others) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="", help="a regular expression on FILE::NAME")
    parser.add_argument("--scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--write", action="store_true", help="write docs/constants.md")
    arguments = parser.parse_args()
    chosen = [constant for constant in constants() if re.search(arguments.only, constant.key)]
    found, bases = measured(chosen, arguments.scenes, arguments.jobs)
    if arguments.write:
        PAGE.write_text(page(chosen, found, bases))


if __name__ == "__main__":
    main()
