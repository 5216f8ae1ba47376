//! Water: its pressure on the boundary of the soil, its flow through the pores, and its level inside and outside.

#[path = "../support/bench.rs"]
mod bench;
mod boundary_pressure;
mod covered_surface;
mod drained_surface;
#[path = "../support/layout.rs"]
mod layout;
mod phreatic;
mod pore_water;
#[path = "../support/mod.rs"]
mod support;
mod terzaghi;
