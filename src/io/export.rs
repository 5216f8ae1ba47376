//! Result frames to series for ParaView: `vtu/points_000123.vtu` and `vtu/grid_000123.vtu` with `points.pvd`
//! and `grid.pvd`, with the fields that the case asks for; where it has finite elements, `vtu/structures_000123.vtu` and
//! `structures.pvd` with these; and where they touch soil, `vtu/contact_000123.vtu` and `contact.pvd` with what it exerts
//! along their boundaries. Where the surface of the material is known, `vtu/surface_000123.vtp` and `surface.pvd`. The soil as a
//! body, in `vtu/soil_000123.vtu` and `soil.pvd`, is made here ([`crate::soil`]).
//!
//! Derived here, from the stress: `mean_stress` (tension positive) and `deviatoric_stress`, √(3/2 s:s).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::provenance::{self, Origin};
use super::vtu::{self, Encoding, Grid};
use super::{atomic, hash, pvd};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::program;

mod contact;
mod fields;
mod pieces;
pub mod plates;
mod section;
mod series;
mod soil;
mod surface;

pub use section::{Section, Sheet};
pub use series::{Series, Shown};

/// The name of the stage that writes series, in its record.
pub const STAGE: &str = "export";

/// The kinds of files, each with a `.pvd`.
const SERIES: [&str; 7] = ["points", "grid", SOIL, STRUCTURES, CONTACT, SURFACE, PLATES];
const SOIL: &str = "soil";
const STRUCTURES: &str = "structures";
const CONTACT: &str = "contact";
const SURFACE: &str = "surface";
const PLATES: &str = "plates";

/// The table of the forces in plates.
pub const SECTIONS: &str = "plates.csv";

/// What the regions of a mesh are, by number, and what phases do with them.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    /// Whether each is of finite elements.
    pub elements: Vec<bool>,
    /// Whether each is of soil: material points, or finite elements that are no structure.
    pub soil: Vec<bool>,
    /// Whether the mesh is a half plane that is turned about its axis.
    pub axisymmetric: bool,
    /// The names of the phases that count displacements from their beginning.
    pub resets: Vec<String>,
    /// The structures that are not there in a phase, by its name.
    pub absent: BTreeMap<String, Vec<u16>>,
    /// The plates, by number, with their names.
    pub plates: Vec<(u16, String)>,
    /// Whether phases remove or place soil.
    pub changes: bool,
    /// The number of the material that each region has in a phase, by its name.
    pub materials: BTreeMap<String, Vec<u16>>,
}

/// What was exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    pub frames: usize,
    /// Whether the soil is there as a body; it is not where the frames do not hold the displacement.
    pub soil: bool,
}

/// Writes the frames in `results` as series into `out`, with `fields` and nothing else.
///
/// The files are written into a folder beside that of an earlier export and take its place when all of them are there;
/// other files that somebody has put there stay. The `.pvd` files are written last.
///
/// # Errors
/// `Input` when there are no frames, one is damaged, they do not belong to `mesh`, or a field is in none of
/// them; `Machine` when a file cannot be written.
pub fn export(
    results: &Path,
    mesh: &Mesh<2>,
    regions: &Regions,
    out: &Path,
    fields: &[String],
    encoding: Encoding,
) -> Result<Exported> {
    let series = Series::open(results, mesh, regions)?;
    let infos = &series.infos;
    let folder = out.join(NEW);
    prepare(out)?;
    atomic::prepare_folder(&folder)?;
    let _in_hand = InHand(&folder);
    let note = infos.first().map(|info| note(info.origin)).unwrap_or_default();
    let of_frame = |i: usize| {
        let Shown { points, grid, soil, structures, contact, surface, plates, sections } = series.at(i, fields)?;
        let grids = [Some(points), Some(grid), soil, structures, contact, surface, plates];
        for (name, grid) in SERIES.into_iter().zip(grids) {
            let Some(grid) = grid else { continue };
            let (path, grid) = (folder.join(file_name(name, i)), Grid { note: note.clone(), ..grid });
            if name == SURFACE {
                vtu::write_lines(&path, &grid, encoding)?;
            } else {
                vtu::write(&path, &grid, encoding)?;
            }
        }
        Ok(plates::rows(&series.plates, &sections, &infos[i]))
    };
    let rows = (0..infos.len()).into_par_iter().map(of_frame).collect::<Result<Vec<String>>>()?;
    exchange(out)?;
    let table = out.join(SECTIONS);
    if series.has(PLATES) {
        let text = std::iter::once(format!("{}\n", plates::HEADING)).chain(rows).collect::<String>();
        atomic::write(&table, |out| out.write_all(text.as_bytes()))?;
    } else if table.exists() {
        atomic::remove(&table)?;
    }
    for name in SERIES {
        let path = out.join(format!("{name}.pvd"));
        if !series.has(name) {
            if path.exists() {
                atomic::remove(&path)?;
            }
            continue;
        }
        let files: Vec<_> =
            infos.iter().enumerate().map(|(i, info)| (info.time, format!("{FOLDER}/{}", file_name(name, i)))).collect();
        pvd::write(&path, &files, &note)?;
    }
    Ok(Exported { frames: infos.len(), soil: series.has(SOIL) })
}

/// The folder of the series, and those of an export in hand and of the one before it.
const FOLDER: &str = "vtu";
const NEW: &str = ".vtu-new";
const OLD: &str = ".vtu-old";

/// The folder of an export in hand: what is left of it goes when this does.
struct InHand<'a>(&'a Path);

impl Drop for InHand<'_> {
    fn drop(&mut self) {
        // Only tidiness: the next export does it again, and says where it cannot.
        let _ = atomic::clear_folder(self.0, is_of_series);
    }
}

/// What the files of a series say of themselves.
fn note(origin: Origin) -> String {
    format!("{} run {} mesh {}", program::IDENTITY, origin.run, hash::text(origin.mesh))
}

/// Undoes what an export that was killed has left.
fn prepare(out: &Path) -> Result<()> {
    let [folder, new, old] = [FOLDER, NEW, OLD].map(|name| out.join(name));
    [&folder, &new, &old].into_iter().try_for_each(|folder| atomic::refuse_link(folder))?;
    if old.exists() && !folder.exists() {
        atomic::rename(&old, &folder)?;
    }
    atomic::clear_folder(&new, is_of_series)?;
    discard(&old, &folder)
}

/// Removes a series, once what others keep beside it is in `folder`.
fn discard(old: &Path, folder: &Path) -> Result<()> {
    atomic::move_others(old, folder, is_of_series)?;
    atomic::clear_folder(old, is_of_series)
}

/// Puts the new series into the place of the earlier ones.
fn exchange(out: &Path) -> Result<()> {
    let [folder, new, old] = [FOLDER, NEW, OLD].map(|name| out.join(name));
    if folder.exists() {
        atomic::rename(&folder, &old)?;
    }
    atomic::rename(&new, &folder)?;
    discard(&old, &folder)
}

/// The files that an export would replace, and are there.
///
/// # Errors
/// `Input` for a link in place of the folder of the series, `Machine` when it cannot be read.
pub fn replaced(out: &Path) -> Result<Vec<PathBuf>> {
    atomic::refuse_link(&out.join(FOLDER))?;
    let collections = SERIES.map(|name| out.join(format!("{name}.pvd"))).into_iter().chain([out.join(SECTIONS)]);
    let series = atomic::entries(&out.join(FOLDER))?.into_iter().filter(|path| atomic::is_named(path, is_of_series));
    Ok(collections.filter(|path| path.exists()).chain(series).collect())
}

/// Removes a series and the record of its export.
///
/// # Errors
/// `Input` for a link in place of the folder of the series, `Machine` when something cannot be removed.
pub fn remove(out: &Path) -> Result<()> {
    [FOLDER, NEW, OLD].iter().try_for_each(|name| atomic::clear_folder(&out.join(name), is_of_series))?;
    SERIES.iter().try_for_each(|name| atomic::remove(&out.join(format!("{name}.pvd"))))?;
    atomic::remove(&out.join(SECTIONS))?;
    atomic::remove(&provenance::path(out, STAGE))
}

/// Whether a name is that of a file of a series.
fn is_of_series(name: &str) -> bool {
    let stem = name.strip_suffix(".vtu").or_else(|| name.strip_suffix(".vtp"));
    let numbered = |(series, index): (&str, &str)| SERIES.contains(&series) && index.parse::<u64>().is_ok();
    stem.and_then(|stem| stem.split_once('_')).is_some_and(numbered)
}

fn file_name(series: &str, index: usize) -> String {
    let kind = if series == SURFACE { "vtp" } else { "vtu" };
    format!("{series}_{index:06}.{kind}")
}

#[cfg(test)]
mod tests;
