//! The values of the history after a step.

use super::measured::{Soil, mean_over, members, over};
use super::record::{plates, sides};
use super::watch::{Quantity, WatchedOn};
use crate::kinematics::Kinematics;
use crate::rigid::Body;
use crate::step::{Report, Scene, State};

/// The value of a quantity of what is watched, as the converged state of a step and its report have it; `None` where there is no soil to have one.
pub fn value<const D: usize, K: Kinematics<D>>(
    on: &WatchedOn,
    quantity: Quantity,
    soil: &Soil<D, K>,
    report: &Report<D>,
) -> Option<f64> {
    let (scene, state) = (soil.scene, soil.state);
    let contact = |region: u16| report.contacts.iter().map(move |c| c.on(region));
    Some(match (on, quantity) {
        (WatchedOn::Nodes(nodes) | WatchedOn::Side(nodes, _), Quantity::Displacement(d)) => {
            mean(nodes.iter().map(|&n| travel(state, n as usize, d)))
        }
        (WatchedOn::Nodes(nodes) | WatchedOn::Side(nodes, _), Quantity::Velocity(d)) => {
            mean(nodes.iter().map(|&n| state.velocity.get(n as usize).map_or(0.0, |v| v[d])))
        }
        (WatchedOn::Nodes(nodes), Quantity::Reaction(d)) => nodes.iter().map(|&n| report.reaction[n as usize][d]).sum(),
        (WatchedOn::Nodes(nodes), Quantity::PorePressure) => {
            let [places, _] = scene.places();
            let value = |n: u32| state.pressure.get(places.pore(n)).filter(|_| scene.water.is_some());
            mean(nodes.iter().map(|&n| value(n).copied().unwrap_or(0.0)))
        }
        (WatchedOn::Side(_, body), Quantity::Reaction(_)) => of_body(*body, quantity, scene, state, report),
        (WatchedOn::Body(body), _) => of_body(*body, quantity, scene, state, report),
        (WatchedOn::Region(region), Quantity::Contact(d)) => contact(*region).map(|(force, _)| force[d]).sum(),
        (WatchedOn::Region(region), Quantity::ContactMoment) => {
            moment_about(&centroid(state, *region), contact(*region))
        }
        (WatchedOn::Region(region), _) => return over(members(state, *region), quantity, scene),
        (WatchedOn::Soil(place), _) => return soil.at(place, quantity),
        (WatchedOn::Outflow(_, number), Quantity::Out(k)) => state.left.get(*number).map_or(0.0, |left| left[k]),
        (WatchedOn::Inflow(_, number), Quantity::In(k)) => state.entered.get(*number).map_or(0.0, |entered| entered[k]),
        (WatchedOn::Outflow(on, _) | WatchedOn::Inflow(on, _), _) => return value(on, quantity, soil, report),
        (WatchedOn::Touched(_, side), Quantity::Contact(d)) => sides::contact(scene, state, side)[d],
        (WatchedOn::Touched(on, _), _) => return value(on, quantity, soil, report),
        (WatchedOn::Bar(number), Quantity::BarForce) => state.force_of_bar(scene, *number),
        (WatchedOn::Plate(region, turned), Quantity::Section(force)) => {
            plates::largest(scene, state, (*region, *turned), force)
        }
        (WatchedOn::Plate(region, _), _) => return value(&WatchedOn::Region(*region), quantity, soil, report),
        // A curve has no contact and no soil; only rigid bodies turn.
        (WatchedOn::Nodes(_) | WatchedOn::Side(..) | WatchedOn::Bar(_), _) => 0.0,
    })
}

/// How far (m) a node has gone since displacements are counted.
fn travel<const D: usize>(state: &State<D>, n: usize, d: usize) -> f64 {
    state.travel[n][d] - state.uncounted.get(n).map_or(0.0, |u| u[d])
}

/// A quantity of a rigid body, by its number in the scene.
fn of_body<const D: usize>(
    number: usize,
    quantity: Quantity,
    scene: &Scene<D>,
    state: &State<D>,
    report: &Report<D>,
) -> f64 {
    let body = &scene.bodies[number];
    let Body { region, dofs, .. } = body;
    let motion = || dofs.motion::<D>(|n| std::array::from_fn(|d| travel(state, n as usize, d)));
    let reaction = || dofs.load(|n| report.reaction[n as usize]);
    let contact = || report.contacts.iter().map(|c| c.on(*region));
    match quantity {
        Quantity::Displacement(d) => motion().0[d],
        Quantity::Velocity(d) => state.velocity.get(dofs.translation as usize).map_or(0.0, |v| v[d]),
        Quantity::Reaction(d) => reaction().0[d],
        Quantity::Contact(d) => contact().map(|(force, _)| force[d]).sum(),
        Quantity::Rotation => motion().1,
        Quantity::ReactionMoment => reaction().1,
        Quantity::ContactMoment => {
            let centre = body.centre_after(&state.travel);
            dofs.rotation.map_or(0.0, |_| moment_about(&[centre[0], centre[1]], contact()))
        }
        // It has no soil.
        _ => 0.0,
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
    [0, 1].map(|d| mean_over(members(state, region), |points, p| points.position[p][d]).unwrap_or(0.0))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0usize, 0.0), |(n, s), v| (n + 1, s + v));
    if count > 0 { sum / count as f64 } else { 0.0 }
}
