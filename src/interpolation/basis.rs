//! What a scheme of the material point method is: the functions that a point sees.

use super::{Interpolation, Support};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::system::LinearConstraints;
use std::fmt;

/// The domains of material points ([`Points::domain`]).
#[derive(Clone, Copy)]
pub struct Domains<'a, const D: usize> {
    numbers: &'a [f64],
    /// Numbers a point.
    count: usize,
    /// Finds the cells of places in the grid.
    pub locator: &'a Locator<D>,
}

impl<'a, const D: usize> Domains<'a, D> {
    /// Those of some points, if they have any.
    pub fn of(points: &'a Points<D>, locator: &'a Locator<D>) -> Option<Self> {
        let numbers = &points.domain;
        (!numbers.is_empty()).then(|| Self { numbers, count: numbers.len() / points.len(), locator })
    }

    /// The domain of point `p`.
    pub fn get(&self, p: usize) -> &'a [f64] {
        &self.numbers[p * self.count..(p + 1) * self.count]
    }
}

/// The first grid, with the points on it.
pub struct First<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    /// The parametric coordinates (-) of each point in its cell.
    pub xi: &'a [[f64; 3]],
    /// As [`Located::measure`].
    pub measure: fn(&[f64; D]) -> f64,
}

/// A grid that is reset, as it was before.
pub struct Reset<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub locator: &'a Locator<D>,
    /// The cells that took part.
    pub active: &'a [bool],
    /// The displacement (m) of its nodes since the last reset.
    pub displacement: &'a [[f64; D]],
}

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
    /// The domains of the points, where these are material points and have any.
    pub domains: Option<Domains<'a, D>>,
}

impl<'a, const D: usize> Located<'a, D> {
    /// Points in `cell` at `xi`, without domains.
    pub fn new<K: Kinematics<D>>(mesh: &'a Mesh<D>, active: &'a [bool], cell: &'a [u32], xi: &'a [[f64; 3]]) -> Self {
        Self { mesh, active, cell, xi, hoop: K::HOOP, measure: K::measure, domains: None }
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

    /// Another name of it.
    fn alias(&self) -> Option<&'static str> {
        None
    }

    /// Whether the scheme supports cells of a kind. Those of third order are there for splines.
    fn takes(&self, kind: CellKind) -> bool {
        kind.order() < 3
    }

    /// What the scheme cannot do on a mesh, and a remedy.
    fn refusal(&self, _mesh: &Mesh<D>) -> Option<[String; 2]> {
        None
    }

    /// Whether it needs the cells in their first shape. Finite elements that share nodes with the grid change the shape that it is reset to.
    fn wants_first_shape(&self) -> bool {
        false
    }

    /// Why its functions are defined at material points only, and not anywhere in a cell as integration points need; `None` where they are.
    fn of_points(&self) -> Option<&'static str> {
        (self.domain_size() > 0).then_some("averages over the domains of the material points")
    }

    /// Whether its functions are defined anywhere in a cell.
    fn is_of_places(&self) -> bool {
        self.of_points().is_none()
    }

    /// What it lacks for pore water (docs/theory.md, section 11), if anything.
    fn without_pore_water(&self) -> Option<&'static str> {
        None
    }

    /// What it lacks for a pressure field (docs/theory.md, section 10), if anything.
    fn without_pressure_field(&self) -> Option<&'static str> {
        None
    }

    /// Whether strains are taken with the gradients that forces act through. Else no force has a potential, and tangents are not symmetric.
    fn is_symmetric(&self) -> bool {
        true
    }

    /// The nodes that the points of each cell act on, for the matrix to couple; `None` where these are those of the cell. They
    /// are nodes of active cells, and depend on the grid and its active cells, not on where the points are. Points with domains act on the nodes
    /// of the cells around theirs.
    fn support(&self, mesh: &Mesh<D>, active: &[bool]) -> Option<Support> {
        (self.domain_size() > 0).then(|| Support::with_neighbours(mesh, active))
    }

    /// Numbers that describe the domain of a point ([`Points::domain`]); none for schemes whose points have no extent.
    fn domain_size(&self) -> usize {
        0
    }

    /// Writes the first domains of material points. Schemes whose points have no extent write nothing.
    fn begin_domains(&self, _first: &First<D>, _points: &mut Points<D>) {}

    /// Renews the domains at a grid reset, given the grid before it; the points have their state and their positions since. Returns a note
    /// for the log, if there is something to say.
    fn renew_domains(&self, _before: &Reset<D>, _points: &mut Points<D>) -> Option<String> {
        None
    }

    /// What the values of the nodes are of those of fewer controls, so that the functions of the controls are those of the scheme; `None`
    /// where each node has unknowns of its own, and on a mesh that is refused ([`Basis::refusal`]).
    fn constraints(&self, _mesh: &Mesh<D>) -> Option<LinearConstraints> {
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
