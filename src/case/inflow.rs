//! Curves through which soil enters the model: what a case says of them, checked, and where they are on the boundary of the mesh.

use super::changes;
use super::check::Checker;
use super::checked::{Case, Content, Inflow, Numerics, Restore};
use super::find::group;
use super::locate::{At, Path};
use super::outflow::{boundary_sides, unfit};
use super::raw::{self, Analysis, Quadrature, RegionKind};
use crate::error::{Error, Result};
use crate::geometry::{Line, distance, nearest};
use crate::mesh::locate::Locator;
use crate::mesh::side::Side;
use crate::mesh::{Mesh, quality::SAME};
use crate::step;
use crate::time_value::TimeValue;

impl Checker {
    /// The soil that enters in a phase.
    pub(super) fn inflows(
        &mut self,
        phase: &raw::Phase,
        (file, numerics): (&raw::CaseFile, &Numerics),
        path: &Path,
    ) -> Vec<Inflow> {
        let mut inflows = Vec::new();
        if !phase.inflow.is_empty() {
            self.can_enter(phase, (file, numerics), path);
        }
        for (curve, raw::Inflow { region, velocity }) in &phase.inflow {
            let path = path.key(curve);
            let at = path.key("region");
            match file.regions.get(region).map(|region| region.kind) {
                Some(RegionKind::Mpm) => {}
                Some(_) => {
                    let remedy = "give the region `kind: mpm`";
                    self.issue(&at, At::Value, format!("`{region}` is not of kind mpm"), remedy);
                }
                None => {
                    self.region_named(file, region, &at);
                }
            }
            let at = path.key("velocity");
            let velocity = self.in_time(velocity, &at);
            let backwards = match &velocity {
                TimeValue::Constant(value) | TimeValue::Rate(value) => *value <= 0.0,
                TimeValue::Record(_) => true,
                TimeValue::Table(table) => table.iter().any(|[_, value]| *value < 0.0),
            };
            if backwards || velocity.is_zero() {
                let problem = "soil enters with a velocity above 0, positive into the mesh";
                self.issue(&at, At::Value, problem, "give a number above 0, or a table of such");
            }
            if file.supports.contains_key(curve) {
                let problem = format!("`{curve}` has an entry under `supports`, and soil enters through a free curve");
                self.issue(&path, At::Key, problem, "take one of the two out");
            }
            if phase.prescribe.contains_key(curve) || file.contacts.iter().any(|c| c.wall.as_ref() == Some(curve)) {
                let problem = format!("`{curve}` is prescribed or a wall, and soil enters through a free curve");
                self.issue(&path, At::Key, problem, "take one of the two out");
            }
            inflows.push(Inflow { curve: curve.clone(), region: region.clone(), velocity });
        }
        let regions: Vec<String> = inflows.iter().map(|inflow| inflow.region.clone()).collect();
        if !regions.is_empty() {
            self.is_empty_at_first(file, &regions);
        }
        inflows
    }

    fn can_enter(&mut self, phase: &raw::Phase, (file, numerics): (&raw::CaseFile, &Numerics), path: &Path) {
        if phase.analysis != Analysis::Dynamic {
            let problem = "soil that enters moves, and the phase has no inertia";
            self.issue(path, At::Key, problem, "choose `analysis: dynamic`, or fill regions by `place`");
        }
        if numerics.solver.restore == Restore::Never {
            let remedy = "take `restore: never` out of `numerics`";
            self.issue(path, At::Key, "a grid that is never reset takes no new soil", remedy);
        }
        if let Some(name) = unfit(numerics) {
            let problem = format!("inflow with `gradient: {name}` is not available yet");
            self.issue(path, At::Key, problem, "choose `gradient: mpm` or `gradient: ddmp` under `numerics`");
        }
        if numerics.quadrature == Quadrature::Points {
            let problem =
                "new soil needs the surface of the soil that is there, which `quadrature: points` does not follow";
            self.issue(path, At::Key, problem, "choose `quadrature: resampled` under `numerics`");
        }
        if file.water.is_some() || file.materials.values().any(|material| material.permeability.is_some()) {
            let problem = "inflow of soil with water in its pores or around it is not available yet";
            self.issue(path, At::Key, problem, "take `water` and every `permeability` out");
        }
    }

    /// Refuses what the history counts of curves through which no soil passes.
    pub(super) fn passed(&mut self, file: &raw::CaseFile) {
        let leaves = |curve: &String| file.supports.get(curve).is_some_and(|held| held.outflow);
        let enters = |curve: &String| file.phases.iter().any(|phase| phase.inflow.contains_key(curve));
        for (i, entry) in file.output.history.iter().enumerate() {
            let on = entry.on.as_ref();
            for (k, quantity) in entry.quantities.iter().enumerate() {
                let (problem, remedy) = match quantity {
                    raw::Quantity::MassOut | raw::Quantity::VolumeOut if !on.is_some_and(leaves) => (
                        "mass_out and volume_out are those of a curve through which soil leaves",
                        "name such a curve `on`, with `outflow: true` under `supports`",
                    ),
                    raw::Quantity::MassIn | raw::Quantity::VolumeIn if !on.is_some_and(enters) => (
                        "mass_in and volume_in are those of a curve through which soil enters",
                        "name a curve of the `inflow` of a phase `on`",
                    ),
                    _ => continue,
                };
                let path = Path::default().key("output").key("history").index(i).key("quantities").index(k);
                self.issue(&path, At::Value, problem, remedy);
            }
        }
    }
}

/// The curves of a case through which soil enters the grid `mesh`.
///
/// # Errors
/// Input: a curve that is not straight, not on the boundary of the mesh, or not beside the region whose soil enters.
pub fn inflows(case: &Case, grid: (&Mesh<2>, &Locator<2>), fem: Option<&Mesh<2>>) -> Result<Vec<step::Inflow<2>>> {
    let mut names: Vec<&str> = case.phases.iter().flat_map(|p| &p.inflows).map(|i| i.curve.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter().map(|name| inflow(case, grid, fem, name)).collect()
}

fn inflow(
    case: &Case,
    (mesh, locator): (&Mesh<2>, &Locator<2>),
    fem: Option<&Mesh<2>>,
    name: &str,
) -> Result<step::Inflow<2>> {
    let (number, first) = case
        .phases
        .iter()
        .enumerate()
        .find_map(|(number, phase)| Some((number, phase.inflows.iter().find(|inflow| inflow.curve == name)?)))
        .unwrap_or_else(|| unreachable!("the name is that of an inflow"));
    let place = || format!("phases[{}].inflow.{name}", number - usize::from(case.equilibrium));
    let sides = boundary_sides((mesh, locator), fem, group(mesh, name)?, &place)?;
    let lines: Vec<Side<2>> = sides.iter().map(|side| Side::of(mesh, *side)).collect();
    let length: f64 = lines.iter().map(|side| distance(&side.ends[0], &side.ends[1])).sum();
    // The ends of the curve are the two places that are farthest from each other.
    let all: Vec<[f64; 2]> = lines.iter().flat_map(|side| side.ends).collect();
    let farthest = |from: &[f64; 2]| {
        let far = all.iter().copied().max_by(|a, b| distance(from, a).total_cmp(&distance(from, b)));
        far.unwrap_or_default()
    };
    let from = farthest(&all[0]);
    let ends: Line<2> = [from, farthest(&from)];
    let bends = all.iter().any(|x| nearest(x, &ends).1 > SAME * length);
    if bends || (distance(&ends[0], &ends[1]) - length).abs() > SAME * length {
        let remedy = "draw a straight curve, or an inflow for each straight piece";
        return Err(Error::input(place(), "soil enters through one straight curve", remedy));
    }
    let own = &group(mesh, name)?.nodes;
    let way = [0, 1].map(|d| (ends[1][d] - ends[0][d]) / length);
    let centre = |c: u32| {
        let x = mesh.coordinates(c as usize);
        [0, 1].map(|d| x.iter().map(|x| x[d]).sum::<f64>() / x.len() as f64)
    };
    let inside = centre(sides[0].0);
    let turned = (inside[0] - ends[0][0]) * -way[1] + (inside[1] - ends[0][1]) * way[0] > 0.0;
    let inward = if turned { [-way[1], way[0]] } else { [way[1], -way[0]] };
    // A node at an end of the curve that is held holds the soil that enters.
    for support in &case.supports {
        let holds = (0..2).any(|d| support.fixed[d] && inward[d].abs() > SAME);
        if holds && mesh.group(&support.curve).is_some_and(|curve| curve.nodes.iter().any(|n| own.contains(n))) {
            let problem = format!("`{}`, which is held along the flow, begins at a node of the curve", support.curve);
            let remedy = format!("take the support of `{}` out, or make it a wall of `contacts`", support.curve);
            return Err(Error::input(place(), problem, remedy));
        }
    }
    let mut phases = Vec::new();
    let mut points = 1;
    for (number, phase) in case.phases.iter().enumerate() {
        let Some(inflow) = phase.inflows.iter().find(|inflow| inflow.curve == name) else {
            phases.push(None);
            continue;
        };
        let soil = changes::at(case, mesh, number, &inflow.region)?;
        if let Some((cell, _)) = sides.iter().find(|(cell, _)| mesh.cells.region[*cell as usize] != soil.region) {
            let beside = &mesh.regions[usize::from(mesh.cells.region[*cell as usize])];
            let problem =
                format!("the curve is beside `{beside}` and not beside `{}`, whose soil is to enter", first.region);
            let remedy = "name the region of kind mpm at the curve under `region`; a thin one is enough";
            return Err(Error::input(place(), problem, remedy));
        }
        if let Some(Content::Mpm { points_per_cell, .. }) = case.content(&inflow.region) {
            points = points_per_cell.isqrt().max(1);
        }
        phases.push(Some((soil, inflow.velocity.clone())));
    }
    let gravity = case.phases.iter().map(|phase| phase.gravity.clone()).collect();
    let row = sides.len() * points;
    // A wall along the flow bounds it; a side that goes on beyond an end does not.
    let others =
        locator.faces.boundary.iter().filter(|side| !sides.contains(side)).map(|side| Side::of(mesh, *side).ends);
    let mut open = [false; 2];
    for other in others {
        for (end, beyond) in [(0, -1.0), (1, 1.0)] {
            let at_end = other.iter().position(|x| distance(x, &ends[end]) <= SAME * length);
            let Some(at_end) = at_end else { continue };
            let far = other[1 - at_end];
            let along: f64 = (0..2).map(|d| (far[d] - ends[end][d]) * way[d]).sum();
            open[end] |= beyond * along > SAME * length;
        }
    }
    Ok(step::Inflow { name: name.to_owned(), ends, inward, open, spacing: length / row as f64, row, gravity, phases })
}
