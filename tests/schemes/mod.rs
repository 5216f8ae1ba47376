//! The schemes whose points have an extent (docs/schemes.md): their functions by themselves, and scenes solved with them.

mod functions;
mod program;
mod shapes;
mod solved;
mod tangent;
