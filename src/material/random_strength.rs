//! Strength that varies at random in space: a factor with the mean one, lognormal at every place, of a stationary field.
//!
//! `f(X) = exp(s z(X) − s²/2)`, `s² = ln(1 + v²)`, `v` the coefficient of variation and `z` a field with the mean 0, the variance 1 and the
//! correlation of [`Correlation`] (Fenton & Griffiths, *Risk Assessment in Geotechnical Engineering*, 2008). `X` is the place where the
//! soil was seeded, so that a realisation belongs to the material and not to a mesh.
//!
//! `z` is a sum of waves with random amplitudes, phases and wave vectors, these by the spectral density of the correlation (Shinozuka & Jan 1972,
//! *Digital simulation of random processes and its applications*, J. Sound Vib. 25, 111–128; Shinozuka & Deodatis 1991, *Simulation of stochastic
//! processes by spectral representation*, Appl. Mech. Rev. 44, 191–204):
//!
//! ```text
//! z(X) = N^(−1/2) Σ_i a_i cos(k_i · X + φ_i)
//! ```
//!
//! The amplitudes have a Rayleigh distribution, so that `z` at a place is normal for every N, not only in the limit. The wave numbers are stratified
//! samples of their distribution, and the directions are spread evenly over the circle, with one random shift each. Mean, variance and
//! correlation over all seeds are exact; those of one seed differ a little. No grid is needed, and the field can be evaluated anywhere.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Number of waves of a field. Variance and correlation of one realisation differ from those of the ensemble by the order of N^(−1/2) of the variance
/// (the test prints 0.03 for 500 waves of equal amplitude); the time to evaluate the field is proportional to N.
const WAVES: usize = 500;

/// The golden ratio less one: the fractional parts of its multiples are spread evenly over a circle for any number of them.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The correlation function of `z` at two places, with `d² = (Δx/θ_x)² + (Δy/θ_y)²`. The scale of fluctuation θ (Vanmarcke 1983) is the integral of the
/// correlation over a line along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correlation {
    /// `exp(−2 d)`: rough.
    Markov,
    /// `exp(−π d²)`: smooth.
    Gaussian,
}

impl Correlation {
    /// The wave number, times the scale of fluctuation, above which the spectral density in the plane has the part `left` (-) of the variance.
    fn wave_number(self, left: f64) -> f64 {
        match self {
            // `∫ 2 κ/(4 + κ²)^(3/2) dκ`.
            Self::Markov => 2.0 * (1.0 / (left * left) - 1.0).sqrt(),
            // `∫ κ/2π exp(−κ²/4π) dκ`.
            Self::Gaussian => (-4.0 * PI * left.ln()).sqrt(),
        }
    }
}

/// The parameters of a random field of strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Randomness {
    /// Standard deviation over mean (-), 0 or above.
    pub variation: f64,
    /// Scales of fluctuation (m) of `z`, horizontal and vertical, above 0.
    pub lengths: [f64; 2],
    pub correlation: Correlation,
    /// The number of the realisation.
    pub seed: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave {
    /// (rad/m).
    vector: [f64; 2],
    phase: f64,
    /// With the factor N^(−1/2).
    amplitude: f64,
}

/// A realisation.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomStrength {
    /// s (-).
    deviation: f64,
    waves: Vec<Wave>,
}

impl RandomStrength {
    /// The realisation of a seed. The numbers are those of ChaCha8, which are the same on every machine.
    pub fn new(of: &Randomness) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(of.seed);
        // Above 0, and 1 at most.
        let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
        let (first_length, first_direction) = (uniform(), uniform());
        let wave = |i: usize| {
            let left = (i as f64 + first_length) / WAVES as f64;
            let length = of.correlation.wave_number(left);
            let direction = TAU * (first_direction + i as f64 * GOLDEN).fract();
            let vector = [length * direction.cos() / of.lengths[0], length * direction.sin() / of.lengths[1]];
            let amplitude = (-2.0 * uniform().ln() / WAVES as f64).sqrt();
            Wave { vector, phase: TAU * uniform(), amplitude }
        };
        Self { deviation: of.variation.powi(2).ln_1p().sqrt(), waves: (0..WAVES).map(wave).collect() }
    }

    /// `z` (-) at a place (m).
    pub fn standard(&self, x: &[f64; 2]) -> f64 {
        let value = |w: &Wave| w.amplitude * (w.vector[0] * x[0] + w.vector[1] * x[1] + w.phase).cos();
        self.waves.iter().map(value).sum()
    }

    /// The strength over its mean (-) of soil that was seeded at a place (m); the field is one of the first coordinate and the last, the height.
    pub fn factor<const D: usize>(&self, seeded: &[f64; D]) -> f64 {
        let z = self.standard(&[seeded[0], seeded[D - 1]]);
        (self.deviation * (z - 0.5 * self.deviation)).exp()
    }
}

/// The fields of strength of the materials of a scene by number; none of those whose strength does not vary at random.
pub type RandomStrengths = Vec<Option<Arc<RandomStrength>>>;

/// The strength over its mean (-) of soil of the material with a number that was seeded at a place (m).
pub fn strength_at<const D: usize>(fields: &[Option<Arc<RandomStrength>>], number: usize, seeded: &[f64; D]) -> f64 {
    fields.get(number).and_then(Option::as_ref).map_or(1.0, |field| field.factor(seeded))
}

#[cfg(test)]
mod tests;
