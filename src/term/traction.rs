//! Dead tractions on named curves: `−∫ N_I t dS` over the grid as it was meshed, `t` in a fixed direction.
//!
//! The force does not follow the deformation: it acts per unit of initial area, as PLAXIS's line loads do. A traction that varies with depth has
//! that of the undeformed curve.

use super::facet_pressure::spans;
use super::{Assembly, Frame, Role, Term, Trial};
use crate::error::{Error, Result};
use crate::geometry::dot;
use crate::kinematics::Kinematics;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use crate::mesh::{Group, Mesh, height};
use crate::time_value::TimeValue;
use std::marker::PhantomData;

/// A traction on one curve in one phase.
pub struct Traction<K, const D: usize> {
    phase: usize,
    /// Traction components (kPa) in time.
    value: [TimeValue; D],
    /// `∫ N_I dS` of the nodes of the curve (m²).
    area: Vec<(u32, f64)>,
    kinematics: PhantomData<K>,
}

impl<K, const D: usize> Traction<K, D> {
    /// The traction `value` on `group` of the undeformed `mesh`, acting in `phase` only.
    pub fn new(mesh: &Mesh<D>, group: &Group, phase: usize, value: [TimeValue; D]) -> Self
    where
        K: Kinematics<D>,
    {
        Self::of_shares(Self::shares(mesh, group, None), phase, value)
    }

    /// The traction `value` in `phase` on nodes with shares of the area (m²), or of its moment ([`Self::shares`]).
    pub fn of_shares(area: Vec<(u32, f64)>, phase: usize, value: [TimeValue; D]) -> Self {
        Self { phase, value, area, kinematics: PhantomData }
    }

    /// `∫ N_I dS` (m²) of the nodes of `group` on the undeformed `mesh`, where it is not zero; with a `datum` (m) `∫ N_I ⟨datum − y⟩ dS` (m³), of
    /// what grows with the depth below it.
    pub fn shares(mesh: &Mesh<D>, group: &Group, datum: Option<f64>) -> Vec<(u32, f64)>
    where
        K: Kinematics<D>,
    {
        let mut area = vec![0.0; mesh.nodes.len()];
        for (kind, nodes) in &group.facets {
            let ends = match datum {
                Some(datum) => {
                    let heights: Vec<f64> = nodes.iter().map(|&n| height(&mesh.nodes[n as usize])).collect();
                    spans(&heights, &[datum])
                }
                None => vec![-1.0, 1.0],
            };
            for span in ends.windows(2) {
                let (middle, half) = (f64::midpoint(span[0], span[1]), 0.5 * (span[1] - span[0]));
                for (xi, weight) in rule(*kind, 2 * kind.order() + 1) {
                    let xi = if datum.is_some() { [middle + half * xi[0], 0.0, 0.0] } else { xi };
                    let mut n = [0.0; MAX_NODES];
                    kind.values(&xi, &mut n);
                    let (x, stretch) = facet_point(mesh, *kind, nodes, &xi, &n);
                    let depth = datum.map_or(1.0, |datum| half * (datum - height(&x)).max(0.0));
                    for (i, &node) in nodes.iter().enumerate() {
                        area[node as usize] += weight * stretch * K::measure(&x) * depth * n[i];
                    }
                }
            }
        }
        (0..).zip(area).filter(|(_, a)| *a != 0.0).collect()
    }
}

/// Position and length (area) ratio of a facet at `xi`.
fn facet_point<const D: usize>(
    mesh: &Mesh<D>,
    kind: CellKind,
    nodes: &[u32],
    xi: &[f64; 3],
    n: &[f64],
) -> ([f64; D], f64) {
    let mut dn = [[0.0; 3]; MAX_NODES];
    kind.derivatives(xi, &mut dn);
    let mut x = [0.0; D];
    let mut tangent = [[0.0; D]; 2];
    for (i, &node) in nodes.iter().enumerate() {
        for d in 0..D {
            let coordinate = mesh.nodes[node as usize][d];
            x[d] += n[i] * coordinate;
            tangent[0][d] += dn[i][0] * coordinate;
            tangent[1][d] += dn[i][1] * coordinate;
        }
    }
    let [a, b] = &tangent;
    let stretch =
        if kind.dimension() == 2 { (dot(a, a) * dot(b, b) - dot(a, b).powi(2)).sqrt() } else { dot(a, a).sqrt() };
    (x, stretch)
}

impl<const D: usize, K: Kinematics<D>> Term<D> for Traction<K, D> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        if trial.phase != self.phase {
            return Ok(());
        }
        let t: [f64; D] = std::array::from_fn(|d| -self.value[d].at(trial.time));
        for &(node, area) in &self.area {
            let Some((_, shares)) = frame.loaded.iter().find(|(loaded, _)| *loaded == node) else {
                add(frame, node, t.map(|t| area * t), out);
                continue;
            };
            // The material of a point load is not at its node any more.
            if shares.is_empty() {
                return Err(Error::analysis(
                    "a force at a point",
                    "the soil that it acts on is in no cell with material points",
                    "take smaller steps, or load a structure in contact with the soil",
                ));
            }
            shares.iter().for_each(|&(n, share)| add(frame, n, t.map(|t| share * (area * t)), out));
        }
        Ok(())
    }
}

/// Adds a force (kN) to the equations of a node, or of the controls of its values.
fn add<const D: usize>(frame: &Frame<D>, node: u32, force: [f64; D], out: &mut Assembly) {
    let own = [(node, 1.0)];
    for &(control, by) in frame.linear_constraints.map_or(&own[..], |all| all.of_node(node)) {
        let block = frame.block[control as usize];
        if block != u32::MAX {
            let first = frame.pattern.start[block as usize] as usize;
            for d in 0..D {
                out.force[first + d] += by * force[d];
            }
        }
    }
}
