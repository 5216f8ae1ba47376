//! The fields of a frame, and those that follow from them.

use super::super::frame::{Column, INTERNAL, Part};
use super::super::vtu::Array;
use crate::tensor::{Symmetric, deviatoric, mean};

/// The fields that a part has or that follow from what it has.
pub fn select(part: &Part, fields: &[String]) -> Vec<Array> {
    let internal: Vec<&str> = part.columns.iter().map(|c| c.name.as_str()).filter(|name| is_internal(name)).collect();
    let mut arrays = Vec::new();
    for name in fields {
        let own = [name.as_str()];
        let names = if name == INTERNAL { &internal[..] } else { &own };
        arrays.extend(names.iter().filter_map(|name| column(part, name)));
    }
    arrays
}

/// Whether a column is one of an internal variable.
fn is_internal(name: &str) -> bool {
    name.strip_prefix(INTERNAL).is_some_and(|rest| rest.starts_with('.'))
}

/// One of them.
pub fn column(part: &Part, name: &str) -> Option<Array> {
    let find = |name: &str| part.columns.iter().find(|c| c.name == name);
    if let Some(Column { unit, components, values, .. }) = find(name) {
        return Some(Array::new(name, unit, *components, values.clone()));
    }
    let derive: fn(&Symmetric) -> f64 = match name {
        "mean_stress" => mean,
        "deviatoric_stress" => deviatoric,
        _ => return None,
    };
    let Column { unit, components: 6, values, .. } = find("stress")? else { return None };
    let values = values.chunks_exact(6).map(|s| derive(&[s[0], s[1], s[2], s[3], s[4], s[5]])).collect();
    Some(Array::new(name, unit, 1, values))
}
