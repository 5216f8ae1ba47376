//! Warnings of values that no soil has: mostly those of another unit or of another sign. The case runs, and its numbers are wrong.
//!
//! Each bound lies beyond all that soil, rock and metal have; 0 stands for what is left out on purpose, such as weight.

use super::checked::Case;
use super::layout::Bounds;
use super::raw::{self, CaseFile, RegionKind};
use super::unconnected::Place;
use crate::run::WARNING;
use std::ops::RangeInclusive;

/// Densities (t/m³) from that of foam to above that of all metals.
const DENSITY: RangeInclusive<f64> = 0.1..=25.0;
/// Density (t/m³) above those of all minerals that soil is made of.
const OF_SOIL: f64 = 12.0;
/// The same as [`DENSITY`] for unit weights (kN/m³) on Earth.
const UNIT_WEIGHT: RangeInclusive<f64> = 1.0..=250.0;
/// Young's modulus (kPa) near that of diamond.
const STIFFEST: f64 = 1e9;
/// Angles of friction (degrees) that are rather in radians; less is none on purpose.
const RADIANS: RangeInclusive<f64> = 0.1..=3.0;
/// Coefficient of friction (-) of a contact that is rather an angle: tan 45°.
const STEEP: f64 = 1.0;
/// Permeability (m/s) above that of coarse gravel.
const PERMEABLE: f64 = 10.0;
/// Length (m) above that of all models.
const LONGEST: f64 = 5e3;
/// Horizontal acceleration over gravity (-) below which it is rather a coefficient.
const WEAKEST: f64 = 0.03;

/// A warning of each value in a case.
pub(super) fn values(file: &CaseFile) -> Vec<String> {
    let mut found = Vec::new();
    let soils = file.regions.values().filter(|region| region.kind == RegionKind::Mpm);
    let soils: Vec<&str> = soils.filter_map(|region| region.material.as_deref()).collect();
    for (name, material) in &file.materials {
        let is_soil = soils.contains(&name.as_str());
        of_material(name, material, file, is_soil, &mut found);
    }
    for (i, contact) in file.contacts.iter().enumerate() {
        found.extend(friction_of_contact(&format!("contacts[{i}].friction"), contact.friction));
    }
    for (i, phase) in file.phases.iter().enumerate() {
        for (name, change) in &phase.contacts {
            let entry = format!("phases[{i}].contacts.{name}.friction");
            found.extend(change.friction.and_then(|friction| friction_of_contact(&entry, friction)));
        }
    }
    if file.gravity.y > 0.0 {
        let y = file.gravity.y;
        found.push(warning("gravity.y", &format!("{y} m/s², which is upwards: y is up"), &format!("write `y: -{y}`")));
    }
    let g = file.gravity.x.hypot(file.gravity.y);
    for (i, phase) in file.phases.iter().enumerate() {
        let Some(raw::PhaseGravity::Components(raw::Acceleration { x: Some(x), .. })) = &phase.gravity else {
            continue;
        };
        let largest = largest(x, phase.duration);
        if 0.0 < largest && largest < WEAKEST * g {
            let problem = format!("at most {largest:.3} m/s², {:.4} of gravity", largest / g);
            let remedy =
                format!("components are accelerations: for a coefficient of {largest:.3} it is {:.3}", largest * g);
            found.push(warning(&format!("phases[{i}].gravity.x"), &problem, &remedy));
        }
    }
    found
}

/// The largest size of a value in a phase of the given duration (s).
fn largest(value: &raw::InTime, duration: f64) -> f64 {
    match value {
        raw::InTime::Constant(value) => value.abs(),
        raw::InTime::Rate(rate) => (rate.rate * duration).abs(),
        raw::InTime::Table(table) => table.table.iter().map(|[_, value]| value.abs()).fold(0.0, f64::max),
    }
}

fn of_material(name: &str, material: &raw::Material, file: &CaseFile, is_soil: bool, found: &mut Vec<String>) {
    let mut warn = |key: &str, problem: &str, remedy: &str| {
        found.push(warning(&format!("materials.{name}.{key}"), problem, remedy));
    };
    let given = |value: &Option<raw::InDepth>| value.map(|value| value.profile().top).filter(|top| *top > 0.0);
    const NO_MATERIAL: &str = "which no soil and no structure has";
    let g = file.gravity.x.hypot(file.gravity.y);
    if let Some(density) = given(&material.density) {
        let remedy = "densities are in t/m³, and all units follow from kN, m, s and t: 1 t/m³ is 1000 kg/m³";
        if !DENSITY.contains(&density) {
            warn("density", &format!("{density} t/m³, {NO_MATERIAL}"), remedy);
        } else if density > OF_SOIL && is_soil {
            let remedy = "write `unit_weight` in place of `density` if it is in kN/m³";
            warn("density", &format!("{density} t/m³, which no soil has"), remedy);
        }
    }
    // Where gravity is that of a centrifuge the weights are, too.
    let strange = |weight: &f64| !UNIT_WEIGHT.contains(weight) && !DENSITY.contains(&(weight / g));
    if let Some(weight) = given(&material.unit_weight).filter(strange) {
        let remedy = "unit weights are in kN/m³: 1 kN/m³ is 1000 N/m³, and some 102 kg/m³ by gravity";
        warn("unit_weight", &format!("{weight} kN/m³, {NO_MATERIAL}"), remedy);
    }
    let parameter = |key: &str| material.parameters.get(key).map(|value| value.profile().top);
    if let Some(young) = parameter("young").filter(|young| is_soil && *young > STIFFEST) {
        warn("young", &format!("{young:e} kPa, stiffer than diamond"), "stiffnesses are in kPa: 1 kPa is 1000 Pa");
    }
    if let Some(friction) = parameter("friction").filter(|friction| RADIANS.contains(friction)) {
        let degrees = friction.to_degrees();
        let remedy = format!("angles are in degrees: {friction} rad is {degrees:.1}°");
        warn("friction", &format!("{friction}°, less than any soil has"), &remedy);
    }
    if let Some(k) = material.permeability.map(raw::Permeability::by_axis).filter(|k| k.iter().any(|k| *k > PERMEABLE))
    {
        let k = k[0].max(k[1]);
        let remedy = "permeabilities are in m/s: 1 m/day is 1.16e-5 m/s";
        warn("permeability", &format!("{k} m/s, more than gravel has"), remedy);
    }
}

fn friction_of_contact(entry: &str, friction: f64) -> Option<String> {
    let problem = format!("{friction}, steeper than any wall: it is the coefficient tan δ, not an angle");
    let remedy = match friction < 90.0 {
        true => format!("write {:.3} for an angle of {friction}°", friction.to_radians().tan()),
        false => "write the tangent of the angle".to_owned(),
    };
    (friction > STEEP).then(|| warning(entry, &problem, &remedy))
}

fn warning(entry: &str, problem: &str, remedy: &str) -> String {
    format!("{WARNING}`{entry}` is {problem}; {remedy}")
}

/// A warning of a model that is too large, given where its regions lie.
pub(super) fn extents(case: &Case, places: &[Place]) -> Option<String> {
    let join = |a: Bounds, b: Bounds| [[0, 1].map(|d| a[0][d].min(b[0][d])), [0, 1].map(|d| a[1][d].max(b[1][d]))];
    let [low, high] = places.iter().map(|place| place.bounds).reduce(join)?;
    let [width, height] = [0, 1].map(|d| (high[d] - low[d]).round());
    (width.max(height) > LONGEST).then(|| {
        format!(
            "{WARNING}the model of {} is {width} m wide and {height} m high: lengths are in m, and those of a STEP file mostly in mm; put \
             `Geometry.OCCTargetUnit = \"M\";` before its `Merge` in the .geo, or scale what is drawn in mm by 0.001",
            case.mesh.source.path().display()
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::case::unmeant::of_case;
    use crate::case::{resolve, source::Source, unconnected::Place};
    use std::path::PathBuf;

    const CASE: &str = "geometry: plane_strain\nmesh: {geo: Cargo.toml}\n\
        regions: {soil: {kind: mpm, material: sand}, pier: {kind: structure, material: heavy}}\n\
        materials:\n  sand: {model: mohr_coulomb, young: 3.0e+4, poisson: 0.3, cohesion: 5, friction: 30, density: 1.9, \
        drainage: undrained, permeability: 1.0e-6}\n  heavy: {model: linear_elastic, young: 1.0e+12, poisson: 0, density: 20}\n\
        contacts: [{wall: floor, soil: soil, friction: 0.36, name: floor}]\ngravity: {y: -9.81}\n\
        phases: [{name: rest, analysis: quasi_static, duration: 1, step: {initial: 1}, contacts: {floor: {friction: 0.9}}}]\n";

    /// The warnings of that case with other entries, in a model of a width (m).
    fn told(replaced: &[[&str; 2]], width: f64) -> Vec<String> {
        let mut text = CASE.to_owned();
        for [entry, other] in replaced {
            assert_eq!(text.matches(entry).count(), 1, "{entry}");
            text = text.replace(entry, other);
        }
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let place = Place { name: "soil".into(), bounds: [[0.0, 0.0], [width, 2.0]], parts: Vec::new() };
        of_case(&case.unwrap(), &[place])
    }

    #[test]
    fn values_in_other_units_are_told_with_the_unit() {
        assert_eq!(told(&[], 4.0), [""; 0]);
        for (entry, other, said) in [
            (
                "density: 1.9",
                "density: 1900",
                "`materials.sand.density` is 1900 t/m³, which no soil and no structure has; densities",
            ),
            ("density: 1.9", "density: 0.05", "is 0.05 t/m³"),
            ("density: 1.9", "density: 18", "is 18 t/m³, which no soil has; write `unit_weight`"),
            (
                "friction: 30",
                "friction: 0.52",
                "is 0.52°, less than any soil has; angles are in degrees: 0.52 rad is 29.8°",
            ),
            ("young: 3.0e+4", "young: 3.0e+10", "is 3e10 kPa"),
            ("permeability: 1.0e-6", "permeability: {x: 20, y: 0}", "is 20 m/s, more than gravel has"),
            (
                "friction: 0.36",
                "friction: 20",
                "`contacts[0].friction` is 20, steeper than any wall: it is the coefficient tan δ, not an angle; write 0.364",
            ),
            ("friction: 0.9", "friction: 20", "`phases[0].contacts.floor.friction` is 20"),
            ("y: -9.81", "y: 9.81", "`gravity.y` is 9.81 m/s², which is upwards: y is up; write `y: -9.81`"),
            (
                "step: {initial: 1}",
                "step: {initial: 1}, gravity: {x: {rate: 0.1}}",
                "`phases[0].gravity.x` is at most 0.100 m/s², 0.0102 of gravity; components are accelerations: for a coefficient of 0.100 it is",
            ),
        ] {
            let [warning] = told(&[[entry, other]], 4.0).try_into().unwrap();
            assert!(warning.starts_with("warning: ") && warning.contains(said), "{warning}");
        }
        // What is meant.
        for [entry, other] in [
            ["density: 1.9", "density: 0"],
            ["friction: 30", "friction: 0"],
            ["friction: 30", "friction: 0.057"],
            ["friction: 0.36", "friction: 1"],
            ["friction: 0.36", "friction: 0"],
            ["step: {initial: 1}", "step: {initial: 1}, gravity: {x: 0, y: -9.81}"],
            ["step: {initial: 1}", "step: {initial: 1}, gravity: {x: {table: [[0, 0], [1, -0.981]]}}"],
        ] {
            assert_eq!(told(&[[entry, other]], 4.0), [""; 0], "{other}");
        }
    }

    #[test]
    fn unit_weights_in_other_units_are_told_and_those_of_a_centrifuge_are_not() {
        let weight = |weight: &str, gravity: &str| {
            told(&[["density: 1.9", &format!("unit_weight: {weight}")], ["y: -9.81", &format!("y: {gravity}")]], 4.0)
        };
        assert_eq!(weight("18", "-9.81").len() + weight("0", "-9.81").len() + weight("900", "-490.5").len(), 0);
        for strange in ["18000", "0.5"] {
            let [warning] = weight(strange, "-9.81").try_into().unwrap();
            assert!(warning.contains(&format!("`materials.sand.unit_weight` is {strange} kN/m³")), "{warning}");
        }
    }

    #[test]
    fn a_model_in_millimetres_is_told_with_its_extents() {
        assert!(told(&[], 5000.0).is_empty());
        let [warning] = told(&[], 20_000.0).try_into().unwrap();
        assert!(
            warning.contains("20000 m wide and 2 m high") && warning.contains("OCCTargetUnit = \"M\""),
            "{warning}"
        );
    }
}
