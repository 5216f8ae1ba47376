//! The schemes whose points have an extent (docs/schemes.md): their functions by themselves, and scenes solved with them.

#[path = "../support/bench.rs"]
#[allow(dead_code)] // some scenes of other tests have more
mod bench;
mod functions;
mod program;
mod shapes;
mod solved;
#[path = "../terms/stand.rs"]
#[allow(dead_code)] // as above
mod stand;
#[path = "../support/mod.rs"]
mod support;
mod tangent;
