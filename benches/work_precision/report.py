"""docs/benchmarks.md with its pictures, from the numbers in docs/benchmarks/*.csv."""

import csv
import re

from program import ROOT

DATA = ROOT / "docs/benchmarks"
PAGE = ROOT / "docs/benchmarks.md"
# Colours that are told apart in print and by most eyes, and marks of their own.
STYLES = {
    "default": ("#000000", "o"),
    "plain": ("#d55e00", "s"),
    "resampled": ("#0072b2", "^"),
    "ddmp": ("#009e73", "v"),
    "plain, quality": ("#e69f00", "D"),
    "resampled, quality": ("#56b4e9", "P"),
    "resampled, no pressure field": ("#cc79a7", "<"),
    "resampled, pressure field": ("#7f3fbf", ">"),
    "never": ("#999999", "x"),
    "mpm, Q4": ("#d55e00", "1"),
    "ugimp": ("#b2182b", "2"),
    "cpgimp": ("#ef8a62", "3"),
    "cpdi": ("#2166ac", "4"),
    "cpdi, T6": ("#67a9cf", "+"),
    "cpdi2": ("#1b7837", "|"),
    "composite": ("#5aae61", "p"),
    "bspline, points": ("#bf812d", "h"),
    "bspline": ("#8c510a", "H"),
    "cubic bspline, points": ("#9970ab", "8"),
    "cubic bspline": ("#762a83", "X"),
    "resampled, Q9": ("#0072b2", "d"),
    "Kratos MPM": ("#8b0000", "*"),
    "AMPLE": ("#555555", "$A$"),
    "GeoWarp": ("#555555", "$G$"),
}
OTHERS = "by the program of others, measured once, in another series of runs"

INTRODUCTION = """# Work and precision

Made by `make bench` (`ARGS=--quick` for a few runs of each, `ARGS=--first` for the series over the size of the cells alone). Each point of a picture is a run: its error over
the seconds of the solve stage, with reading, log, frames and checkpoints. Runs use one
thread, pinned to one core; the time is the median of three if a run takes less than 3 s. For Kratos MPM 10.4.4, in the same series of runs, it is that of the solution of its steps
alone; those of AMPLE and GeoWarp were measured once, with all that they print. The numbers are in `docs/benchmarks/*.csv`, with processor seconds, Newton iterations and halvings; `--report` makes the page
from them without running anything.

Errors are reproducible to the last digit; seconds depend on the machine and its other load. If only some schemes were run again (`--schemes`),
the remark of the problem says which rows are of an earlier series. *Fails* also marks a scheme that cannot be used for a problem: the `.geo` has no grid of its
kind (`there is no DefineConstant for the parameter quads`), or the case rejects it. The reason is listed below each table.

## Schemes

| scheme | | |
|---|---|---|
"""


def rows_of(problem):
    """The remark and the rows of a problem, by schemes; None if there are none."""
    path = DATA / f"{problem.name}.csv"
    if not path.exists():
        return None
    with open(path, newline="") as file:
        remark = file.readline().lstrip("# ").strip()
        rows = [row for row in csv.DictReader(file) if row["scheme"] in STYLES]
        heads = dict.fromkeys(rows[0] if rows else [], "")
        first = next(iter(problem.measures))
        for name, runs in problem.others.items():
            for at, (error, seconds) in runs.items():
                row = {"series": problem.series[0].name, "scheme": name, "at": str(at), first: str(error), "wall [s]": str(seconds), "note": OTHERS}
                rows.append(heads | row)
        return remark, sorted(rows, key=lambda row: list(STYLES).index(row["scheme"]))


def number(text, form):
    return form.format(float(text)) if text else ""


def picture(problem, rows):
    """Error over seconds, a panel a measure and a line a series of h."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "mpm", "font.size": 10})
    from matplotlib import pyplot

    main = problem.series[0].name
    measures = list(problem.measures.items())[:2]
    figure, panels = pyplot.subplots(1, len(measures), figsize=(6.2 * len(measures), 4.6), squeeze=False)
    for panel, (key, label) in zip(panels[0], measures):
        for name, (colour, mark) in STYLES.items():
            of = [r for r in rows if r["scheme"] == name and r["series"] == main and r[key]]
            if not of:
                continue
            x, y = [float(r["wall [s]"]) for r in of], [float(r[key]) for r in of]
            panel.loglog(x, y, color=colour, marker=mark, label=name, linewidth=1.4, markersize=6)
            for r, a, b in zip(of, x, y):
                at = f"{float(r['at']):g}"
                panel.annotate(at, (a, b), textcoords="offset points", xytext=(4, 4), fontsize=7, color=colour)
        panel.set_xlabel("solve stage [s]")
        panel.set_ylabel(label)
        panel.grid(True, which="both", linewidth=0.3, alpha=0.6)
        if panel.get_legend_handles_labels()[0]:
            panel.legend(fontsize=8)
    figure.suptitle(f"{problem.title}: {main} (numbers at the points: {problem.series[0].axis})", fontsize=10)
    figure.tight_layout()
    figure.savefig(DATA / f"{problem.name}.svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def scan(key, rows):
    """What is left of a series with very many variants: the range and the worst against the trend."""
    lines = ["| scheme | runs | failed | least | largest | largest over the trend |", "|---|---|---|---|---|---|"]
    for name in dict.fromkeys(r["scheme"] for r in rows):
        of = [r for r in rows if r["scheme"] == name]
        pairs = [(float(r["at"]), float(r[key])) for r in of if r[key]]
        if not pairs:
            lines.append(f"| {name} | {len(of)} | {len(of)} | | | |")
            continue
        # The trend: second order through the median of error · n².
        level = sorted(e * n * n for n, e in pairs)[len(pairs) // 2]
        values = [e for _, e in pairs]
        worst = max((e * n * n / level, n) for n, e in pairs)
        lines.append(
            f"| {name} | {len(of)} | {len(of) - len(pairs)} | {min(values):.2e} | {max(values):.2e} | {worst[0]:.2f} at {worst[1]:g} |"
        )
    return [*lines, "", "The trend is c/n² through the median."]


def table(problem, series, rows):
    """A row a scheme; a column a variant: errors and seconds."""
    if len(series.variants) > 10:
        return scan(next(iter(problem.measures)), rows)
    ats = [at for at in dict.fromkeys(float(v.at) for v in series.variants) if any(float(r["at"]) == at for r in rows)]
    # What the largest run takes, where it was measured.
    taken = any(row.get("peak [MB]") for row in rows)
    heads = [f"{at:g}" for at in ats] + (["nonzeros a row", "peak [MB]"] if taken else [])
    lines = [f"| {series.axis} | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for name in dict.fromkeys(r["scheme"] for r in rows):
        cells = []
        for at in ats:
            row = next((r for r in rows if r["scheme"] == name and float(r["at"]) == at), None)
            if row is None:
                cells.append("–")
            elif not row["wall [s]"]:
                when = re.search(r"from t = ([\d.]+) s", row["note"])
                cells.append(f"fails at t = {float(when[1]):.2f} s" if when else "fails")
            else:
                errors = ", ".join(number(row[key], "{:.1e}") for key in problem.measures)
                mark = "¹" if row["note"] else ""
                cells.append(f"{errors} / {float(row['wall [s]']):.3g} s{mark}")
        if taken:
            of = [r for r in rows if r["scheme"] == name and r.get("peak [MB]")]
            largest = max(of, key=lambda r: float(r["peak [MB]"]), default={})
            cells += [number(largest.get("nonzeros a row"), "{:.1f}"), number(largest.get("peak [MB]"), "{:.0f}")]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    if any(r["note"] and r["wall [s]"] for r in rows):
        lines += ["", "¹ " + "; ".join(dict.fromkeys(r["note"] for r in rows if r["note"] and r["wall [s]"])) + "."]
    return lines


LEVELS = [1e-2, 1e-3, 1e-4]


def reached(problems):
    """Seconds of the cheapest run of each scheme whose error is at most that of each level."""
    heads, columns = [], []
    for problem in problems.values():
        found = rows_of(problem)
        if found is None:
            continue
        key = next(iter(problem.measures))
        of = {}
        for row in found[1]:
            if row.get(key) and row["wall [s]"]:
                of.setdefault(row["scheme"], []).append((float(row[key]), float(row["wall [s]"])))
        heads.append(problem.title.split(",")[0])
        columns.append(of)
    lines = ["| scheme | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for name in STYLES:
        cells = []
        for of in columns:
            times = [min((t for error, t in of.get(name, []) if error <= level), default=None) for level in LEVELS]
            cells.append(" / ".join("–" if t is None else f"{t:.2g}" for t in times) if name in of else "")
        if any(cells):
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def failures(rows):
    """Why runs ended early, once each."""
    found = dict.fromkeys((r["scheme"], short(r["note"])) for r in rows if r["note"] and not r["wall [s]"])
    return [f"- {name}: {note}" for name, note in found]


def short(note):
    note = note.removeprefix("error: ")
    return note.split(";")[0].split(" (residual")[0][:160]


def write(problems, schemes, missing):
    """The page, and a picture a problem."""
    lines = [INTRODUCTION.rstrip()]
    lines += [f"| {s.name} | {s.about} | {'not available yet' if missing(s) else ''} |" for s in schemes]
    lines += ["", "Sixteen points a cell where nothing else is said, three with *never*.", ""]
    lines += ["## Seconds to an error", "", "The cheapest run of each scheme with an error of at most 1 % / 0.1 % / 0.01 %, by the first measure of the problem; "]
    lines[-1] += "– where no run reached it, empty where the scheme does not run there."
    lines += ["", *reached(problems), ""]
    for problem in problems.values():
        found = rows_of(problem)
        if found is None:
            continue
        remark, rows = found
        picture(problem, rows)
        lines += [f"## {problem.title}", "", problem.text, *([remark] if remark else []), ""]
        lines += [f"![{problem.title}](benchmarks/{problem.name}.svg)", ""]
        lines += ["Each entry: " + ", ".join(problem.measures.values()) + " / seconds. Nonzeros a row of the matrix and peak of memory: of the run that takes most.", ""]
        for series in problem.series:
            of = [r for r in rows if r["series"] == series.name]
            if of:
                lines += [f"**{series.name}**", "", *table(problem, series, of), ""]
        why = failures(rows)
        if why:
            lines += ["Runs that ended early:", "", *why, ""]
    PAGE.write_text("\n".join(lines).rstrip() + "\n")
    print(f"wrote {PAGE.relative_to(ROOT)}")
