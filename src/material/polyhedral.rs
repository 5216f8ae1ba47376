//! The exact return onto a yield surface made of planes in principal space: Mohr–Coulomb, Tresca and the
//! tension cut-off.
//!
//! With the stresses sorted, `τ₁ ≥ τ₂ ≥ τ₃` (tension positive), the surface is
//!
//! ```text
//! f_ij = (1 + sin φ) τ_i − (1 − sin φ) τ_j − 2 c cos φ ≤ 0,   ij = 13 (the face), 12 and 23 (its neighbours)
//! t_i  = τ_i − σ_t ≤ 0
//! ```
//!
//! and plastic strain flows along `m_ij = (1 + sin ψ) e_i − (1 − sin ψ) e_j` and `e_i` (Koiter's rule). Since
//! both law and surface are linear, each set of active planes gives its return in one exact step (Clausen,
//! Damkilde & Andersen, *Int. J. Numer. Meth. Engng* 66 (2006) 1036–1059, and, non-associated, *Computers
//! and Structures* 85 (2007) 1795–1807; docs/theory.md, section 9):
//!
//! ```text
//! τ = τ_tr − C M λ,   (Nᵀ C M) λ = f(τ_tr),   ∂τ/∂ε = C − C M (Nᵀ C M)⁻¹ Nᵀ C
//! ```
//!
//! The sets are tried from the largest face to the corners, and the first that leaves no multiplier negative
//! and no other plane violated holds. Should rounding leave none, the least violated one does: a state is
//! always found, and in it every active plane holds to rounding. At a corner, where more planes meet than
//! there are multipliers, what is checked is that the plastic strain lies in the cone of all their flows.

use super::model::equivalent_plastic;
use super::{Moduli, Response, State};
use crate::geometry::dot;

/// Planes of a polyhedral model at one height. Stresses in kPa, tension positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Sine of the angle of friction.
    pub sin_friction: f64,
    /// Sine of the angle of dilation.
    pub sin_dilation: f64,
    /// `2 c cos φ`, the strength of the shear planes.
    pub strength: f64,
    /// Largest tension `σ_t`, at most the apex `c cot φ` where there is friction; infinite for none where
    /// there is no friction.
    pub tension: f64,
}

/// Yield within this fraction of the strength, or of rounding, counts as elastic: so a returned state is.
const TOLERANCE: f64 = 1e-12;

/// Rounding of a yield function, a fraction of the stress it is evaluated from.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A sorted return: stress, elastic strain and tangent, and by how much (kPa) its set of active planes fails
/// the conditions of Kuhn and Tucker.
struct Candidate {
    stress: [f64; 3],
    elastic_strain: [f64; 3],
    tangent: [[f64; 3]; 3],
    violation: f64,
}

impl Candidate {
    /// This return if it holds, else the less violated of the two.
    #[inline]
    fn or(self, rounding: f64, next: impl FnOnce() -> Self) -> Self {
        if self.violation <= rounding {
            return self;
        }
        let next = next();
        if next.violation < self.violation { next } else { self }
    }
}

/// A plane `n·τ ≤ r` with the flow `m`.
#[derive(Clone, Copy)]
struct Plane {
    n: [f64; 3],
    m: [f64; 3],
    r: f64,
}

impl Planes {
    /// How far stresses in any order lie outside (kPa); negative inside.
    pub fn excess(&self, stress: &[f64; 3]) -> f64 {
        let largest = stress[0].max(stress[1]).max(stress[2]);
        let smallest = stress[0].min(stress[1]).min(stress[2]);
        let shear = (1.0 + self.sin_friction) * largest - (1.0 - self.sin_friction) * smallest - self.strength;
        shear.max(largest - self.tension)
    }

    /// The response to elastic trial strains in any order.
    pub fn respond(&self, moduli: &Moduli, trial: &[f64; 3], state: &State) -> Response {
        let stress = moduli.stress(trial);
        let magnitude = stress[0].abs().max(stress[1].abs()).max(stress[2].abs());
        let rounding = ROUNDING * magnitude;
        if self.excess(&stress) <= (TOLERANCE * self.strength).max(rounding) {
            return Response::elastic(moduli, trial, state);
        }
        let order = descending(trial);
        let sorted = order.map(|k| trial[k]);
        let returned = self.sorted(moduli, &sorted, rounding);

        let plastic = std::array::from_fn(|k| sorted[k] - returned.elastic_strain[k]);
        let mut response = Response {
            stress: [0.0; 3],
            tangent: [[0.0; 3]; 3],
            elastic_strain: [0.0; 3],
            plastic_strain: state.plastic_strain + equivalent_plastic(&plastic),
            yielding: true,
        };
        for a in 0..3 {
            response.stress[order[a]] = returned.stress[a];
            response.elastic_strain[order[a]] = returned.elastic_strain[a];
            for b in 0..3 {
                response.tangent[order[a]][order[b]] = returned.tangent[a][b];
            }
        }
        response
    }

    /// The response of soil that dilates only until its plastic volume has grown by `left` (-) in the step, and by how much (-) it has grown.
    ///
    /// Where the return dilates by more, the plastic strain up to there is a share of it; what is left of the trial strain returns without dilation. Soil
    /// that opens at the apex or the tension cut-off goes on to do so.
    pub fn respond_within(&self, moduli: &Moduli, trial: &[f64; 3], state: &State, left: f64) -> (Response, f64) {
        let sum = |v: &[f64; 3]| v.iter().sum::<f64>();
        let flow_of =
            |response: &Response| -> [f64; 3] { std::array::from_fn(|k| trial[k] - response.elastic_strain[k]) };
        let whole = self.respond(moduli, trial, state);
        let flow = flow_of(&whole);
        let grown = sum(&flow);
        if !whole.yielding || grown <= left {
            return (whole, grown);
        }
        let share = left.max(0.0) / grown;
        let start = std::array::from_fn(|k| trial[k] - share * flow[k]);
        let mut response = Self { sin_dilation: 0.0, ..*self }.respond(moduli, &start, state);
        // Of the flow by the trial strain: I − C⁻¹ ∂τ/∂ε; columns.
        let by_trial: [[f64; 3]; 3] = std::array::from_fn(|j| {
            let elastic = moduli.strain(&std::array::from_fn(|i| whole.tangent[i][j]));
            std::array::from_fn(|i| f64::from(u8::from(i == j)) - elastic[i])
        });
        let start_by_trial: [[f64; 3]; 3] = std::array::from_fn(|j| {
            let growth = sum(&by_trial[j]) / grown;
            std::array::from_fn(|i| f64::from(u8::from(i == j)) - share * (by_trial[j][i] - flow[i] * growth))
        });
        let of_start = response.tangent;
        response.tangent = std::array::from_fn(|i| std::array::from_fn(|j| dot(&of_start[i], &start_by_trial[j])));
        let flow = flow_of(&response);
        response.plastic_strain = state.plastic_strain + equivalent_plastic(&flow);
        response.yielding = true;
        (response, sum(&flow))
    }

    /// The return of sorted trial strains that lie outside.
    fn sorted(&self, moduli: &Moduli, trial: &[f64; 3], rounding: f64) -> Candidate {
        let (face, left, right) = (self.shear(0, 2), self.shear(0, 1), self.shear(1, 2));
        let on = |active| self.on_planes(moduli, trial, active);
        let best = self.on_planes(moduli, trial, [face]);
        if self.tension == f64::INFINITY {
            return best.or(rounding, || on([face, left])).or(rounding, || on([face, right]));
        }
        if self.tension >= self.apex() {
            return best
                .or(rounding, || on([face, left]))
                .or(rounding, || on([face, right]))
                .or(rounding, || self.corner(moduli, trial, 3));
        }
        let (first, second) = (self.tensile(0), self.tensile(1));
        best.or(rounding, || self.on_planes(moduli, trial, [first]))
            .or(rounding, || on([face, left]))
            .or(rounding, || on([face, right]))
            .or(rounding, || on([face, first]))
            .or(rounding, || on([first, second]))
            .or(rounding, || self.corner(moduli, trial, 1))
            .or(rounding, || self.corner(moduli, trial, 2))
            .or(rounding, || self.corner(moduli, trial, 3))
    }

    /// Largest isotropic tension the shear planes allow: `c cot φ`.
    fn apex(&self) -> f64 {
        if self.sin_friction > 0.0 { self.strength / (2.0 * self.sin_friction) } else { f64::INFINITY }
    }

    fn shear(&self, i: usize, j: usize) -> Plane {
        let (mut n, mut m) = ([0.0; 3], [0.0; 3]);
        n[i] = 1.0 + self.sin_friction;
        n[j] = self.sin_friction - 1.0;
        m[i] = 1.0 + self.sin_dilation;
        m[j] = self.sin_dilation - 1.0;
        Plane { n, m, r: self.strength }
    }

    fn tensile(&self, i: usize) -> Plane {
        let mut n = [0.0; 3];
        n[i] = 1.0;
        Plane { n, m: n, r: self.tension }
    }

    /// The return with one or two planes active.
    fn on_planes<const K: usize>(&self, moduli: &Moduli, trial: &[f64; 3], active: [Plane; K]) -> Candidate {
        let cm = active.map(|p| moduli.stress(&p.m));
        let cn = active.map(|p| moduli.stress(&p.n));
        let inverse: [[f64; K]; K] =
            inverse(std::array::from_fn(|a| std::array::from_fn(|b| dot(&active[a].n, &cm[b]))));

        // The second pass removes the rounding of the first, which is that of the trial stress times the
        // condition of Nᵀ C M: near incompressibility it would show.
        let mut stress = moduli.stress(trial);
        let mut lambda = [0.0; K];
        for _ in 0..2 {
            let f = active.map(|p| dot(&p.n, &stress) - p.r);
            for a in 0..K {
                let change: f64 = (0..K).map(|b| inverse[a][b] * f[b]).sum();
                lambda[a] += change;
                for i in 0..3 {
                    stress[i] -= cm[a][i] * change;
                }
            }
        }
        let mut tangent = moduli.tangent();
        for a in 0..K {
            for b in 0..K {
                for i in 0..3 {
                    for j in 0..3 {
                        tangent[i][j] -= cm[a][i] * inverse[a][b] * cn[b][j];
                    }
                }
            }
        }
        // Multipliers in strain, made a stress; order and every plane of the sorted sector.
        let negative = lambda.iter().fold(0.0, |v: f64, l| v.max(-2.0 * moduli.shear * l));
        let outside = self.excess(&stress).max(stress[1] - stress[0]).max(stress[2] - stress[1]);
        // From the stress, not trial strain less flow: it must give this stress back, however large the trial.
        let elastic_strain = moduli.strain(&stress);
        Candidate { stress, elastic_strain, tangent, violation: outside.max(negative) }
    }

    /// The return to the corner where the `tensile` largest stresses are at the tension cut-off, and the
    /// others where the shear planes then put them. With three, that is the apex.
    fn corner(&self, moduli: &Moduli, trial: &[f64; 3], tensile: usize) -> Candidate {
        let apex = self.apex();
        let tension = self.tension.min(apex);
        let low = ((1.0 + self.sin_friction) * tension - self.strength) / (1.0 - self.sin_friction);
        let stress = std::array::from_fn(|k| if k < tensile { tension } else { low });
        let elastic_strain = moduli.strain(&stress);
        let d: [f64; 3] = std::array::from_fn(|k| trial[k] - elastic_strain[k]);
        // The cone of flows, by its faces (d is sorted): a unit of shortening along one axis needs k of
        // lengthening along those before it.
        let k = (1.0 + self.sin_dilation) / (1.0 - self.sin_dilation);
        let least = match tensile {
            1 => (-d[1]).min(d[0] + k * (d[1] + d[2])),
            2 => (-d[2]).min(d[1]).min(d[0] + d[1] + k * d[2]),
            _ if tension < apex => d[2],
            _ => (d[0] + k * (d[1] + d[2])).min(d[0] + d[1] + k * d[2]),
        };
        Candidate { stress, elastic_strain, tangent: [[0.0; 3]; 3], violation: -2.0 * moduli.shear * least }
    }
}

/// Indices of the entries from the largest to the smallest.
#[inline]
fn descending(v: &[f64; 3]) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if v[order[a]] < v[order[b]] {
            order.swap(a, b);
        }
    }
    order
}

/// Inverse of a 1×1 or 2×2 matrix.
#[inline]
fn inverse<const K: usize>(a: [[f64; K]; K]) -> [[f64; K]; K] {
    let mut inverse = [[0.0; K]; K];
    if K == 1 {
        inverse[0][0] = 1.0 / a[0][0];
    } else {
        let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
        inverse[0][0] = a[1][1] / det;
        inverse[0][1] = -a[0][1] / det;
        inverse[1][0] = -a[1][0] / det;
        inverse[1][1] = a[0][0] / det;
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    /// The cones of flow at the corners, written as inequalities, against a search through all triples of
    /// the flows that meet there (Carathéodory).
    #[test]
    fn cones_of_the_corners() {
        let moduli = Moduli { lambda: 120.0, shear: 80.0 };
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for (sin_dilation, tension) in [(0.0, 0.5), (0.3, 0.5), (0.5, 0.5), (0.2, f64::INFINITY)] {
            let cone = Planes { sin_friction: 0.5, sin_dilation, strength: 2.0, tension };
            let planes = Planes { tension: cone.tension.min(cone.apex()), ..cone };
            let shear = |ij: &[(usize, usize)]| ij.iter().map(|&(i, j)| planes.shear(i, j).m).collect::<Vec<_>>();
            let tensile = |n: usize| (0..n).map(|i| planes.tensile(i).m).collect::<Vec<_>>();
            let flows = [
                [shear(&[(0, 2), (0, 1)]), tensile(1)].concat(),
                [shear(&[(0, 2), (1, 2)]), tensile(2)].concat(),
                if planes.tension < planes.apex() {
                    tensile(3)
                } else {
                    [shear(&[(0, 2), (0, 1), (1, 2)]), tensile(3)].concat()
                },
            ];
            for (corner, flows) in flows.iter().enumerate() {
                let mut inside = 0;
                for _ in 0..10_000 {
                    let mut d = [random(), random(), random()];
                    d.sort_by(|a, b| b.total_cmp(a));
                    let in_cone = (0..flows.len()).any(|a| {
                        (0..a).any(|b| {
                            (0..b).any(|c| {
                                let m = Matrix3::from_columns(&[flows[a], flows[b], flows[c]].map(Vector3::from));
                                m.try_inverse().is_some_and(|m| (m * Vector3::from(d)).min() >= 0.0)
                            })
                        })
                    });
                    let start = planes.corner(&moduli, &[0.0; 3], corner + 1).elastic_strain;
                    let trial = std::array::from_fn(|k| start[k] + d[k]);
                    let violation = planes.corner(&moduli, &trial, corner + 1).violation;
                    assert_eq!(violation <= 0.0, in_cone, "corner {corner}, {planes:?}: {d:?} {violation}");
                    inside += usize::from(in_cone);
                }
                assert!(inside > 20, "corner {corner}, {planes:?}: {inside}");
            }
        }
    }
}
