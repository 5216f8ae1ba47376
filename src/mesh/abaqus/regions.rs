//! Which region each cell is of: that of its section, or where the file has none, that of a set.

use super::model::{Element, Model, Section, Set, called, count};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// The regions of a mesh.
pub struct Regions {
    pub names: Vec<String>,
    /// The region of each element that is a cell.
    pub of: Vec<Option<usize>>,
}

/// The name of a region and the instance that it is of.
type Name = (usize, String);

/// # Errors
/// Input: a cell in two sections, or in none beside others that have one; without sections, one in sets that do not tell.
pub fn of(model: &Model, place: &str) -> Result<Regions> {
    let mut names = by_section(model, place)?;
    let has_sections = names.iter().any(Option::is_some);
    let cells = || (0..model.elements.len()).filter(|&e| model.elements[e].is_cell());
    if has_sections {
        // Elements without material are those of air in programs that write no section for them.
        for e in cells().filter(|&e| names[e].is_none()).collect::<Vec<_>>() {
            let element = &model.elements[e];
            names[e] = own(model, element);
            if names[e].is_none() {
                let remedy = "assign a section to it (`*Solid Section, elset=…, material=…`)";
                return Err(Error::input(of_element(model, element, place), "it is in no section", remedy));
            }
        }
    } else {
        by_set(model, place, &mut names)?;
    }
    let (of, names) = number(model, &names);
    Ok(Regions { names, of })
}

fn of_element(model: &Model, element: &Element, place: &str) -> String {
    let instance = &model.instances[element.instance].name;
    let of = if instance.is_empty() { String::new() } else { format!(" of {instance}") };
    format!("{place}, element {}{of}", element.number)
}

/// The set that an element is in from the beginning.
fn own(model: &Model, element: &Element) -> Option<Name> {
    let key = (element.instance, element.own.clone()?);
    model.element_sets.get(&key).map(|set| (element.instance, set.name.clone()))
}

/// The region that a section makes of its set: called so, or by the material where the set has no name of the user.
fn of_section(section: &Section, set: &Set) -> Name {
    let is_named = !set.internal && !is_automatic(&set.name) || section.material.is_empty();
    (section.instance, if is_named { set.name.clone() } else { section.material.clone() })
}

fn by_section(model: &Model, place: &str) -> Result<Vec<Option<Name>>> {
    let mut names: Vec<Option<Name>> = vec![None; model.elements.len()];
    for section in &model.sections {
        let Some(set) = model.element_sets.get(&(section.instance, section.set.clone())) else {
            let place = format!("{place}, line {}", section.line);
            return Err(Error::input(
                place,
                format!("there is no set {:?} of elements", section.set),
                "correct the name",
            ));
        };
        let name = of_section(section, set);
        for &e in &set.members {
            let (element, known) = (&model.elements[e as usize], &mut names[e as usize]);
            match known {
                Some(other) if *other != name => {
                    let problem = format!("it is in two sections, those of {} and of {}", other.1, name.1);
                    return Err(Error::input(
                        of_element(model, element, place),
                        problem,
                        "leave it in one: sections are the regions of the case",
                    ));
                }
                _ if element.is_cell() => *known = Some(name.clone()),
                _ => {}
            }
        }
    }
    Ok(names)
}

/// Without sections: the sets of `*ELSET` where each cell is in one of them, else those that the elements are written with, else what there is.
fn by_set(model: &Model, place: &str, names: &mut [Option<Name>]) -> Result<()> {
    let cells: Vec<usize> = (0..model.elements.len()).filter(|&e| model.elements[e].is_cell()).collect();
    let mut listed: Vec<Vec<Name>> = vec![Vec::new(); model.elements.len()];
    let all = |set: &Set| cells.iter().all(|&e| set.members.contains(&(e as u32)));
    let candidates =
        || model.element_sets.iter().filter(|(_, set)| set.listed && !set.internal && !is_automatic(&set.name));
    let parts_too = candidates().any(|(_, set)| !all(set));
    for ((instance, _), set) in candidates().filter(|(_, set)| !parts_too || !all(set)) {
        let of_cells = set.members.iter().filter(|&&e| model.elements[e as usize].is_cell());
        of_cells.for_each(|&e| listed[e as usize].push((*instance, set.name.clone())));
    }
    let owned: Vec<Option<Name>> = model.elements.iter().map(|element| own(model, element)).collect();
    let by_listed = cells.iter().all(|&e| listed[e].len() == 1);
    let by_own = cells.iter().all(|&e| owned[e].is_some());
    for &e in &cells {
        let element = &model.elements[e];
        names[e] = match (&listed[e][..], &owned[e]) {
            ([one], _) if by_listed => Some(one.clone()),
            (_, Some(own)) if by_own => Some(own.clone()),
            ([], Some(one)) => Some(one.clone()),
            ([one], None) => Some(one.clone()),
            ([], None) => {
                let instance = &model.instances[element.instance].name;
                Some((element.instance, if instance.is_empty() { "domain".to_owned() } else { instance.clone() }))
            }
            (several, own) => {
                let sets: BTreeSet<&str> = several.iter().chain(own).map(|name| name.1.as_str()).collect();
                let sets = sets.into_iter().collect::<Vec<_>>().join(" and ");
                let remedy =
                    "leave it in one, or write `*Solid Section, elset=…`, whose sets are the regions of the case";
                return Err(Error::input(
                    of_element(model, element, place),
                    format!("it is in the sets {sets}, and nothing tells which is its region"),
                    remedy,
                ));
            }
        };
    }
    Ok(())
}

/// Numbers the regions in the order of their cells, and calls those of several instances by both names.
fn number(model: &Model, names: &[Option<Name>]) -> (Vec<Option<usize>>, Vec<String>) {
    let mut order: Vec<&Name> = Vec::new();
    let mut number: BTreeMap<&Name, usize> = BTreeMap::new();
    for name in names.iter().flatten() {
        number.entry(name).or_insert_with(|| {
            order.push(name);
            order.len() - 1
        });
    }
    let of = names.iter().map(|name| name.as_ref().and_then(|name| number.get(name).copied())).collect();
    let count = count(order.iter().map(|name| name.1.to_lowercase()));
    let called = |name: &&Name| called(model, name.0, &name.1, count[&name.1.to_lowercase()] > 1);
    (of, order.iter().map(called).collect())
}

/// Whether a name is one that Abaqus/CAE gives where the user gives none: `Set-1`, `_PickedSet2`.
fn is_automatic(name: &str) -> bool {
    let number = |rest: &str| !rest.is_empty() && rest.bytes().all(|c| c.is_ascii_digit());
    name.starts_with('_') || name.get(..4).is_some_and(|set| set.eq_ignore_ascii_case("set-") && number(&name[4..]))
}
