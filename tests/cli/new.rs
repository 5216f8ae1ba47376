//! `mpm new`: every template makes a case that is sound, with the entries that `--set` changes, or leaves nothing behind.

use crate::support::{PROGRAM, errors, in_folder, project, said, succeeds};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The templates, and what makes the mesh of each coarse.
const TEMPLATES: [(&str, &str); 13] = [
    ("anchor", "0.25"),
    ("consolidation", "0.1"),
    ("cpt", "0.006"),
    ("embankment", "0.8"),
    ("excavation", "0.25"),
    ("footing", "0.2"),
    ("impact", "0.1"),
    ("monopile", "0.1"),
    ("penetration", "0.25"),
    ("pipe", "0.2"),
    ("silo", "0.15"),
    ("slope", "2.5"),
    ("wall", "1"),
];

/// Runs a command in a folder, which succeeds without a warning; returns what it prints.
#[track_caller]
fn quietly(folder: &Path, arguments: &[&str]) -> String {
    let output = in_folder(folder, arguments);
    succeeds(&output);
    let told = errors(&output);
    assert!(!told.contains("warning") && !told.contains("note"), "{told}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs a command in a folder, which refuses its input and says so in one line with all `parts`.
#[track_caller]
fn refuses(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let output = in_folder(folder, arguments);
    let told = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert_eq!(told.lines().filter(|line| line.starts_with("error")).count(), 1, "{told}");
    parts.iter().for_each(|part| assert!(told.contains(part), "`{part}` is not in: {told}"));
}

/// The names of what a folder holds.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_templates_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let list = quietly(folder.path(), &["new"]);
    assert_eq!(list, quietly(folder.path(), &["new", "--list"]));
    let help = quietly(folder.path(), &["--help"]);
    let folders = names(&project("templates")).into_iter().filter(|name| name != "Makefile");
    assert_eq!(folders.collect::<Vec<_>>(), TEMPLATES.map(|(name, _)| name));
    for (name, _) in TEMPLATES {
        assert!(list.lines().any(|line| line.starts_with(&format!("{name} "))), "{list}");
        assert!(help.contains(name), "{help}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn every_template_is_sound_and_can_be_meshed_and_seeded() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    for (name, h) in TEMPLATES {
        let printed = quietly(root, &["new", name]);
        assert!(printed.contains(&format!("next: `mpm run {name}`")), "{printed}");
        let case = root.join(name);
        let geo = format!("{name}.geo");
        let mut files = vec!["Makefile", "README.md", "case.yaml", &geo];
        files.extend((name == "monopile").then_some("loading.yaml"));
        files.sort_unstable();
        assert_eq!(names(&case), files);
        for file in files {
            let made = fs::read_to_string(case.join(file)).unwrap();
            let template = project("templates").join(if file == "Makefile" { "" } else { name }).join(file);
            assert_eq!(made, fs::read_to_string(template).unwrap(), "{name}/{file}");
            assert!(printed.contains(&format!("{name}/{file}\n")), "{printed}");
        }
        assert_eq!(quietly(root, &["check", name]), format!("{name}: no mistakes\n"));
        let coarse = format!("mesh.parameters.h={h}");
        for stage in ["mesh", "seed"] {
            quietly(root, &[stage, name, "--set", &coarse]);
        }
        assert!(case.join("out/points.vtu").exists());
    }
}

/// Edges become smaller where a plate or a wall is thin: Gmsh would look for a mesh of an outline that crosses itself without end.
#[test]
fn thin_bodies_can_be_meshed() {
    let folder = tempfile::tempdir().unwrap();
    for (k, (name, set)) in
        [("anchor", "half_width=0.5"), ("penetration", "shape=1"), ("penetration", "shape=2")].into_iter().enumerate()
    {
        let case = format!("case{k}");
        let parameters = [set, "thickness=0.1"].map(|set| format!("mesh.parameters.{set}"));
        quietly(folder.path(), &["new", name, &case, "--set", &parameters[0], "--set", &parameters[1]]);
        let coarse = ["mesh", &case, "--mesh-timeout", "20", "--set", "mesh.parameters.h=0.1"];
        // It may say that these cells are too coarse for the body.
        succeeds(&in_folder(folder.path(), &coarse));
    }
}

#[test]
fn the_variants_that_the_readmes_name_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    for (k, (name, set)) in [
        ("footing", "geometry=axisymmetric"),
        ("footing", "materials.clay.shear_strength={top: 20, gradient: 2}"),
        ("penetration", "mesh.parameters.shape=1"),
        ("penetration", "mesh.parameters.shape=2"),
        ("penetration", "geometry=axisymmetric"),
        ("anchor", "geometry=axisymmetric"),
        ("anchor", "contacts[0].tension=no_separation"),
        ("anchor", "contacts[0].tension={limit: 100}"),
        ("slope", "water={level: 2, phreatic_level: 5}"),
        ("slope", "materials.soil={model: tresca, young: 20000, poisson: 0.49, shear_strength: {top: 30, gradient: 2, datum: 10}, unit_weight: 18}"),
        ("pipe", "contacts[0].adhesion_factor=1"),
        ("pipe", "phases.pull.prescribe.pipe={ux: {rate: 1}}"),
        ("impact", "mesh.parameters.tip=0"),
        ("impact", "geometry=plane_strain"),
        ("consolidation", "supports.bottom={ux: 0, uy: 0, pore_pressure: 0}"),
        ("consolidation", "phases[0].tractions[0].ty={table: [[0, 0], [2.0e+4, -40]]}"),
    ]
    .into_iter()
    .enumerate()
    {
        let case = format!("case{k}");
        quietly(folder.path(), &["new", name, &case, "--set", set]);
        quietly(folder.path(), &["check", &case]);
        let readme = fs::read_to_string(folder.path().join(&case).join("README.md")).unwrap();
        assert!(readme.ends_with(&format!("    --set {set}\n")), "{readme}");
    }
}

#[test]
fn entries_are_changed_in_their_places() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "--set",
        "mesh.parameters={half_width: 1.5}",
        "--set",
        "mesh.parameters.h=0.2",
        "--set",
        "materials.clay.shear_strength={top: 20, gradient: 2}",
        "--set",
        "phases.push.step.max=0.01",
        "--set",
        "phases[0].step.min=1e-6",
        "--set",
        "numerics.restore=every_step",
        "--set",
        "title=Pier 3, axis B",
    ];
    let output = in_folder(folder.path(), &[&["new", "footing", "pier"], &set[..]].concat());
    succeeds(&output);
    assert!(errors(&output).contains("note: phases[0].step.initial is lowered from 0.02 s to 0.01 s"));
    let changed = |file: &str| {
        let lines = |path: &Path| fs::read_to_string(path).unwrap().lines().map(str::to_owned).collect::<Vec<_>>();
        let before = lines(&project("templates/footing").join(file));
        let after = lines(&folder.path().join("pier").join(file));
        after.into_iter().filter(|line| !before.contains(line)).collect::<Vec<_>>()
    };
    let h = r#"  h          = {0.2,  Min 1e-6, Name "Parameters/h"},          // size of the cells at the edge of the footing [m]"#;
    let b = r#"  half_width = {1.5,  Min 1e-6, Name "Parameters/half_width"}, // B/2, or the radius [m]"#;
    assert_eq!(changed("footing.geo"), [b, h]);
    assert_eq!(
        changed("case.yaml"),
        [
            "title: \"Pier 3, axis B\"",
            "  clay: {model: tresca, young: 20000, poisson: 0.49, shear_strength: {gradient: 2, top: 20}, unit_weight: 8}    # kPa, kN/m³ (under water)",
            "    step: {initial: 0.01, max: 0.01, min: 1e-6}",
            "numerics: {restore: every_step}",
        ]
    );
    assert!(changed("README.md").contains(&"    --set title=Pier 3, axis B".to_owned()));
    quietly(folder.path(), &["check", "pier"]);
}

#[test]
fn what_is_wrong_is_told_and_nothing_is_left_behind() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let set = |entry: &'static str, parts: &[&str]| {
        refuses(root, &["new", "penetration", "a/b", "--set", entry], parts);
        assert!(names(root).is_empty(), "{:?}", names(root));
    };
    refuses(root, &["new", "footin"], &["no template `footin`", "did you mean `footing`?"]);
    refuses(root, &["new", "x"], &["no template `x`", "choose from", "consolidation"]);
    set(
        "mesh.parameters.diametr=2",
        &["--set mesh.parameters.diametr", "no parameter `diametr`", "did you mean `diameter`?"],
    );
    set("mesh.parameters.shape=3", &["3 is none of its values", "0 (round bar), 1 (flat strip), 2 (thin wall)"]);
    set("mesh.parameters.h=0", &["0 is out of its range", "0.000001 or more"]);
    set("mesh.parameters.h=wide", &["the text `wide`", "write a number"]);
    set("mesh.parameters.h", &["no `=`"]);
    set("materials.clay.yung=5", &["--set materials.clay.yung=5", "unknown key `yung`", "did you mean `young`?"]);
    set("phases.pull.duration=5", &["no item `pull`", "by name push"]);
    set("contacts[0].adhesion_factor=2", &["--set contacts[0].adhesion_factor=2"]);
    set("output={every: 1}", &["--set output={every: 1}", "lines of their own", "set entries below it"]);
    set("mesh.geo=other.geo", &["there is no file", "other.geo"]);
    assert!(names(root).is_empty());
}

#[test]
fn a_folder_that_holds_something_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    fs::create_dir_all(root.join("full/slope")).unwrap();
    fs::write(root.join("full/slope/notes"), "mine").unwrap();
    refuses(&root.join("full"), &["new", "slope"], &["slope: the folder is not empty", "name another one"]);
    assert_eq!(names(&root.join("full/slope")), ["notes"]);
    refuses(root, &["new", "slope", "full/slope/notes"], &["this is a file", "name another folder"]);

    // An empty one is filled, and one that failed to be is empty again.
    let empty = root.join("empty");
    fs::create_dir(&empty).unwrap();
    refuses(&empty, &["new", "slope", ".", "--set", "gravty.y=1"], &["unknown key `gravty`"]);
    assert!(names(&empty).is_empty());
    quietly(&empty, &["new", "slope", "."]);
    assert_eq!(names(&empty).len(), 4);
    assert_eq!(quietly(&empty, &["check", "."]), ".: no mistakes\n");
}

#[test]
fn the_makefile_runs_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    quietly(folder.path(), &["new", "consolidation", "layer"]);
    let case = folder.path().join("layer");
    let make = |target: &str| {
        let mut make = Command::new("make");
        // Not the flags of a make that runs these tests.
        make.arg(target).arg(format!("MPM={PROGRAM}")).current_dir(&case).env_remove("MAKEFLAGS");
        make.arg("FLAGS=--set phases.first.duration=1000 --set phases.second.duration=5000 --set phases.third.duration=40000");
        let output = make.output().unwrap();
        succeeds(&output);
        said(&output)
    };
    for target in ["run", "check", "clean"] {
        assert!(make("help").contains(&format!("  make {target} ")));
    }
    assert!(make("check").contains("no mistakes"));
    make("run");
    assert!(case.join("out/points.pvd").exists());
    make("clean");
    assert!(!case.join("out").exists());
}
