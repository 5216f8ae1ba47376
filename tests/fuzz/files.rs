//! The formats as files are made of: taken apart, changed and put together again with the checksums right.

use crate::mutate::{self, Random};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use mpm::io::container::{Array, Data, Scalar, Store};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use twox_hash::XxHash64;

const START: usize = 24;
const BLOCK: usize = 1 << 18;

/// A file of named arrays.
#[derive(Clone)]
pub struct Container {
    magic: [u8; 12],
    header: Value,
    pub arrays: Vec<Array>,
}

impl Container {
    /// A sound file of a kind.
    pub fn read(path: &Path, kind: &str) -> Self {
        let bytes = fs::read(path).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        Self {
            magic: bytes[..12].try_into().unwrap(),
            header: serde_json::from_slice(&bytes[START..START + length]).unwrap(),
            arrays: Store::read(path, kind, "").unwrap().into_arrays(),
        }
    }

    /// Changes an array, its name or a text.
    pub fn mutate(&mut self, random: &mut Random) {
        for _ in 0..=random.below(2) {
            let at = random.below(self.arrays.len());
            match random.below(24) {
                0 => drop(self.arrays.swap_remove(at)),
                1 => self.arrays.push(self.arrays[at].clone()),
                2 => self.arrays[at].name.push('x'),
                4 => {
                    let Array { data, components, .. } = &mut self.arrays[at];
                    let fitting = [1, 2, 3, 6, 9].into_iter().filter(|count| data.len() % count == 0);
                    *components = *random.pick(&fitting.collect::<Vec<_>>());
                }
                3 => {
                    let texts = self.header["texts"].as_object_mut().unwrap();
                    if let Some(text) = texts.values_mut().next() {
                        let mut bytes = text.as_str().unwrap().as_bytes().to_vec();
                        mutate::bytes(random, &mut bytes, &[b"1e999".to_vec()]);
                        *text = json!(String::from_utf8_lossy(&bytes));
                    }
                }
                _ => {
                    let Array { data, components, .. } = &mut self.arrays[at];
                    mutate::array(random, data, *components);
                }
            }
            if self.arrays.is_empty() {
                return;
            }
        }
    }

    /// Applies an edit of a file of faults, such as `set points.cell 3 4294967295`, `cut NAME 2` (keep two tuples) or `drop NAME`.
    pub fn edit(&mut self, line: &str) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = self.arrays.iter().position(|a| a.name == words[1]).unwrap_or_else(|| panic!("no array: {line}"));
        let Array { data, components, .. } = &mut self.arrays[at];
        match words[..] {
            ["drop", _] => drop(self.arrays.swap_remove(at)),
            ["cut", _, tuples] => mutate::resize(data, tuples.parse::<usize>().unwrap() * *components),
            ["set", _, index, value] => set(data, index.parse().unwrap(), value),
            _ => panic!("not an edit: {line}"),
        }
    }

    /// The bytes, all checksums right, nothing compressed.
    pub fn bytes(&self) -> Vec<u8> {
        let (mut blocks, mut entries) = (Vec::new(), Vec::new());
        for Array { name, unit, components, data } in &self.arrays {
            let (scalar, numbers) = plain(data);
            let size = if data.is_empty() { 8 } else { numbers.len() / data.len() };
            let start = blocks.len();
            for block in numbers.chunks((BLOCK / (components * size)).max(1) * components * size) {
                let (stride, tuples) = (components * size, block.len() / (components * size));
                blocks.extend((block.len() as u32 | 1 << 31).to_le_bytes());
                blocks.extend((0..stride).flat_map(|j| (0..tuples).map(move |t| block[t * stride + j])));
            }
            entries.push(json!({
                "name": name, "unit": unit, "type": scalar, "components": components, "count": data.len(),
                "stored": blocks.len() - start, "checksum": XxHash64::oneshot(0, &blocks[start..]),
            }));
        }
        let mut header = self.header.clone();
        header["arrays"] = json!(entries);
        let header = serde_json::to_vec(&header).unwrap();
        let mut bytes = self.magic.to_vec();
        bytes.extend((header.len() as u32).to_le_bytes());
        bytes.extend(XxHash64::oneshot(0, &header).to_le_bytes());
        bytes.extend(header);
        bytes.extend(blocks);
        bytes
    }
}

/// The bytes of a container with the checksum of its header made right.
pub fn repair_container(bytes: &mut [u8]) {
    let Some(length) = bytes.get(12..16).map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize) else { return };
    let Some(header) = bytes.get(START..START.saturating_add(length)) else { return };
    let checksum = XxHash64::oneshot(0, header);
    bytes[16..24].copy_from_slice(&checksum.to_le_bytes());
}

/// Changes a number, or adds one behind the last.
fn set(data: &mut Data, index: usize, value: &str) {
    fn put<T: std::str::FromStr<Err: std::fmt::Debug>>(values: &mut Vec<T>, index: usize, value: &str) {
        let value = value.parse().unwrap();
        if index == values.len() { values.push(value) } else { values[index] = value }
    }
    match data {
        Data::F64(v) => put(v, index, value),
        Data::U64(v) => put(v, index, value),
        Data::I64(v) => put(v, index, value),
        Data::U32(v) => put(v, index, value),
        Data::U16(v) => put(v, index, value),
        Data::U8(v) => put(v, index, value),
    }
}

/// The name of the type of an array, and its numbers in bytes.
fn plain(data: &Data) -> (&'static str, Vec<u8>) {
    fn of<T: Scalar>(v: &[T]) -> (&'static str, Vec<u8>) {
        let mut bytes = vec![0; v.len() * T::SIZE];
        bytes.chunks_exact_mut(T::SIZE).zip(v).for_each(|(bytes, v)| v.store(bytes));
        (T::NAME, bytes)
    }
    match data {
        Data::F64(v) => of(v),
        Data::U64(v) => of(v),
        Data::I64(v) => of(v),
        Data::U32(v) => of(v),
        Data::U16(v) => of(v),
        Data::U8(v) => of(v),
    }
}

/// The array of a `points.vtu` with the number `which`: its name, type and numbers.
struct Element {
    name: String,
    /// Where its base64 is.
    range: std::ops::Range<usize>,
    data: Data,
}

fn elements(text: &str) -> Vec<Element> {
    let attribute = |tag: &str, name: &str| {
        let value = tag.split(&format!("{name}=\"")).nth(1).and_then(|rest| rest.split('"').next());
        value.unwrap_or_default().to_string()
    };
    let mut found = Vec::new();
    for (start, _) in text.match_indices("<DataArray ") {
        let open = start + text[start..].find('>').unwrap() + 1;
        let close = open + text[open..].find('<').unwrap();
        let bytes = STANDARD.decode(&text[open..close]).unwrap();
        let tag = &text[start..open];
        fn of<T: Scalar>(bytes: &[u8]) -> Data {
            T::to_data(bytes[8..].chunks_exact(T::SIZE).map(T::load).collect())
        }
        let data = match attribute(tag, "type").as_str() {
            "Float64" => of::<f64>(&bytes),
            "UInt32" => of::<u32>(&bytes),
            "UInt16" => of::<u16>(&bytes),
            "UInt8" => of::<u8>(&bytes),
            _ => of::<i64>(&bytes),
        };
        let name = attribute(tag, "Name").split(" [").next().unwrap().to_string();
        found.push(Element { name, range: open..close, data });
    }
    found
}

fn replace(text: &mut String, element: &Element) {
    let (_, numbers) = plain(&element.data);
    let mut bytes = (numbers.len() as u64).to_le_bytes().to_vec();
    bytes.extend(numbers);
    text.replace_range(element.range.clone(), &STANDARD.encode(bytes));
}

/// Changes the numbers of a `points.vtu`, its checksum made right.
pub fn mutate_points(random: &mut Random, file: &[u8]) -> Vec<u8> {
    let mut text = String::from_utf8(file.to_vec()).unwrap();
    let mut elements = elements(&text);
    let which = random.below(elements.len());
    let element = &mut elements[which];
    mutate::array(random, &mut element.data, 1);
    replace(&mut text, element);
    repair_points(text.into_bytes())
}

/// Applies an edit as [`Container::edit`]; the positions are called `Points`.
pub fn edit_points(file: &[u8], line: &str) -> Vec<u8> {
    let mut text = String::from_utf8(file.to_vec()).unwrap();
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut elements = elements(&text);
    let element = elements.iter_mut().find(|e| e.name == words[1]).unwrap_or_else(|| panic!("no array: {line}"));
    match words[..] {
        ["cut", _, count] => mutate::resize(&mut element.data, count.parse().unwrap()),
        ["set", _, index, value] => set(&mut element.data, index.parse().unwrap(), value),
        _ => panic!("not an edit: {line}"),
    }
    replace(&mut text, element);
    repair_points(text.into_bytes())
}

/// A `points.vtu` with the checksum in its last line made right, where it has one.
pub fn repair_points(file: Vec<u8>) -> Vec<u8> {
    let repaired = || {
        let end = file.strip_suffix(b" -->\n")?;
        let start = end.iter().rposition(|&b| b == b'\n')? + 1;
        let open = b"<!-- mpm points ";
        let mut trailer: Value = serde_json::from_slice(end[start..].strip_prefix(open)?).ok()?;
        let regions: Vec<&str> = trailer["regions"].as_array()?.iter().map(Value::as_str).collect::<Option<_>>()?;
        let (program, source) = (trailer["program"].as_str()?, &trailer["source"]);
        let (mesh, case) = (source["mesh"].as_str()?, source["case"].as_str()?);
        let (points, dimension) = (trailer["points"].as_u64()?, trailer["dimension"].as_u64()?);
        let head = format!("{points} {dimension} {regions:?} {program:?} {mesh} {case}");
        let checksum = XxHash64::oneshot(XxHash64::oneshot(0, head.as_bytes()), &file[..start]);
        trailer["checksum"] = json!(checksum);
        let mut out = file[..start].to_vec();
        out.extend_from_slice(open);
        out.extend(serde_json::to_vec(&trailer).ok()?);
        out.extend_from_slice(b" -->\n");
        Some(out)
    };
    repaired().unwrap_or(file)
}
