//! The state of the material points as a linear function over each cell, and in cells of third order as a quadratic one.
//!
//! `c = argmin Σ_p V_p ω_p |f_p − P(x_p) c|²` with `P = (1, x, y)` about the cell. The points of the cell count with `ω = 1`, those of
//! ring `r` of the cells around it with `0.1^r`. A ring is taken in only as far as the function at the integration points depends on
//! no more than three times the largest value at a material point, `Σ_p |R_qp| ≤ 3`: what is fitted to the points of a cell
//! gives back every linear function of that cell, and with it the errors of a reset do not grow (docs/theory.md).
//!
//! In cells of third order stresses have terms of second degree: there `P = (1, x, y, x², xy, y²)`, with the same bound and at most one ring, and linear
//! functions where that is not met.

use super::places::Place;
use crate::geometry::quadratic::{self, Quadratic};
use crate::mesh::Mesh;
use crate::points::Points;
use crate::surface::CellFrame;
use std::borrow::Borrow;

/// Weight of a ring over that of the one within it.
const RING: f64 = 0.1;
/// Rings that a linear function may need; cells that take part are nearer to points than that.
const RINGS: usize = 3;
/// Rings that a quadratic function may need.
const NEAR_RINGS: usize = 1;
/// The largest `Σ_p |R_qp|`.
const MOST: f64 = 3.0;

/// The cells that share a corner with each cell.
pub struct Around {
    first: Vec<u32>,
    cells: Vec<u32>,
}

impl Around {
    pub fn of(mesh: &Mesh<2>) -> Self {
        let at = mesh.cells_at_nodes(|_| true);
        let (mut first, mut cells) = (vec![0], Vec::new());
        for c in 0..mesh.cells.len() {
            let mut own: Vec<u32> = mesh.cells.corners(c).iter().flat_map(|&n| &at[n as usize]).copied().collect();
            own.sort_unstable();
            own.dedup();
            cells.extend(own.into_iter().filter(|&other| other != c as u32));
            first.push(cells.len() as u32);
        }
        Self { first, cells }
    }

    pub fn cells(&self, c: u32) -> &[u32] {
        &self.cells[self.first[c as usize] as usize..self.first[c as usize + 1] as usize]
    }
}

/// The material points by cell.
pub struct Held {
    first: Vec<u32>,
    points: Vec<u32>,
}

impl Held {
    /// All points, each in a `cell`, of so many cells.
    pub fn new(cells: usize, cell: &[u32]) -> Self {
        Self::of(&vec![true; cells], cell)
    }

    /// Those in cells that count.
    pub fn of(counts: &[bool], cell: &[u32]) -> Self {
        let cells = counts.len();
        let mut first = vec![0; cells + 1];
        let held = || (0..).zip(cell).filter(|(_, c)| counts[**c as usize]);
        held().for_each(|(_, &c): (u32, _)| first[c as usize + 1] += 1);
        (0..cells).for_each(|c| first[c + 1] += first[c]);
        let (mut next, mut points) = (first.clone(), vec![0; first[cells] as usize]);
        for (p, &c) in held() {
            points[next[c as usize] as usize] = p;
            next[c as usize] += 1;
        }
        Self { first, points }
    }

    pub fn points(&self, c: u32) -> &[u32] {
        &self.points[self.first[c as usize] as usize..self.first[c as usize + 1] as usize]
    }
}

/// A cell with the cells around it, ring after ring.
pub struct Rings {
    cells: Vec<u32>,
    /// Ring `r` ends here.
    end: Vec<usize>,
}

impl Rings {
    pub fn of(cell: u32) -> Self {
        Self { cells: vec![cell], end: vec![1] }
    }

    /// The cells of ring `r`, 0 the cell itself.
    fn ring(&mut self, r: usize, around: &Around) -> &[u32] {
        while self.end.len() <= r {
            let begin = if self.end.len() > 1 { self.end[self.end.len() - 2] } else { 0 };
            for i in begin..self.cells.len() {
                for &other in around.cells(self.cells[i]) {
                    if !self.cells.contains(&other) {
                        self.cells.push(other);
                    }
                }
            }
            self.end.push(self.cells.len());
        }
        &self.cells[if r > 0 { self.end[r - 1] } else { 0 }..self.end[r]]
    }

    /// The points of the nearest ring that has any.
    pub fn nearest(&mut self, around: &Around, held: &Held) -> Vec<u32> {
        for r in 0..=RINGS {
            let points: Vec<u32> = self.ring(r, around).iter().flat_map(|&c| held.points(c)).copied().collect();
            if !points.is_empty() {
                return points;
            }
        }
        Vec::new()
    }
}

/// How a cell's function follows from values at points.
pub struct Fit {
    pub points: Vec<u32>,
    /// What the value at each point adds to the coefficients of `1, x, y` in the coordinates of the cell's frame.
    shares: Vec<[f64; 3]>,
    /// And to those of `x², xy, y²`; empty where it is linear or constant.
    second: Vec<[f64; 3]>,
    frame: CellFrame,
    pub linear: bool,
}

/// The coefficients of `N` functions: of `1, x, y`, and of `x², xy, y²` where there are any.
pub struct Coefficients<const N: usize> {
    first: [[f64; N]; 3],
    second: Option<[[f64; N]; 3]>,
}

impl<const N: usize> Coefficients<N> {
    /// Those of `1, x, y`.
    pub fn linear(&self) -> [[f64; N]; 3] {
        self.first
    }
}

impl Fit {
    /// The fit of the points that `counts` picks, for the `places` in a cell of some `order`; `None` where none is near.
    pub fn new(
        points: &Points<2>,
        (around, held): (&Around, &Held),
        rings: &mut Rings,
        (frame, order): (&CellFrame, usize),
        places: &[Place],
        counts: &dyn Fn(u32) -> bool,
    ) -> Option<Self> {
        let (mut numbers, mut weights) = (Vec::new(), Vec::new());
        for r in 0..=if order > 2 { NEAR_RINGS as i32 } else { -1 } {
            let before = numbers.len();
            for &c in rings.ring(r as usize, around) {
                numbers.extend(held.points(c).iter().copied().filter(|&p| counts(p)));
            }
            weights.extend(numbers[before..].iter().map(|&p| RING.powi(r) * points.volume(p as usize)));
            if let Some((shares, second)) = quadratic(points, &numbers, &weights, frame, places) {
                return Some(Self { points: numbers, shares, second, frame: *frame, linear: true });
            }
        }
        (numbers, weights) = (Vec::new(), Vec::new());
        for r in 0..=RINGS {
            let factor = RING.powi(r as i32);
            let before = numbers.len();
            for &c in rings.ring(r, around) {
                numbers.extend(held.points(c).iter().copied().filter(|&p| counts(p)));
            }
            weights.extend(numbers[before..].iter().map(|&p| factor * points.volume(p as usize)));
            if (numbers.len() > before || r == 0)
                && let Some(shares) = linear(points, &numbers, &weights, frame, places)
            {
                return Some(Self { points: numbers, shares, second: Vec::new(), frame: *frame, linear: true });
            }
        }
        // The mean of the nearest points.
        (numbers, weights) = (Vec::new(), Vec::new());
        for r in 0..=RINGS {
            for &c in rings.ring(r, around) {
                numbers.extend(held.points(c).iter().copied().filter(|&p| counts(p)));
            }
            weights.extend(numbers.iter().map(|&p| points.volume(p as usize)));
            if !numbers.is_empty() {
                let sum: f64 = weights.iter().sum();
                let shares = weights.iter().map(|w| [w / sum, 0.0, 0.0]).collect();
                return Some(Self { points: numbers, shares, second: Vec::new(), frame: *frame, linear: false });
            }
        }
        None
    }

    /// The coefficients of the function that is nearest to `values`, given by point.
    pub fn coefficients<const N: usize>(&self, values: &[[f64; N]]) -> Coefficients<N> {
        self.sums(|p| &values[p])
    }

    /// The coefficients of the function that is nearest to one number of each point.
    pub fn coefficients_of(&self, value: impl Fn(usize) -> f64) -> Coefficients<1> {
        self.sums(|p| [value(p)])
    }

    fn sums<const N: usize, V: Borrow<[f64; N]>>(&self, value: impl Fn(usize) -> V) -> Coefficients<N> {
        let sum = |shares: &[[f64; 3]]| {
            let mut sum = [[0.0; N]; 3];
            for (&p, shares) in self.points.iter().zip(shares) {
                let value = value(p as usize);
                for (sum, share) in sum.iter_mut().zip(shares) {
                    for (sum, value) in sum.iter_mut().zip(value.borrow()) {
                        *sum += share * value;
                    }
                }
            }
            sum
        };
        Coefficients { first: sum(&self.shares), second: (!self.second.is_empty()).then(|| sum(&self.second)) }
    }

    /// The function at a place (m).
    pub fn at<const N: usize>(&self, Coefficients { first, second }: &Coefficients<N>, x: &[f64; 2]) -> [f64; N] {
        let [x, y] = self.frame.local(x);
        let mut value = std::array::from_fn(|k| first[0][k] + x * first[1][k] + y * first[2][k]);
        if let Some(second) = second {
            for (k, value) in value.iter_mut().enumerate() {
                *value += x * x * second[0][k] + x * y * second[1][k] + y * y * second[2][k];
            }
        }
        value
    }
}

/// What the value at each point adds to the coefficients of `1, x, y` and of `x², xy, y²`.
type OfSecondDegree = (Vec<[f64; 3]>, Vec<[f64; 3]>);

/// The shares of the points in a quadratic fit; `None` as of [`linear`].
fn quadratic(
    points: &Points<2>,
    numbers: &[u32],
    weights: &[f64],
    frame: &CellFrame,
    places: &[Place],
) -> Option<OfSecondDegree> {
    let local = |p: u32| frame.local(&points.position[p as usize]);
    let weighed = || numbers.iter().zip(weights).map(|(&p, &weight)| (weight, local(p)));
    let fit = Quadratic::of(weighed())?;
    let shares: Vec<_> = weighed().map(|(weight, x)| fit.shares(weight, x)).collect();
    for place in places {
        let at = frame.local(&place.x);
        let most: f64 = shares.iter().map(|share| quadratic::value(share, at).abs()).sum();
        if most.is_nan() || most > MOST {
            return None;
        }
    }
    Some(shares.into_iter().map(|[a, b, c, d, e, f]| ([a, b, c], [d, e, f])).unzip())
}

/// The shares of the points in a linear fit; `None` where they are too few or lie so that it depends on them too much.
fn linear(
    points: &Points<2>,
    numbers: &[u32],
    weights: &[f64],
    frame: &CellFrame,
    places: &[Place],
) -> Option<Vec<[f64; 3]>> {
    if numbers.len() < 4 {
        return None;
    }
    // Orthogonal functions, 1, x − x̄ and y − ȳ − a (x − x̄): what is little beside the others keeps its digits.
    let local: Vec<[f64; 2]> = numbers.iter().map(|&p| frame.local(&points.position[p as usize])).collect();
    let sum = |value: &dyn Fn(usize) -> f64| (0..local.len()).map(|i| weights[i] * value(i)).sum::<f64>();
    let all = sum(&|_| 1.0);
    let mean = [0, 1].map(|d| sum(&|i| local[i][d]) / all);
    let off = |x: &[f64; 2]| [x[0] - mean[0], x[1] - mean[1]];
    let along = sum(&|i| off(&local[i])[0].powi(2));
    let slope = sum(&|i| off(&local[i])[0] * off(&local[i])[1]) / along;
    let functions = |x: &[f64; 2]| {
        let [x, y] = off(x);
        [1.0, x, y - slope * x]
    };
    let across = sum(&|i| functions(&local[i])[2].powi(2));
    let share = |i: usize| {
        let [one, x, y] = functions(&local[i]);
        [one / all, x / along, y / across].map(|value| weights[i] * value)
    };
    let shares: Vec<[f64; 3]> = (0..local.len()).map(share).collect();
    for place in places {
        let at = functions(&frame.local(&place.x));
        let most: f64 = shares.iter().map(|share| share.iter().zip(&at).map(|(s, a)| s * a).sum::<f64>().abs()).sum();
        // It is not a number where the points are on a line.
        if most.is_nan() || most > MOST {
            return None;
        }
    }
    let of_frame = |[one, x, y]: [f64; 3]| [one - x * mean[0] - y * (mean[1] - slope * mean[0]), x - slope * y, y];
    Some(shares.into_iter().map(of_frame).collect())
}

#[cfg(test)]
mod tests {
    use super::super::places::Places;
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::builder::rectangle;
    use crate::mesh::locate::Locator;
    use crate::mesh::shape::CellKind;

    /// Points anywhere, as few as wanted in each cell.
    fn scattered(mesh: &Mesh<2>, many: usize) -> Points<2> {
        let at = |i: usize| [0.754_877_666_2, 0.569_840_290_9].map(|g| (0.5 + g * i as f64).fract());
        let position: Vec<[f64; 2]> = (0..many).map(at).collect();
        let locator = Locator::new(mesh);
        Points {
            cell: position.iter().map(|x| locator.locate(mesh, x, None).unwrap().0).collect(),
            initial_volume: (0..many).map(|i| 1.0 + (0.3 * i as f64).sin().abs()).collect(),
            deformation: vec![crate::tensor::Tensor::identity(); many],
            position,
            ..Points::default()
        }
    }

    #[test]
    fn linear_functions_come_back_however_the_points_lie_and_no_value_counts_more_than_three_times() {
        for (kind, many) in [(CellKind::T6, 1500), (CellKind::T6, 300), (CellKind::Q9, 400), (CellKind::T3, 500)] {
            let mesh = rectangle(kind, 1.0, 1.0, 8, 8, 0.2, 4);
            let points = scattered(&mesh, many);
            let values: Vec<[f64; 2]> = points
                .position
                .iter()
                .map(|x| [3.0 - 2.0 * x[0] + x[1], if x[0] > 0.4 { 1.0 } else { -1.0 }])
                .collect();
            let (around, held) = (Around::of(&mesh), Held::new(mesh.cells.len(), &points.cell));
            let (rule, mut linear) = (Places::new(), 0);
            for c in 0..mesh.cells.len() {
                let mut places = Vec::new();
                rule.full::<PlaneStrain>(&mesh, c, &mut places);
                let frame = CellFrame::of(&mesh, c);
                let mut rings = Rings::of(c as u32);
                let fit = Fit::new(&points, (&around, &held), &mut rings, (&frame, 2), &places, &|_| true).unwrap();
                let coefficients = fit.coefficients(&values);
                linear += usize::from(fit.linear);
                for place in &places {
                    let [line, jump] = fit.at(&coefficients, &place.x);
                    assert!(!fit.linear || (line - (3.0 - 2.0 * place.x[0] + place.x[1])).abs() < 1e-12);
                    assert!(jump.abs() <= MOST + 1e-12);
                }
            }
            assert!(linear == mesh.cells.len(), "{kind:?}: {linear} of {} cells", mesh.cells.len());
        }
    }

    /// In cells of third order quadratic functions come back where cells have points enough, and linear ones elsewhere.
    #[test]
    fn quadratic_functions_come_back_in_cells_of_third_order() {
        let mesh = rectangle(CellKind::Q16, 1.0, 1.0, 6, 6, 0.0, 4);
        for many in [900, 300, 100] {
            let points = scattered(&mesh, many);
            let line = |[x, y]: [f64; 2]| 3.0 - 2.0 * x + y;
            let curve = |[x, y]: [f64; 2]| x * x - 3.0 * x * y + 0.5 * y * y;
            let values: Vec<[f64; 3]> = points
                .position
                .iter()
                .map(|&x| [line(x), line(x) + curve(x), if x[0] > 0.4 { 1.0 } else { -1.0 }])
                .collect();
            let (around, held) = (Around::of(&mesh), Held::new(mesh.cells.len(), &points.cell));
            let (rule, mut quadratic) = (Places::new(), 0);
            for c in 0..mesh.cells.len() {
                let mut places = Vec::new();
                rule.full::<PlaneStrain>(&mesh, c, &mut places);
                let frame = CellFrame::of(&mesh, c);
                let mut rings = Rings::of(c as u32);
                let fit = Fit::new(&points, (&around, &held), &mut rings, (&frame, 3), &places, &|_| true).unwrap();
                let coefficients = fit.coefficients(&values);
                quadratic += usize::from(!fit.second.is_empty());
                for place in &places {
                    let [linear, second, jump] = fit.at(&coefficients, &place.x);
                    assert!((linear - line(place.x)).abs() < 1e-11);
                    assert!(fit.second.is_empty() || (second - line(place.x) - curve(place.x)).abs() < 1e-11);
                    assert!(jump.abs() <= MOST + 1e-12);
                }
            }
            println!("{many} points: {quadratic} of 36 cells quadratic");
            assert!(if many == 900 { quadratic == 36 } else { quadratic > 0 }, "{many}: {quadratic}");
        }
    }

    #[test]
    fn one_point_gives_its_value_and_points_on_a_line_take_neighbours_in() {
        let mesh = rectangle(CellKind::T6, 1.0, 1.0, 2, 2, 0.0, 1);
        let mut points = scattered(&mesh, 1);
        let mut places = Vec::new();
        Places::new().full::<PlaneStrain>(&mesh, 0, &mut places);
        let (around, frame) = (Around::of(&mesh), CellFrame::of(&mesh, 0));
        let held = Held::new(mesh.cells.len(), &points.cell);
        let fit = Fit::new(&points, (&around, &held), &mut Rings::of(0), (&frame, 2), &places, &|_| true).unwrap();
        assert_eq!(fit.at(&fit.coefficients(&[[7.0]]), &places[0].x), [7.0]);
        assert!(Fit::new(&points, (&around, &held), &mut Rings::of(0), (&frame, 2), &places, &|_| false).is_none());

        // Six on a line in the cell, and what is scattered in the others.
        points = scattered(&mesh, 60);
        let locator = Locator::new(&mesh);
        for p in 0..60 {
            if points.cell[p] == 0 {
                points.position[p] = [0.1 + 0.02 * (p % 7) as f64; 2];
                points.cell[p] = locator.locate(&mesh, &points.position[p], Some(0)).unwrap().0;
            }
        }
        let held = Held::new(mesh.cells.len(), &points.cell);
        let fit = Fit::new(&points, (&around, &held), &mut Rings::of(0), (&frame, 2), &places, &|_| true).unwrap();
        assert!(fit.linear && fit.points.iter().any(|&p| points.cell[p as usize] != 0));
    }

    /// Points of cells that do not count are held by none, and the numbers of the others stay.
    #[test]
    fn cells_that_do_not_count_hold_nothing() {
        let held = Held::of(&[true, false, true], &[2, 1, 0, 1, 2]);
        assert_eq!([0, 1, 2].map(|c| held.points(c)), [&[2][..], &[], &[0, 4]]);
    }
}
