//! Mandel's problem: a strip of porous soil pressed between two rigid, smooth plates by a constant force, drained at its sides.
//!
//! The pressure in the middle first rises, as the drained sides grow softer and leave more of the load to the core. J. Mandel,
//! *Géotechnique* 3 (1953) 287–299; in the form of Cheng & Detournay, *Int. J. Numer. Anal. Methods Geomech.* 12 (1988) 551–572, with
//! Biot's coefficient 1.

use std::f64::consts::PI;

/// Half of the strip, `0 ≤ x ≤ a`, in plane strain. Pressure positive in compression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// Half width a (m).
    pub half_width: f64,
    /// Young's modulus (kPa) and Poisson's ratio (-) of the skeleton.
    pub young: f64,
    pub poisson: f64,
    /// `n/K_w` (1/kPa) of the water.
    pub storage: f64,
    /// `k/γ_w` (m²/(kPa s)).
    pub mobility: f64,
    /// Half of the force on a plate (kN/m).
    pub force: f64,
}

impl Strip {
    fn shear(&self) -> f64 {
        0.5 * self.young / (1.0 + self.poisson)
    }

    /// Poisson's ratio (-) of the soil as a whole without drainage, and Skempton's coefficient (-).
    fn undrained(&self) -> [f64; 2] {
        let bulk = self.young / (3.0 * (1.0 - 2.0 * self.poisson));
        let shear = self.shear();
        if self.storage == 0.0 {
            return [0.5, 1.0];
        }
        let whole = bulk + 1.0 / self.storage;
        [(3.0 * whole - 2.0 * shear) / (2.0 * (3.0 * whole + shear)), 1.0 / (1.0 + bulk * self.storage)]
    }

    /// Coefficient of consolidation c (m²/s).
    pub fn coefficient(&self) -> f64 {
        let modulus = 2.0 * self.shear() * (1.0 - self.poisson) / (1.0 - 2.0 * self.poisson);
        self.mobility / (1.0 / modulus + self.storage)
    }

    /// The time (s) at which `c t/a²` is `factor` (-).
    pub fn time(&self, factor: f64) -> f64 {
        factor * self.half_width.powi(2) / self.coefficient()
    }

    /// Excess pressure (kPa) at first.
    pub fn first_pressure(&self) -> f64 {
        let [undrained, skempton] = self.undrained();
        self.force * skempton * (1.0 + undrained) / (3.0 * self.half_width)
    }

    /// Sum of `of(α) exp(−α² T)` over the roots of `tan α = (1 − ν)/(ν_u − ν) α`.
    fn sum(&self, time: f64, of: impl Fn(f64) -> f64) -> f64 {
        let factor = self.coefficient() * time / self.half_width.powi(2);
        let ratio = (1.0 - self.poisson) / (self.undrained()[0] - self.poisson);
        let count = ((40.0 / factor.max(1e-9)).sqrt() / PI).ceil().min(2e5) as u32 + 2;
        let term = |n: u32| {
            let alpha = root(ratio, n);
            of(alpha) * (-alpha * alpha * factor).exp()
        };
        (0..count).map(term).sum()
    }

    /// Excess pressure (kPa) at `x` (m) from the middle, at a time (s) above 0.
    pub fn pressure(&self, x: f64, time: f64) -> f64 {
        let x = x / self.half_width;
        2.0 * self.first_pressure() * self.sum(time, |a| a.sin() / (a - a.sin() * a.cos()) * ((a * x).cos() - a.cos()))
    }

    /// Strain (-) between the plates, shortening positive, at a time (s) above 0.
    pub fn shortening(&self, time: f64) -> f64 {
        let scale = self.force / (2.0 * self.shear() * self.half_width);
        let left = self.sum(time, |a| a.sin() * a.cos() / (a - a.sin() * a.cos()));
        scale * ((1.0 - self.poisson) - 2.0 * (1.0 - self.undrained()[0]) * left)
    }
}

/// The root of `tan α = ratio · α`, `ratio` above 1, between `nπ` and `(n + ½)π`.
fn root(ratio: f64, n: u32) -> f64 {
    let (mut low, mut high) = (PI * f64::from(n), PI * (f64::from(n) + 0.5));
    // `sin α − ratio α cos α` falls through zero only once, and has no pole.
    let below =
        |alpha: f64| (alpha.sin() - ratio * alpha * alpha.cos()) * if n.is_multiple_of(2) { 1.0 } else { -1.0 } < 0.0;
    if n == 0 {
        // Zero is no root that counts.
        low = 1e-6;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strip(poisson: f64) -> Strip {
        Strip { half_width: 1.0, young: 1000.0, poisson, storage: 0.0, mobility: 1e-6, force: 2.0 }
    }

    /// Values of VERIFICATION.md: `p/p₀` in the middle of a strip with incompressible water.
    #[test]
    fn known_values() {
        for (poisson, values) in [
            (0.0, [(0.01, 1.05902), (0.1, 1.15179), (0.5, 0.70273), (1.0, 0.35628)]),
            (0.2, [(0.01, 1.04376), (0.1, 1.09541), (0.5, 0.59279), (1.0, 0.25884)]),
        ] {
            let strip = strip(poisson);
            for (factor, expected) in values {
                let p = strip.pressure(0.0, strip.time(factor)) / strip.first_pressure();
                assert!((p - expected).abs() < 5.1e-6, "ν {poisson}, T {factor}: {p}");
            }
        }
    }

    /// Shortening begins undrained, at `(1 − ν_u) F/2Ga`, and ends drained; the force on the plate is that on the soil and the water.
    #[test]
    fn begins_undrained_and_ends_drained() {
        let strip = Strip { storage: 2e-4, ..strip(0.2) };
        let [undrained, _] = strip.undrained();
        let scale = strip.force / (2.0 * strip.shear());
        assert!((strip.shortening(strip.time(1e-8)) / (scale * (1.0 - undrained)) - 1.0).abs() < 1e-3);
        assert!((strip.shortening(strip.time(20.0)) / (scale * 0.8) - 1.0).abs() < 1e-12);
        let early = strip.pressure(0.0, strip.time(1e-7)) / strip.first_pressure();
        assert!((early - 1.0).abs() < 1e-3, "{early}");
    }
}
