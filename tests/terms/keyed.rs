//! A term with its key in `case.yaml`, defined in this file only; the library needs no change for it.
//!
//! Elastic bedding (Winkler): springs along a curve, per area of the curve as it was meshed, in its first normal `n`:
//!
//! ```text
//! R_I = ∫ N_I k (u − g) dS,    k = k_s 1 + (k_n − k_s) n ⊗ n
//! ```
//!
//! `u` is the displacement since the mesh was made, `g` that of the ground below the springs.

use crate::support::stand::{KINDS, Stand, mesh, points, resultant};
use crate::support::{PROGRAM, column, written};
use mpm::case::checked::Site;
use mpm::case::keyed::{Key, Keyed, Terms};
use mpm::case::locate::{At, Path};
use mpm::case::names::{Groups, Of};
use mpm::case::parts::material_curve;
use mpm::case::raw::{CaseFile, InTime, Product, RegionKind, Restore, RestoreName};
use mpm::case::{Checker, Keys, Loaded, scene, seeding};
use mpm::error::Result;
use mpm::io::checkpoint::Fingerprint;
use mpm::io::provenance::Origin;
use mpm::io::run_folder::RunFolder;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::mesh::gmsh::{Options, Worker};
use mpm::mesh::shape::{MAX_NODES, rule};
use mpm::mesh::{Group, Mesh, msh};
use mpm::run::Ended;
use mpm::system::{Local, scatter};
use mpm::term::{Assembly, Frame, Role, Term, Trial};
use mpm::time_value::TimeValue;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;
use std::fs;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};

/// Springs on one curve, as they are written.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OnCurve {
    /// The name of a physical curve of finite elements, or of a grid that is never restored.
    on: String,
    /// Stiffness normal to the curve (kN/m³), 0 or above.
    #[schemars(range(min = 0))]
    normal: f64,
    /// Stiffness along the curve (kN/m³), 0 or above.
    #[serde(default)]
    #[schemars(range(min = 0))]
    shear: f64,
    /// Vertical displacement of the ground below the springs (m), in the time of each phase. Without it 0.
    ground: Option<InTime>,
}

/// The entry, checked: curve, stiffness normal to it and along it, displacement of the ground.
#[derive(Debug)]
struct Bedding(Vec<(String, [f64; 2], TimeValue)>);

impl Keyed for Bedding {
    const KEY: &'static str = "bedding";
    const DESCRIPTION: &'static str = "Elastic springs that curves rest on.";

    type Written = Vec<OnCurve>;

    fn check(written: Vec<OnCurve>, file: &CaseFile, path: &Path, checker: &mut Checker) -> Option<Self> {
        let of_elements = |kind| matches!(kind, RegionKind::Fem | RegionKind::Structure);
        let elements = file.regions.values().any(|region| of_elements(region.kind));
        let moves = matches!(file.numerics.restore, Restore::Named(RestoreName::Never));
        let mut all = Vec::new();
        for (i, OnCurve { on, normal, shear, ground }) in written.into_iter().enumerate() {
            let path = path.index(i);
            if !elements && !moves {
                let problem = "springs need finite elements, or a grid that moves with the material";
                let remedy = "set `restore: never` under `numerics`, or make the region beside it `kind: fem`";
                checker.issue(&path.key("on"), At::Value, problem, remedy);
            }
            if normal == 0.0 && shear == 0.0 {
                let remedy = "give `normal` or `shear` above 0";
                checker.issue(&path.key("normal"), At::Value, "the springs have no stiffness", remedy);
            }
            let none = TimeValue::Constant(0.0);
            let ground = ground.map_or(none, |ground| checker.in_time(&ground, &path.key("ground")));
            all.push((on, [normal, shear], ground));
        }
        Some(Self(all))
    }

    fn curves(&self, path: &Path) -> Vec<(&str, Path)> {
        self.0.iter().enumerate().map(|(i, (curve, ..))| (curve.as_str(), path.index(i).key("on"))).collect()
    }

    fn values(&self, _phase: usize) -> Vec<&TimeValue> {
        self.0.iter().map(|(_, _, ground)| ground).collect()
    }

    fn terms<K: Kinematics<2>>(&self, site: &Site) -> Terms {
        self.springs::<K>(site, site.mesh, site.elements)
    }

    fn on_elements<K: Kinematics<2>>(&self, site: &Site, mesh: &Mesh<2>) -> Terms {
        self.springs::<K>(site, mesh, None)
    }
}

impl Bedding {
    /// The springs on the cells of `mesh`, but for those that are on cells of `others`.
    fn springs<K: Kinematics<2>>(&self, site: &Site, mesh: &Mesh<2>, others: Option<&Mesh<2>>) -> Terms {
        let mut terms: Vec<Box<dyn Term<2>>> = Vec::new();
        for (name, stiffness, ground) in &self.0 {
            let curve = material_curve(site, name, || format!("the bedding on `{name}`"))?;
            let mut springs = Springs::<K>::new(mesh, curve, *stiffness, ground.clone());
            springs.facets.retain(|facet| others.is_none_or(|others| beside(others, &facet.nodes).is_empty()));
            terms.push(Box::new(springs));
        }
        Ok(terms)
    }
}

/// The cells that have all of some nodes.
fn beside(mesh: &Mesh<2>, nodes: &[u32]) -> Vec<u32> {
    let has_all = |&c: &u32| nodes.iter().all(|n| mesh.cells.nodes(c as usize).contains(n));
    (0..mesh.cells.len() as u32).filter(has_all).collect()
}

struct Facet {
    nodes: Vec<u32>,
    /// Where they were meshed (m).
    first: Vec<[f64; 2]>,
    /// The cells beside it.
    cells: Vec<u32>,
    /// Row-major over the components of the nodes (kN/m).
    stiffness: Vec<f64>,
}

struct Springs<K> {
    facets: Vec<Facet>,
    ground: TimeValue,
    kinematics: PhantomData<K>,
}

impl<K: Kinematics<2>> Springs<K> {
    /// Springs on `curve` of the undeformed `mesh` with a stiffness (kN/m³) normal to it and along it.
    fn new(mesh: &Mesh<2>, curve: &Group, [normal, shear]: [f64; 2], ground: TimeValue) -> Self {
        let mut facets = Vec::new();
        for (kind, nodes) in &curve.facets {
            let first: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
            let mut stiffness = vec![0.0; 4 * nodes.len() * nodes.len()];
            for (xi, weight) in rule(*kind, 2 * kind.order() + 1) {
                let (mut n, mut slopes) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
                kind.values(&xi, &mut n);
                kind.derivatives(&xi, &mut slopes);
                let (mut x, mut along) = ([0.0; 2], [0.0; 2]);
                for (i, node) in first.iter().enumerate() {
                    x = [0, 1].map(|d| x[d] + n[i] * node[d]);
                    along = [0, 1].map(|d| along[d] + slopes[i][0] * node[d]);
                }
                let length = along[0].hypot(along[1]);
                let across = [along[1] / length, -along[0] / length];
                let area = weight * length * K::measure(&x);
                for (i, d, j, e) in pairs(nodes.len()) {
                    let k = (normal - shear) * across[d] * across[e] + if d == e { shear } else { 0.0 };
                    stiffness[(2 * i + d) * 2 * nodes.len() + 2 * j + e] += area * n[i] * n[j] * k;
                }
            }
            facets.push(Facet { cells: beside(mesh, nodes), nodes: nodes.clone(), first, stiffness });
        }
        facets.retain(|facet| !facet.cells.is_empty());
        Self { facets, ground, kinematics: PhantomData }
    }
}

/// Pairs of nodes with a component each.
fn pairs(nodes: usize) -> impl Iterator<Item = (usize, usize, usize, usize)> {
    (0..4 * nodes * nodes).map(move |k| (k / (4 * nodes), k / (2 * nodes) % 2, k % (2 * nodes) / 2, k % 2))
}

impl<K: Kinematics<2>> Term<2> for Springs<K> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        let ground = [0.0, self.ground.at(trial.time)];
        // Each on the first cell beside it that takes part.
        let active = |&c: &u32| frame.coupling[c as usize] != u32::MAX;
        let on_cells: Vec<(&Facet, u32)> =
            self.facets.iter().filter_map(|facet| Some((facet, facet.cells.iter().copied().find(active)?))).collect();
        let compute = |&(facet, cell): &(&Facet, u32), local: &mut Local| {
            let of_cell = frame.interpolation.nodes(frame.mesh, cell);
            // A facet has at most three nodes.
            let mut place = [0; 3];
            for (place, node) in place.iter_mut().zip(&facet.nodes) {
                *place = of_cell.iter().position(|n| n == node).expect("a node of the cell");
            }
            let stretch = |j: usize, e: usize| {
                let n = facet.nodes[j] as usize;
                frame.mesh.nodes[n][e] + trial.between[n][e] - facet.first[j][e] - ground[e]
            };
            for (k, (i, d, j, e)) in facet.stiffness.iter().zip(pairs(facet.nodes.len())) {
                let row = 2 * place[i] + d;
                local.vector[row] += k * stretch(j, e);
                if !local.matrix.is_empty() {
                    local.matrix[row * local.size + 2 * place[j] + e] += (1.0 - trial.alpha_f) * k;
                }
            }
            Ok(())
        };
        let coupling = |&(_, cell): &(&Facet, u32)| frame.coupling[cell as usize] as usize;
        scatter(frame.pattern, &on_cells, coupling, compute, out.force, out.tangent.as_deref_mut(), out.workspace)
    }
}

fn tangent<K: Kinematics<2>>() {
    for kind in KINDS {
        for restored in [false, true] {
            let mesh = mesh(kind);
            let curve = mesh.group("right").unwrap();
            let springs = Springs::<K>::new(&mesh, curve, [700.0, 300.0], TimeValue::Rate(0.2));
            let points = points(&mesh, |_| true);
            let mut stand = Stand::<K>::new(mesh, points, Box::new(springs), restored, true);
            stand.alpha_f = 0.4;
            let (trial, converged) = (stand.field(0.1, 1, |_| [0.0; 2]), stand.field(0.1, 2, |_| [0.0; 2]));
            let (error, asymmetry) = (stand.tangent_error(&trial, &converged), stand.asymmetry(&trial, &converged));
            // The residual is linear in u: the difference is exact but for rounding.
            assert!(error < 1e-8 && asymmetry < 1e-13, "{kind:?}: {error:.1e} {asymmetry:.1e}");
        }
    }
}

#[test]
fn the_tangent_is_the_derivative() {
    tangent::<PlaneStrain>();
    tangent::<Axisymmetric>();
}

/// `k A (u − g)` on the right edge, 1.5 m high at a radius of 4 m.
fn force_of_a_translation<K: Kinematics<2>>(area: f64) {
    for kind in KINDS {
        let mesh = mesh(kind);
        let springs = Springs::<K>::new(&mesh, mesh.group("right").unwrap(), [700.0, 300.0], TimeValue::Rate(0.2));
        let points = points(&mesh, |_| true);
        let stand = Stand::<K>::new(mesh, points, Box::new(springs), false, false);
        let moved = stand.field(0.0, 1, |_| [0.02, -0.03]);
        let force = resultant(&stand.evaluate(&moved, &moved, 0, false).0);
        // The time of the stand is 0.5 s.
        let expected = [700.0 * area * 0.02, 300.0 * area * (-0.03 - 0.1)];
        let error = (0..2).map(|d| (force[d] / expected[d] - 1.0).abs()).fold(0.0, f64::max);
        assert!(error < 1e-12, "{kind:?}: {force:?} {expected:?}");
    }
}

#[test]
fn the_force_is_stiffness_times_area_times_displacement() {
    force_of_a_translation::<PlaneStrain>(1.5);
    force_of_a_translation::<Axisymmetric>(1.5 * 2.0 * PI * 4.0);
}

const GEO: &str = r#"Point(1) = {0, 0, 0, 0.5};
Point(2) = {1, 0, 0, 0.5};
Point(3) = {2, 0, 0, 0.5};
Point(4) = {2, 1, 0, 0.5};
Point(5) = {0, 1, 0, 0.5};
Point(6) = {3, 0, 0, 0.5};
Point(7) = {3, 1, 0, 0.5};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Line(6) = {3, 6};
Line(7) = {6, 7};
Line(8) = {7, 4};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Curve Loop(2) = {6, 7, 8, -3};
Plane Surface(2) = {2};
Physical Surface("block") = {1};
Physical Surface("air") = {2};
Physical Curve("left") = {1};
Physical Curve("right") = {2};
Physical Curve("side") = {3};
"#;

/// A block of 2 m by 1 m and 40 kN/m on springs, with cells beside it that are empty.
const CASE: &str = "\
geometry: plane_strain
mesh: {geo: block.geo}
regions: {block: {kind: mpm, material: stone}, air: {kind: buffer}}
materials: {stone: {model: linear_elastic, young: 10000, poisson: 0, density: 2}}
gravity: {y: -10}
numerics: {restore: never}
bedding:
  - {on: left, normal: 1000, shear: 100}
  - {on: right, normal: 1000, shear: 100}
phases:
  - {name: settle, analysis: quasi_static, duration: 1, step: {initial: 0.25}, gravity: {rate: 1}}
output:
  every: 0.25
  history: [{name: left, on: left, quantities: [uy]}, {name: right, on: right, quantities: [uy]}]
";

fn keys() -> Keys {
    Keys::with(&[Key::of::<Bedding>()]).unwrap()
}

fn strings(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|&text| text.to_owned()).collect()
}

/// The case in a folder of its own, with overrides.
fn loaded(overrides: &[&str]) -> (tempfile::TempDir, std::result::Result<Loaded, Vec<String>>) {
    let folder = written(CASE);
    fs::write(folder.path().join("block.geo"), GEO).unwrap();
    let loaded = keys().load(folder.path(), &strings(overrides));
    (folder, loaded.map_err(|errors| errors.iter().map(ToString::to_string).collect()))
}

fn groups(mesh: &Mesh<2>) -> Groups {
    let named = |dimension| mesh.groups.iter().filter(move |g| g.dimension == dimension).map(|g| g.name.clone());
    Groups { surfaces: mesh.regions.clone(), curves: named(1).collect(), points: named(0).collect(), of: Of::Made }
}

fn meshed(loaded: &Loaded) -> Mesh<2> {
    let worker = Worker {
        program: PROGRAM.as_ref(),
        seconds: 60,
        memory: 4 << 30,
        analysis: 4 << 30,
        filter: true,
        sandbox: true,
        stop: &AtomicBool::new(false),
        warn: |_| (),
    };
    let options = Options { order: 2, incomplete: false, parameters: Vec::new() };
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("mesh.msh");
    worker.mesh(loaded.case.mesh.source.path(), &options, &out, |_| Ok(())).unwrap();
    msh::seal(&out).unwrap();
    msh::read(&out).unwrap()
}

/// Solves in `folder`, at most to the step `last`. A run belongs to what shapes its results, as in `mpm solve`.
fn solve(loaded: &Loaded, mesh: &Mesh<2>, folder: &std::path::Path, resume: bool, last: u64) -> Result<Ended> {
    let entries = format!("{:?}", loaded.shaping(Product::Results));
    let origin = Origin { run: Fingerprint::of(&[entries.as_bytes()]), mesh: 1 };
    let points = seeding::points(&loaded.case, mesh).unwrap();
    let begin = scene::Begin { origin, resume, ..scene::Begin::default() };
    let (folder, stop) = (RunFolder::new(folder), AtomicBool::new(false));
    let watch = |progress: mpm::run::Progress| stop.store(progress.step >= last, Ordering::Relaxed);
    scene::solve(&loaded.case, mesh.clone(), points, &folder, begin, &stop, &mut { watch })
}

/// The columns of the history of a case with overrides: time, and the displacements of both halves of the base.
fn history(overrides: &[&str]) -> [Vec<f64>; 3] {
    let (folder, loaded) = loaded(overrides);
    let loaded = loaded.unwrap();
    let mesh = meshed(&loaded);
    assert!(loaded.check_names(&groups(&mesh)).is_ok());
    assert_eq!(solve(&loaded, &mesh, folder.path(), false, u64::MAX).unwrap(), Ended::Done);
    ["time [s]", "left.uy [m]", "right.uy [m]"].map(|name| column(folder.path(), name))
}

/// The block of material points, and of finite elements on a grid that is restored.
const SIDES: [&[&str]; 2] = [&[], &["regions.block.kind=fem", "numerics.restore=every_step"]];

/// Weight over stiffness and area, 0.02 m, and the ground below goes down by 0.1 m until 0.4 s, where a step ends.
#[test]
fn a_block_settles_by_its_weight_over_the_stiffness_and_with_the_ground() {
    let ground = "{table: [[0, 0], [0.4, -0.1], [1, -0.1]]}";
    for kind in SIDES {
        let bedding = ["left", "right"].map(|on| format!("{{on: {on}, normal: 1000, shear: 100, ground: {ground}}}"));
        let bedding = format!("bedding=[{}]", bedding.join(", "));
        let overrides: Vec<&str> = kind.iter().copied().chain([bedding.as_str()]).collect();
        let [time, left, right] = history(&overrides);
        assert!(time.iter().any(|t| (t - 0.4).abs() < 1e-12), "{time:?}");
        for ((t, left), right) in time.iter().zip(left).zip(right) {
            let expected = -0.02 * t - 0.1 * (t / 0.4).min(1.0);
            assert!(
                (left - expected).abs() < 1e-8 && (right - expected).abs() < 1e-8,
                "{t}: {left} {right} {expected}"
            );
        }
    }
}

/// A rigid block on halves of two stiffnesses: with `v(x) = a + b x` from the middle, `∫ k v dx = −W` and `∫ k v x dx = 0`. The block
/// bends by 1e-4 of that, and leans by as little.
#[test]
fn a_block_on_two_stiffnesses_tilts() {
    for kind in SIDES {
        let soft = ["bedding[1].normal=500", "gravity.y=-0.1", "materials.stone.young=1.0e+7"];
        let overrides: Vec<&str> = kind.iter().copied().chain(soft).collect();
        let [_, left, right] = history(&overrides);
        let (k1, k2, weight) = (1000.0, 500.0, 0.4);
        // a (k1 + k2) + b (k2 − k1)/2 = −W, a (k2 − k1)/2 + b (k1 + k2)/3 = 0.
        let (sum, apart) = (k1 + k2, 0.5 * (k2 - k1));
        let a = -weight / (sum - 3.0 * apart * apart / sum);
        let b = -3.0 * apart / sum * a;
        // The means over the nodes of the halves, which are even and lie about their middles.
        for (value, expected) in [(left, a - 0.5 * b), (right, a + 0.5 * b)] {
            let last = *value.last().unwrap();
            assert!((last / expected - 1.0).abs() < 1e-3, "{last} {expected}");
        }
    }
}

#[test]
fn a_run_resumes_bit_for_bit_and_is_stale_when_the_stiffness_changes() {
    for kind in SIDES {
        let [whole, parts] = [0; 2].map(|_| tempfile::tempdir().unwrap());
        let (_folder, loaded) = loaded(kind);
        let loaded = loaded.unwrap();
        let mesh = meshed(&loaded);
        assert_eq!(solve(&loaded, &mesh, whole.path(), false, u64::MAX).unwrap(), Ended::Done);
        assert_eq!(solve(&loaded, &mesh, parts.path(), false, 2).unwrap(), Ended::Stopped);
        let (_other, stiffer) = self::loaded(&[kind, &["bedding[0].normal=1001"]].concat());
        let stiffer = stiffer.unwrap();
        let error = solve(&stiffer, &mesh, parts.path(), true, u64::MAX).unwrap_err();
        assert!(error.to_string().contains("checkpoint"), "{error}");
        assert_eq!(solve(&loaded, &mesh, parts.path(), true, u64::MAX).unwrap(), Ended::Done);
        for file in ["results/frame-000004.mpmf", "history.csv", "checkpoints/step-000000004.mpmc"] {
            let [a, b] = [&whole, &parts].map(|folder| fs::read(folder.path().join(file)).unwrap());
            assert!(a == b, "{kind:?}: {file}");
        }
        for (product, stale) in
            [(Product::Mesh, false), (Product::Points, false), (Product::Results, true), (Product::Series, false)]
        {
            assert_eq!(loaded.shaping(product) != stiffer.shaping(product), stale, "{product:?}");
        }
    }
}

/// The shape of the entry, its own checks, names of the mesh and mistakes elsewhere, with line, place and remedy.
#[test]
fn mistakes_are_told_with_all_others() {
    let told = |overrides: &[&str]| loaded(overrides).1.map(drop).unwrap_err();
    let all = told(&[
        "bedding[0].normal=-5",
        "bedding[1]={on: right, normal: 0, shaer: 0, ground: {table: [[1, 0], [0, 1]]}}",
        "numerics={}",
        "gravty={y: -10}",
        "materials.stone.density=-2",
    ]);
    for wanted in [
        &["bedding[0].normal", "is -5, but must be at least 0", "Stiffness normal to the curve (kN/m³)"][..],
        &["bedding[0].on", "springs need finite elements", "restore: never"],
        &["bedding[1].shaer", "unknown key `shaer`", "did you mean `shear`?"],
        &["bedding[1].normal", "no stiffness", "above 0"],
        &["bedding[1].ground", "does not come after", "sort the table"],
        &["gravty", "did you mean `gravity`?"],
        &["density"],
    ] {
        let found = all.iter().filter(|error| wanted.iter().all(|part| error.contains(part))).count();
        assert!(found == 1, "{wanted:?}: {all:#?}");
    }
    let [error] = told(&["bedding=3"]).try_into().unwrap();
    assert!(error.contains("a list") && error.contains("Elastic springs that curves rest on"), "{error}");
    let [error] = told(&["bedding=null", "beding=[]"]).try_into().unwrap();
    assert!(error.contains("did you mean `bedding`?"), "{error}");

    let (_folder, loaded) = loaded(&["bedding[1].on=rigth"]);
    let loaded = loaded.unwrap();
    let [error] = loaded.check_names(&groups(&meshed(&loaded))).unwrap_err().try_into().unwrap();
    let error = error.to_string();
    let parts = ["bedding[1].on", "no physical curve `rigth`", "did you mean `right`?"];
    assert!(parts.iter().all(|part| error.contains(part)), "{error}");
}

/// Springs of a curve that stays behind, or of a structure that has no nodes of its own, are refused on the mesh.
#[test]
fn curves_that_do_not_move_with_material_are_refused() {
    let refused = |overrides: &[&str]| {
        let (_folder, loaded) = loaded(overrides);
        let case = loaded.unwrap().case;
        scene::scene::<PlaneStrain>(&case, meshed(&self::loaded(&[]).1.unwrap())).err().unwrap().to_string()
    };
    // The air is of finite elements, the block of material points on a grid that is restored.
    let swapped = "regions={block: {kind: mpm, material: stone}, air: {kind: fem, material: stone}}";
    let error = refused(&[swapped, "numerics={}"]);
    assert!(error.contains("the bedding on `left`") && error.contains("restore: never"), "{error}");
    let rigid = "regions={block: {kind: structure, rigid: true, material: stone}, air: {kind: mpm, material: stone}}";
    let error = refused(&[rigid, "numerics={}"]);
    assert!(error.contains("rigid structure"), "{error}");
}

#[test]
fn the_schema_has_the_entry_and_a_key_is_given_once() {
    let schema = keys().schema();
    let entry = &schema["properties"]["bedding"];
    assert_eq!(entry["description"], "Elastic springs that curves rest on.");
    assert!(schema["$defs"]["OnCurve"]["properties"]["ground"]["description"].is_string(), "{schema:#}");
    let mut built_in = schema.clone();
    built_in["properties"].as_object_mut().unwrap().remove("bedding");
    built_in["$defs"].as_object_mut().unwrap().remove("OnCurve");
    assert_eq!(built_in, Keys::default().schema());
    let error = Keys::with(&[Key::of::<Bedding>(); 2]).unwrap_err();
    assert!(error.to_string().contains("`bedding`"), "{error}");
}
