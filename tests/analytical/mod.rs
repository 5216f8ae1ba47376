//! Closed-form solutions that the program is verified against, one a file, each with its source.

pub mod elastica;
pub mod limit_load;
pub mod mandel;
pub mod self_weight_column;
pub mod terzaghi;
pub mod vibrating_bar;
