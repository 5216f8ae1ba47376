//! Contact between the boundary of a structure and soil: where they meet, how far apart they are and what they
//! exert on each other.
//!
//! The boundary is where contact is integrated, for there area and normal are exact. Pressure and shear are combinations
//! of contact nodes along it, about half an edge of the soil's cells apart (`case/contact_interfaces.rs`), and each contact node has one condition: its
//! mean gap. It is summed over segments of a fifth of that distance. The gap of a segment is the distance to the followed surface of the soil;
//! where there is none, it is the signed distance of the nearest point to the boundary (its level set), less the half width of that point.

mod along;
mod bodies;
mod constraint;
mod cover;
mod gap;
mod interface;
mod law;
mod motion;
mod multipliers;
mod place;
mod rigid;
mod sides;
mod smoothing;
mod surface;

pub use along::{Mark, Tractions};
pub use bodies::{Bodies, SoilSide};
pub use constraint::Constraint;
pub use interface::{Boundary, Ground, Interface, Pushed};
pub use law::{Answer, Law, Laws, Penalty};
pub use motion::{Motion, Spot};
pub use multipliers::Multipliers;
pub use rigid::Rigid;
pub use sides::Sides;
pub use surface::{Run, Surface};
