//! Writes a file as a whole or not at all: beside its name, then renamed into place.
//!
//! A process that is killed leaves the earlier file or the new one, never half of it. [`write_durable`] also
//! waits for the disk, so that a power cut cannot lose a file that was reported as written.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::error::{Error, Result};

/// The marker of unfinished files, `.<name>.tmp-<process>`.
const MARK: &str = ".tmp-";

/// Writes `path` with what `fill` puts out, replacing an earlier file in one move.
///
/// # Errors
/// `Machine` when the folder cannot be written or the disk is full; the earlier file stays as it was and
/// nothing half-written remains.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    replace(path, false, fill)
}

/// Like [`write()`], and returns only when the file is on the disk.
///
/// # Errors
/// As [`write()`].
pub fn write_durable(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    replace(path, true, fill)
}

fn replace(path: &Path, durable: bool, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let beside = beside(path);
    let written = (|| {
        // A file that an earlier process with this number left, or a link that someone created there.
        match fs::remove_file(&beside) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e),
            _ => {}
        }
        let mut out = BufWriter::with_capacity(1 << 18, File::create_new(&beside)?);
        fill(&mut out)?;
        let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        if durable {
            file.sync_all()?;
        }
        drop(file);
        fs::rename(&beside, path)?;
        match path.parent() {
            Some(folder) if durable => sync_folder(folder),
            _ => Ok(()),
        }
    })();
    written.map_err(|e| {
        // Only a convenience: the report is about the first error.
        let _ = fs::remove_file(&beside);
        unwritable(path, &e)
    })
}

fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}{MARK}{}", std::process::id()))
}

/// The rename itself reaches the disk with its folder.
fn sync_folder(folder: &Path) -> io::Result<()> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    File::open(folder)?.sync_all()
}

/// Makes `folder` with its parents, and removes the unfinished files that killed processes left in it.
///
/// # Errors
/// `Machine` when the folder can neither be made nor read.
pub fn prepare_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|e| unwritable(folder, &e))?;
    for path in entries(folder)? {
        if let Some(process) = unfinished(&path)
            && process != std::process::id()
            && !Path::new(&format!("/proc/{process}")).exists()
        {
            remove(&path)?;
        }
    }
    Ok(())
}

/// The number between `start` and `end` in a name.
pub fn number<N: FromStr>(name: &str, start: &str, end: &str) -> Option<N> {
    let number = name.strip_prefix(start)?.strip_suffix(end)?;
    // A sign would parse, too.
    number.parse().ok().filter(|_| number.bytes().all(|digit| digit.is_ascii_digit()))
}

/// The numbers of the files in a folder that are named by one between `start` and `end`, in order.
///
/// # Errors
/// Those of the folder.
pub fn numbered<N: FromStr + Ord>(folder: &Path, start: &str, end: &str) -> io::Result<Vec<N>> {
    let entries = fs::read_dir(folder)?;
    let mut numbers: Vec<N> =
        entries.filter_map(|entry| number(entry.ok()?.file_name().to_str()?, start, end)).collect();
    numbers.sort_unstable();
    Ok(numbers)
}

/// The process that was writing the file, if `path` is an unfinished one.
fn unfinished(path: &Path) -> Option<u32> {
    let name = path.file_name()?.to_str()?;
    let (start, process) = name.rsplit_once(MARK)?;
    start.starts_with('.').then(|| process.parse().ok())?
}

/// Refuses a symbolic link where the program writes in place or empties a folder: its target may be anywhere.
///
/// # Errors
/// `Input` for a link.
pub fn refuse_link(path: &Path) -> Result<()> {
    match fs::symlink_metadata(path) {
        Ok(metadata) if metadata.is_symlink() => Err(Error::input(
            path.display(),
            "is a symbolic link, and nothing is written outside the output folder",
            "remove the link, or name the folder itself with -o",
        )),
        _ => Ok(()),
    }
}

/// Removes the files of a folder whose names `is_own` takes, with those that killed processes left unfinished, and the folder where
/// nothing else is in it; one that is not there is as good.
///
/// # Errors
/// `Input` for a link in its place, `Machine` when one of them stays.
pub fn clear_folder(folder: &Path, is_own: impl Fn(&str) -> bool) -> Result<()> {
    refuse_link(folder)?;
    for path in entries(folder)? {
        if unfinished(&path).is_some() || is_named(&path, &is_own) {
            remove(&path)?;
        }
    }
    remove_empty(folder)
}

/// Moves what has other names than `is_own` takes from one folder to another.
///
/// # Errors
/// `Input` for a link in place of a folder; `Machine` when something has a name there already or cannot be moved.
pub fn move_others(from: &Path, to: &Path, is_own: impl Fn(&str) -> bool) -> Result<()> {
    refuse_link(from)?;
    refuse_link(to)?;
    for path in entries(from)? {
        if unfinished(&path).is_some() || is_named(&path, &is_own) {
            continue;
        }
        fs::create_dir_all(to).map_err(|e| unwritable(to, &e))?;
        let place = to.join(path.file_name().unwrap_or_default());
        if fs::symlink_metadata(&place).is_ok() {
            return Err(unwritable(&place, &io::ErrorKind::AlreadyExists.into()));
        }
        rename(&path, &place)?;
    }
    Ok(())
}

/// Removes a folder where nothing is in it.
///
/// # Errors
/// `Machine` when it cannot be removed all the same.
pub fn remove_empty(folder: &Path) -> Result<()> {
    use io::ErrorKind::{DirectoryNotEmpty, NotADirectory, NotFound};
    match fs::remove_dir(folder) {
        Err(e) if !matches!(e.kind(), NotFound | NotADirectory | DirectoryNotEmpty) => Err(unwritable(folder, &e)),
        _ => Ok(()),
    }
}

/// What is in a folder; nothing where there is none.
///
/// # Errors
/// `Machine` when it cannot be read.
pub fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    match fs::read_dir(folder) {
        Err(e) if matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(Vec::new()),
        entries => entries
            .and_then(|entries| entries.map(|entry| entry.map(|entry| entry.path())).collect())
            .map_err(|e| unwritable(folder, &e)),
    }
}

/// Whether the name of a file is one that `is_own` takes.
pub fn is_named(path: &Path, is_own: impl Fn(&str) -> bool) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(is_own)
}

/// Renames a file or folder.
///
/// # Errors
/// `Machine` when it cannot be renamed.
pub fn rename(from: &Path, to: &Path) -> Result<()> {
    fs::rename(from, to).map_err(|e| unwritable(to, &e))
}

/// Removes a file; one that is not there is as good.
///
/// # Errors
/// `Machine` when it is there and stays.
pub fn remove(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(unwritable(path, &e)),
        _ => Ok(()),
    }
}

/// The error of a file or folder that cannot be written.
pub fn unwritable(path: &Path, e: &io::Error) -> Error {
    let remedy = match e.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space, or choose an output folder on another disk with -o"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "make the folder writable, or choose another with -o"
        }
        io::ErrorKind::NotFound => "make the folder, or choose another with -o",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists | io::ErrorKind::IsADirectory => {
            "something else has this name: move it away, or choose another folder with -o"
        }
        _ => "check the disk, or choose another output folder with -o",
    };
    Error::machine(path.display(), format!("cannot be written: {e}"), remedy)
}

/// The error of a file that cannot be read; a missing one is an input error with `remedy`.
pub fn unreadable(path: &Path, e: &io::Error, remedy: &str) -> Error {
    match e.kind() {
        io::ErrorKind::NotFound => Error::input(path.display(), "there is no such file", remedy),
        // What `reading` does not open.
        io::ErrorKind::InvalidInput | io::ErrorKind::FileTooLarge => {
            Error::input(path.display(), e, "put a regular file in its place")
        }
        io::ErrorKind::PermissionDenied => {
            Error::machine(path.display(), format!("cannot be read: {e}"), "make it readable")
        }
        _ => Error::machine(path.display(), format!("cannot be read: {e}"), "check the path and the disk"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_failed_write_keeps_the_earlier_file_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, |w| w.write_all(b"earlier")).unwrap();
        let full = write_durable(&path, |w| {
            w.write_all(&[0; 1 << 20])?;
            Err(io::ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert_eq!(full.kind, Kind::Machine);
        assert!(full.to_string().contains("a.txt") && full.remedy.contains("free some space"), "{full}");
        assert_eq!(fs::read(&path).unwrap(), b"earlier");
        assert_eq!(names(folder.path()), ["a.txt"]);
        write_durable(&path, |w| w.write_all(b"later")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"later");
    }

    #[test]
    fn a_missing_folder_and_a_file_in_the_way_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = write(&folder.path().join("no/a.txt"), |_| Ok(())).unwrap_err();
        assert_eq!(missing.kind, Kind::Machine);
        assert!(missing.to_string().contains("no/a.txt"), "{missing}");
        let file = folder.path().join("file");
        write(&file, |_| Ok(())).unwrap();
        assert_eq!(prepare_folder(&file).unwrap_err().kind, Kind::Machine);
    }

    #[test]
    fn leftovers_of_dead_processes_are_removed_and_others_kept() {
        let folder = tempfile::tempdir().unwrap();
        let mut dead = std::process::Command::new("true").spawn().unwrap();
        let dead_id = dead.id();
        dead.wait().unwrap();
        let own = format!(".frame.tmp-{}", std::process::id());
        for name in [&format!(".frame.tmp-{dead_id}"), &own, "notes.tmp-3", ".frame.tmp-x"] {
            fs::write(folder.path().join(name), b"").unwrap();
        }
        prepare_folder(folder.path()).unwrap();
        let mut left = names(folder.path());
        left.sort();
        let mut expected = vec![".frame.tmp-x".to_string(), own, "notes.tmp-3".to_string()];
        expected.sort();
        assert_eq!(left, expected);
    }
}
