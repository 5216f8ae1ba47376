//! Lines one after the other.

use crate::geometry::{cross, dot};
use std::collections::BTreeMap;

/// The loops that lines make, as lists of their numbers: each begins where the one before ends. A line has a vertex at each end, and a direction.
pub fn loops<V: Ord>(ends: &[[V; 2]], direction: impl Fn(usize) -> [f64; 2]) -> Vec<Vec<usize>> {
    let mut outgoing: BTreeMap<&V, Vec<usize>> = BTreeMap::new();
    for (number, [from, _]) in ends.iter().enumerate() {
        outgoing.entry(from).or_default().push(number);
    }
    let (mut loops, mut used) = (Vec::new(), vec![false; ends.len()]);
    for start in 0..ends.len() {
        let (mut own, mut next) = (Vec::new(), Some(start).filter(|&n| !used[n]));
        while let Some(at) = next {
            used[at] = true;
            own.push(at);
            let along = direction(at);
            // Where bodies touch in a node, the sharpest turn to the left stays with the same one.
            let turn = |&number: &usize| {
                let other = direction(number);
                cross(&along, &other).atan2(dot(&along, &other))
            };
            let from_here = outgoing.get(&ends[at][1]).into_iter().flatten().copied().filter(|&n| !used[n]);
            next = from_here.max_by(|a, b| turn(a).total_cmp(&turn(b)));
        }
        if !own.is_empty() {
            loops.push(own);
        }
    }
    loops
}
