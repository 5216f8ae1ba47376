//! Soil with a limit of its mean stress in tension, from the case to the results, against closed forms.

use crate::support::{column, errors, in_folder, project, run};

const YOUNG: f64 = 1000.0;
const STRENGTH: f64 = 5.0;
const LIMIT: f64 = 20.0;

/// What voids of 8 % may keep of the volume (-) as they close: the points of a cell do not all open alike.
const CLOSED: f64 = 1e-3;

/// The axial Cauchy stress (kPa) of confined Tresca soil that has been stretched up to `most` and is now at the stretch `now` (-): the mean
/// stress is Hencky's up to the limit, and then rises by 2 s_u for each volume that opens; beside a pressure field the points keep
/// a thousandth of the shear modulus as bulk modulus.
fn axial(poisson: f64, field: bool, most: f64, now: f64) -> f64 {
    let shear = 0.5 * YOUNG / (1.0 + poisson);
    let whole = YOUNG / (3.0 * (1.0 - 2.0 * poisson));
    let kept = if field { 1e-3 * shear } else { 0.0 };
    let (bulk, limit) = (whole - kept, LIMIT * (1.0 - kept / whole));
    let at = (limit / bulk).exp();
    let mean = if bulk * now.ln() <= limit { bulk * now.ln() / now } else { limit / at + 2.0 * STRENGTH * (now - at) };
    // The largest difference of the principal Kirchhoff stresses, on the way out and back.
    let out = (2.0 * shear * most.ln()).min(2.0 * STRENGTH);
    let difference = (out - 2.0 * shear * (most / now).ln()).max(-2.0 * STRENGTH);
    mean + (kept * now.ln() + 2.0 / 3.0 * difference) / now
}

/// Soil whose water flows has another limit, and is refused with the reason.
#[test]
fn a_limit_beside_water_that_flows_is_refused() {
    let soil = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 5, tension_limit: 20, density: 0, \
        drainage: undrained, permeability: 1.0e-8}";
    let set = ["--set", soil, "--set", "materials.plate.poisson=0.1"];
    let output = in_folder(&project("tests/data/plate"), &[&["check", "."], &set[..]].concat());
    let said = errors(&output);
    assert!(
        !output.status.success() && said.contains("tension_limit") && said.contains("a pressure field of its own"),
        "{said}"
    );
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A confined column is pulled by a plate that cannot part from it, and pushed back: the mean stress comes to its limit, stays, and comes back as the
    /// voids close. On a grid that is restored in each step, and on one that is not; any two of the three choices are combined in all ways.
    #[test]
    fn a_confined_column_cavitates_and_closes_again() {
        for (geometry, poisson, restore) in [
            ("plane_strain", 0.3, "every_step"),
            ("plane_strain", 0.49, "never"),
            ("axisymmetric", 0.49, "every_step"),
            ("axisymmetric", 0.3, "never"),
        ] {
            let field = poisson == 0.49;
            let width = if geometry == "axisymmetric" { 2.0 } else { 1.0 };
            let entries = [
                format!("geometry={geometry}"),
                format!(
                    "materials.soil={{model: tresca, young: {YOUNG}, poisson: {poisson}, shear_strength: {STRENGTH}, \
                 tension_limit: {LIMIT}, density: 0}}"
                ),
                format!("numerics={{restore: {restore}}}"),
                "contacts[0].tension=no_separation".to_string(),
                format!("mesh.parameters={{width: {width}, plate: {width}}}"),
                "phases=[{name: pull, analysis: quasi_static, duration: 2, step: {initial: 0.02, max: 0.02}, \
              prescribe: {top: {ux: 0, uy: {table: [[0, 0], [1, 0.08], [2, 0]]}}}}]"
                    .to_string(),
            ];
            let folder = run("tests/data/plate", &entries.iter().map(String::as_str).collect::<Vec<_>>());
            let (moved, force) = (column(folder.path(), "plate.uy [m]"), column(folder.path(), "plate.contact_y [kN]"));
            let area = if geometry == "axisymmetric" { 4.0 * std::f64::consts::PI } else { width };
            let top = moved.iter().copied().fold(0.0, f64::max);
            let (mut most, mut errors) = (1.0f64, [0.0f64; 3]);
            let shear = 0.5 * YOUNG / (1.0 + poisson);
            let bulk = YOUNG / (3.0 * (1.0 - 2.0 * poisson));
            for (moved, force) in moved.iter().zip(&force) {
                let (now, closes) = (1.0 + moved, most > 1.0 + moved);
                most = most.max(now);
                let error = (-force / area - axial(poisson, field, most, now)).abs();
                // Where voids are all but closed the stress is a matter of how much volume is left.
                let is_closed = closes && now.ln() < LIMIT / bulk + CLOSED;
                let error = if is_closed { error / (bulk + 4.0 / 3.0 * shear) } else { error / LIMIT };
                let which = usize::from(closes) + usize::from(is_closed);
                errors[which] = errors[which].max(error);
            }
            println!("{geometry} {poisson} {field} {restore}: {errors:?}");
            // Less what the plate itself is stretched.
            assert!((top - 0.08).abs() < 1e-6, "{top}");
            let bounds = errors[0] < 0.02 && errors[1] < 0.05 && errors[2] < CLOSED;
            assert!(bounds, "{geometry} {poisson} {field} {restore}: {errors:?}");
        }
    }
}
