//! What a series shows of a mesh: some of its cells, with the nodes that they use.
//!
//! Fields that are known at the points of finite elements are brought to their nodes: in each cell a linear function, the
//! nearest to the values at its points by least squares, is taken at the nodes, and what the cells of a region say of a
//! node is averaged. Where a cell has too few points for it their mean takes its place.

use super::super::container::Data;
use super::super::frame::{CELL, Column, DISPLACEMENT, Part};
use super::super::vtu::{Array, Grid, Topology};
use super::fields::select;
use crate::mesh::Mesh;
use std::collections::HashMap;

/// Cells of a mesh with nodes of their own.
#[derive(Default)]
pub struct Piece {
    /// The node of the mesh that each node is; absent where all are, in their order.
    nodes: Option<Vec<u32>>,
    topology: Topology,
    region: Vec<u16>,
}

impl Piece {
    /// All of a mesh.
    pub fn whole<const D: usize>(mesh: &Mesh<D>) -> Self {
        Self { nodes: None, topology: Topology::of_mesh(mesh), region: mesh.cells.region.clone() }
    }

    /// The cells of a mesh and their nodes, each once.
    pub fn background<const D: usize>(mesh: &Mesh<D>) -> Self {
        Self::numbered(mesh, |_| 0)
    }

    /// The cells of a mesh and their nodes, each once a region.
    pub fn by_region<const D: usize>(mesh: &Mesh<D>) -> Self {
        Self::numbered(mesh, |region| region)
    }

    fn numbered<const D: usize>(mesh: &Mesh<D>, body: impl Fn(u16) -> u16) -> Self {
        let (mut topology, mut nodes, mut number) = (Topology::of_mesh(mesh), Vec::new(), HashMap::new());
        let mut connectivity = topology.connectivity.iter_mut();
        for c in 0..mesh.cells.len() {
            for (&n, entry) in mesh.cells.nodes(c).iter().zip(&mut connectivity) {
                *entry = *number.entry((body(mesh.cells.region[c]), n)).or_insert_with(|| {
                    nodes.push(n);
                    nodes.len() as i64 - 1
                });
            }
        }
        Self { nodes: Some(nodes), topology, region: mesh.cells.region.clone() }
    }

    /// The nodes of each cell, in their own numbers, and its region.
    pub fn cells(&self) -> impl Iterator<Item = (&[i64], u16)> {
        let begin = std::iter::once(0).chain(self.topology.offsets.iter().copied());
        let cells =
            begin.zip(&self.topology.offsets).map(|(a, &b)| &self.topology.connectivity[a as usize..b as usize]);
        cells.zip(self.region.iter().copied())
    }

    /// The part of a field over all nodes that these cells see.
    pub fn at(&self, part: &Part) -> Part {
        let Some(nodes) = &self.nodes else { return part.clone() };
        let pick = |c: &Column| {
            let values = nodes.iter().flat_map(|&n| &c.values[n as usize * c.components..][..c.components]).copied();
            Column { values: values.collect(), ..c.clone() }
        };
        Part {
            position: nodes.iter().map(|&n| part.position[n as usize]).collect(),
            columns: part.columns.iter().map(pick).collect(),
        }
    }

    /// The fields of finite elements at their nodes, given the nodes now (`grid`) and at `first`, and what is known at
    /// the points of the `elements`. The displacement is that of the nodes themselves. `None` where the points or the
    /// nodes do not belong to the cells.
    pub fn smooth(&self, grid: &Part, first: &[[f64; 3]], elements: &Part) -> Option<Part> {
        let nodes = self.nodes.as_deref().unwrap_or(&[]);
        let now = |n: u32| grid.position.get(n as usize).copied();
        let position: Vec<[f64; 3]> = nodes.iter().map(|&n| now(n)).collect::<Option<_>>()?;
        let mut members = vec![Vec::new(); self.region.len()];
        let cells = elements.columns.iter().find(|c| c.name == CELL).map_or(&[][..], |c| &c.values);
        for (p, &cell) in cells.iter().enumerate() {
            let number = cell as usize;
            // No part of a cell, and none before the first.
            members.get_mut(number).filter(|_| number as f64 == cell)?.push(p);
        }
        let mut columns = Vec::new();
        let known: Vec<&Column> = elements.columns.iter().filter(|c| c.name != CELL).collect();
        let mut values: Vec<Vec<f64>> = known.iter().map(|c| vec![0.0; nodes.len() * c.components]).collect();
        let mut count = vec![0.0; nodes.len()];
        let mut begin = 0;
        for (members, &end) in members.iter().zip(&self.topology.offsets) {
            let corners = &self.topology.connectivity[begin..end as usize];
            begin = end as usize;
            let fit = Fit::new(members.iter().map(|&p| elements.position[p]).collect());
            for &n in corners {
                let n = n as usize;
                count[n] += 1.0;
                for (weight, &p) in fit.weights(&position[n]).zip(members) {
                    for (column, values) in known.iter().zip(&mut values) {
                        let k = column.components;
                        for i in 0..k {
                            values[n * k + i] += weight * column.values[p * k + i];
                        }
                    }
                }
            }
        }
        for (column, mut values) in known.into_iter().zip(values) {
            for (values, count) in values.chunks_exact_mut(column.components).zip(&count) {
                values.iter_mut().for_each(|v| *v /= count);
            }
            columns.push(Column { values, ..column.clone() });
        }
        if let Some(displacement) = columns.iter_mut().find(|c| c.name == DISPLACEMENT) {
            let way = |(x, &n): (&[f64; 3], &u32)| [0, 1, 2].map(|d| x[d] - first[n as usize][d]);
            displacement.values = position.iter().zip(nodes).flat_map(way).collect();
        }
        Some(Part { position, columns })
    }

    /// The cells with `part` at their nodes.
    pub fn grid(&self, part: &Part, fields: &[String], time: Option<f64>) -> Grid {
        let region = Array { name: "region [-]".to_string(), components: 1, data: Data::U16(self.region.clone()) };
        Grid {
            points: part.position.concat(),
            topology: self.topology.clone(),
            point_data: select(part, fields),
            cell_data: vec![region],
            time,
            note: String::new(),
        }
    }
}

/// Linear functions fitted to values at some places of a plane.
struct Fit {
    places: Vec<[f64; 3]>,
    centre: [f64; 2],
    /// Inverse of the second moments of the places about their centre; zero where they are on a line.
    inverse: [[f64; 2]; 2],
}

impl Fit {
    fn new(places: Vec<[f64; 3]>) -> Self {
        let count = places.len().max(1) as f64;
        let centre = [0, 1].map(|d| places.iter().map(|x| x[d]).sum::<f64>() / count);
        let moment = |i: usize, j: usize| places.iter().map(|x| (x[i] - centre[i]) * (x[j] - centre[j])).sum::<f64>();
        let (a, b, c) = (moment(0, 0), moment(0, 1), moment(1, 1));
        let determinant = a * c - b * b;
        let inverse = if determinant > 1e-12 * (a + c) * (a + c) {
            [[c / determinant, -b / determinant], [-b / determinant, a / determinant]]
        } else {
            [[0.0; 2]; 2]
        };
        Self { places, centre, inverse }
    }

    /// What the values at the places count in the function at `x`.
    fn weights(&self, x: &[f64; 3]) -> impl Iterator<Item = f64> {
        let [u, v] = [0, 1].map(|d| x[d] - self.centre[d]);
        let slope = [0, 1].map(|d| self.inverse[d][0] * u + self.inverse[d][1] * v);
        let mean = 1.0 / self.places.len() as f64;
        self.places.iter().map(move |place| mean + (0..2).map(|d| slope[d] * (place[d] - self.centre[d])).sum::<f64>())
    }
}
