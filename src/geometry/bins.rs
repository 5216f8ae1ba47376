//! Which of many boxes are near a place: a uniform grid of bins.

use super::box_around;

/// Items by the bins that their boxes touch, in ascending order within a bin.
#[derive(Clone, Debug, Default)]
pub struct Bins {
    low: [f64; 2],
    side: f64,
    count: [usize; 2],
    offset: Vec<u32>,
    items: Vec<u32>,
}

/// The most bins in a direction.
const MOST: f64 = 2048.0;

impl Bins {
    /// Bins at least `side` wide over boxes given by opposite corners.
    pub fn new(boxes: impl Iterator<Item = ([f64; 2], [f64; 2])> + Clone, side: f64) -> Self {
        let around = box_around(boxes.clone().flat_map(|(a, b)| [a, b]));
        let Some([low, high]) = around else { return Self::default() };
        if !(low[0] <= high[0] && low[1] <= high[1] && side > 0.0) {
            return Self::default();
        }
        let side = side.max((high[0] - low[0]).max(high[1] - low[1]) / MOST);
        let count = [0, 1].map(|d| ((high[d] - low[d]) / side) as usize + 1);
        let total = count[0] * count[1];
        let mut bins = Self { low, side, count, offset: vec![0; total + 1], items: Vec::new() };
        for item in boxes.clone() {
            bins.touched(item).for_each(|bin| bins.offset[bin + 1] += 1);
        }
        for i in 0..total {
            bins.offset[i + 1] += bins.offset[i];
        }
        bins.items = vec![0; bins.offset[total] as usize];
        let mut next = bins.offset.clone();
        for (number, item) in boxes.enumerate() {
            for bin in bins.touched(item) {
                bins.items[next[bin] as usize] = number as u32;
                next[bin] += 1;
            }
        }
        bins
    }

    /// The items of the bin that holds `x` and of the eight around it: all nearer than the width of a bin. An item may
    /// be in several.
    pub fn around<'a>(&'a self, x: &[f64; 2]) -> impl Iterator<Item = &'a [u32]> + use<'a> {
        let range = |d: usize| {
            let at = ((x[d] - self.low[d]) / self.side).floor();
            let last = self.count[d] as f64 - 1.0;
            // Empty where `x` is farther out than one bin, and where there are no bins.
            let (first, last) = ((at - 1.0).max(0.0), (at + 1.0).min(last));
            if first <= last { first as usize..last as usize + 1 } else { 0..0 }
        };
        let (columns, rows) = (range(0), range(1));
        rows.flat_map(move |row| columns.clone().map(move |column| row * self.count[0] + column))
            .map(|bin| &self.items[self.offset[bin] as usize..self.offset[bin + 1] as usize])
    }

    /// The items of the bins that a box touches: all that overlap it. An item may be in several.
    pub fn beside(&self, item: ([f64; 2], [f64; 2])) -> impl Iterator<Item = &[u32]> {
        self.touched(item).map(|bin| &self.items[self.offset[bin] as usize..self.offset[bin + 1] as usize])
    }

    fn touched(&self, (a, b): ([f64; 2], [f64; 2])) -> impl Iterator<Item = usize> + use<> {
        let index = |d: usize, x: f64| ((x - self.low[d]) / self.side) as usize;
        // Empty where there are no bins.
        let range = |d: usize| match self.count[d].checked_sub(1) {
            Some(last) => index(d, a[d].min(b[d])).min(last)..index(d, a[d].max(b[d])).min(last) + 1,
            None => 0..0,
        };
        let (columns, rows, width) = (range(0), range(1), self.count[0]);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_is_within_a_bin_of_a_place_is_found() {
        let place = |k: usize| [0.754_877_666, 0.569_840_291].map(|g| 7.0 * (g * (k + 1) as f64).fract() - 2.0);
        let boxes: Vec<_> = (0..300).map(|k| (place(k), place(k).map(|x| x + 0.2))).collect();
        let bins = Bins::new(boxes.iter().copied(), 0.5);
        for k in 0..400 {
            let x = place(k + 1000).map(|x| 1.3 * x - 0.5);
            for (number, (low, high)) in boxes.iter().enumerate() {
                let gap = [0, 1].map(|d| (low[d] - x[d]).max(x[d] - high[d]).max(0.0));
                let found = bins.around(&x).any(|bin| bin.contains(&(number as u32)));
                assert!(found || gap[0].hypot(gap[1]) >= bins.side, "{x:?} {number}");
            }
        }
        let none = Bins::new(std::iter::empty(), 1.0);
        assert_eq!((none.around(&[0.0; 2]).count(), none.beside(([0.0; 2], [1.0; 2])).count()), (0, 0));
    }
}
