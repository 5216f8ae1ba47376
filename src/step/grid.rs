//! The grid of a run: which cells take part, the numbering of the unknowns and the interpolation of the points.
//! All of it follows from the scene and the state, and is made anew only as far as they changed.

use super::drainage;
use super::facing;
use super::family::{Family, Interpolations, System};
use super::fem::Elements;
use super::ghost_faces;
use super::nodal_fit::Filled;
use super::outflow;
use super::pore_pressure;
use super::pressure;
use super::relax::{self, Relaxed};
use super::restore::{begin_anew, fill, take_weights};
use super::scalars::{Carrier, Scalars};
use super::scene::{Fixed, Prescribed, Restore, Scene};
use super::state::State;
use super::traced::Shares;
use super::unknowns::Buffers;
use crate::dofs::DofMap;
use crate::error::Result;
use crate::interpolation::Interpolation;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::surface::Piece;
use crate::system::{Connectivity, Workspace};
use crate::term::{Frame, GhostFace, PlacedConstraint};

/// The grid of a run.
pub struct Grid<const D: usize> {
    pub interpolations: Interpolations<D>,
    /// The grid where finite elements that share nodes with it have moved it; absent where it keeps its first shape.
    pub relaxed: Option<Relaxed<D>>,
    /// The finite elements; absent where the scene has none.
    pub elements: Option<Elements<D>>,
    /// The faces that take a ghost penalty.
    pub ghost: Vec<GhostFace>,
    /// The constraints of the contact nodes that face soil or another body.
    pub constraints: Vec<PlacedConstraint<D>>,
    /// Where the material of point loads is, as [`Frame::loaded`].
    pub loaded: Vec<(u32, Shares)>,
    /// The parts of the boundary of the material that no structure covers; absent where all of it is open or no term needs it.
    pub open: Option<Vec<Piece>>,
    /// The coupling of each contact node of each interface that the system has room for, else `u32::MAX`.
    pub constraint_coupling: Vec<Vec<u32>>,
    /// The coupling of each face that the system has room for a penalty at, else `u32::MAX`; empty without faces.
    face_coupling: Vec<u32>,
    /// The coupling of each rigid body.
    body_coupling: Vec<u32>,
    /// The coupling of each cell; `u32::MAX` for those left out.
    pub coupling: Vec<u32>,
    /// The equations of [`Grid::motion`].
    pub dofs: DofMap<D>,
    /// The cells that take part, ascending.
    pub cells: Vec<u32>,
    pub motion: System,
    /// The mass of the points on the nodes, one equation a node: in dynamic analysis only.
    pub mass: Option<System>,
    pub workspace: Workspace,
    pub buffers: Buffers<D>,
}

impl<const D: usize> Grid<D> {
    /// The grid of a state whose points are located and have weights.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new<K: Kinematics<D>>(scene: &Scene<D>, state: &State<D>) -> Result<Self> {
        let relaxed = relax::at(scene, state);
        let mut interpolations = Interpolations::default();
        let (mesh, locator) = relax::mesh(scene, relaxed.as_ref());
        fill::<D, K>(&mut interpolations.integration, scene, (mesh, locator), state);
        take_weights::<D, K>(&mut interpolations, scene, mesh, state);
        Self::with::<K>(scene, state, interpolations, relaxed)
    }

    /// The grid in its first shape, with the points on it.
    ///
    /// # Errors
    /// When a point lies outside the grid, or memory does not suffice.
    pub fn first<K: Kinematics<D>>(scene: &Scene<D>, state: &mut State<D>) -> Result<Self> {
        let mut interpolations = Interpolations::default();
        state.points.plastic_increment.resize(state.points.len(), 0.0);
        let mut relaxed = None;
        begin_anew::<D, K>(scene, state, &mut interpolations, &mut relaxed)?;
        let grid = Self::with::<K>(scene, state, interpolations, relaxed)?;
        if scene.has_pressure_field() {
            grid.project_pressure_of_elements::<K>(scene, state);
        }
        grid.project_pore_pressure::<K>(scene, state);
        Ok(grid)
    }

    /// Restores the grid.
    ///
    /// # Errors
    /// As [`Grid::first`].
    pub fn restore<K: Kinematics<D>>(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        if begin_anew::<D, K>(scene, state, &mut self.interpolations, &mut self.relaxed)? {
            *self = Self::with::<K>(scene, state, std::mem::take(&mut self.interpolations), self.relaxed.take())?;
        } else {
            if let Some(elements) = &mut self.elements {
                elements.place::<K>(state);
            }
            self.penalise(scene, state);
        }
        self.project_pore_pressure::<K>(scene, state);
        Ok(())
    }

    /// Whether material points have passed a curve through which they leave.
    pub fn has_outflow(&self, scene: &Scene<D>, state: &State<D>) -> bool {
        !outflow::passed(scene, state, relax::mesh(scene, self.relaxed.as_ref())).is_empty()
    }

    /// The grid for its interpolations.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn with<K: Kinematics<D>>(
        scene: &Scene<D>,
        state: &State<D>,
        interpolations: Interpolations<D>,
        relaxed: Option<Relaxed<D>>,
    ) -> Result<Self> {
        let mesh = &scene.mesh;
        let mut coupling = vec![u32::MAX; mesh.cells.len()];
        let mut connectivity = Connectivity::default();
        let [places, of_elements] = scene.places();
        let active = (0..mesh.cells.len()).filter(|&c| state.active[c]).flat_map(|c| mesh.cells.nodes(c));
        let of_fem = scene.fem.iter().flat_map(|fem| fem.deforming().flat_map(|c| fem.mesh.cells.nodes(c)));
        let (nodes, bodies) = (active.chain(of_fem).copied(), scene.bodies.iter().map(|body| body.dofs).collect());
        let mut dofs = DofMap::of_nodes(nodes, scene.displacements(), bodies, places, scene.constraints());
        let node = &dofs.node;
        let cells: Vec<u32> = (0u32..).zip(&state.active).filter(|(_, part)| **part).map(|(c, _)| c).collect();
        let support = scene.basis.support(mesh, &state.active);
        for &c in &cells {
            let nodes = support.as_ref().map_or_else(|| mesh.cells.nodes(c as usize), |support| support.nodes(c));
            coupling[c as usize] = dofs.couple(nodes.iter().copied(), &mut connectivity);
        }
        let mut elements = scene.fem.as_ref().map(|fem| Elements::new::<K>(fem, state));
        if let (Some(elements), Some(fem)) = (&mut elements, &scene.fem) {
            elements.couple((fem, &scene.bars), &dofs, &mut connectivity);
        }
        let body_coupling = dofs.bodies.iter().map(|body| dofs.couple(body.numbers(), &mut connectivity)).collect();
        let cells_only = connectivity.clone();
        let mut face_coupling = vec![u32::MAX; scene.locator.faces.inner.len()];
        for (face, coupling) in scene.locator.faces.inner.iter().zip(&mut face_coupling) {
            if ghost_faces::has_room(state, face) {
                *coupling = dofs.couple(face.nodes(mesh), &mut connectivity);
            }
        }
        let dynamic = scene.dynamic();
        let coordinates: Vec<_> = node.iter().map(|&n| scene.origin(n)).collect();
        let mass = if dynamic {
            Some(System::new(&vec![1; node.len()], connectivity.clone(), true, &coordinates)?)
        } else {
            None
        };
        // The mass always takes a penalty on faces, the motion only where a term says so.
        let mut connectivity = if scene.terms.iter().any(|t| t.penalises_faces()) { connectivity } else { cells_only };
        let constraint_coupling = facing::couple(state, &dofs, &mut connectivity);
        let with_pressure = scene.pressure_unit.is_some().then(|| {
            let (with_pressure, with_water, part) = (scene.has_pressure_field(), scene.water.is_some(), &state.active);
            let mut families = vec![Carrier {
                mesh,
                places,
                with_pressure: Box::new(move |c| with_pressure && part[c as usize]),
                with_water: Box::new(move |c| with_water && part[c as usize]),
                coupling: &coupling,
            }];
            families.extend(elements.iter().zip(&scene.fem).map(|(elements, fem)| Carrier {
                mesh: &elements.mesh,
                places: of_elements,
                with_pressure: Box::new(|c| fem.with_pressure[c as usize]),
                with_water: Box::new(|c| fem.with_water[c as usize]),
                coupling: &elements.coupling,
            }));
            Scalars::new(&families, node.len(), &connectivity, places.end(with_water))
        });
        let of_elements = scene.fem.iter().flat_map(|fem| &fem.terms);
        let symmetric = scene.basis.is_symmetric() && scene.terms.iter().chain(of_elements).all(|t| t.symmetric());
        let mut sizes = vec![D as u8; node.len()];
        let (motion, pressure) = match with_pressure {
            None => (System::new(&sizes, connectivity, symmetric, &coordinates)?, Vec::new()),
            Some(Scalars { places: pressure, connectivity }) => {
                sizes.resize(node.len() + pressure.len(), 1);
                let mut motion = System::new(&sizes, connectivity, symmetric, &coordinates)?;
                motion.solver = motion.solver.saddle();
                (motion, pressure)
            }
        };
        dofs.pressure = pressure;
        let mut grid = Self {
            interpolations,
            relaxed,
            elements,
            ghost: Vec::new(),
            constraints: Vec::new(),
            loaded: Vec::new(),
            open: None,
            constraint_coupling,
            face_coupling,
            body_coupling,
            coupling,
            dofs,
            cells,
            motion,
            mass,
            workspace: Workspace::default(),
            buffers: Buffers::default(),
        };
        grid.penalise(scene, state);
        Ok(grid)
    }

    /// Takes the pressure field over from points whose materials have changed.
    pub fn project_pressure<K: Kinematics<D>>(&self, scene: &Scene<D>, state: &mut State<D>) {
        let mut field = std::mem::take(&mut state.pressure);
        let soil = Filled {
            mesh: self.mesh(scene),
            interpolation: &self.interpolations.integration,
            points: state.integration(),
        };
        pressure::gather::<D, K>(soil, scene.places()[0], &mut field);
        state.pressure = field;
        self.project_pressure_of_elements::<K>(scene, state);
    }

    fn project_pressure_of_elements<K: Kinematics<D>>(&self, scene: &Scene<D>, state: &mut State<D>) {
        if let Some(Elements { mesh, interpolation, .. }) = &self.elements {
            let [_, places] = scene.places();
            let elements = Filled { mesh, interpolation, points: &state.fem };
            pressure::gather::<D, K>(elements, places, &mut state.pressure);
        }
    }

    /// Takes the pore pressure over from the points.
    fn project_pore_pressure<K: Kinematics<D>>(&self, scene: &Scene<D>, state: &mut State<D>) {
        let Some(water) = &scene.water else { return };
        let mut pressure = std::mem::take(&mut state.pressure);
        let places = scene.places()[0];
        pressure.resize(places.end(true), 0.0);
        let soil = self.frame(&scene.mesh, state).into();
        let elements = self.elements.as_ref().map(|elements| self.frame_of_elements(scene, elements, state).into());
        let integrated: Vec<_> = std::iter::once(soil).chain(elements).collect();
        pore_pressure::gather::<D, K>(&integrated, &water.porous, &mut pressure[places.pore(0)..]);
        state.pressure = pressure;
    }

    /// Takes the faces that are to have a ghost penalty.
    fn penalise(&mut self, scene: &Scene<D>, state: &State<D>) {
        self.ghost.clear();
        self.ghost.extend(ghost_faces::choose(scene, state).into_iter().map(|face| GhostFace {
            face,
            between: scene.locator.faces.inner[face as usize],
            coupling: self.face_coupling[face as usize],
        }));
    }

    /// What the terms of the scene see.
    pub fn frame<'a>(&'a self, mesh: &'a Mesh<D>, state: &'a State<D>) -> Frame<'a, D> {
        let relaxed = self.relaxed.as_ref().map(|relaxed| &relaxed.mesh);
        Frame {
            mesh: relaxed.unwrap_or(mesh),
            reset: &state.nodes,
            relaxed: relaxed.is_some(),
            interpolation: &self.interpolations.integration,
            partly_filled: &state.weights.partly_filled,
            ghost: &self.ghost,
            constraints: &self.constraints,
            loaded: &self.loaded,
            boundary: &state.weights.boundary.pieces,
            open: self.open.as_deref().unwrap_or(&state.weights.boundary.pieces),
            level_set: &state.weights.level_set,
            cells: &self.cells,
            places: self.dofs.places,
            points: state.integration(),
            integration: None,
            pattern: &self.motion.pattern,
            coupling: &self.coupling,
            block: &self.dofs.block,
            linear_constraints: self.dofs.constraints.as_ref(),
            travel: &state.travel,
            bodies: &self.body_coupling,
            bars: self.elements.as_ref().map_or(&[], |elements| &elements.bars),
            free_lengths: &state.free_lengths,
        }
    }

    /// What the terms of the scene see of the material points, where others are summed over.
    pub fn frame_of_material<'a>(&'a self, mesh: &'a Mesh<D>, state: &'a State<D>) -> Option<Frame<'a, D>> {
        let interpolation = self.interpolations.material.as_ref()?;
        let frame = self.frame(mesh, state);
        Some(Frame {
            interpolation,
            points: &state.points,
            integration: Some((frame.interpolation, frame.points)),
            ..frame
        })
    }

    /// What the terms of the finite elements see.
    pub fn frame_of_elements<'a>(
        &'a self,
        scene: &Scene<D>,
        elements: &'a Elements<D>,
        state: &'a State<D>,
    ) -> Frame<'a, D> {
        Frame {
            mesh: &elements.mesh,
            relaxed: true,
            interpolation: &elements.interpolation,
            partly_filled: &[],
            ghost: &[],
            constraints: &[],
            loaded: &[],
            boundary: &[],
            open: &[],
            level_set: &[],
            cells: &elements.cells,
            places: scene.places()[1],
            points: &state.fem,
            coupling: &elements.coupling,
            ..self.frame(&elements.mesh, state)
        }
    }

    /// The mesh at the last reset.
    pub(super) fn mesh<'a>(&'a self, scene: &'a Scene<D>) -> &'a Mesh<D> {
        relax::mesh(scene, self.relaxed.as_ref()).0
    }

    /// The interpolation of the material points.
    pub fn of_material(&self) -> &Interpolation<D> {
        self.interpolations.material.as_ref().unwrap_or(&self.interpolations.integration)
    }

    /// The material points on the grid.
    pub fn family_of_material<'a>(&'a self, scene: &'a Scene<D>, state: &'a State<D>) -> Family<'a, D> {
        let (mesh, interpolation, coupling) = (&scene.mesh, self.of_material(), &self.coupling);
        Family { mesh, interpolation, coupling, points: &state.points }
    }

    /// All that moves: the material points and those of the finite elements.
    pub fn families<'a>(&'a self, scene: &'a Scene<D>, state: &'a State<D>) -> impl Iterator<Item = Family<'a, D>> {
        std::iter::once(self.family_of_material(scene, state))
            .chain(self.elements.iter().map(|elements| elements.family(&state.fem)))
    }

    /// All that integrals are summed over.
    pub fn integrated<'a>(&'a self, scene: &'a Scene<D>, state: &'a State<D>) -> impl Iterator<Item = Family<'a, D>> {
        let (mesh, interpolation, coupling) = (&scene.mesh, &self.interpolations.integration, &self.coupling);
        let soil = Family { mesh, interpolation, coupling, points: state.integration() };
        std::iter::once(soil).chain(self.elements.iter().map(|elements| elements.family(&state.fem)))
    }
}

/// The prescribed increments (m) of displacement in a step of size `dt`, one entry for each equation: zero at supports, and those of curves,
/// which take precedence; and those of the pore pressure (kPa), which is not in excess at drained nodes.
pub fn given_increments<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    dt: f64,
) -> Vec<Option<f64>> {
    let mut given = vec![None; grid.motion.pattern.len()];
    let mut give = |fixed: &Fixed, increment: f64| {
        for &n in &fixed.nodes {
            if let Some(equation) = grid.dofs.displacement(n, fixed.component) {
                given[equation] = Some(increment);
            }
        }
    };
    for fixed in &scene.supports {
        give(fixed, 0.0);
    }
    for prescribed in &scene.phases[state.phase].prescribed {
        give(&prescribed.fixed, increment(prescribed, state, dt));
    }
    for fixed in &scene.phases[state.phase].held {
        give(fixed, 0.0);
    }
    let drained = drainage::nodes(scene, state, grid.integrated(scene, state));
    for (equation, node) in grid.dofs.pores().filter(|(_, node)| drained.binary_search(node).is_ok()) {
        given[equation] = Some(0.0 - state.pressure[grid.dofs.places.pore(node)]);
    }
    given
}

/// The increment (m) of a prescribed displacement in a step of size `dt`.
fn increment<const D: usize>(prescribed: &Prescribed, state: &State<D>, dt: f64) -> f64 {
    let from = if state.phase_time > 0.0 { prescribed.displacement.at(state.phase_time) } else { 0.0 };
    prescribed.displacement.at(state.phase_time + dt) - from
}

/// Moves the nodes far from all material of curves that are moved and reach to it: a curve stays whole.
pub fn move_whole_curves<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    dt: f64,
    displacement: &mut [[f64; D]],
) {
    let is_far = |n: &&u32| !grid.dofs.has(**n);
    let reaches = |p: &&Prescribed| {
        let far = p.fixed.nodes.iter().filter(is_far).count();
        far > 0 && far < p.fixed.nodes.len()
    };
    let mut curves = scene.phases[state.phase].prescribed.iter().filter(reaches).peekable();
    if scene.numerics.restore == Restore::Never || curves.peek().is_none() {
        return;
    }
    let following = scene.following(state.phase);
    for prescribed in curves {
        let (by, d) = (increment(prescribed, state, dt), prescribed.fixed.component);
        for &n in prescribed.fixed.nodes.iter().filter(is_far).filter(|n| following.get(**n as usize) == Some(&true)) {
            displacement[n as usize][d] = state.displacement[n as usize][d] + by;
        }
    }
}
