//! The lock on an output folder: one process at a time writes there.
//!
//! A lock of the operating system (`flock`) on the folder itself: it leaves no file, and the system releases it when the
//! process ends, however it ends. Where the file system has no such locks, as some over a network, there is none.

use std::fs::{self, File, TryLockError};
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use super::atomic;
use crate::error::{Error, Result};

/// Held until it is dropped.
#[derive(Debug)]
pub struct Lock {
    _folder: File,
}

impl Lock {
    /// Takes the lock of `folder`, which exists.
    ///
    /// # Errors
    /// `Machine` naming the process that has it, or when the folder cannot be read.
    pub fn take(folder: &Path) -> Result<Self> {
        let open = || Ok((File::open(folder)?, fs::metadata(folder)?.ino()));
        let (file, inode) = open().map_err(|e| atomic::unreadable(folder, &e, "choose another folder with -o"))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(Error::machine(
                folder.display(),
                format!("{} is at work in this folder", holder(inode)),
                "wait until it has ended, or choose another folder with -o",
            )),
            _ => Ok(Self { _folder: file }),
        }
    }
}

/// The process that holds the lock of a file, as far as the system tells.
fn holder(inode: u64) -> String {
    let locks = fs::read_to_string("/proc/locks").unwrap_or_default();
    let process = locks.lines().find_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let of_folder = words.get(5)?.rsplit(':').next()?.parse() == Ok(inode);
        (words.get(1) == Some(&"FLOCK") && of_folder).then(|| words.get(4).copied()).flatten()
    });
    let Some(process) = process else { return "another process".to_owned() };
    let command = fs::read(format!("/proc/{process}/cmdline")).unwrap_or_default();
    let words = command.split(|&byte| byte == 0).map(String::from_utf8_lossy);
    format!("process {process} ({})", words.collect::<Vec<_>>().join(" ").trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_holder_is_told_of_the_first_until_it_ends() {
        let folder = tempfile::tempdir().unwrap();
        let first = Lock::take(folder.path()).unwrap();
        let refused = Lock::take(folder.path()).unwrap_err().to_string();
        let own = format!("process {} (", std::process::id());
        assert!(refused.contains(&own) && refused.contains("is at work"), "{refused}");
        drop(first);
        Lock::take(folder.path()).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "it leaves nothing");
    }
}
