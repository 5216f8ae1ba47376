//! Implicit second-order Material Point Method for geotechnics.

pub mod error;
pub mod material;
pub mod mesh;
pub mod points;
pub mod seed;
pub mod tensor;
