//! Hashes of files (XXH64, seed 0): they tell damage and mix-ups, not forgery.

use std::hash::Hasher;
use std::io::{self, Read};
use std::path::Path;

use rayon::prelude::*;
use twox_hash::XxHash64;

use super::atomic;
use crate::error::Result;
use crate::reading;

/// The hash of the bytes at hand.
pub fn bytes(bytes: &[u8]) -> u64 {
    XxHash64::oneshot(0, bytes)
}

/// The hash of a file; `remedy` is for one that is missing.
///
/// # Errors
/// `Input` when it is missing, `Machine` when it cannot be read.
pub fn file(path: &Path, remedy: &str) -> Result<u64> {
    read(path).map_err(|e| atomic::unreadable(path, &e, remedy))
}

/// The hashes of several files, in parallel.
///
/// # Errors
/// As [`file()`].
pub fn files<P: AsRef<Path> + Sync>(paths: &[P], remedy: &str) -> Result<Vec<u64>> {
    paths.par_iter().map(|path| file(path.as_ref(), remedy)).collect()
}

/// A hash as text: 16 hexadecimal digits.
pub fn text(hash: u64) -> String {
    format!("{hash:016x}")
}

fn read(path: &Path) -> io::Result<u64> {
    let file = reading::open(path)?;
    // One of a run may grow meanwhile.
    let mut file = (&file).take(file.metadata()?.len());
    let mut hasher = XxHash64::with_seed(0);
    let mut block = vec![0; 1 << 16];
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hasher.finish()),
            n => hasher.write(&block[..n]),
        }
    }
}
