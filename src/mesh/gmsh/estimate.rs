//! How many cells a geometry will get, before Gmsh makes them: a mesh size that is too small by a slip of the keyboard
//! otherwise fills the memory, or overflows Gmsh's count of the segments of a curve and is silently left out.

use super::session::Session;
use crate::error::{Error, Result};
use std::path::Path;

/// The most segments of all curves that Gmsh is asked for.
const MOST_SEGMENTS: f64 = 1e7;

/// A mesh size must be larger than this part of the size of the geometry: smaller ones are below Gmsh's tolerance.
const TOLERANCE: f64 = 1e-9;

/// What a cell of second order with 16 material points takes from the mesh to the solution (bytes); a mesh of fewer
/// points takes less.
pub const BYTES_PER_CELL: f64 = 25e3;

/// The mesh sizes at the points must be possible.
///
/// # Errors
/// Input: a size below the tolerance of the geometry, or one that divides a curve into too many segments.
pub fn check_sizes(session: &Session, geo: &Path) -> Result<()> {
    let option = |name| session.option(name);
    let (smallest, largest) = (option("Mesh.MeshSizeMin")?, option("Mesh.MeshSizeMax")?);
    let (factor, from_points) = (option("Mesh.MeshSizeFactor")?, option("Mesh.MeshSizeFromPoints")? != 0.0);
    let extent = session.extent(-1, -1);
    if extent.is_nan() || extent <= 0.0 {
        return Ok(());
    }
    let size = |point| {
        let own = session.size(point).filter(|&size| from_points && size > 0.0).unwrap_or(extent);
        own.min(largest).max(smallest) * factor
    };
    let place = |point| format!("{}, point {point}", geo.display());
    let remedy = "ask for a larger mesh size: the h or lc of the points, Mesh.MeshSizeMax or Mesh.MeshSizeFactor";
    let mut segments = 0.0;
    for curve in session.entities(1) {
        let points = session.boundary(1, curve);
        let Some(coarsest) = points.iter().copied().max_by(|&a, &b| size(a.abs()).total_cmp(&size(b.abs()))) else {
            continue;
        };
        for point in points.iter().map(|point| point.abs()) {
            if size(point) < TOLERANCE * extent {
                let problem = format!(
                    "the mesh size {:e} is below the tolerance of the geometry, {:.1e} for its extent of {extent:.3} m",
                    size(point),
                    TOLERANCE * extent
                );
                return Err(Error::input(place(point), problem, remedy));
            }
        }
        let length = session.extent(1, curve);
        segments += length / size(coarsest.abs());
        if segments > MOST_SEGMENTS {
            let problem = format!(
                "the mesh size {:e} makes {:.1e} segments along the curves up to curve {curve}, and Gmsh can make \
                 {MOST_SEGMENTS:.0e}",
                size(coarsest.abs()),
                segments
            );
            return Err(Error::input(place(coarsest.abs()), problem, remedy));
        }
    }
    Ok(())
}

/// The cells that the meshed curves lead to: for each surface its area by that of an equilateral triangle of the mean
/// segment around it. Nothing where the sizes are not extended from the boundary, which says little then.
///
/// # Errors
/// Machine: a Gmsh without the option that says so.
pub fn cells(session: &Session) -> Result<f64> {
    if session.option("Mesh.MeshSizeExtendFromBoundary")? == 0.0 {
        return Ok(0.0);
    }
    let nodes = session.nodes();
    let mut cells = 0.0;
    for surface in session.entities(2) {
        // Twice the area, the length around it and the sum of the squares of its segments.
        let (mut doubled, mut length, mut squares) = (0.0, 0.0, 0.0);
        for curve in session.boundary(2, surface) {
            for ends in session.elements(1, curve.abs()) {
                let [Some(a), Some(b)] = [0, 1].map(|end| ends.get(end).and_then(|tag| nodes.get(tag))) else {
                    continue;
                };
                let size = (b[0] - a[0]).hypot(b[1] - a[1]);
                doubled += f64::from(curve.signum()) * (a[0] * b[1] - a[1] * b[0]);
                length += size;
                squares += size * size;
            }
        }
        if squares > 0.0 {
            // The mean over the length, for which a few small segments at a corner count little.
            let mean = squares / length;
            cells += 0.5 * doubled.abs() / (0.25 * 3.0f64.sqrt() * mean * mean);
        }
    }
    Ok(cells)
}

/// So many cells must fit the machine, of which `memory` (bytes) may be used.
///
/// # Errors
/// Input: too many of them.
pub fn check_cells(geo: &Path, cells: f64, memory: u64) -> Result<()> {
    let needed = cells * BYTES_PER_CELL;
    if needed <= memory as f64 {
        return Ok(());
    }
    let gib = |bytes: f64| bytes / f64::from(1 << 30);
    let problem = format!(
        "the mesh will have about {cells:.1e} cells, whose analysis takes about {:.1} GiB of memory; this machine can \
         give {:.1} GiB",
        gib(needed),
        gib(memory as f64)
    );
    Err(Error::input(geo.display(), problem, "ask for a larger mesh size, or use a machine with more memory"))
}
