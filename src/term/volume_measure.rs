//! Measures of the volume strain that the pressure field is conjugate to.

use super::Ratios;
use super::mixed_pressure::MixedPressure;
use crate::material::cavitation::Volumetric;
use crate::points::Points;

/// Most iterations for the volume at a pressure; it takes two or three.
pub(super) const ITERATIONS: usize = 20;

/// What the field is conjugate to at a point: `ln j`, or where the field is in tension as the step begins `½ j²`, and `j` where the tension has a
/// limit. `j` is the volume over that when the grid was restored. In steps with inertia it is `j` everywhere: a change of the measure would bring
/// energy.
#[derive(Clone, Copy)]
pub(super) enum Measure {
    Logarithm,
    Volume,
    Square,
}

impl Measure {
    /// That of point `p`; `inertia` says whether the step has it.
    pub fn of<const D: usize>(carried: &MixedPressure, points: &Points<D>, p: usize, inertia: bool) -> Self {
        match points.pressure[p] > 0.0 {
            _ if carried.is_whole() => Self::Logarithm,
            _ if inertia => Self::Volume,
            false => Self::Logarithm,
            true if carried.limit.is_some() => Self::Volume,
            true => Self::Square,
        }
    }

    /// The power `n` of the measure `jⁿ/n`; 0 of the logarithm.
    pub(super) fn power(self) -> i32 {
        self as i32
    }

    /// The slope of the measure in `ln j`: the Kirchhoff stress of a unit of the field.
    pub fn slope(self, ratio: f64) -> f64 {
        ratio.powi(self.power())
    }

    /// What a step of the given ratios adds to the measure.
    pub fn strain(self, ratios: Ratios) -> f64 {
        let before = ratios.grid / ratios.step;
        match self {
            Self::Logarithm => ratios.step.ln(),
            Self::Volume => ratios.grid - before,
            Self::Square => 0.5 * (ratios.grid.powi(2) - before.powi(2)),
        }
    }

    /// The volume (-) at the end of a step over that at its beginning by Hencky's law with a bulk modulus (kPa), from the same stresses and slope as
    /// [`Measure::elastic`]. `None` at a tension for which the law has no volume.
    pub fn ratio(self, bulk: f64, before: f64, pressure: f64, slope: f64) -> Option<f64> {
        let (then, now) = (before / bulk, slope * pressure / bulk);
        let ratio = match self {
            Self::Logarithm => (now - then).exp(),
            _ => least_root(self.power(), then, now, 1.0),
        };
        ratio.is_finite().then_some(ratio)
    }

    /// The volume strain of a law, by this measure, as the field goes from the Kirchhoff stress `before` to `pressure` (kPa), and its
    /// slope (1/kPa). `slope` is that of the measure as the step begins. Not a number at a tension for which the law has no volume,
    /// as at half the bulk modulus and above; such a trial state is refused.
    pub fn elastic(self, law: &Volumetric, before: f64, pressure: f64, slope: f64) -> [f64; 2] {
        let (then, compliance) = (law.strain(before)[0], 1.0 / law.bulk);
        match self {
            Self::Logarithm => {
                let [strain, compliance] = law.strain(pressure);
                [strain - then, compliance]
            }
            Self::Volume => {
                // The Cauchy stress is linear in the volume beyond the limit. `first` is the volume, over that without stress, as the step begins.
                let (first, (least, cauchy)) = (then.exp(), law.at_limit());
                let more = pressure * slope / first - cauchy;
                if more > 0.0 {
                    let x = (least + more / law.rise) / first;
                    return [slope * (x - 1.0), slope * slope / (first * first * law.rise)];
                }
                let now = compliance * pressure * slope;
                let x = least_root(1, then, now, (-then).exp());
                [slope * (x - 1.0), compliance * slope * slope * x / (1.0 / x - now)]
            }
            Self::Square => {
                let now = compliance * pressure * slope;
                let x = least_root(2, then, now, if then < 0.5 && now < 0.5 { 1.0 } else { f64::NAN });
                [0.5 * slope * (x * x - 1.0), compliance * slope * slope * x.powi(3) / (1.0 / x - 2.0 * now * x)]
            }
        }
    }
}

/// The least root of `then + ln x = now xⁿ` by Newton's method from `x`; not a number where it finds none. From the second iterate on it comes from below.
fn least_root(n: i32, then: f64, now: f64, mut x: f64) -> f64 {
    for _ in 0..ITERATIONS {
        let change = (then + f64::ln(x) - now * x.powi(n)) / (1.0 / x - f64::from(n) * now * x.powi(n - 1));
        x -= change;
        // What is left is the square of the last change.
        if change.abs() < 1e-9 * x {
            return x;
        }
    }
    f64::NAN
}
