use proptest::prelude::*;

use super::*;
use crate::error::Kind;
use std::fs;

fn sample() -> Store {
    let mut store = Store::new("frame");
    store.put_text("phase", "push, \"then\" pull");
    store.put("stress", 6, (0..6 * 20_000).map(|i| (i as f64 * 0.37).sin() * 1e3).collect::<Vec<_>>());
    store.put("edge", 1, vec![0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::MIN, 1.0 + f64::EPSILON]);
    store.put("nothing", 3, Vec::<f64>::new());
    store.put("zero", 3, vec![0.0; 300_000]);
    store.put("u64", 1, vec![u64::MAX, 0, 1 << 63]);
    store.put("i64", 1, vec![i64::MIN, -1, 7]);
    store.put("u32", 2, vec![u32::MAX, 4, 5, 6]);
    store.put("u16", 1, vec![u16::MAX, 2]);
    store.put("bytes", 1, b"text".to_vec());
    store
}

fn bits(store: Store) -> Vec<(String, usize, Vec<u64>)> {
    store
        .into_arrays()
        .into_iter()
        .map(|a| {
            let bits = match a.data {
                Data::F64(v) => v.into_iter().map(f64::to_bits).collect(),
                Data::U64(v) => v,
                Data::I64(v) => v.into_iter().map(|x| x as u64).collect(),
                Data::U32(v) => v.into_iter().map(u64::from).collect(),
                Data::U16(v) => v.into_iter().map(u64::from).collect(),
                Data::U8(v) => v.into_iter().map(u64::from).collect(),
            };
            (a.name, a.components, bits)
        })
        .collect()
}

#[test]
fn every_bit_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mpmf");
    sample().write(&path, true).unwrap();
    let back = Store::read(&path, "frame", "").unwrap();
    assert_eq!(back.text("phase").unwrap(), "push, \"then\" pull");
    assert_eq!(bits(back), bits(sample()));
    let summary = Store::peek(&path, "frame", "").unwrap();
    assert_eq!(summary.arrays[0], ("stress".to_string(), 20_000));
    assert_eq!(summary.texts["phase"], "push, \"then\" pull");
    // 2.4 MB of zeros and 0.96 MB of random-looking mantissas.
    let length = fs::metadata(&path).unwrap().len();
    assert!(length < 1_000_000, "{length}");
}

#[test]
fn a_number_that_is_not_finite_never_reaches_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mpmf");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut store = Store::new("frame");
        let mut values = vec![1.0; 12];
        values[8] = bad;
        store.put("stress", 3, values);
        let e = store.write(&path, false).unwrap_err();
        assert_eq!(e.kind, Kind::Analysis);
        assert!(e.to_string().starts_with("entry 2: `stress` is "), "{e}");
        assert!(!path.exists());
    }
}

#[test]
fn what_is_asked_for_must_be_there() {
    let mut store = sample();
    store.set_origin("x.mpmf", "make it again");
    for e in [
        store.take::<f64>("none", 1).unwrap_err(),
        store.take::<f64>("u64", 1).unwrap_err(),
        store.take::<f64>("edge", 2).unwrap_err(),
        store.text("none").unwrap_err(),
    ] {
        assert_eq!(e.kind, Kind::Input);
        assert!(e.to_string().starts_with("x.mpmf: ") && !e.remedy.is_empty(), "{e}");
    }
    assert_eq!(store.take_if_present::<f64>("none", 1).unwrap(), None);
    assert_eq!(store.take::<u16>("u16", 1).unwrap(), [u16::MAX, 2]);
}

fn reads_as_error(path: &Path, bytes: &[u8]) -> Error {
    fs::write(path, bytes).unwrap();
    let e = Store::read(path, "frame", "run `mpm solve` again").unwrap_err();
    assert_eq!(e.kind, Kind::Input, "{e}");
    assert!(e.to_string().contains("a.mpmf") && e.remedy.contains("mpm solve"), "{e}");
    e
}

fn small() -> (tempfile::TempDir, std::path::PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mpmf");
    let mut store = Store::new("frame");
    store.put_text("phase", "push");
    store.put("stress", 3, (0..300).map(|i| f64::from(i).sqrt()).collect::<Vec<_>>());
    store.put("region", 1, vec![3_u16; 100]);
    store.write(&path, false).unwrap();
    let bytes = fs::read(&path).unwrap();
    (folder, path, bytes)
}

#[test]
fn cut_and_foreign_files_are_errors() {
    let (_folder, path, bytes) = small();
    for n in 0..bytes.len() {
        reads_as_error(&path, &bytes[..n]);
    }
    let mut longer = bytes.clone();
    longer.push(0);
    reads_as_error(&path, &longer);
    assert!(reads_as_error(&path, &[b'x'; 4000]).to_string().contains("not a file of mpm"));
    let mut newer = bytes.clone();
    newer[8] = 2;
    assert!(reads_as_error(&path, &newer).to_string().contains("version 2"));
    fs::write(&path, &bytes).unwrap();
    assert!(Store::read(&path, "checkpoint", "").unwrap_err().to_string().contains("is a frame"));
    assert_eq!(Store::read(&path.with_file_name("b"), "frame", "r").unwrap_err().kind, Kind::Input);
}

/// A file whose header and checksums are right but whose numbers are not: made by a program, not by a fault.
fn forge(change: impl Fn(&mut Header), blocks: &[u8]) -> Vec<u8> {
    let (_folder, _, bytes) = small();
    let (mut header, _) = split_header(&bytes, bytes.len() as u64, "frame").unwrap();
    header.arrays.truncate(1);
    header.arrays[0].stored = blocks.len();
    header.arrays[0].checksum = XxHash64::oneshot(0, blocks);
    change(&mut header);
    let header = serde_json::to_vec(&header).unwrap();
    let mut forged = MAGIC.to_vec();
    forged.extend(VERSION.to_le_bytes());
    forged.extend((header.len() as u32).to_le_bytes());
    forged.extend(XxHash64::oneshot(0, &header).to_le_bytes());
    forged.extend(header);
    forged.extend(blocks);
    forged
}

#[test]
fn forged_sizes_neither_panic_nor_take_memory() {
    let (_folder, path, _) = small();
    for count in [usize::MAX, usize::MAX / 8, 1 << 50, 3 << 20, 299] {
        reads_as_error(&path, &forge(|h| h.arrays[0].count = count, &[0; 100]));
    }
    for components in [0, MAX_COMPONENTS + 1, usize::MAX] {
        reads_as_error(&path, &forge(|h| h.arrays[0].components = components, &[0; 100]));
    }
    reads_as_error(&path, &forge(|h| h.arrays[0].stored = usize::MAX, &[0; 100]));
    reads_as_error(&path, &forge(|h| h.arrays[0].scalar = "f32".to_string(), &[0; 100]));
    reads_as_error(&path, &forge(|_| (), &[0xff; 100]));
}

proptest! {
    #[test]
    fn any_changed_byte_is_noticed(at in 0_usize..10_000, flip in 1_u8..=255) {
        let (_folder, path, mut bytes) = small();
        let at = at % bytes.len();
        bytes[at] ^= flip;
        reads_as_error(&path, &bytes);
    }

    #[test]
    fn forged_blocks_never_panic(blocks in proptest::collection::vec(any::<u8>(), 0..400)) {
        let (_folder, path, _) = small();
        fs::write(&path, forge(|_| (), &blocks)).unwrap();
        // Random bytes may decompress; what matters is that the answer is a value.
        prop_assert!(Store::read(&path, "frame", "").is_ok_and(|s| s.arrays[0].data.len() == 300)
            || Store::read(&path, "frame", "").is_err());
    }
}

proptest! {
    #[test]
    fn any_numbers_come_back(
        components in 1_usize..10,
        values in proptest::collection::vec(any::<u64>(), 0..400),
        repeated in 1_usize..200,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mpmf");
        let count = values.len() / components * components;
        let values = values[..count].repeat(repeated);
        // Every pattern of bits but those of infinities and NaN.
        let floats: Vec<f64> = values.iter().map(|&b| f64::from_bits(b)).map(|x| if x.is_finite() { x } else { -0.0 }).collect();
        let mut store = Store::new("frame");
        store.put("f64", components, floats);
        store.put("u64", components, values.clone());
        store.put("u32", components, values.iter().map(|&v| v as u32).collect());
        store.put("u16", components, values.iter().map(|&v| v as u16).collect());
        store.put("u8", components, values.iter().map(|&v| v as u8).collect());
        store.clone().write(&path, false).unwrap();
        prop_assert_eq!(bits(Store::read(&path, "frame", "").unwrap()), bits(store));
    }
}
