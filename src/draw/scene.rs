//! The scene as it is meshed: what fills the regions, the lines of the mesh, and the curves that something acts on.

use super::curves::WIDTH;
use super::{Canvas, Drawn, HPos, INK, Picture, RGBColor, Text, VPos};
use crate::geometry::box_around;
use crate::mesh::{Group, Mesh};
use plotters::prelude::DrawingBackend;

/// Space around the mesh (points).
const SPACE: f64 = 12.0;
/// The highest picture of a mesh (points).
const HIGHEST: f64 = 640.0;
/// Height of a line of the legend (points).
const LINE: f64 = 18.0;
/// How light lines of the mesh are: the part of the paper in them (-).
const LIGHT: f64 = 0.35;

/// How a region is shown; structures, which lie above the grid, in front.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    pub name: String,
    pub colour: RGBColor,
    pub in_front: bool,
}

/// A curve with what acts on it.
#[derive(Clone, Debug)]
pub struct Acted<'a> {
    pub group: &'a Group,
    pub name: String,
    pub colour: RGBColor,
}

/// A mesh with its regions and curves.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    pub mesh: &'a Mesh<2>,
    /// By region of the mesh.
    pub regions: Vec<Shown>,
    pub curves: Vec<Acted<'a>>,
}

/// Where the mesh is on the paper.
struct Frame {
    low: [f64; 2],
    /// Points a metre.
    scale: f64,
    /// Width and height on the paper (points).
    size: [f64; 2],
}

impl Frame {
    fn place(&self, x: &[f64; 2]) -> [f64; 2] {
        let left = (f64::from(WIDTH) - self.size[0]) / 2.0;
        [left + (x[0] - self.low[0]) * self.scale, SPACE + self.size[1] - (x[1] - self.low[1]) * self.scale]
    }
}

impl Scene<'_> {
    fn frame(&self) -> Frame {
        let places = self.mesh.cells.nodes.iter().map(|&n| self.mesh.nodes[n as usize]);
        let [low, high] = box_around(places).unwrap_or_default();
        let extent = [0, 1].map(|d| (high[d] - low[d]).max(f64::MIN_POSITIVE));
        let scale = ((f64::from(WIDTH) - 2.0 * SPACE) / extent[0]).min(HIGHEST / extent[1]);
        Frame { low, scale, size: extent.map(|length| length * scale) }
    }

    /// The corners of a cell on the paper.
    fn corners(&self, cell: usize, frame: &Frame) -> Vec<[f64; 2]> {
        let corners = self.mesh.cells.kind[cell].facets().1.iter().map(|facet| facet[0]);
        let nodes = self.mesh.cells.nodes(cell);
        corners.map(|i| frame.place(&self.mesh.nodes[nodes[i] as usize])).collect()
    }
}

impl Picture for Scene<'_> {
    fn size(&self) -> [u32; 2] {
        let entries = (self.regions.len() + self.curves.len()).div_ceil(2);
        let height = 2.0 * SPACE + self.frame().size[1] + LINE * entries as f64 + SPACE;
        [WIDTH, height.ceil() as u32]
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> Drawn {
        let frame = self.frame();
        for in_front in [false, true] {
            for cell in 0..self.mesh.cells.len() {
                let shown = &self.regions[usize::from(self.mesh.cells.region[cell])];
                if shown.in_front == in_front {
                    let mut corners = self.corners(cell, &frame);
                    canvas.polygon(&corners, shown.colour)?;
                    corners.extend(corners.first().copied());
                    canvas.line(&corners, darker(shown.colour), 0.4)?;
                }
            }
        }
        for curve in &self.curves {
            for (_, nodes) in &curve.group.facets {
                // A facet has its ends first, then its middle.
                let ends: Vec<_> = nodes.iter().take(2).map(|&n| frame.place(&self.mesh.nodes[n as usize])).collect();
                match &ends[..] {
                    [place] => canvas.circle(*place, 3.5, curve.colour, true)?,
                    ends => canvas.line(ends, curve.colour, 2.5)?,
                }
            }
        }
        self.legend(canvas, 2.0 * SPACE + frame.size[1])
    }
}

impl Scene<'_> {
    fn legend<B: DrawingBackend>(&self, canvas: &Canvas<B>, top: f64) -> Drawn {
        let column = f64::from(WIDTH) / 2.0;
        let how = Text::at(HPos::Left, VPos::Center);
        let place = |i: usize| [SPACE + (i % 2) as f64 * column, top + 8.0 + (i / 2) as f64 * LINE];
        for (i, region) in self.regions.iter().enumerate() {
            let [x, y] = place(i);
            let corners = [[x, y - 6.0], [x + 20.0, y - 6.0], [x + 20.0, y + 6.0], [x, y + 6.0], [x, y - 6.0]];
            canvas.polygon(&corners, region.colour)?;
            canvas.line(&corners, INK, 0.5)?;
            canvas.text(&region.name, [x + 28.0, y], how)?;
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let [x, y] = place(self.regions.len() + i);
            canvas.line(&[[x, y], [x + 20.0, y]], curve.colour, 2.5)?;
            canvas.text(&curve.name, [x + 28.0, y], how)?;
        }
        Ok(())
    }
}

fn darker(colour: RGBColor) -> RGBColor {
    let dark = |c: u8| (f64::from(c) * (1.0 - LIGHT)) as u8;
    RGBColor(dark(colour.0), dark(colour.1), dark(colour.2))
}
