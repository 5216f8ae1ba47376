//! A strip footing on soil with friction, through the program: the limit load against slip lines.

use crate::support::{column, solve};
use std::fs;

/// `N_q` at φ = 30°: `e^(π tan φ) tan²(45° + φ/2)`.
const SURCHARGE_FACTOR: f64 = 18.401;
/// Of Davis' angle φ* for φ = 30° without dilation, `tan φ* = sin φ`.
const WITHOUT_DILATION: f64 = 12.59;

/// On weightless soil the footing bears `q₀ (N_q − 1)`, with cells of a tenth of its width: 5 % more with dilation, which is associated flow, and
/// something between the loads of both angles without.
#[test]
fn a_footing_beside_a_surcharge_has_its_limit_load() {
    for (dilation, range) in
        [("30", 0.98 * SURCHARGE_FACTOR..1.08 * SURCHARGE_FACTOR), ("0", WITHOUT_DILATION..SURCHARGE_FACTOR)]
    {
        let folder =
            solve("cases/footing_on_sand", &["mesh.parameters.h=0.2", &format!("materials.sand.dilation={dilation}")]);
        let found = column(folder.path(), "footing.contact_y [kN]").pop().unwrap() / 10.0 + 1.0;
        println!("ψ = {dilation}°: {found:.2}");
        assert!(range.contains(&found), "{dilation}: {found}");
    }
}

/// `N_γ` of a smooth base at φ = 20° (Martin 2005).
const WEIGHT_FACTOR: f64 = 1.579;

/// On soil that has weight and no surcharge the error falls with the size of the cells, at first order: the stress at the edge of the footing is zero.
/// The stiffness is such that the footing hardly settles: the heap of dilating soil beside it would be a surcharge.
#[test]
fn a_footing_on_heavy_soil_converges_to_its_limit_load() {
    let error = |h: &str| {
        let size = format!("mesh.parameters.h={h}");
        let settings = [
            &size[..],
            "materials.sand={model: mohr_coulomb, young: 1.0e8, poisson: 0.3, cohesion: 0, friction: 20, dilation: 20, unit_weight: 18}",
            "gravity={y: -9.81}",
            "initial_stress={k0: 0.5}",
            "phases.surcharge.tractions[0].ty.rate=0",
            "phases.push.tractions[0].ty=0",
            "phases.push.prescribe.footing.uy.rate=-2.8e-6",
        ];
        let folder = solve("cases/footing_on_sand", &settings);
        column(folder.path(), "footing.contact_y [kN]").pop().unwrap() / 18.0 / WEIGHT_FACTOR - 1.0
    };
    let [coarse, fine] = ["0.2", "0.1"].map(error);
    println!("{coarse:.3}, {fine:.3}");
    assert!((0.0..0.1).contains(&fine) && fine < 0.6 * coarse, "{coarse} {fine}");
}

/// Soil without dilation past its peak: a step is as hard to solve as a smaller one, since all residuals are in proportion to it, and most of them are
/// in equilibrium only after iterations that raise the residual. With a residual that was to fall in each of them the analysis ended at a fifth of the
/// settlement, after twelve halvings of a step. The load is between `c N_c` of Davis' angle and cohesion and that of φ.
#[test]
fn soil_that_does_not_dilate_goes_on_past_its_peak() {
    let settings = [
        "materials.clay={model: mohr_coulomb, young: 1.0e6, poisson: 0.3, cohesion: 10, friction: 30, dilation: 0, density: 0}",
        "mesh.parameters={h: 0.1, width: 10, depth: 6}",
        "phases[0].step={initial: 0.02}",
        "phases[0].prescribe.footing.uy.rate=-0.01",
    ];
    let folder = solve("cases/strip_footing", &settings);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let halvings = log.matches("halved").count();
    assert!(halvings <= 3, "{halvings}");
    let forces = column(folder.path(), "footing.reaction_y [kN]");
    let [most, last] = [forces.iter().fold(0.0, |most: f64, f| most.max(-f)), -forces[forces.len() - 1]];
    println!("{most:.1} kN at most, {last:.1} in the end");
    let factor = |tan: f64| {
        ((std::f64::consts::PI * tan).exp() * (1.0 + 2.0 * tan * tan + 2.0 * tan * tan.hypot(1.0)) - 1.0) / tan
    };
    let (davis, exact) = (10.0 * 3f64.sqrt() / 2.0 * factor(0.5), 10.0 * factor(1.0 / 3f64.sqrt()));
    assert!((davis..1.05 * exact).contains(&most) && (davis..exact).contains(&last), "{davis} {exact}");
}
