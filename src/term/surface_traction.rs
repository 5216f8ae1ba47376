//! Tractions on the active boundary (reference 1 of docs/theory.md, §2.5): `−∫ N_I t dS` over its pieces inside cells, where they are in the trial
//! state, per area of the surface as it is.
//!
//! `t dS = (−p R t̂ + s t̂ + q) dl`, `t̂` along the surface with the material on its left, `R` a turn to the right, which
//! makes it the normal outwards; `p`, `s` and `q` are pressure, shear and a traction in a fixed direction. With
//! `x(ξ) = Σ N_I (X_I + u_I)` along a piece all of it is a function of the nodes of one cell: that whose points bear it,
//! as they bear the weight of what is behind it. The force of a pressure on
//! part of a surface depends on the path: the tangent is not symmetric. Walls are not loaded.

use super::hydrostatic::Hydrostatic;
use super::{Assembly, Frame, Role, Term, Trial};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use crate::surface::{NO_REGION, Piece};
use crate::system::Local;
use crate::time_value::TimeValue;
use std::f64::consts::TAU;
use std::marker::PhantomData;

/// A load on the active boundary in one phase.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceLoad {
    pub phase: usize,
    /// The region whose surface is loaded; all where `None`.
    pub region: Option<u16>,
    /// Compression positive.
    pub pressure: Option<Hydrostatic>,
    /// Along the surface (kPa), positive with the material on the left.
    pub shear: TimeValue,
    /// In fixed directions (kPa).
    pub components: [TimeValue; 2],
    /// From and to (m), in x and y: what of the surface is in there as a step begins.
    pub within: Option<[[f64; 2]; 2]>,
}

impl SurfaceLoad {
    /// Whether a piece takes part.
    pub fn acts_on(&self, phase: usize, piece: &Piece) -> bool {
        let of_region = self.region.map_or(piece.region != NO_REGION, |region| region == piece.region);
        self.phase == phase && !piece.wall && of_region
    }

    /// Pressure, shear and components (kPa) at the place `x` (m) and a time (s) in the phase.
    pub fn at(&self, x: &[f64; 2], time: f64) -> (f64, f64, [f64; 2]) {
        let pressure = self.pressure.as_ref().map_or(0.0, |head| head.at(time).at(x[1])[0]);
        (pressure, self.shear.at(time), [0, 1].map(|d| self.components[d].at(time)))
    }

    /// The part of a line from `a` to `b` that is within: shares of its length.
    pub fn clip(&self, a: &[f64; 2], b: &[f64; 2]) -> Option<[f64; 2]> {
        let [mut from, mut to] = [0.0f64, 1.0];
        for (d, [low, high]) in self.within.iter().flat_map(|within| within.iter().enumerate()) {
            let way = b[d] - a[d];
            if way == 0.0 {
                if a[d] < *low || a[d] > *high {
                    return None;
                }
                continue;
            }
            let ends = [(low - a[d]) / way, (high - a[d]) / way];
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        (from < to).then_some([from, to])
    }
}

/// Loads on the active boundary.
pub struct SurfaceTraction<K> {
    loads: Vec<SurfaceLoad>,
    kinematics: PhantomData<K>,
}

impl<K> SurfaceTraction<K> {
    pub fn new(loads: Vec<SurfaceLoad>) -> Self {
        Self { loads, kinematics: PhantomData }
    }
}

/// A place of a piece: functions of the cell's nodes and their slopes along it, `x` (m) and `dx` (m) by the parameter.
struct Place {
    n: [f64; MAX_NODES],
    slope: [f64; MAX_NODES],
    x: [f64; 2],
    t: [f64; 2],
}

impl Place {
    /// That at the share `s` of `piece`, the nodes of whose cell are at `x`.
    fn of(kind: CellKind, piece: &Piece, s: f64, x: &[[f64; 2]]) -> Self {
        let (xi, way) = (piece.in_host.at(s), piece.in_host.rate(s));
        let mut place = Self { n: [0.0; MAX_NODES], slope: [0.0; MAX_NODES], x: [0.0; 2], t: [0.0; 2] };
        let mut derivatives = [[0.0; 3]; MAX_NODES];
        kind.values(&xi, &mut place.n);
        kind.derivatives(&xi, &mut derivatives);
        for (i, x) in x.iter().enumerate() {
            place.slope[i] = derivatives[i][0] * way[0] + derivatives[i][1] * way[1];
            for d in 0..2 {
                place.x[d] += place.n[i] * x[d];
                place.t[d] += place.slope[i] * x[d];
            }
        }
        place
    }
}

/// The kind of the cell that bears a piece, and where its nodes (m) are in a displacement.
fn corners(frame: &Frame<2>, piece: &Piece, displacement: &[[f64; 2]]) -> (CellKind, [[f64; 2]; MAX_NODES]) {
    let host = piece.host as usize;
    let mut x = [[0.0; 2]; MAX_NODES];
    for (x, &n) in x.iter_mut().zip(frame.mesh.cells.nodes(host)) {
        *x = [0, 1].map(|d| frame.mesh.nodes[n as usize][d] + displacement[n as usize][d]);
    }
    (frame.mesh.cells.kind[host], x)
}

impl<K: Kinematics<2>> Term<2> for SurfaceTraction<K> {
    fn role(&self) -> Role {
        Role::External
    }

    fn symmetric(&self) -> bool {
        false
    }

    fn idle_load(&self, frame: &Frame<2>, displacement: &[[f64; 2]], phase: usize) -> Option<String> {
        let meets = |load: &SurfaceLoad| {
            let mut pieces = frame.boundary.iter().filter(|piece| load.acts_on(phase, piece));
            pieces.any(|piece| {
                let (kind, x) = corners(frame, piece, displacement);
                let [a, b] = [0.0, 1.0].map(|s| Place::of(kind, piece, s, &x[..kind.node_count()]).x);
                load.clip(&a, &b).is_some()
            })
        };
        let idle = self.loads.iter().any(|load| load.phase == phase && !meets(load));
        idle.then(|| {
            "a load on the surface meets no free surface of the material: it does nothing until some comes".into()
        })
    }

    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        let compute = |piece: &Piece, local: &mut Local| {
            for load in self.loads.iter().filter(|load| load.acts_on(trial.phase, piece)) {
                self.add(frame, trial, piece, load, local);
            }
            Ok(())
        };
        if self.loads.iter().all(|load| load.phase != trial.phase) {
            return Ok(());
        }
        let coupling = |piece: &Piece| frame.coupling[piece.host as usize] as usize;
        out.scatter(frame.pattern, frame.boundary, coupling, compute)
    }
}

impl<K: Kinematics<2>> SurfaceTraction<K> {
    /// Adds force and tangent of one load on one piece.
    fn add(&self, frame: &Frame<2>, trial: &Trial<2>, piece: &Piece, load: &SurfaceLoad, local: &mut Local) {
        let mut range = [0.0, 1.0];
        if load.within.is_some() {
            let (kind, before) = corners(frame, piece, trial.converged);
            let count = kind.node_count();
            let [a, b] = [0.0, 1.0].map(|s| Place::of(kind, piece, s, &before[..count]).x);
            let Some(part) = load.clip(&a, &b) else { return };
            range = part;
        }
        let (kind, now) = corners(frame, piece, trial.between);
        let count = kind.node_count();
        let head = load.pressure.as_ref().map(|head| head.at(trial.time));
        let (shear, q) = (load.shear.at(trial.time), [0, 1].map(|d| load.components[d].at(trial.time)));
        let share = 1.0 - trial.alpha_f;
        for (xi, weight) in rule(CellKind::Line2, 5) {
            let s = range[0] + 0.5 * (1.0 + xi[0]) * (range[1] - range[0]);
            let weight = 0.5 * weight * (range[1] - range[0]);
            let Place { n, slope, x, t } = Place::of(kind, piece, s, &now[..count]);
            let [p, growth, _] = head.map_or([0.0; 3], |head| head.at(x[1]));
            let (measure, by_radius) = (K::measure(&x), if K::HOOP { TAU } else { 0.0 });
            let length = t[0].hypot(t[1]).max(f64::MIN_POSITIVE);
            let normal = [t[1], -t[0]];
            let load = [0, 1].map(|d| -p * normal[d] + shear * t[d] + q[d] * length);
            for i in 0..count {
                for d in 0..2 {
                    local.vector[2 * i + d] -= weight * n[i] * measure * load[d];
                }
            }
            if local.matrix.is_empty() {
                continue;
            }
            // The derivative of the load by the displacement of node j in direction e.
            for j in 0..count {
                for e in 0..2 {
                    for d in 0..2 {
                        let turned = if d == e {
                            0.0
                        } else if d == 0 {
                            slope[j]
                        } else {
                            -slope[j]
                        };
                        let mut by = measure * (q[d] * slope[j] * t[e] / length - p * turned);
                        if d == e {
                            by += measure * shear * slope[j];
                        }
                        if e == 0 {
                            by += by_radius * n[j] * load[d];
                        } else {
                            by -= measure * growth * n[j] * normal[d];
                        }
                        for i in 0..count {
                            local.matrix[(2 * i + d) * local.size + 2 * j + e] -= share * weight * n[i] * by;
                        }
                    }
                }
            }
        }
    }
}
