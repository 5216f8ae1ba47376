//! Bearing capacity factors `N_c = q/s_u` of footings on the surface of weightless clay, Tresca, `s_u` constant.

use std::f64::consts::PI;

/// Strip footing, smooth or rough: `2 + π` (Prandtl, *Nachr. Ges. Wiss. Göttingen* (1920) 74–85).
pub const STRIP: f64 = 2.0 + PI;

/// Smooth circular footing, by the method of characteristics with the hypothesis of Haar and von Kármán
/// (Shield, *Proc. R. Soc. A* 233 (1955) 267–287, gives 5.69).
pub const CIRCLE_SMOOTH: f64 = 5.689;
