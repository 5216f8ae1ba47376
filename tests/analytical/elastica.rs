//! The cantilever with a dead transverse load at its tip, inextensible and rigid in shear, at any deflection.
//!
//! `EI θ″ = −P cos θ` with θ the slope against the unloaded axis (Bisshopp & Drucker, *Q. Appl. Math.* 3 (1945)
//! 272–275). With the slope θ_L of the tip, `k² = (1 + sin θ_L)/2` and `sin φ₁ = 1/(k√2)`:
//!
//! ```text
//! √(PL²/EI) = K(k) − F(φ₁, k),   δ/L = 1 − 2 [E(k) − E(φ₁, k)]/√(PL²/EI),   x/L = 2k cos φ₁/√(PL²/EI)
//! ```
//!
//! In plane strain EI is `E h³/(12 (1 − ν²))` a metre.

use std::f64::consts::FRAC_PI_2;

/// The tip of the cantilever, as fractions of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// Deflection δ/L along the load.
    pub deflection: f64,
    /// How far the tip has come towards the clamp, over L.
    pub shortening: f64,
    /// Slope against the unloaded axis (rad).
    pub slope: f64,
}

/// The tip under the load `PL²/EI`, positive and below 100 (where the slope is within 1e-8 of a right angle).
pub fn tip(load: f64) -> Tip {
    let root = load.sqrt();
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    // Bisection to the last bit: the load grows with the slope.
    let slope = loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break middle;
        }
        let (k2, start) = modulus(middle);
        let reached = first_kind(QUARTER, k2) - first_kind(start, k2);
        if reached < root { low = middle } else { high = middle }
    };
    let (k2, start) = modulus(slope);
    let second = second_kind(QUARTER, k2) - second_kind(start, k2);
    Tip { deflection: 1.0 - 2.0 * second / root, shortening: 1.0 - 2.0 * k2.sqrt() * start.1 / root, slope }
}

/// Sine and cosine of a quarter turn.
const QUARTER: (f64, f64) = (1.0, 0.0);

/// `k²` and the sine and cosine of `φ₁` of a slope; the cosine from `cos² φ₁ = sin θ/(1 + sin θ)`, exact for
/// small slopes too.
fn modulus(slope: f64) -> (f64, (f64, f64)) {
    let s = slope.sin();
    (0.5 * (1.0 + s), ((1.0 / (1.0 + s)).sqrt(), (s / (1.0 + s)).sqrt()))
}

/// Legendre's `F(φ, k)` by Carlson's `R_F` (DLMF 19.25.5), from sine and cosine of φ.
fn first_kind((s, c): (f64, f64), k2: f64) -> f64 {
    s * carlson(c * c, 1.0 - k2 * s * s).0
}

/// Legendre's `E(φ, k)` by Carlson's `R_F` and `R_D` (DLMF 19.25.9), from sine and cosine of φ.
fn second_kind((s, c): (f64, f64), k2: f64) -> f64 {
    let (rf, rd) = carlson(c * c, 1.0 - k2 * s * s);
    s * rf - k2 * s * s * s * rd / 3.0
}

/// `R_F(x, y, 1)` and `R_D(x, y, 1)` by duplication (Carlson, *Numer. Algorithms* 10 (1995) 13–26).
fn carlson(x: f64, y: f64) -> (f64, f64) {
    let (mut x, mut y, mut z) = (x, y, 1.0);
    let (mut sum, mut power) = (0.0, 1.0);
    // Each duplication divides the differences by four, and the error of the expansions by 4⁶: 14 leave them
    // below rounding for any x and y met here.
    for _ in 0..14 {
        let root = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        sum += power / (z.sqrt() * (z + root));
        power *= 0.25;
        (x, y, z) = (0.25 * (x + root), 0.25 * (y + root), 0.25 * (z + root));
    }
    let mean = (x + y + z) / 3.0;
    let weighted = (x + y + 3.0 * z) / 5.0;
    (1.0 / mean.sqrt(), power / weighted.powf(1.5) + 3.0 * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elliptic_integrals() {
        // DLMF 19.6: K(0) = E(0) = π/2, E(1) = 1, and the lemniscate's K(1/√2).
        assert!((first_kind(QUARTER, 0.0) - FRAC_PI_2).abs() < 1e-15);
        assert!((second_kind(QUARTER, 0.0) - FRAC_PI_2).abs() < 1e-15);
        assert!((first_kind(QUARTER, 0.5) - 1.854_074_677_301_372).abs() < 1e-14);
        assert!((second_kind(1f64.sin_cos(), 1.0) - 1f64.sin()).abs() < 1e-14);
        assert!((first_kind(1f64.sin_cos(), 1.0) - 1f64.tan().asinh()).abs() < 1e-14);
    }

    /// Verification table, to its five digits.
    #[test]
    fn tips() {
        for (load, deflection, shortening) in [
            (0.25, 0.08275, 0.00412),
            (0.5, 0.16214, 0.01592),
            (1.0, 0.30172, 0.05643),
            (2.0, 0.49346, 0.16064),
            (3.0, 0.60325, 0.25442),
            (5.0, 0.71379, 0.38763),
            (10.0, 0.81061, 0.55500),
        ] {
            let t = tip(load);
            assert!((t.deflection - deflection).abs() < 5.1e-6, "{load}: {t:?}");
            assert!((t.shortening - shortening).abs() < 5.1e-6, "{load}: {t:?}");
        }
    }

    /// Small loads give the beam of small deflections.
    #[test]
    fn small_loads_are_linear() {
        let t = tip(1e-4);
        assert!((t.deflection - 1e-4 / 3.0).abs() < 1e-12);
        assert!((t.slope - 0.5e-4).abs() < 1e-12);
    }

    /// Against the differential equation, by Runge–Kutta from the clamp with the moment the solution implies.
    #[test]
    fn the_equation_is_solved() {
        for load in [0.3, 2.0, 7.0] {
            let t = tip(load);
            // At the clamp ½θ′² = α sin θ_L, as θ′ = 0 at the tip.
            let mut y = [0.0, (2.0 * load * t.slope.sin()).sqrt(), 0.0, 0.0];
            let rate = |y: &[f64; 4]| [y[1], -load * y[0].cos(), y[0].cos(), y[0].sin()];
            let steps = 2000;
            let h = 1.0 / steps as f64;
            for _ in 0..steps {
                let along = |k: &[f64; 4], by: f64| std::array::from_fn(|i| y[i] + by * k[i]);
                let k1 = rate(&y);
                let k2 = rate(&along(&k1, 0.5 * h));
                let k3 = rate(&along(&k2, 0.5 * h));
                let k4 = rate(&along(&k3, h));
                for i in 0..4 {
                    y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
                }
            }
            assert!(y[1].abs() < 1e-10, "no moment at the tip: {}", y[1]);
            assert!((y[0] - t.slope).abs() < 1e-10);
            assert!((1.0 - y[2] - t.shortening).abs() < 1e-10);
            assert!((y[3] - t.deflection).abs() < 1e-10);
        }
    }
}
