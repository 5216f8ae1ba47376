//! Softening and rate dependence against their own law, and the tangent against differences.

use super::*;

fn model(rate: f64) -> SofteningTresca {
    let elasticity = Elasticity::new(Profile::constant(2600.0), 0.3).unwrap();
    let softening = Softening { remoulded: 0.25, ductility: 4.0, rate, reference_rate: 0.01 };
    SofteningTresca::new(elasticity, Profile::growing(4.0, 1.0, 0.0), softening).unwrap()
}

/// Leads a point through pure shear in steps of `step`, each of which takes `1/inverse_dt`.
fn shear(model: &SofteningTresca, step: f64, count: usize, inverse_dt: f64) -> Vec<(f64, f64, f64)> {
    let state = State { inverse_dt, ..State::default() };
    let (mut elastic, mut internal, mut path) = ([0.0; 3], [0.0], Vec::new());
    for n in 1..=count {
        let trial = [elastic[0] + 0.5 * step, elastic[1], elastic[2] - 0.5 * step];
        let r = model.respond(-6.0, &trial, &state, &mut internal);
        elastic = r.elastic_strain;
        path.push((n as f64 * step, 0.5 * (r.stress[0] - r.stress[2]), internal[0]));
    }
    path
}

/// In pure shear ξ = γ − τ/G, and τ is the strength at that ξ: whatever the steps, as the return is implicit.
#[test]
fn in_shear_the_stress_follows_the_softening_curve() {
    let model = model(0.0);
    for (step, count) in [(1e-3, 8000), (0.5, 16), (8.0, 1)] {
        let path = shear(&model, step, count, 0.0);
        for &(gamma, tau, sheared) in path.iter().filter(|(gamma, ..)| *gamma > 0.02) {
            let xi = gamma - tau / 1000.0;
            let exact = 10.0 * (0.25 + 0.75 * (-3.0 * xi / 4.0f64).exp());
            assert!((tau - exact).abs() < 1e-9, "γ {gamma}: {tau} {exact}");
            assert!((sheared - xi).abs() < 1e-11, "γ {gamma}: {sheared} {xi}");
        }
    }
    // 95 % of the softening is done at ξ₉₅.
    let (gamma, tau, _) = shear(&model, 1e-3, 4003, 0.0)[4002];
    let left = (tau - 2.5) / 7.5;
    assert!((left - (-3.0f64).exp()).abs() < 1e-4, "{gamma} {tau} {left}");
}

/// A tenfold rate gains μ; rates below the reference gain nothing.
#[test]
fn strength_grows_with_the_rate() {
    let model = model(0.1);
    for (times, gained) in [(0.1, 1.0), (10.0, 1.1), (1000.0, 1.3)] {
        // A plastic rate that does not change: the steps far from the first yield are all alike.
        let step = 1e-3;
        let inverse_dt = times * 0.01 / step;
        let path = shear(&model, step, 4000, inverse_dt);
        let (gamma, tau, sheared) = path[3999];
        let soft = 10.0 * (0.25 + 0.75 * (-3.0 * sheared / 4.0f64).exp());
        // What the falling stress gives back adds to the plastic rate: 1e-3 of it.
        assert!((tau / soft - gained).abs() < 3e-4, "{times}: γ {gamma}: {}", tau / soft);
    }
}

/// The tangent against differences of the return with rate and softening, on faces and edges.
#[test]
fn the_tangent_is_that_of_the_implicit_return() {
    let model = model(0.2);
    let state = State { inverse_dt: 10.0, ..State::default() };
    let before = [0.3];
    let mut edges = 0;
    for trial in
        [[0.02, 0.001, -0.03], [0.5, 0.1, -0.6], [0.03, -0.0148, -0.0152], [0.0151, 0.0149, -0.03], [0.2, 0.2, -0.3]]
    {
        let r = model.respond(-6.0, &trial, &state, &mut before.clone());
        assert!(r.yielding);
        edges += usize::from(by_strength(&model.elasticity.at(-6.0), &r.stress).1 > 6e-4);
        for b in 0..3 {
            let moved = |by: f64| {
                let mut t = trial;
                t[b] += by;
                model.respond(-6.0, &t, &state, &mut before.clone()).stress
            };
            let (up, down) = (moved(1e-7), moved(-1e-7));
            for a in 0..3 {
                let difference = (up[a] - down[a]) / 2e-7;
                assert!(
                    (difference - r.tangent[a][b]).abs() < 2e-3,
                    "{trial:?} {a}{b}: {difference} {}",
                    r.tangent[a][b]
                );
            }
        }
    }
    assert!(edges >= 2, "{edges}");
}

#[test]
fn soil_that_softens_faster_than_it_unloads_is_refused() {
    let elasticity = Elasticity::new(Profile::constant(2600.0), 0.3).unwrap();
    let brittle = Softening { remoulded: 0.1, ductility: 0.01, rate: 0.0, reference_rate: 1.0 };
    let error = SofteningTresca::new(elasticity, Profile::constant(4.0), brittle).unwrap_err();
    assert_eq!(error.place, "ductility");
}
