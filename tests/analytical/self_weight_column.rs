//! A column under its own weight at large strain, Hencky elasticity, one-dimensional.
//!
//! The cross-section stays: the column is confined (M the oedometric modulus) or has ν = 0 (M = E). At the
//! original depth Z below the top the Cauchy stress balances the weight above, `(M ln λ)/λ = −ρ₀ g Z`, so the
//! stretch is `λ = W(q)/q` with `q = ρ₀ g Z/M` and W Lambert's function, and the heights follow from
//! `∫ W(q)/q dq = W + W²/2`. The same benchmark with other laws: Charlton, Coombs & Augarde, *Computers and Structures*
//! 190 (2017) 108–125.

/// The column. Lengths in m, tension positive, heights measured from the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Modulus M (kPa): oedometric if confined, Young's if ν = 0.
    pub modulus: f64,
    /// Weight ρ₀ g (kN/m³) of the unstrained material.
    pub unit_weight: f64,
    /// Unstrained height H (m).
    pub height: f64,
}

impl Column {
    /// Height (m) of the column under its weight.
    pub fn deformed_height(&self) -> f64 {
        self.position(0.0)
    }

    /// Height (m) above the base of what was at `depth` Z (m) below the top.
    pub fn position(&self, depth: f64) -> f64 {
        let scale = self.modulus / self.unit_weight;
        let integral = |z: f64| {
            let w = lambert(z / scale);
            w * (1.0 + 0.5 * w)
        };
        scale * (integral(self.height) - integral(depth))
    }

    /// Displacement (m), upwards positive, of what was at `depth` Z (m).
    pub fn displacement(&self, depth: f64) -> f64 {
        self.position(depth) - (self.height - depth)
    }

    /// Stretch λ (-) of what was at `depth` Z (m).
    pub fn stretch(&self, depth: f64) -> f64 {
        // W(q)/q = exp(−W(q)), which needs no care at q = 0.
        (-lambert(self.unit_weight * depth / self.modulus)).exp()
    }

    /// Vertical Cauchy stress (kPa) of what was at `depth` Z (m).
    pub fn stress(&self, depth: f64) -> f64 {
        -self.unit_weight * depth
    }
}

/// Lambert's W on `x ≥ 0`: the root of `w eʷ = x`, by Halley's method (Corless et al., *Adv. Comput. Math.* 5
/// (1996) 329–359, eq. 5.9).
pub fn lambert(x: f64) -> f64 {
    let mut w = x.ln_1p();
    if w > 2.0 {
        w -= w.ln();
    }
    for _ in 0..20 {
        let e = w.exp();
        let f = w * e - x;
        let change = f / (e * (w + 1.0) - 0.5 * (w + 2.0) * f / (w + 1.0));
        w -= change;
        if change.abs() <= 1e-16 * w.abs() {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lambert_inverts_w_exp_w() {
        assert_eq!(lambert(0.0), 0.0);
        assert!((lambert(1.0) - 0.567_143_290_409_783_8).abs() < 1e-15, "omega constant");
        assert!((lambert(1f64.exp()) - 1.0).abs() < 1e-15);
        for x in [1e-300, 1e-12, 1e-3, 0.5, 3.0, 100.0, 1e10, 1e300] {
            let w = lambert(x);
            assert!((w.ln() + w - x.ln()).abs() <= 1e-13 * x.ln().abs().max(1.0), "{x}");
        }
    }

    /// Verification table: h/H to its six digits.
    #[test]
    fn deformed_heights() {
        for (r, expected) in [
            (0.01, 0.995049),
            (0.05, 0.976173),
            (0.1, 0.954422),
            (0.2, 0.915911),
            (0.5, 0.827184),
            (1.0, 0.727969),
            (2.0, 0.608037),
        ] {
            let column = Column { modulus: 40.0, unit_weight: 40.0 * r / 8.0, height: 8.0 };
            assert!((column.deformed_height() / 8.0 - expected).abs() < 5.1e-7, "{r}");
        }
    }

    /// The stretch is the derivative of the position and its Hencky stress the weight above.
    #[test]
    fn stretch_position_and_stress_fit() {
        let column = Column { modulus: 50.0, unit_weight: 20.0, height: 3.0 };
        assert!(column.position(3.0).abs() < 1e-15 && column.displacement(3.0).abs() < 1e-15);
        for z in [0.1, 1.0, 2.9] {
            let h = 1e-5;
            let slope = (column.position(z - h) - column.position(z + h)) / (2.0 * h);
            let stretch = column.stretch(z);
            assert!((slope - stretch).abs() < 1e-9);
            assert!((column.modulus * stretch.ln() / stretch - column.stress(z)).abs() < 1e-12);
        }
    }
}
