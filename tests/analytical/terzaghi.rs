//! One-dimensional consolidation of a layer that drains at its top, under a load that is there at once.
//!
//! `∂p/∂t = c_v ∂²p/∂z²`, `p = p₀` at first, `p = 0` at the top and `∂p/∂z = 0` at the base. Terzaghi & Fröhlich, *Theorie der
//! Setzung von Tonschichten* (1936); Verruijt, *An Introduction to Soil Dynamics* (2010), chapter 4: the series of eigenfunctions.

use std::f64::consts::PI;

/// The layer. Lengths in m, pressures in kPa, compression positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Height H (m), which is the way that the water has to go.
    pub height: f64,
    /// Confined modulus M (kPa) of the skeleton.
    pub modulus: f64,
    /// `n/K_w` (1/kPa) of the water.
    pub storage: f64,
    /// `k/γ_w` (m²/(kPa s)).
    pub mobility: f64,
    /// The load (kPa).
    pub load: f64,
}

impl Layer {
    /// Coefficient of consolidation c_v (m²/s).
    pub fn coefficient(&self) -> f64 {
        self.mobility / (1.0 / self.modulus + self.storage)
    }

    /// The time (s) at which `T_v = c_v t/H²` is `factor` (-).
    pub fn time(&self, factor: f64) -> f64 {
        factor * self.height.powi(2) / self.coefficient()
    }

    /// Excess pressure (kPa) at first: what the water bears of the load.
    pub fn first_pressure(&self) -> f64 {
        self.load / (1.0 + self.modulus * self.storage)
    }

    /// Excess pressure (kPa) at the `depth` (m) below the top and the time (s).
    pub fn pressure(&self, depth: f64, time: f64) -> f64 {
        self.first_pressure() * isochrone(depth / self.height, self.coefficient() * time / self.height.powi(2))
    }

    /// Settlement of the top (m).
    pub fn settlement(&self, time: f64) -> f64 {
        let first = (self.load - self.first_pressure()) / self.modulus;
        let last = self.load / self.modulus;
        let factor = self.coefficient() * time / self.height.powi(2);
        self.height * (first + (last - first) * degree(factor))
    }
}

/// `p/p₀` (-) at the depth `z` (-) below the top over the height, at the time factor `t` (-).
pub fn isochrone(z: f64, t: f64) -> f64 {
    if t <= 0.0 {
        return if z > 0.0 { 1.0 } else { 0.0 };
    }
    let terms = (0..terms(t)).map(|j| {
        let m = PI * (f64::from(j) + 0.5);
        2.0 / m * (m * z).sin() * (-m * m * t).exp()
    });
    terms.sum()
}

/// Degree of consolidation U (-) at the time factor `t` (-).
pub fn degree(t: f64) -> f64 {
    if t <= 0.0 {
        return 0.0;
    }
    let left = (0..terms(t)).map(|j| {
        let m = PI * (f64::from(j) + 0.5);
        2.0 / (m * m) * (-m * m * t).exp()
    });
    1.0 - left.sum::<f64>()
}

/// Terms until `exp(−m² t)` is below rounding.
fn terms(t: f64) -> u32 {
    ((40.0 / t).sqrt() / PI).ceil().min(1e6) as u32 + 2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of VERIFICATION.md: T_v, U, p at the base over p₀.
    #[test]
    fn known_values() {
        for (t, u, base) in [
            (0.01, 0.11284, 1.00000),
            (0.05, 0.25231, 0.99687),
            (0.1, 0.35682, 0.94931),
            (0.197, 0.50034, 0.77774),
            (0.5, 0.76395, 0.37078),
            (1.0, 0.93126, 0.10798),
        ] {
            assert!((degree(t) - u).abs() < 5.1e-6, "{t}: {}", degree(t));
            assert!((isochrone(1.0, t) - base).abs() < 5.1e-6, "{t}: {}", isochrone(1.0, t));
        }
    }

    /// Early on `U = 2 √(T/π)`, and what the water loses is what the degree gains.
    #[test]
    fn early_and_in_balance() {
        for t in [1e-6, 1e-4, 0.02] {
            assert!((degree(t) - 2.0 * (t / PI).sqrt()).abs() < 1e-8, "{t}");
        }
        for t in [1e-3, 0.1, 0.7] {
            let n = 20_000;
            let left: f64 =
                (0..n).map(|i| isochrone((f64::from(i) + 0.5) / f64::from(n), t)).sum::<f64>() / f64::from(n);
            assert!((1.0 - left - degree(t)).abs() < 1e-7, "{t}");
        }
    }

    /// The balance of a layer whose water is compressible.
    #[test]
    fn a_layer_ends_where_it_is_drained() {
        let layer = Layer { height: 2.0, modulus: 1000.0, storage: 2e-4, mobility: 1e-6, load: 10.0 };
        assert!((layer.first_pressure() - 10.0 / 1.2).abs() < 1e-12);
        assert!((layer.settlement(0.0) - 2.0 * (10.0 - 10.0 / 1.2) / 1000.0).abs() < 1e-15);
        assert!((layer.settlement(layer.time(10.0)) - 0.02).abs() < 1e-10);
        assert!((layer.coefficient() - 1e-6 / 1.2e-3).abs() < 1e-18);
    }
}
