//! Fits the weights of all points, cell by cell, and mends the gradients where no weights suffice.
//!
//! A uniform stress exerts the right forces where `Σ w ∇N = ∫∇N` over the active part of the cell. Weights that
//! integrate the degree of `∇N` exactly see to that; elsewhere `∇N += (∫∇N − Σ w ∇N)/Σ w` at all points of the cell does.
//!
//! In axisymmetry areas `a` are fitted, and `w = 2πr a`. The hoop forces `Σ w N/r = 2π Σ a N` are then as exact as the
//! others, whose integrand `r ∇N` is of the same degree; with moments weighed by `2πr` they would not be, and a
//! uniform pressure would move the nodes near the axis.

use super::fit::{Degree, Fitter};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, CellKind, MAX_NODES};
use crate::points::Points;
use crate::stencil::{Patch, Stencil, integrate};
use crate::surface::Geometry;
use crate::surface::moments::{CellFrame, Moments};
use rayon::prelude::*;

/// How the fit of a cell came out.
#[derive(Clone, Debug, PartialEq)]
pub struct CellFit {
    pub cell: u32,
    /// The points in the cell.
    pub points: u32,
    /// The degree that the weights integrate exactly.
    pub degree: Degree,
    /// `Σ V_p` and `Σ w_p` (m³).
    pub held: f64,
    pub fitted: f64,
    /// What is added to the gradients of the cell's nodes (1/m) at all its points.
    pub shift: Option<Vec<[f64; 2]>>,
}

/// Memory that a thread keeps from cell to cell.
#[derive(Default)]
struct Buffers {
    fitter: Fitter,
    place: Vec<[f64; 2]>,
    area: Vec<f64>,
}

/// Fits the weights of the points in `stencil` to the plane moments (m²) of the active part of their cells, one entry a
/// cell of the mesh; `plane` is the geometry of plane strain, in axisymmetry too. Writes the current weights (m³), one entry a point in the order of `stencil.points`, and returns the
/// fits in the order of the patches.
pub fn fit<K: Kinematics<2>>(
    mesh: &Mesh<2>,
    plane: &Geometry,
    moments: &[Moments],
    points: &Points<2>,
    stencil: &Stencil<2>,
    weight: &mut Vec<f64>,
) -> Vec<CellFit> {
    weight.clear();
    weight.resize(stencil.points.len(), 0.0);
    let (mut rest, mut slots) = (&mut weight[..], Vec::with_capacity(stencil.patches.len()));
    for patch in &stencil.patches {
        let own;
        (own, rest) = rest.split_at_mut(patch.point_count as usize);
        slots.push((patch, own));
    }
    let work = |buffers: &mut Buffers, (patch, weight): (&Patch, &mut [f64])| {
        let c = patch.cell as usize;
        let (kind, moments) = (mesh.cells.kind[c], &moments[c]);
        let numbers = stencil.points(patch).iter().map(|&p| p as usize);
        let measure = |p: usize| K::measure(&points.position[p]);
        buffers.place.clear();
        buffers.place.extend(numbers.clone().map(|p| plane.frame[c].local(&points.position[p])));
        buffers.area.clear();
        buffers.area.extend(numbers.clone().map(|p| points.volume(p) / measure(p)));
        let degree = buffers.fitter.fit(&buffers.place, &buffers.area, moments, wanted(kind), weight);
        weight.iter_mut().zip(numbers.clone()).for_each(|(w, p)| *w *= measure(p));
        let held = numbers.map(|p| points.volume(p)).sum();
        let active = moments[0] > NEGLIGIBLE * buffers.area.iter().sum::<f64>();
        let centroid = Centroid::of::<K>(&plane.frame[c], moments);
        if K::HOOP && active && degree == Degree::Constant {
            // Areas without first moments do not sum to the volume.
            let factor = centroid.volume / weight.iter().sum::<f64>();
            weight.iter_mut().for_each(|w| *w *= factor);
        }
        let fitted = weight.iter().sum();
        let enough = sufficient::<K>(kind, plane.affine[c]).is_some_and(|enough| degree >= enough);
        let plain = stencil.reach.is_none();
        let mean =
            if active && plain && !enough { mean_gradients::<K>(mesh, plane, moments, &centroid, c) } else { None };
        let shift = mean.map(|mean| shift::<K>(stencil, patch, weight, fitted, &mean[..kind.node_count()]));
        CellFit { cell: patch.cell, points: patch.point_count, degree, held, fitted, shift }
    };
    slots.into_par_iter().with_min_len(64).map_init(Buffers::default, work).collect()
}

/// Share of the volume of a cell's points below which its active part exerts no forces worth mending.
const NEGLIGIBLE: f64 = 1e-9;

/// The degree asked for: stress and gradient may both be linear, but for the constant gradients of the simplest cell.
pub fn wanted(kind: CellKind) -> Degree {
    if kind == CellKind::T3 { Degree::Linear } else { Degree::Quadratic }
}

/// The least degree that integrates the gradients of a cell exactly, if any does: in axisymmetry the radius comes on top.
fn sufficient<K: Kinematics<2>>(kind: CellKind, affine: bool) -> Option<Degree> {
    match (kind, K::HOOP) {
        (CellKind::T3, _) => Some(Degree::Constant),
        (CellKind::T6 | CellKind::Q4, false) if affine => Some(Degree::Linear),
        (CellKind::T6 | CellKind::Q4, true) | (CellKind::Q8, false) if affine => Some(Degree::Quadratic),
        _ => None,
    }
}

/// Volume (m³) and centroid of an active part, in the coordinates of the cell's frame.
struct Centroid {
    volume: f64,
    place: [f64; 2],
}

impl Centroid {
    /// From plane moments.
    fn of<K: Kinematics<2>>(frame: &CellFrame, m: &Moments) -> Self {
        let [first, x, y] = if K::HOOP {
            // 2πr is linear: its values at the centre and a length beside it.
            let at = |x: f64| K::measure(&[frame.centre[0] + x * frame.length, frame.centre[1]]);
            let (base, slope) = (at(0.0), at(1.0) - at(0.0));
            [base * m[0] + slope * m[1], base * m[1] + slope * m[3], base * m[2] + slope * m[4]]
        } else {
            [m[0], m[1], m[2]]
        };
        Self { volume: first, place: [x / first, y / first] }
    }
}

/// `∫∇N / ∫1` (1/m) over the active part of cell `c` with the given moments. Known where the gradients are linear,
/// and in cells that are active as a whole.
fn mean_gradients<K: Kinematics<2>>(
    mesh: &Mesh<2>,
    plane: &Geometry,
    moments: &Moments,
    centroid: &Centroid,
    c: usize,
) -> Option<[[f64; 2]; MAX_NODES]> {
    let (kind, frame) = (mesh.cells.kind[c], &plane.frame[c]);
    let mut mean = [[0.0; 2]; MAX_NODES];
    if plane.affine[c] && matches!(kind, CellKind::T6 | CellKind::Q4) {
        // Linear: the gradients at the centroid, from those at three corners.
        let corner = if kind.is_simplex() { [0, 1, 2] } else { [0, 1, 3] };
        let mut x = [[0.0; 2]; MAX_NODES];
        for (x, &n) in x.iter_mut().zip(mesh.cells.nodes(c)) {
            *x = frame.local(&mesh.nodes[n as usize]);
        }
        let [a, b, d] = corner.map(|i| x[i]);
        let area =
            |a: [f64; 2], b: [f64; 2], d: [f64; 2]| (b[0] - a[0]) * (d[1] - a[1]) - (d[0] - a[0]) * (b[1] - a[1]);
        let whole = area(a, b, d);
        let (l1, l2) = (area(a, centroid.place, d) / whole, area(a, b, centroid.place) / whole);
        let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        for (i, l) in corner.into_iter().zip([1.0 - l1 - l2, l1, l2]) {
            shape::map(kind, &x[..kind.node_count()], &kind.node_coordinates()[i], &mut n, &mut gradient);
            add(&mut mean, l / frame.length, &gradient);
        }
        return Some(mean);
    }
    // Where a neighbour's sliver belongs to the points too, the moments are not those of the cell.
    (*moments == plane.whole[c]).then(|| {
        let volume = integrate::<2, K>(mesh, c, |weight, _, gradient| add(&mut mean, weight, gradient));
        mean.map(|g| g.map(|g| g / volume))
    })
}

/// What brings the mean of the gradients over the points of a patch to the given one.
fn shift<K: Kinematics<2>>(
    stencil: &Stencil<2>,
    patch: &Patch,
    weight: &[f64],
    sum: f64,
    mean: &[[f64; 2]],
) -> Vec<[f64; 2]> {
    let mut shift = mean.to_vec();
    for (entries, w) in stencil.entries::<K>(patch).zip(weight) {
        for (i, shift) in shift.iter_mut().enumerate() {
            let gradient = entries.gradient(i).g;
            shift[0] -= w / sum * gradient[0];
            shift[1] -= w / sum * gradient[1];
        }
    }
    shift
}

/// Adds `factor` times `gradient` to `sum`, as far as `gradient` goes.
fn add(sum: &mut [[f64; 2]], factor: f64, gradient: &[[f64; 2]]) {
    for (sum, g) in sum.iter_mut().zip(gradient) {
        sum[0] += factor * g[0];
        sum[1] += factor * g[1];
    }
}

#[cfg(test)]
mod tests;
