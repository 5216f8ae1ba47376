//! Fitted weights: the points of a cell integrate polynomials exactly over the part of it that is within the
//! surface of the material.

use super::cells::{self, CellFit};
use super::surface::{boundary, follow, points_of, smoothed};
use super::{Degree, MOMENTS, Quadrature, Restored, Tally, Weighing};
use crate::kinematics::{Kinematics, PlaneStrain};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::stencil::{Patch, SoftCell, Stencil};
use crate::surface::{Active, Contour, Distance, Filling, Front, Geometry};
use std::marker::PhantomData;

/// Cells whose weights are worth fewer points for each moment that they are fitted to do not stand alone.
const POINTS_A_MOMENT: f64 = 2.0;

/// The surface lies at most so far beside the markers of its front, as a share of a cell's size: as far as the front may
/// be off before it is given up.
const LARGEST_OFFSET: f64 = 0.05;
/// Offsets of a smoothed contour, which is farther from where it weighs what it should than a surface that was there before.
const OFFSETS: usize = 4;
/// So far is no distance.
const LEAST_OFFSET: f64 = 1e-10;

/// Weights fitted to the cells cut along the contour of the material.
pub struct Fitted<K> {
    geometry: Geometry,
    /// That of plane strain, where it is another one.
    plane: Option<Geometry>,
    /// Whether the boundary of the material is wanted.
    bounded: bool,
    kinematics: PhantomData<K>,
}

impl<K: Kinematics<2>> Fitted<K> {
    /// For grids that are restored to `mesh`.
    pub fn new(mesh: &Mesh<2>) -> Self {
        let plane = K::HOOP.then(|| Geometry::new::<PlaneStrain>(mesh));
        Self { geometry: Geometry::new::<K>(mesh), plane, bounded: false, kinematics: PhantomData }
    }

    /// With the boundary of the material in what the points weigh.
    #[must_use]
    pub fn with_boundary(mut self) -> Self {
        self.bounded = true;
        self
    }

    /// Weighs points within a front. It follows the grid and not the points, and nothing holds it where it is: it would
    /// sink or rise a little in every restoration, and the body lose or gain weight by that. So the surface is taken
    /// where the points weigh together what they did when the front was made: everywhere as far beside the markers.
    /// Against a structure the surface is that of the structure, which has not moved.
    fn weigh_followed(&self, grid: &Restored<2>, front: &mut Front) -> (Weighing<2>, Vec<f64>) {
        self.weigh_beside(grid, front, &grid.points.cell, usize::from(grid.outlines.is_empty()))
    }

    /// Weighs points within a front with the surface beside its markers, found by `offsets` of which each corrects the one
    /// before; `cells` are those with points that are material where the front is far. A front without weight takes that of the
    /// points within.
    fn weigh_beside(
        &self,
        grid: &Restored<2>,
        front: &mut Front,
        cells: &[u32],
        offsets: usize,
    ) -> (Weighing<2>, Vec<f64>) {
        let Restored { mesh, locator, points, stencil, taking_part, .. } = *grid;
        let mut distance = Distance::default();
        distance.update(mesh, &self.geometry, locator, front, cells, taking_part);
        let mut level_set = distance.level_set;
        let mut weighing = self.weigh_within(mesh, points, stencil, taking_part, &level_set);
        if grid.displacement.is_none() && front.weight == 0.0 {
            front.weight = weighing.weight.iter().sum();
        }
        let (surface, size) = front.surface::<K>(mesh, &self.geometry, locator);
        let (mut offset, most) = (0.0, LARGEST_OFFSET * size);
        for _ in 0..offsets {
            let missing = (front.weight - weighing.weight.iter().sum::<f64>()) * volume_ratio(points, &weighing);
            if missing.abs() <= LEAST_OFFSET * size * surface {
                break;
            }
            let next = (offset + missing / surface).clamp(-most, most);
            level_set.iter_mut().for_each(|distance| *distance += next - offset);
            offset = next;
            weighing = self.weigh_within(mesh, points, stencil, taking_part, &level_set);
        }
        (weighing, level_set)
    }

    /// Weighs points in a body whose surface is the zero of `level_set`: one value a node, positive inside.
    pub fn weigh_within(
        &self,
        mesh: &Mesh<2>,
        points: &Points<2>,
        stencil: &Stencil<2>,
        taking_part: &[bool],
        level_set: &[f64],
    ) -> Weighing<2> {
        let plane = self.plane.as_ref().unwrap_or(&self.geometry);
        let mut active = Active::default();
        active.update::<PlaneStrain>(mesh, plane, level_set, &points.cell, taking_part);
        let mut current = Vec::new();
        let mut fits = cells::fit::<K>(mesh, plane, &active.moments, points, stencil, &mut current);
        let full = |c: u32| active.filling[c as usize] == Filling::Full;
        keep_drops(mesh, stencil, full, &mut fits, &mut current);
        let mut weight = vec![0.0; points.len()];
        for (w, &p) in current.iter().zip(&stencil.points) {
            let p = p as usize;
            weight[p] = w * points.initial_volume[p] / points.volume(p);
        }
        let tally = tally(&fits, full);
        let poor = |(fit, patch): &(&CellFit, &Patch)| {
            !full(fit.cell) || fit.degree == Degree::Constant || {
                let begin = patch.first_point as usize;
                let weight = &current[begin..begin + patch.point_count as usize];
                effective_points(points, stencil.points(patch), weight) < enough(mesh.cells.kind[fit.cell as usize])
            }
        };
        let poor = fits.iter().zip(&stencil.patches).filter(poor).map(|(fit, _)| fit.cell).collect();
        let shift = fits.into_iter().filter_map(|fit| Some((fit.cell, fit.shift?))).collect();
        let soft = soft(mesh, plane, &active, stencil, taking_part);
        Weighing { weight, shift, soft, poor, tally, ..Weighing::default() }
    }
}

impl<K: Kinematics<2>> Quadrature<2> for Fitted<K> {
    fn weigh(&self, grid: &Restored<2>, front: &mut Option<Front>) -> Weighing<2> {
        if !grid.relaxed {
            return self.weigh_on(grid, front);
        }
        Self { bounded: self.bounded, ..Self::new(grid.mesh) }.weigh_on(grid, front)
    }
}

impl<K: Kinematics<2>> Fitted<K> {
    /// Weighs the points on a grid whose geometry this is.
    fn weigh_on(&self, grid: &Restored<2>, front: &mut Option<Front>) -> Weighing<2> {
        let Restored { mesh, points, parametric, stencil, taking_part, .. } = *grid;
        let mut lost_front = None;
        if let Err(fault) = follow::<K>(&self.geometry, grid, front) {
            *front = None;
            lost_front = Some(fault.to_string());
        }
        let (mut weighing, level_set) = match front {
            Some(front) => self.weigh_followed(grid, front),
            None => {
                let mut contour = Contour::default();
                contour.update::<K>(mesh, &self.geometry, points, parametric, taking_part);
                match smoothed::<K>(&self.geometry, grid, &contour.level_set) {
                    Some((mut front, cells)) => self.weigh_beside(grid, &mut front, &cells, OFFSETS),
                    None => {
                        (self.weigh_within(mesh, points, stencil, taking_part, &contour.level_set), contour.level_set)
                    }
                }
            }
        };
        weighing.lost_front = lost_front;
        if self.bounded {
            weighing.boundary = boundary(&self.geometry, grid, &level_set, points, |c| points_of(stencil, c));
            weighing.level_set = level_set;
        }
        weighing
    }
}

/// How many points of equal weight the points of a cell are worth: `n (Σ w)²/(Σ V Σ w²/V)`, of the current weights (m³) and
/// volumes. The stresses of points differ from those in balance by some noise; that of the cell's forces falls with it.
fn effective_points(points: &Points<2>, numbers: &[u32], weight: &[f64]) -> f64 {
    let (mut volumes, mut weights, mut squares) = (0.0, 0.0, 0.0);
    for (&p, w) in numbers.iter().zip(weight) {
        let volume = points.volume(p as usize);
        volumes += volume;
        weights += w;
        squares += w * w / volume;
    }
    numbers.len() as f64 * weights * weights / (volumes * squares)
}

/// The points that the weights of a cell must be worth.
fn enough(kind: CellKind) -> f64 {
    let moments = match cells::wanted(kind) {
        Degree::Constant => 1,
        Degree::Linear => 3,
        Degree::Quadratic => MOMENTS,
    };
    POINTS_A_MOMENT * moments as f64
}

/// The mean of `J` over the points in cells that are not full; one where there are none.
fn volume_ratio(points: &Points<2>, weighing: &Weighing<2>) -> f64 {
    let (mut now, mut then) = (0.0, 0.0);
    for (p, &cell) in points.cell.iter().enumerate() {
        if weighing.soft.binary_search_by_key(&cell, |soft| soft.cell).is_ok() {
            now += points.volume(p) * (weighing.weight[p] / points.initial_volume[p]);
            then += weighing.weight[p];
        }
    }
    if then > 0.0 { now / then } else { 1.0 }
}

/// Gives a body, cells with points that share nodes, that fills no cell the volume of its points: what the surface cuts off cells beside it, which have no
/// points and may have no neighbour with any, is much of it, and it would lose as much of its weight.
fn keep_drops(
    mesh: &Mesh<2>,
    stencil: &Stencil<2>,
    full: impl Fn(u32) -> bool,
    fits: &mut [CellFit],
    current: &mut [f64],
) {
    let mut at: Vec<(u32, usize)> = Vec::new();
    for (i, fit) in fits.iter().enumerate() {
        let corners = mesh.cells.kind[fit.cell as usize].corner_count();
        at.extend(mesh.cells.nodes(fit.cell as usize)[..corners].iter().map(|&n| (n, i)));
    }
    at.sort_unstable();
    let around = |n: u32| at[at.partition_point(|&(m, _)| m < n)..].iter().take_while(move |&&(m, _)| m == n);
    let mut seen = vec![false; fits.len()];
    for first in 0..fits.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut body = vec![first];
        let mut next = 0;
        while let Some(&i) = body.get(next) {
            next += 1;
            let c = fits[i].cell as usize;
            let corners = &mesh.cells.nodes(c)[..mesh.cells.kind[c].corner_count()];
            for &(_, patch) in corners.iter().flat_map(|&n| around(n)) {
                if !std::mem::replace(&mut seen[patch], true) {
                    body.push(patch);
                }
            }
        }
        if body.iter().any(|&i| full(fits[i].cell)) {
            continue;
        }
        body.sort_unstable();
        let sum = |value: fn(&CellFit) -> f64| body.iter().map(|&i| value(&fits[i])).sum::<f64>();
        let factor = sum(|fit| fit.held) / sum(|fit| fit.fitted);
        for &i in &body {
            fits[i].fitted *= factor;
            let patch = &stencil.patches[i];
            let begin = patch.first_point as usize;
            current[begin..begin + patch.point_count as usize].iter_mut().for_each(|w| *w *= factor);
        }
    }
}

/// The cells that take part and are not full. Those with fewer points than nodes, or none, do not hold their nodes even
/// within the surface, as where soil has come apart, and count as empty.
fn soft(
    mesh: &Mesh<2>,
    geometry: &Geometry,
    active: &Active,
    stencil: &Stencil<2>,
    taking_part: &[bool],
) -> Vec<SoftCell> {
    let mut count = vec![0; taking_part.len()];
    stencil.patches.iter().for_each(|patch| count[patch.cell as usize] = patch.point_count as usize);
    let emptiness = |c: usize| match active.filling[c] {
        _ if count[c] < mesh.cells.nodes(c).len() => 1.0,
        Filling::Full => 0.0,
        Filling::Cut => 1.0 - active.volume[c] / geometry.volume(c),
        Filling::Empty => 1.0,
    };
    let cells = (0..taking_part.len()).filter(|&c| taking_part[c]);
    let soft = cells.map(|c| SoftCell { cell: c as u32, emptiness: emptiness(c) });
    soft.filter(|soft| soft.emptiness > 0.0).collect()
}

fn tally(fits: &[CellFit], full: impl Fn(u32) -> bool) -> Tally {
    let mut tally = Tally::default();
    for fit in fits {
        match fit.degree {
            Degree::Quadratic => tally.quadratic += 1,
            Degree::Linear => tally.linear += 1,
            Degree::Constant => tally.constant += 1,
        }
        tally.point_volume += fit.held;
        tally.fitted_volume += fit.fitted;
        if full(fit.cell) {
            let drift = fit.held / fit.fitted - 1.0;
            if drift.abs() > tally.drift.abs() {
                tally.drift = drift;
            }
        }
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::Axisymmetric;
    use crate::mesh::builder::rectangle;
    use crate::mesh::locate::Locator;
    use crate::stencil::Scheme;
    use crate::tensor::Tensor;

    /// A block that fills the lower `height` of the square, compressed by a tenth since it was seeded.
    fn weigh<K: Kinematics<2>>(kind: CellKind, height: f64) -> (Mesh<2>, Points<2>, Stencil<2>, Weighing<2>) {
        let mesh = rectangle(kind, 1.0, 1.0, 8, 8, 0.2, 4);
        let n = 45;
        let rows = (height * n as f64).round() as usize;
        let places = (0..n * rows).map(|k| [(k % n) as f64 + 0.5, (k / n) as f64 + 0.5].map(|x| x / n as f64));
        let position: Vec<[f64; 2]> = places.collect();
        let locator = Locator::new(&mesh);
        let found: Vec<_> = position.iter().map(|x| locator.locate(&mesh, x, None).unwrap()).collect();
        let points = Points {
            initial_volume: position.iter().map(|x| K::measure(x) / (0.9 * (n * n) as f64)).collect(),
            deformation: vec![Tensor::from_diagonal(&[1.0, 0.9, 1.0].into()); position.len()],
            cell: found.iter().map(|f| f.0).collect(),
            position,
            ..Points::default()
        };
        let parametric: Vec<_> = found.iter().map(|f| f.1).collect();
        let taking_part = vec![true; mesh.cells.len()];
        let mut stencil = Stencil::default();
        stencil.fill::<K>(Scheme::Mpm, &mesh, &points.cell, &parametric, &taking_part);
        let grid = Restored {
            mesh: &mesh,
            locator: &locator,
            points: &points,
            parametric: &parametric,
            stencil: &stencil,
            taking_part: &taking_part,
            before: (&mesh, &locator),
            outlines: &[],
            relaxed: false,
            displacement: None,
        };
        // The cells with points are not all full: the contour it must be.
        let mut front = None;
        let weighing = Fitted::<K>::new(&mesh).weigh(&grid, &mut front);
        assert!(front.is_none() && weighing.lost_front.is_some());
        (mesh, points, stencil, weighing)
    }

    fn check<K: Kinematics<2>>(kind: CellKind) {
        let (mesh, points, stencil, weighing) = weigh::<K>(kind, 0.6);
        let Weighing { weight, soft, poor, tally, .. } = &weighing;
        assert_eq!((tally.quadratic + tally.linear + tally.constant) as usize, stencil.patches.len());
        let degree = if kind == CellKind::T3 { tally.linear } else { tally.quadratic };
        assert!(degree as usize > stencil.patches.len() / 2, "{tally:?}");
        // The contour encloses the volume of the points; next to nothing of it is in cells without points.
        assert!((tally.fitted_volume / tally.point_volume - 1.0).abs() < 0.01, "{tally:?}");
        let current: f64 = (0..points.len()).map(|p| weight[p] * points.deformation[p].determinant()).sum();
        assert!((current / tally.fitted_volume - 1.0).abs() < 1e-12);
        assert!(weight.iter().all(|w| *w > 0.0) && tally.drift.abs() < 0.5, "{tally:?}");
        // Full below the surface, empty above it.
        let heights = |cell: u32| mesh.cells.nodes(cell as usize).iter().map(|&n| mesh.nodes[n as usize][1]);
        for soft in soft {
            let top = heights(soft.cell).fold(0.0, f64::max);
            assert!(top > 0.5 && soft.emptiness > 0.0 && soft.emptiness <= 1.0, "{soft:?}");
            assert!(soft.emptiness == 1.0 || heights(soft.cell).fold(1.0, f64::min) < 0.7);
        }
        assert!(poor.is_sorted() && poor.iter().filter(|&&c| heights(c).fold(0.0, f64::max) > 0.58).count() > 4);
    }

    #[test]
    fn a_block_with_a_free_surface_is_weighed() {
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9] {
            check::<PlaneStrain>(kind);
            check::<Axisymmetric>(kind);
        }
    }
}
