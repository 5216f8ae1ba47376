//! The arrays of a `.vtu` in the plain encoding of [`super::vtu`]: a line an array, its numbers in base64 after their length
//! in bytes (u64).
//!
//! Not a reader of VTK's XML: whatever else the format permits is an error. So time and memory are proportional to the length
//! of the file, whoever wrote it.

use std::collections::BTreeSet;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rayon::prelude::*;

use crate::io::container::{Array, Data, Scalar};

/// The name of the array of places.
pub const POSITION: &str = "position";

/// Numbers in the largest tuple, a tensor.
const MAX_COMPONENTS: usize = 9;

/// The positions and the arrays of the points, their names without the unit.
///
/// # Errors
/// What is wrong with the text.
pub fn arrays(xml: &[u8]) -> Result<Vec<Array>, String> {
    let text = std::str::from_utf8(xml).ok().filter(|text| text.contains("<VTKFile type=\"UnstructuredGrid\" "));
    let text = text.ok_or("is not an unstructured grid of mpm")?;
    let mut lines: Vec<&str> = section(text, "PointData")?.lines().collect();
    lines.extend(section(text, "Points")?.lines());
    let arrays: Vec<Array> = lines.par_iter().map(|line| array(line)).collect::<Result<_, _>>()?;
    let mut names = BTreeSet::new();
    match arrays.iter().find(|array| !names.insert(&array.name)) {
        Some(array) => Err(format!("has the array `{}` twice", array.name)),
        None => Ok(arrays),
    }
}

/// The lines of the only element `name`.
fn section<'a>(text: &'a str, name: &str) -> Result<&'a str, String> {
    let problem = || format!("does not have one element `{name}`");
    let (_, inside) = text.split_once(&format!("\n<{name}>\n")).ok_or_else(problem)?;
    let (inside, after) = inside.split_once(&format!("</{name}>\n")).ok_or_else(problem)?;
    if after.contains(&format!("<{name}>")) { Err(problem()) } else { Ok(inside) }
}

fn array(line: &str) -> Result<Array, String> {
    let (tag, numbers) = line
        .strip_prefix("<DataArray ")
        .and_then(|line| line.strip_suffix("</DataArray>"))
        .and_then(|line| line.split_once(" format=\"binary\">"))
        .ok_or("has a line that is no array")?;
    let (kind, rest) = attribute(tag, "type").ok_or("has an array without a type")?;
    let (name, rest) = attribute(rest, "Name").ok_or("has an array without a name")?;
    let name = name.split_once(" [").map_or(name, |(name, _)| name);
    let components = attribute(rest, "NumberOfComponents").map_or(Some(1), |(number, _)| number.parse().ok());
    let components = components.filter(|n| (1..=MAX_COMPONENTS).contains(n));
    let broken = || format!("`{name}` has an unexpected type or length");
    let components = components.ok_or_else(broken)?;
    let bytes = STANDARD.decode(numbers).map_err(|_| broken())?;
    let (length, bytes) = bytes.split_at_checked(8).ok_or_else(broken)?;
    if u64::load(length) != bytes.len() as u64 {
        return Err(broken());
    }
    let data = match kind {
        "Float64" => values::<f64>(bytes),
        "UInt32" => values::<u32>(bytes),
        "UInt16" => values::<u16>(bytes),
        _ => None,
    };
    let data = data.filter(|data| data.len().is_multiple_of(components)).ok_or_else(broken)?;
    let name = if name == "Points" { POSITION } else { name };
    Ok(Array { name: name.to_string(), unit: String::new(), components, data })
}

/// The value of the first attribute, if it is `name`, and the text after it.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<(&'a str, &'a str)> {
    tag.trim_start().strip_prefix(name)?.strip_prefix("=\"")?.split_once('"')
}

fn values<T: Scalar>(bytes: &[u8]) -> Option<Data> {
    let values = bytes.len().is_multiple_of(T::SIZE).then(|| bytes.chunks_exact(T::SIZE).map(T::load).collect())?;
    Some(T::to_data(values))
}
