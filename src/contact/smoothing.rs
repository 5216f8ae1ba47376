//! Contact tractions to report: those of the solution without their variation from one contact node to the next.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::surface::Run;

/// Weight of the squares of the second differences. A wave six contact nodes long, three edges of the finest cells of the soil, keeps half of its
/// amplitude, one from node to node a seventeenth. `docs/numerics.md`, *Contact and finite elements*, has what remains under the bodies of the cases.
const WEIGHT: f64 = 1.0;

/// Tractions (kPa) of contact nodes without waves that are shorter than the cells of the soil can represent; `areas` (m²) under the contact nodes.
///
/// Along each stretch of closed contact nodes each component is the smooth series `q` of Whittaker (1923) for the values `p`: the sum of `A_k (q_k - p_k)²` and
/// of `A_k (Δ²q_k)²` is least. The force `Σ A_k q_k` and its first moment along the boundary are those of `p`, and linear values are unchanged. A
/// single open contact node between closed ones belongs to the stretch: its neighbours carry its share.
pub fn smooth(traction: &[[f64; 3]], runs: &[Run], areas: &[f64]) -> Vec<[f64; 3]> {
    let mut smooth = traction.to_vec();
    for (run, is_loop) in runs {
        let closed: Vec<bool> = traction[run.clone()].iter().map(|t| *t != [0.0; 3]).collect();
        let (stretches, is_loop) = stretches(&closed, *is_loop);
        for stretch in stretches.into_iter().filter(|stretch| stretch.len() > 2) {
            let nodes: Vec<usize> = stretch.map(|k| run.start + k % run.len()).collect();
            let area = DVector::from_iterator(nodes.len(), nodes.iter().map(|&k| areas[k]));
            let values = DMatrix::from_fn(nodes.len(), 3, |k, d| traction[nodes[k]][d]);
            if let Some(values) = whittaker(&values, &area, is_loop) {
                nodes.iter().enumerate().for_each(|(k, &node)| smooth[node] = [0, 1, 2].map(|d| values[(k, d)]));
            }
        }
    }
    smooth
}

/// Stretches of the contact nodes of a run of which these are `closed`, and whether the only one has no ends. In a loop they may go on beyond its last node.
fn stretches(closed: &[bool], is_loop: bool) -> (Vec<Range<usize>>, bool) {
    let count = closed.len();
    let closed = |k: usize| closed[k % count];
    let beside = |k: usize| (is_loop || (k > 0 && k + 1 < count)) && closed(k + count - 1) && closed(k + 1);
    let counts = |k: usize| closed(k) || beside(k);
    let first = if is_loop { (0..count).find(|&k| !counts(k)) } else { Some(0) };
    let Some(first) = first else { return (std::iter::once(0..count).collect(), true) };
    let mut found: Vec<Range<usize>> = Vec::new();
    for k in (first..first + count).filter(|&k| counts(k)) {
        match found.last_mut().filter(|stretch| stretch.end == k) {
            Some(stretch) => stretch.end += 1,
            None => found.push(k..k + 1),
        }
    }
    (found, false)
}

/// The smooth series for the columns of `values` with weights `area`; none where these are not positive.
fn whittaker(values: &DMatrix<f64>, area: &DVector<f64>, is_loop: bool) -> Option<DMatrix<f64>> {
    let count = values.nrows();
    let weights = DMatrix::from_diagonal(area);
    let mut matrix = weights.clone();
    let middles = if is_loop { 0..count } else { 1..count - 1 };
    for k in middles {
        let difference = [((k + count - 1) % count, 1.0), (k, -2.0), ((k + 1) % count, 1.0)];
        for (i, a) in difference {
            for (j, b) in difference {
                matrix[(i, j)] += WEIGHT * area[k] * a * b;
            }
        }
    }
    Some(matrix.cholesky()?.solve(&(weights * values)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force and first moment of the second component.
    fn sums(values: &[[f64; 3]], areas: &[f64]) -> [f64; 2] {
        let add = |[a, b]: [f64; 2], (k, (t, area)): (usize, (&[f64; 3], &f64))| {
            [a + t[1] * area, b + k as f64 * t[1] * area]
        };
        values.iter().zip(areas).enumerate().fold([0.0; 2], add)
    }

    /// A wave from node to node almost vanishes, around a loop and in a row. Force and moment are kept, also where areas grow with the radius, and linear
    /// values stay.
    #[test]
    fn they_bear_the_same_load() {
        let count = 12;
        let traction = |value: &dyn Fn(usize) -> f64| (0..count).map(|k| [0.0, value(k), 1.0]).collect::<Vec<_>>();
        let wave = traction(&|k| 10.0 + if k % 2 == 0 { 3.0 } else { -3.0 });
        let equal = vec![1.0; count];
        let round = smooth(&wave, &[(0..count, true)], &equal);
        assert!(
            round.iter().all(|t| (t[1] - 10.0).abs() < 3.0 / 17.0 + 1e-12 && (t[2] - 1.0).abs() < 1e-12),
            "{round:?}"
        );
        let rings: Vec<f64> = (0..count).map(|k| 0.25 + k as f64).collect();
        for areas in [equal, rings] {
            let even = smooth(&wave, &[(0..count, false)], &areas);
            let ([a, b], [c, d]) = (sums(&wave, &areas), sums(&even, &areas));
            assert!((a - c).abs() < 1e-11 * a && (b - d).abs() < 1e-11 * b, "{even:?}");
            assert!((2..count - 2).all(|k| (even[k][1] - 10.0).abs() < 0.7), "{even:?}");
            let linear = traction(&|k| 5.0 + 2.0 * k as f64);
            let same = smooth(&linear, &[(0..count, false)], &areas);
            assert!(same.iter().zip(&linear).all(|(a, b)| (a[1] - b[1]).abs() < 1e-11), "{same:?}");
        }
    }

    /// A single open contact node belongs to its stretch, two part it; what is open beyond stays so; a stretch may go over the end of a loop.
    #[test]
    fn open_contact_nodes_part_stretches() {
        let pressure = [0.0, 2.0, 3.0, 0.0, 4.0, 5.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let closed = pressure.map(|p| p != 0.0);
        assert_eq!(stretches(&closed, false), (vec![1..6, 8..11], false));
        for (closed, only, without_ends) in [(&closed[..], 8..17, false), (&[true; 5], 0..5, true)] {
            let (found, is_loop) = stretches(closed, true);
            assert!(found.len() == 1 && found[0] == only && is_loop == without_ends, "{found:?}");
        }
        let traction = pressure.map(|p| [0.0, p, 0.0]);
        let even = smooth(&traction, &[(0..11, false)], &[1.0; 11]);
        assert!(even[0][1] == 0.0 && even[3][1] > 2.0 && even[6] == [0.0; 3] && even[7] == [0.0; 3], "{even:?}");
        assert!((sums(&even, &[1.0; 11])[0] - 17.0).abs() < 1e-12, "{even:?}");
    }
}
