//! The soil at a place: at a point, in a box or along a line; and over a region.

use super::boundary;
use super::warning::WARNING;
use super::watch::{Place, Quantity, Watch, WatchedOn};
use crate::geometry::cross;
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::soil::{Probe, Weights};
use crate::step::{Scene, State};
use crate::tensor::{deviatoric, mean};
use crate::term::excess_pressure;
use std::cell::OnceCell;
use std::marker::PhantomData;

/// Stations along a line, each in the middle of its part, over which a mean is taken.
const STATIONS: usize = 100;
/// Both sides of a line, in its length (-), on which it is seen how much of it is soil: on a wall only one of them has soil.
const BESIDE: f64 = 1e-7;

/// The soil of a state, in which places are looked up.
pub struct Soil<'a, const D: usize, K> {
    pub scene: &'a Scene<D>,
    pub state: &'a State<D>,
    /// The material points where they are, and where they were seeded: made when first asked for.
    now: OnceCell<Probe>,
    seeded: OnceCell<Probe>,
    kinematics: PhantomData<K>,
}

impl<'a, const D: usize, K: Kinematics<D>> Soil<'a, D, K> {
    pub fn new(scene: &'a Scene<D>, state: &'a State<D>) -> Self {
        Self { scene, state, now: OnceCell::new(), seeded: OnceCell::new(), kinematics: PhantomData }
    }

    /// The points at `place` (m), given their volumes (m³).
    fn probe(&self, place: &[[f64; D]], volume: impl Fn(usize) -> f64) -> Probe {
        let area: Vec<f64> = place.iter().enumerate().map(|(p, x)| volume(p) / K::measure(x)).collect();
        Probe::new(place.iter().map(plane).collect(), &area, self.state.points.region.clone())
    }

    fn now(&self) -> &Probe {
        let points = &self.state.points;
        self.now.get_or_init(|| self.probe(&points.position, |p| points.volume(p)))
    }

    fn seeded(&self) -> &Probe {
        let points = &self.state.points;
        self.seeded.get_or_init(|| self.probe(&points.origin, |p| points.initial_volume[p]))
    }

    /// A quantity at a place; `None` where there is no soil to have one.
    pub fn at(&self, place: &Place, quantity: Quantity) -> Option<f64> {
        let points = &self.state.points;
        let fitted = |weights: Weights| {
            weights.into_iter().map(|(p, w)| Some(w * of_point(points, p, quantity, self.scene)?)).sum()
        };
        match place {
            Place::Fixed(x) => fitted(self.now().at(x)?),
            Place::Followed(x) => fitted(self.seeded().at(x)?),
            Place::Box([low, high]) => {
                let within = |x: [f64; 2]| (0..2).all(|d| low[d] <= x[d] && x[d] <= high[d]);
                let members = (0..points.len()).filter(|&p| within(plane(&points.position[p])));
                over(members.map(|p| (points, p)), quantity, self.scene)
            }
            Place::Line(ends) if quantity == Quantity::Thickness => Some(self.thickness(ends)),
            Place::Line([a, b]) => {
                let station = |i: usize| (i as f64 + 0.5) / STATIONS as f64;
                let stations = (0..STATIONS).map(|i| [0, 1].map(|d| a[d] + station(i) * (b[d] - a[d])));
                let values: Vec<f64> = stations.filter_map(|x| fitted(self.now().at(&x)?)).collect();
                (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
            }
        }
    }

    /// The length (m) of a line within the surface of the material points.
    fn thickness(&self, &[a, b]: &[[f64; 2]; 2]) -> f64 {
        const { assert!(D == 2, "the surface is a line in the plane only") };
        let surface = &self.state.weights.boundary;
        let nodes = boundary::nodes(self.scene, self.state);
        let corner = |piece| plane(&crate::surface::place(&self.scene.mesh, &nodes, piece, 0.0));
        let loops: Vec<Vec<[f64; 2]>> =
            (0..surface.loops()).map(|l| surface.pieces(l).iter().map(corner).collect()).collect();
        let across = [a[1] - b[1], b[0] - a[0]].map(|v| BESIDE * v);
        let beside = |side: f64| within(&loops, [a, b].map(|x| [0, 1].map(|d| x[d] + side * across[d])));
        beside(1.0).max(beside(-1.0)) * (b[0] - a[0]).hypot(b[1] - a[1])
    }
}

fn plane<const D: usize>(x: &[f64; D]) -> [f64; 2] {
    [x[0], x[1]]
}

/// The part (-) of a line that is inside closed loops: where it is crossed an odd number of times farther on.
fn within(loops: &[Vec<[f64; 2]>], [a, b]: [[f64; 2]; 2]) -> f64 {
    let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    let along = way(a, b);
    let edges = loops.iter().flat_map(|x| (0..x.len()).map(move |i| [x[i], x[(i + 1) % x.len()]]));
    let crossing = |[p, q]: [[f64; 2]; 2]| {
        let [sp, sq] = [p, q].map(|x| cross(&along, &way(a, x)));
        let edge = way(p, q);
        // One end of an edge counts, or a line through a corner would cross twice.
        ((sp > 0.0) != (sq > 0.0)).then(|| cross(&way(a, p), &edge) / cross(&along, &edge))
    };
    let mut places: Vec<f64> = edges.filter_map(crossing).collect();
    places.sort_by(f64::total_cmp);
    let pairs = places.chunks_exact(2);
    sum(pairs.map(|pair| pair[1].min(1.0) - pair[0].max(0.0)).filter(|length| *length > 0.0))
}

/// The sum; of nothing 0, where that of the library is −0.
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |sum, v| sum + v)
}

/// The points of a region, of whatever kind.
pub fn members<const D: usize>(state: &State<D>, region: u16) -> impl Iterator<Item = (&Points<D>, usize)> + Clone {
    let all = [&state.points, &state.fem].into_iter().flat_map(|points| (0..points.len()).map(move |p| (points, p)));
    all.filter(move |(points, p)| points.region[*p] == region)
}

/// A quantity of some points: a sum, an extreme, or a mean. Without points only sums have a value.
pub fn over<'a, const D: usize>(
    members: impl Iterator<Item = (&'a Points<D>, usize)> + Clone,
    quantity: Quantity,
    scene: &Scene<D>,
) -> Option<f64> {
    let coordinate = |d: usize| members.clone().map(move |(points, p)| points.position[p][d]);
    match quantity {
        Quantity::Mass => Some(sum(members.map(|(points, p)| points.mass[p]))),
        Quantity::Volume => Some(sum(members.map(|(points, p)| points.volume(p)))),
        Quantity::Least(d) => coordinate(d).reduce(f64::min),
        Quantity::Most(d) => coordinate(d).reduce(f64::max),
        _ => mean_over(members, |points, p| of_point(points, p, quantity, scene).unwrap_or(0.0)),
    }
}

/// The mean of a value over points, by the volume that each had when seeded: points that are split and merged leave it.
pub fn mean_over<'a, const D: usize>(
    members: impl Iterator<Item = (&'a Points<D>, usize)>,
    value: impl Fn(&Points<D>, usize) -> f64,
) -> Option<f64> {
    let (volume, sum) = members.fold((0.0, 0.0), |(volume, sum), (points, p)| {
        let v = points.initial_volume[p];
        (volume + v, sum + v * value(points, p))
    });
    (volume > 0.0).then(|| sum / volume)
}

/// A quantity of a point; `None` of one that only bodies have.
fn of_point<const D: usize>(points: &Points<D>, p: usize, quantity: Quantity, scene: &Scene<D>) -> Option<f64> {
    Some(match quantity {
        Quantity::Displacement(d) => points.displacement(p)[d],
        Quantity::Velocity(d) => points.velocity.get(p).map_or(0.0, |v| v[d]),
        Quantity::PorePressure => excess_pressure(&scene.carried, points, p),
        Quantity::Stress(k) => points.stress[p][k],
        Quantity::MeanStress => mean(&points.stress[p]),
        Quantity::DeviatoricStress => deviatoric(&points.stress[p]),
        Quantity::Strain(k) => points.strain(p)[k],
        Quantity::PlasticStrain => points.plastic_strain[p],
        _ => return None,
    })
}

/// A warning for each entry whose place has no soil after a step, given the row of the history.
pub fn found(watches: &[Watch], row: &[Option<f64>], time: f64) -> Vec<String> {
    let first = row.len() - watches.iter().map(|watch| watch.quantities.len()).sum::<usize>();
    let mut rest = &row[first..];
    let mut warnings = Vec::new();
    for watch in watches {
        let (own, others) = rest.split_at(watch.quantities.len());
        rest = others;
        if own.contains(&None) {
            let whereof = match &watch.on {
                WatchedOn::Region(_) => "its region has no points".to_owned(),
                WatchedOn::Soil(Place::Followed(x)) => format!("the soil that was seeded at {x:?} m is not there"),
                _ => "there is no soil at its place".to_owned(),
            };
            warnings.push(format!(
                "{WARNING}the history `{}` has empty fields from t = {time:.6} s on, as long as {whereof}",
                watch.name
            ));
        }
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_inside_between_its_crossings() {
        let square = |x: f64, y: f64, side: f64| vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        let mut hole = square(1.0, 1.0, 1.0);
        hole.reverse();
        let loops = [square(0.0, 0.0, 4.0), hole, square(6.0, 0.0, 1.0)];
        for (line, part) in [
            ([[-1.0, 0.5], [9.0, 0.5]], 0.5),
            ([[-1.0, 1.5], [9.0, 1.5]], 0.3),
            ([[3.0, 3.0], [3.0, 5.0]], 0.5),
            ([[3.0, 5.0], [3.0, 3.0]], 0.5),
            ([[-1.0, -1.0], [4.0, 4.0]], 0.6),
            ([[5.0, -1.0], [5.0, 4.0]], 0.0),
            ([[1.5, 1.2], [1.5, 1.8]], 0.0),
        ] {
            assert!((within(&loops, line) - part).abs() < 1e-12, "{line:?}: {}", within(&loops, line));
        }
    }
}
