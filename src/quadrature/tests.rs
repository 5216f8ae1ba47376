//! Fits of single cells: the moments that are met, optimality, and what happens where they cannot be met.

use super::dual::{HIGH, LOW};
use super::{Degree, Fitter, MOMENTS};
use nalgebra::{DMatrix, DVector};

/// Evenly distributed numbers in [0, 1) that are the same in every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A point of the triangle (0, 0), (1, 0), (0, 1).
    fn place(&mut self) -> [f64; 2] {
        let (x, y) = (self.unit(), self.unit());
        if x + y < 1.0 { [x, y] } else { [1.0 - x, 1.0 - y] }
    }

    fn cell(&mut self, points: usize) -> Cell {
        Cell {
            place: (0..points).map(|_| self.place()).collect(),
            volume: (0..points).map(|_| self.between(0.5, 1.5)).collect(),
        }
    }
}

#[derive(Clone)]
struct Cell {
    place: Vec<[f64; 2]>,
    volume: Vec<f64>,
}

impl Cell {
    fn moments(&self, weight: &[f64]) -> [f64; MOMENTS] {
        let mut sum = [0.0; MOMENTS];
        for (p, w) in self.place.iter().zip(weight) {
            for (s, q) in sum.iter_mut().zip(values(p)) {
                *s += w * q;
            }
        }
        sum
    }

    fn fit(&self, moments: &[f64; MOMENTS], wanted: Degree) -> (Vec<f64>, Degree) {
        let mut weight = vec![f64::NAN; self.place.len()];
        let degree = Fitter::default().fit(&self.place, &self.volume, moments, wanted, &mut weight);
        (weight, degree)
    }

    /// Ratios to the volumes scaled to the active volume.
    fn ratios(&self, weight: &[f64], active: f64) -> Vec<f64> {
        let scale = active / self.volume.iter().sum::<f64>();
        weight.iter().zip(&self.volume).map(|(w, v)| w / (scale * v)).collect()
    }

    fn check_sound(&self, weight: &[f64], active: f64) {
        for r in self.ratios(weight, active) {
            assert!((LOW * (1.0 - 1e-9)..=HIGH * (1.0 + 1e-9)).contains(&r), "ratio {r}");
        }
        let sum: f64 = weight.iter().sum();
        assert!((sum / active - 1.0).abs() < 1e-12, "{sum} in place of {active}");
    }
}

fn values([x, y]: &[f64; 2]) -> [f64; MOMENTS] {
    [1.0, *x, *y, x * x, x * y, y * y]
}

/// Moments of the triangle (0, 0), (a, 0), (0, b) by its closed form.
fn triangle(a: f64, b: f64) -> [f64; MOMENTS] {
    let area = a * b / 2.0;
    [area, area * a / 3.0, area * b / 3.0, area * a * a / 6.0, area * a * b / 12.0, area * b * b / 6.0]
}

fn miss(a: &[f64; MOMENTS], b: &[f64; MOMENTS], count: usize) -> f64 {
    (0..count).fold(0.0, |m, j| m.max((a[j] - b[j]).abs() / b[0].abs()))
}

/// Weights within the bounds, so that their moments can be met.
fn some_weights(random: &mut Random, cell: &Cell, spread: f64) -> Vec<f64> {
    cell.volume.iter().map(|v| v * random.between(-spread, spread).exp()).collect()
}

#[test]
fn moments_that_can_be_met_are_met() {
    let mut random = Random(1);
    for n in 1..=60 {
        for spread in [0.1, 0.5, 1.0] {
            for _ in 0..40 {
                let cell = random.cell(n);
                let moments = cell.moments(&some_weights(&mut random, &cell, spread));
                for (wanted, count) in [(Degree::Quadratic, 6), (Degree::Linear, 3)] {
                    let (weight, degree) = cell.fit(&moments, wanted);
                    assert_eq!(degree, wanted, "{n} points, spread {spread}");
                    let miss = miss(&cell.moments(&weight), &moments, count);
                    assert!(miss < 1e-12, "{n} points, spread {spread}: {miss:e}");
                    cell.check_sound(&weight, moments[0]);
                }
            }
        }
    }
}

/// Conditions of Karush, Kuhn and Tucker: `r − 1 = c·λ` at points within the bounds determines the multipliers by
/// least squares; at the bounds `c·λ` points outwards.
#[test]
fn weights_are_the_nearest() {
    let mut random = Random(2);
    let (mut at_low, mut at_high, mut checked) = (0, 0, 0);
    for n in [6, 8, 11, 16, 30, 60] {
        for _ in 0..60 {
            let cell = random.cell(n);
            let moments = cell.moments(&some_weights(&mut random, &cell, 2.5));
            let (weight, degree) = cell.fit(&moments, Degree::Quadratic);
            if degree < Degree::Quadratic {
                continue;
            }
            let r = cell.ratios(&weight, moments[0]);
            let free: Vec<usize> = (0..n).filter(|&p| r[p] > LOW + 1e-9 && r[p] < HIGH - 1e-9).collect();
            if free.len() < 8 {
                continue;
            }
            let c = DMatrix::from_fn(free.len(), MOMENTS, |i, j| values(&cell.place[free[i]])[j]);
            let excess = DVector::from_fn(free.len(), |i, _| r[free[i]] - 1.0);
            let lambda = c.clone().svd(true, true).solve(&excess, 1e-14).unwrap();
            let rest = (&c * &lambda - &excess).amax() / (1.0 + excess.amax());
            assert!(rest < 1e-9, "{n} points: {rest:e}");
            for p in 0..n {
                let t: f64 = 1.0 + values(&cell.place[p]).iter().zip(lambda.iter()).map(|(c, l)| c * l).sum::<f64>();
                if r[p] <= LOW + 1e-9 {
                    assert!(t < LOW + 1e-7, "{t}");
                    at_low += 1;
                } else if r[p] >= HIGH - 1e-9 {
                    assert!(t > HIGH - 1e-7, "{t}");
                    at_high += 1;
                }
            }
            checked += 1;
        }
    }
    assert!(
        checked > 100 && at_low > 50,
        "{checked} cells, {at_low} points at the lower and {at_high} at the upper bound"
    );
}

/// Four points leave one freedom beside three moments: all of it is tried.
#[test]
fn second_moments_that_cannot_be_met_are_missed_least() {
    let mut random = Random(3);
    let (mut worst, mut checked) = (0f64, 0);
    for _ in 0..300 {
        let cell = random.cell(4);
        let moments = triangle(1.0, 1.0);
        let (weight, degree) = cell.fit(&moments, Degree::Quadratic);
        cell.check_sound(&weight, moments[0]);
        if degree != Degree::Linear {
            continue;
        }
        assert!(miss(&cell.moments(&weight), &moments, 3) < 1e-12);
        // The freedom: weights without moments of degree 1.
        let minor = |skip: usize| {
            let k: Vec<usize> = (0..4).filter(|&p| p != skip).collect();
            let [a, b, c] = [cell.place[k[0]], cell.place[k[1]], cell.place[k[2]]];
            (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        };
        let free: Vec<f64> = (0..4).map(|p| minor(p) * if p % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let size = free.iter().fold(0f64, |m, f| m.max(f.abs()));
        let [x, y] = [1.0 / 3.0, 1.0 / 3.0];
        let missed = |w: &[f64]| {
            let m = cell.moments(w);
            let d: Vec<f64> = (0..6).map(|j| m[j] - moments[j]).collect();
            // About the centroid; volume and first moments are met.
            let xx = d[3] - 2.0 * x * d[1] + x * x * d[0];
            let xy = d[4] - x * d[2] - y * d[1] + x * y * d[0];
            let yy = d[5] - 2.0 * y * d[2] + y * y * d[0];
            (xx * xx + 2.0 * xy * xy + yy * yy).sqrt() / moments[0]
        };
        let own = missed(&weight);
        let best = (-20_000..=20_000)
            .map(|k| {
                let a = f64::from(k) / 20_000.0 * moments[0] / size;
                weight.iter().zip(&free).map(|(w, f)| w + a * f).collect::<Vec<_>>()
            })
            .filter(|w| cell.ratios(w, moments[0]).iter().all(|r| (LOW..=HIGH).contains(r)))
            .map(|w| missed(&w))
            .fold(own, f64::min);
        worst = worst.max(own - best);
        checked += 1;
    }
    println!("{checked} cells, at most {worst:.1e} above the least miss");
    assert!(checked > 50 && worst < 1e-4, "{checked} cells, {worst:e}");
}

#[test]
fn degenerate_layouts_have_weights() {
    let third = 1.0 / 3.0;
    let moments = triangle(1.0, 1.0);
    let layouts: [(&str, Vec<[f64; 2]>); 9] = [
        ("one point", vec![[0.1, 0.2]]),
        ("one point in the centroid", vec![[third, third]]),
        ("coincident", vec![[0.2, 0.3]; 7]),
        ("coincident in the centroid", vec![[third, third]; 7]),
        ("collinear", (0..9).map(|k| [0.1 * f64::from(k), 0.2]).collect()),
        ("collinear through the centroid", (0..9).map(|k| [0.1 * f64::from(k), third]).collect()),
        ("in a corner", (0..16).map(|k| [1e-3 * f64::from(k % 4), 1e-3 * f64::from(k / 4)]).collect()),
        (
            "on a circle",
            (0..12).map(|k| f64::from(k).sin_cos()).map(|(s, c)| [third + 0.2 * s, third + 0.2 * c]).collect(),
        ),
        ("two heaps", (0..10).map(|k| if k < 5 { [0.1, 0.1] } else { [0.6, 0.2] }).collect()),
    ];
    for (name, place) in layouts {
        let cell = Cell { volume: vec![0.1; place.len()], place };
        for wanted in [Degree::Constant, Degree::Linear, Degree::Quadratic] {
            let (weight, degree) = cell.fit(&moments, wanted);
            cell.check_sound(&weight, moments[0]);
            assert!(degree <= wanted);
            let count = [1, 3, 6][degree as usize];
            assert!(miss(&cell.moments(&weight), &moments, count) < 1e-12, "{name}");
        }
    }
}

#[test]
fn thin_active_parts_have_weights() {
    let mut random = Random(4);
    for exponent in 0..=10 {
        let thin = 10f64.powi(-exponent);
        for n in [1, 3, 6, 16] {
            // Points in the whole cell, and points in the sliver.
            for share in [1.0, thin] {
                let mut cell = random.cell(n);
                cell.place.iter_mut().for_each(|p| p[1] *= share);
                let moments = triangle(1.0, thin);
                for wanted in [Degree::Linear, Degree::Quadratic] {
                    let (weight, _) = cell.fit(&moments, wanted);
                    cell.check_sound(&weight, moments[0]);
                }
            }
        }
    }
}

#[test]
fn nonsense_still_gives_positive_weights() {
    let mut random = Random(5);
    let cell = random.cell(5);
    for moments in [
        [0.0; 6],
        [-1.0, 0.3, 0.3, 0.1, 0.1, 0.1],
        [f64::NAN; 6],
        [f64::INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1e-300, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, f64::NAN, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1e200, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.3, 0.3, -5.0, 9.0, -5.0],
    ] {
        for volume in [vec![1.0; 5], vec![0.0; 5], vec![-1.0, 1.0, 1.0, 1.0, 1.0], vec![f64::NAN; 5], vec![1e-310; 5]] {
            let cell = Cell { place: cell.place.clone(), volume };
            for wanted in [Degree::Constant, Degree::Linear, Degree::Quadratic] {
                let (weight, _) = cell.fit(&moments, wanted);
                assert!(weight.iter().all(|w| *w > 0.0 && w.is_finite()), "{moments:?} {:?}: {weight:?}", cell.volume);
            }
        }
    }
    assert_eq!(Fitter::default().fit(&[], &[], &triangle(1.0, 1.0), Degree::Quadratic, &mut []), Degree::Constant);
}

#[test]
fn coordinates_do_not_matter() {
    let mut random = Random(6);
    let mut worst = 0f64;
    for n in [1, 3, 4, 5, 6, 9, 16] {
        for _ in 0..40 {
            let cell = random.cell(n);
            let active = random.cell(40);
            let moments = active.moments(&active.volume);
            let (weight, degree) = cell.fit(&moments, Degree::Quadratic);
            let (s, c) = random.between(0.0, 6.3).sin_cos();
            let (scale, shift) = (random.between(0.01, 30.0), [random.between(-0.5, 0.5), random.between(-0.5, 0.5)]);
            let mapped = |cell: &Cell| {
                let map = |p: &[f64; 2]| {
                    let (x, y) = (p[0] + shift[0], p[1] + shift[1]);
                    [scale * (c * x - s * y), scale * (s * x + c * y)]
                };
                Cell { place: cell.place.iter().map(map).collect(), volume: cell.volume.clone() }
            };
            let (cell, active) = (mapped(&cell), mapped(&active));
            let (other, other_degree) = cell.fit(&active.moments(&active.volume), Degree::Quadratic);
            assert_eq!(degree, other_degree, "{n} points");
            for (a, b) in weight.iter().zip(&other) {
                worst = worst.max((a - b).abs() / moments[0]);
            }
        }
    }
    assert!(worst < 1e-6, "{worst:e}");
}

/// Points and the active part drift until an exact fit is lost, degree after degree: the weights follow without a jump.
#[test]
fn weights_are_continuous_where_a_fit_is_lost() {
    let mut random = Random(7);
    let (mut worst, mut changes) = ([0f64; 3], 0);
    for n in [3, 4, 6, 8, 12, 16] {
        for _ in 0..20 {
            let start = random.cell(n);
            let way: Vec<[f64; 2]> = start.place.iter().map(|_| random.place()).collect();
            let step = |s: f64| {
                let mut cell = start.clone();
                for (p, to) in cell.place.iter_mut().zip(&way) {
                    *p = [p[0] + s * (0.5 * to[0] - p[0]), p[1] + s * (0.5 * to[1] - p[1])];
                }
                let height = 1.0 - 0.9 * s;
                let moments = triangle(1.0, height);
                let (weight, degree) = cell.fit(&moments, Degree::Quadratic);
                (cell.ratios(&weight, moments[0]), degree)
            };
            // Where the degree changes, bisect: what is left is the jump.
            let mut before = step(0.0);
            for k in 1..=50 {
                let after = step(f64::from(k) / 50.0);
                if before.1 != after.1 {
                    let (mut low, mut high) = (f64::from(k - 1) / 50.0, f64::from(k) / 50.0);
                    let (mut a, mut b) = (before.clone(), after.clone());
                    while high - low > 1e-13 {
                        let middle = 0.5 * (low + high);
                        let m = step(middle);
                        if m.1 == a.1 {
                            (low, a) = (middle, m);
                        } else {
                            (high, b) = (middle, m);
                        }
                    }
                    let jump = a.0.iter().zip(&b.0).fold(0f64, |m, (a, b)| m.max((a - b).abs()));
                    let lower = a.1.min(b.1) as usize;
                    worst[lower] = worst[lower].max(jump);
                    changes += 1;
                }
                before = after;
            }
        }
    }
    println!("{changes} changes of degree; largest jump of a weight {worst:.5?} of its volume, by the lower degree");
    assert!(changes > 50 && worst.iter().all(|&w| w < 0.01 * (HIGH - LOW)), "{changes} changes, {worst:?}");
}

/// Printed only: what a fit costs.
#[test]
fn time_of_a_fit() {
    let mut random = Random(8);
    for (n, spread) in [(16, 0.2), (16, 1.0), (16, 2.5), (60, 0.2), (3, 1.0)] {
        let cells: Vec<_> = (0..2000)
            .map(|_| {
                let cell = random.cell(n);
                let moments =
                    if n > 3 { cell.moments(&some_weights(&mut random, &cell, spread)) } else { triangle(1.0, 1.0) };
                (cell, moments)
            })
            .collect();
        let (mut fitter, mut weight) = (Fitter::default(), vec![0.0; n]);
        let begin = std::time::Instant::now();
        let mut reached = [0; 3];
        for (cell, moments) in &cells {
            reached[fitter.fit(&cell.place, &cell.volume, moments, Degree::Quadratic, &mut weight) as usize] += 1;
        }
        let each = begin.elapsed().as_secs_f64() / cells.len() as f64;
        println!("{n} points, spread {spread}: {:.2} µs a cell, degrees 0 / 1 / 2: {reached:?}", 1e6 * each);
        assert_eq!(reached.iter().sum::<usize>(), cells.len());
    }
}
