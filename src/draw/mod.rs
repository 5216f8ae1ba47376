//! Pictures: curves of histories, and what a report shows of a scene.
//!
//! What is drawn is a [`Picture`]; it does not know whether it becomes an SVG or a PNG ([`write()`], by the ending of the file;
//! [`svg`] and [`png()`] in memory, for pages). Lengths on the paper are in points, of which a PNG has `PIXELS` pixels each. The font
//! of a PNG is within the program, so pictures are the same on every machine; an SVG names a family and leaves it to the reader.

pub mod animation;
pub mod colour;
pub mod curves;
pub mod field;
pub mod history;
mod raster;
pub mod scene;
pub mod ticks;

use crate::error::{Error, Result};
use crate::io::atomic;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontTransform, TextStyle, register_font, text_anchor};
use std::path::Path;
use std::sync::OnceLock;

pub use plotters::style::RGBColor;
pub use plotters::style::text_anchor::{HPos, VPos};
pub use raster::Raster;

/// Pixels of a PNG along a point.
const PIXELS: u32 = 2;
/// Units of an SVG along a point: coordinates are whole numbers, and curves must not show it.
const UNITS: u32 = 20;
/// The family of the font, in SVG and in the table of fonts.
const FAMILY: &str = "sans-serif";
/// Text of axes and legends (points).
pub const TEXT: f64 = 12.0;

/// Ink of text and axes, of lines in the background, and of the paper.
pub const INK: RGBColor = RGBColor(40, 40, 40);
pub const GREY: RGBColor = RGBColor(150, 150, 150);
pub const FAINT: RGBColor = RGBColor(225, 225, 225);

/// Colours of series that also readers with a colour vision deficiency tell apart (Okabe & Ito 2008, Color Universal Design), but its yellow,
/// which is too light on white.
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];

/// The colour of the series of a number.
pub fn colour(number: usize) -> RGBColor {
    COLOURS[number % COLOURS.len()]
}

/// Something to draw.
pub trait Picture {
    /// Width and height (points).
    fn size(&self) -> [u32; 2];

    /// What is filled pixel by pixel, below all that is drawn, with so many pixels a point; nothing unless a picture has its own.
    fn raster(&self, _pixels: u32) -> Option<Raster> {
        None
    }

    /// Draws it.
    ///
    /// # Errors
    /// What the canvas gives.
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Drawn;
}

/// What drawing ends with; a canvas in memory refuses nothing but what cannot be drawn, such as a font that is not there.
pub type Drawn = std::result::Result<(), String>;

/// Where pictures are drawn; places are in points from the upper left corner.
pub struct Canvas<B: DrawingBackend> {
    area: DrawingArea<B, Shift>,
    unit: f64,
}

/// How text stands: its size (points), colour, and which point of it is at its place.
#[derive(Clone, Copy)]
pub struct Text {
    pub size: f64,
    pub colour: RGBColor,
    pub bold: bool,
    pub at: (HPos, VPos),
    /// Upwards, a quarter turn anticlockwise.
    pub upwards: bool,
}

impl Text {
    /// Ordinary text about a place.
    pub fn at(h: HPos, v: VPos) -> Self {
        Self { size: TEXT, colour: INK, bold: false, at: (h, v), upwards: false }
    }
}

impl<B: DrawingBackend> Canvas<B> {
    fn new(backend: B, unit: u32) -> Self {
        Self { area: backend.into_drawing_area(), unit: f64::from(unit) }
    }

    fn place(&self, [x, y]: [f64; 2]) -> (i32, i32) {
        ((x * self.unit).round() as i32, (y * self.unit).round() as i32)
    }

    fn pen(&self, colour: RGBColor, width: f64) -> ShapeStyle {
        colour.stroke_width((width * self.unit).round().max(1.0) as u32)
    }

    /// A line through places.
    ///
    /// # Errors
    /// What cannot be drawn.
    pub fn line(&self, through: &[[f64; 2]], colour: RGBColor, width: f64) -> Drawn {
        let mut path: Vec<_> = through.iter().map(|&place| self.place(place)).collect();
        path.dedup();
        let pen = self.pen(colour, width);
        let mut begin = 0;
        for i in 1..path.len().saturating_sub(1) {
            if self.unit == f64::from(PIXELS) && turns_back(&path[i - 1..=i + 1]) {
                let part = path[begin..=i].to_vec();
                self.area.draw(&PathElement::new(part, pen)).map_err(|e| e.to_string())?;
                begin = i;
            }
        }
        self.area.draw(&PathElement::new(path.split_off(begin), pen)).map_err(|e| e.to_string())
    }

    /// A filled polygon.
    ///
    /// # Errors
    /// What cannot be drawn.
    pub fn polygon(&self, corners: &[[f64; 2]], colour: RGBColor) -> Drawn {
        let path: Vec<_> = corners.iter().map(|&place| self.place(place)).collect();
        self.area.draw(&Polygon::new(path, colour.filled())).map_err(|e| e.to_string())
    }

    /// A disc, or a circle where it is not `filled`.
    ///
    /// # Errors
    /// What cannot be drawn.
    pub fn circle(&self, centre: [f64; 2], radius: f64, colour: RGBColor, filled: bool) -> Drawn {
        let style = if filled { colour.filled() } else { self.pen(colour, 1.2) };
        let circle = Circle::new(self.place(centre), (radius * self.unit).round() as i32, style);
        self.area.draw(&circle).map_err(|e| e.to_string())
    }

    /// Text at a place, without characters that are not to be seen.
    ///
    /// # Errors
    /// What cannot be drawn.
    pub fn text(&self, text: &str, place: [f64; 2], how: Text) -> Drawn {
        let style = self.style(how);
        self.area.draw_text(&crate::error::plain(text), &style, self.place(place)).map_err(|e| e.to_string())
    }

    /// Text at a place that is made smaller where it is longer than the `room` (points).
    ///
    /// # Errors
    /// What cannot be drawn.
    pub fn fitted(&self, text: &str, place: [f64; 2], how: Text, room: f64) -> Drawn {
        let share = room / width(text, how).max(f64::MIN_POSITIVE);
        self.text(text, place, Text { size: how.size * share.min(1.0), ..how })
    }

    fn style(&self, how: Text) -> TextStyle<'static> {
        let transform = if how.upwards { FontTransform::Rotate270 } else { FontTransform::None };
        let font = font(how, self.unit).transform(transform);
        let pos = text_anchor::Pos::new(how.at.0, how.at.1);
        TextStyle { color: how.colour.to_backend_color(), ..TextStyle::from(font).pos(pos) }
    }
}

/// Whether a line turns back at the second of three pixels: there `plotters` puts a corner of its outline far beyond the line, so that it is drawn in two parts.
fn turns_back(path: &[(i32, i32)]) -> bool {
    let way = |i: usize| {
        let (a, b) = (path[i], path[i + 1]);
        [i64::from(b.0) - i64::from(a.0), i64::from(b.1) - i64::from(a.1)]
    };
    let ([a, b], [c, d]) = (way(0), way(1));
    a * c + b * d < 0
}

fn font(how: Text, unit: f64) -> FontDesc<'static> {
    let style = if how.bold { FontStyle::Bold } else { FontStyle::Normal };
    FontDesc::new(FontFamily::SansSerif, how.size * unit, style)
}

/// How wide a text is (points).
pub fn width(text: &str, how: Text) -> f64 {
    load_fonts();
    let unit = f64::from(UNITS);
    font(how, unit).box_size(text).map_or(0.0, |(width, _)| f64::from(width) / unit)
}

/// A text in lines that are no longer than the `room` (points), as far as its words are not.
pub fn wrapped(text: &str, how: Text, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), how) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// What a picture is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
}

impl Format {
    /// The format that the ending of a file asks for.
    ///
    /// # Errors
    /// `Input` for another ending.
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().and_then(|kind| kind.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Error::input(path.display(), "pictures are SVG or PNG", "let the name end in .svg or .png")),
        }
    }
}

/// Draws into a file, whose ending says how.
///
/// # Errors
/// `Input` for another ending than .svg and .png, `Machine` when the file cannot be written.
pub fn write(picture: &impl Picture, path: &Path) -> Result<()> {
    let bytes = match Format::of(path)? {
        Format::Svg => svg(picture)?.into_bytes(),
        Format::Png => png(picture)?,
    };
    atomic::write(path, |out| out.write_all(&bytes))
}

/// The picture as the text of an SVG.
///
/// # Errors
/// `Machine` when it cannot be drawn.
pub fn svg(picture: &impl Picture) -> Result<String> {
    let ([width, height], mut text) = (picture.size(), String::new());
    let size = (width * UNITS, height * UNITS);
    draw(picture, SVGBackend::with_string(&mut text, size), UNITS, true)?;
    if let Some(raster) = picture.raster(PIXELS) {
        // After the background, which is the first element.
        let image = encoded([width * PIXELS, height * PIXELS], &raster.pixels())?;
        let element = format!(
            "\n<image width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>",
            size.0,
            size.1,
            STANDARD.encode(image)
        );
        let background = text.find("<rect").and_then(|begin| Some(begin + text[begin..].find("/>")? + 2));
        text.insert_str(background.unwrap_or(text.len()), &element);
    }
    // As large as it was meant, in units that are finer.
    let drawn = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(text.replacen(&drawn, &format!("width=\"{width}\" height=\"{height}\""), 1))
}

/// The picture as the bytes of a PNG.
///
/// # Errors
/// `Machine` when it cannot be drawn.
pub fn png(picture: &impl Picture) -> Result<Vec<u8>> {
    let (size, pixels) = pixels(picture)?;
    encoded(size, &pixels)
}

/// Width and height of the picture in pixels, and these row by row, three bytes each.
///
/// # Errors
/// `Machine` when it cannot be drawn.
pub fn pixels(picture: &impl Picture) -> Result<([u32; 2], Vec<u8>)> {
    let [width, height] = picture.size().map(|length| length * PIXELS);
    let white = || vec![255; width as usize * height as usize * 3];
    let mut pixels = picture.raster(PIXELS).map_or_else(white, |raster| raster.pixels());
    draw(picture, BitMapBackend::with_buffer(&mut pixels, (width, height)), PIXELS, false)?;
    Ok(([width, height], pixels))
}

/// Pixels as the bytes of a PNG.
fn encoded([width, height]: [u32; 2], pixels: &[u8]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels)).map_err(|e| undrawn(&e))?;
    Ok(bytes)
}

/// Draws on paper, white from the beginning unless it has to be made so.
fn draw<B: DrawingBackend>(picture: &impl Picture, backend: B, unit: u32, whiten: bool) -> Result<()> {
    load_fonts();
    let canvas = Canvas::new(backend, unit);
    let paper = if whiten { canvas.area.fill(&WHITE).map_err(|e| e.to_string()) } else { Ok(()) };
    let drawn = paper.and_then(|()| picture.draw(&canvas));
    drawn.and_then(|()| canvas.area.present().map_err(|e| e.to_string())).map_err(|e| undrawn(&e))
}

fn undrawn(problem: &dyn std::fmt::Display) -> Error {
    Error::machine("a picture", format!("cannot be drawn: {problem}"), "report this as a mistake of mpm")
}

/// Puts the font of the program into the table of fonts, once.
fn load_fonts() {
    static LOADED: OnceLock<()> = OnceLock::new();
    LOADED.get_or_init(|| {
        for (style, font) in [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())] {
            // One that could not be read is missing when it is asked for, which is told then.
            let _ = register_font(FAMILY, style, font);
        }
    });
}
