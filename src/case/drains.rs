//! What of a case drains the water in the pores of its soil, on its mesh.

use super::changes;
use super::checked::{Analysis, Case, Content, Material, Surface};
use super::find::{mean_size, regions};
use super::pores::flows;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::mesh::bodies::Bodies;
use crate::mesh::faces::Faces;
use crate::term::Porous;
use std::collections::BTreeSet;

/// How far, in cells (-), pressure has to go in the time of the phases for a drain to matter.
const LEAST: f64 = 0.01;

/// A note on each two regions of which one takes the water of the other, or could and is tight; and a warning for each body of soil that
/// consolidates and has nothing that drains it.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Result<Vec<String>> {
    if !case.phases.iter().any(|phase| flows(case, phase)) {
        return Ok(Vec::new());
    }
    let time: f64 = case.phases.iter().filter(|phase| flows(case, phase)).map(|phase| phase.duration).sum();
    let heights = || mesh.nodes.iter().map(|x| x[1]);
    let ends = [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    // Less permeable soil keeps its water anyway: pressure goes as far as √(c_v t).
    let passes = |soil: &Porous| {
        let confined = |y: f64| soil.model.elasticity().at(y).lambda + 2.0 * soil.model.elasticity().at(y).shear;
        let coefficient = soil.mobility[0].max(soil.mobility[1]) * ends.map(confined).into_iter().fold(0.0, f64::max);
        (coefficient * time).sqrt() > LEAST * mean_size(mesh)
    };
    let porous = changes::ever(case, mesh, |m| m.porous.as_ref().is_some_and(passes))?;
    let drains = changes::ever(case, mesh, |material| material.drains)?;
    let is_total = |m: &Material| m.porous.is_none() && m.carried.as_ref().is_some_and(|c| c.water == 0.0);
    let total = changes::ever(case, mesh, |material| is_total(material) && !material.drains)?;
    let soil = regions(case, mesh, |content| matches!(content, Content::Mpm { .. } | Content::Fem { .. }));
    let buffer = regions(case, mesh, |content| matches!(content, Content::Buffer));
    let region = |c: usize| usize::from(mesh.cells.region[c]);
    let is_porous = |c: usize| porous[region(c)] && soil[region(c)];
    let name = |r: usize| &mesh.regions[r];

    let mut at_node: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); mesh.nodes.len()];
    for c in (0..mesh.cells.len()).filter(|&c| is_porous(c)) {
        mesh.cells.nodes(c).iter().for_each(|&n| _ = at_node[n as usize].insert(region(c)));
    }
    let bodies = Bodies::of(mesh, (0..mesh.cells.len()).filter(|&c| is_porous(c)).map(|c| c as u32), &[]);
    let mut drained = vec![false; bodies.count()];
    let mut pairs = BTreeSet::new();
    for c in (0..mesh.cells.len()).filter(|&c| soil[region(c)] && (drains[region(c)] || total[region(c)])) {
        for &n in mesh.cells.nodes(c) {
            pairs.extend(at_node[n as usize].iter().map(|&other| (region(c), other)));
            if let Some(body) = bodies.of_node(n as usize).filter(|_| drains[region(c)]) {
                drained[body] = true;
            }
        }
    }
    let curves = case.supports.iter().filter(|support| support.drained).filter_map(|s| mesh.group(&s.curve));
    curves.flat_map(|curve| &curve.nodes).filter_map(|&n| bodies.of_node(n as usize)).for_each(|b| drained[b] = true);
    if let Some(surface) = case.drained_surface {
        let opens = |r: usize| match surface {
            Surface::All => true,
            Surface::Of(index) => case.regions[index].name == *name(r),
        };
        // Where the surface itself drains, soil on it that does changes nothing.
        pairs.retain(|&(beside, other)| !(drains[beside] && opens(other)));
        for face in Faces::of(mesh).inner {
            for [own, other] in [face.cells, [face.cells[1], face.cells[0]]] {
                let free = buffer[region(other as usize)] && is_porous(own as usize) && opens(region(own as usize));
                if let Some(body) = bodies.of_cell(own).filter(|_| free) {
                    drained[body] = true;
                }
            }
        }
    }

    let note = |&(beside, other): &(usize, usize)| {
        let (beside_name, other) = (name(beside), name(other));
        if drains[beside] {
            format!(
                "note: the drained soil `{beside_name}` takes the water of `{other}`: no excess pressure where they meet; what is tight is \
                 `kind: structure`, or undrained without a permeability"
            )
        } else {
            format!(
                "note: `{beside_name}` is tight and keeps the water in `{other}`: it is nearly incompressible in total stress; with \
                 `drainage: drained` it would take the water"
            )
        }
    };
    let mut found: Vec<String> = pairs.iter().map(note).collect();
    if let Some(phase) = case.phases.iter().find(|phase| phase.analysis == Analysis::Consolidation) {
        for body in (0..drained.len()).filter(|&body| !drained[body]) {
            let cells = (0..mesh.cells.len()).filter(|&c| is_porous(c) && bodies.of_cell(c as u32) == Some(body));
            let of: BTreeSet<String> = cells.map(|c| format!("`{}`", name(region(c)))).collect();
            let of: Vec<String> = of.into_iter().collect();
            found.push(format!(
                "warning: phase `{}` is a consolidation, and nothing drains {}: no water leaves, and the excess pressure at most evens out; drain a \
                 curve by `pore_pressure: 0` under `supports`, or the surface by `drained_surface` (it is free where a region of `kind: buffer` lies \
                 beside it), or make the soil beside it drained",
                phase.name,
                of.join(" and ")
            ));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::Group;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// What is said of clay between sand below and above, 1 m each, under a metre of air, with entries of the case and of the sand.
    fn said(entries: &str, sand: &str) -> Vec<String> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\n\
             regions: {{lower: {{kind: mpm, material: sand}}, clay: {{kind: mpm, material: clay}}, upper: {{kind: mpm, material: sand}}, air: {{kind: buffer}}}}\n\
             materials: {{clay: {{model: linear_elastic, young: 4000, poisson: 0.2, density: 0, drainage: undrained, permeability: 1.0e-8}}, \
             sand: {{model: linear_elastic, young: 4000, density: 0, {sand}}}}}\n{entries}"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let mut mesh = rectangle(CellKind::T6, 1.0, 4.0, 2, 8, 0.0, 0);
        mesh.regions = ["lower", "clay", "upper", "air"].map(String::from).to_vec();
        for c in 0..mesh.cells.len() {
            mesh.cells.region[c] = mesh.centre(c)[1] as u16;
        }
        let left = mesh.group("left").unwrap().clone();
        mesh.groups.push(Group { name: "side".into(), ..left });
        on_mesh(&case.unwrap(), &mesh).unwrap()
    }

    const FLOWS: &str = "phases: [{name: wait, analysis: consolidation, duration: 1.0e+6, step: {initial: 1}}]\n";

    #[test]
    fn drained_soil_beside_undrained_soil_is_named() {
        let found = said(FLOWS, "poisson: 0.3");
        assert!(
            found.len() == 2 && found[0].starts_with("note: the drained soil `lower` takes the water of `clay`"),
            "{found:?}"
        );
        let undrained = "phases: [{name: load, analysis: quasi_static, duration: 1.0e+6, step: {initial: 1}}]\n";
        assert!(said(undrained, "poisson: 0.3").is_empty());
        assert_eq!(said(FLOWS, "poisson: 0.49, drainage: drained").len(), 2);
    }

    #[test]
    fn a_consolidation_that_nothing_drains_is_warned_of() {
        let tight = "poisson: 0.3, drainage: undrained";
        let [warning] = said(FLOWS, tight).try_into().unwrap();
        assert!(
            warning.starts_with("warning: phase `wait` is a consolidation, and nothing drains `clay`"),
            "{warning}"
        );
        let found = said(FLOWS, "poisson: 0.49");
        assert!(found.len() == 3 && found[0].contains("`lower` is tight") && found[2] == warning, "{found:?}");
        // The surface is that of the sand.
        assert_eq!(said(&format!("drained_surface: all\n{FLOWS}"), tight), [warning]);
        let curve = format!("supports: {{side: {{ux: 0, pore_pressure: 0}}}}\n{FLOWS}");
        assert!(said(&curve, tight).is_empty());
        // With a permeability of its own the upper layer drains to its surface, and the clay through it.
        let porous = "poisson: 0.3, drainage: undrained, permeability: 1.0e-6";
        assert!(said(&format!("drained_surface: all\n{FLOWS}"), porous).is_empty());
        assert_eq!(said(&format!("drained_surface: lower\n{FLOWS}"), porous).len(), 1);
        // In a second pressure goes two millimetres.
        assert!(said(&FLOWS.replace("1.0e+6", "1"), tight).is_empty());
    }
}
