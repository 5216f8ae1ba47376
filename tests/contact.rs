//! Structures on soil, from the case to the results: forces against closed forms.

use mpm::io::frame::{FACES, Frame, LINE};
use std::path::Path;
use std::process::Command;

/// Runs a case with overrides and returns its folder.
fn run(case: &str, overrides: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
    command.arg("run").arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(case)).arg("-o").arg(folder.path());
    for entry in overrides {
        command.args(["--set", entry]);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{case} {overrides:?}: {}", String::from_utf8_lossy(&output.stderr));
    folder
}

/// The history: rows of numbers.
fn history(folder: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join("history.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

/// Confined soil under a plate with an unrelated mesh is strained evenly: Hencky elasticity, `σ = M ln λ / λ`, the
/// confined modulus M, and no point differs.
#[test]
fn a_plate_hands_on_a_uniform_pressure() {
    let folder = run("tests/data/plate", &[]);
    let force = history(folder.path()).last().unwrap()[4];
    let (young, poisson, stretch) = (1000.0, 0.3, 0.9f64);
    let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let stress = modulus * stretch.ln() / stretch;
    assert!((force / (-2.0 * stress) - 1.0).abs() < 1e-3, "{force} {}", -2.0 * stress);
    let frame = Frame::read(&folder.path().join("results/frame-000001.mpmf")).unwrap();
    let column = frame.points.columns.iter().find(|c| c.name == "stress").unwrap();
    for sigma in column.values.chunks_exact(6) {
        assert!((sigma[1] / (-0.5 * force) - 1.0).abs() < 1e-3, "{sigma:?} {force}");
    }
}

/// The same with a load in place of a displacement, from the first step on: a plate that touches, and does not press yet, is held by the
/// soil that it lies on.
#[test]
fn a_plate_laid_on_soil_bears_a_load() {
    let load = 150.0;
    let phase = "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1}, \
                  tractions: [{on: top, ty: -150}], prescribe: {top: {ux: 0}}}]";
    let folder = run("tests/data/plate", &[phase]);
    let last = history(folder.path()).pop().unwrap();
    let (young, poisson) = (1000.0, 0.3);
    let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let balance = |stretch: f64| modulus * stretch.ln() / stretch + load;
    let (mut low, mut high) = (0.5, 1.0);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        *(if balance(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    assert!((last[4] / (2.0 * load) - 1.0).abs() < 1e-9, "{last:?}");
    assert!((last[2] / (low - 1.0) - 1.0).abs() < 1e-3, "{last:?}, {}", low - 1.0);
}

/// A free body with friction alone, laid on the soil or a little above it: nothing presses yet, and still it is held along the soil, too.
#[test]
fn a_free_body_with_friction_is_laid_on_soil() {
    for gap in [0.0, 5e-4, 2e-3] {
        let overrides = [
            &format!("mesh.parameters={{gap: {gap}}}"),
            "materials.clay={model: linear_elastic, young: 1000, poisson: 0.2, density: 0}",
            "materials.steel.density=20",
            "gravity={y: -10}",
            "drained_surface=null",
            "contacts[0].friction=0.3",
            "phases=[{name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}}]",
            "output={history: [{name: strip, on: strip, quantities: [ux, uy, contact_x, contact_y]}]}",
        ];
        let folder = run("tests/data/strip", &overrides);
        let last = history(folder.path()).pop().unwrap();
        println!("gap of {gap} m: {last:?}");
        // 20 t/m³ of 1 m by 0.2 m.
        assert!(last[3].abs() < 1e-6 && (last[4] / 40.0 - 1.0).abs() < 1e-6, "{last:?}");
        let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
        assert!(!log.contains("halved"), "{log}");
    }
}

/// A strip pressed into clay and dragged along is held by `α` times the shear strength, which is `σ_y/√3` by von Mises.
#[test]
fn adhesion_is_a_share_of_the_shear_strength() {
    for (clay, strength) in [
        ("{model: tresca, young: 1000, poisson: 0.49, shear_strength: 5, density: 0}", 5.0),
        ("{model: von_mises, young: 1000, poisson: 0.49, yield_stress: 10, density: 0}", 10.0 / 3f64.sqrt()),
    ] {
        let material = format!("materials.clay={clay}");
        let overrides = [
            material.as_str(),
            "drained_surface=null",
            "contacts[0].adhesion_factor=0.4",
            "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
              prescribe: {strip: {ux: 0, rotation: 0, uy: {rate: -0.002}}}}, \
              {name: drag, analysis: quasi_static, duration: 1, step: {initial: 0.1}, \
              prescribe: {strip: {ux: {rate: 0.03}, rotation: 0, uy: 0}}}]",
            "output={history: [{name: strip, on: strip, quantities: [ux, contact_x]}]}",
        ];
        let folder = run("tests/data/strip", &overrides);
        let force = -history(folder.path()).pop().unwrap()[2];
        println!("{force} of {}", 0.4 * strength);
        assert!((force / (0.4 * strength) - 1.0).abs() < 6e-3, "{force} {strength}");
    }
}

/// Clay that a plate has consolidated along its virgin line adheres with the strength that it has come to.
#[test]
fn adhesion_grows_as_clay_hardens() {
    let overrides = [
        "materials.soil={model: cam_clay, young: 1000, poisson: 0.3, critical_slope: 1, preconsolidation: 20, \
          plastic_compressibility: 0.1, density: 0}",
        "contacts[0].adhesion_factor=0.3",
        "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.05}, \
          prescribe: {top: {ux: 0, uy: {rate: -0.1}}}}, \
          {name: drag, analysis: quasi_static, duration: 1, step: {initial: 0.1}, \
          prescribe: {top: {ux: {rate: 0.05}, uy: 0}}}]",
    ];
    let folder = run("tests/data/plate", &overrides);
    let force = -history(folder.path()).pop().unwrap()[3];
    // On the yield surface p_c is p + q²/(M² p), of the Kirchhoff stress that is 0.9 times the Cauchy stress.
    let frame = Frame::read(&folder.path().join("results/frame-000001.mpmf")).unwrap();
    let column = frame.points.columns.iter().find(|c| c.name == "stress").unwrap();
    let size = |s: &[f64]| {
        let (p, q) = (-0.9 * (s[0] + s[1] + s[2]) / 3.0, 0.9 * (s[0] - s[1]).abs());
        p + q * q / p
    };
    let sizes: Vec<f64> = column.values.chunks_exact(6).map(size).collect();
    let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
    let wanted = 2.0 * 0.3 * mean / (2.0 * 3f64.sqrt());
    println!("p_c {mean} kPa, at first 20; {force} of {wanted} kN");
    assert!(mean > 30.0 && (force / wanted - 1.0).abs() < 3e-2, "{mean} {force} {wanted}");
}

/// A plate near the limit of what clay bears, laid on it at once: the step fails, and halves of it bear a half. It
/// ends where a load that grows does.
#[test]
fn what_cannot_be_borne_at_once_is_released_by_halved_steps() {
    let with = |load: &str, step: f64, more: &str| {
        let phase = format!(
            "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: {step}, max: {step}}}, \
             tractions: [{{on: top, ty: {load}}}], prescribe: {{top: {{ux: 0}}}}{more}}}]"
        );
        let clay =
            "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 0}".to_string();
        let plate = ["plate=0.8", "left=0.6", "edge=0.05"].map(|entry| format!("mesh.parameters.{entry}"));
        let overrides: Vec<String> = plate.into_iter().chain([clay, phase]).collect();
        let folder = run("tests/data/plate", &overrides.iter().map(String::as_str).collect::<Vec<_>>());
        let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
        (history(folder.path()).pop().unwrap(), log)
    };
    let (at_once, log) = with("-46", 1.0, "");
    let (grown, _) = with("{rate: -46}", 0.05, "");
    println!("{at_once:?}, grown {grown:?}");
    assert!(log.contains("halved") && log.contains("held back"), "{log}");
    assert!((at_once[4] / (0.8 * 46.0) - 1.0).abs() < 1e-6, "{at_once:?}");
    assert!((at_once[2] / grown[2] - 1.0).abs() < 0.1, "{at_once:?} {grown:?}");
    // What ends before all is released says so.
    let (_, log) = with("-46", 1.0, ", until: [{of: plate, quantity: uy, below: -0.002}]");
    assert!(
        log.contains("% of what was out of balance as it began, up to") && log.contains("is not released\n"),
        "{log}"
    );
}

/// A load that clay bears stays where it is through a hundred restorations of the grid, and moves little near what the clay bears.
#[test]
fn a_load_is_held_while_the_grid_is_restored() {
    let settled = |load: f64, hold: f64| {
        let to =
            format!("prescribe: {{top: {{ux: 0}}}}, tractions: [{{on: top, ty: {{table: [[0, 0], [1, {load}]]}}}}]");
        let at = format!("prescribe: {{top: {{ux: 0}}}}, tractions: [{{on: top, ty: {load}}}]");
        let phases = format!(
            "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.1, max: 0.1}}, {to}}}, \
             {{name: hold, analysis: quasi_static, duration: {hold}, step: {{initial: 1, max: 1}}, {at}}}]"
        );
        let overrides = [
            "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
            "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 0}",
            "numerics.restore=every_step",
            &phases,
        ];
        let folder = run("tests/data/plate", &overrides);
        let rows = history(folder.path());
        let loaded = rows.iter().rfind(|row| row[0] <= 1.0 + 1e-9).unwrap()[2];
        let last = rows.last().unwrap();
        println!("{load}: {loaded} -> {} at {} s", last[2], last[0]);
        assert!((last[0] - 1.0 - hold).abs() < 1e-9, "{}", last[0]);
        (loaded, last[2], std::fs::read_to_string(folder.path().join("solve.log")).unwrap())
    };
    for (load, most) in [(-36.0, 0.01), (-45.45, 0.01), (-46.0, 0.03)] {
        let (loaded, held, log) = settled(load, 100.0);
        assert!((held / loaded - 1.0).abs() < most && !log.contains("no balance"), "{load}: {loaded} {held}");
    }
}

/// The same on soil that presses on a wall already: what presses elsewhere is nothing to the plate.
#[test]
fn a_plate_is_laid_on_soil_that_rests_on_a_wall() {
    let overrides = [
        "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
        "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 1}",
        "contacts=[{structure: plate, soil: soil}, {wall: bottom, soil: soil}]",
        "supports={side: {ux: 0}}",
        "gravity={y: -9.81}",
        "initial_stress={k0: 0.96}",
        "phases=[{name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}, deactivate: [plate]}, \
         {name: load, analysis: quasi_static, duration: 1, step: {initial: 1}, activate: [plate], \
         tractions: [{on: top, ty: -46}], prescribe: {top: {ux: 0}}}]",
        "output.history=[{name: plate, on: plate, quantities: [uy, contact_y]}, {name: bottom, on: bottom, quantities: [contact_y]}]",
    ];
    let last = history(run("tests/data/plate", &overrides).path()).pop().unwrap();
    println!("{last:?}");
    let (load, weight) = (0.8 * 46.0, 2.0 * 9.81);
    assert!((last[2] / load - 1.0).abs() < 1e-6 && (last[3] / -(load + weight) - 1.0).abs() < 1e-3, "{last:?}");
}

/// The same pressure stands along the base of the plate, adds up to the force, and leaves the other sides free. Where there
/// is no soil the gap is not known, and along the base it is closed.
#[test]
fn pressure_is_shown_along_the_boundary() {
    let folder = run("tests/data/plate", &[]);
    let force = history(folder.path()).last().unwrap()[4];
    let contact = Frame::read(&folder.path().join("results/frame-000001.mpmf")).unwrap().contact;
    let column = |name: &str| &contact.columns.iter().find(|c| c.name == name).unwrap().values;
    let (pressure, gap, line, faces) = (column("contact_pressure"), column("contact_gap"), column(LINE), column(FACES));
    let (mut sum, mut most, mut length) = (0.0, 0.0f64, 0.0);
    for i in (1..line.len()).filter(|&i| line[i] == line[i - 1]) {
        let [a, b] = [i - 1, i].map(|i| contact.position[i]);
        let on_base = faces[i] == 1.0;
        assert_eq!(on_base, (a[1] - b[1]).abs() < 1e-6 && a[1] < 0.0, "{a:?} {b:?}");
        if on_base {
            sum += 0.5 * (pressure[i - 1] + pressure[i]) * (b[0] - a[0]);
            length += b[0] - a[0];
            most = most.max((pressure[i] / (0.5 * force) - 1.0).abs());
            assert!(gap[i].abs() < 1e-4, "{}", gap[i]);
        } else {
            assert_eq!(pressure[i], 0.0);
        }
    }
    println!("pressure off its mean by up to {most:.4}, in all by {:.1e}", sum / force - 1.0);
    assert!((length - 2.0).abs() < 1e-6 && (sum / force - 1.0).abs() < 1e-3, "{length} {sum} {force}");
    assert!(most < 0.015, "{most}");
    let text = std::fs::read_to_string(folder.path().join("contact.pvd")).unwrap();
    assert_eq!(text.matches("vtu/contact_").count(), 2);
}

/// Along a round bar, which soil flows past, the traction adds up to the force of the history.
#[test]
fn traction_adds_up_to_the_force() {
    let overrides = ["mesh.parameters={h: 0.25}", "phases[0].duration=0.3", "output.every=0.1"];
    let folder = run("cases/tbar", &overrides);
    let rows = history(folder.path());
    for number in 1..=3 {
        let frame = Frame::read(&folder.path().join(format!("results/frame-{number:06}.mpmf"))).unwrap();
        let column = |name: &str| &frame.contact.columns.iter().find(|c| c.name == name).unwrap().values;
        let (traction, line) = (column("contact_traction"), column(LINE));
        let mut sum = [0.0; 2];
        for i in (1..line.len()).filter(|&i| line[i] == line[i - 1]) {
            let [a, b] = [i - 1, i].map(|i| frame.contact.position[i]);
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            (0..2).for_each(|d| sum[d] += 0.5 * length * (traction[3 * i - 3 + d] + traction[3 * i + d]));
        }
        let row = rows.iter().find(|row| (row[0] - frame.time).abs() < 1e-9).unwrap();
        println!("{sum:?} kN of {:?} at {} s", &row[3..5], frame.time);
        assert!(row[4] > 1.0 && (0..2).all(|d| (sum[d] - row[3 + d]).abs() < 1e-9 * row[4]), "{sum:?} {row:?}");
    }
}

/// A plate that reaches beyond the soil has the force in the middle of the soil, and so a moment about its own middle.
#[test]
fn the_moment_is_about_the_centroid() {
    let history_of = "output.history=[{name: plate, on: plate, quantities: [contact_x, contact_y, contact_moment]}]";
    for rigid in ["regions.plate.rigid=false", "regions.plate.rigid=true"] {
        let folder = run("tests/data/plate", &[history_of, "mesh.parameters={plate: 2.6, hp: 0.13}", rigid]);
        let row = history(folder.path()).pop().unwrap();
        let arm = row[3] / row[2];
        println!("arm {arm:.5} of -0.3 m");
        assert!((arm / -0.3 - 1.0).abs() < 0.01 && row[1].abs() < 1e-3 * row[2], "{row:?}");
        let text = std::fs::read_to_string(folder.path().join("history.csv")).unwrap();
        assert!(
            text.starts_with("time [s],plate.contact_x [kN],plate.contact_y [kN],plate.contact_moment [kN m]\n"),
            "{text}"
        );
    }
}

const LIFT: &str = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.1}, \
    prescribe: {top: {ux: 0, uy: {rate: -0.05}}}}, {name: lift, analysis: quasi_static, duration: 1, \
    step: {initial: 0.1}, prescribe: {top: {ux: 0, uy: {rate: 0.2}}}}]";

/// A plate that is pulled off soil it cannot part from stretches it evenly: `σ = M ln λ / λ`, with λ above one.
#[test]
fn a_plate_that_cannot_part_pulls_the_soil() {
    let upwards = "phases[0].prescribe.top.uy={rate: 0.1}";
    let folder = run("tests/data/plate", &["contacts[0].tension=no_separation", upwards]);
    let force = history(folder.path()).last().unwrap()[4];
    let (young, poisson, stretch) = (1000.0, 0.3, 1.1f64);
    let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let stress = modulus * stretch.ln() / stretch;
    println!("force {force:.3} of {:.3} kN", -2.0 * stress);
    assert!((force / (-2.0 * stress) - 1.0).abs() < 1e-3, "{force} {}", -2.0 * stress);
}

/// Where a tension has a limit, the plate pulls with what the soil is strained by up to that, and with nothing from the step after that in
/// which it comes to it.
#[test]
fn a_plate_parts_where_the_tension_exceeds_its_limit() {
    let upwards = "phases[0].prescribe.top.uy={rate: 0.1}";
    let folder = run("tests/data/plate", &["contacts[0].tension={limit: 50}", upwards]);
    let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
    let (mut pulled, mut parted) = (0, 0);
    for row in history(folder.path()).iter().filter(|row| row[2] > 0.0) {
        let stretch = 1.0 + row[2];
        let stress = modulus * stretch.ln() / stretch;
        println!("stretched by {:.3}: {:.3} kN, bonded {:.3}", stretch, row[4], -2.0 * stress);
        if stress < 50.0 {
            // Of the force at the limit.
            assert!((row[4] + 2.0 * stress).abs() < 1e-3 * 100.0, "{row:?} {stress}");
            pulled += 1;
        } else {
            let left = if parted == 0 { -100.0 } else { 0.0 };
            assert!((row[4] - left).abs() < 1e-6, "{row:?} {stress}");
            parted += 1;
        }
    }
    assert!(pulled >= 3 && parted >= 3, "{pulled} {parted}");
}

/// One that can part leaves the soil, with adhesion too: no force and no stress stay behind.
#[test]
fn a_plate_lifts_off_and_nothing_sticks() {
    for adhesion in ["contacts[0].adhesion=0", "contacts[0].adhesion=5"] {
        let folder = run("tests/data/plate", &[LIFT, adhesion]);
        let rows = history(folder.path());
        let pressed = rows.iter().map(|row| row[4]).fold(0.0, f64::max);
        assert!(pressed > 100.0, "{pressed}");
        for row in rows.iter().filter(|row| row[2] > 0.0) {
            assert_eq!(row[3..5], [0.0, 0.0], "{row:?}");
        }
        let frame = Frame::read(&folder.path().join("results/frame-000002.mpmf")).unwrap();
        let stress = &frame.points.columns.iter().find(|c| c.name == "stress").unwrap().values;
        let most = stress.iter().fold(0.0f64, |most, s| most.max(s.abs()));
        println!("pressed with {pressed:.1} kN, lifted with a stress of {most:.1e} kPa in the soil");
        assert!(most < 1e-7 * pressed, "{most}");
    }
}

/// Presses the plate down by 5 cm and slides it by `way` (m): how much its shear is off `limit` (kPa) times the length on soil
/// in the second half of the way (-).
fn slide(limit: f64, way: f64, overrides: &[&str]) -> Vec<f64> {
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, \
        prescribe: {{top: {{ux: 0, uy: {{rate: -0.05}}}}}}}}, {{name: slide, analysis: quasi_static, duration: 1, \
        step: {{initial: 0.1}}, prescribe: {{top: {{ux: {{rate: {way}}}, uy: 0}}}}}}]"
    );
    let mut all = overrides.to_vec();
    all.push(&phases);
    let folder = run("tests/data/plate", &all);
    let rows = history(folder.path());
    rows.iter().filter(|row| row[0] > 1.45).map(|row| -row[3] / (limit * (2.0 - row[1])) - 1.0).collect()
}

/// Where a plate slides, its shear is the limit over the length L that is on soil: `∫τ = α s_u L` on clay, `c_a L` on elastic
/// soil. It slides off one end of the soil by what it comes to lie beyond the other, less than a contact node.
#[test]
fn a_plate_that_slides_is_held_by_adhesion() {
    let clay = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 30, density: 0}";
    let bonded = "contacts[0].tension=no_separation";
    for (limit, way, overrides) in [
        (3.0, 0.01, &[clay, "contacts[0].adhesion_factor=0.1"][..]),
        (3.0, 0.01, &[clay, "contacts[0].adhesion_factor=0.1", "contacts[0].adhesion=50"]),
        (2.0, 0.01, &["contacts[0].adhesion=2"]),
        (2.0, 0.06, &["contacts[0].adhesion=2", bonded]),
        (3.0, 0.06, &[clay, "contacts[0].adhesion_factor=0.1", bonded]),
    ] {
        let off = slide(limit, way, overrides);
        println!("{overrides:?}: shear off by {off:.4?}");
        assert!(off.len() >= 5 && off.iter().all(|off| off.abs() < 0.01), "{overrides:?}: {off:?}");
    }
}

/// On a longer way, where it may part from the soil, too.
#[test]
fn a_plate_that_slides_on_is_held_by_adhesion() {
    let off = slide(2.0, 0.06, &["contacts[0].adhesion=2"]);
    println!("shear off by {off:.4?}");
    assert!(off.len() >= 5 && off.iter().all(|off| off.abs() < 0.01), "{off:?}");
}

/// A plate that slides along soil it is pressed into keeps its normal force to one per cent while it crosses ten cells, and
/// nothing holds it back: it is smooth and the soil elastic.
fn keeps_its_normal_force(depth: f64, rate: f64, left: f64, overrides: &[&str]) {
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, \
        prescribe: {{top: {{ux: 0, uy: {{rate: -{depth}}}}}}}}}, {{name: slide, analysis: quasi_static, duration: 2, \
        step: {{initial: 0.01}}, prescribe: {{top: {{ux: {{rate: {rate}}}, uy: 0}}}}}}]"
    );
    let mesh = format!("mesh.parameters={{width: 8, plate: 1, left: {left}, edge: 0.1, depth: 1.5, h: 0.2, hp: 0.12}}");
    let folder = run("tests/data/plate", &[&[phases.as_str(), mesh.as_str()], overrides].concat());
    let rows = history(folder.path());
    let pressed = rows.iter().rfind(|row| row[0] < 1.0 + 1e-9).unwrap()[4];
    let sliding = || rows.iter().filter(|row| row[0] > 1.0 + 1e-9);
    let off: Vec<f64> = sliding().map(|row| row[4] / pressed - 1.0).collect();
    let drag = sliding().map(|row| (row[3] / row[4]).abs()).fold(0.0, f64::max);
    let ends = [off.iter().copied().fold(0.0, f64::min), off.iter().copied().fold(0.0, f64::max)];
    println!("normal force {:+.4} to {:+.4} of that before, held back by at most {drag:.1e} of it", ends[0], ends[1]);
    // On the round edges the normal turns with soil that follows them only in part.
    assert!(off.len() >= 200 && drag < 3e-3 && ends.iter().all(|end| end.abs() < 0.01), "{ends:?} {drag}");
}

#[test]
fn a_plate_that_slides_keeps_its_normal_force() {
    keeps_its_normal_force(0.02, 1.0, 2.5, &[]);
}

/// The other way on another soil.
#[test]
fn a_plate_that_slides_back_keeps_its_normal_force() {
    keeps_its_normal_force(0.015, -1.0, 4.5, &["materials.soil.poisson=0.1", "materials.soil.young=20000"]);
}

/// A plate that slides over clay under 45 % of its bearing capacity, three cells far, is held by half the strength along its length.
#[test]
fn a_loaded_plate_slides_over_clay() {
    let load = 0.45 * (2.0 + std::f64::consts::PI);
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, \
        prescribe: {{plate: {{ux: 0, rotation: 0, uy: {{rate: -0.0055}}}}}}}}, \
        {{name: slide, analysis: quasi_static, duration: 0.6, step: {{initial: 0.002, max: 0.02}}, \
        tractions: [{{on: top, tx: 0, ty: {}}}], prescribe: {{plate: {{ux: {{rate: 1}}, rotation: 0}}}}}}]",
        -load
    );
    let folder = run(
        "tests/data/plate",
        &[
            "mesh.parameters={width: 10, plate: 2, left: 3.7, depth: 4, h: 0.2, hp: 0.2}",
            "regions.plate.rigid=true",
            "contacts[0].adhesion_factor=0.5",
            "materials.soil={model: tresca, young: 500, poisson: 0.49, shear_strength: 1, density: 0}",
            "supports.bottom={ux: 0, uy: 0}",
            &phases,
        ],
    );
    let rows = history(folder.path());
    // It sticks in the first step.
    let sliding: Vec<&Vec<f64>> = rows.iter().filter(|row| row[0] > 1.004).collect();
    let shear: Vec<f64> = sliding.iter().map(|row| -row[3] / (0.5 * 2.0)).collect();
    let mean = shear.iter().sum::<f64>() / shear.len() as f64;
    let ripple = (shear.iter().map(|s| (s / mean - 1.0).powi(2)).sum::<f64>() / shear.len() as f64).sqrt();
    let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let after = |line: &str| line.split(' ').skip_while(|w| *w != "iterations").nth(1).and_then(|n| n.parse().ok());
    let iterations: Vec<usize> = log.lines().filter_map(after).collect();
    let most = iterations.iter().copied().max().unwrap();
    println!("shear over α s_u L {shear:.3?}, ripple {ripple:.4}, iterations {iterations:?}");
    assert!(
        shear.len() >= 30
            && iterations.len() == rows.len()
            && shear.iter().all(|s| (s - 1.0).abs() < 0.03)
            && ripple < 0.02,
        "{shear:?}"
    );
    assert!(most <= 10 && sliding.iter().all(|row| (row[4] / (2.0 * load) - 1.0).abs() < 1e-6), "{iterations:?}");
}

/// A block slides down with `g (sin θ − tan δ cos θ)` where that is positive …
#[test]
fn a_block_slides_down_an_incline() {
    let folder = run("cases/incline", &["phases[0].duration=0.6"]);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let way = 0.5 * 9.81 * (sin - 0.2 * cos) * 0.6f64.powi(2);
    let rows = history(folder.path());
    let row = rows.last().unwrap();
    let (along, across) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
    println!("way {along:.5} of {way:.5} m, lifted by {across:.5} m");
    assert!((along / way - 1.0).abs() < 0.01, "{along} {way}");
    // Cells are 0.25 m wide.
    assert!(across.abs() < 0.001 * 0.25, "{across}");
}

/// … and rests where it is not, once it has settled.
#[test]
fn a_block_rests_on_an_incline() {
    let overrides = ["contacts[0].friction=0.37", "numerics.spectral_radius=0.5", "phases[0].duration=0.8"];
    let folder = run("cases/incline", &overrides);
    let rows = history(folder.path());
    let at = |time: f64| rows.iter().find(|row| row[0] > time - 1e-9).unwrap()[1];
    let free = 0.5 * 9.81 * 20f64.to_radians().sin() * 0.8f64.powi(2);
    assert!((at(0.8) - at(0.6)).abs() < 1e-6 * free, "{} {}", at(0.6), at(0.8));
}

/// The head of a pile bears what the soil exerts on it, and in the first centimetres that is the limit load of a circular
/// footing, between smooth (5.69 s_u) and rough (6.05 s_u), with what it gains with depth and errs by in coarse cells.
#[test]
fn a_pile_finds_its_bearing_capacity() {
    let folder = run("cases/pile", &["phases.push.duration=0.1"]);
    let rows = history(folder.path());
    for row in &rows {
        assert!((row[2] + row[4]).abs() < 1e-6 * row[2].abs().max(1e-3), "{row:?}");
    }
    let pressure = rows.last().unwrap()[2] / (std::f64::consts::PI * 0.5f64.powi(2)) / 0.5;
    assert!((5.69..1.1 * 6.05).contains(&pressure), "{pressure}");
}

/// Holds the forces in two columns in the end against each other.
fn shear_over_pressure(name: &str, folder: &Path, columns: [usize; 2], wanted: f64) {
    let last = history(folder).pop().unwrap();
    let [shear, pressure] = columns.map(|column| last[column]);
    let ratio = (shear / pressure).abs();
    println!("{name}: shear over pressure {ratio:.5} of {wanted:.5}");
    assert!((ratio / wanted - 1.0).abs() < 0.01, "{name}: {last:?}");
}

/// A plate on confined clay that cannot drain at once: the water bears what it is stiffer by than the grains, and of the pressure friction
/// has the grains' part alone, M′/(M′ + K_w/n). Once the water has left it has all.
#[test]
fn friction_takes_the_pressure_of_the_grains() {
    let (young, poisson, undrained) = (1000.0, 0.2, 0.45);
    let bulk = |nu: f64| 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + poisson));
    let confined = (bulk(poisson) + 4.0 / 3.0) * shear;
    let share = confined / (confined + (bulk(undrained) - bulk(poisson)) * shear);
    let material = |more: &str| {
        format!(
            "materials.soil={{model: linear_elastic, young: {young}, poisson: {poisson}, density: 0, drainage: undrained, \
             undrained_poisson: {undrained}{more}}}"
        )
    };
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, prescribe: {top: {ux: 0, uy: {rate: -0.002}}}}";
    let slide = |seconds: f64| {
        let [ux, step] = [0.004 / seconds, 0.5 * seconds];
        format!("duration: {seconds}, step: {{initial: {step}}}, prescribe: {{top: {{ux: {{rate: {ux}}}, uy: 0}}}}}}")
    };
    let wait = "{name: wait, analysis: consolidation, duration: 1.0e+5, step: {initial: 1.0e+4}, prescribe: {top: {ux: 0, uy: 0}}}";
    let flowing = material(", permeability: 1.0e-6");
    let held = "supports={bottom: {uy: 0, pore_pressure: 0}, side: {ux: 0}}";
    let first = format!("phases=[{press}, {{name: slide, analysis: quasi_static, {}]", slide(1.0));
    let later = format!("phases=[{press}, {wait}, {{name: slide, analysis: consolidation, {}]", slide(1e5));
    let friction = "contacts[0].friction=0.2";
    for (name, overrides, grains) in [
        ("share of a field", &[&material("")[..], &first, friction][..], share),
        ("field of its own", &[&flowing, &first, friction], share),
        ("drained", &[&flowing, &later, held, friction], 1.0),
    ] {
        shear_over_pressure(name, run("tests/data/plate", overrides).path(), [3, 4], 0.2 * grains);
    }
}

/// A heavy plate in a pool on soil with water in its pores: as the pool falls or the table in the pores does, friction has what the grains
/// bear, the weight with the water on top of the plate less the pressure of the pores. The levels are those of the end of a step.
#[test]
fn friction_takes_the_grains_share_between_two_levels() {
    // 60 kPa of the plate, 0.3 m thick, in water up to 3 m.
    let (weight, friction) = (60.0, 0.2);
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
        prescribe: {plate: {ux: 0, rotation: 0, uy: {rate: -4.5e-4}}}}";
    let rest = "{name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}, prescribe: {plate: {ux: 0, rotation: 0}}}";
    let slid = |levels: &str| {
        let slide = format!(
            "{{name: slide, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, {levels}, \
             prescribe: {{plate: {{ux: {{rate: 0.004}}, rotation: 0}}}}}}"
        );
        run(
            "tests/data/plate",
            &[
                "regions.plate.rigid=true",
                "materials.plate.density=20",
                "materials.soil={model: linear_elastic, young: 1.0e+5, poisson: 0.3, density: 2}",
                "gravity={y: -10}",
                "initial_stress={k0: 0.43}",
                "water={level: 3, phreatic_level: 3, unit_weight: 10}",
                &format!("contacts[0].friction={friction}"),
                &format!("phases=[{press}, {rest}, {slide}]"),
            ],
        )
    };
    let falls = "{table: [[0, 3], [1, 1]]}";
    let (steady, at_once) = ((|_| 3.0) as fn(f64) -> f64, (|_| 1.0) as fn(f64) -> f64);
    let falling: fn(f64) -> f64 = |time| 3.0 - 2.0 * time;
    for (name, levels, outside, inside) in [
        ("both as they were", "water_level: 3".into(), steady, steady),
        ("pool drawn down at once", "water_level: 1".into(), at_once, steady),
        ("pool drawn down", format!("water_level: {falls}"), falling, steady),
        ("pores drawn down at once", "phreatic_level: 1".into(), steady, at_once),
        ("pores drawn down", format!("phreatic_level: {falls}"), steady, falling),
    ] {
        let rows = history(slid(&levels).path());
        let sliding: Vec<&Vec<f64>> = rows.iter().filter(|row| row[0] > 2.0 + 1e-9).collect();
        let off = sliding.iter().map(|row| {
            let (outside, inside) = (outside(row[0] - 2.0), inside(row[0] - 2.0));
            let grains = weight + 10.0 * (outside - 0.3) - 10.0 * inside;
            let contact = weight - 3.0;
            [-row[3] / (2.0 * friction * grains) - 1.0, row[4] / (2.0 * contact) - 1.0]
        });
        let off: Vec<[f64; 2]> = off.collect();
        println!("{name}: shear and pressure off by {off:.4?}");
        assert!(off.len() >= 4 && off.iter().flatten().all(|off| off.abs() < 5e-4), "{name}: {off:?}");
    }
    // A table that says the same, so that the levels are compared in each step.
    let text = |levels: &str| std::fs::read_to_string(slid(levels).path().join("history.csv")).unwrap();
    assert_eq!(text("water_level: 3"), text("water_level: {table: [[0, 3], [1, 3]]}"));
}

/// Undrained finite elements between two blocks, or on a wall, have excess pressure as points do.
#[test]
fn friction_takes_the_pressure_of_the_grains_of_finite_elements() {
    let (young, poisson, undrained) = (1000.0, 0.2, 0.45);
    let bulk = |nu: f64| 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + poisson));
    let confined = (bulk(poisson) + 4.0 / 3.0) * shear;
    let share = confined / (confined + (bulk(undrained) - bulk(poisson)) * shear);
    let material = |more: &str| {
        format!(
            "materials={{lower: {{model: linear_elastic, young: {young}, poisson: {poisson}, density: 0, drainage: undrained, \
             undrained_poisson: {undrained}{more}}}, upper: {{model: linear_elastic, young: 1.0e+7, poisson: 0, density: 0}}}}"
        )
    };
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.002}}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.5}, prescribe: {top: {ux: {rate: 0.004}, uy: 0}}}]";
    let pushed = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {uy: {rate: -0.002}}, bottom: {ux: 0, uy: 0, rotation: 0}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.5}, prescribe: {top: {uy: 0}, bottom: {ux: {rate: 0.004}, uy: 0, rotation: 0}}}]";
    let rough = "contacts=[{structure: upper, against: lower, friction: 0.2}]";
    let wall = "contacts=[{structure: upper, against: lower, tension: no_separation}, \
        {wall: bottom, against: lower, friction: 0.2, tension: no_separation}]";
    let (on_floor, on_wall) = ("supports={bottom: {uy: 0}, lower_sides: {ux: 0}}", "supports={sides: {ux: 0}}");
    let on = |what: &str| format!("output.history=[{{name: it, on: {what}, quantities: [contact_x, contact_y]}}]");
    for (name, overrides, grains) in [
        ("share of a field", [&material("")[..], phases, rough, on_floor, &on("upper")], share),
        ("field of its own", [&material(", permeability: 1.0e-6"), phases, rough, on_floor, &on("upper")], share),
        ("on a wall", [&material(""), pushed, wall, on_wall, &on("bottom")], share),
    ] {
        shear_over_pressure(name, run("tests/data/blocks", &overrides).path(), [1, 2], 0.2 * grains);
    }
}

/// Finite elements have water in their pores up to a level, too. The block slides off by 3 % of its length, where nothing presses.
#[test]
fn friction_takes_the_grains_share_of_finite_elements_between_two_levels() {
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.02}}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.25}, prescribe: {top: {ux: {rate: 0.06}, uy: 0}}}]";
    for (outside, inside) in [(1.0, 1.0), (1.0, 1.5), (3.0, 1.0)] {
        let water = format!("water={{level: {outside}, phreatic_level: {inside}, unit_weight: 10}}");
        let rows = history(
            run(
                "tests/data/blocks",
                &[
                    "materials.upper={model: linear_elastic, young: 1.0e+7, poisson: 0, density: 0}",
                    "contacts=[{structure: upper, against: lower, friction: 0.2}]",
                    "supports={bottom: {uy: 0}, lower_sides: {ux: 0}}",
                    &water,
                    phases,
                ],
            )
            .path(),
        );
        let last = rows.last().unwrap();
        let ratio = -last[1] / (0.2 * (last[2] - 1.94 * 10.0 * (inside - outside)));
        println!(
            "levels of {outside} m outside and {inside} m inside: shear over what the grains bear times tan δ {ratio:.4}"
        );
        assert!((ratio - 1.0).abs() < 0.01, "{last:?}");
    }
}
