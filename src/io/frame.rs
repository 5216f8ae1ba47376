//! Result frames: what a run shows at one moment, as `frame-000123.mpmf` in the results folder.
//!
//! Frames are numbered from 0, the initial state, without gaps. A run that continues from a checkpoint writes
//! the later ones again, to the same bytes.

use std::path::{Path, PathBuf};

use super::checkpoint::Fingerprint;
use super::container::{Array, Contents, Data, Store, check_finite, not_finite};
use super::provenance::Origin;
use super::{atomic, hash};
use crate::error::{Error, Result};
use crate::program;

const KIND: &str = "frame";
const AGAIN: &str = "run `mpm solve` again";
const POSITION: &str = "position";

/// A quantity at the points or nodes of a [`Part`].
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name as the case has it in `output.fields`.
    pub name: String,
    /// Unit, `-` for none.
    pub unit: String,
    /// 1 (scalar), 3 (vector), 6 (symmetric tensor, `tensor::SYMMETRIC_NAMES`) or 9 (tensor by rows).
    pub components: usize,
    /// Tuple after tuple.
    pub values: Vec<f64>,
}

impl Column {
    pub fn new(name: &str, unit: &str, components: usize, values: Vec<f64>) -> Self {
        Self { name: name.into(), unit: unit.into(), components, values }
    }
}

/// Coordinates padded to three.
pub fn triples<const D: usize>(x: &[[f64; D]]) -> Vec<[f64; 3]> {
    x.iter().map(|x| std::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))).collect()
}

/// Points, or the nodes of a mesh, and what is known there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Coordinates in m, padded to three. Empty in the grid: the nodes are where the mesh has them.
    pub position: Vec<[f64; 3]>,
    pub columns: Vec<Column>,
}

impl Part {
    /// The numbers of a column, if there is one of this name and with so many components.
    pub fn numbers(&self, name: &str, components: usize) -> Option<&[f64]> {
        self.columns.iter().find(|c| c.name == name && c.components == components).map(|c| &c.values[..])
    }
}

/// The state at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Time in s since the start of the first phase.
    pub time: f64,
    /// Name of the phase.
    pub phase: String,
    /// Steps done.
    pub step: u64,
    /// What the run was made from.
    pub origin: Origin,
    pub points: Part,
    pub grid: Part,
    /// The points of the finite elements, with the number of their cell among those of finite elements in the column
    /// [`CELL`]; empty, and not written, without finite elements.
    pub elements: Part,
    /// The boundaries of structures in contact, as the lines of [`LINE`]; empty, and not written, without contact.
    pub contact: Part,
    /// The corners of the surface of the material, as the loops of [`LINE`]; empty, and not written, where it is not known.
    pub surface: Part,
}

/// The column of [`Frame::elements`] that tells the cells.
pub const CELL: &str = "cell";

/// The column of [`Frame::points`] with the volume (m³, per metre or full turn) of each, written together with their displacement. It is not exported.
pub const VOLUME: &str = "volume";

/// The field of the internal variables of the models; the column of each is this, a point and its name.
pub const INTERNAL: &str = "internal_variables";

/// The column of [`Frame::grid`] that tells what of the way of a node displacements are not counted from; absent before a
/// phase resets them, and without finite elements.
pub const UNCOUNTED: &str = "uncounted";

/// Columns of [`Frame::contact`] that are not shown as they are: the number of the line that a node is on, which joins
/// nodes that follow each other (the last one of a surface with its first); the region of its structure; and whether there is soil before it (1) or not (0).
pub const LINE: &str = "line";
pub const REGION: &str = "region";
pub const FACES: &str = "faces";

/// The column of [`Frame::points`] and [`Frame::elements`] with how far each has moved (m).
pub const DISPLACEMENT: &str = "displacement";

/// The column of [`Frame::contact`] with the gap (m).
pub const GAP: &str = "contact_gap";

/// How many components the columns have that more is made of than their picture.
const COMPONENTS: [(&str, usize); 8] =
    [(CELL, 1), (VOLUME, 1), (UNCOUNTED, 3), (LINE, 1), (REGION, 1), (FACES, 1), (DISPLACEMENT, 3), (GAP, 1)];

/// What a listing tells about a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    pub path: PathBuf,
    pub time: f64,
    pub phase: String,
    pub step: u64,
    pub origin: Origin,
    /// Material points.
    pub points: usize,
    /// Nodes along boundaries in contact.
    pub contact: usize,
    /// Corners of the surface of the material.
    pub surface: usize,
}

const NAME: [&str; 2] = ["frame-", ".mpmf"];

/// Whether a name is that of a frame.
pub fn is_name(name: &str) -> bool {
    atomic::number::<usize>(name, NAME[0], NAME[1]).is_some()
}

/// The file of frame `index`.
pub fn path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("{}{index:06}{}", NAME[0], NAME[1]))
}

impl Frame {
    /// Writes the frame as number `index` to the disk, atomically; returns the hash of the file.
    ///
    /// # Errors
    /// `Analysis` naming the material point or node whose value is not finite (then nothing is written);
    /// `Machine` when the file cannot be written.
    pub fn write(self, folder: &Path, index: usize) -> Result<u64> {
        let mut store = Store::new(KIND);
        // Rust prints a float with as many digits as tell it from all others.
        store.put_text("time", format!("{:?}", self.time));
        store.put_text("phase", &*self.phase);
        store.put_text("step", self.step.to_string());
        store.put_text("program", program::IDENTITY);
        store.put_text("run", self.origin.run.to_string());
        store.put_text("mesh", hash::text(self.origin.mesh));
        let parts = [
            ("points/", "material point", self.points),
            ("grid/", "grid node", self.grid),
            ("elements/", "point of a finite element", self.elements),
            ("contact/", "node of a boundary in contact", self.contact),
            ("surface/", "corner of the surface", self.surface),
        ];
        let optional = |prefix: &str| matches!(prefix, "elements/" | "contact/" | "surface/");
        let written = parts.into_iter().filter(|(prefix, _, part)| !optional(prefix) || !part.position.is_empty());
        for (prefix, item, part) in written {
            let position =
                Column { name: POSITION.into(), unit: "m".into(), components: 3, values: part.position.concat() };
            for Column { name, unit, components, values } in std::iter::once(position).chain(part.columns) {
                let mut array = Array { name, unit, components, data: Data::F64(values) };
                check_finite(&array, item)?;
                array.name.insert_str(0, prefix);
                store.put_array(array);
            }
        }
        store.write(&path(folder, index), true)
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// `Input` when the file is missing, cut or damaged, or a number is not finite; when a column is there twice, has not as many entries as
    /// the others, or not the components that it must have.
    pub fn read(path: &Path) -> Result<Self> {
        let store = Store::read(path, KIND, AGAIN)?;
        let (time, phase, step, origin) = read_texts(path, |name| store.text(name))?;
        let mut frame = Self { time, phase, step, origin, ..Self::default() };
        for array in store.into_arrays() {
            if let Some((entry, value)) = not_finite(&array) {
                let problem = format!("is damaged: entry {entry} of array `{}` is {value}", array.name);
                return Err(Error::input(path.display(), problem, AGAIN));
            }
            let Array { name, unit, components, data } = array;
            let broken = || Error::input(path.display(), format!("is damaged: array `{name}` is unexpected"), AGAIN);
            let (part, name) = match name.split_once('/') {
                Some(("points", name)) => (&mut frame.points, name),
                Some(("grid", name)) => (&mut frame.grid, name),
                Some(("elements", name)) => (&mut frame.elements, name),
                Some(("contact", name)) => (&mut frame.contact, name),
                Some(("surface", name)) => (&mut frame.surface, name),
                _ => return Err(broken()),
            };
            let Data::F64(values) = data else { return Err(broken()) };
            match (name, components) {
                (POSITION, 3) => part.position = values.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect(),
                (POSITION, _) => return Err(broken()),
                _ if part.columns.iter().any(|column| column.name == name) => return Err(broken()),
                _ if COMPONENTS.iter().any(|&(known, count)| known == name && count != components) => {
                    return Err(broken());
                }
                _ => part.columns.push(Column { name: name.to_string(), unit, components, values }),
            }
        }
        let parts = [
            ("points", &frame.points),
            ("grid", &frame.grid),
            ("elements", &frame.elements),
            ("contact", &frame.contact),
            ("surface", &frame.surface),
        ];
        for (what, part) in parts {
            let counts = part.columns.iter().map(|c| (c.name.as_str(), c.values.len() / c.components));
            // A grid without positions of its own takes those of the mesh; its columns still agree.
            let of_mesh = what == "grid" && part.position.is_empty();
            let count = (!of_mesh).then_some((POSITION, part.position.len()));
            let mut all = count.into_iter().chain(counts);
            let Some((_, first)) = all.next() else { continue };
            if let Some((name, n)) = all.find(|&(_, n)| n != first) {
                let problem = format!("is damaged: {what} column `{name}` has {n} entries where {first} are expected");
                return Err(Error::input(path.display(), problem, AGAIN));
            }
        }
        Ok(frame)
    }
}

/// The frames of a results folder in order, from their headers alone.
///
/// # Errors
/// `Input` when the folder is missing or empty, a frame is missing, cut or damaged, or the frames do not
/// belong together: times or steps go back, or they are of different runs.
pub fn list(folder: &Path) -> Result<Vec<Info>> {
    let indices = indices(folder)?;
    if indices.is_empty() {
        return Err(Error::input(folder.display(), "there are no result frames here", "run `mpm solve` first"));
    }
    let mut infos: Vec<Info> = Vec::with_capacity(indices.len());
    for (expected, index) in indices.into_iter().enumerate() {
        if index != expected {
            return Err(Error::input(path(folder, expected).display(), "this frame is missing", AGAIN));
        }
        let path = path(folder, index);
        let Contents { texts, arrays } = Store::peek(&path, KIND, AGAIN)?;
        let (time, phase, step, origin) = read_texts(&path, |name| {
            texts
                .get(name)
                .map(String::as_str)
                .ok_or_else(|| Error::input(path.display(), format!("is damaged: text `{name}` is missing"), AGAIN))
        })?;
        let count = |array: &str| arrays.iter().find(|(name, _)| name == array).map_or(0, |&(_, n)| n);
        let [points, contact, surface] = ["points/position", "contact/position", "surface/position"].map(count);
        if let Some(before) = infos.last() {
            let mixed = |problem: String| {
                Err(Error::input(path.display(), format!("does not belong to the frame before: {problem}"), AGAIN))
            };
            if time < before.time || step < before.step {
                return mixed(format!("time {time} at step {step} after {} at {}", before.time, before.step));
            }
            if origin != before.origin {
                return mixed("it is of another run".to_owned());
            }
        }
        infos.push(Info { path, time, phase, step, origin, points, contact, surface });
    }
    Ok(infos)
}

/// Makes the folder ready for frames from `first` on: later ones of an earlier run are removed (0: all).
///
/// # Errors
/// `Machine` when the folder cannot be made or a frame cannot be removed.
pub fn prepare(folder: &Path, first: usize) -> Result<()> {
    atomic::prepare_folder(folder)?;
    indices(folder)?.into_iter().filter(|&i| i >= first).try_for_each(|i| atomic::remove(&path(folder, i)))
}

/// The files of the frames in a results folder, in order; none where there is no folder.
///
/// # Errors
/// `Machine` when the folder cannot be read.
pub fn paths(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    Ok(indices(folder)?.into_iter().map(|index| path(folder, index)).collect())
}

fn indices(folder: &Path) -> Result<Vec<usize>> {
    atomic::numbered(folder, NAME[0], NAME[1]).map_err(|e| atomic::unreadable(folder, &e, "run `mpm solve` first"))
}

type Texts = (f64, String, u64, Origin);

fn read_texts<'a>(path: &Path, text: impl Fn(&'static str) -> Result<&'a str>) -> Result<Texts> {
    let broken = |name: &str, value: &str| {
        Error::input(path.display(), format!("is damaged: {name} `{value}` is not a number"), AGAIN)
    };
    let (time, step, run, mesh) = (text("time")?, text("step")?, text("run")?, text("mesh")?);
    let parsed = time.parse::<f64>().ok().filter(|t| t.is_finite());
    let hash = |name: &str, value: &str| u64::from_str_radix(value, 16).map_err(|_| broken(name, value));
    Ok((
        parsed.ok_or_else(|| broken("time", time))?,
        text("phase")?.to_string(),
        step.parse().map_err(|_| broken("step", step))?,
        Origin { run: Fingerprint::from(hash("run", run)?), mesh: hash("mesh", mesh)? },
    ))
}

#[cfg(test)]
pub(super) mod tests;
