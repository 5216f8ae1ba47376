//! The straight triangles into which the nodes of a cell split it, and the parts of a
//! triangle where a linear function is positive.

use crate::mesh::shape::CellKind;

/// Barycentric coordinates in a triangle.
pub type Barycentric = [f64; 3];

/// The corners of a triangle.
pub const CORNERS: [Barycentric; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The triangles between the nodes of a plane kind, counter-clockwise, as local node numbers. Two cells that
/// share an edge split it alike.
pub fn triangles(kind: CellKind) -> &'static [[usize; 3]] {
    match kind {
        CellKind::T3 => &[[0, 1, 2]],
        CellKind::T6 => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        CellKind::Q4 => &[[0, 1, 2], [0, 2, 3]],
        CellKind::Q8 => &[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]],
        CellKind::Q9 => &[[0, 4, 8], [4, 1, 8], [1, 5, 8], [5, 2, 8], [2, 6, 8], [6, 3, 8], [3, 7, 8], [7, 0, 8]],
        CellKind::Q16 => &[
            [0, 4, 12],
            [0, 12, 11],
            [4, 5, 13],
            [4, 13, 12],
            [5, 1, 6],
            [5, 6, 13],
            [11, 12, 15],
            [11, 15, 10],
            [12, 13, 14],
            [12, 14, 15],
            [13, 6, 7],
            [13, 7, 14],
            [10, 15, 9],
            [10, 9, 3],
            [15, 14, 8],
            [15, 8, 9],
            [14, 7, 2],
            [14, 2, 8],
        ],
        CellKind::Point1 | CellKind::Line2 | CellKind::Line3 | CellKind::Line4 | CellKind::T10 | CellKind::H27 => &[],
    }
}

/// The parametric coordinates of the corners of one of the [`triangles`] of a kind.
pub fn corners(kind: CellKind, triangle: &[usize; 3]) -> [[f64; 2]; 3] {
    triangle.map(|i| {
        let xi = kind.node_coordinates()[i];
        [xi[0], xi[1]]
    })
}

/// Calls `piece(corners, fraction)` for at most two triangles that cover the part of a triangle where the linear
/// function with the values `v` at its corners is positive. The corners are barycentric and run as those of the
/// triangle do; `fraction` is the piece's share of the area, positive and with full relative accuracy however
/// thin the piece is.
pub fn positive(v: &[f64; 3], mut piece: impl FnMut(&[Barycentric; 3], f64)) {
    // Where the function vanishes between a positive corner `i` and another one `j`, as a share of their distance.
    let share = |i: usize, j: usize| v[i] / (v[i] - v[j]);
    let between = |i: usize, j: usize, t: f64| {
        let mut l = [0.0; 3];
        (l[i], l[j]) = (1.0 - t, t);
        l
    };
    let inside = v.map(|v| v > 0.0);
    match inside.iter().filter(|&&inside| inside).count() {
        0 => {}
        1 => {
            let i = inside.iter().position(|&inside| inside).unwrap_or(0);
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (s, t) = (share(i, j), share(i, k));
            piece(&[CORNERS[i], between(i, j, s), between(i, k, t)], s * t);
        }
        2 => {
            let k = inside.iter().position(|&inside| !inside).unwrap_or(0);
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (s, t) = (share(i, k), share(j, k));
            let (on_s, on_t) = (between(i, k, s), between(j, k, t));
            piece(&[CORNERS[i], CORNERS[j], on_t], t);
            // `1 − t` without cancellation, from the values themselves.
            piece(&[CORNERS[i], on_t, on_s], s * (v[k] / (v[k] - v[j])));
        }
        _ => piece(&CORNERS, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::twice_area;

    fn plane_kinds() -> impl Iterator<Item = CellKind> {
        CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
    }

    #[test]
    fn the_triangles_cover_the_domain_once_and_use_every_node() {
        for kind in plane_kinds() {
            let area: f64 = triangles(kind).iter().map(|t| 0.5 * twice_area(&corners(kind, t))).sum();
            assert!((area - if kind.is_simplex() { 0.5 } else { 4.0 }).abs() < 1e-15, "{kind:?}");
            assert!(triangles(kind).iter().all(|t| twice_area(&corners(kind, t)) > 0.0));
            assert!((0..kind.node_count()).all(|i| triangles(kind).iter().any(|t| t.contains(&i))), "{kind:?}");
        }
    }

    #[test]
    fn pieces_measure_what_is_positive_down_to_the_thinnest() {
        let area = |v: [f64; 3]| {
            let mut sum = 0.0;
            positive(&v, |corners, fraction| {
                sum += fraction;
                let x = corners.map(|l| [l[1], l[2]]);
                assert!((twice_area(&x) - fraction).abs() < 1e-15, "{v:?}");
                // Nothing of the piece is negative.
                assert!(corners.iter().all(|l| (0..3).map(|k| l[k] * v[k]).sum::<f64>() > -1e-15));
            });
            sum
        };
        assert_eq!((area([1.0; 3]), area([-1.0; 3]), area([0.0; 3])), (1.0, 0.0, 0.0));
        assert_eq!((area([1.0, 0.0, 0.0]), area([1.0, 1.0, 0.0])), (1.0, 1.0));
        for turn in 0..3 {
            let at = |v: [f64; 3]| area([v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]]);
            for e in [0.7, 1e-3, 1e-9, 1e-15, 1e-100] {
                // x > 1 − e with x the first barycentric coordinate: the area e².
                assert!((at([e, e - 1.0, e - 1.0]) / (e * e) - 1.0).abs() < 1e-12 + 1e-15 / e || e < 1e-15);
                // x < e in the same triangle: 1 − (1 − e)².
                let strip = e * (2.0 - e);
                assert!((at([e - 1.0, e, e]) / strip - 1.0).abs() < 1e-14, "{e}");
            }
            assert!((at([0.3, -0.5, 0.2]) + at([-0.3, 0.5, -0.2]) - 1.0).abs() < 1e-15);
        }
    }
}
