//! What a scheme of the material point method is: the functions that a point sees.

use super::{Interpolation, Support};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use std::fmt;

/// Points in the cells of a grid.
pub struct Located<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    /// The cells that take part.
    pub active: &'a [bool],
    /// The cell of each point and its parametric coordinates (-) there.
    pub cell: &'a [u32],
    pub xi: &'a [[f64; 3]],
    /// Whether there is strain around an axis at `x = 0`.
    pub hoop: bool,
    /// Factor from area to volume at a position: 1 in plane strain and in space, `2πr` (m) in axisymmetry.
    pub measure: fn(&[f64; D]) -> f64,
}

impl<'a, const D: usize> Located<'a, D> {
    /// Points in `cell` at `xi`.
    pub fn new<K: Kinematics<D>>(mesh: &'a Mesh<D>, active: &'a [bool], cell: &'a [u32], xi: &'a [[f64; 3]]) -> Self {
        Self { mesh, active, cell, xi, hoop: K::HOOP, measure: K::measure }
    }
}

/// A scheme: which nodes a point acts on, with what values and gradients.
///
/// Values sum up to one and gradients to zero; both reproduce a linear field. Assembly, transfer, inertia, pressure fields and pore water
/// take what a scheme fills in. Contact, loads on boundaries and the ghost penalty act on boundaries and faces, where the
/// shape functions of the cells stand for those of the scheme.
pub trait Basis<const D: usize>: fmt::Debug + Send + Sync {
    /// The name of the scheme in a case file.
    fn name(&self) -> &'static str;

    /// Whether the scheme supports cells of a kind.
    fn takes(&self, _kind: CellKind) -> bool {
        true
    }

    /// Whether its functions are defined anywhere in a cell (as integration points need), not only at material points.
    fn is_of_places(&self) -> bool {
        true
    }

    /// The nodes that the points of each cell act on, for the matrix to couple; `None` where these are those of the cell. They
    /// are nodes of active cells, and depend on the grid and its active cells, not on where the points are.
    fn support(&self, _mesh: &Mesh<D>, _active: &[bool]) -> Option<Support> {
        None
    }

    /// Fills in what the points see. The weights are for the caller to write.
    fn fill(&self, points: &Located<D>, interpolation: &mut Interpolation<D>);
}

impl<const D: usize> PartialEq for dyn Basis<D> + '_ {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}
