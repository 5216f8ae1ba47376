//! Meshes from Gmsh: a `.geo` to an MSH 4.1 file, and such a file to a [`Mesh`].
//!
//! All foreign functions of the program are called here. Gmsh keeps one global model and is not safe to
//! share among threads: a `Session` holds a lock, starts Gmsh afresh and ends it when dropped. Gmsh prints
//! nothing; what it has to say comes back in errors, with its own file and line.

use std::collections::BTreeMap;
use std::ffi::{CStr, CString, c_char, c_int};
use std::fs;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::shape::CellKind;
use super::{Cells, Group, Mesh};
use crate::error::{Error, Result};

mod ffi {
    include!(concat!(env!("OUT_DIR"), "/gmsh.rs"));
}

/// What the case decides about the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Polynomial order of the cells: 1 or 2.
    pub order: u8,
    /// Quadrilaterals of order 2 without a centre node (Q8 instead of Q9).
    pub incomplete: bool,
    /// Values of `DefineConstant` variables of the `.geo`, by name.
    pub parameters: Vec<(String, f64)>,
}

/// Meshes the plane geometry in `geo` and writes MSH 4.1 with the names of the physical groups to `out`,
/// which must end in `.msh`; it is replaced in one go, and only by a complete file.
///
/// # Errors
/// Input: what Gmsh cannot read or mesh, with its line where it names one; a parameter that no
/// `DefineConstant` declares; a surface in no physical surface or in two; an order other than 1 and 2.
/// Machine: `out` cannot be written.
pub fn generate(geo: &Path, options: &Options, out: &Path) -> Result<()> {
    if !matches!(options.order, 1 | 2) {
        return Err(Error::input(geo.display(), format!("order {} is not possible", options.order), "use 1 or 2"));
    }
    let session = open(geo, options)?;
    for (name, value) in [
        ("Mesh.ElementOrder", 1.0),
        ("Mesh.SecondOrderIncomplete", f64::from(u8::from(options.incomplete))),
        ("Mesh.SecondOrderLinear", 0.0),
        ("Mesh.MshFileVersion", 4.1),
        ("Mesh.Binary", 0.0),
        ("Mesh.SaveAll", 0.0),
        ("Mesh.SaveParametric", 0.0),
        ("Mesh.ScalingFactor", 1.0),
    ] {
        session.set_option(name, value)?;
    }
    let mut status = 0;
    // SAFETY: plain numbers; the session holds the lock.
    unsafe { ffi::model_mesh_generate(2, &mut status) };
    session.checked(geo, status, "the geometry does not mesh; open it in Gmsh to see where")?;
    // SAFETY: as above.
    unsafe { ffi::model_mesh_set_order(c_int::from(options.order), &mut status) };
    session.checked(geo, status, "the mesh has no second order; use order: 1 or mend the geometry")?;
    session.write(out)
}

/// The names of the physical groups of a `.geo`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    pub surfaces: Vec<String>,
    pub curves: Vec<String>,
    pub points: Vec<String>,
}

/// The names of the physical groups of the geometry in `geo`, which is not meshed.
///
/// # Errors
/// Input: as [`generate`], but for what only shows in meshing.
pub fn groups(geo: &Path, options: &Options) -> Result<Groups> {
    let session = open(geo, options)?;
    let names = |dimension| Ok(session.physical_groups(dimension)?.into_iter().map(|group| group.name).collect());
    Ok(Groups { surfaces: names(2)?, curves: names(1)?, points: names(0)? })
}

/// A session with the geometry in `geo`, its parameters and surfaces checked.
fn open(geo: &Path, options: &Options) -> Result<Session> {
    check_readable(geo)?;
    let text = fs::read(geo).map_err(|error| Error::input(geo.display(), error, "check the path"))?;
    let last = text.rsplit(|&c| c == b'\n').next().unwrap_or_default();
    if !last.trim_ascii().is_empty() {
        return Err(Error::input(
            geo.display(),
            "the last line has no end, and Gmsh would leave its statement out",
            "end the file with a line feed",
        ));
    }
    let session = Session::start()?;
    for (name, value) in &options.parameters {
        session.set_parameter(geo, name, *value)?;
    }
    session.merge(geo)?;
    check_parameters(&session, geo, &String::from_utf8_lossy(&text), &options.parameters)?;
    check_surfaces(&session, geo)?;
    Ok(session)
}

/// Reads a plane mesh with its named groups from a file Gmsh understands (MSH 4.1 of [`generate`]).
///
/// Cells come in the order of their physical surfaces' numbers, nodes in that of theirs; nodes of no cell
/// are left out, clockwise cells are turned round, a group without a name is called by its number.
///
/// # Errors
/// Input: a file that is missing, cut short or without physical surfaces; cells that are not T3, T6, Q4, Q8
/// or Q9, of mixed order, in two physical surfaces, or outside the x–y plane; groups that no cell touches.
pub fn read(path: &Path) -> Result<Mesh<2>> {
    check_readable(path)?;
    check_complete(path)?;
    let session = Session::start()?;
    session.merge(path)?;
    check_surfaces(&session, path)?;
    let place = path.display();
    let nodes = session.nodes(path)?;
    let mut mesh = Mesh { nodes: Vec::new(), cells: Cells::default(), regions: Vec::new(), groups: Vec::new() };
    let mut cells = Vec::new();
    for physical in session.physical_groups(2)? {
        let region = u16::try_from(mesh.regions.len())
            .map_err(|_| Error::input(&place, "more than 65536 physical surfaces", "join some of them"))?;
        if mesh.regions.contains(&physical.name) {
            return Err(doubled(path, "surfaces", &physical.name));
        }
        for &entity in &physical.entities {
            for (kind, tags) in session.elements(path, 2, entity)? {
                cells.push((kind, region, tags));
            }
        }
        mesh.regions.push(physical.name);
    }
    if let Some((a, b)) = cells.first().zip(cells.iter().find(|c| c.0.order() != cells[0].0.order())) {
        return Err(Error::input(&place, format!("{:?} and {:?} cells in one mesh", a.0, b.0), "use one order"));
    }
    if cells.is_empty() {
        return Err(Error::input(
            &place,
            "the mesh has no surface cells",
            "mesh it in two dimensions and save it again",
        ));
    }
    // Number the nodes of the cells in the order of their tags.
    let mut number: BTreeMap<usize, u32> = cells.iter().flat_map(|c| c.2.iter().map(|&tag| (tag, 0))).collect();
    for (i, (tag, number)) in number.iter_mut().enumerate() {
        *number = i as u32;
        let x = nodes.get(tag).ok_or_else(|| Error::input(&place, format!("node {tag} is missing"), AGAIN))?;
        mesh.nodes.push([x[0], x[1]]);
    }
    straighten(&cells, &number, &mut mesh.nodes);
    check_plane(path, number.keys().filter_map(|tag| nodes.get(tag)))?;
    let mut local = Vec::new();
    for (kind, region, tags) in &cells {
        local.clear();
        local.extend(tags.iter().map(|tag| number[tag]));
        turn_counter_clockwise(*kind, &mesh.nodes, &mut local);
        mesh.cells.push(*kind, *region, &local);
    }
    for dimension in [1, 0] {
        for physical in session.physical_groups(dimension)? {
            let kind = if dimension == 1 { "curves" } else { "points" };
            if mesh.groups.iter().any(|g| g.name == physical.name) {
                return Err(doubled(path, kind, &physical.name));
            }
            let mut group =
                Group { name: physical.name, dimension: dimension as usize, facets: Vec::new(), nodes: Vec::new() };
            for &entity in &physical.entities {
                for (kind, tags) in session.elements(path, dimension, entity)? {
                    let nodes: Option<Vec<u32>> = tags.iter().map(|tag| number.get(tag).copied()).collect();
                    let nodes = nodes.ok_or_else(|| {
                        Error::input(
                            format!("{place}, physical group {}", group.name),
                            "it has nodes that belong to no cell",
                            "embed it in a surface (`Curve{…} In Surface{…};`) or take it out",
                        )
                    })?;
                    group.facets.push((kind, nodes));
                }
            }
            group.nodes = group.facets.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
            group.nodes.sort_unstable();
            group.nodes.dedup();
            mesh.groups.push(group);
        }
    }
    Ok(mesh)
}

const AGAIN: &str = "make the file again with `mpm mesh`";

static LOCK: Mutex<()> = Mutex::new(());

/// Gmsh, started with its default options and silent, for as long as this lives.
struct Session {
    _lock: MutexGuard<'static, ()>,
}

/// A physical group: its name and the tags of its entities in ascending order.
struct Physical {
    tag: c_int,
    name: String,
    entities: Vec<c_int>,
}

impl Session {
    fn start() -> Result<Self> {
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

    fn set_option(&self, name: &str, value: f64) -> Result<()> {
        let mut status = 0;
        let c_name = c_string(name)?;
        // SAFETY: a zero-terminated string that outlives the call.
        unsafe { ffi::option_set_number(c_name.as_ptr(), value, &mut status) };
        if status == 0 {
            Ok(())
        } else {
            Err(Error::machine("Gmsh", format!("it has no option {name}"), "run `make setup`"))
        }
    }

    /// Presets a variable, which `DefineConstant` then leaves as it is.
    fn set_parameter(&self, geo: &Path, name: &str, value: f64) -> Result<()> {
        let mut status = 0;
        let c_name = c_string(name)?;
        // SAFETY: one number and a zero-terminated string, both copied by Gmsh.
        unsafe { ffi::parser_set_number(c_name.as_ptr(), &value, 1, &mut status) };
        self.checked(geo, status, "")
    }

    /// The value of a variable of the `.geo`, where it is a number.
    fn parameter(&self, name: &str) -> Result<Option<f64>> {
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
    fn merge(&self, path: &Path) -> Result<()> {
        let name = c_path(path)?;
        let mut status = 0;
        // SAFETY: a zero-terminated string that outlives the call.
        unsafe { ffi::merge(name.as_ptr(), &mut status) };
        self.checked(path, status, "correct the file")
    }

    /// Writes the mesh beside `out`, checks that it is all there and renames it.
    fn write(&self, out: &Path) -> Result<()> {
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
    fn physical_groups(&self, dimension: c_int) -> Result<Vec<Physical>> {
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
        Ok(groups)
    }

    /// The tags of the entities of a dimension.
    fn entities(&self, dimension: c_int) -> Vec<c_int> {
        let (mut data, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out `count` integers, pairs of dimension and tag.
        let pairs = unsafe {
            ffi::model_get_entities(&mut data, &mut count, dimension, &mut status);
            take(data, count)
        };
        pairs.chunks_exact(2).map(|pair| pair[1]).collect()
    }

    /// The coordinates of all nodes by their tags.
    fn nodes(&self, path: &Path) -> Result<BTreeMap<usize, [f64; 3]>> {
        let (mut tags, mut tag_count) = (null_mut(), 0);
        let (mut coordinates, mut coordinate_count) = (null_mut(), 0);
        let (mut parameters, mut parameter_count) = (null_mut(), 0);
        let mut status = 0;
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
        self.checked(path, status, AGAIN)?;
        Ok(tags.into_iter().zip(coordinates.chunks_exact(3).map(|x| [x[0], x[1], x[2]])).collect())
    }

    /// The elements of an entity, each with its kind and the tags of its nodes.
    fn elements(&self, path: &Path, dimension: c_int, entity: c_int) -> Result<Vec<(CellKind, Vec<usize>)>> {
        let (mut types, mut type_count) = (null_mut(), 0);
        let (mut tags, mut tag_counts, mut tag_lists) = (null_mut(), null_mut(), 0);
        let (mut nodes, mut node_counts, mut node_lists) = (null_mut(), null_mut(), 0);
        let mut status = 0;
        // SAFETY: Gmsh hands out an array of types and, a type each, lists of elements and of their nodes.
        let (types, nodes) = unsafe {
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
            take_lists(tags, tag_counts, tag_lists);
            (take(types, type_count), take_lists(nodes, node_counts, node_lists))
        };
        self.checked(path, status, AGAIN)?;
        let mut elements = Vec::new();
        for (kind, nodes) in types.into_iter().zip(nodes) {
            let kind = kind_of(kind).ok_or_else(|| {
                Error::input(path.display(), format!("elements of Gmsh's type {kind}"), "mesh it with order 1 or 2")
            })?;
            elements.extend(nodes.chunks_exact(kind.node_count()).map(|n| (kind, n.to_vec())));
        }
        Ok(elements)
    }

    /// An error if the last call failed or Gmsh has logged one.
    fn checked(&self, path: &Path, status: c_int, remedy: &str) -> Result<()> {
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

    fn log(&self) -> Vec<String> {
        let (mut lines, mut count, mut status) = (null_mut(), 0, 0);
        // SAFETY: Gmsh hands out `count` strings.
        unsafe {
            ffi::logger_get(&mut lines, &mut count, &mut status);
            take_strings(lines, count)
        }
    }

    fn last_error(&self) -> String {
        let (mut message, mut status) = (null_mut(), 0);
        // SAFETY: Gmsh hands out a zero-terminated string.
        unsafe {
            ffi::logger_get_last_error(&mut message, &mut status);
            take_string(message)
        }
    }

    /// The names of the variables of the `.geo`.
    fn parameter_names(&self) -> Vec<String> {
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

/// The cell kind of a Gmsh element type.
fn kind_of(element: c_int) -> Option<CellKind> {
    Some(match element {
        15 => CellKind::Point1,
        1 => CellKind::Line2,
        8 => CellKind::Line3,
        2 => CellKind::T3,
        9 => CellKind::T6,
        3 => CellKind::Q4,
        16 => CellKind::Q8,
        10 => CellKind::Q9,
        _ => return None,
    })
}

/// Puts the middle nodes of straight edges and cells exactly in the middle, from which Gmsh's own are off by
/// some 1e-13 of the length: so straight cells are recognised as straight.
fn straighten(cells: &[(CellKind, u16, Vec<usize>)], number: &BTreeMap<usize, u32>, x: &mut [[f64; 2]]) {
    let snap = |x: &mut [[f64; 2]], middle: u32, around: &[u32]| {
        let mean = [0, 1].map(|d| around.iter().map(|&n| x[n as usize][d]).sum::<f64>() / around.len() as f64);
        let [a, b] = [around[0], around[around.len() / 2]].map(|n| x[n as usize]);
        let size = (b[0] - a[0]).hypot(b[1] - a[1]);
        let y = &mut x[middle as usize];
        if (y[0] - mean[0]).hypot(y[1] - mean[1]) <= 1e-10 * size {
            *y = mean;
        }
    };
    for (kind, _, tags) in cells {
        let node = |i: usize| number[&tags[i]];
        for facet in kind.facets().1 {
            if let [a, b, middle] = **facet {
                snap(x, node(middle), &[node(a), node(b)]);
            }
        }
        if *kind == CellKind::Q9 {
            snap(x, node(8), &[0, 1, 2, 3].map(node));
        }
    }
}

/// Turns a clockwise cell round; its corners decide.
fn turn_counter_clockwise(kind: CellKind, x: &[[f64; 2]], nodes: &mut [u32]) {
    let corners = kind.corner_count();
    let corner = |i: usize| x[nodes[i % corners] as usize];
    let doubled: f64 = (0..corners).map(|i| corner(i)[0] * corner(i + 1)[1] - corner(i + 1)[0] * corner(i)[1]).sum();
    if doubled < 0.0 {
        nodes[1..corners].reverse();
        if kind.order() == 2 {
            // The mid-side after corner i is that before it in the other sense.
            nodes[corners..2 * corners].reverse();
        }
    }
}

/// Every surface must be in exactly one physical surface.
fn check_surfaces(session: &Session, path: &Path) -> Result<()> {
    let groups = session.physical_groups(2)?;
    if groups.is_empty() {
        return Err(Error::input(
            path.display(),
            "it has no physical surface",
            "name the regions: Physical Surface(\"soil\") = {1};",
        ));
    }
    for surface in session.entities(2) {
        let mut holders = groups.iter().filter(|g| g.entities.contains(&surface));
        let place = || format!("{}, surface {surface}", path.display());
        match (holders.next(), holders.next()) {
            (None, _) => {
                return Err(Error::input(place(), "it is in no physical surface", "add it to one, or delete it"));
            }
            (Some(a), Some(b)) => {
                let problem = format!("it is in two physical surfaces, {} and {}", a.name, b.name);
                return Err(Error::input(place(), problem, "leave it in one: they are the regions of the case"));
            }
            _ => (),
        }
    }
    Ok(())
}

/// Every parameter must have been taken up by a `DefineConstant` of the file.
fn check_parameters(session: &Session, geo: &Path, text: &str, parameters: &[(String, f64)]) -> Result<()> {
    if parameters.is_empty() {
        return Ok(());
    }
    let declared = declared(text);
    for (name, value) in parameters {
        // An included file may declare it too; a plain assignment after it would have changed the value.
        let used = declared.contains(name) || session.parameter_names().contains(name) && text.contains("Include");
        if used && session.parameter(name)? == Some(*value) {
            continue;
        }
        let remedy = match declared.is_empty() {
            true => format!("declare it: DefineConstant[ {name} = {{1, Name \"Parameters/{name}\"}} ];"),
            false => format!("it declares {}", declared.join(", ")),
        };
        let problem = format!("there is no DefineConstant for the parameter {name}");
        return Err(Error::input(geo.display(), problem, remedy));
    }
    Ok(())
}

/// The names declared in the `DefineConstant[ a = …, b = {…, …} ]` of a `.geo`, in order.
fn declared(text: &str) -> Vec<String> {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    let text = lines.collect::<Vec<_>>().join("\n");
    let mut names: Vec<String> = Vec::new();
    for block in text.split("DefineConstant").skip(1) {
        let Some(body) = block.trim_start().strip_prefix('[') else { continue };
        let (mut depth, mut quoted, mut name, mut in_name) = (0usize, false, String::new(), true);
        for c in body.chars() {
            match c {
                '"' => quoted = !quoted,
                _ if quoted => (),
                '{' | '(' | '[' => depth += 1,
                ']' if depth == 0 => break,
                '}' | ')' | ']' => depth = depth.saturating_sub(1),
                ',' if depth == 0 => {
                    names.push(std::mem::take(&mut name));
                    in_name = true;
                }
                '=' if depth == 0 => in_name = false,
                _ if in_name && !c.is_whitespace() => name.push(c),
                _ => (),
            }
        }
        names.push(name);
    }
    names.retain(|name| !name.is_empty());
    names
}

fn check_readable(path: &Path) -> Result<()> {
    match fs::File::open(path).and_then(|f| f.metadata()) {
        Ok(metadata) if metadata.is_file() => Ok(()),
        Ok(_) => Err(Error::input(path.display(), "it is a folder", "name a file")),
        Err(error) => Err(Error::input(path.display(), error, "check the path")),
    }
}

/// The sections an MSH file can end with.
const LAST_SECTIONS: [&str; 8] = [
    "Elements",
    "Periodic",
    "GhostElements",
    "Parametrizations",
    "NodeData",
    "ElementData",
    "ElementNodeData",
    "InterpolationScheme",
];

/// A mesh file that was cut short does not end with the end of a section.
fn check_complete(path: &Path) -> Result<()> {
    let tail = || -> std::io::Result<Vec<u8>> {
        let mut file = fs::File::open(path)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(64)))?;
        let mut tail = Vec::new();
        file.read_to_end(&mut tail)?;
        Ok(tail)
    };
    let tail = tail().map_err(|error| Error::input(path.display(), error, AGAIN))?;
    let tail = String::from_utf8_lossy(&tail);
    let last = tail.trim_end().lines().last().and_then(|line| line.trim().strip_prefix("$End")).unwrap_or_default();
    if LAST_SECTIONS.contains(&last) {
        Ok(())
    } else {
        Err(Error::input(path.display(), "it is cut short or no MSH file", AGAIN))
    }
}

/// The mesh must lie in the plane z = 0, with finite coordinates.
fn check_plane<'a>(path: &Path, nodes: impl Iterator<Item = &'a [f64; 3]> + Clone) -> Result<()> {
    let size = nodes.clone().fold(0.0f64, |size, x| size.max(x[0].abs()).max(x[1].abs()));
    for x in nodes {
        if !x.iter().all(|v| v.is_finite()) || x[2].abs() > 1e-9 * size {
            let place = format!("{}, node at ({}, {}, {})", path.display(), x[0], x[1], x[2]);
            return Err(Error::input(place, "it is not in the plane z = 0", "draw the section in the x–y plane, y up"));
        }
    }
    Ok(())
}

fn doubled(path: &Path, kind: &str, name: &str) -> Error {
    Error::input(path.display(), format!("the physical {kind} have the name {name} twice"), "give each its own name")
}

fn c_string(text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::input(format!("{text:?}"), "it contains a zero byte", "take it out"))
}

fn c_path(path: &Path) -> Result<CString> {
    c_string(&absolute(path).to_string_lossy())
}

/// Gmsh gets absolute paths: it reads a leading dash and a relative include in its own way.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
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
