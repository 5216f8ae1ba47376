//! The stress of soil at rest in meshes of Gmsh.

use super::gmsh::{mesh_of, options};
use crate::support::Random;
use mpm::material::Profile;
use mpm::seed::{RegionSeed, RegionWeight, k0_stress, seed};
use std::fmt::Write;

/// Rectangles of random place, width, depth and size of cells, beside each other: the vertical stress is the weight above at every point. In
/// such meshes many edges end above a point to within rounding.
#[test]
fn rectangles_of_any_size_bear_what_is_above() {
    const COUNT: usize = 80;
    let mut random = Random(15);
    let mut between = |low: f64, high: f64| low + (high - low) * 0.5 * (1.0 + random.next());
    let (mut geo, mut left, mut tops) = ("SetFactory(\"OpenCASCADE\");\n".to_owned(), -200.0, Vec::new());
    for k in 1..=COUNT {
        // One decimal, as one would draw it.
        let deep = between(1.0, 5.0);
        let [wide, deep, top] = [deep * between(1.0, 4.0), deep, between(-5.0, 5.0)].map(|x| (10.0 * x).round() / 10.0);
        let bottom = top - deep;
        writeln!(geo, "Rectangle({k}) = {{{left}, {bottom}, 0, {wide}, {deep}}};").unwrap();
        writeln!(geo, "MeshSize{{PointsOf{{Surface{{{k}}};}}}} = {};", deep / between(2.0, 5.0)).unwrap();
        writeln!(geo, "Physical Surface(\"r{k}\") = {{{k}}};").unwrap();
        left += wide + 1.0;
        tops.push(top);
    }
    let mesh = mesh_of(&geo, &options(2, &[])).unwrap();
    let numbers: Vec<usize> = mesh.regions.iter().map(|name| name[1..].parse::<usize>().unwrap() - 1).collect();
    let one = Profile::constant(1.0);
    let seeds: Vec<_> =
        (0..COUNT as u16).map(|region| RegionSeed { region, points_per_cell: 16, density: one }).collect();
    let points = seed(&mesh, false, &seeds).unwrap();
    let weight = Profile::constant(18.0);
    let soils: Vec<_> = (0..COUNT as u16).map(|region| RegionWeight { region, unit_weight: weight }).collect();
    let stress = k0_stress(&mesh, &soils, |_| 0.7, &points);
    let wrong = |p: &usize| {
        let depth = tops[numbers[usize::from(points.region[*p])]] - points.position[*p][1];
        (stress[*p][1] + 18.0 * depth).abs() > 1e-9
    };
    let wrong: Vec<usize> = (0..points.len()).filter(wrong).collect();
    assert!(wrong.is_empty(), "{} of {} points, such as {:?}", wrong.len(), points.len(), points.position[wrong[0]]);
}
