//! The stiffness of the points of a patch on the functions that smooth its gradients.
//!
//! The functions come in groups with the gradients `ψ_a e_j`, one function a direction. What a point has is therefore
//! known by a small matrix over the components of a gradient, by the gradients of the cell's nodes and by the `ψ_a`: a
//! third of the numbers of the matrix over all functions, which is never formed.

use crate::kinematics::{Gradient, Kinematics};
use crate::stencil::{Entries, Patch};
use pulp::{Simd, WithSimd};

/// What the points of a patch keep. A row of a gradient is `D` numbers, and one for the hoop where there is one.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Nodes of the cell and groups of functions.
    own: usize,
    groups: usize,
    dimension: usize,
    hoop: bool,
}

impl Layout {
    pub fn new<const D: usize, K: Kinematics<D>>(patch: &Patch) -> Self {
        let own = patch.node_count as usize;
        Self { own, groups: (patch.function_count as usize - own) / D, dimension: D, hoop: K::HOOP }
    }

    /// Components of the gradient of a displacement: by direction and component, then the hoop.
    fn components(&self) -> usize {
        self.dimension * self.dimension + usize::from(self.hoop)
    }

    /// Numbers that a point keeps: the gradients of the nodes, the `ψ_a`, and its matrix, column by column.
    pub fn per_point(&self) -> usize {
        (self.dimension + usize::from(self.hoop)) * self.own + self.groups + self.components().pow(2)
    }
}

/// Writes what a point keeps, given its tangent, the inverse of its deformation since the grid was restored, and its
/// weight (m³).
pub fn keep<const D: usize, K: Kinematics<D>>(
    layout: &Layout,
    tangent: &K::Tangent,
    entries: &Entries<D>,
    inverse: &crate::tensor::Tensor,
    weight: f64,
    out: &mut [f64],
) {
    let (own, components) = (layout.own, layout.components());
    let (gradients, rest) = out.split_at_mut((D + usize::from(K::HOOP)) * own);
    let (psi, matrix) = rest.split_at_mut(layout.groups);
    for (i, to) in gradients.chunks_exact_mut(D + usize::from(K::HOOP)).enumerate() {
        let gradient = entries.gradient(i);
        to[..D].copy_from_slice(&gradient.g);
        if K::HOOP {
            to[D] = gradient.hoop;
        }
    }
    for (a, psi) in psi.iter_mut().enumerate() {
        *psi = entries.gradient(own + a * D).g[0];
    }
    // Along each direction, then around the axis.
    let along = |j: usize| {
        let unit = std::array::from_fn(|d| if d == j { 1.0 } else { 0.0 });
        K::push_forward(&Gradient { g: unit, hoop: if j == D { 1.0 } else { 0.0 } }, inverse)
    };
    let directions = D + usize::from(K::HOOP);
    for to in 0..directions {
        let column = K::column(tangent, &along(to));
        for from in 0..directions {
            let block = K::block(&column, &along(from));
            // A displacement has one component around the axis.
            for d in 0..if from == D { 1 } else { D } {
                for e in 0..if to == D { 1 } else { D } {
                    matrix[(to * D + e) * components + from * D + d] = weight * block[d][e];
                }
            }
        }
    }
}

/// The products of a patch: forces of a field without those that the cell's own nodes exert on each other.
pub struct Products<'a, const D: usize> {
    pub layout: Layout,
    /// What the points keep, one after the other.
    pub points: &'a [f64],
    /// Values at the nodes of the cell, and of the functions beside them.
    pub own: &'a [f64],
    pub beside: &'a [f64],
    /// The forces on them, added to.
    pub force: &'a mut [f64],
    pub force_beside: &'a mut [f64],
}

impl<const D: usize> WithSimd for Products<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match self.layout.components() {
            4 => self.add::<4>(),
            5 => self.add::<5>(),
            9 => self.add::<9>(),
            _ => self.add::<10>(),
        }
    }
}

impl<const D: usize> Products<'_, D> {
    /// `B` components of a gradient.
    #[inline(always)]
    fn add<const B: usize>(self) {
        let Layout { own, groups, .. } = self.layout;
        let (across, row) = (D * D, D + B - D * D);
        for point in self.points.chunks_exact(self.layout.per_point()) {
            let (gradients, rest) = point.split_at(row * own);
            let (psi, matrix) = rest.split_at(groups);
            let mut added = [0.0; B];
            for (psi, beside) in psi.iter().zip(self.beside.chunks_exact(across)) {
                for k in 0..across {
                    added[k] += psi * beside[k];
                }
            }
            let mut whole = added;
            for (g, u) in gradients.chunks_exact(row).zip(self.own.chunks_exact(D)) {
                for j in 0..D {
                    for c in 0..D {
                        whole[j * D + c] += g[j] * u[c];
                    }
                }
                if B > across {
                    whole[across] += g[D] * u[0];
                }
            }
            let (mut stress, mut stress_added) = ([0.0; B], [0.0; B]);
            for ((column, whole), added) in matrix.chunks_exact(B).zip(&whole).zip(&added) {
                for k in 0..B {
                    stress[k] += column[k] * whole;
                    stress_added[k] += column[k] * added;
                }
            }
            for (psi, force) in psi.iter().zip(self.force_beside.chunks_exact_mut(across)) {
                for k in 0..across {
                    force[k] += psi * stress[k];
                }
            }
            for (g, force) in gradients.chunks_exact(row).zip(self.force.chunks_exact_mut(D)) {
                for j in 0..D {
                    for c in 0..D {
                        force[c] += g[j] * stress_added[j * D + c];
                    }
                }
                if B > across {
                    force[0] += g[D] * stress_added[across];
                }
            }
        }
    }
}
