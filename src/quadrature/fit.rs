//! Weights of the points of one cell that integrate polynomials exactly over its active part.
//!
//! As weights, the volumes `V` of points that have moved through the grid integrate not even a constant stress
//! well. These are the nearest positive ones that do: `min Σ (w − V̂)²/V̂` with `Σ w q(x) = ∫ q` over the active
//! part for `q` of degree 2 (or 1), and `0.05 V̂ ≤ w ≤ 20 V̂`, where `V̂` is `V` scaled to the active volume.
//!
//! Where points are too few or badly placed for that, the moments are missed by as little as the bounds permit, those of
//! degree 2 first: the weights are then the limit of the exact ones, so a cell that ceases to have an exact
//! fit does not make the solution jump.

use super::dual::{self, Layout, Row};
use super::least::{self, Place};

/// The moments `∫ {1, x, y, x², xy, y²}` of degree 2.
pub const MOMENTS: usize = 6;

/// Up to which degree polynomials are integrated exactly over the active part of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Degree {
    /// The active volume alone.
    Constant,
    /// Linear polynomials; quadratic ones as nearly as the bounds permit, where they were asked for.
    Linear,
    /// Quadratic polynomials.
    Quadratic,
}

/// Fits weights, cell after cell, in memory that it keeps.
#[derive(Clone, Debug, Default)]
pub struct Fitter {
    rows: Vec<Row>,
    share: Vec<f64>,
    ratio: Vec<f64>,
    linear: Vec<f64>,
    near: Vec<f64>,
    along: Vec<f64>,
    place: Vec<Place>,
    /// What rounding of the coordinates leaves of the moments.
    tolerance: f64,
}

/// Softness of first moments that cannot be met, in units of the active volume and the spread of the points: so
/// small that they are missed by next to the least.
const SOFT_FIRST: f64 = 1e-9;
/// The same of second moments; and of the first ones beside them, which can be met.
const SOFT_SECOND: f64 = 1e-9;
const NEARLY_HARD: f64 = 1e-13;

/// Least active volume, as a share of the volume of the points: points in a cell that the active part has left
/// keep a positive weight.
const LEAST_VOLUME: f64 = 1e-12;

impl Fitter {
    /// Writes weights for the points of a cell and returns the degree that they reach, at most `wanted`.
    ///
    /// `place` are the coordinates of the points, best about a point in the cell; `volume` their current volumes (m³,
    /// per metre or per full turn); `moments` are `∫ {1, x, y, x², xy, y²}` over the active part in the same
    /// coordinates and measure, of which the last three matter only if quadratic ones are wanted. The unit of the
    /// coordinates does not matter. All three slices of points have the same length.
    ///
    /// The weights are positive and finite, and sum to the active volume, whatever the layout of the points; with a
    /// volume of the points that is not positive and finite, they are equal.
    pub fn fit(
        &mut self,
        place: &[[f64; 2]],
        volume: &[f64],
        moments: &[f64; MOMENTS],
        wanted: Degree,
        weight: &mut [f64],
    ) -> Degree {
        let active = self.scale(volume, moments[0]);
        let quadratic = wanted == Degree::Quadratic;
        let usable = wanted > Degree::Constant && moments[0] == active && self.tabulate(place, moments, quadratic);
        let degree = if usable { self.solve(quadratic) } else { Degree::Constant };
        if !usable {
            self.ratio.clear();
            self.ratio.resize(volume.len(), 1.0);
        }
        for ((w, v), r) in weight.iter_mut().zip(&self.share).zip(&self.ratio) {
            *w = active * v * r;
        }
        degree
    }

    /// Takes the volumes as shares of their sum; returns the active volume, which is positive.
    fn scale(&mut self, volume: &[f64], active: f64) -> f64 {
        let sum: f64 = volume.iter().sum();
        self.share.clear();
        if volume.iter().all(|&v| v > 0.0) && (1.0 / sum).is_normal() {
            self.share.extend(volume.iter().map(|v| v / sum));
        } else {
            self.share.resize(volume.len(), 1.0 / volume.len() as f64);
        }
        let least = LEAST_VOLUME * if sum > 0.0 && sum.is_finite() { sum } else { 1.0 };
        if active.is_finite() { active.max(least) } else { least }
    }

    /// Writes the values of the polynomials at the points, about the centroid of the active part and in units of the
    /// spread of the points about it and of the active part; false where these are not finite numbers.
    fn tabulate(&mut self, place: &[[f64; 2]], moments: &[f64; MOMENTS], quadratic: bool) -> bool {
        let [x, y] = [moments[1] / moments[0], moments[2] / moments[0]];
        let mut square = 0.0;
        let mut second = [0.0; 3];
        if quadratic {
            second =
                [moments[3] / moments[0] - x * x, moments[4] / moments[0] - x * y, moments[5] / moments[0] - y * y];
            square += (second[0] + second[2]).max(0.0);
        }
        for (p, v) in place.iter().zip(&self.share) {
            square += v * ((p[0] - x).powi(2) + (p[1] - y).powi(2));
        }
        // Points that all lie in the centroid need no scale.
        let square = if square > 0.0 { square } else { 1.0 };
        let (scale, root) = (1.0 / square.sqrt(), std::f64::consts::SQRT_2);
        self.tolerance = 1e-14 + 1e-15 * (x.abs().max(y.abs()) * scale).powi(2);
        let second = second.map(|s| s / square);
        self.rows.clear();
        self.rows.extend(place.iter().map(|p| {
            let (x, y) = ((p[0] - x) * scale, (p[1] - y) * scale);
            // With the root the sum of the squares of the second moments is that of a tensor: no axis is special.
            [1.0, x, y, x * x - second[0], root * (x * y - second[1]), y * y - second[2]]
        }));
        self.ratio.clear();
        self.ratio.resize(place.len(), 1.0);
        self.linear.resize(place.len(), 0.0);
        self.near.resize(place.len(), 0.0);
        self.along.resize(place.len(), 0.0);
        self.place.resize(place.len(), Place::Within);
        self.rows.iter().flatten().all(|c| c.is_finite())
    }

    fn solve(&mut self, quadratic: bool) -> Degree {
        let Self { rows, share, ratio, linear, near, along, place, tolerance } = self;
        let layout = Layout { rows, share, tolerance: *tolerance };
        if quadratic && dual::solve::<6>(layout, ratio, near, along) {
            return Degree::Quadratic;
        }
        ratio.fill(1.0);
        if !dual::solve::<3>(layout, ratio, near, along) {
            least::solve(layout, &[0.0, SOFT_FIRST, SOFT_FIRST], ratio, place);
            return Degree::Constant;
        }
        if quadratic {
            linear.copy_from_slice(ratio);
            let (h, s) = (NEARLY_HARD, SOFT_SECOND);
            least::solve(layout, &[0.0, h, h, s, s, s], ratio, place);
            // From there it is next to nothing to the right first moments.
            if !dual::solve::<3>(layout, ratio, near, along) {
                ratio.copy_from_slice(linear);
            }
        }
        Degree::Linear
    }
}
