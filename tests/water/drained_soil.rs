//! Drained soil beside undrained soil takes its water: Terzaghi's layer between other soil, and one that settles by more than a cell.

use crate::analytical::terzaghi::degree;
use crate::support::{column, in_folder, said, succeeds};
use std::fs;
use tempfile::TempDir;

/// A metre of soil below and above two metres of clay, and half a metre of air: cells of 1/8 m in the clay.
const GEO: &str = "
Point(1) = {0, 0, 0};  Point(2) = {0.25, 0, 0};  Point(3) = {0.25, 1, 0};  Point(4) = {0, 1, 0};  Point(5) = {0.25, 3, 0};
Point(6) = {0, 3, 0};  Point(7) = {0.25, 4, 0};  Point(8) = {0, 4, 0};  Point(9) = {0.25, 4.5, 0};  Point(10) = {0, 4.5, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};  Line(5) = {3, 5};  Line(6) = {5, 6};  Line(7) = {6, 4};
Line(8) = {5, 7};  Line(9) = {7, 8};  Line(10) = {8, 6};  Line(11) = {7, 9};  Line(12) = {9, 10};  Line(13) = {10, 8};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};  Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10};  Plane Surface(3) = {3};
Curve Loop(4) = {-9, 11, 12, 13};  Plane Surface(4) = {4};
Transfinite Curve {1, 3, 6, 9, 12} = 2;  Transfinite Curve {2, 4, 8, 10} = 5;  Transfinite Curve {5, 7} = 17;  Transfinite Curve {11, 13} = 3;
Transfinite Surface {1, 2, 3, 4};
Physical Surface(\"lower\") = {1};  Physical Surface(\"clay\") = {2};  Physical Surface(\"upper\") = {3};  Physical Surface(\"air\") = {4};
Physical Curve(\"bottom\") = {1};  Physical Curve(\"sides\") = {2, 4, 5, 7, 8, 10, 11, 13};  Physical Curve(\"top\") = {9};
";

/// The load (kPa).
const LOAD: f64 = 50.0;
/// `c_v` (m²/s).
const COEFFICIENT: f64 = 2e-6;

/// The clay and what lies around it.
#[derive(Clone, Copy, Debug)]
struct Layers {
    /// Materials below and above.
    around: [&'static str; 2],
    /// The kind of the clay and of the soil around it.
    kinds: [&'static str; 2],
    quadrangles: bool,
    /// Young's modulus of the clay (kPa).
    young: f64,
    restore: &'static str,
    factor: f64,
}

const LAYERS: Layers = Layers {
    around: ["sand", "sand"],
    kinds: ["mpm", "mpm"],
    quadrangles: true,
    young: 4000.0,
    restore: "{min_quality: 0.5}",
    factor: 0.2,
};

impl Layers {
    /// How far the water goes at most (m).
    fn way(&self) -> f64 {
        if self.around == ["sand", "sand"] { 1.0 } else { 2.0 }
    }

    /// Confined modulus (kPa) of the clay.
    fn modulus(&self) -> f64 {
        self.young / 0.9
    }

    fn folder(&self) -> TempDir {
        let folder = tempfile::tempdir().unwrap();
        let recombine = if self.quadrangles { "Recombine Surface {1, 2, 3, 4};\n" } else { "" };
        fs::write(folder.path().join("layers.geo"), format!("{GEO}{recombine}")).unwrap();
        let Layers { around: [lower, upper], kinds: [clay, other], young, restore, .. } = self;
        // A grid that moves with the soil bears tractions on its curves, as finite elements do.
        let on = if *other == "fem" || *restore == "never" { "on: top" } else { "surface: all" };
        let time = self.factor * self.way().powi(2) / COEFFICIENT;
        let case = format!(
            "geometry: plane_strain\nmesh: {{geo: layers.geo}}\n\
             regions: {{lower: {{kind: {other}, material: {lower}}}, clay: {{kind: {clay}, material: clay}}, \
               upper: {{kind: {other}, material: {upper}}}, air: {{kind: buffer}}}}\n\
             materials:\n  clay: {{model: linear_elastic, young: {young}, poisson: 0.2, density: 0, drainage: undrained, \
               permeability: {}, porosity: 0.5, water_bulk_modulus: 2.2e+6}}\n  \
               sand: {{model: linear_elastic, young: 4.0e+5, poisson: 0.2, density: 0}}\n  \
               tight: {{model: linear_elastic, young: 4.0e+5, poisson: 0.2, density: 0, drainage: undrained}}\n\
             supports: {{bottom: {{ux: 0, uy: 0}}, sides: {{ux: 0}}}}\n\
             numerics: {{restore: {restore}}}\n\
             phases:\n- {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.1}}, tractions: [{{{on}, ty: {{rate: -{LOAD}}}}}]}}\n\
             - {{name: wait, analysis: consolidation, duration: {time:e}, step: {{initial: {:e}}}, tractions: [{{{on}, ty: -{LOAD}}}]}}\n\
             output: {{fields: [pore_pressure], history: [{{name: clay, on: clay, quantities: [pore_pressure]}}, \
               {{name: upper, on: upper, quantities: [uy]}}]}}\n",
            COEFFICIENT * 9.81 / self.modulus(),
            time / 50.0,
        );
        fs::write(folder.path().join("case.yaml"), case).unwrap();
        folder
    }

    /// Mean excess pressure (kPa) in the clay and settlement (m) of the soil above it in the mean, in the end.
    fn end(&self) -> [f64; 2] {
        let folder = self.folder();
        let output = in_folder(folder.path(), &["run", ".", "--threads", "1"]);
        succeeds(&output);
        assert_eq!(said(&output).contains("warning"), self.around == ["tight", "tight"], "{}", said(&output));
        let last = |name: &str| *column(&folder.path().join("out"), name).last().unwrap();
        [last("clay.pore_pressure [kPa]"), -last("upper.uy [m]")]
    }
}

/// One way or both ways, in quadrangles and triangles, whichever of the soils are finite elements.
#[test]
fn clay_beside_drained_soil_consolidates() {
    let points = [["mpm", "mpm"]];
    let all = [["mpm", "mpm"], ["mpm", "fem"], ["fem", "mpm"], ["fem", "fem"]];
    for (around, quadrangles, kinds) in [
        (["sand", "sand"], true, &all[..]),
        (["sand", "sand"], false, &all[..2]),
        (["sand", "tight"], true, &points),
        (["tight", "sand"], false, &points),
    ] {
        for &kinds in kinds {
            let layers = Layers { around, quadrangles, kinds, ..LAYERS };
            let [pressure, settlement] = layers.end();
            let first = LOAD / (1.0 + layers.modulus() / 4.4e6);
            let rest = first * (1.0 - degree(layers.factor));
            // Of the sand half a metre above lies below its mean; a tight layer hardly gives.
            let expected = 2.0 * (LOAD - rest) / layers.modulus();
            println!("{layers:?}: {pressure:.3} of {rest:.3} kPa, {settlement:.5} of {expected:.5} m");
            assert!((pressure - rest).abs() < 0.01 * first, "{layers:?}: {pressure} {rest}");
            assert!((settlement / expected - 1.0).abs() < 0.025, "{layers:?}: {settlement} {expected}");
        }
    }
}

/// Between tight soil no water leaves.
#[test]
fn clay_between_tight_soil_keeps_its_pressure() {
    let [pressure, settlement] = Layers { around: ["tight", "tight"], ..LAYERS }.end();
    assert!((pressure / LOAD - 1.0).abs() < 2e-3 && settlement < 1e-3, "{pressure} {settlement}");
}

/// Clay that settles by two cells leaves the lines of the grid on which the drain began: the sand drains where it is. Against a grid that moves with
/// the soil, to the part of a cell that the place of the drain is known to.
#[test]
fn the_drain_moves_with_the_soil() {
    let soft = Layers { young: 350.0, factor: 1.0, ..LAYERS };
    let [pressure, settlement] = Layers { restore: "never", ..soft }.end();
    for restore in ["{min_quality: 0.5}", "every_step"] {
        let found = Layers { restore, ..soft }.end();
        println!("{restore}: {found:?} beside {pressure} {settlement}");
        assert!(found[1] > 0.2 && (found[1] / settlement - 1.0).abs() < 0.02, "{restore}: {found:?} {settlement}");
        assert!((found[0] - pressure).abs() < 0.02 * LOAD, "{restore}: {found:?} {pressure}");
    }
}
