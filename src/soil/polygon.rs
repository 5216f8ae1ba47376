//! Convex polygons in a triangle, by barycentric coordinates: cut along linear functions, and without other triangles.

use crate::geometry::{area, cross, way};

/// A corner by its barycentric coordinates in the triangle.
pub type Corner = [f64; 3];
/// A convex polygon, counter-clockwise as the triangle is.
pub type Polygon = Vec<Corner>;

/// The whole triangle.
pub const WHOLE: [Corner; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// A smaller part (-) of the area of a triangle is rounding.
const LEAST: f64 = 1e-9;

/// The mean of three values with the weights of a corner.
pub fn mix(corner: &Corner, of: &[f64; 3]) -> f64 {
    corner[0] * of[0] + corner[1] * of[1] + corner[2] * of[2]
}

/// The place (m) of a corner in a triangle.
pub fn place(corner: &Corner, triangle: &[[f64; 2]; 3]) -> [f64; 2] {
    [0, 1].map(|d| mix(corner, &triangle.map(|x| x[d])))
}

/// The part of a polygon where the linear function with the values `f` at the corners of the triangle is positive; empty
/// where that is no more than rounding.
pub fn positive(polygon: &[Corner], f: &[f64; 3]) -> Polygon {
    let mut part = Polygon::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (at_p, at_q) = (mix(p, f), mix(q, f));
        if at_p >= 0.0 {
            part.push(*p);
        }
        if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
            let t = at_p / (at_p - at_q);
            part.push([0, 1, 2].map(|k| p[k] + t * (q[k] - p[k])));
        }
    }
    if share(&part) > LEAST { part } else { Polygon::new() }
}

/// The area of a polygon over that of its triangle (-).
pub fn share(polygon: &[Corner]) -> f64 {
    if polygon.len() < 3 {
        return 0.0;
    }
    let flat: Vec<[f64; 2]> = polygon.iter().map(|l| [l[1], l[2]]).collect();
    2.0 * area(&flat)
}

/// What `others`, counter-clockwise triangles (m), leave of a polygon in the `triangle` (m), as convex polygons.
pub fn without<'a>(
    polygon: Polygon,
    triangle: &[[f64; 2]; 3],
    others: impl Iterator<Item = &'a [[f64; 2]; 3]>,
) -> Vec<Polygon> {
    let mut left = vec![polygon];
    for other in others {
        if left.is_empty() {
            break;
        }
        let sides = [0, 1, 2].map(|i| {
            let (a, along) = (other[i], way(&other[i], &other[(i + 1) % 3]));
            triangle.map(|x| cross(&along, &way(&a, &x)))
        });
        // A triangle that is all beyond one side is not touched.
        if sides.iter().any(|side| side.iter().all(|f| *f <= 0.0)) {
            continue;
        }
        let mut next = Vec::with_capacity(left.len() + 2);
        for polygon in left {
            let mut within = polygon.clone();
            let mut parts = Vec::new();
            for side in &sides {
                let beyond = positive(&within, &side.map(|f| -f));
                within = positive(&within, side);
                parts.extend((!beyond.is_empty()).then_some(beyond));
            }
            // What is not touched stays in one piece.
            if within.is_empty() {
                next.push(polygon);
            } else {
                next.append(&mut parts);
            }
        }
        left = next;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

    #[test]
    fn a_polygon_is_cut_along_a_line() {
        // x > 1/4 in the unit triangle: (3/4)².
        let part = positive(&WHOLE, &[-0.25, 0.75, -0.25]);
        assert!((share(&part) - 0.5625).abs() < 1e-15);
        assert!(positive(&WHOLE, &[-1.0; 3]).is_empty());
        assert_eq!(positive(&WHOLE, &[0.0, 1.0, 1.0]), WHOLE);
    }

    #[test]
    fn what_a_triangle_leaves_has_the_rest_of_the_area() {
        let leaves = |others: &[[[f64; 2]; 3]]| -> f64 {
            without(WHOLE.to_vec(), &UNIT, others.iter()).iter().map(|polygon| share(polygon)).sum()
        };
        let inner = [[0.2, 0.2], [0.5, 0.2], [0.2, 0.5]];
        assert!((leaves(&[inner]) - (1.0 - 0.09)).abs() < 1e-15);
        // The same twice, one that covers all, one beside.
        assert!((leaves(&[inner, inner]) - (1.0 - 0.09)).abs() < 1e-15);
        assert_eq!(leaves(&[inner, [[-1.0, -1.0], [4.0, -1.0], [-1.0, 4.0]]]), 0.0);
        assert_eq!(leaves(&[[[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]]]), 1.0);
    }
}
