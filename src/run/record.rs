//! What a run writes down: frames, rows of the history, lines of the log.

pub mod plates;
pub mod sides;

pub use plates::Force;
pub use sides::Side;

use super::accepted;
use super::boundary;
use super::fields::Field;
use super::measured::Soil;
use super::surface::{self, Acting};
use super::values::value;
use super::watch::{Watch, column_name};
use crate::io::columns::padded;
use crate::io::frame::{CELL, Column, Frame, Part, UNCOUNTED, VOLUME, triples};
use crate::io::provenance::Origin;
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::quadrature::Count;
use crate::step::{self, ITEMS, Report, Restore, Scene, State};

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

/// Whether a phase reduces strengths.
fn reduces<const D: usize>(scene: &Scene<D>) -> bool {
    scene.phases.iter().any(|phase| phase.reduction.is_some())
}

/// Whether a phase searches for the reduction that leaves no equilibrium.
fn searches<const D: usize>(scene: &Scene<D>) -> bool {
    scene.phases.iter().any(|phase| phase.search.is_some())
}

/// A row of the history; `None` where there is no soil to have a value.
pub fn row<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    watches: &[Watch],
    state: &State<D>,
    report: &Report<D>,
) -> Vec<Option<f64>> {
    let mut row = vec![Some(state.time)];
    if reduces(scene) {
        row.extend([Some(scene.phases[state.phase].reduction_at(state.phase_time)), Some(0.0)]);
    }
    if searches(scene) {
        row.push(Some(state.search_curve.last().map_or(0.0, |[_, moved]| *moved)));
    }
    let soil = Soil::<D, K>::new(scene, state);
    for watch in watches {
        row.extend(watch.quantities.iter().map(|quantity| value(&watch.on, *quantity, &soil, report)));
    }
    row
}

/// The header of the balance of energy.
pub fn energy_columns() -> Vec<String> {
    let items = ITEMS.iter().map(|(_, name, side)| format!("{}.{name} [kJ]", side.name()));
    std::iter::once("time [s]".to_string()).chain(items).collect()
}

/// A row of the balance of energy.
pub fn energy_row<const D: usize>(state: &State<D>) -> Vec<Option<f64>> {
    std::iter::once(state.time).chain(state.energies.unwrap_or_default().0).map(Some).collect()
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
        for side in [step::Side::Supplied, step::Side::Held, step::Side::Dissipated, step::Side::Numerical] {
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
