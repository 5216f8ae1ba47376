//! Curves on springs and dashpots, and curves that waves leave through: dashpots in phases with inertia, supports in others.

use super::check::Checker;
use super::checked::{Case, Content, Material, Restore, Support};
use super::find::{filled, group, region_index};
use super::locate::{At, Path};
use super::raw;
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh, height};
use crate::step::Fixed;
use crate::term::{Course, Spring, samples};
use std::collections::{BTreeMap, BTreeSet};

/// A side of a cell.
type Facet = (crate::mesh::shape::CellKind, Vec<u32>);

impl Checker {
    /// The springs, or the dashpots, at `path`: across the curve and along it.
    pub(super) fn yielding(&mut self, given: Option<raw::Yielding>, path: &Path) -> Option<[f64; 2]> {
        let values = given.map(|given| [given.normal, given.tangential])?;
        if values == [0.0; 2] {
            self.issue(path, At::Key, "both are 0", "give `normal` or `tangential` a value, or take it out");
        }
        Some(values)
    }

    /// Refuses springs and dashpots that have nothing to do, or nothing to act on.
    pub(super) fn on_springs(&mut self, file: &raw::CaseFile, curve: &str, held: &raw::Components, path: &Path) {
        let named =
            [("absorbing", held.absorbing), ("dashpots", held.dashpots.is_some()), ("springs", held.springs.is_some())];
        let Some(key) = named.iter().find(|(_, there)| *there).map(|(key, _)| key) else { return };
        let path = path.key(key);
        if held.absorbing && held.dashpots.is_some() {
            let remedy = "take one of the two out: `absorbing` has the dashpots of the soil beside the curve";
            self.issue(&path, At::Key, "`dashpots` are given as well", remedy);
        }
        if *key != "springs" {
            self.damped(file, held, &path);
        }
        if held.un.is_some() || held.rotation.is_some() || held.ux.is_some() && held.uy.is_some() {
            let remedy = "leave at least one of `ux` and `uy` out, and `un` and `rotation`";
            let problem = match *key {
                "absorbing" => "a curve that is held does not absorb",
                _ => "a curve that is held does not move against springs and dashpots",
            };
            self.issue(&path, At::Key, problem, remedy);
        }
        if file.regions.contains_key(curve) {
            let problem = "springs and dashpots are under a physical curve";
            self.issue(&path, At::Key, problem, "name the curve in place of the region");
        }
        if let Some(i) = file.phases.iter().position(|phase| phase.prescribe.contains_key(curve)) {
            let problem = format!("phase `{}` prescribes the displacement of `{curve}`", file.phases[i].name);
            let remedy =
                "take one of the two out; an incoming wave of the velocity v is a traction of 2ρcv on the curve";
            self.issue(&path, At::Key, problem, remedy);
        }
        if file.numerics.gradient == "bspline" {
            let remedy = "choose `gradient: mpm`";
            self.issue(&path, At::Key, "springs and dashpots act on nodes, and splines have none", remedy);
        }
    }

    /// Refuses dashpots without a phase in which they act, and phases that cannot tell whether they do.
    fn damped(&mut self, file: &raw::CaseFile, held: &raw::Components, path: &Path) {
        let is = |kind| move |phase: &raw::Phase| phase.analysis == kind;
        let is_auto = file.phases.iter().any(is(raw::Analysis::Auto));
        if !is_auto && !file.phases.iter().any(is(raw::Analysis::Dynamic)) {
            let remedy = "take it out, or make a phase `analysis: dynamic`";
            self.issue(path, At::Key, "no phase has waves", remedy);
        }
        let is_borne = held.springs.is_some_and(|springs| springs.normal > 0.0 && springs.tangential > 0.0);
        if is_auto && !is_borne {
            let remedy = "choose quasi_static or dynamic for each phase, or give `springs` both ways";
            self.issue(path, At::Key, "an `auto` phase cannot tell when the curve is to be held", remedy);
        }
    }
}

/// The curves on springs and dashpots.
fn curves(case: &Case) -> impl Iterator<Item = &Support> {
    case.supports.iter().filter(|support| support.is_yielding())
}

/// The components in which curves with dashpots are free in phases with inertia, and held in others: those with a dashpot and without a spring.
///
/// # Errors
/// Input: a curve that the mesh lacks.
pub fn held(case: &Case, mesh: &Mesh<2>, springs: &[Spring<2>], ties: &[[u32; 2]]) -> Result<Vec<Fixed>> {
    let tied = tied(ties);
    let of = |n: u32| {
        let n = *tied.get(&n).unwrap_or(&n);
        springs.binary_search_by_key(&n, |spring| spring.node).ok().map(|i| &springs[i])
    };
    let mut fixed = Vec::new();
    for support in curves(case).filter(|support| support.absorbing || support.dashpots.is_some()) {
        let nodes = &group(mesh, &support.curve)?.nodes;
        for component in (0..2).filter(|&d| !support.fixed[d]) {
            let is_held = |n: &u32| {
                let [elastic, damped] = of(*n).map_or([false; 2], |spring| {
                    [&spring.stiffness, &spring.damping].map(|matrix| matrix[component][component] != 0.0)
                });
                !elastic && (damped || support.absorbing)
            };
            fixed.push(Fixed { nodes: nodes.iter().copied().filter(is_held).collect(), component });
        }
    }
    fixed.retain(|fixed| !fixed.nodes.is_empty());
    Ok(fixed)
}

/// The node that each tied one follows.
fn tied(ties: &[[u32; 2]]) -> BTreeMap<u32, u32> {
    ties.iter().map(|&[follows, followed]| (follows, followed)).collect()
}

/// The springs and dashpots of all curves, by node; a node that follows another in `ties` has its own there.
///
/// # Errors
/// Input: a curve that is inclined and would have to be held, or does not bound soil or finite elements.
pub fn springs<K: Kinematics<2>>(case: &Case, meshes: [&Mesh<2>; 2], ties: &[[u32; 2]]) -> Result<Vec<Spring<2>>> {
    let tied = tied(ties);
    let mut springs: BTreeMap<u32, Spring<2>> = BTreeMap::new();
    for support in curves(case) {
        let (curve, mut acts) = (group(meshes[0], &support.curve)?, false);
        for facet in &curve.facets {
            let beside = beside(meshes, facet);
            let is_empty = |r: &u16| case.content(&meshes[0].regions[usize::from(*r)]) == Some(Content::Buffer);
            let [stiffness, damping] = resistance(case, meshes, support, facet, &beside)?;
            if beside.iter().all(is_empty) {
                // The side of the air above soil: springs support soil that comes there.
                if support.springs.is_none() && support.dashpots.is_none() {
                    continue;
                }
            } else {
                acts = true;
            }
            let single = Group { facets: vec![facet.clone()], ..curve.clone() };
            for (n, share) in samples::<K, 2>(meshes[0], &single, &Course::Uniform).into_iter().flat_map(|s| s.shares) {
                let n = *tied.get(&n).unwrap_or(&n);
                let none = || Spring { node: n, stiffness: [[0.0; 2]; 2], damping: [[0.0; 2]; 2] };
                let spring = springs.entry(n).or_insert_with(none);
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().filter(|&(i, j)| {
                    // What is held moves against nothing.
                    !support.fixed[i] && !support.fixed[j]
                }) {
                    spring.stiffness[i][j] += share * stiffness[i][j];
                    spring.damping[i][j] += share * damping[i][j];
                }
            }
        }
        if !acts {
            return Err(Error::input(
                support.place(),
                "no soil is beside the curve",
                "take it out, or name a boundary of soil or of a structure that deforms",
            ));
        }
    }
    Ok(springs.into_values().collect())
}

/// The nodes of springs whose material is to be followed through grid resets.
pub fn followed(case: &Case, fem: Option<&Mesh<2>>, springs: &[Spring<2>]) -> Vec<u32> {
    if case.numerics.solver.restore == Restore::Never {
        return Vec::new();
    }
    let of_elements: BTreeSet<u32> = fem.iter().flat_map(|fem| fem.cells.nodes.iter().copied()).collect();
    let on_grid = springs.iter().filter(|s| s.is_elastic() && !of_elements.contains(&s.node));
    on_grid.map(|spring| spring.node).collect()
}

/// The regions of the cells beside a facet.
fn beside(meshes: [&Mesh<2>; 2], (_, nodes): &Facet) -> Vec<u16> {
    let has = |mesh: &Mesh<2>, c: usize| {
        let of = mesh.cells.nodes(c);
        of.contains(&nodes[0]) && of.contains(&nodes[1])
    };
    let beside = |mesh: &Mesh<2>| -> Vec<u16> {
        (0..mesh.cells.len()).filter(|&c| has(mesh, c)).map(|c| mesh.cells.region[c]).collect()
    };
    if std::ptr::eq(meshes[0], meshes[1]) { beside(meshes[0]) } else { meshes.map(beside).concat() }
}

/// What a facet resists a displacement (kPa/m) and a velocity (kPa s/m).
fn resistance(
    case: &Case,
    meshes: [&Mesh<2>; 2],
    support: &Support,
    (_, nodes): &Facet,
    beside: &[u16],
) -> Result<[[[f64; 2]; 2]; 2]> {
    let [a, b] = [nodes[0], nodes[1]].map(|n| meshes[0].nodes[n as usize]);
    let way = [b[0] - a[0], b[1] - a[1]];
    let level = (0..2).find(|&d| way[d].abs() <= SAME * way[1 - d].abs());
    let springs = support.springs.unwrap_or_default();
    let is_damped = support.absorbing || support.dashpots.is_some();
    if level.is_none() && is_damped && springs.contains(&0.0) {
        let problem = "the curve is inclined, and without springs both ways it is held across or along level and vertical curves where nothing moves";
        return Err(Error::input(
            support.place(),
            problem,
            "draw a level or vertical boundary there, or give `springs` both `normal` and `tangential`",
        ));
    }
    let is_rigid =
        |r: &u16| case.content(&meshes[0].regions[usize::from(*r)]).is_some_and(|content| content.is_rigid());
    if beside.iter().any(is_rigid) {
        return Err(Error::input(
            support.place(),
            format!("at [{:.3}, {:.3}] m a rigid structure is beside the curve", a[0], a[1]),
            "name curves of soil or of structures that deform; a rigid structure is held by `bars`",
        ));
    }
    let dashpots = match (support.dashpots, support.absorbing) {
        (Some(dashpots), _) => dashpots,
        (None, true) => impedance(case, meshes, support, f64::midpoint(height(&a), height(&b)), (&a, beside))?,
        (None, false) => [0.0; 2],
    };
    let length = way[0].hypot(way[1]);
    let across = match level {
        Some(d) => std::array::from_fn(|i| f64::from(u8::from(i == d))),
        None => [-way[1] / length, way[0] / length],
    };
    let along = [-across[1], across[0]];
    Ok([springs, dashpots].map(|[normal, tangential]| {
        [0, 1].map(|i| [0, 1].map(|j| normal * across[i] * across[j] + tangential * along[i] * along[j]))
    }))
}

/// What the soil beside a facet at the height `y` (m) resists a velocity (kPa s/m): ρ c_p across it, ρ c_s along it.
fn impedance(
    case: &Case,
    meshes: [&Mesh<2>; 2],
    support: &Support,
    y: f64,
    (at, regions): (&[f64; 2], &[u16]),
) -> Result<[f64; 2]> {
    let is_empty = |r: u16| case.content(&meshes[0].regions[usize::from(r)]) == Some(Content::Buffer);
    if regions.len() == 1 && is_empty(regions[0]) {
        // The side of the air above soil.
        return Ok([0.0; 2]);
    }
    let material = filled(case).find(|(region, _)| {
        let number = region_index(meshes[0], &region.name).ok();
        matches!(region.content, Content::Mpm { .. } | Content::Fem { .. }) && number.is_some_and(|n| regions == [n])
    });
    let Some((_, material)) = material else {
        return Err(Error::input(
            support.place(),
            format!("at [{:.3}, {:.3}] m it is not the boundary of soil", at[0], at[1]),
            "let only curves absorb that have soil on one side and nothing on the other",
        ));
    };
    Ok(impedance_of(material, y))
}

/// ρ c_p and ρ c_s of a material at a height (m), in kPa s/m.
fn impedance_of(material: &Material, y: f64) -> [f64; 2] {
    let (density, moduli) = (material.density.at(y), material.model.elasticity().at(y));
    [moduli.lambda + 2.0 * moduli.shear, moduli.shear].map(|modulus| (density * modulus).sqrt())
}

impl Support {
    /// Whether it has springs or dashpots.
    pub fn is_yielding(&self) -> bool {
        self.absorbing || self.springs.is_some() || self.dashpots.is_some()
    }

    /// Where its springs or dashpots are given.
    fn place(&self) -> String {
        let key = match (self.absorbing, self.dashpots) {
            (true, _) => "absorbing",
            (false, Some(_)) => "dashpots",
            (false, None) => "springs",
        };
        format!("supports.{}.{key}", self.curve)
    }
}
