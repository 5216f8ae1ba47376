//! Limit loads of weightless clay, Tresca, `s_u` constant: bearing capacity factors `N_c = q/s_u` of footings on its surface, and that of a pipe deep in it.

use std::f64::consts::PI;

/// Strip footing, smooth or rough: `2 + π` (Prandtl, *Nachr. Ges. Wiss. Göttingen* (1920) 74–85).
pub const STRIP: f64 = 2.0 + PI;

/// Smooth circular footing, by the method of characteristics with the hypothesis of Haar and von Kármán
/// (Shield, *Proc. R. Soc. A* 233 (1955) 267–287, gives 5.69).
pub const CIRCLE_SMOOTH: f64 = 5.689;

/// A pipe deep in the soil, pushed across its axis without parting from it: `N = F/(s_u D)` for a force `F` a metre and a shear
/// on the pipe of at most `α s_u`, `0 ≤ α ≤ 1`.
///
/// `N = π + 2Δ + 2 cos Δ + 4 (cos(Δ/2) + sin(Δ/2))` with `sin Δ = α`: the lower bound of Randolph & Houlsby (*Géotechnique* 34 (1984)
/// 613–623), from 6 + π to 4√2 + 2π. At α = 1 it is exact; below that the best upper bounds are a little higher (Martin & Randolph,
/// *Géotechnique* 56 (2006) 141–145).
pub fn deep_pipe(factor: f64) -> f64 {
    let delta = factor.asin();
    let (sin, cos) = (0.5 * delta).sin_cos();
    PI + 2.0 * delta + 2.0 * delta.cos() + 4.0 * (cos + sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed values of the smooth and the rough pipe, and one between them that was computed in another way.
    #[test]
    fn a_deep_pipe_has_its_known_limits() {
        assert!((deep_pipe(0.0) - (6.0 + PI)).abs() < 1e-14);
        assert!((deep_pipe(1.0) - (4.0 * 2f64.sqrt() + 2.0 * PI)).abs() < 1e-14);
        assert!((deep_pipe(0.5) - 10.819820497921626).abs() < 1e-12);
    }
}
