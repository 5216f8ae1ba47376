//! The solver against closed forms, one file a problem.

mod bar;
mod bench;
mod boundary_projection;
mod cantilever;
mod column;
mod ddmp;
mod drained_surface;
mod elements;
mod general_position;
mod ghost;
mod held_out;
mod incompressible;
mod layout;
mod patch;
mod population;
mod resampled;
mod rotation;
mod scheme;
mod slivers;
mod surface;
mod terzaghi;
mod water;
