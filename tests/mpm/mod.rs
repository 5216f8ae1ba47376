//! The method on whole problems: the solver against closed forms, and scenes and cases through the program.

mod axis;
mod balance;
