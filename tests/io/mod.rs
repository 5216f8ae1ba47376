//! What the program writes: files that other programs read, pictures drawn from them, and a process killed as it writes.

mod kill;
mod pictures;
mod pile_study;
mod readers;
