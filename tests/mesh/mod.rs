//! Meshes: made by Gmsh, read from files, imported from other programs, and geometries that are refused.

mod at_rest;
mod given;
mod gmsh;
mod hostile_geo;
mod import;
mod msh;
mod plane;
