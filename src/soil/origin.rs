//! Where the soil was at first: the cells that were seeded, their outline, and what of them a place is in.

use crate::geometry::{Bins, Line, nearest};
use crate::mesh::faces::Face;
use crate::mesh::locate::Locator;
use crate::mesh::side::Side;
use crate::mesh::{Mesh, cell_size};

/// Places found so far beyond the boundary of the mesh, in the diagonal of the cell there (-), are on it: a displacement that is
/// fitted may lead across a wall.
const FARTHEST: f64 = 0.5;

/// Lines by where they are.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    lines: Vec<Line<2>>,
    bins: Bins,
    reach: f64,
}

impl Outline {
    /// Those nearer than `reach` (m) to a place will be found.
    pub fn new(lines: Vec<Line<2>>, reach: f64) -> Self {
        let bins = Bins::new(lines.iter().map(|[a, b]| (*a, *b)), reach);
        Self { lines, bins, reach }
    }

    /// The distance (m) of the nearest line, no more than the reach, and the unit vector from it to `x`.
    pub fn distance(&self, x: &[f64; 2]) -> (f64, [f64; 2]) {
        let mut best = (self.reach, [0.0; 2]);
        for &k in self.bins.around(x).flatten() {
            let line = &self.lines[k as usize];
            let (share, away) = nearest(x, line);
            if away < best.0 {
                let foot = crate::geometry::at(line, share);
                let by = [0, 1].map(|d| if away > 0.0 { (x[d] - foot[d]) / away } else { 0.0 });
                best = (away, by);
            }
        }
        best
    }
}

/// The lines along a face: from node to node.
fn along(mesh: &Mesh<2>, face: &Face) -> Vec<Line<2>> {
    let cell = face.cells[0] as usize;
    let nodes = mesh.cells.nodes(cell);
    let (_, facets) = mesh.cells.kind[cell].facets();
    // Both ends, then what is between them, from the first to the second.
    let facet = facets[face.sides[0] as usize];
    let places: Vec<[f64; 2]> =
        facet[..1].iter().chain(&facet[2..]).chain(&facet[1..2]).map(|&i| mesh.nodes[nodes[i] as usize]).collect();
    places.windows(2).map(|w| [w[0], w[1]]).collect()
}

/// The grid as it was seeded.
pub struct Origin {
    pub mesh: Mesh<2>,
    locator: Locator<2>,
    /// Whether each cell was seeded.
    seeded: Vec<bool>,
    /// Where the soil ended within the grid.
    free: Outline,
    /// Where each region of soil met others.
    between: Vec<Outline>,
    /// Sides on the boundary of the grid, and their bins.
    sides: Vec<Side<2>>,
    side_cells: Vec<u32>,
    side_bins: Bins,
}

impl Origin {
    /// The grid `mesh`, in which the regions `seeded` were filled with points.
    pub fn new(mesh: Mesh<2>, seeded: &[bool]) -> Self {
        let locator = Locator::new(&mesh);
        let faces = &locator.faces;
        let region = |c: u32| mesh.cells.region[c as usize];
        let is_soil = |c: u32| seeded[region(c) as usize];
        let mut free = Vec::new();
        let mut between = vec![Vec::new(); mesh.regions.len()];
        for face in &faces.inner {
            let [a, b] = face.cells;
            let lines = || along(&mesh, face);
            match (is_soil(a), is_soil(b)) {
                (true, true) if region(a) != region(b) => {
                    [a, b].iter().for_each(|&c| between[region(c) as usize].extend(lines()));
                }
                (true, false) | (false, true) => free.extend(lines()),
                _ => {}
            }
        }
        let size = (0..mesh.cells.len()).map(|c| cell_size(&mesh, c)).fold(0.0, f64::max);
        let sides: Vec<Side<2>> = faces.boundary.iter().map(|&side| Side::of(&mesh, side)).collect();
        Self {
            seeded: (0..mesh.cells.len() as u32).map(is_soil).collect(),
            free: Outline::new(free, 2.0 * size),
            between: between.into_iter().map(|lines| Outline::new(lines, 2.0 * size)).collect(),
            side_cells: faces.boundary.iter().map(|side| side.0).collect(),
            side_bins: Bins::new(sides.iter().map(|side| (side.ends[0], side.ends[1])), size),
            sides,
            locator,
            mesh,
        }
    }

    /// The lines between cells that are `apart`.
    pub fn lines(&self, apart: impl Fn(u32, u32) -> bool) -> impl Iterator<Item = Line<2>> {
        let inner = self.locator.faces.inner.iter().filter(move |face| apart(face.cells[0], face.cells[1]));
        inner.flat_map(|face| along(&self.mesh, face))
    }

    pub fn is_seeded(&self, c: usize) -> bool {
        self.seeded[c]
    }

    /// The cell that a place was in, or one beside which it was a little outside the grid.
    pub fn cell(&self, x: &[f64; 2], hint: Option<u32>) -> Option<u32> {
        let found = self.locator.locate(&self.mesh, x, hint).map(|(c, _)| c);
        found.or_else(|| {
            let near = self.side_bins.around(x).flatten().map(|&k| k as usize);
            let near = near.filter_map(|k| Some((self.sides[k].nearest(x, FARTHEST)?.1, k)));
            near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| self.side_cells[k])
        })
    }

    /// The cell of soil that a point was seeded in, and whether its displacement leads there. It does not after a reset of displacements that no
    /// frame knows of, in the run that this one goes on from: then the nearest one across faces, or any.
    pub fn seeded_cell(&self, x: &[f64; 2]) -> Option<(u32, bool)> {
        let mut reached: Vec<u32> = self.cell(x, None).into_iter().collect();
        let mut i = 0;
        while i < reached.len().min(NEAR) {
            if self.seeded[reached[i] as usize] {
                return Some((reached[i], i == 0));
            }
            for &next in self.locator.faces.neighbours(reached[i]) {
                if !reached.contains(&next) {
                    reached.push(next);
                }
            }
            i += 1;
        }
        self.seeded.iter().position(|&seeded| seeded).map(|c| (c as u32, false))
    }

    /// How deep (m) in the soil a place was, negative outside, and the unit vector away from the nearest surface.
    pub fn depth(&self, x: &[f64; 2]) -> (f64, [f64; 2]) {
        let (distance, by) = self.free.distance(x);
        let inside = self.cell(x, None).is_some_and(|c| self.seeded[c as usize]);
        (if inside { distance } else { -distance }, by)
    }

    /// How deep (m) in a region a place was, negative in other ones.
    pub fn depth_in(&self, region: u16, x: &[f64; 2]) -> f64 {
        let (distance, _) = self.between[region as usize].distance(x);
        let inside = self.cell(x, None).is_some_and(|c| self.mesh.cells.region[c as usize] == region);
        if inside { distance } else { -distance }
    }
}

/// Cells that are looked at for one of soil: two rings.
const NEAR: usize = 12;
