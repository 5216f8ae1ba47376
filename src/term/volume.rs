//! Change of volume of the material points where integrals are summed over integration points (docs/theory.md, section 6, item 4).
//!
//! A step brings the volume to balance where it is summed over. Elsewhere in a cell the determinant of the deformation has terms of second order
//! in the strain of a step that nothing has balanced, and soil that resists a change of its volume, and flows otherwise, would answer to
//! them with a pressure; where it cannot bear tension, with the half of them that presses. So the volume of a material point changes as the linear function of place does
//! that is fitted to `ln ΔJ` at the integration points of its cell; in cells of third order the quadratic one.

use crate::geometry::quadratic::{self, Quadratic};
use crate::tensor::Tensor;

/// Largest Lebesgue constant (-) of a fit at a point. Where the quadratic function has a larger one the linear one is taken, and where that has, the mean.
const MOST: f64 = 3.0;

/// How many times (-) what an integration point of the cell undergoes a place may undergo, and nothing of a sign that none of them has. In a full
/// triangle a linear function without a mean is twice as large at a corner as at the integration points, so such functions are met. In sand that
/// comes apart at one place of a cell it would press the others, where no integration point is pressed.
const BEYOND: f64 = 2.0;

/// The weight (m³) of an integration point, its place (m) and the value there.
pub type Weighed<const D: usize> = (f64, [f64; D], f64);

/// A value at an integration point.
#[derive(Clone, Copy)]
struct Sample<const D: usize> {
    /// Share of the weight of all (-).
    share: f64,
    /// From the centre of all (m).
    from_centre: [f64; D],
    value: f64,
}

/// A function of place through values at the integration points of a cell.
pub struct VolumeFit<const D: usize> {
    samples: Vec<Sample<D>>,
    centre: [f64; D],
    mean: f64,
    /// What the linear function is limited to.
    range: [f64; 2],
    /// Inverse of the second moments (1/m²), if there is one.
    inverse: Option<Tensor>,
    /// The normal equations of the quadratic function, and the length (m) in which they take places from the centre.
    quadratic: Option<(Quadratic, f64)>,
}

impl<const D: usize> VolumeFit<D> {
    /// That through `values`, each with its weight and its place (m), in a cell of some `order`; `None` of no values.
    pub fn of(values: &[Weighed<D>], order: usize) -> Option<Self> {
        let whole: f64 = values.iter().map(|v| v.0).sum();
        if values.is_empty() || whole <= 0.0 {
            return None;
        }
        let mean_of = |of: &dyn Fn(&Weighed<D>) -> f64| values.iter().map(|v| v.0 * of(v)).sum::<f64>() / whole;
        let centre: [f64; D] = std::array::from_fn(|d| mean_of(&|v| v.1[d]));
        let sample = |(weight, place, value): &Weighed<D>| Sample {
            share: weight / whole,
            from_centre: std::array::from_fn(|d| place[d] - centre[d]),
            value: *value,
        };
        let samples: Vec<Sample<D>> = values.iter().map(sample).collect();
        let mut moments = Tensor::identity();
        for i in 0..D {
            for j in 0..D {
                moments[(i, j)] = samples.iter().map(|s| s.share * s.from_centre[i] * s.from_centre[j]).sum();
            }
        }
        let length = (0..D).map(|d| moments[(d, d)]).sum::<f64>().sqrt();
        let weighed = samples.iter().map(|s| (s.share, in_plane(&s.from_centre, length)));
        let quadratic = if order > 2 && D == 2 { Quadratic::of(weighed) } else { None };
        let quadratic = quadratic.map(|quadratic| (quadratic, length));
        let range = samples.iter().fold([0.0f64; 2], |r, s| [r[0].min(BEYOND * s.value), r[1].max(BEYOND * s.value)]);
        Some(Self { mean: mean_of(&|v| v.2), range, inverse: moments.try_inverse(), samples, centre, quadratic })
    }

    /// The value at a place (m).
    pub fn at(&self, place: &[f64; D]) -> f64 {
        let Some(inverse) = &self.inverse else { return self.mean };
        let to: [f64; D] = std::array::from_fn(|d| place[d] - self.centre[d]);
        if let Some((quadratic, length)) = &self.quadratic {
            let (at, mut value, mut size) = (in_plane(&to, *length), 0.0, 0.0);
            for sample in &self.samples {
                let shares = quadratic.shares(sample.share, in_plane(&sample.from_centre, *length));
                let weight = quadratic::value(&shares, at);
                value += weight * sample.value;
                size += weight.abs();
            }
            if size <= MOST {
                return value;
            }
        }
        let slope: [f64; D] = std::array::from_fn(|i| (0..D).map(|j| inverse[(i, j)] * to[j]).sum());
        let (mut value, mut size) = (0.0, 0.0);
        for sample in &self.samples {
            let weight = sample.share * (1.0 + (0..D).map(|d| slope[d] * sample.from_centre[d]).sum::<f64>());
            value += weight * sample.value;
            size += weight.abs();
        }
        if size <= MOST { value.clamp(self.range[0], self.range[1]) } else { self.mean }
    }
}

/// The first two coordinates of a place, in lengths.
fn in_plane<const D: usize>(x: &[f64; D], length: f64) -> [f64; 2] {
    [x[0] / length, x[1] / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_values_are_met_and_far_places_take_the_mean() {
        let line = |x: &[f64; 2]| 0.3 - 2.0 * x[0] + x[1];
        let places = [[0.2, 0.1], [0.7, 0.15], [0.15, 0.8]];
        let values = places.map(|x| (0.5, x, line(&x)));
        let fit = VolumeFit::of(&values, 2).unwrap();
        for x in [[0.3, 0.3], [0.0, 0.0], [1.0, 0.0]] {
            assert!((fit.at(&x) - line(&x)).abs() < 1e-14);
        }
        let mean = values.iter().map(|v| v.2).sum::<f64>() / 3.0;
        assert!((fit.at(&[4.0, 4.0]) - mean).abs() < 1e-14);
        // On a line there is no linear function of the plane.
        let flat = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]].map(|x| (1.0, x, line(&x)));
        assert!((VolumeFit::of(&flat, 2).unwrap().at(&[0.2, 0.4]) + 0.7).abs() < 1e-14);
        assert!(VolumeFit::<2>::of(&[], 2).is_none());
        // Soil that comes apart at one of them is not pressed elsewhere; a function without a mean is met at the corners.
        let gauss = [[1.0 / 6.0, 1.0 / 6.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]];
        let at_corner = |of: [f64; 3], x: [f64; 2]| {
            let values: Vec<Weighed<2>> = (0..3).map(|i| (1.0, gauss[i], of[i])).collect();
            VolumeFit::of(&values, 2).unwrap().at(&x)
        };
        assert_eq!(at_corner([0.04, 0.0, 0.0], [1.0, 0.0]), 0.0);
        assert!((at_corner([0.04, 0.0, 0.0], [0.0, 0.0]) - 0.04 * 5.0 / 3.0).abs() < 1e-14);
        assert!((at_corner([-0.02, 0.01, 0.01], [0.0, 0.0]) + 0.04).abs() < 1e-14);

        let curve = |x: &[f64; 2]| line(x) + x[0] * x[0] - 2.0 * x[0] * x[1];
        let place = |i: usize| [0.1 + 0.3 * (i % 4) as f64, 0.2 * (i / 4) as f64];
        let values: Vec<Weighed<2>> = (0..16).map(|i| (1.0, place(i), curve(&place(i)))).collect();
        for (order, most) in [(3, 1e-13), (2, 1.0)] {
            let off = (VolumeFit::of(&values, order).unwrap().at(&[0.33, 0.27]) - curve(&[0.33, 0.27])).abs();
            assert!(off < most && (off > 1e-3) == (order == 2), "{order}: {off:e}");
        }
    }
}
