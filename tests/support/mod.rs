//! What the tests of all topics share: starting the program, reading what it wrote, a small scene, random numbers.

pub mod bench;
pub mod block;
mod history;
pub mod layout;
mod program;
mod random;
pub mod stand;

pub use history::{column, rows};
pub use program::{
    PROGRAM, command, errors, in_folder, log, mpm, project, python, run, safety, said, solve, solve_text, stage,
    succeeds, written,
};
pub use random::Random;
