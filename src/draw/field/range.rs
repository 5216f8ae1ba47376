//! The ends of the colour bar: without the few extreme values beside which all others would have one colour.

use super::triangles::Triangles;
use crate::geometry::twice_area;

/// The part of the area (-) whose values may lie beyond each end of the colour bar.
const SPARED: f64 = 0.005;
/// The whole range is shown where it is no more than so many times (-) that of the rest.
const WORTH: f64 = 1.3;

/// A value and where it is (m).
pub type Peak = (f64, [f64; 2]);

impl Triangles {
    /// The values that are known, with their places.
    fn known(&self) -> impl Iterator<Item = Peak> {
        let corners = self.values.iter().flatten().zip(self.places.iter().flatten());
        corners.filter(|(value, _)| value.is_finite()).map(|(value, place)| (*value, *place))
    }

    /// The least and the greatest value, with their places; `None` where there is none.
    pub fn peaks(&self) -> Option<[Peak; 2]> {
        let least = self.known().min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some([least, self.known().max_by(|a, b| a.0.total_cmp(&b.0))?])
    }

    /// The range of the values but for those of a small part of the area at both ends; the whole range where that is hardly larger.
    pub fn usual_range(&self) -> Option<[f64; 2]> {
        let [(least, _), (greatest, _)] = self.peaks()?;
        let corners = self.values.iter().zip(&self.places).flat_map(|(values, x)| {
            let area = twice_area(x).abs() / 6.0;
            values.map(|value| (value, area))
        });
        let mut corners: Vec<(f64, f64)> = corners.filter(|(value, _)| value.is_finite()).collect();
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let whole: f64 = corners.iter().map(|(_, area)| area).sum();
        let is_beyond = |sum: &mut f64, area: f64| {
            *sum += area;
            *sum > SPARED * whole
        };
        let mut sums = [0.0; 2];
        let low = corners.iter().find(|corner| is_beyond(&mut sums[0], corner.1)).map_or(least, |corner| corner.0);
        let high = corners.iter().rev().find(|corner| is_beyond(&mut sums[1], corner.1));
        let high = high.map_or(greatest, |corner| corner.0);
        Some(if greatest - least > WORTH * (high - low) && high > low { [low, high] } else { [least, greatest] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of squares of two triangles each, with a value in each square.
    fn strip(values: &[f64]) -> Triangles {
        let mut triangles = Triangles::default();
        for (i, &value) in values.iter().enumerate() {
            let x = i as f64;
            triangles.places.extend([[[x, 0.0], [x + 1.0, 0.0], [x, 1.0]], [[x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]]]);
            triangles.values.extend([[value; 3]; 2]);
            triangles.region.extend([0; 2]);
        }
        triangles
    }

    #[test]
    fn one_peak_does_not_make_the_range_and_is_told() {
        let mut values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
        assert_eq!(strip(&values).usual_range(), Some([0.0, 0.999]));
        values[700] = 50.0;
        let spoiled = strip(&values);
        let [low, high] = spoiled.usual_range().unwrap();
        assert!((low - 0.005).abs() < 2e-3 && (high - 0.995).abs() < 2e-3, "{low} {high}");
        let (peak, [x, _]) = spoiled.peaks().unwrap()[1];
        assert!(peak == 50.0 && (700.0..=701.0).contains(&x), "{peak} {x}");
        values[700] = f64::NAN;
        assert_eq!(strip(&values).usual_range(), Some([0.0, 0.999]));
        assert_eq!(strip(&[3.0; 4]).usual_range(), Some([3.0, 3.0]));
        assert_eq!(Triangles::default().usual_range(), None);
    }
}
