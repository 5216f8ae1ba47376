//! Scenes of contact that cannot be: each gets one message with its place, the problem and a remedy.

use crate::support::{errors, in_folder, project, succeeds};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// The plate of `tests/data` in a folder of its own, with each `from` in its case in the place of a `to`.
fn scene(changes: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let data = project("tests/data/plate");
    fs::copy(data.join("plate.geo"), folder.path().join("plate.geo")).unwrap();
    let mut case = fs::read_to_string(data.join("case.yaml")).unwrap();
    for (from, to) in changes {
        assert_eq!(case.matches(from).count(), 1, "{from:?} is not once in the case");
        case = case.replace(from, to);
    }
    fs::write(folder.path().join("case.yaml"), case).unwrap();
    folder
}

fn mpm(folder: &Path, command: &[&str]) -> Output {
    in_folder(folder, &[&command[..1], &["case.yaml"], &command[1..]].concat())
}

/// Runs a command on a scene and holds its end and its one message against what is expected.
fn refused(folder: &Path, command: &[&str], status: i32, says: &[&str]) {
    let output = mpm(folder, command);
    let said = errors(&output);
    let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    let [error] = errors[..] else { panic!("not one message: {said}") };
    assert_eq!(output.status.code(), Some(status), "{said}");
    for piece in says {
        assert!(error.contains(piece), "{piece:?} is not in: {error}");
    }
    assert!(error.rsplit_once("; ").is_some_and(|(_, remedy)| remedy.len() > 10), "no remedy: {error}");
}

#[test]
fn regions_in_contact_are_there_and_of_the_right_kind() {
    let contact = "{structure: plate, soil: soil}";
    for (to, says) in [
        ("{structure: plaat, soil: soil}", ["contacts[0].structure", "no region `plaat`", "did you mean `plate`?"]),
        ("{structure: soil, soil: soil}", ["contacts[0].structure", "`soil` is of kind mpm, not structure", "`plate`"]),
        ("{structure: plate, soil: air}", ["contacts[0].soil", "`air` is of kind buffer, not mpm", "`soil`"]),
        ("{structure: plate, soil: [soil, sand]}", ["contacts[0].soil", "no region `sand`", "of kind mpm"]),
    ] {
        let folder = scene(&[(contact, to)]);
        refused(folder.path(), &["check"], 2, &says);
        refused(folder.path(), &["run"], 2, &says);
    }
}

/// Two contacts of the same pair would act twice, whether all of what they touch is the same or a part; where phases have one of them at a time,
/// they are two interfaces.
#[test]
fn a_contact_given_twice_is_refused() {
    let contact = "  - {structure: plate, soil: soil}\n";
    let twice = "  - {name: a, structure: plate, soil: soil, adhesion: 1}\n  - {name: b, structure: plate}\n";
    let folder = scene(&[(contact, twice)]);
    let says = ["contacts[1]", "contacts[0] has `plate` on `soil` already", "in phase `press`", "deactivate one"];
    refused(folder.path(), &["check"], 2, &says);
    refused(folder.path(), &["run"], 2, &says);
    let apart = ("    duration: 1\n", "    duration: 1\n    deactivate: [b]\n");
    succeeds(&mpm(scene(&[(contact, twice), apart]).path(), &["check"]));
}

/// A structure in the grid that no contact names passes through the soil: that is told before it does. One that is beside the grid, held
/// by shared curves or never there does not.
#[test]
fn a_structure_without_a_contact_is_told() {
    let told = |folder: &Path, command: &[&str]| {
        let output = mpm(folder, command);
        let said = errors(&output);
        assert!(output.status.success(), "{said}");
        said.matches("warning: no contact names the structure `plate`").count()
    };
    let contact = "contacts:\n  - {structure: plate, soil: soil}\n";
    let loose = scene(&[(contact, "")]);
    let step = ["run", "--set", "phases[0].step={initial: 1}"];
    assert_eq!(told(loose.path(), &["check"]), 1);
    assert_eq!(told(loose.path(), &step), 1);
    let log = fs::read_to_string(loose.path().join("out/solve.log")).unwrap();
    assert!(log.contains("no contact names the structure `plate`"), "{log}");
    assert_eq!(told(loose.path(), &["check", "--set", "mesh.parameters={left: 3}"]), 0);
    assert_eq!(told(loose.path(), &[&step[..], &["--set", "mesh.parameters={left: 3}"]].concat()), 0);
    let never = ["check", "--set", "phases[0].deactivate=[plate]", "--set", "phases[0].prescribe={}"];
    assert_eq!(told(loose.path(), &never), 0);

    let bound = scene(&[]);
    assert_eq!(told(bound.path(), &["check"]), 0);
    assert_eq!(told(bound.path(), &step), 0);

    // The plate on the curve of the surface of the soil.
    let geo = fs::read_to_string(loose.path().join("plate.geo")).unwrap();
    let own = "Line(13) = {12, 13}; Line(14) = {13, 14}; Line(15) = {14, 11};\n  Curve Loop(3) = {11, 13, 14, 15};";
    assert_eq!(geo.matches(own).count(), 1);
    let shared = "Line(13) = {3, 13}; Line(14) = {13, 14}; Line(15) = {14, 4};\n  Curve Loop(3) = {-3, 13, 14, 15};";
    fs::write(loose.path().join("plate.geo"), geo.replace(own, shared)).unwrap();
    // It is joined to the soil. That the air lies there too is another mistake.
    let said = errors(&mpm(loose.path(), &["check"]));
    assert!(
        !said.contains("no contact names") && said.contains("more than two cells share one of its edges"),
        "{said}"
    );
}

#[test]
fn curves_of_a_structure_are_there() {
    let folder = scene(&[("prescribe: {top:", "prescribe: {head:")]);
    refused(folder.path(), &["run"], 2, &["phases[0].prescribe.head", "no physical curve `head`", "choose from"]);
    let folder = scene(&[("on: plate, quantities", "on: plat, quantities")]);
    refused(folder.path(), &["run"], 2, &["output.history[0].on", "region `plat`", "did you mean `plate`?"]);
    let folder = scene(&[("on: plate, quantities", "on: bottom, quantities")]);
    refused(folder.path(), &["check"], 2, &["`bottom`", "not on the boundary of a structure", "a curve of `plate`"]);
}

/// It would be looked for among the curves of the mesh, in vain.
#[test]
fn a_rigid_structure_does_not_drain() {
    let folder = scene(&[("  side: {ux: 0}", "  side: {ux: 0}\n  plate: {pore_pressure: 0}")]);
    let soil = "materials.soil={model: linear_elastic, young: 1000, poisson: 0.3, density: 0, drainage: undrained, \
        permeability: 1.0e-8}";
    let held = "phases[0].prescribe={plate: {uy: {rate: -0.1}}}";
    let command = ["check", "--set", soil, "--set", "regions.plate.rigid=true", "--set", held];
    refused(folder.path(), &command, 2, &["supports.plate.pore_pressure", "no pores", "drain a physical curve"]);
}

/// A mesh made before the case named a curve.
#[test]
fn a_curve_that_an_old_mesh_has_not_is_named() {
    let folder = scene(&[]);
    for stage in ["mesh", "seed"] {
        assert!(mpm(folder.path(), &[stage]).status.success());
    }
    let geo = folder.path().join("plate.geo");
    fs::write(&geo, fs::read_to_string(&geo).unwrap().replace("\"top\"", "\"head\"")).unwrap();
    let case = folder.path().join("case.yaml");
    fs::write(&case, fs::read_to_string(&case).unwrap().replace("{top:", "{head:")).unwrap();
    refused(folder.path(), &["solve"], 2, &["mesh.msh has no physical curve `head`", "run `mpm mesh` again"]);
}

/// A little overlap is pushed out; a plate of which the soil has not left the place is a mistake.
#[test]
fn a_structure_that_begins_within_the_soil_is_refused() {
    let folder = scene(&[]);
    let geo = folder.path().join("plate.geo");
    let sound = fs::read_to_string(&geo).unwrap();
    let says = ["contact of `plate`", "begins within the soil", "points of `soil`", "in the .geo, move the structure"];
    for (bottom, refuse) in [("-0.01", false), ("-0.9", true)] {
        let text = sound
            .replace("Point(11) = {left, 0, 0, hp}", &format!("Point(11) = {{left, {bottom}, 0, hp}}"))
            .replace("Point(12) = {left + plate, 0, 0, hp}", &format!("Point(12) = {{left + plate, {bottom}, 0, hp}}"));
        assert_eq!(text.matches(bottom).count(), 2);
        fs::write(&geo, text).unwrap();
        let parameters = ["--set", "mesh.parameters={width: 3, left: 0.9, plate: 1.2}"];
        for rigid in ["regions.plate.rigid=false", "regions.plate.rigid=true"] {
            let command = ["run", parameters[0], parameters[1], "--set", rigid];
            if refuse {
                refused(folder.path(), &command, 2, &says);
            } else {
                let output = mpm(folder.path(), &command);
                succeeds(&output);
            }
        }
    }
}

/// A plate slides over the side of the grid: its contact nodes there go on feeling soil that the grid has no cells for.
#[test]
fn a_structure_that_leaves_the_grid_is_named() {
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.2}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.02}}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.04}, prescribe: {top: {ux: {rate: 1}, uy: 0}}}]";
    let mesh = "mesh.parameters={width: 3, plate: 1, left: 1.8, edge: 0.1}";
    // So that the leading edge presses on soil when it leaves.
    let empty = "numerics.empty_stiffness=0.1";
    let folder = scene(&[]);
    let says = ["structure `plate`", "has left the grid", "in phase `slide`", "extend the regions"];
    refused(folder.path(), &["run", "--set", phases, "--set", mesh, "--set", empty], 1, &says);
    // What was computed is there, with the moment it ended in.
    let log = fs::read_to_string(folder.path().join("out/solve.log")).unwrap();
    assert!(log.lines().last().is_some_and(|line| line.contains("the analysis ends here: structure `plate`")), "{log}");
    let rows = fs::read_to_string(folder.path().join("out/history.csv")).unwrap().lines().count();
    assert!(rows > 8, "{rows}");
    let output = mpm(folder.path(), &["export", "--set", phases, "--set", mesh, "--set", empty]);
    succeeds(&output);
}
