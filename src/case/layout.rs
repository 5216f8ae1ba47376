//! Where the regions of a case lie: what no mesh can be right with, and what would not fit into the machine.

use super::checked::{Case, Content, Geometry, Touched, Touching};
use super::find::{region_index, regions};
use crate::error::{Error, Result};
use crate::geometry::box_around;
use crate::machine::memory;
use crate::mesh::locate::Locator;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh};
use crate::time_value::TimeValue;

/// Checks the layout of the regions, in time linear in the cells.
///
/// # Errors
/// Input: cells of soil or buffer that lie upon each other, a structure that cannot come to the soil it is to touch.
pub fn check(case: &Case, mesh: &Mesh<2>) -> Result<()> {
    if case.geometry == Geometry::Axisymmetric {
        outwards(mesh)?;
    }
    let structures = regions(case, mesh, Content::is_structure);
    let grid = mesh.part(|c| !structures[mesh.cells.region[c] as usize]);
    apart(&grid)?;
    within_reach(case, mesh, &grid)
}

/// Refuses cells on the other side of the axis, x = 0.
fn outwards(mesh: &Mesh<2>) -> Result<()> {
    let widest = mesh.nodes.iter().fold(0.0f64, |widest, x| widest.max(x[0].abs()));
    let radius = |n: &u32| mesh.nodes[*n as usize][0];
    for c in 0..mesh.cells.len() {
        let least = mesh.cells.corners(c).iter().map(radius).fold(f64::INFINITY, f64::min);
        if least < -SAME * widest {
            let [x, y] = mesh.centre(c);
            return Err(Error::input(
                format!("region `{}`", mesh.regions[mesh.cells.region[c] as usize]),
                format!("its cell at [{x:.4}, {y:.4}] m lies at negative radius: in axisymmetry x is the radius"),
                "draw the half of the section with x ≥ 0, its axis at x = 0, or choose `geometry: plane_strain`",
            ));
        }
    }
    Ok(())
}

/// Refuses cells that lie upon each other: a point would be in two of them. Structures lie above the grid, and
/// may be drawn upon it.
fn apart(grid: &Mesh<2>) -> Result<()> {
    let locator = Locator::new(grid);
    for c in 0..grid.cells.len() {
        let centre = grid.centre(c);
        let inwards = |&n: &u32| [0, 1].map(|d| 0.8 * grid.nodes[n as usize][d] + 0.2 * centre[d]);
        for x in grid.cells.corners(c).iter().map(inwards).chain([centre]) {
            let Some(other) = locator.holders(grid, &x).find(|&other| other as usize != c) else { continue };
            let name = |c: usize| &grid.regions[grid.cells.region[c] as usize];
            let (place, what) = match (name(c), name(other as usize)) {
                (a, b) if a == b => (format!("region `{a}`"), "its cells"),
                (a, b) => (format!("regions `{a}` and `{b}`"), "their cells"),
            };
            return Err(Error::input(
                place,
                format!("{what} lie upon each other at [{:.4}, {:.4}] m", x[0], x[1]),
                "in the .geo, take one out of the other: a hole in the Plane Surface, or BooleanDifference",
            ));
        }
    }
    Ok(())
}

/// Lowest and highest corner (m).
pub type Bounds = [[f64; 2]; 2];

/// The box around the cells of a mesh; `None` without cells.
pub(super) fn bounds(mesh: &Mesh<2>) -> Option<Bounds> {
    box_around(mesh.cells.nodes.iter().map(|&n| mesh.nodes[n as usize]))
}

/// How far (m) two boxes are apart; 0 where they meet.
pub(super) fn gap(a: &Bounds, b: &Bounds) -> f64 {
    let along = |d: usize| (a[0][d] - b[1][d]).max(b[0][d] - a[1][d]).max(0.0);
    along(0).hypot(along(1))
}

/// Refuses a structure beside the grid that touches soil by a contact, and that nothing moves as far as to the grid.
fn within_reach(case: &Case, mesh: &Mesh<2>, grid: &Mesh<2>) -> Result<()> {
    let Some(around) = bounds(grid) else { return Ok(()) };
    for contact in &case.contacts {
        let (Touching::Structure(index), Touched::Soil(_)) = (&contact.structure, &contact.on) else { continue };
        let name = &case.regions[*index].name;
        let number = region_index(mesh, name)?;
        let part = mesh.part(|c| mesh.cells.region[c] == number);
        let Some(own) = bounds(&part) else { continue };
        let gap = gap(&own, &around);
        if gap > 0.0 && reach(case, &part, name).is_some_and(|reach| reach < gap) {
            return Err(Error::input(
                format!("region `{name}`"),
                format!(
                    "the structure lies {gap:.4} m beside the grid, and nothing moves it there: it touches no soil"
                ),
                "in the .geo, move the structure to the soil; between the two there must be soil or buffer",
            ));
        }
    }
    Ok(())
}

/// Whether what moves `curve` moves the structure `name` with the cells `body`.
pub(super) fn moves(name: &str, body: &Mesh<2>, curve: &str) -> bool {
    let on = |group: &Group| group.nodes.iter().all(|n| body.cells.nodes.contains(n));
    curve == name || body.group(curve).is_some_and(on)
}

/// How far (m) the structure `name` with the cells `body` moves at most by what is prescribed; `None` where inertia, loads or turning may take
/// it anywhere.
fn reach(case: &Case, body: &Mesh<2>, name: &str) -> Option<f64> {
    let of_it = |curve: &str| moves(name, body, curve);
    let mut reach = 0.0;
    for phase in &case.phases {
        let free = phase.analysis.has_inertia() || phase.tractions.iter().any(|load| of_it(&load.curve));
        let mut moves = phase.prescribed.iter().filter(|p| of_it(&p.curve));
        if free || moves.clone().any(|p| p.component == 2) {
            return None;
        }
        reach += moves.by_ref().map(|p| farthest(&p.displacement, phase.duration)).sum::<f64>();
    }
    Some(reach)
}

/// The largest amount of a value until `end`: it is linear between its kinks.
pub(super) fn farthest(value: &TimeValue, end: f64) -> f64 {
    value.kinks().filter(|t| *t < end).chain([0.0, end]).map(|t| value.at(t).abs()).fold(0.0, f64::max)
}

/// Memory (B) that a point takes while it is seeded and written, measured at 256 704 points of `seabed_slope`.
const SEEDED: u64 = 1_000;
/// Memory (B) that a point and a node take while they are solved for: a little less than measured there and, with a
/// pressure field and contact, at 65 722 points of `pile`.
const SOLVED: [u64; 2] = [1_500, 6_000];

/// Refuses points that the memory of the machine does not hold, before any is made.
///
/// # Errors
/// Machine: more of them than fit.
pub fn check_seeding(case: &Case, mesh: &Mesh<2>) -> Result<()> {
    let mut of_region = vec![0; mesh.regions.len()];
    for region in &case.regions {
        of_region[region_index(mesh, &region.name)? as usize] = match region.content {
            Content::Mpm { points_per_cell, .. } => points_per_cell as u64,
            // At most: those of a quadrilateral.
            Content::Fem { .. } | Content::Structure { .. } => 9,
            Content::Buffer => 0,
        };
    }
    let points: u64 = mesh.cells.region.iter().map(|&r| of_region[r as usize]).sum();
    memory("MemAvailable")
        .map_or(Ok(()), |left| fits(&format!("seeding {points} points"), points.saturating_mul(SEEDED), left))
}

/// Refuses a solution that the memory of the machine does not hold, before anything is written.
///
/// # Errors
/// Machine: more points and nodes than fit.
pub fn check_solving(mesh: &Mesh<2>, points: usize) -> Result<()> {
    let nodes = mesh.nodes.len();
    let needed = (points as u64).saturating_mul(SOLVED[0]).saturating_add((nodes as u64).saturating_mul(SOLVED[1]));
    let what = format!("solving for {points} points on {nodes} nodes");
    memory("MemAvailable").map_or(Ok(()), |left| fits(&what, needed, left))
}

/// Refuses `what` where it needs more memory (B) than is left.
fn fits(what: &str, needed: u64, left: u64) -> Result<()> {
    if needed <= left {
        return Ok(());
    }
    let [needed, left] = [needed, left].map(|bytes| bytes as f64 / 1e9);
    Err(Error::machine(
        "memory",
        format!("{what} takes about {needed:.1} GB, and the machine has {left:.1} GB left"),
        "coarsen the mesh, lower `points_per_cell`, or take a larger machine",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder;
    use crate::mesh::shape::CellKind;

    /// A mesh and the same once more, moved by `by` (m), as another region.
    fn twice(kind: CellKind, by: [f64; 2]) -> Mesh<2> {
        let mut mesh = builder::rectangle(kind, 2.0, 1.0, 4, 2, 0.2, 7);
        let (nodes, cells) = (mesh.nodes.clone(), mesh.cells.clone());
        let first = nodes.len() as u32;
        mesh.nodes.extend(nodes.iter().map(|x| [x[0] + by[0], x[1] + by[1]]));
        for c in 0..cells.len() {
            let moved: Vec<u32> = cells.nodes(c).iter().map(|n| n + first).collect();
            mesh.cells.push(cells.kind[c], 1, &moved);
        }
        mesh.regions = vec!["soil".into(), "water".into()];
        mesh
    }

    #[test]
    fn cells_upon_each_other_are_found_wherever_they_are() {
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9] {
            for by in [[0.0, 0.0], [0.3, 0.1], [1.9, 0.0], [-1.0, 0.9]] {
                let e = apart(&twice(kind, by)).unwrap_err();
                assert!(
                    e.to_string().contains("regions `soil` and `water`: their cells lie upon"),
                    "{kind:?} {by:?} {e}"
                );
            }
            for by in [[2.0, 0.0], [0.0, -1.0], [5.0, 5.0]] {
                apart(&twice(kind, by)).unwrap();
            }
        }
    }

    #[test]
    fn points_beyond_the_memory_are_refused() {
        fits("seeding", 8_000_000_000, 8_000_000_000).unwrap();
        let e = fits("seeding 140000000 points", 140_000_000 * SEEDED, 8_000_000_000).unwrap_err();
        assert_eq!(e.exit_status(), 3);
        assert!(e.to_string().contains("140000000 points takes about 140.0 GB, and the machine has 8.0 GB"), "{e}");
        let mesh = builder::rectangle(CellKind::T6, 2.0, 1.0, 4, 2, 0.0, 0);
        check_solving(&mesh, 100).unwrap();
        if memory("MemAvailable").is_some() {
            check_solving(&mesh, usize::MAX).unwrap_err();
        }
    }

    #[test]
    fn a_prescribed_motion_reaches_as_far_as_its_table() {
        assert_eq!(farthest(&TimeValue::Rate(-2.0), 3.0), 6.0);
        assert_eq!(farthest(&TimeValue::Table(vec![[0.0, 0.0], [1.0, -4.0], [2.0, 1.0]]), 2.0), 4.0);
    }
}
