#!/usr/bin/env python
"""The anchored wall of templates/excavation in Kratos GeoMechanics: small strains, 6-node triangles, 8-node quadrilaterals in the wall.

    kratos_wall.py MESH.npz SETTINGS.json RESULTS.json

benches/peers/wall.py writes mesh and settings, runs this and compares. The wall is a strip of finite elements with the E
that gives EA and EI, ν = 0; line interfaces join it to the sand on both sides and below the tip. A lift that is dug is
deactivated, and the forces that it exerted on the rest go to zero in equal steps, as they do in mpm. Units: kN, m, t.
Runs in a virtual environment of its own, see wall.py.
"""

import json
import os
import sys
import tempfile
import time

import KratosMultiphysics as KM
import numpy as np

KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
import KratosMultiphysics.LinearSolversApplication  # noqa: E402, F401: registers the solver named below
import KratosMultiphysics.StructuralMechanicsApplication as SM  # noqa: E402
import KratosMultiphysics.GeoMechanicsApplication  # noqa: E402, F401
from KratosMultiphysics.GeoMechanicsApplication.geomechanics_analysis import GeoMechanicsAnalysis  # noqa: E402

SOIL = ["sand", "lift1", "lift2", "lift3"]
FACES = ["face1", "face2", "face3", "faces"]  # interfaces beside the lifts, and the others


def materials(s):
    """Properties of each part, in the form of Kratos."""
    dry = {
        "DENSITY_SOLID": s["unit_weight"] / 9.81, "DENSITY_WATER": 1.0, "POROSITY": 0.0, "BULK_MODULUS_SOLID": 1e12,
        "BULK_MODULUS_FLUID": 2e6, "PERMEABILITY_XX": 1e-9, "PERMEABILITY_YY": 1e-9, "PERMEABILITY_XY": 0.0,
        "DYNAMIC_VISCOSITY": 1e-6, "BIOT_COEFFICIENT": 1.0, "RETENTION_LAW": "SaturatedLaw",
        "SATURATED_SATURATION": 1.0, "GEO_DRAINAGE_TYPE": "CONSTANT_PW_FIELD",
    }  # fmt: skip
    sand = dict(dry, YOUNG_MODULUS=s["young"], POISSON_RATIO=s["poisson"])
    face = {"INTERFACE_NORMAL_STIFFNESS": s["normal_stiffness"], "INTERFACE_SHEAR_STIFFNESS": s["shear_stiffness"], **dry}
    # Elastic sand has the same law with a strength that is not reached: the linear elastic one knows no initial stress.
    elastic = s["model"] == "elastic"
    cohesion = 1e9 if elastic else s["cohesion"]
    apex = cohesion / np.tan(np.radians(s["friction"]))
    sand |= {"GEO_COHESION": cohesion, "GEO_FRICTION_ANGLE": s["friction"], "GEO_DILATANCY_ANGLE": s["dilation"],
             "GEO_ENABLE_TENSION_CUT_OFF": True, "GEO_TENSILE_STRENGTH": 0.999 * apex}  # fmt: skip
    if not elastic:
        angle = np.degrees(np.arctan(s["wall_friction"]))
        face |= {"GEO_COHESION": 0.0, "GEO_FRICTION_ANGLE": angle, "GEO_DILATANCY_ANGLE": 0.0,
                 "GEO_ENABLE_TENSION_CUT_OFF": True, "GEO_TENSILE_STRENGTH": 0.0}  # fmt: skip
    face_law = "GeoIncrementalLinearElasticInterfaceLaw" if elastic else "GeoInterfaceCoulombWithTensionCutOff"
    wall = dict(dry, YOUNG_MODULUS=s["wall_young"], POISSON_RATIO=0.0, DENSITY_SOLID=s["wall_weight"] / s["t"] / 9.81)
    entries = [(SOIL, "GeoMohrCoulombWithTensionCutOff2D", sand), (FACES, face_law, face), (["wall"], "GeoLinearElasticPlaneStrain2DLaw", wall)]
    return {
        "properties": [
            {
                "model_part_name": f"PorousDomain.{part}",
                "properties_id": number,
                "Material": {"constitutive_law": {"name": law}, "Variables": variables, "Tables": {}},
            }
            for number, (part, law, variables) in enumerate(((p, law, v) for parts, law, v in entries for p in parts), 1)
        ]
    }


def settings(s, file):
    parts = [*SOIL, "wall", *FACES, "anchor", "loads"]
    solver = {
        "solver_type": "U_Pw", "model_part_name": "PorousDomain", "domain_size": 2, "echo_level": 0,
        "model_import_settings": {"input_type": "use_input_model_part"},
        "material_import_settings": {"materials_filename": file},
        "time_stepping": {"time_step": 1.0}, "solution_type": "static", "scheme_type": "static",
        "convergence_criterion": "residual_criterion", "residual_relative_tolerance": 1e-4,
        "residual_absolute_tolerance": 1e-6, "max_iterations": 150, "min_iterations": 0, "number_cycles": 6,
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
        "problem_domain_sub_model_part_list": [p for p in parts if p != "loads"],
        "processes_sub_model_part_list": ["loads"],
        "body_domain_sub_model_part_list": [*SOIL, "wall"],
        # The stiffness is that of elasticity, in sand and interfaces that yield, too: Newton would need thousands of iterations.
        "strategy_type": "quasi_newton", "quasi_newton_type": "broyden", "quasi_newton_max_rank": 30,
        "block_builder": False, "reform_dofs_at_each_step": True,
    }  # fmt: skip
    return {
        "problem_data": {"problem_name": "wall", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": 1.0 + len(s["stages"])},
        "solver_settings": solver,
        "processes": {"constraints_process_list": [], "loads_process_list": [], "auxiliary_process_list": []},
        "output_processes": {},
    }  # fmt: skip


def integration_points(element):
    """Places of the integration points of an element; of a rectangle their weights over its width, too."""
    nodes = np.array([[n.X0, n.Y0] for n in element.GetGeometry()])
    if len(nodes) == 6:
        return np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6 @ nodes[:3], None
    at, weights = np.polynomial.legendre.leggauss(2)
    x, y = at[[0, 1, 1, 0]], at[[0, 0, 1, 1]]
    shapes = np.array([(1 - x) * (1 - y), (1 + x) * (1 - y), (1 + x) * (1 + y), (1 - x) * (1 + y)]).T / 4
    return shapes @ nodes[:4], weights[[0, 1, 1, 0]] / 2 * np.ptp(nodes[:, 0])


class Wall(GeoMechanicsAnalysis):
    def __init__(self, model, parameters, mesh, s):
        self.mesh, self.s, self.results, self.iterations = mesh, s, [], []
        super().__init__(model, parameters)

    def build(self):
        """The parts with their elements; an edge of an interface has its nodes on the sand first, then those on the wall."""
        main, mesh = self._GetSolver().main_model_part, self.mesh
        for number, (x, y) in enumerate(mesh["nodes"], 1):
            main.CreateNewNode(number, x, y, 0.0)
        elements = {6: "UPwSmallStrainElement2D6N", 8: "UPwSmallStrainElement2D8N"}
        number = condition = 0
        for index, part in enumerate([*SOIL, "wall", *FACES, "anchor"], 1):
            sub, properties = main.CreateSubModelPart(part), main.CreateNewProperties(index)
            cells = mesh[part] + 1
            sub.AddNodes(sorted({int(n) for n in cells.flat}))
            kind = "Geo_ULineInterfacePlaneStrainElement3Plus3N" if part in FACES else elements.get(cells.shape[1], "NodalConcentratedElement2D1N")
            for cell in cells:
                number += 1
                sub.CreateNewElement(kind, number, [int(n) for n in cell], properties)
        loads, properties = main.CreateSubModelPart("loads"), main.CreateNewProperties(99)
        loaded = sorted({int(n) + 1 for part in ("lift1", "lift2", "lift3", "face1", "face2", "face3", "anchor") for n in mesh[part].flat})
        loads.AddNodes(loaded)
        for node in loaded:
            condition += 1
            loads.CreateNewCondition("UPwForceCondition2D1N", condition, [node], properties)

    def _CreateSolver(self):
        solver = super()._CreateSolver()
        solver.ImportModelPart = lambda: self.build()
        return solver

    def Initialize(self):
        super().Initialize()
        self.part = self._GetSolver().main_model_part
        s, info = self.s, self.part.ProcessInfo
        (left, low), right = self.mesh["nodes"].min(0), self.mesh["nodes"][:, 0].max()
        self._GetSolver().GetComputingModelPart().AddConditions([c.Id for c in self.part.GetSubModelPart("loads").Conditions])
        for node in self.part.Nodes:
            node.Fix(KM.WATER_PRESSURE)
            node.Fix(KM.DISPLACEMENT_Z)
            if node.Y < low + 1e-6 or node.X < left + 1e-6 or node.X > right - 1e-6:
                node.Fix(KM.DISPLACEMENT_X)
            if node.Y < low + 1e-6:
                node.Fix(KM.DISPLACEMENT_Y)
            node.SetSolutionStepValue(KM.VOLUME_ACCELERATION, [0.0, -9.81, 0.0])
        # The initial stress of the sand: the weight of what is above, and K0 of it. The first step begins with stress 0 in laws that
        # are made then; new ones take what the element has as the scheme begins the step.
        solver = self._GetSolver()
        solver.InitializeSolutionStep()
        for part in SOIL:
            for element in self.part.GetSubModelPart(part).Elements:
                depths = integration_points(element)[0][:, 1]
                vertical = [s["unit_weight"] * float(y) for y in depths]
                stress = [KM.Vector([s["k0"] * v, v, s["k0"] * v, 0.0]) for v in vertical]
                element.SetValuesOnIntegrationPoints(KM.CAUCHY_STRESS_VECTOR, stress, 4, info)
                element.Initialize(info)
        strategy = solver.solving_strategy
        solver.scheme.InitializeSolutionStep(
            solver.computing_model_part, strategy.GetSystemMatrix(), strategy.GetSolutionVector(), strategy.GetSystemVector()
        )
        self.stiffness = 0.0
        self.set_anchor()
        self.head = self.part.GetNode(int(self.mesh["anchor"][0, 0]) + 1)
        self.released, self.pull, self.stage = {}, 0.0, -1

    def begin_stage(self):
        """Deactivates what is dug, and keeps the forces that it exerted on the nodes of the rest."""
        stage, info = self.s["stages"][self.stage], self.part.ProcessInfo
        self.released = {}
        if "dig" in stage:
            matrix, vector = KM.Matrix(), KM.Vector()
            for part in (f"lift{stage['dig']}", f"face{stage['dig']}"):
                for element in self.part.GetSubModelPart(part).Elements:
                    element.CalculateLocalSystem(matrix, vector, info)
                    for k, node in enumerate(element.GetGeometry()):
                        force = self.released.setdefault(node.Id, np.zeros(2))
                        force += [vector[2 * k], vector[2 * k + 1]]
                    element.Set(KM.ACTIVE, False)
            alive = {node.Id for e in self.part.Elements if e.IsActive() for node in e.GetGeometry()}
            self.released = {node: force for node, force in self.released.items() if node in alive}
            for node in self.part.Nodes:
                if node.Id not in alive:
                    node.Fix(KM.DISPLACEMENT_X)
                    node.Fix(KM.DISPLACEMENT_Y)
        if stage.get("prestress"):
            self.pull = stage["prestress"]
        if stage.get("anchor") and not self.stiffness:
            self.stiffness = self.s["anchor_stiffness"]
            # The rod is free of further strain where its head is now.
            self.pull += self.stiffness * self.head.GetSolutionStepValue(KM.DISPLACEMENT_X)
            self.set_anchor()

    def set_anchor(self):
        for element in self.part.GetSubModelPart("anchor").Elements:
            element.SetValue(SM.NODAL_DISPLACEMENT_STIFFNESS, [self.stiffness, 0.0, 0.0])

    def InitializeSolutionStep(self):
        """The loads of this time; Kratos comes here again where it has halved a step that did not converge."""
        # Halving moves the nodes to where they have gone; the analysis is of small strains, in the initial geometry.
        KM.VariableUtils().UpdateCurrentToInitialConfiguration(self.part.Nodes)
        held = 1.0 - (self.part.ProcessInfo[KM.TIME] - self.stage - 1) if self.stage >= 0 else 0.0
        for node in self.part.GetSubModelPart("loads").Nodes:
            force = held * self.released.get(node.Id, np.zeros(2))
            extra = self.pull if node.Id == self.head.Id else 0.0
            node.SetSolutionStepValue(SM.POINT_LOAD, [force[0] + extra, force[1], 0.0])
        super().InitializeSolutionStep()

    def FinalizeSolutionStep(self):
        super().FinalizeSolutionStep()
        now = self.part.ProcessInfo[KM.TIME]
        self.iterations.append(self.part.ProcessInfo[KM.NL_ITERATION_NUMBER])
        print(f"time {now:.4f}: {self.iterations[-1]} iterations", file=sys.stderr, flush=True)
        if abs(now - round(now)) < 1e-9:
            self.results.append(self.measure())
            if len(self.results) <= len(self.s["stages"]):
                self.stage += 1
                self.delta_time = 1.0 / self.s["stages"][self.stage]["steps"]
                self.begin_stage()

    def measure(self):
        """Displacements of all nodes, moments at the rows of integration points of the wall, force of the anchor."""
        info = self.part.ProcessInfo
        rows = {}
        for element in self.part.GetSubModelPart("wall").Elements:
            stress = element.CalculateOnIntegrationPoints(KM.CAUCHY_STRESS_VECTOR, info)
            places, weights = integration_points(element)
            for value, place, weight in zip(stress, places, weights, strict=True):
                y = round(place[1], 6)
                rows[y] = rows.get(y, 0.0) + weight * value[1] * place[0]
        force = self.pull - self.stiffness * self.head.GetSolutionStepValue(KM.DISPLACEMENT_X)
        return {
            "anchor": force,
            "moments": sorted(rows.items()),
            "displacement": [list(n.GetSolutionStepValue(KM.DISPLACEMENT))[:2] for n in self.part.Nodes],
        }


def main():
    mesh = dict(np.load(sys.argv[1]))
    with open(sys.argv[2]) as file:
        s = json.load(file)
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "materials.json")
        with open(file, "w") as stream:
            json.dump(materials(s), stream)
        wall = Wall(KM.Model(), KM.Parameters(json.dumps(settings(s, file))), mesh, s)
        try:
            wall.Run()
            end = "complete"
        except RuntimeError as error:
            end = str(error)
    with open(sys.argv[3], "w") as stream:
        json.dump({"end": end, "seconds": time.perf_counter() - start, "iterations": wall.iterations, "stages": wall.results}, stream)
    print(end)


if __name__ == "__main__":
    main()
