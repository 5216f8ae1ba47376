"""Runs the pile over a regular grid of rectangles by the schemes that want one, beside the plain method and DDMP.

`make pile-schemes` runs all, draws the stress below the base side by side, and prints tables.
"""

import sys
from pathlib import Path

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "pipeline"))
import together

# All of the clay is of material points: finite elements that share nodes with the grid would change its shape.
REGULAR = {
    "mesh.geo": "../../geo/pile_regular.geo",
    "mesh.parameters.h": 0.2,
    "regions.clay_far.kind": "mpm",
    "contacts[0].soil": "[clay_near, clay_far]",
}
# The methods of the literature, whose points weigh their volumes, on four-node cells; B-splines on nine-node cells, as the case as it is.
FIRST_ORDER = {"mesh.order": 1, "numerics.quadrature": "points"}
VARIANTS = {
    "mpm": FIRST_ORDER | {"numerics.gradient": "mpm"},
    "ddmp": FIRST_ORDER | {"numerics.gradient": "ddmp"},
    "cpgimp": FIRST_ORDER | {"numerics.gradient": "cpgimp"},
    "composite": FIRST_ORDER | {"numerics.gradient": "composite"},
    # Splines have no pressure field.
    "bspline": {"numerics.gradient": "bspline", "numerics.pressure": "none"},
}

if __name__ == "__main__":
    together.run(CASE, VARIANTS, base=REGULAR, out="out-regular")
