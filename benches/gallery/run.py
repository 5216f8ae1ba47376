#!/usr/bin/env python3
"""Runs the cases of the gallery, compares them with their references and writes docs/gallery.md with a picture of each.

    .venv/bin/python benches/gallery/run.py [CASE …] [--threads N] [--no-pictures]

A run that is up to date is not made again: `mpm run` decides that, and what was stopped is continued by running this once more. With names of cases only these are
run, and their table is printed; the page is written when all are there. Needs `make build`; see `make gallery`.
"""

import argparse
import json
import math
import shlex
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

from entries import ENTRIES, Entry, Row  # noqa: E402
from program import PROGRAM, ROOT, execute, version  # noqa: E402

PAGE = ROOT / "docs/gallery.md"
PICTURES = ROOT / "docs/pictures/gallery"
INTRODUCTION = """# Gallery

`make gallery` runs the cases and writes this page: problems with published results, most of them offshore, with the default `numerics`. *Error* is relative to
the reference. If the reference is two bounds, it is relative to the nearer one, and *none* between them. *Within* is the accepted error for the mesh of the run; **no** means that it is exceeded, and the page of the case says why, if that is known.
Seconds are processor seconds of the solve stage on one thread. Each command also writes the series for ParaView; the page of a case says what to look at.
"""


def folder(entry: Entry, row: Row) -> Path:
    return ROOT / "cases" / entry.case / (f"out-{row.name}" if row.name else "out")


def flow(value) -> str:
    """A value as YAML in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    return str(value)


def options(settings: dict) -> list[str]:
    """The options `--set` of entries {path: value}."""
    return [part for path, value in settings.items() for part in ("--set", f"{path}={flow(value)}")]


def command(entry: Entry, row: Row) -> str:
    """The command line of a run, from the root of the repository."""
    parts = ["mpm", "run", f"cases/{entry.case}"]
    parts += ["-o", str(folder(entry, row).relative_to(ROOT))] if row.name else []
    return shlex.join([*parts, *options(row.settings)])


def run(entry: Entry, row: Row, threads: int) -> str | None:
    """Brings a run up to date and notes its processor seconds beside it; what it failed by, if it did."""
    out = folder(entry, row)
    seconds = out / "seconds.json"
    case = [ROOT / "cases" / entry.case, "-o", out, "--threads", threads, *options(row.settings)]
    done = execute([PROGRAM, "run", *case])
    # An unfinished run is continued, or made anew where the case, the mesh or the program is another one now.
    for option in ("--resume", "--fresh"):
        if done.status == 2 and option in done.out:
            done = execute([PROGRAM, "run", *case, option])
            if option == "--resume" and done.status < 2:
                resumed = json.loads(seconds.read_text()) if seconds.exists() else 0
                done.cpu += resumed
    if "solved in" in done.out or "ended after" in done.out:
        seconds.write_text(json.dumps(round(done.cpu, 1)))
    if done.status == 1:
        execute([PROGRAM, "export", *case])
        return done.reason
    if done.status:
        sys.exit(f"{command(entry, row)}: {done.reason}")
    return None


def error(value: float, reference: float | tuple[float, float]) -> float:
    """Relative distance from the reference, or from the nearer one of two bounds where it is outside of them."""
    low, high = reference if isinstance(reference, tuple) else (reference, reference)
    return value / high - 1 if value > high else value / low - 1 if value < low else 0.0


def shown(reference: float | tuple[float, float]) -> str:
    if isinstance(reference, tuple) and reference[0] != reference[1]:
        return f"{reference[0]:.4g}–{reference[1]:.4g}"
    return f"{reference[0] if isinstance(reference, tuple) else reference:.4g}"


def cells(entry: Entry, row: Row, failed: str | None) -> list[str]:
    """What was run, the number found, the reference, the error, whether it is accepted, and seconds."""
    out = folder(entry, row)
    seconds = json.loads((out / "seconds.json").read_text()) if (out / "seconds.json").exists() else None
    took = f"{seconds:.0f}" if seconds is not None else "–"
    try:
        # A run that ended early stays beside the finished one of before, if there is one.
        value = row.found(out / "unfinished" if failed and (out / "unfinished").exists() else out)
        if math.isnan(value):
            raise ValueError("not reached")
        off = error(value, row.reference)
        verdict = f"{100 * row.tolerance:.0f} %{'' if abs(off) <= row.tolerance else ': **no**'}"
        found, off = f"{value:.4g}", f"{100 * off:+.1f} %" if abs(off) >= 5e-4 else "none"
    except (OSError, AttributeError, ValueError) as reason:
        found, off, verdict = "–", "–", f"**no** ({reason})"
    note = f" (ended early: {failed.removeprefix('error: ').split(' (')[0]})" if failed else ""
    return [row.what + note, found, shown(row.reference), off, verdict, took]


def picture(entry: Entry) -> str | None:
    """Draws the last frame of the first run by `mpm plot`; its path from the page, or none where it cannot."""
    target = PICTURES / f"{entry.case}.png"
    target.parent.mkdir(parents=True, exist_ok=True)
    command = [PROGRAM, "plot", folder(entry, entry.rows[0]), "-o", target, "--field", "plastic_strain", "--width", "1000", *entry.picture]
    drawn = subprocess.run(command, capture_output=True, text=True, check=False)
    if drawn.returncode:
        print(f"no picture of {entry.case}: {' '.join(drawn.stderr.split()[:30])}", file=sys.stderr)
    return str(target.relative_to(PAGE.parent)) if target.exists() else None


def row_of(parts: list[str]) -> str:
    return "| " + " | ".join(parts) + " |"


def section(entry: Entry, failures: dict[str, str | None]) -> str:
    """The table of all runs of a case."""
    lines = [f"## {entry.case}", "", f"[Its page](../cases/{entry.case}/README.md). Compared: {entry.quantity}, with {entry.source}.", ""]
    lines += ["| run | found | reference | error | within | seconds | command |", "|---|---|---|---|---|---|---|"]
    lines += [row_of([*cells(entry, row, failures[row.name]), f"`{command(entry, row)}`"]) for row in entry.rows]
    return "\n".join(lines) + "\n"


def overview(ran: list[tuple[Entry, dict[str, str | None]]], pictures: bool) -> str:
    """A row a case: its picture, and one of its numbers."""
    lines = ["| case | plastic strain at the end | compared | found | reference | error | seconds | command |", "|---|---|---|---|---|---|---|---|"]
    for entry, failures in ran:
        drawn, row = picture(entry) if pictures else None, entry.rows[entry.headline]
        what, found, reference, off, _, took = cells(entry, row, failures[row.name])
        image = f'<a href="{drawn}"><img src="{drawn}" width="260" alt="{entry.case}"></a>' if drawn else ""
        lines.append(row_of([f"[{entry.case}](../cases/{entry.case}/README.md)", image, what, found, reference, off, took, f"`{command(entry, row)}`"]))
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [entry.case for entry in ENTRIES]
    parser.add_argument("cases", nargs="*", choices=[[], *names], default=[], help="only these; the page is not written")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--no-pictures", action="store_true")
    chosen = parser.parse_args()
    ran = []
    for entry in ENTRIES:
        if chosen.cases and entry.case not in chosen.cases:
            continue
        failures = {}
        for row in entry.rows:
            if row.name in failures:
                continue  # a further number of the same run
            print(f"--- {command(entry, row)}", file=sys.stderr, flush=True)
            failures[row.name] = run(entry, row, chosen.threads)
        ran.append((entry, failures))
        print(section(entry, failures), flush=True)
    if not chosen.cases:
        pages = [INTRODUCTION, f"Made by {version()}.\n", overview(ran, not chosen.no_pictures), *(section(*pair) for pair in ran)]
        PAGE.write_text("\n".join(pages))


if __name__ == "__main__":
    main()
