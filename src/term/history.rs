//! What the converged state of a step makes of the history of points.

use crate::points::Points;
use crate::tensor::{Symmetric, Tensor};
use rayon::prelude::*;

/// New values of the history of one point.
pub struct History {
    pub point: usize,
    pub deformation: Tensor,
    pub elastic: Symmetric,
    pub stress: Symmetric,
    pub plastic_strain: f64,
    /// What the pressure field carries (kPa); not kept by points without the column.
    pub pressure: f64,
    /// The excess pressure (kPa) of the water in the pores; not kept by points without the column.
    pub pore_pressure: f64,
    pub dissipated: Dissipated,
}

/// What a step dissipates (kJ): as material yields, and as water flows through its pores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dissipated {
    pub plastic: f64,
    pub seepage: f64,
}

/// New values of the history of some points.
#[derive(Default)]
pub struct Histories {
    pub points: Vec<History>,
    /// Their internal variables, one point after the other; not kept by points without the column.
    pub internal: Vec<f64>,
    /// The points that have no new values: they are strained beyond the range of their model.
    pub failed: Vec<usize>,
}

impl Histories {
    /// Room for some points with `count` numbers of internal variables each.
    pub fn with_capacity(points: usize, count: usize) -> Self {
        let (points, internal) = (Vec::with_capacity(points), Vec::with_capacity(points * count));
        Self { points, internal, failed: Vec::new() }
    }

    /// Adds `point` with its new values, if it has some, given room for its `count` numbers of internal variables.
    pub fn add(&mut self, point: usize, count: usize, new: impl FnOnce(&mut [f64]) -> Option<History>) {
        let before = self.internal.len();
        self.internal.resize(before + count, 0.0);
        match new(&mut self.internal[before..]) {
            Some(history) => self.points.push(history),
            None => {
                self.internal.truncate(before);
                self.failed.push(point);
            }
        }
    }
}

/// New values of the points' history, in lists of any length and order.
pub struct Update(pub Vec<Histories>);

impl Update {
    /// The points that have no new values: they are strained beyond the range of their model.
    pub fn failed(&self) -> impl Iterator<Item = usize> {
        self.0.iter().flat_map(|list| &list.failed).copied()
    }

    /// What all points dissipate.
    pub fn dissipated(&self) -> Dissipated {
        let points = self.0.iter().flat_map(|list| &list.points);
        points.fold(Dissipated::default(), |sum, History { dissipated, .. }| Dissipated {
            plastic: sum.plastic + dissipated.plastic,
            seepage: sum.seepage + dissipated.seepage,
        })
    }

    /// The new values of each point of some number.
    fn by_point(&self, count: usize) -> Vec<Option<&History>> {
        let mut of_point = vec![None; count];
        self.0.iter().flat_map(|list| &list.points).for_each(|new| of_point[new.point] = Some(new));
        of_point
    }

    /// Writes the new values.
    pub fn apply<const D: usize>(&self, points: &mut Points<D>) {
        let of_point = self.by_point(points.len());
        let increment = &mut points.plastic_increment;
        increment.par_iter_mut().zip(&points.plastic_strain).zip(&of_point).for_each(|((increment, before), new)| {
            if let Some(new) = new {
                *increment = new.plastic_strain - before;
            }
        });
        write(&mut points.deformation, &of_point, |new| new.deformation);
        write(&mut points.stress, &of_point, |new| new.stress);
        self.write_state(points, &of_point);
    }

    /// Writes the new values but for the deformation: the same Kirchhoff stresses in the volume that there was.
    pub fn apply_stresses<const D: usize>(self, points: &mut Points<D>) {
        let of_point = self.by_point(points.len());
        let columns = points.stress.par_iter_mut().zip(&points.deformation).zip(&of_point);
        columns.with_min_len(1024).for_each(|((stress, deformation), new)| {
            if let Some(new) = new {
                let over = new.deformation.determinant() / deformation.determinant();
                *stress = new.stress.map(|s| s * over);
            }
        });
        self.write_state(points, &of_point);
    }

    /// Writes all but the deformation, and what depends on that.
    fn write_state<const D: usize>(&self, points: &mut Points<D>, of_point: &[Option<&History>]) {
        write(&mut points.elastic, of_point, |new| new.elastic);
        write(&mut points.plastic_strain, of_point, |new| new.plastic_strain);
        write(&mut points.pressure, of_point, |new| new.pressure);
        write(&mut points.pore_pressure, of_point, |new| new.pore_pressure);
        let count = points.internal_count();
        if count == 0 {
            return;
        }
        for Histories { points: new, internal, .. } in &self.0 {
            for (history, internal) in new.iter().zip(internal.chunks_exact(count)) {
                points.internal_mut(history.point).copy_from_slice(internal);
            }
        }
    }
}

/// Writes the new values of the points that have one into a column, which may be empty.
fn write<T: Send>(column: &mut [T], of_point: &[Option<&History>], value: impl Fn(&History) -> T + Sync) {
    column.par_iter_mut().zip(of_point).with_min_len(1024).for_each(|(old, new)| {
        if let Some(new) = new {
            *old = value(new);
        }
    });
}
