//! Soil that yields under its own weight, and whose stress is then not unique.

use crate::case::checked::{Analysis, Case, Content, Material};
use crate::case::unconnected::Place;
use crate::material::{State, spectral};
use crate::mesh::quality::SAME;

/// Bisections for the least horizontal stress: to a millionth of the vertical one.
const BISECTIONS: usize = 20;
/// Ratios (-) that differ by less than this part are the same.
const ROUNDING: f64 = 1e-3;

/// A warning for each region of soil whose dilation is less than its friction and whose lower half yields under its own weight, in ground from side
/// to side of the model, as gravity comes to act without `initial_stress`.
pub fn of_case(case: &Case, places: &[Place]) -> Vec<String> {
    let Some(phase) = case.phases.iter().find(|phase| phase.gravity.at(phase.duration)[1] < 0.0) else {
        return Vec::new();
    };
    if case.k0.is_some() || phase.analysis == Analysis::Dynamic || case.gravity[1] >= 0.0 {
        return Vec::new();
    }
    let soils = places.iter().filter_map(|place| Some((place, soil(case, &place.name)?)));
    // Soil that ends beside air is no level ground: nothing holds it there, and it stands or fails by its strength.
    let [soil_ends, model_ends] = [ends(soils.clone().map(|(place, _)| place)), ends(places.iter())];
    if (0..2).any(|end| (soil_ends[end] - model_ends[end]).abs() > SAME * (model_ends[1] - model_ends[0])) {
        return Vec::new();
    }
    let surface = soils.clone().map(|(place, _)| place.bounds[1][1]).fold(f64::NEG_INFINITY, f64::max);
    let told = |(place, material): (&Place, &Material)| {
        let model = material.model.as_ref();
        if !model.has_friction() || model.symmetric() || material.has_pore_pressure() {
            return None;
        }
        let poisson = model.elasticity().poisson();
        let elastic = poisson / (1.0 - poisson);
        let y = f64::midpoint(place.bounds[0][1], place.bounds[1][1]);
        let least = least_ratio(material, y, case.gravity[1] * material.density.at(y) * (surface - y))?;
        let needed = (100.0 * least / (1.0 + least) - ROUNDING).ceil() / 100.0;
        (elastic < (1.0 - ROUNDING) * least).then(|| {
            format!(
                "warning: phase `{}`: `{}` yields under its own weight: Poisson's ratio {poisson} gives a horizontal stress of {elastic:.2} times the \
                 vertical one, and `{}` needs {least:.2} times or more at half its depth; as its dilation is less than its friction, its stress is then not unique, and \
                 may be that of shear bands; take a ratio of {needed:.2} or more, or `initial_stress` with a `k0`",
                phase.name, place.name, material.name,
            )
        })
    };
    soils.filter_map(told).collect()
}

/// The least horizontal stress that a material bears at height `y` (m) beside the vertical stress (kPa, tension positive), over that; `None` where it
/// bears any, or none up to that.
fn least_ratio(material: &Material, y: f64, vertical: f64) -> Option<f64> {
    let is_borne = |k: f64| {
        let stress = [k * vertical, vertical, k * vertical, 0.0, 0.0, 0.0];
        material.model.yield_excess(y, &spectral::roots(&stress), &State::default()) <= 0.0
    };
    let (mut low, mut high) = (0.0, 1.0);
    if is_borne(low) || !is_borne(high) {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(low, high);
        *(if is_borne(middle) { &mut high } else { &mut low }) = middle;
    }
    Some(high)
}

/// Where places end (m) to the left and to the right.
fn ends<'a>(places: impl Iterator<Item = &'a Place>) -> [f64; 2] {
    let join = |[low, high]: [f64; 2], place: &Place| [low.min(place.bounds[0][0]), high.max(place.bounds[1][0])];
    places.fold([f64::INFINITY, f64::NEG_INFINITY], join)
}

/// The material of a region of soil.
fn soil<'a>(case: &'a Case, region: &str) -> Option<&'a Material> {
    let content = case.content(region)?;
    let is_soil = matches!(content, Content::Mpm { .. } | Content::Fem { .. });
    content.material().filter(|_| is_soil && !case.comes_later(region)).map(|material| &case.materials[material])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use std::path::PathBuf;

    /// The warnings of ground 20 m wide in a model of a width (m).
    fn in_model(width: f64, sand: &str, entries: &str) -> Vec<String> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\nregions: {{soil: {{kind: mpm, material: sand}}, air: {{kind: buffer}}}}\n\
             materials: {{sand: {{model: mohr_coulomb, young: 3.0e+4, unit_weight: 20, {sand}}}}}\ngravity: {{y: -9.81}}\n{entries}\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let place = |name: &str, bounds| Place { name: name.into(), bounds, parts: Vec::new() };
        let places = [place("soil", [[0.0, -10.0], [20.0, 0.0]]), place("air", [[0.0, 0.0], [width, 5.0]])];
        of_case(&case.unwrap(), &places)
    }

    fn told(sand: &str, entries: &str) -> Vec<String> {
        in_model(20.0, sand, entries)
    }

    #[test]
    fn soil_that_yields_under_its_own_weight_is_told_with_the_ratio_that_helps() {
        let rises =
            "phases: [{name: weight, analysis: quasi_static, duration: 1, step: {initial: 0.25}, gravity: {rate: 1}}]";
        // K_a of 30° is 1/3, and ν/(1 − ν) is that at 0.25; with c = 40 kPa it is 1/3 − 2 · 40 · tan 30° / 100 kPa at half the depth.
        let [warning] = told("poisson: 0.13, friction: 30, cohesion: 0, dilation: 7.5", rises).try_into().unwrap();
        let said = "ratio 0.13 gives a horizontal stress of 0.15 times the vertical one, and `sand` needs 0.33 times or more at half its depth";
        assert!(warning.contains(said) && warning.contains("a ratio of 0.25 or more"), "{warning}");
        for sand in [
            "poisson: 0.3, friction: 30, cohesion: 0",
            "poisson: 0.13, friction: 30, cohesion: 0, dilation: 30",
            "poisson: 0.13, friction: 30, cohesion: 40",
        ] {
            assert_eq!(told(sand, rises), [""; 0], "{sand}");
        }
        assert_eq!(told("poisson: 0.25, friction: 30, cohesion: 0", rises), [""; 0], "at the limit");
        let sand = "poisson: 0.24, friction: 30, cohesion: 0";
        // However it comes on: in steps, at once, from a part of it, after a phase without.
        let after = rises.replace(
            "phases: [",
            "phases: [{name: rest, analysis: quasi_static, duration: 1, step: {initial: 1}, gravity: 0}, ",
        );
        let table = rises.replace("rate: 1", "table: [[0, 0.2], [1, 1]]");
        for phases in [rises, &rises.replace(", gravity: {rate: 1}", ""), &table, &after] {
            let [warning] = told(sand, phases).try_into().unwrap();
            assert!(warning.contains("phase `weight`") && warning.contains("ratio of 0.25 or more"), "{warning}");
        }
        assert_eq!(in_model(30.0, sand, rises).len(), 0, "a bank with a free side");
        assert_eq!(told(sand, &format!("initial_stress: {{k0: 0.5}}\n{}", rises.replace("{rate: 1}", "1"))).len(), 0);
        assert_eq!(told(sand, &rises.replace("quasi_static", "dynamic")).len(), 0);
    }
}
