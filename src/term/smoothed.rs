//! The stiffness of the points of a cell on the functions that smooth its gradients.
//!
//! The functions come in groups with the gradients `ψ_a e_j`, one function a direction. What a point has is therefore
//! known by a small matrix over the components of a gradient, by the gradients of the cell's nodes and by the `ψ_a`: a
//! third of the numbers of the matrix over all functions, which is never formed.

use crate::interpolation::{CellPoints, Entries};
use crate::kinematics::{Gradient, Kinematics};
use crate::tensor::Tensor;
use pulp::{Simd, WithSimd};

/// Nodes of the largest cell with smoothed gradients.
const MOST_NODES: usize = 9;
/// Points whose numbers stand side by side, so that the products work on as many at once. The last ones of a cell may
/// be absent: all they have is zero.
const SIDE_BY_SIDE: usize = 4;

/// What the points of a cell keep. A row of a gradient is `D` numbers, and one for the hoop where there is one.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Nodes of the cell and groups of functions.
    own: usize,
    groups: usize,
    dimension: usize,
    hoop: bool,
}

impl Layout {
    pub fn new<const D: usize, K: Kinematics<D>>(cell_points: &CellPoints) -> Self {
        let own = cell_points.node_count as usize;
        Self { own, groups: (cell_points.function_count as usize - own) / D, dimension: D, hoop: K::HOOP }
    }

    /// Components of the gradient of a displacement: by direction and component, then the hoop.
    fn components(&self) -> usize {
        self.dimension * self.dimension + usize::from(self.hoop)
    }

    /// Numbers that a point keeps: the gradients of the nodes, the `ψ_a`, and its matrix, column by column.
    fn per_point(&self) -> usize {
        (self.dimension + usize::from(self.hoop)) * self.own + self.groups + self.components().pow(2)
    }

    /// Numbers that so many points keep.
    pub fn kept(&self, points: usize) -> usize {
        self.per_point() * points.next_multiple_of(SIDE_BY_SIDE)
    }
}

/// Writes what the point with number `k` of the cell keeps to `out`, which is for all of them, given its tangent, the
/// inverse of its deformation since the grid was restored, and its weight (m³).
pub fn keep<const D: usize, K: Kinematics<D>>(
    layout: &Layout,
    tangent: &K::Tangent,
    entries: &Entries<D>,
    inverse: &Tensor,
    weight: f64,
    k: usize,
    out: &mut [f64],
) {
    let (own, row, components) = (layout.own, D + usize::from(K::HOOP), layout.components());
    let together = layout.per_point() * SIDE_BY_SIDE;
    let out = &mut out[k / SIDE_BY_SIDE * together..][..together];
    let mut put = |number: usize, value: f64| out[number * SIDE_BY_SIDE + k % SIDE_BY_SIDE] = value;
    for i in 0..own {
        let gradient = entries.gradient(i);
        for (j, g) in gradient.g.iter().enumerate() {
            put(i * row + j, *g);
        }
        if K::HOOP {
            put(i * row + D, gradient.hoop);
        }
    }
    for a in 0..layout.groups {
        put(own * row + a, entries.gradient(own + a * D).g[0]);
    }
    let matrix = own * row + layout.groups;
    // Along each direction, then around the axis.
    let along = |j: usize| {
        let unit = std::array::from_fn(|d| if d == j { 1.0 } else { 0.0 });
        K::push_forward(&Gradient { g: unit, hoop: if j == D { 1.0 } else { 0.0 } }, inverse)
    };
    for to in 0..row {
        let column = K::column(tangent, &along(to));
        for from in 0..row {
            let block = K::block(&column, &along(from));
            // A displacement has one component around the axis.
            for d in 0..if from == D { 1 } else { D } {
                for e in 0..if to == D { 1 } else { D } {
                    put(matrix + (to * D + e) * components + from * D + d, weight * block[d][e]);
                }
            }
        }
    }
}

/// The products of a cell: forces of a field without those that the cell's own nodes exert on each other.
pub struct Products<'a, const D: usize> {
    pub layout: Layout,
    /// What the points keep, one after the other.
    pub points: &'a [f64],
    /// Values at the nodes of the cell, and of the functions beside them.
    pub own: &'a [f64],
    pub beside: &'a [f64],
    /// The forces on them, written.
    pub force: &'a mut [f64],
    pub force_beside: &'a mut [f64],
}

impl<const D: usize> WithSimd for Products<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self.layout.components() {
            4 => self.add::<S, 4>(simd),
            5 => self.add::<S, 5>(simd),
            9 => self.add::<S, 9>(simd),
            _ => self.add::<S, 10>(simd),
        }
    }
}

impl<const D: usize> Products<'_, D> {
    /// `B` components of a gradient.
    #[inline(always)]
    fn add<S: Simd, const B: usize>(self, simd: S) {
        let Layout { own, groups, .. } = self.layout;
        let (across, row) = (D * D, D + B - D * D);
        let zero = simd.splat_f64s(0.0);
        let (mut force, mut force_beside) = ([[zero; D]; MOST_NODES], [[[zero; D]; D]; MOST_NODES]);
        let (numbers, _) = S::as_simd_f64s(self.points);
        const { assert!(S::F64_LANES <= SIDE_BY_SIDE) };
        let registers = SIDE_BY_SIDE / S::F64_LANES;
        for together in numbers.chunks_exact(self.layout.per_point() * registers) {
            for register in 0..registers {
                let number = |k: usize| together[k * registers + register];
                let mut added = [zero; B];
                for (a, beside) in self.beside.chunks_exact(across).enumerate() {
                    let psi = number(own * row + a);
                    for k in 0..across {
                        added[k] = simd.mul_add_e_f64s(psi, simd.splat_f64s(beside[k]), added[k]);
                    }
                }
                let mut whole = added;
                for (i, u) in self.own.chunks_exact(D).enumerate() {
                    for j in 0..D {
                        let g = number(i * row + j);
                        for c in 0..D {
                            whole[j * D + c] = simd.mul_add_e_f64s(g, simd.splat_f64s(u[c]), whole[j * D + c]);
                        }
                    }
                    if B > across {
                        whole[across] = simd.mul_add_e_f64s(number(i * row + D), simd.splat_f64s(u[0]), whole[across]);
                    }
                }
                let (mut stress, mut stress_added) = ([zero; B], [zero; B]);
                let matrix = own * row + groups;
                for l in 0..B {
                    for k in 0..B {
                        let entry = number(matrix + l * B + k);
                        stress[k] = simd.mul_add_e_f64s(entry, whole[l], stress[k]);
                        stress_added[k] = simd.mul_add_e_f64s(entry, added[l], stress_added[k]);
                    }
                }
                for (a, force) in force_beside[..groups].iter_mut().enumerate() {
                    let psi = number(own * row + a);
                    for j in 0..D {
                        for c in 0..D {
                            force[j][c] = simd.mul_add_e_f64s(psi, stress[j * D + c], force[j][c]);
                        }
                    }
                }
                for (i, force) in force[..own].iter_mut().enumerate() {
                    for j in 0..D {
                        let g = number(i * row + j);
                        for c in 0..D {
                            force[c] = simd.mul_add_e_f64s(g, stress_added[j * D + c], force[c]);
                        }
                    }
                    if B > across {
                        force[0] = simd.mul_add_e_f64s(number(i * row + D), stress_added[across], force[0]);
                    }
                }
            }
        }
        for (to, sum) in self.force.iter_mut().zip(force.as_flattened()) {
            *to = simd.reduce_sum_f64s(*sum);
        }
        for (to, sum) in self.force_beside.iter_mut().zip(force_beside.as_flattened().as_flattened()) {
            *to = simd.reduce_sum_f64s(*sum);
        }
    }
}
