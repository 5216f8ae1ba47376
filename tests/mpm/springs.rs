//! Springs and dashpots under curves: bodies on them against closed forms.

use crate::support::{column, errors, in_folder, project, solve, succeeds};
use std::fs;
use std::path::Path;

const COLUMN: &str = "tests/data/shaken_column";
const BEAM: &str = "tests/data/beam";

fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

#[track_caller]
fn close(found: f64, exact: f64, within: f64) {
    assert!((found / exact - 1.0).abs() < within, "{found} for {exact}");
}

/// The last value of an entry of the balance of energy.
fn energy(folder: &Path, name: &str) -> f64 {
    let text = fs::read_to_string(folder.join("energy.csv")).unwrap();
    let at = text.lines().next().unwrap().split(',').position(|column| column.starts_with(name)).unwrap();
    text.lines().last().unwrap().split(',').nth(at).unwrap().parse().unwrap()
}

/// Loads on a block go through its springs, which move by the traction over their stiffness, across and along a base of any direction; the reaction is
/// their force, and their energy is in the balance.
#[test]
fn a_block_moves_by_the_load_over_the_stiffness() {
    let springs = "supports={base: {springs: {normal: 1.0e+4, tangential: 5000}}}";
    let load = "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
        tractions: [{on: top, ty: {rate: -10}}, {on: base, tx: {rate: 4}}]}]";
    let block = ["materials.soil.poisson=0", "materials.soil.young=1.0e+6", "mesh.parameters.width=2", springs, load];
    for kind in ["mpm", "fem"] {
        let region = format!("regions.soil.kind={kind}");
        let folder = solve(COLUMN, &[&block[..], &[&region]].concat());
        let last = |name: &str| last(folder.path(), name);
        close(last("base.uy [m]"), -10.0 / 1e4, 1e-9);
        close(last("base.ux [m]"), 4.0 / 5e3, 1e-9);
        close(last("base.reaction_y [kN]"), 20.0, 1e-9);
        close(last("base.reaction_x [kN]"), -8.0, 1e-9);
        // Loads give what is stored, and half of q u and t u, per area, goes into the springs.
        let given = 0.5 * 2.0 * (10.0 * -last("top.uy [m]") + 4.0 * 8e-4);
        let in_springs = 0.5 * 2.0 * (10.0 * 1e-3 + 4.0 * 8e-4);
        close(energy(folder.path(), "supplied.loads"), given - in_springs, 1e-5);
        close(energy(folder.path(), "held.stored"), given - in_springs, 1e-4);
    }
    // On an inclined base: the traction is that of the springs, and nothing deforms.
    let load = "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 1}, tractions: [{on: base, tx: 3, ty: -5}]}]";
    let folder = solve(COLUMN, &[&block[..4], &[load, "mesh.parameters.slope=0.75"]].concat());
    let (n, t) = ([-0.6, 0.8], [0.8, 0.6]);
    let [across, along] = [n, t].map(|e: [f64; 2]| 3.0 * e[0] - 5.0 * e[1]);
    for (d, name) in ["base.ux [m]", "base.uy [m]"].into_iter().enumerate() {
        close(last(folder.path(), name), across / 1e4 * n[d] + along / 5e3 * t[d], 1e-6);
    }
}

/// On a grid that is reset the springs go on from where the soil is.
#[test]
fn springs_bear_the_weight_on_a_reset_grid() {
    let set = |restore: &str| {
        solve(
            COLUMN,
            &[
                "supports={base: {springs: {normal: 1.0e+5, tangential: 5000}}}",
                "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1}, gravity: {rate: 1}}]",
                "gravity={y: -10}",
                "materials.soil.poisson=0",
                restore,
            ],
        )
    };
    for (restore, within) in [("numerics.restore=never", 1e-9), ("numerics.restore=every_step", 1e-3)] {
        let folder = set(restore);
        close(last(folder.path(), "base.uy [m]"), -200.0 / 1e5, within);
        close(last(folder.path(), "base.reaction_y [kN]"), 200.0, within);
    }
}

/// A rigid block that is let go: its swing by the spring, and by the dashpot beside it; its free end the dashpot alone.
#[test]
fn a_block_swings_on_its_spring_and_dashpot() {
    let (k, m, g) = (1e4f64, 2.0f64, 10.0);
    for c in [0.0, 60.0] {
        let dashpots = if c > 0.0 { format!(", dashpots: {{normal: {c}}}") } else { String::new() };
        let supports =
            format!("supports={{left: {{ux: 0}}, right: {{ux: 0}}, base: {{springs: {{normal: {k}}}{dashpots}}}}}");
        let errors = [0.002, 0.001].map(|step| {
            let phases =
                format!("phases=[{{name: free, analysis: dynamic, duration: 0.2, step: {{initial: {step}}}}}]");
            let rigid = ["materials.soil.young=1.0e+10", "materials.soil.poisson=0", "mesh.parameters.height=1"];
            let folder = solve(COLUMN, &[&rigid[..], &[&supports, &phases, "gravity={y: -10}"]].concat());
            let (time, found) = (column(folder.path(), "time [s]"), column(folder.path(), "base.uy [m]"));
            let (w, z) = ((k / m).sqrt(), c / (2.0 * (k * m).sqrt()));
            let damped = w * (1.0 - z * z).sqrt();
            let exact = |t: f64| {
                let swing = (damped * t).cos() + z * w / damped * (damped * t).sin();
                -m * g / k * (1.0 - (-z * w * t).exp() * swing)
            };
            let off = time.iter().zip(&found).map(|(t, u)| (u - exact(*t)).abs()).fold(0.0, f64::max);
            off / (m * g / k)
        });
        assert!(errors[1] < 6e-3 && errors[0] / errors[1] > 3.5, "c = {c}: {errors:?}");
    }
}

/// A beam of any length on an elastic foundation under a force in its middle: Hetényi (1946), art. 14.
#[test]
fn a_beam_on_springs_bends_as_hetenyi_has_it() {
    let (k, ei, p, l) = (1e4f64, 1e4f64, 0.1, 10.0);
    let set = [
        "supports={beam_left: {springs: {normal: 1.0e+4}}, root: {ux: 0}}",
        "regions.beam.plate.EA=3.0e+7",
        "regions.beam.plate.size=0.25",
        "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 1}, gravity: 0, tractions: [{on: middle, fy: -0.1}]}]",
    ];
    let folder = solve(BEAM, &set);
    let lambda = (k / (4.0 * ei)).powf(0.25);
    let x = lambda * l;
    let sum = x.sinh() + x.sin();
    close(last(folder.path(), "middle.uy [m]"), -p * lambda / (2.0 * k) * (2.0 + x.cosh() + x.cos()) / sum, 2e-3);
    let moment = p / (4.0 * lambda) * (x.cosh() - x.cos()) / sum;
    close(last(folder.path(), "beam.bending_moment [kN m/m]"), moment, 5e-3);
}

/// Given dashpots of the impedance of the soil are those of an absorbing curve.
#[test]
fn given_dashpots_absorb() {
    let wave = "tests/data/wave_column";
    // ρ c of the column: c_s = 100 m/s, c_p = √3 c_s.
    let given = format!("supports.bottom={{uy: 0, dashpots: {{normal: {}, tangential: 200}}}}", 200.0 * 3f64.sqrt());
    let [absorbs, dashpots] = [&[][..], &[given.as_str()]].map(|set| {
        let folder = solve(wave, set);
        last(folder.path(), "top.ux [m]")
    });
    close(dashpots, absorbs, 1e-9);
}

/// A direction with a dashpot and no spring is held while there is no inertia, and what held it stays.
#[test]
fn a_dashpot_without_a_spring_is_held_without_inertia() {
    let free = [
        "supports={base: {springs: {tangential: 5000}, dashpots: {normal: 30}}}",
        "phases=[{name: weight, analysis: quasi_static, duration: 1, step: {initial: 0.5}, gravity: {rate: 1}}, \
          {name: still, analysis: dynamic, duration: 0.05, step: {initial: 0.01}}]",
        "gravity={y: -10}",
    ];
    let folder = solve(COLUMN, &free);
    let of = |name: &str| column(folder.path(), name);
    assert!(of("base.uy [m]").iter().all(|u| u.abs() < 1e-12), "{:?}", of("base.uy [m]"));
    let top = of("top.uy [m]");
    assert!(top.last().unwrap() < &-1e-3 && (top[1] / top.last().unwrap() - 1.0).abs() < 1e-9, "{top:?}");
}

/// The last step done again from the checkpoint before it gives the same bytes.
#[test]
fn a_run_on_springs_resumes_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "supports={left: {tied: right}, base: {springs: {normal: 1.0e+4, tangential: 5000}, dashpots: {normal: 30}}}",
        "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.5}, gravity: {rate: 1}}, \
          {name: free, analysis: dynamic, duration: 0.05, step: {initial: 0.01}, tractions: [{on: top, tx: {rate: 10}}]}]",
        "gravity={y: -10}",
    ];
    for stage in ["mesh", "seed", "solve"] {
        succeeds(&crate::support::mpm(stage, COLUMN, folder.path(), &set));
    }
    let rows = || fs::read(folder.path().join("history.csv")).unwrap();
    let before = rows();
    let mut steps: Vec<_> =
        fs::read_dir(folder.path().join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect();
    steps.sort();
    fs::remove_file(steps.last().unwrap()).unwrap();
    let mut again = crate::support::stage("solve", COLUMN, folder.path(), &set);
    succeeds(&again.arg("--resume").output().unwrap());
    assert!(before == rows());
}

#[test]
fn springs_that_cannot_act_are_refused() {
    let springs = "springs: {normal: 1000}";
    for (set, says) in [
        (vec!["supports.base={springs: {}}".to_owned()], "both are 0"),
        (vec![format!("supports.base={{ux: 0, uy: 0, {springs}}}")], "a curve that is held does not move"),
        (vec![format!("supports.base={{{springs}}}")], "prescribes the displacement of `base`"),
        (vec![format!("supports.soil={{{springs}}}")], "under a physical curve"),
        (
            vec![format!("supports.top={{absorbing: true, dashpots: {{normal: 1}}, {springs}}}")],
            "`dashpots` are given as well",
        ),
        (
            vec!["supports={top: {dashpots: {normal: 1}}}".into(), "mesh.parameters.slope=0.5".into()],
            "the curve is inclined",
        ),
    ] {
        let set: Vec<&str> = set.iter().flat_map(|entry| ["--set", entry]).collect();
        let output = errors(&in_folder(&project(""), &[&["check", COLUMN][..], &set].concat()));
        assert!(output.contains(says), "{set:?}: {output}");
    }
}
