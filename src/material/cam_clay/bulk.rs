//! How the mean pressure of clay follows from its elastic volume strain, both positive in compression: in proportion, or along a
//! straight line of swelling in the logarithm of pressure (Butterfield 1979; Borja, Tamagnini & Amorosi 1997),
//!
//! ```text
//! p = K ε      or      p = p_l e^(ε/κ̂ − 1),  K = dp/dε = p/κ̂
//! ```
//!
//! Below its least pressure `p_l`, tension included, the second goes on along its tangent, `p = p_l ε/κ̂`, which leads through zero
//! stress at zero strain: soil at a free surface is stiff. So it does beyond a largest pressure that no soil comes to, and every
//! strain has a finite stress. Pressure and tangent are continuous, and both derive from one energy.

use crate::error::{Error, Result};
use crate::material::Profile;

/// The largest pressure of a line of swelling, over that of preconsolidation or the least, whichever is more.
const MOST: f64 = 1e6;

/// A line of swelling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swelling {
    /// κ̂ (-).
    slope: f64,
    /// p_l (kPa).
    least: f64,
    /// Pressure (kPa) whose stiffness stands for the line.
    reference: Profile,
}

impl Swelling {
    /// The line of slope `slope`, κ̂ (-), down to the pressure `least` (kPa); `reference` (kPa) is that whose stiffness stands for it.
    ///
    /// # Errors
    /// Unless slope and least pressure are positive; names the parameter.
    pub fn new(slope: f64, least: f64, reference: Profile) -> Result<Self> {
        for (name, value) in [("swelling", slope), ("least_pressure", least)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::input(name, format!("{value} is not positive"), "give a value above 0"));
            }
        }
        Ok(Self { slope, least, reference })
    }

    /// κ̂ (-).
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// p_l (kPa).
    pub(super) fn least(&self) -> f64 {
        self.least
    }

    /// The pressure (kPa) whose stiffness stands for the line.
    pub(super) fn reference(&self) -> Profile {
        self.reference
    }

    /// The law of clay whose first preconsolidation pressure is `size` (kPa).
    pub(super) fn at(&self, size: f64) -> Bulk {
        Bulk::Swelling { slope: self.slope, least: self.least, most: MOST * size.max(self.least) }
    }
}

/// The law at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bulk {
    /// K (kPa).
    Constant(f64),
    Swelling {
        slope: f64,
        least: f64,
        /// The largest pressure (kPa) on the line.
        most: f64,
    },
}

impl Bulk {
    /// p (kPa).
    pub fn pressure(&self, strain: f64) -> f64 {
        match *self {
            Self::Constant(bulk) => bulk * strain,
            Self::Swelling { slope, least, .. } if strain <= slope => least * strain / slope,
            Self::Swelling { slope, least, most } => {
                let pressure = least * (strain / slope - 1.0).exp();
                if pressure <= most { pressure } else { most * (1.0 + (strain - self.strain(most)) / slope) }
            }
        }
    }

    /// The strain of a pressure, the inverse of [`Bulk::pressure`].
    pub fn strain(&self, pressure: f64) -> f64 {
        match *self {
            Self::Constant(bulk) => pressure / bulk,
            Self::Swelling { slope, least, .. } if pressure <= least => slope * pressure / least,
            Self::Swelling { slope, least, most } => {
                let beyond = (pressure - most).max(0.0) / most;
                slope * (1.0 + (pressure.min(most) / least).ln() + beyond)
            }
        }
    }

    /// K (kPa) at a pressure.
    pub fn modulus(&self, pressure: f64) -> f64 {
        match *self {
            Self::Constant(bulk) => bulk,
            Self::Swelling { slope, least, most } => pressure.clamp(least, most) / slope,
        }
    }

    /// The energy (kPa) of a strain, `∫ p dε`.
    pub fn energy(&self, strain: f64) -> f64 {
        let Self::Swelling { slope, least, most } = *self else {
            return 0.5 * self.pressure(strain) * strain;
        };
        let pressure = self.pressure(strain);
        // On the lower tangent, the line, and the upper tangent, each as far as the strain comes.
        let low = 0.5 * slope * pressure.min(least).powi(2) / least;
        let middle = slope * (pressure.clamp(least, most) - least);
        let high = 0.5 * slope * ((pressure / most).powi(2) - 1.0).max(0.0) * most;
        low + middle + high
    }

    /// The pressure where a plastic volume strain `x` is taken from a trial strain, whose pressure is `trial`.
    pub fn relaxed(&self, trial: f64, strain: f64, x: f64) -> f64 {
        match self {
            Self::Constant(bulk) => trial - bulk * x,
            Self::Swelling { .. } => self.pressure(strain - x),
        }
    }

    /// The plastic volume strain that brings a trial strain, whose pressure is `trial`, to a pressure.
    pub fn relaxing(&self, trial: f64, strain: f64, pressure: f64) -> f64 {
        match self {
            Self::Constant(bulk) => (trial - pressure) / bulk,
            Self::Swelling { .. } => strain - self.strain(pressure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pressure, modulus and strain are the derivatives and the inverse of each other from tension to beyond the largest pressure.
    #[test]
    fn one_energy_gives_all() {
        let laws = [
            Bulk::Constant(700.0),
            Swelling::new(0.02, 1.5, Profile::constant(80.0)).unwrap().at(80.0),
            Swelling::new(0.1, 4.0, Profile::constant(0.5)).unwrap().at(0.5),
        ];
        for law in laws {
            assert_eq!(law.pressure(0.0), 0.0);
            for n in -100..2000 {
                let strain = 1e-3 * f64::from(n) + 1e-4;
                let (p, h) = (law.pressure(strain), 1e-7);
                let scale = law.modulus(p) * 0.02;
                assert!((law.strain(p) - strain).abs() < 1e-14 + 1e-14 * strain.abs(), "{law:?} {strain}");
                let slope = (law.pressure(strain + h) - law.pressure(strain - h)) / (2.0 * h);
                assert!((slope - law.modulus(p)).abs() * 0.02 < 1e-6 * scale, "{law:?} {strain}: {slope}");
                let by_energy = (law.energy(strain + h) - law.energy(strain - h)) / (2.0 * h);
                assert!((by_energy - p).abs() < 1e-6 * scale.max(p.abs()), "{law:?} {strain}: {by_energy} {p}");
            }
        }
    }

    #[test]
    fn ranges_are_checked() {
        for (slope, least) in [(0.0, 1.0), (-0.1, 1.0), (f64::NAN, 1.0), (0.1, 0.0), (0.1, f64::INFINITY)] {
            assert!(Swelling::new(slope, least, Profile::constant(1.0)).is_err());
        }
    }
}
