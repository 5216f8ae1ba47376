//! The frames of a run as what is to be seen of them: points, grid, soil, structures, contact and surface.

use super::fields::{column, select};
use super::pieces::Piece;
use super::plates::{self, Plate};
use super::soil::Bodies;
use super::{CONTACT, PLATES, Regions, SOIL, STRUCTURES, SURFACE, contact, surface};
use crate::error::{Error, Result};
use crate::io::frame::{self, Frame, Info, Part, triples};
use crate::io::vtu::{Grid, Topology};
use crate::mesh::Mesh;
use crate::mesh::sections::Section;
use std::borrow::Cow;
use std::path::Path;

/// The frames of a results folder on the mesh that they were computed with.
pub struct Series<'a> {
    pub infos: Vec<Info>,
    /// The places of the nodes in the mesh (m).
    first: Vec<[f64; 3]>,
    background: Piece,
    structures: Piece,
    with_elements: bool,
    pub(super) bodies: Option<Bodies<'a>>,
    /// Those of a case whose frames have the stress.
    pub plates: Vec<Plate>,
    axisymmetric: bool,
}

/// What is to be seen of a frame; what a case has not is absent.
pub struct Shown {
    pub points: Grid,
    pub grid: Grid,
    pub soil: Option<Grid>,
    pub structures: Option<Grid>,
    pub contact: Option<Grid>,
    pub surface: Option<Grid>,
    pub plates: Option<Grid>,
    /// The sections of each plate.
    pub sections: Vec<Vec<Section>>,
}

impl<'a> Series<'a> {
    /// The frames in `results`.
    ///
    /// # Errors
    /// `Input` when there are no frames, or one is damaged.
    pub fn open(results: &Path, mesh: &Mesh<2>, regions: &'a Regions) -> Result<Self> {
        let infos = frame::list(results)?;
        let is_element = |c: usize| regions.elements[mesh.cells.region[c] as usize];
        let elements = mesh.part(is_element);
        let with_elements = !elements.cells.is_empty();
        let (background, structures) = if with_elements {
            (Piece::background(&mesh.part(|c| !is_element(c))), Piece::by_region(&elements))
        } else {
            (Piece::whole(mesh), Piece::default())
        };
        let bodies = Bodies::new(mesh, regions, (&structures, &elements.cells.kind), &infos)?;
        let plates = plates::plates(&elements, &regions.plates);
        let (first, axisymmetric) = (triples(&mesh.nodes), regions.axisymmetric);
        Ok(Self { infos, first, background, structures, with_elements, bodies, plates, axisymmetric })
    }

    /// Whether there is a series of this name.
    pub fn has(&self, name: &str) -> bool {
        match name {
            SOIL => self.bodies.is_some(),
            STRUCTURES => self.with_elements,
            CONTACT => self.infos.iter().any(|info| info.contact > 0),
            PLATES => !self.plates.is_empty(),
            SURFACE => self.infos.iter().any(|info| info.surface > 0),
            _ => true,
        }
    }

    /// Frame `i` with `fields`.
    ///
    /// # Errors
    /// `Input` when the frame is damaged, does not belong to the mesh or to the others, or has not one of the fields.
    pub fn at(&self, i: usize, fields: &[String]) -> Result<Shown> {
        let info = &self.infos[i];
        let frame = Frame::read(&info.path)?;
        check_fields(&info.path, &frame, fields)?;
        let wrong = |problem: String, remedy: &str| Error::input(info.path.display(), problem, remedy);
        let Frame { time, points, mut grid, elements, contact, surface, .. } = frame;
        let time = Some(time);
        if grid.position.is_empty() {
            grid.position.clone_from(&self.first);
        }
        let count = self.first.len();
        let fits = grid.position.len() == count && grid.columns.iter().all(|c| c.values.len() == c.components * count);
        let from = if fits { counted_from(&mut grid, &self.first) } else { Cow::Borrowed(&self.first[..]) };
        let Some(smooth) = self.structures.smooth(&grid, &from, &elements).filter(|_| fits) else {
            let problem = format!("has not the {count} nodes and the cells of the mesh");
            return Err(wrong(problem, "the mesh was made again after the run: run `mpm solve` again"));
        };
        let places = [&self.first[..], &from, &grid.position];
        let sections = if self.plates.is_empty() {
            Vec::new()
        } else {
            let found = plates::of_frame(&self.plates, places, &elements, self.axisymmetric);
            found.ok_or_else(|| {
                wrong(
                    "has no stress, of which the forces in plates are made".into(),
                    "name `stress` in `output.fields`, and run `mpm solve` again",
                )
            })?
        };
        let soil = self.bodies.as_ref();
        let soil = soil.map(|bodies| bodies.grid(i, info, &points, &grid.position, &smooth, fields)).transpose()?;
        let lines = |name: &str, lines: Option<Grid>, what: &str| match lines {
            _ if !self.has(name) => Ok(None),
            None => Err(wrong(
                format!("has not the {what} that others have"),
                "the frames are of several runs: run `mpm solve` again",
            )),
            lines => Ok(lines),
        };
        Ok(Shown {
            grid: self.background.grid(&self.background.at(&grid), fields, time),
            soil,
            structures: self.with_elements.then(|| self.structures.grid(&smooth, fields, time)),
            contact: lines(CONTACT, contact::grid(&contact, time), "boundaries in contact")?,
            plates: self.has(PLATES).then(|| plates::grid(&self.plates, &sections, time)),
            sections,
            surface: lines(SURFACE, surface::lines(&surface, time), "loops of the surface")?,
            points: Grid {
                point_data: select(&points, fields),
                topology: Topology::vertices(points.position.len()),
                points: points.position.concat(),
                ..Grid { time, ..Grid::default() }
            },
        })
    }
}

/// Where the nodes were that displacements are counted from, given where they were at `first`.
pub fn counted_from<'a>(grid: &mut Part, first: &'a [[f64; 3]]) -> Cow<'a, [[f64; 3]]> {
    let Some(at) = grid.columns.iter().position(|column| column.name == frame::UNCOUNTED) else {
        return Cow::Borrowed(first);
    };
    let way = grid.columns.remove(at).values;
    Cow::Owned(first.iter().zip(way.chunks_exact(3)).map(|(x, way)| [0, 1, 2].map(|d| x[d] + way[d])).collect())
}

/// Every field must be somewhere in the frame.
pub fn check_fields(path: &Path, frame: &Frame, fields: &[String]) -> Result<()> {
    let parts = [&frame.points, &frame.grid, &frame.elements];
    let has = |name: &str| parts.iter().any(|part| column(part, name).is_some());
    let given = |name: &String| parts.iter().any(|part| !select(part, std::slice::from_ref(name)).is_empty());
    let Some(missing) = fields.iter().find(|name| !given(name)) else { return Ok(()) };
    let names = parts.iter().flat_map(|part| &part.columns).map(|c| c.name.as_str());
    let names = names.filter(|name| ![frame::CELL, frame::UNCOUNTED].contains(name));
    let mut names: Vec<_> =
        names.chain(["mean_stress", "deviatoric_stress"].into_iter().filter(|name| has(name))).collect();
    names.sort_unstable();
    names.dedup();
    Err(Error::input(
        path.display(),
        format!("the results have no field `{missing}`; they have {}", names.join(", ")),
        "choose one of these, or name it in `output.fields` and run `mpm solve` again",
    ))
}
