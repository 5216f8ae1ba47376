//! Pixels: triangles with a value at each corner, lines, and the outlines of what was filled.

use super::colour::{Rgb, blend};
use crate::geometry::twice_area;

/// Sub-pixels along a pixel: edges are smooth.
const FINE: usize = 2;

/// A picture in sub-pixels that knows what each of them shows.
pub struct Raster {
    /// Pixels.
    size: [usize; 2],
    colour: Vec<Rgb>,
    /// What it shows, 0 for nothing.
    of: Vec<u16>,
    /// Where the lengths on the paper that are drawn begin, and pixels along one of them.
    pixels: f64,
    /// The part of the paper that is drawn on.
    frame: [[f64; 2]; 2],
}

impl Raster {
    /// White paper of so many pixels, with `pixels` along a length of the paper.
    pub fn new(size: [usize; 2], pixels: f64) -> Self {
        let count = size[0] * size[1] * FINE * FINE;
        let end = size.map(|n| n as f64 / pixels);
        Self { size, colour: vec![[255; 3]; count], of: vec![0; count], pixels, frame: [[0.0; 2], end] }
    }

    /// Draws within a part of the paper from now on.
    pub fn within(&mut self, low: [f64; 2], high: [f64; 2]) {
        self.frame = [low, high];
    }

    fn width(&self) -> usize {
        self.size[0] * FINE
    }

    /// The sub-pixels whose centres are between two places of the paper, in a direction.
    fn span(&self, d: usize, low: f64, high: f64) -> std::ops::Range<usize> {
        let unit = self.pixels * FINE as f64;
        let [begin, end] = [self.frame[0][d], self.frame[1][d]].map(|x| x * unit);
        let most = (self.size[d] * FINE) as f64;
        let first = (low * unit).max(begin).max(0.0) - 0.5;
        let last = (high * unit).min(end).min(most) - 0.5;
        let first = first.ceil().max(0.0) as usize;
        let last = if last < 0.0 { 0 } else { last.floor() as usize + 1 };
        first..last.max(first)
    }

    /// Calls `action` for the sub-pixels in a triangle (places on the paper), with their colour, what they show, and the shares of the second and
    /// the third corner.
    fn each(&mut self, x: &[[f64; 2]; 3], mut action: impl FnMut(&mut Rgb, &mut u16, f64, f64)) {
        let low = [0, 1].map(|d| x[0][d].min(x[1][d]).min(x[2][d]));
        let high = [0, 1].map(|d| x[0][d].max(x[1][d]).max(x[2][d]));
        let whole = twice_area(x);
        if whole == 0.0 || !whole.is_finite() {
            return;
        }
        let unit = self.pixels * FINE as f64;
        let (columns, width) = (self.span(0, low[0], high[0]), self.width());
        for row in self.span(1, low[1], high[1]) {
            let y = (row as f64 + 0.5) / unit;
            for column in columns.clone() {
                let p = [(column as f64 + 0.5) / unit, y];
                let (b, c) = (twice_area(&[x[0], p, x[2]]) / whole, twice_area(&[x[0], x[1], p]) / whole);
                // A hair beyond the sides, so that rounding leaves no gap between two triangles.
                if b >= -HAIR && c >= -HAIR && 1.0 - b - c >= -HAIR {
                    let at = row * width + column;
                    action(&mut self.colour[at], &mut self.of[at], b, c);
                }
            }
        }
    }

    /// Fills a triangle whose corners have values, in the colours of these, as a part of what has the number `of`.
    pub fn triangle(&mut self, x: &[[f64; 2]; 3], values: &[f64; 3], of: u16, colour: impl Fn(f64) -> Rgb) {
        self.each(x, |pixel, shows, b, c| {
            *pixel = colour((1.0 - b - c) * values[0] + b * values[1] + c * values[2]);
            *shows = of;
        });
    }

    /// Mixes a colour into a triangle, which shows what it did.
    pub fn tint(&mut self, x: &[[f64; 2]; 3], colour: Rgb, share: f64) {
        self.each(x, |pixel, _, _, _| *pixel = blend(*pixel, colour, share));
    }

    /// Draws a line between two places of the paper, of a width on it, mixed into what is there by its share.
    pub fn line(&mut self, a: [f64; 2], b: [f64; 2], width: f64, colour: Rgb, share: f64) {
        let unit = self.pixels * FINE as f64;
        let half = 0.5 * width;
        let along = [b[0] - a[0], b[1] - a[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let columns = self.span(0, a[0].min(b[0]) - half, a[0].max(b[0]) + half);
        let all = self.width();
        for row in self.span(1, a[1].min(b[1]) - half, a[1].max(b[1]) + half) {
            for column in columns.clone() {
                let p = [(column as f64 + 0.5) / unit - a[0], (row as f64 + 0.5) / unit - a[1]];
                let t = if square > 0.0 { ((p[0] * along[0] + p[1] * along[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
                if (p[0] - t * along[0]).hypot(p[1] - t * along[1]) <= half {
                    let at = row * all + column;
                    self.colour[at] = blend(self.colour[at], colour, share);
                }
            }
        }
    }

    /// Draws the borders between what was filled as different things, and around it, a pixel wide.
    pub fn outline(&mut self, colour: Rgb) {
        let (width, height) = (self.width(), self.size[1] * FINE);
        let columns = self.span(0, self.frame[0][0], self.frame[1][0]);
        let rows = self.span(1, self.frame[0][1], self.frame[1][1]);
        let differs = |row: usize, column: usize| {
            let own = self.of[row * width + column];
            let near = [(0, 1), (1, 0), (0, -1), (-1, 0)].map(|(i, j): (isize, isize)| {
                let (row, column) = (row.checked_add_signed(i), column.checked_add_signed(j));
                match (row, column) {
                    (Some(row), Some(column)) if row < height && column < width => self.of[row * width + column],
                    _ => own,
                }
            });
            near.iter().any(|&other| other != own)
        };
        let mut marked = Vec::new();
        for row in rows.clone() {
            marked.extend(columns.clone().filter(|&column| differs(row, column)).map(|column| row * width + column));
        }
        marked.into_iter().for_each(|at| self.colour[at] = colour);
    }

    /// The pixels, row by row from above, three bytes each.
    pub fn pixels(&self) -> Vec<u8> {
        let width = self.width();
        let mut bytes = Vec::with_capacity(self.size[0] * self.size[1] * 3);
        for row in 0..self.size[1] {
            for column in 0..self.size[0] {
                let fine =
                    (0..FINE * FINE).map(|k| self.colour[(row * FINE + k / FINE) * width + column * FINE + k % FINE]);
                let sum = fine.fold([0usize; 3], |sum, c| [0, 1, 2].map(|k| sum[k] + usize::from(c[k])));
                bytes.extend(sum.map(|sum| ((sum + FINE * FINE / 2) / (FINE * FINE)) as u8));
            }
        }
        bytes
    }
}

/// A hair (-), of the height of a triangle.
const HAIR: f64 = 1e-6;

#[cfg(test)]
impl Raster {
    /// What the sub-pixel in the middle of a place of the paper shows.
    pub fn shown(&self, place: [f64; 2]) -> u16 {
        let unit = self.pixels * FINE as f64;
        let at = [0, 1].map(|d| ((place[d] * unit) as usize).min(self.size[d] * FINE - 1));
        self.of[at[1] * self.width() + at[0]]
    }

    /// The part of the drawn part of the paper that shows something `wanted`.
    pub fn part(&self, wanted: impl Fn(u16) -> bool) -> f64 {
        let columns = self.span(0, self.frame[0][0], self.frame[1][0]);
        let rows = self.span(1, self.frame[0][1], self.frame[1][1]);
        let all = columns.len() * rows.len();
        let of = |row: usize| columns.clone().filter(|c| wanted(self.of[row * self.width() + c])).count();
        rows.map(of).sum::<usize>() as f64 / all as f64
    }
}
