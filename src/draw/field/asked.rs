//! Which field is drawn, and which component of it.

use crate::error::{Error, Result};
use crate::io::container::Data;
use crate::io::frame::INTERNAL;
use crate::io::vtu::{Array, Grid};
use crate::tensor::SYMMETRIC_NAMES;

/// The name of a field as a case has it under `output.fields`, and of its component.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    pub field: String,
    component: Option<String>,
    pub array: String,
}

impl Asked {
    /// `NAME`, `NAME.COMPONENT` or `internal_variables.NAME`.
    pub fn of(text: &str) -> Self {
        let (field, rest) = text.split_once('.').map_or((text, None), |(field, rest)| (field, Some(rest.to_owned())));
        if field == INTERNAL {
            return Self { field: field.to_owned(), component: None, array: text.to_owned() };
        }
        Self { field: field.to_owned(), component: rest, array: field.to_owned() }
    }

    /// The values of a grid at its nodes, with the title of the colour bar. `None` where it has not the field.
    ///
    /// # Errors
    /// `Input` for a component that the field has not.
    pub fn values(&self, grid: &Grid) -> Result<Option<(String, Vec<f64>)>> {
        let named = |array: &&Array| array.name.rsplit_once(" [").is_some_and(|(name, _)| name == self.array);
        let Some(Array { name, components, data: Data::F64(values) }) = grid.point_data.iter().find(named) else {
            return Ok(None);
        };
        let (array, unit) = name.rsplit_once(" [").unwrap_or((name, "-]"));
        let names: &[&str] = match components {
            3 => &["x", "y", "z"],
            6 => &SYMMETRIC_NAMES,
            9 => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
            _ => &[],
        };
        let at = |k: usize| values.chunks_exact(*components).map(|v| v[k]).collect();
        let size = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let (title, values): (String, Vec<f64>) = match &self.component {
            None if *components == 1 => (array.to_owned(), values.clone()),
            None if *components == 3 => (array.to_owned(), values.chunks_exact(3).map(size).collect()),
            component => match names.iter().position(|name| component.as_deref() == Some(*name)) {
                Some(k) => (format!("{array}.{}", names[k]), at(k)),
                None => return Err(self.wrong(names)),
            },
        };
        let unit = unit.trim_end_matches(']');
        Ok(Some((if unit == "-" { title } else { format!("{title} [{unit}]") }, values)))
    }

    fn wrong(&self, names: &[&str]) -> Error {
        let remedy = if names.is_empty() {
            "it is a number: take the component out".to_owned()
        } else {
            let all: Vec<String> = names.iter().map(|name| format!("{}.{name}", self.field)).collect();
            format!("say which component: {}", all.join(", "))
        };
        let problem = match &self.component {
            Some(component) => format!("the field has no component `{component}`"),
            None => "the field has several components".to_owned(),
        };
        Error::input(format!("--field {}", self.array), problem, remedy)
    }
}
