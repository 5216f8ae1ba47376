//! Fields at the nodes from those at the points.
//!
//! In each cell a linear function is fitted to the points of a region in it and around it, the fit of resampled quadrature
//! ([`Fit`]); what the cells with points of the region say of a node is averaged, and where there is none of them what the cells
//! beside them say.

use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::quadrature::{Around, Fit, Held, Place, Rings};
use crate::surface::CellFrame;
use rayon::prelude::*;

/// Values at points: so many numbers each, one point after the other.
#[derive(Clone, Copy)]
pub struct Values<'a> {
    pub width: usize,
    pub of: &'a [f64],
}

/// What is around the points.
pub struct Ground<'a> {
    pub mesh: &'a Mesh<2>,
    pub points: &'a Points<2>,
    pub around: &'a Around,
    pub held: &'a Held,
    /// Cells with points, and those that share a corner with one.
    pub active: &'a [u32],
}

/// The mean size of the cells around each node.
pub struct Sizes(Vec<(f64, f64)>);

impl Sizes {
    pub fn new(ground: &Ground) -> Self {
        let mut size = vec![(0.0, 0.0f64); ground.mesh.nodes.len()];
        for &c in ground.active {
            let h = cell_size(ground.mesh, c as usize) * std::f64::consts::FRAC_1_SQRT_2;
            ground.mesh.cells.nodes(c as usize).iter().for_each(|&n| {
                let (sum, count) = &mut size[n as usize];
                (*sum, *count) = (*sum + h, *count + 1.0);
            });
        }
        Self(size)
    }

    /// That at node `n` (m); 0 where there is none.
    pub fn of(&self, n: usize) -> f64 {
        let (sum, count) = self.0[n];
        sum / count.max(1.0)
    }
}

/// Linear functions over a cell.
struct Function {
    cell: u32,
    frame: CellFrame,
    /// The coefficients of `1, x, y` in the coordinates of the frame, function after function.
    coefficients: Vec<[f64; 3]>,
    /// The least and the greatest value at the points that each is fitted to.
    range: Vec<[f64; 2]>,
    /// Root of the mean square of what the functions leave of the values at the points; infinite where they are constant.
    residual: f64,
}

/// Fields at the nodes.
pub struct Nodal {
    width: usize,
    /// The number of a node among those with values.
    number: Vec<u32>,
    value: Vec<f64>,
    range: Vec<[f64; 2]>,
    /// Root of the mean square of what the functions of the cells leave, and of how they differ at the node.
    residual: Vec<f64>,
    /// The gradient (1/m) of each value.
    gradient: Vec<[f64; 2]>,
}

/// The values at a node, what the functions of the cells leave there, and the gradients (1/m).
pub struct AtNode<'a> {
    pub value: &'a [f64],
    pub residual: f64,
    pub gradient: &'a [[f64; 2]],
}

/// Marks a node without values.
const NONE: u32 = u32::MAX;

impl Nodal {
    /// The fields at the nodes of the active cells, of the points of a `region` or of all.
    pub fn of(ground: &Ground, region: Option<u16>, values: Values) -> Self {
        let functions: Vec<Function> =
            ground.active.par_iter().with_min_len(32).filter_map(|&c| fitted(ground, region, values, c)).collect();
        let width = values.width;
        let mut nodal = Self {
            width,
            number: vec![NONE; ground.mesh.nodes.len()],
            value: Vec::new(),
            range: Vec::new(),
            residual: Vec::new(),
            gradient: Vec::new(),
        };
        let (mut count, mut square): (Vec<(f64, bool)>, Vec<f64>) = (Vec::new(), Vec::new());
        let of_cell = |c: u32| functions.binary_search_by_key(&c, |f| f.cell).ok().map(|k| &functions[k]);
        // Cells with points first; then those beside them, by the functions of these.
        for own in [true, false] {
            for &cell in ground.active.iter().filter(|&&c| of_cell(c).is_some() == own) {
                let beside = ground.around.cells(cell).iter().copied().filter(|_| !own);
                let by = beside.chain(own.then_some(cell)).filter_map(of_cell);
                for (&n, function) in
                    by.flat_map(|f| ground.mesh.cells.nodes(cell as usize).iter().map(move |n| (n, f)))
                {
                    let number = &mut nodal.number[n as usize];
                    if *number == NONE {
                        *number = count.len() as u32;
                        count.push((0.0, own));
                        square.push(0.0);
                        nodal.value.resize(nodal.value.len() + width, 0.0);
                        nodal.gradient.resize(nodal.gradient.len() + width, [0.0; 2]);
                        nodal.range.resize(nodal.range.len() + width, [f64::INFINITY, f64::NEG_INFINITY]);
                        nodal.residual.push(0.0);
                    }
                    let k = *number as usize;
                    if count[k].1 != own {
                        continue;
                    }
                    count[k].0 += 1.0;
                    let [x, y] = function.frame.local(&ground.mesh.nodes[n as usize]);
                    for (i, [a, b, c]) in function.coefficients.iter().enumerate() {
                        let value = a + b * x + c * y;
                        nodal.value[k * width + i] += value;
                        square[k] += value * value;
                        let range = &mut nodal.range[k * width + i];
                        *range = [range[0].min(function.range[i][0]), range[1].max(function.range[i][1])];
                        let gradient = &mut nodal.gradient[k * width + i];
                        *gradient = [gradient[0] + b / function.frame.length, gradient[1] + c / function.frame.length];
                    }
                    nodal.residual[k] += function.residual.powi(2);
                }
            }
        }
        for (k, (count, _)) in count.iter().enumerate() {
            let own = k * width..(k + 1) * width;
            nodal.value[own.clone()].iter_mut().for_each(|value| *value /= count);
            nodal.gradient[own.clone()].iter_mut().for_each(|g| *g = g.map(|g| g / count));
            let mean: f64 = nodal.value[own].iter().map(|value| value * value).sum();
            let apart = (square[k] / count - mean).max(0.0);
            nodal.residual[k] = (nodal.residual[k] / count + apart).sqrt();
        }
        nodal
    }

    /// What is known at a node.
    pub fn at(&self, n: u32) -> Option<AtNode<'_>> {
        let k = self.number[n as usize];
        let own = (k != NONE).then(|| k as usize * self.width..(k as usize + 1) * self.width)?;
        let (value, gradient) = (&self.value[own.clone()], &self.gradient[own]);
        Some(AtNode { value, residual: self.residual[k as usize], gradient })
    }

    /// Whether something is known between some nodes, given the weight of each.
    pub fn is_known(&self, nodes: &[u32; 3], weights: &[f64; 3]) -> bool {
        nodes.iter().zip(weights).any(|(n, weight)| self.number[*n as usize] != NONE && *weight > 0.0)
    }

    /// Appends the values between some nodes where something [is known](Self::is_known), given the weight of each, no greater and no less than at the points around them.
    pub fn between(&self, nodes: &[u32; 3], weights: &[f64; 3], out: &mut Vec<f64>) {
        let has = |(n, weight): (&u32, &f64)| {
            let k = self.number[*n as usize];
            (k != NONE && *weight > 0.0).then_some((k as usize * self.width, *weight))
        };
        let own: Vec<(usize, f64)> = nodes.iter().zip(weights).filter_map(has).collect();
        let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
        for i in 0..self.width {
            let value: f64 = own.iter().map(|(k, weight)| weight / sum * self.value[k + i]).sum();
            let range = own.iter().map(|(k, _)| self.range[k + i]);
            let [low, high] = range.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], r| [l.min(r[0]), h.max(r[1])]);
            out.push(if low <= high { value.clamp(low, high) } else { value });
        }
    }
}

/// The order of cells up to which what is fitted is linear: pictures take that in all cells.
const LINEAR: usize = 2;

/// The functions of a cell; `None` where it has no points.
fn fitted(ground: &Ground, region: Option<u16>, values: Values, cell: u32) -> Option<Function> {
    let Ground { mesh, points, around, held, .. } = *ground;
    let counts = |p: u32| region.is_none_or(|region| points.region[p as usize] == region);
    let inside: Vec<u32> = held.points(cell).iter().copied().filter(|&p| counts(p)).collect();
    if inside.is_empty() {
        return None;
    }
    let frame = CellFrame::of(mesh, cell as usize);
    let at = |&n: &u32| Place { xi: [0.0; 3], x: mesh.nodes[n as usize], weight: 0.0 };
    let places: Vec<Place> = mesh.cells.nodes(cell as usize).iter().map(at).collect();
    let fit = Fit::new(points, (around, held), &mut Rings::of(cell), (&frame, LINEAR), &places, &counts)?;
    let Values { width, of } = values;
    let linear = |i: usize| fit.coefficients_of(|p| of[p * width + i]).linear().map(|[c]| c);
    let coefficients: Vec<[f64; 3]> = (0..width).map(linear).collect();
    let mut range = vec![[f64::INFINITY, f64::NEG_INFINITY]; width];
    for &p in &fit.points {
        for (range, value) in range.iter_mut().zip(&of[p as usize * width..]) {
            *range = [range[0].min(*value), range[1].max(*value)];
        }
    }
    let square = |&p: &u32| -> f64 {
        let [x, y] = frame.local(&points.position[p as usize]);
        let off = |(i, [a, b, c]): (usize, &[f64; 3])| (of[p as usize * width + i] - a - b * x - c * y).powi(2);
        coefficients.iter().enumerate().map(off).sum()
    };
    let residual = (inside.iter().map(square).sum::<f64>() / inside.len() as f64).sqrt();
    let residual = if fit.linear { residual } else { f64::INFINITY };
    Some(Function { cell, frame, coefficients, range, residual })
}
