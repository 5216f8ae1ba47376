//! The columns of [`super::Points`]: what is known of each, and how all of them are gone through.

use crate::tensor::Tensor;

/// A column of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Its name, in files too.
    pub name: &'static str,
    pub unit: &'static str,
    pub presence: Presence,
    /// Whether seeding may write it.
    pub seeded: bool,
    /// Whether integration points have it; they have no velocity and no displacement of their own.
    pub at_integration: bool,
    /// Whether it is part of the material state, which can be copied from one point to another.
    pub of_material: bool,
    pub merged: Merged,
    /// Whether it has several entries for each point, as many as the scene needs.
    pub several: bool,
}

/// When a column is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    Always,
    /// In all of a run, if the scene needs it.
    Scene,
    /// As the phases have it.
    Phases,
}

/// How the values of two points are combined when the points are merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merged {
    /// The value of the first point, or one that is computed elsewhere.
    First,
    Sum,
    /// Means.
    ByMass,
    BySeededVolume,
    ByVolume,
}

impl Column {
    /// One that is always there, given its unit.
    pub(super) const fn of(unit: &'static str) -> Self {
        let (presence, merged) = (Presence::Always, Merged::First);
        Self {
            name: "",
            unit,
            presence,
            seeded: true,
            at_integration: true,
            of_material: false,
            merged,
            several: false,
        }
    }

    pub(super) const fn merged(self, merged: Merged) -> Self {
        Self { merged, ..self }
    }

    pub(super) const fn of_scene(self) -> Self {
        Self { presence: Presence::Scene, seeded: false, ..self }
    }

    pub(super) const fn comes_and_goes(self) -> Self {
        Self { presence: Presence::Phases, seeded: false, ..self }
    }

    pub(super) const fn seeded(self) -> Self {
        Self { seeded: true, ..self }
    }

    pub(super) const fn of_material_points(self) -> Self {
        Self { at_integration: false, ..self }
    }

    pub(super) const fn several(self) -> Self {
        Self { several: true, ..self }
    }

    pub(super) const fn of_material(self) -> Self {
        Self { of_material: true, ..self }
    }
}

/// What looks at all columns.
pub trait Visitor<'a> {
    fn visit<T: Item>(&mut self, column: &'static Column, values: &'a [T]);
}

/// What looks at all columns of two sets of points, and changes the first.
pub trait PairVisitor {
    fn visit<T: Item>(&mut self, column: &Column, own: &mut Vec<T>, other: &[T]);
}

/// What makes all columns.
pub trait Maker {
    type Error;

    /// # Errors
    /// When the column cannot be made.
    fn make<T: Item>(&mut self, column: &Column) -> Result<Vec<T>, Self::Error>;
}

/// Entries for each of `count` points.
pub(super) fn width<T>(values: &[T], count: usize) -> usize {
    if values.is_empty() { 0 } else { values.len() / count }
}

/// The numbers of a column.
pub enum Numbers {
    F64(Vec<f64>),
    U16(Vec<u16>),
    U32(Vec<u32>),
}

/// Their type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    F64,
    U16,
    U32,
}

/// An entry of a column.
pub trait Item: Copy + Send + Sync + 'static {
    const TYPE: Type;
    /// Numbers of an entry in files: vectors are padded to three, tensors are written row by row.
    const COMPONENTS: usize;

    fn to_numbers(items: &[Self]) -> Numbers;

    /// The inverse of [`Item::to_numbers`]; nothing of numbers of another type.
    fn from_numbers(numbers: Numbers) -> Vec<Self>;

    /// The sum, of what has one.
    fn plus(&self, _: &Self) -> Self {
        *self
    }

    /// The mean, of what has one, with the `share` of the other.
    fn mixed(&self, _share: f64, _: &Self) -> Self {
        *self
    }
}

impl Item for f64 {
    const TYPE: Type = Type::F64;
    const COMPONENTS: usize = 1;

    fn to_numbers(items: &[Self]) -> Numbers {
        Numbers::F64(items.to_vec())
    }

    fn from_numbers(numbers: Numbers) -> Vec<Self> {
        if let Numbers::F64(values) = numbers { values } else { Vec::new() }
    }

    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    fn mixed(&self, share: f64, other: &Self) -> Self {
        self + share * (other - self)
    }
}

/// Vectors, and symmetric tensors.
impl<const D: usize> Item for [f64; D] {
    const TYPE: Type = Type::F64;
    const COMPONENTS: usize = if D < 3 { 3 } else { D };

    fn to_numbers(items: &[Self]) -> Numbers {
        Numbers::F64(padded(items))
    }

    fn from_numbers(numbers: Numbers) -> Vec<Self> {
        let entry = |v: &[f64]| std::array::from_fn(|i| v[i]);
        f64::from_numbers(numbers).chunks_exact(Self::COMPONENTS).map(entry).collect()
    }

    fn mixed(&self, share: f64, other: &Self) -> Self {
        std::array::from_fn(|d| self[d].mixed(share, &other[d]))
    }
}

impl Item for Tensor {
    const TYPE: Type = Type::F64;
    const COMPONENTS: usize = 9;

    fn to_numbers(items: &[Self]) -> Numbers {
        let mut out = vec![0.0; 9 * items.len()];
        for (out, t) in out.chunks_exact_mut(9).zip(items) {
            out.copy_from_slice(t.transpose().as_slice());
        }
        Numbers::F64(out)
    }

    fn from_numbers(numbers: Numbers) -> Vec<Self> {
        f64::from_numbers(numbers).chunks_exact(9).map(Self::from_row_slice).collect()
    }
}

/// Whole numbers, which have no sum and no mean.
macro_rules! whole {
    ($number:ident, $type:ident) => {
        impl Item for $number {
            const TYPE: Type = Type::$type;
            const COMPONENTS: usize = 1;

            fn to_numbers(items: &[Self]) -> Numbers {
                Numbers::$type(items.to_vec())
            }

            fn from_numbers(numbers: Numbers) -> Vec<Self> {
                if let Numbers::$type(values) = numbers { values } else { Vec::new() }
            }
        }
    };
}

whole!(u16, U16);
whole!(u32, U32);

/// Vectors of `D` components padded with zeros to three.
pub fn padded<const D: usize>(vectors: &[[f64; D]]) -> Vec<f64> {
    let width = <[f64; D]>::COMPONENTS;
    let mut out = vec![0.0; width * vectors.len()];
    for (out, v) in out.chunks_exact_mut(width).zip(vectors) {
        for (out, v) in out.iter_mut().zip(v) {
            *out = *v;
        }
    }
    out
}
