//! Factors of safety of clay slopes against the slip circle of the least one (φ = 0), which Taylor's charts (1937) are made of.

use crate::support::{column, log, safety, solve_text};
use std::f64::consts::PI;

const UNIT_WEIGHT: f64 = 18.0;

/// A slope of some height (m) and angle (°) on a layer of clay whose strength (kPa) is `top` at the crest and grows by `gradient` (kPa/m).
#[derive(Clone, Copy)]
struct Slope {
    height: f64,
    angle: f64,
    base: f64,
    top: f64,
    gradient: f64,
}

impl Slope {
    fn ground(&self, x: f64) -> f64 {
        (-x * self.angle.to_radians().tan()).clamp(0.0, self.height)
    }

    /// The factor of safety of a circle: moments of strength and weight about its centre; infinite where it is none.
    fn of_circle(&self, [x, y, radius]: [f64; 3]) -> f64 {
        const PARTS: usize = 400;
        if radius <= 0.0 || y - radius < -self.base {
            return f64::INFINITY;
        }
        let (mut weight, mut strength) = (0.0, 0.0);
        let arc = PI / PARTS as f64;
        for k in 0..PARTS {
            let angle = PI + (k as f64 + 0.5) * arc;
            let place = [x + radius * angle.cos(), y + radius * angle.sin()];
            let above = self.ground(place[0]) - place[1];
            if above > 0.0 {
                weight += UNIT_WEIGHT * above * (x - place[0]) * -angle.sin() * radius * arc;
                strength += (self.top + self.gradient * (self.height - place[1])) * radius * radius * arc;
            }
        }
        if weight > 0.0 { strength / weight } else { f64::INFINITY }
    }

    /// The least factor over all circles: a coarse search, refined around the best one.
    fn of_circles(&self) -> f64 {
        let h = self.height;
        let run = h / self.angle.to_radians().tan();
        let mut best = ([0.0; 3], f64::INFINITY);
        let mut centre = [-0.5 * run, 2.0 * h, -self.base];
        let mut reach = [run, 1.5 * h, 0.0];
        // First the deepest circles and those through the toe, then all around the best.
        for round in 0..12 {
            for k in 0..21 * 21 * 5 {
                let at = |n: usize| (n as f64 / 10.0) - 1.0;
                let (x, y) = (centre[0] + reach[0] * at(k % 21), centre[1] + reach[1] * at(k / 21 % 21));
                let deepest = match (round, k / 441) {
                    (0, 0) => -self.base,
                    (0, 1) => y - x.hypot(y),
                    (_, n) => (centre[2] + reach[2] * (n as f64 - 2.0) / 2.0).max(-self.base),
                };
                let circle = [x, y, y - deepest];
                let factor = self.of_circle(circle);
                if factor < best.1 {
                    best = (circle, factor);
                }
            }
            let [x, y, radius] = best.0;
            centre = [x, y, y - radius];
            let share = 0.6f64.powi(round + 1);
            reach = [run * share, 1.5 * h * share, 0.3 * h * share];
        }
        best.1
    }

    /// The factors with and without equilibrium, as the log has them; `soil` is of the kind given, under K₀ where that is.
    fn found(&self, kind: &str, k0: Option<f64>) -> [f64; 2] {
        let Self { height, angle, base, top, gradient } = self;
        let gravity = "- {name: gravity, analysis: quasi_static, duration: 1, step: {initial: 0.25, min: 0.01}, gravity: {rate: 1}}\n";
        let (stress, gravity) = match k0 {
            Some(k0) => (format!("initial_stress: {{k0: {k0}}}\n"), ""),
            None => (String::new(), gravity),
        };
        let folder = solve_text(&format!(
            "geometry: plane_strain\n\
             mesh: {{geo: GEO/seabed_slope.geo, parameters: {{height: {height}, angle: {angle}, base: {base}, crest: 12, plain: 12, h: 1, coarse: 2}}}}\n\
             regions: {{soil: {{kind: {kind}, material: clay}}, water: {{kind: buffer}}}}\n\
             materials: {{clay: {{model: tresca, young: 30000, poisson: 0.49, unit_weight: {UNIT_WEIGHT}, \
                 shear_strength: {{top: {top}, gradient: {gradient}, datum: {height}}}}}}}\n\
             supports: {{bottom: {{ux: 0, uy: 0}}, back: {{ux: 0}}, end: {{ux: 0}}}}\n\
             gravity: {{y: -9.81}}\n{stress}\
             phases:\n{gravity}\
             - {{name: safety, analysis: strength_reduction, duration: 1.5, step: {{initial: 0.1, min: 0.01}}}}\n\
             output: {{history: [{{name: crest, on: crest, quantities: [ux, uy]}}]}}\n"
        ));
        let log = log(folder.path());
        assert!(log.contains("has its kink at"), "{log}");
        let moved = column(folder.path(), "soil_moved [m]");
        assert!(moved.iter().all(|moved| *moved < 0.5), "{moved:?}");
        safety(&log)
    }
}

const UNIFORM: Slope = Slope { height: 5.0, angle: 45.0, base: 5.0, top: 30.0, gradient: 0.0 };

#[test]
fn the_circles_are_those_of_taylor() {
    // N = γH/s_u at failure: on a layer as deep as the slope is high, and for a circle through the toe.
    for (slope, number) in [(UNIFORM, 5.64), (Slope { angle: 53.0, base: 1.0, ..UNIFORM }, 5.55)] {
        let found = slope.of_circles() * UNIT_WEIGHT * slope.height / slope.top;
        assert!((found / number - 1.0).abs() < 0.01, "{found} {number}");
    }
}

/// Five to ten cells over the height are within 5 % of the circles.
#[test]
fn slopes_of_clay_have_the_factor_of_slip_circles() {
    for (name, slope, kind, k0) in [
        ("uniform", UNIFORM, "mpm", None),
        ("of finite elements", UNIFORM, "fem", None),
        ("under K0", UNIFORM, "mpm", Some(1.0)),
        ("flat", Slope { angle: 26.565, base: 2.5, ..UNIFORM }, "mpm", None),
        ("firmer with depth", Slope { angle: 30.0, top: 15.0, gradient: 2.0, ..UNIFORM }, "mpm", None),
    ] {
        let circles = slope.of_circles();
        let [held, failed] = slope.found(kind, k0);
        let over = 0.5 * (held + failed) / circles - 1.0;
        println!("{name}: {held} to {failed}, circles {circles:.4}: {:+.1} %", 100.0 * over);
        assert!(failed - held < 0.021 && over.abs() < 0.05, "{name}: {held} to {failed}, circles {circles:.4}");
    }
}
