"""The undrained footing by four ways: the table of the README, and reference.csv.

    .venv/bin/python cases/undrained_footing/study.py                                    # the table
    .venv/bin/python cases/undrained_footing/study.py --reference > cases/undrained_footing/reference.csv

Prandtl's bearing capacity of half a footing 2 m wide on clay of 100 kPa is (2 + π) 100 kN/m.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history, variant, write_csv

LIMIT = (2 + math.pi) * 100
STATIC = {"phases.push.analysis": "quasi_static"}
SOIL = "shear_strength: 100, density: 0"
UNDRAINED = f"young: 86957, poisson: 0.3, {SOIL}, drainage: undrained, undrained_poisson: 0.495"
WAYS = {
    "k → 0": {},
    "k → 0, surface drained": {"supports.surface.pore_pressure": 0},
    "k = 0, water apart": STATIC,
    "k = 0": STATIC | {"materials.clay": f"{{model: tresca, {UNDRAINED}}}"},
    "total stress": STATIC
    | {"materials.clay": f"{{model: tresca, young: 1.0e5, poisson: 0.495, {SOIL}}}", "output.fields": "[stress]"},
}


def load(settings):
    """The last load (kN/m)."""
    with variant("undrained_footing", settings) as out:
        return -history(out)["footing.reaction_y"][-1]


if __name__ == "__main__":
    if "--reference" in sys.argv:
        write_csv("load [kN/m]", [(LIMIT,)])
    else:
        print("| way | load [kN/m] | over (2 + π) s_u |")
        print("|---|---|---|")
        for title, settings in WAYS.items():
            found = load(settings)
            print(f"| {title} | {found:.2f} | {100 * (found / LIMIT - 1):+.2f} % |", flush=True)
