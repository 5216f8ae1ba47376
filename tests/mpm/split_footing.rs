//! Finite elements beside material points, through the program: soil of two regions that meet along a slanted line, each of
//! either kind.

use crate::support;
use std::path::Path;
use std::process::Output;

fn mpm(stage: &str, out: &Path, set: &[&str]) -> Output {
    support::mpm(stage, "tests/data/split_footing", out, set)
}

/// Settlement and reaction of the footing at the end.
fn solved(set: &[&str]) -> [f64; 2] {
    let out = tempfile::tempdir().unwrap();
    for stage in ["mesh", "seed", "solve", "export"] {
        let result = mpm(stage, out.path(), set);
        assert!(result.status.success(), "{set:?}: {}", String::from_utf8_lossy(&result.stderr));
    }
    let elements = set.iter().any(|entry| entry.contains("kind=fem")) || !set.iter().any(|entry| entry.contains("far"));
    assert_eq!(out.path().join("structures.pvd").exists(), elements, "{set:?}");
    let history = std::fs::read_to_string(out.path().join("history.csv")).unwrap();
    let last: Vec<f64> = history.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    println!("{set:?}: {last:?}");
    [last[1], last[2]]
}

const ALL_FEM: &str = "regions.near.kind=fem";
const ALL_MPM: &str = "regions.far.kind=mpm";
const ELASTIC: &str = "materials.clay={model: linear_elastic, young: 1.0e+5, poisson: 0.3, density: 0}";

fn agree_within(limit: f64, set: &[&str]) {
    let reaction = |more: &[&str]| solved(&[set, more].concat())[1];
    let (split, fem, mpm) = (reaction(&[]), reaction(&[ALL_FEM]), reaction(&[ALL_MPM]));
    for other in [fem, mpm] {
        assert!((split / other - 1.0).abs() < limit, "split {split}, fem {fem}, mpm {mpm}");
    }
}

#[test]
fn an_elastic_footing_is_as_stiff_on_either_kind_of_soil() {
    agree_within(0.01, &[ELASTIC]);
}

/// At B/500 of a soil with E = 1000 s_u, at 63 % of the limit load.
#[test]
fn a_yielding_footing_is_as_strong_on_either_kind_of_soil() {
    agree_within(0.01, &[]);
}

const LOAD: &str = "phases[0].prescribe={}";
const TRACTION: &str = "phases[0].tractions=[{on: footing, ty: {rate: -20000}}]";

/// Finite elements keep their shape: when the grid is restored does not matter, nor that the load is large.
#[test]
fn a_traction_on_finite_elements_is_dead_in_any_restoration() {
    let never = solved(&[ALL_FEM, ELASTIC, LOAD, TRACTION, "numerics.restore=never"])[0];
    let always = solved(&[ALL_FEM, ELASTIC, LOAD, TRACTION])[0];
    assert!(never < -0.1 && (always / never - 1.0).abs() < 1e-7, "{always} against {never}");
}

#[test]
fn a_traction_on_soil_that_leaves_its_grid_is_refused() {
    let out = tempfile::tempdir().unwrap();
    for stage in ["mesh", "seed"] {
        assert!(mpm(stage, out.path(), &[LOAD, TRACTION]).status.success());
    }
    let refused = mpm("solve", out.path(), &[LOAD, TRACTION]);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("`footing`") && said.contains("restore: never") && said.contains("kind: fem"), "{said}");
}
