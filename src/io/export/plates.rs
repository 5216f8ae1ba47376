//! The series of plates: their axes as lines, with the forces in their sections.

use super::super::container::Data;
use super::super::frame::{CELL, Info, Part};
use super::super::table::guarded;
use super::super::vtu::{Array, Grid, Topology};
use crate::mesh::Mesh;
use crate::mesh::sections::{Element, Section, sections};
use std::collections::HashMap;

/// VTK's number of a line between two points (`vtkCellType.h`).
const VTK_LINE: u8 = 3;

/// The heading of the table of sections.
pub const HEADING: &str =
    "time [s],phase,plate,along [m],x [m],y [m],ux [m],uy [m],N [kN/m],Q [kN/m],M [kN m/m],hoop [kN/m]";

/// A plate: the numbers of its elements among the finite elements, and their nodes.
pub struct Plate {
    region: u16,
    pub name: String,
    elements: Vec<(usize, [usize; 8])>,
}

/// The plates in the finite elements of a mesh, given the numbers of their regions and their names.
pub fn plates(elements: &Mesh<2>, named: &[(u16, String)]) -> Vec<Plate> {
    let of = |(region, name): &(u16, String)| {
        let own = (0..elements.cells.len()).filter(|&c| elements.cells.region[c] == *region);
        let nodes = |c: usize| Some((c, <[u32; 8]>::try_from(elements.cells.nodes(c)).ok()?.map(|n| n as usize)));
        Plate { region: *region, name: name.clone(), elements: own.filter_map(nodes).collect() }
    };
    named.iter().map(of).collect()
}

/// The sections of each plate, given the places of the nodes (m) as drawn, where displacements are counted from, and now, and what is known at the
/// points of the finite elements; `None` where that has no stress.
pub fn of_frame(
    plates: &[Plate],
    [drawn, from, now]: [&[[f64; 3]]; 3],
    points: &Part,
    axisymmetric: bool,
) -> Option<Vec<Vec<Section>>> {
    let (cell, stress) = (points.numbers(CELL, 1)?, points.numbers("stress", 6)?);
    let mut members: HashMap<usize, Vec<usize>> = HashMap::new();
    cell.iter().enumerate().for_each(|(p, &cell)| members.entry(cell as usize).or_default().push(p));
    let element = |(number, nodes): &(usize, [usize; 8])| {
        let own: [usize; 4] = members.get(number)?.as_slice().try_into().ok()?;
        let places = |of: &[[f64; 3]]| nodes.map(|n| [of[n][0], of[n][1]]);
        let stress = own.map(|p| std::array::from_fn(|k| stress[6 * p + k]));
        Some(Element { drawn: places(drawn), from: places(from), now: places(now), stress })
    };
    let of_plate = |plate: &Plate| {
        let elements: Vec<Element> = plate.elements.iter().map(element).collect::<Option<_>>()?;
        Some(sections(elements.into_iter(), axisymmetric))
    };
    plates.iter().map(of_plate).collect()
}

/// The axes as lines, an element each, with the forces in the sections at both of its ends.
pub fn grid(plates: &[Plate], found: &[Vec<Section>], time: Option<f64>) -> Grid {
    let mut topology = Topology::default();
    let mut regions = Vec::new();
    for (plate, sections) in plates.iter().zip(found) {
        for _ in sections.chunks(2) {
            let first = topology.connectivity.len() as i64;
            topology.connectivity.extend([first, first + 1]);
            topology.offsets.push(first + 2);
            topology.types.push(VTK_LINE);
            regions.push(plate.region);
        }
    }
    let all = || found.iter().flatten();
    let field = |name: &str, unit: &str, of: fn(&Section) -> f64| Array::new(name, unit, 1, all().map(of).collect());
    Grid {
        points: all().flat_map(|s| [s.position[0], s.position[1], 0.0]).collect(),
        topology,
        point_data: vec![
            Array::new(
                "displacement",
                "m",
                3,
                all().flat_map(|s| [s.displacement[0], s.displacement[1], 0.0]).collect(),
            ),
            field("along", "m", |s| s.along),
            field("normal_force", "kN/m", |s| s.forces.normal),
            field("shear_force", "kN/m", |s| s.forces.shear),
            field("bending_moment", "kN m/m", |s| s.forces.moment),
            field("hoop_force", "kN/m", |s| s.forces.hoop),
        ],
        cell_data: vec![Array { name: "region [-]".to_string(), components: 1, data: Data::U16(regions) }],
        time,
        note: String::new(),
    }
}

/// The sections of a frame as rows of a table.
pub fn rows(plates: &[Plate], found: &[Vec<Section>], info: &Info) -> String {
    let text = |name: &str| format!("\"{}\"", guarded(name).replace('"', "\"\"").replace('\n', " "));
    let mut rows = String::new();
    for (plate, sections) in plates.iter().zip(found) {
        for Section { along, position, displacement, forces } in sections {
            let numbers = [*position, *displacement].concat();
            let forces = [forces.normal, forces.shear, forces.moment, forces.hoop];
            let numbers = [*along].into_iter().chain(numbers).chain(forces).map(|v| format!("{v:?}"));
            let numbers = numbers.collect::<Vec<_>>().join(",");
            rows.push_str(&format!("{:?},{},{},{numbers}\n", info.time, text(&info.phase), text(&plate.name)));
        }
    }
    rows
}
