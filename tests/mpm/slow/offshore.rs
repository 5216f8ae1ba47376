//! Cases of the gallery in coarse variants, against their references. `make gallery` has the meshes of their README files, and more of each.

use crate::support::{column, log, safety, solve};
use std::f64::consts::PI;
use std::path::Path;

fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

/// Limit analysis has γH/s_u between 3.763 and 3.815. Cells of a tenth of the height, and a fiftieth at the toe, err by 5 %; the search is 0.0125 wide. The pipe on
/// the floor of the trench changes nothing.
#[test]
fn vertical_cuts_have_their_factor_of_safety() {
    let cut =
        "mesh.parameters={height: 5, angle: 90, base: 1, crest: 6, plain: 5, headroom: 1, h: 0.5, coarse: 2, toe: 0.2}";
    let trench = "mesh.parameters={h: 0.25, toe: 0.2, aside: 4}";
    for (case, mesh, number) in [("vertical_cut", cut, 18.0 * 5.0 / 30.0), ("trench", trench, 1.65 * 3.94 * 2.0 / 5.0)]
    {
        let folder =
            solve(format!("cases/{case}"), &[mesh, "phases.safety.step.min=0.01", "phases.failure.duration=0.02"]);
        let log = log(folder.path());
        let [held, failed] = safety(&log).map(|factor| number * factor);
        println!("{case}: {held:.3} to {failed:.3}");
        assert!(failed / held < 1.013 && failed > 3.763 && held < 3.815 * 1.06, "{case}: {held} to {failed}");
    }
}

/// Green's envelope (1954) has H/(B s_u) = 0.75 under V = 3.955 B s_u; these cells bear 5 % more.
#[test]
fn a_mudmat_slides_on_the_envelope() {
    let settings = ["mesh.parameters={h: 0.15, under: 4, coarse: 20}", "phases.push.duration=0.01"];
    let folder = solve("cases/mudmat", &settings);
    let [h, v] = ["x", "y"].map(|axis| last(folder.path(), &format!("mat.contact_{axis} [kN]")) / 30.0);
    println!("V {v:.4}, H {:.4} B s_u", -h);
    assert!((v / 3.955 - 1.0).abs() < 1e-6 && (0.75..0.75 * 1.07).contains(&-h), "{h} {v}");
}

/// 1.115 m below the level of its widest section a can bears more than a flat rough plate on the surface and less than deep in the clay, 10 to 12, with the weight of the
/// clay above that level.
#[test]
fn a_spudcan_bears_what_is_between_the_surface_and_deep_clay() {
    let settings = [
        "mesh.parameters={h: 1.5, coarse: 4, way: 4}",
        "phases.push.duration=2.5",
        "phases.push.step.max=0.25",
        "output.every=2.5",
    ];
    let folder = solve("cases/spudcan", &settings);
    let load = last(folder.path(), "can.contact_y [kN]");
    let factor = (load / (PI * 6.0 * 6.0) - 7.0 * 1.115) / 20.0;
    println!("N {factor:.3}");
    assert!((6.05..10.0).contains(&factor), "{factor}");
    assert!((last(folder.path(), "can.reaction_y [kN]") / load + 1.0).abs() < 1e-6);
}

/// Limit analysis of a solid block has V/(B s_u) between 6.18 and 6.39, upwards and downwards: skirts hold their plug.
#[test]
fn a_mat_with_skirts_bears_like_a_solid_block() {
    for rate in [-1.0, 1.0] {
        let settings = [
            "mesh.parameters={skirt: 1.5, wall: 0.15, depth: 12, aside: 24, h: 0.15, under: 4, coarse: 16}".to_owned(),
            "phases.push.duration=0.04".to_owned(),
            format!("phases.push.prescribe.mat.uy.rate={rate}"),
        ];
        let folder = solve("cases/skirted_mat", &settings.each_ref().map(String::as_str));
        let factor = -rate * last(folder.path(), "mat.contact_y [kN]") / 30.0;
        println!("V/(B s_u) {factor:.3}");
        assert!((6.18 * 0.97..6.39 * 1.03).contains(&factor), "{rate}: {factor}");
    }
}

/// As the clay beneath loses its strength the pipe sinks to where the clay bears its weight: less that of the clay in its place, one and a half times
/// because of the heave beside it (DNV-RP-F114), between the formulas of Merifield, White & Randolph (2009) for a smooth and a rough pipe.
#[test]
fn a_pipe_sinks_to_where_jetted_clay_bears_it() {
    let settings =
        ["mesh.parameters.h=0.1", "phases.jet.duration=6", "phases.jet.strength_reduction={table: [[0, 1], [6, 7]]}"];
    let folder = solve("cases/jet_trench", &settings);
    let (depth, load) = (-last(folder.path(), "pipe.uy [m]"), 2.0 * last(folder.path(), "pipe.contact_y [kN]"));
    let angle = 2.0 * (1.0 - depth / 0.2f64).acos();
    let inside = 0.5 * 0.2f64.powi(2) * (angle - angle.sin());
    let (factor, way) = ((load - 1.5 * 6.0 * inside) / (4.0 / 7.0 * 0.4), depth / 0.4);
    let [smooth, rough] = [5.66 * way.powf(0.32), 7.4 * way.powf(0.4)];
    println!("w/D {way:.3}: N {factor:.3}, {smooth:.3} to {rough:.3}");
    assert!((load / (11.06 * PI * 0.04) - 1.0).abs() < 1e-3, "{load}");
    assert!((smooth..1.03 * rough).contains(&factor), "{way} {factor}");
}
