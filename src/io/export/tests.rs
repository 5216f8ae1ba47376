use super::super::container::Data;
use super::super::frame::{self, Column, Frame, Part};
use super::series::counted_from;
use super::*;
use crate::error::Kind;
use crate::io::export::pieces::Piece;
use crate::mesh::shape::CellKind;
use crate::tensor::{deviatoric, mean};
use std::fs;

fn mesh() -> Mesh<2> {
    let mut mesh = Mesh {
        nodes: vec![[0., 0.], [1., 0.], [0., 1.], [0.5, 0.], [0.5, 0.5], [0., 0.5]],
        regions: vec!["soil".to_string()],
        ..Mesh::default()
    };
    mesh.cells.push(CellKind::T6, 0, &[0, 1, 2, 3, 4, 5]);
    mesh
}

fn regions(elements: &[bool]) -> Regions {
    Regions { elements: elements.to_vec(), soil: vec![false; elements.len()], ..Regions::default() }
}

fn fields(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

fn write_frames(folder: &Path, count: usize) {
    frame::prepare(folder, 0).unwrap();
    for k in 0..count {
        frame::tests::sample(k).write(folder, k).unwrap();
    }
}

#[test]
fn only_what_is_asked_for_is_written_and_stale_files_go() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    write_frames(&results, 4);
    fs::create_dir_all(out.join("vtu")).unwrap();
    fs::write(out.join("vtu/points_own.vtu"), b"").unwrap();
    let asked = fields(&["mean_stress", "plastic_strain"]);
    assert_eq!(export(&results, &mesh(), &regions(&[false]), &out, &asked, Encoding::Plain).unwrap().frames, 4);
    let text = fs::read_to_string(out.join("vtu/points_000003.vtu")).unwrap();
    assert!(text.contains("Name=\"mean_stress [kPa]\"") && text.contains("Name=\"plastic_strain [-]\""));
    assert!(!text.contains("Name=\"stress") && !text.contains("displacement") && !text.contains("deviatoric"));

    write_frames(&results, 2);
    assert_eq!(export(&results, &mesh(), &regions(&[false]), &out, &asked, Encoding::Lz4).unwrap().frames, 2);
    let mut left: Vec<_> =
        fs::read_dir(out.join("vtu")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    left.sort();
    assert_eq!(
        left,
        ["grid_000000.vtu", "grid_000001.vtu", "points_000000.vtu", "points_000001.vtu", "points_own.vtu"]
    );
    assert_eq!(fs::read_to_string(out.join("grid.pvd")).unwrap().matches("<DataSet ").count(), 2);
}

#[test]
fn unknown_fields_and_other_meshes_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    write_frames(&results, 1);
    let e =
        export(&results, &mesh(), &regions(&[false]), &out, &fields(&["pore_pressure"]), Encoding::Lz4).unwrap_err();
    assert_eq!(e.kind, Kind::Input);
    assert!(e.problem.contains("`pore_pressure`") && e.problem.contains("mean_stress, plastic_strain"), "{e}");
    let mut other = mesh();
    other.nodes.push([2., 2.]);
    let e = export(&results, &other, &regions(&[false]), &out, &fields(&["stress"]), Encoding::Lz4).unwrap_err();
    assert!(e.kind == Kind::Input && e.problem.contains("7 nodes"), "{e}");
    assert!(!out.join("points.pvd").exists());
}

#[test]
fn stress_invariants() {
    // Uniaxial tension: q is the stress itself; pure shear: √3 τ; a pressure adds nothing to q.
    assert_eq!((mean(&[6., 0., 0., 0., 0., 0.]), deviatoric(&[6., 0., 0., 0., 0., 0.])), (2.0, 6.0));
    for i in 3..6 {
        let mut s = [-7., -7., -7., 0., 0., 0.];
        s[i] = 2.0;
        assert_eq!(mean(&s), -7.0);
        assert!((deviatoric(&s) - 2.0 * 3_f64.sqrt()).abs() < 1e-15);
    }
}

/// Two elements of different regions beside a cell of the grid: their nodes at the interface are two, and a stress that is linear
/// in each is found again at them.
#[test]
fn finite_elements_are_a_series_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    let mut mesh = Mesh {
        nodes: vec![[0., 0.], [1., 0.], [1., 1.], [0., 1.], [2., 0.]],
        regions: ["soil", "clay", "steel"].map(str::to_string).to_vec(),
        ..Mesh::default()
    };
    mesh.cells.push(CellKind::T3, 1, &[0, 1, 2]);
    mesh.cells.push(CellKind::T3, 0, &[0, 2, 3]);
    mesh.cells.push(CellKind::T3, 2, &[1, 4, 2]);
    let now: Vec<[f64; 3]> = mesh.nodes.iter().map(|x| [x[0] + 0.1, 0.5 * x[1], 0.0]).collect();
    let inside = |nodes: [usize; 3]| {
        [[0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]]
            .map(|w| [0, 1, 2].map(|d| (0..3).map(|i| w[i] * now[nodes[i]][d]).sum::<f64>()))
    };
    let position = [inside([0, 1, 2]), inside([1, 4, 2])].concat();
    let strain = |region: usize, x: &[f64; 3]| if region == 1 { x[0] - 2.0 * x[1] } else { 7.0 };
    let column = |name: &str, values: Vec<f64>| Column {
        name: name.to_string(),
        unit: "-".to_string(),
        components: values.len() / 6,
        values,
    };
    let elements = Part {
        columns: vec![
            column("plastic_strain", position.iter().zip([1, 1, 1, 2, 2, 2]).map(|(x, r)| strain(r, x)).collect()),
            column("displacement", vec![9.0; 18]),
            column(frame::CELL, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        ],
        position,
    };
    let grid = Part { position: now.clone(), ..Part::default() };
    let full = Frame { grid, elements, ..Frame::default() };
    frame::prepare(&results, 0).unwrap();
    full.clone().write(&results, 0).unwrap();
    assert_eq!(Frame::read(&frame::path(&results, 0)).unwrap(), full);

    let pieces = Piece::by_region(&mesh.part(|c| c != 1));
    let first: Vec<[f64; 3]> = mesh.nodes.iter().map(|x| [x[0], x[1], 0.0]).collect();
    let smooth = pieces.smooth(&full.grid, &first, &full.elements).unwrap();
    assert_eq!(smooth.position.len(), 6);
    for (n, x) in smooth.position.iter().enumerate() {
        let expected = strain(if n < 3 { 1 } else { 2 }, x);
        assert!(
            (smooth.columns[0].values[n] - expected).abs() < 1e-14 * (1.0 + expected.abs()),
            "node {n}: {}",
            smooth.columns[0].values[n]
        );
        assert!((smooth.columns[1].values[3 * n] - 0.1).abs() < 1e-15, "the displacement of the node itself");
    }

    // Once displacements have been reset they are counted from where the nodes were then.
    let way =
        Column { name: frame::UNCOUNTED.to_string(), unit: "m".to_string(), components: 3, values: vec![0.04; 15] };
    let mut reset = Part { columns: vec![way], ..full.grid.clone() };
    let from = counted_from(&mut reset, &first);
    assert!(reset.columns.is_empty());
    let counted = pieces.smooth(&reset, &from, &full.elements).unwrap();
    assert!((counted.columns[1].values[0] - 0.06).abs() < 1e-15, "{:?}", counted.columns[1].values);

    let asked = fields(&["plastic_strain"]);
    let done = export(&results, &mesh, &regions(&[false, true, true]), &out, &asked, Encoding::Plain).unwrap();
    assert_eq!(done.frames, 1);
    let count = |series: &str| {
        let text = fs::read_to_string(out.join(format!("vtu/{series}_000000.vtu"))).unwrap();
        text.lines().find(|line| line.contains("<Piece")).unwrap().to_string()
    };
    assert!(count("grid").contains("NumberOfPoints=\"3\" NumberOfCells=\"1\""), "{}", count("grid"));
    assert!(count("structures").contains("NumberOfPoints=\"6\" NumberOfCells=\"2\""), "{}", count("structures"));
    assert!(out.join("structures.pvd").exists());

    // A case that no longer has any.
    let without = Frame { elements: Part::default(), ..full };
    without.write(&results, 0).unwrap();
    let done = export(&results, &mesh, &regions(&[false; 3]), &out, &[], Encoding::Plain).unwrap();
    assert_eq!(done.frames, 1);
    assert!(!out.join("structures.pvd").exists());
}

/// Two lines of a structure: cells join the nodes of a line and nothing else, and a gap where there is no soil is not a number.
#[test]
fn boundaries_in_contact_are_a_series_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    let column = |name: &str, values: &[f64]| Column {
        name: name.to_string(),
        unit: "-".to_string(),
        components: 1,
        values: values.to_vec(),
    };
    let contact = Part {
        position: (0..5).map(|i| [f64::from(i), 0.0, 0.0]).collect(),
        columns: vec![
            column("contact_pressure", &[1.0, 2.0, 3.0, 0.0, 0.0]),
            column("contact_gap", &[0.0, 0.0, 0.1, 0.0, 0.0]),
            column(frame::LINE, &[0.0, 0.0, 0.0, 1.0, 1.0]),
            column(frame::REGION, &[4.0; 5]),
            column(frame::FACES, &[1.0, 1.0, 1.0, 0.0, 0.0]),
        ],
    };
    let grid = contact::grid(&contact, None).unwrap();
    assert_eq!(grid.topology.connectivity, [0, 1, 1, 2, 3, 4]);
    assert_eq!(grid.cell_data[0].data, Data::U16(vec![4; 3]));
    let [pressure, gap] = &grid.point_data[..] else { panic!("{:?}", grid.point_data) };
    assert_eq!(pressure.data, Data::F64(vec![1.0, 2.0, 3.0, 0.0, 0.0]));
    let Data::F64(gap) = &gap.data else { panic!("{gap:?}") };
    assert!(gap[..3] == [0.0, 0.0, 0.1] && gap[3..].iter().all(|g| g.is_nan()), "{gap:?}");

    let with = Frame { contact, ..frame::tests::sample(0) };
    frame::prepare(&results, 0).unwrap();
    with.clone().write(&results, 0).unwrap();
    assert_eq!(Frame::read(&frame::path(&results, 0)).unwrap(), with);
    export(&results, &mesh(), &regions(&[false]), &out, &[], Encoding::Plain).unwrap();
    assert!(out.join("contact.pvd").exists() && out.join("vtu/contact_000000.vtu").exists());

    // A frame of a run without contact among those with it, and a run without any.
    frame::tests::sample(1).write(&results, 1).unwrap();
    let e = export(&results, &mesh(), &regions(&[false]), &out, &[], Encoding::Plain).unwrap_err();
    assert!(e.kind == Kind::Input && e.problem.contains("boundaries in contact"), "{e}");
    frame::tests::sample(0).write(&results, 0).unwrap();
    let done = export(&results, &mesh(), &regions(&[false]), &out, &[], Encoding::Plain).unwrap();
    assert_eq!(done.frames, 2);
    assert!(!out.join("contact.pvd").exists());
}
