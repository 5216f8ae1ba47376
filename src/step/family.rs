//! Points with the cells that they act on (a *family*: those of the grid, or those of the finite elements), and systems of equations over
//! their nodes.

use crate::error::Result;
use crate::interpolation::{Entries, Interpolation};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::profile;
use crate::system::{Connectivity, Matrix, Pattern, Solver};
use rayon::prelude::*;

/// Points with the cells they act on: the material points on the grid, or those of the finite elements.
pub struct Family<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub interpolation: &'a Interpolation<D>,
    /// The coupling of each cell.
    pub coupling: &'a [u32],
    pub points: &'a Points<D>,
}

/// A system of equations over the active nodes.
pub struct System {
    pub pattern: Pattern,
    pub matrix: Matrix,
    pub solver: Solver,
}

/// What the points see of a grid.
#[derive(Debug, Default)]
pub struct Interpolations<const D: usize> {
    /// Those that integrals are summed over.
    pub integration: Interpolation<D>,
    /// The material points, where these are others.
    pub material: Option<Interpolation<D>>,
}

impl System {
    /// A system of blocks of `sizes` unknowns; `places` as for [`Solver::new`].
    pub fn new<const D: usize>(
        sizes: &[u8],
        connectivity: Connectivity,
        symmetric: bool,
        places: &[[f64; D]],
    ) -> Result<Self> {
        let pattern = Pattern::new(sizes, connectivity, symmetric);
        // A pattern that is symmetric has one triangle.
        let entries = if symmetric { 2 * pattern.row.len() - pattern.len() } else { pattern.row.len() };
        profile::note_system(pattern.len(), entries);
        let matrix = Matrix::new(&pattern);
        let solver = Solver::new(&pattern, places)?;
        Ok(Self { pattern, matrix, solver })
    }
}

/// Interpolates a nodal field at points.
pub fn interpolate<const D: usize, K: Kinematics<D>>(family: &Family<D>, field: &[[f64; D]]) -> Vec<[f64; D]> {
    let Family { mesh, interpolation, points, .. } = family;
    let by_cell_points: Vec<Vec<(usize, [f64; D])>> = interpolation
        .filled
        .par_iter()
        .map(|cell_points| {
            let nodes = interpolation.nodes(mesh, cell_points.cell);
            let interpolate = |entries: Entries<'_, D>| {
                let mut value = [0.0; D];
                for (n, &node) in entries.value.iter().zip(nodes) {
                    for d in 0..D {
                        value[d] += n * field[node as usize][d];
                    }
                }
                (entries.point, value)
            };
            interpolation.entries::<K>(cell_points).map(interpolate).collect()
        })
        .collect();
    let mut out = vec![[0.0; D]; points.len()];
    for (p, value) in by_cell_points.into_iter().flatten() {
        out[p] = value;
    }
    out
}
