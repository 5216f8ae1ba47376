//! Mutated files through every reader of the program: no panic, no hang, no memory without bound, and none that is read as
//! something else than what was written. `README.md` beside this file says how to run it for longer and how to add a fault.

mod files;
mod harness;
mod memory;
mod mutate;
mod readers;
mod scenes;

use harness::fuzz;
use readers::{Abaqus, Cases, Checkpoints, Frames, Histories, Meshes, Points};

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting;

/// The readers that `FUZZ_SECONDS` is shared among.
const READERS: u32 = 7;

#[test]
fn cases() {
    fuzz(&Cases::new());
}

#[test]
fn meshes() {
    fuzz(&Meshes::new());
}

#[test]
fn abaqus() {
    fuzz(&Abaqus::new());
}

#[test]
fn points() {
    fuzz(&Points::new());
}

#[test]
fn frames() {
    fuzz(&Frames::new());
}

#[test]
fn histories() {
    fuzz(&Histories::new());
}

#[test]
fn checkpoints() {
    fuzz(&Checkpoints::new());
}
