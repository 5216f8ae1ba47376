//! The materials of a case: the entries a model takes come from the list of models, so that a new model
//! needs no line in this layer. The density is given, or follows from a unit weight and gravity.

use super::check::Checker;
use super::checked::Material;
use super::locate::{At, Path};
use super::raw::{self, InDepth};
use super::structure::suggest;
use crate::error::Result;
use crate::material::{Correlation, Kind, MODELS, Model, Parameters, Profile, RandomStrength, Randomness};
use crate::term::MixedPressure;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

impl Checker {
    /// The checked material `name`, if it is without fault; `gravity` (m/s²) turns a unit weight into a density.
    pub(super) fn material(
        &mut self,
        name: &str,
        material: &raw::Material,
        gravity: &[f64; 2],
        pressure: Option<raw::Pressure>,
        path: &Path,
    ) -> Option<Material> {
        let density = self.density(material, gravity, path);
        let (model, carried) = self.model(material, pressure, path)?;
        let random_strength = self.random_strength(material, path);
        let porous = self.porous(material, &model, path);
        let drains = Self::drains(material, &model);
        Some(Material {
            name: name.to_owned(),
            model_name: material.model.clone(),
            density: density?,
            model,
            random_strength,
            carried,
            porous,
            drains,
        })
    }

    /// The field of strength of a material whose strength varies at random.
    fn random_strength(&mut self, material: &raw::Material, path: &Path) -> Option<Arc<RandomStrength>> {
        let random = material.random_strength.as_ref()?;
        let path = path.key("random_strength");
        if !MODELS.iter().any(|kind| kind.name == material.model && kind.yields) {
            let problem = format!("the model {} has no strength", material.model);
            self.issue(&path, At::Key, problem, "take it out, or choose a model that yields");
        }
        Some(Arc::new(RandomStrength::new(&Randomness {
            variation: random.coefficient_of_variation,
            lengths: [random.horizontal_scale, random.vertical_scale],
            correlation: random.correlation.into(),
            seed: random.seed,
        })))
    }

    fn density(&mut self, material: &raw::Material, gravity: &[f64; 2], path: &Path) -> Option<Profile> {
        match (material.density, material.unit_weight) {
            (Some(density), None) => self.not_negative(density, &path.key("density")),
            (None, Some(weight)) => {
                let path = path.key("unit_weight");
                let weight = self.not_negative(weight, &path)?;
                let g = gravity[0].hypot(gravity[1]);
                if g > 0.0 {
                    return Some(Profile::growing(weight.top / g, weight.gradient / g, weight.datum));
                }
                let remedy = "set `gravity`, or give `density` in place of `unit_weight`";
                self.issue(&path, At::Key, "a unit weight without gravity gives no density", remedy);
                None
            }
            (Some(_), Some(_)) => {
                let problem = "`density` and `unit_weight` are both given";
                self.issue(&path.key("unit_weight"), At::Key, problem, "keep one of them");
                None
            }
            (None, None) => {
                let remedy = "add `density: …` [t/m³] or `unit_weight: …` [kN/m³]";
                self.issue(path, At::Key, "neither `density` nor `unit_weight` is given", remedy);
                None
            }
        }
    }

    /// Refuses a value that falls with depth without an end, or has an end without falling.
    pub(super) fn falls_to_something(&mut self, value: InDepth, path: &Path) {
        let InDepth::Profile(raw::Profile { top, gradient, least, .. }) = value else { return };
        match least {
            None if gradient < 0.0 => {
                let problem = "the value falls with depth, and has no `least`";
                self.issue(&path.key("gradient"), At::Value, problem, "add `least: …`, below which it does not fall");
            }
            Some(_) if gradient >= 0.0 => {
                self.issue(&path.key("least"), At::Key, "the value does not fall with depth", "take `least` out");
            }
            Some(least) if least > top => {
                let problem = format!("is {least}, above the `top` of {top}");
                self.issue(&path.key("least"), At::Value, problem, "give a value below `top`");
            }
            _ => {}
        }
    }

    /// Refuses a value that falls with depth.
    pub(super) fn grows(&mut self, value: InDepth, path: &Path) {
        if let InDepth::Profile(profile) = value {
            self.profile_grows(&profile, path);
        }
    }

    pub(super) fn profile_grows(&mut self, profile: &raw::Profile, path: &Path) {
        if profile.gradient < 0.0 {
            let problem = format!("is {}, but must be at least 0", profile.gradient);
            self.issue(&path.key("gradient"), At::Value, problem, "only parameters of models fall with depth");
        } else if profile.least.is_some() {
            self.issue(&path.key("least"), At::Key, "the value does not fall with depth", "take `least` out");
        }
    }

    fn not_negative(&mut self, value: InDepth, path: &Path) -> Option<Profile> {
        let profile = value.profile();
        self.grows(value, path);
        if profile.top >= 0.0 {
            return Some(profile);
        }
        let problem = format!("is {}, but must be at least 0", profile.top);
        self.issue(&value.top(path), At::Value, problem, "give a value in t/m³ for a density, in kN/m³ for a weight");
        None
    }

    fn model(
        &mut self,
        material: &raw::Material,
        pressure: Option<raw::Pressure>,
        path: &Path,
    ) -> Option<(Arc<dyn Model>, Option<MixedPressure>)> {
        let kind = MODELS.iter().find(|kind| kind.name == material.model)?;
        let mut values = BTreeMap::new();
        let before = self.count();
        for (name, value) in &material.parameters {
            if kind.parameters.iter().any(|known| known.name == name) {
                self.falls_to_something(*value, &path.key(name));
                values.insert(name.as_str(), value.profile());
            } else {
                let known = kind.parameters.iter().map(|known| known.name).filter(|known| !material.has(known));
                let remedy = format!("take it out, or {}", suggest(name, known));
                self.issue(&path.key(name), At::Key, format!("the model {} has no `{name}`", kind.name), remedy);
            }
        }
        for known in kind.parameters.iter().filter(|known| known.required && !material.has(known.name)) {
            let problem = format!("the model {} needs `{}`", kind.name, known.name);
            self.issue(path, At::Key, problem, format!("add `{}: …`: {} [{}]", known.name, known.meaning, known.unit));
            values.extend(example(kind, known.name));
        }
        // A model stops at its first fault: with a sound value in its place the next one shows.
        let mut mended = BTreeSet::new();
        let model = loop {
            let fault = match build(kind, &values) {
                Ok(model) => break model,
                Err(fault) => fault,
            };
            // It names the parameter at fault as the place. One that does not go with another stays at fault.
            // What is said of one that has a sound value by now is nothing of the case.
            if mended.iter().any(|name| *name == fault.place || fault.problem.contains(&format!("`{name}`"))) {
                return None;
            }
            let Some(value) = material.parameters.get(&fault.place) else {
                self.issue(path, At::Key, format!("{}: {}", fault.place, fault.problem), fault.remedy);
                return None;
            };
            self.issue(&value.top(&path.key(&fault.place)), At::Value, fault.problem, fault.remedy);
            let sound = example(kind, &fault.place)?;
            values.insert(sound.0, sound.1);
            mended.insert(fault.place);
        };
        if self.count() > before {
            return None;
        }
        let carried = self.carried(material, kind, &model, &values, pressure, path);
        Some((model, carried))
    }
}

/// A sound value of a parameter.
fn example(kind: &Kind, name: &str) -> Option<(&'static str, Profile)> {
    let (name, value) = kind.examples.iter().flat_map(|example| example.iter()).find(|(known, _)| *known == name)?;
    Some((name, Profile::constant(*value)))
}

pub(super) fn build(kind: &Kind, values: &BTreeMap<&str, Profile>) -> Result<Arc<dyn Model>> {
    let mut parameters = Parameters::default();
    for (&name, &value) in values {
        parameters.set(name, value);
    }
    (kind.build)(&parameters)
}

impl From<raw::Correlation> for Correlation {
    fn from(raw: raw::Correlation) -> Self {
        match raw {
            raw::Correlation::Markov => Self::Markov,
            raw::Correlation::Gaussian => Self::Gaussian,
        }
    }
}

impl raw::Material {
    fn has(&self, parameter: &str) -> bool {
        self.parameters.contains_key(parameter)
    }
}

impl InDepth {
    pub(super) fn profile(self) -> Profile {
        match self {
            Self::Constant(value) => Profile::constant(value),
            Self::Profile(raw::Profile { top, gradient, datum, least }) => {
                Profile { least: least.unwrap_or(f64::NEG_INFINITY), ..Profile::growing(top, gradient, datum) }
            }
        }
    }

    /// Where the value at the top is written, for an entry at `path`.
    fn top(self, path: &Path) -> Path {
        match self {
            Self::Constant(_) => path.clone(),
            Self::Profile(_) => path.key("top"),
        }
    }
}

impl JsonSchema for raw::Material {
    fn schema_name() -> Cow<'static, str> {
        "Material".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let in_depth = generator.subschema_for::<InDepth>();
        let varying = |description: String| {
            let mut schema = in_depth.clone();
            schema.insert("description".into(), description.into());
            schema.to_value()
        };
        let models: Vec<&str> = MODELS.iter().map(|kind| kind.name).collect();
        let mut properties = Map::new();
        properties.insert("model".into(), json!({ "description": "The material model.", "enum": models }));
        let weight = "Unit weight [kN/m³], 0 or above; divided by gravity it is the density. This or `density`.";
        properties.insert("unit_weight".into(), varying(weight.into()));
        properties.insert("density".into(), varying("Density [t/m³], 0 or above. This or `unit_weight`.".into()));
        let drainage = "Whether water can leave the pores. If undrained, the model and its parameters are those of the effective \
            stress, and the excess pore pressure is found. Drained soil takes the water of undrained soil beside it; without this entry \
            one with a Poisson's ratio of 0.45 or more is in total stress and tight. Default: drained.";
        let mut schema = generator.subschema_for::<raw::Drainage>();
        schema.insert("description".into(), drainage.into());
        properties.insert("drainage".into(), schema.to_value());
        properties.insert(
            "undrained_poisson".into(),
            json!({
                "description": "Poisson's ratio of an undrained soil as a whole, which gives the stiffness of its water [-]: \
                    above `poisson`, below 0.5. Default: 0.495.",
                "type": "number",
            }),
        );
        let mut schema = generator.subschema_for::<raw::Permeability>();
        let permeability = "Permeability of an undrained soil, or {x, y} [m/s]: its water flows in consolidation and dynamic phases. Default: no \
            flow.";
        schema.insert("description".into(), permeability.into());
        properties.insert("permeability".into(), schema.to_value());
        let mut schema = generator.subschema_for::<raw::RandomStrength>();
        let random =
            "A random field with the mean 1, by which all strengths of the model are multiplied. Default: none.";
        schema.insert("description".into(), random.into());
        properties.insert("random_strength".into(), schema.to_value());
        for (name, range, description) in [
            (
                "porosity",
                json!({"exclusiveMinimum": 0, "exclusiveMaximum": 1}),
                "Porosity of an undrained soil, with `water_bulk_modulus` in place of `undrained_poisson` [-].",
            ),
            (
                "water_bulk_modulus",
                json!({"exclusiveMinimum": 0}),
                "Bulk modulus of the water in an undrained soil, K_w [kPa]; the stiffness of the water is K_w/n, n the `porosity`.",
            ),
            (
                "water_unit_weight",
                json!({"exclusiveMinimum": 0}),
                "Unit weight of the water in an undrained soil with a `permeability` [kN/m³]. Default: 9.81.",
            ),
        ] {
            let mut schema = json!({ "description": description, "type": "number" });
            if let (Some(schema), Some(range)) = (schema.as_object_mut(), range.as_object()) {
                schema.extend(range.clone());
            }
            properties.insert(name.into(), schema);
        }
        for kind in MODELS {
            for parameter in kind.parameters {
                let takers = MODELS.iter().filter(|k| k.parameters.iter().any(|p| p.name == parameter.name));
                let takers = takers.map(|k| k.name).collect::<Vec<_>>().join(", ");
                let description = format!("{} [{}] of {takers}.", parameter.meaning, parameter.unit);
                let schema = if parameter.varies {
                    varying(description)
                } else {
                    json!({ "description": description, "type": "number" })
                };
                properties.entry(parameter.name).or_insert(schema);
            }
        }
        json_schema!({
            "description": "A material; which entries it needs depends on its model.",
            "type": "object",
            "properties": Value::Object(properties),
            "required": ["model"],
            "additionalProperties": false,
        })
    }
}
