//! Implicit second-order Material Point Method for geotechnics.

pub mod analytical;
pub mod case;
pub mod cli;
pub mod error;
pub mod io;
pub mod kinematics;
pub mod material;
pub mod mesh;
pub mod points;
pub mod profile;
pub mod run;
pub mod seed;
pub mod stencil;
pub mod step;
pub mod system;
pub mod tensor;
pub mod term;
pub mod time_integration;
pub mod time_value;
