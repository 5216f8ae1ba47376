//! Water in the pores: its excess pressure as a field of unknowns of its own, and its flow.
//!
//! The points answer for the effective stress. The field `p` (kPa, Cauchy, compression positive) is linear from corner to
//! corner and continuous from cell to cell; with displacements of second order that is the Taylor–Hood pair, stable
//! where nothing flows. With `J = det F`, `Q = K_w/n` and `κ = k/γ_w` (theory, eq. 35 to 37):
//!
//! ```text
//! R_u −= Σ w₀ J p 1 : ∇_x N
//! R_p  = −Σ w₀ { L [J − J_n + (p − p_n)/Q] + Δt J_n ∇L·κ∇p + s L_a (Δp_a − Δp) }
//! ```
//!
//! `J − J_n + (p − p_n)/Q` is the water that a point takes up for each volume when seeded. It is the difference of a state, so
//! that the water is conserved over any number of steps; and its derivative is that of `R_u`, so that the system is symmetric. `∇` in
//! the flow is that of the configuration at the beginning of the step. The excess pressure has no gravity in it.
//!
//! The last term lumps, in part, what holds `p` against its change, the compliance `1/M + 1/Q` of skeleton and water. A step shorter
//! than it takes pressure to pass a cell would otherwise make the pressure oscillate beside a drained boundary (Vermeer &
//! Verruijt 1981); `s` is what keeps the entries between different nodes from being positive, `1/M + 1/Q − 6 κ Δt/h²`, and zero in
//! longer steps (Aguilar et al. 2008). In cells of first order it makes the pair stable, too, and stays.

use super::mixed::{Coupling, Point};
use super::{Frame, History, Mixed, Trial};
use crate::geometry::dot;
use crate::interpolation::{CellPoints, Coefficients, Entries};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::Model;
use crate::material::spatial::Spatial;
use crate::mesh::cell_size;
use crate::mesh::shape::{CellKind, MAX_NODES};
use crate::points::Points;
use crate::system::Local;
use crate::tensor::Tensor;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// Most corners of a cell.
pub(super) const MOST: usize = 4;

/// A value for each corner of a cell.
pub(super) type Corners = [f64; MOST];

/// How stiff the water is in the pores: `K_w/n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WaterStiffness {
    /// Over the shear modulus of the skeleton (-).
    Ratio(f64),
    /// In kPa.
    Modulus(f64),
}

/// Soil whose pores hold water.
#[derive(Clone)]
pub struct Porous {
    /// The model of the whole effective stress.
    pub model: Arc<dyn Model>,
    pub stiffness: WaterStiffness,
    /// `k/γ_w` (m²/(kPa s)), horizontal and vertical.
    pub mobility: [f64; 2],
}

impl fmt::Debug for Porous {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stiffness, mobility, .. } = self;
        f.debug_struct("Porous").field("stiffness", stiffness).field("mobility", mobility).finish_non_exhaustive()
    }
}

impl Porous {
    /// `n/K_w` (1/kPa) at a point seeded at height `y` (m).
    pub fn storage(&self, y: f64) -> f64 {
        match self.stiffness {
            WaterStiffness::Ratio(ratio) => 1.0 / (ratio * self.model.elasticity().at(y).shear),
            WaterStiffness::Modulus(modulus) => 1.0 / modulus,
        }
    }

    /// What holds the pressure against its change (1/kPa): `1/M + n/K_w`, M the confined modulus of the skeleton; of
    /// one whose stiffness follows the pressure, that at its reference pressure.
    fn compliance(&self, y: f64) -> f64 {
        let moduli = self.model.elasticity().at(y);
        1.0 / (moduli.lambda + 2.0 * moduli.shear) + self.storage(y)
    }
}

/// The pore water of a scene.
pub struct PoreWater<K> {
    /// The porous soil of each material by number; `None` without water.
    porous: Vec<Option<Porous>>,
    /// What a unit of its unknowns stands for (kPa/m).
    unit: f64,
    kinematics: PhantomData<K>,
}

impl<K> PoreWater<K> {
    /// `porous[m]` is the soil of material `m` ([`Points::model_of`]), `unit` that of [`crate::step::Scene`].
    pub fn new(porous: Vec<Option<Porous>>, unit: f64) -> Self {
        Self { porous, unit, kinematics: PhantomData }
    }
}

/// The linear shape functions of the corners as sums of those of a cell of first or second order: the coefficient of function `i` in that of corner `a`.
fn coefficients(kind: CellKind) -> [[f64; MAX_NODES]; MOST] {
    let corners = kind.corner_count();
    let mut of = [[0.0; MAX_NODES]; MOST];
    for (a, of) in of.iter_mut().enumerate().take(corners) {
        of[a] = 1.0;
        if kind.order() > 1 {
            of[corners + a] = 0.5;
            of[corners + (a + corners - 1) % corners] = 0.5;
            if kind.node_count() > 2 * corners {
                of[2 * corners] = 0.25;
            }
        }
    }
    of
}

/// The values of the linear shape functions of the corners where those of the cell are `n`.
pub fn corner_shapes(kind: CellKind, n: &[f64]) -> Corners {
    coefficients(kind).map(|of| of.iter().zip(n).map(|(c, n)| c * n).sum())
}

/// The field over a cell.
pub struct Cell<const D: usize> {
    corners: usize,
    /// The linear shape functions by those of the cell.
    shapes: [[f64; MAX_NODES]; MOST],
    /// The pressure (kPa) at the corners, and what the step has added to it.
    pressure: Corners,
    gained: Corners,
    /// Displacement (m) of the nodes at the beginning of the step.
    before: Coefficients<D>,
    /// Time `Δt` (s) that the water flows for, and `6 Δt/h²` with the size `h` of the cell.
    flow_time: f64,
    passing: f64,
    /// Whether the cell is of first order, whose pressures are stabilised in steps of any size.
    first_order: bool,
}

impl<const D: usize> Cell<D> {
    /// The pressure (kPa) within the step where the functions are `shapes`: between the unknowns of both ends.
    fn within(&self, shapes: &Corners, end_weight: f64) -> f64 {
        dot(shapes, &self.pressure) - (1.0 - end_weight) * dot(shapes, &self.gained)
    }

    fn shapes(&self, n: &[f64]) -> Corners {
        self.shapes.map(|of| of.iter().zip(n).map(|(c, n)| c * n).sum())
    }

    /// `∇L` (1/m) on the configuration at the beginning of the step.
    fn gradients<K: Kinematics<D>>(&self, entries: &Entries<D>) -> [[f64; D]; MOST] {
        let before = entries.deformation::<K>(&self.before);
        // It was admissible when the step before converged to it.
        let inverse = before.try_inverse().unwrap_or_else(Tensor::identity);
        self.shapes.map(|of| {
            let mut sum = Gradient { g: [0.0; D], hoop: 0.0 };
            for (i, c) in of.iter().enumerate().take(entries.shape.len()) {
                for (sum, g) in sum.g.iter_mut().zip(entries.shape_gradient[i]) {
                    *sum += c * g;
                }
            }
            K::push_forward(&sum, &inverse).g
        })
    }
}

impl<const D: usize, K: Kinematics<D>> Mixed<D, K> for PoreWater<K> {
    type Cell = Cell<D>;

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, cell_points: &CellPoints) -> Cell<D> {
        let cell = cell_points.cell as usize;
        let kind = frame.mesh.cells.kind[cell];
        let corners = kind.corner_count();
        let (mut pressure, mut gained) = ([0.0; MOST], [0.0; MOST]);
        for (a, &n) in frame.mesh.cells.nodes(cell)[..corners].iter().enumerate() {
            let unknown = frame.places.pore(n);
            pressure[a] = trial.pressure[unknown];
            gained[a] = pressure[a] - trial.converged_pressure[unknown];
        }
        // The edge of a typical cell is its diagonal over √2.
        let edge = 0.5 * cell_size(frame.mesh, cell).powi(2);
        Cell {
            corners,
            shapes: coefficients(kind),
            pressure,
            gained,
            before: frame.interpolation.gather(frame.mesh, cell_points, trial.converged),
            flow_time: trial.flow_time,
            passing: 6.0 * trial.flow_time / edge,
            first_order: kind.order() == 1,
        }
    }

    fn add(&self, cell: &Cell<D>, point: &Point<D>, end_weight: f64, answer: &mut Spatial<K::Tangent>) {
        let &Point { points, entries, ratios } = point;
        if points.by_material(entries.point, &self.porous).is_none() {
            return;
        }
        let pressure = cell.within(&cell.shapes(entries.shape), end_weight);
        let stress = -points.deformation[entries.point].determinant() * ratios.step * pressure;
        for normal in &mut answer.kirchhoff[..3] {
            *normal += stress;
        }
        K::add_pressure(&mut answer.tangent, stress);
        K::add_volumetric(&mut answer.tangent, stress);
    }

    fn work(&self, cell: &Cell<D>, point: &Point<D>, end_weight: f64) -> [f64; 2] {
        let &Point { points, entries, ratios } = point;
        if points.by_material(entries.point, &self.porous).is_none() {
            return [0.0; 2];
        }
        let pressure = cell.within(&cell.shapes(entries.shape), end_weight);
        let stress = -points.deformation[entries.point].determinant() * pressure;
        [stress * (ratios.step - 1.0), stress * ratios.step]
    }

    fn couple(&self, cell: &Cell<D>, point: &Point<D>, coupling: &Coupling<D>, local: &mut Local) {
        let &Point { points, entries, ratios } = point;
        let &Coupling { forces, strains, acting, end_weight, .. } = coupling;
        let p = entries.point;
        let Some(porous) = points.by_material(p, &self.porous) else { return };
        let begin = D * forces.len();
        let y = points.seeded_height(p);
        let before = points.deformation[p].determinant();
        let shapes = cell.shapes(entries.shape);
        let storage = porous.storage(y);
        let taken_up =
            before * (ratios.step - 1.0) + storage * (dot(&shapes, &cell.pressure) - points.pore_pressure[p]);
        let weight = end_weight * self.unit * entries.weight;
        let flows = cell.flow_time > 0.0;
        let gradients = if flows { cell.gradients::<K>(entries) } else { [[0.0; D]; MOST] };
        let mobility: [f64; D] =
            std::array::from_fn(|d| cell.flow_time * before * porous.mobility[usize::from(d == D - 1)]);
        let conducted =
            |a: usize, b: usize| (0..D).map(|d| gradients[a][d] * mobility[d] * gradients[b][d]).sum::<f64>();
        let lumped = if flows || cell.first_order {
            let slowest = porous.mobility[0].min(porous.mobility[1]);
            (porous.compliance(y) - slowest * cell.passing).max(0.0)
        } else {
            0.0
        };
        let gained = dot(&shapes, &cell.gained);
        let held = |a: usize, b: usize| {
            let own = if a == b { shapes[a] } else { 0.0 };
            storage * shapes[a] * shapes[b] + conducted(a, b) + lumped * (own - shapes[a] * shapes[b])
        };
        for a in 0..cell.corners {
            let flow: f64 = (0..cell.corners).map(|b| conducted(a, b) * cell.pressure[b]).sum();
            let bond = lumped * shapes[a] * (cell.gained[a] - gained);
            local.vector[begin + a] -= weight * (shapes[a] * taken_up + flow + bond);
        }
        if local.matrix.is_empty() {
            return;
        }
        let (size, one) = (local.size, Tensor::identity());
        let volume = -weight * before * ratios.step;
        let acts = acting.of_unit(acting.within.step, ratios.step - 1.0) * (-weight * before);
        for (i, (force, strain)) in forces.iter().zip(strains).enumerate() {
            let (swelling, force) = (K::force(&one, strain), K::force(&acts, force));
            for (a, shape) in shapes.iter().enumerate().take(cell.corners) {
                for d in 0..D {
                    local.matrix[(begin + a) * size + i * D + d] += volume * shape * swelling[d];
                    local.matrix[(i * D + d) * size + begin + a] += shape * force[d];
                }
            }
        }
        for a in 0..cell.corners {
            for b in 0..cell.corners {
                local.matrix[(begin + a) * size + begin + b] -= weight * self.unit * held(a, b);
            }
        }
    }

    fn seepage(&self, cell: &Cell<D>, &Point { points, entries, .. }: &Point<D>, end_weight: f64) -> f64 {
        let Some(porous) = points.by_material(entries.point, &self.porous).filter(|_| cell.flow_time > 0.0) else {
            return 0.0;
        };
        let gradients = cell.gradients::<K>(entries);
        let slope =
            |d: usize, value: &dyn Fn(usize) -> f64| (0..cell.corners).map(|a| gradients[a][d] * value(a)).sum::<f64>();
        let within = |a: usize| cell.pressure[a] - (1.0 - end_weight) * cell.gained[a];
        let flow = |d: usize| porous.mobility[usize::from(d == D - 1)] * slope(d, &|a| cell.pressure[a]);
        let sum: f64 = (0..D).map(|d| slope(d, &within) * flow(d)).sum();
        entries.weight * points.deformation[entries.point].determinant() * cell.flow_time * sum
    }

    fn commit(&self, cell: &Cell<D>, &Point { points, entries, .. }: &Point<D>, history: &mut History) {
        if points.by_material(entries.point, &self.porous).is_some() {
            history.pore_pressure = dot(&cell.shapes(entries.shape), &cell.pressure);
        }
    }

    fn energy(&self, points: &Points<D>, p: usize) -> f64 {
        let Some(porous) = points.by_material(p, &self.porous) else { return 0.0 };
        0.5 * points.initial_volume[p] * porous.storage(points.seeded_height(p)) * points.pore_pressure[p].powi(2)
    }
}
