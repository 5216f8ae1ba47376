//! The axis of axisymmetry stays where it is, also where no support holds it.

use crate::support::{column, mpm, succeeds};
use std::f64::consts::PI;
use std::fs;

const GEO: &str = "Mesh.MeshSizeMax = 0.5;\nPoint(1) = {0, 0, 0};\nPoint(2) = {0.8, 0, 0};\nPoint(3) = {0.8, 2, 0};\nPoint(4) = {0, 2, 0};\n\
Point(5) = {0.8, 3, 0};\nPoint(6) = {0, 3, 0};\nLine(1) = {1, 2};\nLine(2) = {2, 3};\nLine(3) = {3, 4};\nLine(4) = {4, 1};\nLine(5) = {3, 5};\n\
Line(6) = {5, 6};\nLine(7) = {6, 4};\nCurve Loop(1) = {1, 2, 3, 4};\nCurve Loop(2) = {-3, 5, 6, 7};\nPlane Surface(1) = {1};\nPlane Surface(2) = {2};\n\
Physical Surface(\"soil\") = {1};\nPhysical Surface(\"air\") = {2};\nPhysical Curve(\"bottom\") = {1};\nPhysical Curve(\"axis\") = {4, 7};\n\
Physical Curve(\"side\") = {2, 5};\n";
const CASE: &str = "geometry: axisymmetric\nmesh: {geo: m.geo}\nregions: {soil: {kind: mpm, material: soil}, air: {kind: buffer}}\n\
materials: {soil: {model: linear_elastic, young: 500, poisson: 0.2, density: 0}}\nsupports: {bottom: {uy: 0}, side: {ux: 0}}\n\
numerics: {restore: every_step}\nphases: [{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.2}, \
tractions: [{surface: soil, pressure: {rate: 90}}]}]\noutput: {history: [{name: bottom, on: bottom, quantities: [reaction_y]}, \
{name: soil, on: soil, quantities: [uy]}]}\n";

#[test]
fn soil_stays_on_an_axis_without_a_support() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.geo"), GEO).unwrap();
    fs::write(folder.path().join("case.yaml"), CASE).unwrap();
    let held = "supports={bottom: {uy: 0}, side: {ux: 0}, axis: {ux: 0}}";
    let wall = "contacts=[{wall: axis, soil: soil}]";
    let [free, held, wall] = [None, Some(held), Some(wall)].map(|set| {
        succeeds(&mpm("run", folder.path(), &folder.path().join("out"), set.as_slice()));
        ["bottom.reaction_y [kN]", "soil.uy [m]"].map(|name| *column(&folder.path().join("out"), name).last().unwrap())
    });
    let load = 90.0 * PI * 0.8 * 0.8;
    for [reaction, settlement] in [free, held, wall] {
        assert!((reaction / load - 1.0).abs() < 1e-6, "{reaction} {load}");
        assert!((settlement / held[1] - 1.0).abs() < 1e-6, "{settlement} {held:?}");
    }
}
