//! An output field, defined in this file only; the library needs no change for it. `volume_ratio` is `det F` of each point.

use crate::support::bench::{Bench, constant, quadrature_points};
use mpm::io::checkpoint::Fingerprint;
use mpm::io::export::{Regions, export};
use mpm::io::frame::{self, Column, Frame};
use mpm::io::provenance::Origin;
use mpm::io::run_folder::RunFolder;
use mpm::io::vtu::Encoding;
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::run::fields::Field;
use mpm::run::{self, Ended, Outputs};
use mpm::step::State;
use std::fs;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

#[derive(Debug)]
struct VolumeRatio;

impl Field<2> for VolumeRatio {
    fn columns(&self, points: &Points<2>) -> Vec<Column> {
        let values = points.deformation.iter().map(|f| f.determinant()).collect();
        vec![Column { name: "volume_ratio".into(), unit: "-".into(), components: 1, values }]
    }
}

/// Soil under its weight, confined: the ratios are those of the closed form.
#[test]
fn a_field_of_ones_own_is_written_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut bench = Bench::new(
        rectangle(CellKind::T6, 1.0, 4.0, 1, 4, 0.0, 0),
        Arc::new(LinearElastic::new(Elasticity::new(constant(500.0), 0.2).unwrap())),
    );
    bench.gravity = [0.0, -10.0];
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
    let points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0);
    let depth: Vec<f64> = points.position.iter().map(|x| 4.0 - x[1]).collect();
    let scene = bench.scene::<PlaneStrain>();
    let outputs = Outputs {
        folder: RunFolder::new(folder.path()),
        warnings: Vec::new(),
        ends: Vec::new(),
        fields: vec![Arc::new(VolumeRatio)],
        watches: Vec::new(),
        until: Vec::new(),
        surface: None,
        origin: Origin { run: Fingerprint::of(&[b"volume ratio"]), mesh: 1 },
    };
    let first = State::new(points, scene.mesh.nodes.len(), scene.phases[0].step.initial);
    let ended =
        run::run::<2, PlaneStrain>(&scene, first, &outputs, false, &AtomicBool::new(false), &mut |_| {}).unwrap();
    assert_eq!(ended, Ended::Done);
    let results = RunFolder::new(folder.path()).results();
    let regions = Regions { elements: vec![false], soil: vec![true], ..Regions::default() };
    export(&results, &scene.mesh, &regions, folder.path(), &["volume_ratio".to_string()], Encoding::Plain).unwrap();
    let text = fs::read_to_string(folder.path().join("vtu/points_000001.vtu")).unwrap();
    assert!(text.contains("\"volume_ratio [-]\""), "{text}");
    let Frame { points, .. } = Frame::read(&frame::path(&results, 1)).unwrap();
    let values = &points.columns.iter().find(|column| column.name == "volume_ratio").unwrap().values;
    assert_eq!(values.len(), depth.len());
    // The weight above a point does not change as it is compressed: σ = M ln J/J = −ρgd.
    let modulus = 500.0 * 0.8 / (1.2 * 0.6);
    for (ratio, depth) in values.iter().zip(&depth) {
        let error = ratio.ln() + 10.0 * depth / modulus * ratio;
        assert!(error.abs() < 1e-4, "{ratio} at {depth}: {error:.1e}");
    }
}
