//! Voids: empty cells where there was soil.
//!
//! A void opens where a whole cell is empty, for the mesh resolves nothing narrower, and has closed where none of its cells is partly empty: one of
//! a cell's width does not come and go. The cells of a void hang together by their nodes. What was empty at the first look, or was told to
//! be no news as it opened, keeps to be none; so does what becomes part of it.

use crate::geometry::area;
use crate::mesh::{Mesh, cell_size};
use std::collections::{BTreeMap, BTreeSet};

/// How much (-) a void has grown when that is reported.
const MUCH: f64 = 2.0;

/// The voids so far: part of the state of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Voids {
    /// A label a cell: 0 where it is none of a void, `k + 1` in void `k`. Empty before the first look.
    pub of_cell: Vec<u32>,
    /// The area (m²) of each void when it was last reported; 0 of one that has closed, `None` of one that is no news.
    pub reported: Vec<Option<f64>>,
}

/// What became of a void.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum News {
    Opened,
    Grown,
    Closed,
}

/// A void of which there is news.
#[derive(Clone, Debug, PartialEq)]
pub struct Void<const D: usize> {
    pub news: News,
    /// Area (m²) in the plane, of one that has closed that which was last reported.
    pub area: f64,
    /// Its centroid (m).
    pub place: [f64; D],
    /// Its cells, ascending.
    pub cells: Vec<u32>,
}

/// Empty cells that hang together.
struct Group {
    cells: Vec<u32>,
    /// How many of its nodes each label had before.
    before: BTreeMap<u32, usize>,
}

impl Voids {
    /// Looks at cells again, of which a part `emptiness` (-) is empty, and returns the news. `is_news(cells, cut_off)` tells whether it is that a void
    /// opens, or is cut off from what was empty before.
    pub fn look<const D: usize>(
        &mut self,
        mesh: &Mesh<D>,
        emptiness: &[f64],
        is_news: &mut dyn FnMut(&[u32], bool) -> bool,
    ) -> Vec<Void<D>> {
        let count = mesh.cells.len();
        if self.of_cell.len() != count {
            *self = Self { of_cell: vec![0; count], reported: Vec::new() };
            let open: Vec<bool> = emptiness.iter().map(|&e| e >= 1.0).collect();
            for group in self.groups(mesh, &open) {
                let label = self.label(None);
                group.cells.iter().for_each(|&c| self.of_cell[c as usize] = label);
            }
            return Vec::new();
        }
        let stays = |c: usize| emptiness[c] > 0.0 && self.area(self.of_cell[c]).is_some_and(|area| area > 0.0);
        let open: Vec<bool> = (0..count).map(|c| emptiness[c] >= 1.0 || stays(c)).collect();
        let groups = self.groups(mesh, &open);
        // What a label stood for goes on in the group with most of its nodes.
        let mut heirs: BTreeMap<u32, usize> = BTreeMap::new();
        for (g, group) in groups.iter().enumerate() {
            for (&label, &nodes) in &group.before {
                let heir = heirs.entry(label).or_insert(g);
                if groups[*heir].before[&label] < nodes {
                    *heir = g;
                }
            }
        }
        let mut now = vec![0; count];
        let mut news = Vec::new();
        let mut goes_on: BTreeSet<u32> = BTreeSet::new();
        for (g, group) in groups.iter().enumerate() {
            let own: Vec<u32> = group.before.keys().copied().filter(|label| heirs[label] == g).collect();
            goes_on.extend(&own);
            let is_no_news = |label: &u32| self.reported[*label as usize - 1].is_none();
            let label = match own.iter().copied().find(is_no_news).or(own.first().copied()) {
                Some(label) => label,
                None if is_news(&group.cells, !group.before.is_empty()) => self.label(Some(0.0)),
                None => self.label(None),
            };
            goes_on.insert(label);
            group.cells.iter().for_each(|&c| now[c as usize] = label);
            // Those that it has taken in are no voids of their own any longer.
            for &other in own.iter().filter(|&&other| other != label) {
                self.reported[other as usize - 1] = Some(0.0);
            }
            let Some(reported) = &mut self.reported[label as usize - 1] else { continue };
            let (area, place) = extent(mesh, &group.cells, emptiness);
            if area > MUCH * *reported {
                let kind = if *reported > 0.0 { News::Grown } else { News::Opened };
                news.push(Void { news: kind, area, place, cells: group.cells.clone() });
                *reported = area;
            }
        }
        for (label, area) in (1..).zip(&mut self.reported) {
            if let Some(area) = area
                && *area > 0.0
                && !goes_on.contains(&label)
            {
                let cells: Vec<u32> = (0..count as u32).filter(|&c| self.of_cell[c as usize] == label).collect();
                let (_, place) = extent(mesh, &cells, &vec![1.0; count]);
                news.push(Void { news: News::Closed, area: *area, place, cells });
                *area = 0.0;
            }
        }
        self.of_cell = now;
        news
    }

    /// The area (m²) that was reported of the void of a label.
    fn area(&self, label: u32) -> Option<f64> {
        *self.reported.get((label as usize).checked_sub(1)?)?
    }

    /// The label of a new void.
    fn label(&mut self, reported: Option<f64>) -> u32 {
        self.reported.push(reported);
        self.reported.len() as u32
    }

    /// The groups of `open` cells that share nodes.
    fn groups<const D: usize>(&self, mesh: &Mesh<D>, open: &[bool]) -> Vec<Group> {
        let mut at_node: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut before: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for c in 0..open.len() {
            for &n in mesh.cells.nodes(c) {
                if open[c] {
                    at_node.entry(n).or_default().push(c as u32);
                }
                if self.of_cell[c] > 0 {
                    before.entry(n).or_default().insert(self.of_cell[c]);
                }
            }
        }
        let mut taken = vec![false; open.len()];
        let mut groups = Vec::new();
        for start in (0..open.len()).filter(|&c| open[c]) {
            if taken[start] {
                continue;
            }
            taken[start] = true;
            let (mut cells, mut next, mut nodes) = (vec![start as u32], 0, BTreeSet::new());
            while let Some(&c) = cells.get(next) {
                next += 1;
                for &n in mesh.cells.nodes(c as usize).iter().filter(|&&n| nodes.insert(n)) {
                    for &other in at_node.get(&n).into_iter().flatten() {
                        if !std::mem::replace(&mut taken[other as usize], true) {
                            cells.push(other);
                        }
                    }
                }
            }
            cells.sort_unstable();
            let mut labels = BTreeMap::new();
            for label in nodes.iter().filter_map(|n| before.get(n)).flatten() {
                *labels.entry(*label).or_insert(0) += 1;
            }
            groups.push(Group { cells, before: labels });
        }
        groups
    }
}

/// The empty area (m²) in and around `cells`, to which `emptiness` gives parts of each, and its centroid (m).
fn extent<const D: usize>(mesh: &Mesh<D>, cells: &[u32], emptiness: &[f64]) -> (f64, [f64; D]) {
    let nodes: BTreeSet<u32> = cells.iter().flat_map(|&c| mesh.cells.nodes(c as usize)).copied().collect();
    let mut is_own = vec![false; mesh.cells.len()];
    cells.iter().for_each(|&c| is_own[c as usize] = true);
    let (mut sum, mut first) = (0.0, [0.0; D]);
    for c in (0..mesh.cells.len()).filter(|&c| emptiness[c] > 0.0) {
        if is_own[c] || mesh.cells.nodes(c).iter().any(|n| nodes.contains(n)) {
            let corners = mesh.cells.corners(c);
            let outline: Vec<[f64; 2]> = corners.iter().map(|&n| [0, 1].map(|d| mesh.nodes[n as usize][d])).collect();
            let empty = emptiness[c] * area(&outline);
            sum += empty;
            for &n in corners {
                for d in 0..D {
                    first[d] += empty * mesh.nodes[n as usize][d] / corners.len() as f64;
                }
            }
        }
    }
    (sum, first.map(|f| f / sum))
}

/// Whether a void of `cells` reaches as near to one of some places (m) as the size of its largest cell.
pub fn lies_near<const D: usize>(mesh: &Mesh<D>, cells: &[u32], places: &[[f64; D]]) -> bool {
    let reach = cells.iter().map(|&c| cell_size(mesh, c as usize)).fold(0.0, f64::max);
    let nodes: BTreeSet<u32> = cells.iter().flat_map(|&c| mesh.cells.nodes(c as usize)).copied().collect();
    let square = |a: &[f64; D], b: &[f64; D]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    nodes.iter().any(|&n| places.iter().any(|x| square(&mesh.nodes[n as usize], x) <= reach * reach))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// The emptiness of cells of 0.5 m: what lies within one of some boxes is empty.
    fn empty(mesh: &Mesh<2>, boxes: &[[f64; 4]]) -> Vec<f64> {
        let part = |low: f64, high: f64, at: f64| (high.min(at + 0.5) - low.max(at)).max(0.0) / 0.5;
        let of_cell = |c: usize| {
            let corner = mesh.nodes[mesh.cells.nodes(c)[0] as usize];
            boxes.iter().map(|[x, y, to_x, to_y]| part(*x, *to_x, corner[0]) * part(*y, *to_y, corner[1])).sum()
        };
        (0..mesh.cells.len()).map(of_cell).collect()
    }

    /// Looks at one state after another and returns the news.
    fn news(states: &[&[[f64; 4]]], is_news: bool) -> Vec<Vec<(News, f64)>> {
        let mesh = rectangle(CellKind::Q4, 8.0, 4.0, 16, 8, 0.0, 0);
        let mut voids = Voids::default();
        let mut look = |boxes: &&[[f64; 4]]| {
            let news = voids.look(&mesh, &empty(&mesh, boxes), &mut |_, _| is_news);
            news.into_iter().map(|void| (void.news, void.area)).collect()
        };
        states.iter().map(&mut look).collect()
    }

    const AIR: [f64; 4] = [0.0, 3.0, 8.0, 4.0];

    #[test]
    fn what_is_empty_from_the_start_is_no_news() {
        let tunnel = |size: f64| [2.0, 1.0, 2.0 + size, 2.0];
        let states: [&[[f64; 4]]; 3] = [&[AIR, tunnel(1.0)], &[AIR, tunnel(3.0)], &[AIR]];
        assert_eq!(news(&states, true), vec![vec![]; 3]);
    }

    #[test]
    fn a_void_is_reported_as_it_opens_has_doubled_and_has_closed() {
        let void = |right: f64| [2.0, 1.0, right, 1.5];
        let states: [&[[f64; 4]]; 8] = [
            &[AIR],
            // Narrower than a cell; a cell, less than twice as much, twice, a part of a cell, and none.
            &[AIR, void(2.4)],
            &[AIR, void(2.5)],
            &[AIR, void(2.9)],
            &[AIR, void(3.6)],
            &[AIR, void(2.25)],
            &[AIR, void(2.25)],
            &[AIR],
        ];
        let news = news(&states, true);
        let expected = [
            vec![],
            vec![],
            vec![(News::Opened, 0.25)],
            vec![],
            vec![(News::Grown, 0.8)],
            vec![],
            vec![],
            vec![(News::Closed, 0.8)],
        ];
        for (found, expected) in news.iter().zip(&expected) {
            assert_eq!(found.len(), expected.len(), "{news:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-12), "{news:?}");
        }
    }

    #[test]
    fn a_part_that_is_cut_off_is_new_and_one_that_is_no_news_stays_so() {
        let (notch, hole) = ([2.0, 1.0, 3.0, 3.0], [2.0, 1.0, 3.0, 2.0]);
        let states: [&[[f64; 4]]; 4] = [&[AIR], &[AIR, notch], &[AIR, hole], &[AIR, notch]];
        let found = news(&states, true);
        assert_eq!(found[2], [(News::Opened, 1.0)]);
        // Part of the air again.
        assert_eq!([found[1].len(), found[3].len()], [0, 0], "{found:?}");
        // Two spaces from the start, of which one is smaller.
        assert_eq!(news(&[&[AIR, hole], &[AIR, hole], &[AIR, [2.0, 1.0, 3.0, 2.5]]], true), vec![vec![]; 3]);
        assert_eq!(news(&states, false), vec![vec![]; 4]);
        // A void drifts on by less than a cell.
        let at = |x: f64| [x, 1.0, x + 1.0, 2.0];
        let states: [&[[f64; 4]]; 5] = [&[AIR], &[AIR, at(2.0)], &[AIR, at(2.3)], &[AIR, at(2.6)], &[AIR, at(2.9)]];
        assert_eq!(news(&states, true).concat(), [(News::Opened, 1.0)]);
    }
}
