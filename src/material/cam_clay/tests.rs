//! Modified Cam-Clay against closed forms: here with constant moduli.

mod swelling;

use super::*;
use crate::material::driver::{Control, drive_from};

const M: f64 = 1.2;
const LAMBDA: f64 = 0.08;
const P_C: f64 = 100.0;

fn model() -> CamClay {
    let elasticity = Elasticity::new(Profile::constant(6000.0), 0.25).unwrap();
    CamClay::new(elasticity, M, Profile::constant(P_C), LAMBDA).unwrap()
}

fn invariants(stress: &[f64; 3]) -> (f64, f64) {
    (-(stress[0] + stress[1] + stress[2]) / 3.0, (stress[0] - stress[2]).abs())
}

/// Isotropic compression: ε_v = p/K up to p_c0 and Λ ln(p/p_c0) more beyond, with any steps; unloading is elastic.
#[test]
fn isotropic_compression_follows_the_virgin_line() {
    let model = model();
    let bulk = model.elasticity.at(0.0).bulk();
    for count in [1, 7, 100] {
        let path = (1..=count).map(|n| [Control::Strain(-0.06 * f64::from(n) / f64::from(count)); 3]);
        let path: Vec<_> = path.chain([[Control::Strain(-0.05); 3]]).collect();
        let history = drive_from(&model, 0.0, [0.0; 3], path).unwrap();
        let (p, q) = invariants(&history[history.len() - 2].stress);
        assert!(q < 1e-9 && (p / bulk + LAMBDA * (p / P_C).ln() - 0.18).abs() < 1e-12, "{count}: {p} {q}");
        let back = invariants(&history[history.len() - 1].stress).0;
        assert!((p - back - 0.03 * bulk).abs() < 1e-9 * p && !history[history.len() - 1].yielding);
    }
}

/// Undrained triaxial compression from the isotropic stress p₀: the plastic volume strain is (p − p₀)/K with the other sign,
/// so that p_c = p_c0 e^(−(p − p₀)/KΛ), and yield gives q at every p, without integrating.
#[test]
fn undrained_triaxial_compression_follows_the_closed_form() {
    let model = model();
    let moduli = model.elasticity.at(0.0);
    let bulk = moduli.bulk();
    // Normally consolidated, and overconsolidated by 1.6 and 5.
    for p0 in [100.0, 62.5, 20.0] {
        let start = [-p0 / (3.0 * bulk); 3];
        let path = (1..=2000).map(|n| {
            let axial = 1e-4 * f64::from(n);
            [Control::Strain(0.5 * axial), Control::Strain(0.5 * axial), Control::Strain(-axial)]
        });
        let history = drive_from(&model, 0.0, start, path).unwrap();
        let mut yielded = 0;
        for r in history.iter().filter(|r| r.yielding) {
            let (p, q) = invariants(&r.stress);
            let size = P_C * (-(p - p0) / (bulk * LAMBDA)).exp();
            let exact = M * (p * (size - p)).max(0.0).sqrt();
            assert!((q - exact).abs() < 1e-6 * P_C, "p₀ {p0}: p {p}, q {q}, {exact}");
            yielded += 1;
        }
        // The critical state: 2 p = p_c, q = M p.
        let (mut low, mut high) = (0.0, 200.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            let above = 2.0 * middle > P_C * (-(middle - p0) / (bulk * LAMBDA)).exp();
            (low, high) = if above { (low, middle) } else { (middle, high) };
        }
        let (p, q) = invariants(&history[history.len() - 1].stress);
        assert!(yielded > 1000 && (p / low - 1.0).abs() < 1e-3, "p₀ {p0}: {yielded} yielded, p {p}, {low}");
        assert!((q / (M * low) - 1.0).abs() < 1e-3, "p₀ {p0}: q {q}, {}", M * low);
    }
}

/// Drained, with the stress path dq/dp = 3 of the triaxial test, the soil fails at q = M p: p = p₀/(1 − M/3).
#[test]
fn drained_triaxial_compression_ends_at_the_critical_state() {
    let model = model();
    let bulk = model.elasticity.at(0.0).bulk();
    let (p0, cell) = (80.0, -80.0);
    let path =
        (1..=6000).map(|n| [Control::Stress(cell), Control::Stress(cell), Control::Strain(-2e-4 * f64::from(n))]);
    let history = drive_from(&model, 0.0, [-p0 / (3.0 * bulk); 3], path).unwrap();
    let (p, q) = invariants(&history[history.len() - 1].stress);
    let exact = p0 / (1.0 - M / 3.0);
    assert!((p / exact - 1.0).abs() < 1e-3 && (q / (M * exact) - 1.0).abs() < 1e-3, "{p} {q} {exact}");
}
