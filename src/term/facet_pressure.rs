//! A pressure on the boundary of finite elements, or on a curve: `−∫ p N_I n dS` over facets where they are in the trial state.
//!
//! Facets where finite elements meet the grid are among those of water: what the points there take of the pressure cancels with it. Between
//! the heights where the pressure bends the integral is exact for straight facets. Their boundary is closed, so that the pressure of water has a
//! potential, and the sum of the unsymmetric parts of the tangent is symmetric. That of a load on a curve with ends is not.

use super::hydrostatic::{Hydrostatic, Momentary};
use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use crate::system::Local;
use std::f64::consts::TAU;
use std::marker::PhantomData;

/// A pressure on facets of the cells of a mesh.
pub struct FacetPressure<K> {
    heads: Vec<Option<Hydrostatic>>,
    /// Cell and side of each facet.
    facets: Vec<(u32, u8)>,
    source: Source,
    kinematics: PhantomData<K>,
}

impl<K> FacetPressure<K> {
    /// Water: `heads[i]` acts in phase `i` on the boundary of the cells of `mesh` in which `loaded` holds.
    pub fn new(mesh: &Mesh<2>, loaded: impl Fn(usize) -> bool, heads: Vec<Option<Hydrostatic>>) -> Self {
        let facets = Faces::of(mesh).boundary.into_iter().filter(|&(c, _)| loaded(c as usize)).collect();
        Self { heads, facets, source: Source::Water, kinematics: PhantomData }
    }

    /// A load: `heads[i]` acts in phase `i` on `facets`, by their cells and sides.
    pub fn on(facets: Vec<(u32, u8)>, heads: Vec<Option<Hydrostatic>>) -> Self {
        Self { heads, facets, source: Source::Load, kinematics: PhantomData }
    }
}

/// A place on a facet: the functions of its nodes, `n dS` (m²) out of the cell, and place and weight.
pub struct Place {
    pub n: [f64; 3],
    pub slope: [f64; 3],
    pub x: [f64; 2],
    /// The normal out of the cell, as long as the facet's length by the parameter.
    pub normal: [f64; 2],
    pub weight: f64,
}

/// Where a line with the given heights (m) of its nodes (ends, then middle) crosses the heights `breaks`: ascending parameters from −1 to 1.
pub fn spans(heights: &[f64], breaks: &[f64]) -> Vec<f64> {
    let mut ends = vec![-1.0, 1.0];
    // y(s) = a + b s + c s².
    let (b, c, a) = match *heights {
        [p, q, m] => (0.5 * (q - p), 0.5 * (p + q) - m, m),
        [p, q] => (0.5 * (q - p), 0.0, 0.5 * (p + q)),
        _ => return ends,
    };
    for &height in breaks {
        let root = (b * b - 4.0 * c * (a - height)).max(0.0).sqrt();
        let q = -0.5 * (b + root.copysign(b));
        ends.extend([q / c, (a - height) / q].into_iter().filter(|s| s.abs() < 1.0));
    }
    ends.sort_by(f64::total_cmp);
    ends
}

/// Calls `action` at the places of a rule for the facet with nodes at `x` (ends, then middle), cut at the heights
/// `breaks`.
pub fn integrate(x: &[[f64; 2]], breaks: &[f64], mut action: impl FnMut(&Place)) {
    let kind = if x.len() == 3 { CellKind::Line3 } else { CellKind::Line2 };
    let mut heights = [0.0; 3];
    heights.iter_mut().zip(x).for_each(|(y, x)| *y = x[1]);
    let ends = spans(&heights[..x.len()], breaks);
    let mut derivatives = [[0.0; 3]; MAX_NODES];
    for piece in ends.windows(2).filter(|piece| piece[1] > piece[0]) {
        let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
        for (xi, weight) in rule(CellKind::Line2, 9) {
            let s = [middle + half * xi[0], 0.0, 0.0];
            let mut place =
                Place { n: [0.0; 3], slope: [0.0; 3], x: [0.0; 2], normal: [0.0; 2], weight: half * weight };
            kind.values(&s, &mut place.n);
            kind.derivatives(&s, &mut derivatives);
            for (i, x) in x.iter().enumerate() {
                place.slope[i] = derivatives[i][0];
                for d in 0..2 {
                    place.x[d] += place.n[i] * x[d];
                }
                place.normal[0] += place.slope[i] * x[1];
                place.normal[1] -= place.slope[i] * x[0];
            }
            action(&place);
        }
    }
}

/// Adds force and tangent of a pressure on one facet; `at` are the places of its nodes among those of the local
/// matrix, `share` what the displacement of the trial state moves it by.
fn add<K: Kinematics<2>>(head: &Momentary, x: &[[f64; 2]], at: &[usize], share: f64, local: &mut Local) {
    integrate(x, &head.breaks(), |place| {
        let [p, growth, _] = head.at(place.x[1]);
        let (measure, by_radius) = (K::measure(&place.x), if K::HOOP { TAU } else { 0.0 });
        for (i, &row) in at.iter().enumerate() {
            let weight = place.weight * place.n[i];
            for d in 0..2 {
                local.vector[2 * row + d] += weight * p * measure * place.normal[d];
            }
            if local.matrix.is_empty() {
                continue;
            }
            for (j, &column) in at.iter().enumerate() {
                for d in 0..2 {
                    let entry = (2 * row + d) * local.size + 2 * column;
                    let weight = share * weight;
                    // The normal is the tangent turned: δn = (δt_y, −δt_x).
                    let turned = if d == 0 { 1.0 } else { -1.0 };
                    local.matrix[entry + 1 - d] += weight * p * measure * turned * place.slope[j];
                    local.matrix[entry] += weight * p * by_radius * place.n[j] * place.normal[d];
                    local.matrix[entry + 1] += weight * growth * measure * place.n[j] * place.normal[d];
                }
            }
        }
    });
}

impl<K: Kinematics<2>> Term<2> for FacetPressure<K> {
    fn source(&self) -> Source {
        self.source
    }

    fn symmetric(&self) -> bool {
        self.source == Source::Water
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        let Some(head) = self.heads.get(trial.phase).and_then(Option::as_ref) else { return Ok(()) };
        let head = head.at(trial.time).sharp();
        let compute = |&(cell, side): &(u32, u8), local: &mut Local| {
            let nodes = frame.mesh.cells.nodes(cell as usize);
            let facet = frame.mesh.cells.kind[cell as usize].facets().1[side as usize];
            let mut x = [[0.0; 2]; 3];
            for (x, &i) in x.iter_mut().zip(facet) {
                let n = nodes[i] as usize;
                *x = [0, 1].map(|d| frame.mesh.nodes[n][d] + trial.between[n][d]);
            }
            add::<K>(&head, &x[..facet.len()], facet, 1.0 - trial.alpha_f, local);
            Ok(())
        };
        let coupling = |&(cell, _): &(u32, u8)| frame.coupling[cell as usize] as usize;
        out.scatter(frame.pattern, &self.facets, coupling, compute)
    }
}
