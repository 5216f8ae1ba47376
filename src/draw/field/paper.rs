//! Where a picture shows what.

/// Space beside the axes for the title and ticks of the vertical one (points).
pub const LEFT: f64 = 62.0;

/// Where the window is on the paper.
pub struct Paper {
    pub window: [f64; 4],
    /// Points of the paper in a metre.
    pub scale: f64,
    /// Of the axes (points).
    pub size: [f64; 2],
    /// Where they begin (points).
    pub above: f64,
    pub height: f64,
    pub width: f64,
}

impl Paper {
    /// Where a place is on the paper.
    pub fn at(&self, x: [f64; 2]) -> [f64; 2] {
        [LEFT + self.scale * (x[0] - self.window[0]), self.above + self.scale * (self.window[3] - x[1])]
    }

    /// Whether a place is in the window.
    pub fn sees(&self, x: [f64; 2]) -> bool {
        (0..2).all(|d| self.window[d] <= x[d] && x[d] <= self.window[d + 2])
    }

    /// The part of a line on the paper that is within the axes.
    pub fn clipped(&self, [a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let (low, way) = ([LEFT, self.above], [b[0] - a[0], b[1] - a[1]]);
        let (mut begin, mut end) = (0.0f64, 1.0f64);
        for d in 0..2 {
            let sides = [low[d], low[d] + self.size[d]].map(|side| (side - a[d]) / way[d]);
            if way[d] != 0.0 {
                (begin, end) = (begin.max(sides[0].min(sides[1])), end.min(sides[0].max(sides[1])));
            } else if a[d] < low[d] || a[d] > low[d] + self.size[d] {
                return None;
            }
        }
        (begin < end).then(|| [begin, end].map(|t| [0, 1].map(|d| a[d] + t * way[d])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_axes() {
        let paper = Paper {
            window: [0.0, 0.0, 4.0, 2.0],
            scale: 50.0,
            size: [200.0, 100.0],
            above: 40.0,
            height: 200.0,
            width: 400.0,
        };
        let at = |x: f64, y: f64| paper.at([x, y]);
        let clipped = |a: [f64; 2], b: [f64; 2]| paper.clipped([a, b]);
        assert_eq!(clipped(at(1.0, 1.0), at(1.0, 5.0)), Some([at(1.0, 1.0), at(1.0, 2.0)]));
        assert_eq!(clipped(at(-1.0, 1.0), at(9.0, 1.0)), Some([at(0.0, 1.0), at(4.0, 1.0)]));
        assert_eq!(clipped(at(1.0, 3.0), at(3.0, 3.0)), None);
        assert_eq!(clipped(at(1.0, 3.0), at(3.0, 4.0)), None);
        assert!(paper.sees([4.0, 0.0]) && !paper.sees([4.1, 0.0]));
    }
}
