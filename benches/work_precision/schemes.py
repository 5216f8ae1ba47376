"""The schemes that are compared: a line each."""

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path

from program import GEO, PROGRAM, execute


@dataclass(frozen=True)
class Scheme:
    """Entries of `numerics`; an empty list stands for the defaults."""

    name: str
    numerics: tuple  # of pairs (key, value)
    about: str
    points: int = 16  # a cell, where the series does not say
    grid: tuple = ()  # of pairs (entry of the case, value): the cells that the scheme is for
    first: bool = False  # whether it runs in the first series of a problem only

    @property
    def settings(self):
        return {f"numerics.{key}": value for key, value in self.numerics} | dict(self.grid)


def scheme(name, about, points=16, grid=(), first=False, **numerics):
    return Scheme(name, tuple(numerics.items()), about, points, tuple(grid), first or bool(grid))


QUALITY = {"min_quality": 0.5}
# Regular quadrilaterals, of the problems whose geometry has them.
Q4 = [("mesh.order", 1), ("mesh.parameters.quads", 1)]
Q9 = [("mesh.order", 2), ("mesh.parameters.quads", 1)]
Q16 = [("mesh.order", 3), ("mesh.parameters.quads", 1)]
SCHEMES = [
    scheme("default", "the default `numerics`"),
    scheme("plain", "volumes as weights, plain gradients", quadrature="points", gradient="mpm", restore="every_step"),
    scheme("resampled", "resampled quadrature", quadrature="resampled", gradient="mpm", restore="every_step"),
    scheme("ddmp", "volumes as weights, smooth gradients", quadrature="points", gradient="ddmp", restore="every_step"),
    scheme("plain, quality", "plain, restored by quality", quadrature="points", gradient="mpm", restore=QUALITY),
    scheme("resampled, quality", "resampled, restored by quality", quadrature="resampled", gradient="mpm", restore=QUALITY),
    scheme("resampled, no pressure field", "resampled, displacements alone", quadrature="resampled", gradient="mpm",
           restore="every_step", pressure="none"),
    scheme("resampled, pressure field", "resampled, with a field of pressure", quadrature="resampled", gradient="mpm",
           restore="every_step", pressure="field"),
    scheme("mpm, Q4", "plain on four-node quadrilaterals", grid=Q4, quadrature="points", gradient="mpm", restore="every_step"),
    scheme("ugimp", "GIMP, domains that keep their size, Q4", grid=Q4, gradient="ugimp", restore="every_step"),
    scheme("cpgimp", "GIMP, domains that stretch, Q4", grid=Q4, gradient="cpgimp", restore="every_step"),
    scheme("cpdi", "CPDI, Q4", grid=Q4, gradient="cpdi", restore="every_step"),
    scheme("cpdi, T6", "CPDI on six-node triangles", first=True, gradient="cpdi", restore="every_step"),
    scheme("cpdi2", "CPDI2, Q4", grid=Q4, gradient="cpdi2", restore="every_step"),
    scheme("composite", "composite points: GIMP with strains over a patch, Q4", grid=Q4, gradient="composite", restore="every_step"),
    scheme("bspline, points", "quadratic B-splines, volumes as weights", grid=Q9, quadrature="points", gradient="bspline", restore="every_step"),
    scheme("bspline", "quadratic B-splines, resampled quadrature", grid=Q9, gradient="bspline", restore="every_step"),
    scheme("cubic bspline, points", "cubic B-splines, volumes as weights", grid=Q16, quadrature="points", gradient="bspline", restore="every_step"),
    scheme("cubic bspline", "cubic B-splines, resampled quadrature", grid=Q16, gradient="bspline", restore="every_step"),
    scheme("resampled, Q9", "resampled quadrature on nine-node quadrilaterals", grid=Q9, quadrature="resampled", gradient="mpm",
           restore="every_step"),
    scheme("never", "the grid is never restored: finite elements", points=3, restore="never"),
]  # fmt: skip

CASE = {
    "geometry": "plane_strain",
    "mesh": {"geo": str(GEO / "column.geo"), "parameters": {"height": 2, "h": 1}},
    "regions": {"soil": {"kind": "mpm", "material": "soil"}},
    "materials": {"soil": {"model": "linear_elastic", "young": 1, "poisson": 0.3, "density": 1}},
    "phases": [{"name": "rest", "analysis": "quasi_static", "duration": 1, "step": {"initial": 1}}],
}


def missing(scheme):
    """Why the program does not have the scheme; None where it has."""
    with tempfile.TemporaryDirectory() as name:
        case = Path(name) / "case.yaml"
        mesh = CASE["mesh"] | {"order": dict(scheme.grid).get("mesh.order", 2)}
        mesh["parameters"] = mesh["parameters"] | ({"quads": 1} if scheme.grid else {})
        case.write_text(json.dumps({**CASE, "mesh": mesh, "numerics": dict(scheme.numerics)}))
        done = execute([PROGRAM, "check", name])
        return done.reason if done.status else None
