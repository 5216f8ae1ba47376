//! Places, lines and polygons: distances, feet, rays, crossings, areas, and what of many is near a place.
//!
//! A line is straight and given by its two ends; a polygon, by its corners, has what it bounds on its left where its area is positive.

mod bins;
mod lines;
pub mod quadratic;

pub use bins::Bins;
pub use lines::{Hit, Lines};

/// The ends (m) of a straight line.
pub type Line<const D: usize> = [[f64; D]; 2];

/// Distance (m) of two places.
pub fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum: f64, (a, b)| sum.hypot(a - b))
}

/// The length (m) of a line.
pub fn length<const D: usize>([a, b]: &Line<D>) -> f64 {
    distance(a, b)
}

/// The way (m) from one place to another.
pub fn way<const D: usize>(from: &[f64; D], to: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|d| to[d] - from[d])
}

#[inline]
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (1..D).fold(a[0] * b[0], |sum, d| sum + a[d] * b[d])
}

/// `a × b` in the plane.
pub fn cross(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Lowest and highest corner (m) of the box around places; `None` without any.
pub fn box_around<const D: usize>(places: impl IntoIterator<Item = [f64; D]>) -> Option<[[f64; D]; 2]> {
    places.into_iter().fold(None, |bounds, x| {
        let [low, high] = bounds.unwrap_or([x; 2]);
        Some([std::array::from_fn(|d| low[d].min(x[d])), std::array::from_fn(|d| high[d].max(x[d]))])
    })
}

/// The place at a share (-) of a line.
pub fn at<const D: usize>([a, b]: &Line<D>, share: f64) -> [f64; D] {
    std::array::from_fn(|d| a[d] + share * (b[d] - a[d]))
}

/// The share (-) of a line at which the foot of a place is; below 0 and above 1 beyond its ends.
pub fn foot<const D: usize>(x: &[f64; D], [a, b]: &Line<D>) -> f64 {
    let along = way(a, b);
    dot(&way(a, x), &along) / dot(&along, &along)
}

/// The share (-) of a line at which it is nearest to a place, and how far (m) that is.
pub fn nearest<const D: usize>(x: &[f64; D], line: &Line<D>) -> (f64, f64) {
    let share = foot(x, line).clamp(0.0, 1.0);
    (share, distance(x, &at(line, share)))
}

/// The shares (-) of two lines in the plane at which they cross; lines that only touch do not.
pub fn crossing([a, b]: &Line<2>, [c, d]: &Line<2>) -> Option<(f64, f64)> {
    let side = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2]| twice_area(&[*p, *q, *r]);
    let (of_c, of_d) = (side(a, b, c), side(a, b, d));
    let (of_a, of_b) = (side(c, d, a), side(c, d, b));
    let cross = (of_c > 0.0) != (of_d > 0.0) && (of_a > 0.0) != (of_b > 0.0);
    let touch = [of_a, of_b, of_c, of_d].contains(&0.0);
    (cross && !touch).then(|| (of_a / (of_a - of_b), of_c / (of_c - of_d)))
}

/// Twice the signed area (m²) of a triangle, positive where its corners run counter-clockwise.
pub fn twice_area(x: &[[f64; 2]; 3]) -> f64 {
    (x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[2][0] - x[0][0]) * (x[1][1] - x[0][1])
}

/// The signed area (m²) within a polygon.
pub fn area(x: &[[f64; 2]]) -> f64 {
    (1..x.len() - 1).map(|i| 0.5 * twice_area(&[x[0], x[i], x[i + 1]])).sum()
}

/// Twice the signed area (m²) of the triangle of a line and a place, positive where the place is on the left of the line. For the line the
/// other way it is the opposite number exactly: of two polygons that share a side, a place is never beyond that of both.
pub fn side([a, b]: &Line<2>, x: &[f64; 2]) -> f64 {
    cross(&way(x, a), &way(x, b))
}

/// How many times the polygons that `lines` make run around a place, counter-clockwise.
pub fn winding(lines: &[Line<2>], x: &[f64; 2]) -> i32 {
    let around = |line: &Line<2>| match line.map(|end| end[1] <= x[1]) {
        [true, false] if side(line, x) > 0.0 => 1,
        [false, true] if side(line, x) < 0.0 => -1,
        _ => 0,
    };
    lines.iter().map(around).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_are_at_right_angles_and_the_nearest_place_is_on_the_line() {
        let line = [[1.0, 2.0, -1.0], [4.0, 6.0, -1.0]];
        for (x, share, away) in
            [([1.0, 2.0, 3.0], 0.0, 4.0), ([2.5, 4.0, -1.5], 0.5, 0.5), ([7.0, 10.0, -1.0], 2.0, 5.0)]
        {
            assert!((foot(&x, &line) - share).abs() < 1e-15);
            let (nearest, distance) = nearest(&x, &line);
            assert!((nearest - share.clamp(0.0, 1.0)).abs() < 1e-15 && (distance - away).abs() < 1e-14);
        }
    }

    #[test]
    fn lines_cross_in_one_place_and_touching_is_not_crossing() {
        let line = [[0.0, 0.0], [4.0, 0.0]];
        let found = crossing(&line, &[[1.0, -1.0], [1.0, 3.0]]).unwrap();
        assert_eq!(found, (0.25, 0.25));
        assert_eq!(crossing(&line, &[[1.0, 0.0], [1.0, 3.0]]), None);
        assert_eq!(crossing(&line, &[[5.0, -1.0], [5.0, 3.0]]), None);
    }

    #[test]
    fn a_polygon_has_its_area_and_winds_around_what_is_in_it() {
        let x = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        assert_eq!(area(&x), 2.0);
        let lines: Vec<Line<2>> = (0..4).map(|i| [x[i], x[(i + 1) % 4]]).collect();
        assert_eq!([[1.0, 0.5], [3.0, 0.5]].map(|at| winding(&lines, &at)), [1, 0]);
        let back: Vec<Line<2>> = lines.iter().map(|[a, b]| [*b, *a]).collect();
        assert_eq!(winding(&back, &[1.0, 0.5]), -1);
    }
}
