//! Contact forces on a part of the boundary of a structure.

use crate::contact::Tractions;
use crate::geometry::nearest;
use crate::run::boundary;
use crate::step::{Scene, State};
use std::f64::consts::TAU;

/// A named curve of a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// The number of the region of the structure.
    pub region: u16,
    /// The nodes of its facets in Gmsh's order.
    pub facets: Vec<Vec<u32>>,
    /// Those of the rest of the boundary of the structure.
    pub rest: Vec<Vec<u32>>,
    /// Whether the plane is turned about its axis.
    pub turned: bool,
}

/// The force (kN) of contact on a side in the last step: the integral of the tractions that the frames show, over the pieces of the boundary on it.
pub fn contact<const D: usize>(scene: &Scene<D>, state: &State<D>, side: &Side) -> [f64; 2] {
    const { assert!(D == 2, "boundaries are lines in the plane only") };
    let nodes = boundary::nodes(scene, state);
    let at = |n: u32| nodes[n as usize];
    let plane = |x: [f64; D]| [x[0], x[1]];
    // Curves are seen as straight between nodes, so a piece of the boundary is of what lies nearest.
    let [own, rest] = [&side.facets, &side.rest].map(|facets| {
        let pieces = facets.iter().flat_map(|facet| match facet[..] {
            [a, b, middle] => vec![[a, middle], [middle, b]],
            [a, b, ..] => vec![[a, b]],
            _ => Vec::new(),
        });
        pieces.map(|ends| ends.map(|n| plane(at(n)))).collect::<Vec<[[f64; 2]; 2]>>()
    });
    let distance = |pieces: &[[[f64; 2]; 2]], x: &[f64; 2]| {
        pieces.iter().map(|piece| nearest(x, piece).1).fold(f64::INFINITY, f64::min)
    };
    let touching: Vec<usize> =
        scene.touching(state.phase.min(scene.phases.len() - 1)).map(|(number, _)| number).collect();
    let mut force = [0.0; 2];
    for (i, interface) in scene.interfaces.iter().enumerate() {
        let Some(held) = state.multipliers.get(i).filter(|_| touching.contains(&i)) else { continue };
        if interface.sides().structure != side.region {
            continue;
        }
        let lines = interface.lines(&at);
        let exerted = Tractions::new(&lines, interface.runs(), held);
        for ends in lines.iter().flat_map(|line| line.windows(2)) {
            let [a, b] = [&ends[0], &ends[1]].map(|mark| plane(mark.place));
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let middle = [0, 1].map(|d| 0.5 * (a[d] + b[d]));
            if distance(&own, &middle) > distance(&rest, &middle) {
                continue;
            }
            let [m, n] = [a, b].map(|x| if side.turned { TAU * x[0] } else { 1.0 });
            let [from, to] = [&ends[0], &ends[1]].map(|mark| mark.vector(&exerted.traction));
            for d in 0..2 {
                force[d] += length / 6.0 * ((2.0 * m + n) * from[d] + (m + 2.0 * n) * to[d]);
            }
        }
    }
    force
}
