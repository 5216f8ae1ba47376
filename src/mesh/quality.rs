//! How good the cells of a plane mesh are, and that none is inverted, flat or folded.
//!
//! The quality of a triangle is `4√3 A / (l1² + l2² + l3²)` of its corners: 1 if equilateral, 0 if flat. That
//! of a quadrilateral is the least over its corners of `2 (a × b) / (|a|² + |b|²)` with the edges `a`, `b`
//! that meet there: 1 for a square. A curved cell is valid where `det J > 0` throughout, for which it is
//! enough that all Bernstein coefficients of this polynomial are positive (Johnen, Remacle & Geuzaine 2013,
//! *Geometrical validity of curvilinear finite elements*).

use std::fmt;
use std::path::Path;

use super::Mesh;
use super::conformity;
use super::shape::{self, CellKind, MAX_NODES};
use crate::error::{Error, Result};
use crate::geometry::{cross, dot, way};

/// Up to this quality a cell counts as flat, and up to this ratio of the least to the largest Bernstein coefficient of
/// `det J` as folded: at the fourth root of the rounding of `f64` half of the digits of its stiffness are lost.
const WORST: f64 = 1.2e-4;

/// Places nearer to each other than this part of the extent of a mesh (-) are the same.
pub const SAME: f64 = 1e-9;

/// What a mesh is like.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub nodes: usize,
    /// Cells by kind, in the order of [`CellKind::ALL`], kinds that are there only.
    pub cells: Vec<(CellKind, usize)>,
    /// Name, number of cells and area in m² of every region.
    pub regions: Vec<(String, usize, f64)>,
    /// Least quality, the cell that has it and the place of its centre.
    pub worst: (f64, usize, [f64; 2]),
    pub mean: f64,
    /// Least ratio, over the cells, of the least to the largest Bernstein coefficient of `det J`: 1 where
    /// every cell is an affine image.
    pub jacobian: f64,
}

/// Checks `mesh`, read from `file`, and sums it up.
///
/// # Errors
/// Input: a cell that is inverted, flat or folded, with its number, region and place; cells that do not fit together
/// ([`conformity`]).
pub fn check(mesh: &Mesh<2>, file: &Path) -> Result<Summary> {
    let mut regions: Vec<_> = mesh.regions.iter().map(|name| (name.clone(), 0, 0.0)).collect();
    let (mut worst, mut sum, mut jacobian) = ((f64::INFINITY, 0, [0.0; 2]), 0.0, f64::INFINITY);
    let mut x = Vec::new();
    for c in 0..mesh.cells.len() {
        let kind = mesh.cells.kind[c];
        mesh.cell_coordinates(c, &mut x);
        let corners = &x[..kind.corner_count()];
        let quality = quality(corners);
        let region = &mut regions[usize::from(mesh.cells.region[c])];
        let coefficients = Coefficients::of(kind, &x);
        let (least, largest) = coefficients.range();
        let finite = x.iter().flatten().all(|v| v.is_finite());
        // What is not a number is neither.
        let (shaped, unfolded) = (quality > WORST, least > WORST * largest);
        if !finite || !shaped || !unfolded {
            let (problem, remedy) = if shaped && kind.order() > 1 {
                ("its curved edges fold it over", "refine the mesh along the curve there, or use order: 1")
            } else {
                ("it is inverted or flat", "mend the geometry there, or refine the mesh")
            };
            let place = conformity::place_of(mesh, c, file);
            let problem = format!("{problem} (quality {quality:.1e}, det J {least:.3e} to {largest:.3e})");
            return Err(Error::input(place, problem, remedy));
        }
        region.1 += 1;
        region.2 += coefficients.integral(kind);
        sum += quality;
        jacobian = jacobian.min(least / largest);
        if quality < worst.0 {
            worst = (quality, c, mesh.centre(c));
        }
    }
    conformity::check(mesh, file)?;
    let count = |kind| mesh.cells.kind.iter().filter(|&&k| k == kind).count();
    let cells = CellKind::ALL.into_iter().map(|k| (k, count(k))).filter(|(_, n)| *n > 0).collect();
    let mean = sum / mesh.cells.len() as f64;
    Ok(Summary { nodes: mesh.nodes.len(), cells, regions, worst, mean, jacobian })
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let total: usize = self.cells.iter().map(|(_, n)| n).sum();
        let kinds: Vec<_> = self.cells.iter().map(|(kind, n)| format!("{n} {kind:?}")).collect();
        writeln!(f, "{total} cells ({}), {} nodes", kinds.join(", "), self.nodes)?;
        for (name, count, area) in &self.regions {
            writeln!(f, "region {name}: {count} cells, {area:.6} m²")?;
        }
        let (least, cell, [x, y]) = self.worst;
        writeln!(f, "quality: least {least:.3} (cell {cell} near ({x:.3}, {y:.3})), mean {:.3}", self.mean)?;
        write!(f, "det J, least to largest in a cell: {:.3}", self.jacobian)
    }
}

/// The nodes at each place where there are several: nearer to each other than [`SAME`], by rounding to a lattice of that size.
pub fn coincident(nodes: &[[f64; 2]]) -> Vec<Vec<u32>> {
    let bound = |d: usize| nodes.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x[d]), b.max(x[d])));
    let [(left, right), (bottom, top)] = [0, 1].map(bound);
    let size = SAME * (right - left).max(top - bottom);
    let mut places: Vec<_> = (0u32..).zip(nodes).map(|(n, x)| (x.map(|v| (v / size).round() as i64), n)).collect();
    places.sort_unstable();
    let same = places.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1);
    same.map(|same| same.iter().map(|(_, n)| *n).collect()).collect()
}

/// Quality of a triangle or quadrilateral with these corners (-): 1 at best, 0 if flat, negative if inverted.
pub fn quality(corners: &[[f64; 2]]) -> f64 {
    let edge = |i: usize, j: usize| way(&corners[i % corners.len()], &corners[j % corners.len()]);
    let square = |a: [f64; 2]| dot(&a, &a);
    if corners.len() == 3 {
        let squares = square(edge(0, 1)) + square(edge(1, 2)) + square(edge(2, 0));
        return 2.0 * 3f64.sqrt() * cross(&edge(0, 1), &edge(0, 2)) / squares;
    }
    let corner = |i: usize| {
        let (a, b) = (edge(i, i + 1), edge(i, i + corners.len() - 1));
        2.0 * cross(&a, &b) / (square(a) + square(b))
    };
    (0..corners.len()).map(corner).fold(f64::INFINITY, f64::min)
}

fn determinant(kind: CellKind, x: &[[f64; 2]], xi: &[f64; 3]) -> f64 {
    let (mut n, mut grad) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
    shape::map(kind, x, xi, &mut n, &mut grad)
}

/// Least and largest Bernstein coefficient of `det J` (m²), between which all its values lie.
pub fn jacobian_range(kind: CellKind, x: &[[f64; 2]]) -> (f64, f64) {
    Coefficients::of(kind, x).range()
}

/// The Bernstein coefficients of `det J` of a cell (m²).
struct Coefficients {
    value: [f64; 36],
    count: usize,
}

impl Coefficients {
    fn of(kind: CellKind, x: &[[f64; 2]]) -> Self {
        let at = |xi: [f64; 3]| determinant(kind, x, &xi);
        let (mut value, mut count) = ([0.0; 36], 0);
        let mut take = |coefficient| {
            value[count] = coefficient;
            count += 1;
        };
        match kind {
            CellKind::T6 => {
                // Degree 2 on the triangle, from the values at the six nodes.
                let mut node = [0.0; 6];
                node.iter_mut().zip(kind.node_coordinates()).for_each(|(value, &xi)| *value = at(xi));
                node[..3].iter().for_each(|&corner| take(corner));
                (0..3).for_each(|i| take(2.0 * node[3 + i] - 0.5 * (node[i] + node[(i + 1) % 3])));
            }
            CellKind::Q8 | CellKind::Q9 => {
                // Degree 3 in each direction, from values at 4 × 4 equal distances.
                let third = |i: usize| 2.0 / 3.0 * i as f64 - 1.0;
                let rows = [0, 1, 2, 3].map(|j| bernstein([0, 1, 2, 3].map(|i| at([third(i), third(j), 0.0]))));
                (0..4).for_each(|i| bernstein([0, 1, 2, 3].map(|j: usize| rows[j][i])).into_iter().for_each(&mut take));
            }
            CellKind::Q16 => {
                // Degree 5 in each direction, from values at 6 × 6 equal distances.
                let place = |i: usize| 0.4 * i as f64 - 1.0;
                let rows: [_; 6] =
                    std::array::from_fn(|j| quintic(std::array::from_fn(|i| at([place(i), place(j), 0.0]))));
                (0..6).for_each(|i| quintic(std::array::from_fn(|j| rows[j][i])).into_iter().for_each(&mut take));
            }
            // Constant on a T3, linear in each direction on a Q4: the corners tell.
            _ => kind.node_coordinates().iter().for_each(|&xi| take(at(xi))),
        }
        Self { value, count }
    }

    fn range(&self) -> (f64, f64) {
        let range = (f64::INFINITY, f64::NEG_INFINITY);
        self.value[..self.count].iter().fold(range, |(low, high), &b| (low.min(b), high.max(b)))
    }

    /// The area of the cell (m²): all Bernstein polynomials of a degree have the same integral.
    fn integral(&self, kind: CellKind) -> f64 {
        let reference = if kind.is_simplex() { 0.5 } else { 4.0 };
        reference * self.value[..self.count].iter().sum::<f64>() / self.count as f64
    }
}

/// Bernstein coefficients of the polynomial of fifth degree with the values `f` at six equal distances.
fn quintic(f: [f64; 6]) -> [f64; 6] {
    const SECOND: [f64; 6] = [-154.0, 600.0, -600.0, 400.0, -150.0, 24.0];
    const THIRD: [f64; 6] = [134.5, -725.0, 1475.0, -1150.0, 462.5, -77.0];
    let sum = |weights: [f64; 6], backwards: bool| {
        let value = |i: usize| if backwards { f[5 - i] } else { f[i] };
        weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum::<f64>() / 120.0
    };
    [f[0], sum(SECOND, false), sum(THIRD, false), sum(THIRD, true), sum(SECOND, true), f[5]]
}

/// Bernstein coefficients of the cubic with the values `f` at four equal distances.
fn bernstein(f: [f64; 4]) -> [f64; 4] {
    [
        f[0],
        (-5.0 * f[0] + 18.0 * f[1] - 9.0 * f[2] + 2.0 * f[3]) / 6.0,
        (2.0 * f[0] - 9.0 * f[1] + 18.0 * f[2] - 5.0 * f[3]) / 6.0,
        f[3],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;

    fn plane_kinds() -> impl Iterator<Item = CellKind> {
        CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
    }

    #[test]
    fn quality_of_known_shapes() {
        let height = 3f64.sqrt() / 2.0;
        assert!((quality(&[[0.0, 0.0], [1.0, 0.0], [0.5, height]]) - 1.0).abs() < 1e-15);
        // Right isosceles: 4√3 (1/2) / 4.
        assert!((quality(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - height).abs() < 1e-15);
        assert_eq!(quality(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]), 1.0);
        // A rectangle 1 × 2: 2·2/(1 + 4).
        assert!((quality(&[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]]) - 0.8).abs() < 1e-15);
        assert!(quality(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]) < 0.0);
    }

    #[test]
    fn the_summary_counts_and_names_the_worst() {
        for kind in plane_kinds() {
            let mut mesh = rectangle(kind, 3.0, 2.0, 6, 4, 0.0, 0);
            let even = check(&mesh, Path::new("mesh.msh")).unwrap();
            // The coefficients of fifth degree of a Q16 multiply rounding by 1e4.
            let rounding = if kind == CellKind::Q16 { 1e-11 } else { 1e-12 };
            assert!((even.mean - even.worst.0).abs() < 1e-14, "{kind:?}: {even:?}");
            assert!((even.jacobian - 1.0).abs() < rounding, "{kind:?}: {even:?}");
            // Move a corner that six or four cells share.
            let moved = mesh.nodes.iter().position(|x| *x == [1.5, 1.0]).unwrap();
            mesh.nodes[moved] = [1.53, 1.03];
            let summary = check(&mesh, Path::new("mesh.msh")).unwrap();
            let count = if kind.is_simplex() { 48 } else { 24 };
            assert_eq!(summary.cells, [(kind, count)]);
            assert!((summary.regions[0].2 - 6.0).abs() < 1e-12);
            assert!(summary.worst.0 < even.worst.0 && mesh.cells.nodes(summary.worst.1).contains(&(moved as u32)));
            assert!(summary.to_string().contains(&format!("{count} cells ({count} {kind:?})")), "{summary}");
        }
    }

    #[test]
    fn bernstein_coefficients_bound_the_jacobian() {
        for kind in plane_kinds() {
            let mut mesh = rectangle(kind, 1.0, 1.0, 2, 2, 0.2, 9);
            for x in &mut mesh.nodes {
                *x = [x[0] + 0.1 * (3.0 * x[1]).sin(), x[1] + 0.1 * x[0] * x[0]];
            }
            let mut x = Vec::new();
            for c in 0..mesh.cells.len() {
                mesh.cell_coordinates(c, &mut x);
                let coefficients = Coefficients::of(kind, &x);
                let (least, largest) = coefficients.range();
                let mut seen = (f64::INFINITY, f64::NEG_INFINITY);
                for i in 0..=20 {
                    for j in 0..=20 {
                        let (a, b) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                        let xi = if kind.is_simplex() {
                            [a * (1.0 - b), b, 0.0]
                        } else {
                            [2.0 * a - 1.0, 2.0 * b - 1.0, 0.0]
                        };
                        let det = determinant(kind, &x, &xi);
                        seen = (seen.0.min(det), seen.1.max(det));
                    }
                }
                assert!(least <= seen.0 + 1e-14 && seen.1 <= largest + 1e-14, "{kind:?}");
                // They are sharp to the curvature: no wild bounds.
                assert!(
                    seen.0 - least < 0.2 * seen.0 && largest - seen.1 < 0.2 * seen.1,
                    "{kind:?} {least} {seen:?} {largest}"
                );
            }
        }
    }

    #[test]
    fn inverted_flat_and_folded_cells_are_refused_with_their_place() {
        for kind in plane_kinds() {
            let whole = rectangle(kind, 3.0, 2.0, 3, 2, 0.0, 0);
            let refused = |mesh: &Mesh<2>| check(mesh, Path::new("out/mesh.msh")).unwrap_err().to_string();
            let mut mesh = whole.clone();
            mesh.nodes[0] = [1.5, 1.5];
            let message = refused(&mesh);
            assert!(message.contains("out/mesh.msh, cell 0 of region soil near ("), "{message}");
            let mut mesh = whole.clone();
            mesh.nodes[0] = [f64::NAN, 0.0];
            assert!(refused(&mesh).contains("cell 0"));
            if kind.order() == 2 {
                // A mid-side pulled through its cell: the corners alone look right.
                let mut mesh = whole.clone();
                let facet = &mesh.group("bottom").unwrap().facets[1].1;
                let middle = facet[2] as usize;
                mesh.nodes[middle] = [1.5, 1.2];
                assert!(refused(&mesh).contains("fold"), "{kind:?}");
            }
        }
    }
}
