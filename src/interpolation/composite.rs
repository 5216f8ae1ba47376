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
//! strains have other gradients. The gradients that forces act through are taken to the deformed grid by the deformation that they give
//! themselves: the forces of a symmetric stress have then no moment.
//!
//! The interpolation is for cells within a body: where one of the cells that share a node with that of the point is filled by less than half by the
//! domains of the points in it, strains are those of GIMP. Nodes on the far side of such a cell have hardly a force of their own, and strains
//! that hang on them are not stable; and a force on a node that no strain hangs on would move it without resistance. At the boundary of the
//! grid the polynomial ends with it. Where it does so at a corner that enters the grid, it is linear towards both sides of the corner.

use super::gimp::{self, Gimp, Rectangle, Surroundings, slanted};
use super::{Basis, First, Interpolation, Located, Reset};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use rayon::prelude::*;

/// Distance (-) of nodes over the size of a cell below which they are at one place.
const ON_LINE: f64 = 1e-6;

/// The part (-) of a cell that must be filled for the cells beside it to have the interpolation. Points that wander change it by a quarter or so in a
/// full body of four points a cell.
const FILLED: f64 = 0.5;

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

    fn is_symmetric(&self) -> bool {
        false
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
        let (mesh, surroundings) = (points.mesh, Surroundings::of(points.mesh));
        let Some(domains) = &points.domains else {
            return gimp::fill(points, interpolation, &surroundings);
        };
        let mut held = vec![0.0; mesh.cells.len()];
        for (p, &c) in points.cell.iter().enumerate() {
            held[c as usize] += domains.get(p)[..2].iter().product::<f64>();
        }
        let filled = |c: usize| {
            let Rectangle { low, high } = surroundings.boxes[c];
            points.active[c] && held[c] >= FILLED * (high[0] - low[0]) * (high[1] - low[1])
        };
        gimp::fill(points, interpolation, &surroundings);
        interpolation.strain_gradient.resize(interpolation.gradient.len(), [0.0; 2]);
        let support = interpolation.support.clone();
        interpolation.slots().into_par_iter().for_each(|slot| {
            let cell = slot.cell_points.cell;
            let own = mesh.cells.nodes(cell as usize);
            let nodes = support.as_ref().map_or(own, |support| support.nodes(cell));
            let beside = || surroundings.beside(mesh, cell as usize).map(|c| c as usize);
            if !beside().all(filled) {
                return slot.strain_gradient.copy_from_slice(slot.gradient);
            }
            let lines = GridLines::of(mesh, cell as usize, beside(), nodes);
            let gradients = slot.strain_gradient.chunks_exact_mut(nodes.len());
            for (gradient, shape) in gradients.zip(slot.shape.chunks_exact(own.len())) {
                let term = |d| own.iter().zip(shape).map(move |(&n, shape)| shape * mesh.nodes[n as usize][d]);
                lines.gradients([0, 1].map(|d| term(d).sum()), gradient);
            }
        });
    }
}

/// The lines of the grid around a cell whose crossings are nodes.
struct GridLines {
    /// Where they are (m), ascending: up to four across each direction.
    lines: [Vec<f64>; 2],
    /// The place of each crossing in the list of nodes, row by row.
    node: Vec<usize>,
}

impl GridLines {
    /// That of a cell and the cells `beside` it; its points act on `nodes`.
    fn of(mesh: &Mesh<2>, cell: usize, beside: impl Iterator<Item = usize>, nodes: &[u32]) -> Self {
        let own = Rectangle::of(mesh, cell);
        // The far side of the cell beyond each side, before and after it along each axis, and the cells in the corners between them.
        let (mut sides, mut corners) = ([[None; 2]; 2], [[false; 2]; 2]);
        let mut taken = vec![cell];
        for other in beside {
            let Rectangle { low, high } = Rectangle::of(mesh, other);
            let at = [0, 1].map(|d| {
                let middle = 0.5 * (low[d] + high[d]);
                usize::from(middle > own.low[d]) + usize::from(middle > own.high[d])
            });
            match at {
                [1, 1] => continue,
                [1, j] => sides[1][j / 2] = Some(if j == 0 { low[1] } else { high[1] }),
                [i, 1] => sides[0][i / 2] = Some(if i == 0 { low[0] } else { high[0] }),
                [i, j] => corners[i / 2][j / 2] = true,
            }
            taken.push(other);
        }
        let known = sides;
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if known[0][i].is_some() && known[1][j].is_some() && !corners[i][j] {
                (sides[0][i], sides[1][j]) = (None, None);
            }
        }
        let lines = [0, 1].map(|d| {
            let [before, after] = sides[d];
            before.into_iter().chain([own.low[d], own.high[d]]).chain(after).collect::<Vec<f64>>()
        });
        let size = [0, 1].map(|d| own.high[d] - own.low[d]);
        let at = |x: [f64; 2]| {
            let near = |n: u32| (0..2).all(|d| (mesh.nodes[n as usize][d] - x[d]).abs() <= ON_LINE * size[d]);
            let node = taken.iter().flat_map(|&c| mesh.cells.nodes(c)).find(|&&n| near(n))?;
            nodes.iter().position(|n| n == node)
        };
        let crossings = lines[1].iter().flat_map(|&y| lines[0].iter().map(move |&x| [x, y]));
        // All of them are nodes of these cells.
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
