//! Three dimensions, as far as they go: the internal force of points in tetrahedra and hexahedra, and their cells in files.
//!
//! Shapes, meshes, location and seeding have their tests beside them; these are of what is made of them together.

mod internal;
mod output;
mod patch;
mod stand;
