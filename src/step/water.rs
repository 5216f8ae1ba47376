//! The pore water on the grid: where the pressures of the nodes stand, what the points bring to a restored grid, and the balance of
//! a step.

use super::grid::Grid;
use super::newton::Solution;
use super::scene::Scene;
use super::state::State;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::cell_size;
use crate::points::Points;
use crate::term::{Frame, Porous, Trial, corner_hats};
use crate::time_integration::GeneralisedAlpha;
use nalgebra::{SMatrix, SVector};

/// Share of the size of a cell squared that the points of a node are taken to be apart at least: a gradient that they are
/// too close to tell is zero.
const SPREAD: f64 = 1e-6;

/// Times that the difference is mapped: what one leaves the next takes up.
const ROUNDS: usize = 3;

/// The porous soil of point `p`.
fn soil<'a, const D: usize>(porous: &'a [Option<Porous>], points: &Points<D>, p: usize) -> Option<&'a Porous> {
    porous.get(points.model_of(p)).and_then(Option::as_ref)
}

/// The water of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// What the soil took up (m³, in plane strain per metre), and what left it at drained boundaries.
    pub taken_up: f64,
    pub left: f64,
    /// What points took up or gave, all together (m³).
    pub exchanged: f64,
}

impl Balance {
    /// What is neither in the soil nor has left, over what was exchanged (-).
    pub fn error(&self) -> f64 {
        if self.exchanged > 0.0 { (self.taken_up + self.left) / self.exchanged } else { 0.0 }
    }
}

/// The water in the points of each family over their volume when seeded, but for a constant: `J + n/K_w p`.
pub fn content<const D: usize>(scene: &Scene<D>, state: &State<D>) -> [Vec<f64>; 2] {
    let Some(water) = &scene.water else { return [Vec::new(), Vec::new()] };
    [state.integration(), &state.fem].map(|points| {
        let one = |p: usize| {
            let soil = soil(&water.porous, points, p);
            soil.map_or(0.0, |soil| {
                points.deformation[p].determinant() + soil.storage(points.origin[p][1]) * points.pore_pressure[p]
            })
        };
        (0..points.len()).map(one).collect()
    })
}

/// Water (m³) that leaves through surfaces in a step of `dt` (s), whose points are those before it.
pub fn through_surfaces<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    solution: &Solution<D>,
    dt: f64,
) -> f64 {
    if scene.water.is_none() || !scene.phases[state.phase].flows {
        return 0.0;
    }
    let frame = grid.frame(&scene.mesh, state);
    let at_rest = Trial::at_rest(&solution.displacement, &state.displacement);
    let trial = Trial { pressure: &solution.pressure, flow_time: dt, ..at_rest };
    scene.terms.iter().map(|term| term.outflow(&frame, &trial)).sum()
}

/// The balance of a step, given the content of the points before it and what has left through surfaces; absent without water.
pub fn balance<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    before: &[Vec<f64>; 2],
    solution: &Solution<D>,
    drained: f64,
) -> Option<Balance> {
    let water = scene.water.as_ref()?;
    let after = content(scene, state);
    let mut balance = Balance { left: drained, ..Balance::default() };
    for (family, (before, after)) in grid.integrated(scene, state).zip(before.iter().zip(&after)) {
        for (&p, weight) in family.stencil.points.iter().zip(&family.stencil.weight) {
            let taken_up = weight * (after[p as usize] - before[p as usize]);
            balance.taken_up += taken_up;
            balance.exchanged += taken_up.abs();
        }
    }
    if scene.phases[state.phase].flows {
        let alpha_f = if scene.phases[state.phase].dynamic { alpha_f(scene.numerics.spectral_radius) } else { 0.0 };
        let unit = scene.pressure_unit.unwrap_or(1.0) * (1.0 - alpha_f);
        let of_nodes = D * grid.node.len();
        for (&unknown, residual) in grid.carrier.iter().zip(&solution.residual[of_nodes..]) {
            let node = (unknown as usize).checked_sub(grid.water).map(|n| n as u32);
            if node.is_some_and(|n| water.drained.binary_search(&n).is_ok()) {
                balance.left += residual / unit;
            }
        }
    }
    Some(balance)
}

fn alpha_f(spectral_radius: f64) -> f64 {
    GeneralisedAlpha::new(spectral_radius, 1.0).alpha_f
}

/// Where the pore pressures of a cell stand in [`super::State::pressure`]: those of its corners, counted from `water` on.
pub fn unknowns_of<const D: usize>(mesh: &Mesh<D>, water: usize, cell: usize) -> impl Iterator<Item = u32> {
    let corners = &mesh.cells.nodes(cell)[..mesh.cells.kind[cell].corner_count()];
    corners.iter().map(move |&n| water as u32 + n)
}

/// What the points around a node tell of it, weighted by its hat: sums that are moments about their centre in the end.
#[derive(Clone)]
struct Around<const D: usize> {
    weight: f64,
    place: SVector<f64, D>,
    pressure: f64,
    spread: SMatrix<f64, D, D>,
    slope: SVector<f64, D>,
    node: SVector<f64, D>,
    size: f64,
}

/// Takes the pressures (kPa) of the nodes over from the points of all `frames` that are in regions with water. What is mapped is by
/// how much those differ from the field of the nodes so far: at each node the linear function that fits it best around it,
/// weighted by its hat. A field whose points have not moved stays what it is, and so does a linear one wherever they are, at the edges
/// of a body, too. Nodes without points keep theirs.
pub fn gather<const D: usize, K: Kinematics<D>>(frames: &[Frame<D>], porous: &[Option<Porous>], field: &mut [f64]) {
    for _ in 0..ROUNDS {
        correct::<D, K>(frames, porous, field);
    }
}

fn correct<const D: usize, K: Kinematics<D>>(frames: &[Frame<D>], porous: &[Option<Porous>], field: &mut [f64]) {
    let nothing = Around {
        weight: 0.0,
        place: SVector::zeros(),
        pressure: 0.0,
        spread: SMatrix::zeros(),
        slope: SVector::zeros(),
        node: SVector::zeros(),
        size: 0.0,
    };
    let mut around = vec![nothing; field.len()];
    visit::<D, K>(frames, porous, field, |frame, cell, n, weight, p, missing| {
        let around = &mut around[n];
        around.node = SVector::from(frame.mesh.nodes[n]);
        around.size = around.size.max(cell_size(frame.mesh, cell));
        around.weight += weight;
        around.place += weight * SVector::from(frame.points.position[p]);
        around.pressure += weight * missing;
    });
    for around in around.iter_mut().filter(|around| around.weight > 0.0) {
        around.place /= around.weight;
        around.pressure /= around.weight;
        around.spread = SMatrix::identity() * (SPREAD * around.size.powi(2) * around.weight);
    }
    visit::<D, K>(frames, porous, field, |frame, _, n, weight, p, missing| {
        let around = &mut around[n];
        let from = SVector::from(frame.points.position[p]) - around.place;
        around.spread += weight * from * from.transpose();
        around.slope += weight * (missing - around.pressure) * from;
    });
    for (pressure, around) in field.iter_mut().zip(&around).filter(|(_, around)| around.weight > 0.0) {
        let gradient = around.spread.try_inverse().map_or(SVector::zeros(), |inverse| inverse * around.slope);
        *pressure += around.pressure + gradient.dot(&(around.node - around.place));
    }
}

/// Calls `see` with each cell, corner and point in it that has water, the weight of the point in the hat of the corner, and what
/// the field lacks of its pressure (kPa).
fn visit<const D: usize, K: Kinematics<D>>(
    frames: &[Frame<D>],
    porous: &[Option<Porous>],
    field: &[f64],
    mut see: impl FnMut(&Frame<D>, usize, usize, f64, usize, f64),
) {
    for frame in frames {
        for patch in &frame.stencil.patches {
            let cell = patch.cell as usize;
            let kind = frame.mesh.cells.kind[cell];
            for entries in frame.stencil.entries::<K>(patch) {
                let p = entries.point;
                if soil(porous, frame.points, p).is_none() {
                    continue;
                }
                let hats = corner_hats(kind, entries.value);
                let corners = || hats.iter().zip(&frame.mesh.cells.nodes(cell)[..kind.corner_count()]);
                let there: f64 = corners().map(|(hat, &n)| hat * field[n as usize]).sum();
                let missing = frame.points.pore_pressure[p] - there;
                for (hat, &n) in corners() {
                    see(frame, cell, n as usize, entries.weight * hat, p, missing);
                }
            }
        }
    }
}
