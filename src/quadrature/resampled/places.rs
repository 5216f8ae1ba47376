//! Where the integration points of a cell are: at the Gauss points of a full cell, and at those of each triangle of the part
//! inside where the surface cuts it or materials meet in it.

use crate::geometry::twice_area;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, CellKind, MAX_NODES, rule};
use crate::surface::{Triangles, positive, triangles};

/// A smaller share of a cell is rounding.
const ROUNDING: f64 = 1e-14;

/// An integration point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Parametric coordinates in its cell.
    pub xi: [f64; 3],
    /// Position (m).
    pub x: [f64; 2],
    /// The volume (m³) that it stands for.
    pub weight: f64,
}

/// The degree that the points of a full cell integrate: the products of gradients of a cell that is affine, and its mass
/// as exactly as the order of the cell can use.
fn degree(kind: CellKind) -> usize {
    match kind {
        CellKind::Q8 | CellKind::Q9 => 4,
        CellKind::Q16 => 6,
        _ => 2,
    }
}

/// Parametric coordinates and weights.
type Rule = Vec<([f64; 3], f64)>;

/// Rules for full cells and for triangles of cut ones, made once: in the plane, and about an axis, where the radius is one
/// degree more.
pub struct Places {
    full: Vec<(CellKind, [Rule; 2])>,
    triangle: [Rule; 2],
    /// For triangles of cells of third order, whose stresses are of higher degree.
    fine: [Rule; 2],
}

impl Places {
    pub fn new() -> Self {
        let plane = CellKind::ALL.into_iter().filter(|kind| kind.dimension() == 2);
        let rules = |kind, degree| [rule(kind, degree), rule(kind, degree + 1)];
        Self {
            full: plane.map(|kind| (kind, rules(kind, degree(kind)))).collect(),
            triangle: rules(CellKind::T3, 2),
            fine: rules(CellKind::T3, 4),
        }
    }

    /// The points of a cell that is full.
    pub fn full<K: Kinematics<2>>(&self, mesh: &Mesh<2>, cell: usize, out: &mut Vec<Place>) {
        let cell = Shape::new(mesh, cell);
        for (_, rules) in self.full.iter().filter(|(kind, _)| *kind == cell.kind) {
            out.extend(rules[usize::from(K::HOOP)].iter().map(|(xi, weight)| cell.place::<K>(*xi, *weight)));
        }
    }

    /// The points of the part of a cell in which the level set with the nodal `values` is positive, triangle by triangle.
    pub fn cut<K: Kinematics<2>>(&self, mesh: &Mesh<2>, cell: usize, values: &[f64], out: &mut Vec<Place>) {
        let cell = Shape::new(mesh, cell);
        let split = Triangles::of(cell.kind, &cell.x);
        let rules = if cell.kind.order() > 2 { &self.fine } else { &self.triangle };
        let of_triangle = |triangle: &[usize; 3]| twice_area(&split.corners(triangle));
        let whole: f64 = triangles(cell.kind).iter().map(of_triangle).sum();
        for triangle in triangles(cell.kind) {
            let at = split.corners(triangle);
            let twice = twice_area(&at);
            positive(&triangle.map(|i| values[i]), |piece, fraction| {
                if twice * fraction <= ROUNDING * whole {
                    return;
                }
                let [a, b, c] = piece.map(|l| [0, 1].map(|d| l[0] * at[0][d] + l[1] * at[1][d] + l[2] * at[2][d]));
                for ([s, t, _], weight) in &rules[usize::from(K::HOOP)] {
                    let place = [0, 1].map(|d| a[d] + s * (b[d] - a[d]) + t * (c[d] - a[d]));
                    let ([x, y], weight) = (split.parametric(&place), weight * twice * fraction);
                    let mut found = cell.place::<K>([x, y, 0.0], weight);
                    if split.in_space() {
                        found.weight = weight * K::measure(&found.x);
                    }
                    out.push(found);
                }
            });
        }
    }
}

/// The nodes (m) of a cell.
struct Shape {
    kind: CellKind,
    x: [[f64; 2]; MAX_NODES],
}

impl Shape {
    fn new(mesh: &Mesh<2>, cell: usize) -> Self {
        Self { kind: mesh.cells.kind[cell], x: mesh.coordinates(cell) }
    }

    fn place<K: Kinematics<2>>(&self, xi: [f64; 3], weight: f64) -> Place {
        let count = self.kind.node_count();
        let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        let det = shape::map(self.kind, &self.x[..count], &xi, &mut n, &mut gradient);
        let x = [0, 1].map(|d| n.iter().zip(&self.x[..count]).map(|(n, x)| n * x[d]).sum());
        Place { xi, x, weight: weight * det * K::measure(&x) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Axisymmetric, PlaneStrain};
    use crate::mesh::builder::rectangle;
    use crate::surface::Geometry;

    /// A full cell, and the two parts of a cut one, hold the moments of the cell to degree 2, in the plane and about the axis,
    /// where the radius comes on top.
    fn check<K: Kinematics<2>>() {
        for kind in CellKind::ALL.into_iter().filter(|kind| kind.dimension() == 2) {
            let mesh = rectangle(kind, 1.0, 1.0, 3, 3, 0.2, 4);
            let geometry = Geometry::new::<K>(&mesh);
            let places = Places::new();
            for c in 0..mesh.cells.len() {
                let values: Vec<f64> = mesh
                    .cells
                    .nodes(c)
                    .iter()
                    .map(|&n| mesh.nodes[n as usize])
                    .map(|x| x[0] - 0.7 * x[1] - 0.1)
                    .collect();
                let other: Vec<f64> = values.iter().map(|v| -v).collect();
                let (mut full, mut parts) = (Vec::new(), Vec::new());
                places.full::<K>(&mesh, c, &mut full);
                places.cut::<K>(&mesh, c, &values, &mut parts);
                places.cut::<K>(&mesh, c, &other, &mut parts);
                let exact = geometry.whole[c];
                let moments = |places: &[Place]| {
                    let mut sum = [0.0; 6];
                    for place in places {
                        let [x, y] = geometry.frame[c].local(&place.x);
                        for (sum, m) in sum.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                            *sum += place.weight * m;
                        }
                    }
                    sum
                };
                let holds = |places: &[Place], count: usize, part: &str| {
                    let got = moments(places);
                    let close = got.iter().zip(&exact).take(count).all(|(a, b)| (a - b).abs() < 1e-12 * exact[0]);
                    assert!(close, "{kind:?} {part}: {got:?} {exact:?}");
                };
                // Cells of first order have first moments: their stress is constant, or linear beside the radius.
                let first = kind == CellKind::T3 || (kind == CellKind::Q4 && K::HOOP);
                holds(&full, if first { 3 } else { 6 }, "full");
                holds(&parts, 6, "parts");
            }
        }
    }

    #[test]
    fn volumes_and_moments_of_full_and_cut_cells_are_exact() {
        check::<PlaneStrain>();
        check::<Axisymmetric>();
    }
}
