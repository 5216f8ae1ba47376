//! Warnings of what a case may have, and surely does not mean: it runs, and its numbers are wrong.
//!
//! Each has a bound that no sound case comes near to; what may be meant is not warned of.

mod contacts;
mod falls;
mod loads;
mod own_weight;

use self::falls::{GOOD_STEP, LONG_STEP};
use super::checked::{Case, Content, Phase, Touched, Touching};
use super::layout::{Bounds, bounds, farthest, gap, moves};
use super::unconnected::Place;
use super::{at_rest, drains, equilibrium, histories, plates, records, unlikely};
use crate::error::Result;
use crate::geometry::box_around;
use crate::mesh::quality::SAME;
use crate::mesh::{Mesh, cell_size};
use crate::time_value::TimeValue;

/// Newton's tolerance (-) above which the error of each step, which adds up, is one of the results: a run has hundreds of steps.
const LOOSE: f64 = 1e-4;
/// Cells across a structure below which its limit load is that of the cells: with eight it is 6 to 12 % too high (docs/numerics.md), and
/// the error goes with the size of the cells.
const FEW_CELLS: f64 = 4.0;
/// Cells across it that are told instead, as docs/reference/messages.md has it.
const GOOD_CELLS: f64 = 6.0;
/// The same as [`FEW_CELLS`] across one that is [`SLENDER`], most of whose load is along its sides: `cases/suction_anchor` has two and bears within 5 %.
const FEW_CELLS_OF_A_WALL: f64 = 2.0;
/// How many times (-) as long on its way as it is wide a wall or a pile is.
const SLENDER: f64 = 4.0;

/// What shows without the mesh, given where the regions lie.
pub fn of_case(case: &Case, places: &[Place]) -> Vec<String> {
    let tolerance = case.numerics.solver.tolerance;
    let loose = (tolerance > LOOSE).then(|| {
        format!(
            "warning: `numerics.tolerance` is {tolerance:e}: each step leaves an error of that part of the forces, and they add up; leave \
             it out (the default is 1e-8), or set {LOOSE:e} at most"
        )
    });
    let strange = case.unlikely.iter().cloned().chain(unlikely::extents(case, places));
    let told = strange.chain(loose).chain(room(case, places)).chain(above_water(case, places));
    let told = told.chain(equilibrium::undrained(case));
    let told = told.chain(records::warnings(case));
    told.chain(loads::of_case(case)).chain(own_weight::of_case(case, places)).collect()
}

/// A warning for each structure that is pressed down into soil that has no cells to heave into.
fn room(case: &Case, places: &[Place]) -> Vec<String> {
    let of = |wanted: fn(&Content) -> bool| {
        places.iter().filter(move |place| case.content(&place.name).as_ref().is_some_and(wanted))
    };
    let top = |place: &Place| place.bounds[1][1];
    let surface = of(|content| matches!(content, Content::Mpm { .. })).map(top).fold(f64::NEG_INFINITY, f64::max);
    let free = of(|content| matches!(content, Content::Buffer)).map(top).fold(f64::NEG_INFINITY, f64::max);
    let height = places.iter().map(|place| top(place) - place.bounds[0][1]).fold(0.0, f64::max);
    if free > surface + SAME * height {
        return Vec::new();
    }
    let pressed = of(Content::is_structure).filter(|place| {
        let touches = case.contacts.iter().any(|contact| {
            matches!((&contact.structure, &contact.on), (Touching::Structure(r), Touched::Soil(_)) if case.regions[*r].name == place.name)
        });
        // From above: what lies within the soil may move it around.
        touches && place.bounds[1][1] > surface + SAME * height && case.phases.iter().any(|phase| sinks(phase, &place.name))
    });
    let warning = |place: &Place| {
        format!(
            "warning: the structure `{}` is pressed into soil that has no room to heave: no region of `kind: buffer` lies above it, and soil \
             stays below y = {surface} m; add a surface for one to the .geo",
            place.name
        )
    };
    pressed.map(warning).collect()
}

/// A warning for each region of undrained soil that reaches above the level of the water in the pores.
fn above_water(case: &Case, places: &[Place]) -> Vec<String> {
    let table = case.water.as_ref().and_then(|water| water.phreatic.as_ref()?.first());
    let Some(table) = table else { return Vec::new() };
    let level = |place: &Place| table.highest_at_first(place.bounds.map(|x| x[0]));
    let reaches = |place: &&Place| place.bounds[1][1] - level(place) > SAME * (place.bounds[1][1] - place.bounds[0][1]);
    let is_undrained = |place: &&Place| {
        let soil = case.content(&place.name).filter(|content| !content.is_structure());
        let material = soil.and_then(|content| content.material());
        material.is_some_and(|material| case.materials[material].has_pore_pressure())
    };
    let warning = |place: &Place| {
        format!(
            "warning: the undrained soil `{}` reaches {:.3} m above the `phreatic_level` at y = {} m: its pores count as full of water there, \
             too, and take excess pressure; if they are not, make that part a region of its own with a drained material",
            place.name,
            place.bounds[1][1] - level(place),
            level(place)
        )
    };
    places.iter().filter(is_undrained).filter(reaches).map(warning).collect()
}

/// Whether a phase moves the rigid structure `name` downwards.
fn sinks(phase: &Phase, name: &str) -> bool {
    let motions = phase.prescribed.iter().filter(|p| p.curve == name && p.component == 1);
    motions.into_iter().any(|p| p.displacement.at(phase.duration) < 0.0)
}

/// What shows on the mesh: cells and steps that are too coarse, contacts and loads that act on nothing, an initial stress that is not in
/// equilibrium, water that cannot leave.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Result<Vec<String>> {
    let of_rest: Vec<String> = at_rest::imbalance(case, mesh)?.into_iter().collect();
    let of_water = drains::on_mesh(case, mesh)?;
    let of_steps = [coarse(case, mesh), plates::coarse(case, mesh), falls::on_mesh(case, mesh)].concat();
    let of_loads = [contacts::on_mesh(case, mesh), loads::on_mesh(case, mesh)].concat();
    Ok([of_steps, of_loads, of_rest, of_water, histories::on_mesh(case, mesh)].concat())
}

/// Cells and steps that are too coarse for the structures that move in soil, and ways that lead out of the grid.
fn coarse(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let content = |c: usize| case.content(&mesh.regions[usize::from(mesh.cells.region[c])]);
    let is_grid = |c: &usize| matches!(content(*c), Some(Content::Mpm { .. } | Content::Buffer));
    let Some(grid) = bounds(&mesh.part(|c| is_grid(&c))) else { return Vec::new() };
    let mut warnings = Vec::new();
    for contact in &case.contacts {
        let (Touching::Structure(structure), Touched::Soil(_)) = (&contact.structure, &contact.on) else { continue };
        let name = &case.regions[*structure].name;
        let Some(region) = mesh.regions.iter().position(|other| other == name) else { continue };
        let body = mesh.part(|c| usize::from(mesh.cells.region[c]) == region);
        let Some(around) = bounds(&body) else { continue };
        warnings.extend(leaves(case, name, &body, [around[0][1], grid[0][1]]));
        let motions = motions(case, name, &body);
        // Cells that it lies upon or in.
        let near = |c: &usize| {
            let places = mesh.cells.nodes(*c).iter().map(|&n| mesh.nodes[n as usize]);
            box_around(places).is_some_and(|cell| gap(&cell, &around) <= SAME * (grid[1][0] - grid[0][0]))
        };
        let sizes: Vec<f64> =
            (0..mesh.cells.len()).filter(is_grid).filter(near).map(|c| cell_size(mesh, c) / 2f64.sqrt()).collect();
        if sizes.is_empty() {
            continue;
        }
        let h = sizes.iter().sum::<f64>() / sizes.len() as f64;
        let said = |length: f64| format!("{length:.3}");
        let Some(far) = motions.iter().max_by(|a, b| a.distance.total_cmp(&b.distance)) else { continue };
        let width = width(&around, &grid, 1 - far.component);
        let is_slender = around[1][far.component] - around[0][far.component] > SLENDER * width;
        if width < h * if is_slender { FEW_CELLS_OF_A_WALL } else { FEW_CELLS } {
            warnings.push(format!(
                "warning: the cells around `{name}` are {} m, and it is {} m wide across its way: {:.1} cells, which resolve it poorly, and its \
                 load is far too high; make them {} m or finer there",
                said(h),
                said(width),
                width / h,
                said(width / if is_slender { FEW_CELLS_OF_A_WALL } else { GOOD_CELLS })
            ));
        }
        if let Some(motion) = motions.iter().find(|motion| motion.step > LONG_STEP * h) {
            warnings.push(format!(
                "warning: phase `{}` moves `{name}` by up to {} m in a step, {:.1} times the size of the cells, {} m: lower its `step.max` from \
                 {} s to {:.2e} s or less",
                motion.phase,
                said(motion.step),
                motion.step / h,
                said(h),
                motion.largest,
                motion.largest * GOOD_STEP * h / motion.step
            ));
        }
    }
    warnings
}

/// How a phase moves a structure.
struct Motion<'a> {
    phase: &'a str,
    component: usize,
    /// How far it goes (m), and in the longest step (m).
    distance: f64,
    step: f64,
    /// The largest step (s).
    largest: f64,
}

/// A warning where the phases move a structure below the lowest place of the grid, given the heights (m) of the lowest places of both.
fn leaves(case: &Case, name: &str, body: &Mesh<2>, [low, bottom]: [f64; 2]) -> Option<String> {
    let mut at = low;
    for phase in &case.phases {
        let mut down = phase.prescribed.iter().filter(|moved| moved.component == 1 && moves(name, body, &moved.curve));
        let Some(moved) = down.next() else { continue };
        let within = moved.displacement.kinks().map(|t| moved.displacement.at(t)).fold(0.0, f64::min);
        let end = moved.displacement.at(phase.duration);
        let lowest = at + end.min(within);
        if low >= bottom && lowest < bottom {
            return Some(format!(
                "warning: phase `{}` moves `{name}` down to y = {lowest:.3} m, and the grid ends at y = {bottom:.3} m: shorten its way, or \
                 make the mesh deeper",
                phase.name
            ));
        }
        at += end;
    }
    None
}

/// The prescribed motions of a structure: its own where it is rigid, or those of a curve of it.
fn motions<'a>(case: &'a Case, name: &str, body: &Mesh<2>) -> Vec<Motion<'a>> {
    let mut motions = Vec::new();
    for phase in &case.phases {
        for moved in phase.prescribed.iter().filter(|moved| moved.component < 2 && moves(name, body, &moved.curve)) {
            let largest = phase.step.max.min(phase.duration);
            let (distance, speed) = match &moved.displacement {
                TimeValue::Constant(_) => (0.0, 0.0),
                TimeValue::Rate(rate) => (rate.abs() * phase.duration, rate.abs()),
                TimeValue::Table(table) => {
                    let speeds =
                        table.windows(2).map(|pair| ((pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).abs());
                    let distance = table.iter().map(|[_, u]| u.abs()).fold(0.0, f64::max);
                    (distance, speeds.fold(0.0, f64::max))
                }
                TimeValue::Record(record) => {
                    (farthest(&moved.displacement, phase.duration), record.fastest(phase.duration))
                }
            };
            if distance > 0.0 {
                let (phase, component, step) = (phase.name.as_str(), moved.component, (speed * largest).min(distance));
                motions.push(Motion { phase, component, distance, step, largest });
            }
        }
    }
    motions
}

/// How wide (m) a body is along an axis; one that ends where the grid does is half of one, by symmetry.
fn width(body: &Bounds, grid: &Bounds, axis: usize) -> f64 {
    let width = body[1][axis] - body[0][axis];
    let rounding = SAME * (grid[1][axis] - grid[0][axis]);
    let halved = (0..2).any(|end| (body[end][axis] - grid[end][axis]).abs() <= rounding);
    if halved { 2.0 * width } else { width }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// A case of a footing on clay, and its mesh: clay 4 m wide and 2 m deep in cells of 0.25 m, the footing upon it as wide as said.
    fn footing(wide: usize, entries: &str, step: f64) -> (Case, Mesh<2>) {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
             regions: {{clay: {{kind: mpm, material: clay}}, footing: {{kind: structure, material: clay, rigid: true}}, air: {{kind: buffer}}}}\n\
             materials: {{clay: {{model: linear_elastic, young: 1, poisson: 0, density: 1}}}}\n\
             contacts: [{{structure: footing, soil: clay}}]\n{entries}\n\
             phases: [{{name: push, analysis: quasi_static, duration: 1, step: {{initial: 0.01, max: {step}}}, \
             prescribe: {{footing: {{ux: 0, uy: {{rate: -1}}}}}}}}]\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let mut mesh = rectangle(CellKind::Q9, 4.0, 2.0, 16, 8, 0.0, 0);
        let body = rectangle(CellKind::Q9, 0.25 * wide as f64, 0.25, wide, 1, 0.0, 0);
        let first = mesh.nodes.len() as u32;
        // Not at the edge of the grid: whole.
        mesh.nodes.extend(body.nodes.iter().map(|x| [x[0] + 1.0, x[1] + 2.0]));
        for c in 0..body.cells.len() {
            let nodes: Vec<u32> = body.cells.nodes(c).iter().map(|n| n + first).collect();
            mesh.cells.push(CellKind::Q9, 1, &nodes);
        }
        mesh.regions = vec!["clay".into(), "footing".into()];
        (case.unwrap(), mesh)
    }

    #[test]
    fn coarse_cells_and_long_steps_are_told_with_numbers_and_cure() {
        let told = |wide, step| {
            let (case, mesh) = footing(wide, "", step);
            on_mesh(&case, &mesh).unwrap()
        };
        assert!(told(8, 0.05).is_empty() && told(4, 0.25).is_empty(), "{:?}", told(4, 0.25));
        let [coarse] = told(3, 0.05).try_into().unwrap();
        assert!(
            coarse.contains("0.250 m") && coarse.contains("3.0 cells") && coarse.contains("make them 0.125 m"),
            "{coarse}"
        );
        let [long] = told(8, 0.4).try_into().unwrap();
        assert!(long.contains("0.400 m in a step, 1.6 times") && long.contains("4.17e-2 s or less"), "{long}");
    }

    #[test]
    fn a_way_that_leads_out_of_the_grid_is_told() {
        let (mut case, mesh) = footing(8, "", 0.05);
        case.phases[0].duration = 2.5;
        let [far] = on_mesh(&case, &mesh).unwrap().try_into().unwrap();
        assert!(far.contains("moves `footing` down to y = -0.500 m, and the grid ends at y = 0.000 m"), "{far}");
    }

    #[test]
    fn a_footing_at_the_edge_of_the_grid_is_half_of_one() {
        let (grid, body) = ([[0.0, 0.0], [4.0, 2.0]], [[0.0, 2.0], [1.0, 3.0]]);
        assert_eq!([0, 1].map(|axis| width(&body, &grid, axis)), [2.0, 1.0]);
        assert_eq!(width(&[[0.5, 2.0], [1.0, 3.0]], &grid, 0), 0.5);
    }

    #[test]
    fn soil_without_room_and_a_loose_tolerance_are_told() {
        let place = |name: &str, low: f64, high: f64| Place {
            name: name.into(),
            bounds: [[0.0, low], [4.0, high]],
            parts: Vec::new(),
        };
        let (case, _) = footing(8, "", 0.05);
        let [clay, above, within] = [place("clay", 0.0, 2.0), place("footing", 2.0, 3.0), place("footing", 1.0, 1.5)];
        let [warning] = of_case(&case, &[clay.clone(), above.clone()]).try_into().unwrap();
        assert!(
            warning.contains("`footing` is pressed into soil that has no room") && warning.contains("y = 2 m"),
            "{warning}"
        );
        assert!(of_case(&case, &[clay.clone(), above.clone(), place("air", 2.0, 3.0)]).is_empty());
        assert!(of_case(&case, &[clay.clone(), within]).is_empty());
        assert_eq!(of_case(&case, &[clay.clone(), above, place("air", 0.0, 2.0)]).len(), 1);
        let (case, _) = footing(8, "numerics: {tolerance: 1.0e-3}", 0.05);
        let [warning] = of_case(&case, &[clay]).try_into().unwrap();
        assert!(warning.contains("`numerics.tolerance` is 1e-3"), "{warning}");
    }
}
