"""The cases whose closed form holds for a grid that is never restored, by the functions of their `study.py`."""

import importlib.util
import math
import time

from program import ROOT


def study(case):
    """The module cases/CASE/study.py."""
    spec = importlib.util.spec_from_file_location(f"study_{case}", ROOT / "cases" / case / "study.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def timed(function, *arguments, **named):
    """What a function returns, and its wall time [s]."""
    start = time.perf_counter()
    return function(*arguments, **named), time.perf_counter() - start


def judged(errors, tolerance):
    """Tolerance of the last error and whether it is met."""
    return f"{tolerance:.1e}: {'yes' if abs(errors[-1]) <= tolerance else '**no**'}"


def order(errors):
    return ", ".join(f"{math.log2(a / b):.2f}" for a, b in zip(errors, errors[1:]))


SECONDS = "Seconds are those of all stages of the runs of a row."


def column(quick):
    """Mean errors of stress and displacement over r = w H/E, and their orders."""
    module = study("column")
    lines = ["### Column under its own weight", "", "`cases/column`: confined, ν = 0, Hencky; closed form with Lambert's W. " + SECONDS, ""]
    lines += ["| r | cells | stress, mean over w H | order | tolerance | displacement over the settlement | order | seconds |"]
    lines += ["|---" * 8 + "|"]
    for r in [0.01, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0][:: 3 if quick else 1]:
        cells = [8, 16] if quick else [8, 16, 32]
        found, seconds = timed(lambda: [module.errors(n, r) for n in cells])
        stress, moved = zip(*found)
        lines.append(
            f"| {r} | {', '.join(map(str, cells))} | {', '.join(f'{e:.1e}' for e in stress)} | {order(stress)} | {judged(stress, 0.01)} | "
            f"{', '.join(f'{e:.1e}' for e in moved)} | {order(moved)} | {seconds:.1f} |"
        )
    return [*lines, ""]


def cantilever(quick):
    """Tip against the elastica over the slenderness, extrapolated to a thin beam."""
    module = study("cantilever")
    text = "`cases/cantilever`: P L²/EI = 5. The elastica neither shears nor stretches: the difference is the beam's thickness, of order (h/L)²."
    lines = ["### Cantilever against the elastica", "", text, ""]
    lines += ["| L/h | cells over the depth | deflection | shortening | tolerance | seconds |", "|---" * 6 + "|"]
    tips = []
    for depth in [2, 1] if quick else [2, 1, 0.5]:
        found, seconds = timed(module.tip, 0.5 * depth, depth=depth)
        tips.append(found)
        down, along = (0.01 * e for e in module.percent(found, 5))
        met = "–" if depth > 1 else judged([max(abs(down), abs(along))], 0.01)
        lines.append(f"| {20 / depth:g} | 4 | {down:+.2e} | {along:+.2e} | {met} | {seconds:.1f} |")
    deflections = [tip[0][-1] for tip in tips]
    limit = (4 * deflections[-1] - deflections[-2]) / 3 / module.elastica(5)[0] - 1
    lines.append(f"| ∞, extrapolated | 4 | {limit:+.1e} | | {judged([limit], 1e-3)} | |")
    differences = [module.percent(tip, 5)[0] for tip in tips]
    return [*lines, "", f"Order of the difference in h/L: {order(differences)}; 2 is that of the continuum.", ""]


def bar(quick):
    """Period and energy over 20 periods, and the order in the step."""
    module = study("bar")
    text = "`cases/bar`: first mode over 20 periods, ρ∞ = 1. The trapezoidal rule lengthens the period by (ωΔt)²/12; *own* is over that."
    lines = ["### Vibrating bar", "", text, ""]
    lines += ["| steps a period | period | order | own | tolerance of own | energy | seconds |", "|---" * 7 + "|"]
    errors = []
    for steps in [20, 40] if quick else [20, 40, 80]:
        (table, energy), seconds = timed(module.vibrate, module.PERIOD / steps)
        found = module.period(table)
        own = found / (math.pi * module.PERIOD / steps / math.atan(math.pi / steps)) - 1
        errors.append(found / module.PERIOD - 1)
        rate = order(errors[-2:]) if len(errors) > 1 else ""
        drift = abs(energy / energy[0] - 1).max()
        lines.append(f"| {steps} | {errors[-1]:+.2e} | {rate} | {own:+.1e} | {judged([own], 1e-4)} | {drift:.0e} | {seconds:.1f} |")
    return [*lines, ""]


def footings(quick):
    """Limit loads over the mesh."""
    module = study("strip_footing")
    lines = ["### Smooth footings", "", "`cases/strip_footing` and `cases/circular_footing`: Tresca, ν = 0.49, at 4 mm of settlement. " + SECONDS, ""]
    lines += ["| footing | exact | h at the edge [m] | error | order | tolerance | seconds |", "|---" * 7 + "|"]
    for case, name, exact in [("strip_footing", "strip", "2 + π"), ("circular_footing", "circle", "5.689")]:
        sizes = [0.1, 0.05] if quick else [0.1, 0.05, 0.025]
        found, seconds = timed(lambda: [0.01 * module.error(case, module.solve(case, h, 3, 0.004, 0.49), 0.004) for h in sizes])
        listed = ", ".join(f"{e:+.3f}" for e in found)
        lines.append(f"| {name} | {exact} | {', '.join(map(str, sizes))} | {listed} | {order(found)} | {judged(found, 0.03)} | {seconds:.1f} |")
    return [*lines, ""]


ALL = [column, cantilever, bar, footings]
