//! Quasi-static contact with friction from the first step, in which nothing presses yet.

use crate::contact::history;

/// Sand without cohesion beside a rough wall, whose stress is nought as gravity begins to grow: in steps of a tenth, as with a cohesion of 0.01 kPa.
#[test]
fn sand_without_cohesion_fills_a_bin_with_a_rough_wall() {
    let last = |cohesion: &str| history("tests/data/bin", &[cohesion]).last().unwrap().clone();
    let [without, with] = ["materials.sand.cohesion=0", "materials.sand.cohesion=0.01"].map(last);
    let weight = 0.5 * 1.6 * 9.81;
    println!("the wall bears {:.4} and {:.4} kN of {weight:.4} kN", -without[2], -with[2]);
    assert!((without[3] - without[2] - weight).abs() < 1e-6 * weight, "{without:?}");
    assert!(
        (without[2] / with[2] - 1.0).abs() < 5e-3 && (without[1] / with[1] - 1.0).abs() < 5e-3,
        "{without:?} {with:?}"
    );
    assert!(-without[2] <= 0.364 * without[1] * (1.0 + 1e-9) && -without[2] > 0.35 * without[1], "{without:?}");
}

/// An elastic body on a rough floor spreads as it settles: its base sticks inside and slides at the rim.
#[test]
fn an_elastic_cylinder_settles_on_a_rough_floor() {
    let weight = std::f64::consts::PI * 1.8 * 10.0;
    for (friction, size) in [(0.3, 0.13), (0.5, 0.13), (0.7, 0.12), (1.0, 0.13)] {
        let overrides = [format!("contacts[0].friction={friction}"), format!("mesh.parameters.h={size}")];
        let rows = history("tests/data/rough_floor", &overrides.each_ref().map(String::as_str));
        let force = rows.last().unwrap()[2];
        assert!((force / -weight - 1.0).abs() < 1e-6, "friction {friction}: {force} kN of {weight} kN");
    }
}
