//! What a `.geo` and a mesh file must be, beyond what Gmsh asks of them.

use super::session::Session;
use crate::error::{Error, Result};
use std::path::Path;

/// Every surface must be in exactly one physical surface.
///
/// # Errors
/// Input: one in none or in two, or no physical surface at all.
pub fn check_surfaces(session: &Session, path: &Path) -> Result<()> {
    let groups = session.physical_groups(2);
    if groups.is_empty() {
        return Err(Error::input(
            path.display(),
            "it has no physical surface",
            "name the regions: Physical Surface(\"soil\") = {1};",
        ));
    }
    for surface in session.entities(2) {
        let mut holders = groups.iter().filter(|g| g.entities.contains(&surface));
        let place = || format!("{}, surface {surface}", path.display());
        match (holders.next(), holders.next()) {
            (None, _) => {
                return Err(Error::input(place(), "it is in no physical surface", "add it to one, or delete it"));
            }
            (Some(a), Some(b)) => {
                let problem = format!("it is in two physical surfaces, {} and {}", a.name, b.name);
                return Err(Error::input(place(), problem, "leave it in one: they are the regions of the case"));
            }
            _ => (),
        }
    }
    Ok(())
}

/// Every parameter must have been taken up by a `DefineConstant` of the file.
///
/// # Errors
/// Input: one that the file does not declare.
pub fn check_parameters(session: &Session, geo: &Path, text: &str, parameters: &[(String, f64)]) -> Result<()> {
    if parameters.is_empty() {
        return Ok(());
    }
    let declared = declared(text);
    for (name, value) in parameters {
        // An included file may declare it too; a plain assignment after it would have changed the value.
        let used = declared.contains(name) || session.parameter_names().contains(name) && text.contains("Include");
        if used && session.parameter(name)? == Some(*value) {
            continue;
        }
        let remedy = match declared.is_empty() {
            true => format!("declare it: DefineConstant[ {name} = {{1, Name \"Parameters/{name}\"}} ];"),
            false => format!("it declares {}", declared.join(", ")),
        };
        let problem = format!("there is no DefineConstant for the parameter {name}");
        return Err(Error::input(geo.display(), problem, remedy));
    }
    Ok(())
}

/// The names declared in the `DefineConstant[ a = …, b = {…, …} ]` of a `.geo`, in order.
pub fn declared(text: &str) -> Vec<String> {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let text = lines.collect::<Vec<_>>().join("\n");
    let mut names: Vec<String> = Vec::new();
    for block in text.split("DefineConstant").skip(1) {
        let Some(body) = block.trim_start().strip_prefix('[') else { continue };
        let (mut depth, mut quoted, mut name, mut in_name) = (0usize, false, String::new(), true);
        for c in body.chars() {
            match c {
                '"' => quoted = !quoted,
                _ if quoted => (),
                '{' | '(' | '[' => depth += 1,
                ']' if depth == 0 => break,
                '}' | ')' | ']' => depth = depth.saturating_sub(1),
                ',' if depth == 0 => {
                    names.push(std::mem::take(&mut name));
                    in_name = true;
                }
                '=' if depth == 0 => in_name = false,
                _ if in_name && !c.is_whitespace() => name.push(c),
                _ => (),
            }
        }
        names.push(name);
    }
    names.retain(|name| !name.is_empty());
    names
}
