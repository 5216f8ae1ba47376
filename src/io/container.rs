//! A compact, self-describing file of named arrays, bit-exact.
//!
//! ```text
//! 0   8  the bytes 89 'M' 'P' 'M' 0d 0a 1a 0a (a transfer in text mode breaks them)
//! 8   4  version of the format, u32
//! 12  4  length of the header, u32
//! 16  8  XXH64 of the header, u64
//! 24     header: JSON with the kind of the file, its texts and the list of arrays
//!        the arrays' blocks, one array after the other, to the end of the file
//! ```
//!
//! All numbers are little-endian. An array is cut into blocks of as many tuples as fit 256 KiB; in a block the bytes are
//! sorted by their place in the tuple (all first bytes, all second bytes, …: neighbouring numbers share their
//! high bytes) and compressed with LZ4. A block is a u32, its stored length, and the stored bytes; the highest
//! bit of the length says that they are not compressed. The checksum in the header is the XXH64 of the
//! array's stored bytes.
//!
//! A file that is cut, changed or foreign is an error; memory is bounded by the length of the file.

mod blocks;
mod data;

use std::collections::BTreeMap;
use std::hash::Hasher;
use std::io::{self, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use twox_hash::XxHash64;

pub use data::{Data, Scalar};

use blocks::{Compressor, decompress};
pub(super) use data::with_values;

use super::atomic;
use crate::error::{Error, Result};
use crate::reading;

const MAGIC: [u8; 8] = *b"\x89MPM\r\n\x1a\n";
const VERSION: u32 = 1;
const START: usize = 24;
/// More components than any tensor here has; a bound for buffers when reading.
const MAX_COMPONENTS: usize = 1024;

/// A named array of tuples.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    pub name: String,
    /// Unit of the values, empty for none.
    pub unit: String,
    /// Numbers in a tuple, at least 1.
    pub components: usize,
    pub data: Data,
}

/// What a file holds: its kind, texts, and arrays.
#[derive(Clone, Debug, PartialEq)]
pub struct Store {
    kind: String,
    texts: BTreeMap<String, String>,
    arrays: Vec<Array>,
    /// Where it was read and how to make it again, for messages.
    place: String,
    remedy: String,
}

#[derive(Serialize, Deserialize)]
struct Header {
    kind: String,
    texts: BTreeMap<String, String>,
    arrays: Vec<Entry>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    name: String,
    unit: String,
    #[serde(rename = "type")]
    scalar: String,
    components: usize,
    /// Numbers, all components counted.
    count: usize,
    /// Bytes in the file.
    stored: usize,
    checksum: u64,
}

impl Store {
    /// An empty store; `kind` tells files of different purposes apart.
    pub fn new(kind: &str) -> Self {
        Self {
            kind: kind.to_string(),
            texts: BTreeMap::new(),
            arrays: Vec::new(),
            place: format!("new {kind}"),
            remedy: String::new(),
        }
    }

    pub fn put_text(&mut self, name: &str, text: impl Into<String>) {
        self.texts.insert(name.to_string(), text.into());
    }

    /// Appends tuples of `components` numbers.
    pub fn put<T: Scalar>(&mut self, name: &str, components: usize, values: Vec<T>) {
        self.put_array(Array { name: name.to_string(), unit: String::new(), components, data: T::to_data(values) });
    }

    pub fn put_array(&mut self, array: Array) {
        debug_assert!(
            (1..=MAX_COMPONENTS).contains(&array.components) && array.data.len().is_multiple_of(array.components)
        );
        self.arrays.push(array);
    }

    /// Says where the store comes from and how the user makes it again, for messages.
    pub fn set_origin(&mut self, place: impl Into<String>, remedy: &str) {
        self.place = place.into();
        self.remedy = remedy.to_string();
    }

    /// The error of a store that does not hold what it should.
    pub(super) fn wrong(&self, problem: String) -> Error {
        Error::input(&self.place, problem, &self.remedy)
    }

    /// # Errors
    /// `Input` when there is no such text.
    pub fn text(&self, name: &str) -> Result<&str> {
        self.texts.get(name).map(String::as_str).ok_or_else(|| self.missing("text", name))
    }

    /// Whether there is an array of this name.
    pub fn has(&self, name: &str) -> bool {
        self.components(name).is_some()
    }

    /// Numbers in a tuple of an array, if there is one of this name.
    pub(super) fn components(&self, name: &str) -> Option<usize> {
        self.arrays.iter().find(|array| array.name == name).map(|array| array.components)
    }

    /// Takes the numbers of an array out of the store.
    ///
    /// # Errors
    /// `Input` when there is no such array, it has another type or number of components, or a number is not finite.
    pub fn take<T: Scalar>(&mut self, name: &str, components: usize) -> Result<Vec<T>> {
        self.take_if_present(name, components)?.ok_or_else(|| self.missing("array", name))
    }

    /// Like [`Store::take`] for an array that may be absent.
    ///
    /// # Errors
    /// `Input` when it has another type or number of components, or a number is not finite.
    pub fn take_if_present<T: Scalar>(&mut self, name: &str, components: usize) -> Result<Option<Vec<T>>> {
        let Some(i) = self.arrays.iter().position(|a| a.name == name) else { return Ok(None) };
        let array = self.arrays.swap_remove(i);
        if let Some((tuple, value)) = not_finite(&array) {
            return Err(self.wrong(format!("entry {tuple} of array `{name}` is {value}")));
        }
        let found = format!("{} × {}", array.components, array.data.type_name());
        match T::from_data(array.data) {
            Some(values) if array.components == components => Ok(Some(values)),
            _ => {
                let expected = T::NAME;
                Err(self.wrong(format!("array `{name}` is {found} where {components} × {expected} is expected")))
            }
        }
    }

    /// The arrays still in the store, in the order of the file.
    pub fn into_arrays(self) -> Vec<Array> {
        self.arrays
    }

    /// The error of something that the store should have.
    pub(super) fn missing(&self, what: &str, name: &str) -> Error {
        self.wrong(format!("{what} `{name}` is missing"))
    }

    /// Writes the file, atomically, and returns its hash; `durable` waits for the disk.
    ///
    /// # Errors
    /// `Analysis` when a number is not finite (then nothing is written), `Machine` when the file cannot be
    /// written.
    pub fn write(self, path: &Path, durable: bool) -> Result<u64> {
        let mut entries = Vec::with_capacity(self.arrays.len());
        let mut stored: Vec<Vec<u8>> = Vec::with_capacity(self.arrays.len());
        let mut compressor = Compressor::default();
        // An array is dropped as soon as its blocks are made: a file as large as the state is in memory once.
        for array in self.arrays {
            check_finite(&array, "entry")?;
            let mut blocks = Vec::new();
            with_values!(&array.data, v => compressor.compress(v, array.components, &mut blocks));
            blocks.shrink_to_fit();
            entries.push(Entry {
                scalar: array.data.type_name().to_string(),
                count: array.data.len(),
                stored: blocks.len(),
                checksum: XxHash64::oneshot(0, &blocks),
                name: array.name,
                unit: array.unit,
                components: array.components,
            });
            stored.push(blocks);
        }
        let header = Header { kind: self.kind, texts: self.texts, arrays: entries };
        let header = serde_json::to_vec(&header)
            .map_err(|e| Error::analysis(path.display(), format!("header: {e}"), "report this as a mistake of mpm"))?;
        let length = (header.len() as u32).to_le_bytes();
        let checksum = XxHash64::oneshot(0, &header).to_le_bytes();
        let start: [&[u8]; 5] = [&MAGIC, &VERSION.to_le_bytes(), &length, &checksum, &header];
        let parts = || start.into_iter().chain(stored.iter().map(Vec::as_slice));
        let fill = |out: &mut dyn Write| parts().try_for_each(|part| out.write_all(part));
        if durable { atomic::write_durable(path, fill) } else { atomic::write(path, fill) }?;
        let mut hasher = XxHash64::with_seed(0);
        parts().for_each(|part| hasher.write(part));
        Ok(hasher.finish())
    }

    /// Reads a file of the given kind; `remedy` says how the user makes it again.
    ///
    /// # Errors
    /// `Input` when the file is missing, foreign, cut or changed.
    pub fn read(path: &Path, kind: &str, remedy: &str) -> Result<Self> {
        let bytes = reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, remedy))?;
        let broken = |problem: String| Error::input(path.display(), problem, remedy);
        let (header, mut rest) = split_header(&bytes, bytes.len() as u64, kind).map_err(broken)?;
        let mut arrays = Vec::with_capacity(header.arrays.len());
        for entry in header.arrays {
            // The lengths were checked to add up to the length of the file.
            let (stored, after) = rest.split_at(entry.stored);
            rest = after;
            arrays.push(decode(entry, stored).map_err(broken)?);
        }
        Ok(Self {
            kind: header.kind,
            texts: header.texts,
            arrays,
            place: path.display().to_string(),
            remedy: remedy.to_string(),
        })
    }

    /// Reads only the header: the texts, and the names and numbers of tuples of the arrays.
    ///
    /// # Errors
    /// `Input` when the file is missing, foreign, cut, or its header changed; the arrays are not read.
    pub fn peek(path: &Path, kind: &str, remedy: &str) -> Result<Contents> {
        let (bytes, length) = start(path).map_err(|e| atomic::unreadable(path, &e, remedy))?;
        let broken = |problem: String| Error::input(path.display(), problem, remedy);
        let (header, _) = split_header(&bytes, length, kind).map_err(broken)?;
        let arrays = header.arrays.into_iter().map(|e| (e.name, e.count / e.components)).collect();
        Ok(Contents { texts: header.texts, arrays })
    }
}

/// The kind and the texts of a file, if it is a container: for `mpm info`.
pub fn inspect(path: &Path) -> Option<(String, BTreeMap<String, String>)> {
    let (bytes, _) = start(path).ok()?;
    let length = header_length(&bytes).ok()?;
    let header: Header = serde_json::from_slice(bytes.get(START..START + length)?).ok()?;
    Some((header.kind, header.texts))
}

/// The header of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    pub texts: BTreeMap<String, String>,
    /// Names and numbers of tuples.
    pub arrays: Vec<(String, usize)>,
}

/// Checks that an array of floating-point numbers is finite; `item` is what a tuple belongs to, such as
/// `material point`.
///
/// # Errors
/// `Analysis` naming the item and the array.
pub fn check_finite(array: &Array, item: &str) -> Result<()> {
    match not_finite(array) {
        None => Ok(()),
        Some((tuple, value)) => Err(Error::analysis(
            format!("{item} {tuple}"),
            format!("`{}` is {value}: it was not written", array.name),
            "what was written before is kept; reduce the steps or refine the mesh",
        )),
    }
}

/// The first tuple with a number that is not finite, and that number.
pub(super) fn not_finite(array: &Array) -> Option<(usize, f64)> {
    let Data::F64(values) = &array.data else { return None };
    let at = values.iter().position(|v| !v.is_finite())?;
    Some((at / array.components, values[at]))
}

fn decode(entry: Entry, stored: &[u8]) -> std::result::Result<Array, String> {
    let Entry { name, unit, scalar, components, count, checksum, .. } = entry;
    if XxHash64::oneshot(0, stored) != checksum {
        return Err(format!("is damaged: array `{name}` does not match its checksum"));
    }
    let data = match scalar.as_str() {
        "f64" => decompress(stored, components, count).map(Data::F64),
        "u64" => decompress(stored, components, count).map(Data::U64),
        "i64" => decompress(stored, components, count).map(Data::I64),
        "u32" => decompress(stored, components, count).map(Data::U32),
        "u16" => decompress(stored, components, count).map(Data::U16),
        "u8" => decompress(stored, components, count).map(Data::U8),
        _ => return Err(format!("array `{name}` has the unknown type `{scalar}`")),
    };
    let data = data.ok_or_else(|| format!("is damaged: array `{name}` cannot be decompressed"))?;
    Ok(Array { name, unit, components, data })
}

/// The first [`START`] bytes of a file with the header after them, if it is a container, and the length of the file.
fn start(path: &Path) -> io::Result<(Vec<u8>, u64)> {
    let (file, mut bytes) = (reading::open(path)?, Vec::new());
    (&file).take(START as u64).read_to_end(&mut bytes)?;
    if let Ok(header) = header_length(&bytes) {
        (&file).take(header as u64).read_to_end(&mut bytes)?;
    }
    Ok((bytes, file.metadata()?.len()))
}

/// The length of the header, from the first [`START`] bytes.
fn header_length(bytes: &[u8]) -> std::result::Result<usize, String> {
    let Some((start, _)) = bytes.split_at_checked(START) else {
        return Err(format!("is cut off after {} bytes", bytes.len()));
    };
    if start[..8] != MAGIC {
        return Err("is not a file of mpm".to_string());
    }
    match <u32 as Scalar>::load(&start[8..12]) {
        VERSION => Ok(<u32 as Scalar>::load(&start[12..16]) as usize),
        other => Err(format!("has version {other} of the format; this mpm reads version {VERSION}")),
    }
}

/// Reads the header of a file that is `length` bytes long; returns it with the bytes after it.
fn split_header<'a>(bytes: &'a [u8], length: u64, kind: &str) -> std::result::Result<(Header, &'a [u8]), String> {
    let n = header_length(bytes)?;
    let Some((header, rest)) = bytes[START..].split_at_checked(n) else {
        return Err(format!("is cut off after {length} bytes"));
    };
    if XxHash64::oneshot(0, header) != <u64 as Scalar>::load(&bytes[16..24]) {
        return Err("is damaged: its header does not match its checksum".to_string());
    }
    let header: Header = serde_json::from_slice(header).map_err(|e| format!("is damaged: header: {e}"))?;
    if header.kind != kind {
        return Err(format!("is a {} where a {kind} is expected", header.kind));
    }
    if let Some(e) = header.arrays.iter().find(|e| !(1..=MAX_COMPONENTS).contains(&e.components)) {
        return Err(format!("is damaged: array `{}` has {} components", e.name, e.components));
    }
    let expected = header.arrays.iter().fold((START + n) as u64, |sum, e| sum.saturating_add(e.stored as u64));
    if expected != length {
        return Err(format!("is cut off or damaged: it has {length} bytes where its header says {expected}"));
    }
    Ok((header, rest))
}

#[cfg(test)]
mod tests;
