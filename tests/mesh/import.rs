//! Meshes of other programs through `pipeline/import_mesh.py`: their sets arrive as regions and curves.

use crate::support::{project, python};
use std::fs;
use std::path::Path;
use std::process::Output;

use mpm::mesh::msh::read;
use mpm::mesh::shape::CellKind;

fn import(source: &Path, out: &Path, arguments: &[&str]) -> Output {
    python().arg(project("pipeline/import_mesh.py")).args([source, out]).args(arguments).output().unwrap()
}

#[test]
fn second_order_cells_with_numbered_parts_are_named_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let (source, out) = (folder.path().join("model.vtu"), folder.path().join("mesh.msh"));
    let script = "import meshio, sys\n\
        x = [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[.5,0,0],[1,.5,0],[.5,.5,0],[.5,1,0],[0,.5,0]]\n\
        meshio.Mesh(x, [('triangle6', [[0,1,2,4,5,6],[0,2,3,6,7,8]]), ('line3', [[0,1,4]])],\n\
                    cell_data={'part': [[3, 4], [7]]}).write(sys.argv[1])";
    assert!(python().args(["-c", script]).arg(&source).status().unwrap().success());
    let output = import(&source, &out, &["--surface", "clay=3", "--surface", "sand=4", "--curve", "base=7"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mesh = read(&out).unwrap();
    assert_eq!(mesh.regions, ["clay", "sand"]);
    assert_eq!(mesh.cells.kind, [CellKind::T6; 2]);
    assert_eq!(mesh.group("base").unwrap().facets[0].0, CellKind::Line3);
}

#[test]
fn what_cannot_be_imported_is_said_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("mesh.msh");
    let points_only = "*NODE\n1, 0.0, 0.0\n*ELEMENT, TYPE=T2D2, ELSET=A\n1, 1, 1\n";
    for (name, text, said) in [
        // Read by the program itself.
        ("model.inp", points_only, "write `mesh: {file: model.inp}` in the case.yaml"),
        ("model.med", "", "write `mesh: {file: model.med}` in the case.yaml"),
        ("model.off", "OFF\n1 0 0\n0 0 0\n", "model.off"),
        ("model.unheard", "", "model.unheard"),
    ] {
        let source = folder.path().join(name);
        fs::write(&source, text).unwrap();
        let output = import(&source, &out, &[]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(said) && !message.contains("Traceback"), "{message}");
        assert!(!out.exists());
    }
}

/// Exodus needs netCDF4, which need not be there: then the message names it.
#[test]
fn a_package_that_is_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (source, out) = (folder.path().join("model.e"), folder.path().join("mesh.msh"));
    fs::write(&source, "").unwrap();
    let output = import(&source, &out, &[]);
    let message = String::from_utf8_lossy(&output.stderr);
    let is_there = python().args(["-c", "import netCDF4"]).output().unwrap().status.success();
    let part = if is_there { "meshio cannot read it" } else { "meshio needs the package netCDF4 for it" };
    assert!(output.status.code() == Some(2) && message.contains(part) && !message.contains("Traceback"), "{message}");
}
