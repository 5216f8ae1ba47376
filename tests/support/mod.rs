//! What the tests of all topics share: starting the program, reading what it wrote, a small scene, random numbers.

#![allow(dead_code, unused_imports)] // each topic takes a part of it

pub mod block;
mod history;
mod program;
mod random;

pub use history::{column, rows};
pub use program::{
    PROGRAM, command, errors, in_folder, mpm, project, python, run, said, solve, solve_text, stage, succeeds, written,
};
pub use random::Random;
