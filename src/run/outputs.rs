//! What a run writes.

use super::ending::Until;
use super::fields::Field;
use super::surface::Acting;
use super::watch::Watch;
use crate::io::phase_state::End;
use crate::io::provenance::Origin;
use crate::io::run_folder::RunFolder;

/// What a run writes, and where.
#[derive(Clone)]
pub struct Outputs {
    pub folder: RunFolder,
    /// What is told of the case as the run begins.
    pub warnings: Vec<String>,
    /// The fields of the points in the frames.
    pub fields: Vec<Field>,
    pub watches: Vec<Watch>,
    /// What ends each phase before its time.
    pub until: Vec<Vec<Until>>,
    /// What acts on the surface of the material, where that is shown.
    pub surface: Option<Acting>,
    /// What the states at the ends of phases belong to, by number of the phase; those without are not kept.
    pub ends: Vec<Option<End>>,
    /// What the run is made from: whether a checkpoint belongs to the case, and a frame to the mesh.
    pub origin: Origin,
}
