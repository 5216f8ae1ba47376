"""The cases that are held against closed forms and published values, by the functions of their `study.py`."""

import importlib.util
import math
import sys
import time

from program import ROOT


def study(case, name="study"):
    """The module cases/CASE/NAME.py, and what it imports from beside it."""
    folder = ROOT / "cases" / case
    sys.path.append(str(folder))
    spec = importlib.util.spec_from_file_location(f"{name}_{case}", folder / f"{name}.py")
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
    lines = ["### Column under its own weight", "", "`cases/column`: confined, ν = 0, Hencky; closed form with Lambert's W (`tests/analytical/self_weight_column.rs`). " + SECONDS, ""]
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
    text = "`cases/cantilever`: P L²/EI = 5. The elastica (Bisshopp & Drucker 1945) has no shear and axial strain: the difference is due to the thickness h of the beam, of order (h/L)²."
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
    text = "`cases/bar`: first mode over 20 periods, ρ∞ = 1; closed form of the wave equation. The trapezoidal rule lengthens the period by (ωΔt)²/12; *own* is the error relative to that period."
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
    lines = ["### Smooth footings", "", "`cases/strip_footing` and `cases/circular_footing`: Tresca, ν = 0.49, at 4 mm of settlement; Prandtl (1920), and for the circle the method of characteristics (Shield 1955). " + SECONDS, ""]
    lines += ["| footing | exact | h at the edge [m] | error | order | tolerance | seconds |", "|---" * 7 + "|"]
    for case, name, exact in [("strip_footing", "strip", "2 + π"), ("circular_footing", "circle", "5.689")]:
        sizes = [0.1, 0.05] if quick else [0.1, 0.05, 0.025]
        found, seconds = timed(lambda: [0.01 * module.error(case, module.solve(case, h, 3, 0.004, 0.49), 0.004) for h in sizes])
        listed = ", ".join(f"{e:+.3f}" for e in found)
        lines.append(f"| {name} | {exact} | {', '.join(map(str, sizes))} | {listed} | {order(found)} | {judged(found, 0.03)} | {seconds:.1f} |")
    return [*lines, ""]


def terzaghi(quick):
    """Largest errors over the times of the table."""
    module = study("terzaghi")
    text = "`cases/terzaghi`, the series of Terzaghi & Fröhlich (1936): at T_v = 0.01 … 1 the largest errors of the settlement, over itself, and of the pressure at the base, over p₀."
    lines = ["### Terzaghi's consolidation", "", f"{text} {SECONDS}", "", "| h [m] | settlement | pressure | tolerance | seconds |", "|---" * 5 + "|"]
    for h in [0.04, 0.02] if quick else [0.04, 0.02, 0.01]:
        found, seconds = timed(module.errors, {"mesh.parameters.h": h})
        down, base = (max(map(abs, column)) for column in zip(*found))
        met = judged([max(down, base)], 5e-3) if h < 0.04 else "–"
        lines.append(f"| {h} | {down:.1e} | {base:.1e} | {met} | {seconds:.1f} |")
    return [*lines, ""]


def mandel(quick):
    """Largest errors over the times of the table."""
    module = study("mandel")
    text = "`cases/mandel`, the series of Mandel (1953), as Cheng & Detournay (1988) have it: at t = 100 s … 10 000 s the largest errors of the pressure in the middle, over p₀, and of the plate's settlement, over itself."
    lines = ["### Mandel's problem", "", f"{text} {SECONDS}", ""]
    lines += ["| ν | pressure at 1000 s over p₀ | pressure | settlement | tolerance | seconds |", "|---" * 6 + "|"]
    for poisson in [0.2] if quick else [0.2, 0.0]:
        found, seconds = timed(module.errors, poisson, 0.05)
        middle, down = (max(abs(row[i]) for row in found) for i in (1, 2))
        met = judged([max(middle, down)], 0.01)
        lines.append(f"| {poisson} | {found[1][0]:.4f} | {middle:.1e} | {down:.1e} | {met} | {seconds:.1f} |")
    return [*lines, ""]


def undrained_footing(quick):
    """The ways to have undrained soil beside each other."""
    module = study("undrained_footing")
    text = "`cases/undrained_footing`: the smooth strip in effective stress compared with total stress, h = 0.1 m at the edge; k is the permeability, *water apart* a separate field of pore pressure."
    lines = ["### Undrained footing", "", f"{text} {SECONDS}", "", "| way | error over (2 + π) s_u | difference from total stress | tolerance | seconds |", "|---" * 5 + "|"]
    total, seconds = timed(module.load, module.WAYS["total stress"])
    lines.append(f"| total stress | {total / module.LIMIT - 1:+.2e} | | – | {seconds:.1f} |")
    for way, settings in list(module.WAYS.items())[: 1 if quick else -1]:
        load, seconds = timed(module.load, settings)
        lines.append(f"| {way} | {load / module.LIMIT - 1:+.2e} | {load / total - 1:+.1e} | {judged([load / total - 1], 0.01)} | {seconds:.1f} |")
    return [*lines, ""]


def slope_safety(quick):
    """Factor of safety over the mesh."""
    module = study("slope_safety")
    text = "`cases/slope_safety`: Mohr–Coulomb, φ = 20°, c/γH = 0.05, 1 : 2; Griffiths & Lane (1999) find 1.4 by finite elements, Bishop's charts give 1.380."
    lines = ["### Factor of safety of a slope", "", f"{text} {SECONDS}", ""]
    lines += ["| h [m] | equilibrium at … none at | over 1.4 | over 1.380 | tolerance | seconds |", "|---" * 6 + "|"]
    for h in [2.0] if quick else [2.0, 1.0]:
        (low, high), seconds = timed(module.factor, h)
        error, bishop = (0.5 * (low + high) / exact - 1 for exact in (module.FINITE_ELEMENTS, module.BISHOP))
        met = judged([error], 0.03) if h < 2 else "–"
        lines.append(f"| {h:g} | {low:.3f} … {high:.3f} | {error:+.3f} | {bishop:+.3f} | {met} | {seconds:.1f} |")
    return [*lines, ""]


def drawdown(quick):
    """Factors of safety of a bank with its pool at four levels, on the mesh of the case."""
    module = study("drawdown", "variants")
    text = "`cases/drawdown`: the same bank on a rigid base, its pool and the water table in it drawn down by L; compared with Bishop's method over all circles."
    lines = ["### Factor of safety of a bank in a pool", "", f"{text} {SECONDS}", ""]
    lines += ["| L/H | h [m] | equilibrium at … none at | Bishop | error | tolerance | seconds |", "|---" * 7 + "|"]
    size = 2.0 if quick else module.SIZE
    for down in module.DRAWN_DOWN[:: 2 if quick else 1]:
        exact, _ = module.bishop.least(module.bishop.HEIGHT * (1 - down))
        (low, high), seconds = timed(module.factor, size, down)
        error = 0.5 * (low + high) / exact - 1
        met = "–" if quick else judged([error], 0.03)
        lines.append(f"| {down} | {size:g} | {low:.3f} … {high:.3f} | {exact:.3f} | {error:+.3f} | {met} | {seconds:.1f} |")
    return [*lines, ""]


def submerged_slope(quick):
    """What the bottom bears in the pool, and the slide when it is drawn down."""
    module = study("submerged_slope")
    text = "`cases/submerged_slope`: in the pool the reaction at the bottom is the buoyant weight; after the drawdown the slope slides and comes to rest."
    lines = ["### Slope whose pool is drawn down", "", f"{text} {SECONDS}", ""]
    lines += ["| h [m] | bottom over the buoyant weight − 1 | tolerance | moved in the pool [m] | at the end [m] | seconds |", "|---" * 6 + "|"]
    for h in [2.5] if quick else [1.25]:
        (bears, times, way), seconds = timed(module.run, h)
        pool = way[abs(times - module.POOL).argmin()]
        lines.append(f"| {h} | {bears - 1:+.1e} | {judged([bears - 1], 1e-3)} | {pool:.4f} | {way[-1]:.3f} | {seconds:.1f} |")
    return [*lines, ""]


def sand_column(quick):
    """Run-out over the width at the end of a collapse."""
    module = study("sand_column")
    text = (
        "`cases/sand_column`: dry sand without cohesion in plane strain; 99.5 % of the sand lies behind the toe. The law of Lube et al. (2005) is for channels, in which side walls"
        " and collisions dissipate energy that the model does not: no tolerance is set."
    )
    lines = ["### Collapse of a column of sand", "", f"{text} {SECONDS}", "", "| variant | run-out over the width | law | seconds |", "|---" * 4 + "|"]
    for name in ["a = 1, cells of 25 mm", "**a = 1**"][: 1 if quick else 2]:
        (run_out, law), seconds = timed(module.run_out, name)
        lines.append(f"| {name} | {run_out:.2f} | {law:.2f} | {seconds:.1f} |")
    return [*lines, ""]


SMALL = [column, cantilever, bar, footings]
LARGE = [terzaghi, mandel, undrained_footing, slope_safety, drawdown, submerged_slope, sand_column]
