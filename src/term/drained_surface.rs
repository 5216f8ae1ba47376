//! The active boundary as one that drains: no excess pressure of the pore water on it, wherever it runs through the cells.
//!
//! Nitsche's method, on the pieces of the boundary as the step begins, as the flow in the pores is ([`super::PoreWater`]), `n` outwards:
//!
//! ```text
//! R_p −= Δt ∫ { −L n·κ∇p − p n·κ∇L + β L p } dS,    β = γ n·κn |Γ|/V
//! ```
//!
//! over the linear shape functions `L`. The first part is the flow that leaves, the second makes the system symmetric, the third holds the pressure at
//! zero. `|Γ|` is the boundary that a cell bears and `V` what its points weigh: the flow through a cell however it is cut then stays
//! less than what it loses, where `∇p` is one in all of the cell and γ above 1 (Dolbow & Harari 2009). What leaves through all of
//! it is `Δt ∫ (−n·κ∇p + β p) dS`. Walls are tight, and so is what a structure covers as the step begins.

use super::water::{self, Corners, Porous};
use super::{Assembly, Frame, Term, Trial};
use crate::error::Result;
use crate::geometry::dot;
use crate::kinematics::Kinematics;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use crate::surface::{NO_REGION, Piece};
use crate::system::Local;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// γ (-) in triangles: twice what is needed.
const GAMMA: f64 = 2.0;
/// γ (-) in quadrangles, where gradients vary within a cell.
const GAMMA_OF_QUADRANGLES: f64 = 4.0;

/// The active boundary of porous soil, drained while water flows.
pub struct DrainedSurface<K> {
    /// The porous soil of each material by number; `None` without water.
    porous: Vec<Option<Porous>>,
    /// The region whose surface drains; all where `None`.
    region: Option<u16>,
    /// What a unit of the unknowns stands for (kPa/m).
    unit: f64,
    /// Whether water flows in each phase.
    flows: Vec<bool>,
    kinematics: PhantomData<K>,
}

/// A place of a piece as the step begins.
struct Place {
    shapes: Corners,
    /// `∇L` (1/m).
    gradients: [[f64; 2]; water::MOST],
    /// Outwards, as long as the piece by its parameter (m), with the measure of the place.
    normal: [f64; 2],
    area: f64,
}

/// The cell that bears a piece.
struct Host {
    kind: CellKind,
    /// Its nodes (m) as the step begins.
    nodes: [[f64; 2]; MAX_NODES],
    /// `k/γ_w` (m²/(kPa s)) of its points in the mean.
    mobility: [f64; 2],
    /// What its points weigh (m³).
    volume: f64,
    /// Area (m²) of the boundary that it bears.
    area: f64,
}

impl Host {
    fn place<K: Kinematics<2>>(&self, piece: &Piece, s: f64) -> Place {
        let (xi, way) = (piece.in_host.at(s), piece.in_host.rate(s));
        let (mut n, mut slopes) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        self.kind.values(&xi, &mut n);
        self.kind.derivatives(&xi, &mut slopes);
        // ∂x/∂ξ.
        let (mut x, mut by) = ([0.0; 2], [[0.0; 2]; 2]);
        for (i, node) in self.nodes.iter().enumerate() {
            for d in 0..2 {
                x[d] += n[i] * node[d];
                for e in 0..2 {
                    by[d][e] += slopes[i][e] * node[d];
                }
            }
        }
        let determinant = by[0][0] * by[1][1] - by[0][1] * by[1][0];
        let shapes_by = [0, 1].map(|e| water::corner_shapes(self.kind, &slopes.map(|slope| slope[e])));
        let gradients = std::array::from_fn(|a| {
            let [s, t] = [shapes_by[0][a], shapes_by[1][a]];
            [(by[1][1] * s - by[1][0] * t) / determinant, (by[0][0] * t - by[0][1] * s) / determinant]
        });
        let along = [0, 1].map(|d| by[d][0] * way[0] + by[d][1] * way[1]);
        let measure = K::measure(&x);
        let normal = [measure * along[1], -measure * along[0]];
        Place { shapes: water::corner_shapes(self.kind, &n), gradients, normal, area: normal[0].hypot(normal[1]) }
    }
}

impl<K: Kinematics<2>> DrainedSurface<K> {
    /// `porous[m]` is the soil of material `m`, `unit` that of [`crate::step::Scene`]; water `flows` in some phases.
    pub fn new(porous: Vec<Option<Porous>>, region: Option<u16>, unit: f64, flows: Vec<bool>) -> Self {
        Self { porous, region, unit, flows, kinematics: PhantomData }
    }

    fn drains(&self, piece: &Piece) -> bool {
        !piece.wall && self.region.map_or(piece.region != NO_REGION, |region| region == piece.region)
    }

    /// The cells with water that bear open pieces, by number.
    fn hosts(&self, frame: &Frame<2>, converged: &[[f64; 2]]) -> BTreeMap<u32, Host> {
        let mut hosts = BTreeMap::new();
        for piece in frame.open.iter().filter(|piece| self.drains(piece)) {
            let host = hosts.entry(piece.host).or_insert_with(|| self.host(frame, converged, piece.host));
            if let Some(host) = host {
                host.area += host.place::<K>(piece, 0.5).area;
            }
        }
        hosts.into_iter().filter_map(|(cell, host)| Some((cell, host?))).collect()
    }

    /// A cell that bears pieces, of no area yet; `None` where it has no water.
    fn host(&self, frame: &Frame<2>, converged: &[[f64; 2]], cell: u32) -> Option<Host> {
        let cell_points = frame.interpolation.of_cell(cell)?;
        let (mut volume, mut mobility) = (0.0, [0.0; 2]);
        for entries in frame.interpolation.entries::<K>(cell_points) {
            let p = entries.point;
            if let Some(soil) = frame.points.by_material(p, &self.porous) {
                let weight = entries.weight * frame.points.deformation[p].determinant();
                volume += weight;
                mobility = [0, 1].map(|d| mobility[d] + weight * soil.mobility[d]);
            }
        }
        if volume <= 0.0 || mobility == [0.0; 2] {
            return None;
        }
        let mut nodes = [[0.0; 2]; MAX_NODES];
        for (x, &n) in nodes.iter_mut().zip(frame.mesh.cells.nodes(cell as usize)) {
            *x = [0, 1].map(|d| frame.mesh.nodes[n as usize][d] + converged[n as usize][d]);
        }
        let kind = frame.mesh.cells.kind[cell as usize];
        Some(Host { kind, nodes, mobility: mobility.map(|sum| sum / volume), volume, area: 0.0 })
    }

    /// Calls `see` with the shape functions at each place of a piece and, over the time and the part of the piece that it stands for, their flow
    /// outwards `−n·κ∇L` and β (m³/kPa).
    fn visit(host: &Host, trial: &Trial<2>, piece: &Piece, mut see: impl FnMut(&Corners, &Corners, f64)) {
        let gamma = if host.kind.is_simplex() { GAMMA } else { GAMMA_OF_QUADRANGLES };
        let hold = host.area / host.volume * gamma;
        for (xi, weight) in rule(CellKind::Line2, 3) {
            let Place { shapes, gradients, normal, area } = host.place::<K>(piece, 0.5 * (1.0 + xi[0]));
            let [kx, ky] = host.mobility;
            let weight = 0.5 * weight * trial.flow_time;
            let flow = gradients.map(|g| -weight * (kx * g[0] * normal[0] + ky * g[1] * normal[1]));
            let through = (kx * normal[0] * normal[0] + ky * normal[1] * normal[1]) / area.max(f64::MIN_POSITIVE);
            see(&shapes, &flow, weight * hold * through);
        }
    }

    fn pressures(frame: &Frame<2>, trial: &Trial<2>, piece: &Piece) -> (usize, Corners) {
        let corners = frame.mesh.cells.kind[piece.host as usize].corner_count();
        let mut pressure = [0.0; water::MOST];
        for (p, &n) in pressure.iter_mut().zip(&frame.mesh.cells.nodes(piece.host as usize)[..corners]) {
            *p = trial.pressure[frame.places.pore(n)];
        }
        (corners, pressure)
    }

    fn add(&self, frame: &Frame<2>, trial: &Trial<2>, host: &Host, piece: &Piece, local: &mut Local) {
        let (corners, pressure) = Self::pressures(frame, trial, piece);
        let begin = 2 * frame.interpolation.nodes(frame.mesh, piece.host).len();
        let scale = (1.0 - trial.alpha_f) * self.unit;
        Self::visit(host, trial, piece, |shapes, flow, hold| {
            let held = |a: usize, b: usize| shapes[a] * flow[b] + flow[a] * shapes[b] + hold * shapes[a] * shapes[b];
            for a in 0..corners {
                let sum: f64 = (0..corners).map(|b| held(a, b) * pressure[b]).sum();
                local.vector[begin + a] -= scale * sum;
            }
            if local.matrix.is_empty() {
                return;
            }
            for a in 0..corners {
                for b in 0..corners {
                    local.matrix[(begin + a) * local.size + begin + b] -= scale * self.unit * held(a, b);
                }
            }
        });
    }
}

impl<K: Kinematics<2>> Term<2> for DrainedSurface<K> {
    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        if trial.flow_time == 0.0 {
            return Ok(());
        }
        let hosts = self.hosts(frame, trial.converged);
        let compute = |piece: &Piece, local: &mut Local| {
            if let Some(host) = hosts.get(&piece.host).filter(|_| self.drains(piece)) {
                self.add(frame, trial, host, piece, local);
            }
            Ok(())
        };
        let coupling = |piece: &Piece| frame.coupling[piece.host as usize] as usize;
        out.scatter(frame.pattern, frame.open, coupling, compute)
    }

    fn idle_load(&self, frame: &Frame<2>, displacement: &[[f64; 2]], phase: usize) -> Option<String> {
        let idle = self.flows.get(phase) == Some(&true) && self.hosts(frame, displacement).is_empty();
        idle.then(|| {
            "no free surface of soil with a permeability is there to drain: it is tight where structures cover it and where soil lies on the \
             boundary of the mesh"
                .into()
        })
    }

    fn sees_open_boundary(&self) -> bool {
        true
    }

    fn outflow(&self, frame: &Frame<2>, trial: &Trial<2>) -> f64 {
        let mut sum = 0.0;
        let hosts = self.hosts(frame, trial.converged);
        let open = frame.open.iter().filter(|piece| self.drains(piece));
        for (piece, host) in open.filter_map(|piece| Some((piece, hosts.get(&piece.host)?))) {
            let (_, pressure) = Self::pressures(frame, trial, piece);
            Self::visit(host, trial, piece, |shapes, flow, hold| {
                sum += dot(flow, &pressure) + hold * dot(shapes, &pressure);
            });
        }
        sum
    }
}
