//! The schemes through the program: contact, names, and what `mpm check` and `mpm solve` refuse.

use crate::support::{errors, in_folder, mpm, project, rows, solve, succeeds};

const QUADS: &str = "tests/data/quads";

/// Half of a block of soil between smooth plates, which press it by a tenth of its height in ten steps while the grid is reset in each: the
/// force is that of uniform plane strain, `2 E/(1 − ν²) (−ln λ)/λ` with Hencky's elasticity. Plain MPM loses 6 % as points cross cells.
#[test]
fn a_plate_presses_soil() {
    let exact = 2.0 * 1000.0 / (1.0 - 0.09) * -0.9f64.ln() / 0.9;
    let error = |gradient: &str, more: &str| {
        let folder = solve(QUADS, &["numerics.restore=every_step", gradient, more]);
        rows(folder.path()).pop().unwrap()[4] / exact - 1.0
    };
    let plain = error("numerics.gradient=mpm", "numerics.quadrature=points");
    println!("contact force of mpm {plain:+.4}");
    assert!(plain < -0.04, "{plain}");
    for scheme in ["ugimp", "gimp", "composite", "cpdi", "cpdi2"] {
        let off = error(&format!("numerics.gradient={scheme}"), "output.every=0.5");
        println!("contact force of {scheme} {off:+.4}");
        assert!(off.abs() < 0.02, "{scheme}: {off}");
    }
}

/// On a grid that is not reset, all schemes integrate uniform strain exactly, beside smooth and rigid plates, in plane strain and axisymmetry, with
/// a pressure field and with pore water: they have the forces of plain MPM.
#[test]
fn without_a_reset_they_have_the_forces_of_plain_mpm() {
    let undrained =
        "materials.soil={model: linear_elastic, young: 1000, poisson: 0.3, density: 0, drainage: undrained}";
    let water = "materials.soil={model: linear_elastic, young: 1000, poisson: 0.3, density: 0, drainage: undrained, \
                 permeability: 1.0e-5, porosity: 0.5, water_bulk_modulus: 2.2e+6}";
    let rigid = "phases[0].prescribe={plate: {ux: 0, rotation: 0, uy: {rate: -0.1}}}";
    for more in [
        &["geometry=axisymmetric"][..],
        &["regions.plate.rigid=true", rigid],
        &[undrained],
        &[water, "supports.bottom.pore_pressure=0", "phases[0].analysis=consolidation"],
    ] {
        let force = |gradient: &str| {
            let set = ["numerics.restore=never", "numerics.quadrature=points", gradient];
            rows(solve(QUADS, &[&set[..], more].concat()).path()).pop().unwrap()[4]
        };
        let plain = force("numerics.gradient=mpm");
        for scheme in ["ugimp", "cpgimp", "composite", "cpdi", "cpdi2"] {
            let off = force(&format!("numerics.gradient={scheme}")) / plain - 1.0;
            // Around an axis and with a pressure field strain is not uniform, and the interpolation sees another one.
            let most = if scheme == "composite" { 5e-3 } else { 1e-6 };
            assert!(off.abs() < most, "{scheme}, {more:?}: {off:e}");
        }
    }
}

/// What is said of a case with entries overridden: by `mpm check`, or as it is solved.
fn refused(by_check: bool, case: &str, set: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let said = if by_check {
        let path = project(case).display().to_string();
        let set = set.iter().flat_map(|entry| ["--set", entry]);
        in_folder(folder.path(), &["check", &path].into_iter().chain(set).collect::<Vec<_>>())
    } else {
        ["mesh", "seed"].iter().for_each(|stage| succeeds(&mpm(stage, case, folder.path(), set)));
        mpm("solve", case, folder.path(), set)
    };
    assert_eq!(said.status.code(), Some(2), "{}", errors(&said));
    let said = errors(&said);
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
}

#[test]
fn what_they_do_not_support_is_refused_with_another_choice() {
    let resampled = "numerics.quadrature=resampled";
    let reason = "cpgimp averages over the domains of the material points";
    refused(true, QUADS, &[resampled], &[reason, "`quadrature: points`"]);
    let set = ["numerics.gradient=cpdi", "regions.soil.points_per_cell=12"];
    refused(true, "tests/data/plate", &set, &["cpdi needs points that fill their cells", "use 4, 9, 16 or 25"]);
    let composite = "numerics.gradient=composite";
    refused(true, QUADS, &[resampled, composite], &["composite averages over the domains", "`quadrature: points`"]);
    refused(
        true,
        "tests/data/plate",
        &[composite],
        &["composite does not support cells of second order", "`order: 1`"],
    );
    let (plate, gimp) = ("tests/data/plate", "numerics.gradient=gimp");
    refused(true, plate, &[gimp], &["cpgimp does not support cells of second order", "`order: 1`"]);
    refused(
        false,
        plate,
        &[gimp, "mesh.order=1"],
        &["cpgimp needs cells that are rectangles along the axes", "`Recombine Surface`"],
    );
    let beside =
        "regions={soil: {kind: fem, material: soil}, air: {kind: buffer}, plate: {kind: structure, material: plate}}";
    let contact = "contacts=[{structure: plate, against: soil}]";
    let words = ["cpgimp needs a grid that keeps its shape", "`gradient: mpm`"];
    refused(false, QUADS, &[contact, beside], &words);
}
