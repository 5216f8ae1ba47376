//! What is drawn over a field: arrows, crosses of principal stresses, points that yield.

use super::paper::{LEFT, Paper};
use super::triangles::place;
use crate::draw::ticks::Ticks;
use crate::draw::{Canvas, Drawn, HPos, INK, RGBColor, Raster, Text, VPos, width};
use crate::error::{Error, Result};
use crate::io::container::Data;
use crate::io::vtu::Grid;
use plotters::prelude::DrawingBackend;
use std::collections::BTreeMap;

/// Side of the squares of the paper (points), in each of which one arrow or cross is drawn: that of the point next to its middle.
const SQUARE: f64 = 24.0;
/// The part of the arrows (-) that are no longer than one and a half squares.
const MOST: f64 = 0.95;
/// The least width of a point at yield (points).
const LEAST: f64 = 0.8;
/// The largest.
const WIDEST: f64 = 2.6;
/// Space between a symbol of the legend and its text (points).
const BESIDE: f64 = 6.0;
/// Colours of principal stresses in tension, of points at yield, and of those at a limit of tension with what is inside.
const TENSION: RGBColor = RGBColor(213, 94, 0);
const PLASTIC: [u8; 3] = [200, 30, 30];
const CUT_OFF: [[u8; 3]; 2] = [[20, 20, 20], [255, 255, 255]];

/// What is drawn at the material points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// Places (m) of the points.
    places: Vec<[f64; 2]>,
    /// What arrows are of, with the unit, and a vector for each point.
    arrows: Option<(String, String, Vec<[f64; 2]>)>,
    /// The stress (kPa) of each point: xx, yy and xy.
    stress: Option<Vec<[f64; 3]>>,
    /// 1 for a point at yield, 2 for one at a limit of tension.
    plastic: Option<Vec<f64>>,
}

/// A column of the points, with its unit and components.
fn column<'a>(points: &'a Grid, name: &str) -> Option<(&'a str, usize, &'a [f64])> {
    points.point_data.iter().find_map(|array| match (array.name.rsplit_once(" ["), &array.data) {
        (Some((own, unit)), Data::F64(values)) if own == name => {
            Some((unit.trim_end_matches(']'), array.components, &values[..]))
        }
        _ => None,
    })
}

/// The largest of 1, 2, 5 times a power of ten up to a value, with its label.
fn round(value: f64) -> (f64, String) {
    let power = 10f64.powf(value.log10().floor());
    let shown =
        [5.0, 2.0, 1.0].map(|multiple| multiple * power).into_iter().find(|shown| *shown <= value * (1.0 + 1e-9));
    let shown = shown.unwrap_or(power);
    (shown, Ticks::within(&(0.0..=shown), 1).label(shown))
}

impl Overlay {
    /// Of the material points with their fields.
    ///
    /// # Errors
    /// `Input` for arrows of what is no vector.
    pub fn of(points: &Grid, arrows: Option<&str>, crosses: bool, plastic: bool) -> Result<Self> {
        let arrows = arrows.map(|name| match column(points, name) {
            Some((unit, 3, values)) => {
                Ok((name.to_owned(), unit.to_owned(), values.chunks_exact(3).map(|v| [v[0], v[1]]).collect()))
            }
            _ => Err(Error::input("--arrows", format!("`{name}` is no vector"), "write `displacement` or `velocity`")),
        });
        let stress = crosses.then(|| column(points, "stress")).flatten();
        let plastic = plastic.then(|| column(points, "plastic_points")).flatten();
        Ok(Self {
            places: (0..points.points.len() / 3).map(|i| place(points, i as i64)).collect(),
            arrows: arrows.transpose()?,
            stress: stress.map(|(_, _, values)| values.chunks_exact(6).map(|s| [s[0], s[1], s[3]]).collect()),
            plastic: plastic.map(|(_, _, values)| values.to_vec()),
        })
    }

    /// Whether it needs a line below the axes.
    pub fn has_legend(&self) -> bool {
        self.arrows.is_some() || self.stress.is_some() || self.plastic.is_some()
    }

    /// Fills the points that yield, as seen on a side.
    pub fn fill(&self, raster: &mut Raster, paper: &Paper, side: f64) {
        let seen = |x: &[f64; 2]| paper.sees([side * x[0], x[1]]);
        let count = self.places.iter().filter(|x| seen(x)).count().max(1) as f64;
        // Half of the mean distance of points, so that the field is seen between them.
        let width = (0.5 * (paper.size[0] * paper.size[1] / count).sqrt()).clamp(LEAST, WIDEST);
        for (x, value) in self.places.iter().zip(self.plastic.iter().flatten()).filter(|(x, _)| seen(x)) {
            disc(raster, paper.at([side * x[0], x[1]]), *value, width);
        }
    }

    /// One point of each square of the paper, of those in the window, with the side that it is seen on.
    fn sampled(&self, paper: &Paper, sides: &[f64]) -> Vec<(f64, usize, [f64; 2])> {
        let mut squares: BTreeMap<[i64; 2], (f64, f64, usize, [f64; 2])> = BTreeMap::new();
        for (&side, (p, x)) in
            sides.iter().flat_map(|side| self.places.iter().enumerate().map(move |each| (side, each)))
        {
            let x = [side * x[0], x[1]];
            if !paper.sees(x) {
                continue;
            }
            let at = paper.at(x);
            let square = at.map(|v| (v / SQUARE).floor());
            let off = (0..2).map(|d| (at[d] / SQUARE - square[d] - 0.5).powi(2)).sum::<f64>();
            let entry = squares.entry(square.map(|v| v as i64)).or_insert((off, side, p, at));
            if off < entry.0 {
                *entry = (off, side, p, at);
            }
        }
        squares.into_values().map(|(_, side, p, at)| (side, p, at)).collect()
    }

    /// Draws arrows and crosses, and says below the axes how long they are.
    ///
    /// # Errors
    /// What the canvas gives.
    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, paper: &Paper, sides: &[f64], below: f64) -> Drawn {
        let sampled = self.sampled(paper, sides);
        let how = Text { size: 11.0, ..Text::at(HPos::Left, VPos::Center) };
        let mut legend = Legend { left: LEFT, how };
        if let Some((name, unit, vectors)) = &self.arrows {
            let scale = scale(sampled.iter().map(|&(_, p, _)| vectors[p][0].hypot(vectors[p][1])), 1.5 * SQUARE);
            for &(side, p, at) in &sampled {
                let [x, y] = vectors[p].map(|v| v * scale);
                arrow(canvas, at, [at[0] + side * x, at[1] - y], |ends| paper.clipped(ends))?;
            }
            if scale > 0.0 {
                let (shown, label) = round(1.5 * SQUARE / scale);
                let text = format!("{name} {label} {unit}");
                let [from, to] = legend.entry(shown * scale, &text);
                arrow(canvas, [from, below], [to, below], Some)?;
                canvas.text(&text, [to + BESIDE, below], how)?;
            }
        }
        if let Some(stresses) = &self.stress {
            let principal = |p: usize| {
                let [xx, yy, xy] = stresses[p];
                let (mean, radius, angle) =
                    (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy), 0.5 * (2.0 * xy).atan2(xx - yy));
                [(mean + radius, angle), (mean - radius, angle + std::f64::consts::FRAC_PI_2)]
            };
            let largest = |p: usize| principal(p).iter().fold(0.0f64, |most, (s, _)| most.max(s.abs()));
            let scale = scale(sampled.iter().map(|&(_, p, _)| largest(p)), 0.9 * SQUARE);
            for &(side, p, at) in &sampled {
                for (stress, angle) in principal(p) {
                    let half = 0.5 * scale * stress.abs();
                    let [x, y] = [side * half * angle.cos(), -half * angle.sin()];
                    let colour = if stress > 0.0 { TENSION } else { INK };
                    if let Some(ends) = paper.clipped([[at[0] - x, at[1] - y], [at[0] + x, at[1] + y]]) {
                        canvas.line(&ends, colour, 1.0)?;
                    }
                }
            }
            if scale > 0.0 {
                let (shown, label) = round(0.9 * SQUARE / scale);
                for (what, colour) in [("compression", INK), ("tension", TENSION)] {
                    let text = format!("{what} {label} kPa");
                    let [from, to] = legend.entry(shown * scale, &text);
                    canvas.line(&[[from, below], [to, below]], colour, 1.0)?;
                    canvas.text(&text, [to + BESIDE, below], how)?;
                }
            }
        }
        for (text, wanted) in [("at yield", 1.0), ("at a limit of tension", 2.0)] {
            if self.plastic.iter().flatten().any(|value| *value == wanted) {
                let [from, to] = legend.entry(4.0, text);
                let (x, [r, g, b]) = (0.5 * (from + to), if wanted == 1.0 { PLASTIC } else { CUT_OFF[0] });
                canvas.circle([x, below], 2.0, RGBColor(r, g, b), wanted == 1.0)?;
                canvas.text(text, [to + BESIDE, below], how)?;
            }
        }
        Ok(())
    }
}

/// Entries below the axes, one beside the other.
struct Legend {
    left: f64,
    how: Text,
}

impl Legend {
    /// Where the symbol of an entry begins and ends, given how wide that is (points).
    fn entry(&mut self, symbol: f64, text: &str) -> [f64; 2] {
        let ends = [self.left, self.left + symbol];
        self.left = ends[1] + BESIDE + width(text, self.how) + 3.0 * BESIDE;
        ends
    }
}

/// Points of the paper in a unit, such that most lengths are no longer than `longest` (points); 0 where all are zero.
fn scale(lengths: impl Iterator<Item = f64>, longest: f64) -> f64 {
    let mut lengths: Vec<f64> = lengths.collect();
    lengths.sort_by(f64::total_cmp);
    let most = lengths.get((MOST * lengths.len() as f64) as usize).or(lengths.last()).copied().unwrap_or(0.0);
    if most > 0.0 { longest / most } else { 0.0 }
}

/// A point that yields, of a width on the paper.
fn disc(raster: &mut Raster, at: [f64; 2], value: f64, width: f64) {
    if value > 1.5 {
        raster.line(at, at, 1.5 * width, CUT_OFF[0], 1.0);
        raster.line(at, at, 0.9 * width, CUT_OFF[1], 1.0);
    } else if value > 0.5 {
        raster.line(at, at, width, PLASTIC, 1.0);
    }
}

/// An arrow, as far as `clipped` leaves it.
fn arrow<B: DrawingBackend>(
    canvas: &Canvas<B>,
    from: [f64; 2],
    to: [f64; 2],
    clipped: impl Fn([[f64; 2]; 2]) -> Option<[[f64; 2]; 2]>,
) -> Drawn {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = way[0].hypot(way[1]);
    if length < 0.5 {
        return Ok(());
    }
    let head = (0.35 * length).min(5.0) / length;
    let side =
        |sign: f64| [to[0] - head * (way[0] - sign * 0.5 * way[1]), to[1] - head * (way[1] + sign * 0.5 * way[0])];
    for ends in [[from, to], [side(1.0), to], [side(-1.0), to]].into_iter().filter_map(clipped) {
        canvas.line(&ends, INK, 0.9)?;
    }
    Ok(())
}
