//! All tests but those of `fuzz`, in one program: what is generic is compiled once, and no test waits for another topic to end.

mod analytical;
mod architecture;
mod campaign;
mod cli;
mod contact;
mod documents;
mod io;
mod manual;
mod material;
mod mesh;
mod mpm;
mod schemes;
mod support;
mod terms;
mod three_d;
mod water;
