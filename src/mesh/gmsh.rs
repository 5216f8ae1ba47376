//! Meshes from Gmsh: a `.geo` to an MSH 4.1 file. Gmsh opens no mesh file: [`super::msh`] reads them.
//!
//! The program runs Gmsh in a process of its own, a [`Worker`], behind a filter of the `.geo` ([`sources`]) and with the
//! rights that the kernel can take from it. [`generate`] and [`groups`] are what that process does.
//!
//! Gmsh keeps one global model and is not safe to share among threads: a `Session` holds a lock, starts Gmsh afresh and
//! ends it when dropped. Gmsh prints nothing; what it has to say comes back in errors, with its own file and line.

mod check;
mod estimate;
mod files;
mod ranges;
mod sandbox;
mod script;
mod session;
mod token;
mod worker;

pub use script::{Sources, sources};
pub use worker::{COMMAND, Worker, serve};

use crate::error::{Error, Result};
use crate::reading;
use check::{check_parameters, check_surfaces};
use files::check_readable;
use serde::{Deserialize, Serialize};
use session::Session;
use std::path::Path;

/// What the case decides about the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Polynomial order of the cells: 1, 2 or 3.
    pub order: u8,
    /// Quadrilaterals of order 2 without a centre node (Q8 instead of Q9).
    pub incomplete: bool,
    /// Values of `DefineConstant` variables of the `.geo`, by name.
    pub parameters: Vec<(String, f64)>,
}

/// Meshes the plane geometry in `geo`, unless that is a mesh in another version or format, and writes MSH 4.1 with the names of the physical groups to `out`,
/// which must end in `.msh`; it is replaced in one go, and only by a complete file. It does so once `agree` to the names of the
/// groups, for an analysis that may take `memory` (bytes).
///
/// # Errors
/// Input: what Gmsh cannot read or mesh, with its line where it names one; a parameter that no
/// `DefineConstant` declares; a surface in no physical surface or in two; an order other than 1, 2 and 3; a mesh size below
/// the tolerance of the geometry.
/// Machine: `out` cannot be written.
pub fn generate(
    geo: &Path,
    options: &Options,
    out: &Path,
    memory: u64,
    agree: &mut dyn FnMut(Groups) -> Result<bool>,
) -> Result<()> {
    if !matches!(options.order, 1..=3) {
        return Err(Error::input(geo.display(), format!("order {} is not possible", options.order), "use 1, 2 or 3"));
    }
    let session = open(geo, options)?;
    if !agree(names(&session))? {
        return Ok(());
    }
    for (name, value) in [
        ("Mesh.ElementOrder", 1.0),
        ("Mesh.SecondOrderIncomplete", f64::from(u8::from(options.incomplete))),
        ("Mesh.SecondOrderLinear", 0.0),
        ("Mesh.MshFileVersion", 4.1),
        ("Mesh.Binary", 0.0),
        ("Mesh.SaveAll", 0.0),
        ("Mesh.SaveParametric", 0.0),
        ("Mesh.ScalingFactor", 1.0),
    ] {
        session.set_option(name, value)?;
    }
    if is_mesh(geo) {
        return session.write(out);
    }
    estimate::check_sizes(&session, geo)?;
    // A script may have meshed already, or hold a mesh of another program.
    if session.elements(1, -1).is_empty() {
        session.mesh(geo, 1)?;
        estimate::check_cells(geo, estimate::cells(&session)?, memory)?;
        // Surfaces on curves that are there already come out some 1e-16 elsewhere.
        session.clear();
    }
    session.mesh(geo, 2)?;
    estimate::check_cells(geo, session.elements(2, -1).len() as f64, memory)?;
    session.set_order(geo, options.order)?;
    session.write(out)
}

/// Whether a file is a mesh, which is written as it is, by the end of its name.
fn is_mesh(file: &Path) -> bool {
    file.extension().is_some_and(|end| end == "msh" || end == "med")
}

/// Where a physical surface lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outline {
    /// Lowest and highest corner (m) of the box around it.
    pub bounds: [[f64; 2]; 2],
    /// The numbers of the curves around its surfaces, ascending.
    pub curves: Vec<u32>,
}

/// The physical groups of a `.geo`, by their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Groups {
    pub surfaces: Vec<String>,
    /// Where each of the surfaces lies.
    pub outlines: Vec<Outline>,
    pub curves: Vec<String>,
    pub points: Vec<String>,
}

/// The names of the physical groups of the geometry in `geo`, which is not meshed.
///
/// # Errors
/// Input: as [`generate`], but for what only shows in meshing.
pub fn groups(geo: &Path, options: &Options) -> Result<Groups> {
    Ok(names(&open(geo, options)?))
}

fn names(session: &Session) -> Groups {
    let names = |dimension| session.physical_groups(dimension).into_iter().map(|group| group.name).collect();
    let outlines = session.physical_groups(2).iter().map(|group| outline(session, &group.entities)).collect();
    Groups { surfaces: names(2), outlines, curves: names(1), points: names(0) }
}

/// Where some surfaces lie, taken together.
fn outline(session: &Session, surfaces: &[i32]) -> Outline {
    let mut outline = Outline { bounds: [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], curves: Vec::new() };
    for &surface in surfaces {
        let [low, high] = session.bounds(2, surface);
        for d in 0..2 {
            // What is not a number bounds nothing.
            outline.bounds[0][d] = outline.bounds[0][d].min(low[d]);
            outline.bounds[1][d] = outline.bounds[1][d].max(high[d]);
        }
        outline.curves.extend(session.boundary(2, surface).iter().map(|curve| curve.unsigned_abs()));
    }
    outline.curves.sort_unstable();
    outline
}

/// A session with the geometry in `geo`, its parameters and surfaces checked.
fn open(geo: &Path, options: &Options) -> Result<Session> {
    check_readable(geo)?;
    let text = reading::bytes(geo).map_err(|error| Error::input(geo.display(), error, "check the path"))?;
    let last = text.rsplit(|&c| c == b'\n').next().unwrap_or_default();
    if !is_mesh(geo) && !last.trim_ascii().is_empty() {
        return Err(Error::input(
            geo.display(),
            "the last line has no end, and Gmsh would leave its statement out",
            "end the file with a line feed",
        ));
    }
    let session = Session::start()?;
    for (name, value) in &options.parameters {
        session.set_parameter(geo, name, *value)?;
    }
    session.merge(geo)?;
    check_parameters(&session, geo, &String::from_utf8_lossy(&text), &options.parameters)?;
    check_surfaces(&session, geo)?;
    Ok(session)
}
