//! Loads and tables of which a part, or all, does nothing, or that begin anew where they were to go on.

use crate::case::checked::{Case, Geometry, LoadProfile, Phase, SurfaceLoad, Traction};
use crate::case::curve_loads::presses;
use crate::gravity::Gravity;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh};
use crate::time_value::TimeValue;
use std::collections::BTreeSet;

const AXES: [&str; 2] = ["x", "y"];

/// What shows without the mesh.
pub fn of_case(case: &Case) -> Vec<String> {
    let mut warnings: Vec<String> = (0..case.phases.len()).flat_map(|k| beyond(case, k)).collect();
    warnings.extend((0..case.phases.len()).flat_map(|k| begin_anew(case, k)));
    warnings.extend(case.phases.iter().flat_map(twice));
    let as_given = [TimeValue::Constant(1.0)];
    let idle = case.phases.iter().find(|phase| case.gravity == [0.0; 2] && phase.gravity.values() != as_given);
    warnings.extend(idle.map(|phase| {
        format!(
            "warning: phase `{}` has a factor on gravity, and there is no gravity: add `gravity: {{y: -9.81}}` to the case, or take the factor out",
            phase.name
        )
    }));
    warnings
}

/// What shows on the mesh: loads on curves that take up none.
pub fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let mut warnings = Vec::new();
    for phase in &case.phases {
        for load in &phase.tractions {
            let Some(curve) = mesh.group(&load.curve) else { continue };
            if load.force.is_none() && is_axis(case, mesh, curve) {
                warnings.push(format!(
                    "warning: phase `{}`: the traction on `{}` does nothing: the curve lies on the axis of symmetry, where a load has no area; \
                     take it out, or load a curve at a radius above 0",
                    phase.name, load.curve
                ));
                continue;
            }
            let held = [0, 1].map(|d| is_held(case, phase, mesh, curve, d));
            for (d, force) in load.force.iter().flatten().enumerate() {
                let on_axis = d == 0 && is_axis(case, mesh, curve);
                if !force.is_zero() && (held[d] || on_axis) {
                    let why =
                        if on_axis { "lies on the axis of symmetry" } else { "is held or moved in that direction" };
                    warnings.push(format!(
                        "warning: phase `{}`: `f{}` at `{}` does nothing: the point {why}; take one of the two out",
                        phase.name, AXES[d], load.curve
                    ));
                }
            }
            if load.pressure.is_some() && (0..2).all(|d| held[d] || !presses(mesh, curve, d)) {
                let name = &load.curve;
                warnings.push(format!(
                    "warning: phase `{}`: the pressure on `{name}` does nothing to the soil: all of the curve is held or moved in its direction, and \
                     the load goes into that; take one of the two out",
                    phase.name
                ));
            }
            let acts = |d: usize| {
                let LoadProfile { top, gradient, .. } = &load.components[d];
                [top, gradient].iter().any(|value| !value.is_zero()) || load.fields[d].is_some()
            };
            for d in (0..2).filter(|&d| held[d] && acts(d)) {
                let name = &load.curve;
                warnings.push(format!(
                    "warning: phase `{}`: `t{}` of the traction on `{name}` does nothing to the soil: all of the curve is held or moved in that \
                     direction, and the load goes into that; take one of the two out",
                    phase.name, AXES[d]
                ));
            }
        }
    }
    warnings
}

/// Whether all of a curve lies on the axis of symmetry.
fn is_axis(case: &Case, mesh: &Mesh<2>, curve: &Group) -> bool {
    let widest = mesh.nodes.iter().map(|x| x[0].abs()).fold(0.0, f64::max);
    case.geometry == Geometry::Axisymmetric && curve.nodes.iter().all(|&n| mesh.nodes[n as usize][0] <= SAME * widest)
}

/// Whether supports, or what a phase prescribes, give the displacement of all nodes of a curve in a direction.
fn is_held(case: &Case, phase: &Phase, mesh: &Mesh<2>, curve: &Group, direction: usize) -> bool {
    let supports = case.supports.iter().filter(|s| s.fixed[direction]).map(|s| &s.curve);
    let moved = phase.prescribed.iter().filter(|p| p.component == direction).map(|p| &p.curve);
    let mut held = BTreeSet::new();
    for name in supports.chain(moved) {
        held.extend(mesh.group(name).iter().flat_map(|group| &group.nodes));
        if case.content(name).is_some_and(|content| content.is_rigid()) {
            held.extend(mesh.part(|c| mesh.regions[usize::from(mesh.cells.region[c])] == *name).cells.nodes);
        }
    }
    curve.nodes.iter().all(|n| held.contains(n))
}

/// A warning where a phase has the same load twice.
fn twice(phase: &Phase) -> Vec<String> {
    let said = |what: String| {
        format!(
            "warning: phase `{}`: {what} is given twice, the same each time, and acts twice; take one out",
            phase.name
        )
    };
    let alike = |a: &Traction, b: &Traction| Traction { entry: b.entry, ..a.clone() } == *b;
    let before = |i: usize, load: &Traction| phase.tractions[..i].iter().any(|other| alike(other, load));
    let curves = phase.tractions.iter().enumerate().filter(|(i, load)| before(*i, load));
    let surfaces = phase.surface_loads.iter().enumerate().filter(|(i, load)| phase.surface_loads[..*i].contains(load));
    let curves = curves.map(|(_, load)| said(format!("the load on `{}`", load.curve)));
    curves.chain(surfaces.map(|_| said("a load on the surface".to_owned()))).collect()
}

/// What varies in the time of phase `k`, with what it is.
fn values(case: &Case, k: usize) -> Vec<(String, &TimeValue)> {
    let phase = &case.phases[k];
    let name = |d: usize| match phase.gravity {
        Gravity::Scaled { .. } => "`gravity`".to_owned(),
        Gravity::Components(_) => format!("`{}` of `gravity`", AXES[d]),
    };
    let mut values: Vec<_> = phase.gravity.values().iter().enumerate().map(|(d, value)| (name(d), value)).collect();
    values.extend(phase.prescribed.iter().map(|p| {
        (format!("`{}` prescribed of `{}`", ["ux", "uy", "rotation"][p.component], p.curve), &p.displacement)
    }));
    for load in &phase.tractions {
        values.extend(of_curve(load));
    }
    for load in &phase.surface_loads {
        values.extend(of_surface(case, load));
    }
    values.extend(phase.reduction.iter().map(|value| ("`strength_reduction`".to_owned(), value)));
    values.extend(levels(case, k));
    values
}

/// The values of a load on a curve.
fn of_curve(load: &Traction) -> Vec<(String, &TimeValue)> {
    if let Some(force) = &load.force {
        return [0, 1].map(|d| (format!("`f{}` at `{}`", AXES[d], load.curve), &force[d])).to_vec();
    }
    let name = |key: &str| format!("`{key}` of the traction on `{}`", load.curve);
    let keys = [("tx", &load.components[0]), ("ty", &load.components[1])];
    let loads = keys.into_iter().chain(load.pressure.iter().map(|pressure| ("pressure", pressure)));
    let factors =
        ["tx", "ty"].into_iter().zip(&load.fields).filter_map(|(key, field)| Some((key, field.as_ref()?.factor()?)));
    loads.map(|(key, load)| (key, largest(load))).chain(factors).map(|(key, value)| (name(key), value)).collect()
}

/// What varies of a load: both parts of a profile do, by the same factor.
fn largest(load: &LoadProfile) -> &TimeValue {
    if load.top.is_zero() { &load.gradient } else { &load.top }
}

/// The values of a load on the surface.
fn of_surface<'a>(case: &Case, load: &'a SurfaceLoad) -> Vec<(String, &'a TimeValue)> {
    let place = load.region.map_or("all", |region| &case.regions[region].name);
    let name = |key: &str| format!("`{key}` of the load on the surface of `{place}`");
    let mut values = vec![(name("shear"), &load.shear)];
    values.extend([0, 1].map(|d| (name(["tx", "ty"][d]), &load.components[d])));
    if let Some(pressure) = &load.pressure {
        values.push((name("pressure"), largest(pressure)));
    }
    values
}

/// The levels of the water in phase `k`.
fn levels(case: &Case, k: usize) -> Vec<(String, &TimeValue)> {
    let Some(water) = &case.water else { return Vec::new() };
    let outside = water.level.as_ref().and_then(|levels| levels.get(k));
    let in_pores = water.phreatic.as_ref().and_then(|tables| tables.get(k)?.level());
    let values = [("the water level", outside), ("the phreatic level", in_pores)];
    values.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
}

/// A warning for each table with times after the end of phase `k`.
fn beyond(case: &Case, k: usize) -> Vec<String> {
    let phase = &case.phases[k];
    let end = phase.duration;
    let is_after = |time: f64| time > end * (1.0 + 1e-9);
    let tables = values(case, k).into_iter().filter_map(|(what, value)| match value {
        TimeValue::Table(table) if table.len() > 1 && is_after(table[table.len() - 1][0]) => Some((what, table, value)),
        _ => None,
    });
    let said = |(what, table, value): (String, &Vec<[f64; 2]>, &TimeValue)| {
        let [last, of] = table[table.len() - 1];
        let reaches = if is_after(table[0][0]) || table[0][0] >= end * (1.0 - 1e-9) {
            format!("all of it is after the end, and the value is {} throughout", table[0][1])
        } else {
            format!("at the end the value is {}, and {of} is not reached", value.at(end))
        };
        format!(
            "warning: phase `{}`: the table of {what} goes to {last} s, and the phase ends at {end} s: {reaches}; times are those since the phase \
             began, so begin at 0, or lengthen the phase",
            phase.name
        )
    };
    tables.map(said).collect()
}

/// A warning for each load that varies in phase `k` and begins with another value than the phase before has ended with.
fn begin_anew(case: &Case, k: usize) -> Vec<String> {
    let phase = &case.phases[k];
    let mut warnings = Vec::new();
    let mut compare = |what: String, ended: f64, now: &TimeValue, before: &str| {
        // Without the sign of a zero.
        let begins = now.at(0.0) + 0.0;
        let varies = !matches!(now, TimeValue::Constant(_)) && !now.is_zero();
        let size = ended.abs().max(begins.abs());
        if varies && ended != 0.0 && (begins - ended).abs() > 1e-9 * size {
            let to = ended + now.at(phase.duration) - begins;
            warnings.push(format!(
                "warning: phase `{}`: {what} begins with {begins}, and {before} {ended}: it changes to {begins} in the first step; values are in the \
                 time of their phase, so to go on write `{{table: [[0, {ended}], [{}, {to}]]}}`",
                phase.name, phase.duration
            ));
        }
    };
    let Some(last) = k.checked_sub(1).map(|k| &case.phases[k]) else {
        if case.k0.is_some() && case.gravity != [0.0; 2] {
            match &phase.gravity {
                Gravity::Scaled { factor, .. } => {
                    let before = "the initial stress is that under gravity with the factor";
                    compare("gravity".to_owned(), 1.0, factor, before);
                }
                Gravity::Components(components) => {
                    for (d, now) in components.iter().enumerate() {
                        let before = "the initial stress is that under gravity with";
                        compare(format!("`{}` of gravity", AXES[d]), case.gravity[d], now, before);
                    }
                }
            }
        }
        return warnings;
    };
    let before = format!("phase `{}` has ended with", last.name);
    if case.gravity != [0.0; 2] {
        match (&last.gravity, &phase.gravity) {
            (Gravity::Scaled { factor: ended, .. }, Gravity::Scaled { factor, .. }) => {
                compare("the factor on gravity".to_owned(), ended.at(last.duration), factor, &before);
            }
            (ended, now) => {
                for d in 0..2 {
                    let what = format!("`{}` of gravity", AXES[d]);
                    compare(what, ended.at(last.duration)[d], &now.component(d), &before);
                }
            }
        }
    }
    for (what, now) in levels(case, k) {
        let value = levels(case, k - 1).into_iter().find(|(other, _)| *other == what);
        if let Some((_, value)) = value {
            compare(what, value.at(last.duration), now, &before);
        }
    }
    for load in &phase.tractions {
        let here = |other: &&Traction| other.curve == load.curve;
        let Some(other) = one(last.tractions.iter().filter(here)) else { continue };
        for ((what, now), (other, ended)) in of_curve(load).into_iter().zip(of_curve(other)) {
            if what == other {
                compare(what, ended.at(last.duration), now, &before);
            }
        }
    }
    for load in &phase.surface_loads {
        let here = |other: &&SurfaceLoad| other.region == load.region && other.within == load.within;
        let Some(other) = one(last.surface_loads.iter().filter(here)) else { continue };
        for ((what, now), (other, ended)) in of_surface(case, load).into_iter().zip(of_surface(case, other)) {
            if what == other {
                compare(what, ended.at(last.duration), now, &before);
            }
        }
    }
    warnings
}

/// The only one of some loads.
fn one<'a, T>(mut loads: impl Iterator<Item = &'a T>) -> Option<&'a T> {
    loads.next().filter(|_| loads.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// A case of a block with the entries of a case, and its phases, of a second each.
    fn case(entries: &str, phases: &[&str]) -> Case {
        let phase = |(k, more): (usize, &&str)| {
            format!("  - {{name: p{k}, analysis: quasi_static, duration: 1, step: {{initial: 1}}{more}}}\n")
        };
        let phases: String = phases.iter().enumerate().map(phase).collect();
        let text = format!(
            "geometry: axisymmetric\nmesh: {{geo: Cargo.toml}}\nregions: {{clay: {{kind: mpm, material: clay}}}}\n\
             materials: {{clay: {{model: linear_elastic, young: 1, poisson: 0, density: 1}}}}\n{entries}\nphases:\n{phases}"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        case.unwrap()
    }

    const GRAVITY: &str = "gravity: {y: -9.81}";

    #[test]
    fn tables_beyond_the_end_of_their_phase_are_told() {
        let load = |table: &str| {
            of_case(&case("", &["", &format!(", tractions: [{{surface: all, ty: {{table: {table}}}}}]")]))
        };
        for table in ["[[0, 0], [1, -80]]", "[[0, 0], [0.5, -80]]", "[[0, -80]]"] {
            assert!(load(table).is_empty(), "{table}");
        }
        let [after] = load("[[4, 0], [5, -80]]").try_into().unwrap();
        assert!(
            after.contains("phase `p1`: the table of `ty` of the load on the surface of `all` goes to 5 s")
                && after.contains("the value is 0 throughout"),
            "{after}"
        );
        let [cut] = load("[[0, 0], [2, -80]]").try_into().unwrap();
        assert!(cut.contains("at the end the value is -40, and -80 is not reached"), "{cut}");
        let water = case("water: {level: {table: [[0, 4], [3, 1]]}}", &[""]);
        assert!(of_case(&water)[0].contains("the table of the water level goes to 3 s"), "{:?}", of_case(&water));
    }

    #[test]
    fn loads_that_begin_anew_are_told_and_no_others() {
        let gravity = |first: &str, second: &str| of_case(&case(GRAVITY, &[first, second]));
        for second in ["", ", gravity: 2", ", gravity: {table: [[0, 1], [1, 2]]}"] {
            assert!(gravity(", gravity: {rate: 1}", second).is_empty(), "{second}");
        }
        let [anew] = gravity(", gravity: {rate: 1}", ", gravity: {rate: 1}").try_into().unwrap();
        assert!(
            anew.contains("phase `p1`: the factor on gravity begins with 0, and phase `p0` has ended with 1")
                && anew.contains("{table: [[0, 1], [1, 2]]}"),
            "{anew}"
        );
        let k0 = case(&format!("{GRAVITY}\ninitial_stress: {{k0: 1}}"), &[", gravity: {rate: 1}"]);
        assert!(of_case(&k0)[0].contains("the initial stress is that under gravity"), "{:?}", of_case(&k0));
        let loads = |first: &str, second: &str| {
            of_case(&case(
                "",
                &[first, second]
                    .map(|load| format!(", tractions: [{{surface: all, {load}}}]"))
                    .each_ref()
                    .map(|p| &**p),
            ))
        };
        assert!(loads("ty: {rate: -40}", "ty: -40").is_empty() && loads("ty: {rate: -40}", "tx: {rate: 1}").is_empty());
        assert!(loads("ty: {rate: -40}, where: {x: [0, 1]}", "ty: {rate: -40}").is_empty());
        let [anew] = loads("ty: {rate: -40}", "ty: {rate: -10}").try_into().unwrap();
        assert!(
            anew.contains("begins with 0") && anew.contains("ended with -40") && anew.contains("[1, -50]"),
            "{anew}"
        );
        let level = case("water: {level: {table: [[0, 4], [1, 1]]}}", &["", ""]);
        let [anew] = of_case(&level).try_into().unwrap();
        assert!(anew.contains("the water level begins with 4") && anew.contains("ended with 1"), "{anew}");
        let load = "{surface: all, ty: -40}";
        let two = |other: &str| of_case(&case("", &[&format!(", tractions: [{load}, {other}]")]));
        assert!(two("{surface: all, ty: -41}").is_empty());
        assert!(two(load)[0].contains("is given twice"), "{:?}", two(load));
        for second in [", gravity: {x: {rate: 1}}", ", gravity: {x: 1, y: {table: [[0, -9.81], [1, -5]]}}", ""] {
            assert!(gravity(", gravity: {rate: 1}", second).is_empty(), "{second}");
        }
        let [anew] = gravity(", gravity: {x: {rate: 2}}", ", gravity: {x: {rate: 1}}").try_into().unwrap();
        assert!(anew.contains("`x` of gravity begins with 0, and phase `p0` has ended with 2"), "{anew}");
        let [anew] = gravity(", gravity: {x: 2}", ", gravity: {rate: 1}").try_into().unwrap();
        assert!(anew.contains("`y` of gravity begins with 0, and phase `p0` has ended with -9.81"), "{anew}");
        let [after] = gravity("", ", gravity: {x: {table: [[0, 0], [5, 1]]}}").try_into().unwrap();
        assert!(after.contains("the table of `x` of `gravity` goes to 5 s"), "{after}");
        let [nothing] = of_case(&case("", &[", gravity: {rate: 1}"])).try_into().unwrap();
        assert!(nothing.contains("there is no gravity"), "{nothing}");
    }

    #[test]
    fn loads_on_curves_that_take_up_none_are_told() {
        let mut mesh = rectangle(CellKind::T6, 1.0, 1.0, 2, 2, 0.0, 0);
        mesh.regions = vec!["clay".into()];
        let entries = "supports: {left: {ux: 0}, bottom: {uy: 0}}\nnumerics: {restore: never}";
        let told = |load: &str| on_mesh(&case(entries, &[&format!(", tractions: [{load}]")]), &mesh);
        assert!(told("{on: top, ty: -1}").is_empty() && told("{on: bottom, tx: 1}").is_empty());
        let [axis] = told("{on: left, ty: -1}").try_into().unwrap();
        assert!(axis.contains("the traction on `left` does nothing") && axis.contains("axis of symmetry"), "{axis}");
        let [held] = told("{on: bottom, tx: 1, ty: -1}").try_into().unwrap();
        assert!(held.contains("`ty` of the traction on `bottom` does nothing to the soil"), "{held}");
    }
}
