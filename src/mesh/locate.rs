//! Which cell holds a point, and where in it: the inverse of the cells' maps.
//!
//! A query walks from a hint over the facets that separate the point from the cell ([`CellKind::depth`]);
//! a point well inside a cell is done there. Points on or near a facet, and walks that end at the boundary,
//! are settled by a uniform grid of bins over the cells' boxes, which names the same cell whatever the hint.
//! Straight cells (and parallelograms) have an affine map with a stored inverse; curved and bilinear cells
//! are inverted by Newton's method.

mod bins;

use super::Mesh;
use super::faces::{BOUNDARY, Faces};
use super::shape::{CellKind, MAX_NODES, invert, jacobian};
use crate::geometry::distance;
use bins::{Bins, Bounds, bounds, enclose};
use std::sync::Arc;

/// A point this deep (parametric) in a cell is in no other.
const INSIDE: f64 = 1e-9;
/// A point this little outside a cell (parametric) is on its boundary.
const ON_FACET: f64 = 1e-12;
/// A point outside the mesh by less than this, relative to the mesh, is taken in.
const TAKEN_IN: f64 = 1e-10;
/// A point this deep (parametric) in a cell is inside it, not on its edge: the straight edges of an arc that is drawn
/// twice differ by less, from 18 edges to a circle on.
const DEEP: f64 = 0.05;
/// Cells a walk visits before the bins take over.
const WALK: usize = 24;
/// Newton iterations of the inverse map.
const ITERATIONS: usize = 30;

/// A search structure over a mesh. Queries do not allocate and can run in parallel.
#[derive(Clone, Debug)]
pub struct Locator<const D: usize> {
    /// The stored inverse of every affine cell.
    affine: Vec<Option<Affine<D>>>,
    /// The faces of the mesh, also when its nodes have moved.
    pub faces: Arc<Faces>,
    /// Boxes (m) that hold the cells, curved edges included, widened by `reach`.
    boxes: Vec<Bounds<D>>,
    bins: Bins<D>,
    /// Distance (m) up to which a point outside the mesh is taken in.
    reach: f64,
}

/// `ξ = ξ_0 + A (x − x_0)` with node 0 of the cell.
#[derive(Clone, Debug)]
struct Affine<const D: usize> {
    origin: [f64; D],
    inverse: [[f64; D]; D],
}

impl<const D: usize> Locator<D> {
    /// Prepares queries on `mesh`, whose nodes must stay where they are while this is in use.
    pub fn new(mesh: &Mesh<D>) -> Self {
        Self::with(mesh, Arc::new(Faces::of(mesh)))
    }

    /// Prepares queries on the mesh after its nodes have moved.
    pub fn moved(&self, mesh: &Mesh<D>) -> Self {
        Self::with(mesh, self.faces.clone())
    }

    fn with(mesh: &Mesh<D>, faces: Arc<Faces>) -> Self {
        let mut x = Vec::new();
        let mut boxes = Vec::with_capacity(mesh.cells.len());
        let mut affine = Vec::with_capacity(mesh.cells.len());
        for c in 0..mesh.cells.len() {
            mesh.cell_coordinates(c, &mut x);
            affine.push(Affine::of(mesh.cells.kind[c], &x));
            boxes.push(bounds(mesh.cells.kind[c], &x));
        }
        let (low, high) = enclose(&boxes);
        let reach = TAKEN_IN * (0..D).map(|d| high[d] - low[d]).fold(0.0, f64::max);
        for (low, high) in &mut boxes {
            *low = low.map(|v| v - 2.0 * reach);
            *high = high.map(|v| v + 2.0 * reach);
        }
        let bins = Bins::new(&boxes);
        Self { affine, faces, boxes, bins, reach }
    }

    /// The cell that holds `x` and the parametric coordinates there, which are always within the cell.
    ///
    /// `hint` is a cell near the point and only saves time. A point shared by several cells belongs to the
    /// lowest of them; one outside the mesh by about 1e-10 of its size at most belongs to the nearest; for one
    /// farther out, or not finite, the answer is `None`.
    pub fn locate(&self, mesh: &Mesh<D>, x: &[f64; D], hint: Option<u32>) -> Option<(u32, [f64; 3])> {
        let bin = self.bins.at(x)?;
        let start = hint.filter(|&c| (c as usize) < self.affine.len()).or_else(|| bin.get(bin.len() / 2).copied());
        if let Some(found) = start.and_then(|start| self.walk(mesh, x, start)) {
            return Some(found);
        }
        for c in self.candidates(bin, x) {
            if let Some(xi) = self.invert(mesh, c, x, true)
                && self.kind(mesh, c).depth(&xi).0 >= -ON_FACET
            {
                return Some((c, clamp(self.kind(mesh, c), &xi)));
            }
        }
        self.nearest(mesh, x, bin)
    }

    /// The cells in which `x` lies deep, not on their edges: in a sound mesh one at most.
    pub fn holders(&self, mesh: &Mesh<D>, x: &[f64; D]) -> impl Iterator<Item = u32> {
        let candidates = self.bins.at(x).into_iter().flat_map(|bin| self.candidates(bin, x));
        candidates
            .filter(move |&c| self.invert(mesh, c, x, true).is_some_and(|xi| self.kind(mesh, c).depth(&xi).0 > DEEP))
    }

    /// The parametric coordinates of `x` in a cell that need not hold it.
    pub fn extend(&self, mesh: &Mesh<D>, c: u32, x: &[f64; D]) -> Option<[f64; 3]> {
        self.invert(mesh, c, x, false)
    }

    /// Walks from `start` to a cell that holds `x` well inside; `None` where that is not settled.
    fn walk(&self, mesh: &Mesh<D>, x: &[f64; D], start: u32) -> Option<(u32, [f64; 3])> {
        let mut c = start;
        for _ in 0..WALK {
            let xi = self.invert(mesh, c, x, false)?;
            let (depth, facet) = self.kind(mesh, c).depth(&xi);
            if depth >= -ON_FACET {
                return (depth > INSIDE).then_some((c, xi));
            }
            c = self.faces.across(c).get(facet).copied().filter(|&n| n != BOUNDARY)?;
        }
        None
    }

    /// The cell of `bin` nearest to `x` within reach, the lowest of equals.
    fn nearest(&self, mesh: &Mesh<D>, x: &[f64; D], bin: &[u32]) -> Option<(u32, [f64; 3])> {
        let mut best = None;
        let mut least = self.reach;
        for c in self.candidates(bin, x) {
            let Some(xi) = self.invert(mesh, c, x, true) else { continue };
            let kind = self.kind(mesh, c);
            let xi = clamp(kind, &xi);
            let (y, _) = position(mesh, c, &xi);
            let distance = distance(x, &y);
            if distance < least || (distance == least && best.is_none()) {
                least = distance;
                best = Some((c, xi));
            }
        }
        best
    }

    /// The cells of `bin` whose boxes hold `x`.
    fn candidates(&self, bin: &[u32], x: &[f64; D]) -> impl Iterator<Item = u32> {
        bin.iter().copied().filter(move |&c| {
            let (low, high) = &self.boxes[c as usize];
            (0..D).all(|d| low[d] <= x[d] && x[d] <= high[d])
        })
    }

    fn kind(&self, mesh: &Mesh<D>, c: u32) -> CellKind {
        mesh.cells.kind[c as usize]
    }

    /// Parametric coordinates of `x` in cell `c`, inside or outside it. Newton's method from the centre is
    /// enough for a point inside or near most cells; with `thorough`, more starting points are tried until
    /// one leads inside, because a strongly curved map has further solutions outside its cell.
    fn invert(&self, mesh: &Mesh<D>, c: u32, x: &[f64; D], thorough: bool) -> Option<[f64; 3]> {
        let kind = self.kind(mesh, c);
        if let Some(affine) = &self.affine[c as usize] {
            return Some(affine.apply(kind, x));
        }
        let first = newton(mesh, c, x, kind.centre());
        let inside = |xi: &[f64; 3]| kind.depth(xi).0 >= -ON_FACET;
        if !thorough || first.is_some_and(|xi| inside(&xi)) {
            return first;
        }
        let centre = kind.centre();
        kind.node_coordinates()
            .iter()
            .filter_map(|node| newton(mesh, c, x, [0, 1, 2].map(|i| 0.8 * node[i] + 0.2 * centre[i])))
            .find(inside)
            .or(first)
    }
}

impl<const D: usize> Affine<D> {
    /// The inverse of the cell's map where all its nodes lie on the affine image of their places.
    fn of(kind: CellKind, x: &[[f64; D]]) -> Option<Self> {
        let places = kind.node_coordinates();
        let mut dn = [[0.0; 3]; MAX_NODES];
        kind.derivatives(&kind.centre(), &mut dn);
        let jacobian = jacobian(x, &dn);
        let (inverse, determinant) = invert(&jacobian);
        let size = x.iter().map(|y| distance(y, &x[0])).fold(0.0, f64::max);
        let straight = x.iter().zip(places).all(|(y, p)| {
            let image =
                std::array::from_fn(|i| x[0][i] + (0..D).map(|j| jacobian[i][j] * (p[j] - places[0][j])).sum::<f64>());
            distance(y, &image) <= 1e-12 * size
        });
        (straight && determinant > 0.0).then_some(Self { origin: x[0], inverse })
    }

    fn apply(&self, kind: CellKind, x: &[f64; D]) -> [f64; 3] {
        let mut xi = kind.node_coordinates()[0];
        for (i, row) in self.inverse.iter().enumerate() {
            for (j, a) in row.iter().enumerate() {
                xi[i] += a * (x[j] - self.origin[j]);
            }
        }
        xi
    }
}

/// Newton's method for `x(ξ) = x` in cell `c`, damped by halving; `None` where it does not converge.
fn newton<const D: usize>(mesh: &Mesh<D>, c: u32, x: &[f64; D], start: [f64; 3]) -> Option<[f64; 3]> {
    let mut xi = start;
    let (mut y, mut jacobian) = position(mesh, c, &xi);
    let mut residual = distance(x, &y);
    for _ in 0..ITERATIONS {
        let (inverse, determinant) = invert(&jacobian);
        if !determinant.is_normal() {
            return None;
        }
        let step: [f64; D] = std::array::from_fn(|i| (0..D).map(|j| inverse[i][j] * (x[j] - y[j])).sum());
        let length = step.iter().fold(0.0f64, |a, s| a.max(s.abs()));
        let mut factor = 1.0;
        loop {
            let mut trial = xi;
            for (t, s) in trial.iter_mut().zip(&step) {
                *t += factor * s;
            }
            let (trial_y, trial_jacobian) = position(mesh, c, &trial);
            let trial_residual = distance(x, &trial_y);
            // The last steps are lost in rounding: they need not reduce the residual.
            if trial_residual < residual || length < 1e-10 {
                (xi, y, jacobian, residual) = (trial, trial_y, trial_jacobian, trial_residual);
                break;
            }
            factor *= 0.5;
            if factor < 1e-3 {
                return None;
            }
        }
        // Convergence is quadratic: the step just taken has reached rounding.
        if length < 1e-10 {
            return Some(xi);
        }
    }
    None
}

/// Position and Jacobian `∂x/∂ξ` at `xi` of cell `c`.
fn position<const D: usize>(mesh: &Mesh<D>, c: u32, xi: &[f64; 3]) -> ([f64; D], [[f64; D]; D]) {
    let kind = mesh.cells.kind[c as usize];
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    kind.values(xi, &mut n);
    kind.derivatives(xi, &mut dn);
    let nodes = mesh.cells.nodes(c as usize).iter().map(|&node| &mesh.nodes[node as usize]);
    let mut y = [0.0; D];
    for (node, n) in nodes.clone().zip(&n) {
        for d in 0..D {
            y[d] += n * node[d];
        }
    }
    (y, jacobian(nodes, &dn))
}

/// `xi` moved into the parametric domain.
fn clamp(kind: CellKind, xi: &[f64; 3]) -> [f64; 3] {
    if !kind.is_simplex() {
        return xi.map(|t| t.clamp(-1.0, 1.0));
    }
    let mut xi = xi.map(|t| t.max(0.0));
    let sum: f64 = xi.iter().sum();
    if sum > 1.0 {
        xi = xi.map(|t| t / sum);
    }
    xi
}

#[cfg(test)]
mod tests;
