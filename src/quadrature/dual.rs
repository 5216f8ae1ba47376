//! The nearest weights to given ones under linear constraints and bounds, through the dual problem.
//!
//! In terms of the ratios `r = w/v` of the weights to the volumes, with `Σ v = 1`: `min ½ Σ v (r − s)²` where
//! `Σ v r c = e₀` and `LOW ≤ r ≤ HIGH`. The rows of `c` are the values of polynomials at the points, the first of them
//! one, and the others without moment on the active part; `s` are the ratios to stay near to. The dual is smooth and
//! convex, and its variables are not bounded: `min_λ Σ v ψ(c·λ) − λ₀` with `ψ′(t) = clip(s + t, LOW, HIGH)`, which is `r`.
//! Newton's method on it is semismooth: it ends exactly once the set of points within the bounds is known.

/// Least and largest ratio of a fitted weight to the volume.
pub const LOW: f64 = 0.05;
pub const HIGH: f64 = 20.0;

/// Values of `1, x, y` and of three quadratic polynomials at a point.
pub type Row = [f64; 6];

/// The points of a cell.
#[derive(Clone, Copy)]
pub struct Layout<'a> {
    pub rows: &'a [Row],
    /// Volumes, as shares of their sum.
    pub share: &'a [f64],
    /// What rounding of the rows leaves of the moments.
    pub tolerance: f64,
}

/// Newton steps that are tried. One to four are common.
const MAX_STEPS: usize = 40;

/// Multipliers beyond which rounding would show in the ratios.
const MAX_MULTIPLIER: f64 = 1e8;

/// Added to the diagonal of the dual's second derivative (of order one), so that it can be factorised when the
/// points within the bounds do not tell some polynomials apart: while that is all points, one step shall do; later
/// it bounds the steps.
const DAMPING_FREE: f64 = 1e-13;
const DAMPING: f64 = 1e-9;

/// Moves `ratio` to the nearest ratios within the bounds that meet the first `N` constraints, and says whether it
/// found them; else `ratio` holds nothing of use. `near` and `along` are working space, an entry a point.
pub fn solve<const N: usize>(layout: Layout, ratio: &mut [f64], near: &mut [f64], along: &mut [f64]) -> bool {
    let Layout { rows, share, tolerance } = layout;
    near.copy_from_slice(ratio);
    let mut lambda = [0f64; N];
    for _ in 0..MAX_STEPS {
        let size = lambda.iter().fold(0.0, |m: f64, l| m.max(l.abs()));
        let (mut gradient, mut hessian) = ([0.0; N], [[0.0; N]; N]);
        gradient[0] = -1.0;
        let (mut all_free, mut most) = (true, 0.0);
        for (((row, &v), r), &s) in rows.iter().zip(share).zip(ratio.iter_mut()).zip(near.iter()) {
            let t = dot(row, &lambda);
            most += v * t * if t > 0.0 { HIGH } else { LOW };
            *r = (s + t).clamp(LOW, HIGH);
            for j in 0..N {
                gradient[j] += v * *r * row[j];
            }
            if *r == s + t {
                add_product(&mut hessian, v, row);
            } else {
                all_free = false;
            }
        }
        let miss = gradient.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
        let found = miss <= 1e-11 + tolerance + 4e-16 * size;
        if found && miss <= tolerance {
            return true;
        }
        // No weights within the bounds reach `λ·Cw = λ₀`, or they nearly do not.
        if size > MAX_MULTIPLIER || !found && most - lambda[0] < -1e-11 * size {
            return false;
        }
        for j in 0..N {
            hessian[j][j] += if all_free { DAMPING_FREE } else { DAMPING };
        }
        let step = solve_symmetric(hessian, &gradient.map(|g| -g));
        for (row, along) in rows.iter().zip(along.iter_mut()) {
            *along = dot(row, &step);
        }
        if found && along.iter().all(|d| d.abs() < 1e-6) {
            // What the rounding of `c·λ` leaves, large multipliers having been needed, is taken from the ratios.
            for (r, d) in ratio.iter_mut().zip(along.iter()).filter(|(r, _)| **r > LOW && **r < HIGH) {
                *r = (*r + d).clamp(LOW, HIGH);
            }
            return true;
        }
        let slope: f64 = (0..N).map(|j| gradient[j] * step[j]).sum();
        let slope_at = |a: f64| {
            let mut sum = -step[0];
            for (((row, &v), &s), &d) in rows.iter().zip(share).zip(near.iter()).zip(along.iter()) {
                sum += v * d * (s + dot(row, &lambda) + a * d).clamp(LOW, HIGH);
            }
            sum
        };
        let a = length(slope, slope_at);
        if !(a > 0.0 && slope < 0.0) {
            return false;
        }
        for j in 0..N {
            lambda[j] += a * step[j];
        }
    }
    false
}

/// `c·λ`.
pub fn dot<const N: usize>(row: &Row, lambda: &[f64; N]) -> f64 {
    (0..N).map(|j| row[j] * lambda[j]).sum()
}

/// Adds `v c cᵀ` to the lower half of a matrix.
pub fn add_product<const N: usize>(matrix: &mut [[f64; N]; N], v: f64, row: &Row) {
    for i in 0..N {
        let vc = v * row[i];
        for j in 0..=i {
            matrix[i][j] += vc * row[j];
        }
    }
}

/// Solves with a positive definite matrix, of which the lower half is given, by Cholesky's method. A pivot lost in
/// rounding gives its unknown the value zero.
pub fn solve_symmetric<const N: usize>(mut h: [[f64; N]; N], right: &[f64; N]) -> [f64; N] {
    let mut inverse = [0.0; N];
    for j in 0..N {
        let mut pivot = h[j][j];
        for k in 0..j {
            pivot -= h[j][k] * h[j][k];
        }
        inverse[j] = if pivot > 0.0 { 1.0 / pivot.sqrt() } else { 0.0 };
        for i in j + 1..N {
            let mut sum = h[i][j];
            for k in 0..j {
                sum -= h[i][k] * h[j][k];
            }
            h[i][j] = sum * inverse[j];
        }
    }
    let mut x = *right;
    for i in 0..N {
        for k in 0..i {
            x[i] -= h[i][k] * x[k];
        }
        x[i] *= inverse[i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            x[i] -= h[k][i] * x[k];
        }
        x[i] *= inverse[i];
    }
    x
}

/// How far to go along a step: all of it, or to where the dual still falls, at most half as steeply as at first.
/// The slope grows along a step, the dual being convex.
fn length(slope: f64, slope_at: impl Fn(f64) -> f64) -> f64 {
    let end = slope_at(1.0);
    if end <= 1e-4 * slope.abs() {
        return 1.0;
    }
    // Regula falsi, halving the value of an end that stays (Illinois).
    let (mut low, mut high) = ((0.0, slope), (1.0, end));
    let mut last_low = None;
    for _ in 0..60 {
        let a = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let s = slope_at(a);
        if s <= 0.0 {
            if s >= 0.5 * slope {
                return a;
            }
            low = (a, s);
            if last_low == Some(true) {
                high.1 *= 0.5;
            }
        } else {
            high = (a, s);
            if last_low == Some(false) {
                low.1 *= 0.5;
            }
        }
        last_low = Some(s <= 0.0);
    }
    low.0
}
