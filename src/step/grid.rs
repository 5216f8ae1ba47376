//! The grid of a run: which cells take part, the numbering of the unknowns and the stencil of the points.
//! All of it follows from the scene and the state, and is made anew only as far as they changed.

use super::ghost_faces;
use super::scene::{Fixed, Restore, Scene};
use super::state::State;
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::quadrature::Weighing;
use crate::stencil::Stencil;
use crate::system::{Cliques, Matrix, Pattern, Solver, Workspace};
use crate::term::{Frame, GhostFace};
use rayon::prelude::*;

/// Rings of cells around those with points that take part too, so that points can move on for a while
/// before the pattern changes.
const RINGS: usize = 2;

/// A system of equations over the nodes that take part.
pub struct System {
    pub pattern: Pattern,
    pub matrix: Matrix,
    pub solver: Solver,
}

/// The grid of a run.
pub struct Grid<const D: usize> {
    pub stencil: Stencil<D>,
    /// The faces that take a ghost penalty.
    pub ghost: Vec<GhostFace>,
    /// The clique of each face that the system has room for a penalty at, else `u32::MAX`; empty without faces.
    face_clique: Vec<u32>,
    /// The clique of each cell and the block of each node; `u32::MAX` for those left out.
    pub clique: Vec<u32>,
    pub block: Vec<u32>,
    /// The node of each block.
    pub node: Vec<u32>,
    pub motion: System,
    /// The mass of the points on the nodes, one equation a node: in dynamic analysis only.
    pub mass: Option<System>,
    pub workspace: Workspace,
}

impl System {
    fn new(blocks: usize, size: u8, cliques: Cliques, symmetric: bool) -> Result<Self> {
        let pattern = Pattern::new(&vec![size; blocks], cliques, symmetric);
        let matrix = Matrix::new(&pattern);
        let solver = Solver::new(&pattern)?;
        Ok(Self { pattern, matrix, solver })
    }
}

impl<const D: usize> Grid<D> {
    /// The grid of a state whose points are located and weighed.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new<K: Kinematics<D>>(scene: &Scene<D>, state: &State<D>) -> Result<Self> {
        let mut stencil = Stencil::default();
        fill::<D, K>(&mut stencil, scene, state);
        stencil.weigh(&state.weighing.weight, &state.weighing.shift);
        Self::with(scene, state, stencil)
    }

    /// The grid in its first shape, with the points on it.
    ///
    /// # Errors
    /// When a point lies outside the grid, or memory does not suffice.
    pub fn first<K: Kinematics<D>>(scene: &Scene<D>, state: &mut State<D>) -> Result<Self> {
        let mut stencil = Stencil::default();
        if scene.terms.iter().any(|term| term.sees_flow()) {
            state.points.plastic_increment.resize(state.points.len(), 0.0);
        }
        begin_anew::<D, K>(scene, state, &mut stencil)?;
        Self::with(scene, state, stencil)
    }

    /// Restores the grid.
    ///
    /// # Errors
    /// As [`Grid::first`].
    pub fn restore<K: Kinematics<D>>(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        if begin_anew::<D, K>(scene, state, &mut self.stencil)? {
            *self = Self::with(scene, state, std::mem::take(&mut self.stencil))?;
        } else {
            self.penalise(scene, state);
        }
        Ok(())
    }

    /// The grid for a stencil.
    fn with(scene: &Scene<D>, state: &State<D>, stencil: Stencil<D>) -> Result<Self> {
        let mesh = &scene.mesh;
        let (mut clique, mut block) = (vec![u32::MAX; mesh.cells.len()], vec![u32::MAX; mesh.nodes.len()]);
        let (mut cliques, mut node) = (Cliques::default(), Vec::new());
        for c in (0..mesh.cells.len()).filter(|&c| state.taking_part[c]) {
            for &n in mesh.cells.nodes(c) {
                block[n as usize] = 0;
            }
        }
        for (n, block) in block.iter_mut().enumerate().filter(|(_, b)| **b == 0) {
            *block = node.len() as u32;
            node.push(n as u32);
        }
        for c in (0..mesh.cells.len()).filter(|&c| state.taking_part[c]) {
            clique[c] = cliques.push(stencil.nodes(mesh, c as u32).iter().map(|&n| block[n as usize]));
        }
        let mut face_clique = Vec::new();
        if let Some(faces) = &scene.faces {
            face_clique.resize(faces.inner.len(), u32::MAX);
            for (face, clique) in faces.inner.iter().zip(&mut face_clique) {
                if ghost_faces::has_room(state, face) {
                    *clique = cliques.push(face.nodes(mesh).map(|n| block[n as usize]));
                }
            }
        }
        let dynamic = scene.phases.iter().any(|p| p.dynamic);
        let mass = if dynamic { Some(System::new(node.len(), 1, cliques.clone(), true)?) } else { None };
        let symmetric = scene.terms.iter().all(|t| t.symmetric());
        let motion = System::new(node.len(), D as u8, cliques, symmetric)?;
        let workspace = Workspace::default();
        let mut grid = Self { stencil, ghost: Vec::new(), face_clique, clique, block, node, motion, mass, workspace };
        grid.penalise(scene, state);
        Ok(grid)
    }

    /// Takes the faces that are to have a ghost penalty.
    fn penalise(&mut self, scene: &Scene<D>, state: &State<D>) {
        self.ghost.clear();
        let Some(faces) = &scene.faces else { return };
        self.ghost.extend(ghost_faces::choose(scene, state).into_iter().map(|face| GhostFace {
            face,
            between: faces.inner[face as usize],
            clique: self.face_clique[face as usize],
        }));
    }

    /// What the terms see.
    pub fn frame<'a>(&'a self, mesh: &'a Mesh<D>, points: &'a Points<D>, weighing: &'a Weighing<D>) -> Frame<'a, D> {
        Frame {
            mesh,
            stencil: &self.stencil,
            soft: &weighing.soft,
            ghost: &self.ghost,
            points,
            pattern: &self.motion.pattern,
            clique: &self.clique,
            block: &self.block,
        }
    }
}

/// Goes back to the first shape of the grid: finds the points on it, chooses the cells that take part and weighs
/// the points. True when the system must have another pattern than before.
///
/// # Errors
/// When a point lies outside the grid.
fn begin_anew<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    state: &mut State<D>,
    stencil: &mut Stencil<D>,
) -> Result<bool> {
    locate_points(scene, state)?;
    let changed = choose_cells(scene, state);
    state.displacement.fill([0.0; D]);
    state.restorations += 1;
    fill::<D, K>(stencil, scene, state);
    let points = &state.points;
    state.weighing = scene.quadrature.weigh(&scene.mesh, points, &state.parametric, stencil, &state.taking_part);
    if scene.numerics.restore == Restore::Never {
        // A grid that is never restored carries its points along: its cells stay as full as seeded.
        state.weighing.soft.clear();
    }
    stencil.weigh(&state.weighing.weight, &state.weighing.shift);
    if let Some(faces) = &scene.faces {
        let chosen = ghost_faces::choose(scene, state);
        return Ok(ghost_faces::make_room(faces, state, &chosen) || changed);
    }
    Ok(changed)
}

/// Fills the stencil for the points where they were last located.
fn fill<const D: usize, K: Kinematics<D>>(stencil: &mut Stencil<D>, scene: &Scene<D>, state: &State<D>) {
    let (cell, scheme) = (&state.points.cell, scene.numerics.scheme);
    stencil.fill::<K>(scheme, &scene.mesh, cell, &state.parametric, &state.taking_part);
}

/// Finds the cell of every point of the restored grid.
///
/// # Errors
/// An analysis error that names the first point outside the grid.
fn locate_points<const D: usize>(scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
    let points = &mut state.points;
    let position = &points.position;
    state.parametric.resize(position.len(), [0.0; 3]);
    let lost = points
        .cell
        .par_iter_mut()
        .zip(&mut state.parametric)
        .enumerate()
        .filter_map(|(p, (cell, parametric))| match scene.locator.locate(&scene.mesh, &position[p], Some(*cell)) {
            Some((c, xi)) => {
                (*cell, *parametric) = (c, xi);
                None
            }
            None => Some(p),
        })
        .min();
    match lost {
        None => Ok(()),
        Some(p) => {
            let region = scene.mesh.regions.get(points.region[p] as usize).map_or("", String::as_str);
            Err(Error::analysis(
                format!("material point {p} ({region})"),
                format!("it left the grid at {:.4?} m", position[p]),
                "extend the mesh by a buffer region there, or hold the material back by a support",
            ))
        }
    }
}

/// Decides which cells take part; true when that changed since the last time.
fn choose_cells<const D: usize>(scene: &Scene<D>, state: &mut State<D>) -> bool {
    let cells = scene.mesh.cells.len();
    // A face to a cell beyond would have no place in the system.
    let surrounded = |&c: &u32| {
        let across = scene.faces.as_ref().map_or(&[][..], |faces| faces.neighbours(c));
        state.taking_part[c as usize] && across.iter().all(|&other| state.taking_part[other as usize])
    };
    if state.taking_part.len() == cells && state.points.cell.iter().all(surrounded) {
        return false;
    }
    let mut chosen = vec![false; cells];
    for &c in &state.points.cell {
        chosen[c as usize] = true;
    }
    if scene.numerics.restore != Restore::Never {
        let mut reached = vec![false; scene.mesh.nodes.len()];
        for _ in 0..RINGS {
            for c in (0..cells).filter(|&c| chosen[c]) {
                for &n in scene.mesh.cells.nodes(c) {
                    reached[n as usize] = true;
                }
            }
            for (c, chosen) in chosen.iter_mut().enumerate() {
                *chosen |= scene.mesh.cells.nodes(c).iter().any(|&n| reached[n as usize]);
            }
        }
    }
    state.taking_part = chosen;
    true
}

/// The displacement increments (m) that are given in a step of size `dt`, one entry an equation: zero at the
/// supports, and what is prescribed, which takes precedence.
pub fn given_increments<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    dt: f64,
) -> Vec<Option<f64>> {
    let mut given = vec![None; grid.motion.pattern.len()];
    let mut give = |fixed: &Fixed, increment: f64| {
        for &n in &fixed.nodes {
            let block = grid.block[n as usize];
            if block != u32::MAX {
                given[block as usize * D + fixed.component] = Some(increment);
            }
        }
    };
    for fixed in &scene.supports {
        give(fixed, 0.0);
    }
    for prescribed in &scene.phases[state.phase].prescribed {
        let from = if state.phase_time > 0.0 { prescribed.displacement.at(state.phase_time) } else { 0.0 };
        give(&prescribed.fixed, prescribed.displacement.at(state.phase_time + dt) - from);
    }
    given
}
