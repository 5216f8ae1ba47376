//! Who is in contact, by what law, and how stiff the contact is across the boundary.

use super::law::Laws;

/// Normal penalty ε_n (-), in Young's modulus over the spacing of the contact nodes.
const NORMAL: f64 = 50.0;
/// The same of supports across a curve, where nothing parts or sticks: a step leaves one over this of the strain of a cell as a gap.
const SUPPORT: f64 = 1e4;

/// Who is in contact, and by what law.
#[derive(Clone, Debug)]
pub struct Sides {
    /// The region of the structure.
    pub structure: u16,
    /// The region of what it touches, if that is a body and not soil.
    pub against: Option<u16>,
    /// The regions of the soil that it touches; none of a body.
    pub soils: Vec<u16>,
    pub laws: Laws,
    /// Whether it is a support across a curve.
    pub is_support: bool,
}

impl Sides {
    /// Normal penalty (-), in Young's modulus over the spacing of the contact nodes.
    pub(super) fn penalty(&self) -> f64 {
        if self.is_support { SUPPORT } else { NORMAL }
    }
}
