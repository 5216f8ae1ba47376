//! Quadratic B-splines on a rectangular grid of Q9 cells: gradients that are continuous from cell to cell
//! (Tielen, Wobbes, Möller & Beuth 2017, *A high order material point method*; Steffen, Kirby & Berzins 2008).
//!
//! The tensor products of quadratic splines with simple knots at the grid lines and open ends have one control value a cell, one an edge on
//! the boundary and one a corner of the grid. On each cell they are biquadratic, so they are the linear constraints
//! `u = E c` on the nodal values of Q9 cells (Bézier extraction: Borden, Scott, Evans & Hughes 2011), and the points see the shape functions of
//! their cells as in the plain method. The Greville abscissa of a control is the middle of its span, also where the spacing varies:
//! it has the number of the node there.
//!
//! In one dimension, with the lengths `h` of the spans on both sides of a knot and controls `c` in their middle,
//! `u_knot = (h_right c_left + h_left c_right)/(h_left + h_right)`, at the ends `u = c`, and in the middle of a span
//! `u = ¼ u_left + ½ c + ¼ u_right`, so that `c = 2 u − ½ (u_left + u_right)`. Splines of third degree would need cells of third order.

use super::{Basis, Interpolation, Located};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::system::{LinearConstraints, Rows};

/// Largest distance (-) of a node from its place on the lattice, over the size of a cell: the digits that a mesh file may not have.
const OFF: f64 = 1e-6;

/// The scheme.
#[derive(Clone, Copy, Debug)]
pub struct BSpline;

impl Basis<2> for BSpline {
    fn name(&self) -> &'static str {
        "bspline"
    }

    fn takes(&self, kind: CellKind) -> bool {
        kind == CellKind::Q9
    }

    fn refusal(&self, mesh: &Mesh<2>) -> Option<[String; 2]> {
        let problem = Lattice::of(mesh).err()?;
        Some([
            format!("takes a rectangular grid of Q9 cells, and {problem}"),
            "make the grid one rectangle along x and y with `Transfinite Curve`, `Transfinite Surface` and `Recombine Surface` in the .geo and cells of second order, or choose `gradient: mpm`".into(),
        ])
    }

    fn wants_first_shape(&self) -> bool {
        true
    }

    fn without_pore_water(&self) -> Option<&'static str> {
        Some("is not stable beside the field of a pore pressure, which has a value a corner of a cell")
    }

    fn without_pressure_field(&self) -> Option<&'static str> {
        Some(
            "has about as many displacements as the pressure field of undrained and nearly incompressible materials has pressures: it would lock",
        )
    }

    fn constraints(&self, mesh: &Mesh<2>) -> Option<LinearConstraints> {
        let lattice = Lattice::of(mesh).ok()?;
        let along = lattice.lines.each_ref().map(|lines| Splines::new(lines));
        let (mut nodes, mut controls) = (Rows::default(), Rows::default());
        for (n, place) in (0u32..).zip(&lattice.place) {
            let Some([i, j]) = *place else {
                // A node of a structure.
                nodes.push([(n, 1.0)]);
                controls.push([(n, 1.0)]);
                continue;
            };
            let product = |of: [&[(usize, f64)]; 2]| {
                let [along_x, along_y] = of;
                let numbers = |&(l, b): &(usize, f64)| along_x.iter().map(move |&(k, a)| ([k, l], a * b));
                let all = along_y.iter().flat_map(numbers);
                all.map(|(place, by)| (lattice.number(place), by)).collect::<Vec<_>>()
            };
            nodes.push(product([&along[0].of_node[i], &along[1].of_node[j]]));
            controls.push(product([&along[0].of_control[i], &along[1].of_control[j]]));
        }
        Some(LinearConstraints::new(nodes, controls))
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        interpolation.fill_shapes(points, |_| 0);
    }
}

/// Splines along one direction, by places: `2k` is knot `k`, `2k + 1` the middle of span `k`.
struct Splines {
    /// The controls of each place with their coefficients.
    of_node: Vec<Vec<(usize, f64)>>,
    /// The places that give the value of the control at each place; empty where there is none.
    of_control: Vec<Vec<(usize, f64)>>,
}

impl Splines {
    /// With the knots `x` (m), ascending.
    fn new(x: &[f64]) -> Self {
        let last = 2 * (x.len() - 1);
        let length = |span: usize| x[span + 1] - x[span];
        let knot = |k: usize| {
            if k == 0 || 2 * k == last {
                return vec![(2 * k, 1.0)];
            }
            let (left, right) = (length(k - 1), length(k));
            vec![(2 * k - 1, right / (left + right)), (2 * k + 1, left / (left + right))]
        };
        let of_node = |i: usize| {
            if i.is_multiple_of(2) {
                return knot(i / 2);
            }
            let ends = [knot(i / 2), knot(i / 2 + 1)].concat();
            let mut row = vec![(i, 0.5)];
            for (control, by) in ends {
                match row.iter_mut().find(|(other, _)| *other == control) {
                    Some((_, sum)) => *sum += 0.25 * by,
                    None => row.push((control, 0.25 * by)),
                }
            }
            row
        };
        let of_control = |i: usize| match i {
            _ if !i.is_multiple_of(2) => vec![(i - 1, -0.5), (i, 2.0), (i + 1, -0.5)],
            _ if i == 0 || i == last => vec![(i, 1.0)],
            _ => Vec::new(),
        };
        Self { of_node: (0..=last).map(of_node).collect(), of_control: (0..=last).map(of_control).collect() }
    }
}

/// A rectangular grid of Q9 cells.
struct Lattice {
    /// The grid lines (m) across both directions, ascending.
    lines: [Vec<f64>; 2],
    /// The place of each node along both directions, knots and middles of spans counted; `None` where it is none of the grid.
    place: Vec<Option<[usize; 2]>>,
    /// The node at each place, row by row.
    node: Vec<u32>,
}

impl Lattice {
    fn number(&self, [i, j]: [usize; 2]) -> u32 {
        self.node[j * (2 * self.lines[0].len() - 1) + i]
    }

    /// The lattice of the cells of a mesh.
    ///
    /// # Errors
    /// Why they are none.
    fn of(mesh: &Mesh<2>) -> Result<Self, String> {
        if let Some(kind) = mesh.cells.kind.iter().find(|&&kind| kind != CellKind::Q9) {
            return Err(format!("the grid has {kind:?} cells"));
        }
        let cells = || (0..mesh.cells.len()).map(|c| mesh.cells.nodes(c).iter().map(|&n| mesh.nodes[n as usize]));
        let sides = |d: usize| {
            cells().map(move |nodes| {
                nodes.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x[d]), high.max(x[d])])
            })
        };
        let lines = [0, 1].map(|d| lines(sides(d).collect()));
        let [nx, ny] = lines.each_ref().map(|lines| lines.len().saturating_sub(1));
        if nx == 0 || mesh.cells.len() != nx * ny {
            return Err("the cells do not fill a rectangle on common grid lines".into());
        }
        let mut lattice =
            Self { place: vec![None; mesh.nodes.len()], node: vec![u32::MAX; (2 * nx + 1) * (2 * ny + 1)], lines };
        for c in 0..mesh.cells.len() {
            let nodes = mesh.cells.nodes(c);
            let middle = mesh.nodes[nodes[8] as usize];
            let cell = [0, 1].map(|d| span(&lattice.lines[d], middle[d]));
            for &n in nodes {
                let x = mesh.nodes[n as usize];
                let place = [0, 1].map(|d| lattice.place_of(d, cell[d], x[d]));
                let [Some(i), Some(j)] = place else {
                    return Err(format!(
                        "the cell at {middle:.4?} m is no rectangle along x and y on common grid lines"
                    ));
                };
                let at = &mut lattice.node[j * (2 * nx + 1) + i];
                if *at != u32::MAX && *at != n {
                    return Err(format!("there are two nodes at {x:.4?} m"));
                }
                *at = n;
                lattice.place[n as usize] = Some([i, j]);
            }
        }
        if lattice.node.contains(&u32::MAX) {
            return Err("the cells do not fill a rectangle on common grid lines".into());
        }
        Ok(lattice)
    }

    /// Where `x` (m) along direction `d` is in span `k`: at an end or in the middle.
    fn place_of(&self, d: usize, k: usize, x: f64) -> Option<usize> {
        let (from, to) = (self.lines[d][k], self.lines[d][k + 1]);
        let near = |at: f64| (x - at).abs() <= OFF * (to - from);
        [from, 0.5 * (from + to), to].into_iter().position(near).map(|place| 2 * k + place)
    }
}

/// The different ends of some intervals, ascending.
fn lines(sides: Vec<[f64; 2]>) -> Vec<f64> {
    let least = sides.iter().map(|[low, high]| high - low).fold(f64::INFINITY, f64::min);
    let mut ends: Vec<f64> = sides.into_iter().flatten().collect();
    ends.sort_unstable_by(f64::total_cmp);
    ends.dedup_by(|b, a| *b - *a <= OFF * least);
    ends
}

/// The span between ascending `lines` that `x` is in.
fn span(lines: &[f64], x: f64) -> usize {
    lines.partition_point(|line| *line <= x).clamp(1, lines.len() - 1) - 1
}
