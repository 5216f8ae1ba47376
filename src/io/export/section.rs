//! Numbers of a frame as a table: of the material points, all or those in a box, or of the soil along a line.

use super::fields::select;
use super::series::Series;
use super::soil::{numbers, with_invariants};
use crate::error::{Error, Result};
use crate::io::frame::{DISPLACEMENT, Frame};

/// What of a frame becomes rows (m).
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    Points,
    /// Points in a box, by its lower left and its upper right corner.
    Window([[f64; 2]; 2]),
    /// Stations along a line, its ends among them, at equal distances.
    Along {
        ends: [[f64; 2]; 2],
        stations: usize,
    },
}

/// Columns by their headings, and rows; a field is empty where there is no soil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    pub headings: Vec<String>,
    pub rows: Vec<Vec<Option<f64>>>,
}

/// The components of a field that are not zero in the plane, with their names.
fn components(count: usize) -> Vec<(usize, &'static str)> {
    match count {
        3 => vec![(0, ".x"), (1, ".y")],
        6 => vec![(0, ".xx"), (1, ".yy"), (2, ".zz"), (3, ".xy")],
        9 => vec![(0, ".xx"), (1, ".xy"), (3, ".yx"), (4, ".yy"), (8, ".zz")],
        _ => vec![(0, "")],
    }
}

impl Series<'_> {
    /// A section of frame `i` with `fields`.
    ///
    /// # Errors
    /// `Input` when the frame is damaged or has not one of the fields, and along a line without the displacement of the points.
    pub fn section(&self, i: usize, fields: &[String], section: &Section) -> Result<Sheet> {
        let info = &self.infos[i];
        let frame = Frame::read(&info.path)?;
        super::series::check_fields(&info.path, &frame, fields)?;
        let points = &frame.points;
        let arrays = select(points, &with_invariants(fields));
        let mut headings = vec!["time [s]".to_owned()];
        if matches!(section, Section::Along { .. }) {
            headings.push("distance [m]".to_owned());
        }
        headings.extend(["x [m]", "y [m]"].map(String::from));
        for array in &arrays {
            let (name, unit) = array.name.rsplit_once(" [").unwrap_or((&array.name, "-]"));
            headings.extend(components(array.components).iter().map(|(_, of)| format!("{name}{of} [{unit}")));
        }
        let columns: Vec<(&[f64], usize, usize)> = arrays
            .iter()
            .flat_map(|array| {
                components(array.components).into_iter().map(|(k, _)| (numbers(array), array.components, k))
            })
            .collect();
        let value = |p: usize, &(values, count, k): &(&[f64], usize, usize)| values[p * count + k];
        let position = |p: usize| [points.position[p][0], points.position[p][1]];
        let mut rows = Vec::new();
        match section {
            Section::Points | Section::Window(_) => {
                let within = |x: [f64; 2]| match section {
                    Section::Window([low, high]) => (0..2).all(|d| low[d] <= x[d] && x[d] <= high[d]),
                    _ => true,
                };
                for p in (0..points.position.len()).filter(|&p| within(position(p))) {
                    let own = columns.iter().map(|column| value(p, column));
                    rows.push([frame.time].into_iter().chain(position(p)).chain(own).map(Some).collect());
                }
            }
            Section::Along { ends: [a, b], stations } => {
                let Some(bodies) = &self.bodies else {
                    let problem = format!("values along a line need the `{DISPLACEMENT}` of material points");
                    let remedy = "add it to `output.fields` and solve again, or take the points themselves";
                    return Err(Error::input(info.path.display(), problem, remedy));
                };
                let probe = bodies.probe(i, info, points)?;
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                for station in 0..*stations {
                    let t = station as f64 / (*stations as f64 - 1.0);
                    let x = [0, 1].map(|d| a[d] + t * (b[d] - a[d]));
                    let weights = probe.at(&x);
                    let fitted = |column: &(&[f64], usize, usize)| {
                        weights.as_ref().map(|weights| weights.iter().map(|&(p, w)| w * value(p, column)).sum::<f64>())
                    };
                    let place = [frame.time, t * length].into_iter().chain(x).map(Some);
                    rows.push(place.chain(columns.iter().map(fitted)).collect());
                }
            }
        }
        Ok(Sheet { headings, rows })
    }
}
