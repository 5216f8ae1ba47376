//! What a run writes down: frames, rows of the history, lines of the log.

use super::accepted;
use super::boundary;
use super::fields::Field;
use super::surface::{self, Acting};
use crate::io::columns::padded;
use crate::io::frame::{CELL, Column, Frame, Part, UNCOUNTED, VOLUME, triples};
use crate::io::provenance::Origin;
use crate::points::Points;
use crate::quadrature::Count;
use crate::rigid::Body;
use crate::step::{ITEMS, Report, Restore, Scene, Side, State};

/// A quantity of the history, with its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Displacement (m), the mean over what is watched.
    Displacement(usize),
    /// Velocity (m/s), the mean over what is watched.
    Velocity(usize),
    /// Force of the supports and prescribed displacements on the nodes (kN), the sum.
    Reaction(usize),
    /// Force of what a structure touches on it (kN), the sum.
    Contact(usize),
    /// Rotation of a rigid body (rad), and the moment (kN m) about its centroid of what holds it.
    Rotation,
    ReactionMoment,
    /// Moment (kN m) of what a structure touches on it about the centroid that it has now, in the plane, anticlockwise.
    ContactMoment,
    /// Excess pore pressure (kPa), the mean over what is watched.
    PorePressure,
}

/// What is watched.
#[derive(Clone, Debug, PartialEq)]
pub enum WatchedOn {
    /// Nodes of the grid: a curve or a point.
    Nodes(Vec<u32>),
    /// Nodes of a rigid body, and its number in the scene.
    Side(Vec<u32>, usize),
    /// A rigid body, by its number in the scene.
    Body(usize),
    /// The points of a region of the mesh.
    Region(u16),
}

/// An entry of the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    pub name: String,
    pub on: WatchedOn,
    pub quantities: Vec<Quantity>,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The column of the reduction of strength at which the last search found no equilibrium.
pub const NO_EQUILIBRIUM: &str = "no_equilibrium_at [-]";

/// The column of how far the soil has moved in a search for that.
const MOVED: &str = "soil_moved [m]";

/// The header of the history.
pub fn columns<const D: usize>(scene: &Scene<D>, watches: &[Watch]) -> Vec<String> {
    let mut columns = vec!["time [s]".to_string()];
    if reduces(scene) {
        columns.extend(["strength_reduction [-]", NO_EQUILIBRIUM].map(String::from));
    }
    if searches(scene) {
        columns.push(MOVED.to_string());
    }
    for watch in watches {
        for quantity in &watch.quantities {
            columns.push(column_name(watch, *quantity));
        }
    }
    columns
}

/// The name of a column.
pub fn column_name(watch: &Watch, quantity: Quantity) -> String {
    match quantity {
        Quantity::Displacement(d) => format!("{}.u{} [m]", watch.name, AXES[d]),
        Quantity::Velocity(d) => format!("{}.v{} [m/s]", watch.name, AXES[d]),
        Quantity::Reaction(d) => format!("{}.reaction_{} [kN]", watch.name, AXES[d]),
        Quantity::Contact(d) => format!("{}.contact_{} [kN]", watch.name, AXES[d]),
        Quantity::Rotation => format!("{}.rotation [rad]", watch.name),
        Quantity::ReactionMoment => format!("{}.reaction_moment [kN m]", watch.name),
        Quantity::ContactMoment => format!("{}.contact_moment [kN m]", watch.name),
        Quantity::PorePressure => format!("{}.pore_pressure [kPa]", watch.name),
    }
}

/// Whether a phase reduces strengths.
fn reduces<const D: usize>(scene: &Scene<D>) -> bool {
    scene.phases.iter().any(|phase| phase.reduction.is_some())
}

/// Whether a phase searches for the reduction that leaves no equilibrium.
fn searches<const D: usize>(scene: &Scene<D>) -> bool {
    scene.phases.iter().any(|phase| phase.search.is_some())
}

/// A row of the history.
pub fn row<const D: usize>(scene: &Scene<D>, watches: &[Watch], state: &State<D>, report: &Report<D>) -> Vec<f64> {
    let mut row = vec![state.time];
    if reduces(scene) {
        row.extend([scene.phases[state.phase].reduction_at(state.phase_time), 0.0]);
    }
    if searches(scene) {
        row.push(state.search_curve.last().map_or(0.0, |[_, moved]| *moved));
    }
    for watch in watches {
        row.extend(watch.quantities.iter().map(|quantity| value(&watch.on, *quantity, scene, state, report)));
    }
    row
}

/// The header of the balance of energy.
pub fn energy_columns() -> Vec<String> {
    let items = ITEMS.iter().map(|(_, name, side)| format!("{}.{name} [kJ]", side.name()));
    std::iter::once("time [s]".to_string()).chain(items).collect()
}

/// A row of the balance of energy.
pub fn energy_row<const D: usize>(state: &State<D>) -> Vec<f64> {
    std::iter::once(state.time).chain(state.energies.unwrap_or_default().0).collect()
}

/// The value of a quantity of what is watched, as the converged state of a step and its report have it.
pub fn value<const D: usize>(
    on: &WatchedOn,
    quantity: Quantity,
    scene: &Scene<D>,
    state: &State<D>,
    report: &Report<D>,
) -> f64 {
    let contact = |region: u16| report.contacts.iter().map(move |c| c.on(region));
    let travel = |n: usize, d: usize| state.travel[n][d] - state.uncounted.get(n).map_or(0.0, |u| u[d]);
    match (on, quantity) {
        (WatchedOn::Nodes(nodes) | WatchedOn::Side(nodes, _), Quantity::Displacement(d)) => {
            mean(nodes.iter().map(|&n| travel(n as usize, d)))
        }
        (WatchedOn::Nodes(nodes) | WatchedOn::Side(nodes, _), Quantity::Velocity(d)) => {
            mean(nodes.iter().map(|&n| state.velocity.get(n as usize).map_or(0.0, |v| v[d])))
        }
        (WatchedOn::Nodes(nodes), Quantity::Reaction(d)) => nodes.iter().map(|&n| report.reaction[n as usize][d]).sum(),
        (WatchedOn::Side(_, body), quantity @ Quantity::Reaction(_)) => {
            value(&WatchedOn::Body(*body), quantity, scene, state, report)
        }
        (WatchedOn::Body(number), quantity) => {
            let body = &scene.bodies[*number];
            let Body { region, dofs, .. } = body;
            let motion = || dofs.motion::<D>(|n| std::array::from_fn(|d| travel(n as usize, d)));
            let reaction = || dofs.load(|n| report.reaction[n as usize]);
            match quantity {
                Quantity::Displacement(d) => motion().0[d],
                Quantity::Velocity(d) => state.velocity.get(dofs.translation as usize).map_or(0.0, |v| v[d]),
                Quantity::Reaction(d) => reaction().0[d],
                Quantity::Contact(d) => contact(*region).map(|(force, _)| force[d]).sum(),
                Quantity::PorePressure => 0.0,
                Quantity::Rotation => motion().1,
                Quantity::ReactionMoment => reaction().1,
                Quantity::ContactMoment => {
                    let centre = body.centre_after(&state.travel);
                    dofs.rotation.map_or(0.0, |_| moment_about(&[centre[0], centre[1]], contact(*region)))
                }
            }
        }
        (WatchedOn::Nodes(nodes), Quantity::PorePressure) => {
            let [places, _] = scene.places();
            let value = |n: u32| state.pressure.get(places.pore(n)).filter(|_| scene.water.is_some());
            mean(nodes.iter().map(|&n| value(n).copied().unwrap_or(0.0)))
        }
        (WatchedOn::Region(region), Quantity::PorePressure) => {
            mean_over(state, *region, |points, p| points.pore_pressure.get(p).copied().unwrap_or(0.0))
        }
        (WatchedOn::Region(region), Quantity::Displacement(d)) => {
            mean_over(state, *region, |points, p| points.displacement(p)[d])
        }
        (WatchedOn::Region(region), Quantity::Velocity(d)) => {
            mean_over(state, *region, |points, p| points.velocity.get(p).map_or(0.0, |v| v[d]))
        }
        (WatchedOn::Region(region), Quantity::Contact(d)) => contact(*region).map(|(force, _)| force[d]).sum(),
        (WatchedOn::Region(region), Quantity::ContactMoment) => {
            moment_about(&centroid(state, *region), contact(*region))
        }
        // A region has no supports of its own, a curve no contact; only rigid bodies turn.
        (WatchedOn::Region(_) | WatchedOn::Nodes(_) | WatchedOn::Side(..), _) => 0.0,
    }
}

/// The moment (kN m) about `centre` of forces with their moments about the origin.
fn moment_about<const D: usize>(centre: &[f64; 2], forces: impl Iterator<Item = ([f64; D], f64)>) -> f64 {
    const { assert!(D == 2, "moments are numbers in the plane only") };
    forces.map(|(force, moment)| moment - (centre[0] * force[1] - centre[1] * force[0])).sum()
}

/// The centroid (m) of a region where it is now, in the plane, by the volumes of its points.
fn centroid<const D: usize>(state: &State<D>, region: u16) -> [f64; 2] {
    const { assert!(D == 2, "centroids are those of moments in the plane") };
    [0, 1].map(|d| mean_over(state, region, |points, p| points.position[p][d]))
}

/// The points of a region, of whatever kind.
fn members<const D: usize>(state: &State<D>, region: u16) -> impl Iterator<Item = (&Points<D>, usize)> {
    let all = [&state.points, &state.fem].into_iter().flat_map(|points| (0..points.len()).map(move |p| (points, p)));
    all.filter(move |(points, p)| points.region[*p] == region)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0usize, 0.0), |(n, s), v| (n + 1, s + v));
    if count > 0 { sum / count as f64 } else { 0.0 }
}

/// The mean of a value over the points of a region, by the volume that each had when seeded: points that are split and merged leave it.
fn mean_over<const D: usize>(state: &State<D>, region: u16, value: impl Fn(&Points<D>, usize) -> f64) -> f64 {
    let (volume, sum) = members(state, region).fold((0.0, 0.0), |(volume, sum), (points, p)| {
        let v = points.initial_volume[p];
        (volume + v, sum + v * value(points, p))
    });
    if volume > 0.0 { sum / volume } else { 0.0 }
}

/// The state at one moment.
pub fn frame<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    fields: &[Field],
    origin: Origin,
    acting: Option<&Acting>,
) -> Frame {
    let nodes = scene.mesh_nodes();
    let displacement = fields.iter().any(|field| matches!(field, Field::Displacement));
    // A grid that is restored and follows nothing stays where the mesh has it.
    let grid = if scene.numerics.restore == Restore::EveryStep && scene.fem.is_none() && !scene.moves_curves() {
        Part::default()
    } else {
        let columns = displacement.then(|| Column::new("displacement", "m", 3, padded(&state.displacement[..nodes])));
        let reset = scene.fem.is_some() && !state.uncounted.is_empty();
        let uncounted = reset.then(|| Column::new(UNCOUNTED, "m", 3, padded(&state.uncounted[..nodes])));
        Part {
            position: triples(&boundary::nodes(scene, state)[..nodes]),
            columns: columns.into_iter().chain(uncounted).collect(),
        }
    };
    let mut points = part(&state.points, fields);
    if displacement {
        let volumes = (0..state.points.len()).map(|p| state.points.volume(p));
        points.columns.push(Column::new(VOLUME, "m3", 1, volumes.collect()));
    }
    let mut elements = part(&state.fem, fields);
    elements.columns.push(Column::new(CELL, "-", 1, state.fem.cell.iter().map(|&c| f64::from(c)).collect()));
    Frame {
        time: state.time,
        phase: scene.phases.get(state.phase).map_or_else(String::new, |p| p.name.clone()),
        step: state.step,
        origin,
        points,
        grid,
        elements: if scene.fem.is_some() { elements } else { Part::default() },
        contact: boundary::part(scene, state),
        surface: acting.map_or_else(Part::default, |acting| surface::part(scene, state, acting)),
    }
}

/// The fields of some points.
fn part<const D: usize>(points: &Points<D>, fields: &[Field]) -> Part {
    let columns = fields.iter().filter_map(|field| field.column(points)).collect();
    Part { columns, position: triples(&points.position) }
}

/// The first lines of the log.
pub fn heading<const D: usize>(scene: &Scene<D>, points: &Points<D>) -> Vec<String> {
    let mass: f64 = points.mass.iter().sum();
    vec![
        format!(
            "{} material points, mass {mass:.12e} t, in {} cells with {} nodes",
            points.len(),
            scene.mesh.cells.len(),
            scene.mesh_nodes()
        ),
        "energies in kJ, momenta in t m/s, the imbalance is the change of momentum less the impulse of the loads"
            .to_string(),
        "elastic, potential and kinetic energy are those of the material points; the balance is that of the equations: supplied = held + dissipated + \
         numerical"
            .to_string(),
    ]
}

/// What a step did.
pub fn log_lines<const D: usize>(scene: &Scene<D>, state: &State<D>, report: &Report<D>) -> Vec<String> {
    let mut lines: Vec<String> = report.halvings.iter().map(|reason| format!("  halved: {reason}")).collect();
    let phase = &scene.phases[state.phase];
    let dynamic = state.dynamic(scene);
    let residuals: Vec<String> = report.residuals.iter().map(|r| format!("{r:.1e}")).collect();
    let mut line = format!(
        "step {} {} t {:.9} dt {:.3e} iterations {} residuals {} by {:?}",
        state.step,
        phase.name,
        state.time,
        report.dt,
        report.iterations(),
        residuals.join(" "),
        report.method
    );
    line.push_str(&format!(
        " mass {:.12e} elastic {:.9e} potential {:.9e}",
        report.motion.mass, report.elastic, report.potential
    ));
    if dynamic {
        let vector = |v: &[f64; D]| v.map(|x| format!("{x:.6e}")).join(" ");
        line.push_str(&format!(
            " kinetic {:.9e} momentum {} angular {:.6e} imbalance {}",
            report.motion.kinetic,
            vector(&report.motion.linear),
            report.motion.angular,
            vector(&report.imbalance)
        ));
    }
    if let Some(energies) = &state.energies {
        line.push_str(" balance");
        for side in [Side::Supplied, Side::Held, Side::Dissipated, Side::Numerical] {
            line.push_str(&format!(" {} {:.9e}", side.name(), energies.sum(side)));
        }
    }
    if let Some(water) = &report.water {
        let (taken_up, left, error) = (water.taken_up, water.left, water.error());
        line.push_str(&format!(" water taken up {taken_up:.9e} left {left:.9e} m3 imbalance {error:.1e}"));
    }
    for contact in &report.contacts {
        let force = contact.force.map(|f| format!("{f:.6e}")).join(" ");
        line.push_str(&format!(
            " contact {force} kN on {} contact nodes, overlap {:.1e} m",
            contact.contact_nodes, contact.overlap
        ));
        if contact.pushed.points > 0 {
            line.push_str(&format!(" pushed out {} by {:.1e} m", contact.pushed.points, contact.pushed.most));
        }
    }
    if report.strained > 0 {
        line.push_str(&format!(" {} material points took the state of an integration point", report.strained));
    }
    let (share, most) = (state.ramp.share(state.phase_time), state.ramp.most());
    if share > 0.0 && !dynamic {
        line.push_str(&format!(" held back {share:.4} of up to {most:.3e} kN at a node"));
    }
    if report.restored && scene.numerics.restore != Restore::EveryStep {
        line.push_str(" restored");
    }
    if let Some(residual) = accepted::residual(scene, report) {
        line.push_str(&format!(" accepted with the residual {residual:.1e}"));
    }
    if report.unbalanced {
        line.push_str(" no balance on the restored grid");
    }
    let tally = &state.weights.tally;
    if report.restored && tally.volume > 0.0 {
        line.push_str(&format!(" cells fitted linear {} constant {}", tally.linear, tally.constant));
        let outside = state.weights.samples.as_ref().map_or(0, |samples| samples.outside.len());
        if outside > 0 {
            line.push_str(&format!(" outside the surface {outside}"));
        }
        if tally.taken > 0 {
            line.push_str(&format!(" integration points with the state of a material point {}", tally.taken));
        }
        let Count { split, merged, starved } = tally.population;
        if split + merged > 0 {
            line.push_str(&format!(" points {} split {split} merged {merged}", state.points.len()));
        }
        if starved > 0 {
            line.push_str(&format!(" cells short of points {starved}"));
        }
        line.push_str(&format!(" volume drift {:.2e}", tally.point_volume / tally.volume - 1.0));
    }
    lines.push(line);
    if report.restored {
        lines.extend(of_reset(state));
    }
    lines
}

/// What is to be said of the last grid reset.
pub fn of_reset<const D: usize>(state: &State<D>) -> impl Iterator<Item = String> {
    let lost =
        |why: &String| format!("  the surface is from now on the contour of the points: following it failed, {why}");
    state.weights.notes.iter().map(|note| format!("  {note}")).chain(state.weights.lost_front.iter().map(lost))
}
