#!/usr/bin/env python
"""The block of benches/block in Kratos MPM, one load step of 1/40 of gravity after another.

Prints one line of JSON: seconds in the solution of the steps, Newton iterations, peak memory. Runs in a
virtual environment of its own, see benches/block/run.py.

A body 8 m x 8 m of n x n bilinear quadrilaterals with 4 points each moves through a grid 16 m x 8 m of such
cells: n = 160 makes 102 400 points. Material, supports and load steps are those of case.yaml, in kN and t made
N and kg.
"""

import argparse
import json
import os
import resource
import sys
import tempfile
import time

import KratosMultiphysics as KM

KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.LinearSolversApplication  # noqa: E402, F401: registers the solver named below
import KratosMultiphysics.MPMApplication as MPM  # noqa: E402
from KratosMultiphysics.MPMApplication.mpm_analysis import MpmAnalysis  # noqa: E402

SIDE = 8.0
GRAVITY = 10.0
FULL_LOAD = 40  # steps that would make the full gravity
DENSITY = 1000.0
MATERIAL = {
    "constitutive_law": {"name": "HenckyMCPlasticPlaneStrain2DLaw"},
    "Variables": {
        "THICKNESS": 1.0,
        "MATERIAL_POINTS_PER_ELEMENT": 4,
        "DENSITY": DENSITY,
        "YOUNG_MODULUS": 1.0e6,
        "POISSON_RATIO": 0.3,
        "COHESION": 1.0e4,
        "INTERNAL_FRICTION_ANGLE": 0.001,
        "INTERNAL_DILATANCY_ANGLE": 0.0,
    },
    "Tables": {},
}


def settings(materials, steps):
    """The project parameters; Newton stops at a relative residual of 1e-6 (mpm: 1e-8)."""
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
        "time_stepping": {"time_step": 1.0 / FULL_LOAD},
        "convergence_criterion": "residual_criterion",
        "residual_relative_tolerance": 1e-6,
        "residual_absolute_tolerance": 1e-9,
        "max_iteration": 20,
        "pressure_dofs": False,
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
    }
    return {
        "problem_data": {
            "problem_name": "block",
            "parallel_type": "OpenMP",
            "echo_level": 0,
            "start_time": 0.0,
            "end_time": (steps - 0.5) / FULL_LOAD,
        },
        "solver_settings": solver,
        "processes": {"constraints_process_list": [], "loads_process_list": [], "list_other_processes": [], "gravity": []},
        "output_processes": {},
    }


class Block(MpmAnalysis):
    """Builds the model in memory and counts time and iterations of the solution alone."""

    def __init__(self, model, parameters, n):
        self.n = n
        self.seconds = []
        self.iterations = []
        self.unconverged = 0
        super().__init__(model, parameters)

    def build(self):
        n, h = self.n, SIDE / self.n
        grid = self.model["Background_Grid"]
        body = self.model["Initial_MPM_Material"].CreateSubModelPart("Body")
        first_node = first_cell = 1
        for part, columns, element in (
            (grid, 2 * n, "Element2D4N"),
            (body, n, "MPMUpdatedLagrangian2D4N"),
        ):
            properties = part.CreateNewProperties(1)
            row = columns + 1
            for j in range(n + 1):
                for i in range(row):
                    part.CreateNewNode(first_node + j * row + i, i * h, j * h, 0.0)
            for j in range(n):
                for i in range(columns):
                    a = first_node + j * row + i
                    part.CreateNewElement(element, first_cell + j * columns + i, [a, a + 1, a + row + 1, a + row], properties)
            first_node += row * (n + 1)
            first_cell += columns * n

    def _CreateSolver(self):
        solver = super()._CreateSolver()
        importing = solver.ImportModelPart
        solver.ImportModelPart = lambda: (self.build(), importing())
        return solver

    def Initialize(self):
        super().Initialize()
        self.points = self.model["MPM_Material"]
        for node in self.model["Background_Grid"].Nodes:
            if node.X < 1e-9 or node.X > 2 * SIDE - 1e-9:
                node.Fix(KM.DISPLACEMENT_X)
            if node.Y < 1e-9:
                node.Fix(KM.DISPLACEMENT_Y)

    def InitializeSolutionStep(self):
        load = [[0.0, -GRAVITY * self.time, 0.0]]
        for point in self.points.Elements:
            point.SetValuesOnIntegrationPoints(MPM.MP_VOLUME_ACCELERATION, load, self.points.ProcessInfo)
        super().InitializeSolutionStep()

    def RunSolutionLoop(self):
        solver = self._GetSolver()
        while self.KeepAdvancingSolutionLoop():
            self.time = solver.AdvanceInTime(self.time)
            # Setting the load from Python is slow and no fault of the peer: it is not timed.
            self.InitializeSolutionStep()
            start = time.perf_counter()
            solver.Predict()
            converged = solver.SolveSolutionStep()
            self.iterations.append(self.model["Background_Grid"].ProcessInfo[KM.NL_ITERATION_NUMBER])
            self.FinalizeSolutionStep()
            self.seconds.append(time.perf_counter() - start)
            self.unconverged += not converged


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=160, help="cells along the side of the block")
    parser.add_argument("--steps", type=int, default=11, help="load steps")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        materials = os.path.join(folder, "materials.json")
        with open(materials, "w") as file:
            entry = {"model_part_name": "Initial_MPM_Material.Body", "properties_id": 1, "Material": MATERIAL}
            json.dump({"properties": [entry]}, file)
        parameters = KM.Parameters(json.dumps(settings(materials, arguments.steps)))
        block = Block(KM.Model(), parameters, arguments.n)
        block.Run()
    result = {
        "points": block.points.NumberOfElements(),
        "iterations": block.iterations,
        "unconverged": block.unconverged,
        "seconds": block.seconds,
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    sys.stdout.flush()
    print(json.dumps(result))


if __name__ == "__main__":
    main()
