//! Files as they are read: regular ones, no longer than memory can hold.
//!
//! The folder of a case may come from a stranger, with links to devices without end, pipes that nobody writes to, and files with holes
//! that are a few bytes on a disk and longer than the memory. So all files are opened here.

use crate::machine;
use rustix::fs::OFlags;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::sync::LazyLock;

/// The longest file (B) that is read: what is made of one must find room beside it.
static LONGEST: LazyLock<u64> = LazyLock::new(|| machine::memory("MemTotal").map_or(u64::MAX, |memory| memory / 4));

/// Opens a file for reading.
///
/// # Errors
/// `InvalidInput` for a folder, pipe, device or socket, also behind a link; `FileTooLarge` for one that is longer than a quarter of the
/// memory; those of opening a file.
pub fn open(path: &Path) -> Result<File> {
    sized(path).map(|(file, _)| file)
}

/// Reads a file as long as it was when it was opened.
///
/// # Errors
/// As [`open`], and those of reading; `InvalidInput` for one that has no length and is not empty, as those of the kernel.
pub fn bytes(path: &Path) -> Result<Vec<u8>> {
    let (file, length) = sized(path)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(length).unwrap_or(usize::MAX))?;
    (&file).take(length).read_to_end(&mut bytes)?;
    // A file of a run may have grown meanwhile.
    if length == 0 && (&file).read(&mut [0])? > 0 && file.metadata()?.len() == 0 {
        return Err(Error::new(ErrorKind::InvalidInput, "it is no file of a disk"));
    }
    Ok(bytes)
}

/// Reads a text, with a sign in place of what is not UTF-8.
///
/// # Errors
/// As [`bytes()`].
pub fn text(path: &Path) -> Result<String> {
    bytes(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
}

fn sized(path: &Path) -> Result<(File, u64)> {
    // Opening a pipe would wait for who writes to it.
    let file = OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits().cast_signed()).open(path)?;
    let metadata = file.metadata()?;
    let length = metadata.len();
    match (metadata.is_dir(), metadata.is_file()) {
        (true, _) => Err(Error::new(ErrorKind::InvalidInput, "it is a folder")),
        (_, false) => Err(Error::new(ErrorKind::InvalidInput, "it is no regular file")),
        _ if length > *LONGEST => {
            Err(Error::new(ErrorKind::FileTooLarge, format!("it has {length} bytes, more than the memory can hold")))
        }
        _ => Ok((file, length)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;
    use std::process::Command;

    #[test]
    fn what_has_no_end_is_refused_and_nothing_waits() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        for (name, target) in [("zero", "/dev/zero"), ("folder", "/"), ("kernel", "/proc/self/status")] {
            symlink(target, place(name)).unwrap();
        }
        assert!(Command::new("mkfifo").arg(place("pipe")).status().unwrap().success());
        File::create(place("holes")).unwrap().set_len(*LONGEST + 1).unwrap();
        fs::write(place("file"), "text").unwrap();
        symlink("file", place("link")).unwrap();
        let said = |name: &str| bytes(&place(name)).unwrap_err().to_string();
        assert_eq!(said("zero"), "it is no regular file");
        assert_eq!(said("pipe"), "it is no regular file");
        assert_eq!(said("folder"), "it is a folder");
        assert_eq!(said("kernel"), "it is no file of a disk");
        assert!(said("holes").contains("more than the memory can hold"));
        assert_eq!(text(&place("link")).unwrap(), "text");
        fs::write(place("empty"), "").unwrap();
        assert_eq!(bytes(&place("empty")).unwrap(), b"");
    }
}
