//! A field over the soil at one time: the soil as a filled body in the colours of the field, structures, surface, contact.

use super::colour::{Map, Rgb};
use super::raster::Raster;
use super::ticks::Ticks;
use super::{Canvas, Drawn, GREY, HPos, INK, Picture, Text, VPos, width, wrapped};
use crate::error::{Error, Result};
use crate::io::container::Data;
use crate::io::export::Shown;
use crate::io::vtu::Array;
use plotters::prelude::DrawingBackend;

mod asked;
mod contours;
mod overlay;
mod paper;
mod range;
mod triangles;

pub use asked::Asked;
use contours::{multiples, segment};
use overlay::Overlay;
use paper::{LEFT, Paper};
use triangles::{Triangles, cell_edges, place, triangles};

/// For the colour bar and its numbers.
const RIGHT: f64 = 104.0;
/// For the title of the colour bar, and what is beyond its ends.
const ABOVE: f64 = 26.0;
/// For a line of the title.
const LINE: f64 = 18.0;
/// For the title and ticks of the horizontal axis.
const BELOW: f64 = 48.0;
/// For the legend of arrows and the like.
const LEGEND: f64 = 20.0;
/// Width of the colour bar (points).
const BAR: f64 = 14.0;
/// Its distance from the axes (points).
const BESIDE: f64 = 16.0;
/// The axes are at most so many times as high as the picture is wide.
const HIGHEST: f64 = 1.4;
/// And have at least room of this height (points).
const LOWEST: f64 = 60.0;
/// The part of the window (-) that is left around the bodies.
const MARGIN: f64 = 0.03;
/// The part of the window (-) that the largest contact pressure is high.
const CONTACT_HEIGHT: f64 = 0.12;

const STRUCTURE: Rgb = [168, 168, 168];
/// Soil whose field is not known.
const UNKNOWN: Rgb = [235, 235, 235];
const LINES: Rgb = [40, 40, 40];
const CONTACT: Rgb = [230, 85, 13];
/// The number of what a structure of region 0 shows; soil is below.
const STRUCTURES: u16 = 1 << 15;

/// How a field is to be seen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Values at the ends of the colour bar; without it those that a small part of the soil lies beyond.
    pub range: Option<[f64; 2]>,
    /// What is seen (m): x and y of the lower left corner, and of the upper right one.
    pub window: Option<[f64; 4]>,
    /// Width of the picture (pixels of a PNG).
    pub width: Option<u32>,
    /// Whether the lines of the grid are drawn.
    pub mesh: bool,
    /// Whether the contact pressure is drawn along structures.
    pub contact: bool,
    /// Whether the other half is drawn too, mirrored at x = 0.
    pub mirror: bool,
    /// Whether x is the radius.
    pub axisymmetric: bool,
    /// The vector that arrows show.
    pub arrows: Option<String>,
    /// Whether crosses show principal stresses.
    pub crosses: bool,
    /// Whether points at yield and at limits of tension are drawn.
    pub plastic_points: bool,
    /// Whether lines join places of one value.
    pub contours: bool,
    /// The spacing (m) of a square net that was on the soil before it was displaced.
    pub net: Option<f64>,
    /// Regions that are not drawn.
    pub hidden: Vec<u16>,
}

impl Options {
    /// The fields that are needed besides the one in colours.
    pub fn needs(&self) -> impl Iterator<Item = String> {
        let net = self.net.map(|_| "displacement".to_owned());
        let stress = self.crosses.then(|| "stress".to_owned());
        let plastic = self.plastic_points.then(|| "plastic_points".to_owned());
        self.arrows.clone().into_iter().chain(stress).chain(plastic).chain(net)
    }
}

/// The pixels of a PNG that is not told how wide to be.
const WIDTH: u32 = 1600;

/// A line along a structure, with the contact pressure (kPa) and the unit normal into the soil at both ends.
#[derive(Clone, Debug, PartialEq)]
struct Pressed {
    ends: [[f64; 2]; 2],
    pressure: [f64; 2],
    normal: [[f64; 2]; 2],
}

/// A field over the soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    pub title: String,
    /// The title of the colour bar.
    name: String,
    soil: Triangles,
    structures: Triangles,
    /// Edges of the cells of the grid (m).
    edges: Vec<[[f64; 2]; 2]>,
    contact: Vec<Pressed>,
    overlay: Overlay,
    /// Where the corners of the triangles were (m) before they were displaced, if a net is drawn.
    seeded: [Vec<[f64; 3]>; 2],
    /// Lines that the title has room for at least.
    least_lines: usize,
    options: Options,
}

impl Field {
    /// The field that is `asked` for, of a frame.
    ///
    /// # Errors
    /// `Input` where the soil is not known as a body, has not the field, or this not the component.
    pub fn of(shown: &Shown, is_soil: &[bool], asked: &Asked, title: String, options: Options) -> Result<Self> {
        let Some(soil) = &shown.soil else {
            let problem = "the soil cannot be drawn as a body: the frames hold no `displacement`";
            return Err(Error::input(
                "output.fields",
                problem,
                "add `displacement` to the fields of the case, and solve it again",
            ));
        };
        let Some((name, values)) = asked.values(soil)? else {
            let known: Vec<&str> = soil.point_data.iter().filter_map(|a| Some(a.name.rsplit_once(" [")?.0)).collect();
            let remedy = format!("the frame has {}", known.join(", "));
            return Err(Error::input(format!("--field {}", asked.array), "there is no such field", remedy));
        };
        let structures = shown.structures.as_ref().map_or_else(Triangles::default, |grid| {
            let wanted = |region: u16| !is_soil[region as usize] && !options.hidden.contains(&region);
            triangles(grid, &vec![0.0; grid.points.len() / 3], wanted)
        });
        let mut edges = Vec::new();
        if options.mesh {
            edges.extend(std::iter::once(&shown.grid).chain(&shown.structures).flat_map(cell_edges));
        }
        let mut contact = Vec::new();
        if options.contact {
            let Some(grid) = &shown.contact else {
                return Err(Error::input("--contact", "the case has no contact", "take `--contact` out"));
            };
            let pressure = |i: i64| match grid.point_data.iter().find(|a| a.name.starts_with("contact_pressure ")) {
                Some(Array { data: Data::F64(values), .. }) => values[i as usize],
                _ => 0.0,
            };
            let lines: Vec<[i64; 2]> = grid.topology.connectivity.chunks_exact(2).map(|l| [l[0], l[1]]).collect();
            // Lines that go on from each other have a node in common; their normals there are one.
            let mut normals = vec![[0.0; 2]; grid.points.len() / 3];
            for [i, j] in &lines {
                let (a, b) = (place(grid, *i), place(grid, *j));
                for k in [*i as usize, *j as usize] {
                    normals[k] = [normals[k][0] + b[1] - a[1], normals[k][1] + a[0] - b[0]];
                }
            }
            contact.extend(lines.into_iter().map(|ends| Pressed {
                ends: ends.map(|n| place(grid, n)),
                pressure: ends.map(pressure),
                normal: ends.map(|n| {
                    let [x, y] = normals[n as usize];
                    [x, y].map(|v| v / x.hypot(y).max(f64::MIN_POSITIVE))
                }),
            }));
        }
        let is_shown = |region: u16| !options.hidden.contains(&region);
        let overlay = Overlay::of(&shown.points, options.arrows.as_deref(), options.crosses, options.plastic_points)?;
        let seeded = match options.net.and_then(|_| soil.point_data.iter().find(|a| a.name == "displacement [m]")) {
            Some(Array { data: Data::F64(way), .. }) => [0, 1].map(|d| {
                let first: Vec<f64> =
                    soil.points.chunks_exact(3).zip(way.chunks_exact(3)).map(|(x, u)| x[d] - u[d]).collect();
                triangles(soil, &first, is_shown).values
            }),
            _ => Default::default(),
        };
        let soil = triangles(soil, &values, is_shown);
        Ok(Self { title, name, soil, structures, edges, contact, overlay, seeded, least_lines: 0, options })
    }

    /// The range of the colour bar of its own; `None` where there is no value.
    pub fn extent(&self) -> Option<[f64; 2]> {
        self.soil.usual_range()
    }

    /// The box around what there is (m): x and y of the lower left and the upper right corner.
    pub fn bounds(&self) -> [f64; 4] {
        let mut b = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for x in self.soil.places.iter().chain(&self.structures.places).flatten() {
            b = [b[0].min(x[0]), b[1].min(x[1]), b[2].max(x[0]), b[3].max(x[1])];
        }
        if self.options.mirror {
            let most = b[2].max(-b[0]);
            (b[0], b[2]) = (-most, most);
        }
        if b[0] > b[2] { [0.0, 0.0, 1.0, 1.0] } else { b }
    }

    /// Shows the same range as other pictures of a series, and what is in the same box (m), below as many lines of the title.
    pub fn fix(&mut self, range: [f64; 2], window: [f64; 4], lines: usize) {
        self.options.range.get_or_insert(range);
        self.options.window.get_or_insert(around(window));
        self.least_lines = lines;
    }

    /// The number of lines of the title.
    pub fn title_lines(&self) -> usize {
        self.lines().len().max(self.least_lines)
    }

    /// Width of the picture (points).
    fn width(&self) -> f64 {
        f64::from(self.options.width.unwrap_or(WIDTH)) / f64::from(super::PIXELS)
    }

    fn range(&self) -> [f64; 2] {
        let [low, high] = self.options.range.or_else(|| self.extent()).unwrap_or([0.0, 1.0]);
        // A constant has a colour, too.
        let size = low.abs().max(high.abs());
        match high - low > 1e-9 * size {
            true => [low, high],
            false if size > 0.0 => [low - 0.5 * size, high + 0.5 * size],
            false => [0.0, 1.0],
        }
    }

    /// The value at the ends of the colour map, which is about zero where the range has both signs.
    fn scale(&self) -> (Map, [f64; 2]) {
        let [low, high] = self.range();
        let map = Map::of([low, high]);
        let most = low.abs().max(high.abs());
        (map, if map == Map::Diverging { [-most, most] } else { [low, high] })
    }

    fn paper(&self) -> Paper {
        let [x0, y0, x1, y1] = self.options.window.unwrap_or_else(|| around(self.bounds()));
        let width = self.width();
        let (wide, high) = (x1 - x0, y1 - y0);
        let scale = ((width - LEFT - RIGHT) / wide).min(HIGHEST * width / high);
        let size = [scale * wide, scale * high];
        let above = ABOVE + LINE * self.title_lines() as f64;
        let legend = if self.overlay.has_legend() { LEGEND } else { 0.0 };
        let height = size[1].max(LOWEST) + above + BELOW + legend;
        Paper { window: [x0, y0, x1, y1], scale, size, above, height, width }
    }

    /// The lines of the title.
    fn lines(&self) -> Vec<String> {
        wrapped(&self.title, TITLE, self.width() - LEFT - 8.0)
    }

    /// What lies beyond the ends of the colour bar.
    fn beyond(&self) -> String {
        let ([low, high], Some([least, greatest])) = (self.range(), self.soil.peaks()) else { return String::new() };
        let hair = 1e-6 * (high - low);
        let said = |what: &str, (value, x): (f64, [f64; 2])| {
            let value: f64 = format!("{value:.3e}").parse().unwrap_or(value);
            format!("{what} {value} at ({:.3}, {:.3}) m", x[0], x[1])
        };
        let least = (least.0 < low - hair).then(|| said("least", least));
        let greatest = (greatest.0 > high + hair).then(|| said("largest", greatest));
        least.into_iter().chain(greatest).collect::<Vec<_>>().join(", ").replace('-', "−")
    }

    /// The largest contact pressure (kPa), if there are lines along structures.
    fn largest_pressure(&self) -> Option<f64> {
        self.contact.iter().flat_map(|line| line.pressure).reduce(f64::max)
    }

    /// Draws what is filled.
    fn fill(&self, raster: &mut Raster) {
        let paper = self.paper();
        let (map, [low, high]) = self.scale();
        let colour = |value: f64| if value.is_finite() { map.at((value - low) / (high - low)) } else { UNKNOWN };
        raster.within([LEFT, paper.above], [LEFT + paper.size[0], paper.above + paper.size[1]]);
        let sides: &[f64] = if self.options.mirror { &[1.0, -1.0] } else { &[1.0] };
        for &side in sides {
            let at = |x: &[f64; 2]| paper.at([side * x[0], x[1]]);
            for ((x, values), region) in self.soil.places.iter().zip(&self.soil.values).zip(&self.soil.region) {
                raster.triangle(&x.map(|x| at(&x)), values, region + 1, colour);
            }
            self.contour(raster, &|x| at(&x));
            for [a, b] in &self.edges {
                raster.line(at(a), at(b), 0.4, LINES, 0.45);
            }
            for (x, region) in self.structures.places.iter().zip(&self.structures.region) {
                raster.triangle(&x.map(|x| at(&x)), &[0.0; 3], STRUCTURES + region, |_| STRUCTURE);
            }
        }
        for &side in sides {
            self.overlay.fill(raster, &paper, side);
        }
        raster.outline(LINES);
        let most = self.largest_pressure().unwrap_or(0.0);
        let by = CONTACT_HEIGHT * paper.size[0].min(paper.size[1]) / most.max(f64::MIN_POSITIVE);
        for (&side, line) in sides.iter().flat_map(|side| self.contact.iter().map(move |line| (side, line))) {
            let Pressed { ends, pressure, normal } = line;
            let [a, b] = ends.map(|x| paper.at([side * x[0], x[1]]));
            // The paper's y runs down.
            let tip = |x: [f64; 2], k: usize| {
                [x[0] + by * pressure[k] * side * normal[k][0], x[1] - by * pressure[k] * normal[k][1]]
            };
            let [c, d] = [tip(b, 1), tip(a, 0)];
            if pressure.iter().any(|p| *p > 0.0) {
                raster.tint(&[a, b, c], CONTACT, 0.6);
                raster.tint(&[a, c, d], CONTACT, 0.6);
                raster.line(d, c, 0.8, CONTACT, 1.0);
            }
        }
        let bar = [LEFT + paper.size[0] + BESIDE, paper.above];
        let [bottom, top] = self.range();
        let corner = |i: usize, j: usize| [bar[0] + BAR * i as f64, bar[1] + paper.size[1] * j as f64];
        raster.within(corner(0, 0), corner(1, 1));
        raster.triangle(&[corner(0, 0), corner(1, 0), corner(0, 1)], &[top, top, bottom], 0, colour);
        raster.triangle(&[corner(1, 0), corner(1, 1), corner(0, 1)], &[top, bottom, bottom], 0, colour);
    }

    /// Draws lines of one value, at the ticks of the colour bar, and the net.
    fn contour(&self, raster: &mut Raster, at: &dyn Fn([f64; 2]) -> [f64; 2]) {
        let [low, high] = self.range();
        let levels =
            if self.options.contours { self.ticks(self.paper().size[1], low, high).values } else { Vec::new() };
        for (x, values) in self.soil.places.iter().zip(&self.soil.values) {
            for [a, b] in levels.iter().filter_map(|&level| segment(x, values, level)) {
                raster.line(at(a), at(b), 0.7, LINES, 0.75);
            }
        }
        let Some(spacing) = self.options.net else { return };
        for (x, values) in self.seeded.iter().flat_map(|seeded| self.soil.places.iter().zip(seeded)) {
            for [a, b] in multiples(values, spacing).filter_map(|level| segment(x, values, level)) {
                raster.line(at(a), at(b), 0.6, LINES, 0.6);
            }
        }
    }

    /// The ticks of the colour bar, which is so high (points).
    fn ticks(&self, height: f64, low: f64, high: f64) -> Ticks {
        Ticks::within(&(low..=high), (height / 40.0) as usize + 1)
    }

    fn painted(&self, pixels: u32) -> Raster {
        let mut raster = Raster::new(self.size().map(|n| (n * pixels) as usize), f64::from(pixels));
        self.fill(&mut raster);
        raster
    }
}

const TITLE: Text = Text { size: 13.0, colour: INK, bold: false, at: (HPos::Left, VPos::Top), upwards: false };

impl Picture for Field {
    fn size(&self) -> [u32; 2] {
        let paper = self.paper();
        [paper.width.round() as u32, paper.height.ceil() as u32]
    }

    fn raster(&self, pixels: u32) -> Option<Raster> {
        Some(self.painted(pixels))
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Drawn {
        let paper = self.paper();
        let [x0, y0, x1, y1] = paper.window;
        let (low, high) = (paper.at([x0, y0]), paper.at([x1, y1]));
        let small = |h, v| Text { size: 11.0, ..Text::at(h, v) };
        canvas.line(&[low, [high[0], low[1]], high, [low[0], high[1]], low], INK, 0.6)?;
        let ticks = Ticks::within(&(x0..=x1), (paper.size[0] / 80.0) as usize + 1);
        for &x in &ticks.values {
            let at = [paper.at([x, y0])[0], low[1]];
            canvas.line(&[at, [at[0], at[1] + 4.0]], INK, 0.6)?;
            let label = ticks.label(if self.options.mirror && self.options.axisymmetric { x.abs() } else { x });
            canvas.text(&label, [at[0], at[1] + 6.0], small(HPos::Center, VPos::Top))?;
        }
        let ticks = Ticks::within(&(y0..=y1), (paper.size[1] / 60.0) as usize + 1);
        for &y in &ticks.values {
            let at = [low[0], paper.at([x0, y])[1]];
            canvas.line(&[at, [at[0] - 4.0, at[1]]], INK, 0.6)?;
            canvas.text(&ticks.label(y), [at[0] - 6.0, at[1]], small(HPos::Right, VPos::Center))?;
        }
        let across = if self.options.axisymmetric { "r [m]" } else { "x [m]" };
        canvas.text(across, [0.5 * (low[0] + high[0]), low[1] + 24.0], small(HPos::Center, VPos::Top))?;
        let middle = [14.0, 0.5 * (low[1] + high[1])];
        canvas.text("y [m]", middle, Text { upwards: true, ..small(HPos::Center, VPos::Center) })?;

        let [bottom, top] = self.range();
        let bar = [high[0] + BESIDE, high[0] + BESIDE + BAR];
        canvas.line(
            &[[bar[0], low[1]], [bar[1], low[1]], [bar[1], high[1]], [bar[0], high[1]], [bar[0], low[1]]],
            INK,
            0.6,
        )?;
        let ticks = self.ticks(paper.size[1], bottom, top);
        for &value in &ticks.values {
            let y = low[1] + (value - bottom) / (top - bottom) * (high[1] - low[1]);
            canvas.line(&[[bar[1], y], [bar[1] + 4.0, y]], INK, 0.6)?;
            canvas.text(&ticks.label(value), [bar[1] + 6.0, y], small(HPos::Left, VPos::Center))?;
        }
        let name = small(HPos::Right, VPos::Bottom);
        let room = paper.width - LEFT - 6.0;
        canvas.fitted(&self.name, [paper.width - 6.0, high[1] - 8.0], name, room)?;
        let (beyond, left) = (self.beyond(), small(HPos::Left, VPos::Bottom));
        let room = room - width(&self.name, name) - 12.0;
        canvas.fitted(&beyond, [low[0], high[1] - 8.0], Text { colour: GREY, ..left }, room)?;
        for (i, line) in self.lines().into_iter().enumerate() {
            canvas.fitted(&line, [low[0], 8.0 + LINE * i as f64], TITLE, paper.width - LEFT - 6.0)?;
        }
        let sides: &[f64] = if self.options.mirror { &[1.0, -1.0] } else { &[1.0] };
        self.overlay.draw(canvas, &paper, sides, paper.height - 0.5 * LEGEND)?;
        if let Some(most) = self.largest_pressure() {
            let text = format!("contact pressure up to {most:.3} kPa");
            canvas.text(&text, [low[0] + 6.0, high[1] + 6.0], small(HPos::Left, VPos::Top))?;
        }
        Ok(())
    }
}

/// A box with the margin around it.
fn around([x0, y0, x1, y1]: [f64; 4]) -> [f64; 4] {
    let margin = MARGIN * (x1 - x0).max(y1 - y0);
    [x0 - margin, y0 - margin, x1 + margin, y1 + margin]
}

#[cfg(test)]
mod tests;
