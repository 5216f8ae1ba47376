//! Cells by the boxes of a uniform grid that they touch.

use crate::mesh::shape::{CellKind, MAX_NODES};

/// Bins that a cell may touch in the mean.
pub const MOST: usize = 64;

/// Lowest and highest corner.
pub type Bounds<const D: usize> = ([f64; D], [f64; D]);

/// Cells by the boxes of a uniform grid they touch; each bin's cells in ascending order.
#[derive(Clone, Debug)]
pub struct Bins<const D: usize> {
    low: [f64; D],
    /// Bins per metre.
    scale: [f64; D],
    count: [usize; D],
    pub(super) offset: Vec<u32>,
    pub cells: Vec<u32>,
}

impl<const D: usize> Bins<D> {
    /// About one bin a cell, and fewer where boxes are so large that they would touch many each.
    pub fn new(boxes: &[Bounds<D>]) -> Self {
        let (low, high) = enclose(boxes);
        // Cells in a row, as those of a thin plate, get bins along the row only; a mesh without cells gets one bin.
        let longest = (0..D).map(|d| high[d] - low[d]).fold(0.0, f64::max);
        let least = if longest > 0.0 { longest / boxes.len() as f64 } else { 1.0 };
        let extent: [f64; D] = std::array::from_fn(|d| (high[d] - low[d]).max(least));
        let side = (extent.iter().product::<f64>() / boxes.len().max(1) as f64).powf(1.0 / D as f64);
        let mut count = extent.map(|e| ((e / side) as usize).clamp(1, 4096));
        let mut bins = loop {
            let scale = std::array::from_fn(|d| count[d] as f64 / extent[d]);
            let bins = Self { low, scale, count, offset: Vec::new(), cells: Vec::new() };
            let touched = |(low, high): &Bounds<D>| -> usize {
                (0..D).map(|d| 1 + bins.index(d, high[d]) - bins.index(d, low[d])).product()
            };
            // Cells of like size touch about four.
            if boxes.iter().map(touched).sum::<usize>() <= MOST * boxes.len() || count.iter().all(|&n| n == 1) {
                break bins;
            }
            count = count.map(|n| n.div_ceil(2));
        };
        let total = count.iter().product::<usize>();
        bins.offset = vec![0; total + 1];
        // Count, then fill in the order of the cells.
        for b in boxes {
            bins.touched(b, |bins, bin| bins.offset[bin + 1] += 1);
        }
        for i in 0..total {
            bins.offset[i + 1] += bins.offset[i];
        }
        bins.cells = vec![0; bins.offset[total] as usize];
        let mut next = bins.offset.clone();
        for (c, b) in boxes.iter().enumerate() {
            bins.touched(b, |bins, bin| {
                bins.cells[next[bin] as usize] = c as u32;
                next[bin] += 1;
            });
        }
        bins
    }

    /// Calls `action` for every bin that the box touches.
    fn touched(&mut self, (low, high): &Bounds<D>, mut action: impl FnMut(&mut Self, usize)) {
        let first: [usize; D] = std::array::from_fn(|d| self.index(d, low[d]));
        let last: [usize; D] = std::array::from_fn(|d| self.index(d, high[d]));
        let mut at = first;
        loop {
            let bin = self.flat(&at);
            action(self, bin);
            let mut d = 0;
            loop {
                if d == D {
                    return;
                }
                if at[d] < last[d] {
                    at[d] += 1;
                    break;
                }
                at[d] = first[d];
                d += 1;
            }
        }
    }

    /// The cells that may hold `x`; `None` outside the grid.
    pub fn at(&self, x: &[f64; D]) -> Option<&[u32]> {
        let inside = (0..D).all(|d| {
            let t = (x[d] - self.low[d]) * self.scale[d];
            t >= 0.0 && t <= self.count[d] as f64
        });
        if !inside {
            return None;
        }
        let bin = self.flat(&std::array::from_fn(|d| self.index(d, x[d])));
        Some(&self.cells[self.offset[bin] as usize..self.offset[bin + 1] as usize])
    }

    fn index(&self, d: usize, x: f64) -> usize {
        // A negative or NaN value casts to zero.
        (((x - self.low[d]) * self.scale[d]) as usize).min(self.count[d] - 1)
    }

    fn flat(&self, at: &[usize; D]) -> usize {
        (0..D).rev().fold(0, |flat, d| flat * self.count[d] + at[d])
    }
}

/// A box that holds the whole cell, curved edges included: that of its Bézier points where the cell is
/// quadratic. Replacing the middle value `m` of a quadratic between `a` and `b` by `2m − (a + b)/2` along
/// every parametric direction gives the Bernstein coefficients, whose hull holds the graph.
pub fn bounds<const D: usize>(kind: CellKind, x: &[[f64; D]]) -> Bounds<D> {
    let mut low = [f64::INFINITY; D];
    let mut high = [f64::NEG_INFINITY; D];
    let mut take = |y: &[f64; D]| {
        for d in 0..D {
            low[d] = low[d].min(y[d]);
            high[d] = high[d].max(y[d]);
        }
    };
    x.iter().for_each(&mut take);
    match kind {
        CellKind::T10 | CellKind::H27 => solid_control(kind, x).iter().for_each(&mut take),
        CellKind::Line4 | CellKind::Q16 => cubic_control(kind, x).iter().for_each(&mut take),
        _ if kind.order() == 2 => plane_control(kind, x).iter().for_each(&mut take),
        _ => {}
    }
    (low, high)
}

/// The Bézier points of a plane cell that are not its corners.
fn plane_control<const D: usize>(kind: CellKind, x: &[[f64; D]]) -> Vec<[f64; D]> {
    let edge = |facet: &&[usize]| match **facet {
        [a, b, m] => Some(std::array::from_fn(|d| 2.0 * x[m][d] - 0.5 * (x[a][d] + x[b][d]))),
        _ => None,
    };
    let mut control: Vec<[f64; D]> = kind.facets().1.iter().filter_map(edge).collect();
    if !kind.is_simplex() && D == 2 {
        // The centre of the box: the node of a Q9, the value of the functions of a Q8.
        let mut n = [0.0; MAX_NODES];
        kind.values(&kind.centre(), &mut n);
        let corners = &x[..kind.corner_count()];
        let middle = std::array::from_fn(|d| {
            let centre: f64 = x.iter().zip(&n).map(|(y, n)| n * y[d]).sum();
            let corner: f64 = corners.iter().map(|y| y[d]).sum();
            let edge: f64 = control.iter().map(|y| y[d]).sum();
            4.0 * centre - 0.25 * corner - 0.5 * edge
        });
        control.push(middle);
    }
    control
}

/// The Bézier points of a cell of third order.
fn cubic_control<const D: usize>(kind: CellKind, x: &[[f64; D]]) -> Vec<[f64; D]> {
    let places = kind.node_coordinates();
    // How the values at -1, -⅓, ⅓ and 1 of a line enter its inner Bézier points.
    const INNER: [[f64; 4]; 2] = [[-5.0, 18.0, -9.0, 2.0], [2.0, -9.0, 18.0, -5.0]];
    let number = |t: f64| (1.5 * (t + 1.0)).round() as usize;
    let along = |to: f64, from: f64| match number(to) {
        inner @ 1..=2 => INNER[inner - 1][number(from)] / 6.0,
        end => f64::from(number(from) == end),
    };
    let share = |to: &[f64; 3], from: &[f64; 3]| (0..kind.dimension()).map(|d| along(to[d], from[d])).product::<f64>();
    let point =
        |to: &[f64; 3]| std::array::from_fn(|d| places.iter().zip(x).map(|(from, x)| share(to, from) * x[d]).sum());
    places.iter().map(point).collect()
}

/// The Bézier points of a quadratic solid cell that are not its corners; of a hexahedron these too.
fn solid_control<const D: usize>(kind: CellKind, x: &[[f64; D]]) -> Vec<[f64; D]> {
    if kind.is_simplex() {
        // Each edge is seen from both of its faces.
        let edges =
            kind.facets().1.iter().flat_map(|face| [[0, 1, 3], [1, 2, 4], [2, 0, 5]].map(|edge| edge.map(|i| face[i])));
        return edges.map(|[a, b, m]| std::array::from_fn(|d| 2.0 * x[m][d] - 0.5 * (x[a][d] + x[b][d]))).collect();
    }
    let places = kind.node_coordinates();
    // How the value at one place of a line enters the Bézier point that stands at another.
    let along = |to: f64, from: f64| match (to == 0.0, from == 0.0) {
        (true, true) => 2.0,
        (true, false) => -0.5,
        (false, _) => f64::from(to == from),
    };
    let share =
        |to: &[f64; 3], from: &[f64; 3]| to.iter().zip(from).map(|(to, from)| along(*to, *from)).product::<f64>();
    let point =
        |to: &[f64; 3]| std::array::from_fn(|d| places.iter().zip(x).map(|(from, x)| share(to, from) * x[d]).sum());
    places.iter().map(point).collect()
}

/// A box around boxes.
pub fn enclose<const D: usize>(boxes: &[Bounds<D>]) -> Bounds<D> {
    let mut all = boxes.first().copied().unwrap_or(([0.0; D], [0.0; D]));
    for (low, high) in boxes {
        for d in 0..D {
            all.0[d] = all.0[d].min(low[d]);
            all.1[d] = all.1[d].max(high[d]);
        }
    }
    all
}
