//! The solver against closed forms, one file a problem.

mod bar;
mod bench;
mod cantilever;
mod column;
mod ddmp;
mod ghost;
mod held_out;
mod incompressible;
mod patch;
mod rotation;
