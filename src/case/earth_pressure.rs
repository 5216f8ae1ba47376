//! Earth pressure at rest: what a case says of it, checked.

use super::check::Checker;
use super::checked::{EarthPressure, Material};
use super::locate::{At, Path};
use super::raw::{self, EarthPressures, InDepth, RegionKind};
use super::structure::list;
use crate::material::Profile;

/// That of what is no soil.
const NONE: EarthPressure = EarthPressure::Given(Profile { top: 0.0, gradient: 0.0, datum: 0.0, least: 0.0 });

impl Checker {
    /// The earth pressures at rest of the materials in their order, where there is an initial stress.
    pub(super) fn earth_pressures(
        &mut self,
        file: &raw::CaseFile,
        materials: &[Material],
        path: &Path,
    ) -> Option<Vec<EarthPressure>> {
        let of = match &file.initial_stress.as_ref()?.k0 {
            // The angle of friction is one of a material.
            EarthPressures::All(value @ raw::EarthPressure::Given(_)) => {
                let k0 = self.earth_pressure(value, None, path).unwrap_or(NONE);
                return Some(vec![k0; materials.len()]);
            }
            EarthPressures::All(value) => file.materials.keys().map(|name| (name.clone(), *value)).collect(),
            EarthPressures::ByMaterial(of) => of.clone(),
        };
        for name in of.keys().filter(|name| !file.materials.contains_key(*name)) {
            let known: Vec<&str> = file.materials.keys().map(String::as_str).collect();
            let remedy = format!("choose from {}", list(&known));
            self.issue(&path.key(name), At::Key, format!("there is no material `{name}`"), remedy);
        }
        let is_soil = |name: &str| {
            let is = |region: &raw::Region| matches!(region.kind, RegionKind::Mpm | RegionKind::Fem);
            file.regions.values().any(|region| is(region) && region.material.as_deref() == Some(name))
        };
        let mut one = |Material { name, .. }: &Material| match of.get(name) {
            Some(value) => self.earth_pressure(value, file.materials.get(name), &path.key(name)),
            None if is_soil(name) => {
                let remedy = format!("add `{name}: …`, horizontal over vertical effective stress");
                self.issue(path, At::Key, format!("the soil `{name}` has none"), remedy);
                None
            }
            None => None,
        };
        Some(materials.iter().map(|material| one(material).unwrap_or(NONE)).collect())
    }

    fn earth_pressure(
        &mut self,
        value: &raw::EarthPressure,
        material: Option<&raw::Material>,
        path: &Path,
    ) -> Option<EarthPressure> {
        match value {
            raw::EarthPressure::Given(value) => self.at_least(0.0, *value, path).map(EarthPressure::Given),
            raw::EarthPressure::Overconsolidated(raw::Overconsolidated { overconsolidation_ratio: ratio }) => {
                let Some(friction) = material?.parameters.get("friction") else {
                    let remedy = "give a number, such as 0.5";
                    self.issue(path, At::Value, "the material has no `friction`, of which this would be made", remedy);
                    return None;
                };
                let ratio = self.at_least(1.0, *ratio, &path.key("overconsolidation_ratio"))?;
                Some(EarthPressure::Overconsolidated { friction: friction.profile(), ratio })
            }
        }
    }

    /// A value that is nowhere less than a limit.
    fn at_least(&mut self, limit: f64, value: InDepth, path: &Path) -> Option<Profile> {
        self.falls_to_something(value, path);
        let profile = value.profile();
        let least = if profile.gradient < 0.0 { profile.least.min(profile.top) } else { profile.top };
        if least >= limit {
            return Some(profile);
        }
        if least.is_infinite() {
            return None;
        }
        let at = match value {
            InDepth::Constant(_) => path.clone(),
            InDepth::Profile(_) if profile.top < limit => path.key("top"),
            InDepth::Profile(_) => path.key("least"),
        };
        self.issue(&at, At::Value, format!("is {least}, but must be at least {limit}"), "give a larger one");
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::checked::Case;
    use crate::case::{resolve, source::Source};
    use std::path::PathBuf;

    /// What is made of a case whose `k0` is as given.
    fn case(k0: &str) -> Result<Case, Vec<String>> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
             regions: {{sand: {{kind: mpm, material: sand}}, peat: {{kind: mpm, material: peat}}}}\n\
             materials: {{sand: {{model: mohr_coulomb, young: 2.0e+4, poisson: 0.3, unit_weight: 20, cohesion: 1, friction: 30}}, \
             peat: {{model: linear_elastic, young: 1000, poisson: 0.3, unit_weight: 12}}}}\n\
             gravity: {{y: -9.81}}\ninitial_stress: {{k0: {k0}}}\n\
             phases: [{{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 1}}}}]\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        case.filter(|_| issues.is_empty()).ok_or_else(|| issues.iter().map(|i| format!("{i:?}")).collect())
    }

    #[test]
    fn numbers_profiles_and_ratios_of_overconsolidation() {
        // The materials in the order of their names: peat, sand.
        let at = |k0: &str, y: f64| case(k0).unwrap().k0.unwrap().iter().map(|k0| k0.at(y)).collect::<Vec<_>>();
        assert_eq!(at("0.6", -3.0), [0.6, 0.6]);
        assert_eq!(at("{top: 1, gradient: -0.1, least: 0.5}", -3.0), [0.7, 0.7]);
        assert_eq!(at("{sand: 0.5, peat: {top: 1, gradient: -0.1, least: 0.5}}", -9.0), [0.5, 0.5]);
        // sin 30° is ½: ½ √R.
        let [peat, sand] = at("{peat: 0.9, sand: {overconsolidation_ratio: 4}}", 0.0).try_into().unwrap();
        assert!(peat == 0.9 && (sand - 1.0).abs() < 1e-15, "{sand}");
        let falling = "{top: 9, gradient: -1, least: 1}";
        let [_, sand] =
            at(&format!("{{peat: 1, sand: {{overconsolidation_ratio: {falling}}}}}"), -5.0).try_into().unwrap();
        assert!((sand - 1.0).abs() < 1e-15, "{sand}");
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for (k0, said) in [
            ("-1", "is -1, but must be at least 0"),
            ("{sand: 0.5}", "the soil `peat` has none"),
            ("{sand: 0.5, peat: 1, clay: 1}", "there is no material `clay`"),
            ("{sand: 0.5, peat: {overconsolidation_ratio: 2}}", "has no `friction`"),
            ("{sand: {overconsolidation_ratio: 0.5}, peat: 1}", "is 0.5, but must be at least 1"),
            ("{top: 1, gradient: -0.1}", "has no `least`"),
        ] {
            let issues = case(k0).unwrap_err();
            assert!(issues.iter().any(|issue| issue.contains(said)), "{k0}: {issues:?}");
        }
    }
}
