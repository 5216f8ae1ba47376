//! Clay that swells along a line against closed forms: those of the literature, which hold for `K = p/κ̂`.

use super::super::{CamClay, Swelling};
use super::{M, P_C, invariants};
use crate::material::State;
use crate::material::driver::{Control, drive_from};
use crate::material::{Kind, Model, Parameters, Profile, Response};

const SWELLING: f64 = 0.02;
const COMPRESSION: f64 = 0.1;
const LEAST: f64 = 1.0;
const POISSON: f64 = 0.3;

fn model() -> CamClay {
    let swelling = Swelling::new(SWELLING, LEAST, Profile::constant(P_C)).unwrap();
    CamClay::with_swelling(swelling, POISSON, M, Profile::constant(P_C), COMPRESSION - SWELLING).unwrap()
}

/// Principal stresses in compression along the third axis, of the mean pressure `p` and `q` (kPa).
fn triaxial(p: f64, q: f64) -> [f64; 3] {
    [q / 3.0 - p, q / 3.0 - p, -2.0 * q / 3.0 - p]
}

fn undrained(from: &[f64; 3], axial: f64, steps: i32) -> Vec<Response> {
    let path = (1..=steps).map(|n| {
        let e = axial * f64::from(n) / f64::from(steps);
        [Control::Strain(0.5 * e), Control::Strain(0.5 * e), Control::Strain(-e)]
    });
    let model = model();
    drive_from(&model, 0.0, model.elastic_strain(0.0, from), path).unwrap()
}

/// From no stress on: κ̂ below the least pressure in proportion, then κ̂ ln p, then λ̂ ln p, and κ̂ ln p back, in any steps.
#[test]
fn isotropic_lines_have_the_slopes_of_compression_and_swelling() {
    let model = model();
    let first = SWELLING * (1.0 + (P_C / LEAST).ln());
    for count in [1, 7, 100] {
        let all = |from: f64, to: f64| {
            (1..=count)
                .map(move |n| [Control::Strain(-(from + (to - from) * f64::from(n) / f64::from(count)) / 3.0); 3])
        };
        let path: Vec<_> =
            all(0.0, 0.01).chain(all(0.01, first)).chain(all(first, 0.4)).chain(all(0.4, 0.35)).collect();
        let history = drive_from(&model, 0.0, [0.0; 3], path).unwrap();
        let p: Vec<f64> = history.chunks(count as usize).map(|leg| invariants(&leg[leg.len() - 1].stress).0).collect();
        let most = P_C * ((0.4 - first) / COMPRESSION).exp();
        let exact = [LEAST * 0.01 / SWELLING, P_C, most, most * (-0.05 / SWELLING).exp()];
        for (p, exact) in p.iter().zip(exact) {
            assert!((p / exact - 1.0).abs() < 1e-12, "{count}: {p} {exact}");
        }
        let yields = |leg: usize| history[leg * count as usize..][..count as usize].iter().all(|r| r.yielding);
        assert!(yields(2) && !yields(3) && !yields(1));
    }
}

/// Undrained, p/p₀ = [(M² + η₀²)/(M² + η²)]^(Λ/λ̂) from a stress on the surface on (Wood 1990, *Soil Behaviour and Critical State
/// Soil Mechanics*, §5.4), in any steps; it ends at the strength s_u = ½ M p₀ (R/2)^(Λ/λ̂).
#[test]
fn undrained_paths_and_strengths_are_those_of_the_literature() {
    let power = (COMPRESSION - SWELLING) / COMPRESSION;
    for eta in [0.0, 0.4, 0.75] {
        let p0 = P_C / (1.0 + (eta / M).powi(2));
        for steps in [20, 500] {
            let history = undrained(&triaxial(p0, eta * p0), 0.5, steps);
            for r in &history {
                let (p, q) = invariants(&r.stress);
                let exact = p0 * ((M * M + eta * eta) / (M * M + (q / p).powi(2))).powf(power);
                assert!(r.yielding && (p / exact - 1.0).abs() < 1e-10, "{eta}: {p} {exact}");
            }
        }
    }
    for ratio in [1.0, 1.5, 2.0, 4.0, 10.0] {
        let p0 = P_C / ratio;
        let history = undrained(&triaxial(p0, 0.0), 1.0, 400);
        for r in history.iter().filter(|r| !r.yielding) {
            assert!((invariants(&r.stress).0 / p0 - 1.0).abs() < 1e-12, "shear alone changes no pressure");
        }
        let (p, q) = invariants(&history[history.len() - 1].stress);
        let strength = 0.5 * M * p0 * (0.5 * ratio).powf(power);
        println!("R = {ratio}: s_u {:.1e} off", 0.5 * q / strength - 1.0);
        assert!((0.5 * q / strength - 1.0).abs() < 1e-4 && (q / p / M - 1.0).abs() < 1e-4, "{ratio}: {q} {strength}");
    }
}

/// Drained, along dq/dp = 3 the soil fails at q = M p, with the volume of the critical state there; half the step halves the error.
#[test]
fn drained_triaxial_compression_ends_at_the_critical_state() {
    let model = model();
    let p0 = 80.0;
    let start = model.elastic_strain(0.0, &[-p0; 3]);
    let drained = |axial: f64, steps: i32| {
        let axial = (1..=steps).map(|n| -axial * f64::from(n) / f64::from(steps));
        let path = axial.map(|e| [Control::Stress(-p0), Control::Stress(-p0), Control::Strain(e)]);
        drive_from(&model, 0.0, start, path).unwrap()
    };
    let history = drained(1.5, 3000);
    let last = &history[history.len() - 1];
    let (p, q) = invariants(&last.stress);
    let exact = p0 / (1.0 - M / 3.0);
    assert!((p / exact - 1.0).abs() < 1e-4 && (q / (M * exact) - 1.0).abs() < 1e-4, "{p} {q} {exact}");
    let volume = SWELLING * (exact / p0).ln() + (COMPRESSION - SWELLING) * (2.0 * exact / P_C).ln();
    // The size of the yield surface tells the plastic volume strain.
    let plastic = model.compressibility * ((p + (q / M).powi(2) / p) / P_C).ln();
    let reached = plastic + SWELLING * (p / p0).ln();
    assert!((reached / volume - 1.0).abs() < 1e-3, "{reached} {volume}");

    let q = |steps: i32| drained(0.05, steps).last().map(|r| invariants(&r.stress).1).unwrap();
    let fine = q(10_000);
    let errors = [20, 40, 80, 160].map(|steps| (q(steps) / fine - 1.0).abs());
    println!("drained: p {:.1e} off; q in 20, 40, 80, 160 steps {errors:?} off", p / exact - 1.0);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((0.8..1.3).contains(&order), "{errors:?}");
    }
    assert!(errors[0] < 0.02, "{errors:?}");
}

/// A closed cycle within the yield surface, through the least pressure and at other ratios of stress on the way up and down, gives back
/// the strain to the last bits, and the work that goes in comes out: what is left falls with the square of the step.
#[test]
fn elastic_cycles_do_no_work() {
    let model = model();
    let corners = [[5.0, 0.0], [80.0, 0.0], [80.0, 40.0], [30.0, 30.0], [0.2, 0.1], [5.0, 0.0]];
    let net = |segments: i32| {
        let stress = corners.windows(2).flat_map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            (1..=segments).map(move |n| {
                let part = f64::from(n) / f64::from(segments);
                triaxial(from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]))
            })
        });
        let start = model.elastic_strain(0.0, &triaxial(5.0, 0.0));
        let history = drive_from(&model, 0.0, start, stress.map(|s| s.map(Control::Stress))).unwrap();
        assert!(history.iter().all(|r| !r.yielding));
        let mut before = (model.elastic_stress(0.0, &start), start);
        let (mut work, mut turned): (f64, f64) = (0.0, 0.0);
        for r in &history {
            let done: f64 =
                (0..3).map(|k| 0.5 * (before.0[k] + r.stress[k]) * (r.elastic_strain[k] - before.1[k])).sum();
            (work, turned) = (work + done, turned + done.abs());
            before = (r.stress, r.elastic_strain);
            let stored = model.elastic_energy(0.0, &r.elastic_strain) - model.elastic_energy(0.0, &start);
            assert!(segments < 1000 || (work - stored).abs() < 1e-4 * turned, "{work} {stored}");
        }
        for k in 0..3 {
            assert!((before.1[k] - start[k]).abs() < 1e-13, "{before:?}");
        }
        work.abs() / turned
    };
    let (coarse, fine) = (net(1000), net(4000));
    println!("work left of a cycle: {coarse:.1e}, {fine:.1e} of what turned over");
    assert!(coarse < 1e-4 && fine < 0.1 * coarse, "{coarse:e} {fine:e}");
}

/// Isotropic unloading below the least pressure ends stress-free, and what is pulled further loses its surface and bears nothing.
#[test]
fn clay_pulled_apart_bears_nothing() {
    let model = model();
    let path = (1..=50).map(|n| [Control::Strain(0.002 * f64::from(n)); 3]);
    let history = drive_from(&model, 0.0, model.elastic_strain(0.0, &[-50.0; 3]), path).unwrap();
    for r in &history {
        assert!(invariants(&r.stress).0 >= -1e-9 && r.tangent.iter().flatten().all(|x| x.is_finite()));
    }
    assert!(invariants(&history[49].stress).0.abs() < 1e-9);
}

fn build(entries: &[(&str, f64)]) -> crate::error::Result<std::sync::Arc<dyn Model>> {
    let Kind { build, .. } = super::super::KIND;
    build(
        &[("poisson", 0.3), ("critical_slope", 1.0), ("preconsolidation", 50.0)]
            .iter()
            .chain(entries)
            .collect::<Parameters>(),
    )
}

/// The slopes that a case gives are those of the oedometer, in the logarithm of the Cauchy pressure: `ε = λ* ln(p/p₀)` for clay on the
/// virgin line, `κ*` back, whatever the strain.
#[test]
fn slopes_are_those_of_the_cauchy_pressure() {
    for (swelling, compression) in [(0.02, 0.1), (0.05, 0.25)] {
        let clay = build(&[("swelling", swelling), ("compression", compression)]).unwrap();
        let start = clay.elastic_strain(0.0, &[-50.0; 3]);
        let path = [0.4, 0.35].map(|strain: f64| [Control::Strain(-strain / 3.0); 3]);
        let history = drive_from(&*clay, 0.0, start, path).unwrap();
        let cauchy = |n: usize, strain: f64| invariants(&history[n].stress).0 * strain.exp();
        let (loaded, back) = (cauchy(0, 0.4), cauchy(1, 0.35));
        println!(
            "ln p by λ* {:.1e} off, by κ* {:.1e}",
            (loaded / 50.0).ln() * compression - 0.4,
            (loaded / back).ln() * swelling - 0.05
        );
        assert!(((loaded / 50.0).ln() * compression - 0.4).abs() < 1e-12, "{loaded}");
        assert!(((loaded / back).ln() * swelling - 0.05).abs() < 1e-12, "{back}");
    }
}

/// λ* and κ* say what their difference and κ* say; what excludes or needs each other is told, at the entry that is to go.
#[test]
fn parameters_that_do_not_go_together_are_refused() {
    let pair = build(&[("swelling", 0.02), ("compression", 0.1)]).unwrap();
    let difference = build(&[("swelling", 0.02), ("plastic_compressibility", 0.08)]).unwrap();
    let strain = [-0.05, -0.04, -0.02];
    let respond = |m: &dyn Model| m.respond(0.0, &strain, &State::default(), &mut [0.0]).stress;
    for (a, b) in respond(&*pair).iter().zip(respond(&*difference)) {
        assert!((a / b - 1.0).abs() < 1e-12);
    }
    // K = p (1 − κ*)/κ* and ν at the preconsolidation pressure.
    assert!((pair.elasticity().at(0.0).bulk() / 2450.0 - 1.0).abs() < 1e-14);
    let reference = build(&[("swelling", 0.02), ("compression", 0.1), ("reference_pressure", 10.0)]).unwrap();
    assert!((reference.elasticity().at(0.0).bulk() / 490.0 - 1.0).abs() < 1e-14);
    let ratio = pair.elasticity().at(0.0).shear / reference.elasticity().at(0.0).shear;
    assert!((ratio - 5.0).abs() < 1e-13);
    for (entries, place) in [
        (&[("plastic_compressibility", 0.1)][..], "young"),
        (&[("swelling", 0.02), ("young", 1e3), ("compression", 0.1)], "swelling"),
        (&[("swelling", 0.02)], "compression"),
        (&[("swelling", 0.02), ("compression", 0.1), ("plastic_compressibility", 0.08)], "compression"),
        (&[("swelling", 0.02), ("compression", 0.02)], "compression"),
        (&[("swelling", 0.02), ("compression", 1.0)], "compression"),
        (&[("swelling", 0.5), ("plastic_compressibility", 0.5)], "plastic_compressibility"),
        (&[("swelling", 1.0), ("compression", 1.1)], "swelling"),
        (&[("young", 1e3), ("plastic_compressibility", 1.0)], "plastic_compressibility"),
        (&[("young", 1e3), ("compression", 0.1)], "compression"),
        (&[("young", 1e3), ("plastic_compressibility", 0.1), ("least_pressure", 1.0)], "least_pressure"),
        (&[("young", 1e3), ("plastic_compressibility", 0.1), ("reference_pressure", 1.0)], "reference_pressure"),
        (&[("swelling", 0.02), ("compression", 0.1), ("reference_pressure", -1.0)], "reference_pressure"),
        (&[("swelling", -0.02), ("compression", 0.1)], "swelling"),
        (&[("swelling", 0.02), ("compression", 0.1), ("least_pressure", 0.0)], "least_pressure"),
    ] {
        let error = build(entries).err().unwrap();
        assert_eq!(error.place, place, "{entries:?}: {error}");
    }
    let swelling = Swelling::new(SWELLING, LEAST, Profile::constant(P_C)).unwrap();
    let error = CamClay::with_swelling(swelling, 0.5, M, Profile::constant(P_C), 0.1).unwrap_err();
    assert_eq!(error.place, "poisson");
    // A preconsolidation that is the reference, too, is told as what was given.
    let falling = Profile::growing(P_C, -10.0, 0.0);
    let swelling = Swelling::new(SWELLING, LEAST, falling).unwrap();
    let clay = CamClay::with_swelling(swelling, POISSON, M, falling, 0.1).unwrap();
    assert_eq!(clay.check(-P_C).unwrap_err().place, "preconsolidation");
    // A modulus beyond all numbers comes of the slope.
    let swelling = Swelling::new(1e-308, LEAST, Profile::constant(P_C)).unwrap();
    let error = CamClay::with_swelling(swelling, POISSON, M, Profile::constant(P_C), 0.1).unwrap_err();
    assert_eq!(error.place, "swelling");
}

/// Where the reference is below the least pressure, whose bulk modulus holds there, so is Poisson's ratio that of the least pressure.
#[test]
fn poisson_holds_below_the_least_pressure() {
    let reference = Profile::growing(0.1, 1.0, 0.0);
    let swelling = Swelling::new(SWELLING, 2.0, reference).unwrap();
    let clay = CamClay::with_swelling(swelling, POISSON, M, Profile::constant(P_C), 0.1).unwrap();
    for (y, pressure) in [(0.0, 2.0), (-1.0, 2.0), (-9.9, 10.0)] {
        let moduli = clay.elasticity().at(y);
        assert!((moduli.bulk() * SWELLING / pressure - 1.0).abs() < 1e-14, "{y}: {moduli:?}");
        assert!((clay.bulk_modulus(y, -reference.at(y)) / moduli.bulk() - 1.0).abs() < 1e-14, "{y}: {moduli:?}");
    }
}
