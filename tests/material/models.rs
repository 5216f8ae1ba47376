//! What every material model must satisfy, over the examples of the list of models: one test for all.

use mpm::material::{MODELS, Model, Parameters, State, internal_count};
use std::sync::Arc;

/// A small generator (xorshift64*, Vigna 2016) so that a failure can be run again.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn signed(&mut self) -> f64 {
        2.0 * self.uniform() - 1.0
    }

    /// Trial strains from well inside the yield surface to far outside, in every direction; some with equal
    /// or nearly equal entries, where edges are.
    fn trial(&mut self, model: &dyn Model) -> [f64; 3] {
        let scale = if model.yields() { model.shear_strength(0.0, &State::default()) / model.young(0.0) } else { 1e-2 };
        let size = scale * 10f64.powf(-0.7 + 3.0 * self.uniform());
        let mut e: [f64; 3] = std::array::from_fn(|_| size * self.signed());
        match (self.uniform() * 10.0) as usize {
            0 => e[1] = e[0],
            1 => e[2] = e[1] * (1.0 + 1e-13 * self.signed()),
            2 => e[0] = e[2] + size * 1e-9 * self.signed(),
            3 => e = [e[0]; 3],
            _ => {}
        }
        e
    }
}

/// Every example of every model.
fn models() -> Vec<(String, Arc<dyn Model>)> {
    let mut all = Vec::new();
    for kind in MODELS {
        assert!(!kind.examples.is_empty(), "{} has no examples", kind.name);
        for example in kind.examples {
            let parameters: Parameters = example.iter().collect();
            let model = (kind.build)(&parameters).unwrap_or_else(|e| panic!("{} {example:?}: {e}", kind.name));
            all.push((format!("{} {example:?}", kind.name), model));
        }
    }
    all
}

/// Internal variables of a model at first.
fn first(model: &dyn Model) -> Vec<f64> {
    let mut internal = vec![0.0; internal_count(model)];
    model.begin(0.0, &mut internal);
    internal
}

fn finite_strength(model: &dyn Model) -> f64 {
    let s = model.shear_strength(0.0, &State::default());
    if s.is_finite() { s } else { model.young(0.0) }
}

fn largest(v: &[f64; 3]) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Whether the mean stress is in proportion to the elastic volume strain.
fn is_linear(model: &dyn Model) -> bool {
    let [one, two] = [-0.1, -0.2].map(|strain| model.mean_stress(0.0, strain));
    (two - 2.0 * one).abs() <= 1e-9 * one.abs()
}

/// The elastic modulus `λ + 2G` (kPa), or the largest entry of a tangent where pressure makes the soil stiffer.
fn stiffness(model: &dyn Model, tangent: &[[f64; 3]; 3]) -> f64 {
    let elastic = model.elasticity().at(0.0).tangent()[0][0];
    if is_linear(model) { elastic } else { tangent.iter().flatten().fold(elastic, |most, x| most.max(x.abs())) }
}

/// The last bits of a stress of this size (kPa). Pressure that grows with the exponent of the strain has more of them, and a surface that is
/// closed under it is met to a part of its own size.
fn last_bits(model: &dyn Model, stress: &[f64; 3]) -> f64 {
    let part = if is_linear(model) { 4.0 * f64::EPSILON } else { 1e-12 };
    part * largest(stress)
}

const STATES: usize = 100_000;

/// Yield to 1e-10 of the strength, plastic work not negative, the elastic strain that of the stress, and a
/// second return changes nothing.
#[test]
fn returned_states_are_admissible() {
    for (name, model) in models() {
        let law = model.as_ref();
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let strength = finite_strength(&*model);
        for _ in 0..STATES {
            let trial = random.trial(&*model);
            let old = State { plastic_strain: 0.25, ..State::default() };
            let mut internal = first(&*model);
            let r = law.respond(0.0, &trial, &old, &mut internal);
            let new = State { plastic_strain: r.plastic_strain, internal: &internal.clone(), ..old };
            assert!(r.stress.iter().chain(&r.elastic_strain).all(|x| x.is_finite()), "{name}: {trial:?}");
            let excess = law.yield_excess(0.0, &r.stress, &new);
            // At mean stresses of 10⁵ times the strength the last bit of the stress itself is 1e-10 of it.
            let on_surface = 1e-10 * strength + last_bits(&*model, &r.stress);
            assert!(excess <= on_surface, "{name}: {trial:?}: outside by {excess:e}");
            if r.yielding {
                assert!(excess >= -on_surface, "{name}: {trial:?}: yields inside, {excess:e}");
            }

            let stress = model.elastic_stress(0.0, &r.elastic_strain);
            let work: f64 = (0..3).map(|k| r.stress[k] * (trial[k] - r.elastic_strain[k])).sum();
            let rounding = 1e-11 * (largest(&r.stress) + strength);
            for k in 0..3 {
                assert!((stress[k] - r.stress[k]).abs() <= rounding, "{name}: {trial:?}: {stress:?} {r:?}");
            }
            assert!(work >= -rounding * largest(&trial), "{name}: {trial:?}: plastic work {work:e}");
            assert_eq!(r.yielding, r.plastic_strain > old.plastic_strain, "{name}: {trial:?}");

            let again = law.respond(0.0, &r.elastic_strain, &new, &mut internal);
            let change = again.plastic_strain - r.plastic_strain;
            assert!(change <= 1e-11 * (largest(&trial) + strength / model.young(0.0)), "{name}: {trial:?}: {change:e}");
            for k in 0..3 {
                assert!((again.stress[k] - r.stress[k]).abs() <= rounding, "{name}: {trial:?}: {r:?} {again:?}");
            }
        }
    }
}

/// Axes have no names: permuted strains give the permuted response. The tangent is symmetric where claimed.
#[test]
fn responses_are_isotropic() {
    const ORDERS: [[usize; 3]; 5] = [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    for (name, model) in models() {
        let mut random = Random(0xA076_1D64_78BD_642F);
        let respond = |trial: &[f64; 3]| model.respond(0.0, trial, &State::default(), &mut first(&*model));
        let mut asymmetric = false;
        for _ in 0..STATES / 10 {
            let trial: [f64; 3] = random.trial(&*model);
            let r = respond(&trial);
            let scale = 1e-10 * (largest(&r.stress) + finite_strength(&*model));
            let stiffness = stiffness(&*model, &r.tangent);
            let distinct =
                (trial[0] - trial[1]).abs().min((trial[1] - trial[2]).abs()).min((trial[0] - trial[2]).abs())
                    > 1e-6 * largest(&trial);
            for order in ORDERS {
                let p = respond(&order.map(|k| trial[k]));
                for a in 0..3 {
                    assert!((p.stress[a] - r.stress[order[a]]).abs() <= scale, "{name}: {trial:?} {order:?}");
                    for b in 0..3 {
                        let difference = p.tangent[a][b] - r.tangent[order[a]][order[b]];
                        assert!(!distinct || difference.abs() <= 1e-10 * stiffness, "{name}: {trial:?} {order:?}");
                    }
                }
            }
            for a in 0..3 {
                for b in 0..a {
                    let difference = (r.tangent[a][b] - r.tangent[b][a]).abs();
                    asymmetric |= difference > 1e-3 * stiffness;
                    assert!(!model.symmetric() || difference <= 1e-10 * stiffness, "{name}: {trial:?}");
                }
            }
        }
        assert_eq!(asymmetric, !model.symmetric(), "{name}: symmetric() says otherwise");
    }
}

/// Strains of any size, down to nothing and up to e¹⁰⁰, give a finite answer; none gives none.
#[test]
fn extreme_strains_are_survived() {
    for (name, model) in models() {
        let law = model.as_ref();
        let rest = law.respond(0.0, &[0.0; 3], &State::default(), &mut first(&*model));
        assert_eq!(rest.stress, [0.0; 3], "{name}");
        assert!(!rest.yielding, "{name}");
        let strength = finite_strength(&*model);
        for size in [1e-300, 1e-30, 1e-16, 1e-8, 1.0, 10.0, 50.0, 100.0] {
            for direction in [
                [1.0, 1.0, 1.0],
                [1.0, -0.5, -0.5],
                [1.0, 0.0, -1.0],
                [0.5, 0.5, -1.0],
                [-1.0, -1.0, -1.0],
                [0.0, 0.0, -1.0],
            ] {
                let trial = direction.map(|x| x * size);
                let mut internal = first(&*model);
                let r = law.respond(0.0, &trial, &State::default(), &mut internal);
                let entries = r.stress.iter().chain(&r.elastic_strain).chain(r.tangent.iter().flatten());
                assert!(entries.chain([&r.plastic_strain]).all(|x| x.is_finite()), "{name}: {trial:?}");
                // Rounding of a trial stress of λ + 2G times the strain is all that may show.
                let rounding = 1e-14 * stiffness(&*model, &r.tangent) * size + last_bits(&*model, &r.stress);
                let after = State { internal: &internal, ..State::default() };
                let excess = law.yield_excess(0.0, &r.stress, &after);
                assert!(excess <= 1e-10 * strength + rounding, "{name}: {trial:?}: {excess:e}");
            }
        }
    }
}

/// Elastic strain and stress are each other's inverse.
#[test]
fn elastic_strain_inverts_the_stress() {
    for (name, model) in models() {
        let mut random = Random(0xE703_7ED1_A0B4_28DB);
        for _ in 0..1000 {
            let stress = std::array::from_fn(|_| random.signed() * finite_strength(&*model));
            let strain = model.elastic_strain(0.0, &stress);
            let back = model.elastic_stress(0.0, &strain);
            for k in 0..3 {
                assert!((back[k] - stress[k]).abs() <= 1e-11 * largest(&stress), "{name}: {stress:?} {back:?}");
            }
        }
    }
}

/// The list tells the case which models yield, and which can be built again with another Poisson's ratio.
#[test]
fn the_list_knows_its_models() {
    for kind in MODELS {
        for example in kind.examples {
            let parameters: Parameters = example.iter().collect();
            assert_eq!((kind.build)(&parameters).unwrap().yields(), kind.yields, "{}", kind.name);
            if !kind.keeps_volume {
                continue;
            }
            let other: Parameters =
                example.iter().map(|entry| if entry.0 == "poisson" { &("poisson", -0.9) } else { entry }).collect();
            let model = (kind.build)(&other).unwrap_or_else(|e| panic!("{}: {e}", kind.name));
            assert_eq!(model.elasticity().poisson(), -0.9, "{}", kind.name);
            assert!(example.iter().any(|(name, _)| *name == "young"), "{}", kind.name);
        }
    }
}

/// The list tells the case what a model takes: each required parameter is needed, and named when missing.
#[test]
fn missing_parameters_are_named() {
    for kind in MODELS {
        for missing in kind.parameters.iter().filter(|p| p.required) {
            let rest: Parameters = kind.examples[0].iter().filter(|(n, _)| *n != missing.name).collect();
            let error = (kind.build)(&rest).err().unwrap_or_else(|| panic!("{} without {}", kind.name, missing.name));
            assert!(error.to_string().contains(missing.name), "{error}");
            assert_eq!(error.exit_status(), 2);
        }
        for (name, _) in kind.examples.iter().flat_map(|e| e.iter()) {
            assert!(kind.parameters.iter().any(|p| p.name == *name), "{}: {name} is not a parameter", kind.name);
        }
    }
}

/// Simple shear as large as the shear strength is on the yield surface, in every state; in Cam-Clay under half the
/// preconsolidation pressure.
#[test]
fn the_shear_strength_yields_in_simple_shear() {
    let mut seen = 0;
    for (name, model) in models().iter().filter(|(name, model)| model.yields() && !name.starts_with("mohr_coulomb")) {
        let law = model.as_ref();
        for internal in [0.0, 0.02, 0.5] {
            let state = State { internal: &[internal], ..State::default() };
            let strength = model.shear_strength(0.0, &state);
            // The yield function of Cam-Clay under a pressure of 1 is 1/p_c − 1.
            let excess = |stress: [f64; 3]| law.yield_excess(0.0, &stress, &state);
            let pressure = if name.starts_with("cam_clay") { 0.5 / (1.0 + excess([-1.0; 3])) } else { 7.0 };
            let excess = excess([strength - pressure, -pressure, -strength - pressure]);
            assert!(strength > 0.0 && excess.abs() < 1e-10 * strength, "{name}: {state:?}: {excess:e} of {strength}");
            seen += 1;
        }
    }
    assert!(seen >= 15, "{seen}");
}

/// A state with a strength of its own is one of the model whose strengths are multiplied by it. What voids add to the stress is not (`tension_limit`).
#[test]
fn the_strength_of_a_state_is_that_of_the_model_times_a_factor() {
    for (name, model) in models().iter().filter(|(name, model)| model.yields() && !name.contains("tension_limit")) {
        let mut random = Random(0x2545_F491_4F6C_DD1D);
        for factor in [0.3, 0.8, 1.7] {
            let (other, state) = (model.reduced(1.0 / factor), State { strength: factor, ..State::default() });
            let [law, other_law] = [model, &other];
            let [own, expected] = [model.shear_strength(0.0, &state), other.shear_strength(0.0, &State::default())];
            assert!(own == expected || (own / expected - 1.0).abs() < 1e-14, "{name}: {own} {expected}");
            for _ in 0..2000 {
                let trial = random.trial(model.as_ref());
                let [mut internal, mut other_internal] = [first(model.as_ref()), first(other.as_ref())];
                let a = law.respond(0.0, &trial, &state, &mut internal);
                let b = other_law.respond(0.0, &trial, &State::default(), &mut other_internal);
                let unit = 1e-9 * (finite_strength(model.as_ref()) + largest(&a.stress));
                for k in 0..3 {
                    assert!((a.stress[k] - b.stress[k]).abs() <= unit, "{name} {factor}: {trial:?}: {a:?} {b:?}");
                }
                let excess = [
                    law.yield_excess(0.0, &a.stress, &state),
                    other_law.yield_excess(0.0, &a.stress, &State::default()),
                ];
                assert!((excess[0] - excess[1]).abs() <= unit, "{name} {factor}: {trial:?}: {excess:?}");
            }
        }
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// `∂τ/∂ε` against central differences, to 1e-5 of the elastic modulus `λ + 2G`. Where one-sided differences disagree
    /// there is a kink within the step; only few such states may be met.
    #[test]
    fn tangents_are_the_derivative_of_the_stress() {
        for (name, model) in models() {
            let mut random = Random(0xD1B5_4A32_D192_ED03);
            let (law, state, before) = (model.as_ref(), State::default(), first(&*model));
            let mut kinks = 0;
            for _ in 0..STATES {
                let trial = random.trial(&*model);
                let h = 1e-6 * largest(&trial).max(finite_strength(&*model) / model.young(0.0));
                let r = law.respond(0.0, &trial, &state, &mut before.clone());
                let stiffness = stiffness(&*model, &r.tangent);
                let mut kink = false;
                let mut error: f64 = 0.0;
                for b in 0..3 {
                    let moved = |by: f64| {
                        let mut t = trial;
                        t[b] += by;
                        law.respond(0.0, &t, &state, &mut before.clone()).stress
                    };
                    let (up, down) = (moved(h), moved(-h));
                    for a in 0..3 {
                        let (right, left) = ((up[a] - r.stress[a]) / h, (r.stress[a] - down[a]) / h);
                        kink |= (right - left).abs() > 1e-4 * stiffness;
                        error = error.max((0.5 * (right + left) - r.tangent[a][b]).abs() / stiffness);
                    }
                }
                if kink {
                    kinks += 1;
                } else {
                    assert!(error <= 1e-5, "{name}: {trial:?}: tangent off by {error:e}: {r:?}");
                }
            }
            // Four in ten states are built to have equal or nearly equal strains, where apices and edges are.
            assert!(kinks < STATES / 3, "{name}: {kinks} kinks");
        }
    }
}
