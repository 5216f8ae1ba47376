//! Quadratic functions of place in the plane that are nearest to given values: weighted least squares.

use nalgebra::{SMatrix, SVector};

/// The terms of a function: the coefficients of `1, x, y, x², xy, y²`.
pub const TERMS: usize = 6;

/// Least places: with fewer there is hardly a choice between functions.
const FEWEST: usize = 8;

/// What the elimination leaves of each diagonal entry of the normal equations, at least: 1e-5 of a term is its own then. On a curve of second
/// order rounding leaves about 1e-16.
const LEAST: f64 = 1e-10;

/// The normal equations of weighted places.
pub struct Quadratic {
    inverse: SMatrix<f64, TERMS, TERMS>,
}

/// `1, x, y, x², xy, y²`.
pub fn terms([x, y]: [f64; 2]) -> [f64; TERMS] {
    [1.0, x, y, x * x, x * y, y * y]
}

impl Quadratic {
    /// Those of weights and places, in coordinates in which the places are about one apart; `None` where they determine no function, being few
    /// or on a curve of second order.
    pub fn of(weighed: impl ExactSizeIterator<Item = (f64, [f64; 2])>) -> Option<Self> {
        if weighed.len() < FEWEST {
            return None;
        }
        let mut normal = SMatrix::<f64, TERMS, TERMS>::zeros();
        for (weight, place) in weighed {
            let terms = SVector::from(terms(place));
            normal.ger(weight, &terms, &terms, 1.0);
        }
        let factor = normal.cholesky()?;
        let lower = factor.l_dirty();
        let determined = |i: usize| lower[(i, i)].powi(2) > LEAST * normal[(i, i)];
        (0..TERMS).all(determined).then(|| Self { inverse: factor.inverse() })
    }

    /// What the value at a place of a weight adds to the coefficients.
    pub fn shares(&self, weight: f64, place: [f64; 2]) -> [f64; TERMS] {
        (self.inverse * SVector::from(terms(place)) * weight).into()
    }
}

/// A function with given coefficients at a place.
pub fn value(coefficients: &[f64; TERMS], place: [f64; 2]) -> f64 {
    coefficients.iter().zip(terms(place)).map(|(c, term)| c * term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_values_are_met_and_places_on_a_circle_have_no_function() {
        let places: Vec<[f64; 2]> = (0..16).map(|i| [0.3 * f64::from(i % 4), 0.25 * f64::from(i / 4)]).collect();
        let weight = |i: usize| 1.0 + 0.1 * i as f64;
        let weighed = |places: &[[f64; 2]]| places.iter().enumerate().map(|(i, &x)| (weight(i), x)).collect::<Vec<_>>();
        let fit = Quadratic::of(weighed(&places).into_iter()).unwrap();
        let exact = |[x, y]: [f64; 2]| 0.3 - 2.0 * x + y + 0.7 * x * x - 1.1 * x * y + 0.4 * y * y;
        let mut coefficients = [0.0; TERMS];
        for (i, &x) in places.iter().enumerate() {
            let shares = fit.shares(weight(i), x);
            coefficients.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share * exact(x));
        }
        for x in [[0.1, 0.2], [0.8, 0.7], [1.5, -0.5]] {
            assert!((value(&coefficients, x) - exact(x)).abs() < 1e-12);
        }
        let circle: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i).cos(), f64::from(i).sin()]).collect();
        assert!(Quadratic::of(weighed(&circle).into_iter()).is_none());
        assert!(Quadratic::of(weighed(&places[..7]).into_iter()).is_none());
    }
}
