"""Prints the tables of docs/schemes.md that compare forms of the smoothed gradient.

    python benches/ddmp/study.py [operators | column | fitted]     needs numpy, scipy and numba
"""
import sys
import warnings
from multiprocessing import Pool

from column import DM, column
from forms import crossing, energies, infsup, rank

warnings.filterwarnings("ignore")

FORMS = [("plain", "0"), ("hat", "27"), ("hat", "min"), ("hats", "27"), ("split", "27"), ("zz", "27"), ("zz", "0"),
         ("quad", "0"), ("quad", "27"), ("quad", "sm"), ("quad", "min"), ("quad", "c0.5"), ("bub", (0, 0)),
         ("bub", (0.02, 0.16))]


def operators():
    print("form, crossing residual at 4.9 / 9 / 11 / 16 points a cell, spurious modes at 9 points (full, cut, lattice), "
          "inf-sup constant at 4 / 8 / 12 cells")
    for basis, blend in FORMS:
        noise = " / ".join(f"{crossing(basis, blend, n)[0]:.3f}" for n in (4.9, 9, 11, 16))
        modes = [int(rank(basis, blend, 9, seed=2, holes=h, gen=g)[0]) for h, g in ((0, 0), (1, 0), (0, 1))]
        constant = " / ".join(f"{infsup(basis, blend, n)[1]:.3f}" for n in (4, 8, 12))
        print(basis, blend, "|", noise, "|", modes, "|", constant, flush=True)
    print("energy by the plain one, least and most: points a cell, seeded or on a lattice")
    for basis, blend in (("quad", "27"), ("dbub", (0, 0))):
        for n in (4, 8):
            for points, turned in ((9, False), (16, False), (11, True)):
                print(basis, blend, n, points, turned, "%.2f %.2f" % energies(basis, blend, points, n, turned), flush=True)


def job(a):
    cells, points, basis, blend, options = a
    options = dict(options)
    DM.basis, DM.al = basis, blend
    DM.shift, DM.scale = options.pop("shift", False), options.pop("scale", False)
    scheme, surface = options.pop("weights", "ddmp"), options.pop("surface", "none")
    result = column(cells, points, scheme, surface, **options)
    error = result["why"] if result["err"] is None else f"{result['err']:.2e}, {result['its']} iterations"
    return f"{cells} cells, {points} points, {basis} {blend} {a[4]}: {error}"


def run(jobs):
    with Pool(2) as pool:
        for line in pool.imap(job, jobs, chunksize=1):
            print(line, flush=True)


def columns():
    forms = FORMS[:2] + [("split", "27"), ("zz", "27")] + FORMS[7:]
    jobs = [(n, k, b, a, {}) for n in (8, 16, 32) for k in (9, 16) for b, a in forms]
    jobs += [(n, 16, "quad", "27", o) for n in (8, 16, 32)
             for o in (dict(scale=True), dict(shift=True), dict(shift=True, scale=True), dict(gall=0.01), dict(gall=0.1),
                       dict(restore=False))]
    jobs += [(16, 16, "quad", "27", o) for o in (dict(ncol=1), dict(ncol=4), dict(steps=10), dict(steps=160))]
    jobs += [(n, 16, "quad", a, {}) for n in (8, 16, 32) for a in ("sq", "rt", "c0.7")]
    jobs += [(n, 25, "quad", "27", {}) for n in (8, 16, 32)]
    run(jobs)


def fitted():
    fit = dict(weights="fit", surface="contour")
    still = dict(weights="fit", restore=False)
    forms = [("plain", "0"), ("quad", "27"), ("bub", (0, 0)), ("dbub", (0, 0)), ("dbub", (0, 0.16)), ("dbub", (0.02, 0.16))]
    jobs = [(n, k, b, a, fit) for n in (8, 16, 32) for k in (9, 16) for b, a in forms]
    jobs += [(n, 16, b, a, still) for n in (8, 16, 32) for b, a in forms[:4]]
    jobs += [(n, 16, b, a, dict(fit, shift=True)) for n in (8, 16, 32) for b, a in forms[1:3]]
    jobs += [(n, 16, "dbub", (0, 0), {}) for n in (8, 16, 32)]
    run(jobs)


if __name__ == "__main__":
    for name in sys.argv[1:] or ["operators", "column", "fitted"]:
        dict(operators=operators, column=columns, fitted=fitted)[name]()
