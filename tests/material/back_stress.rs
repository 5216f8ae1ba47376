//! A model of a user, defined here and nowhere else: von Mises plasticity with a back stress (Armstrong & Frederick 1966/2007,
//! *A mathematical representation of the multiaxial Bauschinger effect*, Materials at High Temperatures 24, 1–26) and three
//! scalars. Its law at a point, and a scene with it that is run, stopped, resumed and exported.
//!
//! ```text
//! q(s − β) ≤ σ_0 + H p,    Δε_p = Δp n,  n = 3/2 (s − β)/q,    β = (β_n + ⅔ C Δε_p)/(1 + γ Δp)
//! ```

use mpm::interpolation::Mpm;
use mpm::io::checkpoint::Fingerprint;
use mpm::io::export::{Regions, export};
use mpm::io::frame::{self, Frame};
use mpm::io::provenance::Origin;
use mpm::io::run_folder::RunFolder;
use mpm::io::vtu::Encoding;
use mpm::kinematics::PlaneStrain;
use mpm::material::spatial::{self, Spatial};
use mpm::material::{
    Elasticity, Law, Model, Profile, State, TensorModel, TensorResponse, Variable, VariableKind, yield_excess,
};
use mpm::mesh::builder::rectangle;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::quadrature::Resampled;
use mpm::run::fields::{self, Field};
use mpm::run::{self, Ended, InternalVariable, Outputs};
use mpm::seed::{RegionSeed, seed};
use mpm::step::{self, Fixed, Numerics, Phase, Prescribed, Restore, Scene, StepSize, Stop};
use mpm::tensor::{Symmetric, Tensor, deviatoric, full, mean, symmetric};
use mpm::term::{EmptyCells, Internal};
use mpm::time_value::TimeValue;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

type Models = Vec<Option<Arc<dyn Model>>>;

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;
const YIELD: f64 = 3.0;
const HARDENING: f64 = 10.0;
/// C (kPa) and γ (-).
const KINEMATIC: f64 = 200.0;
const RECOVERY: f64 = 50.0;

struct BackStress {
    elasticity: Elasticity,
}

const VARIABLES: [Variable; 4] = [
    Variable { name: "slip", unit: "-", kind: VariableKind::Scalar, initial: 0.0 },
    Variable { name: "back_stress", unit: "kPa", kind: VariableKind::Tensor, initial: 0.0 },
    Variable { name: "plastic_work", unit: "kPa", kind: VariableKind::Scalar, initial: 0.0 },
    Variable { name: "largest_back_stress", unit: "kPa", kind: VariableKind::Scalar, initial: 0.0 },
];
const COUNT: usize = 9;

/// The back stress among the internal variables.
fn back_stress(internal: &[f64]) -> Symmetric {
    std::array::from_fn(|k| internal.get(1 + k).copied().unwrap_or(0.0))
}

fn deviator(t: &Symmetric) -> Symmetric {
    let p = mean(t);
    [t[0] - p, t[1] - p, t[2] - p, t[3], t[4], t[5]]
}

fn combine(a: f64, x: &Symmetric, b: f64, y: &Symmetric) -> Symmetric {
    std::array::from_fn(|k| a * x[k] + b * y[k])
}

fn product(x: &Symmetric, y: &Symmetric) -> f64 {
    (0..6).map(|k| if k < 3 { x[k] * y[k] } else { 2.0 * x[k] * y[k] }).sum()
}

impl BackStress {
    fn new() -> Self {
        Self { elasticity: Elasticity::new(Profile::constant(YOUNG), POISSON).unwrap() }
    }
}

impl TensorModel for BackStress {
    fn respond(&self, y: f64, trial: &Symmetric, state: &State, internal: &mut [f64]) -> TensorResponse {
        let moduli = self.elasticity.at(y);
        let (g, bulk) = (moduli.shear, moduli.bulk());
        let (slip, before) = (internal[0], back_stress(internal));
        let (mean_stress, s_trial) = (3.0 * bulk * mean(trial), deviator(trial).map(|e| 2.0 * g * e));
        let with_mean = |s: &Symmetric, m: f64| std::array::from_fn(|k| s[k] + if k < 3 { m } else { 0.0 });
        // θ, q and n at a slip, and −∂f/∂Δp of f = q(η) − (3G + C θ) Δp − σ_0 − H (p + Δp), η = s_tr − θ β_n.
        let at = |x: f64| {
            let theta = 1.0 / (1.0 + RECOVERY * x);
            let eta = combine(1.0, &s_trial, -theta, &before);
            let q = deviatoric(&eta);
            let n = eta.map(|e| 1.5 * e / q);
            let recovered = RECOVERY * theta * theta * product(&n, &before);
            (theta, q, n, 3.0 * g + KINEMATIC * theta * theta + HARDENING - recovered)
        };
        let size = YIELD + HARDENING * slip;
        let yielding = at(0.0).1 > size * (1.0 + 1e-12);
        let mut x = 0.0;
        for _ in 0..if yielding { 50 } else { 0 } {
            let (theta, q, _, slope) = at(x);
            let change = (q - (3.0 * g + KINEMATIC * theta) * x - size - HARDENING * x) / slope;
            x += change;
            if change.abs() <= 1e-15 * (1.0 + x.abs()) {
                break;
            }
        }
        let (theta, q, n, slope) = at(x);
        let change = |strain: &Symmetric| -> Symmetric {
            let trial = deviator(strain).map(|e| 2.0 * g * e);
            let mut stress = trial;
            if yielding {
                let dx = product(&n, &trial) / slope;
                let d_eta = combine(1.0, &trial, RECOVERY * theta * theta * dx, &before);
                let dn = combine(1.5 / q, &d_eta, -product(&n, &d_eta) / q, &n);
                stress = combine(1.0, &trial, -2.0 * g, &combine(dx, &n, x, &dn));
            }
            with_mean(&stress, 3.0 * bulk * mean(strain))
        };
        // In shear, half of D_ijkl + D_ijlk.
        let unit = |b: usize| std::array::from_fn(|k| if k != b { 0.0 } else { [1.0, 0.5][usize::from(b > 2)] });
        let columns: [Symmetric; 6] = std::array::from_fn(|b| change(&unit(b)));
        let plastic = if yielding { n.map(|n| x * n) } else { [0.0; 6] };
        let s = combine(1.0, &s_trial, -2.0 * g, &plastic);
        if yielding {
            let back = combine(theta, &before, theta * KINEMATIC * 2.0 / 3.0, &plastic);
            internal[0] = slip + x;
            internal[1..7].copy_from_slice(&back);
            internal[7] += product(&s, &plastic);
            internal[8] = internal[8].max(deviatoric(&back));
        }
        TensorResponse {
            stress: with_mean(&s, mean_stress),
            tangent: std::array::from_fn(|a| std::array::from_fn(|b| columns[b][a])),
            elastic_strain: combine(1.0, trial, -1.0, &plastic),
            plastic_strain: state.plastic_strain + x,
            yielding,
        }
    }

    fn yield_excess(&self, _: f64, stress: &Symmetric, state: &State) -> f64 {
        let slip = state.internal.first().copied().unwrap_or(0.0);
        deviatoric(&combine(1.0, stress, -1.0, &back_stress(state.internal))) - YIELD - HARDENING * slip
    }
}

impl Model for BackStress {
    fn law(&self) -> Law<'_> {
        Law::Tensor(self)
    }

    fn internal_variables(&self) -> &[Variable] {
        &VARIABLES
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        false
    }

    fn shear_strength(&self, _: f64, _: &State) -> f64 {
        YIELD / 3f64.sqrt()
    }

    fn check(&self, y: f64) -> mpm::error::Result<()> {
        self.elasticity.check(y)
    }

    fn reduced(&self, _: f64) -> Arc<dyn Model> {
        Arc::new(Self::new())
    }
}

struct Random(u64);

impl Random {
    fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn tensor(&mut self, size: f64) -> Tensor {
        Tensor::from_fn(|_, _| size * self.signed())
    }

    fn symmetric(&mut self, size: f64) -> Symmetric {
        symmetric(&self.tensor(size))
    }

    /// Internal variables that a point may have.
    fn internal(&mut self) -> [f64; COUNT] {
        let mut internal = [0.0; COUNT];
        internal[0] = 0.05 * (1.0 + self.signed());
        internal[1..7].copy_from_slice(&deviator(&self.symmetric(1.0)));
        internal
    }
}

#[test]
fn stresses_return_to_the_shifted_surface() {
    let (model, mut random, mut yielded) = (BackStress::new(), Random(3), 0);
    for _ in 0..10_000 {
        let before = random.internal();
        let mut internal = before;
        let trial = random.symmetric(0.02);
        let r = model.respond(0.0, &trial, &State::default(), &mut internal);
        let after = State { internal: &internal, ..State::default() };
        let excess = model.yield_excess(0.0, &r.stress, &after);
        assert!(excess <= 1e-10 && (!r.yielding || excess >= -1e-10), "{trial:?} {excess:e}");
        yielded += usize::from(r.yielding);
        // The stress is that of the elastic strain, and slip works against the stress less the back stress.
        let moduli = model.elasticity.at(0.0);
        let elastic = deviator(&r.elastic_strain).map(|e| 2.0 * moduli.shear * e);
        let off = combine(1.0, &deviator(&r.stress), -1.0, &elastic);
        assert!(off.iter().all(|x| x.abs() < 1e-11), "{off:?}");
        let relative = combine(1.0, &r.stress, -1.0, &back_stress(&internal));
        assert!(product(&relative, &combine(1.0, &trial, -1.0, &r.elastic_strain)) >= -1e-14);
    }
    assert!(yielded > 5000, "{yielded}");
}

/// Under a slip in one direction the back stress is `C/γ (1 − e^(−γ p))`, and then yield in the other direction comes as much earlier.
#[test]
fn the_back_stress_follows_its_closed_form() {
    const STEPS: usize = 4000;
    let model = BackStress::new();
    let (mut internal, mut elastic) = ([0.0; COUNT], [0.0; 6]);
    for _ in 0..STEPS {
        elastic[3] += 0.05 / STEPS as f64;
        elastic = model.respond(0.0, &elastic, &State::default(), &mut internal).elastic_strain;
    }
    let exact = KINEMATIC / RECOVERY * (1.0 - (-RECOVERY * internal[0]).exp());
    let back = deviatoric(&back_stress(&internal));
    // Steps of first order.
    assert!((back / exact - 1.0).abs() < 2e-3 && internal[0] > 0.04, "{back} {exact}");
    assert_eq!(internal[8], back);
    let shear = model.elasticity.at(0.0).shear;
    let size = YIELD + HARDENING * internal[0];
    for (excess, yields) in [(-1e-6, false), (1e-6, true)] {
        // From q = β + size to β − size.
        let reverse = (size - back + excess) / 3f64.sqrt() / (2.0 * shear);
        let trial = [0.0, 0.0, 0.0, -reverse, 0.0, 0.0];
        assert_eq!(model.respond(0.0, &trial, &State::default(), &mut internal.clone()).yielding, yields);
    }
}

#[test]
fn the_tangent_is_the_differenced_stress() {
    let (model, mut random) = (BackStress::new(), Random(5));
    for _ in 0..2000 {
        let (before, trial, change) = (random.internal(), random.symmetric(0.02), random.symmetric(1.0));
        let at = |h: f64| model.respond(0.0, &combine(1.0, &trial, h, &change), &State::default(), &mut before.clone());
        let (h, r) = (1e-7, at(0.0));
        if [h, -h].iter().any(|&h| at(h).yielding != r.yielding) {
            continue;
        }
        let difference = combine(0.5 / h, &at(h).stress, -0.5 / h, &at(-h).stress);
        let weighted: Symmetric = std::array::from_fn(|k| if k < 3 { change[k] } else { 2.0 * change[k] });
        for a in 0..6 {
            let predicted: f64 = (0..6).map(|b| r.tangent[a][b] * weighted[b]).sum();
            assert!((predicted - difference[a]).abs() < 1e-5 * YOUNG, "{predicted} {}", difference[a]);
        }
    }
}

/// What a point answers to a step `f` from an elastic tensor and internal variables, which become those at the end of the step.
fn step(
    model: &BackStress,
    f: &Tensor,
    elastic: &Symmetric,
    internal: &mut [f64; COUNT],
) -> Spatial<spatial::SolidTangent> {
    let (before, trial) = (*internal, symmetric(&(f * full(elastic) * f.transpose())));
    let state = State { internal: &before, increment: Some(f), ..State::default() };
    spatial::solid(model, 0.0, &trial, &state, internal).unwrap()
}

fn rotation(random: &mut Random) -> Tensor {
    let q = random.tensor(1.0).qr().q();
    q * q.determinant()
}

/// A rigid rotation turns stress and back stress and changes nothing else; and it makes no difference whether a body is
/// turned before it is strained, or after.
#[test]
fn a_rigid_rotation_turns_stress_and_back_stress() {
    let (model, mut random) = (BackStress::new(), Random(7));
    let turned = |q: &Tensor, t: &Symmetric| symmetric(&(q * full(t) * q.transpose()));
    let same = |a: &Symmetric, b: &Symmetric, size: f64| {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12 * size), "{a:?} {b:?}");
    };
    for _ in 0..1000 {
        let mut internal = random.internal();
        let strain = Tensor::identity() + random.tensor(0.01);
        let first = step(&model, &strain, &mpm::tensor::IDENTITY, &mut internal);
        let q = rotation(&mut random);
        let mut after = internal;
        let now = step(&model, &q, &first.elastic, &mut after);
        same(&now.kirchhoff, &turned(&q, &first.kirchhoff), YOUNG);
        same(&back_stress(&after), &turned(&q, &back_stress(&internal)), YIELD);
        same(&now.elastic, &turned(&q, &first.elastic), 1.0);
        assert_eq!((after[0], after[7], after[8]), (internal[0], internal[7], internal[8]));

        let f = Tensor::identity() + random.tensor(0.05);
        let (mut plain, mut with_turn) = (internal, internal);
        let here = step(&model, &f, &first.elastic, &mut plain);
        let there = step(&model, &(q * f), &first.elastic, &mut with_turn);
        assert!(here.yielding == there.yielding);
        same(&there.kirchhoff, &turned(&q, &here.kirchhoff), YOUNG);
        same(&back_stress(&with_turn), &turned(&q, &back_stress(&plain)), YIELD);
    }
}

/// `a_ijkl l_kl F_..` against differences of `τ F⁻ᵀ` with the step, whose rotation turns the back stress; in space and in the plane.
#[test]
fn the_spatial_tangent_is_the_derivative() {
    let (model, mut random) = (BackStress::new(), Random(11));
    for plane in [false, true] {
        let flat = |t: Tensor| {
            let cut = |i: usize, j: usize| plane && i != j && (i == 2 || j == 2);
            Tensor::from_fn(|i, j| if cut(i, j) { 0.0 } else { t[(i, j)] })
        };
        let mut compared = 0;
        for _ in 0..500 {
            let mut before = random.internal();
            let back = flat(full(&back_stress(&before)));
            before[1..7].copy_from_slice(&symmetric(&back));
            let elastic = symmetric(&flat(full(&random.symmetric(0.01)) + Tensor::identity()));
            let (angle, l) = (random.signed(), flat(random.tensor(1.0)));
            let turn = Tensor::new(angle.cos(), -angle.sin(), 0.0, angle.sin(), angle.cos(), 0.0, 0.0, 0.0, 1.0);
            let f = turn * (Tensor::identity() + flat(random.tensor(0.03)));
            let at = |h: f64| {
                let moved = f + l * f * h;
                let r = step(&model, &moved, &elastic, &mut before.clone());
                (full(&r.kirchhoff) * moved.try_inverse().unwrap().transpose() * f.transpose(), r.yielding)
            };
            let r = step(&model, &f, &elastic, &mut before.clone());
            let h = 1e-6;
            if [h, -h].iter().any(|&h| at(h).1 != r.yielding) {
                continue;
            }
            compared += 1;
            let difference = (at(h).0 - at(-h).0) / (2.0 * h);
            let predicted =
                Tensor::from_fn(|i, j| (0..9).map(|kl| r.tangent[3 * i + j][kl] * l[(kl / 3, kl % 3)]).sum());
            assert!((difference - predicted).amax() < 1e-5 * YOUNG, "{difference} {predicted}");
            if plane {
                let trial = symmetric(&(f * full(&elastic) * f.transpose()));
                let state = State { internal: &before, increment: Some(&f), ..State::default() };
                let p = spatial::plane(&model, 0.0, &trial, &state, &mut before.clone()).unwrap();
                let of = [0, 1, 3, 4, 8];
                let same = |a: usize, b: usize| p.tangent[a][b] == r.tangent[of[a]][of[b]];
                assert!(p.kirchhoff == r.kirchhoff && (0..25).all(|k| same(k / 5, k % 5)));
            }
        }
        assert!(compared > 450, "{compared}");
    }
}

const STEPS: usize = 12;

/// A block of the material that is sheared to and fro, on a grid that is restored in every step.
fn scene() -> (Scene<2>, Points<2>, Models) {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, 3, 3, 0.1, 1);
    let models: Models = vec![Some(Arc::new(BackStress::new()))];
    let region = RegionSeed { region: 0, points_per_cell: 9, density: Profile::constant(1.0) };
    let mut points = seed(&mesh, false, &[region]).unwrap();
    points.begin(&models);
    let on = |group: &str, component| Fixed { nodes: mesh.group(group).unwrap().nodes.clone(), component };
    let table = vec![[0.0, 0.0], [0.5, 0.03], [1.0, -0.01]];
    let prescribed = vec![Prescribed { fixed: on("top", 0), displacement: TimeValue::Table(table) }];
    let phase = Phase {
        name: "shear".into(),
        dynamic: false,
        auto: false,
        flows: false,
        duration: 1.0,
        step: StepSize { initial: 1.0 / STEPS as f64, min: 1e-3, max: 1.0 / STEPS as f64 },
        prescribed,
        reduction: None,
        loads_change: false,
        search: None,
        held: Vec::new(),
        apart: Vec::new(),
        changes: Vec::new(),
        reset_displacements: false,
        stops: vec![Stop { time: 0.5, frame: true }, Stop { time: 1.0, frame: true }],
    };
    let scene = Scene {
        fem: None,
        traced: Vec::new(),
        bodies: Vec::new(),
        interfaces: Vec::new(),
        levels: None,
        locator: Locator::new(&mesh),
        terms: vec![
            Box::new(Internal::<PlaneStrain>::new(models.clone(), false)),
            Box::new(EmptyCells::<PlaneStrain>::new(1e-5 * YOUNG, mesh.cells.len())),
        ],
        quadrature: Box::new(Resampled::<PlaneStrain>::new(&mesh, models.clone(), false)),
        pressure_unit: None,
        carried: Vec::new(),
        water: None,
        supports: vec![on("bottom", 0), on("bottom", 1), on("top", 1)],
        phases: vec![phase],
        basis: &Mpm,
        fields: Vec::new(),
        numerics: Numerics {
            restore: Restore::EveryStep,
            spectral_radius: 1.0,
            tolerance: 1e-9,
            acceptable_tolerance: 0.0,
            max_iterations: 25,
        },
        gravity: [0.0; 2],
        stiffness_scale: YOUNG,
        density_scale: 1.0,
        mesh,
    };
    (scene, points, models)
}

/// Runs the scene in `folder`, stopping after some steps.
fn run(folder: &Path, resume: bool, last: u64) -> Ended {
    let (scene, points, models) = scene();
    let mut fields: Vec<Arc<dyn Field<2>>> =
        vec![Arc::new(fields::PointColumn("stress")), Arc::new(fields::DeformationGradient)];
    fields.extend(InternalVariable::all(&models).into_iter().map(|v| Arc::new(v) as Arc<dyn Field<2>>));
    let outputs = Outputs {
        folder: RunFolder::new(folder),
        warnings: Vec::new(),
        ends: Vec::new(),
        fields,
        watches: Vec::new(),
        until: Vec::new(),
        surface: None,
        origin: Origin { run: Fingerprint::of(&[b"back stress"]), mesh: 1 },
    };
    let first = step::State::new(points, scene.mesh.nodes.len(), scene.phases[0].step.initial);
    let stop = AtomicBool::new(false);
    let mut watch = |progress: run::Progress| stop.store(progress.step >= last, Ordering::Relaxed);
    run::run::<2, PlaneStrain>(&scene, first, &outputs, resume, &stop, &mut watch).unwrap()
}

/// A run that is stopped and resumed ends with the same frames and the same last checkpoint, bit by bit; the exported files have the
/// variables, and stress and back stress of every point are on the yield surface or within it.
#[test]
fn a_scene_is_run_stopped_resumed_and_exported() {
    let [whole, parts] = [0; 2].map(|_| tempfile::tempdir().unwrap());
    assert_eq!(run(whole.path(), false, u64::MAX), Ended::Done);
    assert_eq!(run(parts.path(), false, 4), Ended::Stopped);
    assert_eq!(run(parts.path(), true, 9), Ended::Stopped);
    assert_eq!(run(parts.path(), true, u64::MAX), Ended::Done);
    let last = format!("checkpoints/step-{STEPS:09}.mpmc");
    for file in ["results/frame-000001.mpmf", "results/frame-000002.mpmf", "solve.log", &last] {
        let [a, b] = [&whole, &parts].map(|folder| fs::read(folder.path().join(file)).unwrap());
        assert!(a == b, "{file}");
    }

    let results = RunFolder::new(whole.path()).results();
    let Frame { points, .. } = Frame::read(&frame::path(&results, 2)).unwrap();
    let values = |name: &str| {
        let column = points.columns.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no column `{name}`"));
        column.values.chunks(column.components).map(<[f64]>::to_vec).collect::<Vec<_>>()
    };
    let [slip, back, work, largest] =
        VARIABLES.map(|variable| values(&format!("{}.{}", frame::INTERNAL, variable.name)));
    let (stress, deformation) = (values("stress"), values("deformation_gradient"));
    let (model, mut most) = (BackStress::new(), 0.0f64);
    for p in 0..points.position.len() {
        let volume_ratio = Tensor::from_row_slice(&deformation[p]).determinant();
        let kirchhoff: Symmetric = std::array::from_fn(|k| volume_ratio * stress[p][k]);
        let internal = [&slip[p][..], &back[p], &work[p], &largest[p]].concat();
        let state = State { internal: &internal, ..State::default() };
        let excess = yield_excess(&model, 0.0, &kirchhoff, &state);
        assert!(excess < 1e-9, "point {p} is outside by {excess:e}");
        assert!(work[p][0] >= 0.0 && largest[p][0] >= deviatoric(&back_stress(&internal)) - 1e-12);
        most = most.max(largest[p][0]);
    }
    assert!(most > 1.0 && most < KINEMATIC / RECOVERY, "{most}");

    let (scene, ..) = scene();
    let fields = ["stress", frame::INTERNAL].map(String::from);
    let regions = Regions { elements: vec![false], soil: vec![true], ..Regions::default() };
    let count = export(&results, &scene.mesh, &regions, whole.path(), &fields, Encoding::Plain).unwrap();
    assert_eq!(count.frames, 3);
    let text = fs::read_to_string(whole.path().join("vtu/points_000002.vtu")).unwrap();
    for name in ["slip [-]", "back_stress [kPa]", "plastic_work [kPa]", "largest_back_stress [kPa]"] {
        assert!(text.contains(&format!("\"{}.{name}\"", frame::INTERNAL)), "{name}");
    }
}
