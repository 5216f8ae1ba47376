//! The runs of a sweep: every combination of the values of its axes.

use crate::error::{Error, Result, shown};
use crate::io::hash;

/// The longest name of a run, in bytes: file systems allow 255, and files beside the folder have endings.
const LONGEST: usize = 120;

/// The most runs of a sweep; more are most likely a slip.
const MOST: usize = 10_000;

/// An entry of the case and the values it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The path of the entry, as `--set` takes it.
    pub path: String,
    /// What it is called in names and tables: its last key, or its path where another axis has the same one.
    pub label: String,
    /// Its values as YAML.
    pub values: Vec<String>,
}

/// A combination of values, one an axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The name of its folder.
    pub name: String,
    pub values: Vec<String>,
}

/// Reads axes `PATH=V1,V2,…`. A comma within brackets, braces or quotes belongs to a value.
///
/// # Errors
/// Input: an axis without `=` or with an empty value, and two of the same path.
pub fn parse(arguments: &[String]) -> Result<Vec<Axis>> {
    let mut axes: Vec<Axis> = Vec::new();
    for argument in arguments {
        let refuse = |problem: &str| {
            let remedy = "write it as materials.clay.young=100,200,400";
            Error::input(format!("the axis {}", shown(argument)), problem, remedy)
        };
        let (path, values) = argument.split_once('=').ok_or_else(|| refuse("no `=`"))?;
        let path = path.trim();
        let values: Vec<String> = split(values).into_iter().map(|value| value.trim().to_owned()).collect();
        if path.is_empty() || values.iter().any(String::is_empty) {
            return Err(refuse("an empty path or value"));
        }
        if axes.iter().any(|axis| axis.path == path) {
            return Err(refuse("an axis of this path is there already"));
        }
        if (1..values.len()).any(|i| values[..i].contains(&values[i])) {
            return Err(refuse("a value that is there twice"));
        }
        axes.push(Axis { path: path.to_owned(), label: last_key(path).to_owned(), values });
    }
    let labels: Vec<String> = axes.iter().map(|axis| axis.label.clone()).collect();
    for axis in &mut axes {
        if labels.iter().filter(|label| **label == axis.label).count() > 1 {
            axis.label.clone_from(&axis.path);
        }
    }
    Ok(axes)
}

/// The last key of a path, without the numbers of items.
fn last_key(path: &str) -> &str {
    let named = |key: &&str| key.parse::<usize>().is_err() && !key.is_empty();
    path.rsplit(['.', '[', ']']).find(named).unwrap_or(path)
}

/// Splits at the commas that stand in no brackets, braces or quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0_usize, None);
    for (i, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '\'' | '"') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                parts.push(&text[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// Every combination of the values, the last axis running fastest.
///
/// # Errors
/// Input: more than [`MOST`].
pub fn combinations(axes: &[Axis]) -> Result<Vec<Run>> {
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()));
    if count.is_none_or(|count| count > MOST) {
        let problem = format!("the axes have more than {MOST} combinations");
        return Err(Error::input("the sweep", problem, "give fewer values, or divide it into several sweeps"));
    }
    let mut all: Vec<Vec<String>> = vec![Vec::new()];
    for axis in axes {
        let with = |values: &Vec<String>| {
            let values = values.clone();
            axis.values.iter().map(move |value| [values.clone(), vec![value.clone()]].concat())
        };
        all = all.iter().flat_map(with).collect();
    }
    Ok(all.into_iter().map(|values| Run { name: name(axes, &values), values }).collect())
}

/// The name of a run: `label=value__label=value`, the same in every sweep that has it. Characters that a file name should not have
/// become `_`; then, and where it is too long, a hash of the values keeps it apart from others.
fn name(axes: &[Axis], values: &[String]) -> String {
    let pairs: Vec<String> = axes.iter().zip(values).map(|(axis, value)| format!("{}={value}", axis.label)).collect();
    let whole = pairs.join("__");
    let plain = |c: char| c.is_ascii_alphanumeric() || ".+-=_".contains(c);
    let mut name: String = whole.chars().map(|c| if plain(c) { c } else { '_' }).collect();
    if name != whole || name.len() > LONGEST || name.starts_with('.') {
        name.truncate(LONGEST);
        name = format!("{}~{}", name.trim_start_matches('.'), &hash::text(hash::bytes(whole.as_bytes()))[..8]);
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(arguments: &[&str]) -> Result<Vec<Axis>> {
        parse(&arguments.iter().map(|&argument| argument.to_owned()).collect::<Vec<_>>())
    }

    #[test]
    fn values_are_split_at_commas_outside_of_brackets_and_quotes() {
        let found = axes(&["materials.clay.young=1, {top: 2, gradient: 3},[4,5],'6,7'"]).unwrap();
        assert_eq!(found[0].label, "young");
        assert_eq!(found[0].values, ["1", "{top: 2, gradient: 3}", "[4,5]", "'6,7'"]);
    }

    #[test]
    fn combinations_are_all_and_have_names_of_their_own() {
        let axes = axes(&["contacts[0].friction=0,0.5", "materials.clay.young=1,{top: 2},{top= 2}"]).unwrap();
        let runs = combinations(&axes).unwrap();
        assert_eq!(runs.len(), 6);
        assert_eq!((runs[0].name.as_str(), &runs[3].values), ("friction=0__young=1", &vec!["0.5".into(), "1".into()]));
        let names: std::collections::BTreeSet<&str> = runs.iter().map(|run| run.name.as_str()).collect();
        assert_eq!(names.len(), 6, "{names:?}");
        assert!(names.iter().all(|name| !name.contains(['/', ' ', '{'])), "{names:?}");
    }

    #[test]
    fn a_hostile_value_stays_within_the_folder() {
        let runs = combinations(&axes(&["title=../../up,/etc/passwd,."]).unwrap()).unwrap();
        assert!(runs.iter().all(|run| !run.name.contains('/') && !run.name.starts_with('.')), "{runs:?}");
        let long = "x".repeat(5000);
        assert!(combinations(&axes(&[&format!("title={long}")]).unwrap()).unwrap()[0].name.len() < 140);
    }

    #[test]
    fn labels_that_two_axes_share_are_their_paths() {
        let found = axes(&["materials.a.young=1", "materials.b.young=1", "phases[0].step.max=1"]).unwrap();
        let labels: Vec<&str> = found.iter().map(|axis| axis.label.as_str()).collect();
        assert_eq!(labels, ["materials.a.young", "materials.b.young", "max"]);
    }

    #[test]
    fn mistakes_are_refused() {
        for (arguments, problem) in [
            (vec!["young"], "no `=`"),
            (vec!["young=1,,2"], "empty"),
            (vec!["=1"], "empty"),
            (vec!["a.b=1", "a.b=2"], "already"),
            (vec!["a.b=1,2,1"], "twice"),
        ] {
            assert!(axes(&arguments).unwrap_err().to_string().contains(problem), "{arguments:?}");
        }
    }
}
