//! The columns of [`Points`] as named arrays, for files: one list that checkpoints and `points.vtu` share.
//!
//! Vectors are padded to three components, tensors are written row by row, so that a column can be shown as
//! it is. A column that the points do not have (velocity in a quasi-static analysis, pressures without a field) is left out.

use super::container::{Array, Scalar, Store};
use crate::error::Result;
use crate::points::Points;
use crate::tensor::{Symmetric, Tensor};
use rayon::prelude::*;

/// All columns, in a fixed order, every number bit-exact.
pub fn to_arrays<const D: usize>(points: &Points<D>) -> Vec<Array> {
    // No `..`: a new column of the points must find its place here.
    let Points {
        position,
        origin,
        reference,
        velocity,
        acceleration,
        mass,
        initial_volume,
        deformation,
        elastic,
        stress,
        plastic_strain,
        plastic_increment,
        internal,
        pressure,
        pore_pressure,
        region,
        model,
        cell,
    } = points;
    let columns: [&(dyn Fn() -> Array + Sync); 18] = [
        &|| array("position", "m", 3, padded(position)),
        &|| array("origin", "m", 3, padded(origin)),
        &|| array("reference", "m", 3, padded(reference)),
        &|| array("velocity", "m/s", 3, padded(velocity)),
        &|| array("acceleration", "m/s2", 3, padded(acceleration)),
        &|| array("mass", "t", 1, mass.clone()),
        &|| array("initial_volume", "m3", 1, initial_volume.clone()),
        &|| array("deformation", "-", 9, by_rows(deformation)),
        &|| array("elastic", "-", 6, elastic.concat()),
        &|| array("stress", "kPa", 6, stress.concat()),
        &|| array("plastic_strain", "-", 1, plastic_strain.clone()),
        &|| array("plastic_increment", "-", 1, plastic_increment.clone()),
        &|| array("internal", "-", points.internal_count().max(1), internal.clone()),
        &|| array("pressure", "kPa", 1, pressure.clone()),
        &|| array("pore_pressure", "kPa", 1, pore_pressure.clone()),
        &|| array("region", "-", 1, region.clone()),
        &|| array("model", "-", 1, model.clone()),
        &|| array("cell", "-", 1, cell.clone()),
    ];
    let mut arrays: Vec<Array> = columns.par_iter().map(|column| column()).collect();
    const OPTIONAL: [&str; 8] = [
        "reference",
        "velocity",
        "acceleration",
        "plastic_increment",
        "internal",
        "pressure",
        "pore_pressure",
        "model",
    ];
    arrays.retain(|a| !(a.data.is_empty() && OPTIONAL.contains(&a.name.as_str())));
    arrays
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
    let position = cut(&store.take(&format!("{prefix}position"), 3)?);
    let mut columns = Columns { store, prefix, count: position.len() };
    Ok(Points {
        position,
        origin: columns.vectors("origin")?,
        reference: columns.vectors_if_present("reference")?,
        velocity: columns.vectors_if_present("velocity")?,
        acceleration: columns.vectors_if_present("acceleration")?,
        mass: columns.scalars("mass")?,
        initial_volume: columns.scalars("initial_volume")?,
        deformation: columns.numbers("deformation", 9)?.chunks_exact(9).map(Tensor::from_row_slice).collect(),
        elastic: columns.symmetric("elastic")?,
        stress: columns.symmetric("stress")?,
        plastic_strain: columns.scalars("plastic_strain")?,
        plastic_increment: columns.if_present("plastic_increment", 1)?.unwrap_or_default(),
        internal: columns.of_any_width("internal")?,
        pressure: columns.if_present("pressure", 1)?.unwrap_or_default(),
        pore_pressure: columns.if_present("pore_pressure", 1)?.unwrap_or_default(),
        region: columns.scalars("region")?,
        model: columns.if_present("model", 1)?.unwrap_or_default(),
        cell: columns.scalars("cell")?,
    })
}

/// Vectors of `D` components padded with zeros to three.
pub fn padded<const D: usize>(vectors: &[[f64; D]]) -> Vec<f64> {
    let mut out = vec![0.0; 3 * vectors.len()];
    for (out, v) in out.chunks_exact_mut(3).zip(vectors) {
        for (out, v) in out.iter_mut().zip(v) {
            *out = *v;
        }
    }
    out
}

/// The components of tensors, row by row.
fn by_rows(tensors: &[Tensor]) -> Vec<f64> {
    let mut out = vec![0.0; 9 * tensors.len()];
    for (out, t) in out.chunks_exact_mut(9).zip(tensors) {
        out.copy_from_slice(t.transpose().as_slice());
    }
    out
}

fn array<T: Scalar>(name: &str, unit: &str, components: usize, values: Vec<T>) -> Array {
    Array { name: name.to_string(), unit: unit.to_string(), components, data: T::to_data(values) }
}

struct Columns<'a> {
    store: &'a mut Store,
    prefix: &'a str,
    /// Points.
    count: usize,
}

impl Columns<'_> {
    fn if_present<T: Scalar>(&mut self, name: &str, components: usize) -> Result<Option<Vec<T>>> {
        let values = self.store.take_if_present(&format!("{}{name}", self.prefix), components)?;
        match &values {
            Some(v) if v.len() != self.count * components => {
                let found = v.len() / components;
                Err(self.store.wrong(format!("`{name}` has {found} entries for {} material points", self.count)))
            }
            _ => Ok(values),
        }
    }

    /// As many numbers for each point as the file has.
    fn of_any_width(&mut self, name: &str) -> Result<Vec<f64>> {
        let components = self.store.components(&format!("{}{name}", self.prefix)).unwrap_or(1);
        Ok(self.if_present(name, components)?.unwrap_or_default())
    }

    fn numbers<T: Scalar>(&mut self, name: &str, components: usize) -> Result<Vec<T>> {
        let values = self.if_present(name, components)?;
        values.ok_or_else(|| self.store.missing("array", &format!("{}{name}", self.prefix)))
    }

    fn scalars<T: Scalar>(&mut self, name: &str) -> Result<Vec<T>> {
        self.numbers(name, 1)
    }

    fn vectors<const D: usize>(&mut self, name: &str) -> Result<Vec<[f64; D]>> {
        Ok(cut(&self.numbers(name, 3)?))
    }

    fn vectors_if_present<const D: usize>(&mut self, name: &str) -> Result<Vec<[f64; D]>> {
        Ok(cut(&self.if_present(name, 3)?.unwrap_or_default()))
    }

    fn symmetric(&mut self, name: &str) -> Result<Vec<Symmetric>> {
        Ok(self.numbers(name, 6)?.chunks_exact(6).map(|c| [c[0], c[1], c[2], c[3], c[4], c[5]]).collect())
    }
}

/// The first `D` components of vectors padded to three.
fn cut<const D: usize>(padded: &[f64]) -> Vec<[f64; D]> {
    padded.chunks_exact(3).map(|v| std::array::from_fn(|i| v[i])).collect()
}
