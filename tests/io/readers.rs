//! Files of ours, read by programs that others wrote: `vtk` and `pyvista` to the bit in every encoding,
//! `meshio` and vtkio in the plain one. Needs the Python environment of the project (`make setup`).

use crate::support::{project, python, succeeds};
use std::fs;
use std::path::PathBuf;

use mpm::io::container::Data;
use mpm::io::export::Regions;
use mpm::io::frame::{self, Column, Frame, Part};
use mpm::io::points_vtu::Source;
use mpm::io::provenance::Origin;
use mpm::io::vtu::{self, Array, Encoding, Grid, Topology};
use mpm::io::{export, points_vtu};
use mpm::mesh::Mesh;
use mpm::mesh::shape::{CellKind, MAX_NODES, map, rule};
use mpm::points::Points;
use mpm::tensor::Tensor;

/// Runs `tests/readers/check_vtu.py`; fails with what it printed.
fn check(arguments: &[&dyn AsRef<std::ffi::OsStr>]) {
    succeeds(&python().arg(project("tests/readers/check_vtu.py")).args(arguments).output().unwrap());
}

/// The arrays of a file as raw numbers, with a list that says what they are.
struct Expected {
    folder: PathBuf,
    entries: Vec<String>,
}

impl Expected {
    fn new(folder: PathBuf) -> Self {
        fs::create_dir_all(&folder).unwrap();
        Self { folder, entries: Vec::new() }
    }

    fn add(&mut self, place: &str, name: &str, components: usize, component_names: &[&str], data: &Data) {
        let (kind, bytes): (_, Vec<u8>) = match data {
            Data::F64(v) => ("<f8", v.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Data::U64(v) => ("<u8", v.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Data::I64(v) => ("<i8", v.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Data::U32(v) => ("<u4", v.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Data::U16(v) => ("<u2", v.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Data::U8(v) => ("|u1", v.clone()),
        };
        let file = format!("{}.bin", self.entries.len());
        fs::write(self.folder.join(&file), bytes).unwrap();
        self.entries.push(format!(
            "{{\"where\": {place:?}, \"name\": {name:?}, \"components\": {components}, \"type\": {kind:?}, \
             \"file\": {file:?}, \"component_names\": {component_names:?}}}"
        ));
    }

    fn of(folder: PathBuf, grid: &Grid) -> Self {
        let mut expected = Self::new(folder);
        for (place, arrays) in [("point", &grid.point_data), ("cell", &grid.cell_data)] {
            for a in arrays {
                let names: &[&str] = match a.components {
                    3 => &["X", "Y", "Z"],
                    6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
                    9 => &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
                    _ => &[],
                };
                expected.add(place, &a.name, a.components, names, &a.data);
            }
        }
        expected.add("points", "", 3, &[], &Data::F64(grid.points.clone()));
        expected.add("connectivity", "", 1, &[], &Data::I64(grid.topology.connectivity.clone()));
        expected.add("offsets", "", 1, &[], &Data::I64(grid.topology.offsets.clone()));
        expected.add("types", "", 1, &[], &Data::U8(grid.topology.types.clone()));
        if let Some(time) = grid.time {
            expected.add("field", "TimeValue", 1, &[], &Data::F64(vec![time]));
        }
        expected.finish()
    }

    fn finish(self) -> Self {
        fs::write(self.folder.join("manifest.json"), format!("[{}]", self.entries.join(","))).unwrap();
        self
    }
}

/// Awkward numbers among ordinary ones: signed zero, the smallest and largest, a third.
fn numbers(n: usize, seed: usize) -> Vec<f64> {
    let awkward = [-0.0, 5e-324, f64::MIN_POSITIVE, f64::MAX, f64::MIN, 1.0 / 3.0, 1.0 + f64::EPSILON];
    (0..n)
        .map(|i| if i % 11 == 0 { awkward[i / 11 % 7] } else { ((i * 13 + seed) as f64 * 0.731).sin() * 1e3 })
        .collect()
}

/// A row of cells side by side, one of each plane kind, each bulged so that the order of its nodes matters.
fn mixed_mesh() -> Mesh<2> {
    let mut mesh = Mesh { regions: vec!["soil".to_string(), "water".to_string()], ..Mesh::default() };
    let kinds = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9, CellKind::Q16, CellKind::T6];
    for (k, kind) in kinds.into_iter().enumerate() {
        let first = mesh.nodes.len() as u32;
        for (i, xi) in kind.node_coordinates().iter().enumerate() {
            let bulge = if i < kind.corner_count() { 0.0 } else { 0.04 + 0.02 * i as f64 };
            mesh.nodes.push([3.0 * k as f64 + xi[0] + bulge * xi[1], xi[1] + bulge * (1.0 + xi[0])]);
        }
        let nodes: Vec<u32> = (first..mesh.nodes.len() as u32).collect();
        mesh.cells.push(kind, (k % 2) as u16, &nodes);
    }
    mesh
}

/// The area of a cell by our own shape functions.
fn area(mesh: &Mesh<2>, c: usize) -> f64 {
    let kind = mesh.cells.kind[c];
    let mut x = Vec::new();
    mesh.cell_coordinates(c, &mut x);
    let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
    rule(kind, 4).iter().map(|(xi, w)| w * map(kind, &x, xi, &mut n, &mut gradient)).sum()
}

fn sample_grid() -> Grid {
    let mesh = mixed_mesh();
    let n = mesh.nodes.len();
    let array = |name: &str, components, data| Array { name: name.to_string(), components, data };
    Grid {
        points: mesh.nodes.iter().flat_map(|x| [x[0], x[1], -0.0]).collect(),
        topology: Topology::of_mesh(&mesh),
        point_data: vec![
            array("stress [kPa]", 6, Data::F64(numbers(6 * n, 1))),
            array("displacement [m]", 3, Data::F64(numbers(3 * n, 2))),
            array("gradient \"F\" <&> [-]", 9, Data::F64(numbers(9 * n, 3))),
            array("plastic_strain [-]", 1, Data::F64(numbers(n, 4))),
        ],
        cell_data: vec![
            array("area [m2]", 1, Data::F64((0..mesh.cells.len()).map(|c| area(&mesh, c)).collect())),
            array("region [-]", 1, Data::U16(mesh.cells.region.clone())),
            array("cell [-]", 1, Data::U32((0..mesh.cells.len() as u32).map(|c| u32::MAX - c).collect())),
        ],
        time: Some(0.1 + 0.2),
        note: "mpm -- of a test".to_string(),
    }
}

/// Points enough that the compressed arrays have several blocks, and no cells but vertices.
fn many_points() -> Grid {
    let n = 30_000;
    let mut points = numbers(3 * n, 5);
    // VTK computes bounds; keep the squares of the numbers finite.
    points.iter_mut().for_each(|x| *x = x.clamp(-1e3, 1e3));
    Grid {
        points,
        topology: Topology::vertices(n),
        point_data: vec![Array { name: "stress [kPa]".to_string(), components: 6, data: Data::F64(numbers(6 * n, 6)) }],
        cell_data: Vec::new(),
        time: Some(1.0e-7),
        note: String::new(),
    }
}

#[test]
fn vtk_reads_every_encoding_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    for (name, grid) in [("grid", sample_grid()), ("points", many_points()), ("empty", Grid::default())] {
        let expected = Expected::of(folder.path().join(name), &grid);
        let files = [("lz4", Encoding::Lz4), ("plain", Encoding::Plain)].map(|(e, encoding)| {
            let path = folder.path().join(format!("{name}_{e}.vtu"));
            vtu::write(&path, &grid, encoding).unwrap();
            path
        });
        check(&[&"vtk", &expected.folder, &files[0], &files[1]]);
    }
}

#[test]
fn meshio_reads_the_plain_encoding_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    for (name, grid) in [("grid", sample_grid()), ("points", many_points())] {
        let expected = Expected::of(folder.path().join(name), &grid);
        let path = folder.path().join(format!("{name}.vtu"));
        vtu::write(&path, &grid, Encoding::Plain).unwrap();
        check(&[&"meshio", &expected.folder, &path]);
    }
}

#[test]
fn vtkio_reads_the_plain_encoding() {
    use vtkio::model::{DataSet, Piece, Vtk};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.vtu");
    let grid = sample_grid();
    vtu::write(&path, &grid, Encoding::Plain).unwrap();
    let DataSet::UnstructuredGrid { pieces, .. } = Vtk::import(&path).unwrap().data else { panic!("another data set") };
    let [Piece::Inline(piece)] = &pieces[..] else { panic!("not one piece") };
    let points: Vec<f64> = piece.points.clone().into_vec().unwrap();
    assert_eq!(points, grid.points);
    assert_eq!(piece.data.point.len(), grid.point_data.len());
    assert_eq!(piece.data.cell.len(), grid.cell_data.len());
}

#[test]
fn points_vtu_is_viewable_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.vtu");
    let n = 50;
    let symmetric = |seed| numbers(6 * n, seed).chunks_exact(6).map(|c| [c[0], c[1], c[2], c[3], c[4], c[5]]).collect();
    let pairs = |seed| (0..n).map(|i| [(i * seed) as f64 * 0.3, -(i as f64)]).collect::<Vec<_>>();
    let points = Points::<2> {
        position: pairs(1),
        origin: pairs(2),
        reference: Vec::new(),
        velocity: pairs(3),
        acceleration: pairs(4),
        mass: numbers(n, 7),
        initial_volume: numbers(n, 8),
        deformation: numbers(9 * n, 9).chunks_exact(9).map(Tensor::from_row_slice).collect(),
        elastic: symmetric(10),
        stress: symmetric(11),
        plastic_strain: numbers(n, 12),
        plastic_increment: Vec::new(),
        internal: Vec::new(),
        pressure: Vec::new(),
        pore_pressure: Vec::new(),
        domain: Vec::new(),
        strength: numbers(n, 13),
        region: (0..n).map(|i| (i % 2) as u16).collect(),
        model: Vec::new(),
        cell: (0..n as u32).collect(),
    };
    points_vtu::write(&path, &points, &["clay".to_string(), "sand".to_string()], &Source::default()).unwrap();

    let mut expected = Expected::new(folder.path().join("expected"));
    let padded = |v: &[[f64; 2]]| Data::F64(v.iter().flat_map(|x| [x[0], x[1], 0.0]).collect());
    let symmetric_names = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
    expected.add("points", "", 3, &[], &padded(&points.position));
    expected.add("point", "origin [m]", 3, &[], &padded(&points.origin));
    expected.add("point", "velocity [m/s]", 3, &["X", "Y", "Z"], &padded(&points.velocity));
    expected.add("point", "acceleration [m/s2]", 3, &[], &padded(&points.acceleration));
    expected.add("point", "mass [t]", 1, &[], &Data::F64(points.mass.clone()));
    expected.add("point", "initial_volume [m3]", 1, &[], &Data::F64(points.initial_volume.clone()));
    expected.add(
        "point",
        "deformation [-]",
        9,
        &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
        &Data::F64(numbers(9 * n, 9)),
    );
    expected.add("point", "elastic [-]", 6, &symmetric_names, &Data::F64(points.elastic.concat()));
    expected.add("point", "stress [kPa]", 6, &symmetric_names, &Data::F64(points.stress.concat()));
    expected.add("point", "plastic_strain [-]", 1, &[], &Data::F64(points.plastic_strain.clone()));
    expected.add("point", "strength [-]", 1, &[], &Data::F64(points.strength.clone()));
    expected.add("point", "region [-]", 1, &[], &Data::U16(points.region.clone()));
    expected.add("point", "cell [-]", 1, &[], &Data::U32(points.cell.clone()));
    let expected = expected.finish();
    check(&[&"vtk", &expected.folder, &path]);
    check(&[&"meshio", &expected.folder, &path]);
}

/// A square and a triangle beside it, loaded by `1 + x`.
fn surface(time: f64) -> Part {
    let x = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [3.0, 0.0], [2.0, 1.0]];
    let column = |name: &str, components: usize, values: Vec<f64>| Column {
        name: name.to_string(),
        unit: "-".to_string(),
        components,
        values,
    };
    Part {
        position: x.map(|[x, y]| [x, y + time, 0.0]).to_vec(),
        columns: vec![
            column("pressure", 1, x.iter().map(|x| 1.0 + x[0]).collect()),
            column("normal", 3, [0.6, 0.8, 0.0].repeat(x.len())),
            column(frame::LINE, 1, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        ],
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn a_series_has_its_frames_at_their_times() {
        let folder = tempfile::tempdir().unwrap();
        let results = folder.path().join("results");
        frame::prepare(&results, 0).unwrap();
        let mesh = mixed_mesh();
        let times = [0.0, 0.1, 0.1 + 0.2, 1.0 / 3.0, 12.5];
        for (k, &time) in times.iter().enumerate() {
            let column = |n: usize| Column {
                name: "displacement".to_string(),
                unit: "m".to_string(),
                components: 3,
                values: vec![time; 3 * n],
            };
            let volume =
                Column { name: frame::VOLUME.to_string(), unit: "m3".to_string(), components: 1, values: vec![0.1; 7] };
            let frame = Frame {
                time,
                phase: "fall".to_string(),
                step: k as u64,
                origin: Origin::default(),
                points: Part { position: vec![[time, 1.0, 0.0]; 7], columns: vec![column(7), volume] },
                grid: Part { position: Vec::new(), columns: vec![column(mesh.nodes.len())] },
                elements: Part::default(),
                contact: Part::default(),
                surface: surface(time),
            };
            frame.write(&results, k).unwrap();
        }
        let arguments: Vec<String> = times.iter().map(|t| format!("{t:?}")).collect();
        for encoding in [Encoding::Lz4, Encoding::Plain] {
            let count = mesh.regions.len();
            let regions = Regions { elements: vec![false; count], soil: vec![true; count], ..Regions::default() };
            export::export(&results, &mesh, &regions, folder.path(), &["displacement".to_string()], encoding).unwrap();
            check(&[&"vtp", &folder.path().join("vtu/surface_000002.vtp"), &"[[0, 1, 2, 3, 0], [4, 5, 6, 4]]"]);
            for series in ["points.pvd", "grid.pvd", "soil.pvd", "surface.pvd"] {
                let path = folder.path().join(series);
                // Points that fly outside of the grid are no body.
                let what = if series == "soil.pvd" { "times" } else { "pvd" };
                let mut all: Vec<&dyn AsRef<std::ffi::OsStr>> = vec![&what, &path];
                all.extend(arguments.iter().map(|a| a as &dyn AsRef<std::ffi::OsStr>));
                check(&all);
            }
        }
    }
}
