//! Strength that varies at random in space: what the points have of it, and what it does to a block that yields.

use crate::support::{column, errors, in_folder, said, succeeds};
use mpm::io::points_vtu;
use mpm::material::{Correlation, RandomStrength, Randomness};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const GEO: &str = r#"DefineConstant[ h = {0.5, Name "Parameters/h"} ];
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("soil") = {1}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3};
Physical Curve("left") = {4};
"#;

/// A block between smooth plates, whose stress is uniform while its strength is: σ₁ − σ₃ = 2 s_u.
const CASE: &str = "\
geometry: plane_strain
mesh: {geo: scene.geo}
regions: {soil: {kind: mpm, material: clay}}
materials: {clay: {model: tresca, young: 10000, poisson: 0.3, shear_strength: 5, density: 1.8,
  random_strength: {coefficient_of_variation: 0.4, horizontal_scale: 3, vertical_scale: 0.5, seed: 1}}}
supports: {bottom: {uy: 0}, left: {ux: 0}}
phases:
  - name: load
    analysis: quasi_static
    duration: 1
    step: {initial: 0.1, max: 0.1}
    prescribe: {top: {uy: {rate: -0.002}}}
output:
  fields: [stress, displacement, shear_strength]
  history: [{name: top, on: top, quantities: [uy, reaction_y]}]
";

fn scene() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.yaml"), CASE).unwrap();
    fs::write(folder.path().join("scene.geo"), GEO).unwrap();
    folder
}

const RANDOM: Randomness =
    Randomness { variation: 0.4, lengths: [3.0, 0.5], correlation: Correlation::Markov, seed: 1 };

/// Runs stages of the case with entries overridden.
fn stages(folder: &Path, stages: &[&str], set: &[&str]) {
    for stage in stages {
        let set: Vec<&str> = set.iter().flat_map(|entry| ["--set", entry]).collect();
        succeeds(&in_folder(folder, &[&[*stage, "."], &set[..]].concat()));
    }
}

#[test]
fn a_realisation_is_the_same_whatever_the_mesh_and_the_points() {
    let field = RandomStrength::new(&RANDOM);
    for set in [&[][..], &["mesh.parameters.h=0.11"], &["regions.soil.points_per_cell=25"], &["mesh.order=1"]] {
        let scene = scene();
        stages(scene.path(), &["mesh", "seed"], set);
        let points = points_vtu::read::<2>(&scene.path().join("out/points.vtu")).unwrap().points;
        let expected: Vec<f64> = points.position.iter().map(|x| field.factor(x)).collect();
        assert_eq!(points.strength, expected, "{set:?}");
        assert!(expected.iter().any(|f| *f > 1.1) && expected.iter().any(|f| *f < 0.9), "{expected:?}");
    }
}

#[test]
fn a_scale_beyond_the_scene_scales_the_load() {
    // One strength for all: the block bears its factor times what it bears without.
    let far = "materials.clay.random_strength={coefficient_of_variation: 0.4, horizontal_scale: 1.0e+7, vertical_scale: 1.0e+7, \
        correlation: gaussian, seed: SEED}";
    for quadrature in ["resampled", "points"] {
        for model in ["tresca", "von_mises", "tresca_softening", "mohr_coulomb"] {
            let numerics = format!("numerics.quadrature={quadrature}");
            let material = match model {
                "von_mises" => "yield_stress: 5",
                "tresca_softening" => "shear_strength: 5, remoulded: 0.999999, ductility: 1000",
                "mohr_coulomb" => "cohesion: 5, friction: 0",
                _ => "shear_strength: 5",
            };
            let load = |strength: f64, random: &str| {
                let scene = scene();
                // In proportion with the strength: so that all else is the same but for a factor.
                let (young, rate) = (1e4, -0.002 * strength);
                let material = format!(
                    "materials.clay={{model: {model}, young: {young}, poisson: 0.3, density: 1.8, {material}}}"
                );
                let push = format!("phases[0].prescribe.top.uy.rate={rate}");
                let set = [&material, random, &numerics, &push];
                let set: Vec<&str> = set.into_iter().map(AsRef::as_ref).filter(|s: &&str| !s.is_empty()).collect();
                stages(scene.path(), &["mesh", "seed", "solve"], &set);
                *column(&scene.path().join("out"), "top.reaction_y [kN]").last().unwrap()
            };
            let mean = load(1.0, "");
            for seed in [1, 2] {
                let factor = RandomStrength::new(&Randomness {
                    lengths: [1e7; 2],
                    correlation: Correlation::Gaussian,
                    seed,
                    ..RANDOM
                })
                .factor(&[0.0, 0.0]);
                let found = load(factor, &far.replace("SEED", &seed.to_string())) / mean;
                println!("{model} {quadrature} seed {seed}: {found:.6} of the load, the strength {factor:.6}");
                assert!((found / factor - 1.0).abs() < 2e-3, "{model} {quadrature}: {found} {factor}");
                assert!((factor - 1.0).abs() > 0.05, "{factor}");
            }
        }
    }
}

#[test]
fn without_variation_no_bit_changes() {
    let history = |random: &str| {
        let scene = scene();
        let material = format!(
            "materials.clay={{model: tresca, young: 10000, poisson: 0.3, shear_strength: 5, density: 1.8{random}}}"
        );
        stages(scene.path(), &["mesh", "seed", "solve"], &[&material, "phases[0].prescribe.top.uy.rate=-0.2"]);
        fs::read(scene.path().join("out/history.csv")).unwrap()
    };
    let random = ", random_strength: {coefficient_of_variation: 0, horizontal_scale: 3, vertical_scale: 0.5, seed: 1}";
    assert!(history("") == history(random));
}

#[test]
fn what_makes_no_sense_is_refused_with_its_place() {
    for (entry, value, problem) in [
        ("coefficient_of_variation", "-0.1", "coefficient_of_variation"),
        ("coefficient_of_variation", ".inf", "coefficient_of_variation"),
        ("horizontal_scale", "0", "horizontal_scale"),
        ("vertical_scale", "-2", "vertical_scale"),
        ("vertical_scale", ".nan", "vertical_scale"),
        ("seed", "-1", "seed"),
        ("seed", "1.5", "seed"),
        ("correlation", "linear", "correlation"),
        ("scale", "1", "scale"),
    ] {
        let scene = scene();
        let set = format!("materials.clay.random_strength.{entry}={value}");
        let output = in_folder(scene.path(), &["check", ".", "--set", &set]);
        println!("{set}\n{}", said(&output));
        assert_eq!(output.status.code(), Some(2), "{set}");
        assert!(
            said(&output).contains(problem) && errors(&output).matches("error: ").count() == 1,
            "{set}: {}",
            said(&output)
        );
    }
    let scene = scene();
    let elastic = "materials.clay={model: linear_elastic, young: 100, poisson: 0.3, density: 1, \
        random_strength: {coefficient_of_variation: 0.4, horizontal_scale: 3, vertical_scale: 0.5, seed: 1}}";
    let output = in_folder(scene.path(), &["check", ".", "--set", elastic]);
    assert!(said(&output).contains("the model linear_elastic has no strength"), "{}", said(&output));
}

#[test]
fn a_strength_that_softens_too_fast_somewhere_is_told_with_the_place() {
    let scene = scene();
    let brittle = "materials.clay={model: tresca_softening, young: 1000, poisson: 0.3, shear_strength: 5, remoulded: 0.2, \
        ductility: 0.07, density: 1, random_strength: {coefficient_of_variation: 0.4, horizontal_scale: 3, vertical_scale: 0.5, seed: 1}}";
    succeeds(&in_folder(scene.path(), &["mesh", ".", "--set", brittle]));
    let output = in_folder(scene.path(), &["seed", ".", "--set", brittle]);
    assert_eq!(output.status.code(), Some(2));
    let said = said(&output);
    assert!(
        said.contains("where its random strength is") && said.contains("faster than the soil can unload"),
        "{said}"
    );
}

/// Where the strength is above the mean a tension cut-off near the apex would be above it, which is no mistake of the case: it counts as the apex.
#[test]
fn a_tension_near_the_apex_is_no_mistake_where_soil_is_strong() {
    let scene = scene();
    let sand = "materials.clay={model: mohr_coulomb, young: 1000, poisson: 0.3, cohesion: 5, friction: 45, tension: 4.9, density: 1, \
        random_strength: {coefficient_of_variation: 0.4, horizontal_scale: 3, vertical_scale: 0.5, seed: 1}}";
    for stage in ["mesh", "seed"] {
        succeeds(&in_folder(scene.path(), &[stage, ".", "--set", sand]));
    }
}

#[test]
fn the_strength_is_an_output_field() {
    let scene = scene();
    stages(scene.path(), &["run"], &["output.encoding=plain", "mesh.parameters.h=0.5"]);
    let picture = ["plot", ".", "--field", "shear_strength", "-o", "s.png"];
    succeeds(&in_folder(scene.path(), &picture));
    assert!(fs::metadata(scene.path().join("s.png")).unwrap().len() > 1000);
    let vtu = fs::read_dir(scene.path().join("out/vtu")).unwrap().map(|entry| entry.unwrap().path());
    let texts: Vec<String> = vtu.filter_map(|path| fs::read_to_string(path).ok()).collect();
    assert!(texts.iter().any(|text| text.contains("Name=\"shear_strength [kPa]\"")));
}
