//! Meshes from Gmsh: a `.geo` to an MSH 4.1 file, and such a file to a [`Mesh`].
//!
//! The program runs Gmsh in a process of its own, a [`Worker`], behind a filter of the `.geo` ([`sources`]) and with the
//! rights that the kernel can take from it. [`generate`] and [`groups`] are what that process does.
//!
//! Gmsh keeps one global model and is not safe to share among threads: a `Session` holds a lock, starts Gmsh afresh and
//! ends it when dropped. Gmsh prints nothing; what it has to say comes back in errors, with its own file and line.

mod check;
mod estimate;
mod sandbox;
mod script;
mod session;
mod worker;

pub use script::{Sources, sources};
pub use worker::{COMMAND, Worker, serve};

use super::shape::CellKind;
use super::{Cells, Group, Mesh};
use crate::error::{Error, Result};
use check::{check_complete, check_parameters, check_plane, check_readable, check_surfaces, doubled};
use serde::{Deserialize, Serialize};
use session::Session;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const AGAIN: &str = "make the file again with `mpm mesh`";

/// What the case decides about the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
/// `DefineConstant` declares; a surface in no physical surface or in two; an order other than 1 and 2; a mesh size below
/// the tolerance of the geometry.
/// Machine: `out` cannot be written.
pub fn generate(geo: &Path, options: &Options, out: &Path) -> Result<()> {
    generate_when(geo, options, out, u64::MAX, &mut |_| Ok(true))
}

/// As [`generate`], once `agree` to the names of the groups, for an analysis that may take `memory` (bytes).
fn generate_when(
    geo: &Path,
    options: &Options,
    out: &Path,
    memory: u64,
    agree: &mut dyn FnMut(Groups) -> Result<bool>,
) -> Result<()> {
    if !matches!(options.order, 1 | 2) {
        return Err(Error::input(geo.display(), format!("order {} is not possible", options.order), "use 1 or 2"));
    }
    let session = open(geo, options)?;
    if !agree(names(&session))? {
        return Ok(());
    }
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
    estimate::check_sizes(&session, geo)?;
    session.mesh(geo, 1)?;
    estimate::check_cells(geo, estimate::cells(&session, geo)?, memory)?;
    session.mesh(geo, 2)?;
    estimate::check_cells(geo, session.cell_count() as f64, memory)?;
    session.set_order(geo, options.order)?;
    session.write(out)
}

/// The names of the physical groups of a `.geo`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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
    Ok(names(&open(geo, options)?))
}

fn names(session: &Session) -> Groups {
    let names = |dimension| session.physical_groups(dimension).into_iter().map(|group| group.name).collect();
    Groups { surfaces: names(2), curves: names(1), points: names(0) }
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
    for physical in session.physical_groups(2) {
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
        for physical in session.physical_groups(dimension) {
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
