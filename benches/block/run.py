#!/usr/bin/env python3
"""Times the block: seconds and memory of a Newton iteration of mpm beside those of Kratos, in the same run.

Both run one thread, pinned to one core, so that not even a writer thread gets a core of its own. mpm is
charged with the whole of `mpm solve`, reading, frames and checkpoints included; Kratos only with the solution
of its steps, without setting up and without output. Needs `make build`; see `make bench-block`.

With --large the block has four times the cells: the shares of its Lagrangian phase, and one thread beside two.
With --gradients nothing but what smooth gradients cost beside plain ones, before the block yields, is measured and printed.
With --write the numbers of this run go to docs/benchmarks-block.md, if there are numbers of all.
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
MPM = Path(os.environ.get("MPM", ROOT / "target/release/mpm"))
KRATOS = ROOT / ".venv-kratos"
REPORT = ROOT / "docs/benchmarks-block.md"
# What is compared with Kratos, by the entries of the case: aims are for the scheme that a case gets.
SCHEMES = {
    "mpm, default": [],
    "mpm, classical": ["--set", "numerics.quadrature=points", "--set", "numerics.restore=every_step"],
}
LARGE = ["--set", "mesh.parameters.nx=128", "--set", "mesh.parameters.ny=100"]
# The first three steps, before anything yields, each restored.
ELASTIC = ["--set", "phases[0].duration=0.075", "--set", "numerics.restore=every_step"]
SHARES = ["factorisation", "solution", "assembly", "material", "transfer", "analysis", "output"]


def measured(command, environment=None, cores=1):
    """Runs a command on the last cores: wall and processor time [s], peak memory [MB], what it printed."""
    last = sorted(os.sched_getaffinity(0))[-cores:]
    start = time.perf_counter()
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(
            [str(part) for part in command],
            stdout=out,
            stderr=subprocess.STDOUT,
            env={**os.environ, **(environment or {})},
            preexec_fn=lambda: os.sched_setaffinity(0, last),
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        out.seek(0)
        text = out.read()
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} ended with status {process.returncode}:\n{text}")
    return {"wall": wall, "cpu": usage.ru_utime + usage.ru_stime, "peak": usage.ru_maxrss / 1024, "text": text}


def prepare(folder, settings):
    """The mesh and the points."""
    for stage in ("mesh", "seed"):
        measured([MPM, stage, HERE, "--threads", 1, "--output", folder, *settings])


def run_mpm(folder, settings, threads=1):
    """One run of mpm: its measures, iterations, points and shares of time [%]."""
    run = measured([MPM, "solve", HERE, "--threads", threads, "--output", folder, *settings], cores=threads)
    log = (folder / "solve.log").read_text()
    run["iterations"] = [int(n) for n in re.findall(r"^step .* iterations (\d+) ", log, re.MULTILINE)]
    run["points"] = int(re.search(r"(\d+) material points", log)[1])
    summary = re.search(r"solved in .*", run["text"])[0]
    run["shares"] = {name: float(share) for name, share in re.findall(r"(\w+)[^\d,;:]* (\d+(?:\.\d+)?) %", summary)}
    # The material works inside the assembly.
    run["shares"]["material"] = float(re.search(r"material, within assembly, ([\d.]+) %", summary)[1])
    run["shares"]["assembly"] -= run["shares"]["material"]
    run["solved"] = float(re.search(r"solved in ([\d.]+) s", summary)[1])
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
    run.update(wall=sum(run["seconds"]), cpu=sum(run["processor_seconds"]), peak=run["peak_mb"])
    return run


def table(ours, peer):
    """The lines of the comparison."""
    rows = [(name, runs[0], {key: middle(runs, key) for key in ("wall", "cpu", "peak")}) for name, runs in ours.items()]
    if peer:
        rows.append(("Kratos", peer, peer))
    lines = [
        "| | points | iterations of the steps | s/iteration | processor s/iteration | peak memory [MB] |",
        "|---|---|---|---|---|---|",
    ]
    each = {}
    for name, run, cost in rows:
        steps = run["iterations"]
        wall, cpu = cost["wall"] / sum(steps), cost["cpu"] / sum(steps)
        each[name] = {"wall": wall, "cpu": cpu, "peak": cost["peak"]}
        listed = f"{' '.join(map(str, steps))} = {sum(steps)}"
        lines.append(f"| {name} | {run['points']} | {listed} | {wall:.4f} | {cpu:.4f} | {cost['peak']:.0f} |")
    if peer:
        lines.append("")
        for name in ours:
            ratio = {key: each[name][key] / each["Kratos"][key] for key in ("wall", "cpu", "peak")}
            lines.append(
                f"Of what Kratos takes an iteration, {name} takes 1/{1 / ratio['wall']:.1f} of the time and "
                f"1/{1 / ratio['cpu']:.1f} of the processor time (aim: 1/8 or less), and {ratio['peak']:.2f} of the "
                "memory (aim: 0.5 or less). "
                f"All of it takes 1/{peer['wall'] / middle(ours[name], 'wall'):.1f} of the time, in fewer iterations."
            )
        if peer["unconverged"]:
            lines.append(f"Kratos did not converge in {peer['unconverged']} of its steps.")
    lines.append("")
    for name, runs in ours.items():
        walls = ", ".join(f"{run['wall']:.2f}" for run in runs)
        lines.append(f"Runs of {name} [s]: {walls} (processor: {middle(runs, 'cpu'):.2f}).")
    lines += ["", "Shares of the time [%]:", "", "| | " + " | ".join(SHARES) + " | rest |", "|" + "---|" * (len(SHARES) + 2)]
    for name, runs in ours.items():
        shares = [statistics.median(run["shares"][share] for run in runs) for share in SHARES]
        lines.append(f"| {name} | " + " | ".join(f"{share:.0f}" for share in [*shares, 100 - sum(shares)]) + " |")
    return lines


def middle(runs, key):
    """The median of a measure."""
    return statistics.median(run[key] for run in runs)


def large(folder, repeats):
    """The lines on the block of four times the cells."""
    prepare(folder, LARGE)
    # One after the other in turn, so that what else the machine does meets both.
    runs = [[run_mpm(folder, LARGE, threads) for threads in (1, 2)] for _ in range(repeats)]
    one, two = ([pair[k] for pair in runs] for k in (0, 1))
    shares = {name: statistics.median(run["shares"][name] for run in one) for name in SHARES}
    solver = shares["factorisation"] + shares["solution"]
    phase = solver + shares["assembly"] + shares["material"] + shares["analysis"]
    gain = min(run["solved"] for run in one) / min(run["solved"] for run in two)
    steps = one[0]["iterations"]
    return [
        "",
        "## Four times the cells",
        "",
        f"25 600 cells, {one[0]['points']} points, about 105 000 unknowns, default scheme, {sum(steps)} iterations in {len(steps)} steps.",
        f"Factorisation and solution take {100 * solver / phase:.0f} % of the Lagrangian phase (assembly, material, analysis,",
        f"factorisation, solution) on one thread (aim: 50 % or more). Two threads on two cores are {gain:.2f} times as fast as one on one",
        "(aim: 1.5), by the least times of these runs, in turn, each with reading, output and its writer thread:",
        "",
        "| | runs [s] | processor [s] |",
        "|---|---|---|",
        *(
            f"| {name} | {', '.join(format(run['solved'], '.2f') for run in of)} | {middle(of, 'cpu'):.2f} |"
            for name, of in (("one thread", one), ("two threads", two))
        ),
    ]


def gradients(folder, repeats):
    """The lines on smooth gradients beside plain ones: processor time of whole runs [s], the median."""
    lines = ["| | plain | smooth | ratio | iterations, plain and smooth |", "|---|---|---|---|---|"]
    settings = [
        [*ELASTIC, "--set", "numerics.quadrature=points", "--set", f"numerics.gradient={gradient}"]
        for gradient in ("mpm", "ddmp")
    ]
    folders = [folder / f"gradient{k}" for k in (0, 1)]
    for of, chosen in zip(folders, settings):
        prepare(of, chosen)
    runs = [[run_mpm(of, chosen) for of, chosen in zip(folders, settings)] for _ in range(repeats)]
    plain, smooth = (middle([pair[k] for pair in runs], "cpu") for k in (0, 1))
    steps = " and ".join(str(sum(run["iterations"])) for run in runs[0])
    lines.append(f"| volumes | {plain:.2f} | {smooth:.2f} | {smooth / plain:.1f} | {steps} |")
    return lines


INTRODUCTION = """# Time and memory compared with Kratos MPM

Made by `make bench-block`. A block 8 m × 8 m under growing gravity, quasi-static, Mohr–Coulomb (E = 1000 kPa,
ν = 0.3, ρ = 1 t/m³, c = 10 kPa, φ = 0.001 rad, ψ = 0), 11 steps of 1/40 of gravity; its floor begins to yield in
the 9th. Both programs run on one thread, pinned to one core.

- mpm: 6400 six-node triangles with 16 points each, relative residual 1e-8. *Default*: the default `numerics`, resampled quadrature with a grid
  reset by quality. *Classical*: the volumes of the points as weights (`quadrature: points`), the grid reset in every step. The time is that of the whole
  `mpm solve`: reading, solving, log, frames and a checkpoint after every step; the median of the runs.
- Kratos MPM 10.4.4 (`benches/peers/kratos_block.py`): 25 600 bilinear quadrilaterals with 4 points each on a grid
  of 51 200, sparse LU, relative residual 1e-6. The time is that of the solution of its steps only, without output and set-up.

Processor time is given because it does not include waiting for other programs on the machine.

*Solution* is the iterative solution on the factor of the symmetric part (the flow is not associated), *material*
the material models with return mapping and tangent (the program's own summary counts it as assembly); *rest* is
mostly reading the mesh and the points.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5, help="runs of mpm, of which the median counts")
    parser.add_argument("--alone", action="store_true", help="mpm without Kratos")
    parser.add_argument("--large", action="store_true", help="also the block of four times the cells, on one thread and on two")
    parser.add_argument("--gradients", action="store_true", help="only smooth gradients beside plain ones")
    parser.add_argument("--write", action="store_true", help=f"write {REPORT.relative_to(ROOT)}")
    arguments = parser.parse_args()
    ours = {name: [] for name in SCHEMES}
    with tempfile.TemporaryDirectory() as name:
        if arguments.gradients:
            print("\n".join(gradients(Path(name), arguments.repeats)))
            return
        folders = {scheme: Path(name) / str(k) for k, scheme in enumerate(SCHEMES)}
        for scheme, settings in SCHEMES.items():
            prepare(folders[scheme], settings)
        for _ in range(arguments.repeats):
            for scheme, settings in SCHEMES.items():
                ours[scheme].append(run_mpm(folders[scheme], settings))
        peer = None if arguments.alone else run_kratos()
        said = measured([MPM, "--version"])["text"].splitlines()[0]
        lines = [f"Version: {said}.", "", *table(ours, peer)]
        if arguments.large:
            lines += large(Path(name) / "large", arguments.repeats)
    print("\n".join(lines))
    if arguments.write and not (peer and arguments.large):
        print(f"\n{REPORT.relative_to(ROOT)} is kept as it is: it compares with Kratos, and has the large block.")
    elif arguments.write:
        REPORT.parent.mkdir(exist_ok=True)
        REPORT.write_text("\n".join([INTRODUCTION, *lines]) + "\n")


if __name__ == "__main__":
    main()
