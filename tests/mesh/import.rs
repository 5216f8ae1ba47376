//! Meshes of other programs through `pipeline/import_mesh.py`: their sets arrive as regions and curves.

use crate::support::{project, python};
use std::fs;
use std::path::Path;
use std::process::Output;

use mpm::mesh::msh::read;
use mpm::mesh::quality;
use mpm::mesh::shape::CellKind;

fn import(source: &Path, out: &Path, arguments: &[&str]) -> Output {
    python().arg(project("pipeline/import_mesh.py")).args([source, out]).args(arguments).output().unwrap()
}

const ABAQUS: &str = "\
*HEADING
a square of two triangles beside one quadrilateral
*NODE
1, 0.0, 0.0
2, 1.0, 0.0
3, 1.0, 1.0
4, 0.0, 1.0
5, 2.0, 0.0
6, 2.0, 1.0
*ELEMENT, TYPE=CPE3, ELSET=CLAY
1, 1, 2, 3
2, 1, 3, 4
*ELEMENT, TYPE=CPE4R, ELSET=SAND
3, 2, 5, 6, 3
*NSET, NSET=BASE
1, 2, 5
";

#[test]
fn abaqus_element_and_node_sets_become_named_groups() {
    let folder = tempfile::tempdir().unwrap();
    let (source, out) = (folder.path().join("model.inp"), folder.path().join("out/mesh.msh"));
    fs::write(&source, ABAQUS).unwrap();
    let output = import(&source, &out, &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mesh = read(&out).unwrap();
    assert_eq!(mesh.regions, ["CLAY", "SAND"]);
    assert_eq!(mesh.cells.kind, [CellKind::T3, CellKind::T3, CellKind::Q4]);
    assert_eq!(mesh.cells.region, [0, 0, 1]);
    let base = mesh.group("BASE").unwrap();
    assert_eq!(base.facets.len(), 2);
    assert!(base.nodes.iter().all(|&n| mesh.nodes[n as usize][1] == 0.0));
    let summary = quality::check(&mesh, &out).unwrap();
    assert_eq!(summary.regions, [("CLAY".to_string(), 2, 1.0), ("SAND".to_string(), 1, 1.0)]);
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
    let points_only = "*NODE\n1, 0.0, 0.0\n2, 1.0, 0.0\n3, 1.0, 1.0\n*ELEMENT, TYPE=T2D2, ELSET=A\n1, 1, 2\n";
    for (name, text, said) in [
        ("model.inp", points_only, "no triangles or quadrilaterals"),
        ("model.inp", "*NODE\n1, zero\n", "model.inp"),
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
