//! Unstructured grids (`.vtu`) and polylines (`.vtp`) in VTK's XML format, every number bit-exact.
//!
//! Format: VTK file formats, "XML file formats", version 1.0 with 64-bit headers. Two encodings: appended data
//! compressed with LZ4, and base64 within the elements, which every reader understands (meshio, vtkio).

use std::io::{self, Write};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::atomic;
use super::container::{self, Data, Scalar, with_values};
use crate::error::Result;
use crate::mesh::shape::CellKind;
use crate::mesh::{Cells, Mesh};

/// How the numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Appended, compressed with LZ4.
    Lz4,
    /// In the elements, in base64.
    Plain,
}

/// Bytes of a block of [`Encoding::Lz4`] before compression.
const BLOCK: usize = 1 << 18;

/// An array with a value at each point or cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, with its unit in brackets.
    pub name: String,
    pub components: usize,
    pub data: Data,
}

impl Array {
    pub fn new(name: &str, unit: &str, components: usize, values: Vec<f64>) -> Self {
        Self { name: format!("{name} [{unit}]"), components, data: Data::F64(values) }
    }
}

impl From<container::Array> for Array {
    fn from(array: container::Array) -> Self {
        let container::Array { name, unit, components, data } = array;
        Self { name: if unit.is_empty() { name } else { format!("{name} [{unit}]") }, components, data }
    }
}

/// What a `.vtu` shows, or a `.vtp` if all of its cells are polylines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Coordinates of the points in m, three each.
    pub points: Vec<f64>,
    pub topology: Topology,
    pub point_data: Vec<Array>,
    pub cell_data: Vec<Array>,
    /// Time in s that ParaView shows.
    pub time: Option<f64>,
    /// A comment at the start of the file: what it was made from; empty for none.
    pub note: String,
}

/// Cells in VTK's flat form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    pub connectivity: Vec<i64>,
    /// The end of each cell in `connectivity`.
    pub offsets: Vec<i64>,
    pub types: Vec<u8>,
}

impl Topology {
    /// One vertex a point.
    pub fn vertices(count: usize) -> Self {
        let count = count as i64;
        Self { connectivity: (0..count).collect(), offsets: (1..=count).collect(), types: vec![1; count as usize] }
    }

    /// The cells of a mesh.
    pub fn of_mesh<const D: usize>(mesh: &Mesh<D>) -> Self {
        let Cells { kind, offset, nodes, .. } = &mesh.cells;
        let mut connectivity: Vec<i64> = nodes.iter().map(|&n| i64::from(n)).collect();
        for (c, order) in kind.iter().enumerate().filter_map(|(c, &kind)| Some((c, vtk_order(kind)?))) {
            let (own, first) = (mesh.cells.nodes(c), offset[c] as usize);
            for (to, &i) in connectivity[first..].iter_mut().zip(order) {
                *to = i64::from(own[i]);
            }
        }
        Self {
            connectivity,
            offsets: offset[1..].iter().map(|&o| i64::from(o)).collect(),
            types: kind.iter().map(|&k| vtk_type(k)).collect(),
        }
    }
}

/// VTK's number of a kind of cell (`vtkCellType.h`).
fn vtk_type(kind: CellKind) -> u8 {
    match kind {
        CellKind::Point1 => 1,
        CellKind::Line2 => 3,
        CellKind::Line3 => 21,
        CellKind::Line4 => 35,
        CellKind::T3 => 5,
        CellKind::T6 => 22,
        CellKind::Q4 => 9,
        CellKind::Q8 => 23,
        CellKind::Q9 => 28,
        CellKind::Q16 => 70,
        CellKind::T10 => 24,
        CellKind::H27 => 29,
    }
}

/// The nodes of a kind in the order of VTK (`vtkQuadraticTetra.h`, `vtkTriQuadraticHexahedron.h`; `vtkLagrangeQuadrilateral.h`, where
/// nodes on opposite sides run alike and those within row by row) where that is not Gmsh's.
pub fn vtk_order(kind: CellKind) -> Option<&'static [usize]> {
    match kind {
        CellKind::Q16 => Some(&[0, 1, 2, 3, 4, 5, 6, 7, 9, 8, 11, 10, 12, 13, 15, 14]),
        CellKind::T10 => Some(&[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
        CellKind::H27 => {
            Some(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26])
        }
        _ => None,
    }
}

/// Writes `grid` to `path`, atomically.
///
/// # Errors
/// `Machine` when it cannot be written.
pub fn write(path: &Path, grid: &Grid, encoding: Encoding) -> Result<()> {
    atomic::write(path, |out| write_to(out, grid, encoding))
}

/// Writes the polylines of `grid` to `path`, atomically.
///
/// # Errors
/// `Machine` when they cannot be written.
pub fn write_lines(path: &Path, grid: &Grid, encoding: Encoding) -> Result<()> {
    atomic::write(path, |out| write_as(out, "PolyData", grid, encoding))
}

/// Writes the XML of `grid`.
///
/// # Errors
/// Those of `out`.
pub fn write_to(out: &mut dyn Write, grid: &Grid, encoding: Encoding) -> io::Result<()> {
    write_as(out, "UnstructuredGrid", grid, encoding)
}

/// Writes the XML of `grid` as a data set of a `kind`.
fn write_as(out: &mut dyn Write, kind: &str, grid: &Grid, encoding: Encoding) -> io::Result<()> {
    let lines = kind == "PolyData";
    let compressor = if encoding == Encoding::Lz4 { " compressor=\"vtkLZ4DataCompressor\"" } else { "" };
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    comment(out, &grid.note)?;
    writeln!(
        out,
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{compressor}>"
    )?;
    writeln!(out, "<{kind}>")?;
    if let Some(time) = grid.time {
        writeln!(
            out,
            "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{time:?}\
             </DataArray>\n</FieldData>"
        )?;
    }
    let (points, cells) = (grid.points.len() / 3, grid.topology.types.len());
    let of = if lines { "Lines" } else { "Cells" };
    writeln!(out, "<Piece NumberOfPoints=\"{points}\" NumberOf{of}=\"{cells}\">")?;
    let mut arrays = Arrays { out, encoding, appended: Vec::new() };
    for (section, data) in [("PointData", &grid.point_data), ("CellData", &grid.cell_data)] {
        writeln!(arrays.out, "<{section}>")?;
        for a in data {
            with_values!(&a.data, values => arrays.numbers(&a.name, a.components, values))?;
        }
        writeln!(arrays.out, "</{section}>")?;
    }
    writeln!(arrays.out, "<Points>")?;
    arrays.numbers("Points", 3, &grid.points)?;
    writeln!(arrays.out, "</Points>\n<{of}>")?;
    arrays.numbers("connectivity", 1, &grid.topology.connectivity)?;
    arrays.numbers("offsets", 1, &grid.topology.offsets)?;
    if !lines {
        arrays.numbers("types", 1, &grid.topology.types)?;
    }
    writeln!(arrays.out, "</{of}>\n</Piece>\n</{kind}>")?;
    let Arrays { out, appended, .. } = arrays;
    if encoding == Encoding::Lz4 {
        out.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        out.write_all(&appended)?;
        out.write_all(b"\n</AppendedData>\n")?;
    }
    writeln!(out, "</VTKFile>")
}

/// Writes `note` as a comment, in which two hyphens may not stand; nothing for an empty one.
///
/// # Errors
/// Those of `out`.
pub fn comment(out: &mut dyn Write, note: &str) -> io::Result<()> {
    if note.is_empty() { Ok(()) } else { writeln!(out, "<!-- {} -->", note.replace("--", "- -")) }
}

struct Arrays<'a> {
    out: &'a mut dyn Write,
    encoding: Encoding,
    /// What follows the elements.
    appended: Vec<u8>,
}

impl Arrays<'_> {
    fn numbers<T: Scalar>(&mut self, name: &str, components: usize, values: &[T]) -> io::Result<()> {
        let mut bytes = vec![0; 8 + values.len() * T::SIZE];
        let length = (bytes.len() - 8) as u64;
        length.store(&mut bytes[..8]);
        for (bytes, v) in bytes[8..].chunks_exact_mut(T::SIZE).zip(values) {
            v.store(bytes);
        }
        let scalar = vtk_scalar(T::NAME);
        write!(self.out, "<DataArray type=\"{scalar}\" Name=\"{}\"", escaped(name))?;
        // meshio makes a column of what is said to have one component.
        if components > 1 {
            write!(self.out, " NumberOfComponents=\"{components}\"")?;
        }
        for (i, component) in component_names(components).iter().enumerate() {
            write!(self.out, " ComponentName{i}=\"{component}\"")?;
        }
        match self.encoding {
            Encoding::Plain => {
                writeln!(self.out, " format=\"binary\">{}</DataArray>", STANDARD.encode(&bytes))
            }
            Encoding::Lz4 => {
                let offset = self.appended.len();
                compress(&bytes[8..], &mut self.appended);
                writeln!(self.out, " format=\"appended\" offset=\"{offset}\"/>")
            }
        }
    }
}

/// Appends the blocks of an array: their number, the length of a block and of the last one if it is shorter,
/// their lengths when compressed, and the blocks themselves.
fn compress(bytes: &[u8], out: &mut Vec<u8>) {
    let blocks: Vec<_> = bytes.chunks(BLOCK).map(lz4_flex::block::compress).collect();
    for number in [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len)) {
        out.extend_from_slice(&(number as u64).to_le_bytes());
    }
    for block in blocks {
        out.extend(block);
    }
}

fn vtk_scalar(name: &str) -> &'static str {
    match name {
        "f64" => "Float64",
        "u64" => "UInt64",
        "i64" => "Int64",
        "u32" => "UInt32",
        "u16" => "UInt16",
        _ => "UInt8",
    }
}

/// What ParaView calls the components: of a vector, a symmetric tensor, a full tensor by rows.
fn component_names(components: usize) -> &'static [&'static str] {
    match components {
        3 => &["X", "Y", "Z"],
        6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
        9 => &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
        _ => &[],
    }
}

/// The name as an attribute of an element.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
