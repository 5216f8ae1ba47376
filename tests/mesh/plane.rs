//! What `mpm check` says of sections that lie where no analysis can be: it meshes them, and goes as far as to the first step.

use crate::support::{in_folder, said, succeeds, written};
use std::fs;
use std::path::Path;

const CASE: &str = "geometry: plane_strain\nmesh: {geo: scene.geo}\nregions: {soil: {kind: mpm, material: clay}}\n\
    materials: {clay: {model: linear_elastic, young: 5000, poisson: 0.3, unit_weight: 18}}\nsupports: {bottom: {ux: 0, uy: 0}}\n\
    gravity: {y: -10}\nphases: [{name: gravity, analysis: quasi_static, duration: 1, step: {initial: 1}, gravity: {rate: 1}}]\n";

/// A rectangle 8 m × 3 m with its corners where `place` puts x and y.
fn section(folder: &Path, place: &str, end: &str) {
    let points: String = [(0, 0), (8, 0), (8, 3), (0, 3)]
        .iter()
        .enumerate()
        .map(|(i, (x, y))| {
            let place = place.replace('X', &x.to_string()).replace('Y', &y.to_string());
            format!("Point({}) = {{{place}, 1.0}};\n", i + 1)
        })
        .collect();
    let rest = "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4};\n\
        Plane Surface(1) = {1};\nPhysical Surface(\"soil\") = {1};\nPhysical Curve(\"bottom\") = {1};\n";
    fs::write(folder.join("scene.geo"), format!("{points}{rest}{end}\n")).unwrap();
}

#[test]
fn a_section_in_another_plane_is_told_by_check_with_what_turns_it() {
    let folder = written(CASE);
    for (place, part) in [
        ("X, 0, Y", "the section lies in x–z, at y = 0"),
        ("X, 2, Y", "the section lies in x–z, at y = 2"),
        ("0, X, Y", "the section lies in y–z, at x = 0"),
        ("5, X, Y", "the section lies in y–z, at x = 5"),
        ("X, Y, 3", "the section lies at z = 3"),
    ] {
        section(folder.path(), place, "");
        let mut told = Vec::new();
        for command in ["check", "mesh", "run"] {
            let output = in_folder(folder.path(), &[command, "."]);
            let said = said(&output);
            assert!(output.status.code() == Some(2) && said.contains(part), "{said}");
            // Not the file that is gone by now.
            assert!(said.contains("scene.geo, node ") && !said.contains("mesh.msh"), "{said}");
            told.push(said);
        }
        let remedy = told[0].split('`').nth(1).unwrap();
        section(folder.path(), place, remedy);
        assert_eq!(said(&in_folder(folder.path(), &["check", "."])), ".: no mistakes\n", "{remedy}");
        // Up is up, and no place has moved along the section.
        succeeds(&in_folder(folder.path(), &["mesh", "."]));
        let mesh = mpm::mesh::msh::read(&folder.path().join("out/mesh.msh")).unwrap();
        let bottom = &mesh.group("bottom").unwrap().nodes;
        assert!(bottom.iter().all(|&n| mesh.nodes[n as usize][1].abs() < 1e-12), "{remedy}");
        let most = |d: usize| mesh.nodes.iter().map(|x| x[d]).fold(f64::NEG_INFINITY, f64::max);
        assert!((most(0) - 8.0).abs() < 1e-9 && (most(1) - 3.0).abs() < 1e-9, "{remedy}");
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}

/// Of soil and of air.
#[test]
fn a_section_on_both_sides_of_the_axis_is_told_by_check() {
    let folder = written(CASE);
    section(folder.path(), "X - 4, Y, 0", "");
    assert_eq!(said(&in_folder(folder.path(), &["check", "."])), ".: no mistakes\n");
    for regions in ["{soil: {kind: mpm, material: clay}}", "{soil: {kind: fem, material: clay}}"] {
        let set = format!("regions={regions}");
        let output = in_folder(folder.path(), &["check", ".", "--set", "geometry=axisymmetric", "--set", &set]);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        for part in ["region `soil`", "lies at negative radius: in axisymmetry x is the radius", "x ≥ 0"] {
            assert!(said.contains(part), "{said}");
        }
    }
}

/// What only seeding or the scene sees is told, too: a profile that is out of range at the lowest place of its region.
#[test]
fn check_goes_as_far_as_to_the_first_step() {
    let folder = written(CASE);
    section(folder.path(), "X, Y, 0", "");
    let set = "materials.clay.young={top: 100, gradient: -50, datum: 3, least: -10}";
    for command in ["check", "run"] {
        let output = in_folder(folder.path(), &[command, ".", "--set", set]);
        let said = said(&output);
        assert!(output.status.code() == Some(2) && said.contains("young"), "{command}: {said}");
    }
    let quadrature = ["check", ".", "--set", "mesh.order=1", "--set", "regions.soil.points_per_cell=12"];
    let output = in_folder(folder.path(), &quadrature);
    assert!(output.status.success(), "{}", said(&output));
    let recombined = fs::read_to_string(folder.path().join("scene.geo")).unwrap() + "Recombine Surface{1};\n";
    fs::write(folder.path().join("scene.geo"), recombined).unwrap();
    let output = in_folder(folder.path(), &quadrature);
    assert!(output.status.code() == Some(2) && said(&output).contains("points"), "{}", said(&output));
}
