//! Second-order convected particle domain interpolation: the corners of the domain of a point move with the grid.
//!
//! At a reset each corner goes from `x_c` to `x_c + Σ_I N_I(x_c) u_I`, so that domains that shared a corner share it still, and stays
//! where it is on the grid that is reset (Sadeghirad, Brannon & Guilkey 2013). Functions and gradients are those of [`super::domain`]; for
//! `N_1 … N_4` at the corners
//!
//! ```text
//! S  = Σ_c w_c N_c,    w = (6V − a − b, 6V − a + b, 6V + a + b, 6V + a − b)/24V
//! a  = (x₄ − x₁)(y₂ − y₃) − (x₂ − x₃)(y₄ − y₁),    b = (x₃ − x₄)(y₁ − y₂) − (x₁ − x₂)(y₃ − y₄)
//! ∇S = [(N₁ − N₃)(y₂ − y₄, x₄ − x₂) + (N₂ − N₄)(y₃ − y₁, x₁ − x₃)]/2V
//! ```
//!
//! So that linear fields stay exact, the centroid of the domain must be the point: the domain is shifted by what the two have come apart since the
//! reset before, which is of second order in the change of its angles. A corner outside of the active cells takes the motion of the cell of the
//! point, extended. A domain whose corners are nearly in line becomes that of CPDI, and its corners move with the grid from there.

use super::domain::{self, Corners, NUMBERS, centroid, convexity, corners, deformed, first_corners};
use super::{Basis, First, Interpolation, Located, Reset};
use crate::mesh::Mesh;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use rayon::prelude::*;

/// Least Jacobian determinant in a domain over its mean (-). At zero its corners lie on a line and beyond it overlaps itself; a step can
/// take a tenth.
const LEAST_CONVEXITY: f64 = 0.1;

/// The scheme.
#[derive(Clone, Copy, Debug)]
pub struct Cpdi2;

impl Basis<2> for Cpdi2 {
    fn name(&self) -> &'static str {
        "cpdi2"
    }

    fn refusal(&self, mesh: &Mesh<2>) -> Option<[String; 2]> {
        domain::crowded(mesh)
    }

    fn domain_size(&self) -> usize {
        NUMBERS
    }

    fn begin_domains(&self, first: &First<2>, points: &mut Points<2>) {
        let numbers = |p| {
            let corners = first_corners(first, points, p);
            corners.into_iter().chain(shifted(&corners, points.position[p]))
        };
        points.domain = (0..points.len()).flat_map(numbers).flatten().collect();
    }

    fn renew_domains(&self, before: &Reset<2>, points: &mut Points<2>) -> Option<String> {
        let Points { position, deformation, cell, domain, .. } = &mut *points;
        let renew = |(p, numbers): (usize, &mut [f64])| {
            let moved = moved(before, &corners(&numbers[8..]), cell[p]);
            let centre = centroid(&moved);
            let mut now = shifted(&moved, [0, 1].map(|d| position[p][d] - centre[d]));
            let tangled = convexity(&now) < LEAST_CONVEXITY;
            if tangled {
                now = shifted(&deformed(&deformation[p], &corners(numbers)), position[p]);
            }
            numbers[8..].copy_from_slice(now.as_flattened());
            tangled.then_some(p)
        };
        let tangled: Vec<usize> = domain.par_chunks_exact_mut(NUMBERS).enumerate().filter_map(renew).collect();
        let first = points.name(*tangled.first()?);
        Some(format!(
            "domains whose corners were nearly in line and begin again as those of cpdi: {}, the first that of {first}",
            tangled.len()
        ))
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        domain::fill(points, interpolation, |place, numbers| {
            shifted(&corners(&numbers[8..]), place.position().map(|x| -x))
        });
    }
}

fn shifted(x: &Corners, by: [f64; 2]) -> Corners {
    x.map(|x| [x[0] + by[0], x[1] + by[1]])
}

/// Where the corners of a domain have moved with the grid; `near` is a cell near the point.
fn moved(before: &Reset<2>, x: &Corners, near: u32) -> Corners {
    let Reset { mesh, locator, active, displacement } = before;
    let own = locator.locate(mesh, &centroid(x), Some(near));
    let mut n = [0.0; MAX_NODES];
    x.map(|x| {
        let at = locator.locate(mesh, &x, own.map(|(cell, _)| cell)).filter(|(cell, _)| active[*cell as usize]);
        // The map of a cell that is no parallelogram may have no place for a corner far outside: that one moves as its point does.
        let extended = || own.map(|(cell, xi)| (cell, locator.extend(mesh, cell, &x).unwrap_or(xi)));
        let Some((cell, xi)) = at.or_else(extended) else { return x };
        mesh.cells.kind[cell as usize].values(&xi, &mut n);
        let mut moved = x;
        for (&node, n) in mesh.cells.nodes(cell as usize).iter().zip(&n) {
            (0..2).for_each(|d| moved[d] += n * displacement[node as usize][d]);
        }
        moved
    })
}
