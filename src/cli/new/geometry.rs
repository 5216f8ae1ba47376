//! The parameters of the `.geo` of a template: a line each within its `DefineConstant`, `name = {value, options}`.

use crate::case::issue::describe;
use crate::case::structure::suggest;
use serde_json::Value;
use std::ops::Range;

/// A parameter: its name, where its value stands in the text with what is before the options, and the options.
struct Parameter<'a> {
    name: &'a str,
    value: Range<usize>,
    options: &'a str,
}

/// The text with the value of a parameter in the place of the one it has.
///
/// # Errors
/// The problem and its remedy: a name that the `.geo` does not have, a value that its options exclude.
pub fn set(geo: &str, name: &str, value: &Value) -> Result<String, (String, String)> {
    let known = parameters(geo);
    let Some(parameter) = known.iter().find(|parameter| parameter.name == name) else {
        let names = known.iter().map(|parameter| parameter.name);
        return Err((format!("there is no parameter `{name}`"), suggest(name, names)));
    };
    let Some(number) = value.as_f64() else {
        return Err((format!("it is {}", describe(value)), "write a number".into()));
    };
    if let Some(allowed) = parameter.choices().filter(|choices| !choices.iter().any(|(choice, _)| *choice == number)) {
        let allowed: Vec<String> = allowed.iter().map(|(choice, meaning)| format!("{choice} ({meaning})")).collect();
        return Err((format!("{number} is none of its values"), format!("choose from {}", allowed.join(", "))));
    }
    let [least, most] = ["Min", "Max"].map(|which| parameter.bound(which));
    if number < least || number > most {
        let remedy = if number < least { format!("give {least} or more") } else { format!("give {most} or less") };
        return Err((format!("{number} is out of its range"), remedy));
    }
    // As wide as before where it fits, so that the comments stay in line.
    let Range { start, end } = parameter.value;
    let written = format!("{:<width$}", format!("{number}, "), width = end - start);
    Ok(format!("{}{written}{}", &geo[..start], &geo[end..]))
}

/// The parameters of a `.geo` that is written as a template.
fn parameters(geo: &str) -> Vec<Parameter<'_>> {
    let mut from = 0;
    let mut found = Vec::new();
    for line in geo.split_inclusive('\n') {
        let start = from;
        from += line.len();
        let Some((name, rest)) = line.split_once(" = {").filter(|_| line.contains("Name \"Parameters/")) else {
            continue;
        };
        let Some((value, options)) = rest.split_once(',') else { continue };
        let options = options.trim_start();
        let at = start + line.len() - rest.len();
        let behind = start + line.len() - options.len();
        if value.trim().parse::<f64>().is_ok() {
            found.push(Parameter { name: name.trim(), value: at..behind, options });
        }
    }
    found
}

impl<'a> Parameter<'a> {
    /// The number behind `Min` or `Max`; without it there is no bound.
    fn bound(&self, which: &str) -> f64 {
        let of = |option: &str| option.trim().strip_prefix(which)?.trim().parse().ok();
        self.options.split(',').find_map(of).unwrap_or(f64::NAN)
    }

    /// The values it may have, with their meanings, where there are only some.
    fn choices(&self) -> Option<Vec<(f64, &'a str)>> {
        let (list, _) = self.options.split_once("Choices{")?.1.split_once('}')?;
        let choice = |entry: &'a str| {
            let (value, meaning) = entry.split_once('=')?;
            Some((value.trim().parse().ok()?, meaning.trim().trim_matches('"')))
        };
        Some(list.split(',').filter_map(choice).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::templates::TEMPLATES;
    use super::*;
    use serde_json::json;

    const GEO: &str = "\
DefineConstant[
  shape = {0,    Choices{0 = \"bar\", 2 = \"wall\"}, Name \"Parameters/shape\"},
  width = {0.25, Min 1e-6, Max 3, Name \"Parameters/width\"}, // [m]
];
width = 7;
";

    #[test]
    fn a_value_is_changed_in_its_place() {
        let set = |name: &str, value: Value| set(GEO, name, &value).unwrap();
        assert_eq!(set("width", json!(0.5)), GEO.replace("0.25, Min", "0.5,  Min"));
        assert_eq!(set("width", json!(0.123456)), GEO.replace("0.25, Min", "0.123456, Min"));
        assert_eq!(set("width", json!(1e-6)), GEO.replace("0.25, Min", "0.000001, Min"));
        assert_eq!(set("shape", json!(2)), GEO.replace("0,    Choices", "2,    Choices"));
    }

    #[test]
    fn a_value_out_of_range_names_the_parameter() {
        for (name, value, problem, remedy) in [
            ("wdth", json!(1), "there is no parameter `wdth`", "did you mean `width`?"),
            ("width", json!("wide"), "it is the text `wide`", "write a number"),
            ("width", json!(0), "0 is out of its range", "give 0.000001 or more"),
            ("width", json!(4), "4 is out of its range", "give 3 or less"),
            ("shape", json!(1), "1 is none of its values", "choose from 0 (bar), 2 (wall)"),
        ] {
            assert_eq!(set(GEO, name, &value).unwrap_err(), (problem.to_owned(), remedy.to_owned()));
        }
    }

    #[test]
    fn every_parameter_of_the_templates_is_found_and_is_in_its_own_range() {
        for template in TEMPLATES {
            let known = parameters(template.geo);
            assert_eq!(known.len(), template.geo.matches("Name \"Parameters/").count(), "{}", template.name);
            assert!(known.iter().any(|parameter| parameter.name == "h"), "{}", template.name);
            for Parameter { name, value, .. } in known {
                let (number, _) = template.geo[value].split_once(',').unwrap();
                let number: f64 = number.parse().unwrap();
                assert_eq!(set(template.geo, name, &json!(number)).as_deref(), Ok(template.geo), "{name}");
            }
        }
    }
}
