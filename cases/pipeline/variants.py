"""Runs the pipe as it is, smooth and rough: `pipeline/together.py` says how and where. `make pipeline` does it and draws them."""

import sys
from pathlib import Path

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "pipeline"))
import together

# What differs from case.yaml.
VARIANTS = {
    "smooth": {"contacts[0].adhesion_factor": 0},
    "rough": {"contacts[0].adhesion_factor": 1},
}

if __name__ == "__main__":
    together.run(CASE, VARIANTS)
