"""What the gallery shows: runs of cases, the number that each gives, and the value it is compared with.

The values are those of limit analysis and of the literature that the README of each case states. Where two are given they are a lower and an upper bound.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyvista
from cavity import Can
from pipe import bearing
from surface import kept

BONDED = {"contacts[0].tension": "no_separation"}


@dataclass
class Row:
    """A run, and a number from it."""

    name: str  # of the output folder: out-NAME; empty: out, the case as it is
    what: str
    found: Callable[[Path], float]  # of the output folder
    reference: float | tuple[float, float]
    tolerance: float  # relative
    settings: dict = field(default_factory=dict)  # {path: value}


@dataclass
class Entry:
    """A case with its rows; the first run is the one in the picture."""

    case: str
    quantity: str
    source: str
    rows: list[Row]
    picture: tuple[str, ...] = ()  # options of `mpm plot` beside the field
    headline: int = 0  # the row that stands beside the picture


def history(out: Path) -> dict[str, np.ndarray]:
    """The columns of history.csv by their names without units."""
    names, *rows = [line.split(",") for line in (out / "history.csv").read_text().splitlines()]
    return dict(zip((name.split(" [")[0] for name in names), np.array(rows, dtype=float).T))


def mean(load: str, way: str, at: float, within: float, over: float = 1.0, less: float = 0.0) -> Callable[[Path], float]:
    """The mean of a load, without its sign, over the steps within a distance of a way; `less` is taken off before it is divided by `over`."""

    def found(out: Path) -> float:
        columns = history(out)
        near = np.abs(np.abs(columns[way]) - at) <= within * (1 + 1e-9)
        return (np.abs(columns[load][near]).mean() - less) / over

    return found


def safety(per: float) -> Callable[[Path], float]:
    """The middle of the bracket of the factor of safety, times `per`."""

    def found(out: Path) -> float:
        low, high = re.search(r"^factor of safety (\S+) to (\S+) ", (out / "solve.log").read_text(), re.MULTILINE).groups()
        return per * (float(low) + float(high)) / 2

    return found


def beyond_green(v: float, h: float) -> float:
    """What a load (V, H) over B s_u on a rough strip is divided by to lie on the envelope of Green (1954)."""
    low, high = h, 2 * max(v, h)
    for _ in range(60):
        middle = (low + high) / 2
        share = h / middle
        held = 1 + np.pi - np.arcsin(share) + np.sqrt(1 - share**2)
        low, high = (middle, high) if v / middle > held else (low, middle)
    return low


SHORT = {"phases.failure.duration": 0.02}  # the search alone
CUT = (3.763, 3.815)  # limit analysis

VERTICAL_CUT = Entry(
    "vertical_cut",
    "γH/s_u at failure, volume of the run-out over that before",
    "limit analysis, 1",
    [
        Row("", "volume at rest, cut of γH/s_u = 6", kept(), 1.0, 0.01),
        Row("toe", "γH/s_u, cells of H/200 at the toe", safety(3.0), CUT, 0.03, SHORT | {"mesh.parameters.toe": 0.1}),
    ],
    picture=("--window=-10,-2.5,10,6",),
    headline=1,
)

TRENCH = Entry(
    "trench",
    "γ′H/s_u at failure, volume of the run-out over that before",
    "limit analysis, Taylor (1937), 1",
    [
        Row("", "volume at rest, on the pipe", kept(), 1.0, 0.01),
        Row("toe", "γ′H/s_u, walls of 90°", safety(2.6004), CUT, 0.03, SHORT | {"mesh.parameters.toe": 0.1}),
        Row(
            "60",
            "γ′H/s_u, walls of 60°",
            safety(13.002 / 3.5),
            1 / 0.191,
            0.03,
            SHORT | {"mesh.parameters.toe": 0.1, "mesh.parameters.angle": 60, "materials.clay.shear_strength": 3.5},
        ),
    ],
    picture=("--mirror", "--window=-5,-2.75,5,0.5",),
    headline=1,
)


JET_TRENCH = Entry(
    "jet_trench",
    "load over s_u D of the pipe as it sinks, less 1.5 times the weight of the clay in its place",
    "Merifield, White & Randolph (2009), between smooth and rough",
    [Row("", f"N at w/D = {w:g}", bearing(w, 0.4, 4, 6), (5.66 * w**0.32, 7.4 * w**0.4), 0.05) for w in (0.5, 0.3)],
    picture=("--mirror", "--window=-1.5,-1.5,1.5,0.4", "--range=0,3",),
)


def slide(v: float) -> Row:
    """The mat under V = v B s_u, pushed sideways by B/650."""
    sideways = mean("mat.contact_x", "mat.ux", 0.009, 0.004, 30)
    settings = {"phases.weigh.tractions[0].ty.rate": -5 * v, "phases.push.tractions[0].ty": -5 * v} if v != 3.955 else {}
    name = f"v{v:g}" if settings else ""
    return Row(name, f"(V, H) over the envelope, V = {v:g} B s_u", lambda out: beyond_green(v, sideways(out)), 1.0, 0.05, settings)


TURN = {"name": "turn", "analysis": "quasi_static", "duration": 0.02, "step": {"initial": 0.0001, "max": 0.002}}


def skirted(name: str, what: str, depth: float, bounds: tuple[float, float], settings: dict) -> Row:
    """The mat `depth` B deep in the clay, moved by B/100."""
    parameters = {"mesh.parameters.skirt": 6 * depth, "mesh.parameters.depth": 10.5 + 6 * depth} if depth != 0.25 else {}
    found = mean("mat.contact_y", "mat.uy", 0.06, 0.02, 30)
    return Row(name, f"V/(B s_u), D/B = {depth:g}, {what}", found, bounds, 0.05, parameters | settings)


MUDMAT = Entry(
    "mudmat",
    "load over that of the envelope in its direction; moment",
    "Green (1954); limit analysis",
    [
        slide(3.955),
        slide(1.5),
        slide(3.4577),
        slide(4.484),
        Row(
            "moment",
            "M/(B² s_u) without lift-off",
            mean("mat.contact_moment", "mat.rotation", 0.009, 0.004, 180),
            0.690,
            0.05,
            BONDED
            | {
                "phases": [TURN | {"prescribe": {"mat": {"rotation": {"rate": 1}}}}],
                "output.every": 0.01,
                "output.history": [{"name": "mat", "on": "mat", "quantities": ["rotation", "contact_x", "contact_y", "contact_moment"]}],
            },
        ),
    ],
    picture=("--window=-9,-5,9,1.5", "--range=0,0.4",),
)

SOLID = {"mesh.parameters.wall": 0}
SKIRTED_MAT = Entry(
    "skirted_mat",
    "load over B s_u",
    "limit analysis",
    [
        skirted("", "skirts", 0.25, (6.18, 6.39), {}),
        skirted("up", "skirts, pulled up", 0.25, (6.18, 6.39), {"phases.push.prescribe.mat.uy.rate": 1}),
        skirted("0.5", "skirts", 0.5, (7.13, 7.34), {}),
        skirted("solid-0.25", "solid", 0.25, (6.18, 6.39), SOLID),
        skirted("solid-0.5", "solid", 0.5, (7.13, 7.34), SOLID),
        skirted("solid-1", "solid", 1, (8.81, 8.99), SOLID),
    ],
    picture=("--window=-9,-6,9,1.5", "--range=0,0.2",),
)


def spudcan(name: str, strength: float) -> list[Row]:
    """Depth of the cavity over D by the formula of Hossain & Randolph, of a uniform strength, and the deep bearing capacity factor."""
    can = Can(12, strength, 7)
    s = can.strength / (can.weight * can.diameter)
    settings = {"materials.clay.shear_strength": strength, "materials.clay.young": 500 * strength} if name else {}
    rows = [Row(name, f"H_c/D, S = s_u/(γ′D) = {s:.3g}", can.cavity(), s**0.55 - s / 4, 0.15, settings)]
    return rows + [Row(name, f"N_c at 1.4 D, S = {s:.3g}", can.factor(1.4), (10, 12), 0.05, settings)]


SPUDCAN = Entry("spudcan", "depth of the cavity over D, deep N_c", "Hossain & Randolph (2009)", spudcan("", 20) + spudcan("soft", 10) + spudcan("firm", 40), picture=("--mirror", "--window=-15,-24,15,4",))


def anchor(cover: int, bounds: tuple[float, float], bonded: bool) -> Row:
    """A thin plate as it passes the depth `cover` B, where it is plastic."""
    settings = {
        "mesh.parameters": {"cover": cover + 0.05, "thickness": 0.05, "way": 0.1, "width": 2.0 * cover + 3, "h": 0.02, "under": 2, "coarse": 20},
        "phases[0].duration": 0.07,
        "phases[0].step": {"initial": 0.001, "max": 0.005},
        "materials.clay.young": 2000,
    }
    return Row(
        f"{cover}{'-bonded' if bonded else ''}",
        f"N, H/B = {cover}, {'bonded' if bonded else 'breaking away'}",
        mean("plate.contact_y", "plate.uy", 0.05, 0.015, 0.5),
        bounds,
        0.05,
        settings | (BONDED if bonded else {}),
    )


PLATE_ANCHOR = Entry(
    "plate_anchor",
    "N = load/(B s_u)",
    "limit analysis; 3π + 2",
    [
        anchor(1, (1.89, 2.08), False),
        anchor(2, (3.63, 3.79), False),
        anchor(3, (4.68, 4.85), False),
        anchor(4, (5.41, 5.59), False),
        anchor(6, (6.42, 6.60), False),
        anchor(1, (8.82, 9.10), True),
        anchor(2, (11.26, 11.59), True),
        anchor(4, (3 * np.pi + 2, 3 * np.pi + 2), True),
    ],
    picture=("--mirror", "--window=-3,-2.5,3,0.5", "--range=0,0.2",),
)


def layers(upper: float, ratio: float, bound: float) -> Row:
    """The footing on the surface: s_u = 2 kPa above, 2/ratio below, a stiffness at which the limit is reached within B/100; an upper bound."""
    strengths = {"stiff": 2.0, "soft": 2.0 / ratio}
    settings = {f"materials.{name}.{key}": value for name, s in strengths.items() for key, value in (("shear_strength", s), ("young", 5000 * s))}
    settings |= {"mesh.parameters": {"upper": upper, "way": 0.3, "beneath": 5, "width": 8, "h": 0.05, "coarse": 12}}
    settings |= {"phases.push.duration": 0.015, "phases.push.step": {"initial": 0.0002, "max": 0.001}, "output.every": 0.005}
    found = mean("footing.contact_y", "footing.uy", 0.012, 0.002, 1.0)
    return Row(f"{upper:g}-{ratio:g}", f"q/c₁, H/B = {upper:g}, c₁/c₂ = {ratio:g}", found, bound, 0.03, settings)


PUNCH_THROUGH = Entry(
    "punch_through",
    "q/c₁ on the surface",
    "upper bounds of limit analysis (benches/verification/limit_analysis.py)",
    [
        layers(0.5, 2, 3.740),
        layers(0.25, 2, 3.211),
        layers(1, 2, 4.693),
        layers(0.25, 5, 1.714),
        layers(0.5, 5, 2.297),
        layers(1, 5, 3.401),
        layers(0.25, 1.25, 4.472),
        layers(0.5, 1.25, 4.742),
        layers(0.5, 0.5, 5.403),
    ],
    picture=("--mirror", "--window=-2.5,-2.5,2.5,0.5", "--range=0,0.05",),
)


def footing(kind: str, ratio: float, exact: float) -> Row:
    """The footing at B/600 below the surface of clay of s_u = 10 kPa + k z, k D = ratio · 10 kPa, with 20 000 s_u for E; less γ′ z."""
    shape, k = ("circle", "kD") if kind == "axisymmetric" else ("strip", "kB")
    held = {"phases.push.prescribe.footing": {"ux": 0, "uy": {"rate": -1}, "rotation": 0}}
    settings = {"geometry": kind} | held if shape == "strip" else {}
    for key, top in (("young", 200000), ("shear_strength", 10)):
        settings[f"materials.clay.{key}"] = {"top": top, "gradient": round(top * ratio / 3, 3)} if ratio else top
    settings |= {"mesh.parameters": {"way": 0.5, "beneath": 4.5, "width": 8, "air": 0.5, "fine": 0.75, "h": 0.075, "coarse": 12}}
    settings |= {"phases.push.duration": 0.007, "phases.push.step": {"initial": 0.0001, "max": 0.0005}, "output.every": 0.0035}
    area = np.pi * 1.5**2 if shape == "circle" else 1.5
    found = mean("footing.contact_y", "footing.uy", 0.005, 0.0015, 10 * area, 6 * 0.005 * area)
    return Row(f"{shape}-{ratio:g}", f"q/s_u0, rough {shape}, {k}/s_u0 = {ratio:g}", found, exact, 0.03, settings)


EMBEDDED_FOOTING = Entry(
    "embedded_footing",
    "q/s_u0 on the surface",
    "the method of characteristics",
    [
        *(footing("axisymmetric", ratio, exact) for ratio, exact in ((0, 6.0482), (1, 6.9460), (5, 9.2316))),
        *(footing("plane_strain", ratio, exact) for ratio, exact in ((0, 2 + np.pi), (1, 6.6092), (5, 9.7959))),
    ],
    picture=("--mirror", "--window=-4,-3,4,0.5", "--range=0,0.01",),
)


def bar(name: str, factor: float, exact: float) -> Row:
    """The T-bar from three diameters on; half of it is modelled, and the weight of the clay in its place is taken off."""
    settings = {"contacts[0].adhesion_factor": factor} if name else {}
    return Row(name, f"N, α = {factor:g}", mean("bar.contact_y", "bar.uy", 4, 1, 1.0, 0.5 * 6 * np.pi / 4), exact, 0.05, settings)


TBAR = Entry(
    "tbar",
    "N = load/(s_u D) deep in the clay",
    "Randolph & Houlsby (1984)",
    [bar("", 0.5, 10.8198), bar("smooth", 0, 9.1416), bar("rough", 1, 11.94)],
    picture=("--mirror", "--window=-3,-6.5,3,0.8", "--range=0,3",),
)


# Suction within the tube, by the time of the push, which goes down by 1 m/s [s, kPa].
SUCTION = [[0, 0], [0.05, 0], [0.1, -1.7], [0.25, -6.4], [0.5, -12.6], [0.75, -18.4], [0.95, -22.9], [1, -24]]
TIP = np.pi * (1 - 0.96**2)  # area [m²]


def anchor_leg(at: float, expected: float, suction: bool = False) -> Row:
    """The tube on its way down: sides and tip by limit analysis, with the weight of the clay in place of the wall. Suction lifts what the wall displaces into the tube."""
    load = mean("wall.contact_y", "time", at, 0.02)
    if not suction:
        return Row("", f"load [kN] at {at:g} m", load, expected, 0.05)
    drawn = np.interp(at, *np.transpose(SUCTION))
    pressure = {"surface": "clay", "pressure": {"table": SUCTION}, "where": {"x": [0, 0.96], "y": [-0.5, 0.4]}}
    settings = {"phases.push.tractions": [pressure]}
    return Row("suction", f"load [kN] at {at:g} m, suction of {-drawn:g} kPa", load, (round(expected + drawn * TIP, 1), expected), 0.05, settings)


SUCTION_ANCHOR = Entry(
    "suction_anchor",
    "load of the push",
    "limit analysis",
    [anchor_leg(0.25, 38.9), anchor_leg(0.5, 56.5), anchor_leg(0.75, 72.9), anchor_leg(0.95, 86.1), anchor_leg(0.5, 56.5, True), anchor_leg(0.75, 72.9, True), anchor_leg(0.95, 86.1, True)],
    picture=("--mirror", "--window=-2,-2,2,0.6", "--range=0,1",),
)

def deepest(out: Path) -> float:
    """How far the tip of the cone went (m)."""
    return -history(out)["cone.uy"].min()


def momentum(out: Path) -> float:
    """The impulse of the clay and of gravity over the change of the momentum of the cone."""
    columns = history(out)
    mass = 3.5 * np.pi * 0.05**2 * (0.36 - 2 / 3 * 0.05 * 3**0.5)
    return np.sum((columns["cone.contact_y"] - 9.81 * mass) * np.diff(columns["time"], prepend=0)) / (mass * (columns["cone.vy"][-1] + 3))


FREE_FALL_CONE = Entry(
    "free_fall_cone",
    "depth of the tip, momentum",
    "its energy and the resistance to a slow cone, with and without drag",
    [Row("", "depth [m]", deepest, (0.2128, 0.2176), 0.05), Row("", "impulse over change of momentum", momentum, 1.0, 0.01)],
    picture=("--mirror", "--window=-0.25,-0.4,0.25,0.15", "--range=0,1"),
)


def hit(out: Path) -> float:
    """The mean force on the pipe from 0.1 s on."""
    columns = history(out)
    steady = columns["time"] > 0.1
    return np.average(columns["pipe.contact_x"][steady], weights=np.diff(columns["time"], prepend=0)[steady])


SLIDE_ON_PIPE = Entry(
    "slide_on_pipe",
    "force on the pipe once the flow is steady",
    "a liquid with a cavity behind the pipe and the bearing resistance of a strip; Randolph & White (2012) for a closed flow",
    [Row("", "force [kN/m]", hit, (48.6, 77.9), 0.1)],
    picture=("--window=-4,-0.2,4,5", "--range=0,2"),
)


def surface_at(x: float, height: float) -> Row:
    """The height of the deposit of the column at x."""

    def found(out: Path) -> float:
        reader = pyvista.get_reader(str(out / "points.pvd"))
        reader.set_active_time_point(len(reader.time_values) - 1)
        place = reader.read()[0].points
        return place[np.abs(place[:, 0] - x) < 0.005, 1].max()

    return Row("", f"height [m] at {x:.1f} m", found, height, 0.15)


BUI_COLUMN = Entry(
    "bui_column",
    "height of the deposit",
    "the experiment of Bui et al. (2008)",
    [surface_at(x, height) for x, height in ((0.1001, 0.0776), (0.2, 0.0474), (0.3022, 0.0215))],
    picture=("--window=-0.02,-0.02,0.62,0.12", "--range=0,2"),
)


def passive(cohesion: float, bounds: tuple[float, float]) -> Row:
    settings = {"materials.sand.cohesion": cohesion} if cohesion else {}
    return Row("c" if cohesion else "", f"force [kN/m], c = {cohesion:g} kPa", mean("wall.contact_x", "wall.ux", 0.055, 0.005), bounds, 0.03, settings)


PASSIVE_WALL = Entry(
    "passive_wall",
    "force on the wall",
    "Davis (1968) and Rankine, without dilation",
    [passive(0, (377.0, 432.0)), passive(5, (433.0, 501.3))],
    picture=("--window=-1.5,-0.2,6.2,4.8",),
)


def surcharge_factor(angle: float) -> float:
    """N_q (-) of an angle of friction (degrees)."""
    tangent = np.tan(np.radians(angle))
    return np.exp(np.pi * tangent) * np.tan(np.radians(45 + angle / 2)) ** 2


def of_surcharge(out: Path) -> float:
    """N_q of a footing 1 m wide on each side, on soil without weight that bears 10 kPa beneath it, too."""
    return history(out)["footing.contact_y"][-1] / 10 + 1


FOOTING_ON_SAND = Entry(
    "footing_on_sand",
    "N_q, φ = 30°",
    "slip lines (Prandtl 1921, Reissner 1924); without dilation between Davis (1968) and these",
    [
        Row("", "N_q, ψ = φ", of_surcharge, surcharge_factor(30), 0.03),
        Row("no-dilation", "N_q, ψ = 0", of_surcharge, (surcharge_factor(26.565), surcharge_factor(30)), 0.0, {"materials.sand.dilation": 0}),
    ],
    picture=("--window=0,-3,7,0.6", "--range=0,0.004"),
)

def tip(out: Path) -> float:
    """The force at the tip of the cone over its area, on average from nine radii on (kPa)."""
    columns = history(out)
    return columns["tip.contact_y"][columns["time"] > 10].mean() / (np.pi * 0.018**2)


# Spheres (Yu & Houlsby 1991) and N_c (Teh & Houlsby 1991) by `cases/cpt_sand/reference.py`.
SPHERE, FACTOR = 732.7, 11.97
IN_CLAY = {
    "materials.sand": {"model": "tresca", "young": 12500, "poisson": 0.49, "shear_strength": 25, "density": 0},
    "contacts[0]": {"structure": "tip", "soil": "sand", "adhesion_factor": 0.5},
    "phases.surcharge.prescribe": {"tip": {"uy": {"rate": -0.0002}}, "sleeve": {"uy": {"rate": -0.0002}}},
    "phases.push.duration": 10,
}
CPT_SAND = Entry(
    "cpt_sand",
    "q_c over the limit pressure of a sphere; in clay N_c",
    "the steps from a sphere to a cone of Ladanyi & Johnston (1974) and Vesic (1977); Teh & Houlsby (1991)",
    [
        Row("", "q_c/p_lim in sand", lambda out: tip(out) / SPHERE, (1.52, 4.45), 0.0),
        Row("fine", "q_c/p_lim in sand, cells of R/3", lambda out: tip(out) / SPHERE, (1.52, 4.45), 0.0, {"mesh.parameters.h": 0.006, "phases.push.duration": 10}),
        Row("clay", "N_c in clay", lambda out: (tip(out) - 100) / 25, FACTOR, 0.2, IN_CLAY),
        Row("clay-fine", "N_c in clay, cells of R/3", lambda out: (tip(out) - 100) / 25, FACTOR, 0.1, IN_CLAY | {"mesh.parameters.h": 0.006}),
    ],
    picture=("--mirror", "--window=-0.2,-0.6,0.2,0.05", "--range=0,2"),
)

def emptied(top: float, bottom: float) -> Row:
    """Beverloo's constant of the slot while the mean height of the sand is between two."""

    def found(out: Path) -> float:
        reader = pyvista.get_reader(str(out / "points.pvd"))
        time, mass = [], []
        for t in (t for t in reader.time_values if t >= 1):
            reader.set_active_time_value(t)
            points = reader.read()[0]
            time.append(t)
            mass.append(points["mass [t]"][points.points[:, 1] > 0].sum())
        height = np.array(mass) / (1.6 * 0.5)
        within = (height <= top) & (height >= bottom)
        return -np.polyfit(np.array(time)[within], np.array(mass)[within], 1)[0] / (0.5 * 1.6 * 9.81**0.5 * 0.3**1.5)

    return Row("", f"rate over ρ √g w^1.5, heights of {top:g} to {bottom:g} m", found, (0.87, 1.04), 0.1)


def full_silo(out: Path) -> float:
    """The force on the floor and the gate before it is opened, over that of Janssen for ν/(1 − ν)."""
    columns = history(out)
    full = np.argmin(np.abs(columns["time"] - 1))
    rise = 0.364 * 0.3 / 0.7 / 0.5
    janssen = 0.5 * 1.6 * 9.81 / rise * (1 - np.exp(-rise * 1.5))
    return -(columns["floor.contact_y"][full] + columns["gate.contact_y"][full]) / janssen


SILO = Entry(
    "silo",
    "rate of discharge and force on the floor",
    "an arch in free fall and Beverloo for a slot; Janssen",
    [emptied(1.4, 0.9), emptied(0.9, 0.4), Row("", "force on the floor over Janssen's", full_silo, 1.0, 0.03)],
    picture=("--mirror", "--window=-1.5,-1.45,1.5,1.6", "--range=0,2", "--time=1.9"),
)

def over_wedge(way: float, wedge: float) -> Row:
    """The force on the blade about a way, over that of the wedge under the surface there (`cases/shovel/study.py`)."""
    found = mean("blade.contact_x", "blade.ux", way, 0.03, over=wedge)
    return Row("", f"force over that of a wedge, after {way} m", found, 1.0, 0.15)


SHOVEL = Entry(
    "shovel",
    "force on the blade",
    "a wedge of soil, heap included",
    [over_wedge(0.1, 13.6), over_wedge(0.9, 19.9)],
    picture=("--window=-0.6,-1,3,0.8",),
)



def rubbing(at: float) -> Callable[[Path], float]:
    """The force on the blade about a way, on average over time, over μ W."""

    def found(out: Path) -> float:
        columns = history(out)
        near = np.abs(columns["blade.ux"] - at) <= 0.05
        steps = np.diff(columns["time"], prepend=0)
        weight = 1.6 * 9.81 * 0.6**2 / 2 / np.tan(np.radians(25))
        return -np.average(columns["blade.contact_x"][near], weights=steps[near]) / (0.3 * weight)

    return found


BULLDOZING = Entry(
    "bulldozing",
    "force on the blade",
    "what rubs on the floor, μ W",
    [Row("", f"force over μ W, after {way} m", rubbing(way), 1.0, 0.02) for way in (0.35, 0.75)],
    picture=("--range=0,0.6",),
)

ENTRIES = [VERTICAL_CUT, TRENCH, JET_TRENCH, MUDMAT, SKIRTED_MAT, SPUDCAN, PLATE_ANCHOR, PUNCH_THROUGH, EMBEDDED_FOOTING, TBAR, SUCTION_ANCHOR, FREE_FALL_CONE, SLIDE_ON_PIPE, BUI_COLUMN, SILO, PASSIVE_WALL, FOOTING_ON_SAND, CPT_SAND, SHOVEL, BULLDOZING]
