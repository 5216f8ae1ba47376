//! Water: its pressure on the boundary of the soil, its flow through the pores, and its level inside and outside.

mod boundary_pressure;
mod covered_surface;
mod drained_soil;
mod drained_surface;
mod inclined_table;
mod phreatic;
mod pore_water;
mod terzaghi;
