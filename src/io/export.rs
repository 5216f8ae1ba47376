//! Result frames to series for ParaView: `vtu/points_000123.vtu` and `vtu/grid_000123.vtu` with `points.pvd`
//! and `grid.pvd`, with the fields that the case asks for; where it has finite elements, `vtu/structures_000123.vtu` and
//! `structures.pvd` with these; and where they touch soil, `vtu/contact_000123.vtu` and `contact.pvd` with what it exerts
//! along their boundaries. Where the surface of the material is known, `vtu/surface_000123.vtp` and `surface.pvd`. The soil as a
//! body, in `vtu/soil_000123.vtu` and `soil.pvd`, is made here ([`crate::soil`]).
//!
//! Derived here, from the stress: `mean_stress` (tension positive) and `deviatoric_stress`, √(3/2 s:s).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use rayon::prelude::*;

use super::frame::{self, Frame, Part};
use super::provenance::Origin;
use super::vtu::{self, Encoding, Grid, Topology};
use super::{atomic, hash, pvd};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::program;

mod contact;
mod fields;
mod pieces;
mod soil;
mod surface;

use fields::{column, select};
use pieces::Piece;
use soil::Bodies;

/// The kinds of files, each with a `.pvd`.
const SERIES: [&str; 6] = ["points", "grid", SOIL, STRUCTURES, CONTACT, SURFACE];
const SOIL: &str = "soil";
const STRUCTURES: &str = "structures";
const CONTACT: &str = "contact";
const SURFACE: &str = "surface";

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
    let infos = frame::list(results)?;
    let folder = out.join(NEW);
    prepare(out)?;
    atomic::prepare_folder(&folder)?;
    let _in_hand = InHand(&folder);
    let note = infos.first().map(|info| note(info.origin)).unwrap_or_default();
    let write = |series: &str, index: usize, grid: Grid| {
        let (path, grid) = (folder.join(file_name(series, index)), Grid { note: note.clone(), ..grid });
        if series == SURFACE { vtu::write_lines(&path, &grid, encoding) } else { vtu::write(&path, &grid, encoding) }
    };
    let is_element = |c: usize| regions.elements[mesh.cells.region[c] as usize];
    let elements = mesh.part(is_element);
    let with_elements = !elements.cells.is_empty();
    let (background, structures) = if with_elements {
        (Piece::background(&mesh.part(|c| !is_element(c))), Piece::by_region(&elements))
    } else {
        (Piece::whole(mesh), Piece::default())
    };
    let with_contact = infos.iter().any(|info| info.contact > 0);
    let with_surface = infos.iter().any(|info| info.surface > 0);
    let first = triples(&mesh.nodes);
    let bodies = Bodies::new(mesh, regions, (&structures, &elements.cells.kind), &infos)?;
    infos.par_iter().enumerate().try_for_each(|(i, info)| {
        let frame = Frame::read(&info.path)?;
        check_fields(&info.path, &frame, fields)?;
        let Frame { time, points, mut grid, elements, contact, surface, .. } = frame;
        let time = Some(time);
        let vertices = Grid {
            point_data: select(&points, fields),
            topology: Topology::vertices(points.position.len()),
            points: points.position.concat(),
            ..Grid { time, ..Grid::default() }
        };
        write("points", i, vertices)?;
        if grid.position.is_empty() {
            grid.position.clone_from(&first);
        }
        let count = mesh.nodes.len();
        let fits = grid.position.len() == count && grid.columns.iter().all(|c| c.values.len() == c.components * count);
        let from = if fits { counted_from(&mut grid, &first) } else { Cow::Borrowed(&first[..]) };
        let Some(smooth) = structures.smooth(&grid, &from, &elements).filter(|_| fits) else {
            return Err(Error::input(
                info.path.display(),
                format!("has not the {count} nodes and the cells of the mesh"),
                "the mesh was made again after the run: run `mpm solve` again",
            ));
        };
        if let Some(bodies) = &bodies {
            let body = bodies.grid(i, (&info.phase, info.time), &points, &grid.position, &smooth, fields);
            write(SOIL, i, body)?;
        }
        write("grid", i, background.grid(&background.at(&grid), fields, time))?;
        if with_elements {
            write(STRUCTURES, i, structures.grid(&smooth, fields, time))?;
        }
        if with_contact {
            let Some(lines) = contact::grid(&contact, time) else {
                return Err(Error::input(
                    info.path.display(),
                    "has not the boundaries in contact that others have",
                    "the frames are of several runs: run `mpm solve` again",
                ));
            };
            write(CONTACT, i, lines)?;
        }
        if with_surface {
            let Some(lines) = surface::lines(&surface, time) else {
                return Err(Error::input(
                    info.path.display(),
                    "has not the loops of the surface that others have",
                    "the frames are of several runs: run `mpm solve` again",
                ));
            };
            write(SURFACE, i, lines)?;
        }
        Ok(())
    })?;
    exchange(out)?;
    let is_there = |series: &str| match series {
        SOIL => bodies.is_some(),
        STRUCTURES => with_elements,
        CONTACT => with_contact,
        SURFACE => with_surface,
        _ => true,
    };
    for series in SERIES {
        let path = out.join(format!("{series}.pvd"));
        if !is_there(series) {
            if path.exists() {
                atomic::remove(&path)?;
            }
            continue;
        }
        let files: Vec<_> = infos
            .iter()
            .enumerate()
            .map(|(i, info)| (info.time, format!("{FOLDER}/{}", file_name(series, i))))
            .collect();
        pvd::write(&path, &files, &note)?;
    }
    Ok(Exported { frames: infos.len(), soil: bodies.is_some() })
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
        let _ = fs::remove_dir_all(self.0);
    }
}

/// What the files of a series say of themselves.
fn note(origin: Origin) -> String {
    format!("{} run {} mesh {}", program::IDENTITY, origin.run, hash::text(origin.mesh))
}

/// Undoes what an export that was killed has left.
fn prepare(out: &Path) -> Result<()> {
    let [folder, new, old] = [FOLDER, NEW, OLD].map(|name| out.join(name));
    atomic::refuse_link(&folder)?;
    if old.exists() && !folder.exists() {
        atomic::rename(&old, &folder)?;
    }
    atomic::remove_folder(&new)?;
    atomic::remove_folder(&old)
}

/// Puts the new series into the place of the earlier ones.
fn exchange(out: &Path) -> Result<()> {
    let [folder, new, old] = [FOLDER, NEW, OLD].map(|name| out.join(name));
    if folder.exists() {
        atomic::rename(&folder, &old)?;
    }
    atomic::rename(&new, &folder)?;
    if old.exists() {
        for entry in fs::read_dir(&old).map_err(|e| atomic::unwritable(&old, &e))? {
            let path = entry.map_err(|e| atomic::unwritable(&old, &e))?.path();
            if let Some(name) = path.file_name()
                && !is_of_series(&path)
            {
                atomic::rename(&path, &folder.join(name))?;
            }
        }
    }
    atomic::remove_folder(&old)
}

/// Whether a file is one of a series, or one that was not finished.
fn is_of_series(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    let stem = name.strip_suffix(".vtu").or_else(|| name.strip_suffix(".vtp"));
    let numbered = |(series, index): (&str, &str)| SERIES.contains(&series) && index.parse::<u64>().is_ok();
    name.starts_with('.') || stem.and_then(|stem| stem.split_once('_')).is_some_and(numbered)
}

/// Where the nodes were that displacements are counted from, given where they were at `first`.
fn counted_from<'a>(grid: &mut Part, first: &'a [[f64; 3]]) -> Cow<'a, [[f64; 3]]> {
    let Some(at) = grid.columns.iter().position(|column| column.name == frame::UNCOUNTED) else {
        return Cow::Borrowed(first);
    };
    let way = grid.columns.remove(at).values;
    Cow::Owned(first.iter().zip(way.chunks_exact(3)).map(|(x, way)| [0, 1, 2].map(|d| x[d] + way[d])).collect())
}

/// Coordinates padded to three.
fn triples<const D: usize>(x: &[[f64; D]]) -> Vec<[f64; 3]> {
    x.iter().map(|x| std::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))).collect()
}

fn file_name(series: &str, index: usize) -> String {
    let kind = if series == SURFACE { "vtp" } else { "vtu" };
    format!("{series}_{index:06}.{kind}")
}

/// Every field must be somewhere in the frame.
fn check_fields(path: &Path, frame: &Frame, fields: &[String]) -> Result<()> {
    let parts = [&frame.points, &frame.grid, &frame.elements];
    let has = |name: &str| parts.iter().any(|part| column(part, name).is_some());
    let given = |name: &String| parts.iter().any(|part| !select(part, std::slice::from_ref(name)).is_empty());
    let Some(missing) = fields.iter().find(|name| !given(name)) else { return Ok(()) };
    let names = parts.iter().flat_map(|part| &part.columns).map(|c| c.name.as_str());
    let names = names.filter(|name| ![frame::CELL, frame::UNCOUNTED].contains(name));
    let mut names: Vec<_> =
        names.chain(["mean_stress", "deviatoric_stress"].into_iter().filter(|name| has(name))).collect();
    names.sort_unstable();
    names.dedup();
    Err(Error::input(
        path.display(),
        format!("the field `{missing}` of output.fields is not in the results; they have {}", names.join(", ")),
        "run `mpm solve` again, or ask for another field",
    ))
}

#[cfg(test)]
mod tests;
