//! Gmsh itself: a session with its one global model, by its C interface. All foreign functions of the program are called here.

use super::files::{absolute, check_complete};
use crate::error::{Error, Result};
use std::collections::HashMap;
use std::ffi::{CStr, CString, c_char, c_int};
use std::fs;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::{Mutex, MutexGuard, PoisonError};

mod ffi {
    include!(concat!(env!("OUT_DIR"), "/gmsh.rs"));
}

static LOCK: Mutex<()> = Mutex::new(());

/// Gmsh, started with its default options and silent, for as long as this lives.
pub struct Session {
    _lock: MutexGuard<'static, ()>,
}

/// A physical group: its name and the tags of its entities in ascending order.
pub struct Physical {
    tag: c_int,
    pub name: String,
    pub entities: Vec<c_int>,
}

impl Session {
    /// Starts it, once no other thread has a session.
    ///
    /// # Errors
    /// A machine error when Gmsh does not start or lacks an option.
    pub fn start() -> Result<Self> {
        // A thread that panicked with the lock has ended its session: the lock guards nothing else.
        let lock = LOCK.lock().unwrap_or_else(PoisonError::into_inner);
        let mut status = 0;
        // SAFETY: no arguments; neither the user's configuration files nor the window are wanted.
        unsafe { ffi::initialize(0, null_mut(), 0, 0, &mut status) };
        let session = Self { _lock: lock };
        if status != 0 {
            return Err(Error::machine("Gmsh", "it does not start", "run `make setup`"));
        }
        session.set_option("General.Terminal", 0.0)?;
        // Errors are logged, not thrown: thrown ones leave the rest of a file in Gmsh's parser for the next.
        session.set_option("General.AbortOnError", 1.0)?;
        // One thread, so that the mesh is the same every time.
        session.set_option("General.NumThreads", 1.0)?;
        // SAFETY: as above.
        unsafe { ffi::logger_start(&mut status) };
        Ok(session)
    }

    /// Sets an option that is a number.
    ///
    /// # Errors
    /// A machine error when this Gmsh has no such option.
    pub fn set_option(&self, name: &str, value: f64) -> Result<()> {
        let mut status = 0;
        let c_name = c_string(name)?;
        // SAFETY: a zero-terminated string that outlives the call.
        unsafe { ffi::option_set_number(c_name.as_ptr(), value, &mut status) };
        if status == 0 { Ok(()) } else { Err(no_option(name)) }
    }

    /// Presets a variable, which `DefineConstant` then leaves as it is.
    ///
    /// # Errors
    /// Input: a name with a zero byte.
    pub fn set_parameter(&self, geo: &Path, name: &str, value: f64) -> Result<()> {
        let mut status = 0;
        let c_name = c_string(name)?;
        // SAFETY: one number and a zero-terminated string, both copied by Gmsh.
        unsafe { ffi::parser_set_number(c_name.as_ptr(), &value, 1, &mut status) };
        self.checked(geo, status, "")
    }

    /// The value of a variable of the `.geo`, where it is a number.
    ///
    /// # Errors
    /// Input: a name with a zero byte.
    pub fn parameter(&self, name: &str) -> Result<Option<f64>> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        let c_name = c_string(name)?;
        // SAFETY: Gmsh hands out an array of `count` numbers, which `take` copies and frees.
        let values = unsafe {
            ffi::parser_get_number(c_name.as_ptr(), &mut data, &mut count, &mut status);
            take(data, count)
        };
        Ok(values.first().copied().filter(|_| status == 0))
    }

    /// Reads a file into the model, which is empty at the start of a session.
    ///
    /// # Errors
    /// Input: what Gmsh says of the file, with its line.
    pub fn merge(&self, path: &Path) -> Result<()> {
        let name = c_path(path)?;
        let mut status = 0;
        // SAFETY: a zero-terminated string that outlives the call.
        unsafe { ffi::merge(name.as_ptr(), &mut status) };
        self.checked(path, status, "correct the file")
    }

    /// The value of an option that is a number.
    ///
    /// # Errors
    /// A machine error when this Gmsh has no such option.
    pub fn option(&self, name: &str) -> Result<f64> {
        let (mut value, mut status) = (0.0, 0);
        let c_name = c_string(name)?;
        // SAFETY: a zero-terminated string that outlives the call, and a place for a number.
        unsafe { ffi::option_get_number(c_name.as_ptr(), &mut value, &mut status) };
        if status == 0 { Ok(value) } else { Err(no_option(name)) }
    }

    /// The mesh size that is set at a point (m), if any.
    pub fn size(&self, point: c_int) -> Option<f64> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: a pair of dimension and tag; Gmsh hands out an array of `count` numbers.
        let sizes = unsafe {
            ffi::model_mesh_get_sizes([0, point].as_ptr(), 2, &mut data, &mut count, &mut status);
            take(data, count)
        };
        sizes.first().copied()
    }

    /// The diagonal of the box around an entity (m), or around all for the dimension −1; not a number where there is none.
    pub fn extent(&self, dimension: c_int, tag: c_int) -> f64 {
        let [low, high] = self.bounds(dimension, tag);
        (high[0] - low[0]).hypot(high[1] - low[1]).hypot(high[2] - low[2])
    }

    /// Lowest and highest corner of that box (m); no numbers where there is none.
    pub fn bounds(&self, dimension: c_int, tag: c_int) -> [[f64; 3]; 2] {
        let ([mut x, mut y, mut z, mut x2, mut y2, mut z2], mut status) = ([f64::NAN; 6], 0);
        // SAFETY: places for six numbers.
        unsafe {
            ffi::model_get_bounding_box(dimension, tag, &mut x, &mut y, &mut z, &mut x2, &mut y2, &mut z2, &mut status);
        }
        [[x, y, z], [x2, y2, z2]]
    }

    /// The entities that bound one, negative where they run against its sense.
    pub fn boundary(&self, dimension: c_int, tag: c_int) -> Vec<c_int> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: a pair of dimension and tag; Gmsh hands out `count` integers, pairs of dimension and tag.
        let pairs = unsafe {
            ffi::model_get_boundary([dimension, tag].as_ptr(), 2, &mut data, &mut count, 0, 1, 0, &mut status);
            take(data, count)
        };
        pairs.chunks_exact(2).map(|pair| pair[1]).collect()
    }

    /// Meshes the entities of a dimension and of those below, with straight cells.
    ///
    /// # Errors
    /// Input: a geometry that does not mesh.
    pub fn mesh(&self, geo: &Path, dimension: c_int) -> Result<()> {
        let mut status = 0;
        // SAFETY: plain numbers; the session holds the lock.
        unsafe { ffi::model_mesh_generate(dimension, &mut status) };
        self.checked(geo, status, "the geometry does not mesh; open it in Gmsh to see where")
    }

    /// Forgets the mesh.
    pub fn clear(&self) {
        let mut status = 0;
        // SAFETY: no entities are named, which means all.
        unsafe { ffi::model_mesh_clear(std::ptr::null(), 0, &mut status) };
    }

    /// Gives the cells their order.
    ///
    /// # Errors
    /// Input: a mesh that cannot have it.
    pub fn set_order(&self, geo: &Path, order: u8) -> Result<()> {
        let mut status = 0;
        // SAFETY: as above.
        unsafe { ffi::model_mesh_set_order(c_int::from(order), &mut status) };
        self.checked(geo, status, "the mesh cannot have the order of its cells; use order: 1 or mend the geometry")
    }

    /// The coordinates of all nodes by their tags.
    pub fn nodes(&self) -> HashMap<usize, [f64; 3]> {
        let (mut tags, mut tag_count, mut coordinates, mut coordinate_count) = (null_mut(), 0, null_mut(), 0);
        let (mut parameters, mut parameter_count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out three arrays of the counts it gives.
        let (tags, coordinates) = unsafe {
            ffi::model_mesh_get_nodes(
                &mut tags,
                &mut tag_count,
                &mut coordinates,
                &mut coordinate_count,
                &mut parameters,
                &mut parameter_count,
                -1,
                -1,
                0,
                0,
                &mut status,
            );
            take(parameters, parameter_count);
            (take(tags, tag_count), take(coordinates, coordinate_count))
        };
        tags.into_iter().zip(coordinates.chunks_exact(3).map(|x| [x[0], x[1], x[2]])).collect()
    }

    /// The elements of an entity, or of all of a dimension for the tag −1: the tags of their nodes.
    pub fn elements(&self, dimension: c_int, entity: c_int) -> Vec<Vec<usize>> {
        let (mut types, mut type_count, mut status) = (null_mut(), 0, 0);
        let (mut tags, mut tag_counts, mut tag_lists) = (null_mut(), null_mut(), 0);
        let (mut nodes, mut node_counts, mut node_lists) = (null_mut(), null_mut(), 0);
        // SAFETY: Gmsh hands out an array of types and two lists of arrays.
        let (tags, nodes) = unsafe {
            ffi::model_mesh_get_elements(
                &mut types,
                &mut type_count,
                &mut tags,
                &mut tag_counts,
                &mut tag_lists,
                &mut nodes,
                &mut node_counts,
                &mut node_lists,
                dimension,
                entity,
                &mut status,
            );
            take(types, type_count);
            (take_lists(tags, tag_counts, tag_lists), take_lists(nodes, node_counts, node_lists))
        };
        let by_type = tags.iter().zip(&nodes).filter(|(tags, _)| !tags.is_empty());
        by_type
            .flat_map(|(tags, nodes)| nodes.chunks_exact((nodes.len() / tags.len()).max(1)).map(<[usize]>::to_vec))
            .collect()
    }

    /// Writes the mesh beside `out`, checks that it is all there and renames it.
    ///
    /// # Errors
    /// A machine error when it cannot be written in full.
    pub fn write(&self, out: &Path) -> Result<()> {
        let failed = |problem: String| {
            Error::machine(out.display(), problem, "free some space, or choose another folder with -o")
        };
        let stem = out.file_stem().unwrap_or_default().to_string_lossy();
        // Gmsh chooses the format by the extension.
        let beside = out.with_file_name(format!(".{stem}.{}.msh", std::process::id()));
        let name = c_path(&beside)?;
        let mut status = 0;
        // SAFETY: a zero-terminated string that outlives the call.
        unsafe { ffi::write(name.as_ptr(), &mut status) };
        let written = match status {
            0 => check_complete(&beside)
                .map_err(|_| failed("the mesh could not be written in full".into()))
                .and_then(|()| fs::File::open(&beside).and_then(|f| f.sync_all()).map_err(|e| failed(e.to_string())))
                .and_then(|()| fs::rename(&beside, out).map_err(|e| failed(e.to_string()))),
            _ => Err(failed("the mesh could not be written".into())),
        };
        if written.is_err() {
            // What is left of the attempt; that it may not exist is no further error.
            let _ = fs::remove_file(&beside);
        }
        written
    }

    /// The physical groups of a dimension, by their numbers.
    pub fn physical_groups(&self, dimension: c_int) -> Vec<Physical> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out `count` integers, pairs of dimension and tag.
        let pairs = unsafe {
            ffi::model_get_physical_groups(&mut data, &mut count, dimension, &mut status);
            take(data, count)
        };
        let mut groups = Vec::new();
        for pair in pairs.chunks_exact(2) {
            let tag = pair[1];
            let mut name: *mut c_char = null_mut();
            // SAFETY: Gmsh hands out a zero-terminated string and an array of tags.
            let (name, mut entities) = unsafe {
                ffi::model_get_physical_name(dimension, tag, &mut name, &mut status);
                let name = take_string(name);
                let (mut data, mut count) = (null_mut(), 0);
                ffi::model_get_entities_for_physical_group(dimension, tag, &mut data, &mut count, &mut status);
                (name, take(data, count))
            };
            entities.sort_unstable();
            entities.dedup();
            let name = if name.is_empty() { tag.to_string() } else { name };
            groups.push(Physical { tag, name, entities });
        }
        groups.sort_by_key(|g| g.tag);
        groups
    }

    /// The tags of the entities of a dimension.
    pub fn entities(&self, dimension: c_int) -> Vec<c_int> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out `count` integers, pairs of dimension and tag.
        let pairs = unsafe {
            ffi::model_get_entities(&mut data, &mut count, dimension, &mut status);
            take(data, count)
        };
        pairs.chunks_exact(2).map(|pair| pair[1]).collect()
    }

    /// An error if the last call failed or Gmsh has logged one.
    ///
    /// # Errors
    /// Input: what Gmsh says, at the line of the file that it names, with the `remedy`.
    pub fn checked(&self, path: &Path, status: c_int, remedy: &str) -> Result<()> {
        // A group that names a curve that is not there is a warning to Gmsh, and wrong all the same.
        let logged = self.log().into_iter().find_map(|line| {
            let skipped = line.strip_prefix("Warning: ").filter(|text| text.starts_with("Skipping unknown"));
            line.strip_prefix("Error: ").or(skipped).map(str::to_owned)
        });
        let message = match logged {
            Some(message) => message,
            None if status == 0 => return Ok(()),
            None => self.last_error(),
        };
        if message.trim().is_empty() {
            let problem = "Gmsh gave up without a message, mostly for lack of memory";
            return Err(Error::input(path.display(), problem, "ask for a larger mesh size, or simplify the geometry"));
        }
        // Gmsh names the place as `'file', line N: what`.
        let split = message.strip_prefix('\'').and_then(|rest| {
            let (file, rest) = rest.split_once("', line ")?;
            let (line, problem) = rest.split_once(": ")?;
            // The file itself as the user named it; an included one as Gmsh does.
            let own = absolute(path).to_string_lossy() == file;
            let file = if own { path.display().to_string() } else { file.to_owned() };
            Some((format!("{file}, line {line}"), problem.to_owned()))
        });
        let (place, problem) = split.unwrap_or((path.display().to_string(), message));
        Err(Error::input(place, problem, remedy))
    }

    /// What Gmsh has logged since it was started, a line each.
    pub fn log(&self) -> Vec<String> {
        let (mut lines, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out `count` strings.
        unsafe {
            ffi::logger_get(&mut lines, &mut count, &mut status);
            take_strings(lines, count)
        }
    }

    /// What Gmsh says of its last error.
    pub fn last_error(&self) -> String {
        let (mut message, mut status) = (null_mut(), 0);
        // SAFETY: Gmsh hands out a zero-terminated string.
        unsafe {
            ffi::logger_get_last_error(&mut message, &mut status);
            take_string(message)
        }
    }

    /// The names of the variables of the `.geo`.
    pub fn parameter_names(&self) -> Vec<String> {
        let (mut names, mut count, mut status) = (null_mut(), 0, 0);
        let search = CString::default();
        // SAFETY: Gmsh hands out `count` strings.
        unsafe {
            ffi::parser_get_names(&mut names, &mut count, search.as_ptr(), &mut status);
            take_strings(names, count)
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let mut status = 0;
        let all = CString::default();
        // SAFETY: the session was started and the lock is still held. The log and the variables of the
        // parser outlive `finalize`.
        unsafe {
            ffi::logger_stop(&mut status);
            ffi::parser_clear(all.as_ptr(), &mut status);
            ffi::finalize(&mut status);
        }
    }
}

fn no_option(name: &str) -> Error {
    Error::machine("Gmsh", format!("it has no option {name}"), "run `make setup`")
}

fn c_string(text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::input(format!("{text:?}"), "it contains a zero byte", "take it out"))
}

fn c_path(path: &Path) -> Result<CString> {
    c_string(&absolute(path).to_string_lossy())
}

/// Copies an array that Gmsh hands out, and frees it.
///
/// # Safety
/// `data` is null or an array of `count` values allocated by Gmsh.
unsafe fn take<T: Copy>(data: *mut T, count: usize) -> Vec<T> {
    if data.is_null() {
        return Vec::new();
    }
    // SAFETY: as required of the caller.
    unsafe {
        let values = std::slice::from_raw_parts(data, count).to_vec();
        ffi::free(data.cast());
        values
    }
}

/// Copies a list of arrays and frees all of it.
///
/// # Safety
/// `data` and `counts` are null or arrays of `count` arrays and of their lengths, allocated by Gmsh.
unsafe fn take_lists<T: Copy>(data: *mut *mut T, counts: *mut usize, count: usize) -> Vec<Vec<T>> {
    // SAFETY: as required of the caller.
    unsafe {
        let (lists, counts) = (take(data, count), take(counts, count));
        lists.into_iter().zip(counts).map(|(list, count)| take(list, count)).collect()
    }
}

/// Copies a string and frees it.
///
/// # Safety
/// `text` is null or a zero-terminated string allocated by Gmsh.
unsafe fn take_string(text: *mut c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: as required of the caller.
    unsafe {
        let copy = CStr::from_ptr(text).to_string_lossy().into_owned();
        ffi::free(text.cast());
        copy
    }
}

/// Copies a list of strings and frees all of it.
///
/// # Safety
/// `data` is null or an array of `count` strings allocated by Gmsh.
unsafe fn take_strings(data: *mut *mut c_char, count: usize) -> Vec<String> {
    // SAFETY: as required of the caller.
    unsafe { take(data, count).into_iter().map(|text| take_string(text)).collect() }
}
