//! What acts at a place, and its force and tangent.

use crate::error::Error;
use crate::interpolation::MAX_FUNCTIONS;
use crate::kinematics::{Gradient, Kinematics};
use crate::system::Local;
use crate::tensor::Tensor;
use crate::term::hydrostatic::{Momentary, MomentaryPhreatic};

/// What acts at one time.
#[derive(Clone, Copy)]
pub struct Acting<'a> {
    pub outside: Option<Momentary>,
    pub inside: Option<MomentaryPhreatic<'a>>,
}

/// The pressures (kPa) at a place.
pub struct Pressures {
    /// The slope of that outside by the height, and its slope (kPa/m, kPa/m²).
    slope: f64,
    second: f64,
    /// What is left of it in the material beside that in the pores, and the slopes of that by x and y.
    left: f64,
    left_slope: [f64; 2],
}

impl Acting<'_> {
    /// That which acts on material with or without pores.
    pub fn on(self, porous: bool) -> Self {
        Self { inside: self.inside.filter(|_| porous), ..self }
    }

    pub fn map(self, to: impl Fn(Momentary) -> Momentary) -> Self {
        let inside = self.inside.map(|inside| MomentaryPhreatic { head: to(inside.head), ..inside });
        Self { outside: self.outside.map(&to), inside }
    }

    /// That at a place (m); `None` where there is nothing.
    pub fn at(self, [x, y]: [f64; 2]) -> Option<Pressures> {
        let [p, slope, second] = self.outside.map_or([0.0; 3], |head| head.at(y));
        let [u, by_x, by_y] = self.inside.map_or([0.0; 3], |head| head.at(x, y));
        let nothing = [p, slope, u, by_y] == [0.0; 4];
        (!nothing).then_some(Pressures { slope, second, left: p - u, left_slope: [-by_x, slope - by_y] })
    }
}

/// A place over which the term is summed.
pub struct Place<'a, const D: usize> {
    /// The values of functions at the nodes, and the gradients of all, in the configuration of the grid.
    pub value: &'a [f64],
    pub gradient: &'a [Gradient<D>],
    /// The inverse of the deformation of the grid there by these gradients.
    pub inverse: Tensor,
    /// The gradients that strains are taken with and the inverse by them, where these are others.
    pub strained: Option<(&'a [Gradient<D>], Tensor)>,
    /// The volume (m³) in the trial state.
    pub volume: f64,
    pub pressures: Pressures,
}

impl<const D: usize> Place<'_, D> {
    /// Adds the force, and the tangent by `share` of the displacement.
    pub fn add<K: Kinematics<D>>(&self, share: f64, local: &mut Local) {
        let Self { volume, pressures: Pressures { slope, second, left, left_slope }, .. } = *self;
        let count = self.gradient.len();
        let mut spatial = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_FUNCTIONS];
        let mut divergence = [[0.0; D]; MAX_FUNCTIONS];
        for i in 0..count {
            spatial[i] = K::push_forward(&self.gradient[i], &self.inverse);
            divergence[i] = K::force(&Tensor::identity(), &spatial[i]);
        }
        let swollen: Option<Vec<[f64; D]>> = self.strained.map(|(gradients, inverse)| {
            let strains = gradients.iter().map(|gradient| K::push_forward(gradient, &inverse));
            strains.map(|strain| K::force(&Tensor::identity(), &strain)).collect()
        });
        let value = |i: usize| self.value.get(i).copied().unwrap_or(0.0);
        for i in 0..count {
            for d in 0..D {
                local.vector[i * D + d] += volume * left * divergence[i][d];
            }
            local.vector[i * D + 1] += volume * slope * value(i);
        }
        if local.matrix.is_empty() {
            return;
        }
        let weight = share * volume;
        for i in 0..count {
            for j in 0..count {
                let (a, b, size) = (&spatial[i], &spatial[j], local.size);
                let swelling = swollen.as_ref().map_or(&divergence[j], |swollen| &swollen[j]);
                for d in 0..D {
                    for e in 0..D {
                        let mut entry = left * (divergence[i][d] * swelling[e] - a.g[e] * b.g[d]);
                        if d == 0 && e == 0 {
                            entry -= left * a.hoop * b.hoop;
                        }
                        if e < 2 {
                            entry += left_slope[e] * divergence[i][d] * value(j);
                        }
                        if d == 1 {
                            entry += slope * value(i) * swelling[e];
                        }
                        if d == 1 && e == 1 {
                            entry += second * value(i) * value(j);
                        }
                        local.matrix[(i * D + d) * size + j * D + e] += weight * entry;
                    }
                }
            }
        }
    }
}

/// The inverse and the determinant of a deformation; an error where the latter is not positive.
pub fn invert(deformed: &Tensor) -> std::result::Result<(Tensor, f64), f64> {
    let determinant = deformed.determinant();
    let inverse = deformed.try_inverse().filter(|_| determinant > 0.0);
    inverse.map(|inverse| (inverse, determinant)).ok_or(determinant)
}

pub fn inside_out(what: String, determinant: f64) -> Error {
    Error::analysis(
        what,
        format!("is turned inside out (det F {determinant:.3})"),
        "take smaller steps or refine the mesh",
    )
}
