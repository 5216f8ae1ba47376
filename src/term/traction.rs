//! Dead tractions on named curves: `−∫ N_I t dS` over the grid as it was meshed, `t` in a fixed direction.
//!
//! The force does not follow the deformation: it acts per unit of initial area, as PLAXIS's line loads do. A traction that varies with depth has
//! that of the undeformed curve.

use super::facet_pressure::spans;
use super::{Assembly, Frame, Role, Term, Trial};
use crate::error::{Error, Result};
use crate::expression::Expression;
use crate::geometry::dot;
use crate::kinematics::Kinematics;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use crate::mesh::{Group, Mesh, height};
use crate::time_value::{TimeValue, interpolate};
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
        Self::of_shares(Self::shares(mesh, group, &Course::Uniform), phase, value)
    }

    /// The traction `value` in `phase` on nodes with shares of the area (m²), or of its moment ([`Self::shares`]).
    pub fn of_shares(area: Vec<(u32, f64)>, phase: usize, value: [TimeValue; D]) -> Self {
        Self { phase, value, area, kinematics: PhantomData }
    }

    /// `∫ N_I c dS` of the nodes of `group` on the undeformed `mesh`, where it is not zero; `c` is the course of the traction along the curve.
    pub fn shares(mesh: &Mesh<D>, group: &Group, course: &Course) -> Vec<(u32, f64)>
    where
        K: Kinematics<D>,
    {
        let mut area = vec![0.0; mesh.nodes.len()];
        for sample in samples::<K, D>(mesh, group, course) {
            let value = course.at(&sample.place);
            sample.shares.iter().for_each(|&(n, share)| area[n as usize] += value * share);
        }
        (0..).zip(area).filter(|(_, a)| *a != 0.0).collect()
    }
}

/// How a traction varies along a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    Uniform,
    /// `⟨datum − y⟩` (m), the depth below a datum (m).
    Depth(f64),
    /// Linear between pairs of a coordinate (m), by the number of its axis, and a value, constant before the first and after the last.
    Table(usize, Vec<[f64; 2]>),
    /// A function of the place, which is sampled.
    Free,
}

impl Course {
    /// Its value at a place (m); one where that varies otherwise.
    fn at<const D: usize>(&self, x: &[f64; D]) -> f64 {
        match self {
            Self::Uniform | Self::Free => 1.0,
            Self::Depth(datum) => (datum - height(x)).max(0.0),
            Self::Table(axis, table) => interpolate(table, x[*axis]),
        }
    }

    /// The axis along which its slope jumps, and where (m).
    fn breaks<const D: usize>(&self) -> Option<(usize, Vec<f64>)> {
        match self {
            Self::Uniform | Self::Free => None,
            Self::Depth(datum) => Some((D - 1, vec![*datum])),
            Self::Table(axis, table) => Some((*axis, table.iter().map(|[at, _]| *at).collect())),
        }
    }
}

/// A place (m) on a curve, with the share (m²) of its area that each node has.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample<const D: usize> {
    pub place: [f64; D],
    pub shares: Vec<(u32, f64)>,
}

/// Degrees that are integrated beyond that of a uniform traction where it is any function.
const MORE: usize = 4;

/// The places of a rule on `group` of the undeformed `mesh` that is exact for a `course`, or to a high degree for any function.
pub fn samples<K: Kinematics<D>, const D: usize>(mesh: &Mesh<D>, group: &Group, course: &Course) -> Vec<Sample<D>> {
    let breaks = course.breaks::<D>();
    let more = if *course == Course::Free { MORE } else { 0 };
    let mut samples = Vec::new();
    for (kind, nodes) in &group.facets {
        let ends = match &breaks {
            Some((axis, breaks)) => {
                let along: Vec<f64> = nodes.iter().map(|&n| mesh.nodes[n as usize][*axis]).collect();
                spans(&along, breaks)
            }
            None => vec![-1.0, 1.0],
        };
        for span in ends.windows(2) {
            let (middle, half) = (f64::midpoint(span[0], span[1]), 0.5 * (span[1] - span[0]));
            for (xi, weight) in rule(*kind, 2 * kind.order() + 1 + more) {
                let xi = if breaks.is_some() { [middle + half * xi[0], 0.0, 0.0] } else { xi };
                let mut n = [0.0; MAX_NODES];
                kind.values(&xi, &mut n);
                let (place, stretch) = facet_point(mesh, *kind, nodes, &xi, &n);
                let area = weight * stretch * K::measure(&place) * if breaks.is_some() { half } else { 1.0 };
                samples
                    .push(Sample { place, shares: nodes.iter().zip(n).map(|(&node, n)| (node, area * n)).collect() });
            }
        }
    }
    samples
}

/// Components (kPa) of a dead traction as formulas of the place and the time; zero where there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Formulas(pub [Option<Expression>; 2]);

impl Formulas {
    /// The traction (kPa) at a place (m) and a time (s).
    ///
    /// # Errors
    /// Analysis: it has no value there.
    pub fn at<const D: usize>(&self, place: &[f64; D], time: f64) -> Result<[f64; D]> {
        let mut value = [0.0; D];
        for (value, formula) in value.iter_mut().zip(&self.0) {
            let Some(formula) = formula else { continue };
            *value = formula.at([place[0], place[1]], time);
            if !value.is_finite() {
                return Err(Error::analysis(
                    format!("the load `{formula}`"),
                    format!("its value at {place:.4?} m and {time} s of the phase is {value}"),
                    "write a formula that is a number on all of the curve and at all times of the phase",
                ));
            }
        }
        Ok(value)
    }
}

/// A traction on one curve in one phase that is a formula.
pub struct FormulaTraction<const D: usize> {
    phase: usize,
    formulas: Formulas,
    samples: Vec<Sample<D>>,
}

impl<const D: usize> FormulaTraction<D> {
    /// Of `formulas` at the places of a rule, in `phase`.
    pub fn new(samples: Vec<Sample<D>>, phase: usize, formulas: Formulas) -> Self {
        Self { phase, formulas, samples }
    }
}

impl<const D: usize> Term<D> for FormulaTraction<D> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        if trial.phase != self.phase {
            return Ok(());
        }
        for Sample { place, shares } in &self.samples {
            let traction = self.formulas.at(place, trial.time)?;
            shares.iter().for_each(|&(n, share)| add(frame, n, traction.map(|t| -share * t), out));
        }
        Ok(())
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
