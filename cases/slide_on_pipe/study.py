"""Force of the slide on the pipe beside published relations: the table of the README, and its picture.

    .venv/bin/python cases/slide_on_pipe/study.py OUT [OUT ...] [-o PICTURE]
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "pipeline"))
from variants import history

STRENGTH, DENSITY, DIAMETER, SPEED = 5.0, 1.5, 1.0, 8.0  # of the clay, the pipe and the slide [kPa, t/m³, m, m/s]
STEADY = 0.1  # from when on the flow around the pipe is steady [s]; half of a shorter run


def relations(v: float) -> dict[str, float]:
    """The force (kN/m) at a velocity (m/s)."""
    dynamic = 0.5 * DENSITY * v**2 * DIAMETER
    reynolds = DENSITY * v**2 / STRENGTH
    return {
        "cavity: 0.5 ½ρv²D + 5.14 s_u D": 0.5 * dynamic + 5.14 * STRENGTH * DIAMETER,
        "Randolph & White (2012): 0.4 ½ρv²D + 11.9 s_u D": 0.4 * dynamic + 11.9 * STRENGTH * DIAMETER,
        "Zakeri et al. (2008): (1.4 + 17.5/Re^1.25) ½ρv²D": (1.4 + 17.5 / reynolds**1.25) * dynamic,
    }


def main() -> None:
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", nargs="+", type=Path)
    arguments.add_argument("-o", "--picture", type=Path)
    given = arguments.parse_args()
    curves = []
    print("| run | largest force (kN/m) | steady: velocity of the slide (m/s) | mean force (kN/m) | from its mean over a tenth of the time | impulse over loss of momentum |\n|---|---|---|---|---|---|")
    for out in given.out:
        of = history(out)
        time, force, speed = of["time"], of["pipe.contact_x"], of["slide.vx"]
        touching = time[force > 0]
        tenth = 0.1 * (time[-1] - touching[0])
        steady = time > min(STEADY, 0.5 * time[-1])
        near = [force[abs(time - t) <= tenth / 2].mean() for t in time[steady]]
        mean = np.sum((force * np.diff(time, prepend=0))[steady]) / np.sum(np.diff(time, prepend=0)[steady])
        mass = DENSITY * 32
        impulse = np.sum(force * np.diff(time, prepend=0)) / (mass * (SPEED - speed[-1]))
        curves.append((out.name, time, force))
        print(f"| {out.name} | {force.max():.0f} | {speed[steady].mean():.2f} | {mean:.1f} | {100 * abs(force[steady] / near - 1).max():.0f} % | {impulse:.4f} |")
    values = relations(speed[steady].mean())
    for name, value in values.items():
        print(f"{name}: {value:.1f} kN/m")
    if given.picture:
        import matplotlib

        matplotlib.use("agg")
        import matplotlib.pyplot as plt

        fig, axes = plt.subplots(figsize=(6, 3), layout="constrained")
        for name, time, force in curves:
            axes.plot(time, force, label=name)
        for name, value in values.items():
            (line,) = axes.plot([STEADY, time[-1]], [value, value], "--", lw=1, label=name)
        axes.set(xlabel="time (s)", ylabel="force (kN/m)", ylim=(0, None))
        axes.legend(fontsize=7)
        fig.savefig(given.picture, dpi=150)


if __name__ == "__main__":
    main()
