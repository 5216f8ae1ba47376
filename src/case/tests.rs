//! Sound cases come out as they were meant, and no text makes the reader panic.

use super::checked::{Content, Geometry, InitialVelocity, Order, Restore};
use super::raw::SHAPES;
use super::source::Source;
use super::{Case, resolve, schema, seeding};
use crate::gravity::Gravity;
use crate::mesh::builder;
use crate::mesh::shape::CellKind;
use crate::time_value::TimeValue;
use proptest::prelude::*;
use std::path::PathBuf;

// The reader only asks whether the .geo is there: any file will do.
const CASE: &str = "\
geometry: axisymmetric
mesh: {geo: Cargo.toml, order: 2, incomplete: true, parameters: {h: 0.5}}
regions:
  block: {kind: mpm, material: clay, points_per_cell: 9}
materials:
  rock: {model: linear_elastic, young: 5000, poisson: 0.2, density: 2.5}
  clay:
    model: tresca
    young: {top: 100, gradient: 10, datum: 2}
    poisson: 0.49
    shear_strength: {top: 1, gradient: 0.5}
    unit_weight: {top: 10, gradient: 1, datum: 1}
supports: {bottom: {ux: 0, uy: 0}, side: {ux: 0}}
gravity: {y: -10}
initial_stress: {k0: 0.5}
initial_velocity: {block: {velocity: {x: 1}, gradient: [[0, -2], [2, 0]], centre: {x: 1, y: 1}}}
numerics: {restore: never, spectral_radius: 1}
phases:
  - {name: a, analysis: quasi_static, duration: 2, step: {initial: 0.1}, gravity: {rate: 0.5}}
  - name: b
    analysis: dynamic
    duration: 1
    step: {initial: 0.01, min: 0.001, max: 0.02}
    prescribe: {top: {uy: {table: [[0, 0], [1, -3]]}}}
    tractions: [{on: top, tx: 4}]
output: {every: 0.5}
";

fn case(text: &str, overrides: &[&str]) -> Case {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let source = Source::parse(PathBuf::from("case.yaml"), text.to_owned(), &overrides).unwrap();
    match resolve(&source) {
        (Some(case), issues) if issues.is_empty() => case,
        (_, issues) => panic!("{issues:?}"),
    }
}

#[test]
fn entries_arrive_where_they_are_meant() {
    let case = case(CASE, &[]);
    assert_eq!(case.geometry, Geometry::Axisymmetric);
    assert_eq!(case.mesh.order, Some(Order::SecondIncomplete));
    assert_eq!(case.mesh.parameters["h"], 0.5);
    assert_eq!(case.gravity, [0.0, -10.0]);
    assert!(case.k0.unwrap().iter().all(|k0| k0.at(0.0) == 0.5));
    assert_eq!(case.numerics.solver.restore, Restore::Never);
    assert_eq!((case.numerics.solver.spectral_radius, case.numerics.solver.tolerance), (1.0, 1e-8));
    let Content::Mpm { material, points_per_cell: 9 } = case.regions[0].content else { panic!("{:?}", case.regions) };
    assert_eq!(case.materials[material].name, "clay");
    assert_eq!(case.supports.iter().map(|s| s.fixed).collect::<Vec<_>>(), [[true, true], [true, false]]);
    let [a, b] = case.phases.as_slice() else { panic!("{:?}", case.phases) };
    let whole = [0.0, -10.0];
    assert_eq!(a.gravity, Gravity::Scaled { whole, factor: TimeValue::Rate(0.5) });
    assert_eq!(b.gravity, Gravity::Scaled { whole, factor: TimeValue::Constant(1.0) });
    assert_eq!((a.step.min, a.step.initial, a.step.max), (1e-5, 0.1, 0.1));
    assert_eq!((b.step.min, b.step.initial, b.step.max), (0.001, 0.01, 0.02));
    assert_eq!((b.prescribed[0].component, b.prescribed[0].displacement.at(0.5)), (1, -1.5));
    let tops = [0, 1].map(|d| b.tractions[0].components[d].top.clone());
    assert_eq!(tops, [TimeValue::Constant(4.0), TimeValue::Constant(0.0)]);
}

#[test]
fn a_unit_weight_is_divided_by_gravity() {
    let case = case(CASE, &[]);
    let density = case.materials[0].density;
    // 10 kN/m³ at y = 1 and 1 more a metre below, at 10 m/s².
    assert_eq!([2.0, 1.0, -1.0].map(|y| density.at(y)), [1.0, 1.0, 1.2]);
}

/// A crust: what falls with depth falls no further than to its least value.
#[test]
fn a_parameter_may_fall_with_depth() {
    let case = case(CASE, &["materials.clay.young={top: 100, gradient: -10, datum: 2, least: 65}"]);
    let young = |y: f64| case.materials[0].model.young(y);
    assert_eq!([3.0, 2.0, 0.0, -1.5, -2.0, -9.0].map(young), [100.0, 100.0, 80.0, 65.0, 65.0, 65.0]);
}

#[test]
fn overrides_set_entries_by_keys_numbers_and_names() {
    let overrides =
        ["phases[0].duration=7", "phases.b.step={initial: 0.5}", "numerics.max_iterations=9", "materials.clay.young=3"];
    let case = case(CASE, &overrides);
    assert_eq!((case.phases[0].duration, case.phases[1].step.initial), (7.0, 0.5));
    assert_eq!(case.numerics.solver.max_iterations, 9);
    assert_eq!(case.materials[0].model.young(-4.0), 3.0);
}

/// `--set phases.b.step.max=…` below the first step lowers that too, unless the command line gives it.
#[test]
fn a_largest_step_of_the_command_line_lowers_the_first() {
    let read = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        Source::parse(PathBuf::from("case.yaml"), CASE.to_owned(), &overrides).unwrap()
    };
    for (overrides, lowered) in [
        (&["phases.b.step.max=0.004"][..], Some([0.004, 0.001, 0.004])),
        (&["phases[1].step.max=0.5", "phases.b.step.max=0.004"], Some([0.004, 0.001, 0.004])),
        (&["phases.a.step.max=0.01"], None),
        (&["phases.b.step.max=0.02"], None),
    ] {
        let (source, step) = (read(overrides), case(CASE, overrides).phases[1].step);
        assert_eq!([step.initial, step.min, step.max], lowered.unwrap_or([0.01, 0.001, 0.02]), "{overrides:?}");
        let of_b: Vec<_> = source.notes().iter().filter(|note| note.contains("phases[1].step.initial")).collect();
        assert_eq!(of_b.len(), usize::from(lowered.is_some()), "{:?}", source.notes());
    }
    assert!(read(&["phases.a.step.max=0.01"]).notes()[0].contains("from 0.1 s to 0.01 s"));
    // By number and by name, of several phases at once: each has its own.
    let both = ["phases[0].step.max=0.01", "phases.b.step.max=0.004"];
    let steps = case(CASE, &both).phases.iter().map(|phase| [phase.step.initial, phase.step.max]).collect::<Vec<_>>();
    assert_eq!(steps, [[0.01; 2], [0.004; 2]]);
    assert_eq!(read(&both).notes().len(), 2);
    // A whole `step` on the command line says what it means itself.
    let steps: Vec<_> =
        case(CASE, &["phases.a.step={initial: 0.2, max: 0.5}"]).phases.iter().map(|p| p.step.initial).collect();
    assert_eq!(steps, [0.2, 0.01]);
    for overrides in [
        &["phases.b.step.max=0.004", "phases.b.step.initial=0.01"][..],
        &["phases.b.step={initial: 0.01, max: 0.004}"],
        &["phases.b.step.initial=0.04"],
        &["phases.b.step.max=-1"],
    ] {
        let source = read(overrides);
        assert!(!resolve(&source).1.is_empty() && source.notes().is_empty(), "{overrides:?}");
    }
}

#[test]
fn a_later_override_wins() {
    assert_eq!(case(CASE, &["title=a", "title=b"]).title, "b");
}

#[test]
fn a_velocity_field_turns_about_its_centre_and_has_its_wave() {
    let velocity = &case(CASE, &[]).initial_velocity[0];
    assert_eq!(velocity.at(&[1.0, 1.0]), [1.0, 0.0]);
    assert_eq!(velocity.at(&[2.0, 1.0]), [1.0, 2.0]);
    assert_eq!(velocity.at(&[1.0, 2.0]), [-1.0, 0.0]);
    let wave = "initial_velocity.block={standing_wave: {component: y, along: x, amplitude: 3, wave_number: 0.5}}";
    let wave: InitialVelocity = case(CASE, &[wave]).initial_velocity.swap_remove(0);
    assert_eq!(wave.at(&[2.0, 9.0]), [0.0, 3.0 * 1f64.sin()]);
}

#[test]
fn points_start_with_their_mass_velocity_and_stress_at_rest() {
    let case = case(CASE, &["geometry=plane_strain"]);
    let mut mesh = builder::rectangle(CellKind::T6, 1.0, 1.0, 2, 2, 0.0, 0);
    mesh.regions = vec!["block".to_owned()];
    let points = seeding::points(&case, &mesh).unwrap();
    assert_eq!(points.len(), 8 * 9);
    // ∫ (1 + 0.1 (1 − y)) dy over the unit square.
    let mass: f64 = points.mass.iter().sum();
    assert!((mass - 1.05).abs() < 1e-12, "{mass}");
    for p in 0..points.len() {
        let y = points.position[p][1];
        let vertical = -(10.0 * (1.0 - y) + 0.5 * (1.0 - y).powi(2));
        let [xx, yy, zz, ..] = points.stress[p];
        assert!((yy - vertical).abs() < 1e-11, "{yy} {vertical}");
        assert!((xx - 0.5 * vertical).abs() < 1e-11 && xx == zz);
        assert_eq!(points.velocity[p], case.initial_velocity[0].at(&points.position[p]));
        // The elastic strain carries the stress: Hencky's law back again, ε = ½ ln b.
        let strain = [0, 1, 2].map(|i| 0.5 * points.elastic[p][i].ln());
        let young = case.materials[0].model.young(y);
        let back = (strain[1] * young - (yy - 0.49 * (xx + zz))).abs();
        assert!(back < 1e-10, "{back}");
    }
}

/// The bulk modulus over G that the pressure field of clay carries, and the share of the water, under overrides.
fn carried(overrides: &[&str]) -> Option<(f64, f64)> {
    case(CASE, overrides).materials[0].carried.as_ref().map(|c| (c.ratio, c.water))
}

#[test]
fn nearly_incompressible_and_undrained_materials_leave_their_mean_stress_to_a_field() {
    let bulk = |poisson: f64| 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
    assert_eq!(case(CASE, &[]).materials[1].carried.as_ref().map(|c| c.ratio), None, "rock");
    let (ratio, water) = carried(&[]).unwrap();
    // The points keep a thousandth of G.
    let left = |poisson: f64| bulk(poisson) - 0.001;
    assert!((ratio / left(0.49) - 1.0).abs() < 1e-12 && water == 0.0);
    assert_eq!(carried(&["numerics.pressure=none"]), None);
    assert_eq!(carried(&["materials.clay.poisson=0.4"]), None);
    let (ratio, _) = carried(&["materials.clay.poisson=0.4", "numerics.pressure=field"]).unwrap();
    assert!((ratio / left(0.4) - 1.0).abs() < 1e-12);
    // Water as stiff as PLAXIS has it: K_w/n = 3 (ν_u − ν')/((1 − 2 ν_u)(1 + ν')) K'.
    let (ratio, water) = carried(&["materials.clay.poisson=0.3", "materials.clay.drainage=undrained"]).unwrap();
    let stiffness = 3.0 * 0.195 / (0.01 * 1.3) * bulk(0.3);
    assert!((water * ratio / stiffness - 1.0).abs() < 1e-12 && (ratio / left(0.495) - 1.0).abs() < 1e-12);
}

/// A permeability gives the water a field of its own, with the stiffness that it had; only a skeleton that yields or is
/// nearly incompressible has the other field beside it.
#[test]
fn water_that_can_flow_has_a_field_of_its_own() {
    let porous = |overrides: &[&str]| case(CASE, overrides).materials[0].porous.clone();
    let base = ["materials.clay.poisson=0.3", "materials.clay.drainage=undrained"];
    assert!(porous(&base).is_none());
    let with = |more: &str| -> Vec<String> { base.iter().map(|s| s.to_string()).chain([more.to_owned()]).collect() };
    let strings = with("materials.clay.permeability={x: 2e-8, y: 1e-8}");
    let overrides: Vec<&str> = strings.iter().map(String::as_str).collect();
    let soil = porous(&overrides).unwrap();
    assert!(
        (soil.mobility[0] * 9.81 / 2e-8 - 1.0).abs() < 1e-12 && (soil.mobility[1] * 9.81 / 1e-8 - 1.0).abs() < 1e-12
    );
    let shear = soil.model.elasticity().at(0.0).shear;
    let bulk = |poisson: f64| 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
    assert!((soil.storage(0.0) * shear * (bulk(0.495) - bulk(0.3)) - 1.0).abs() < 1e-12);
    let (ratio, water) = carried(&overrides).unwrap();
    assert!((ratio / (bulk(0.3) - 0.001) - 1.0).abs() < 1e-12 && water == 0.0, "clay yields");
}

/// The shear modulus stays, whatever is taken from the bulk modulus.
#[test]
fn the_field_leaves_the_shear_modulus() {
    let case = case(CASE, &[]);
    let (whole, left) = (&case.materials[0].model, &case.materials[0].carried.as_ref().unwrap().model);
    for y in [0.0, 5.0] {
        let (whole, left) = (whole.elasticity().at(y), left.elasticity().at(y));
        assert!(
            (left.shear / whole.shear - 1.0).abs() < 1e-12 && (left.bulk() / (0.001 * whole.shear) - 1.0).abs() < 1e-9
        );
    }
}

#[test]
fn contradictions_about_drainage_are_told() {
    for (overrides, place) in [
        (&["materials.clay.undrained_poisson=0.495"][..], "undrained_poisson"),
        (&["materials.clay.drainage=undrained", "materials.clay.undrained_poisson=0.3"], "undrained_poisson"),
        (&["materials.clay.drainage=undrained", "numerics.pressure=none"], "drainage"),
        (&["output.fields=[pore_pressure]"], "fields"),
        (&["output.fields=[internal_variables]"], "fields"),
        (&["materials.clay.permeability=1e-8"], "permeability"),
        (
            &["materials.clay.drainage=undrained", "materials.clay.poisson=0.3", "materials.clay.permeability=-1"],
            "permeability",
        ),
        (
            &["materials.clay.drainage=undrained", "materials.clay.poisson=0.3", "materials.clay.porosity=0.4"],
            "porosity",
        ),
        (
            &["materials.clay.drainage=undrained", "materials.clay.poisson=0.3", "materials.clay.water_unit_weight=10"],
            "water_unit_weight",
        ),
        (&["initial_pore_pressure.block=3"], "initial_pore_pressure"),
        (&["drained_surface=all", "numerics.restore=every_step", "phases[1].tractions=[]"], "drained_surface"),
        (
            &[
                "materials.clay.drainage=undrained",
                "materials.clay.poisson=0.3",
                "materials.clay.permeability=1e-8",
                "numerics.restore=every_step",
                "phases[1].tractions=[]",
                "drained_surface=nothing",
            ],
            "nothing",
        ),
        (
            &[
                "materials.clay.drainage=undrained",
                "materials.clay.poisson=0.3",
                "materials.clay.permeability=1e-8",
                "drained_surface=all",
            ],
            "never restored",
        ),
    ] {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let source = Source::parse(PathBuf::from("case.yaml"), CASE.to_owned(), &overrides).unwrap();
        let issues = resolve(&source).1;
        assert_eq!(issues.len(), 1, "{overrides:?}: {issues:?}");
        assert!(format!("{:?}", issues[0]).contains(place), "{issues:?}");
    }
}

/// Water whose stiffness follows from the skeleton's is soft where that is taken at another pressure than the soil bears.
#[test]
fn a_reference_pressure_of_its_own_does_not_tell_the_stiffness_of_the_water() {
    let clay = |more: &str| {
        format!(
            "materials.clay={{model: cam_clay, swelling: 0.02, compression: 0.1, poisson: 0.3, critical_slope: 1, \
             preconsolidation: 100, density: 1.8, drainage: undrained{more}}}"
        )
    };
    let issues = |more: &str| {
        let source = Source::parse(PathBuf::from("case.yaml"), CASE.to_owned(), &[clay(more)]).unwrap();
        resolve(&source).1.iter().map(|issue| source.error(issue).to_string()).collect::<Vec<_>>()
    };
    for more in ["", ", permeability: 1.0e-8", ", reference_pressure: 5, porosity: 0.5, water_bulk_modulus: 2.0e+6"] {
        assert!(issues(more).is_empty(), "{more}: {:?}", issues(more));
    }
    for more in [", reference_pressure: 5", ", reference_pressure: 5, permeability: 1.0e-8"] {
        let [issue] = issues(more).try_into().unwrap();
        assert!(
            ["reference_pressure", "stiffness of the water", "porosity"].iter().all(|s| issue.contains(s)),
            "{issue}"
        );
    }
}

/// What is wrong with a material is told at once, of entries that its first example has none of, too; each fault once, up to entries that exclude
/// or outdo each other.
#[test]
fn faults_of_swelling_clay_are_told_together() {
    for (more, places) in [
        ("swelling: 0.02, compression: 0.01, critical_slope: -1", vec!["compression", "critical_slope"]),
        ("swelling: 0, compression: 0.015, critical_slope: 1", vec!["swelling"]),
        ("swelling: 0.02, compression: 0.1, young: 1000, critical_slope: 0", vec!["swelling"]),
        (
            "swelling: 0.02, compression: 0.1, least_pressure: 0, reference_pressure: -1, critical_slope: 0",
            vec!["least_pressure", "reference_pressure", "critical_slope"],
        ),
    ] {
        let clay =
            format!("materials.clay={{model: cam_clay, {more}, poisson: 0.3, preconsolidation: 100, density: 1.8}}");
        let source = Source::parse(PathBuf::from("case.yaml"), CASE.to_owned(), &[clay]).unwrap();
        let issues: Vec<String> = resolve(&source).1.iter().map(|issue| format!("{issue:?}")).collect();
        assert_eq!(issues.len(), places.len(), "{more}: {issues:?}");
        assert!(places.iter().all(|place| issues.iter().any(|issue| issue.contains(place))), "{more}: {issues:?}");
    }
}

/// What a constant shear modulus makes of Poisson's ratio where the pressure is far from its reference is told with the points.
#[test]
fn poissons_ratios_that_no_soil_has_are_noted() {
    let mesh = builder::rectangle(CellKind::Q9, 1.0, 10.0, 1, 5, 0.0, 0);
    let notes_at = |stress: &str, more: &str| {
        let clay = format!(
            "materials.clay={{model: cam_clay, swelling: 0.02, compression: 0.1, poisson: 0.3, critical_slope: 1, \
             preconsolidation: 300, density: 1.8{more}}}"
        );
        let case = case(CASE, &[&clay, "initial_velocity={}", stress]);
        let mut mesh = mesh.clone();
        mesh.regions = vec!["block".into()];
        let points = seeding::points(&case, &mesh).unwrap();
        seeding::notes(&case, &mesh, &points).unwrap()
    };
    let notes = |more: &str| notes_at("initial_stress.k0=1", more);
    // ν is negative below 0.31 p_ref: down to 5 m and more.
    let [note] = notes("").try_into().unwrap();
    assert!(["block", "of its 45 points", "reference_pressure"].iter().all(|s| note.contains(s)), "{note}");
    assert_eq!(notes(", reference_pressure: {top: 1, gradient: 18, datum: 10}"), Vec::<String>::new());
    // Without stress all have the bulk modulus of the least pressure.
    let [note] = notes_at("initial_stress=null", "").try_into().unwrap();
    assert!(note.contains("45 of its 45 points") && note.contains("begin with is -0.9"), "{note}");
}

/// What a new entry shapes is declared where it is, so that results do not stay when it changes.
#[test]
fn every_entry_says_what_it_shapes() {
    let schema = schema();
    let entries: Vec<&str> = schema["properties"].as_object().unwrap().keys().map(String::as_str).collect();
    let mut declared: Vec<&str> = SHAPES.iter().map(|(key, _)| *key).collect();
    declared.sort_unstable();
    assert_eq!(declared, entries);
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(
        at in 0..CASE.len(), cut in 0..40_usize, piece in "[ \\-\\[\\]{}:,&*!|>'\"%#~a-z0-9.\n]{0,6}"
    ) {
        let mut text = CASE.to_owned();
        text.replace_range(at..(at + cut).min(CASE.len()), &piece);
        if let Ok(source) = Source::parse(PathBuf::from("case.yaml"), text, &[]) {
            for issue in resolve(&source).1 {
                let error = source.error(&issue);
                prop_assert!(!error.problem.is_empty() && !error.remedy.is_empty(), "{error:?}");
            }
        }
    }

    #[test]
    fn no_override_makes_the_reader_panic(argument in "[a-z.\\[\\]0-9=]{0,24}=[ \\-\\[\\]{}:,a-z0-9.]{0,8}") {
        if let Ok(source) = Source::parse(PathBuf::from("case.yaml"), CASE.to_owned(), &[argument]) {
            resolve(&source).1.iter().for_each(|issue| { source.error(issue); });
        }
    }
}

/// A pressure may be a profile as well as in time, which has forms of its own.
#[test]
fn a_pressure_on_a_surface_takes_all_its_forms() {
    let top = |pressure: &str| {
        let load = format!("phases[1].tractions=[{{surface: all, pressure: {pressure}}}]");
        let case = case(CASE, &["numerics.restore=every_step", &load]);
        let pressure = case.phases[1].surface_loads[0].pressure.clone().unwrap();
        (pressure.top, pressure.gradient)
    };
    let none = TimeValue::Constant(0.0);
    assert_eq!(top("3"), (TimeValue::Constant(3.0), none.clone()));
    assert_eq!(top("{rate: 3}"), (TimeValue::Rate(3.0), none.clone()));
    assert_eq!(top("{table: [[0, 1], [1, 2]]}"), (TimeValue::Table(vec![[0.0, 1.0], [1.0, 2.0]]), none));
    assert_eq!(top("{top: 1, gradient: 2}"), (TimeValue::Constant(1.0), TimeValue::Constant(2.0)));
}
