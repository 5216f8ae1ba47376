//! The consistent mass matrix `M + P` of the mapping to the nodes and its regularisation (docs/theory.md, section 4, eq. 11 and 11a).
//!
//! `M = Σ_p m_p N_I N_J` is singular or nearly so where cells hold few points or a sliver of the body. The ghost penalty on the
//! velocity `P`, `10⁻⁴ ρ h² ∫ (h [∂_n v]² + h³ [∂_nn v]²)` over the faces of such cells, continues the velocity of the
//! neighbours there. It does not act on linear velocity fields. Nodes
//! without a point or such a face nearby stay at rest.
//!
//! Points that are few, or crowded in a part of a cell, leave polynomials of low degree undetermined even then, or nearly so: a velocity that
//! is small at the points may be large at nodes far from them. So the cells with points or such faces, and those whose nodes all have mass of points in
//! cells beside them, have a penalty on the curvature, and
//! those with fewer points than nodes a far weaker one on the gradient: `ρ ∫ (ε₂ h⁴ ∇∇N_I:∇∇N_J + ε₁ h² ∇N_I·∇N_J)` with `ε₂ =` [`CURVATURE`] and `ε₁ =` [`GRADIENT`]. Two further
//! solutions remove its effect where the points determine the motion (iterated Tikhonov regularisation). Of a motion that is quadratic in a
//! square cell of width `l`, evenly spread points determine `1/720 ρ l⁴` times its squared curvature. With `α = 720 ε₂ h⁴/l⁴`, `h = √2 l` being
//! the diagonal, the fraction `(α/(1 + α))²` of it is lost: 8·10⁻⁴, and three quarters where the points are in a third of the width.
//!
//! The inertia of a step has the mass of the integration points, elsewhere in the cells than that of the material points. Motions that these hardly see
//! might have any energy there. So the integration points take part with [`SEEN`] of their mass and the motion that is fitted at them; the further
//! solutions remove its effect where the material points determine the motion.

use super::family::{Family, System};
use super::grid::Grid;
use super::relax;
use super::rigid;
use super::scene::Scene;
use super::state::State;
use crate::error::{Error, Result};
use crate::interpolation::{CellPoints, Interpolation, Jump};
use crate::kinematics::Kinematics;
use crate::mesh::shape::{MAX_NODES, map_second, rule};
use crate::mesh::{Mesh, cell_size};
use crate::quadrature::Samples;
use crate::system::{Method, scatter};
use crate::term::MASS_PENALTY;
use rayon::prelude::*;

/// `ε₁` (-).
const GRADIENT: f64 = 1e-10;
/// The same in the first acceleration (-), for cells whose points are fewer than their corners: they do not even see all linear motions, on which the
/// forces that are divided by the mass may be anything. It makes the mass of a right triangle with one point its consistent one: the variance of its
/// places is `l²/18` along legs `l`, and `h² = 2 l²`.
const GRADIENT_OF_FORCES: f64 = 1.0 / 36.0;
/// `ε₂` (-).
const CURVATURE: f64 = 1e-5;

/// The weak mass of the integration points (-), over their own.
pub const SEEN: f64 = 0.1;

/// The integration points, where they know of the motion that is mapped.
pub fn seen<const D: usize>(state: &State<D>) -> Option<&Samples<D>> {
    state.weights.samples.as_ref().filter(|samples| !samples.motion.is_empty())
}

/// The points whose mass it is: material points for the mapping (eq. 11), integration points for the first acceleration.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Carrier {
    MaterialPoints,
    IntegrationPoints,
}

/// The mass of the points on the nodes, factorised.
pub struct Mass<'a> {
    system: &'a mut System,
    factorised: bool,
    /// The weak penalty on the gradient, cell by cell, with the weak mass of the integration points, and the penalty on the curvature.
    weak: [Vec<Weak>; 2],
}

/// The weak penalty of a cell.
struct Weak {
    coupling: usize,
    /// Row-major over the nodes of the cell, or over its controls.
    form: Vec<f64>,
}

impl<'a> Mass<'a> {
    /// Assembles the mass where the points are.
    ///
    /// # Errors
    /// When the scene has no dynamic phase.
    pub fn assemble<const D: usize, K: Kinematics<D>>(
        scene: &Scene<D>,
        grid: &'a mut Grid<D>,
        state: &State<D>,
        carrier: Carrier,
    ) -> Result<Self> {
        let Some(system) = grid.mass.as_mut() else {
            return Err(Error::analysis("transfer", "a scene without dynamic phases has no mass system", ""));
        };
        system.matrix.clear();
        let mut unused = vec![0.0; system.pattern.len()];
        let (interpolation, points) = match (carrier, &grid.interpolations.material) {
            (Carrier::MaterialPoints, Some(interpolation)) => (interpolation, &state.points),
            _ => (&grid.interpolations.integration, state.integration()),
        };
        let coupling = &grid.coupling;
        let mesh = relax::mesh(scene, grid.relaxed.as_ref()).0;
        let soil = Family { mesh: &scene.mesh, interpolation, coupling, points };
        let elements = grid.elements.iter().map(|elements| elements.family(&state.fem));
        for Family { interpolation, coupling, points, .. } in std::iter::once(soil).chain(elements) {
            scatter(
                &system.pattern,
                &interpolation.filled,
                |cell_points| coupling[cell_points.cell as usize] as usize,
                |cell_points, local| {
                    for entries in interpolation.entries::<K>(cell_points) {
                        let m = points.mass[entries.point];
                        for (i, ni) in entries.value.iter().enumerate() {
                            for (j, nj) in entries.value.iter().enumerate() {
                                local.matrix[i * local.size + j] += m * ni * nj;
                            }
                        }
                    }
                    Ok(())
                },
                &mut unused,
                Some(&mut system.matrix),
                &mut grid.workspace,
            )?;
        }
        scatter(
            &system.pattern,
            &grid.ghost,
            |ghost| ghost.coupling as usize,
            |ghost, local| {
                let jump = Jump::of::<D, K>(mesh, &ghost.between);
                let scale = MASS_PENALTY * scene.density_scale * jump.size * jump.size;
                for (entry, form) in local.matrix.iter_mut().zip(&jump.form) {
                    *entry = scale * form;
                }
                Ok(())
            },
            &mut unused,
            Some(&mut system.matrix),
            &mut grid.workspace,
        )?;
        rigid::add_mass(scene, &grid.dofs.block, &system.pattern, &mut system.matrix);
        let points_in = |cell: u32| interpolation.points_in(cell).len();
        let mut cells: Vec<u32> = interpolation.filled.iter().map(|cell_points| cell_points.cell).collect();
        cells.extend(grid.ghost.iter().flat_map(|ghost| ghost.between.cells));
        cells.extend(reached::<D, K>(mesh, interpolation, &grid.cells));
        cells.sort_unstable();
        cells.dedup();
        let few: Vec<u32> =
            cells.iter().copied().filter(|&c| points_in(c) < mesh.cells.nodes(c as usize).len()).collect();
        let gradient = |cell: u32| match carrier {
            Carrier::IntegrationPoints if (1..mesh.cells.corners(cell as usize).len()).contains(&points_in(cell)) => {
                GRADIENT_OF_FORCES
            }
            _ => GRADIENT,
        };
        let mut weak = [(&few, true), (&cells, false)].map(|(cells, few)| {
            let of_cell = |&cell: &u32| {
                let shares = if few { [gradient(cell), 0.0] } else { [0.0, CURVATURE] };
                let factors = shares.map(|share| share * scene.density_scale);
                let coupling = coupling[cell as usize] as usize;
                let form = system.pattern.over_blocks(coupling, weak_form::<D, K>(mesh, cell as usize, factors));
                Weak { coupling, form }
            };
            cells.par_iter().with_min_len(64).map(of_cell).collect::<Vec<_>>()
        });
        if let (Carrier::MaterialPoints, Some(samples)) = (carrier, seen(state)) {
            let interpolation = &grid.interpolations.integration;
            let of_cell = |cell_points: &CellPoints| {
                let size = interpolation.nodes(mesh, cell_points.cell).len();
                let mut form = vec![0.0; size * size];
                for entries in interpolation.entries::<K>(cell_points) {
                    let m = SEEN * samples.points.mass[entries.point];
                    for (row, ni) in form.chunks_exact_mut(size).zip(entries.value) {
                        row.iter_mut().zip(entries.value).for_each(|(form, nj)| *form += m * ni * nj);
                    }
                }
                let coupling = coupling[cell_points.cell as usize] as usize;
                Weak { coupling, form: system.pattern.over_blocks(coupling, form) }
            };
            weak[0].par_extend(interpolation.filled.par_iter().with_min_len(64).map(of_cell));
        }
        for Weak { coupling, form } in weak.iter().flatten() {
            // The coupling may hold more nodes, behind those of the cell.
            let size = system.pattern.coupling_size(*coupling);
            let mut padded = vec![0.0; size * size];
            let own = form.len().isqrt();
            for (row, form) in padded.chunks_exact_mut(size).zip(form.chunks_exact(own)) {
                row[..own].copy_from_slice(form);
            }
            system.matrix.add(&system.pattern, *coupling, &padded, size);
        }
        let scale = system.matrix.scale(&system.pattern);
        for &diagonal in &system.pattern.column[..system.pattern.len()] {
            // The lower triangle: a column begins with its diagonal entry.
            let value = &mut system.matrix.values[diagonal as usize];
            if *value == 0.0 {
                *value = scale;
            }
        }
        Ok(Self { system, factorised: false, weak })
    }

    /// Solves `M x = b` for one component, `b` given in `x` and the momentum of the weak mass in `weak`, one entry for each active node.
    ///
    /// The first further solution removes the effect of the weak mass and of the penalty on the gradient, the second that of all. Otherwise the
    /// effect of the first would remain at nodes that only the penalty on the curvature determines.
    ///
    /// # Errors
    /// An analysis error when the mass is singular.
    pub fn solve(&mut self, x: &mut [f64], weak: &[f64]) -> Result<()> {
        let given = x.to_vec();
        x.iter_mut().zip(weak).for_each(|(x, weak)| *x += weak);
        self.solve_once(x)?;
        for parts in [..1, ..2] {
            let mut right = given.clone();
            for Weak { coupling, form } in self.weak[parts].iter().flatten() {
                let blocks = self.system.pattern.connectivity.blocks(*coupling);
                let own = form.len().isqrt();
                for (row, &a) in form.chunks_exact(own).zip(blocks) {
                    right[a as usize] += row.iter().zip(blocks).map(|(form, &b)| form * x[b as usize]).sum::<f64>();
                }
            }
            x.copy_from_slice(&right);
            self.solve_once(x)?;
        }
        Ok(())
    }

    fn solve_once(&mut self, x: &mut [f64]) -> Result<()> {
        let System { pattern, matrix, solver } = &mut *self.system;
        if self.factorised {
            return solver.solve_again(pattern, matrix, x);
        }
        let method = solver.solve(pattern, matrix, x)?;
        // Of a right-hand side of zeros nothing is factorised.
        self.factorised = method == Method::Cholesky && x.iter().any(|&v| v != 0.0);
        Ok(())
    }

    /// Solves `M x = b` with `x` as in `given` at the nodes marked in `fixed`.
    ///
    /// # Errors
    /// As [`Mass::solve`].
    pub fn solve_given(&mut self, fixed: &[bool], given: &[f64], x: &mut [f64]) -> Result<()> {
        let System { pattern, matrix, solver } = &mut *self.system;
        let mut held = crate::system::Matrix { values: matrix.values.clone(), ..Default::default() };
        let scale = held.scale(pattern);
        held.constrain(pattern, fixed, given, scale, x);
        self.factorised = false;
        solver.solve(pattern, &held, x).map(|_| ())
    }
}

/// The acceleration of the nodes (m/s²) by minus a force (kN, one entry an equation), `(M + P) a = −f`; zero where the displacement is prescribed.
pub fn accelerations<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    force: &[f64],
) -> Result<Vec<[f64; D]>> {
    let mut fixed = vec![[false; D]; scene.displacements()];
    for f in scene.fixed(state.phase) {
        for &n in &f.nodes {
            fixed[n as usize][f.component] = true;
        }
    }
    let node = grid.dofs.node.clone();
    let mut mass = Mass::assemble::<D, K>(scene, grid, state, Carrier::IntegrationPoints)?;
    let mut solution = Vec::with_capacity(D);
    for d in 0..D {
        let held: Vec<bool> = node.iter().map(|&n| fixed[n as usize][d]).collect();
        let mut x: Vec<f64> = (0..node.len()).map(|b| -force[b * D + d]).collect();
        mass.solve_given(&held, &vec![0.0; node.len()], &mut x)?;
        solution.push(x);
    }
    let mut acceleration = vec![[0.0; D]; scene.displacements()];
    solution.iter().enumerate().for_each(|(d, x)| grid.dofs.write(x, d, &mut acceleration));
    Ok(acceleration)
}

/// The cells among `active` whose nodes all have mass of points, for schemes in which points act beyond their cells: the mass of such a node
/// may be as little as rounding.
fn reached<const D: usize, K: Kinematics<D>>(
    mesh: &Mesh<D>,
    interpolation: &Interpolation<D>,
    active: &[u32],
) -> Vec<u32> {
    if interpolation.support.is_none() {
        return Vec::new();
    }
    let mut has_mass = vec![false; mesh.nodes.len()];
    for cell_points in &interpolation.filled {
        let nodes = interpolation.nodes(mesh, cell_points.cell);
        for entries in interpolation.entries::<K>(cell_points) {
            nodes.iter().zip(entries.value).for_each(|(&n, value)| has_mass[n as usize] |= *value != 0.0);
        }
    }
    active.iter().copied().filter(|&c| mesh.cells.nodes(c as usize).iter().all(|&n| has_mass[n as usize])).collect()
}

/// `∫ (b h⁴ ∇∇N_I:∇∇N_J + a h² ∇N_I·∇N_J)` of a cell, row-major, given `a` and `b` (t/m³).
fn weak_form<const D: usize, K: Kinematics<D>>(mesh: &Mesh<D>, cell: usize, [a, b]: [f64; 2]) -> Vec<f64> {
    let (kind, x) = (mesh.cells.kind[cell], mesh.coordinates(cell));
    let square = cell_size(mesh, cell).powi(2);
    let (mut value, mut gradient, mut second) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES], [[[0.0; D]; D]; MAX_NODES]);
    let count = kind.node_count();
    let mut form = vec![0.0; count * count];
    for (xi, weight) in rule(kind, 2 * kind.order()) {
        kind.values(&xi, &mut value);
        let determinant = map_second(kind, &x[..count], &xi, &mut gradient, &mut second);
        let place: [f64; D] = std::array::from_fn(|d| value.iter().zip(&x).take(count).map(|(n, x)| n * x[d]).sum());
        let scale = square * weight * determinant * K::measure(&place);
        for i in 0..count {
            for j in 0..count {
                let slope: f64 = gradient[i].iter().zip(&gradient[j]).map(|(p, q)| p * q).sum();
                let bend: f64 = (0..D)
                    .flat_map(|k| (0..D).map(move |l| (k, l)))
                    .map(|(k, l)| second[i][k][l] * second[j][k][l])
                    .sum();
                form[i * count + j] += scale * (a * slope + b * square * bend);
            }
        }
    }
    form
}

#[cfg(test)]
mod tests;
