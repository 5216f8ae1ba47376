//! The series of the surface of the material: closed polylines with what acts on them.

use super::super::frame::{Column, LINE, Part};
use super::super::vtu::{Array, Grid, Topology};

/// VTK's number of a line through many points (`vtkCellType.h`).
const VTK_POLY_LINE: u8 = 4;

/// The loops, a polyline each that ends where it begins. `None` where the part has not the column that tells them.
pub fn lines(part: &Part, time: Option<f64>) -> Option<Grid> {
    let mut topology = Topology::default();
    if !part.position.is_empty() {
        let line = part.numbers(LINE, 1)?;
        let mut begin = 0;
        for loop_of in line.chunk_by(|a, b| a == b) {
            let end = begin + loop_of.len() as i64;
            topology.connectivity.extend((begin..end).chain([begin]));
            topology.offsets.push(topology.connectivity.len() as i64);
            topology.types.push(VTK_POLY_LINE);
            begin = end;
        }
    }
    let array = |c: &Column| Array::new(&c.name, &c.unit, c.components, c.values.clone());
    let shown = part.columns.iter().filter(|c| c.name != LINE);
    Some(Grid {
        points: part.position.concat(),
        topology,
        point_data: shown.map(array).collect(),
        cell_data: Vec::new(),
        time,
        note: String::new(),
    })
}
