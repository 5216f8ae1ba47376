"""Reads what mpm wrote with the readers that others wrote, and compares every bit.

    check_vtu.py vtk|meshio EXPECTED FILE.vtu ...
    check_vtu.py pvd FILE.pvd TIME ...
    check_vtu.py times FILE.pvd TIME ...   (frames may be empty)
    check_vtu.py vtp FILE.vtp LOOPS

EXPECTED is a folder with the arrays of the first file as raw little-endian numbers, `manifest.json` saying
which: a list of {"where": "point"|"cell"|"field"|"points"|"connectivity"|"offsets"|"types",
"name", "components", "type", "file"}.
"""

import json
import sys
from pathlib import Path

import numpy as np


def expected(folder):
    for entry in json.loads((folder / "manifest.json").read_text()):
        values = np.fromfile(folder / entry["file"], dtype=entry["type"])
        if entry["components"] > 1:
            values = values.reshape(-1, entry["components"])
        yield entry, values


def same(what, got, want):
    got = np.asarray(got)
    assert got.shape == want.shape, f"{what}: shape {got.shape}, expected {want.shape}"
    assert got.dtype == want.dtype, f"{what}: type {got.dtype}, expected {want.dtype}"
    assert got.tobytes() == want.tobytes(), f"{what}: the bits differ"


def read_with_vtk(path):
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: errors.append("warning"))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors, f"{path}: vtk complains"
    return reader.GetOutput()


def check_vtk(folder, path):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    grid = read_with_vtk(path)
    data = {"point": grid.GetPointData(), "cell": grid.GetCellData(), "field": grid.GetFieldData()}
    counts = dict.fromkeys(data, 0)
    for entry, want in expected(folder):
        where, name = entry["where"], entry["name"]
        what = f"{path.name}: {where} {name}"
        if where in data:
            counts[where] += 1
            array = data[where].GetArray(name)
            assert array is not None, f"{what}: missing"
            same(what, vtk_to_numpy(array), want)
            for i, component in enumerate(entry.get("component_names", [])):
                got = array.GetComponentName(i)
                assert got == component, f"{what}: component {i} is {got}, expected {component}"
        elif where == "points":
            same(what, vtk_to_numpy(grid.GetPoints().GetData()), want)
        elif where == "connectivity":
            same(what, vtk_to_numpy(grid.GetCells().GetConnectivityArray()), want)
        elif where == "offsets":
            same(what, vtk_to_numpy(grid.GetCells().GetOffsetsArray())[1:], want)
        elif where == "types":
            got = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
            same(what, np.array(got, dtype=np.uint8), want)
    for where, count in counts.items():
        got = data[where].GetNumberOfArrays()
        assert got == count, f"{path.name}: {got} {where} arrays, expected {count}"


def check_areas(path):
    """The cells are the unit squares and triangles of the test, so their node order is right if their
    quadratic geometry has the area that the test wrote beside each cell."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    grid = read_with_vtk(path)
    area = vtk_to_numpy(grid.GetCellData().GetArray("area [m2]"))
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        if cell.GetCellDimension() != 2:
            continue
        got = integrate(cell)
        assert abs(got - area[c]) < 1e-6 * area[c], f"cell {c} ({cell.GetClassName()}): area {got}, expected {area[c]}"


def integrate(cell):
    """The area of a cell by VTK's own mapping: Gauss points, Jacobian by central differences."""
    from vtkmodules.vtkCommonCore import mutable

    triangle = cell.GetClassName().endswith("Triangle")
    x, w = np.polynomial.legendre.leggauss(4)
    x, w = 0.5 * (x + 1), 0.5 * w
    weights, place_of, sub = [0.0] * cell.GetNumberOfPoints(), [0.0] * 3, mutable(0)

    def place(r, s):
        cell.EvaluateLocation(sub, (r, s, 0.0), place_of, weights)
        return np.array(place_of)

    total, d = 0.0, 1e-3
    for r, wr in zip(x, w):
        for s, ws in zip(x, w):
            # Duffy's map takes the square to the triangle.
            point, jacobian = ((r, s * (1 - r)), 1 - r) if triangle else ((r, s), 1.0)
            a = (place(point[0] + d, point[1]) - place(point[0] - d, point[1])) / (2 * d)
            b = (place(point[0], point[1] + d) - place(point[0], point[1] - d)) / (2 * d)
            total += wr * ws * jacobian * (a[0] * b[1] - a[1] * b[0])
    return total


def check_meshio(folder, path):
    import meshio
    from meshio._vtk_common import meshio_to_vtk_type

    mesh = meshio.read(path)
    kinds = np.concatenate([np.full(len(c.data), meshio_to_vtk_type[c.type], dtype=np.uint8) for c in mesh.cells])
    nodes = np.concatenate([c.data.ravel() for c in mesh.cells]).astype(np.int64)
    for entry, want in expected(folder):
        where, name = entry["where"], entry["name"]
        what = f"{path.name}: {where} {name}"
        if where == "point":
            same(what, mesh.point_data[name], want)
        elif where == "cell":
            same(what, np.concatenate(mesh.cell_data[name]), want)
        elif where == "points":
            same(what, mesh.points, want)
        elif where == "connectivity":
            same(what, nodes, want)
        elif where == "types":
            same(what, kinds, want)


def check_vtp(path, loops):
    """Closed polylines with the pressure 1 + x at their corners, opened by pyvista and by vtk's own reader."""
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: errors.append("warning"))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors, f"{path}: vtk complains"
    for data in (pyvista.wrap(reader.GetOutput()), pyvista.read(path)):
        got = [list(map(int, data.get_cell(i).point_ids)) for i in range(data.n_cells)]
        assert got == loops, f"{path}: loops {got}, expected {loops}"
        assert (data.point_data["pressure [-]"] == 1 + data.points[:, 0]).all()
        assert data.point_data["normal [-]"].shape == (data.n_points, 3)
        assert "line [-]" not in data.point_data


def check_pvd(path, times, filled):
    import pyvista

    reader = pyvista.get_reader(str(path))
    got = list(reader.time_values)
    assert got == times, f"{path}: times {got}, expected {times}"
    for i, time in enumerate(times):
        reader.set_active_time_point(i)
        block = reader.read()[0]
        shown = block.field_data["TimeValue"][0]
        assert shown == time, f"{path}: frame {i} shows time {shown}, expected {time}"
        assert block.n_points > 0 or not filled


def main():
    what, *rest = sys.argv[1:]
    if what in ("pvd", "times"):
        check_pvd(Path(rest[0]), [float(t) for t in rest[1:]], filled=what == "pvd")
        return
    if what == "vtp":
        check_vtp(Path(rest[0]), json.loads(rest[1]))
        return
    folder = Path(rest[0])
    for path in map(Path, rest[1:]):
        {"vtk": check_vtk, "meshio": check_meshio}[what](folder, path)
        if what == "vtk" and any(e["name"] == "area [m2]" for e, _ in expected(folder)):
            check_areas(path)
        print(f"{what} read {path.name} to the bit")


if __name__ == "__main__":
    main()
