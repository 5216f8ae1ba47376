#!/usr/bin/env python3
"""Times the block: seconds and memory of a Newton iteration of mpm beside those of Kratos, in the same run.

Both run one thread, pinned to one core, so that not even a writer thread gets a core of its own. mpm is
charged with the whole of `mpm solve`, reading, frames and checkpoints included; Kratos only with the solution
of its steps, without setting up and without output. Needs `make build`; see `make bench-block`.

Writes docs/benchmarks-block.md when asked to, with the numbers of this run.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MPM = ROOT / "target/release/mpm"
KRATOS = ROOT / ".venv-kratos"
REPORT = ROOT / "docs/benchmarks-block.md"
SHARES = ["factorisation", "solution", "assembly", "material", "transfer", "analysis", "output"]


def measured(command, environment=None):
    """Runs a command on one core: wall and processor time [s], peak memory [MB], what it printed."""
    core = max(os.sched_getaffinity(0))
    start = time.perf_counter()
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(
            [str(part) for part in command],
            stdout=out,
            stderr=subprocess.STDOUT,
            env={**os.environ, **(environment or {})},
            preexec_fn=lambda: os.sched_setaffinity(0, {core}),
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        out.seek(0)
        text = out.read()
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} ended with status {process.returncode}:\n{text}")
    return {"wall": wall, "cpu": usage.ru_utime + usage.ru_stime, "peak": usage.ru_maxrss / 1024, "text": text}


def run_mpm(folder):
    """One run of mpm: its measures, iterations, points and shares of time [%]."""
    run = measured([MPM, "solve", HERE, "--threads", 1, "--output", folder])
    log = (folder / "solve.log").read_text()
    run["iterations"] = [int(n) for n in re.findall(r"^step .* iterations (\d+) ", log, re.MULTILINE)]
    run["points"] = int(re.search(r"(\d+) material points", log)[1])
    summary = re.search(r"solved in .*", run["text"])[0]
    run["shares"] = {name: float(share) for name, share in re.findall(r"(\w+)[^\d,;:]* (\d+(?:\.\d+)?) %", summary)}
    # The material works inside the assembly.
    run["shares"]["material"] = float(re.search(r"material, within assembly, ([\d.]+) %", summary)[1])
    run["shares"]["assembly"] -= run["shares"]["material"]
    return run


def run_kratos():
    """One run of Kratos, or None with the reason printed."""
    python = KRATOS / "bin/python"
    stamp = KRATOS / "requirements.txt"
    wanted = HERE / "requirements.txt"
    try:
        if not stamp.exists() or stamp.read_text() != wanted.read_text():
            print("installing Kratos into .venv-kratos", flush=True)
            subprocess.run([sys.executable, "-m", "venv", "--clear", KRATOS], check=True)
            pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", wanted]
            subprocess.run(pip, check=True)
            stamp.write_text(wanted.read_text())
        run = measured([python, ROOT / "benches/peers/kratos_block.py"], {"OMP_NUM_THREADS": "1"})
    except (subprocess.CalledProcessError, OSError, RuntimeError) as error:
        print(f"Kratos cannot be had or does not run here, mpm is printed alone: {error}")
        return None
    run.update(json.loads(run["text"].strip().splitlines()[-1]))
    run["wall"] = sum(run["seconds"])
    return run


def table(ours, peer):
    """The lines of the comparison."""
    middle = lambda key: statistics.median(run[key] for run in ours)  # noqa: E731
    first = ours[0]
    count = sum(first["iterations"])
    rows = [("mpm", first["points"], first["iterations"], middle("wall") / count, middle("peak"))]
    if peer:
        count = sum(peer["iterations"])
        rows.append(("Kratos", peer["points"], peer["iterations"], peer["wall"] / count, peer["peak_mb"]))
    lines = ["| | points | iterations of the steps | s/iteration | peak memory [MB] |", "|---|---|---|---|---|"]
    for name, points, iterations, seconds, peak in rows:
        steps = " ".join(map(str, iterations))
        lines.append(f"| {name} | {points} | {steps} = {sum(iterations)} | {seconds:.4f} | {peak:.0f} |")
    if peer:
        lines += [
            "",
            f"mpm takes 1/{rows[1][3] / rows[0][3]:.1f} of the time of Kratos an iteration (aim: 1/4 or less) and "
            f"{rows[0][4] / rows[1][4]:.2f} of its memory (aim: 0.5 or less).",
        ]
        if peer["unconverged"]:
            lines.append(f"Kratos did not converge in {peer['unconverged']} of its steps.")
    walls = ", ".join(f"{run['wall']:.2f}" for run in ours)
    lines += [
        "",
        f"Runs of mpm [s]: {walls} (processor {middle('cpu'):.2f}). Shares of the time [%]:",
        "",
        "| " + " | ".join(SHARES) + " | rest |",
        "|" + "---|" * (len(SHARES) + 1),
    ]
    shares = [statistics.median(run["shares"][name] for run in ours) for name in SHARES]
    lines.append("| " + " | ".join(f"{share:.0f}" for share in [*shares, 100 - sum(shares)]) + " |")
    return lines


INTRODUCTION = """# Time and memory: the block

Made by `make bench-block`. A block 8 m × 8 m under growing gravity, quasi-static, Mohr–Coulomb (E = 1000 kPa,
ν = 0.3, ρ = 1 t/m³, c = 10 kPa, φ = 0.001 rad, ψ = 0), 11 steps of 1/40 of gravity; its floor begins to yield in
the 9th. Both programs run on one thread, pinned to one core.

- mpm: 6400 six-node triangles with 16 points each, the grid restored in every step, relative residual 1e-8.
  Charged with the whole of `mpm solve`: reading, solving, log, frames and a checkpoint after every step. The
  median of the runs.
- Kratos MPM 10.4.4 (`benches/peers/kratos_block.py`): 25 600 bilinear quadrilaterals with 4 points each on a grid
  of 51 200, sparse LU, relative residual 1e-6. Charged with the solution of its steps only: no output, no set-up.

*Solution* is the iterative solution on the factor of the symmetric part (the flow is not associated), *material*
the models with their return and tangent, a part of what the program's own summary calls assembly; *rest* is
mostly reading the mesh and the points.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5, help="runs of mpm, of which the median counts")
    parser.add_argument("--alone", action="store_true", help="mpm without Kratos")
    parser.add_argument("--write", action="store_true", help=f"write {REPORT.relative_to(ROOT)}")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for stage in ("mesh", "seed"):
            measured([MPM, stage, HERE, "--threads", 1, "--output", folder])
        ours = [run_mpm(folder) for _ in range(arguments.repeats)]
    peer = None if arguments.alone else run_kratos()
    lines = table(ours, peer)
    print("\n".join(lines))
    if arguments.write:
        REPORT.parent.mkdir(exist_ok=True)
        REPORT.write_text("\n".join([INTRODUCTION, *lines]) + "\n")


if __name__ == "__main__":
    main()
