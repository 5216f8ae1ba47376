//! The spatial stress and tangent against differences of the stress with the deformation gradient, for every model.

use mpm::material::{LinearElastic, MODELS, Model, Parameters, State, internal_count, spatial};
use mpm::tensor::{Symmetric, Tensor, full, symmetric};
use std::sync::Arc;

struct Random(u64);

impl Random {
    fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A gradient of size `size`; in the plane only the hoop beside the plane part.
    fn gradient(&mut self, size: f64, plane: bool) -> Tensor {
        Tensor::from_fn(|i, j| {
            let x = size * self.signed();
            if plane && i != j && (i == 2 || j == 2) { 0.0 } else { x }
        })
    }

    /// A deformation between near the yield strain and far beyond it, on top of a rotation and stretch.
    fn trial(&mut self, model: &dyn Model, plane: bool) -> Tensor {
        let strength =
            if model.yields() { model.shear_strength(0.0, &State::default()) / model.young(0.0) } else { 0.1 };
        let size = (strength * 10f64.powf(0.2 + 0.8 * self.signed())).min(0.3);
        let angle = self.signed();
        let turn = Tensor::new(angle.cos(), -angle.sin(), 0.0, angle.sin(), angle.cos(), 0.0, 0.0, 0.0, 1.0);
        turn * (Tensor::identity() + self.gradient(size, plane))
    }
}

fn models() -> Vec<(String, Arc<dyn Model>)> {
    let build = |kind: &mpm::material::Kind, example: &[(&str, f64)]| {
        (format!("{} {example:?}", kind.name), (kind.build)(&example.iter().collect::<Parameters>()).unwrap())
    };
    MODELS.iter().flat_map(|k| k.examples.iter().map(move |e| build(k, e))).collect()
}

/// Room for the internal variables of a model.
fn room(model: &dyn Model) -> Vec<f64> {
    vec![0.0; internal_count(model)]
}

fn left(f: &Tensor) -> Symmetric {
    symmetric(&(f * f.transpose()))
}

/// The row (i, j) of the plane tangent.
const PLANE: [(usize, usize); 5] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)];

/// `P = τ F⁻ᵀ`, whose change with `δF = l F` is `δP_iJ F_jJ = a_ijkl l_kl`: compared with central
/// differences along random `l`, away from kinks, and that for F of many sizes.
fn check(
    plane: bool,
    stress: impl Fn(&dyn Model, &Tensor) -> (Tensor, bool),
    predict: impl Fn(&dyn Model, &Tensor, &Tensor) -> Tensor,
) {
    for (name, model) in models() {
        let mut random = Random(7);
        let (mut compared, mut kinks, mut yielded) = (0, 0, 0);
        let stiffness = model.elasticity().at(0.0).tangent()[0][0];
        for _ in 0..1000 {
            let f = random.trial(&*model, plane);
            let l = random.gradient(1.0, plane);
            // Shorter steps drown in the rounding of F, longer ones meet kinks.
            let h = 3e-5 * (left(&f).map(f64::ln)[0]).abs().clamp(1e-4, 1e-1);
            let pulled = |by: f64| {
                let moved = f + l * f * by;
                let (t, _) = stress(&*model, &moved);
                t * moved.try_inverse().unwrap().transpose() * f.transpose()
            };
            let central = |h: f64| (pulled(h) - pulled(-h)) / (2.0 * h);
            let (coarse, fine) = (central(2.0 * h), central(h));
            // A kink within the step, or roots so close that the axes turn within it.
            if (coarse - fine).amax() > 1e-6 * stiffness {
                kinks += 1;
                continue;
            }
            compared += 1;
            yielded += usize::from(stress(&*model, &f).1);
            let error = (fine + (fine - coarse) / 3.0 - predict(&*model, &f, &l)).amax();
            assert!(error <= 1e-6 * stiffness, "{name}: {f:?} off by {:e}", error / stiffness);
        }
        assert!(kinks < 100 && (yielded > 300 || !model.yields()), "{name}: {compared} {kinks} {yielded}");
    }
}

#[test]
fn plane_tangent_is_the_derivative() {
    let respond =
        |m: &dyn Model, f: &Tensor| spatial::plane(m, 0.0, &left(f), &State::default(), &mut room(m)).unwrap();
    check(
        true,
        |m, f| {
            let r = respond(m, f);
            (full(&r.kirchhoff), r.yielding)
        },
        |m, f, l| {
            let a = respond(m, f).tangent;
            let mut p = Tensor::zeros();
            for (row, ij) in PLANE.iter().enumerate() {
                p[*ij] = PLANE.iter().enumerate().map(|(col, kl)| a[row][col] * l[*kl]).sum();
            }
            p
        },
    );
}

#[test]
fn solid_tangent_is_the_derivative() {
    let respond =
        |m: &dyn Model, f: &Tensor| spatial::solid(m, 0.0, &left(f), &State::default(), &mut room(m)).unwrap();
    check(
        false,
        |m, f| {
            let r = respond(m, f);
            (full(&r.kirchhoff), r.yielding)
        },
        |m, f, l| {
            let a = respond(m, f).tangent;
            Tensor::from_fn(|i, j| (0..9).map(|kl| a[3 * i + j][kl] * l[(kl / 3, kl % 3)]).sum())
        },
    );
}

/// Where a model with friction yields, stiffening adds that part of the elastic tangent and changes nothing else; other models do not know it.
#[test]
fn stiffening_adds_a_part_of_the_elastic_tangent() {
    const PART: f64 = 0.3;
    let stiff = State { stiffening: PART, ..State::default() };
    let mut yielded = 0;
    for (name, model) in models() {
        let elastic = LinearElastic::new(*model.elasticity());
        let mut random = Random(7);
        for _ in 0..100 {
            let b = left(&random.trial(&*model, true));
            let plane =
                |model: &dyn Model, state: &State| spatial::plane(model, 0.0, &b, state, &mut room(model)).unwrap();
            let (without, with) = (plane(&*model, &State::default()), plane(&*model, &stiff));
            assert_eq!((without.kirchhoff, without.elastic), (with.kirchhoff, with.elastic), "{name}");
            if !without.yielding || !model.has_friction() {
                assert_eq!(without.tangent, with.tangent, "{name}");
                continue;
            }
            yielded += 1;
            // The elastic tangent without the part of the stress, −τ_il δ_jk.
            let free = plane(&elastic, &State::default());
            let (stress, scale) = (full(&free.kirchhoff), free.tangent[0][0].abs());
            for (row, &(i, j)) in PLANE.iter().enumerate() {
                for (col, &(k, l)) in PLANE.iter().enumerate() {
                    let own = free.tangent[row][col] + if j == k { stress[(i, l)] } else { 0.0 };
                    let error = with.tangent[row][col] - without.tangent[row][col] - PART * own;
                    assert!(error.abs() < 1e-6 * scale, "{name}: {row} {col} {error} of {scale}");
                }
            }
        }
    }
    assert!(yielded > 300, "{yielded}");
}

/// The plane form is the solid form on plane deformations.
#[test]
fn plane_and_solid_agree() {
    for (name, model) in models() {
        let mut random = Random(11);
        for _ in 0..300 {
            let b = left(&random.trial(&*model, true));
            let state = State::default();
            let p = spatial::plane(&*model, 0.0, &b, &state, &mut room(&*model)).unwrap();
            let s = spatial::solid(&*model, 0.0, &b, &state, &mut room(&*model)).unwrap();
            let stiffness = model.elasticity().at(0.0).tangent()[0][0];
            for k in 0..6 {
                assert!((p.kirchhoff[k] - s.kirchhoff[k]).abs() <= 1e-13 * stiffness, "{name}");
                assert!((p.elastic[k] - s.elastic[k]).abs() <= 1e-13, "{name}");
            }
            for (row, (i, j)) in PLANE.iter().enumerate() {
                for (col, (k, l)) in PLANE.iter().enumerate() {
                    let solid = s.tangent[3 * i + j][3 * k + l];
                    assert!((p.tangent[row][col] - solid).abs() <= 1e-7 * stiffness, "{name}: {b:?}");
                }
            }
        }
    }
}

/// Equal and nearly equal roots: the tangent stays the derivative while the difference of the roots runs
/// through every size down to none.
#[test]
fn equal_roots_leave_no_mark() {
    for (name, model) in models() {
        let stiffness = model.elasticity().at(0.0).tangent()[0][0];
        let size =
            if model.yields() { 3.0 * model.shear_strength(0.0, &State::default()) / model.young(0.0) } else { 0.3 };
        for base in [[1.0, 1.0, 1.0], [1.0, 1.0, -2.0], [-1.0, -1.0, 1.7]] {
            let b = base.map(|e: f64| (2.0 * size * e).exp());
            let tangent = |gap: f64| {
                let b = [b[0] * (1.0 + gap), b[1] * (1.0 - gap), b[2], 0.3 * gap, 0.0, 0.0];
                spatial::plane(&*model, 0.0, &b, &State::default(), &mut room(&*model)).unwrap().tangent
            };
            let reference = tangent(0.0);
            for exponent in 5..17 {
                let gap = 10f64.powi(-exponent);
                for (row, expected) in tangent(gap).iter().zip(&reference) {
                    for (a, e) in row.iter().zip(expected) {
                        let allowed = (1e-8 + 20.0 * gap / size.min(1.0)) * stiffness;
                        assert!((a - e).abs() <= allowed, "{name} {base:?} {gap:e}: {a} {e}");
                    }
                }
            }
        }
    }
}

/// Turning the body turns the stress: τ(Q b Qᵀ) = Q τ(b) Qᵀ, in the plane and in space.
#[test]
fn responses_are_objective() {
    for (name, model) in models() {
        let mut random = Random(13);
        for _ in 0..300 {
            let (f, q) = (random.trial(&*model, false), random.gradient(1.0, false).qr().q());
            let at =
                |f: &Tensor| spatial::solid(&*model, 0.0, &left(f), &State::default(), &mut room(&*model)).unwrap();
            let (here, turned) = (at(&f), at(&(q * f)));
            let scale = model.elasticity().at(0.0).tangent()[0][0];
            assert!(
                (full(&turned.kirchhoff) - q * full(&here.kirchhoff) * q.transpose()).amax() <= 1e-13 * scale,
                "{name}"
            );
            assert!((full(&turned.elastic) - q * full(&here.elastic) * q.transpose()).amax() <= 1e-13, "{name}");
        }
    }
}

/// An initial stress is carried by the elastic tensor made for it, in the plane and in space.
#[test]
fn initial_stress_is_carried() {
    for (name, model) in models() {
        let s = if model.yields() { model.shear_strength(0.0, &State::default()) } else { 10.0 };
        for stress in [
            [-0.3, -0.5, -0.4, 0.05, 0.0, 0.0],
            [-0.3, -0.5, -0.4, 0.05, 0.03, -0.02],
            [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0],
        ] {
            let stress: Symmetric = stress.map(|x: f64| x * s);
            let b = spatial::elastic_from_stress(&*model, 0.0, &stress);
            let r = spatial::solid(&*model, 0.0, &b, &State::default(), &mut room(&*model)).unwrap();
            assert!(!r.yielding, "{name}");
            let tolerance = 1e-15 * model.elasticity().at(0.0).tangent()[0][0] * 4.0;
            for k in 0..6 {
                assert!(
                    (r.kirchhoff[k] - stress[k]).abs() <= tolerance + 1e-12 * s,
                    "{name}: {:?} {stress:?}",
                    r.kirchhoff
                );
            }
        }
    }
}

/// What is not a left Cauchy–Green tensor is refused, not turned into NaN.
#[test]
fn indefinite_and_infinite_tensors_are_refused() {
    let (_, model) = models().remove(0);
    for b in [
        [1.0, -0.1, 1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 1.0, 1.1, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [f64::NAN, 1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, f64::INFINITY, 0.0, 0.0, 0.0],
    ] {
        assert!(spatial::plane(&*model, 0.0, &b, &State::default(), &mut []).is_none(), "{b:?}");
        assert!(spatial::solid(&*model, 0.0, &b, &State::default(), &mut []).is_none(), "{b:?}");
    }
}
