//! Drained soil with friction near incompressibility: its limit load does not depend on Poisson's ratio.

use crate::support::{errors, mpm};

const FACTOR: &str = "at the gravity factor ";

/// The gravity at which a vertical cut fails, over the whole, as the run ends.
fn factor(poisson: &str) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", "tests/data/vertical_cut", folder.path(), &[&format!("materials.soil.poisson={poisson}")]);
    let said = errors(&output);
    assert!(!output.status.success(), "{poisson}: {said}");
    let from = said.find(FACTOR).unwrap_or_else(|| panic!("{poisson}: {said}")) + FACTOR.len();
    said[from..].split(' ').next().unwrap().parse().unwrap()
}

/// The critical height of a vertical cut is `3.83 c/γ tan(45° + φ/2)` by a logarithmic spiral (Chen 1975): a factor of 0.617 here.
#[test]
fn a_vertical_cut_fails_at_one_gravity_whatever_the_bulk_modulus() {
    let compressible = factor("0.3");
    for poisson in ["0.49", "0.499", "0.4999", "0.49999"] {
        let found = factor(poisson);
        println!("Poisson's ratio {poisson}: {found}, with 0.3: {compressible}");
        assert!((found / compressible - 1.0).abs() < 0.05, "{poisson}: {found}, not {compressible}");
    }
}
