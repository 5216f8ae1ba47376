//! The types of numbers that a file can hold.

/// The numbers of an array, tuple after tuple.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    F64(Vec<f64>),
    U64(Vec<u64>),
    I64(Vec<i64>),
    U32(Vec<u32>),
    U16(Vec<u16>),
    U8(Vec<u8>),
}

/// A number that a [`Data`] can hold.
pub trait Scalar: Copy + Sized {
    const NAME: &'static str;
    const SIZE: usize;
    fn store(self, bytes: &mut [u8]);
    fn load(bytes: &[u8]) -> Self;
    fn to_data(values: Vec<Self>) -> Data;
    /// The numbers, if `data` holds this type.
    fn from_data(data: Data) -> Option<Vec<Self>>;
}

macro_rules! scalar {
    ($($type:ty, $variant:ident, $name:literal;)*) => {
        $(impl Scalar for $type {
            const NAME: &'static str = $name;
            const SIZE: usize = size_of::<$type>();
            fn store(self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_le_bytes());
            }
            fn load(bytes: &[u8]) -> Self {
                let mut own = [0; size_of::<$type>()];
                own.copy_from_slice(bytes);
                Self::from_le_bytes(own)
            }
            fn to_data(values: Vec<Self>) -> Data {
                Data::$variant(values)
            }
            fn from_data(data: Data) -> Option<Vec<Self>> {
                if let Data::$variant(values) = data { Some(values) } else { None }
            }
        })*
    };
}
scalar! {
    f64, F64, "f64";
    u64, U64, "u64";
    i64, I64, "i64";
    u32, U32, "u32";
    u16, U16, "u16";
    u8, U8, "u8";
}

/// Runs an expression for the vector in a [`Data`], whatever its type.
macro_rules! with_values {
    ($data:expr, $values:ident => $body:expr) => {
        match $data {
            Data::F64($values) => $body,
            Data::U64($values) => $body,
            Data::I64($values) => $body,
            Data::U32($values) => $body,
            Data::U16($values) => $body,
            Data::U8($values) => $body,
        }
    };
}

impl Data {
    pub fn len(&self) -> usize {
        with_values!(self, v => v.len())
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The name of the type in the header.
    pub(super) fn type_name(&self) -> &'static str {
        fn name<T: Scalar>(_: &[T]) -> &'static str {
            T::NAME
        }
        with_values!(self, v => name(v))
    }
}

pub(in crate::io) use with_values;
