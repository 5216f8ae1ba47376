//! Isotropic Hencky elasticity in principal axes: `τ = λ tr(ε) 1 + 2G ε`, the elastic part of every model.
//!
//! Energy `W(ε) = ½ λ tr(ε)² + G ε·ε` with `ε_A = ½ ln b_A` (Hencky 1928; Simo & Hughes, *Computational
//! Inelasticity*, 1998, §9.3): the law of small strains between Kirchhoff stress and logarithmic strain.

use super::profile::Profile;
use crate::error::{Error, Result};

/// Young's modulus (kPa), possibly varying with depth, and Poisson's ratio (-), within their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    young: Profile,
    /// Young's modulus (kPa) is no less.
    least: f64,
    poisson: f64,
}

impl Elasticity {
    /// Elasticity with Young's modulus `young` (kPa) and Poisson's ratio `poisson` (-).
    ///
    /// # Errors
    /// Unless `young` is positive at its datum and `-1 < poisson < 0.5`.
    pub fn new(young: Profile, poisson: f64) -> Result<Self> {
        young.positive_at("young", young.datum)?;
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(Error::input(
                "poisson",
                format!("{poisson} is outside -1 < poisson < 0.5"),
                "for undrained behaviour take 0.49 or 0.495",
            ));
        }
        Ok(Self { young, least: 0.0, poisson })
    }

    /// The same with a Young's modulus of at least `young` (kPa) at every height.
    pub fn at_least(self, young: f64) -> Self {
        Self { least: young, ..self }
    }

    /// Whether Young's modulus is positive at height `y` (m).
    ///
    /// # Errors
    /// If it is not, naming the value.
    pub fn check(&self, y: f64) -> Result<()> {
        self.young.positive_at("young", y)
    }

    /// Young's modulus (kPa) at height `y` (m).
    pub fn young(&self, y: f64) -> f64 {
        self.young.at(y).max(self.least)
    }

    /// Poisson's ratio (-).
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// The moduli at height `y` (m).
    pub fn at(&self, y: f64) -> Moduli {
        let (e, nu) = (self.young(y), self.poisson);
        let shear = 0.5 * e / (1.0 + nu);
        Moduli { lambda: 2.0 * shear * nu / (1.0 - 2.0 * nu), shear }
    }
}

/// Lamé's constants (kPa) at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moduli {
    pub lambda: f64,
    /// Shear modulus G.
    pub shear: f64,
}

impl Moduli {
    /// Bulk modulus (kPa).
    pub fn bulk(&self) -> f64 {
        self.lambda + 2.0 / 3.0 * self.shear
    }

    /// Poisson's ratio (-) of a shear modulus beside the bulk modulus `bulk` (kPa).
    pub fn poisson_beside(&self, bulk: f64) -> f64 {
        (1.5 * bulk - self.shear) / (3.0 * bulk + self.shear)
    }

    /// Principal Kirchhoff stress of a principal Hencky strain.
    pub fn stress(&self, strain: &[f64; 3]) -> [f64; 3] {
        let volumetric = self.lambda * (strain[0] + strain[1] + strain[2]);
        strain.map(|e| volumetric + 2.0 * self.shear * e)
    }

    /// Principal Hencky strain of a principal Kirchhoff stress, the inverse of [`Moduli::stress`].
    pub fn strain(&self, stress: &[f64; 3]) -> [f64; 3] {
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        let volumetric = mean / (3.0 * self.bulk());
        stress.map(|s| volumetric + (s - mean) / (2.0 * self.shear))
    }

    /// `W` (kPa) of a principal Hencky strain.
    pub fn energy(&self, strain: &[f64; 3]) -> f64 {
        0.5 * self.stress(strain).iter().zip(strain).map(|(t, e)| t * e).sum::<f64>()
    }

    /// `∂τ_A/∂ε_B` (kPa).
    pub fn tangent(&self) -> [[f64; 3]; 3] {
        let (l, d) = (self.lambda, self.lambda + 2.0 * self.shear);
        [[d, l, l], [l, d, l], [l, l, d]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniaxial_stress_gives_young_and_poisson() {
        let m = Elasticity::new(Profile::constant(1000.0), 0.3).unwrap().at(0.0);
        let strain = m.strain(&[10.0, 0.0, 0.0]);
        for (got, expected) in strain.iter().zip([0.01, -0.003, -0.003]) {
            assert!((got - expected).abs() < 1e-16);
        }
        for (got, expected) in m.stress(&strain).iter().zip([10.0, 0.0, 0.0]) {
            assert!((got - expected).abs() < 1e-13);
        }
        let oedometer = 1000.0 * 0.7 / (1.3 * 0.4);
        assert!((m.tangent()[0][0] - oedometer).abs() < 1e-10);
    }

    #[test]
    fn ranges_are_checked() {
        for (young, poisson) in [(0.0, 0.3), (-1.0, 0.3), (f64::NAN, 0.3), (1.0, 0.5), (1.0, -1.0), (1.0, f64::NAN)] {
            assert!(Elasticity::new(Profile::constant(young), poisson).is_err(), "{young} {poisson}");
        }
        let softening = Profile::growing(10.0, -1.0, 0.0);
        let e = Elasticity::new(softening, 0.2).unwrap();
        assert!(e.check(-9.0).is_ok());
        assert!(e.check(-10.0).is_err());
    }
}
