//! Reads meshes: MSH 4.1 of Gmsh, as text or binary, which is read as data and never by Gmsh, whose own reader takes
//! a file without the header of a mesh for a script.
//!
//! Read are the sections MeshFormat, PhysicalNames, Entities, Nodes and Elements (Gmsh reference manual, *MSH file
//! format*); others are passed. The crate `mshio` (0.4.2) is not used: it leaves out PhysicalNames, asks for memory by
//! the counts that a file states, and panics on sizes of numbers that it does not know.
//!
//! The *seal* is a `$Comments` section at the end with the XXH64 of all before it. It tells accidents, not
//! forgeries.

mod sections;
mod source;

use super::shape::CellKind;
use super::{Cells, Group, Mesh};
use crate::error::{Error, Result};
use crate::geometry::box_around;
use crate::reading;
use sections::{Block, Nodes, Sections};
use source::{AGAIN, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use twox_hash::XxHash64;

/// The words before the number of the seal.
const SEAL: [&str; 2] = ["mpm mesh", "xxh64="];

/// Reads a plane mesh with its named groups from an MSH 4.1 file.
///
/// Cells come in the order of their physical surfaces' numbers, nodes in that of theirs; nodes of no cell are left
/// out, clockwise cells are turned round, a group without a name is called by its number.
///
/// # Errors
/// Input: a file that is missing, cut short, of another format, changed after it was sealed, or without physical
/// surfaces; cells that are not T3, T6, Q4, Q8, Q9 or Q16, of mixed order, in two physical surfaces, or outside the x–y
/// plane; groups that are empty or that no cell touches. Machine: one that cannot be read.
pub fn read(path: &Path) -> Result<Mesh<2>> {
    let place = path.display().to_string();
    parse(&reading::bytes(path).map_err(|error| Error::input(&place, error, "check the path"))?, &place)
}

/// As [`read`], from the bytes of the file called `place`.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], place: &str) -> Result<Mesh<2>> {
    assemble(sections(bytes, place)?, place)
}

/// Seals the mesh file at `path`, which is complete: [`read`] then refuses it when it was changed.
///
/// # Errors
/// When it cannot be read or written.
pub fn seal(path: &Path) -> io::Result<()> {
    let mut bytes = unsealed(reading::bytes(path)?);
    bytes.extend(format!("$Comments\n{}\n$EndComments\n", sealed(&bytes)).into_bytes());
    let mut file = fs::File::create(path)?;
    file.write_all(&bytes)?;
    file.sync_all()
}

/// The bytes of a file without the seals in them: a mesh that is given may be that of a stage, and Gmsh copies them when it saves such a file.
pub fn unsealed(bytes: Vec<u8>) -> Vec<u8> {
    const END: &[u8] = b"$EndComments";
    let find =
        |from: usize, text: &[u8]| bytes[from..].windows(text.len()).position(|part| part == text).map(|at| from + at);
    let (mut kept, mut from) = (Vec::with_capacity(bytes.len()), 0);
    while let Some(start) = find(from, b"$Comments") {
        let Some(end) = find(start, END).map(|at| at + END.len()) else { break };
        kept.extend(&bytes[from..if is_seal(&bytes[start..end]) { start } else { end }]);
        from = end;
    }
    kept.extend(&bytes[from..]);
    kept
}

/// Whether a file is of the version that [`read`] reads, as far as its first section tells.
pub fn is_of_version(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|&c| c == b'\n').map(<[u8]>::trim_ascii);
    lines.any(|line| line == b"$MeshFormat") && lines.next().is_some_and(|format| format.starts_with(b"4.1 "))
}

/// The seal of all that stands before it.
fn sealed(before: &[u8]) -> String {
    format!("{} {}{:016x}", SEAL[0], SEAL[1], XxHash64::oneshot(0, before))
}

/// Whether a comment is a seal. Half of its words are enough: a damaged one is not to pass for a comment.
fn is_seal(comment: &[u8]) -> bool {
    SEAL.iter().any(|word| comment.windows(word.len()).any(|text| text == word.as_bytes()))
}

/// Reads the sections of a file.
fn sections(bytes: &[u8], place: &str) -> Result<Sections> {
    let mut source = Source::new(bytes, place);
    let mut found: Vec<&str> = Vec::new();
    let mut read = Sections { length: bytes.len(), ..Sections::default() };
    while let Some((name, start)) = source.open().map_err(|error| match found.is_empty() {
        true => no_mesh(place),
        false => error,
    })? {
        if found.is_empty() && !matches!(name, "MeshFormat" | "Comments") {
            return Err(no_mesh(place));
        }
        if found.contains(&name) {
            return Err(source.wrong(format!("${name} is there twice")));
        }
        match name {
            "MeshFormat" => source.format()?,
            "PhysicalNames" => read.names = sections::names(&mut source)?,
            "Entities" => read.entities = sections::entities(&mut source)?,
            "Nodes" => read.nodes = sections::nodes(&mut source)?,
            "Elements" if !found.contains(&"Nodes") => return Err(source.wrong("$Elements comes before $Nodes")),
            "Elements" => read.blocks = sections::elements(&mut source, &read.nodes)?,
            _ => {
                let heart = source.skip()?.trim_ascii();
                if name == "Comments"
                    && is_seal(heart)
                    && (heart != sealed(&bytes[..start]).as_bytes() || source.open()?.is_some())
                {
                    return Err(Error::input(place, "it was changed after it was written", AGAIN));
                }
                continue;
            }
        }
        source.close()?;
        found.push(name);
    }
    match ["MeshFormat", "Nodes", "Elements"].into_iter().find(|name| !found.contains(name)) {
        Some("MeshFormat") => Err(no_mesh(place)),
        Some(missing) => Err(Error::input(place, format!("it is cut short: it has no section ${missing}"), AGAIN)),
        None => Ok(read),
    }
}

/// The error for a file that is none, an empty one or a script for Gmsh.
fn no_mesh(place: &str) -> Error {
    Error::input(place, "it is no mesh file: its first line is not $MeshFormat", AGAIN)
}

/// A physical group: its name and the tags of its entities, ascending.
struct Physical {
    name: String,
    entities: Vec<i32>,
}

/// The physical groups of a dimension, by their numbers.
fn physical_groups(read: &Sections, dimension: usize, place: &str) -> Result<Vec<Physical>> {
    let mut groups: BTreeMap<u32, Vec<i32>> = BTreeMap::new();
    for (&entity, numbers) in &read.entities[dimension] {
        for &number in numbers {
            groups.entry(number).or_default().push(entity);
        }
    }
    let mut named: Vec<Physical> = Vec::with_capacity(groups.len());
    let mut names = BTreeSet::new();
    for (number, entities) in groups {
        let name = read.names.get(&(dimension, number)).filter(|name| !name.is_empty());
        let name = name.cloned().unwrap_or_else(|| number.to_string());
        if !names.insert(name.clone()) {
            let kind = ["points", "curves", "surfaces"][dimension];
            let problem = format!("the physical {kind} have the name {name} twice");
            return Err(Error::input(place, problem, "give each its own name"));
        }
        named.push(Physical { name, entities });
    }
    Ok(named)
}

/// Makes the mesh of what a file holds.
fn assemble(read: Sections, place: &str) -> Result<Mesh<2>> {
    let blocks = Blocks::of(&read, place)?;
    let regions = physical_groups(&read, 2, place)?;
    check_surfaces(&read, &regions, place)?;
    u16::try_from(regions.len().saturating_sub(1))
        .map_err(|_| Error::input(place, "more than 65536 physical surfaces", "join some of them"))?;
    let mut cells: Vec<(CellKind, u16, &[u32])> = Vec::new();
    for (region, physical) in regions.iter().enumerate() {
        let before = cells.len();
        for block in physical.entities.iter().flat_map(|&entity| blocks.of_entity(2, entity)) {
            cells.extend(block.nodes.chunks_exact(block.kind.node_count()).map(|n| (block.kind, region as u16, n)));
        }
        if cells.len() == before {
            return Err(Error::input(place, format!("its physical surface {} has no cells", physical.name), AGAIN));
        }
    }
    let order = cells[0].0.order();
    if let Some(other) = cells.iter().find(|c| c.0.order() != order) {
        let problem = format!("{:?} and {:?} cells in one mesh", cells[0].0, other.0);
        return Err(Error::input(place, problem, "use one order"));
    }
    let mut mesh = Mesh {
        nodes: Vec::new(),
        cells: Cells::default(),
        regions: regions.into_iter().map(|r| r.name).collect(),
        groups: Vec::new(),
    };
    let number = number_nodes(&cells, &read.nodes, &mut mesh, place)?;
    let mut local = Vec::new();
    for (kind, region, nodes) in cells {
        local.clear();
        local.extend(nodes.iter().map(|&n| number[n as usize]));
        turn_counter_clockwise(kind, &mesh.nodes, &mut local);
        mesh.cells.push(kind, region, &local);
    }
    let mut facets = 0;
    for dimension in [1, 0] {
        for physical in physical_groups(&read, dimension, place)? {
            let place = format!("{place}, physical group {}", physical.name);
            let mut of_group = Vec::new();
            for block in physical.entities.iter().flat_map(|&entity| blocks.of_entity(dimension, entity)) {
                if dimension == 1 && block.kind.order() != order {
                    let problem = format!("it has {:?} elements beside cells of order {order}", block.kind);
                    return Err(Error::input(place, problem, "use one order"));
                }
                // An entity may be in several groups, but not so often that memory grows as the square of the file.
                facets += block.nodes.len();
                if facets > read.length {
                    return Err(Error::input(place, "the same elements are in too many groups", AGAIN));
                }
                for nodes in block.nodes.chunks_exact(block.kind.node_count()) {
                    let nodes: Vec<u32> = nodes.iter().map(|&n| number[n as usize]).collect();
                    if nodes.contains(&UNUSED) {
                        return Err(Error::input(
                            place,
                            "it has nodes that belong to no cell",
                            "embed it in a surface (`Curve{…} In Surface{…};`) or take it out",
                        ));
                    }
                    of_group.push((block.kind, nodes));
                }
            }
            if of_group.is_empty() {
                return Err(Error::input(place, "it has no elements", AGAIN));
            }
            mesh.groups.push(Group::of(physical.name, dimension, of_group));
        }
    }
    Ok(mesh)
}

/// The blocks of elements by entity.
struct Blocks<'a>(BTreeMap<(usize, i32), Vec<&'a Block>>);

impl<'a> Blocks<'a> {
    /// # Errors
    /// Input: elements of an entity that is not there.
    fn of(read: &'a Sections, place: &str) -> Result<Self> {
        let mut blocks: BTreeMap<(usize, i32), Vec<&Block>> = BTreeMap::new();
        for block in &read.blocks {
            let (dimension, entity) = (block.dimension, block.entity);
            if dimension < 2 && !read.entities[dimension].contains_key(&entity) {
                let problem =
                    format!("it has elements of entity {entity} of dimension {dimension}, which is not there");
                return Err(Error::input(place, problem, AGAIN));
            }
            blocks.entry((dimension, entity)).or_default().push(block);
        }
        // Gmsh puts the elements of an entity in the order of their types.
        blocks.values_mut().for_each(|blocks| blocks.sort_by_key(|block| block.number));
        Ok(Self(blocks))
    }

    fn of_entity(&self, dimension: usize, entity: i32) -> impl Iterator<Item = &'a Block> {
        self.0.get(&(dimension, entity)).into_iter().flatten().copied()
    }
}

/// Every surface must be in exactly one physical surface.
///
/// # Errors
/// Input: one in none or in two, or no physical surface at all.
fn check_surfaces(read: &Sections, regions: &[Physical], place: &str) -> Result<()> {
    if regions.is_empty() {
        let remedy = "name the regions in the .geo: Physical Surface(\"soil\") = {1};";
        return Err(Error::input(place, "it has no physical surface", remedy));
    }
    let with_cells = read.blocks.iter().filter(|block| block.dimension == 2).map(|block| (block.entity, &[][..]));
    let of_file = read.entities[2].iter().map(|(&surface, groups)| (surface, &groups[..]));
    for (surface, groups) in of_file.chain(with_cells.filter(|(surface, _)| !read.entities[2].contains_key(surface))) {
        let place = format!("{place}, surface {surface}");
        match groups {
            [_] => (),
            [] => return Err(Error::input(place, "it is in no physical surface", "add it to one, or delete it")),
            [a, b, ..] => {
                let problem = format!("it is in two physical surfaces, {a} and {b}");
                return Err(Error::input(place, problem, "leave it in one: they are the regions of the case"));
            }
        }
    }
    Ok(())
}

/// Marks a node of no cell.
const UNUSED: u32 = u32::MAX;

/// Gives the nodes of the cells their numbers in `mesh`, in the order of their tags.
///
/// # Errors
/// Input: one that is not in the plane z = 0.
fn number_nodes(cells: &[(CellKind, u16, &[u32])], nodes: &Nodes, mesh: &mut Mesh<2>, place: &str) -> Result<Vec<u32>> {
    let mut number = vec![UNUSED; nodes.x.len()];
    let used = cells.iter().flat_map(|c| c.2);
    if u32::try_from(used.clone().count()).is_err() {
        return Err(Error::input(place, "it has too many cells", "use a coarser mesh"));
    }
    used.for_each(|&n| number[n as usize] = 0);
    for (number, x) in number.iter_mut().zip(&nodes.x).filter(|(number, _)| **number != UNUSED) {
        *number = mesh.nodes.len() as u32;
        mesh.nodes.push([x[0], x[1]]);
    }
    let size = mesh.nodes.iter().flatten().fold(0.0f64, |size, v| size.max(v.abs()));
    for ((_, x), tag) in number.iter().zip(&nodes.x).zip(&nodes.tags).filter(|((n, _), _)| **n != UNUSED) {
        if x[2].abs() > 1e-9 * size {
            let place = format!("{place}, node {tag} at ({}, {}, {})", x[0], x[1], x[2]);
            let used = number.iter().zip(&nodes.x).filter(|(number, _)| **number != UNUSED).map(|(_, x)| *x);
            let [problem, remedy] = other_plane(used);
            return Err(Error::input(place, problem, remedy));
        }
    }
    straighten(cells, &number, &mut mesh.nodes);
    Ok(number)
}

/// What is said of a section, with these nodes, that does not lie in z = 0, and how to turn it into that plane.
fn other_plane(nodes: impl Iterator<Item = [f64; 3]>) -> [String; 2] {
    let [low, high] = box_around(nodes).unwrap_or_default();
    let size = (0..3).map(|d| high[d] - low[d]).fold(0.0, f64::max);
    let flat = |d: usize| high[d] - low[d] <= 1e-9 * size;
    let problem = |plane: String| format!("it is not in the plane z = 0: the section lies {plane}");
    let at = |d: usize| low[d];
    if flat(1) {
        let (y, half) = (at(1), 0.5 * at(1));
        let remedy = format!(
            "turn it into x–y, with y up: in a .geo, `Rotate {{{{1, 0, 0}}, {{0, {half}, {half}}}, -Pi/2}} {{ Surface{{:}}; }}` after all that is drawn"
        );
        return [problem(format!("in x–z, at y = {y}")), remedy];
    }
    if flat(0) {
        let first =
            if at(0) == 0.0 { String::new() } else { format!("Translate {{{}, 0, 0}} {{ Surface{{:}}; }} ", -at(0)) };
        let remedy = format!(
            "turn it into x–y, with y up: in a .geo, `{first}Rotate {{{{1, 1, 1}}, {{0, 0, 0}}, -2*Pi/3}} {{ Surface{{:}}; }}` after all that is drawn"
        );
        return [problem(format!("in y–z, at x = {}", at(0))), remedy];
    }
    if flat(2) {
        let remedy =
            format!("move it: in a .geo, `Translate {{0, 0, {}}} {{ Surface{{:}}; }}` after all that is drawn", -at(2));
        return [problem(format!("at z = {}", at(2))), remedy];
    }
    ["it is not in the plane z = 0".into(), "draw the section in the x–y plane, y up".into()]
}

/// Puts the nodes within straight edges and cells exactly at their places, from which Gmsh's own are off by
/// some 1e-13 of the length: so straight cells are recognised as straight.
fn straighten(cells: &[(CellKind, u16, &[u32])], number: &[u32], x: &mut [[f64; 2]]) {
    let put = |x: &mut [[f64; 2]], node: u32, place: [f64; 2], [a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|n| x[n as usize]);
        let size = (b[0] - a[0]).hypot(b[1] - a[1]);
        let y = &mut x[node as usize];
        if (y[0] - place[0]).hypot(y[1] - place[1]) <= 1e-10 * size {
            *y = place;
        }
    };
    let snap = |x: &mut [[f64; 2]], middle: u32, around: &[u32]| {
        let mean = [0, 1].map(|d| around.iter().map(|&n| x[n as usize][d]).sum::<f64>() / around.len() as f64);
        put(x, middle, mean, [around[0], around[around.len() / 2]]);
    };
    // A third on from the first of two nodes, or from the first of four corners towards the others.
    let thirds = |x: &mut [[f64; 2]], node: u32, from: &[u32]| {
        let at = |n: u32, d: usize| x[n as usize][d];
        let place = [0, 1].map(|d| match *from {
            [a, b] => (2.0 * at(a, d) + at(b, d)) / 3.0,
            [a, b, c, e] => (4.0 * at(a, d) + 2.0 * (at(b, d) + at(e, d)) + at(c, d)) / 9.0,
            _ => f64::NAN,
        });
        put(x, node, place, [from[0], from[from.len() / 2]]);
    };
    for (kind, _, nodes) in cells {
        let node = |i: usize| number[nodes[i] as usize];
        for facet in kind.facets().1 {
            match **facet {
                [a, b, middle] => snap(x, node(middle), &[node(a), node(b)]),
                [a, b, first, second] => {
                    thirds(x, node(first), &[node(a), node(b)]);
                    thirds(x, node(second), &[node(b), node(a)]);
                }
                _ => {}
            }
        }
        if *kind == CellKind::Q9 {
            snap(x, node(8), &[0, 1, 2, 3].map(node));
        }
        if *kind == CellKind::Q16 {
            (0..4).for_each(|i| thirds(x, node(12 + i), &[0, 1, 2, 3].map(|k| node((i + k) % 4))));
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
        // The nodes of the side after corner i are those before it in the other sense.
        let of_sides = corners * kind.order();
        nodes[corners..of_sides].reverse();
        if kind == CellKind::Q16 {
            nodes[of_sides + 1..].reverse();
        }
    }
}
