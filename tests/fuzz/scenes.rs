//! Small scenes, made without Gmsh, that together use what a checkpoint can hold, and the states of runs in them.

use mpm::case::names::{Groups, Of};
use mpm::case::{Case, Loaded, parts, scene, seeded, seeding};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::mesh::{Group, Mesh};
use mpm::points::Points;
use mpm::step::{Controller, Scene, Simulation, State};
use std::fs;
use std::sync::OnceLock;

/// Loads on a surface that is followed, dynamic.
const SLUMP: &str = "\
title: Soil that slumps
geometry: plane_strain
mesh: {geo: scene.geo}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  air: {kind: buffer}
materials:
  clay: {model: tresca_softening, young: 1000, poisson: 0.3, shear_strength: 3, remoulded: 0.5, ductility: 5, density: 1.8}
supports: {bottom: {ux: 0, uy: 0}, left: {ux: 0}, right: {ux: 0}}
gravity: {y: -9.81}
water: {level: 0.6, unit_weight: 10}
phases:
  - name: fall
    analysis: dynamic
    duration: 0.2
    step: {initial: 0.02, min: 0.01}
    tractions: [{surface: all, pressure: 1}]
output: {every: 0.1, fields: [stress, displacement, velocity]}
";

/// Finite elements beside the grid, a rigid structure in contact, a pressure field, and a material that changes.
const STRIP: &str = "\
title: A strip on layers
geometry: plane_strain
mesh: {geo: scene.geo}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  base: {kind: fem, material: clay}
  air: {kind: buffer}
  strip: {kind: structure, material: steel, rigid: true}
materials:
  clay: {model: tresca, young: 1000, poisson: 0.3, shear_strength: 5, density: 1, drainage: undrained}
  firm: {model: tresca, young: 2000, poisson: 0.3, shear_strength: 9, density: 1, drainage: undrained}
  steel: {model: linear_elastic, young: 1.0e+5, poisson: 0.2, density: 0}
contacts:
  - {structure: strip, soil: soil, adhesion_factor: 0.5}
supports: {bottom: {ux: 0, uy: 0}, left: {ux: 0}, right: {ux: 0}}
numerics: {restore: {min_quality: 0.4}}
phases:
  - name: press
    analysis: quasi_static
    duration: 0.2
    step: {initial: 0.1, min: 0.05}
    prescribe: {strip: {ux: 0, rotation: 0, uy: {rate: -0.02}}}
  - name: go_on
    analysis: quasi_static
    duration: 0.4
    step: {initial: 0.1, min: 0.05}
    materials: {soil: firm}
    reset_displacements: true
    prescribe: {strip: {ux: 0, rotation: 0, uy: {rate: -0.02}}}
output: {fields: [stress, displacement, pore_pressure]}
";

/// Water that flows, points that weigh their volumes, around an axis.
const DRAIN: &str = "\
title: A column that drains
geometry: axisymmetric
mesh: {geo: scene.geo}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  above: {kind: buffer}
materials:
  clay: {model: linear_elastic, young: 1000, poisson: 0.2, density: 0, drainage: undrained, permeability: 1.0e-4,
         porosity: 0.5, water_bulk_modulus: 1.0e+4}
supports: {bottom: {ux: 0, uy: 0}, left: {ux: 0}, right: {ux: 0}}
drained_surface: all
numerics: {quadrature: points}
phases:
  - name: drain
    analysis: consolidation
    duration: 8
    step: {initial: 1, min: 0.5}
    tractions: [{surface: all, pressure: 1}]
output: {fields: [pore_pressure, displacement]}
";

/// The case of the meshes in the corpus.
const BLOCK: &str = "\
title: A block
geometry: plane_strain
mesh: {geo: scene.geo}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  air: {kind: buffer}
materials:
  clay: {model: linear_elastic, young: 1000, poisson: 0.3, density: 1.8}
supports: {bottom: {ux: 0, uy: 0}, side: {ux: 0}}
gravity: {y: -9.81}
phases:
  - {name: load, analysis: quasi_static, duration: 1, step: {initial: 1, min: 0.5}}
output:
  fields: [stress]
  history: [{name: corner, on: corner, quantities: [uy]}]
";

/// A scene with states of a run in it.
pub struct Ready {
    pub name: &'static str,
    pub case: Case,
    pub mesh: Mesh<2>,
    pub seeds: Points<2>,
    pub scene: Scene<2>,
    pub first: State<2>,
    /// The state after each step.
    pub states: Vec<State<2>>,
}

/// Steps that are taken in each scene.
const STEPS: usize = 4;

pub fn all() -> Vec<Ready> {
    let slump = || grid(CellKind::T6, |x, y| if x < 2.0 && y < 1.0 { 0 } else { 1 }, &["soil", "air"]);
    let layers = || {
        let region = |_, y: f64| if y < 0.5 { 1 } else { u16::from(y > 1.0) * 2 };
        with_strip(grid(CellKind::T6, region, &["soil", "base", "air", "strip"]))
    };
    let column = || grid(CellKind::Q4, |_, y| u16::from(y > 1.0), &["soil", "above"]);
    vec![ready("slump", SLUMP, slump()), ready("strip", STRIP, layers()), ready("drain", DRAIN, column())]
}

/// The texts of the cases.
pub fn texts() -> Vec<Vec<u8>> {
    [SLUMP, STRIP, DRAIN].map(|text| text.as_bytes().to_vec()).to_vec()
}

/// The case of a text.
fn loaded(text: &str) -> Loaded {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.geo"), "").unwrap();
    fs::write(folder.path().join("case.yaml"), text).unwrap();
    mpm::case::load(folder.path(), &[]).unwrap_or_else(|e| panic!("{e:?}"))
}

/// Fills a mesh of the corpus with points and does a step.
///
/// # Errors
/// A mesh that the case does not fit.
pub fn on_mesh(mesh: Mesh<2>) -> mpm::error::Result<()> {
    static LOADED: OnceLock<Loaded> = OnceLock::new();
    let loaded = LOADED.get_or_init(|| loaded(BLOCK));
    let named = |dimension| mesh.groups.iter().filter(move |g| g.dimension == dimension).map(|g| g.name.clone());
    let (curves, points) = (named(1).collect(), named(0).collect());
    let groups = Groups { surfaces: mesh.regions.clone(), curves, points, of: Of::Made };
    loaded.check_names(&groups).map_err(|mut errors| errors.remove(0))?;
    let case = loaded.case.clone();
    let seeds = seeding::points(&case, &mesh)?;
    seeded::check(&case, &mesh, &seeds)?;
    let scene = scene::scene::<PlaneStrain>(&case, mesh.clone())?;
    let first = scene::first(&case, &scene, parts::points(&case, &mesh, seeds.clone()))?;
    let ready = Ready { name: "block", case, mesh, seeds, scene, first, states: Vec::new() };
    // That the analysis cannot go on from there may be.
    let _ = ready.step(ready.first.clone());
    Ok(())
}

fn ready(name: &'static str, text: &str, mesh: Mesh<2>) -> Ready {
    let case = loaded(text).case;
    let seeds = seeding::points(&case, &mesh).unwrap();
    let scene = scene_of(&case, &mesh);
    let first = scene::first(&case, &scene, parts::points(&case, &mesh, seeds.clone())).unwrap();
    let mut ready = Ready { name, case, mesh, seeds, scene, first, states: Vec::new() };
    let mut state = State { frames: 1, ..ready.first.clone() };
    for _ in 0..STEPS {
        state = ready.step(state).unwrap_or_else(|e| panic!("{name}: {e}"));
        ready.states.push(state.clone());
    }
    ready
}

/// The scene of a case on a mesh.
fn scene_of(case: &Case, mesh: &Mesh<2>) -> Scene<2> {
    let made = if is_axisymmetric(case) {
        scene::scene::<Axisymmetric>(case, mesh.clone())
    } else {
        scene::scene::<PlaneStrain>(case, mesh.clone())
    };
    made.unwrap()
}

fn is_axisymmetric(case: &Case) -> bool {
    case.geometry == mpm::case::checked::Geometry::Axisymmetric
}

impl Ready {
    /// The state after one more step, as a run has it.
    pub fn step(&self, state: State<2>) -> mpm::error::Result<State<2>> {
        if is_axisymmetric(&self.case) {
            self.step_in::<Axisymmetric>(state)
        } else {
            self.step_in::<PlaneStrain>(state)
        }
    }

    fn step_in<K: Kinematics<2>>(&self, state: State<2>) -> mpm::error::Result<State<2>> {
        let Some(phase) = self.scene.phases.get(state.phase) else { return Ok(state) };
        let mut controller = Controller::new(phase.step, phase.stops.clone(), state.step_size.min(phase.step.max));
        let mut simulation = Simulation::<2, K>::new(&self.scene, state)?;
        if simulation.state.phase_time == 0.0 {
            simulation.begin_phase()?;
        }
        simulation.advance(&mut controller)?;
        let mut state = simulation.state;
        state.step_size = controller.wanted;
        if controller.next_stop(state.phase_time).is_none() {
            state.next_phase(&self.scene);
        }
        Ok(state)
    }

    /// The state of a run that begins with points from a file.
    pub fn begin(&self, points: Points<2>) -> mpm::error::Result<State<2>> {
        seeded::check(&self.case, &self.mesh, &points)?;
        scene::first(&self.case, &self.scene, parts::points(&self.case, &self.mesh, points))
    }
}

/// Four by two metres in cells of half a metre, its regions by the centre of the cells.
fn grid(kind: CellKind, region: impl Fn(f64, f64) -> u16, names: &[&str]) -> Mesh<2> {
    let mut mesh = rectangle(kind, 4.0, 2.0, 8, 4, 0.0, 0);
    mesh.regions = names.iter().map(|name| name.to_string()).collect();
    for c in 0..mesh.cells.len() {
        let corners = &mesh.cells.nodes(c)[..kind.corner_count()];
        let centre =
            [0, 1].map(|d| corners.iter().map(|&n| mesh.nodes[n as usize][d]).sum::<f64>() / corners.len() as f64);
        mesh.cells.region[c] = region(centre[0], centre[1]);
    }
    mesh
}

/// A mesh with a block on top of its soil, of the last region and with a curve around it.
fn with_strip(mut mesh: Mesh<2>) -> Mesh<2> {
    let kind = mesh.cells.kind[0];
    let block = rectangle(kind, 1.0, 0.5, 2, 1, 0.0, 0);
    let (first, region) = (mesh.nodes.len() as u32, mesh.regions.len() as u16 - 1);
    mesh.nodes.extend(block.nodes.iter().map(|[x, y]| [x + 1.5, y + 1.0]));
    for c in 0..block.cells.len() {
        let nodes: Vec<u32> = block.cells.nodes(c).iter().map(|n| n + first).collect();
        mesh.cells.push(kind, region, &nodes);
    }
    for group in block.groups {
        let facets =
            group.facets.into_iter().map(|(kind, n)| (kind, n.into_iter().map(|n| n + first).collect())).collect();
        mesh.groups.push(Group::of(format!("strip_{}", group.name), 1, facets));
    }
    mesh
}
