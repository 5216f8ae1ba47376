//! Composite material points: strains of an interpolation over a cell and its neighbours, forces of generalised interpolation
//! (González Acosta, Vardon, Remmerswaal & Hicks 2020; the interpolation: González Acosta, Vardon & Hicks 2017).
//!
//! The displacement that a point sees is the polynomial through the nodes of its cell and of the cells beside it, the tensor product of
//!
//! ```text
//! u(x) = Σ_i L_i(x) u_i,    L_i(x) = Π_{j≠i} (x − x_j)/(x_i − x_j)
//! ```
//!
//! over the four lines of the grid around the point: of third degree, of second one where the grid ends on one side, linear where it does on
//! both. Its gradient gives the strain, with an error of third order where that of the cell alone has one of first order. Forces act through
//! the functions `S` and gradients `∇S` of GIMP with domains that are stretched ([`Gimp::STRETCHED`]), and so do mass, motion and hoop strain.
//!
//! The paper's third part, a stiffness that is summed over the Gauss points of a cell, is left out: it has a share in the iterations
//! only and not in the state they converge to. Here the tangent is the derivative of the residual, which is not symmetric, as forces and
//! strains have other gradients.
//!
//! The patch takes in the line beyond a side of the cell where both nodes of the side have a neighbour there. Where two such lines cross in no
//! node, at a corner that enters the grid, neither is taken.

use super::gimp::{Gimp, Rectangle, slanted};
use super::{Basis, First, Interpolation, Located, Reset, Support};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use rayon::prelude::*;

/// Distance (-) of nodes over the size of a cell below which they are on one line.
const ON_LINE: f64 = 1e-6;

/// The scheme. Domains are those of [`Gimp::STRETCHED`].
#[derive(Clone, Copy, Debug)]
pub struct Composite;

impl Basis<2> for Composite {
    fn name(&self) -> &'static str {
        "composite"
    }

    fn takes(&self, kind: CellKind) -> bool {
        kind == CellKind::Q4
    }

    fn refusal(&self, mesh: &Mesh<2>) -> Option<[String; 2]> {
        slanted(mesh)
    }

    fn wants_first_shape(&self) -> bool {
        true
    }

    fn of_points(&self) -> Option<&'static str> {
        Some("averages over the domains of the material points")
    }

    fn is_symmetric(&self) -> bool {
        false
    }

    fn support(&self, mesh: &Mesh<2>, active: &[bool]) -> Option<Support> {
        Gimp::STRETCHED.support(mesh, active)
    }

    fn domain_size(&self) -> usize {
        Basis::<2>::domain_size(&Gimp::STRETCHED)
    }

    fn begin_domains(&self, first: &First<2>, points: &mut Points<2>) {
        Gimp::STRETCHED.begin_domains(first, points);
    }

    fn renew_domains(&self, before: &Reset<2>, points: &mut Points<2>) -> Option<String> {
        Gimp::STRETCHED.renew_domains(before, points)
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        Gimp::STRETCHED.fill(points, interpolation);
        interpolation.strain_gradient.resize(interpolation.gradient.len(), [0.0; 2]);
        let support = interpolation.support.clone();
        interpolation.slots().into_par_iter().for_each(|slot| {
            let cell = slot.cell_points.cell;
            let own = points.mesh.cells.nodes(cell as usize);
            let nodes = support.as_ref().map_or(own, |support| support.nodes(cell));
            let patch = Patch::of(points.mesh, cell as usize, nodes);
            let gradients = slot.strain_gradient.chunks_exact_mut(nodes.len());
            for (gradient, shape) in gradients.zip(slot.shape.chunks_exact(own.len())) {
                let term = |d| own.iter().zip(shape).map(move |(&n, shape)| shape * points.mesh.nodes[n as usize][d]);
                patch.gradients([0, 1].map(|d| term(d).sum()), gradient);
            }
        });
    }
}

/// The lines of the grid around a cell whose crossings are nodes.
struct Patch {
    /// Where they are (m), ascending: up to four across each direction.
    lines: [Vec<f64>; 2],
    /// The place of each crossing in the list of nodes, row by row.
    node: Vec<usize>,
}

impl Patch {
    /// That of a cell whose points act on `nodes`.
    fn of(mesh: &Mesh<2>, cell: usize, nodes: &[u32]) -> Self {
        let Rectangle { low, high } = Rectangle::of(mesh, cell);
        let off = [0, 1].map(|d| ON_LINE * (high[d] - low[d]));
        let at = |x: [f64; 2]| {
            nodes.iter().position(|&n| (0..2).all(|d| (mesh.nodes[n as usize][d] - x[d]).abs() <= off[d]))
        };
        // The next line on either side that has nodes beside both of the side.
        let beyond = |d: usize, up: bool| {
            let across = 1 - d;
            let place = |x: f64, y: f64| if d == 0 { [x, y] } else { [y, x] };
            let found = nodes.iter().map(|&n| mesh.nodes[n as usize][d]);
            let line = if up {
                found.filter(|x| *x > high[d] + off[d]).fold(f64::INFINITY, f64::min)
            } else {
                found.filter(|x| *x < low[d] - off[d]).fold(f64::NEG_INFINITY, f64::max)
            };
            [low, high].iter().all(|end| at(place(line, end[across])).is_some()).then_some(line)
        };
        let sides = [0, 1].map(|d| [beyond(d, false), beyond(d, true)]);
        let mut taken = sides;
        for (i, x) in sides[0].into_iter().enumerate() {
            for (j, y) in sides[1].into_iter().enumerate() {
                if let (Some(x), Some(y)) = (x, y) && at([x, y]).is_none() {
                    (taken[0][i], taken[1][j]) = (None, None);
                }
            }
        }
        let lines = [0, 1].map(|d| {
            let [before, after] = taken[d];
            before.into_iter().chain([low[d], high[d]]).chain(after).collect::<Vec<f64>>()
        });
        let crossings = lines[1].iter().flat_map(|&y| lines[0].iter().map(move |&x| [x, y]));
        // All of them are nodes: those of the cell, beside its sides, and beyond its corners where both sides are taken.
        let node = crossings.filter_map(at).collect();
        Self { lines, node }
    }

    /// Writes the gradients (1/m) at a place (m), where there are zeros.
    fn gradients(&self, x: [f64; 2], gradient: &mut [[f64; 2]]) {
        let [along_x, along_y] = [0, 1].map(|d| lagrange(&self.lines[d], x[d]));
        let products = along_y.iter().flat_map(|b| along_x.iter().map(move |a| [a[1] * b[0], a[0] * b[1]]));
        for (&node, product) in self.node.iter().zip(products) {
            gradient[node] = product;
        }
    }
}

/// The Lagrange polynomials through places `t` (m) and their derivatives (1/m) at `x`.
fn lagrange(t: &[f64], x: f64) -> Vec<[f64; 2]> {
    let one = |i: usize| {
        let (mut value, mut slope) = (1.0, 0.0);
        for j in (0..t.len()).filter(|&j| j != i) {
            let width = t[i] - t[j];
            slope = (slope * (x - t[j]) + value) / width;
            value *= (x - t[j]) / width;
        }
        [value, slope]
    };
    (0..t.len()).map(one).collect()
}
