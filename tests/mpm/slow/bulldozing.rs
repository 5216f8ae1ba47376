//! A blade pushes a heap of dry sand over a rough floor by the defaults, on cells coarser than those of the case.

use crate::mpm::scripts::of_run;
use crate::support::{column, solve};

/// The blade bears what rubs on the floor, μ W, and the floor the weight, on average over a tenth of a metre.
#[test]
fn a_blade_bears_what_rubs_on_the_floor() {
    for (slope, friction) in [(25.0, 0.3), (32.0, 0.4)] {
        let mesh = format!("mesh.parameters={{h: 0.12, slope: {slope}, way: 2.2}}");
        let rubs = format!("contacts[1].friction={friction}");
        let folder = solve("cases/bulldozing", &[&mesh, &rubs, "phases.push.duration=0.7"]);
        let [time, way, blade, floor] = ["time [s]", "blade.ux [m]", "blade.contact_x [kN]", "floor.contact_y [kN]"]
            .map(|name| column(folder.path(), name));
        let mean = |of: &[f64]| {
            let last = (1..time.len()).filter(|&k| way[k] > 0.2);
            let (sum, whole) = last.fold((0.0, 0.0), |(sum, whole), k| {
                let dt = time[k] - time[k - 1];
                (sum - of[k] * dt, whole + dt)
            });
            sum / whole
        };
        let weight = 1.6 * 9.81 * 0.5 * 0.36 / f64::tan(f64::to_radians(slope));
        let [force, borne] = [mean(&blade) / (friction * weight), mean(&floor) / weight];
        let table = of_run("cases/bulldozing/study.py", folder.path(), &[]);
        assert!(table.contains(&format!("| {} |", folder.path().display())), "{table}");
        println!("slope {slope}: force over μ W {force:.4}, force on the floor over W {borne:.4}");
        assert!((force - 1.0).abs() < 0.03 && (borne - 1.0).abs() < 0.02, "{slope}: {force}, {borne}");
    }
}

/// The heap finds its equilibrium in the first steps of gravity: where residuals had to fall in each iteration, these ended at any size of steps.
#[test]
fn a_heap_without_cohesion_rests_on_a_rough_floor() {
    for (h, slope, friction) in [(0.08, 25.0, 0.3), (0.07, 25.0, 0.4), (0.08, 28.0, 0.5)] {
        let mesh = format!("mesh.parameters={{h: {h}, slope: {slope}, way: 2.2}}");
        let rubs = format!("contacts[1].friction={friction}");
        let folder = solve("cases/bulldozing", &[&mesh, &rubs, "phases.push.duration=0.002"]);
        let [time, floor] = ["time [s]", "floor.contact_y [kN]"].map(|name| column(folder.path(), name));
        let rest = time.iter().position(|t| (t - 1.0).abs() < 1e-9).unwrap();
        let weight = 1.6 * 9.81 * 0.5 * 0.36 / f64::tan(f64::to_radians(slope));
        println!("h {h}, slope {slope}: force on the floor over W {:.7}", -floor[rest] / weight);
        assert!((floor[rest] / weight + 1.0).abs() < 1e-5, "{h}, {slope}: {}", floor[rest]);
    }
}
