//! Convected particle domain interpolation: a point sees the functions of the grid averaged over a domain that its deformation gradient deforms.
//!
//! The corners of the domain are `x + F (x_c⁰ − x⁰)` (Sadeghirad, Brannon & Burghardt 2011); functions and gradients are those of
//! [`super::domain`]. For a parallelogram `x ± r₁ ± r₂`, as the paper has it, and `N_1 … N_4` at the corners they are
//!
//! ```text
//! S = ¼ Σ_c N_c,    ∇S = [(N₁ − N₃) (r₁y − r₂y, r₂x − r₁x) + (N₂ − N₄) (r₁y + r₂y, −r₁x − r₂x)]/V,    V = 4 r₁ × r₂
//! ```
//!
//! It needs values of `N` only, so that cells may have any shape. The first domain is the part of the cell that the point stands for: a
//! parallelogram in cells that are parallelograms, a triangle in triangles.

use super::domain::{self, NUMBERS, corners, deformed, first_corners};
use super::{Basis, First, Interpolation, Located, Reset};
use crate::mesh::Mesh;
use crate::points::Points;

/// The scheme.
#[derive(Clone, Copy, Debug)]
pub struct Cpdi;

impl Basis<2> for Cpdi {
    fn name(&self) -> &'static str {
        "cpdi"
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
            corners.into_iter().chain(corners)
        };
        points.domain = (0..points.len()).flat_map(numbers).flatten().collect();
    }

    fn renew_domains(&self, _: &Reset<2>, points: &mut Points<2>) -> Option<String> {
        for (numbers, f) in points.domain.chunks_exact_mut(NUMBERS).zip(&points.deformation) {
            let now = deformed(f, &corners(numbers));
            numbers[8..].copy_from_slice(now.as_flattened());
        }
        None
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        domain::fill(points, interpolation, |_, numbers| corners(&numbers[8..]));
    }
}
