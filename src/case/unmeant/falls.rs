//! Steps of phases with inertia in which soil, or a structure that nothing holds, moves by more than a cell.

use crate::case::checked::{Case, Content, Phase, Touched, Touching};
use crate::case::layout::{Bounds, bounds, moves};
use crate::mesh::{Mesh, cell_size};

/// Part of a cell (-) that a body moves in a step above which it passes by what it is to meet.
pub const LONG_STEP: f64 = 1.0;
/// The part of a cell that it is told to move, as docs/reference/messages.md has it; sound cases have a hundredth to four tenths.
pub const GOOD_STEP: f64 = 1.0 / 6.0;

/// A warning for each body and phase with inertia whose longest step lets the body pass more than a cell.
///
/// The velocity is what gravity and the beginning leave room for: v² = v₀² + 2 g d + g H/4, and not more than v₀ + g T, T being the duration. Here
/// d is the height of free cells beneath all of the soil, or that of a structure over it, and H the height of soil that stands beside free cells.
/// Such soil is braked by its strength: nine tenths of a column of sand that collapses stay below half of √(g H), its front comes to 0.9 of that
/// for a moment, and slopes of clay are slower.
pub fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let content = |c: usize| case.content(&mesh.regions[usize::from(mesh.cells.region[c])]);
    let around = |wanted: &dyn Fn(&Content) -> bool| bounds(&mesh.part(|c| content(c).as_ref().is_some_and(wanted)));
    let Some(soil) = around(&|content| matches!(content, Content::Mpm { .. })) else { return Vec::new() };
    let free = around(&|content| matches!(content, Content::Buffer));
    let mut warnings = Vec::new();
    for region in case.regions.iter().filter(|region| !case.comes_later(&region.name)) {
        let of_it = |c: &usize| mesh.regions[usize::from(mesh.cells.region[*c])] == region.name;
        let body = mesh.part(|c| of_it(&c));
        let Some(own) = bounds(&body) else { continue };
        let (fall, slump, cells): (f64, f64, Vec<usize>) = match region.content {
            Content::Mpm { .. } => {
                let bottom = free.map_or(own[1][1], |free| free[0][1]);
                let fall = (own[0][1] - bottom).max(0.0);
                (fall, (own[1][1] - bottom - fall).max(0.0), (0..mesh.cells.len()).filter(of_it).collect())
            }
            Content::Structure { .. } if touches_soil(case, &region.name) => {
                let is_grid = |c: &usize| matches!(content(*c), Some(Content::Mpm { .. } | Content::Buffer));
                let below = |c: &usize| overlaps(mesh, *c, &own);
                ((own[0][1] - soil[1][1]).max(0.0), 0.0, (0..mesh.cells.len()).filter(is_grid).filter(below).collect())
            }
            _ => continue,
        };
        if cells.is_empty() {
            continue;
        }
        let h = cells.iter().map(|&c| cell_size(mesh, c) / 2f64.sqrt()).sum::<f64>() / cells.len() as f64;
        let mut first = initial_speed(case, &region.name, &body);
        for phase in &case.phases {
            if !phase.analysis.has_inertia() {
                // What is at rest at its end begins from there.
                first = 0.0;
                continue;
            }
            if phase.prescribed.iter().any(|p| p.component == 1 && moves(&region.name, &body, &p.curve)) {
                continue;
            }
            let gravity = gravity(phase);
            let speed =
                (first * first + gravity * (2.0 * fall + 0.25 * slump)).sqrt().min(first + gravity * phase.duration);
            let largest = phase.step.max.min(phase.duration);
            let way = speed * largest;
            if way > LONG_STEP * h {
                warnings.push(format!(
                    "warning: phase `{}`: `{}` may come to move at {speed:.2} m/s, by {way:.3} m in a step, {:.1} times the size of the cells, \
                     {h:.3} m: lower its `step.max` from {largest} s to {:.2e} s or less",
                    phase.name,
                    region.name,
                    way / h,
                    GOOD_STEP * h / speed
                ));
                break;
            }
        }
    }
    warnings
}

/// Whether a structure is in contact with soil.
fn touches_soil(case: &Case, name: &str) -> bool {
    case.contacts.iter().any(|contact| {
        matches!((&contact.structure, &contact.on), (Touching::Structure(r), Touched::Soil(_)) if case.regions[*r].name == name)
    })
}

/// Whether a cell lies above or beneath a body.
fn overlaps(mesh: &Mesh<2>, cell: usize, body: &Bounds) -> bool {
    let x = mesh.centre(cell)[0];
    (body[0][0]..=body[1][0]).contains(&x)
}

/// The largest velocity (m/s) of a region before the first phase.
fn initial_speed(case: &Case, name: &str, body: &Mesh<2>) -> f64 {
    let of_it = case.initial_velocity.iter().filter(|velocity| case.regions[velocity.region].name == name);
    let speeds = of_it.flat_map(|velocity| {
        body.cells.nodes.iter().map(|&n| velocity.at(&body.nodes[n as usize])).map(|[x, y]| x.hypot(y))
    });
    speeds.fold(0.0, f64::max)
}

/// The largest acceleration of gravity (m/s²) downwards in a phase.
fn gravity(phase: &Phase) -> f64 {
    phase.gravity.extremes(phase.duration).map(|g| -g[1]).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// A block of soil, 0.5 m high, in cells of 0.25 m in a box 2 m wide and 1.5 m high; its lower side at `low` cells above the floor.
    fn told(low: usize, entries: &str, phase: &str) -> Vec<String> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
             regions: {{block: {{kind: mpm, material: clay}}, air: {{kind: buffer}}}}\n\
             materials: {{clay: {{model: linear_elastic, young: 100, poisson: 0, density: 1}}}}\n\
             {entries}\nphases: [{{name: fall, {phase}}}]\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let mut mesh = rectangle(CellKind::Q9, 2.0, 1.5, 8, 6, 0.0, 0);
        mesh.regions = vec!["air".into(), "block".into()];
        for c in 0..mesh.cells.len() {
            let [x, y] = mesh.centre(c);
            let y = y - 0.25 * low as f64;
            mesh.cells.region[c] = u8::from(x < 0.5 && (0.0..0.5).contains(&y)).into();
        }
        on_mesh(&case.unwrap(), &mesh)
    }

    const GRAVITY: &str = "gravity: {y: -9.81}";

    fn dynamic(duration: f64, step: f64) -> String {
        format!("analysis: dynamic, duration: {duration}, step: {{initial: 0.001, max: {step}}}")
    }

    #[test]
    fn soil_that_may_pass_a_cell_in_a_step_is_told_with_its_velocity_and_the_step() {
        // 1 m of free fall and a slump of 0.5 m: √(9.81 · (2 + 0.5/4)) = 4.57 m/s.
        let [fast] = told(4, GRAVITY, &dynamic(1.0, 0.1)).try_into().unwrap();
        assert!(fast.contains("`block` may come to move at 4.57 m/s, by 0.457 m in a step, 1.8 times"), "{fast}");
        assert!(fast.contains("from 0.1 s to 9.13e-3 s or less"), "{fast}");
        assert!(told(4, GRAVITY, &dynamic(1.0, 0.05)).is_empty());
        // Standing on the floor it can only slump, √(9.81 · 0.5)/2 = 1.1 m/s; and in 0.2 s nothing comes to more than 2 m/s.
        assert!(told(0, GRAVITY, &dynamic(1.0, 0.1)).is_empty());
        assert!(told(4, GRAVITY, &dynamic(0.2, 0.1)).is_empty());
        // A step is no longer than the phase; without inertia nothing moves by itself.
        assert!(told(4, GRAVITY, "analysis: quasi_static, duration: 1, step: {initial: 0.1, max: 0.5}").is_empty());
        let part = format!("{}, gravity: {{table: [[0, 0], [0.5, 0.1], [1, 0]]}}", dynamic(1.0, 0.1));
        assert!(told(4, GRAVITY, &part).is_empty());
    }

    #[test]
    fn soil_that_begins_with_a_velocity_is_told() {
        let thrown = "initial_velocity: {block: {velocity: {x: 4}}}";
        let [fast] = told(0, thrown, &dynamic(1.0, 0.1)).try_into().unwrap();
        assert!(fast.contains("4.00 m/s, by 0.400 m in a step, 1.6 times the size of the cells, 0.250 m"), "{fast}");
        assert!(told(0, thrown, &dynamic(1.0, 0.05)).is_empty());
    }

    #[test]
    fn a_structure_that_falls_on_soil_is_told_unless_it_is_moved() {
        let told = |prescribe: &str| {
            let text = format!(
                "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
                 regions: {{clay: {{kind: mpm, material: clay}}, air: {{kind: buffer}}, body: {{kind: structure, material: clay, rigid: true}}}}\n\
                 materials: {{clay: {{model: linear_elastic, young: 100, poisson: 0, density: 1}}}}\n\
                 contacts: [{{structure: body, soil: clay}}]\n{GRAVITY}\n\
                 phases: [{{name: fall, {}{prescribe}}}]\n",
                dynamic(1.0, 0.1)
            );
            let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
            let (case, issues) = resolve(&source);
            assert!(issues.is_empty(), "{issues:?}");
            // Clay up to 0.5 m, air above it, and a body 1 m higher than the clay.
            let mut mesh = rectangle(CellKind::Q9, 2.0, 2.0, 8, 8, 0.0, 0);
            for c in 0..mesh.cells.len() {
                mesh.cells.region[c] = u8::from(mesh.centre(c)[1] < 0.5).into();
            }
            let body = rectangle(CellKind::Q9, 0.5, 0.25, 2, 1, 0.0, 0);
            let first = mesh.nodes.len() as u32;
            mesh.nodes.extend(body.nodes.iter().map(|x| [x[0] + 1.0, x[1] + 1.5]));
            for c in 0..body.cells.len() {
                let nodes: Vec<u32> = body.cells.nodes(c).iter().map(|n| n + first).collect();
                mesh.cells.push(CellKind::Q9, 2, &nodes);
            }
            mesh.regions = vec!["air".into(), "clay".into(), "body".into()];
            on_mesh(&case.unwrap(), &mesh)
        };
        // √(2 · 9.81 · 1) m/s.
        let [fast] = told("").try_into().unwrap();
        assert!(fast.contains("`body` may come to move at 4.43 m/s, by 0.443 m in a step, 1.8 times"), "{fast}");
        assert!(told(", prescribe: {body: {uy: 0}}").is_empty());
    }
}
