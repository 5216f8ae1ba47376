//! Implicit second-order Material Point Method for geotechnics.

pub mod analytical;
pub mod error;
pub mod material;
pub mod mesh;
pub mod points;
pub mod tensor;
