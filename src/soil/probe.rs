//! Values of the soil at a place, from its material points.
//!
//! The value is that of a linear function, fitted by weighted least squares to the points of one region around the place: that of the point in whose
//! surroundings it lies. A linear field is met exactly. Where no point is near there is no soil.

use crate::geometry::Bins;

/// Soil is where a point is within so many times its spacing (-), the side of a square of its area: in corners of irregular points none is
/// nearer than that of one.
const NEAR: f64 = 1.5;
/// Points within so many times the spacing (-) count, those farther out less: some twenty.
const AROUND: f64 = 2.5;
/// Moments of places on a line are less than this part (-) of their square.
const ON_A_LINE: f64 = 1e-12;

/// Points that values are known at.
pub struct Probe {
    position: Vec<[f64; 2]>,
    /// The region of each.
    region: Vec<u16>,
    /// The spacing of each (m).
    spacing: Vec<f64>,
    bins: Bins,
}

/// Points by their numbers with their weights (-), whose sum is one.
pub type Weights = Vec<(usize, f64)>;

impl Probe {
    /// Of points with their places (m), areas (m²) in the plane and regions.
    pub fn new(position: Vec<[f64; 2]>, area: &[f64], region: Vec<u16>) -> Self {
        let spacing: Vec<f64> = area.iter().map(|area| area.max(0.0).sqrt()).collect();
        let widest = spacing.iter().copied().fold(0.0, f64::max);
        let bins = Bins::new(position.iter().map(|x| (*x, *x)), AROUND * widest);
        Self { position, region, spacing, bins }
    }

    /// What the points count in the value at `x`; `None` where there is no soil.
    pub fn at(&self, x: &[f64; 2]) -> Option<Weights> {
        let near = || self.bins.around(x).flatten().map(|&p| p as usize);
        let way = |p: usize| [0, 1].map(|d| self.position[p][d] - x[d]);
        let distance = |p: usize| {
            let [a, b] = way(p);
            a.hypot(b)
        };
        let relative = |p: usize| distance(p) / self.spacing[p];
        let host = near().filter(|&p| self.spacing[p] > 0.0).min_by(|&a, &b| relative(a).total_cmp(&relative(b)))?;
        if relative(host) > NEAR {
            return None;
        }
        let radius = AROUND * self.spacing[host];
        let mut weights: Weights = near()
            .filter(|&p| self.region[p] == self.region[host] && distance(p) < radius)
            .map(|p| (p, (1.0 - (distance(p) / radius).powi(2)).powi(2)))
            .collect();
        let whole: f64 = weights.iter().map(|(_, w)| w).sum();
        weights.iter_mut().for_each(|(_, w)| *w /= whole);
        let centre = [0, 1].map(|d| weights.iter().map(|&(p, w)| w * way(p)[d]).sum::<f64>());
        let off = |p: usize| [0, 1].map(|d| way(p)[d] - centre[d]);
        let moment = |i: usize, j: usize| weights.iter().map(|&(p, w)| w * off(p)[i] * off(p)[j]).sum::<f64>();
        let [a, b, c] = [moment(0, 0), moment(0, 1), moment(1, 1)];
        let determinant = a * c - b * b;
        if determinant > ON_A_LINE * (a + c) * (a + c) {
            // From the centre of the points to the place.
            let [u, v] = centre.map(|x| -x);
            let slope = [(c * u - b * v) / determinant, (a * v - b * u) / determinant];
            let factors: Vec<f64> =
                weights.iter().map(|&(p, _)| 1.0 + slope[0] * off(p)[0] + slope[1] * off(p)[1]).collect();
            weights.iter_mut().zip(factors).for_each(|((_, w), factor)| *w *= factor);
        }
        Some(weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a layer 4 m long and 2 m high, moved by up to `off` spacings.
    fn layer(off: f64) -> Vec<[f64; 2]> {
        let scatter = |k: usize, g: f64| off * ((g * (k + 1) as f64).fract() - 0.5) * 0.1;
        let place = |k: usize| [0.05 + 0.1 * (k % 40) as f64, 0.05 + 0.1 * (k / 40) as f64];
        let moved = |k: usize| [place(k)[0] + scatter(k, 0.754_877_666), place(k)[1] + scatter(k, 0.569_840_291)];
        (0..800).map(moved).collect()
    }

    #[test]
    fn a_linear_field_is_met_everywhere_in_the_soil_and_nothing_beside_it() {
        for off in [0.0, 0.8] {
            let position = layer(off);
            let (area, region) = (vec![0.01; 800], vec![3; 800]);
            let probe = Probe::new(position.clone(), &area, region);
            for k in 0..500 {
                let at = [4.0, 2.0].map(|l| l * (0.618_034 * (k * k) as f64 + 0.3 * l).fract());
                let value: f64 = probe
                    .at(&at)
                    .unwrap()
                    .iter()
                    .map(|&(p, w)| w * (3.0 - position[p][0] + 7.0 * position[p][1]))
                    .sum();
                assert!((value - (3.0 - at[0] + 7.0 * at[1])).abs() < 1e-10, "{at:?}: {value}");
            }
            for beside in [[2.0, 2.2], [-0.2, 1.0], [9.0, 9.0]] {
                assert!(probe.at(&beside).is_none(), "{beside:?}");
            }
        }
        assert!(Probe::new(Vec::new(), &[], Vec::new()).at(&[0.0; 2]).is_none());
    }

    #[test]
    fn a_region_is_not_mixed_with_the_one_beside_it_and_a_row_of_points_has_a_mean() {
        let position = layer(0.0);
        let area = vec![0.01; 800];
        let region: Vec<u16> = position.iter().map(|x| u16::from(x[0] > 2.0)).collect();
        let probe = Probe::new(position, &area, region.clone());
        for (x, own) in [(1.98, 0), (2.02, 1)] {
            assert!(probe.at(&[x, 1.0]).unwrap().iter().all(|&(p, _)| region[p] == own));
        }
        let row: Vec<[f64; 2]> = (0..5).map(|i| [0.1 * f64::from(i), 0.0]).collect();
        let probe = Probe::new(row.clone(), &[0.01; 5], vec![0; 5]);
        let sum: f64 = probe.at(&[0.2, 0.03]).unwrap().iter().map(|&(p, w)| w * row[p][0]).sum();
        assert!((sum - 0.2).abs() < 1e-12, "{sum}");
    }

    #[test]
    fn weights_do_not_know_where_the_origin_is_nor_which_side_is_left() {
        let position = layer(0.8);
        let of = |moved: &dyn Fn([f64; 2]) -> [f64; 2], x: [f64; 2]| {
            Probe::new(position.iter().map(|x| moved(*x)).collect(), &[0.01; 800], vec![0; 800]).at(&moved(x)).unwrap()
        };
        for x in [[0.03, 0.02], [1.234, 0.777], [2.5, 1.99]] {
            let first = of(&|x| x, x);
            for other in [of(&|[x, y]| [-x, y], x), of(&|[x, y]| [x + 1000.0, y - 300.0], x)] {
                let pairs = first.iter().map(|(p, w)| (w, other.iter().find(|(q, _)| q == p).unwrap().1));
                assert!(first.len() == other.len() && pairs.into_iter().all(|(w, v)| (w - v).abs() < 1e-9), "{x:?}");
            }
        }
    }
}
