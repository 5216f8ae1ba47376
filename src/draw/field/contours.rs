//! Lines over the triangles of a field along which a value is constant.

/// Where a linear function with `values` at the corners of a triangle (m) is `level`: a piece of a line, if anywhere.
pub fn segment(x: &[[f64; 2]; 3], values: &[f64; 3], level: f64) -> Option<[[f64; 2]; 2]> {
    let crossing = |(i, j): (usize, usize)| {
        let (a, b) = (values[i], values[j]);
        // A corner at the level counts as above it.
        ((a < level) != (b < level)).then(|| {
            let t = (level - a) / (b - a);
            [0, 1].map(|d| x[i][d] + t * (x[j][d] - x[i][d]))
        })
    };
    let mut ends = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(crossing);
    Some([ends.next()?, ends.next()?])
}

/// The multiples of a `spacing` between the least and the greatest of three values.
pub fn multiples(values: &[f64; 3], spacing: f64) -> impl Iterator<Item = f64> {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min) / spacing;
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) / spacing;
    let first = least.ceil() as i64;
    let count = if least.is_finite() && greatest.is_finite() { greatest.floor() as i64 - first + 1 } else { 0 };
    (0..count.clamp(0, 10_000)).map(move |i| (first + i) as f64 * spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contour_joins_places_of_one_value() {
        let x = [[0.0, 0.0], [2.0, 0.0], [0.0, 4.0]];
        let value = |p: [f64; 2]| 1.0 + 3.0 * p[0] - p[1];
        let values = x.map(value);
        for level in [-2.5, 0.0, 1.0, 4.0, 6.9] {
            let ends = segment(&x, &values, level).unwrap();
            assert!(ends.iter().all(|&end| (value(end) - level).abs() < 1e-12), "{level}: {ends:?}");
        }
        assert!(segment(&x, &values, 7.5).is_none() && segment(&x, &[2.0; 3], 2.0).is_none());
        assert_eq!(multiples(&values, 2.0).collect::<Vec<_>>(), [-2.0, 0.0, 2.0, 4.0, 6.0]);
        assert_eq!(multiples(&[f64::NAN; 3], 2.0).count(), 0);
    }
}
