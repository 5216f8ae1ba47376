//! B-splines of second and third degree on rectangular grids of Q9 and Q16 cells: gradients that are continuous from cell to cell
//! (Tielen, Wobbes, Möller & Beuth 2017, *A high order material point method*; Steffen, Kirby & Berzins 2008). The degree is the order of the
//! cells.
//!
//! On each cell the tensor products of splines with simple knots at the grid lines and open ends are polynomials of their degree along both axes,
//! so they are the linear constraints `u = E c` on the nodal values of the cells (Bézier extraction: Borden, Scott, Evans & Hughes 2011), and the
//! points see the shape functions of their cells as in the plain method.
//!
//! *Second degree.* There is one control value a cell, one an edge on the boundary and one a corner of the grid. The Greville abscissa of a control
//! is the middle of its span, also where the spacing varies: it has the number of the node there. In one dimension, with the lengths `h` of the
//! spans on both sides of a knot and controls `c` in their middle,
//! `u_knot = (h_right c_left + h_left c_right)/(h_left + h_right)`, at the ends `u = c`, and in the middle of a span
//! `u = ¼ u_left + ½ c + ¼ u_right`, so that `c = 2 u − ½ (u_left + u_right)`.
//!
//! *Third degree.* There is one control a grid line, and one more in the first and the last span. A control has the number of the node on its line, or
//! of that a third of a span from the end: where the lines are evenly spaced, these are the Greville abscissae. Nodal values are the splines there
//! (recurrence of Cox and de Boor). A control is the polar form of the cubic of a span at the line and those on both sides of it
//! (blossom: Ramshaw 1989); here it is the mean of those of both spans at the line.

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
        matches!(kind, CellKind::Q9 | CellKind::Q16)
    }

    fn refusal(&self, mesh: &Mesh<2>) -> Option<[String; 2]> {
        let problem = Lattice::of(mesh).err()?;
        Some([
            format!("takes a rectangular grid of Q9 or Q16 cells, and {problem}"),
            "make the grid one rectangle along x and y with `Transfinite Curve`, `Transfinite Surface` and `Recombine Surface` in the .geo and cells of second or third order, or choose `gradient: mpm`".into(),
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
        let of_degree = if lattice.degree == 3 { Splines::cubic } else { Splines::quadratic };
        let along = lattice.lines.each_ref().map(|lines| of_degree(lines));
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

/// Splines along one direction, by places: knot `k` is the place `p k` with the degree `p`, and between knots are `p − 1` of them at equal distances.
struct Splines {
    /// The controls of each place with their coefficients.
    of_node: Vec<Vec<(usize, f64)>>,
    /// The places that give the value of the control at each place; empty where there is none.
    of_control: Vec<Vec<(usize, f64)>>,
}

impl Splines {
    /// Of second degree, with the knots `x` (m), ascending.
    fn quadratic(x: &[f64]) -> Self {
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

    /// Of third degree, with the knots `x` (m), ascending.
    fn cubic(x: &[f64]) -> Self {
        let spans = x.len() - 1;
        // Ends three times more: control `k` has its support between knots `k` and `k + 4`.
        let knot = |k: usize| x[k.saturating_sub(3).min(spans)];
        let place = |control: usize| match control {
            0 | 1 => control,
            _ if control + 1 < spans + 2 => 3 * (control - 1),
            _ => 3 * spans + control - (spans + 2),
        };
        let of_node = |i: usize| {
            let span = (i / 3).min(spans - 1);
            let at = x[span] + (x[span + 1] - x[span]) * (i - 3 * span) as f64 / 3.0;
            let values = cox_de_boor(knot, span + 3, at);
            let all = values.into_iter().enumerate().map(|(k, value)| (place(span + k), value));
            all.filter(|(_, value)| *value != 0.0).collect()
        };
        let mut of_control = vec![Vec::new(); 3 * spans + 1];
        for control in 0..spans + 3 {
            let around = [1, 2, 3].map(|i| knot(control + i));
            // The spans at the middle one.
            let line = (control.saturating_sub(1)).min(spans);
            let of: Vec<usize> = (line.saturating_sub(1)..=line.min(spans - 1)).collect();
            let row: &mut Vec<(usize, f64)> = &mut of_control[place(control)];
            for &span in &of {
                let parameter = around.map(|t| (t - x[span]) / (x[span + 1] - x[span]));
                for (i, by) in polar_form(parameter).into_iter().enumerate() {
                    let by = by / of.len() as f64;
                    match row.iter_mut().find(|(other, _)| *other == 3 * span + i) {
                        Some((_, sum)) => *sum += by,
                        None if by != 0.0 => row.push((3 * span + i, by)),
                        None => {}
                    }
                }
            }
        }
        Self { of_node: (0..=3 * spans).map(of_node).collect(), of_control }
    }
}

/// The four cubic B-splines that are not zero between knots `span` and `span + 1`, at `x` there.
fn cox_de_boor(knot: impl Fn(usize) -> f64, span: usize, x: f64) -> [f64; 4] {
    let mut value = [1.0, 0.0, 0.0, 0.0];
    for degree in 1..=3 {
        let mut from_left = 0.0;
        for k in 0..degree {
            let (low, high) = (knot(span + 1 + k - degree), knot(span + 1 + k));
            let own = value[k];
            value[k] = from_left + own * ((high - x) / (high - low));
            from_left = own * ((x - low) / (high - low));
        }
        value[degree] = from_left;
    }
    value
}

/// What the values of a cubic at 0, ⅓, ⅔ and 1 add to its polar form, the symmetric function of three arguments that is linear in each and the cubic
/// where they are equal.
fn polar_form([a, b, c]: [f64; 3]) -> [f64; 4] {
    let (first, second, third) = ((a + b + c) / 3.0, (a * b + b * c + c * a) / 3.0, a * b * c);
    [
        1.0 - 5.5 * first + 9.0 * second - 4.5 * third,
        9.0 * first - 22.5 * second + 13.5 * third,
        -4.5 * first + 18.0 * second - 13.5 * third,
        first - 4.5 * second + 4.5 * third,
    ]
}

/// A rectangular grid of Q9 or Q16 cells.
struct Lattice {
    /// The order of the cells, and the degree of the splines.
    degree: usize,
    /// The grid lines (m) across both directions, ascending.
    lines: [Vec<f64>; 2],
    /// The place of each node along both directions ([`Splines`]); `None` where it is none of the grid.
    place: Vec<Option<[usize; 2]>>,
    /// The node at each place, row by row.
    node: Vec<u32>,
}

impl Lattice {
    fn number(&self, [i, j]: [usize; 2]) -> u32 {
        self.node[j * (self.degree * (self.lines[0].len() - 1) + 1) + i]
    }

    /// The lattice of the cells of a mesh.
    ///
    /// # Errors
    /// Why they are none.
    fn of(mesh: &Mesh<2>) -> Result<Self, String> {
        let first = mesh.cells.kind.first().copied().unwrap_or(CellKind::Q9);
        let fits = |kind: CellKind| kind == first && BSpline.takes(kind);
        if let Some(kind) = mesh.cells.kind.iter().find(|&&kind| !fits(kind)) {
            return Err(format!("the grid has {kind:?} cells"));
        }
        let degree = first.order();
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
        let [along_x, along_y] = [nx, ny].map(|spans| degree * spans + 1);
        let mut lattice =
            Self { degree, place: vec![None; mesh.nodes.len()], node: vec![u32::MAX; along_x * along_y], lines };
        for c in 0..mesh.cells.len() {
            let nodes = mesh.cells.nodes(c);
            let corner = |i: usize| mesh.nodes[nodes[i] as usize];
            let middle = if degree == 2 { corner(8) } else { [0, 1].map(|d| 0.5 * (corner(0)[d] + corner(2)[d])) };
            let cell = [0, 1].map(|d| span(&lattice.lines[d], middle[d]));
            for &n in nodes {
                let x = mesh.nodes[n as usize];
                let place = [0, 1].map(|d| lattice.place_of(d, cell[d], x[d]));
                let [Some(i), Some(j)] = place else {
                    return Err(format!(
                        "the cell at {middle:.4?} m is no rectangle along x and y on common grid lines"
                    ));
                };
                let at = &mut lattice.node[j * along_x + i];
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

    /// Where `x` (m) along direction `d` is in span `k`: at an end or at a place between them.
    fn place_of(&self, d: usize, k: usize, x: f64) -> Option<usize> {
        let (from, to) = (self.lines[d][k], self.lines[d][k + 1]);
        let near = |at: f64| (x - at).abs() <= OFF * (to - from);
        let place = |i: &usize| from + (to - from) * *i as f64 / self.degree as f64;
        (0..=self.degree).find(|i| near(place(i))).map(|i| self.degree * k + i)
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
