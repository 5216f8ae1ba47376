"""Kratos MPM on the same scenes, in a virtual environment of its own."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from program import ROOT, Failed, execute

HOME = ROOT / ".venv-kratos"
WANTED = ROOT / "benches/block/requirements.txt"


def install():
    """Whether Kratos is there, installed now if need be; where not the reason is printed."""
    stamp = HOME / "requirements.txt"
    try:
        if not stamp.exists() or stamp.read_text() != WANTED.read_text():
            print("installing Kratos into .venv-kratos", flush=True)
            subprocess.run([sys.executable, "-m", "venv", "--clear", HOME], check=True)
            pip = [HOME / "bin/python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", WANTED]
            subprocess.run(pip, check=True)
            stamp.write_text(WANTED.read_text())
    except (subprocess.CalledProcessError, OSError) as error:
        print(f"Kratos cannot be had here: {error}")
        return False
    return True


def run(scene, arguments, core):
    """Times and counts of the peer's run, and its points: origin, displacement, stress, volume."""
    with tempfile.TemporaryDirectory() as name:
        points = Path(name) / "points.npz"
        command = [HOME / "bin/python", ROOT / "benches/peers/kratos_elastic.py", scene, points]
        command += [part for key, value in arguments.items() for part in (f"--{key}", value)]
        done = execute(command, {"OMP_NUM_THREADS": "1"}, core)
        if done.status:
            found = re.search(r"caught exception: Error: (.{1,120})", done.out) or re.search(r"([^\n]{1,120})\s*$", done.out)
            raise Failed(found[1].strip() if found else f"status {done.status}")
        result = json.loads(done.out.strip().splitlines()[-1])
        with np.load(points) as arrays:
            return result, dict(arrays)
