"""Runs the pipe as it is and variants of it: `pipeline/together.py` says how and where.

`make pipeline` runs the smooth and the rough one and draws them, `make pipeline-study` all.
"""

import sys
from pathlib import Path

CASE = Path(__file__).resolve().parent
sys.path.insert(0, str(CASE.parents[1] / "pipeline"))
import together

# What is prescribed where the pipe is a rigid body, which has its middle and its rotation for unknowns.
RIGID = {"regions.pipe.rigid": "true", "phases[0].prescribe": "{pipe: {ux: 0, rotation: 0, uy: {rate: -1}}}"}

# What differs from case.yaml.
VARIANTS = {
    "smooth": {"contacts[0].adhesion_factor": 0},
    "rough": {"contacts[0].adhesion_factor": 1},
    "softening": {
        "materials.clay.model": "tresca_softening",
        "materials.clay.remoulded": 0.3,
        "materials.clay.ductility": 10,
    },
    "joined": {
        "contacts[0].tension": "no_separation",
        "phases[0].step": "{initial: 0.001, max: 0.002, min: 1.0e-6}",
    },
    "rigid": RIGID
    | {
        "phases[1].prescribe": "{pipe: {ux: 0, rotation: 0}}",
        "phases[2].prescribe": "{pipe: {ux: {rate: 1}, rotation: 0}}",
    },
    "turning": RIGID
    | {"phases[1].prescribe": "{pipe: {ux: 0}}", "phases[2].prescribe": "{pipe: {ux: {rate: 1}}}"},
    "half-step": {
        "phases[0].step": "{initial: 0.001, max: 0.002, min: 1.0e-6}",
        "phases[2].step": "{initial: 0.001, max: 0.005, min: 1.0e-6}",
    },
    "coarse": {"mesh.parameters.h": 0.14},
}

if __name__ == "__main__":
    together.run(CASE, VARIANTS)
