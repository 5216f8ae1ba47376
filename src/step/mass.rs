//! The mass of the points on the nodes: consistent, and regular however the points lie.
//!
//! `Σ_p m_p N_I N_J` is singular or nearly so where cells hold few points or a sliver of the body. A ghost
//! penalty on the velocity, `γ_m ρ h² ∫ (h [∂_n v]² + h³ [∂_nn v]²)` over the faces of such cells, continues there
//! what the neighbours move like. It leaves linear velocity fields alone, so that what is mapped keeps linear and
//! angular momentum. Nodes that no point and no such face reaches have nothing to move and stay at rest.
//!
//! Few points on their own leave polynomials of low degree undetermined also then. A far weaker gradient penalty
//! `ε ρ h² ∫ ∇N_I·∇N_J` in cells with fewer points than nodes decides these, and a second solution that takes it
//! back to the first one (iterated Tikhonov regularisation) removes it from all that the points do determine.

use super::determined::undetermined;
use super::grid::{Family, Grid, System};
use super::rigid;
use super::scene::Scene;
use super::state::State;
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::cell_size;
use crate::stencil::{Jump, integrate};
use crate::system::{Method, scatter};
use crate::term::MASS_PENALTY;

/// `ε` (-).
const WEAK: f64 = 1e-10;

/// Whose mass it is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Carrier {
    MaterialPoints,
    IntegrationPoints,
}

/// The mass of the points on the nodes, factorised.
pub struct Mass<'a> {
    system: &'a mut System,
    factorised: bool,
    weak: Vec<Weak>,
}

/// The weak penalty of a cell.
struct Weak {
    clique: usize,
    /// Row-major over the nodes of the cell.
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
        let integration = &grid.stencils.integration;
        let (stencil, points, parametric) = match (carrier, &grid.stencils.material, &state.weighing.samples) {
            (Carrier::MaterialPoints, Some(stencil), _) => (stencil, &state.points, &state.parametric),
            (_, _, Some(samples)) => (integration, &samples.points, &samples.parametric),
            _ => (integration, &state.points, &state.parametric),
        };
        let clique = &grid.clique;
        let mesh = grid.relaxed.as_ref().map_or(&scene.mesh, |relaxed| &relaxed.mesh);
        let soil = Family { mesh: &scene.mesh, stencil, clique, points };
        let elements = grid.elements.iter().map(|elements| elements.family(&state.fem));
        for Family { stencil, clique, points, .. } in std::iter::once(soil).chain(elements) {
            scatter(
                &system.pattern,
                &stencil.patches,
                |patch| clique[patch.cell as usize] as usize,
                |patch, local| {
                    for entries in stencil.entries::<K>(patch) {
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
            |ghost| ghost.clique as usize,
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
        rigid::add_mass(scene, &grid.block, &system.pattern, &mut system.matrix);
        let weak: Vec<Weak> = undetermined(&scene.mesh, &points.cell, parametric)
            .into_iter()
            .map(|cell| Weak {
                clique: clique[cell as usize] as usize,
                form: weak_form::<D, K>(scene, cell as usize),
            })
            .collect();
        for Weak { clique, form } in &weak {
            // The clique may hold more nodes, behind those of the cell.
            let size = system.pattern.clique_size(*clique);
            let mut padded = vec![0.0; size * size];
            let own = form.len().isqrt();
            for (row, form) in padded.chunks_exact_mut(size).zip(form.chunks_exact(own)) {
                row[..own].copy_from_slice(form);
            }
            system.matrix.add(&system.pattern, *clique, &padded, size);
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

    /// Solves `M x = b` for one component, `b` given in `x`, one entry a node that takes part.
    ///
    /// # Errors
    /// An analysis error when the mass is singular.
    pub fn solve(&mut self, x: &mut [f64]) -> Result<()> {
        let mut again = x.to_vec();
        self.solve_once(x)?;
        if self.weak.is_empty() {
            return Ok(());
        }
        for Weak { clique, form } in &self.weak {
            let blocks = self.system.pattern.cliques.blocks(*clique);
            let own = form.len().isqrt();
            for (row, &a) in form.chunks_exact(own).zip(blocks) {
                again[a as usize] += row.iter().zip(blocks).map(|(form, &b)| form * x[b as usize]).sum::<f64>();
            }
        }
        self.solve_once(&mut again)?;
        x.copy_from_slice(&again);
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

    /// Solves `M x = b` with `x = 0` at the nodes marked in `fixed`. The mass is spent afterwards.
    ///
    /// # Errors
    /// As [`Mass::solve`].
    pub fn solve_held(&mut self, fixed: &[bool], x: &mut [f64]) -> Result<()> {
        let System { pattern, matrix, solver } = &mut *self.system;
        let mut held = crate::system::Matrix { values: matrix.values.clone(), ..Default::default() };
        let (zero, scale) = (vec![0.0; x.len()], held.scale(pattern));
        held.constrain(pattern, fixed, &zero, scale, x);
        self.factorised = false;
        solver.solve(pattern, &held, x).map(|_| ())
    }
}

/// `ε ρ h² ∫ ∇N_I·∇N_J` of a cell, row-major.
fn weak_form<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, cell: usize) -> Vec<f64> {
    let scale = WEAK * scene.density_scale * cell_size(&scene.mesh, cell).powi(2);
    let count = scene.mesh.cells.nodes(cell).len();
    let mut form = vec![0.0; count * count];
    integrate::<D, K>(&scene.mesh, cell, |weight, _, g| {
        for a in 0..count {
            for b in 0..count {
                let dot: f64 = (0..D).map(|d| g[a][d] * g[b][d]).sum();
                form[a * count + b] += scale * weight * dot;
            }
        }
    });
    form
}

#[cfg(test)]
mod tests;
