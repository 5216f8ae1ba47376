//! Limit loads on uniform cells, of other bodies, mechanisms, strengths and stiffnesses than those of `footings` and
//! `general_position`. They are too large, by what cells of this size are too stiff, and less so on finer ones.

use crate::support::{errors, mpm};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// Uniform cells under half of a footing 2 m wide, `n` over its width.
const FOOTING: &str = r#"DefineConstant[ n = {8} ];
h = 2 / n;
Point(1) = {0, -3, 0, h};
Point(2) = {5, -3, 0, h};
Point(3) = {5, 0, 0, h};
Point(4) = {1, 0, 0, h};
Point(5) = {0, 0, 0, h};
Point(6) = {0.5, -0.8, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Point{6} In Surface{1};
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2};
Physical Curve("body") = {4};
Physical Curve("axis") = {5};
"#;

/// A quarter of a disc 1 m across in a wide soil, which grows coarser from 1.6 m on.
const PILE: &str = r#"DefineConstant[ n = {8} ];
h = 1 / n;
Point(1) = {0, 0, 0, h};
Point(2) = {0.5, 0, 0, h};
Point(3) = {0, 0.5, 0, h};
Point(4) = {1.6, 0, 0, h};
Point(5) = {0, 1.6, 0, h};
Point(6) = {5, 0, 0, 6 * h};
Point(7) = {0, 5, 0, 6 * h};
Circle(1) = {2, 1, 3};
Circle(2) = {4, 1, 5};
Circle(3) = {6, 1, 7};
Line(4) = {2, 4};
Line(5) = {4, 6};
Line(6) = {3, 5};
Line(7) = {5, 7};
Curve Loop(1) = {4, 2, -6, -1};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 3, -7, -2};
Plane Surface(2) = {2};
Physical Surface("soil") = {1, 2};
Physical Curve("axis") = {4, 5, 6, 7};
Physical Curve("far") = {3};
Physical Curve("body") = {1};
"#;

/// A vertical cut of 1 m, `n` cells over its height, in a soil that goes on by half of it below the toe.
const CUT: &str = r#"DefineConstant[ n = {8} ];
h = 1 / n;
Point(1) = {-2.5, -0.5, 0, h};
Point(2) = {1.25, -0.5, 0, h};
Point(3) = {1.25, 0, 0, h};
Point(4) = {0, 0, 0, h};
Point(5) = {0, 1, 0, h};
Point(6) = {-2.5, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 6};
Physical Curve("body") = {4};
"#;

/// Uniform cells in a block between smooth plates.
const BLOCK: &str = r#"DefineConstant[ n = {6} ];
h = 1 / n;
Point(1) = {0, 0, 0, h};
Point(2) = {1.5, 0, 0, h};
Point(3) = {1.5, 1, 0, h};
Point(4) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("body") = {3};
Physical Curve("axis") = {4};
"#;

const FOOTING_HELD: &str = "{axis: {ux: 0}, side: {ux: 0}, bottom: {ux: 0, uy: 0}}";
const ROUGH_HELD: &str = "{axis: {ux: 0}, side: {ux: 0}, bottom: {ux: 0, uy: 0}, body: {ux: 0}}";

#[derive(Clone, Copy)]
struct Case {
    geometry: &'static str,
    geo: &'static str,
    /// Cells over the body.
    cells: u32,
    supports: &'static str,
    /// E over s_u (100 kPa at y = 0), and the strength gained with depth (kPa/m).
    stiffness: f64,
    gain: f64,
    poisson: f64,
    component: char,
    /// What the body moves by (m), in 20 steps.
    travel: f64,
}

const STRIP: Case = Case {
    geometry: "plane_strain",
    geo: FOOTING,
    cells: 10,
    supports: FOOTING_HELD,
    stiffness: 1e4,
    gain: 0.0,
    poisson: 0.49,
    component: 'y',
    travel: -0.004,
};

/// Twenty steps.
const PUSH: &str = "step: {initial: 0.05, min: 1.0e-5, max: 0.05}";

impl Case {
    /// Meshes, seeds and solves in `folder`; what the program says of a phase it cannot end.
    fn solve(&self, folder: &Path, gravity: &str, loading: &str) -> Result<(), String> {
        let Self { geometry, cells, supports, gain, poisson, component, .. } = self;
        let young = 100.0 * self.stiffness;
        let case = format!(
            "title: Held out
geometry: {geometry}
mesh: {{geo: body.geo, parameters: {{n: {cells}}}}}
regions:
  soil: {{kind: mpm, material: clay, points_per_cell: 16}}
materials:
  clay: {{model: tresca, young: {young}, poisson: {poisson}, shear_strength: {{top: 100, gradient: {gain}, datum: 0}}, density: 10}}
supports: {supports}
gravity: {{y: {gravity}}}
numerics: {{restore: never}}
phases:
  - name: push
    analysis: quasi_static
    duration: 1
    {loading}
output:
  every: 1
  fields: [stress]
  history:
    - {{name: body, on: body, quantities: [u{component}, reaction_{component}]}}
"
        );
        fs::write(folder.join("case.yaml"), case).unwrap();
        fs::write(folder.join("body.geo"), self.geo).unwrap();
        for stage in ["mesh", "seed", "solve"] {
            let result = mpm(stage, folder, folder, &[]);
            let said = errors(&result);
            assert!(result.status.success() || stage == "solve", "{said}");
            if !result.status.success() {
                return Err(said);
            }
        }
        Ok(())
    }

    /// The force on the body after each step (kN) over s_u at y = 0, in absolute value.
    fn loads(&self) -> Vec<f64> {
        let folder = tempfile::tempdir().unwrap();
        let prescribed = format!("prescribe: {{body: {{u{}: {{rate: {}}}}}}}", self.component, self.travel);
        self.solve(folder.path(), "0", &format!("{PUSH}\n    {prescribed}")).unwrap();
        let history = fs::read_to_string(folder.path().join("history.csv")).unwrap();
        let force = |line: &str| line.split(',').nth(2).unwrap().parse::<f64>().unwrap();
        history.lines().skip(1).map(|line| force(line).abs() / 100.0).collect()
    }

    fn error(&self, name: &str, exact: f64) -> f64 {
        let error = self.loads().last().unwrap() / exact - 1.0;
        println!("{name}, {} cells over the body: {:+.2} %", self.cells, 100.0 * error);
        error
    }
}

/// Too strong by no more than the bound, and by less on the finer cells.
fn falls(name: &str, coarse: f64, fine: f64, bound: f64) {
    assert!(coarse < bound && fine > 0.0 && fine < 0.8 * coarse, "{name}: {coarse} {fine}");
}

/// Prandtl's 2 + π on half of a width of 2 m.
#[test]
fn strips() {
    for (name, supports) in [("smooth strip", FOOTING_HELD), ("rough strip", ROUGH_HELD)] {
        let [coarse, fine] = [6, 10].map(|cells| Case { cells, supports, ..STRIP }.error(name, 2.0 + PI));
        falls(name, coarse, fine, 0.08);
    }
}

/// A rough strip in soil with E = 500 s_u that sinks by a tenth of its width bears no less than before at any time.
#[test]
fn a_strip_that_sinks_loses_no_load() {
    let case = Case { cells: 6, stiffness: 500.0, travel: -0.2, supports: ROUGH_HELD, ..STRIP };
    let loads = case.loads();
    println!("sinking strip: {:.3?} of 2 + π", loads.iter().map(|load| load / (2.0 + PI)).collect::<Vec<_>>());
    assert_eq!(loads.len(), 20);
    assert!(loads.windows(2).all(|pair| pair[1] > pair[0]), "{loads:?}");
    assert!(loads[19] < 1.25 * (2.0 + PI), "{loads:?}");
}

/// 6.05 under a rough circle; 6.246 and 7.555 under smooth ones where s_u grows by k D/s_u0 = 1 and 4.
#[test]
fn circles() {
    for (name, supports, gain, exact, bound) in [
        ("rough circle", ROUGH_HELD, 0.0, 6.05, 0.12),
        ("smooth circle, k D/s_u0 = 1", FOOTING_HELD, 50.0, 6.246, 0.15),
        ("smooth circle, k D/s_u0 = 4", FOOTING_HELD, 200.0, 7.555, 0.2),
    ] {
        let case = Case { geometry: "axisymmetric", supports, gain, travel: -0.005, ..STRIP };
        let [coarse, fine] = [6, 8].map(|cells| Case { cells, ..case }.error(name, exact * PI));
        assert!(coarse < bound && fine > 0.0 && fine < 0.9 * coarse, "{name}: {coarse} {fine}");
    }
}

/// 2π + 4√2 on a rough disc that moves sideways (Randolph & Houlsby 1984).
#[test]
fn a_pile_pushed_sideways() {
    let supports = "{axis: {uy: 0}, far: {ux: 0, uy: 0}, body: {uy: 0}}";
    let pile = Case { geo: PILE, supports, component: 'x', travel: 0.004, poisson: 0.4999, ..STRIP };
    let exact = (2.0 * PI + 4.0 * 2f64.sqrt()) / 4.0;
    let [coarse, fine] = [8, 12].map(|cells| Case { cells, ..pile }.error("rough pile", exact));
    falls("rough pile", coarse, fine, 0.07);
}

/// A vertical cut falls at γH/s_u = 3.776 (between 3.7752 and 3.7776 by limit analysis). Gravity rises until no
/// equilibrium is found, in steps of 1 % of it or halves of that.
#[test]
fn a_vertical_cut() {
    let supports = "{side: {ux: 0}, bottom: {ux: 0, uy: 0}}";
    let folder = tempfile::tempdir().unwrap();
    let cut = Case { geo: CUT, cells: 8, supports, ..STRIP };
    let rising = "step: {initial: 0.02, min: 0.005, max: 0.02}\n    gravity: {table: [[0, 0], [0.5, 3.4], [1, 4.4]]}";
    let said = cut.solve(folder.path(), "-10", rising).unwrap_err();
    let (_, after) = said.split_once("found at the gravity factor ").unwrap_or_else(|| panic!("{said}"));
    let stands: f64 = after.split(' ').next().unwrap().parse().unwrap();
    println!("cut, {} cells over its height: stands at {stands}", cut.cells);
    assert!((3.776..3.97).contains(&stands), "{stands}");
}

/// 2 s_u on the width at the end, to rounding.
#[test]
fn a_block_between_smooth_plates() {
    let supports = "{axis: {ux: 0}, bottom: {uy: 0}}";
    let block = Case { geo: BLOCK, cells: 6, supports, travel: -0.002, ..STRIP };
    // The true stress acts on a width that grows as the height shrinks.
    let error = block.error("block", 2.0 * 1.5 / (1.0 - 0.002));
    assert!(error.abs() < 1e-6, "{error}");
}
