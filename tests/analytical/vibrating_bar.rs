//! Axial vibration of an elastic bar, fixed at one end and free at the other, at small amplitude.
//!
//! In mode n the velocity is `v = v₀ sin(βx) cos(ωt)` with `β = (2n − 1)π/(2L)`, `ω = β √(E/ρ)` and x from the
//! fixed end (Sulsky, Chen & Schreyer, *Comput. Methods Appl. Mech. Engng* 118 (1994) 179–196; any text on waves).

use std::f64::consts::PI;

/// The bar in one mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Young's modulus (kPa), or the oedometric one if confined.
    pub modulus: f64,
    /// Density (t/m³).
    pub density: f64,
    /// Length L (m).
    pub length: f64,
    /// Velocity v₀ (m/s) of an antinode at t = 0.
    pub velocity: f64,
    /// Mode n, from 1.
    pub mode: u32,
}

impl Bar {
    /// Wave number β (1/m).
    pub fn wave_number(&self) -> f64 {
        f64::from(2 * self.mode - 1) * PI / (2.0 * self.length)
    }

    /// Angular frequency ω (1/s).
    pub fn frequency(&self) -> f64 {
        self.wave_number() * (self.modulus / self.density).sqrt()
    }

    /// Period (s).
    pub fn period(&self) -> f64 {
        2.0 * PI / self.frequency()
    }

    /// Velocity (m/s) at `x` from the fixed end and time `t`.
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        self.velocity * (self.wave_number() * x).sin() * (self.frequency() * t).cos()
    }

    /// Displacement (m) at `x` from the fixed end and time `t`.
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        self.velocity / self.frequency() * (self.wave_number() * x).sin() * (self.frequency() * t).sin()
    }

    /// Axial stress (kPa), tension positive.
    pub fn stress(&self, x: f64, t: f64) -> f64 {
        let amplitude = self.modulus * self.velocity * self.wave_number() / self.frequency();
        amplitude * (self.wave_number() * x).cos() * (self.frequency() * t).sin()
    }

    /// Kinetic and strain energy together (kJ), per unit area of the section.
    pub fn energy(&self) -> f64 {
        0.25 * self.density * self.velocity * self.velocity * self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `ρ ü = E u″`, `v = u̇`, `σ = E u′`, the ends, and the energy by a sum.
    #[test]
    fn the_wave_equation_is_solved() {
        let bar = Bar { modulus: 200.0, density: 1.5, length: 4.0, velocity: 0.1, mode: 2 };
        let (x, t, h) = (1.3, 0.07, 1e-4);
        let u = |dx: f64, dt: f64| bar.displacement(x + dx, t + dt);
        let second = |a: f64, b: f64, c: f64| (a - 2.0 * b + c) / (h * h);
        let acceleration = second(u(0.0, h), u(0.0, 0.0), u(0.0, -h));
        let curvature = second(u(h, 0.0), u(0.0, 0.0), u(-h, 0.0));
        assert!((1.5 * acceleration - 200.0 * curvature).abs() < 1e-4 * (200.0 * curvature).abs());
        assert!(((u(0.0, h) - u(0.0, -h)) / (2.0 * h) - bar.velocity(x, t)).abs() < 1e-7);
        assert!((200.0 * (u(h, 0.0) - u(-h, 0.0)) / (2.0 * h) - bar.stress(x, t)).abs() < 1e-6);
        assert_eq!(bar.displacement(0.0, t), 0.0);
        assert!(bar.stress(4.0, t).abs() < 1e-13);
        let n = 1000;
        let energy: f64 = (0..n)
            .map(|i| (i as f64 + 0.5) * 4.0 / f64::from(n))
            .map(|x| 0.5 * 1.5 * bar.velocity(x, t).powi(2) + 0.5 * bar.stress(x, t).powi(2) / 200.0)
            .sum::<f64>()
            * 4.0
            / f64::from(n);
        assert!((energy - bar.energy()).abs() < 1e-12);
        assert!((bar.velocity(4.0, bar.period()) + 0.1).abs() < 1e-14);
    }
}
