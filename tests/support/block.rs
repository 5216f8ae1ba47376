//! A block of rock under its weight, for tests of the program as a whole.

use std::fs;
use tempfile::TempDir;

pub const GEO: &str = r#"DefineConstant[ h = {1, Name "Parameters/h"} ];
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1, 2, 0, h};
Point(4) = {0, 2, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("block") = {1};
Physical Curve("bottom") = {1};
"#;

const CASE: &str = "\
geometry: plane_strain
mesh: {geo: scene.geo, parameters: {h: SIZE}}
regions: {block: {kind: mpm, material: rock, points_per_cell: 4}}
materials: {rock: {model: linear_elastic, young: 1000, poisson: 0.2, density: 2}}
supports: {bottom: {ux: 0, uy: 0}}
gravity: {y: -10}
numerics: {restore: never}
phases:
  - {name: load, analysis: quasi_static, duration: 1, step: {initial: STEP}, gravity: {rate: 1}}
output: {every: EVERY}
";

/// A folder with the case: cells of `size`, steps of `step`, and a frame `every` so often.
pub fn scene(size: &str, step: &str, every: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let case = CASE.replace("SIZE", size).replace("STEP", step).replace("EVERY", every);
    fs::write(folder.path().join("case.yaml"), case).unwrap();
    fs::write(folder.path().join("scene.geo"), GEO).unwrap();
    folder
}
