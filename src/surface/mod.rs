//! Where the material ends: its surface within the cells, reconstructed from the material points.

pub mod moments;
mod split;
