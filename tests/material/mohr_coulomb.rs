//! Mohr–Coulomb and Tresca against values and formulations that share nothing with the return: the point
//! values of the verification table, strengths in closed form, and a projection onto all planes at once.

use mpm::material::driver::{Control, drive};
use mpm::material::{Elasticity, Friction, Model, MohrCoulomb, Profile, State, Tresca};

fn elasticity(young: f64, poisson: f64) -> Elasticity {
    Elasticity::new(Profile::constant(young), poisson).unwrap()
}

fn mohr_coulomb(e: Elasticity, c: f64, friction: f64, dilation: f64, tension: Option<f64>) -> MohrCoulomb {
    let friction = Friction::degrees(friction, dilation).unwrap();
    MohrCoulomb::new(e, Profile::constant(c), friction, tension.map(Profile::constant)).unwrap()
}

/// Verification table, E = 1000, ν = 0.3, c = 1, φ = 30°, ψ = 10°: a face, both edges and the apex, to all
/// of its eight digits.
#[test]
fn verification_points() {
    let model = mohr_coulomb(elasticity(1000.0, 0.3), 1.0, 30.0, 10.0, None);
    let apex = 3f64.sqrt();
    for (strain, expected) in [
        ([0.004, 0.001, -0.006], [-0.21850948, -0.30144186, -4.11963005]),
        ([0.004, 0.0039, -0.008], [-0.20630135, -0.20630135, -4.08300566]),
        ([0.006, -0.004, -0.0041], [-0.16107738, -3.94733375, -3.94733375]),
        ([0.01, 0.009, 0.008], [apex, apex, apex]),
    ] {
        let r = model.respond(0.0, &strain, &State::default(), &mut []);
        for k in 0..3 {
            assert!((r.stress[k] - expected[k]).abs() <= 1e-8, "{strain:?}: {:?}, not {expected:?}", r.stress);
        }
    }
}

/// Triaxial compression to failure: `σ_axial = N σ_cell − 2c√N`, `N = tan²(45° + φ/2)`.
#[test]
fn triaxial_compression_strength() {
    for (c, friction, dilation, cell) in [(1.0, 30.0, 10.0, 10.0), (5.0, 20.0, 0.0, 0.0), (0.0, 38.0, 38.0, 50.0)] {
        let model = mohr_coulomb(elasticity(1e4, 0.25), c, friction, dilation, None);
        let consolidate = [Control::Stress(-cell); 3];
        let shear = (1..=50).map(|n| {
            [Control::Strain(-0.002 * n as f64 - 1e-4 * cell), Control::Stress(-cell), Control::Stress(-cell)]
        });
        let history = drive(&model, 0.0, std::iter::once(consolidate).chain(shear)).unwrap();
        let n = (45.0f64 + 0.5 * friction).to_radians().tan().powi(2);
        let expected = -(n * cell + 2.0 * c * n.sqrt());
        let last = history.last().unwrap();
        assert!((last.stress[0] - expected).abs() <= 1e-8 * expected.abs(), "{} {expected}", last.stress[0]);
        assert!(last.yielding);
    }
}

/// Plane strain: biaxial compression at failure has the same strength as long as the out-of-plane stress
/// stays between the others; undrained it is `2 s_u` whatever the mean stress.
#[test]
fn plane_strain_strength() {
    let sand = mohr_coulomb(elasticity(1e4, 0.3), 2.0, 35.0, 5.0, None);
    let path = (1..=60).map(|n| [Control::Stress(-20.0), Control::Strain(-0.001 * n as f64), Control::Strain(0.0)]);
    let path = std::iter::once([Control::Stress(-20.0); 3])
        .chain([[Control::Stress(-20.0), Control::Stress(-20.0), Control::Strain(0.0)]])
        .chain(path);
    let last = *drive(&sand, 0.0, path).unwrap().last().unwrap();
    let n = (45.0f64 + 17.5).to_radians().tan().powi(2);
    let expected = -(20.0 * n + 4.0 * n.sqrt());
    assert!((last.stress[1] - expected).abs() <= 1e-8 * expected.abs(), "{:?} {expected}", last.stress);
    assert!(last.stress[2] < last.stress[0] && last.stress[2] > last.stress[1]);

    let clay = Tresca::new(elasticity(1000.0, 0.4999), Profile::growing(1.0, 2.0, 0.0)).unwrap();
    for mean in [-1e4, 0.0, 1e4] {
        let volumetric = clay.elastic_strain(0.0, &[mean; 3])[0];
        let r = clay.respond(-3.0, &[volumetric + 0.05, volumetric - 0.05, volumetric], &State::default(), &mut []);
        assert!((r.stress[0] - r.stress[1] - 14.0).abs() <= 1e-10, "{:?}", r.stress);
        assert!((r.elastic_strain.iter().sum::<f64>() - 3.0 * volumetric).abs() <= 1e-15);
    }
}

/// On a face the plastic strain dilates by the angle asked for: `sin ψ = (Δε₁ + Δε₃)/(Δε₁ − Δε₃)`.
#[test]
fn dilation_angle_is_that_of_the_flow() {
    let model = mohr_coulomb(elasticity(1000.0, 0.3), 1.0, 30.0, 10.0, None);
    let trial = [0.004, 0.001, -0.006];
    let r = model.respond(0.0, &trial, &State::default(), &mut []);
    let plastic: [f64; 3] = std::array::from_fn(|k| trial[k] - r.elastic_strain[k]);
    assert!(plastic[1].abs() <= 1e-16);
    assert!(((plastic[0] + plastic[2]) / (plastic[0] - plastic[2]) - 10f64.to_radians().sin()).abs() <= 1e-12);
    let equivalent = (2.0 / 3.0 * plastic.iter().map(|x| x * x).sum::<f64>()).sqrt();
    assert!((r.plastic_strain - equivalent).abs() <= 1e-16);
}

/// Isotropic tension ends at the apex or the cut-off, uniaxial tension at the smaller of the cut-off and
/// `2c cos φ/(1 + sin φ)`.
#[test]
fn tensile_strength() {
    let e = elasticity(1e4, 0.2);
    let uniaxial = |m: &MohrCoulomb| {
        let path = (1..=40).map(|n| [Control::Strain(1e-4 * n as f64), Control::Stress(0.0), Control::Stress(0.0)]);
        drive(m, 0.0, path).unwrap().last().unwrap().stress[0]
    };
    let sine = 20f64.to_radians().sin();
    let (free, cut) = (mohr_coulomb(e, 3.0, 20.0, 0.0, None), mohr_coulomb(e, 3.0, 20.0, 0.0, Some(0.75)));
    assert!((uniaxial(&free) - 6.0 * 20f64.to_radians().cos() / (1.0 + sine)).abs() <= 1e-8);
    assert!((uniaxial(&cut) - 0.75).abs() <= 1e-8);
    let isotropic = |m: &MohrCoulomb| m.respond(0.0, &[0.01; 3], &State::default(), &mut []).stress;
    assert!(isotropic(&free).iter().all(|s| (s - 3.0 / 20f64.to_radians().tan()).abs() <= 1e-12));
    assert_eq!(isotropic(&cut), [0.75; 3]);
}

/// All planes at once, by sweeps: each plane in turn takes the multiplier that puts the stress on it, no
/// multiplier negative. With associated flow this is Hildreth's projection in the energy norm (*Naval Res. Logist. Q.*
/// 4 (1957) 79–85); otherwise projected Gauss–Seidel on the same complementarity problem. No sorting, no
/// sets of active planes. The three tension planes stand at the cut-off or the apex.
fn swept(young: f64, poisson: f64, c: f64, angles: [f64; 2], tension: f64, trial: &[f64; 3]) -> [f64; 3] {
    let shear = young / (2.0 * (1.0 + poisson));
    let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let stiff = |v: &[f64; 3]| v.map(|x| lame * v.iter().sum::<f64>() + 2.0 * shear * x);
    let [sin_friction, sin_dilation] = angles.map(|a| a.to_radians().sin());
    let mut planes = Vec::new();
    for i in 0..3 {
        for j in (0..3).filter(|j| *j != i) {
            let direction = |s: f64| -> [f64; 3] {
                std::array::from_fn(|k| {
                    if k == i {
                        1.0 + s
                    } else if k == j {
                        s - 1.0
                    } else {
                        0.0
                    }
                })
            };
            planes.push((direction(sin_friction), direction(sin_dilation), 2.0 * c * angles[0].to_radians().cos()));
        }
        if tension.is_finite() {
            let direction = std::array::from_fn(|k| if k == i { 1.0 } else { 0.0 });
            planes.push((direction, direction, tension));
        }
    }
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let mut stress = stiff(trial);
    let mut multipliers = vec![0.0f64; planes.len()];
    for _ in 0..200_000 {
        let mut moved = 0.0f64;
        for ((n, m, r), multiplier) in planes.iter().zip(&mut multipliers) {
            let flow = stiff(m);
            let next = (*multiplier + (dot(n, &stress) - r) / dot(n, &flow)).max(0.0);
            let change = next - *multiplier;
            *multiplier = next;
            for k in 0..3 {
                stress[k] -= flow[k] * change;
            }
            moved = moved.max((change * young).abs());
        }
        if moved < 1e-13 * c {
            break;
        }
    }
    stress
}

#[test]
fn the_return_is_the_solution_of_the_complementarity_problem() {
    let mut seed = 12345u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    for (young, poisson, c, friction, dilation, tension) in [
        (1000.0, 0.3, 1.0, 30.0, 30.0, None),
        (1000.0, 0.3, 1.0, 30.0, 10.0, None),
        (1000.0, 0.2, 1.0, 40.0, 0.0, None),
        (1000.0, 0.0, 2.0, 25.0, 25.0, Some(1.0)),
        (1000.0, 0.3, 1.0, 35.0, 5.0, Some(0.2)),
        (1000.0, 0.4, 1.0, 0.0, 0.0, Some(0.5)),
        (1000.0, 0.45, 1.0, 0.0, 0.0, None),
    ] {
        let e = elasticity(young, poisson);
        let model = mohr_coulomb(e, c, friction, dilation, tension);
        let apex = if friction > 0.0 { c / friction.to_radians().tan() } else { f64::INFINITY };
        let largest = tension.unwrap_or(f64::INFINITY).min(apex);
        let mut yielded = 0;
        for n in 0..300 {
            let size = 1e-3 * 10f64.powf((n % 5) as f64 * 0.5);
            let trial: [f64; 3] = std::array::from_fn(|_| size * random());
            let r = model.respond(0.0, &trial, &State::default(), &mut []);
            let expected = swept(young, poisson, c, [friction, dilation], largest, &trial);
            yielded += usize::from(r.yielding);
            for k in 0..3 {
                let scale = c + expected[k].abs();
                assert!(
                    (r.stress[k] - expected[k]).abs() <= 1e-7 * scale,
                    "{friction} {dilation} {tension:?} {trial:?}: {:?}, not {expected:?}",
                    r.stress
                );
            }
        }
        assert!(yielded > 100);
    }
}

/// Tresca is Mohr–Coulomb without friction, to the bit.
#[test]
fn tresca_is_frictionless_mohr_coulomb() {
    let e = elasticity(300.0, 0.49);
    let (a, b) = (Tresca::new(e, Profile::constant(2.0)).unwrap(), mohr_coulomb(e, 2.0, 0.0, 0.0, None));
    for trial in [[0.1, 0.02, -0.1], [0.1, 0.099, -0.2], [0.2, -0.1, -0.1], [1e-3, 0.0, 0.0]] {
        assert_eq!(
            a.respond(0.0, &trial, &State::default(), &mut []),
            b.respond(0.0, &trial, &State::default(), &mut [])
        );
    }
}

/// Parameters out of range are named, with their value.
#[test]
fn ranges_are_checked() {
    for (friction, dilation, name) in [
        (-1.0, 0.0, "friction"),
        (90.0, 0.0, "friction"),
        (f64::NAN, 0.0, "friction"),
        (30.0, 31.0, "dilation"),
        (30.0, -1.0, "dilation"),
    ] {
        let error = Friction::degrees(friction, dilation).unwrap_err();
        assert_eq!((error.place.as_str(), error.exit_status()), (name, 2), "{error}");
    }
    let e = elasticity(1000.0, 0.3);
    let friction = Friction::degrees(30.0, 0.0).unwrap();
    let build = |c: f64, t: f64| MohrCoulomb::new(e, Profile::constant(c), friction, Some(Profile::constant(t)));
    assert!(build(1.0, 1.8).unwrap_err().problem.contains("apex"));
    assert_eq!(build(-1.0, 0.0).unwrap_err().place, "cohesion");
    assert_eq!(build(1.0, -0.1).unwrap_err().place, "tension");
    assert!(build(0.0, 0.0).is_ok());
    assert!(MohrCoulomb::new(e, Profile::constant(0.0), Friction::degrees(0.0, 0.0).unwrap(), None).is_err());

    let softening = Profile::growing(5.0, -1.0, 0.0);
    let clay = Tresca::new(e, softening).unwrap();
    assert!(clay.check(-4.0).is_ok());
    assert!(clay.check(-5.0).unwrap_err().to_string().contains("shear_strength"));
    assert!(Tresca::new(e, Profile::constant(0.0)).is_err());
}

/// Soil that is sheared at constant volume dilates until its plastic volume strain is that of the cut-off, in small steps as in large ones, and not beyond:
/// then its mean stress stays.
#[test]
fn dilation_ends_at_its_cutoff() {
    let cutoff = 3e-3;
    let dense = mohr_coulomb(elasticity(1e4, 0.3), 1.0, 35.0, 15.0, None);
    let ends = dense.dilating_until(cutoff).unwrap();
    let shear = |model: &MohrCoulomb, steps: usize| {
        let mut internal = [0.0];
        let (mut elastic, mut mean) = ([-1e-3; 3], Vec::new());
        for _ in 0..steps {
            let by = 0.05 / steps as f64;
            let trial = [elastic[0] - by, elastic[1] + 0.5 * by, elastic[2] + 0.5 * by];
            let before = internal;
            let state = State { internal: &before, ..State::default() };
            let response = model.respond(0.0, &trial, &state, &mut internal);
            elastic = response.elastic_strain;
            mean.push(response.stress.iter().sum::<f64>() / 3.0);
            assert!(internal[0] <= cutoff + 1e-12, "{internal:?}");
        }
        (internal[0], mean)
    };
    let bulk = 1e4 / (3.0 * 0.4);
    for steps in [2, 7, 200] {
        let (grown, mean) = shear(&ends, steps);
        let last = mean.last().unwrap();
        assert!((grown - cutoff).abs() < 1e-12, "{steps} steps: {grown}");
        // The volume is constant: what has dilated is compressed.
        assert!((last / (-bulk * (3e-3 + cutoff)) - 1.0).abs() < 1e-9, "{steps} steps: {last}");
    }
    // Without a cut-off it goes on.
    let mut internal = [0.0];
    let strain = [-0.05 - 1e-3, 0.025 - 1e-3, 0.025 - 1e-3];
    let response = dense.respond(0.0, &strain, &State::default(), &mut internal);
    assert!(response.stress.iter().sum::<f64>() / 3.0 < -2.0 * bulk * (3e-3 + cutoff), "{response:?}");
    assert!(dense.dilating_until(-0.1).is_err());
}

/// The tangent of soil whose dilation ends is the derivative of its stress: before the cut-off, in the step that comes to it, after it; on faces, edges
/// and in tension.
#[test]
fn the_tangent_where_dilation_ends_is_the_derivative() {
    let model = mohr_coulomb(elasticity(1e4, 0.3), 1.0, 35.0, 15.0, Some(0.5)).dilating_until(2e-3).unwrap();
    let step = 1e-9;
    let mut within = 0;
    for (a, b, c) in
        [(5e-3, 1e-3, -8e-3), (5e-3, 4.9e-3, -9e-3), (2e-3, -5e-3, -5.2e-3), (6e-3, 2e-3, -3e-3), (2e-3, 0.0, -4e-3)]
    {
        for grown in [0.0, 1e-3, 1.9e-3, 2e-3] {
            let internal = [grown];
            let state = State { internal: &internal, ..State::default() };
            let respond = |trial: &[f64; 3]| {
                let mut after = internal;
                let response = model.respond(0.0, trial, &state, &mut after);
                (response, after[0])
            };
            let trial = [a, b, c];
            let (response, after) = respond(&trial);
            within += usize::from(grown < 2e-3 && (after - 2e-3).abs() < 1e-12);
            for j in 0..3 {
                let [up, down] = [step, -step].map(|by| {
                    let mut other = trial;
                    other[j] += by;
                    respond(&other).0.stress
                });
                for i in 0..3 {
                    let slope = (up[i] - down[i]) / (2.0 * step);
                    let error = (slope - response.tangent[i][j]).abs();
                    assert!(error < 1e-4 * 1e4, "{trial:?}, {grown}: {slope} {}", response.tangent[i][j]);
                }
            }
        }
    }
    assert!(within >= 4, "{within}");
}
