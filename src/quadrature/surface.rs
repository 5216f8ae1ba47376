//! The surface of the material from one restoration to the next, for weights and for loads on it.

use super::{Quadrature, Restored, Volumes, Weights};
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::surface::{ActiveBoundary, Behind, Contour, Distance, Geometry, Lost, MarkerFront, NO_REGION};

/// The surface lies at most so far beside the markers of its front, as a share of a cell's size.
const LARGEST_OFFSET: f64 = 0.05;

/// Takes the front along with the grid: at first it goes around the cells with points.
///
/// # Errors
/// Why the surface is not followed.
pub fn follow<K: Kinematics<2>>(
    geometry: &Geometry,
    grid: &Restored<2>,
    front: &mut Option<MarkerFront>,
) -> Result<(), Lost> {
    let (mesh, points) = (grid.mesh, grid.points);
    match (grid.displacement, front.as_mut()) {
        (Some(displacement), Some(front)) => {
            front.advance(grid.before, (mesh, grid.locator), geometry, displacement)?;
            front.conform(mesh, geometry, grid.locator, (grid.outlines, grid.contact))?;
            front.join(mesh, geometry, grid.locator, grid.outlines)?;
            if !grid.entering.0.is_empty() {
                *front = with_strips(geometry, grid, front);
            }
        }
        (Some(_), None) => return Ok(()),
        (None, _) => {
            let mut filled = vec![false; mesh.cells.len()];
            points.cell.iter().for_each(|&c| filled[c as usize] = true);
            let front = front.insert(MarkerFront::around(mesh, &geometry.faces, &filled));
            is_theirs::<K>(front, geometry, grid)?;
        }
    }
    Ok(())
}

/// The front of the soil that is there with the strips that are filled.
fn with_strips(geometry: &Geometry, grid: &Restored<2>, front: &MarkerFront) -> MarkerFront {
    let Restored { mesh, locator, points, active, entering: (strips, new), .. } = *grid;
    let mut distance = Distance::default();
    distance.update(mesh, geometry, locator, front, &points.cell[..points.len() - new], active);
    let with = |(soil, x): (&f64, &[f64; 2])| strips.iter().fold(*soil, |level, strip| level.max(strip.level(x)));
    let level: Vec<f64> = distance.level_set.iter().zip(&mesh.nodes).map(with).collect();
    let nothing = |host: u32, _: &[f64; 2]| Behind { region: NO_REGION, host };
    ActiveBoundary::of(mesh, geometry, &level, active, nothing).front(mesh)
}

/// Says whether a front that begins encloses the volume of the points, but for what the offset makes up for.
///
/// # Errors
/// Where it does not, as where the points lie in cells that they do not fill.
fn is_theirs<K: Kinematics<2>>(front: &MarkerFront, geometry: &Geometry, grid: &Restored<2>) -> Result<(), Lost> {
    let (enclosed, points) = (front.volume::<K>(), (0..grid.points.len()).map(|p| grid.points.volume(p)).sum::<f64>());
    let (area, size) = front.surface::<K>(grid.mesh, geometry, grid.locator);
    // Where no surface is free, the points may fill their box a little more or less than all.
    if area > 0.0 && (enclosed - points).abs() > LARGEST_OFFSET * size * area {
        Err(Lost::Volume { enclosed, points })
    } else {
        Ok(())
    }
}

/// How far (m) beside the markers of a front the surface may lie.
pub fn largest_offset<K: Kinematics<2>>(front: &MarkerFront, geometry: &Geometry, grid: &Restored<2>) -> f64 {
    let (_, size) = front.surface::<K>(grid.mesh, geometry, grid.locator);
    LARGEST_OFFSET * size
}

/// The contour of the points, whose level set is `contour`, smoothed: a front for this restoration alone, and the cells with
/// points that are within it at least in part, for points far outside are none of the material. `None` where the contour
/// is better as it is: where a body is hardly more than two cells large, structures may touch the material, or the front would be none.
pub fn smoothed<K: Kinematics<2>>(
    geometry: &Geometry,
    grid: &Restored<2>,
    contour: &[f64],
) -> Option<(MarkerFront, Vec<u32>)> {
    let Restored { mesh, points, .. } = *grid;
    if !grid.outlines.is_empty() {
        return None;
    }
    let nothing = |host: u32, _: &[f64; 2]| Behind { region: NO_REGION, host };
    let boundary = ActiveBoundary::of(mesh, geometry, contour, grid.active, nothing);
    let mut front = MarkerFront::along::<K>(mesh, geometry, &boundary)?;
    front.join(mesh, geometry, grid.locator, &[]).ok()?;
    is_theirs::<K>(&front, geometry, grid).ok()?;
    let inside = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| contour[n as usize] > 0.0);
    Some((front, points.cell.iter().copied().filter(inside).collect()))
}

/// Rings of cells across faces in which points are sought that stand for what is behind a piece of the boundary.
const RINGS: usize = 3;

/// The boundary of where `level_set` is positive, given the points that integrals are summed over and the numbers of those in a cell. A piece
/// in a cell without points has the nearest cell with points for its host: where that is a neighbour, the one to which the active part of the
/// cell is assigned.
pub fn boundary<N: IntoIterator<Item = usize>>(
    geometry: &Geometry,
    grid: &Restored<2>,
    level_set: &[f64],
    points: &Points<2>,
    of_cell: impl Fn(u32) -> N,
) -> ActiveBoundary {
    let mesh = grid.mesh;
    let count = |c: u32| of_cell(c).into_iter().count() as u32;
    let region = |cell: u32, x: &[f64; 2]| {
        let distance = |p: usize| {
            let y = &points.position[p];
            (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)
        };
        let nearest = of_cell(cell).into_iter().map(|p| (distance(p), p)).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or(NO_REGION, |(_, p)| points.region[p])
    };
    ActiveBoundary::of(mesh, geometry, level_set, grid.active, |cell, x| match geometry.host(cell, RINGS, count) {
        Some(host) => Behind { region: region(host, x), host },
        None => Behind { region: NO_REGION, host: cell },
    })
}

/// Classical weights with the boundary of the material: followed, or the contour of the points.
pub struct Bounded<K> {
    geometry: Geometry,
    volumes: Volumes<K>,
}

impl<K: Kinematics<2>> Bounded<K> {
    /// For grids that are restored to `mesh`.
    pub fn new(mesh: &crate::mesh::Mesh<2>) -> Self {
        Self { geometry: Geometry::new::<K>(mesh), volumes: Volumes::default() }
    }
}

impl<K: Kinematics<2>> Quadrature<2> for Bounded<K> {
    fn weigh(&self, grid: &Restored<2>, front: &mut Option<MarkerFront>) -> Weights<2> {
        let relaxed = grid.relaxed.then(|| Geometry::new::<K>(grid.mesh));
        let geometry = relaxed.as_ref().unwrap_or(&self.geometry);
        let Restored { mesh, locator, points, parametric, active, .. } = *grid;
        let mut weights = self.volumes.weigh(grid, front);
        if let Err(lost) = follow::<K>(geometry, grid, front) {
            *front = None;
            weights.lost_front = Some(lost.to_string());
        }
        let of_cell = |c: u32| grid.interpolation.points_in(c).iter().map(|&p| p as usize);
        let bounded = |level_set: &[f64]| boundary(geometry, grid, level_set, points, of_cell);
        let within = |front: &MarkerFront, cells: &[u32]| {
            let mut distance = Distance::default();
            distance.update(mesh, geometry, locator, front, cells, active);
            bounded(&distance.level_set)
        };
        weights.boundary = match front {
            Some(front) => within(front, &points.cell),
            None => {
                let mut contour = Contour::default();
                contour.update::<K>(mesh, geometry, points, parametric, active);
                let smoothed = smoothed::<K>(geometry, grid, &contour.level_set);
                smoothed.map_or_else(|| bounded(&contour.level_set), |(front, cells)| within(&front, &cells))
            }
        };
        weights
    }
}
