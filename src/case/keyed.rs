//! Entries of the case with terms of their own: each is one file, which declares its key, what may be written there, its checks and
//! its terms.
//!
//! A file implements [`Keyed`]; [`Key::of`] is what the list of the keys has of it: those built in (`KEYS` in `src/case/mod.rs`), or those
//! that a caller of the library adds ([`super::Keys::with`]). Schema, messages, the results that are stale when the entry changes,
//! and the scene follow from the list. `tests/terms/keyed.rs` is a whole one, defined outside the crate.

use super::check::Checker;
use super::checked::{Feature, Geometry, Site, Surface};
use super::issue::Issue;
use super::locate::{At, Path, Step};
use super::raw::{CaseFile, Product};
use crate::error::Result;
use crate::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use crate::mesh::Mesh;
use crate::term::Term;
use crate::time_value::TimeValue;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::Value;
use serde_path_to_error::Segment;
use std::fmt;
use std::sync::Arc;

/// The terms that an entry adds.
pub type Terms = Result<Vec<Box<dyn Term<2>>>>;

/// An entry at the top level of the case with terms of its own, checked.
pub trait Keyed: fmt::Debug + Send + Sync + Sized + 'static {
    const KEY: &'static str;

    /// What the entry is, with units: its description in the schema. The first sentence is shown as a remedy.
    const DESCRIPTION: &'static str;

    /// What the entry shapes of what the stages make.
    const SHAPES: &'static [Product] = &[Product::Results];

    /// The entry as it is written. Its type is its schema, so that mistakes in its shape need no check.
    type Written: DeserializeOwned + JsonSchema + 'static;

    /// Checks what is written at `path` of a case `file`, and gives each mistake that shows without the mesh to `checker`. Other
    /// entries of the file may be wrong; they have been reported. `None` only after a mistake.
    fn check(written: Self::Written, file: &CaseFile, path: &Path, checker: &mut Checker) -> Option<Self>;

    /// The physical curves that the entry names, each with the place of the name, given that of the entry. They are held against the mesh.
    fn curves(&self, _path: &Path) -> Vec<(&str, Path)> {
        Vec::new()
    }

    /// Its values that vary in the time of phase number `phase`, from 0: steps end where they bend.
    fn values(&self, _phase: usize) -> Vec<&TimeValue> {
        Vec::new()
    }

    /// Whether its terms need the surface of the material points.
    fn needs_surface(&self) -> bool {
        false
    }

    /// The surface that the entry drains, if it does.
    fn drains(&self) -> Option<Surface> {
        None
    }

    /// The terms on the background grid. They see its material points, and all nodes, those of finite elements too.
    ///
    /// # Errors
    /// `Input`: what the mesh does not have, or cannot bear.
    fn terms<K: Kinematics<2>>(&self, site: &Site) -> Terms;

    /// The terms on the finite elements, which are those cells of `mesh`. They see the points of these.
    ///
    /// # Errors
    /// As [`Keyed::terms`].
    fn on_elements<K: Kinematics<2>>(&self, _site: &Site, _mesh: &Mesh<2>) -> Terms {
        Ok(Vec::new())
    }
}

impl<T: Keyed> Feature for T {
    fn key(&self) -> &'static str {
        T::KEY
    }

    fn shapes(&self) -> &'static [Product] {
        T::SHAPES
    }

    fn curves(&self, path: &Path) -> Vec<(&str, Path)> {
        Keyed::curves(self, path)
    }

    fn values(&self, phase: usize) -> Vec<&TimeValue> {
        Keyed::values(self, phase)
    }

    fn needs_surface(&self) -> bool {
        Keyed::needs_surface(self)
    }

    fn drains(&self) -> Option<Surface> {
        Keyed::drains(self)
    }

    fn terms(&self, site: &Site) -> Terms {
        match site.case.geometry {
            Geometry::PlaneStrain => Keyed::terms::<PlaneStrain>(self, site),
            Geometry::Axisymmetric => Keyed::terms::<Axisymmetric>(self, site),
        }
    }

    fn on_elements(&self, site: &Site, mesh: &Mesh<2>) -> Terms {
        match site.case.geometry {
            Geometry::PlaneStrain => Keyed::on_elements::<PlaneStrain>(self, site, mesh),
            Geometry::Axisymmetric => Keyed::on_elements::<Axisymmetric>(self, site, mesh),
        }
    }
}

/// An entry that was read, to be checked beside the rest of the case.
pub(super) type Unchecked = Box<dyn FnOnce(&CaseFile, &mut Checker) -> Option<Arc<dyn Feature>>>;

/// A key of the case whose entry has terms of its own.
#[derive(Clone, Copy)]
pub struct Key {
    pub(super) name: &'static str,
    pub(super) shapes: &'static [Product],
    /// The schema of the entry, which adds what it refers to to the definitions.
    pub(super) schema: fn(&mut SchemaGenerator) -> Schema,
    /// Reads the entry; `None` where nothing is written.
    pub(super) read: fn(&Value) -> std::result::Result<Option<Unchecked>, Issue>,
}

impl Key {
    /// The key of a kind of entry.
    pub const fn of<T: Keyed>() -> Self {
        Self { name: T::KEY, shapes: T::SHAPES, schema: schema::<T>, read: read_entry::<T> }
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Key").field("name", &self.name).field("shapes", &self.shapes).finish_non_exhaustive()
    }
}

fn schema<T: Keyed>(generator: &mut SchemaGenerator) -> Schema {
    let mut schema = generator.subschema_for::<Option<T::Written>>();
    schema.insert("description".into(), T::DESCRIPTION.into());
    schema
}

fn read_entry<T: Keyed>(value: &Value) -> std::result::Result<Option<Unchecked>, Issue> {
    let path = Path::default().key(T::KEY);
    let written: Option<T::Written> = read(value, &path)?;
    Ok(written.map(|written| -> Unchecked {
        Box::new(move |file, checker| Some(Arc::new(T::check(written, file, &path, checker)?)))
    }))
}

/// What is written in `tree`, which is the entry at `around`.
///
/// # Errors
/// The first entry that does not fit.
pub(super) fn read<T: DeserializeOwned>(tree: &Value, around: &Path) -> std::result::Result<T, Issue> {
    serde_path_to_error::deserialize(tree).map_err(|e| {
        let steps = e.path().iter().filter_map(|segment| match segment {
            Segment::Seq { index } => Some(Step::Index(*index)),
            Segment::Map { key } => Some(Step::Key(key.clone())),
            _ => None,
        });
        let path = Path(around.0.iter().cloned().chain(steps).collect());
        Issue::new(&path, At::Value, e.inner().to_string(), "compare with `mpm schema`")
    })
}
