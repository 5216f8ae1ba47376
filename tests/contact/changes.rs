//! Settings of contacts that change as a phase begins.

use crate::contact::{history, refused};
use crate::support::{rows, run};

/// A block that friction holds on an incline slides down from the phase on in which friction is less, with `g (sin θ − tan δ cos θ)`.
#[test]
fn a_block_slides_once_friction_is_less() {
    let folder = run(
        "cases/incline",
        &[
            "contacts=[{name: base, structure: block, soil: ground, friction: 0.5}]",
            "phases=[{name: hold, analysis: quasi_static, duration: 1, step: {initial: 0.25}, gravity: {rate: 1}}, \
             {name: slide, analysis: dynamic, duration: 0.6, step: {initial: 0.01}, contacts: {base: {friction: 0.2}}}]",
        ],
    );
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let rows = rows(folder.path());
    let along = |row: &Vec<f64>| row[1] * cos - row[2] * sin;
    let held = rows.iter().rfind(|row| row[0] < 1.0 + 1e-9).unwrap();
    let way = along(rows.last().unwrap()) - along(held);
    let free = 0.5 * 9.81 * (sin - 0.2 * cos) * 0.6f64.powi(2);
    println!("held within {:.1e} m, then {way:.5} of {free:.5} m", along(held));
    assert!(along(held).abs() < 1e-3 && (way / free - 1.0).abs() < 0.01, "{} {way} {free}", along(held));
}

/// Confined soil is pulled by a plate that cannot part from it: `F = M ln λ / λ` over the width of 2 m. With a tensile strength above that it
/// holds on, with one below they part.
#[test]
fn a_plate_parts_from_soil_once_the_tension_is_limited() {
    let phase = |name: &str, limit: &str| {
        format!(
            "{{name: {name}, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, prescribe: {{top: {{ux: 0, uy: 0}}}}, \
             contacts: {{base: {{tension: {limit}}}}}}}"
        )
    };
    let pull = "{name: pull, analysis: quasi_static, duration: 1, step: {initial: 0.2}, prescribe: {top: {ux: 0, uy: {rate: 0.05}}}}";
    let phases = format!("phases=[{pull}, {}, {}]", phase("hold", "{limit: 100}"), phase("part", "{limit: 20}"));
    let base = "contacts=[{name: base, structure: plate, soil: soil, tension: no_separation}]";
    let rows = history("tests/data/plate", &[base, &phases]);
    let at = |time: f64| rows.iter().rfind(|row| row[0] < time + 1e-9).unwrap()[4];
    let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
    let pulled = 2.0 * modulus * 1.05f64.ln() / 1.05;
    println!("{:.4} of {pulled:.4} kN, {:.4}, {:.1e}", -at(1.0), -at(2.0), at(3.0));
    for time in [1.0, 2.0] {
        assert!((-at(time) / pulled - 1.0).abs() < 1e-3, "{time}: {}", at(time));
    }
    assert!(at(3.0).abs() < 1e-6 * pulled, "{}", at(3.0));
}

/// Adhesion that grows and goes: the shear of a plate that slides is `c_a L` in each phase, and of a share of the strength α s_u L.
#[test]
fn a_plate_slides_with_the_adhesion_of_the_phase() {
    let slide = |name: &str, contacts: &str| {
        format!(
            "{{name: {name}, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, \
             prescribe: {{top: {{ux: {{rate: 0.005}}, uy: 0}}}}{contacts}}}"
        )
    };
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.2}, prescribe: {top: {ux: 0, uy: {rate: -0.05}}}}";
    let phases = format!(
        "phases=[{press}, {}, {}, {}]",
        slide("first", ""),
        slide("more", ", contacts: {base: {adhesion: 3}}"),
        slide("strength", ", contacts: {base: {adhesion: 0, adhesion_factor: 0.05}}")
    );
    let clay = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 30, density: 0}";
    let rows = history(
        "tests/data/plate",
        &[clay, "contacts=[{name: base, structure: plate, soil: soil, adhesion: 2}]", &phases],
    );
    for (time, limit) in [(2.0, 2.0), (3.0, 3.0), (4.0, 1.5)] {
        let row = rows.iter().rfind(|row| row[0] < time + 1e-9).unwrap();
        let shear = -row[3] / (2.0 - row[1]);
        println!("{shear:.4} of {limit} kPa");
        assert!((shear / limit - 1.0).abs() < 0.01, "{shear} {limit}");
    }
}

#[test]
fn what_a_phase_cannot_change_of_a_contact_is_refused() {
    let named = "contacts=[{name: base, structure: plate, soil: soil}]";
    for (contacts, change, words) in [
        (named, "{bse: {friction: 1}}", ["phases[0].contacts.bse", "did you mean `base`"]),
        ("contacts[0].friction=0", "{base: {friction: 1}}", ["no contact with the name `base`", "give the entry"]),
        (named, "{base: {}}", ["phases[0].contacts.base", "nothing of the contact changes"]),
        (named, "{base: {friction: -1}}", ["phases[0].contacts.base.friction", "0"]),
        (named, "{base: {adhesion_factor: 2}}", ["phases[0].contacts.base.adhesion_factor", "no share"]),
        (named, "{base: {soil: air}}", ["phases[0].contacts.base.soil", "unknown key"]),
        (
            "contacts=[{name: base, structure: plate, soil: soil}, {name: base, wall: side, soil: soil}]",
            "{base: {friction: 1}}",
            ["contacts[1].name", "two contacts"],
        ),
    ] {
        let change = format!("phases[0].contacts={change}");
        refused("tests/data/plate", &[contacts, &change], &words);
    }
    let blocks = "contacts=[{name: base, structure: upper, against: lower}]";
    let share = "phases[0].contacts={base: {adhesion_factor: 0.5}}";
    refused("tests/data/blocks", &[blocks, share], &["phases[0].contacts.base.adhesion_factor", "strength of soil"]);
}
