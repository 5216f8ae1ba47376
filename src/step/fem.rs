//! The finite elements of a run (docs/theory.md, section 3, eq. 26): cells that keep their points and are not reset.
//!
//! At a grid reset their nodes keep their current positions, the displacement begins at zero again, and the points carry the deformation so
//! far (updated Lagrangian).

use super::family::Family;
use super::scene::{Fem, Scene};
use super::state::State;
use crate::dofs::DofMap;
use crate::interpolation::{Interpolation, Mpm};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::system::Connectivity;
use crate::term::Bar;

/// The finite elements, and what their points see of them.
pub struct Elements<const D: usize> {
    /// The cells with the nodes where they were when the grid was last restored.
    pub mesh: Mesh<D>,
    pub interpolation: Interpolation<D>,
    /// The cells with unknowns of pressure.
    pub cells: Vec<u32>,
    /// The coupling of each cell; `u32::MAX` for those of rigid bodies.
    pub coupling: Vec<u32>,
    /// The coupling of each bar.
    pub bars: Vec<u32>,
    /// The number of points that are not of rigid bodies: the first ones.
    points: usize,
}

impl<const D: usize> Elements<D> {
    /// The elements of a scene in a state.
    pub fn new<K: Kinematics<D>>(fem: &Fem<D>, state: &State<D>) -> Self {
        let cells = (0u32..).zip(&fem.with_pressure).filter(|(_, with)| **with).map(|(c, _)| c).collect();
        let points = state.fem.region.iter().filter(|r| !fem.rigid[**r as usize]).count();
        let mut elements = Self {
            mesh: fem.mesh.clone(),
            interpolation: Interpolation::default(),
            cells,
            coupling: Vec::new(),
            bars: Vec::new(),
            points,
        };
        elements.place::<K>(state);
        elements
    }

    /// Their points and cells.
    pub fn family<'a>(&'a self, points: &'a Points<D>) -> Family<'a, D> {
        Family { mesh: &self.mesh, interpolation: &self.interpolation, coupling: &self.coupling, points }
    }

    /// Takes the nodes where `state` has them.
    pub fn place<K: Kinematics<D>>(&mut self, state: &State<D>) {
        let nodes = self.mesh.nodes.len();
        self.mesh.nodes.copy_from_slice(&state.nodes[..nodes]);
        let count = self.points;
        self.interpolation.fill::<K>(&Mpm, &self.mesh, &state.fem.cell[..count], &state.fem_parametric[..count], &[]);
        self.interpolation.weigh(&state.fem.initial_volume[..count]);
    }

    /// Appends a coupling for each cell that deforms, and each bar.
    pub fn couple(&mut self, (fem, bars): (&Fem<D>, &[Bar<D>]), dofs: &DofMap<D>, connectivity: &mut Connectivity) {
        let cells = &self.mesh.cells;
        self.coupling = vec![u32::MAX; cells.len()];
        for c in fem.deforming() {
            self.coupling[c] = dofs.couple(cells.nodes(c).iter().copied(), connectivity);
        }
        self.bars = bars.iter().map(|bar| dofs.couple(bar.nodes(), connectivity)).collect();
    }
}

/// Sets the reference positions of the nodes of elements and rigid bodies, and of curves that phases move, to the current ones (eq. 26), before the
/// displacement is set to zero.
pub fn keep_shape<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    let mut keeps = scene.following(state.phase);
    if scene.fem.is_none() && scene.bodies.is_empty() && !keeps.contains(&true) {
        return;
    }
    if state.nodes.is_empty() {
        state.nodes = (0..scene.displacements() as u32).map(|n| scene.origin(n)).collect();
    }
    keeps.resize(state.nodes.len(), false);
    for &n in scene.fem.iter().flat_map(|fem| &fem.mesh.cells.nodes) {
        keeps[n as usize] = true;
    }
    keeps[scene.mesh_nodes()..].fill(true);
    for ((x, u), _) in state.nodes.iter_mut().zip(&state.displacement).zip(&keeps).filter(|(_, of)| **of) {
        for d in 0..D {
            x[d] += u[d];
        }
    }
}
