"""Runs the pile as it is, with other adhesion and with other schemes: `pipeline/together.py` says how and where.

`make pile-variants` runs all, draws them and prints their tables.
"""

import sys
from pathlib import Path

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "pipeline"))
import together

# What differs from case.yaml. `mpm` and `ddmp` are the methods of the literature, whose points weigh their volumes; the default is beside them.
VARIANTS = {
    "smooth": {"contacts[0].adhesion_factor": 0},
    "rough": {"contacts[0].adhesion_factor": 1},
    "mpm": {"numerics.gradient": "mpm", "numerics.quadrature": "points"},
    "ddmp": {"numerics.gradient": "ddmp", "numerics.quadrature": "points"},
}

if __name__ == "__main__":
    together.run(CASE, VARIANTS)
