//! The material points: a struct of arrays.

mod columns;

pub use columns::{Column, Item, Maker, Merged, Numbers, PairVisitor, Presence, Type, Visitor, padded};

use crate::kinematics::Kinematics;
use crate::material::spectral::map_roots;
use crate::material::{Model, RandomStrength, State, internal_count, strength_at};
use crate::mesh::height;
use crate::tensor::{Symmetric, Tensor, full, symmetric};
use rayon::prelude::*;
use std::sync::Arc;

/// Declares [`Points`] and the table of its columns: an entry is a field with its documentation, its type and its [`Column`].
macro_rules! columns {
    ($($(#[$about:meta])* $name:ident: [$item:ty] = $column:expr;)*) => {
        /// All material points of a scene. Every column has one entry a point, `internal` and `domain` as many as the scene needs; a column that a
        /// scene or its state does not need is empty.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Points<const D: usize> {
            $($(#[$about])* pub $name: Vec<$item>,)*
        }

        impl<const D: usize> Points<D> {
            /// Shows all columns to a visitor, in the order of the table.
            pub fn each<'a>(&'a self, visitor: &mut impl Visitor<'a>) {
                $(visitor.visit(&const { Column { name: stringify!($name), ..$column } }, &self.$name);)*
            }

            /// Shows all columns to a visitor, each with that of other points.
            pub fn each_with(&mut self, other: &Self, visitor: &mut impl PairVisitor) {
                $(visitor.visit(&const { Column { name: stringify!($name), ..$column } }, &mut self.$name, &other.$name);)*
            }

            /// Makes all columns, in the order of the table.
            ///
            /// # Errors
            /// The first of `make`.
            pub fn make<E>(maker: &mut impl Maker<Error = E>) -> std::result::Result<Self, E> {
                Ok(Self { $($name: maker.make(&const { Column { name: stringify!($name), ..$column } })?,)* })
            }
        }
    };
}

columns! {
    /// Position (m) at the last converged step.
    position: [[f64; D]] = Column::of("m").merged(Merged::ByMass);
    /// Position (m) at which the point was seeded; depth-dependent parameters are taken here.
    origin: [[f64; D]] = Column::of("m").merged(Merged::ByMass);
    /// Position (m) that displacements are counted from, as of the last reset; empty before one: from the origin.
    reference: [[f64; D]] = Column::of("m").merged(Merged::ByMass).comes_and_goes().of_material_points();
    /// Velocity (m/s); empty in a quasi-static analysis.
    velocity: [[f64; D]] = Column::of("m/s").merged(Merged::ByMass).comes_and_goes().seeded().of_material_points();
    /// Acceleration (m/s²); empty in a quasi-static analysis.
    acceleration: [[f64; D]] = Column::of("m/s2").merged(Merged::ByMass).comes_and_goes().of_material_points();
    /// Mass (t), per metre in plane strain, per full turn (2π) in axisymmetry.
    mass: [f64] = Column::of("t").merged(Merged::Sum);
    /// Volume (m³) when seeded, per metre in plane strain, per full turn (2π) in axisymmetry.
    initial_volume: [f64] = Column::of("m3").merged(Merged::Sum);
    /// Deformation gradient (-) since seeding.
    deformation: [Tensor] = Column::of("-");
    /// Elastic left Cauchy–Green tensor (-).
    elastic: [Symmetric] = Column::of("-").of_material();
    /// Cauchy stress (kPa), tension positive, at the last converged step.
    stress: [Symmetric] = Column::of("kPa").of_material();
    /// Accumulated equivalent plastic strain (-).
    plastic_strain: [f64] = Column::of("-").merged(Merged::BySeededVolume).of_material();
    /// What the last converged step added to it (-); empty in finite elements and before the first step.
    plastic_increment: [f64] = Column::of("-").merged(Merged::BySeededVolume).comes_and_goes();
    /// Internal variables of the models, as many numbers for each point as the model with most of them has
    /// ([`crate::material::State::internal`]).
    internal: [f64] = Column::of("-").merged(Merged::BySeededVolume).of_scene().several().of_material();
    /// Kirchhoff mean stress (kPa), tension positive, that the pressure field carries; empty without one.
    pressure: [f64] = Column::of("kPa").merged(Merged::BySeededVolume).of_scene().of_material();
    /// Excess pressure (kPa) of the water in the pores, compression positive, at the last converged step; empty without pore water.
    pore_pressure: [f64] = Column::of("kPa").merged(Merged::ByVolume).of_scene().seeded().of_material();
    /// The domain of the point as its scheme describes it (m), as many numbers for each point as that needs, as of the last grid reset; empty for
    /// schemes whose points have no extent.
    domain: [f64] = Column::of("m").comes_and_goes().several().of_material_points();
    /// The strength over that of the parameters of the material (-), by its random field where the point was seeded
    /// ([`crate::material::RandomStrength`]); empty where no material of the scene has one.
    strength: [f64] = Column::of("-").merged(Merged::ByMass).of_scene().seeded();
    /// Index into the regions of the mesh.
    region: [u16] = Column::of("-");
    /// Number of the material among those of a scene: first one a region of the mesh, then one a change of it; empty where no
    /// phase changes a material.
    model: [u16] = Column::of("-").comes_and_goes();
    /// The cell that holds the point.
    cell: [u32] = Column::of("-");
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

    /// Height (m) at which point `p` was seeded, by which depth-dependent parameters are taken.
    #[inline]
    pub fn seeded_height(&self, p: usize) -> f64 {
        height(&self.origin[p])
    }

    /// The number of the material of point `p`: that of its region, unless a phase has changed it.
    #[inline]
    pub fn model_of(&self, p: usize) -> usize {
        usize::from(*self.model.get(p).unwrap_or(&self.region[p]))
    }

    /// What a list by the numbers of materials has for that of point `p`.
    #[inline]
    pub fn by_material<'a, T>(&self, p: usize, list: &'a [Option<T>]) -> Option<&'a T> {
        list.get(self.model_of(p))?.as_ref()
    }

    /// The state of point `p` for its model; `inverse_dt` (1/s) is one over the step size, 0 without time effects.
    #[inline]
    pub fn state(&self, p: usize, inverse_dt: f64) -> State<'_> {
        let (plastic_strain, internal) = (self.plastic_strain[p], self.internal_of(p));
        State { plastic_strain, internal, inverse_dt, strength: self.strength_of(p), stiffening: 0.0 }
    }

    /// The strength of point `p` over that of the parameters of its material (-).
    #[inline]
    pub fn strength_of(&self, p: usize) -> f64 {
        self.strength.get(p).copied().unwrap_or(1.0)
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

    /// Gives the points the first values of the internal variables of their models, by number of the material: all of a scene, with those that
    /// phases change to, so that there is room for each. Points without internal variables begin every step with the first values.
    pub fn begin(&mut self, models: &[Option<Arc<dyn Model>>]) {
        let count = models.iter().flatten().map(|model| internal_count(model.as_ref())).max().unwrap_or(0);
        self.internal = vec![0.0; count * self.len()];
        for p in 0..self.len() {
            if let Some(model) = self.by_material(p, models) {
                self.begin_internal(p, model.as_ref());
            }
        }
    }

    /// Gives the points the strength over that of the parameters, given the fields of the materials by number: nothing where there is none.
    pub fn vary(&mut self, fields: &[Option<Arc<RandomStrength>>]) {
        self.strength.clear();
        if fields.iter().any(Option::is_some) {
            let of = |p: usize| strength_at(fields, self.model_of(p), &self.origin[p]);
            self.strength = (0..self.len()).into_par_iter().map(of).collect();
        }
    }

    /// Gives point `p` the first values of the internal variables of a model.
    pub fn begin_internal(&mut self, p: usize, model: &dyn Model) {
        let y = self.seeded_height(p);
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

    /// Hencky strain (-) of point `p` since seeding, `½ ln FFᵀ`.
    pub fn strain(&self, p: usize) -> Symmetric {
        let f = &self.deformation[p];
        map_roots(&symmetric(&(f * f.transpose())), |squares| squares.map(|square| 0.5 * square.ln()))
    }

    /// The points with the given numbers, in that order.
    pub fn select(&self, numbers: &[usize]) -> Self {
        struct Pick<'a> {
            numbers: &'a [usize],
            count: usize,
        }
        impl PairVisitor for Pick<'_> {
            fn visit<T: Item>(&mut self, _: &Column, own: &mut Vec<T>, other: &[T]) {
                let width = columns::width(other, self.count);
                own.reserve_exact(self.numbers.len() * width);
                own.extend(self.numbers.iter().flat_map(|&p| &other[p * width..(p + 1) * width]));
            }
        }
        let mut selected = Self::default();
        selected.each_with(self, &mut Pick { numbers, count: self.len() });
        selected
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
        self.append(&other);
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
        let mut merge = Merge { q, count: self.len(), by_mass, by_seeded_volume: share, by_volume };
        one.each_with(self, &mut merge);
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
    pub fn append(&mut self, other: &Self) {
        struct Append;
        impl PairVisitor for Append {
            fn visit<T: Item>(&mut self, _: &Column, own: &mut Vec<T>, other: &[T]) {
                own.extend_from_slice(other);
            }
        }
        self.each_with(other, &mut Append);
    }

    /// Gives point `p` the state of the material at point `q` of `other`, but for the deformation.
    pub fn take_state(&mut self, p: usize, other: &Self, q: usize) {
        struct Take {
            places: [usize; 2],
            counts: [usize; 2],
        }
        impl PairVisitor for Take {
            fn visit<T: Item>(&mut self, column: &Column, own: &mut Vec<T>, other: &[T]) {
                let width = columns::width(own, self.counts[0]);
                if column.of_material && width == columns::width(other, self.counts[1]) {
                    let [p, q] = self.places.map(|place| place * width..(place + 1) * width);
                    own[p].copy_from_slice(&other[q]);
                }
            }
        }
        let counts = [self.len(), other.len()];
        self.each_with(other, &mut Take { places: [p, q], counts });
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

/// Merges point `q` of `count` into one that has the columns of another, given the shares of `q`.
struct Merge {
    q: usize,
    count: usize,
    by_mass: f64,
    by_seeded_volume: f64,
    by_volume: f64,
}

impl PairVisitor for Merge {
    fn visit<T: Item>(&mut self, column: &Column, own: &mut Vec<T>, other: &[T]) {
        let width = columns::width(other, self.count);
        let values = own.iter_mut().zip(&other[self.q * width..(self.q + 1) * width]);
        let share = match column.merged {
            Merged::First => return,
            Merged::Sum => return values.for_each(|(own, other)| *own = own.plus(other)),
            Merged::ByMass => self.by_mass,
            Merged::BySeededVolume => self.by_seeded_volume,
            Merged::ByVolume => self.by_volume,
        };
        values.for_each(|(own, other)| *own = own.mixed(share, other));
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
