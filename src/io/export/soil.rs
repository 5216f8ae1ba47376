//! The series of the soil as a body: that of material points, cut along its surface, and that of finite elements.

use super::super::container::Data;
use super::super::frame::{self, DISPLACEMENT, Frame, Info, Part, VOLUME};
use super::super::vtu::{self, Array, Grid, Topology};
use super::Regions;
use super::fields::select;
use super::pieces::Piece;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::soil::{Body, Cloud, Probe, Soil, Values};
use crate::surface::triangles;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// VTK's number of a triangle (`vtkCellType.h`).
const VTK_TRIANGLE: u8 = 5;

/// The material points of a frame: where they are (m), and where they were seeded (m).
#[derive(Clone, Debug, Default)]
struct Traced {
    position: Vec<[f64; 2]>,
    origin: Vec<[f64; 2]>,
}

/// What all frames have in common.
pub struct Bodies<'a> {
    soil: Soil,
    regions: &'a Regions,
    /// Triangles of the finite elements by the nodes of their piece, with their regions.
    elements: Vec<([u32; 3], u16)>,
    /// The points of the last frame before a phase that resets displacements, by the number of the next frame.
    resets: BTreeMap<usize, Traced>,
}

impl<'a> Bodies<'a> {
    /// Of the cells of the grid in `mesh` and the finite elements in `structures`. `None` where the soil is not to be seen as a body: no
    /// region has material points, or the frames do not hold their displacement and volume.
    ///
    /// # Errors
    /// Those of reading frames.
    pub fn new(
        mesh: &Mesh<2>,
        regions: &'a Regions,
        (pieces, kinds): (&Piece, &[CellKind]),
        infos: &[Info],
    ) -> Result<Option<Self>> {
        let grid = mesh.part(|c| !regions.elements[mesh.cells.region[c] as usize]);
        let seeded: Vec<bool> = regions.soil.iter().zip(&regions.elements).map(|(soil, fem)| *soil && !fem).collect();
        let first = infos.first().map(|info| Frame::read(&info.path)).transpose()?;
        let known = |points: &Part| points.numbers(DISPLACEMENT, 3).is_some() && points.numbers(VOLUME, 1).is_some();
        if !seeded.contains(&true) || first.is_none_or(|frame| !known(&frame.points)) {
            return Ok(None);
        }
        let soil = Soil::new(grid, &seeded);
        let elements = pieces.cells().zip(kinds).flat_map(|((corners, region), &kind)| {
            // The nodes of the piece are in the order of VTK.
            let place =
                move |i: usize| vtu::vtk_order(kind).and_then(|order| order.iter().position(|&j| j == i)).unwrap_or(i);
            triangles(kind).iter().map(move |t| (t.map(|i| corners[place(i)] as u32), region))
        });
        let mut bodies = Self { soil, regions, elements: elements.collect(), resets: BTreeMap::new() };
        for (i, pair) in infos.windows(2).enumerate() {
            if pair[0].phase != pair[1].phase && regions.resets.contains(&pair[1].phase) {
                let frame = Frame::read(&pair[0].path)?;
                let way = needed(&pair[0], &frame.points, DISPLACEMENT, 3)?;
                let traced = bodies.traced(i, &frame.points, way);
                bodies.resets.insert(i + 1, traced);
            }
        }
        Ok(Some(bodies))
    }

    /// The points of frame `index`, which have gone a `way` (m), with their origins.
    fn traced(&self, index: usize, points: &Part, way: &[f64]) -> Traced {
        let plane = |x: &[f64; 3]| [x[0], x[1]];
        let position: Vec<[f64; 2]> = points.position.iter().map(plane).collect();
        let mut origin: Vec<[f64; 2]> =
            position.iter().zip(way.chunks_exact(3)).map(|(x, u)| [x[0] - u[0], x[1] - u[1]]).collect();
        if let Some((_, before)) = self.resets.range(..=index).next_back() {
            origin = Soil::traced(&origin, &before.position, &before.origin);
        }
        Traced { position, origin }
    }

    /// The points of frame `index` to look values up among, each with the region that it was seeded in; one seeded nowhere is of none.
    ///
    /// # Errors
    /// As [`Bodies::grid`].
    pub fn probe(&self, index: usize, info: &Info, points: &Part) -> Result<Probe> {
        let [way, volume] = [(DISPLACEMENT, 3), (VOLUME, 1)].map(|(name, k)| needed(info, points, name, k));
        let traced = self.traced(index, points, way?);
        let area = self.areas(volume?, &traced.position);
        let region = traced.origin.iter().map(|x| self.soil.seeded_region(x).unwrap_or(u16::MAX)).collect();
        Ok(Probe::new(traced.position, &area, region))
    }

    /// The area (m²) of points in the plane. In axisymmetry the volume is that of a ring; a point on the axis has none.
    fn areas(&self, volume: &[f64], position: &[[f64; 2]]) -> Vec<f64> {
        let area = |(volume, x): (&f64, &[f64; 2])| match self.regions.axisymmetric {
            true if x[0] > 0.0 => volume / (TAU * x[0]),
            true => 0.0,
            false => *volume,
        };
        volume.iter().zip(position).map(area).collect()
    }

    /// The soil of frame `index`, with its grid at `nodes` (m) and the finite elements in `smooth`.
    ///
    /// # Errors
    /// `Input` for a frame without the displacement or the volume, which the first one has.
    pub fn grid(
        &self,
        index: usize,
        info: &Info,
        points: &Part,
        nodes: &[[f64; 3]],
        smooth: &Part,
        fields: &[String],
    ) -> Result<Grid> {
        let [way, volume] = [(DISPLACEMENT, 3), (VOLUME, 1)].map(|(name, k)| needed(info, points, name, k));
        let (way, volume) = (way?, volume?);
        let fields = &with_invariants(fields);
        let arrays = select(points, fields);
        let width = arrays.iter().map(|array| array.components).sum();
        let mut of = Vec::with_capacity(width * points.position.len());
        for p in 0..points.position.len() {
            arrays
                .iter()
                .for_each(|array| of.extend_from_slice(&numbers(array)[p * array.components..][..array.components]));
        }
        let plane = |x: &[f64; 3]| [x[0], x[1]];
        let traced = self.traced(index, points, way);
        let nodes: Vec<[f64; 2]> = nodes.iter().map(plane).collect();
        let places: Vec<[f64; 2]> = smooth.position.iter().map(plane).collect();
        let absent = self.regions.absent.get(&info.phase);
        let stands =
            |region: u16| !self.regions.soil[region as usize] && !absent.is_some_and(|absent| absent.contains(&region));
        let standing: Vec<[u32; 3]> = self.elements.iter().filter(|(_, r)| stands(*r)).map(|(t, _)| *t).collect();
        let area = self.areas(volume, &traced.position);
        let Traced { position, origin } = &traced;
        let cloud = Cloud { position, origin, area: &area, values: Values { width, of: &of } };
        let left = self.regions.changes.then(|| self.soil.left(origin)).flatten();
        let body = left.as_ref().unwrap_or(&self.soil).body(&nodes, cloud, (&places, &standing));
        let elements: Vec<&([u32; 3], u16)> =
            self.elements.iter().filter(|(_, r)| self.regions.soil[*r as usize]).collect();
        let mut grid = joined(body, &arrays, &elements, smooth, fields);
        grid.time = Some(info.time);
        if let Some(materials) = self.regions.materials.get(&info.phase) {
            let of_cell = grid.cell_data.iter().find_map(|array| match &array.data {
                Data::U16(regions) => Some(regions.iter().map(|&r| materials[r as usize]).collect()),
                _ => None,
            });
            let data = Data::U16(of_cell.unwrap_or_default());
            grid.cell_data.push(Array { name: "material [-]".to_owned(), components: 1, data });
        }
        Ok(grid)
    }
}

/// The numbers of a column that the first frame has.
fn needed<'a>(info: &Info, points: &'a Part, name: &str, components: usize) -> Result<&'a [f64]> {
    points.numbers(name, components).ok_or_else(|| {
        let problem = format!("has not the column `{name}` of the points that the first frame has");
        Error::input(info.path.display(), problem, "the frames are of several runs: run `mpm solve` again")
    })
}

/// The fields with those that are seen together with the stress.
pub fn with_invariants(fields: &[String]) -> Vec<String> {
    let mut all = fields.to_vec();
    if fields.iter().any(|field| field == "stress") {
        let more =
            ["mean_stress", "deviatoric_stress"].into_iter().filter(|more| !fields.iter().any(|field| field == more));
        all.extend(more.map(String::from));
    }
    all
}

pub fn numbers(array: &Array) -> &[f64] {
    match &array.data {
        Data::F64(values) => values,
        _ => &[],
    }
}

/// The body of material points with the fields in `arrays`, and finite elements with theirs at the nodes of `smooth`. A field that these do not have is
/// not a number there.
fn joined(body: Body, arrays: &[Array], elements: &[&([u32; 3], u16)], smooth: &Part, fields: &[String]) -> Grid {
    let mut number = BTreeMap::new();
    let mut corners: Vec<u32> = body.triangles.iter().flatten().copied().collect();
    let count = body.places.len();
    for n in elements.iter().flat_map(|(triangle, _)| triangle) {
        let next = (count + number.len()) as u32;
        corners.push(*number.entry(*n).or_insert(next));
    }
    let mut nodes: Vec<(u32, u32)> = number.into_iter().map(|(n, k)| (k, n)).collect();
    nodes.sort_unstable();
    let mut points: Vec<f64> = body.places.iter().flat_map(|x| [x[0], x[1], 0.0]).collect();
    points.extend(nodes.iter().flat_map(|&(_, n)| smooth.position[n as usize]));
    let of_elements = if nodes.is_empty() { Vec::new() } else { select(smooth, fields) };
    let width: usize = arrays.iter().map(|array| array.components).sum();
    let (mut begin, mut point_data) = (0, Vec::new());
    for array in arrays {
        let k = array.components;
        let mut values: Vec<f64> = Vec::with_capacity(k * (count + nodes.len()));
        (0..count).for_each(|p| values.extend_from_slice(&body.values[p * width + begin..][..k]));
        let other = of_elements.iter().find(|other| other.name == array.name && other.components == k).map(numbers);
        for &(_, n) in &nodes {
            match other {
                Some(other) => values.extend_from_slice(&other[n as usize * k..][..k]),
                None => values.extend(std::iter::repeat_n(f64::NAN, k)),
            }
        }
        begin += k;
        point_data.push(Array { data: Data::F64(values), ..array.clone() });
    }
    let mut region = body.region;
    region.extend(elements.iter().map(|(_, region)| *region));
    let cells = region.len() as i64;
    Grid {
        points,
        topology: Topology {
            connectivity: corners.into_iter().map(i64::from).collect(),
            offsets: (1..=cells).map(|c| 3 * c).collect(),
            types: vec![VTK_TRIANGLE; region.len()],
        },
        point_data,
        cell_data: vec![Array { name: frame::REGION.to_owned() + " [-]", components: 1, data: Data::U16(region) }],
        time: None,
        note: String::new(),
    }
}
