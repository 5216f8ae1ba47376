//! The entries of the history: what they are of, and what they ask of it.

use super::check::Checker;
use super::checked::{Case, Content, History, On, Place, Quantity};
use super::layout::bounds;
use super::locate::{At, Path};
use super::raw;
use crate::geometry::box_around;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use std::collections::HashSet;

impl Checker {
    /// The entries that are sound.
    pub(super) fn histories(&mut self, entries: &[raw::History], path: &Path) -> Vec<History> {
        let mut names = HashSet::new();
        let mut found = Vec::new();
        for (i, entry) in entries.iter().enumerate() {
            let path = path.index(i);
            if !names.insert(&entry.name) {
                let problem = format!("two entries are called `{}`", entry.name);
                self.issue(&path.key("name"), At::Value, problem, "give each entry a name of its own");
            }
            if entry.name.contains([',', '"', '\n']) {
                let problem = "the name has a comma, a quote or a line break in it";
                self.issue(&path.key("name"), At::Value, problem, "it heads a CSV column: choose a plain name");
            }
            let Some(on) = self.on(entry, &path) else { continue };
            let quantities: Vec<Quantity> = entry.quantities.iter().map(|&quantity| quantity.into()).collect();
            for (k, quantity) in quantities.iter().enumerate() {
                if let Some((problem, remedy)) = refused(&on, *quantity) {
                    self.issue(&path.key("quantities").index(k), At::Value, problem, remedy);
                }
            }
            found.push(History { name: entry.name.clone(), on, quantities });
        }
        found
    }

    /// What an entry is of.
    fn on(&mut self, entry: &raw::History, path: &Path) -> Option<On> {
        let raw::History { on, at, follow, r#box, line, .. } = entry;
        if *follow && at.is_none() {
            let remedy = "take `follow` out, or give the place `at` which the soil was seeded";
            self.issue(&path.key("follow"), At::Value, "only the soil at a point is followed", remedy);
        }
        let corners = |[a, b, c, d]: [f64; 4]| [[a, b], [c, d]];
        match (on, at, r#box, line) {
            (Some(name), None, None, None) => Some(On::Named(name.clone())),
            (None, Some(at), None, None) if *follow => Some(On::Place(Place::Followed(*at))),
            (None, Some(at), None, None) => Some(On::Place(Place::Fixed(*at))),
            (None, None, Some(sides), None) => {
                let [low, high] = corners(*sides);
                if low[0] >= high[0] || low[1] >= high[1] {
                    let problem = "the second corner is not above the first and to the right of it";
                    let remedy = "write `[left, bottom, right, top]`";
                    self.issue(&path.key("box"), At::Value, problem, remedy);
                }
                Some(On::Place(Place::Box([low, high])))
            }
            (None, None, None, Some(ends)) => {
                let [a, b] = corners(*ends);
                if a == b {
                    let remedy = "write two ends, or give the point under `at`";
                    self.issue(&path.key("line"), At::Value, "the line has no length", remedy);
                }
                Some(On::Place(Place::Line([a, b])))
            }
            _ => {
                let problem = "this says not, or not only once, what the entry is of";
                self.issue(path, At::Key, problem, "give one of `on`, `at`, `box` and `line`");
                None
            }
        }
    }
}

/// Why a place has not a quantity, and what to do.
fn refused(on: &On, quantity: Quantity) -> Option<(&'static str, &'static str)> {
    match (on, quantity) {
        (On::Place(Place::Line(_)), Quantity::Thickness) => None,
        (_, Quantity::Thickness) => Some(("only a line has it", "give a `line` from below the soil to above it")),
        (On::Named(_), _) => None,
        (On::Place(_), _) if quantity.is_of_bodies() => Some((
            "a place in the soil has no force, moment or rotation",
            "take it out, or name a structure or a curve under `on`",
        )),
        (On::Place(Place::Box(_)), _) => None,
        (On::Place(_), _) if quantity.is_of_many() => Some((
            "a point or a line has none: it is that of many points",
            "take it out, or give a `box`, or a region under `on`",
        )),
        (On::Place(_), _) => None,
    }
}

/// A warning for each entry whose place has no soil, now or ever.
pub(super) fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let is_grid = |content: &Content| matches!(content, Content::Mpm { .. } | Content::Buffer);
    let of = |c: usize| case.content(&mesh.regions[usize::from(mesh.cells.region[c])]);
    let grid = mesh.part(|c| of(c).as_ref().is_some_and(is_grid));
    let places = case.output.history.iter().filter_map(|entry| match &entry.on {
        On::Place(place) => Some((&entry.name, place)),
        On::Named(_) => None,
    });
    let mut places = places.peekable();
    let (Some(_), Some(around)) = (places.peek(), bounds(&grid)) else { return Vec::new() };
    let locator = Locator::new(&grid);
    let content = |x: &[f64; 2]| {
        let (c, _) = locator.locate(&grid, x, None)?;
        case.content(&grid.regions[usize::from(grid.cells.region[c as usize])])
    };
    let problem = |place: &Place| match place {
        Place::Fixed(x) => content(x).is_none().then(|| format!("{x:?} m lies outside the grid")),
        Place::Followed(x) => {
            let is_soil = matches!(content(x), Some(Content::Mpm { .. }));
            (!is_soil).then(|| format!("no soil of `kind: mpm` is seeded at {x:?} m"))
        }
        Place::Box(ends) | Place::Line(ends) => {
            let [low, high] = box_around(ends.iter().copied())?;
            let apart = (0..2).any(|d| low[d] > around[1][d] || high[d] < around[0][d]);
            apart.then(|| "its place lies outside the grid".to_owned())
        }
    };
    let warning = |(name, place): (&String, &Place)| {
        let problem = problem(place)?;
        Some(format!("warning: the history `{name}` stays empty: {problem}; give a place in the soil"))
    };
    places.filter_map(warning).collect()
}
