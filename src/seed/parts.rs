//! The parts into which a cell is divided among its points.

use crate::mesh::shape::{CellKind, rule};

/// In place of a number of points: those of a quadrature rule for polynomials of degree 4, six in a triangle, nine in a
/// quadrilateral, 15 in a tetrahedron and 27 in a hexahedron. Finite elements have them.
pub const QUADRATURE: u32 = 0;

/// The same for 2 × 2 points of a quadrilateral with eight nodes: a strip of such bends as a beam does.
pub const SECTIONS: u32 = u32::MAX;

/// A part of the parametric domain with its point.
pub struct Part {
    pub point: [f64; 3],
    /// Places and weights that integrate over the part exactly; the weights sum to its parametric measure.
    pub quadrature: Vec<([f64; 3], f64)>,
}

/// A rule that integrates `r det J` exactly in the plane: degree 4 on T6, degree 5 in each direction on Q9; and `det J` in
/// space: degree 3 on T10, degree 5 in each direction on H27.
pub fn exact_rule(kind: CellKind) -> Vec<([f64; 3], f64)> {
    rule(kind, if kind.is_simplex() { 4 } else { 5 })
}

/// The numbers of points that cells of a kind can have, as a message offers them.
pub fn possible(kind: CellKind) -> &'static str {
    match (kind.dimension(), kind.is_simplex()) {
        (3, true) => "4, 8, 15, 24 or 64",
        (3, false) => "8, 27 or 64",
        (_, true) => "3, 4, 6, 7, 9, 12, 16 or 25",
        (_, false) => "4, 9, 16 or 25",
    }
}

/// The parts of a cell with `count` points; `None` where there is no rule.
pub fn parts(kind: CellKind, count: u32) -> Option<Vec<Part>> {
    let gauss = |degree| {
        let points = rule(kind, degree).into_iter();
        Some(points.map(|(point, w)| Part { point, quadrature: vec![(point, w)] }).collect())
    };
    match (kind.dimension(), kind.is_simplex(), count) {
        (2 | 3, _, QUADRATURE) => gauss(4),
        (2, false, SECTIONS) => gauss(3),
        (2, true, 4 | 9 | 16 | 25) => Some(sub_triangles(kind, count.isqrt())),
        (2, true, 3) => gauss(2),
        (2, true, 6) => gauss(4),
        (2, true, 7) => gauss(5),
        (2, true, 12) => gauss(6),
        (2, false, 1 | 4 | 9 | 16 | 25) => Some(sub_boxes(kind, count.isqrt())),
        (3, true, 4) => gauss(2),
        (3, true, 8) => Some(sub_tetrahedra(kind, 1)),
        (3, true, 15) => gauss(5),
        (3, true, 24) => gauss(6),
        (3, true, 64) => Some(sub_tetrahedra(kind, 2)),
        (3, false, 1 | 8 | 27 | 64) => (1..=4).find(|k: &u32| k.pow(3) == count).map(|k| sub_boxes(kind, k)),
        _ => None,
    }
}

/// The `k²` triangles into which `k` parallels to every side cut the parametric triangle.
fn sub_triangles(kind: CellKind, k: u32) -> Vec<Part> {
    let size = 1.0 / f64::from(k);
    let part = |corner: [f64; 2], sign: f64| {
        let at = |xi: &[f64; 3]| [corner[0] + sign * size * xi[0], corner[1] + sign * size * xi[1], 0.0];
        let quadrature = exact_rule(kind).iter().map(|(xi, w)| (at(xi), w * size * size)).collect();
        Part { point: at(&kind.centre()), quadrature }
    };
    let mut parts = Vec::new();
    for j in 0..k {
        for i in 0..k - j {
            let corner = |i: u32, j: u32| [size * f64::from(i), size * f64::from(j)];
            parts.push(part(corner(i, j), 1.0));
            if i + 1 < k - j {
                parts.push(part(corner(i + 1, j + 1), -1.0));
            }
        }
    }
    parts
}

/// The `8^halvings` tetrahedra of equal volume into which the parametric one is cut by halving its edges again and again:
/// four at its corners, four in the octahedron between them (Bey 1995).
fn sub_tetrahedra(kind: CellKind, halvings: u32) -> Vec<Part> {
    const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// The edges whose middles are corners, by their ends; both ends alike are a corner of the whole.
    const EIGHTHS: [[[usize; 2]; 4]; 8] = [
        [[0, 0], [0, 1], [0, 2], [0, 3]],
        [[0, 1], [1, 1], [1, 2], [1, 3]],
        [[0, 2], [1, 2], [2, 2], [2, 3]],
        [[0, 3], [1, 3], [2, 3], [3, 3]],
        [[0, 1], [0, 2], [0, 3], [1, 3]],
        [[0, 1], [0, 2], [1, 2], [1, 3]],
        [[0, 2], [0, 3], [1, 3], [2, 3]],
        [[0, 2], [1, 2], [1, 3], [2, 3]],
    ];
    let mut all = vec![CORNERS];
    for _ in 0..halvings {
        let middle = |x: &[[f64; 3]; 4], [a, b]: [usize; 2]| [0, 1, 2].map(|d| 0.5 * (x[a][d] + x[b][d]));
        all = all.iter().flat_map(|x| EIGHTHS.map(|part| part.map(|ends| middle(x, ends)))).collect();
    }
    let measure = 1.0 / all.len() as f64;
    let part = |x: &[[f64; 3]; 4]| {
        let at = |xi: &[f64; 3]| {
            let along = |d: usize| (0..3).map(|k| xi[k] * (x[k + 1][d] - x[0][d])).sum::<f64>();
            [0, 1, 2].map(|d| x[0][d] + along(d))
        };
        let quadrature = exact_rule(kind).iter().map(|(xi, w)| (at(xi), w * measure)).collect();
        Part { point: at(&kind.centre()), quadrature }
    };
    all.iter().map(part).collect()
}

/// The `k × k` equal boxes of the parametric square, the `k × k × k` of the cube.
fn sub_boxes(kind: CellKind, k: u32) -> Vec<Part> {
    let size = 1.0 / f64::from(k);
    let centre = |i: u32| size * f64::from(2 * i + 1) - 1.0;
    let solid = kind.dimension() == 3;
    let mut parts = Vec::new();
    for l in 0..if solid { k } else { 1 } {
        let (height, measure) = if solid { (centre(l), size * size * size) } else { (0.0, size * size) };
        for j in 0..k {
            for i in 0..k {
                let at = |xi: &[f64; 3]| [centre(i) + size * xi[0], centre(j) + size * xi[1], height + size * xi[2]];
                let quadrature = exact_rule(kind).iter().map(|(xi, w)| (at(xi), w * measure)).collect();
                parts.push(Part { point: at(&[0.0; 3]), quadrature });
            }
        }
    }
    parts
}
