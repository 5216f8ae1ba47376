//! The blocks of a pattern in two halves that have no entry in common but by a separator: what nested dissection (George
//! 1973) begins with. Here the one cut is there for two threads to work on a half each; within the halves the order is by
//! degree.
//!
//! A straight line across parts the blocks by where they are, into two of as many equations; the separator is the fewest
//! blocks that are at one end at least of every edge across the line (König 1931).

use super::Pattern;
use std::collections::VecDeque;

/// Multiplications to factorise a plane mesh of `n` equations, two a node: about `WORK · n^1.5` (George 1973: 829/84 for
/// one a node).
const WORK: f64 = 28.0;
/// The most that the slower thread may have to do, of what one has to do without halves.
const WORTH: f64 = 0.65;
/// Places that are this close, relative to the extent of all, are on one side of a line.
const CLOSE: f64 = 1e-9;
/// No partner.
const NONE: u32 = u32::MAX;

/// Blocks in three parts, each ascending.
#[derive(Debug, PartialEq)]
pub struct Parts {
    /// No block of the one is beside one of the other.
    pub halves: [Vec<u32>; 2],
    pub separator: Vec<u32>,
}

/// Dissection the blocks of `pattern` where that is worth while. `places` has where the first of them are; the others are
/// taken to be amid those beside them.
pub fn halve<const D: usize>(pattern: &Pattern, places: &[[f64; D]]) -> Option<Parts> {
    let parts = (0..D).filter_map(|axis| across(pattern, &along(pattern, places, axis)?));
    let cost = |parts: &Parts| {
        let [first, second] = parts.halves.each_ref().map(|half| weigh(pattern, half));
        // What is left of the separator is eliminated, put together again, and eliminated with what the other half leaves.
        WORK * first.max(second).powf(1.5) + 0.5 * weigh(pattern, &parts.separator).powi(3)
    };
    let parts = parts.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
    (cost(&parts) < WORTH * WORK * (pattern.len() as f64).powf(1.5)).then_some(parts)
}

/// Equations of blocks.
fn weigh(pattern: &Pattern, blocks: &[u32]) -> f64 {
    blocks.iter().map(|&b| f64::from(pattern.start[b as usize + 1] - pattern.start[b as usize])).sum()
}

/// Where all blocks are along an axis.
fn along<const D: usize>(pattern: &Pattern, places: &[[f64; D]], axis: usize) -> Option<Vec<f64>> {
    let blocks = pattern.start.len() - 1;
    let mut along: Vec<f64> = places.iter().take(blocks).map(|place| place[axis]).collect();
    for b in along.len()..blocks {
        let beside = pattern.neighbours(b).iter().filter_map(|&n| places.get(n as usize));
        let (count, sum) = beside.fold((0.0, 0.0), |(count, sum), place| (count + 1.0, sum + place[axis]));
        along.push(if count > 0.0 { sum / count } else { 0.0 });
    }
    (!places.is_empty() && along.iter().all(|at| at.is_finite())).then_some(along)
}

/// Parts the blocks where half of the equations are on either side.
fn across(pattern: &Pattern, along: &[f64]) -> Option<Parts> {
    let mut order: Vec<u32> = (0..along.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| along[a as usize].total_cmp(&along[b as usize]));
    let (first, last) = (along[*order.first()? as usize], along[*order.last()? as usize]);
    let middle = order.iter().scan(0, |sum, &b| {
        *sum += 2 * (pattern.start[b as usize + 1] - pattern.start[b as usize]) as usize;
        Some((*sum > pattern.len()).then_some(along[b as usize]))
    });
    let line = middle.flatten().next()? - CLOSE * (last - first);
    let lower = |b: u32| along[b as usize] < line;
    // The edges across the line, by their upper ends, which are of the heavier part; the lower ones are numbered as they come.
    let (mut uppers, mut lowers, mut edges) = (Vec::new(), Vec::new(), Vec::new());
    let mut number = vec![NONE; along.len()];
    for b in (0..along.len() as u32).filter(|&b| !lower(b)) {
        let mut ends = Vec::new();
        for &n in pattern.neighbours(b as usize).iter().filter(|&&n| lower(n)) {
            if number[n as usize] == NONE {
                number[n as usize] = lowers.len() as u32;
                lowers.push(n);
            }
            ends.push(number[n as usize]);
        }
        if !ends.is_empty() {
            uppers.push(b);
            edges.push(ends);
        }
    }
    let [of_uppers, of_lowers] = cover(&edges, lowers.len());
    let ends = uppers.into_iter().zip(of_uppers).chain(lowers.into_iter().zip(of_lowers));
    let mut separator: Vec<u32> = ends.filter(|(_, chosen)| *chosen).map(|(b, _)| b).collect();
    separator.sort_unstable();
    let half = |side: bool| {
        let own = |b: &u32| lower(*b) == side && separator.binary_search(b).is_err();
        (0..along.len() as u32).filter(own).collect()
    };
    Some(Parts { halves: [half(true), half(false)], separator })
}

/// The fewest nodes of a bipartite graph that all edges end at: which of the left, rather, and which of the right ones.
/// `edges` has the right ends of each left node.
fn cover(edges: &[Vec<u32>], right: usize) -> [Vec<bool>; 2] {
    // As many pairs as there can be: each path from a left to a right node that are alone gives one more.
    let (mut of_left, mut of_right) = (vec![NONE; edges.len()], vec![NONE; right]);
    for start in 0..edges.len() as u32 {
        let (reached, mut end) = search(edges, &of_right, [start]);
        while end != NONE {
            let left = reached[end as usize];
            (of_right[end as usize], end) = (left, std::mem::replace(&mut of_left[left as usize], end));
        }
    }
    let alone = (0..edges.len() as u32).filter(|&left| of_left[left as usize] == NONE);
    let of_right: Vec<bool> = search(edges, &of_right, alone).0.iter().map(|&from| from != NONE).collect();
    let of_left = edges.iter().map(|ends| ends.iter().any(|&end| !of_right[end as usize])).collect();
    [of_left, of_right]
}

/// What can be reached from left nodes by edges, and back by partners: the left node before each right one, and the first
/// right node that is alone, with which the search ends.
fn search(edges: &[Vec<u32>], of_right: &[u32], roots: impl IntoIterator<Item = u32>) -> (Vec<u32>, u32) {
    let mut before = vec![NONE; of_right.len()];
    let mut open: VecDeque<u32> = roots.into_iter().collect();
    while let Some(left) = open.pop_front() {
        for &end in &edges[left as usize] {
            if before[end as usize] == NONE {
                before[end as usize] = left;
                match of_right[end as usize] {
                    NONE => return (before, end),
                    partner => open.push_back(partner),
                }
            }
        }
    }
    (before, NONE)
}
