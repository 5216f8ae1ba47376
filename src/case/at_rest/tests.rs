use super::*;
use crate::case::{resolve, source::Source};
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use std::path::PathBuf;

/// A case of two layers with `entries`, in a box that is held at its sides.
fn case(entries: &str) -> Case {
    let text = format!(
        "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
         regions: {{sand: {{kind: mpm, material: sand}}, peat: {{kind: mpm, material: peat}}, air: {{kind: buffer}}}}\n\
         materials: {{sand: {{model: linear_elastic, young: 2.0e+4, poisson: 0.3, unit_weight: 20}}, \
         peat: {{model: linear_elastic, young: 1000, poisson: 0.3, unit_weight: {{top: 12, gradient: 0.1, datum: 8}}}}}}\n\
         gravity: {{y: -9.81}}\ninitial_stress: {{k0: 0.5}}\n{entries}\n\
         phases: [{{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 1}}}}]\n"
    );
    let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
    let (case, issues) = resolve(&source);
    assert!(issues.is_empty(), "{issues:?}");
    case.unwrap()
}

const HELD: &str = "supports: {bottom: {ux: 0, uy: 0}, left: {ux: 0}, right: {ux: 0}}";

/// A box 20 m wide: sand up to 4 m, peat up to 8 m, then 2 m of air, in cells that are irregular and, in second order, curved within.
fn level(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 20.0, 10.0, 13, 10, 0.0, 0);
    mesh.regions = ["sand", "peat", "air"].map(String::from).to_vec();
    for c in 0..mesh.cells.len() {
        let y = mesh.centre(c)[1];
        mesh.cells.region[c] = u16::from(y > 4.0) + u16::from(y > 8.0);
    }
    for x in &mut mesh.nodes {
        let [a, b] = *x;
        let edge = |y: f64| (b - y).abs();
        let within = [0.0, 4.0, 8.0, 10.0].map(edge).into_iter().fold(f64::INFINITY, f64::min);
        *x = [a - 3.0 + 0.1 * a * (20.0 - a) / 100.0, b - 2.0 + 0.1 * within * (1.3 * a).sin()];
    }
    mesh
}

fn kinds() -> impl Iterator<Item = CellKind> {
    [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9].into_iter()
}

#[test]
fn level_ground_is_in_equilibrium() {
    for kind in kinds() {
        let mesh = level(kind);
        for water in
            ["", "water: {level: 1.3, phreatic_level: 1.3}", "water: {level: 9}", "water: {phreatic_level: 0.4}"]
        {
            assert_eq!(imbalance(&case(&format!("{HELD}\n{water}")), &mesh).unwrap(), None, "{kind:?} {water}");
        }
        assert_eq!(imbalance(&Case { k0: None, ..case(HELD) }, &tilted(&mesh, 0.0, 8.0)).unwrap(), None);
    }
}

/// The mesh with its lines at the height `at` (m) dipping by 1 in 10 to the right.
fn tilted(mesh: &Mesh<2>, at: f64, dip: f64) -> Mesh<2> {
    let mut mesh = mesh.clone();
    for x in &mut mesh.nodes {
        let share = (1.0 - (x[1] + 2.0 - at).abs() / 2.0).max(0.0);
        x[1] -= share * dip * (x[0] + 3.0) / 20.0;
    }
    mesh
}

/// Two metres of peat in place of sand at the right: over the two metres in which both are, and the two below.
#[test]
fn a_layer_that_dips_is_not_and_the_size_is_told() {
    for kind in kinds() {
        let mesh = tilted(&level(kind), 4.0, 1.5);
        let told = imbalance(&case(HELD), &mesh).unwrap().unwrap();
        let numbers: Vec<f64> = told.split([' ', ';', ',']).filter_map(|word| word.parse().ok()).collect();
        let [most, x_most, least, x_least, y, force] = numbers[..] else { panic!("{told}") };
        // 1.5 m of peat (12.6 to 12.75 kN/m³) in place of sand below all of the interface; half of that on the way.
        let lighter = 0.5 * (20.0 - 12.67) * 1.5;
        assert!((most - least - lighter).abs() < 0.1 * lighter, "{kind:?}: {told}");
        assert!(x_most < -2.0 && x_least > 15.0 && y < 0.6, "{kind:?}: {told}");
        assert!((force / (lighter * (2.5 + 0.5 * 1.5)) - 1.0).abs() < 0.1, "{kind:?}: {told}");
        assert!(told.contains("gravity in a first quasi_static phase"), "{told}");
    }
}

#[test]
fn ground_that_slopes_and_sides_that_nothing_holds_are_not() {
    for kind in kinds() {
        let sloping = tilted(&level(kind), 8.0, 0.5);
        assert!(imbalance(&case(HELD), &sloping).unwrap().is_some(), "{kind:?}");
        // Under water its buoyant weight counts.
        assert!(
            imbalance(&case(&format!("{HELD}\nwater: {{level: 9, phreatic_level: 9}}")), &sloping).unwrap().is_some()
        );
        let open = "supports: {bottom: {ux: 0, uy: 0}, left: {ux: 0}}";
        assert!(imbalance(&case(open), &level(kind)).unwrap().is_some(), "{kind:?}");
    }
}
