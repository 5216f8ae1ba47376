//! Meshes that a case names in place of a `.geo`: of Abaqus, of Gmsh in every version, of Salome.

use crate::support::{column, in_folder, project, python, said, succeeds};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// `tests/data/abaqus` in a folder of its own.
fn scene() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for file in ["case.yaml", "ground.inp"] {
        fs::copy(project("tests/data/abaqus").join(file), folder.path().join(file)).unwrap();
    }
    folder
}

fn replace(folder: &Path, file: &str, from: &str, to: &str) {
    let path = folder.join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(path, text.replace(from, to)).unwrap();
}

/// The reaction (kN/m) at the bottom of a run of the case.
fn reaction(folder: &Path) -> f64 {
    let output = in_folder(folder, &["run", ".", "--threads", "1"]);
    succeeds(&output);
    *column(&folder.join("out"), "bottom.reaction_y [kN]").last().unwrap()
}

/// Two layers of 4 m² with 18 and 20 kN/m³, and 3 kPa on 4 m, as a part whose instance is moved down by 2 m.
#[test]
fn a_mesh_of_abaqus_is_checked_meshed_and_solved_without_a_geo() {
    let scene = scene();
    let output = in_folder(scene.path(), &["check", "."]);
    assert_eq!(said(&output), ".: no mistakes\n");
    assert!((reaction(scene.path()) - (4.0 * 38.0 + 12.0)).abs() < 1e-6);
    let again = said(&in_folder(scene.path(), &["run", "."]));
    assert!(again.contains("mesh: nothing has changed"), "{again}");
    // The file is an input of the stage.
    replace(
        scene.path(),
        "ground.inp",
        "          0.,          -2.,           0.",
        "          0.,          -3.,           0.",
    );
    let again = said(&in_folder(scene.path(), &["mesh", "."]));
    assert!(again.contains("8 cells (8 Q4), 15 nodes"), "{again}");
    let mesh = mpm::mesh::msh::read(&scene.path().join("out/mesh.msh")).unwrap();
    assert_eq!(mesh.nodes.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min), -3.0);
}

/// The mesh of the case, written by Gmsh in a format that ends so.
fn written(folder: &Path, name: &str, version: &str) {
    let script = "import gmsh, sys\ngmsh.initialize(interruptible=False)\ngmsh.option.setNumber('General.Terminal', 0)\n\
        gmsh.merge(sys.argv[1])\ngmsh.option.setNumber('Mesh.MshFileVersion', float(sys.argv[3]))\n\
        gmsh.option.setNumber('Mesh.Binary', float(sys.argv[4]))\ngmsh.write(sys.argv[2])";
    let binary = if version == "2.2" { "1" } else { "0" };
    let mut command = python();
    command.args(["-c", script]).arg(folder.join("out/mesh.msh")).arg(folder.join(name)).args([version, binary]);
    succeeds(&command.output().unwrap());
}

#[test]
fn meshes_of_gmsh_in_older_versions_and_of_salome_are_the_same() {
    let scene = scene();
    succeeds(&in_folder(scene.path(), &["mesh", "."]));
    for (name, version) in [("old.msh", "2.2"), ("new.msh", "4.1"), ("four.msh", "4"), ("salome.med", "4.1")] {
        written(scene.path(), name, version);
        fs::copy(project("tests/data/abaqus/case.yaml"), scene.path().join("case.yaml")).unwrap();
        replace(scene.path(), "case.yaml", "ground.inp", name);
        assert_eq!(said(&in_folder(scene.path(), &["check", "."])), ".: no mistakes\n", "{name}");
        assert!((reaction(scene.path()) - 164.0).abs() < 1e-6, "{name}");
    }
    // Of a stage, which has sealed it.
    fs::rename(scene.path().join("out/mesh.msh"), scene.path().join("made.msh")).unwrap();
    replace(scene.path(), "case.yaml", "salome.med", "made.msh");
    assert!((reaction(scene.path()) - 164.0).abs() < 1e-6);
}

#[test]
fn what_does_not_go_with_a_mesh_is_refused_with_the_remedy() {
    let scene = scene();
    fs::write(scene.path().join("scene.geo"), "").unwrap();
    fs::write(scene.path().join("model.e"), "").unwrap();
    fs::write(scene.path().join("script.msh"), "SystemCall \"touch ran\";\n").unwrap();
    for (set, parts) in [
        ("mesh={file: ground.inp, geo: scene.geo}", &["`geo` and `file` are both given"][..]),
        ("mesh={order: 2}", &["neither `geo` nor `file` is given", "`file: …`, a mesh"]),
        ("mesh={geo: ground.inp}", &["it is a mesh, and no geometry", "write `file: ground.inp` in place of `geo`"]),
        ("mesh={file: scene.geo}", &["write `geo: scene.geo` in place of `file`"]),
        ("mesh={file: model.e}", &["it is no mesh that ends in .msh, .inp, .med", "import_mesh.py model.e mesh.msh"]),
        ("mesh={file: none.inp}", &["there is no file ./none.inp", "name a mesh"]),
        ("mesh={file: script.msh}", &["script.msh"]),
        ("mesh.order=2", &["ground.inp: its cells are of order 1 (Q4)", "take `order` out"]),
        ("mesh.parameters={h: 1}", &["a mesh has no parameters"]),
        ("regions.Clay.kind=buffer", &["a buffer region is empty"]),
        ("supports={Botom: {ux: 0, uy: 0}}", &["the mesh has no physical curve `Botom`; did you mean `Bottom`?"]),
    ] {
        for command in ["check", "mesh"] {
            let output = in_folder(scene.path(), &[command, ".", "--set", set]);
            let said = said(&output);
            assert_eq!(output.status.code(), Some(2), "{set}: {said}");
            parts.iter().for_each(|part| assert!(said.contains(part), "{command} {set}: {said}"));
            assert!(!scene.path().join("out").exists() && !scene.path().join("ran").exists());
        }
    }
}
