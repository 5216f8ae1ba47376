//! Curves over axes with round ticks, several charts below each other.

use super::ticks::Ticks;
use super::{Canvas, Drawn, FAINT, GREY, HPos, INK, Picture, RGBColor, TEXT, Text, VPos};
use plotters::prelude::DrawingBackend;
use std::ops::RangeInclusive;

/// Width of a picture (points).
pub const WIDTH: u32 = 720;
/// Height of the axes of a chart (points).
const HEIGHT: f64 = 300.0;
/// Space for the ticks and the title of the vertical axis (points).
const LEFT: f64 = 84.0;
/// Space on the right of the axes (points).
const RIGHT: f64 = 24.0;
/// Space for the ticks and the title of the horizontal axis (points).
const BELOW: f64 = 56.0;
/// Height of a line of text (points).
const LINE: f64 = 18.0;
/// The same of small text (points).
const SMALL: f64 = 12.0;

/// How the places of a series are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Line,
    /// Circles, for values to compare with.
    Points,
}

/// Places to show, and what they are called in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub name: String,
    pub style: Style,
    pub colour: RGBColor,
    pub places: Vec<[f64; 2]>,
}

/// A line across a chart, with what it is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub at: f64,
    pub name: String,
}

/// Curves over one pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    pub title: String,
    /// Titles of the axes, with units.
    pub axes: [String; 2],
    pub series: Vec<Series>,
    /// Horizontal lines, such as a value from the literature.
    pub levels: Vec<Mark>,
    /// Thin vertical lines, such as where phases begin.
    pub borders: Vec<Mark>,
}

/// The chart of the columns in a `unit`, a new one with the titles `axes` if there is none yet.
pub fn of_unit<'a>(charts: &'a mut Vec<(String, Chart)>, unit: &str, axes: [String; 2]) -> &'a mut Chart {
    let i = charts.iter().position(|(known, _)| known == unit).unwrap_or_else(|| {
        charts.push((unit.to_owned(), Chart { axes: axes.clone(), ..Chart::default() }));
        charts.len() - 1
    });
    let chart = &mut charts[i].1;
    if chart.axes[1] != axes[1] {
        // Several columns along one axis: the legend names them.
        chart.axes[1] = if unit.is_empty() { String::new() } else { format!("[{unit}]") };
    }
    chart
}

/// Charts below each other, under a title.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Charts {
    pub title: String,
    /// Below the title, such as that a run is not finished.
    pub remark: String,
    pub charts: Vec<Chart>,
}

impl Picture for Charts {
    fn size(&self) -> [u32; 2] {
        let height: f64 = self.charts.iter().map(Chart::height).sum();
        [WIDTH, (self.head() + height).ceil() as u32]
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Drawn {
        let mut top = 8.0;
        let lines = [(&self.title, Text { size: 16.0, bold: true, ..middle() }), (&self.remark, middle())];
        for (text, how) in lines.into_iter().filter(|(text, _)| !text.is_empty()) {
            canvas.text(text, [f64::from(WIDTH) / 2.0, top], how)?;
            top += LINE + 6.0;
        }
        for chart in &self.charts {
            chart.draw(canvas, top)?;
            top += chart.height();
        }
        Ok(())
    }
}

impl Charts {
    fn head(&self) -> f64 {
        let lines = [&self.title, &self.remark].iter().filter(|text| !text.is_empty()).count();
        8.0 + lines as f64 * (LINE + 6.0)
    }
}

fn middle() -> Text {
    Text::at(HPos::Center, VPos::Top)
}

/// Where an axis begins and ends on the paper (points), and what it shows.
struct Axis {
    range: RangeInclusive<f64>,
    paper: [f64; 2],
    ticks: Ticks,
}

impl Axis {
    /// An axis that shows `values`, with a little space beyond, from zero on where they come near it.
    fn around(values: impl Iterator<Item = f64>, paper: [f64; 2], ticks: usize) -> Self {
        let finite = values.filter(|v| v.is_finite());
        let (mut low, mut high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if low == high {
            (low, high) = if low == 0.0 { (0.0, 1.0) } else { (low - 0.1 * low.abs(), high + 0.1 * low.abs()) };
        }
        let width = high - low;
        let (near, space) = (0.3 * width, 0.04 * width);
        let low = if (0.0..=near).contains(&low) { 0.0 } else { low - space };
        let high = if (-near..=0.0).contains(&high) { 0.0 } else { high + space };
        let range = low..=high;
        Self { ticks: Ticks::within(&range, ticks), range, paper }
    }

    fn place(&self, value: f64) -> f64 {
        let (low, high) = (self.range.start(), self.range.end());
        self.paper[0] + (value - low) / (high - low) * (self.paper[1] - self.paper[0])
    }
}

impl Chart {
    fn rows(&self) -> usize {
        // Two names a row; one alone needs no legend.
        if self.series.len() > 1 { self.series.len().div_ceil(2) } else { 0 }
    }

    fn over(&self) -> f64 {
        let title = if self.title.is_empty() { 0.0 } else { LINE };
        let borders = if self.borders.is_empty() { 0.0 } else { LINE + SMALL };
        8.0 + title + borders + self.rows() as f64 * LINE
    }

    fn height(&self) -> f64 {
        self.over() + HEIGHT + BELOW
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, top: f64) -> Drawn {
        let (left, right) = (LEFT, f64::from(WIDTH) - RIGHT);
        let (upper, lower) = (top + self.over(), top + self.over() + HEIGHT);
        let values = |d: usize| self.series.iter().flat_map(move |series| series.places.iter().map(move |p| p[d]));
        let x = Axis::around(values(0).chain(self.borders.iter().map(|border| border.at)), [left, right], 8);
        let y = Axis::around(values(1).chain(self.levels.iter().map(|level| level.at)), [lower, upper], 6);
        self.axes(canvas, &x, &y)?;
        self.lines(canvas, &x, &y)?;
        for series in &self.series {
            let places = series.places.iter().filter(|p| p.iter().all(|v| v.is_finite()));
            let places: Vec<_> = places.map(|p| [x.place(p[0]), y.place(p[1])]).collect();
            series.draw(canvas, &places)?;
        }
        let how = Text { bold: true, ..Text::at(HPos::Left, VPos::Top) };
        if !self.title.is_empty() {
            canvas.text(&self.title, [left, top + 2.0], how)?;
        }
        self.legend(canvas, top + if self.title.is_empty() { 0.0 } else { LINE })
    }

    fn axes<B: DrawingBackend>(&self, canvas: &Canvas<B>, x: &Axis, y: &Axis) -> Drawn {
        let ([left, right], [lower, upper]) = (x.paper, y.paper);
        for &value in &x.ticks.values {
            let at = x.place(value);
            canvas.line(&[[at, lower], [at, upper]], FAINT, 0.75)?;
            canvas.text(&x.ticks.label(value), [at, lower + 6.0], middle())?;
        }
        for &value in &y.ticks.values {
            let at = y.place(value);
            canvas.line(&[[left, at], [right, at]], FAINT, 0.75)?;
            canvas.text(&y.ticks.label(value), [left - 6.0, at], Text::at(HPos::Right, VPos::Center))?;
        }
        let frame = [[left, upper], [right, upper], [right, lower], [left, lower], [left, upper]];
        canvas.line(&frame, INK, 0.75)?;
        canvas.text(&self.axes[0], [(left + right) / 2.0, lower + 26.0], middle())?;
        let how = Text { upwards: true, ..Text::at(HPos::Center, VPos::Top) };
        canvas.text(&self.axes[1], [8.0, (lower + upper) / 2.0], how)
    }

    /// The lines across the chart.
    fn lines<B: DrawingBackend>(&self, canvas: &Canvas<B>, x: &Axis, y: &Axis) -> Drawn {
        let ([left, right], [lower, upper]) = (x.paper, y.paper);
        // Names stand in two rows; one that finds no room in either is left out.
        let mut free = [left; 2];
        for border in &self.borders {
            let at = x.place(border.at);
            canvas.line(&[[at, lower], [at, upper]], GREY, 0.75)?;
            let how = Text { size: TEXT - 2.0, colour: GREY, ..Text::at(HPos::Left, VPos::Bottom) };
            if let Some(row) = free.iter().position(|&free| at >= free) {
                canvas.text(&border.name, [at, upper - 2.0 - row as f64 * SMALL], how)?;
                free[row] = at + canvas.width(&border.name, how) + 6.0;
            }
        }
        for level in &self.levels {
            let at = y.place(level.at);
            canvas.line(&[[left, at], [right, at]], INK, 1.0)?;
            canvas.text(&level.name, [right - 4.0, at - 1.0], Text::at(HPos::Right, VPos::Bottom))?;
        }
        Ok(())
    }

    fn legend<B: DrawingBackend>(&self, canvas: &Canvas<B>, top: f64) -> Drawn {
        if self.rows() == 0 {
            return Ok(());
        }
        let column = (f64::from(WIDTH) - LEFT - RIGHT) / 2.0;
        for (i, series) in self.series.iter().enumerate() {
            let left = LEFT + (i % 2) as f64 * column;
            let at = top + 8.0 + (i / 2) as f64 * LINE;
            match series.style {
                Style::Line => series.draw(canvas, &[[left, at], [left + 24.0, at]])?,
                Style::Points => series.draw(canvas, &[[left + 12.0, at]])?,
            }
            canvas.text(&series.name, [left + 32.0, at], Text::at(HPos::Left, VPos::Center))?;
        }
        Ok(())
    }
}

impl Series {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, places: &[[f64; 2]]) -> Drawn {
        match self.style {
            Style::Line if places.len() > 1 => canvas.line(&thinned(places), self.colour, 1.6),
            Style::Line => places.iter().try_for_each(|&place| canvas.circle(place, 2.5, self.colour, true)),
            Style::Points => places.iter().try_for_each(|&place| canvas.circle(place, 3.5, self.colour, false)),
        }
    }
}

/// Places of a line without those that lie upon the one before (points of the paper): a long history has thousands in a spot.
fn thinned(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    /// Nobody sees less (points).
    const NEAR: f64 = 0.1;
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(places.len());
    for (i, place) in places.iter().enumerate() {
        let far = kept.last().is_none_or(|last| (0..2).any(|d| (last[d] - place[d]).abs() > NEAR));
        if far || i + 1 == places.len() {
            kept.push(*place);
        }
    }
    kept
}
