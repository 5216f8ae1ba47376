"""Draws the figures of docs/theory.md, docs/schemes.md and docs/code-tour.md as SVG: `python docs/figures/make.py [FOLDER FOR PNG]`.

It needs matplotlib (3.8 or newer). The same input gives the same bytes: no dates, a fixed salt for the identifiers.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch, Polygon, Rectangle

plt.rcParams.update(
    {
        "svg.hashsalt": "mpm",
        "svg.fonttype": "none",
        "font.family": "sans-serif",
        "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "lines.linewidth": 1.5,
        "figure.facecolor": "white",
    }
)

SOIL, FEM, CUT, EMPTY, OFF = "#e7d8b8", "#b9cfe6", "#f5ecd6", "#f4f4f4", "#ffffff"
GRID, DARK, RED, BLUE, GREEN, BROWN = "#9a9a9a", "#222222", "#c0392b", "#1f5fa8", "#2e7d32", "#7a5a1e"
STEEL = "#8d99a6"


def bare(ax):
    ax.set_aspect("equal")
    ax.axis("off")


def arrow(ax, a, b, color=DARK, width=1.2, style="-|>", size=9, **more):
    ax.add_patch(
        FancyArrowPatch(a, b, arrowstyle=style, mutation_scale=size, color=color, lw=width, shrinkA=0, shrinkB=0, **more)
    )


def save(fig, name, png):
    folder = Path(__file__).parent
    fig.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None}, bbox_inches="tight", pad_inches=0.05)
    if png:
        fig.savefig(Path(png) / f"{name}.png", dpi=110, bbox_inches="tight", pad_inches=0.05)
    plt.close(fig)


# The three phases of a step.


def step_phases(png):
    fig, axes = plt.subplots(1, 3, figsize=(10.2, 3.5))
    nx, ny = 5, 4
    nodes = np.array([[i, j] for j in range(ny + 1) for i in range(nx + 1)], float)
    lines = [[(i, j), (i + 1, j)] for j in range(ny + 1) for i in range(nx)]
    lines += [[(i, j), (i, j + 1)] for j in range(ny) for i in range(nx + 1)]

    def moved(x):
        x = np.asarray(x, float)
        y = x.copy()
        grow = x[..., 1] / ny
        y[..., 0] = x[..., 0] + 0.55 * grow**1.3 * np.exp(-((x[..., 0] - 2.2) ** 2) / 6)
        y[..., 1] = x[..., 1] - 0.38 * grow * np.exp(-((x[..., 0] - 1.9) ** 2) / 3)
        return y

    def grid(ax, map_, color, style="-", width=0.9):
        for line in lines:
            t = np.linspace(0, 1, 9)[:, None]
            pts = map_(np.array(line[0]) * (1 - t) + np.array(line[1]) * t)
            ax.plot(pts[:, 0], pts[:, 1], color=color, lw=width, ls=style, zorder=1)

    inside = lambda x: x[1] < 2.9 and x[0] < 3.9 and x[1] < 2.9 - 0.35 * max(0.0, x[0] - 1.2) ** 1.5
    points = np.array([[0.25 + 0.5 * i, 0.25 + 0.5 * j] for j in range(8) for i in range(10)])
    points = np.array([p for p in points if inside(p)])

    titles = ["1  Initialise", "2  Solve (Lagrange)", "3  Convect"]
    notes = [
        "grid reset, points located;\nmass and momentum\nto the nodes (11)",
        "Newton: R(u) = 0 on the grid,\nwhich moves with the soil (1)–(10);\narrows: u of the nodes",
        "points take displacement,\nvelocity, stress and F (12);\ndashed: grid after the next reset",
    ]
    for ax, title, note in zip(axes, titles, notes):
        bare(ax)
        ax.set_title(title, loc="left", fontweight="bold")
        ax.text(2.5, -0.35, note, ha="center", va="top", fontsize=9)
        ax.set_xlim(-0.15, 5.45)
        ax.set_ylim(-1.3, 4.2)

    ax = axes[0]
    grid(ax, lambda x: np.asarray(x, float), GRID)
    ax.plot(*points.T, "o", ms=4, color=BROWN)
    for p in points:
        if 1 < p[0] < 2 and 1 < p[1] < 2:
            for n in [(1, 1), (2, 1), (1, 2), (2, 2)]:
                arrow(ax, p, np.array(p) * 0.12 + np.array(n) * 0.88, BLUE, 0.6, size=6)
    for n in [(1, 1), (2, 1), (1, 2), (2, 2)]:
        ax.plot(*n, "s", ms=5, color=BLUE)

    ax = axes[1]
    grid(ax, lambda x: np.asarray(x, float), "#dddddd")
    grid(ax, moved, GRID)
    ax.plot(*moved(points).T, "o", ms=4, color=BROWN)
    for n in nodes:
        if 0 < n[0] < 4 and 1 < n[1] < 4:
            arrow(ax, n, moved(n), RED, 1.0, size=7)

    ax = axes[2]
    grid(ax, lambda x: np.asarray(x, float), GRID, (0, (3, 2)), 0.8)
    ax.plot(*points.T, "o", ms=3, color="#d9c9a0")
    ends = moved(points)
    for a, b in zip(points, ends):
        if np.hypot(*(b - a)) > 0.1:
            arrow(ax, a, b, BROWN, 0.6, size=5)
    ax.plot(*ends.T, "o", ms=4, color=BROWN)
    fig.subplots_adjust(wspace=0.04)
    save(fig, "step", png)


# The parts of the domain, and where integrals are summed.


def triangles_of(nx, ny, width, height, jitter):
    random = np.random.RandomState(3)
    x = np.array([[i * width / nx, j * height / ny] for j in range(ny + 1) for i in range(nx + 1)], float)
    for k, (i, j) in enumerate([(i, j) for j in range(ny + 1) for i in range(nx + 1)]):
        shift = jitter * (random.rand(2) - 0.5)
        if 0 < i < nx and 0 < j < ny:
            x[k] += shift
    cells = []
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = (j * (nx + 1) + i, j * (nx + 1) + i + 1, (j + 1) * (nx + 1) + i + 1, (j + 1) * (nx + 1) + i)
            cells += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return x, cells


GAUSS = [(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)]


def gauss(t):
    t = np.asarray(t)
    return [t[0] + s * (t[1] - t[0]) + r * (t[2] - t[0]) for s, r in GAUSS]


def positive(t, values):
    """The triangles of the part of a triangle where the linear function with these corner values is positive."""
    t, out = [np.asarray(p) for p in t], []
    polygon = []
    for i in range(3):
        j = (i + 1) % 3
        if values[i] > 0:
            polygon.append(t[i])
        if values[i] * values[j] < 0:
            s = values[i] / (values[i] - values[j])
            polygon.append(t[i] + s * (t[j] - t[i]))
    for k in range(1, len(polygon) - 1):
        out.append((polygon[0], polygon[k], polygon[k + 1]))
    return polygon, out


def regions(png):
    fig, ax = plt.subplots(figsize=(10.2, 5.4))
    bare(ax)
    x, cells = triangles_of(11, 7, 11.0, 7.0, 0.28)
    # Level set, positive in the soil.
    surface = lambda s: 3.62 + 0.42 * np.cos(0.62 * (s - 3.2)) - 0.02 * (s - 5.5) ** 2
    level = surface(x[:, 0]) - x[:, 1]
    is_fem = [max(x[n][1] for n in c) < 1.25 for c in cells]
    kinds, parts, of_elements = [], [], []
    for c, fem in zip(cells, is_fem):
        v = [level[n] for n in c]
        kinds.append("fem" if fem else "full" if min(v) >= 0 else "cut" if max(v) > 0 else "empty")
    active = [k != "empty" for k in kinds]
    for _ in range(2):
        reached = {n for c, a in zip(cells, active) if a for n in c}
        active = [a or bool(set(c) & reached) for c, a in zip(cells, active)]
    for c, k, r in zip(cells, kinds, active):
        color = {"fem": FEM, "full": SOIL, "cut": CUT, "empty": EMPTY if r else OFF}[k]
        edge = GRID if r else "#c8c8c8"
        ax.add_patch(Polygon(x[list(c)], closed=True, fc=color, ec=edge, lw=0.7, ls="-" if r else ":", zorder=1 if r else 0.5))
        if k == "cut":
            polygon, pieces = positive(x[list(c)], [level[n] for n in c])
            ax.add_patch(Polygon(polygon, closed=True, fc=SOIL, ec="none", zorder=1.5))
            for piece in pieces:
                ax.add_patch(Polygon(piece, closed=True, fill=False, ec="#c9b57d", lw=0.5, zorder=1.6))
                parts += gauss(piece)
        if k == "full":
            parts += gauss(x[list(c)])
        if k == "fem":
            of_elements += gauss(x[list(c)])
    ax.plot(*np.array(of_elements).T, "+", ms=4, color=BLUE, zorder=4)
    # Faces with a ghost penalty: those of cut cells within the grid.
    edges = {}
    for number, c in enumerate(cells):
        for i in range(3):
            edges.setdefault(tuple(sorted((c[i], c[(i + 1) % 3]))), []).append(number)
    ghost = []
    for (a, b), of in edges.items():
        k = [kinds[i] for i in of]
        if len(of) == 2 and "fem" not in k and "cut" in k:
            ghost.append([x[a], x[b]])
    ax.add_collection(LineCollection(ghost, colors=RED, linewidths=1.8, zorder=3))
    # Zero of the level set within the cut cells.
    zero = []
    for c, k in zip(cells, kinds):
        if k == "cut":
            v, t, cut = [level[n] for n in c], x[list(c)], []
            for i in range(3):
                j = (i + 1) % 3
                if v[i] * v[j] < 0:
                    s = v[i] / (v[i] - v[j])
                    cut.append(t[i] + s * (t[j] - t[i]))
            zero.append(cut)
    ax.add_collection(LineCollection(zero, colors=DARK, linewidths=1.6, zorder=3.5))
    # Material points, moved through the grid: no longer in step with the cells.
    random = np.random.RandomState(5)
    points = []
    for i in range(44):
        for j in range(20):
            p = np.array([0.13 + 0.25 * i, 1.16 + 0.19 * j]) + 0.07 * (random.rand(2) - 0.5)
            if 1.12 < p[1] < surface(p[0]) - 0.07 and 0.05 < p[0] < 10.95:
                points.append(p)
    ax.plot(*np.array(points).T, ".", ms=2.6, color=BROWN, zorder=2)
    ax.plot(*np.array(parts).T, "x", ms=4.2, mew=1.0, color=GREEN, zorder=4)

    def label(text, at, to, ha="left"):
        ax.annotate(text, to, at, ha=ha, va="center", arrowprops={"arrowstyle": "-", "lw": 0.8, "color": DARK}, zorder=6)

    label("inactive cells: no unknowns", (11.4, 6.6), (10.6, 6.6))
    label("empty cells, active (two rings):\nsoft stiffness (13)", (11.4, 5.6), (10.6, 5.45))
    label("faces with ghost penalty (13b)", (11.4, 4.55), (10.5, 4.02))
    label("free surface: zero of the level set", (11.4, 3.75), (10.3, surface(10.3) + 0.03))
    label("cut cell: three integration points\nin each triangle of the part inside", (11.4, 2.95), (10.72, 2.83))
    label("full cell: Gauss points", (11.4, 1.95), (10.75, 1.75))
    label("finite elements, conforming to\nthe grid, fixed quadrature points", (11.4, 0.8), (10.7, 0.55))
    handles = [
        plt.Line2D([], [], ls="", marker=".", ms=5, color=BROWN, label="material points (state, motion)"),
        plt.Line2D([], [], ls="", marker="x", ms=5, color=GREEN, label="integration points (integrals)"),
        plt.Line2D([], [], ls="", marker="+", ms=6, color=BLUE, label="quadrature points of finite elements"),
        plt.Line2D([], [], color=RED, lw=1.8, label="faces of the ghost penalty"),
    ]
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.02), ncol=4, frameon=False, fontsize=8.5)
    for text, y in [("buffer", 5.5), ("soil: MPM", 2.3), ("FEM", 0.5)]:
        ax.text(-0.2, y, text, rotation=90, ha="right", va="center", fontsize=9)
    ax.set_xlim(-0.6, 15.9)
    ax.set_ylim(-0.2, 7.1)
    save(fig, "regions", png)


# Reconstruction of the state from the material points.


def reconstruction(png):
    fig, (ax, graph) = plt.subplots(1, 2, figsize=(10.2, 4.0), gridspec_kw={"width_ratios": [1.15, 1]})
    bare(ax)
    x, cells = triangles_of(8, 6, 8.0, 6.0, 0.3)
    centre = np.array([4.1, 2.85])
    middle = [x[list(c)].mean(axis=0) for c in cells]
    own = int(np.argmin([np.hypot(*(m - centre)) for m in middle]))
    ring = {own: 0}
    for r in (1, 2, 3):
        corners = {n for c in ring for n in cells[c]}
        for number, c in enumerate(cells):
            if number not in ring and set(c) & corners:
                ring[number] = r
    colors = ["#f2b36d", "#f6d2a2", "#faeacf", "#fdf7ec"]
    for number, c in enumerate(cells):
        color = colors[ring[number]] if number in ring else "white"
        ax.add_patch(Polygon(x[list(c)], closed=True, fc=color, ec=GRID, lw=0.8))
    random = np.random.RandomState(8)
    points = np.array([[0.28 + 0.47 * i, 0.25 + 0.43 * j] for j in range(14) for i in range(17)])
    points = points + 0.22 * (random.rand(*points.shape) - 0.5)
    points = points[(points[:, 0] < 7.95) & (points[:, 1] < 5.95)]

    def cell_of(p):
        for number, c in enumerate(cells):
            a, b, d = x[list(c)]
            m = np.linalg.solve(np.array([b - a, d - a]).T, p - a)
            if m.min() >= 0 and m.sum() <= 1:
                return number
        return -1

    size = {0: 5.5, 1: 4.0, 2: 2.8, 3: 1.8}
    rings = [ring.get(cell_of(p)) for p in points]
    for r, ms in size.items():
        ax.plot(*points[[k == r for k in rings]].T, "o", ms=ms, color=BROWN, mec="none")
    ax.plot(*np.array(gauss(x[list(cells[own])])).T, "x", ms=9, mew=2.2, color=GREEN)
    t = x[list(cells[own])]
    ax.add_patch(Polygon(t, closed=True, fill=False, ec=DARK, lw=1.6))
    entries = [(0, "ring 0: the cell, ω = 1"), (1, "ring 1, ω = 0.1"), (2, "ring 2, ω = 0.01"), (3, "ring 3, ω = 0.001")]
    handles = [
        plt.Line2D([], [], ls="", marker="s", ms=9, color=colors[r], mec=GRID, mew=0.6, label=text) for r, text in entries
    ]
    handles.append(plt.Line2D([], [], ls="", marker="o", ms=4, color=BROWN, label="material points"))
    handles.append(plt.Line2D([], [], ls="", marker="x", ms=7, mew=2, color=GREEN, label="integration points"))
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=3, frameon=False, fontsize=8.5)
    ax.set_xlim(-0.05, 8.05)
    ax.set_ylim(-0.05, 6.05)
    ax.set_title("Points that may enter the fit of a cell (13a)", loc="left")

    s = np.array([-0.34, -0.19, -0.08, 0.07, 0.22, 0.31])
    f = 1.6 + 1.5 * s + np.array([0.05, -0.09, 0.06, -0.03, 0.08, -0.07])
    far = np.array([-1.25, -1.02, -0.83, -0.62, 0.61, 0.8, 1.04, 1.21])
    f_far = 1.6 + 1.5 * far + 0.75 * np.sign(far) * (np.abs(far) - 0.5) ** 2 + 0.05 * np.cos(9 * far)
    k = np.polyfit(s, f, 1)
    graph.axvspan(-0.5, 0.5, color=colors[0], alpha=0.55, lw=0)
    for a, b in [(-1.5, -0.5), (0.5, 1.5)]:
        graph.axvspan(a, b, color=colors[1], alpha=0.4, lw=0)
    for edge in (-0.5, 0.5):
        graph.axvline(edge, color=GRID, lw=0.8)
    graph.plot(far, f_far, "o", ms=4, color=BROWN, alpha=0.6)
    graph.plot(s, f, "o", ms=6, color=BROWN, label="values at the material points, f_p")
    line = np.array([-0.5, 0.5])
    graph.plot(line, np.polyval(k, line), color=DARK, label="linear fit over the cell, P(x) c")
    places = np.array([-0.3, 0.0, 0.3])
    graph.plot(places, np.polyval(k, places), "x", ms=10, mew=2.2, color=GREEN, label="values at the integration points")
    graph.set_xticks([-1, 0, 1], ["neighbour", "cell", "neighbour"])
    graph.set_yticks([])
    graph.set_xlim(-1.5, 1.5)
    graph.set_ylabel("stress, pressure, ln J, density …")
    graph.legend(loc="upper left", frameon=False, fontsize=8.5)
    graph.set_ylim(-1.0, 4.9)
    graph.set_title("The fit in one cell", loc="left")
    fig.subplots_adjust(wspace=0.12)
    save(fig, "reconstruction", png)


# Contact of a structure that cuts the grid.


def contact(png):
    fig = plt.figure(figsize=(10.2, 6.3))
    ax = fig.add_axes([0.0, 0.33, 1.0, 0.67])
    bare(ax)
    x, cells = triangles_of(9, 5, 9.0, 5.0, 0.0)
    centre, radius, gap = np.array([4.5, 5.6]), 2.9, 0.27
    for c in cells:
        ax.add_patch(Polygon(x[list(c)], closed=True, fc="white", ec="#cfcfcf", lw=0.7, zorder=0))
    # Soil below its surface; the surface meets the structure over a part of it.
    angle = np.linspace(-np.pi, 0, 200)
    outline = centre + radius * np.array([np.cos(angle), np.sin(angle)]).T
    opening = lambda a: gap * np.clip((np.abs(a + np.pi / 2) - 0.5) / 0.35, 0, 1.6)
    own = [(a, centre + (radius + opening(a)) * np.array([np.cos(a), np.sin(a)])) for a in angle]
    facing = np.array([p for a, p in own if abs(a + np.pi / 2) < 1.02])
    edge = np.vstack([[[0, facing[0, 1] + 0.12]], facing, [[9, facing[-1, 1] + 0.12]]])
    soil = np.vstack([[[0, 0]], edge, [[9, 0]]])
    ax.add_patch(Polygon(soil, closed=True, fc=SOIL, alpha=0.75, ec="none", zorder=1))
    ax.plot(*edge.T, color=DARK, lw=1.3, zorder=3)
    for c in cells:
        ax.add_patch(Polygon(x[list(c)], closed=True, fill=False, ec="#b9b9b9", lw=0.6, zorder=2))
    ax.add_patch(Polygon(outline, closed=True, fc=STEEL, alpha=0.65, ec=DARK, lw=1.2, zorder=2.5))
    nodes = -np.pi / 2 + 0.29 * np.arange(-4, 5)
    at = lambda a, r=radius: centre + r * np.array([np.cos(a), np.sin(a)])
    ticks = [[at(a, radius - 0.07), at(a, radius + 0.07)] for a in np.arange(nodes[0], nodes[-1] + 1e-9, 0.29 / 5)]
    ax.add_collection(LineCollection(ticks, colors=DARK, linewidths=0.8, zorder=4))
    for k, a in enumerate(nodes):
        ax.plot(*at(a), "o", ms=6.5, color=RED, mec="white", mew=0.8, zorder=5)
    k = 7
    a = nodes[k]
    arrow(ax, at(a, radius + 0.02), at(a, radius + opening(a)), GREEN, 1.6, "<->", 7, zorder=6)
    arrow(ax, at(nodes[5], radius), at(nodes[5], radius - 0.75), BLUE, 1.6, "<|-", 9, zorder=6)
    tangent = np.array([-np.sin(nodes[5]), np.cos(nodes[5])])
    arrow(ax, at(nodes[5], radius), at(nodes[5], radius) + 0.7 * tangent, BLUE, 1.6, zorder=6)
    ax.text(*(at(nodes[5], radius - 0.95) + np.array([-0.12, 0.0])), "p", color=BLUE, zorder=7, fontsize=11)
    ax.text(*(at(nodes[5], radius) + 0.75 * tangent + np.array([0.02, -0.3])), "τ", color=BLUE, zorder=7, fontsize=11)
    random = np.random.RandomState(2)
    points = []
    for i in range(36):
        for j in range(16):
            p = np.array([0.12 + 0.25 * i, 0.12 + 0.22 * j]) + 0.06 * (random.rand(2) - 0.5)
            d = p - centre
            a_p = np.arctan2(d[1], d[0])
            top = edge[np.argmin(np.abs(edge[:, 0] - p[0])), 1]
            if np.hypot(*d) > radius + opening(a_p) + 0.08 and p[1] < top - 0.06:
                points.append(p)
    ax.plot(*np.array(points).T, ".", ms=2.6, color=BROWN, zorder=2.6)

    def label(text, at_, to):
        ax.annotate(text, to, at_, ha="left", va="center", arrowprops={"arrowstyle": "-", "lw": 0.8, "color": DARK}, zorder=8)

    label("structure: its boundary cuts the cells", (9.35, 4.75), (6.55, 4.75))
    label("gap g along the normal n", (9.35, 4.1), tuple(at(a, radius + 0.5 * opening(a))))
    label("contact nodes (multipliers λ, λ_t),\nhalf a cell's edge apart", (9.35, 3.3), tuple(at(nodes[6])))
    label("segments, five to a spacing", (9.35, 2.45), tuple(at(nodes[5] + 0.29 / 2.2, radius + 0.06)))
    label("surface of the soil: contact closed here", (9.35, 1.75), tuple(at(nodes[4] + 0.1, radius + 0.02)))
    label("material points", (9.35, 0.9), (8.3, 0.95))
    ax.set_xlim(-0.1, 14.6)
    ax.set_ylim(-0.1, 5.7)

    one = fig.add_axes([0.05, 0.065, 0.48, 0.20])
    s = np.linspace(0, 6, 601)
    for k in range(7):
        psi = np.clip(1 - np.abs(s - k), 0, None)
        one.plot(s, psi, color=RED if k == 3 else "#d9a29b", lw=2 if k == 3 else 1.0)
        one.plot(k, 0, "o", ms=5, color=RED, clip_on=False)
    one.bar(np.arange(0.1, 6, 0.2), np.clip(1 - np.abs(np.arange(0.1, 6, 0.2) - 3), 0, None), 0.19, color=RED, alpha=0.18)
    one.text(3.0, 1.1, "ψ_k", color=RED, ha="center")
    one.set_ylim(0, 1.35)
    one.set_xlim(0, 6)
    one.set_yticks([0, 1])
    one.set_xticks(range(7), ["k−3", "k−2", "k−1", "k", "k+1", "k+2", "k+3"])
    one.set_title("Multiplier basis functions along the boundary; bars: segments (28)", loc="left", fontsize=9)

    law = fig.add_axes([0.63, 0.065, 0.33, 0.20])
    g = np.linspace(-1, 1.6, 300)
    q, d = 0.6 - 1.2 * g, 0.25
    p = np.where(q >= d, q, np.where(q <= -d, 0, (q + d) ** 2 / (4 * d)))
    limit = np.clip(1 - np.clip(g, 0, None) / 1.0, 0, 1)
    law.plot(g, p, color=BLUE, label="pressure p = ⟨λ − ε_n g⟩, rounded")
    law.plot(g, 0.9 * limit, color=GREEN, ls="--", label="limit of adhesive shear, (1 − ⟨g⟩/w)")
    law.axvline(0, color=GRID, lw=0.8)
    law.set_xticks([0, 0.5, 1.0], ["0", "λ/ε_n", "w"])
    law.set_yticks([0])
    law.set_xlabel("gap g", labelpad=-2, loc="right")
    law.set_ylim(0, 3.0)
    law.set_xlim(-1, 1.6)
    law.legend(frameon=False, fontsize=8, loc="upper right", bbox_to_anchor=(1.04, 1.1))
    law.set_title("Contact law (29)", loc="left", fontsize=9)
    save(fig, "contact", png)


# Newton's method with its line search.


def newton(png):
    fig, ax = plt.subplots(figsize=(10.2, 7.4))
    ax.axis("off")
    ax.set_xlim(-2, 101)
    ax.set_ylim(-1.5, 79)

    def box(x, y, w, h, text, color="#eef3f9", edge=BLUE):
        ax.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle="round,pad=0.2", fc=color, ec=edge, lw=1.1))
        ax.text(x, y, text, ha="center", va="center", fontsize=8.5)

    def ask(x, y, w, h, text):
        ax.add_patch(Polygon([(x - w / 2, y), (x, y + h / 2), (x + w / 2, y), (x, y - h / 2)], fc="#fdf6e3", ec=BROWN, lw=1.1))
        ax.text(x, y, text, ha="center", va="center", fontsize=8.5)

    def way(points, text=None, at=None):
        for a, b in zip(points[:-2], points[1:-1]):
            ax.plot([a[0], b[0]], [a[1], b[1]], color=DARK, lw=1.1)
        arrow(ax, points[-2], points[-1], DARK, 1.1, size=9)
        if text:
            ax.text(*at, text, fontsize=8, color=DARK, ha="center", va="center")

    def connector(x, y, name):
        ax.add_patch(Circle((x, y), 1.7, fc="white", ec=RED, lw=1.3, zorder=5))
        ax.text(x, y - 0.1, name, ha="center", va="center", fontsize=9, fontweight="bold", color=RED, zorder=6)

    box(22, 75, 36, 5, "predictor: u + last increment · Δt/Δt_last")
    box(22, 66.5, 36, 6, "with contact: up to three iterations\nwith the contact status frozen")
    ask(22, 55.5, 38, 10.5, "‖R‖ ≤ tolerance · scale,\ngiven displacements reached?")
    box(22, 44, 36, 6, "direction: K δ = −R (14),\nby factorisation or iteration (15)")
    box(22, 35, 36, 5, "full step, s = 1: R(u + δ)")
    ask(22, 24.5, 38, 10.5, "‖R‖ > ¼ of before and\nw(1) > −w(0)/2?")
    ask(20, 10, 32, 9.5, "‖R‖ reduced (14)?")
    box(60, 55.5, 26, 5, "converged: convect", "#e8f3e8", GREEN)
    box(58, 24.5, 30, 6.5, "energy line search:\n|w(s)| ≤ −w(0)/2 by regula falsi")
    ask(56, 10, 32, 9.5, "watchdog: fewer than\nthree such steps in a row?")
    box(56, 1.2, 36, 3.6, "take the full step, keep the best state")
    box(88, 10, 24, 9, "back to the best state;\nfrom then on backtracking:\ns = ½ … 1/64 until (14)")
    box(88, 30, 24, 9, "no such s, or s ≤ ⅛:\nraise the diagonal of K\n(Levenberg), 10⁻⁴ … 10⁻¹", "#fbeceb", RED)
    box(88, 66.5, 24, 12, "step given up: again\nwithout the predictor, on\na reset grid; after that\nΔt is halved, to step.min", "#fbeceb", RED)
    way([(22, 72.2), (22, 69.8)])
    way([(22, 63.2), (22, 60.9)])
    way([(41, 55.5), (46.7, 55.5)], "yes", (43.4, 56.8))
    way([(22, 50.2), (22, 47.3)], "no", (24.2, 48.9))
    way([(22, 40.7), (22, 37.8)])
    way([(22, 32.2), (22, 29.9)])
    way([(41, 24.5), (42.7, 24.5)], "yes", (40.4, 26.6))
    way([(22, 19.2), (22, 14.9)], "no", (24.2, 17.4))
    way([(36, 10), (39.9, 10)], "no", (37.6, 11.4))
    way([(4, 10), (1.5, 10), (1.5, 55.5), (2.9, 55.5)])
    ax.text(0.7, 33, "yes: accept", fontsize=8, rotation=90, va="center", ha="right")
    connector(1.5, 51.5, "A")
    way([(56, 5.2), (56, 3.3)], "yes", (58.3, 4.5))
    way([(37.8, 1.2), (33, 1.2)], "", (0, 0))
    connector(31.2, 1.2, "A")
    way([(72, 10), (75.7, 10)], "no", (73.6, 11.4))
    way([(58, 28.0), (58, 32.5)], "found: accept", (65.0, 30.2))
    connector(58, 34.2, "A")
    way([(58, 21.0), (58, 17.2), (26.5, 17.2), (24.5, 13.6)], "no such s", (51.5, 18.5))
    way([(84, 14.8), (84, 20.3)], "found: accept", (77.5, 17.2))
    connector(84, 22.0, "A")
    way([(93, 14.8), (93, 25.2)], "else", (95.7, 20))
    way([(75.7, 33), (71.7, 36.5)], "again from the same state", (70, 41.0))
    connector(70.4, 37.8, "B")
    connector(43.4, 44, "B")
    way([(41.7, 44), (40.3, 44)])
    way([(93, 34.8), (93, 60.2)], "diagonal at its limit\nand four searches\nwithout decrease", (83.5, 47.5))
    ax.text(76, 55.5, "also: max_iterations,\nsingular system", fontsize=8, ha="left", va="center")
    way([(75.7, 68), (60, 68), (60, 75), (40.3, 75)], "step again", (67.5, 69.3))
    save(fig, "newton", png)


# Gradients of shape functions, and what a crossing of cells does.


def gradients(png):
    fig, (left, right) = plt.subplots(1, 2, figsize=(10.2, 3.5))
    x = np.linspace(-2.5, 2.5, 2001)

    def plain(x):
        return np.where((x > -1) & (x < 0), 1.0, 0.0) - np.where((x > 0) & (x < 1), 1.0, 0.0)

    def hat(x):
        return np.clip(1 - np.abs(x), 0, None)

    def gimp(x, half=0.25):
        """Mean of the gradient over the width of a point (GIMP)."""
        return (hat(x + half) - hat(x - half)) / (2 * half)

    def spline(x):
        """Gradient of the quadratic B-spline around 0."""
        a = np.abs(x)
        return -np.sign(x) * np.where(a < 0.5, 2 * a, np.where(a < 1.5, 1.5 - a, 0.0))

    def ddmp(x):
        at_node = {-2: 0.0, -1: 0.5, 0: 0.0, 1: -0.5, 2: 0.0}
        out = np.zeros_like(x)
        for k, v in enumerate(x):
            cell = int(np.floor(v))
            t = v - cell
            own = {-1: 1.0, 0: -1.0}.get(cell, 0.0)
            bubble = 4 * t * (1 - t)
            total = own
            for node, share in ((cell, 1 - t), (cell + 1, t)):
                total += (1 - bubble) * share * (at_node.get(node, 0.0) - own)
            out[k] = total
        return out

    for values, color, style, name in [
        (plain(x), DARK, "-", "MPM (linear)"),
        (gimp(x), BLUE, "--", "GIMP, CPDI in 1D (point width h/2)"),
        (spline(x), GREEN, "-.", "quadratic B-spline"),
        (ddmp(x), RED, "-", "DDMP with the blend of this program"),
    ]:
        left.plot(x, values, color=color, ls=style, label=name)
    for n in range(-2, 3):
        left.plot(n, 0, "s", ms=5, color=DARK, clip_on=False, zorder=5)
    left.axhline(0, color=GRID, lw=0.7)
    left.set_xlabel("x/h")
    left.set_ylabel("gradient of N₀, times h")
    left.set_ylim(-1.15, 1.95)
    left.legend(frameon=False, fontsize=8, loc="upper right", ncol=1)
    left.set_title("One node's gradient in 1D", loc="left")

    spacing = 1 / 2.3
    shift = np.linspace(0, 1.0, 1201)
    base = np.arange(-14, 15) * spacing
    for f, color, name in [(plain, DARK, "MPM"), (ddmp, RED, "DDMP")]:
        force = np.array([np.sum(f(base + 0.11 + s)) * spacing for s in shift])
        right.plot(shift, force, color=color, lw=1.2, label=name)
    right.axhline(0, color=GRID, lw=0.7)
    right.set_xlabel("displacement of the points over h (spacing of the points: h/2.3)")
    right.set_ylabel("nodal force of a uniform stress, over σ")
    right.legend(frameon=False, fontsize=8, loc="upper right", ncol=2)
    right.set_ylim(-0.62, 0.78)
    right.set_title("Error as points cross cells (exact: 0)", loc="left")
    fig.subplots_adjust(wspace=0.22)
    save(fig, "gradients", png)


# The unknowns.


def unknowns(png):
    fig = plt.figure(figsize=(10.2, 4.6))
    ax = fig.add_axes([0.0, 0.0, 0.60, 1.0])
    bare(ax)

    def cell(at, corners, nodes, name, constant, scale=1.0):
        c = np.array(corners) * scale + at
        ax.add_patch(Polygon(c, closed=True, fc="#f7f3e8", ec=DARK, lw=1.1))
        for n in nodes:
            ax.plot(*(np.array(n) * scale + at), "o", ms=6, color=BLUE)
        for corner in c:
            ax.plot(*corner, "s", ms=12, mfc="none", mec=RED, mew=1.5)
            ax.plot(*corner, "D", ms=17, mfc="none", mec=GREEN, mew=1.2)
        if constant:
            ax.plot(*(c.mean(axis=0) + np.array([0.0, -0.2])), "s", ms=8, color=RED)
        ax.text(c[:, 0].mean(), at[1] - 0.55, name, ha="center", va="top", fontsize=8.2)

    t = [(0, 0), (2, 0), (1, 1.8)]
    mid = lambda a, b: ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    t6 = t + [mid(t[0], t[1]), mid(t[1], t[2]), mid(t[2], t[0])]
    q = [(0, 0), (2, 0), (2, 1.8), (0, 1.8)]
    q8 = q + [mid(q[i], q[(i + 1) % 4]) for i in range(4)]
    cell(np.array([0.4, 3.6]), t6[:3], t6, "T6: u in P2, π in P1 + P0", True)
    cell(np.array([3.5, 3.6]), q, q8, "Q8: u in S2, π in Q1 + P0", True)
    cell(np.array([6.6, 3.6]), q, q8 + [(1, 0.9)], "Q9: u in Q2, π in Q1 + P0", True)
    cell(np.array([0.4, 0.6]), t, t, "T3: u in P1, π in P1, stabilised", False)
    cell(np.array([3.5, 0.6]), q, q, "Q4: u in Q1, π in Q1, stabilised", False)
    ax.add_patch(Rectangle((6.6, 0.6), 2.0, 1.8, fc=STEEL, alpha=0.6, ec=DARK))
    ax.plot(7.6, 1.5, "o", ms=7, color=BLUE)
    ax.plot(7.6, 1.5, "o", ms=13, mfc="none", mec=BLUE, mew=1.5)
    ax.text(7.6, 0.05, "rigid body: U and the arc ℓθ", ha="center", va="top", fontsize=8.2)
    handles = [
        plt.Line2D([], [], ls="", marker="o", ms=6, color=BLUE, label="displacement u"),
        plt.Line2D([], [], ls="", marker="s", ms=9, mfc="none", mec=RED, mew=1.5, label="pressure field π, corners"),
        plt.Line2D([], [], ls="", marker="s", ms=7, color=RED, label="π, constant of the cell"),
        plt.Line2D([], [], ls="", marker="D", ms=9, mfc="none", mec=GREEN, mew=1.2, label="pore pressure p, corners"),
    ]
    ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, -0.02), ncol=2, frameon=False, fontsize=8.5)
    ax.set_xlim(-0.1, 9.1)
    ax.set_ylim(-1.3, 5.9)

    system = fig.add_axes([0.64, 0.1, 0.34, 0.8])
    bare(system)
    sizes, names = [4.2, 0.9, 1.5], ["u", "U, ℓθ", "π, p"]
    begin = np.concatenate([[0], np.cumsum(sizes)])
    text = {
        (0, 0): "internal, inertia, contact,\nghost penalty, empty cells",
        (0, 2): "volume\ncoupling",
        (2, 0): "volume coupling,\ntransposed",
        (2, 2): "−C",
        (0, 1): "contact",
        (1, 0): "contact",
        (1, 1): "",
    }
    for i in range(3):
        for j in range(3):
            color = "#dfe9f5" if i == j else "#f2f2f2"
            if (i, j) in ((1, 2), (2, 1)):
                color = "white"
            system.add_patch(
                Rectangle((begin[j], -begin[i + 1]), sizes[j], sizes[i], fc=color, ec=DARK, lw=0.9)
            )
            label = text.get((i, j), "0")
            system.text(
                begin[j] + sizes[j] / 2, -begin[i] - sizes[i] / 2, label, ha="center", va="center", fontsize=8,
                rotation=90 if (i, j) == (0, 1) else 0,
            )
    for i, name in enumerate(names):
        system.text(-0.15, -begin[i] - sizes[i] / 2, name, ha="right", va="center")
        system.text(begin[i] + sizes[i] / 2, 0.15, name, ha="center", va="bottom")
    system.text(begin[-1] / 2, -begin[-1] - 0.3, "multipliers of contact are no unknowns (Uzawa)", ha="center", va="top", fontsize=8.5)
    system.set_xlim(-1.0, begin[-1] + 0.1)
    system.set_ylim(-begin[-1] - 0.9, 0.7)
    system.set_title("Structure of the tangent (10), (25), (36)", fontsize=9.5, pad=8)
    save(fig, "unknowns", png)


# Domains of points.


def domains(png):
    """Values and gradients over domains in 1D and in the plane, and the domains themselves."""
    fig, axes = plt.subplots(1, 4, figsize=(13.6, 3.4), gridspec_kw={"width_ratios": [1.1, 1.1, 1, 1.25]})
    value, slope, plane, sketch = axes
    x = np.linspace(-1.8, 1.8, 1441)

    def hat(x):
        return np.clip(1 - np.abs(x), 0, None)

    def integral(x):
        x = np.clip(x, -1, 1)
        return x + np.where(x < 0, x * x, -x * x) / 2

    for width, color, style in [(0.0, DARK, "-"), (0.25, BLUE, "--"), (0.5, BLUE, "-"), (1.0, RED, "-.")]:
        a, b = x - width / 2, x + width / 2
        if width == 0:
            mean, gradient, name = hat(x), np.where(np.abs(x) < 1, -np.sign(x), 0), "MPM"
        else:
            mean, gradient = (integral(b) - integral(a)) / width, (hat(b) - hat(a)) / width
            name = f"l = {width:g} h"
        value.plot(x, mean, color=color, ls=style, label=name)
        slope.plot(x, gradient, color=color, ls=style, label=name)
    for ax, title in [(value, "GIMP: S of a node in 1D"), (slope, "its gradient, times h")]:
        for n in range(-1, 2):
            ax.plot(n, 0, "s", ms=5, color=DARK, clip_on=False, zorder=5)
        ax.axhline(0, color=GRID, lw=0.7)
        ax.set_xlabel("x/h")
        ax.set_title(title, loc="left")
    value.legend(frameon=False, fontsize=8, loc="upper left")

    # CPDI: the gradient of a node of square cells by the corners of a sheared domain.
    r1, r2 = np.array([0.25, 0.0]), np.array([0.15, 0.25])
    volume = 4 * (r1[0] * r2[1] - r1[1] * r2[0])
    xs, ys = np.meshgrid(np.linspace(-1.6, 1.6, 161), np.linspace(-1.6, 1.6, 161))
    corner = {
        c: hat(xs + c[0] * r1[0] + c[1] * r2[0]) * hat(ys + c[0] * r1[1] + c[1] * r2[1])
        for c in [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    }
    gradient = (
        (corner[-1, -1] - corner[1, 1]) * (r1[1] - r2[1]) + (corner[1, -1] - corner[-1, 1]) * (r1[1] + r2[1])
    ) / volume
    plane.contourf(xs, ys, gradient, levels=np.linspace(-1.05, 1.05, 16), cmap="RdBu_r")
    for k in (-1, 0, 1):
        plane.axhline(k, color=GRID, lw=0.7)
        plane.axvline(k, color=GRID, lw=0.7)
    at = np.array([-1.2, 1.2])
    plane.add_patch(Polygon([at - r1 - r2, at + r1 - r2, at + r1 + r2, at - r1 + r2], fc="none", ec=DARK, lw=1.2))
    plane.set_aspect("equal")
    plane.set_xlabel("x/h")
    plane.set_title("CPDI: ∂S/∂x, domain as drawn", loc="left")

    bare(sketch)
    for k in range(4):
        sketch.plot([0, 6], [k, k], color=GRID, lw=0.8)
    for k in range(7):
        sketch.plot([k, k], [0, 3], color=GRID, lw=0.8)
    shapes = [
        ("GIMP", np.array([[0.55, 1.1], [1.25, 1.1], [1.25, 1.75], [0.55, 1.75]]), BLUE),
        ("CPDI", np.array([[2.2, 1.05], [2.95, 1.2], [3.35, 1.85], [2.6, 1.7]]), RED),
        ("CPDI2", np.array([[4.35, 1.0], [5.1, 1.25], [5.45, 1.95], [4.25, 1.7]]), GREEN),
    ]
    for name, corners, color in shapes:
        sketch.add_patch(Polygon(corners, fc=color, alpha=0.25, ec="none"))
        sketch.add_patch(Polygon(corners, fc="none", ec=color, lw=1.3))
        centre = corners.mean(axis=0)
        sketch.plot(*centre, "o", ms=5, color=DARK)
        if name != "GIMP":
            sketch.plot(*corners.T, "s", ms=5, color=color)
            middles = (corners + np.roll(corners, -1, axis=0)) / 2
            sketch.plot(*middles.T, "s", ms=4.5, mfc="white", mec=color)
        sketch.text(centre[0], 3.15, name, ha="center", color=color)
    sketch.text(3.0, -0.15, "filled: places on cells of first order;\nopen, and the point: also, on those of second order", ha="center", va="top", fontsize=8)
    sketch.set_ylim(-0.9, 3.5)
    sketch.set_xlim(-0.1, 6.1)
    save(fig, "domains", png)


# Splines with open ends, and the strains of composite points.


def splines(png):
    fig, (left, right) = plt.subplots(1, 2, figsize=(10.2, 3.5))
    spans = 5
    x = np.linspace(0, spans, 2001)

    def function(degree, number, x):
        knots = np.concatenate([np.zeros(degree), np.arange(spans + 1.0), np.full(degree, spans)])

        def recurrence(k, p):
            if p == 0:
                last = (knots[k + 1] == spans) & (x == spans)
                return np.where((knots[k] <= x) & ((x < knots[k + 1]) | last), 1.0, 0.0) * (knots[k] < knots[k + 1])
            value = np.zeros_like(x)
            for start, by in ((k, x - knots[k]), (k + 1, knots[k + p + 1] - x)):
                length = knots[start + p] - knots[start]
                if length > 0:
                    value += by / length * recurrence(start, p - 1)
            return value

        return recurrence(number, degree)

    for degree, color, style in ((2, GREEN, "-."), (3, BROWN, "-")):
        for number in range(spans + degree):
            name = f"degree {degree}" if number == 0 else None
            left.plot(x, function(degree, number, x), color=color, ls=style, lw=1.2, label=name)
    for n in range(spans + 1):
        left.plot(n, 0, "s", ms=5, color=DARK, clip_on=False, zorder=5)
    left.set_xlabel("x/h, from one end of the grid to the other")
    left.set_ylabel("N")
    left.set_ylim(0, 1.12)
    left.legend(frameon=False, fontsize=8, loc="upper center", ncol=2)
    left.set_title("B-splines with open ends", loc="left")

    x = np.linspace(-2.5, 2.5, 2001)
    a = np.abs(x)
    hat = lambda x: np.clip(1 - np.abs(x), 0, None)  # noqa: E731
    quadratic = -np.sign(x) * np.where(a < 0.5, 2 * a, np.where(a < 1.5, 1.5 - a, 0.0))
    cubic = np.sign(x) * np.where(a < 1, 1.5 * a**2 - 2 * a, np.where(a < 2, -0.5 * (2 - a) ** 2, 0.0))
    strain = np.full_like(x, 0.0)
    for k, v in enumerate(x):
        nodes = np.floor(v) + np.arange(-1, 3)
        if 0 in nodes:
            others = nodes[nodes != 0]
            strain[k] = sum(np.prod([v - other for other in others if other != left_out]) for left_out in others) / np.prod(-others)
    # A line that does not join what jumps.
    strain[np.concatenate([[False], np.diff(np.floor(x)) != 0])] = np.nan
    for values, color, style, name in [
        (quadratic, GREEN, "-.", "quadratic B-spline"),
        (cubic, BROWN, "-", "cubic B-spline"),
        ((hat(x + 0.25) - hat(x - 0.25)) / 0.5, BLUE, "--", "composite: forces (GIMP, point width h/2)"),
        (strain, RED, "-", "composite: strains"),
    ]:
        right.plot(x, values, color=color, ls=style, lw=1.3, label=name)
    for n in range(-2, 3):
        right.plot(n, 0, "s", ms=5, color=DARK, clip_on=False, zorder=5)
    right.axhline(0, color=GRID, lw=0.7)
    right.set_xlabel("x/h")
    right.set_ylabel("gradient of N₀, times h")
    right.set_ylim(-1.35, 2.4)
    right.legend(frameon=False, fontsize=8, loc="upper right")
    right.set_title("One function's gradient", loc="left")
    fig.subplots_adjust(wspace=0.22)
    save(fig, "splines", png)


def main():
    png = sys.argv[1] if len(sys.argv) > 1 else None
    for figure in (step_phases, regions, reconstruction, contact, newton, gradients, unknowns, domains, splines):
        figure(png)


if __name__ == "__main__":
    main()
