//! Implicit second-order Material Point Method for geotechnics.

pub mod case;
pub mod cli;
pub mod error;
pub mod io;
pub mod material;
pub mod mesh;
pub mod points;
pub mod seed;
pub mod tensor;
pub mod time_value;
