//! The columns of [`Points`] as named arrays, for files: what checkpoints, frames and `points.vtu` share.
//!
//! Vectors are padded to three components, tensors are written row by row, so that a column can be shown as
//! it is. A column that the points do not have (velocity in a quasi-static analysis, pressures without a field) is left out.

use super::container::{Array, Data, Store};
use crate::error::{Error, Result};
use crate::points::{Column, Item, Maker, Numbers, Points, Presence, Type, Visitor};
use rayon::prelude::*;

pub use crate::points::padded;

type Make<'a> = Box<dyn Fn() -> Array + Sync + 'a>;

/// How each array is made.
struct Arrays<'a> {
    /// Points.
    count: usize,
    all: Vec<(&'static Column, Make<'a>)>,
}

impl<'a> Visitor<'a> for Arrays<'a> {
    fn visit<T: Item>(&mut self, column: &'static Column, values: &'a [T]) {
        if values.is_empty() && column.presence != Presence::Always {
            return;
        }
        let width = if column.several { values.len() / self.count } else { 1 };
        let (name, unit) = (column.name.to_owned(), column.unit.to_owned());
        let make = move || {
            let data = match T::to_numbers(values) {
                Numbers::F64(values) => Data::F64(values),
                Numbers::U16(values) => Data::U16(values),
                Numbers::U32(values) => Data::U32(values),
            };
            Array { name: name.clone(), unit: unit.clone(), components: T::COMPONENTS * width, data }
        };
        self.all.push((column, Box::new(make)));
    }
}

fn arrays<const D: usize>(points: &Points<D>) -> Arrays<'_> {
    let mut arrays = Arrays { count: points.len(), all: Vec::new() };
    points.each(&mut arrays);
    arrays
}

/// All columns, in a fixed order, every number bit-exact.
pub fn to_arrays<const D: usize>(points: &Points<D>) -> Vec<Array> {
    arrays(points).all.par_iter().map(|(_, make)| make()).collect()
}

/// One of them, if the points have it.
pub fn to_array<const D: usize>(points: &Points<D>, name: &str) -> Option<Array> {
    arrays(points).all.iter().find(|(column, _)| column.name == name).map(|(_, make)| make())
}

/// Puts all columns into a store, their names preceded by `prefix`.
pub fn put<const D: usize>(store: &mut Store, prefix: &str, points: &Points<D>) {
    for mut array in to_arrays(points) {
        array.name.insert_str(0, prefix);
        store.put_array(array);
    }
}

/// Takes the points out of a store again, with the `prefix` of [`put`].
///
/// # Errors
/// `Input` when a column is missing, of another type, or not as long as the others.
pub fn take<const D: usize>(store: &mut Store, prefix: &str) -> Result<Points<D>> {
    Points::make(&mut Columns { store, prefix, count: None })
}

struct Columns<'a> {
    store: &'a mut Store,
    prefix: &'a str,
    /// Points, once the first column is there.
    count: Option<usize>,
}

impl Columns<'_> {
    fn numbers(&mut self, name: &str, kind: Type, components: usize) -> Result<Option<Numbers>> {
        Ok(match kind {
            Type::F64 => self.store.take_if_present(name, components)?.map(Numbers::F64),
            Type::U16 => self.store.take_if_present(name, components)?.map(Numbers::U16),
            Type::U32 => self.store.take_if_present(name, components)?.map(Numbers::U32),
        })
    }
}

impl Maker for Columns<'_> {
    type Error = Error;

    fn make<T: Item>(&mut self, column: &Column) -> Result<Vec<T>> {
        let name = format!("{}{}", self.prefix, column.name);
        let width = if column.several { self.store.components(&name).unwrap_or(1) } else { 1 };
        let Some(numbers) = self.numbers(&name, T::TYPE, T::COMPONENTS * width)? else {
            let absent = column.presence != Presence::Always;
            return if absent { Ok(Vec::new()) } else { Err(self.store.missing("array", &name)) };
        };
        let values = T::from_numbers(numbers);
        let found = values.len() / width;
        let count = *self.count.get_or_insert(found);
        if found == count {
            return Ok(values);
        }
        Err(self.store.wrong(format!("`{}` has {found} entries for {count} material points", column.name)))
    }
}
