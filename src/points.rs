//! The material points: a struct of arrays.

use crate::kinematics::Kinematics;
use crate::material::{Model, State, internal_count};
use crate::tensor::{Symmetric, Tensor, full};
use std::sync::Arc;

/// All material points of a scene. Every column has one entry a point; `velocity` and `acceleration`
/// are empty in a quasi-static analysis, `plastic_increment` in finite elements and before the first step, `internal` where no model has internal variables,
/// `pressure` without a pressure field, `pore_pressure` without pore water, `model` where no phase changes a material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points<const D: usize> {
    /// Position (m) at the last converged step.
    pub position: Vec<[f64; D]>,
    /// Position (m) at which the point was seeded; depth-dependent parameters are taken here.
    pub origin: Vec<[f64; D]>,
    /// Position (m) that displacements are counted from, as of the last reset; empty before one: from the origin.
    pub reference: Vec<[f64; D]>,
    /// Velocity (m/s).
    pub velocity: Vec<[f64; D]>,
    /// Acceleration (m/s²).
    pub acceleration: Vec<[f64; D]>,
    /// Mass (t), per metre in plane strain, per full turn (2π) in axisymmetry.
    pub mass: Vec<f64>,
    /// Volume (m³) when seeded, per metre in plane strain, per full turn (2π) in axisymmetry.
    pub initial_volume: Vec<f64>,
    /// Deformation gradient (-) since seeding.
    pub deformation: Vec<Tensor>,
    /// Elastic left Cauchy–Green tensor (-).
    pub elastic: Vec<Symmetric>,
    /// Cauchy stress (kPa), tension positive, at the last converged step.
    pub stress: Vec<Symmetric>,
    /// Accumulated equivalent plastic strain (-).
    pub plastic_strain: Vec<f64>,
    /// What the last converged step added to it (-).
    pub plastic_increment: Vec<f64>,
    /// Internal variables of the models, as many numbers for each point as the model with most of them has
    /// ([`crate::material::State::internal`]).
    pub internal: Vec<f64>,
    /// Kirchhoff mean stress (kPa), tension positive, that the pressure field carries.
    pub pressure: Vec<f64>,
    /// Excess pressure (kPa) of the water in the pores, compression positive, at the last converged step.
    pub pore_pressure: Vec<f64>,
    /// Index into the regions of the mesh.
    pub region: Vec<u16>,
    /// Number of the material among those of a scene: first one a region of the mesh, then one a change of it.
    pub model: Vec<u16>,
    /// The cell that holds the point.
    pub cell: Vec<u32>,
}

impl<const D: usize> Points<D> {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// What messages call point `p`.
    pub fn name(&self, p: usize) -> String {
        format!("material point {p} at {:.3?} m", self.position[p])
    }

    /// Displacement (m) of point `p` since seeding or the last reset.
    pub fn displacement(&self, p: usize) -> [f64; D] {
        let from = self.reference.get(p).unwrap_or(&self.origin[p]);
        std::array::from_fn(|d| self.position[p][d] - from[d])
    }

    /// The number of the material of point `p`: that of its region, unless a phase has changed it.
    #[inline]
    pub fn model_of(&self, p: usize) -> usize {
        usize::from(*self.model.get(p).unwrap_or(&self.region[p]))
    }

    /// The state of point `p` for its model, in a step of which `inverse_dt` (1/s) make a second; 0 at rest.
    #[inline]
    pub fn state(&self, p: usize, inverse_dt: f64) -> State<'_> {
        let (plastic_strain, internal) = (self.plastic_strain[p], self.internal_of(p));
        State { plastic_strain, internal, inverse_dt, increment: None }
    }

    /// Numbers that each point has in `internal`.
    #[inline]
    pub fn internal_count(&self) -> usize {
        if self.internal.is_empty() { 0 } else { self.internal.len() / self.len() }
    }

    /// The internal variables of point `p`.
    #[inline]
    pub fn internal_of(&self, p: usize) -> &[f64] {
        let count = self.internal_count();
        &self.internal[p * count..(p + 1) * count]
    }

    #[inline]
    pub fn internal_mut(&mut self, p: usize) -> &mut [f64] {
        let count = self.internal_count();
        &mut self.internal[p * count..(p + 1) * count]
    }

    /// Gives the points the first values of the internal variables of their models, by number of the material.
    pub fn begin(&mut self, models: &[Option<Arc<dyn Model>>]) {
        let count = models.iter().flatten().map(|model| internal_count(model.as_ref())).max().unwrap_or(0);
        self.internal = vec![0.0; count * self.len()];
        for p in 0..self.len() {
            if let Some(Some(model)) = models.get(self.model_of(p)) {
                self.begin_internal(p, model.as_ref());
            }
        }
    }

    /// Gives point `p` the first values of the internal variables of a model.
    pub fn begin_internal(&mut self, p: usize, model: &dyn Model) {
        let y = self.origin[p][1];
        let internal = self.internal_mut(p);
        internal.fill(0.0);
        if !internal.is_empty() {
            model.begin(y, internal);
        }
    }

    /// Current volume (m³) of point `p`, by the measure of `initial_volume`.
    pub fn volume(&self, p: usize) -> f64 {
        self.initial_volume[p] * self.deformation[p].determinant()
    }

    /// The points with the given numbers, in that order.
    pub fn select(&self, numbers: &[usize]) -> Self {
        fn pick<T: Clone>(column: &[T], numbers: &[usize]) -> Vec<T> {
            if column.is_empty() { Vec::new() } else { numbers.iter().map(|&p| column[p].clone()).collect() }
        }
        Self {
            position: pick(&self.position, numbers),
            origin: pick(&self.origin, numbers),
            reference: pick(&self.reference, numbers),
            velocity: pick(&self.velocity, numbers),
            acceleration: pick(&self.acceleration, numbers),
            mass: pick(&self.mass, numbers),
            initial_volume: pick(&self.initial_volume, numbers),
            deformation: pick(&self.deformation, numbers),
            elastic: pick(&self.elastic, numbers),
            stress: pick(&self.stress, numbers),
            plastic_strain: pick(&self.plastic_strain, numbers),
            plastic_increment: pick(&self.plastic_increment, numbers),
            internal: numbers.iter().flat_map(|&p| self.internal_of(p)).copied().collect(),
            pressure: pick(&self.pressure, numbers),
            pore_pressure: pick(&self.pore_pressure, numbers),
            region: pick(&self.region, numbers),
            model: pick(&self.model, numbers),
            cell: pick(&self.cell, numbers),
        }
    }

    /// Splits point `p` into halves at `by` and `-by` (m) from it; that at `-by` keeps its number. They have its state and its velocity, and half of its mass
    /// and volume, and were seeded on both sides of its origin. Returns the number of the other.
    pub fn split<K: Kinematics<D>>(&mut self, p: usize, by: [f64; D]) -> usize {
        self.mass[p] *= 0.5;
        // Half of it is seeded within the point's own domain, however far it has been sheared.
        let width = (self.initial_volume[p] / K::measure(&self.origin[p])).sqrt();
        self.initial_volume[p] *= 0.5;
        let seeded = self.deformation[p]
            .try_inverse()
            .map_or([0.0; D], |inverse| std::array::from_fn(|i| (0..D).map(|j| inverse[(i, j)] * by[j]).sum::<f64>()));
        let length = seeded.iter().map(|s| s * s).sum::<f64>().sqrt();
        let seeded = seeded.map(|s| s * (0.25 * width / length.max(0.25 * width)));
        let other = self.select(&[p]);
        let q = self.len();
        self.append(other);
        for (half, sign) in [(q, 1.0), (p, -1.0)] {
            for d in 0..D {
                self.position[half][d] += sign * by[d];
                self.origin[half][d] += sign * seeded[d];
            }
            if let Some(reference) = self.reference.get_mut(half) {
                (0..D).for_each(|d| reference[d] += sign * by[d]);
            }
        }
        q
    }

    /// The point that `p` and `q` become together, of the material and in the cell of `p`, but for its elastic strain and stress, which are those of `p`; and the
    /// moments of momentum (t m²/s) and of its rate about their centre that it lacks, in the plane.
    pub fn joined(&self, p: usize, q: usize) -> (Self, [f64; 2]) {
        let mut one = self.select(&[p]);
        let mass = self.mass[p] + self.mass[q];
        let initial_volume = self.initial_volume[p] + self.initial_volume[q];
        let volume = self.volume(p) + self.volume(q);
        let share = self.initial_volume[q] / initial_volume;
        // Without mass, by volume.
        let by_mass = if mass > 0.0 { self.mass[q] / mass } else { share };
        let by_volume = self.volume(q) / volume;
        let mix = |share: f64, a: f64, b: f64| a + share * (b - a);
        let vectors = |of: &[[f64; D]]| -> Vec<[f64; D]> {
            let one = |p: &[f64; D], q: &[f64; D]| std::array::from_fn(|d| mix(by_mass, p[d], q[d]));
            of.get(p).map(|at| one(at, &of[q])).into_iter().collect()
        };
        let scalars =
            |of: &[f64], share: f64| -> Vec<f64> { of.get(p).map(|&at| mix(share, at, of[q])).into_iter().collect() };
        one.position = vectors(&self.position);
        one.origin = vectors(&self.origin);
        one.reference = vectors(&self.reference);
        one.velocity = vectors(&self.velocity);
        one.acceleration = vectors(&self.acceleration);
        one.mass = vec![mass];
        one.initial_volume = vec![initial_volume];
        one.plastic_strain = scalars(&self.plastic_strain, share);
        one.plastic_increment = scalars(&self.plastic_increment, share);
        one.internal =
            self.internal_of(p).iter().zip(self.internal_of(q)).map(|(&at, &of)| mix(share, at, of)).collect();
        one.pressure = scalars(&self.pressure, share);
        one.pore_pressure = scalars(&self.pore_pressure, by_volume);
        let mean = self.deformation[p] + (self.deformation[q] - self.deformation[p]) * share;
        // Points that have turned against each other have no mean: the larger one's then.
        let larger = if share > 0.5 { q } else { p };
        let mut deformation = if mean.determinant() > 0.0 { mean } else { self.deformation[larger] };
        let stretch = (volume / initial_volume / deformation.determinant()).sqrt();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            deformation[(i, j)] *= stretch;
        }
        one.deformation = vec![deformation];
        let apart = |of: &[[f64; D]], d: usize| of.get(q).map_or(0.0, |at| at[d] - of[p][d]);
        let reduced = self.mass[p] * by_mass;
        let spin = |of: &[[f64; D]]| {
            let x = &self.position;
            reduced * (apart(x, 0) * apart(of, 1) - apart(x, 1) * apart(of, 0))
        };
        let spins = [spin(&self.velocity), spin(&self.acceleration)];
        (one, spins)
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Puts `other` behind these points; both have the same columns.
    pub fn append(&mut self, mut other: Self) {
        self.position.append(&mut other.position);
        self.origin.append(&mut other.origin);
        self.reference.append(&mut other.reference);
        self.velocity.append(&mut other.velocity);
        self.acceleration.append(&mut other.acceleration);
        self.mass.append(&mut other.mass);
        self.initial_volume.append(&mut other.initial_volume);
        self.deformation.append(&mut other.deformation);
        self.elastic.append(&mut other.elastic);
        self.stress.append(&mut other.stress);
        self.plastic_strain.append(&mut other.plastic_strain);
        self.plastic_increment.append(&mut other.plastic_increment);
        self.internal.append(&mut other.internal);
        self.pressure.append(&mut other.pressure);
        self.pore_pressure.append(&mut other.pore_pressure);
        self.region.append(&mut other.region);
        self.model.append(&mut other.model);
        self.cell.append(&mut other.cell);
    }

    /// Checks points from a file, whose numbers are finite: that they are in regions and cells that exist, and that each
    /// has a volume, a mass and a deformation that material can have.
    ///
    /// # Errors
    /// The first point at fault and what is wrong with it.
    pub fn check(&self, regions: usize, cells: usize) -> Result<(), String> {
        (0..self.len()).try_for_each(|p| {
            let (region, cell) = (self.region[p], self.cell[p]);
            let volume_ratio = self.deformation[p].determinant();
            let wrong = if usize::from(region) >= regions {
                format!("is in region {region} of {regions}")
            } else if cell as usize >= cells {
                format!("is in cell {cell} of {cells}")
            } else if self.initial_volume[p] <= 0.0 {
                format!("has the volume {:e} m³", self.initial_volume[p])
            } else if self.mass[p] < 0.0 {
                format!("has the mass {:e} t", self.mass[p])
            } else if !(volume_ratio > 0.0 && volume_ratio.is_finite()) {
                format!("has a deformation gradient with the determinant {volume_ratio:e}")
            } else if !is_positive_definite(&self.elastic[p]) {
                "has an elastic strain tensor that is not positive definite".to_string()
            } else if self.plastic_strain[p] < 0.0 {
                format!("has the plastic strain {:e}", self.plastic_strain[p])
            } else {
                return Ok(());
            };
            Err(format!("{} {wrong}", self.name(p)))
        })
    }
}

/// Whether all principal values are positive and their product is a number.
fn is_positive_definite(s: &Symmetric) -> bool {
    let determinant = full(s).determinant();
    s[0] > 0.0 && s[0] * s[1] - s[3] * s[3] > 0.0 && determinant > 0.0 && determinant.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::IDENTITY;

    #[test]
    fn each_fault_of_a_point_is_named() {
        let sound = Points::<2> {
            position: vec![[0.0; 2]; 2],
            origin: vec![[0.0; 2]; 2],
            mass: vec![0.0; 2],
            initial_volume: vec![1.0; 2],
            deformation: vec![Tensor::identity(); 2],
            elastic: vec![IDENTITY; 2],
            stress: vec![[0.0; 6]; 2],
            plastic_strain: vec![0.0; 2],
            region: vec![2; 2],
            cell: vec![4; 2],
            ..Points::default()
        };
        assert_eq!(sound.check(3, 5), Ok(()));
        type Fault = (fn(&mut Points<2>), &'static str);
        let faults: [Fault; 8] = [
            (|p| p.region[1] = 3, "region 3 of 3"),
            (|p| p.cell[1] = 5, "cell 5 of 5"),
            (|p| p.initial_volume[1] = 0.0, "volume"),
            (|p| p.mass[1] = -1.0, "mass"),
            (|p| p.deformation[1][(0, 0)] = -1.0, "determinant -1"),
            (|p| p.deformation[1] *= 1e200, "determinant inf"),
            (|p| p.elastic[1][3] = 1.0, "positive definite"),
            (|p| p.plastic_strain[1] = -1e-3, "plastic strain"),
        ];
        for (fault, says) in faults {
            let mut points = sound.clone();
            fault(&mut points);
            let problem = points.check(3, 5).unwrap_err();
            assert!(problem.starts_with("material point 1 at") && problem.contains(says), "{problem}");
        }
    }
}
