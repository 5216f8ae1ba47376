//! Contact between the boundary of a structure and soil: where they meet, how far apart they are and what they
//! exert on each other.
//!
//! The boundary is where contact is integrated, for there area and normal are exact. It is cut into segments about a
//! fifth of a cell long; pressure and shear are combinations of hats along it, about a cell wide, and each hat has one
//! condition: its mean gap. The gap of a segment is the signed distance of the nearest points of soil to the boundary
//! (its level set), less the half width of a point.

mod along;
mod bodies;
mod cover;
mod gap;
mod law;
mod multipliers;
mod pair;
mod place;
mod rigid;
mod skin;
mod surface;

pub use along::Mark;
pub use bodies::{Bodies, SoilSide};
pub use law::{Answer, Law, Penalty};
pub use multipliers::Multipliers;
pub use pair::{Boundary, Ground, Pair, Pushed, Row};
pub use rigid::Rigid;
pub use skin::Skin;
pub use surface::Surface;
