//! Weights within bounds that miss moments by as little as possible, where they cannot be met.
//!
//! `min ½ Σ v (r − 1)² + ½ Σ_j (Σ v r c_j)²/ε_j` over `LOW ≤ r ≤ HIGH` with `Σ v r = 1`, in the notation of
//! [`super::dual`]: a strictly convex problem, solved by an active set as in Stark and Parker (1995), *Bounded-variable
//! least squares*. Every iterate lies within the bounds and has the right volume, so that whatever happens the weights are sound.

use super::dual::{HIGH, LOW, Layout, add_product, dot, solve_symmetric};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Within,
    Low,
    High,
}

/// Writes the ratios that miss the first `N` moments least. `softness` are the `ε_j`; the first is not used. `place`
/// is working space.
pub fn solve<const N: usize>(layout: Layout, softness: &[f64; N], ratio: &mut [f64], place: &mut [Place]) {
    let Layout { rows, share, .. } = layout;
    ratio.fill(1.0);
    place.fill(Place::Within);
    find_active_set(layout, softness, ratio, place);
    // Large multipliers leave their rounding in the volume.
    let within = |p: &usize| place[*p] == Place::Within;
    let (missing, free) = (0..rows.len()).fold((1.0, 0.0), |(missing, free), p| {
        (missing - share[p] * ratio[p], if within(&p) { free + share[p] } else { free })
    });
    (0..rows.len()).filter(within).for_each(|p| ratio[p] += missing / free);
}

fn find_active_set<const N: usize>(layout: Layout, softness: &[f64; N], ratio: &mut [f64], place: &mut [Place]) {
    let Layout { rows, share, .. } = layout;
    let mut released = None;
    for _ in 0..10 + 4 * rows.len() {
        let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
        right[0] = 1.0;
        for j in 1..N {
            matrix[j][j] = softness[j];
        }
        for (p, row) in rows.iter().enumerate() {
            let within = place[p] == Place::Within;
            let base = share[p] * if within { 1.0 } else { ratio[p] };
            for j in 0..N {
                right[j] -= base * row[j];
            }
            if within {
                add_product(&mut matrix, share[p], row);
            }
        }
        let lambda = solve_symmetric(matrix, &right);
        // As far towards the solution for these points within the bounds as the bounds permit.
        let (mut length, mut blocking) = (1.0, None);
        for (p, row) in rows.iter().enumerate().filter(|(p, _)| place[*p] == Place::Within) {
            let move_by = 1.0 + dot(row, &lambda) - ratio[p];
            let room = if move_by > 0.0 { HIGH - ratio[p] } else { LOW - ratio[p] };
            if move_by != 0.0 && room / move_by < length {
                (length, blocking) = ((room / move_by).max(0.0), Some(p));
            }
        }
        for (p, row) in rows.iter().enumerate().filter(|(p, _)| place[*p] == Place::Within) {
            ratio[p] = (ratio[p] + length * (1.0 + dot(row, &lambda) - ratio[p])).clamp(LOW, HIGH);
        }
        if let Some(p) = blocking {
            (place[p], ratio[p]) = if ratio[p] > 1.0 { (Place::High, HIGH) } else { (Place::Low, LOW) };
            // A point that would not leave its bound after all was released by rounding.
            if released == Some(p) && length == 0.0 {
                return;
            }
            continue;
        }
        // Points at a bound that the objective pulls off it.
        let rounding = 1e-9 + 1e-14 * lambda.iter().fold(0.0, |m: f64, l| m.max(l.abs()));
        let mut most = rounding;
        released = None;
        for (p, row) in rows.iter().enumerate() {
            let target = 1.0 + dot(row, &lambda);
            let pull = match place[p] {
                Place::Within => continue,
                Place::Low => target - LOW,
                Place::High => HIGH - target,
            };
            if pull > most {
                (most, released) = (pull, Some(p));
            }
        }
        match released {
            Some(p) => place[p] = Place::Within,
            None => return,
        }
    }
}
