//! Contact pressures to report: those of the solution without their variation from one contact node to the next.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::surface::Run;

/// Weight of the squares of the second differences. A wave six contact nodes long, three edges of the finest cells of the soil, keeps half of its
/// amplitude, one from node to node a seventeenth. `docs/numerics.md`, *Contact and finite elements*, has what remains under the bodies of the cases.
const WEIGHT: f64 = 1.0;

/// The pressures (kPa) of contact nodes without waves that are shorter than the cells of the soil can represent; `areas` (m²) under the contact nodes.
///
/// Along each stretch of closed contact nodes it is the smooth series `q` of Whittaker (1923) for the pressures `p`: the sum of `A_k (q_k - p_k)²` and
/// of `A_k (Δ²q_k)²` is least. The force `Σ A_k q_k` and its first moment along the boundary are those of `p`, and a linear pressure is unchanged. A
/// single open contact node between closed ones belongs to the stretch: its neighbours carry its share. A pressure outside the range of the
/// stretch is set to the end of that range, as where contact without tension ends.
pub fn smooth_pressures(pressure: &[f64], runs: &[Run], areas: &[f64]) -> Vec<f64> {
    let mut smooth = pressure.to_vec();
    for (run, is_loop) in runs {
        let (stretches, is_loop) = stretches(&pressure[run.clone()], *is_loop);
        for stretch in stretches.into_iter().filter(|stretch| stretch.len() > 2) {
            let nodes: Vec<usize> = stretch.map(|k| run.start + k % run.len()).collect();
            let area = DVector::from_iterator(nodes.len(), nodes.iter().map(|&k| areas[k]));
            let values = DVector::from_iterator(nodes.len(), nodes.iter().map(|&k| pressure[k]));
            if let Some(values) = whittaker(&values, &area, is_loop) {
                nodes.iter().zip(&values).for_each(|(&k, value)| smooth[k] = *value);
            }
        }
    }
    smooth
}

/// Stretches of closed contact nodes of a run, given its pressures, and whether the only one has no ends. In a loop they may go on beyond its last node.
fn stretches(pressure: &[f64], is_loop: bool) -> (Vec<Range<usize>>, bool) {
    let count = pressure.len();
    let closed = |k: usize| pressure[k % count] != 0.0;
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

/// The smooth series for `values` with weights `area`; none where these are not positive.
fn whittaker(values: &DVector<f64>, area: &DVector<f64>, is_loop: bool) -> Option<DVector<f64>> {
    let count = values.len();
    let mut matrix = DMatrix::from_diagonal(area);
    let middles = if is_loop { 0..count } else { 1..count - 1 };
    for k in middles {
        let difference = [((k + count - 1) % count, 1.0), (k, -2.0), ((k + 1) % count, 1.0)];
        for (i, a) in difference {
            for (j, b) in difference {
                matrix[(i, j)] += WEIGHT * area[k] * a * b;
            }
        }
    }
    let smooth = matrix.cholesky()?.solve(&values.component_mul(area));
    Some(smooth.map(|value| value.clamp(values.min(), values.max())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(values: &[f64], areas: &[f64]) -> [f64; 2] {
        values
            .iter()
            .zip(areas)
            .enumerate()
            .fold([0.0; 2], |[a, b], (k, (p, area))| [a + p * area, b + k as f64 * p * area])
    }

    /// A wave from node to node almost vanishes, around a loop and in a row, force and moment are kept, also where areas grow with the radius, and a linear
    /// pressure stays.
    #[test]
    fn they_bear_the_same_load() {
        let count = 12;
        let wave: Vec<f64> = (0..count).map(|k| 10.0 + if k % 2 == 0 { 3.0 } else { -3.0 }).collect();
        let equal = vec![1.0; count];
        let round = smooth_pressures(&wave, &[(0..count, true)], &equal);
        assert!(round.iter().all(|p| (p - 10.0).abs() < 3.0 / 17.0 + 1e-12), "{round:?}");
        let rings: Vec<f64> = (0..count).map(|k| 0.25 + k as f64).collect();
        for areas in [equal, rings] {
            let smooth = smooth_pressures(&wave, &[(0..count, false)], &areas);
            let ([a, b], [c, d]) = (sums(&wave, &areas), sums(&smooth, &areas));
            assert!((a - c).abs() < 1e-11 * a && (b - d).abs() < 1e-11 * b, "{smooth:?}");
            assert!((2..count - 2).all(|k| (smooth[k] - 10.0).abs() < 0.7), "{smooth:?}");
            let linear: Vec<f64> = (0..count).map(|k| 5.0 + 2.0 * k as f64).collect();
            let same = smooth_pressures(&linear, &[(0..count, false)], &areas);
            assert!(same.iter().zip(&linear).all(|(a, b)| (a - b).abs() < 1e-11), "{same:?}");
        }
    }

    /// A single open node belongs to its stretch, two part it; what is open beyond stays so; a stretch may go over the end of a loop.
    #[test]
    fn open_contact_nodes_part_stretches() {
        let pressure = [0.0, 2.0, 3.0, 0.0, 4.0, 5.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert_eq!(stretches(&pressure, false), (vec![1..6, 8..11], false));
        assert_eq!(stretches(&pressure, true), (vec![8..17], false));
        assert_eq!(stretches(&[1.0; 5], true), (vec![0..5], true));
        let smooth = smooth_pressures(&pressure, &[(0..11, false)], &[1.0; 11]);
        assert!(smooth[0] == 0.0 && smooth[3] > 2.0 && smooth[6..8] == [0.0; 2], "{smooth:?}");
        assert!(
            smooth.iter().all(|p| (0.0..=5.0).contains(p)) && (sums(&smooth, &[1.0; 11])[0] - 17.0).abs() < 0.5,
            "{smooth:?}"
        );
    }
}
