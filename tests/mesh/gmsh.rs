//! Meshes from Gmsh: what comes out of a `.geo`, and what bad input gets.

use std::fs;
use std::path::{Path, PathBuf};

use mpm::error::{Kind, Result};
use mpm::mesh::Mesh;
use mpm::mesh::gmsh::{self, Options};
use mpm::mesh::msh::read;
use mpm::mesh::quality;
use mpm::mesh::shape::{self, CellKind, MAX_NODES};

pub fn options(order: u8, parameters: &[(&str, f64)]) -> Options {
    let parameters = parameters.iter().map(|(name, value)| (name.to_string(), *value)).collect();
    Options { order, incomplete: false, parameters }
}

fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn generate(geo: &Path, options: &Options, out: &Path) -> Result<()> {
    gmsh::generate(geo, options, out, u64::MAX, &mut |_| Ok(true))
}

/// Meshes a `.geo` given as text in a folder of its own.
pub fn mesh_of(text: &str, options: &Options) -> Result<Mesh<2>> {
    let folder = tempfile::tempdir().unwrap();
    let geo = folder.path().join("scene.geo");
    fs::write(&geo, text).unwrap();
    let out = folder.path().join("mesh.msh");
    generate(&geo, options, &out)?;
    read(&out)
}

fn area(mesh: &Mesh<2>) -> f64 {
    let (mut n, mut grad, mut x) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES], Vec::new());
    let mut area = 0.0;
    for c in 0..mesh.cells.len() {
        mesh.cell_coordinates(c, &mut x);
        for (xi, w) in shape::rule(mesh.cells.kind[c], if mesh.cells.kind[c].is_simplex() { 4 } else { 9 }) {
            area += w * shape::map(mesh.cells.kind[c], &x, &xi, &mut n, &mut grad);
        }
    }
    area
}

const BOX: &str = r#"
DefineConstant[ h = {0.5, Name "Parameters/h"}, w = 2 ]; // w has no place in the menu
fixed = 1;
Point(1) = {0, 0, 0, h}; Point(2) = {w, 0, 0, h}; Point(3) = {w, fixed, 0, h}; Point(4) = {0, fixed, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("soil") = {1}; Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Point("corner") = {3};
"#;

/// A disc of radius 1 in four quarters, meshed with triangles or quadrilaterals.
fn disc(recombine: bool) -> String {
    let recombine = if recombine { "Recombine Surface{:};" } else { "" };
    format!(
        r#"SetFactory("OpenCASCADE"); Disk(1) = {{0, 0, 0, 1}}; MeshSize{{:}} = 0.4; {recombine}
        Physical Surface("disc") = {{1}}; Physical Curve("rim") = {{1}};
        "#
    )
}

#[test]
fn orders_and_kinds() {
    for (order, incomplete, recombine, kind, other) in [
        (1, false, false, CellKind::T3, CellKind::T3),
        (2, false, false, CellKind::T6, CellKind::T6),
        (1, false, true, CellKind::Q4, CellKind::T3),
        (2, true, true, CellKind::Q8, CellKind::T6),
        (2, false, true, CellKind::Q9, CellKind::T6),
    ] {
        let options = Options { incomplete, ..options(order, &[]) };
        let mesh = mesh_of(&disc(recombine), &options).unwrap();
        assert!(mesh.cells.kind.contains(&kind), "{:?}", mesh.cells.kind);
        assert!(mesh.cells.kind.iter().all(|&k| k == kind || k == other), "{:?}", mesh.cells.kind);
        assert_eq!(mesh.regions, ["disc"]);
        let rim = mesh.group("rim").unwrap_or_else(|| panic!("{kind:?} {:?}", mesh.groups));
        assert_eq!(rim.dimension, 1);
        for &node in &rim.nodes {
            let [x, y] = mesh.nodes[node as usize];
            assert!((x.hypot(y) - 1.0).abs() < 1e-12, "mid-sides of the rim lie on the circle");
        }
        // Chords lose 1.1 % of the disc at this size, curved edges five hundred times less.
        let lost = std::f64::consts::PI - area(&mesh);
        match order {
            1 => assert!(lost > 0.01 && lost < 0.1, "{lost}"),
            _ => assert!(lost.abs() < 2e-4, "{lost}"),
        }
    }
}

/// Quadrilaterals of third order have their nodes at thirds of their sides, exactly where these are straight; triangles of third order are refused.
#[test]
fn cells_of_third_order_are_quadrilaterals() {
    let quads = BOX.replace("Physical Surface", "Transfinite Surface{1}; Recombine Surface{1}; Physical Surface");
    let mesh = mesh_of(&quads, &options(3, &[])).unwrap();
    assert_eq!(mesh.cells.kind, [CellKind::Q16; 8]);
    assert_eq!(mesh.nodes.len(), 13 * 7);
    let mut x = Vec::new();
    for c in 0..mesh.cells.len() {
        mesh.cell_coordinates(c, &mut x);
        // By the bilinear map of its corners, which Gmsh has to 1e-12.
        for (own, xi) in x.iter().zip(CellKind::Q16.node_coordinates()) {
            let mut n = [0.0; MAX_NODES];
            CellKind::Q4.values(xi, &mut n);
            let place = [0, 1].map(|d| n.iter().zip(&x[..4]).map(|(n, x)| n * x[d]).sum::<f64>());
            assert!((0..2).all(|d| (own[d] - place[d]).abs() < 1e-14), "{own:?}, {place:?}");
        }
    }
    let bottom = mesh.group("bottom").unwrap();
    assert_eq!((bottom.facets.len(), bottom.nodes.len()), (4, 13));
    let error = mesh_of(BOX, &options(3, &[])).unwrap_err().to_string();
    assert!(error.contains("type 21") && error.contains("quadrilaterals alone"), "{error}");
    // Curved ones too: a quarter of a ring.
    let ring = r#"
        SetFactory("OpenCASCADE"); Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {0, 2, 0}; Point(4) = {0, 1, 0};
        Point(5) = {0, 0, 0}; Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4}; Circle(4) = {4, 5, 1};
        Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Curve{1, 3} = 3; Transfinite Curve{2, 4} = 5;
        Transfinite Surface{1}; Recombine Surface{1}; Physical Surface("ring") = {1};
        "#;
    let mesh = mesh_of(ring, &options(3, &[])).unwrap();
    assert_eq!(mesh.cells.kind, [CellKind::Q16; 8]);
    // The remainder of cubics through four places of an arc of π/8 makes 1.7e-5 m².
    assert!((area(&mesh) - 0.75 * std::f64::consts::PI).abs() < 2e-5, "{}", area(&mesh));
    quality::check(&mesh, Path::new("ring.msh")).unwrap();
}

#[test]
fn parameters_replace_defaults_whether_or_not_they_are_in_the_menu() {
    let mesh = mesh_of(BOX, &options(2, &[("w", 3.0), ("h", 0.25)])).unwrap();
    assert!((area(&mesh) - 3.0).abs() < 1e-13);
    assert_eq!(mesh.group("bottom").unwrap().facets.len(), 12);
    let corner = mesh.group("corner").unwrap();
    assert_eq!((corner.dimension, corner.nodes.len()), (0, 1));
    assert_eq!(mesh.nodes[corner.nodes[0] as usize], [3.0, 1.0]);
    assert!((area(&mesh_of(BOX, &options(2, &[])).unwrap()) - 2.0).abs() < 1e-13, "the next session starts afresh");
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let geo = folder.path().join("scene.geo");
    fs::write(&geo, disc(true)).unwrap();
    let files = ["a.msh", "b.msh"].map(|name| {
        let out = folder.path().join(name);
        generate(&geo, &options(2, &[]), &out).unwrap();
        fs::read(out).unwrap()
    });
    assert_eq!(files[0], files[1]);
}

#[test]
fn clockwise_surfaces_are_turned_round() {
    for (text, order) in [
        (BOX.to_string(), 1),
        (BOX.to_string(), 2),
        (BOX.replace("Physical Surf", "Recombine Surface{1}; Physical Surf"), 2),
    ] {
        let turned = text.replace("Curve Loop(1) = {1:4}", "Curve Loop(1) = {-4, -3, -2, -1}");
        assert_ne!(text, turned);
        let mesh = mesh_of(&turned, &options(order, &[])).unwrap();
        let (mut n, mut grad, mut x) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES], Vec::new());
        for c in 0..mesh.cells.len() {
            mesh.cell_coordinates(c, &mut x);
            for (xi, _) in shape::rule(mesh.cells.kind[c], 4) {
                assert!(shape::map(mesh.cells.kind[c], &x, &xi, &mut n, &mut grad) > 0.0);
            }
        }
        assert!((area(&mesh) - 2.0).abs() < 1e-13);
    }
}

#[test]
fn every_scene_of_the_project_meshes_in_both_orders() {
    for (scene, parameters, regions) in [
        ("column", &[("h", 1.25), ("width", 1.25)][..], &["soil"][..]),
        ("column", &[("h", 0.5), ("quads", 1.0)], &["soil"]),
        ("cantilever", &[("h", 1.0)], &["beam"]),
        ("bar", &[], &["bar"]),
        ("strip_footing", &[("h", 0.2)], &["soil"]),
        ("seabed_slope", &[("h", 1.5), ("coarse", 2.0)], &["soil", "water"]),
        ("seabed_slope", &[("h", 1.0), ("angle", 90.0)], &["soil", "water"]),
    ] {
        for order in [1, 2] {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("mesh.msh");
            generate(&project(&format!("geo/{scene}.geo")), &options(order, parameters), &out).unwrap();
            let mesh = read(&out).unwrap();
            assert_eq!(mesh.regions, regions, "{scene}");
            assert!(mesh.cells.kind.iter().all(|k| k.order() == usize::from(order)), "{scene}");
            let summary = quality::check(&mesh, &out).unwrap();
            assert!(summary.worst.0 > 0.5 && summary.mean > 0.8, "{scene}: {summary}");
            assert!((summary.jacobian - 1.0).abs() < 1e-9, "{scene} has straight edges: {summary}");
        }
    }
}

/// The message of a failure that is the input's fault.
fn refusal<T: std::fmt::Debug>(result: Result<T>) -> String {
    let error = result.unwrap_err();
    assert_eq!(error.kind, Kind::Input, "{error}");
    assert!(!error.remedy.is_empty(), "{error}");
    error.to_string()
}

#[test]
fn a_bad_geo_is_refused_with_its_place() {
    let plain = options(2, &[]);
    for (text, said) in [
        ("Point(1) = {0, 0, 0, 1};\nPoint(2) = {0, 0 0, 1};\n".to_string(), "scene.geo, line 2: syntax error"),
        (BOX.replace("fixed = 1", "fixed = unheard_of * 2"), "scene.geo, line 3: Unknown variable"),
        (BOX.replace("Line(4) = {4, 1}", "Line(4) = {4, 7}"), "Unknown control point 7"),
        (BOX.replace("{1:4}", "{1:3}"), "scene.geo"),
        (BOX.replace("Physical Surface(\"soil\") = {1};", ""), "no physical surface"),
        (BOX.replace("Physical Curve(\"bottom\") = {1}", "Physical Curve(\"bottom\") = {9}"), "unknown curve 9"),
        (BOX.trim_end().to_string(), "the last line has no end"),
        (BOX.to_string() + "Physical Surface(\"clay\") = {1};\n", "two physical surfaces, soil and clay"),
        (
            BOX.to_string()
                + "Point(5) = {w, 2, 0, h}; Line(5) = {3, 5}; Line(6) = {5, 4}; Curve Loop(2) = {5, 6, -3}; Plane \
                   Surface(2) = {2};\n",
            "surface 2: it is in no physical surface",
        ),
        (BOX.to_string() + "Physical Curve(\"bottom\", 77) = {2};\n", "already exists"),
        (BOX.to_string() + "Point(9) = {0.3, 0.3, 0, h}; Physical Point(\"gauge\") = {9};\n", "physical group gauge"),
        (BOX.replace("fixed, 0, h", "fixed, 1, h"), "plane z = 0"),
    ] {
        let message = refusal(mesh_of(&text, &plain));
        assert!(message.contains(said), "{message}\n should say {said}");
    }
}

#[test]
fn a_parameter_the_geo_does_not_declare_is_refused() {
    for name in ["nothing", "fixed", "Parameters/h", ""] {
        let message = refusal(mesh_of(BOX, &options(2, &[("h", 0.5), (name, 4.0)])));
        assert!(message.contains(name) && message.contains("it declares h, w"), "{message}");
    }
    let message = refusal(mesh_of(&disc(false), &options(2, &[("h", 0.5)])));
    assert!(message.contains("DefineConstant[ h ="), "{message}");
    assert!(refusal(mesh_of(BOX, &options(3, &[]))).contains("order 3"));
}

#[test]
fn a_place_that_cannot_be_written_is_the_machines_fault_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let geo = folder.path().join("scene.geo");
    fs::write(&geo, BOX).unwrap();
    let error = generate(&geo, &options(1, &[]), &folder.path().join("absent/mesh.msh")).unwrap_err();
    assert_eq!(error.kind, Kind::Machine, "{error}");
    // A folder in the way of the rename.
    let taken = folder.path().join("mesh.msh");
    fs::create_dir(&taken).unwrap();
    assert_eq!(generate(&geo, &options(1, &[]), &taken).unwrap_err().kind, Kind::Machine);
    let mut left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["mesh.msh", "scene.geo"]);
}
