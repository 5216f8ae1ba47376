//! A free disc (a long cylinder in plane strain) that spins steadily about its axis, at small strain.
//!
//! Stress and displacement in the turning frame are constant: what a scheme must keep while the body turns.
//! Timoshenko & Goodier, *Theory of Elasticity*, 3rd ed. (1970), §32, with ν/(1 − ν) and E/(1 − ν²) for ν and E.

/// The disc. Tension positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Young's modulus (kPa).
    pub young: f64,
    /// Poisson's ratio (-).
    pub poisson: f64,
    /// Density (t/m³).
    pub density: f64,
    /// Radius R (m).
    pub radius: f64,
    /// Angular velocity ω (rad/s).
    pub spin: f64,
}

impl Disc {
    /// `ρω²/(8(1 − ν))`.
    fn scale(&self) -> f64 {
        self.density * self.spin * self.spin / (8.0 * (1.0 - self.poisson))
    }

    /// Radial stress (kPa) at the radius `r` (m).
    pub fn radial_stress(&self, r: f64) -> f64 {
        self.scale() * (3.0 - 2.0 * self.poisson) * (self.radius * self.radius - r * r)
    }

    /// Circumferential stress (kPa) at the radius `r` (m).
    pub fn hoop_stress(&self, r: f64) -> f64 {
        let nu = self.poisson;
        self.scale() * ((3.0 - 2.0 * nu) * self.radius * self.radius - (1.0 + 2.0 * nu) * r * r)
    }

    /// Outward displacement (m) at the radius `r` (m).
    pub fn displacement(&self, r: f64) -> f64 {
        let nu = self.poisson;
        let flexibility = (1.0 + nu) * (1.0 - 2.0 * nu) / self.young;
        self.scale() * flexibility * r * ((3.0 - 2.0 * nu) * self.radius * self.radius - r * r)
    }

    /// Angular momentum (t m²/s) a metre, of the unstrained disc.
    pub fn angular_momentum(&self) -> f64 {
        0.5 * std::f64::consts::PI * self.density * self.radius.powi(4) * self.spin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(rσ_r)′ − σ_θ + ρω²r² = 0`, Hooke's law in plane strain, and no traction at the rim.
    #[test]
    fn equilibrium_and_hooke() {
        for nu in [0.0, 0.3, 0.45] {
            let disc = Disc { young: 500.0, poisson: nu, density: 2.0, radius: 1.5, spin: 0.7 };
            let h = 1e-5;
            for r in [0.1, 0.8, 1.4] {
                let slope = |f: &dyn Fn(f64) -> f64| (f(r + h) - f(r - h)) / (2.0 * h);
                let balance = slope(&|x| x * disc.radial_stress(x)) - disc.hoop_stress(r) + 2.0 * 0.49 * r * r;
                assert!(balance.abs() < 1e-9, "{nu} {r} {balance:e}");
                let (er, et) = (slope(&|x| disc.displacement(x)), disc.displacement(r) / r);
                let (lame, shear) = (500.0 * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 250.0 / (1.0 + nu));
                assert!((lame * (er + et) + 2.0 * shear * er - disc.radial_stress(r)).abs() < 1e-8);
                assert!((lame * (er + et) + 2.0 * shear * et - disc.hoop_stress(r)).abs() < 1e-8);
            }
            assert_eq!(disc.radial_stress(1.5), 0.0);
        }
    }
}
