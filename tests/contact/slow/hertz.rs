//! Line contact: Hertz's half width `b² = 4PR/(πE*)` and peak pressure `p0 = 2P/(πb)`, `1/E* = Σ (1 − ν²)/E`, and the
//! ellipse between (K. L. Johnson, Contact Mechanics, 1985, chapter 4).

use crate::support::{rows, run};
use mpm::io::container::Store;
use std::f64::consts::PI;
use std::path::Path;

const HERTZ: &str = "cases/hertz";
const RADIUS: f64 = 50.0;

/// The pressures (kPa) of the contact nodes in the last step.
fn pressures(folder: &Path) -> Vec<f64> {
    let mut files: Vec<_> = std::fs::read_dir(folder.join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    let mut store = Store::read(files.last().unwrap(), "checkpoint", "").unwrap();
    store.take("contact.0.pressure", 1).unwrap()
}

/// What a contact comes to, beside Hertz's.
struct Contact {
    force: f64,
    /// Hertz's half width (m).
    half_width: f64,
    /// Half width, twice the root of the second moment of the pressure, and largest pressure over Hertz's (-).
    width: f64,
    peak: f64,
    /// Coefficient of variation of the pressure over Hertz's ellipse, within eight tenths of the half width (-).
    variation: f64,
}

/// The contact nodes are as far apart as makes their pressures the force.
fn contact(overrides: &[&str], modulus: f64) -> Contact {
    let folder = run(HERTZ, overrides);
    let force = rows(folder.path()).last().unwrap()[2];
    let pressure = pressures(folder.path());
    let sum: f64 = pressure.iter().sum();
    let spacing = force / sum;
    let middle = (0..).map(f64::from).zip(&pressure).map(|(k, p)| k * p).sum::<f64>() / sum;
    let place = |k: usize| (k as f64 - middle) * spacing;
    let half_width = (4.0 * force * RADIUS / (PI * modulus)).sqrt();
    let peak = 2.0 * force / (PI * half_width);
    let contact_nodes = || 0..pressure.len();
    let second = contact_nodes().map(|k| place(k).powi(2) * pressure[k]).sum::<f64>() / sum;
    let ellipse = |k: usize| peak * (1.0 - (place(k) / half_width).powi(2)).sqrt();
    let inside = contact_nodes().filter(|&k| place(k).abs() < 0.8 * half_width);
    let share: Vec<f64> = inside.map(|k| pressure[k] / ellipse(k)).collect();
    let count = share.len() as f64;
    let mean = share.iter().sum::<f64>() / count;
    Contact {
        force,
        half_width,
        width: 2.0 * second.sqrt() / half_width,
        peak: pressure.iter().fold(0.0f64, |a, b| a.max(*b)) / peak,
        variation: (share.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / count).sqrt() / mean,
    }
}

fn modulus(young: f64) -> f64 {
    let compliance = |young: f64| (1.0 - 0.3f64.powi(2)) / young;
    1.0 / (compliance(1000.0) + compliance(young))
}

/// Tells a contact and holds it to Hertz's.
fn check(name: &str, h: f64, contact: &Contact) {
    let Contact { force, half_width, width, peak, variation } = contact;
    let cells = half_width / h;
    println!(
        "{name}: b/h {cells:.1}, force {force:.3} kN, half width {:+.1} %, peak {:+.1} %, variation {:.1} %",
        100.0 * (width - 1.0),
        100.0 * (peak - 1.0),
        100.0 * variation
    );
    assert!((width - 1.0).abs() < 0.02 && (peak - 1.0).abs() < 0.02, "{name}");
    // Where the contact ends between contact nodes the pressures next to it ripple; it is most of the contact in few cells.
    assert!(*variation < if cells > 5.0 { 0.03 } else { 0.05 }, "{name}");
}

#[test]
fn two_bodies_touch_as_hertz_has_it() {
    let coarse = [(0.3, 0.065), (0.24, 0.05), (0.24, 0.055), (0.24, 0.065)];
    let fine = [(0.18, 0.055), (0.12, 0.065)];
    for (h, push) in coarse.into_iter().chain(fine) {
        let mesh = format!("mesh.parameters.h={h}");
        let load = format!("phases[0].prescribe.top.uy={{rate: -{push}}}");
        let name = format!("h {h} m, pushed by {push} m");
        check(&name, h, &contact(&[&mesh, &load], modulus(1000.0)));
    }
}

/// A rigid body is what stiffer and stiffer ones come to.
#[test]
fn a_rigid_body_is_the_limit_of_stiff_ones() {
    let push = "phases[0].prescribe.top.uy={rate: -0.04}";
    let rigid = contact(&["regions.upper.rigid=true", push], modulus(f64::INFINITY));
    check("rigid", 0.12, &rigid);
    let off = [1e5, 1e7].map(|young| {
        let stiff = contact(&[&format!("materials.hard.young={young:e}"), push], modulus(young));
        check(&format!("{young:e} kPa"), 0.12, &stiff);
        stiff.force / rigid.force - 1.0
    });
    println!("force beside that of the rigid body: {off:?}");
    assert!(off[1].abs() < 2e-4 && (off[0] / off[1] / 100.0 - 1.0).abs() < 0.1, "{off:?}");
}

/// The flat body of material points, the round one rigid.
#[test]
fn a_rigid_body_touches_material_points_as_hertz_has_it() {
    let overrides = [
        "regions={lower: {kind: mpm, material: soft}, upper: {kind: structure, material: hard, rigid: true}}",
        "contacts=[{structure: upper, soil: lower}]",
        "phases[0].prescribe.top.uy={rate: -0.04}",
    ];
    for h in [0.24, 0.12] {
        let mesh = format!("mesh.parameters.h={h}");
        let contact = contact(&[&overrides[..], &[&mesh]].concat(), modulus(f64::INFINITY));
        check(&format!("material points, h {h} m"), h, &contact);
    }
}
