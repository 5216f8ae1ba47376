//! The balance of energy of a run: what was supplied is what is held, dissipated by soil and contacts, and dissipated by the method, in every row; and
//! single entries have the values of closed forms.

use crate::support::{column, run};
use std::fs;
use std::path::Path;

/// `energy.csv` of a run.
struct Balance {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Balance {
    fn of(folder: &Path) -> Self {
        let text = fs::read_to_string(folder.join("energy.csv")).unwrap();
        let mut lines = text.lines();
        let name = |heading: &str| heading.split_once(" [").unwrap().0.to_owned();
        let names = lines.next().unwrap().split(',').map(name).collect();
        let rows = lines.map(|line| line.split(',').map(|value| value.parse().unwrap()).collect()).collect();
        Self { names, rows }
    }

    /// Of a case with entries overridden.
    fn case(case: &str, set: &[&str]) -> Self {
        Self::of(run(case, set).path())
    }

    /// The entry `name` in each row.
    fn all(&self, name: &str) -> Vec<f64> {
        let at = self.names.iter().position(|known| known.rsplit('.').next() == Some(name)).unwrap();
        self.rows.iter().map(|row| row[at]).collect()
    }

    fn last(&self, name: &str) -> f64 {
        *self.all(name).last().unwrap()
    }

    /// The largest entry in any row (kJ): the energy in play.
    fn most(&self) -> f64 {
        self.rows.iter().flat_map(|row| &row[1..]).fold(0.0, |most: f64, value| most.max(value.abs()))
    }

    /// Every row adds up, to rounding.
    #[track_caller]
    fn closes(&self) {
        for row in &self.rows {
            let signed = |(name, value): (&String, &f64)| if name.starts_with("supplied.") { *value } else { -value };
            let sum: f64 = self.names.iter().zip(row).skip(1).map(signed).sum();
            assert!(sum.abs() <= 1e-9 * self.most(), "t = {}: {sum} of {}", row[0], self.most());
        }
    }

    /// What the method adds or takes, all but what is named, is at most a part (-) of the energy in play in every row.
    #[track_caller]
    fn is_kept(&self, part: f64, but: &[&str]) {
        for name in self.names.iter().filter_map(|name| name.strip_prefix("numerical.")) {
            let most = self.all(name).iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            assert!(but.contains(&name) || most <= part * self.most(), "{name}: {most} of {}", self.most());
        }
    }
}

const DROP: &str = "tests/data/drop";
const ELASTIC: &str = "materials.clay={model: linear_elastic, young: 2000, poisson: 0.3, density: 1.6}";

/// A block that swings in itself: all of the entries are of their own reckoning, and nothing is left for the steps but what Newton's method leaves.
#[test]
fn an_elastic_block_in_flight() {
    let swings = "initial_velocity={block: {standing_wave: {component: y, along: y, amplitude: 3, wave_number: 12}}}";
    let phases = "phases=[{name: fly, analysis: dynamic, duration: 0.05, step: {initial: 0.0005, max: 0.0005}}]";
    for (numerics, penalties) in [("restore: never, quadrature: points, ", 0.0), ("", 1e-4)] {
        let numerics = format!("numerics={{{numerics}spectral_radius: 1}}");
        let set = ["supports={}", "gravity={y: 0}", ELASTIC, swings, phases, "output.history=[]", &numerics];
        let balance = Balance::case(DROP, &set);
        balance.closes();
        balance.is_kept(1e-8, &["penalties"]);
        assert!((0.0..=penalties).contains(&balance.last("penalties")), "{}", balance.last("penalties"));
        assert!(balance.last("stored") > 0.1 * balance.most() && balance.last("initial") > 0.6, "{numerics}");
    }
}

/// `½ m g² t²`, as work of gravity and as kinetic energy.
#[test]
fn a_free_fall() {
    let balance = Balance::case(DROP, &["phases.fall.duration=0.2", "output.history=[]"]);
    balance.closes();
    let fallen = 0.5 * 0.16 * 1.6 * (9.81f64 * 0.2).powi(2);
    for name in ["gravity", "kinetic"] {
        assert!((balance.last(name) / fallen - 1.0).abs() < 1e-9, "{name}: {}", balance.last(name));
    }
}

/// A column under a load that grows evenly: `½ q s`, whatever the number of steps, and all of it is stored.
#[test]
fn an_oedometer() {
    const CASE: &str = "templates/consolidation";
    let soil = "materials.clay={model: linear_elastic, young: 4.0e+6, poisson: 0.2, density: 0}";
    for step in ["1", "0.25"] {
        let phases = format!(
            "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: {step}}}, \
             tractions: [{{surface: all, ty: {{table: [[0, 0], [1, -40]]}}}}]}}]"
        );
        let set = [soil, "drained_surface=null", "output.fields=[displacement]", "output.history=[]", &phases];
        let balance = Balance::case(CASE, &set);
        balance.closes();
        // ½ q²/E_oed over 2 m by 0.4 m.
        let stored = 0.5 * 40.0 * 40.0 / (4.0e6 * 0.8 / (1.2 * 0.6)) * 0.8;
        for name in ["loads", "stored"] {
            assert!((balance.last(name) / stored - 1.0).abs() < 1e-4, "{name}: {} {stored}", balance.last(name));
        }
        balance.is_kept(1e-4, &[]);
    }
}

/// A layer under a load that comes at once: its work is twice what the skeleton stores at the end, and the water that leaves dissipates the other half. The
/// steps take what a sudden load does beyond the mean of both ends in the first of them.
#[test]
fn a_layer_that_consolidates() {
    let phases = "phases=[{name: first, analysis: consolidation, duration: 1000, step: {initial: 50}, tractions: [{surface: all, ty: -40}]}, \
                  {name: second, analysis: consolidation, duration: 4.0e+6, step: {initial: 1000, max: 2.0e+5}, tractions: [{surface: all, ty: -40}]}]";
    let balance = Balance::case("templates/consolidation", &[phases, "output.every=4.0e+6"]);
    balance.closes();
    let [loads, stored, seepage] = ["loads", "stored", "seepage"].map(|name| balance.last(name));
    assert!((stored / loads - 0.5).abs() < 0.01, "{stored} {loads}");
    assert!((seepage / loads - 0.5).abs() < 0.03, "{seepage} {loads}");
}

/// A block that slides down an incline: friction takes `μ N s`, gravity gives `m g s sin θ`.
#[test]
fn a_block_on_an_incline() {
    let folder = run("cases/incline", &[]);
    let balance = Balance::of(folder.path());
    balance.closes();
    // Once it slides: before, the ground beneath it swings.
    let since = |name: &str| balance.last(name) - balance.all(name)[balance.rows.len() / 2];
    let (friction, gravity) = (since("friction"), since("gravity"));
    let ratio = 0.2 / 20f64.to_radians().tan();
    assert!((friction / gravity / ratio - 1.0).abs() < 2e-3, "{}", friction / gravity / ratio);
    assert!((since("kinetic") / gravity / (1.0 - ratio) - 1.0).abs() < 5e-3);
    balance.is_kept(5e-3, &[]);
}

/// A footing that is pushed into clay: the supports do the work of force times way, which the clay stores and dissipates.
#[test]
fn a_footing_on_clay() {
    let folder = run("templates/footing", &["phases.push.step={initial: 0.05, max: 0.1}"]);
    let balance = Balance::of(folder.path());
    balance.closes();
    balance.is_kept(5e-3, &[]);
    let [way, force] = ["footing.uy [m]", "footing.contact_y [kN]"].map(|name| column(folder.path(), name));
    let (mut work, mut before) = (0.0, [0.0; 2]);
    for now in way.iter().zip(&force).map(|(way, force)| [*way, *force]) {
        work -= 0.5 * (now[1] + before[1]) * (now[0] - before[0]);
        before = now;
    }
    assert!((balance.last("supports") / work - 1.0).abs() < 1e-9, "{} {work}", balance.last("supports"));
    let [plastic, stored] = [balance.last("plastic"), balance.last("stored") - balance.last("initial")];
    assert!(((plastic + stored) / work - 1.0).abs() < 0.02 && plastic > 0.8 * work, "{plastic} {stored} {work}");
}

mod slow {
    use super::*;

    /// Blocks that land on a support and spread to toes thinner than a cell, or splash up the side, and a stiff one on a wall in steps longer than a wave
    /// takes through it: neither impact nor yield nor a reset gives energy.
    #[test]
    fn what_lands_has_no_energy_from_nowhere() {
        let elastic = "materials.clay={model: linear_elastic, young: 200, poisson: 0.49, density: 1.6}";
        let clay = |poisson| {
            format!("materials.clay={{model: tresca, young: 200, poisson: {poisson}, shear_strength: 2, density: 1.6}}")
        };
        let sand =
            "materials.clay={model: mohr_coulomb, young: 200, poisson: 0.3, cohesion: 1, friction: 25, density: 1.6}";
        let stiff = "materials.clay={model: linear_elastic, young: 20000, poisson: 0.1, density: 1.6}";
        let wall = ["supports={left: {ux: 0}, right: {ux: 0}}", "contacts=[{wall: floor, friction: 0.3}]"];
        let scenes = [
            (elastic.to_owned(), 0.75, &[][..]),
            (elastic.to_owned(), 0.67, &[]),
            (clay(0.3), 0.75, &[]),
            (clay(0.49), 0.75, &[]),
            (sand.to_owned(), 0.7, &[]),
            (stiff.to_owned(), 0.62, &wall),
        ];
        for (material, height, on) in scenes {
            let height = format!("mesh.parameters.y={height}");
            let set = [&height, "mesh.parameters.top=4", "numerics={}", "phases.fall.duration=0.55", &material];
            let balance = Balance::case(DROP, &[&set[..], on].concat());
            balance.closes();
            let entries = ["impact", "steps", "resets", "penalties"].map(|name| balance.all(name));
            let lost = |row: usize| entries.iter().map(|entry| entry[row]).sum::<f64>();
            let least = (0..balance.rows.len()).map(lost).fold(0.0, f64::min);
            println!("{material} {height}: {least} of {}", balance.most());
            assert!(least >= -1e-3 * balance.most(), "{material} {height}: {least} of {}", balance.most());
            assert!(balance.all("impact").iter().all(|&lost| lost > -1e-9 * balance.most()), "{material} {height}");
        }
    }

    /// Blocks that land, on a support and on a wall, elastic and of clay; and a bar that is pushed into clay, with friction.
    #[test]
    fn every_scene_closes() {
        let wall = ["supports={left: {ux: 0}, right: {ux: 0}}", "contacts=[{wall: floor, friction: 0.3}]"];
        let clay = "materials.clay={model: tresca, young: 2000, poisson: 0.49, shear_strength: 4, density: 1.6}";
        for (material, on) in [(ELASTIC, &[][..]), (ELASTIC, &wall), (clay, &[])] {
            let set = ["mesh.parameters.y=0.8", "numerics={}", "phases.fall.duration=0.6", material];
            Balance::case(DROP, &[&set[..], on].concat()).closes();
        }
        let bar = Balance::case("templates/penetration", &["mesh.parameters.h=0.25", "phases.push.duration=0.5"]);
        bar.closes();
        assert!(bar.last("friction") > 0.03 * bar.last("supports"), "{}", bar.last("friction"));
    }
}
