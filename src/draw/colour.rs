//! Colour maps, and colours of structures.

/// Red, green and blue, 0 to 255.
pub type Rgb = [u8; 3];

/// A map from 0 to 1 to colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// Perceptually uniform, dark to light: for values that go one way (Smith & van der Walt 2015, matplotlib).
    Viridis,
    /// Blue over light grey to red, as light on both sides: for values about zero (Moreland 2009, Diverging color maps for
    /// scientific visualization).
    Diverging,
}

/// Viridis at equal steps, as published; linear between.
const VIRIDIS: [Rgb; 10] = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 73, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [110, 206, 88],
    [181, 222, 43],
    [253, 231, 37],
];
/// The diverging map at equal steps, as published; linear between.
const DIVERGING: [Rgb; 9] = [
    [59, 76, 192],
    [98, 130, 234],
    [141, 176, 254],
    [184, 208, 249],
    [221, 221, 221],
    [245, 196, 173],
    [244, 154, 123],
    [222, 96, 77],
    [180, 4, 38],
];

impl Map {
    /// The map for values in a range: diverging where it has both signs.
    pub fn of([low, high]: [f64; 2]) -> Self {
        if low < 0.0 && high > 0.0 { Self::Diverging } else { Self::Viridis }
    }

    /// The colour of `t`, from 0 to 1; beyond, that of the nearer end.
    pub fn at(self, t: f64) -> Rgb {
        let table: &[Rgb] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Diverging => &DIVERGING,
        };
        let t = t.clamp(0.0, 1.0) * (table.len() - 1) as f64;
        let i = (t as usize).min(table.len() - 2);
        blend(table[i], table[i + 1], t - i as f64)
    }
}

/// A colour between two.
pub fn blend(a: Rgb, b: Rgb, share: f64) -> Rgb {
    [0, 1, 2].map(|k| (f64::from(a[k]) + share * (f64::from(b[k]) - f64::from(a[k]))).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness L* (CIE 1976) of a colour.
    fn lightness(rgb: Rgb) -> f64 {
        let linear = rgb.map(|v| {
            let v = f64::from(v) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        if y > 0.008_856 { 116.0 * y.cbrt() - 16.0 } else { 903.3 * y }
    }

    #[test]
    fn viridis_grows_lighter_evenly() {
        let steps: Vec<f64> = (0..=20).map(|i| lightness(Map::Viridis.at(f64::from(i) / 20.0))).collect();
        let mean = (steps[20] - steps[0]) / 20.0;
        for pair in steps.windows(2) {
            assert!((pair[1] - pair[0] - mean).abs() < 0.35 * mean, "{steps:?}");
        }
    }

    #[test]
    fn the_diverging_map_is_lightest_in_the_middle_and_as_light_on_both_sides() {
        let at = |t: f64| lightness(Map::Diverging.at(t));
        for i in 0..10 {
            let t = 0.05 * f64::from(i);
            assert!(at(t) < at(t + 0.05) && at(1.0 - t) < at(0.95 - t));
            assert!((at(t) - at(1.0 - t)).abs() < 6.0, "{t}: {} {}", at(t), at(1.0 - t));
        }
        assert_eq!((Map::of([-1.0, 2.0]), Map::of([0.0, 2.0])), (Map::Diverging, Map::Viridis));
    }
}
