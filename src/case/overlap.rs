//! Structures that begin within the soil they are to touch.

use super::checked::{Case, Touched, Touching};
use super::scene::region_index;
use crate::contact::Mark;
use crate::error::{Error, Result};
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::stencil::cell_size;
use crate::step::Scene;

/// Refuses structures with points of soil in them farther from the boundary than a cell is long: contact moves
/// points out of a structure that are near its boundary, and would never see these. Walls have no inside.
///
/// # Errors
/// Input: such a structure; a region that the mesh has not.
pub fn check(case: &Case, scene: &Scene<2>, points: &Points<2>) -> Result<()> {
    let Some(fem) = &scene.fem else { return Ok(()) };
    for contact in &case.contacts {
        let (&Touching::Structure(structure), Touched::Soil(soils)) = (&contact.structure, &contact.on) else {
            continue;
        };
        let name = &case.regions[structure].name;
        let structure = region_index(&scene.mesh, name)?;
        let body = fem.mesh.part(|c| fem.mesh.cells.region[c] == structure);
        let locator = Locator::new(&body);
        let own = scene.pairs.iter().filter(|pair| pair.structure() == structure);
        let lines: Vec<_> = own.flat_map(|pair| pair.lines(&|n| fem.mesh.nodes[n as usize])).collect();
        for &soil in soils {
            let region = region_index(&scene.mesh, &case.regions[soil].name)?;
            let (mut count, mut deepest) = (0, (0.0, 0.0));
            for p in (0..points.len()).filter(|&p| points.region[p] == region) {
                let x = &points.position[p];
                if locator.locate(&body, x, None).is_none() {
                    continue;
                }
                count += 1;
                let (depth, cell) = (distance(x, &lines), cell_size(&scene.mesh, points.cell[p] as usize));
                if depth > cell && depth > deepest.0 {
                    deepest = (depth, cell);
                }
            }
            let (depth, cell) = deepest;
            if depth > 0.0 {
                let soil = &case.regions[soil].name;
                return Err(Error::input(
                    format!("contact of `{name}`"),
                    format!(
                        "the structure begins within the soil: {count} points of `{soil}` are in it, up to {depth:.3} m deep in cells {cell:.3} m wide"
                    ),
                    "in the .geo, move the structure out of the soil, or make its place a region of kind buffer",
                ));
            }
        }
    }
    Ok(())
}

/// How far (m) a place is from the nearest line.
fn distance(x: &[f64; 2], lines: &[Vec<Mark<2>>]) -> f64 {
    let to_segment = |pair: &[Mark<2>]| {
        let [a, b] = [pair[0].place, pair[1].place];
        let along = [b[0] - a[0], b[1] - a[1]];
        let way = [x[0] - a[0], x[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let share = ((way[0] * along[0] + way[1] * along[1]) / square).clamp(0.0, 1.0);
        (way[0] - share * along[0]).hypot(way[1] - share * along[1])
    };
    lines.iter().flat_map(|line| line.windows(2)).map(to_segment).fold(f64::INFINITY, f64::min)
}
