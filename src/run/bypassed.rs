//! Warnings of what no longer acts on the soil that it is meant for: loads in a box that soil has left, held curves that it has left, and
//! structures in soil that their contacts do not name.

use super::boundary::nodes;
use super::surface::Acting;
use super::warning::WARNING;
use crate::geometry::{box_around, distance};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::step::{Report, Scene, State};
use crate::surface::place;
use crate::term::SurfaceLoad;
use std::collections::{BTreeMap, BTreeSet};

/// The part (-) of the surface in its box that a load keeps without a warning.
const LOADED: f64 = 0.8;
/// How many times as long it may become before a traction that is no pressure is told of: the sum of a pressure does not depend on the length.
const GROWN: f64 = 1.25;
/// The part (-) of its nodes within the grid that a held curve keeps in soil without a warning.
const HELD: f64 = 0.5;

/// What a phase began with, and what has been told.
#[derive(Debug, Default)]
pub struct Bypassed {
    /// The length (m) of surface that each load of [`Acting::loads`] acts on; `None` where it is not of the phase or its warning has been given.
    loaded: Vec<Option<f64>>,
    /// The number of nodes in soil of each of the [`held`] curves; `None` where its warning has been given.
    held: Vec<Option<usize>>,
}

impl Bypassed {
    /// Notes what a phase begins with, or goes on with in a run that is continued.
    pub fn begin<const D: usize>(&mut self, scene: &Scene<D>, state: &State<D>, acting: Option<&Acting>) {
        let loads = acting.map_or(&[][..], |acting| &acting.loads);
        let length = |load: &SurfaceLoad| (load.phase == state.phase).then(|| length(scene, state, load));
        self.loaded = loads.iter().map(length).collect();
        let filled = filled(scene, state);
        let count = |curve: &Held| Some(curve.nodes.iter().filter(|n| filled[**n as usize]).count());
        self.held = held(scene, state.phase).iter().map(count).collect();
    }

    /// Warnings after a step.
    pub fn found<const D: usize>(
        &mut self,
        scene: &Scene<D>,
        state: &State<D>,
        report: &Report<D>,
        acting: Option<&Acting>,
    ) -> Vec<String> {
        let phase = scene.phases.get(state.phase).map_or("", |phase| phase.name.as_str());
        let mut warnings = self.of_loads(scene, state, acting);
        if report.restored {
            warnings.extend(self.of_curves(scene, state));
            warnings.extend(self.of_structures(scene, state));
        }
        warnings.iter().map(|warning| format!("{WARNING}phase `{phase}`: {warning} (at {:.6} s)", state.time)).collect()
    }

    fn of_loads<const D: usize>(&mut self, scene: &Scene<D>, state: &State<D>, acting: Option<&Acting>) -> Vec<String> {
        let mut warnings = Vec::new();
        for (load, known) in acting.iter().flat_map(|acting| &acting.loads).zip(&mut self.loaded) {
            let Some(first) = known.filter(|first| *first > 0.0) else { continue };
            let now = length(scene, state, load);
            let least = if load.within.is_some() { LOADED * first } else { 0.0 };
            let (_, shear, fixed) = load.at(&[0.0; 2], state.phase_time);
            let grown = now > GROWN * first && (shear != 0.0 || fixed != [0.0; 2]);
            if now > least && !grown {
                continue;
            }
            *known = None;
            let place = load.within.map_or_else(String::new, |within| format!(" in {}", range(within)));
            let (why, cure) = match load.within {
                _ if grown => (
                    "the surface has stretched, or soil has parted from what it lay on, and the traction, which is one per area, acts there, too",
                    "limit it by `where`",
                ),
                Some(_) => ("soil has moved out of the box, which is fixed in space", "make it larger"),
                None => ("the surface is gone", "load another surface"),
            };
            warnings.push(format!(
                "the load on the surface{place} acts on {now:.3} m of it, and acted on {first:.3} m as the phase began: {why}; {cure}"
            ));
        }
        warnings
    }

    fn of_curves<const D: usize>(&mut self, scene: &Scene<D>, state: &State<D>) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.held.iter().all(Option::is_none) {
            return warnings;
        }
        let filled = filled(scene, state);
        for (curve, known) in held(scene, state.phase).iter().zip(&mut self.held) {
            let Some(first) = *known else { continue };
            let now = curve.nodes.iter().filter(|n| filled[**n as usize]).count();
            if now as f64 >= HELD * first as f64 {
                continue;
            }
            *known = None;
            let at = scene.origin(curve.nodes[0]);
            warnings.push(format!(
                "soil has left the curve near {at:.3?} m {}: of the {first} of its nodes that were in soil {now} are; the curve stays where it \
                 is, so use a wall or a rigid structure with a contact, or `restore: never`",
                curve.does
            ));
        }
        warnings
    }

    fn of_structures<const D: usize>(&self, scene: &Scene<D>, state: &State<D>) -> Vec<String> {
        const { assert!(D == 2, "structures have an inside in the plane only") };
        let Some(fem) = &scene.fem else { return Vec::new() };
        let mut named: BTreeMap<u16, BTreeSet<u16>> = BTreeMap::new();
        for (_, interface) in scene.touching(state.phase) {
            let sides = interface.sides();
            if !sides.soils.is_empty() && fem.mesh.cells.region.contains(&sides.structure) {
                named.entry(sides.structure).or_default().extend(&sides.soils);
            }
        }
        if named.is_empty() {
            return Vec::new();
        }
        let present: BTreeSet<u16> = state.points.region.iter().copied().collect();
        let name = |region: u16| &scene.mesh.regions[usize::from(region)];
        let mut warnings = Vec::new();
        for (structure, named) in named {
            let others: BTreeSet<u16> = present.difference(&named).copied().collect();
            if others.is_empty() {
                continue;
            }
            let part = fem.mesh.part(|c| fem.mesh.cells.region[c] == structure);
            let body = Mesh { nodes: nodes(scene, state), ..part };
            let corners = body.cells.nodes.iter().map(|&n| [0, 1].map(|d| body.nodes[n as usize][d]));
            let Some([low, high]) = box_around(corners) else { continue };
            let locator = Locator::new(&body);
            let mut found: BTreeMap<u16, (usize, [f64; D])> = BTreeMap::new();
            for (x, soil) in state.points.position.iter().zip(&state.points.region) {
                let near = (0..2).all(|d| low[d] <= x[d] && x[d] <= high[d]);
                if near && others.contains(soil) && locator.locate(&body, x, None).is_some() {
                    found.entry(*soil).or_insert((0, *x)).0 += 1;
                }
            }
            for (soil, (count, x)) in found {
                let (structure, soil) = (name(structure), name(soil));
                warnings.push(format!(
                    "the structure `{structure}` is in the soil `{soil}`, which its contacts do not name: {count} points of it have passed into \
                     it, near {x:.3?} m; add `{soil}` to the `soil` of the contact, or leave `soil` out, which means all"
                ));
            }
        }
        warnings
    }
}

/// The length (m) of the surface that a load acts on.
fn length<const D: usize>(scene: &Scene<D>, state: &State<D>, load: &SurfaceLoad) -> f64 {
    const { assert!(D == 2, "the surface is a line in the plane only") };
    let nodes = nodes(scene, state);
    let boundary = &state.weights.boundary;
    let pieces = (0..boundary.loops()).flat_map(|l| boundary.pieces(l)).filter(|p| load.acts_on(state.phase, p));
    let of = |piece| {
        let ends = [0.0, 1.0].map(|t| place(&scene.mesh, &nodes, piece, t));
        let [a, b] = ends.map(|x| [x[0], x[1]]);
        load.clip(&a, &b).map_or(0.0, |[from, to]| (to - from) * distance(&a, &b))
    };
    pieces.map(of).sum()
}

/// A box as it is written.
fn range(within: [[f64; 2]; 2]) -> String {
    let axes = ["x", "y"].into_iter().zip(within).filter(|(_, range)| range.iter().any(|end| end.is_finite()));
    axes.map(|(axis, [from, to])| format!("{axis} from {from} to {to} m")).collect::<Vec<_>>().join(" and ")
}

/// A curve within the grid, of which most lies between cells, that does something where it is.
struct Held {
    nodes: Vec<u32>,
    does: String,
}

/// The curves that a phase holds or drains, but for those on the boundary of the grid and those that go with the material.
fn held<const D: usize>(scene: &Scene<D>, phase: usize) -> Vec<Held> {
    let (count, following) = (scene.mesh_nodes(), scene.following(phase));
    let mut outer = vec![false; scene.mesh.nodes.len()];
    for &(cell, side) in &scene.locator.faces.boundary {
        let facet = scene.mesh.cells.kind[cell as usize].facets().1[side as usize];
        facet.iter().for_each(|&i| outer[scene.mesh.cells.nodes(cell as usize)[i] as usize] = true);
    }
    let fixed = scene.phases.get(phase).into_iter().flat_map(|_| scene.fixed(phase));
    let fixed = fixed.map(|f| (&f.nodes, format!("that is held in {}", ["x", "y", "z"][f.component])));
    let drained = scene.water.iter().map(|water| (&water.drained, "that is drained".to_owned()));
    let inner = |(nodes, does): (&Vec<u32>, String)| {
        let is_inner = |n: &u32| (*n as usize) < count && !outer[*n as usize] && !following[*n as usize];
        let inner: Vec<u32> = nodes.iter().copied().filter(is_inner).collect();
        (2 * inner.len() > nodes.len()).then_some(Held { nodes: inner, does })
    };
    fixed.chain(drained).filter_map(inner).collect()
}

/// Whether each node of the mesh is one of a cell with material points, as of the last reset.
fn filled<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<bool> {
    let mut filled = vec![false; scene.mesh.nodes.len()];
    let mut with_points = vec![false; scene.mesh.cells.len()];
    state.points.cell.iter().for_each(|&c| with_points[c as usize] = true);
    for n in (0..with_points.len()).filter(|&c| with_points[c]).flat_map(|c| scene.mesh.cells.nodes(c)) {
        filled[*n as usize] = true;
    }
    if let Some(fem) = &scene.fem {
        fem.mesh.cells.nodes.iter().for_each(|&n| filled[n as usize] = true);
    }
    filled
}
