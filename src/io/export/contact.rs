//! The series of contact: lines along the boundaries of structures with what they and the soil exert on each other.

use super::super::container::Data;
use super::super::frame::{Column, FACES, GAP, LINE, Part, REGION};
use super::super::vtu::{Array, Grid, Topology};

/// VTK's number of a line between two points (`vtkCellType.h`).
const VTK_LINE: u8 = 3;

/// The lines, a cell from each node to the next on its line; a gap that is not known is not a number. `None` where
/// the part has not the columns that tell the lines.
pub fn grid(part: &Part, time: Option<f64>) -> Option<Grid> {
    let (line, region, faces) = (part.numbers(LINE, 1)?, part.numbers(REGION, 1)?, part.numbers(FACES, 1)?);
    let mut topology = Topology::default();
    let mut regions = Vec::new();
    for (i, _) in line.windows(2).enumerate().filter(|(_, pair)| pair[0] == pair[1]) {
        topology.connectivity.extend([i as i64, i as i64 + 1]);
        topology.offsets.push(topology.connectivity.len() as i64);
        topology.types.push(VTK_LINE);
        regions.push(region[i] as u16);
    }
    let shown = |c: &&Column| ![LINE, REGION, FACES].contains(&c.name.as_str());
    let array = |c: &Column| {
        let of_gap = c.name == GAP;
        let known = |(i, &value): (usize, &f64)| if of_gap && faces[i] == 0.0 { f64::NAN } else { value };
        Array::new(&c.name, &c.unit, c.components, c.values.iter().enumerate().map(known).collect())
    };
    Some(Grid {
        points: part.position.concat(),
        topology,
        point_data: part.columns.iter().filter(shown).map(array).collect(),
        cell_data: vec![Array { name: "region [-]".to_string(), components: 1, data: Data::U16(regions) }],
        time,
        note: String::new(),
    })
}
