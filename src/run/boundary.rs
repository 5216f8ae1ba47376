//! What frames hold of contact: the values of the contact nodes along the boundaries of structures, as lines.

use crate::contact::Tractions;
use crate::io::frame::{Column, FACES, LINE, Part, REGION, triples};
use crate::step::{Scene, State};

/// The lines of all interfaces in contact, with what their contact nodes came to in the last step; empty without contact.
///
/// Pressure (kPa, compression positive) and traction (kPa) on the structure, both without oscillations from node to node: the integral of the traction
/// along the lines is the force of the contact, see [`Tractions`]. Shear (kPa) on the soil and slip (m) since the run began, positive along the boundary with
/// the structure on the left, and gap (m, positive where they are apart). Between contact nodes they are linear.
/// The gap of a contact node that has no soil before it is not known: [`FACES`] is 0 wherever it counts.
pub fn part<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Part {
    if scene.interfaces.is_empty() {
        return Part::default();
    }
    let nodes = nodes(scene, state);
    let position = |n: u32| nodes[n as usize];
    let mut place = Vec::new();
    let [mut pressure, mut shear, mut gap, mut slip] = [const { Vec::new() }; 4];
    let mut tractions = Vec::new();
    let [mut number, mut region, mut faces] = [const { Vec::new() }; 3];
    let mut count = 0;
    for (i, interface) in scene.interfaces.iter().enumerate() {
        // Before the first step nothing is known yet.
        let held = state.multipliers.get(i);
        let lines = interface.lines(&position);
        let exerted = held.map(|h| Tractions::new(&lines, interface.runs(), h));
        for line in &lines {
            for mark in line {
                let known = held
                    .is_some_and(|h| mark.contact_nodes.iter().all(|&(k, share)| share == 0.0 || h.faces[k as usize]));
                place.push(mark.place);
                pressure.push(exerted.as_ref().map_or(0.0, |t| mark.value(&t.pressure)));
                shear.push(held.map_or(0.0, |h| mark.value(&h.shear)));
                gap.push(held.filter(|_| known).map_or(0.0, |h| mark.value(&h.gap)));
                slip.push(held.map_or(0.0, |h| mark.value(&h.slid)));
                tractions.extend(exerted.as_ref().map_or([0.0; 3], |t| mark.vector(&t.traction)));
                number.push(f64::from(count));
                region.push(f64::from(interface.sides().structure));
                faces.push(f64::from(u8::from(known)));
            }
            count += 1;
        }
    }
    let columns = vec![
        Column::new("contact_pressure", "kPa", 1, pressure),
        Column::new("contact_shear", "kPa", 1, shear),
        Column::new("contact_traction", "kPa", 3, tractions),
        Column::new("contact_gap", "m", 1, gap),
        Column::new("contact_slip", "m", 1, slip),
        Column::new(LINE, "-", 1, number),
        Column::new(REGION, "-", 1, region),
        Column::new(FACES, "-", 1, faces),
    ];
    Part { position: triples(&place), columns }
}

/// Where the nodes are now (m).
pub fn nodes<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<[f64; D]> {
    let moved = |(x, u): (&[f64; D], &[f64; D])| std::array::from_fn(|d| x[d] + u[d]);
    state.coordinates(scene).iter().zip(&state.displacement).map(moved).collect()
}
