//! Forces in the sections of a strip (docs/theory.md, section 3, *Plates*): what the stresses at its 2 × 2 points come to across it.
//!
//! Along the axis, N > 0 is tension. M > 0 stretches the right side, seen along the axis: of a beam drawn from left to right that is its lower side.
//! Q = dM/ds.

use super::shape::{CellKind, MAX_NODES};
use crate::geometry::{distance, dot, way};
use crate::tensor::Symmetric;

/// Where the points of an element are along it (parametric), on both sides of its middle.
const POINT: f64 = 0.577_350_269_189_625_8;

/// A section at the end of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Section {
    /// How far along the axis as it was drawn (m).
    pub along: f64,
    /// Where the axis is (m), and how far it has moved (m).
    pub position: [f64; 2],
    pub displacement: [f64; 2],
    pub forces: Forces,
}

/// Forces in a section, per metre out of the plane or of the circumference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    /// N (kN/m).
    pub normal: f64,
    /// Q (kN/m).
    pub shear: f64,
    /// M (kNm/m).
    pub moment: f64,
    /// Around the axis of symmetry (kN/m); out of the plane in plane strain.
    pub hoop: f64,
}

impl Forces {
    fn combine(a: &Self, b: &Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            normal: of(a.normal, b.normal),
            shear: of(a.shear, b.shear),
            moment: of(a.moment, b.moment),
            hoop: of(a.hoop, b.hoop),
        }
    }
}

/// An element of a strip: places of its nodes (m) as drawn, where displacements are counted from, and now, and the stresses (kPa) at its points.
#[derive(Clone, Debug)]
pub struct Element {
    pub drawn: [[f64; 2]; 8],
    pub from: [[f64; 2]; 8],
    pub now: [[f64; 2]; 8],
    pub stress: [Symmetric; 4],
}

/// The sections at both ends of each of the elements, which follow each other along the axis.
pub fn sections(elements: impl Iterator<Item = Element>, axisymmetric: bool) -> Vec<Section> {
    let mut sections = Vec::new();
    let mut along = 0.0;
    for element in elements {
        // The nodes on the axis.
        const ENDS: [usize; 2] = [7, 5];
        let length = distance(&element.now[ENDS[0]], &element.now[ENDS[1]]);
        let [a, b] = [(-POINT, [0, 2]), (POINT, [1, 3])].map(|(x, points)| across(&element, x, points, axisymmetric));
        for (node, sign) in ENDS.into_iter().zip([-1.0, 1.0]) {
            let share = 0.5 * (1.0 + sign / POINT);
            let mut forces = Forces::combine(&a, &b, |a, b| a + share * (b - a));
            // As a parabola with the curvature that Q = dM/ds gives it.
            forces.moment += (b.shear - a.shear) * length / (12.0 * POINT);
            sections.push(Section {
                along,
                position: element.now[node],
                displacement: way(&element.from[node], &element.now[node]),
                forces,
            });
            along += if sign < 0.0 { distance(&element.drawn[ENDS[0]], &element.drawn[ENDS[1]]) } else { 0.0 };
        }
    }
    sections
}

/// The forces across an element at the parametric place `x`, where it has two points, the right one first.
fn across(element: &Element, x: f64, points: [usize; 2], axisymmetric: bool) -> Forces {
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    let mut at = |y: f64| {
        let kind = CellKind::Q8;
        kind.values(&[x, y, 0.0], &mut n);
        kind.derivatives(&[x, y, 0.0], &mut dn);
        let sum = |of: &dyn Fn(usize) -> f64, d: usize| (0..8).map(|k| of(k) * element.now[k][d]).sum::<f64>();
        let place = [0, 1].map(|d| sum(&|k| n[k], d));
        [place, [0, 1].map(|d| sum(&|k| dn[k][0], d)), [0, 1].map(|d| sum(&|k| dn[k][1], d))]
    };
    let [axis, along, half] = at(0.0);
    let size = along[0].hypot(along[1]);
    let t = along.map(|v| v / size);
    let left = [-t[1], t[0]];
    let mut forces = Forces::default();
    for (y, point) in [-POINT, POINT].into_iter().zip(points) {
        let [place, ..] = at(y);
        let s = &element.stress[point];
        let around = if axisymmetric && axis[0] > 0.0 { place[0] / axis[0] } else { 1.0 };
        // The force on the face towards the end of the axis; its normal times the length of this half.
        let m = [half[1] * around, -half[0] * around];
        let force = [s[0] * m[0] + s[3] * m[1], s[3] * m[0] + s[1] * m[1]];
        let normal = dot(&force, &t);
        let arm = dot(&way(&axis, &place), &left);
        forces.normal += normal;
        forces.shear -= dot(&force, &left);
        forces.moment -= normal * arm;
        forces.hoop += s[2] * half[0].hypot(half[1]);
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An element from [0, 0] to [2, 0], 0.4 m thick, with the stress of a beam at its points; turned by an angle.
    fn bent(angle: f64) -> Vec<Section> {
        let turn = |[x, y]: [f64; 2]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()];
        let places =
            [[0.0, -0.2], [2.0, -0.2], [2.0, 0.2], [0.0, 0.2], [1.0, -0.2], [2.0, 0.0], [1.0, 0.2], [0.0, 0.0]];
        let now = places.map(turn);
        let stress = [[-POINT, -POINT], [POINT, -POINT], [-POINT, POINT], [POINT, POINT]].map(|[x, y]| {
            // M = 3 + s, N = 5, Q = 1 of the stresses −M y/I + N/d and −Q/d.
            let (xx, xy) = (-(3.0 + 1.0 + x) * 0.2 * y / (0.4f64.powi(3) / 12.0) + 5.0 / 0.4, -1.0 / 0.4);
            let (c, s) = (angle.cos(), angle.sin());
            [
                c * c * xx - 2.0 * c * s * xy,
                s * s * xx + 2.0 * c * s * xy,
                7.0,
                c * s * xx + (c * c - s * s) * xy,
                0.0,
                0.0,
            ]
        });
        sections([Element { drawn: now, from: now, now, stress }].into_iter(), false)
    }

    #[test]
    fn the_stresses_of_a_beam_give_its_forces_however_it_lies() {
        for angle in [0.0, 0.7, 2.0, -1.6] {
            let found = bent(angle);
            for (section, moment) in found.iter().zip([3.0, 5.0]) {
                let Forces { normal, shear, moment: m, hoop } = section.forces;
                for (value, exact) in [(normal, 5.0), (shear, 1.0), (m, moment), (hoop, 2.8)] {
                    assert!((value - exact).abs() < 1e-12, "{angle}: {:?}", section.forces);
                }
            }
            assert_eq!([found[0].along, found[1].along], [0.0, 2.0]);
        }
    }
}
