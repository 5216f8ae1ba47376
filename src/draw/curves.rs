//! Curves over axes with round ticks, several charts below each other.

use super::{Canvas, Drawn, FAINT, GREY, HPos, INK, Picture, RGBColor, TEXT, Text, VPos, width, wrapped};
use axis::Axis;
use plotters::prelude::DrawingBackend;

mod axis;

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
/// Length of a line of the title (points).
const ROOM: f64 = WIDTH as f64 - 16.0;

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
    /// Whether the horizontal and the vertical axis have logarithms of values, which are positive.
    pub log: [bool; 2],
    /// Whether the vertical axis grows downwards, as a depth does.
    pub down: bool,
    /// Whether the legend is shown for one curve alone, too.
    pub named: bool,
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
        for (line, how) in self.head_lines() {
            canvas.fitted(&line, [f64::from(WIDTH) / 2.0, top], how, ROOM)?;
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
    /// The lines of the title and of the remark.
    fn head_lines(&self) -> Vec<(String, Text)> {
        let texts = [(&self.title, Text { size: 16.0, bold: true, ..middle() }), (&self.remark, middle())];
        texts
            .into_iter()
            .flat_map(|(text, how)| wrapped(text, how, ROOM).into_iter().map(move |line| (line, how)))
            .collect()
    }

    fn head(&self) -> f64 {
        8.0 + self.head_lines().len() as f64 * (LINE + 6.0)
    }
}

fn middle() -> Text {
    Text::at(HPos::Center, VPos::Top)
}

impl Chart {
    fn rows(&self) -> usize {
        // Two names a row; one alone needs no legend.
        if self.series.len() > 1 || self.named { self.series.len().div_ceil(2) } else { 0 }
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
        let of_y = if self.down { [upper, lower] } else { [lower, upper] };
        let x = Axis::around(values(0).chain(self.borders.iter().map(|b| b.at)), [left, right], 8, self.log[0]);
        let y = Axis::around(values(1).chain(self.levels.iter().map(|level| level.at)), of_y, 6, self.log[1]);
        let frame = [[left, lower], [right, upper]];
        self.axes(canvas, &x, &y, frame)?;
        self.lines(canvas, &x, &y, frame)?;
        for series in &self.series {
            // A value that is not known, or has no logarithm, is a gap.
            let places: Vec<_> = series.places.iter().map(|p| [x.place(p[0]), y.place(p[1])]).collect();
            let parts = places.split(|p| p.iter().any(|v| !v.is_finite()));
            parts.filter(|part| !part.is_empty()).try_for_each(|part| series.draw(canvas, part))?;
        }
        let how = Text { bold: true, ..Text::at(HPos::Left, VPos::Top) };
        if !self.title.is_empty() {
            canvas.fitted(&self.title, [left, top + 2.0], how, right - left)?;
        }
        self.legend(canvas, top + if self.title.is_empty() { 0.0 } else { LINE })
    }

    fn axes<B: DrawingBackend>(&self, canvas: &Canvas<B>, x: &Axis, y: &Axis, frame: [[f64; 2]; 2]) -> Drawn {
        let [[left, lower], [right, upper]] = frame;
        for (value, label) in x.marks() {
            let at = x.place(value);
            canvas.line(&[[at, lower], [at, upper]], FAINT, 0.75)?;
            canvas.text(&label, [at, lower + 6.0], middle())?;
        }
        for (value, label) in y.marks() {
            let at = y.place(value);
            canvas.line(&[[left, at], [right, at]], FAINT, 0.75)?;
            canvas.text(&label, [left - 6.0, at], Text::at(HPos::Right, VPos::Center))?;
        }
        let frame = [[left, upper], [right, upper], [right, lower], [left, lower], [left, upper]];
        canvas.line(&frame, INK, 0.75)?;
        canvas.fitted(&self.axes[0], [(left + right) / 2.0, lower + 26.0], middle(), right - left)?;
        let how = Text { upwards: true, ..Text::at(HPos::Center, VPos::Top) };
        canvas.fitted(&self.axes[1], [8.0, (lower + upper) / 2.0], how, lower - upper + BELOW)
    }

    /// The lines across the chart.
    fn lines<B: DrawingBackend>(&self, canvas: &Canvas<B>, x: &Axis, y: &Axis, frame: [[f64; 2]; 2]) -> Drawn {
        let [[left, lower], [right, upper]] = frame;
        // Names stand in two rows; one that finds no room in either is left out.
        let mut free = [left; 2];
        for border in &self.borders {
            let at = x.place(border.at);
            if !at.is_finite() {
                continue;
            }
            canvas.line(&[[at, lower], [at, upper]], GREY, 0.75)?;
            let how = Text { size: TEXT - 2.0, colour: GREY, ..Text::at(HPos::Left, VPos::Bottom) };
            let fits = at + width(&border.name, how) <= f64::from(WIDTH);
            if let Some(row) = free.iter().position(|&free| at >= free).filter(|_| fits) {
                canvas.text(&border.name, [at, upper - 2.0 - row as f64 * SMALL], how)?;
                free[row] = at + width(&border.name, how) + 6.0;
            }
        }
        for level in &self.levels {
            let at = y.place(level.at);
            if !at.is_finite() {
                continue;
            }
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
            canvas.fitted(&series.name, [left + 32.0, at], Text::at(HPos::Left, VPos::Center), column - 40.0)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::{PIXELS, pixels, width};

    fn drawn(series: Vec<Series>, more: Chart) -> Charts {
        let chart = Chart { axes: ["x [m]".into(), "y [kN]".into()], series, ..more };
        Charts { charts: vec![chart], ..Charts::default() }
    }

    /// Load and unload: the corner is so sharp that an outline of the line has one far outside.
    #[test]
    fn a_curve_that_turns_back_stays_within_its_axes() {
        let places: Vec<[f64; 2]> = (0..40)
            .flat_map(|i| {
                let x = f64::from(i) / 40.0;
                [[x, 10.0 * x], [x + 0.3, 10.0 * x + 3.0 + 0.01 * x], [x + 0.28, 10.0 * x + 2.81]]
            })
            .collect();
        let colour = RGBColor(255, 0, 0);
        let charts = drawn(vec![Series { name: String::new(), style: Style::Line, colour, places }], Chart::default());
        let ([w, h], all) = pixels(&charts).unwrap();
        let scale = f64::from(PIXELS);
        let top = charts.head() + charts.charts[0].over();
        let (mut inside, mut outside) = (0, 0);
        let is_red = |rgb: &[u8]| rgb[0] > 200 && rgb[1] < 100 && rgb[2] < 100;
        for (i, _) in all.chunks_exact(3).enumerate().filter(|(_, rgb)| is_red(rgb)) {
            let [x, y] = [i % w as usize, i / w as usize].map(|v| v as f64 / scale);
            let within = (LEFT - 1.0..=f64::from(WIDTH) - RIGHT + 1.0).contains(&x)
                && (top - 1.0..=top + HEIGHT + 1.0).contains(&y);
            *(if within { &mut inside } else { &mut outside }) += 1;
        }
        assert!(h > 600 && inside > 500 && outside == 0, "{inside} {outside}");
    }

    #[test]
    fn long_titles_are_broken_and_one_curve_has_a_legend_where_it_is_named() {
        let title = "A title of a chart that says so much about the case and all of its variants that no line of a picture has room for it";
        let series = Series { name: "a".into(), style: Style::Line, colour: INK, places: vec![[0.0, 0.0], [1.0, 1.0]] };
        let mut charts = drawn(vec![series.clone()], Chart::default());
        let plain = charts.size()[1];
        charts.title = title.into();
        let lines = charts.head_lines();
        assert!(lines.len() == 2 && lines.iter().all(|(line, how)| width(line, *how) <= ROOM), "{}", lines.len());
        assert_eq!(charts.size()[1] - plain, 2 * (LINE + 6.0) as u32);
        let named = drawn(vec![series], Chart { named: true, ..Chart::default() });
        assert_eq!(named.size()[1] - plain, LINE as u32);
    }
}
