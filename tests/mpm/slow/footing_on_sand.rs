//! A strip footing on soil with friction, through the program: the limit load against slip lines.

use crate::support::{column, solve};

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
