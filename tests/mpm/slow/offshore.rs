//! Cases of the gallery in coarse variants, against their references. `make gallery` has the meshes of their README files, and more of each.

use crate::support::{column, solve};
use std::f64::consts::PI;
use std::fs;
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
        let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
        let line = log.lines().find(|line| line.starts_with("factor of safety")).unwrap_or_else(|| panic!("{log}"));
        let words: Vec<&str> = line.split(' ').collect();
        let [held, failed] = [words[3], words[5]].map(|word| number * word.parse::<f64>().unwrap());
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
