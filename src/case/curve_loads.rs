//! The terms of loads on curves, dead tractions and pressures that follow their curve, and of forces at points.

use super::checked::{Case, LoadField, Restore, Traction as Load};
use super::find::{group, regions};
use super::parts;
use super::rigid::body_of;
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh};
use crate::rigid::Body;
use crate::term::{
    Course, FacetPressure, FormulaTraction, Formulas, Hydrostatic, RigidFormulaTraction, RigidPressure, RigidTraction,
    Sample, Term, Traction, samples,
};
use crate::time_value::TimeValue;
use std::collections::{BTreeSet, HashMap, HashSet};

type Terms = Vec<Box<dyn Term<2>>>;

/// What nodes have of a load: the shares, and the value in time of which these are.
type DeadLoad = (Vec<(u32, f64)>, [TimeValue; 2]);

/// A side of a cell.
type Side = (u32, u8);

/// The loads on curves of all phases, with the number of the phase.
fn all(case: &Case) -> impl Iterator<Item = (usize, &Load)> {
    case.phases.iter().enumerate().flat_map(|(i, phase)| phase.tractions.iter().map(move |load| (i, load)))
}

/// The terms on bodies that deform: those of the grid, and those of the finite elements.
///
/// # Errors
/// Input: a curve that the mesh lacks, that does not move with the material, or that has soil on both sides where a pressure acts.
pub fn terms<K: Kinematics<2>>(
    case: &Case,
    (mesh, fem): (&Mesh<2>, Option<&Mesh<2>>),
    rigid: &[Body<2>],
) -> Result<[Terms; 2]> {
    let [mut on_grid, mut on_elements] = [Terms::new(), Terms::new()];
    for (phase, load) in all(case).filter(|(_, load)| !rigid.iter().any(|body| body_of(mesh, body, &load.curve))) {
        let place = || format!("the load on `{}` in phase `{}`", load.curve, case.phases[phase].name);
        let curve = match load.force {
            Some(_) => group(mesh, &load.curve)?,
            None => parts::material_curve(case, (mesh, fem), &load.curve, place)?,
        };
        if load.force.is_some() {
            check_point(case, (mesh, fem), curve, place)?;
        }
        check_order(load, curve, place)?;
        for (shares, value) in dead::<K>(load, mesh, curve) {
            on_grid.push(Box::new(Traction::<K, 2>::of_shares(shares, phase, value)));
        }
        if let Some((samples, formulas)) = by_formula::<K>(load, mesh, curve, place)? {
            on_grid.push(Box::new(FormulaTraction::new(samples, phase, formulas)));
        }
        let Some(pressure) = &load.pressure else { continue };
        let heads = heads(case, phase, pressure.head(0.0));
        let [of_grid, of_elements] = loaded(case, (mesh, fem), curve, place)?;
        if !of_grid.is_empty() {
            on_grid.push(Box::new(FacetPressure::<K>::on(of_grid, heads.clone())));
        }
        if !of_elements.is_empty() {
            on_elements.push(Box::new(FacetPressure::<K>::on(of_elements, heads)));
        }
    }
    Ok([on_grid, on_elements])
}

/// The terms on the rigid body with that number in the scene, given the part of the mesh with it.
///
/// # Errors
/// Input: a curve that the mesh lacks.
pub fn on_rigid<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>, (body, number): (&Body<2>, usize)) -> Result<Terms> {
    let mut terms = Terms::new();
    for (phase, load) in all(case).filter(|(_, load)| body_of(mesh, body, &load.curve)) {
        let curve = group(mesh, &load.curve)?;
        for (shares, value) in dead::<K>(load, mesh, curve) {
            terms.push(Box::new(RigidTraction::new(body, &mesh.nodes, &shares, phase, value)));
        }
        let place = || format!("the load on `{}` in phase `{}`", load.curve, case.phases[phase].name);
        if let Some((samples, formulas)) = by_formula::<K>(load, mesh, curve, place)? {
            terms.push(Box::new(RigidFormulaTraction::new(body, &samples, phase, formulas)));
        }
        if let Some(pressure) = &load.pressure {
            let facets: Vec<Side> = sides(mesh, curve, |region| region == body.region)
                .into_iter()
                .flat_map(|sides| sides.first().copied())
                .collect();
            let heads = heads(case, phase, pressure.head(0.0));
            terms.push(Box::new(RigidPressure::<K>::on((body, number), mesh, &facets, heads)));
        }
    }
    Ok(terms)
}

/// The dead parts of a load on a curve or at the nodes of a point.
fn dead<K: Kinematics<2>>(load: &Load, mesh: &Mesh<2>, curve: &Group) -> Vec<DeadLoad> {
    if let Some(force) = &load.force {
        return vec![(curve.nodes.iter().map(|&n| (n, 1.0)).collect(), force.clone())];
    }
    let none = || TimeValue::Constant(0.0);
    let [x, y] = &load.components;
    let mut parts = vec![
        (Course::Uniform, [x.top.clone(), y.top.clone()]),
        (Course::Depth(x.datum), [x.gradient.clone(), none()]),
        (Course::Depth(y.datum), [none(), y.gradient.clone()]),
    ];
    for (d, field) in load.fields.iter().enumerate() {
        let Some(LoadField::Along { axis, values, factor }) = field else { continue };
        let mut value = [none(), none()];
        value[d] = factor.clone();
        parts.push((Course::Table(*axis, values.clone()), value));
    }
    parts.retain(|(_, value)| value.iter().any(|value| !value.is_zero()));
    parts.into_iter().map(|(course, value)| (Traction::<K, 2>::shares(mesh, curve, &course), value)).collect()
}

/// The formulas of a load on a curve, with the places where they are taken.
///
/// # Errors
/// Input: one that has no value as the phase begins.
fn by_formula<K: Kinematics<2>>(
    load: &Load,
    mesh: &Mesh<2>,
    curve: &Group,
    place: impl Fn() -> String,
) -> Result<Option<(Vec<Sample<2>>, Formulas)>> {
    let formula = |field: &Option<LoadField>| match field {
        Some(LoadField::Formula(formula)) => Some(formula.clone()),
        _ => None,
    };
    let formulas = Formulas(load.fields.each_ref().map(formula));
    if formulas.0.iter().all(Option::is_none) {
        return Ok(None);
    }
    let samples = samples::<K, 2>(mesh, curve, &Course::Free);
    for sample in &samples {
        formulas.at(&sample.place, 0.0).map_err(|e| Error::input(place(), e.problem, e.remedy))?;
    }
    Ok(Some((samples, formulas)))
}

/// The nodes of the grid at whose soil forces act, where the grid is reset.
pub fn loaded_nodes(case: &Case, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> BTreeSet<u32> {
    if case.numerics.solver.restore == Restore::Never {
        return BTreeSet::new();
    }
    let of_elements: HashSet<u32> = fem.iter().flat_map(|fem| &fem.cells.nodes).copied().collect();
    let points = all(case).filter(|(_, load)| load.force.is_some()).filter_map(|(_, load)| mesh.group(&load.curve));
    points.flat_map(|point| point.nodes.iter().copied()).filter(|n| !of_elements.contains(n)).collect()
}

/// Refuses a force at a point of the grid that is in no soil.
fn check_point(
    case: &Case,
    (mesh, fem): (&Mesh<2>, Option<&Mesh<2>>),
    point: &Group,
    place: impl Fn() -> String,
) -> Result<()> {
    let filled = regions(case, mesh, |content| content.material().is_some());
    let soil = (0..mesh.cells.len()).filter(|&c| filled[usize::from(mesh.cells.region[c])]);
    let mut of: HashSet<u32> = soil.flat_map(|c| mesh.cells.nodes(c)).copied().collect();
    of.extend(fem.iter().flat_map(|fem| &fem.cells.nodes));
    if point.nodes.iter().all(|n| of.contains(n)) {
        return Ok(());
    }
    let remedy = "take a point of soil or of a structure";
    Err(Error::input(place(), "there is no soil and no structure at the point", remedy))
}

/// A pressure in one phase.
fn heads(case: &Case, phase: usize, pressure: Hydrostatic) -> Vec<Option<Hydrostatic>> {
    let mut heads = vec![None; case.phases.len()];
    heads[phase] = Some(pressure);
    heads
}

/// The integrals of what follows the curve, or varies along it, are those of cells of first and second order.
fn check_order(load: &Load, curve: &Group, place: impl Fn() -> String) -> Result<()> {
    let has_gradient = load.components.iter().any(|component| !component.gradient.is_zero());
    let varies = load.pressure.is_some() || has_gradient || load.fields.iter().any(Option::is_some);
    if varies && curve.facets.iter().any(|(kind, _)| kind.order() > 2) {
        return Err(Error::input(
            place(),
            "on cells of third order a load on a curve is a traction that does not vary from place to place",
            "set `order: 2` under `mesh`",
        ));
    }
    Ok(())
}

/// The sides of cells that a pressure on a curve acts on: those of soil in the grid, and those of finite elements that deform.
///
/// # Errors
/// Input: a curve with soil or elements on both sides, or on none.
fn loaded(
    case: &Case,
    (mesh, fem): (&Mesh<2>, Option<&Mesh<2>>),
    curve: &Group,
    place: impl Fn() -> String,
) -> Result<[Vec<Side>; 2]> {
    let filled = |mesh: &Mesh<2>| regions(case, mesh, |content| content.material().is_some() && !content.is_rigid());
    let beside = |mesh: &Mesh<2>| {
        let filled = filled(mesh);
        sides(mesh, curve, |region| filled[usize::from(region)])
    };
    let (of_grid, of_elements) = (beside(mesh), fem.map(beside).unwrap_or_default());
    let mut loaded = [Vec::new(), Vec::new()];
    for i in 0..curve.facets.len() {
        let [grid, elements] = [&of_grid, &of_elements].map(|sides| sides.get(i).map_or(&[][..], Vec::as_slice));
        match (grid, elements) {
            (&[side], []) => loaded[0].push(side),
            ([], &[side]) => loaded[1].push(side),
            _ => {
                let problem = if grid.is_empty() && elements.is_empty() {
                    "there is no soil or structure beside the curve for the pressure"
                } else {
                    "soil or elements are on both sides of the curve, and a pressure acts on one"
                };
                let remedy = "load a curve on the boundary of what is loaded, or give `tx` and `ty`";
                return Err(Error::input(place(), problem, remedy));
            }
        }
    }
    Ok(loaded)
}

/// The sides of the cells of some regions at each facet of a curve.
fn sides(mesh: &Mesh<2>, curve: &Group, wanted: impl Fn(u16) -> bool) -> Vec<Vec<Side>> {
    let ends = |a: u32, b: u32| [a.min(b), a.max(b)];
    let number: HashMap<[u32; 2], usize> =
        curve.facets.iter().enumerate().map(|(i, (_, nodes))| (ends(nodes[0], nodes[1]), i)).collect();
    let mut found = vec![Vec::new(); curve.facets.len()];
    for c in (0..mesh.cells.len()).filter(|&c| wanted(mesh.cells.region[c])) {
        let nodes = mesh.cells.nodes(c);
        for (side, facet) in mesh.cells.kind[c].facets().1.iter().enumerate() {
            if let Some(&i) = number.get(&ends(nodes[facet[0]], nodes[facet[1]])) {
                found[i].push((c as u32, side as u8));
            }
        }
    }
    found
}

/// Whether a pressure on a curve has a part in a direction: some of the curve is not along it.
pub fn presses(mesh: &Mesh<2>, curve: &Group, direction: usize) -> bool {
    curve.facets.iter().any(|(_, nodes)| {
        let [a, b] = [nodes[0], nodes[1]].map(|n| mesh.nodes[n as usize]);
        let way = [b[0] - a[0], b[1] - a[1]];
        way[1 - direction].abs() > SAME * way[0].hypot(way[1])
    })
}
