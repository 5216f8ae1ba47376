#!/usr/bin/env python
"""Elastic bodies in Kratos MPM: the column, the cantilever and the block of benches/work_precision.

    kratos_elastic.py column|cantilever|slump POINTS.npz --points 4 --steps 40 ...

Bilinear quadrilaterals on a regular grid, Hencky elasticity (its Mohr–Coulomb law with a cohesion that is never reached).
The column inverts elements with that law; it has the neo-Hookean one, which its stress, ρ g Z, does not depend on.
Prints one line of JSON: seconds in the solution of the steps, Newton iterations. The points at the end go to
POINTS.npz, in m and kPa. Runs in a virtual environment of its own, see benches/work_precision/peers.py.
"""

import argparse
import json
import os
import sys
import tempfile
import time

import KratosMultiphysics as KM
import numpy as np

KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.LinearSolversApplication  # noqa: E402, F401: registers the solver named below
import KratosMultiphysics.MPMApplication as MPM  # noqa: E402
from KratosMultiphysics.MPMApplication.mpm_analysis import MpmAnalysis  # noqa: E402


class Scene:
    """A rectangle of cells in a rectangle of grid, in N, m and kg."""

    def __init__(self, name, arguments):
        self.law = "HenckyMCPlasticPlaneStrain2DLaw"
        if name == "column":
            self.law = "HyperElasticNeoHookeanPlaneStrain2DLaw"
            self.h = 50 / arguments.cells
            self.grid = (arguments.wide, arguments.cells)
            self.body, self.corner = self.grid, (0, 0)
            self.young, self.poisson, self.density = 1e4, 0.0, 80.0
            width = arguments.wide * self.h
            self.fixed = lambda x, y: (x < 1e-9 or x > width - 1e-9, y < 1e-9)
            self.acceleration = lambda x, y: -10.0
        elif name == "slump":
            self.h = 1 / arguments.cells
            self.grid, self.body, self.corner = (3 * arguments.cells // 2, arguments.cells), (arguments.cells,) * 2, (0, 0)
            self.young, self.poisson, self.density = 2e4, 0.3, 1000.0
            self.fixed = lambda x, y: (x < 1e-9, y < 1e-9)
            self.acceleration = lambda x, y: -10.0
        else:
            self.h = arguments.h
            n = round(1 / self.h)
            self.grid, self.body, self.corner = (11 * n, 10 * n), (10 * n, n), (0, 9 * n)
            # The points of the beam weigh something here, but are not loaded.
            self.young, self.poisson, self.density = 12e6, 0.2, 100.0
            self.fixed = lambda x, y: (x < 1e-9, x < 1e-9)
            load = -1e5 / (0.5 * self.density)
            self.acceleration = lambda x, y: load if x > 9.5 else 0.0


def settings(materials, steps):
    solver = {
        "solver_type": "Quasi-static",
        "analysis_type": "non_linear",
        "time_integration_method": "implicit",
        "model_part_name": "MPM_Material",
        "domain_size": 2,
        "echo_level": 0,
        "model_import_settings": {"input_type": "use_input_model_part"},
        "grid_model_import_settings": {"input_type": "use_input_model_part"},
        "material_import_settings": {"materials_filename": materials},
        "time_stepping": {"time_step": 1.0 / steps},
        "convergence_criterion": "residual_criterion",
        "residual_relative_tolerance": 1e-8,
        "residual_absolute_tolerance": 1e-9,
        "max_iteration": 30,
        "pressure_dofs": False,
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
    }
    return {
        "problem_data": {
            "problem_name": "elastic",
            "parallel_type": "OpenMP",
            "echo_level": 0,
            "start_time": 0.0,
            "end_time": 1.0 - 0.5 / steps,
        },
        "solver_settings": solver,
        "processes": {"constraints_process_list": [], "loads_process_list": [], "list_other_processes": [], "gravity": []},
        "output_processes": {},
    }


class Body(MpmAnalysis):
    """Builds the model in memory; the time of the solution alone is counted."""

    def __init__(self, model, parameters, scene):
        self.scene, self.wall, self.cpu, self.iterations, self.steps, self.unconverged = scene, 0.0, 0.0, 0, 0, 0
        super().__init__(model, parameters)

    def build(self):
        grid = self.model["Background_Grid"]
        body = self.model["Initial_MPM_Material"].CreateSubModelPart("Body")
        node = cell = 1
        scene = self.scene
        for part, (columns, rows), (left, low), element in (
            (grid, scene.grid, (0, 0), "Element2D4N"),
            (body, scene.body, scene.corner, "MPMUpdatedLagrangian2D4N"),
        ):
            properties, row = part.CreateNewProperties(1), columns + 1
            for j in range(rows + 1):
                for i in range(row):
                    part.CreateNewNode(node + j * row + i, (left + i) * scene.h, (low + j) * scene.h, 0.0)
            for j in range(rows):
                for i in range(columns):
                    a = node + j * row + i
                    part.CreateNewElement(element, cell, [a, a + 1, a + row + 1, a + row], properties)
                    cell += 1
            node += row * (rows + 1)

    def _CreateSolver(self):
        solver = super()._CreateSolver()
        importing = solver.ImportModelPart
        solver.ImportModelPart = lambda: (self.build(), importing())
        return solver

    def values(self, variable):
        info = self.points.ProcessInfo
        return np.array([list(e.CalculateOnIntegrationPoints(variable, info)[0]) for e in self.points.Elements])

    def Initialize(self):
        super().Initialize()
        self.points = self.model["MPM_Material"]
        for node in self.model["Background_Grid"].Nodes:
            for fixed, variable in zip(self.scene.fixed(node.X, node.Y), (KM.DISPLACEMENT_X, KM.DISPLACEMENT_Y)):
                if fixed:
                    node.Fix(variable)
        info = self.points.ProcessInfo
        self.origin = self.values(MPM.MP_COORD)
        self.volume = np.array([e.CalculateOnIntegrationPoints(MPM.MP_VOLUME, info)[0] for e in self.points.Elements])
        self.pull = [self.scene.acceleration(x, y) for x, y, _ in self.origin]

    def InitializeSolutionStep(self):
        for point, pull in zip(self.points.Elements, self.pull):
            load = [[0.0, pull * self.time, 0.0]]
            point.SetValuesOnIntegrationPoints(MPM.MP_VOLUME_ACCELERATION, load, self.points.ProcessInfo)
        super().InitializeSolutionStep()

    def RunSolutionLoop(self):
        solver = self._GetSolver()
        while self.KeepAdvancingSolutionLoop():
            self.time = solver.AdvanceInTime(self.time)
            # Setting the load from Python is slow and no fault of the peer: it is not timed.
            self.InitializeSolutionStep()
            wall, cpu = time.perf_counter(), time.process_time()
            solver.Predict()
            self.unconverged += not solver.SolveSolutionStep()
            self.iterations += self.model["Background_Grid"].ProcessInfo[KM.NL_ITERATION_NUMBER]
            self.FinalizeSolutionStep()
            self.wall += time.perf_counter() - wall
            self.cpu += time.process_time() - cpu
            self.steps += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", choices=["column", "cantilever", "slump"])
    parser.add_argument("out")
    parser.add_argument("--points", type=int, default=4, help="a cell")
    parser.add_argument("--steps", type=int, default=40)
    parser.add_argument("--cells", type=int, default=16, help="over the height")
    parser.add_argument("--wide", type=int, default=1, help="cells over the width of the column")
    parser.add_argument("--h", type=float, default=0.25, help="size of the cells of the cantilever [m]")
    arguments = parser.parse_args()
    scene = Scene(arguments.scene, arguments)
    material = {
        "constitutive_law": {"name": scene.law},
        "Variables": {
            "THICKNESS": 1.0,
            "MATERIAL_POINTS_PER_ELEMENT": arguments.points,
            "DENSITY": scene.density,
            "YOUNG_MODULUS": scene.young,
            "POISSON_RATIO": scene.poisson,
            "COHESION": 1e12,
            "INTERNAL_FRICTION_ANGLE": 0.5,
            "INTERNAL_DILATANCY_ANGLE": 0.0,
        },
        "Tables": {},
    }
    with tempfile.TemporaryDirectory() as folder:
        materials = os.path.join(folder, "materials.json")
        with open(materials, "w") as file:
            entry = {"model_part_name": "Initial_MPM_Material.Body", "properties_id": 1, "Material": material}
            json.dump({"properties": [entry]}, file)
        body = Body(KM.Model(), KM.Parameters(json.dumps(settings(materials, arguments.steps))), scene)
        body.Run()
    if body.points.NumberOfElements() != len(body.volume):
        sys.exit(f"{len(body.volume) - body.points.NumberOfElements()} points have left the grid")
    np.savez(
        arguments.out,
        origin=body.origin,
        displacement=body.values(MPM.MP_COORD) - body.origin,
        stress=1e-3 * body.values(MPM.MP_CAUCHY_STRESS_VECTOR),
        volume=body.volume,
    )
    note = f"{body.unconverged} of {body.steps} steps not converged" if body.unconverged else ""
    sys.stdout.flush()
    print(json.dumps({"wall": body.wall, "cpu": body.cpu, "iterations": body.iterations, "steps": body.steps, "note": note}))


if __name__ == "__main__":
    main()
