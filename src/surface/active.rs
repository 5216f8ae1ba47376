//! The part of each cell that holds material, from a level set at the nodes.

use super::geometry::Geometry;
use super::moments::Moments;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use rayon::prelude::*;

/// How much of a cell lies within the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filling {
    #[default]
    Empty,
    Cut,
    Full,
}

/// A smaller share of a cell without points is rounding.
const ROUNDING: f64 = 1e-12;

/// The active part of the cells, one entry a cell of the mesh: empty and zero for those that do not take part.
/// The buffers are reused.
#[derive(Clone, Debug, Default)]
pub struct Active {
    pub filling: Vec<Filling>,
    /// Volume (m³) of the active part inside the cell.
    pub volume: Vec<f64>,
    /// Moments (m³) in the cell's frame of what the points of the cell stand for: its own active part and slivers of
    /// neighbours without points. Zero in a cell without points.
    pub moments: Vec<Moments>,
    /// Volume (m³) in cells without points that have no face neighbour with points.
    pub lost: f64,
    /// Volume (m³) in cells without points that neighbours took over.
    pub handed: f64,
    /// Points in each cell.
    points: Vec<u32>,
}

impl Active {
    /// Cuts the cells `taking_part` along the zero of `level_set` (one value a node, positive in the material);
    /// `cell` is the cell of each point. A part without points goes to the face neighbour with most points, the
    /// lowest of equals: to fit points to a part farther away would spoil what they integrate of their own.
    pub fn update<K: Kinematics<2>>(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        level_set: &[f64],
        cell: &[u32],
        taking_part: &[bool],
    ) {
        self.points.clear();
        self.points.resize(mesh.cells.len(), 0);
        for &c in cell {
            self.points[c as usize] += 1;
        }
        self.volume.resize(mesh.cells.len(), 0.0);
        self.moments.resize(mesh.cells.len(), [0.0; 6]);
        let values = |c: usize| {
            let mut values = [0.0; crate::mesh::shape::MAX_NODES];
            for (value, &n) in values.iter_mut().zip(mesh.cells.nodes(c)) {
                *value = level_set[n as usize];
            }
            values
        };
        let own = |c: usize| {
            if !taking_part[c] {
                return (Filling::Empty, 0.0, [0.0; 6]);
            }
            let values = values(c);
            let values = &values[..mesh.cells.nodes(c).len()];
            let moments = match filling(values) {
                Filling::Empty => [0.0; 6],
                Filling::Full => geometry.whole[c],
                Filling::Cut => geometry.cell(mesh, c, c).clipped::<K>(values),
            };
            (filling(values), moments[0], if self.points[c] > 0 { moments } else { [0.0; 6] })
        };
        self.filling.clear();
        self.filling.resize(mesh.cells.len(), Filling::Empty);
        let outputs = (&mut self.filling, &mut self.volume, &mut self.moments);
        outputs.into_par_iter().enumerate().with_min_len(256).for_each(|(c, (filling, volume, moments))| {
            (*filling, *volume, *moments) = own(c);
        });
        (self.lost, self.handed) = (0.0, 0.0);
        for c in 0..mesh.cells.len() {
            if self.points[c] > 0 || self.volume[c] <= ROUNDING * geometry.volume(c) {
                continue;
            }
            match geometry.bearer(c as u32, 1, |c| self.points[c as usize]).map(|owner| owner as usize) {
                Some(owner) => {
                    let values = values(c);
                    let part = geometry.cell(mesh, c, owner).clipped::<K>(&values);
                    for (sum, part) in self.moments[owner].iter_mut().zip(part) {
                        *sum += part;
                    }
                    self.handed += self.volume[c];
                }
                None => self.lost += self.volume[c],
            }
        }
    }
}

/// Zero counts as inside where anything is, for a surface through the nodes of a cell cuts nothing off it.
fn filling(values: &[f64]) -> Filling {
    let some = |test: fn(&f64) -> bool| values.iter().any(test);
    match (some(|&v| v > 0.0), some(|&v| v < 0.0)) {
        (true, false) => Filling::Full,
        (true, true) => Filling::Cut,
        (false, _) => Filling::Empty,
    }
}

#[cfg(test)]
mod tests;
