//! The map of unknowns: where each field stands in the state, and which equation of the grid each unknown has.
//!
//! | field | unknowns | in the state | equations |
//! |---|---|---|---|
//! | displacement (m) | D a node | by node | first, node by node |
//! | motion of rigid bodies (m, rad) | a translation and a rotation a body | after the nodes ([`RigidDofs`]) | after those of the nodes |
//! | pressure (kPa) | one a corner, and in cells of second order one a cell | [`Places`] | one each, after them |
//! | pore pressure (kPa) | one a corner | [`Places`] | among the former |
//!
//! Under linear constraints the equations of the displacements are those of the controls, which have the numbers of nodes, and the values of
//! the nodes follow from them ([`LinearConstraints`]).

use crate::mesh::Mesh;
use crate::system::{Connectivity, LinearConstraints};

/// Where the pressures of a family of cells stand among all pressures of a state: the pressure field by node, the constants of the cells of
/// the grid, those of the finite elements, the pore pressure by node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Places {
    /// Where the constants of the cells of the family begin, and the pore pressure.
    constants: usize,
    pores: usize,
    /// How many nodes there are.
    nodes: usize,
}

impl Places {
    /// Those of the cells of the grid and of the finite elements, given how many nodes and cells there are.
    pub fn of(nodes: usize, cells: usize, elements: usize) -> [Self; 2] {
        let pores = nodes + cells + elements;
        [nodes, nodes + cells].map(|constants| Self { constants, pores, nodes })
    }

    /// The constant of a cell.
    pub fn constant(self, cell: usize) -> usize {
        self.constants + cell
    }

    /// The pore pressure at a node.
    pub fn pore(self, node: u32) -> usize {
        self.pores + node as usize
    }

    /// How many values there are, with pore pressures or without.
    pub fn end(self, with_water: bool) -> usize {
        self.pores + if with_water { self.nodes } else { 0 }
    }

    /// The places of the pressure field of a cell: its corners, and its constant.
    pub fn of_field<const D: usize>(self, mesh: &Mesh<D>, cell: usize) -> impl Iterator<Item = u32> {
        let constant = (mesh.cells.kind[cell].order() > 1).then_some(self.constant(cell) as u32);
        mesh.cells.corners(cell).iter().copied().chain(constant)
    }

    /// The places of the pore pressure of a cell: its corners.
    pub fn of_pores<const D: usize>(self, mesh: &Mesh<D>, cell: usize) -> impl Iterator<Item = u32> + '_ {
        mesh.cells.corners(cell).iter().map(move |&n| self.pore(n) as u32)
    }
}

/// The unknowns of a rigid body: the translation (m) of its reference point and, where it turns, its rotation (rad), anticlockwise.
///
/// They have numbers after those of the nodes in all vectors of displacements, velocities and forces, and a block of equations each. A rotation
/// is kept as the arc `ℓ θ` (m) in the first component, and a moment `M` as `M/ℓ` (kN), so that all unknowns are lengths and all equations forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidDofs {
    /// Their numbers; a body in axisymmetry does not turn.
    pub translation: u32,
    pub rotation: Option<u32>,
    /// ℓ (m): what stands for 1 rad.
    pub arm: f64,
}

impl RigidDofs {
    /// Those with the numbers from `first` on, of a body that `turns` or not.
    pub fn new(first: u32, turns: bool, arm: f64) -> Self {
        Self { translation: first, rotation: turns.then_some(first + 1), arm }
    }

    /// Their numbers.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + use<> {
        std::iter::once(self.translation).chain(self.rotation)
    }

    /// A component of the motion, in `D` dimensions of the translation and then of the rotation: its number, the component there, and what stands for
    /// 1 m or 1 rad; `None` where the body does not turn.
    pub fn component<const D: usize>(&self, component: usize) -> Option<(u32, usize, f64)> {
        match component.checked_sub(D) {
            None => Some((self.translation, component, 1.0)),
            Some(of_rotation) => self.rotation.map(|n| (n, of_rotation, self.arm)),
        }
    }

    /// The numbers and components without a meaning, which are always held: those of the rotation after the first; without a rotation
    /// (axisymmetry) what leaves the axis.
    pub fn unused<const D: usize>(&self) -> impl Iterator<Item = (u32, usize)> {
        let (number, components) = self.rotation.map_or((self.translation, 0..1), |n| (n, 1..D));
        components.map(move |component| (number, component))
    }

    /// Translation (m) and rotation (rad), or their rates, in a `field` by number.
    pub fn motion<const D: usize>(&self, field: impl Fn(u32) -> [f64; D]) -> ([f64; D], f64) {
        (field(self.translation), self.rotation.map_or(0.0, |n| field(n)[0] / self.arm))
    }

    /// Force (kN) and moment (kN m) in a `field` of forces by number.
    pub fn load<const D: usize>(&self, field: impl Fn(u32) -> [f64; D]) -> ([f64; D], f64) {
        (field(self.translation), self.rotation.map_or(0.0, |n| self.moment(&field(n))))
    }

    /// The value in the field that stands for a rotation (rad).
    pub fn arc<const D: usize>(&self, rotation: f64) -> [f64; D] {
        std::array::from_fn(|d| if d == 0 { rotation * self.arm } else { 0.0 })
    }

    /// The moment (kN m) that a `force` (kN) on the rotation is.
    pub fn moment<const D: usize>(&self, force: &[f64; D]) -> f64 {
        self.arm * force[0]
    }

    /// The force (kN) on the rotation that a moment (kN m) is.
    pub fn force<const D: usize>(&self, moment: f64) -> [f64; D] {
        std::array::from_fn(|d| if d == 0 { moment / self.arm } else { 0.0 })
    }
}

/// An unknown of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dof {
    /// Of a node, or by the number of an unknown of a rigid body.
    Displacement { node: usize, component: usize },
    /// By its place ([`Places`]).
    Pressure(usize),
}

/// The equations of a grid.
#[derive(Clone, Debug)]
pub struct DofMap<const D: usize> {
    /// The node (the control, under constraints) of each block of displacements, and the place of each pressure.
    pub node: Vec<u32>,
    pub pressure: Vec<u32>,
    /// The block of each node (control); `u32::MAX` for those left out.
    pub block: Vec<u32>,
    pub places: Places,
    /// The unknowns of the rigid bodies.
    pub bodies: Vec<RigidDofs>,
    /// The values of the nodes as combinations of those of the controls (`E` of eq. 2c); absent where each node has equations of its own.
    pub constraints: Option<LinearConstraints>,
}

impl<const D: usize> DofMap<D> {
    /// The equations of the displacements of those `nodes` that have some and of rigid bodies, by number, without scalar unknowns; `count` is how
    /// many numbers there are.
    pub fn of_nodes(
        nodes: impl Iterator<Item = u32>,
        count: usize,
        bodies: Vec<RigidDofs>,
        places: Places,
        constraints: Option<LinearConstraints>,
    ) -> Self {
        let (mut block, mut node) = (vec![u32::MAX; count], Vec::new());
        for n in nodes.chain(bodies.iter().flat_map(RigidDofs::numbers)) {
            match &constraints {
                None => block[n as usize] = 0,
                Some(constraints) => constraints.of_node(n).iter().for_each(|&(m, _)| block[m as usize] = 0),
            }
        }
        for (n, block) in block.iter_mut().enumerate().filter(|(_, b)| **b == 0) {
            *block = node.len() as u32;
            node.push(n as u32);
        }
        Self { node, pressure: Vec::new(), block, places, bodies, constraints }
    }

    /// Appends a coupling of active nodes and returns its number.
    pub fn couple(&self, nodes: impl Iterator<Item = u32>, connectivity: &mut Connectivity) -> u32 {
        let Some(constraints) = &self.constraints else {
            return connectivity.push(nodes.map(|n| self.block[n as usize]));
        };
        let by_block = |n: u32| constraints.of_node(n).iter().map(|&(m, by)| (self.block[m as usize], by)).collect();
        let rows: Vec<Vec<(u32, f64)>> = nodes.map(by_block).collect();
        connectivity.push_combined(rows.iter().map(Vec::as_slice))
    }

    /// Writes a component of a nodal `field`, given its value at each block. Under constraints every node is written that a block acts on.
    pub fn write(&self, values: &[f64], component: usize, field: &mut [[f64; D]]) {
        let Some(constraints) = &self.constraints else {
            self.node.iter().zip(values).for_each(|(&n, value)| field[n as usize][component] = *value);
            return;
        };
        for (n, field) in (0u32..).zip(field) {
            let active = constraints.of_node(n).iter().filter(|(m, _)| self.block[*m as usize] != u32::MAX);
            let sum = active.map(|&(m, by)| by * values[self.block[m as usize] as usize]).reduce(|a, b| a + b);
            if let Some(sum) = sum {
                field[component] = sum;
            }
        }
    }

    /// Whether some block acts on a node.
    pub fn moves(&self, node: u32) -> bool {
        let has = |n: u32| self.block[n as usize] != u32::MAX;
        self.constraints.as_ref().map_or_else(|| has(node), |all| all.of_node(node).iter().any(|&(m, _)| has(m)))
    }

    /// What the field that has a `value` at the nodes has at node (control) `n`.
    pub fn value(&self, n: u32, value: impl Fn(u32) -> [f64; D]) -> [f64; D] {
        let Some(constraints) = &self.constraints else { return value(n) };
        constraints.of_control(n).iter().fold([0.0; D], |sum, &(m, by)| {
            let value = value(m);
            std::array::from_fn(|d| sum[d] + by * value[d])
        })
    }

    /// The forces on the blocks that do the same work as the `force` on the nodes.
    pub fn on_blocks(&self, force: &[[f64; D]]) -> Vec<[f64; D]> {
        let Some(constraints) = &self.constraints else {
            return self.node.iter().map(|&n| force[n as usize]).collect();
        };
        let mut out = vec![[0.0; D]; self.node.len()];
        for (n, force) in (0u32..).zip(force).filter(|(_, force)| force.iter().any(|&f| f != 0.0)) {
            for &(m, by) in constraints.of_node(n) {
                if let Some(sum) = out.get_mut(self.block[m as usize] as usize) {
                    (0..D).for_each(|d| sum[d] += by * force[d]);
                }
            }
        }
        out
    }

    /// Forces on the nodes that do the same work as the `force` on the blocks.
    pub fn on_nodes(&self, force: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut out = vec![[0.0; D]; self.block.len()];
        for (&n, force) in self.node.iter().zip(force) {
            match &self.constraints {
                None => out[n as usize] = *force,
                Some(constraints) => constraints.of_control(n).iter().for_each(|&(m, by)| {
                    (0..D).for_each(|d| out[m as usize][d] += by * force[d]);
                }),
            }
        }
        out
    }

    /// The blocks with equations of forces, and their nodes: all but those of rotations.
    pub fn forces(&self) -> impl Iterator<Item = (usize, u32)> {
        let turns = |n: u32| self.bodies.iter().any(|body| body.rotation == Some(n));
        self.node.iter().copied().enumerate().filter(move |&(_, n)| !turns(n))
    }

    /// How many equations are those of displacements.
    pub fn displacements(&self) -> usize {
        D * self.node.len()
    }

    /// Whether a node takes part.
    pub fn has(&self, node: u32) -> bool {
        let has = |n: u32| self.block[n as usize] != u32::MAX;
        self.constraints.as_ref().map_or_else(|| has(node), |all| all.of_node(node).iter().all(|&(m, _)| has(m)))
    }

    /// The equation of a displacement, if the node (control) has one.
    pub fn displacement(&self, node: u32, component: usize) -> Option<usize> {
        let block = self.block[node as usize];
        (block != u32::MAX).then(|| block as usize * D + component)
    }

    /// The unknown of an equation.
    pub fn dof(&self, equation: usize) -> Dof {
        match equation.checked_sub(self.displacements()) {
            None => Dof::Displacement { node: self.node[equation / D] as usize, component: equation % D },
            Some(k) => Dof::Pressure(self.pressure[k] as usize),
        }
    }

    /// The equations of the pore pressure, with their nodes.
    pub fn pores(&self) -> impl Iterator<Item = (usize, u32)> {
        let node = |place: u32| place.checked_sub(self.places.pores as u32);
        (self.displacements()..).zip(&self.pressure).filter_map(move |(k, place)| Some((k, node(*place)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// All fields have places of their own, and every equation leads to its unknown and back.
    #[test]
    fn places_are_apart_and_equations_lead_back() {
        let mesh = rectangle(CellKind::T6, 1.0, 1.0, 1, 1, 0.0, 0);
        let (nodes, cells) = (mesh.nodes.len(), mesh.cells.len());
        let [grid, elements] = Places::of(nodes, cells, 3);
        let of_field = (0..cells).flat_map(|c| grid.of_field(&mesh, c));
        let of_elements = (0..3).map(|c| elements.constant(c) as u32);
        let of_scalars = (0..cells).flat_map(|c| grid.of_pores(&mesh, c));
        let mut all: Vec<u32> = of_field.chain(of_elements).chain(of_scalars).collect();
        all.sort_unstable();
        all.dedup();
        // Four corners with both pressures, and a constant a cell.
        assert_eq!(all.len(), 2 * 4 + cells + 3);
        assert_eq!(grid.end(true), grid.pore(nodes as u32 - 1) + 1);

        let places = [grid.constant(0) as u32, grid.pore(1) as u32];
        let dofs = DofMap::<2> {
            node: vec![1, 3],
            pressure: places.to_vec(),
            block: vec![u32::MAX, 0, u32::MAX, 1],
            places: grid,
            bodies: vec![RigidDofs::new(3, false, 1.0)],
            constraints: None,
        };
        assert_eq!(dofs.displacement(3, 1).map(|e| dofs.dof(e)), Some(Dof::Displacement { node: 3, component: 1 }));
        assert_eq!(dofs.displacement(2, 0), None);
        assert_eq!(dofs.dof(4), Dof::Pressure(grid.constant(0)));
        assert_eq!(dofs.pores().collect::<Vec<_>>(), [(5, 1)]);
    }
}
