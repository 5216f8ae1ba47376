//! Rigid structures, from the case to the results: forces and motion against closed forms and deformable ones.

use crate::contact::history;
use crate::support::{errors, mpm, rows, run};
use mpm::io::frame::{self, Frame};
use mpm::io::run_folder::RunFolder;

const PLATE: &str = "tests/data/plate";
const INCLINE: &str = "cases/incline";
const ALL: &str = "output.history=[{name: plate, on: plate, quantities: [ux, uy, rotation, reaction_x, reaction_y, \
    reaction_moment, contact_x, contact_y, contact_moment]}]";

/// A plate of 2 m on soil of 24 m by 12 m, pressed in by 2 cm and then turned or loaded.
fn punch(second: &str, h: f64) -> Vec<Vec<f64>> {
    let mesh = format!("mesh.parameters={{width: 24, plate: 2, left: 11, depth: 12, h: {h}, hp: {h}}}");
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, \
            prescribe: {{plate: {{ux: 0, uy: {{rate: -0.02}}, rotation: 0}}}}}}, \
            {{name: second, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, {second}}}]"
    );
    history(PLATE, &["regions.plate.rigid=true", ALL, &mesh, &phases])
}

/// The force of a rigid plate is what that of a deformable one comes to as it gets stiffer.
#[test]
fn a_rigid_plate_is_the_limit_of_stiff_ones() {
    let force = |entry: &str| history(PLATE, &[entry]).last().unwrap()[4];
    let rigid = force("regions.plate.rigid=true");
    let off = [1e5, 1e7].map(|young| force(&format!("materials.plate.young={young:e}")) / rigid - 1.0);
    println!("force of plates of 1e5 and 1e7 kPa beside that of a rigid one: {off:?}");
    assert!(off[1].abs() < 1e-4 && (off[0] / off[1] / 100.0 - 1.0).abs() < 0.1, "{off:?}");
}

/// A dead load on the top that pushes aside tilts the strip until the soil balances its moment, that of the lever of the
/// turned plate among it.
#[test]
fn a_strip_under_an_eccentric_load_is_in_balance() {
    let rows = punch("prescribe: {plate: {ux: 0}}, tractions: [{on: top, tx: {rate: -6}, ty: -9}]", 0.4);
    let last = rows.last().unwrap();
    let (sin, cos) = last[3].sin_cos();
    // About the centroid, 0.15 m below the top.
    let load = -2.0 * (-6.0 * 0.15 * cos + 9.0 * -0.15 * sin);
    println!("rotation {:.4e}, moment of the load {load:.6}, of the soil {:.6} kN m", last[3], last[9]);
    assert!(last[3] > 1e-3, "{last:?}");
    assert!((load + last[9]).abs() < 1e-6 * load, "{load} {last:?}");
    assert!((last[8] - 18.0).abs() < 1e-6 * 18.0, "{last:?}");
    assert!((last[4] + last[7] - 12.0).abs() < 1e-6 * 12.0, "{last:?}");
}

/// The incline of `sliding.rs`, with a block that keeps its shape: it slides …
#[test]
fn a_rigid_block_slides_down_an_incline() {
    let rows = history(INCLINE, &["regions.block.rigid=true", "phases[0].duration=0.6"]);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let way = 0.5 * 9.81 * (sin - 0.2 * cos) * 0.6f64.powi(2);
    let row = rows.last().unwrap();
    let (along, across) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
    println!("way {along:.5} of {way:.5} m, lifted by {across:.5} m");
    assert!((along / way - 1.0).abs() < 0.01, "{along} {way}");
    assert!(across.abs() < 0.01 * 0.25, "{across}");
}

/// … and sticks.
#[test]
fn a_rigid_block_rests_on_an_incline() {
    let overrides = [
        "regions.block.rigid=true",
        "contacts[0].friction=0.37",
        "numerics.spectral_radius=0.5",
        "phases[0].duration=0.8",
    ];
    let rows = history(INCLINE, &overrides);
    let at = |time: f64| rows.iter().find(|row| row[0] > time - 1e-9).unwrap()[1];
    let free = 0.5 * 9.81 * 20f64.to_radians().sin() * 0.8f64.powi(2);
    assert!((at(0.8) - at(0.6)).abs() < 1e-6 * free, "{} {}", at(0.6), at(0.8));
}

/// Nothing slows a spinning block in free fall: both momenta are kept while it turns.
#[test]
fn a_block_falls_and_spins_freely() {
    let overrides = [
        "regions.block.rigid=true",
        "contacts=[]",
        "phases[0].duration=0.3",
        "initial_velocity={block: {velocity: {x: 1}, gradient: [[0, -2], [2, 0]]}}",
        "output.history=[{name: block, on: block, quantities: [ux, uy, vx, vy, rotation]}]",
    ];
    let folder = run(INCLINE, &overrides);
    let rows = rows(folder.path());
    let first = &rows[0];
    for row in &rows {
        let t = row[0];
        let [vx, vy] = [first[3], first[4] + 9.81 * first[0]];
        let expected = [vx * t, vy * t - 0.5 * 9.81 * t * t, vx, vy - 9.81 * t, 2.0 * t];
        assert!(row[1..].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{row:?} {expected:?}");
    }
    // What is shown of it keeps its shape: the nodes that have come far are the block's.
    let frame = |k: u32| Frame::read(&folder.path().join(format!("results/frame-{k:06}.mpmf"))).unwrap();
    let (before, after) = (frame(0), frame(3));
    let apart = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for (x, y) in [(before.grid.position, after.grid.position), (before.elements.position, after.elements.position)] {
        let far: Vec<usize> = (0..x.len()).filter(|&i| apart(&x[i], &y[i]) > 0.1).collect();
        assert!(far.len() > 50);
        let shape = |i: usize| (apart(&y[i], &y[far[0]]) - apart(&x[i], &x[far[0]])).abs() < 1e-12;
        assert!(far.iter().all(|&i| shape(i)));
    }
}

/// What stops where a body is turned says how far it was, and would be, as an angle.
#[test]
fn a_rotation_reached_is_told_in_radians() {
    let phases = "phases=[{name: turn, analysis: quasi_static, duration: 1, step: {initial: 0.25, min: 0.25}, \
        prescribe: {plate: {ux: 0, uy: 0, rotation: {table: [[0, 0], [0.25, 0.001], [0.5, 3]]}}}}]";
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", PLATE, folder.path(), &["regions.plate.rigid=true", phases]);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("a rotation of 1.0000e-3 of 3.0000e0 rad prescribed"), "{said}");
}

/// Curves move a body without turning it; what contradicts that, or another entry, is told.
#[test]
fn contradictions_about_rigid_structures_are_told() {
    let refused = |overrides: &[&str], words: &[&str]| {
        crate::contact::refused(PLATE, &[&["regions.plate.rigid=true"], overrides].concat(), words);
    };
    refused(&["phases[0].prescribe.plate={uy: {rate: -0.2}}"], &["differently (y)", "`top`", "`plate`"]);
    refused(&["phases[0].prescribe.plate={rotation: {rate: 1}}"], &["rules out the rotation of `plate`"]);
    refused(&["supports.plate={uy: 0}"], &["differently (y)"]);
    refused(&["phases[0].prescribe.top={ux: 0, rotation: 0}"], &["only a rigid structure as a whole"]);
    refused(&["geometry=axisymmetric", "phases[0].prescribe={plate: {ux: {rate: 1}}}"], &["along the axis"]);
    refused(&["regions.plate.rigid=false", ALL], &["only a rigid structure turns"]);
}

/// A plate 2 m wide and 0.3 m high, half as heavy as water, whose base is at 0: it comes to float with 0.15 m in the water, and turned about
/// its centroid it is brought back by `W sin θ (GM + ½ BM tan²θ)`, as a wall-sided body is, on cells of any size.
#[test]
fn a_plate_floats_as_archimedes_says() {
    let (width, draft, angle) = (2.0, 0.15, 0.01f64);
    let weight = 10.0 * width * draft;
    let metacentre = width * width / (12.0 * draft);
    let lever = angle.sin() * (0.5 * draft + metacentre - 0.15 + 0.5 * metacentre * angle.tan().powi(2));
    let off = [0.4, 0.2].map(|h| {
        let mesh = format!("mesh.parameters={{width: 4, plate: 2, left: 1, depth: 1, h: {h}, hp: {h}}}");
        let rows = history(
            PLATE,
            &[
                "regions.plate.rigid=true",
                "materials.plate.density=0.5",
                "contacts=[]",
                "gravity={y: -10}",
                "initial_stress={k0: 1}",
                "water={level: 0.2, unit_weight: 10}",
                &mesh,
                ALL,
                "phases=[{name: rest, analysis: quasi_static, duration: 1, step: {initial: 1}, \
                    prescribe: {plate: {ux: 0, rotation: 0}}}, \
                    {name: turn, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
                    prescribe: {plate: {ux: 0, rotation: {rate: 0.01}}}}]",
            ],
        );
        assert!(rows.iter().all(|row| (row[2] - (0.2 - draft)).abs() < 1e-7), "{rows:?}");
        rows.last().unwrap()[6] / (weight * lever) - 1.0
    });
    println!("moment beside that of a wall-sided body, cells of 0.4 and 0.2 m: {off:?}");
    assert!(off.iter().all(|off| off.abs() < 1e-9), "{off:?}");
}

/// A rigid plate on a column of quadrilaterals of all shapes, pressed in by 18 % and the grid reset in each of nine steps: everywhere
/// the soil has the stress `M ln λ/λ` of Hencky's elasticity, also beneath the plate, whose surface cuts the cells at all angles.
#[test]
fn soil_in_quadrilaterals_is_pressed_evenly() {
    let folder = run("tests/data/pressed_column", &[]);
    let modulus = 45000.0 * 0.64 / (1.36 * 0.28);
    let stretch: f64 = 1.0 - 0.216 / 1.2;
    let exact = modulus * stretch.ln() / stretch;
    let results = RunFolder::new(folder.path()).results();
    let Frame { points, .. } = Frame::read(&frame::path(&results, 1)).unwrap();
    let stress = points.columns.iter().find(|column| column.name == "stress").unwrap();
    let off = |yy: f64| (yy / exact - 1.0).abs();
    let most = stress.values.chunks_exact(stress.components).map(|stress| off(stress[1])).fold(0.0, f64::max);
    println!("{most:.1e} off");
    assert!(most < 0.01, "{most:.1e} off");
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A smooth rigid strip on a half space turns by θ under the moment M = π E θ b²/(4 (1 − ν²)), which has no far field
    /// to speak of. Cells spread the peaks at its ends: the moment errs by the first order of their size.
    #[test]
    fn a_strip_turns_as_on_a_half_space() {
        let off = [0.4, 0.2].map(|h| {
            let rows = punch("prescribe: {plate: {ux: 0, uy: 0, rotation: {rate: 0.004}}}", h);
            let (first, last) = (&rows[1], &rows[rows.len() - 1]);
            assert_eq!((last[1], last[2], last[3]), (0.0, -0.02, 0.004));
            for row in &rows {
                assert!((4..7).all(|i| (row[i] + row[i + 3]).abs() < 1e-7 * row[5].abs()), "{row:?}");
            }
            let exact = std::f64::consts::PI * 1000.0 * 0.004 / (4.0 * (1.0 - 0.09));
            (last[6] - first[6]) / exact - 1.0
        });
        println!("moment beside that of a half space, cells 0.4 and 0.2 of the half width: {off:?}");
        assert!(off[1].abs() < 0.04 && (2.0 * off[1] - off[0]).abs() < 0.02, "{off:?}");
    }

    /// In axisymmetry a rigid pile only sinks. In its first centimetres it bears the limit load of a circular footing, as the deformable
    /// one of `sliding.rs`, with what it gains with depth.
    #[test]
    fn a_rigid_pile_finds_its_bearing_capacity() {
        let rows = history("cases/pile", &["regions.pile.rigid=true", "phases.push.duration=0.1"]);
        assert!(rows.iter().all(|row| (row[2] + row[4]).abs() < 1e-9 * row[2].abs().max(1.0)), "{rows:?}");
        let pressure = rows.last().unwrap()[2] / (std::f64::consts::PI * 0.5f64.powi(2)) / 0.5;
        println!("bearing capacity {pressure:.3} times the strength");
        assert!((5.69..1.1 * 6.05).contains(&pressure), "{pressure}");
    }
}
