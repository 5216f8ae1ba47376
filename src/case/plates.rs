//! Walls, linings and slabs by their axis: their material, and the strip that stands for them in the mesh (docs/theory.md, section 3, *Plates*).
//!
//! The `.geo` has the place of a strip, but not the strip. Cells of soil in it are left empty: they are regions of their own without material.

use super::check::Checker;
use super::checked::{Analysis, Case, Content, Field, Geometry, Material, Plate, Region};
use super::find::region_index;
use super::locate::{At, Path};
use super::raw::{self, InDepth};
use crate::error::{Error, Result};
use crate::geometry::distance;
use crate::mesh::locate::Locator;
use crate::mesh::strip::Strip;
use crate::mesh::{Mesh, cell_size};
use std::collections::BTreeMap;

/// How far (-) cells of soil may be within a strip, or reach out of it, in its thickness.
const OFF: f64 = 0.01;

/// Cells across a plate below which a warning says so.
const FEW_CELLS: f64 = 1.5;
/// Cells across a plate that the warning recommends.
const GOOD_CELLS: f64 = 2.0;

/// Corners of an outline that a message lists.
const LISTED: usize = 8;

/// The name of the material of a plate.
pub(super) fn material(plate: &str) -> String {
    format!("plate {plate}")
}

/// The region of the cells of `soil` that are left empty for a plate.
fn slot(plate: &str, soil: &str) -> String {
    format!("place of {plate} in {soil}")
}

impl Checker {
    /// The plates among the regions; their materials are appended, and the regions refer to them.
    pub(super) fn plates(
        &mut self,
        file: &raw::CaseFile,
        mut regions: Vec<Region>,
        materials: &mut Vec<Material>,
        path: &Path,
    ) -> (Vec<Region>, Vec<Plate>) {
        let mut plates = Vec::new();
        for (index, (name, region)) in file.regions.iter().enumerate() {
            let Some(plate) = &region.plate else { continue };
            let path = path.key(name);
            let other_kind = region.kind != raw::RegionKind::Structure;
            for (key, wrong, problem, remedy) in [
                ("kind", other_kind, "a plate is a structure", "write `kind: structure`"),
                ("material", region.material.is_some(), "a plate has stiffnesses of its own", "take `material` out"),
                ("rigid", region.rigid.is_some(), "a plate bends", "take `rigid` out"),
            ] {
                if wrong {
                    self.issue(&path.key(key), At::Key, problem, remedy);
                }
            }
            let path = path.key("plate");
            let Some(checked) = self.plate(index, plate, &path) else { continue };
            if let Some(material) = self.stiffness(file, name, plate, checked.thickness, &path) {
                regions[index].content = Content::Structure { material: materials.len(), rigid: false };
                materials.push(material);
            }
            plates.push(checked);
        }
        let of_stress = |field: &Field| matches!(field, Field::Stress | Field::MeanStress | Field::DeviatoricStress);
        if !plates.is_empty() && file.output.fields.as_ref().is_some_and(|fields| !fields.iter().any(of_stress)) {
            let path = Path::default().key("output").key("fields");
            let problem = "the forces in plates are made of the stress, which is not among them";
            self.issue(&path, At::Value, problem, "add `stress`");
        }
        (regions, plates)
    }

    fn plate(&mut self, region: usize, plate: &raw::Plate, path: &Path) -> Option<Plate> {
        let thickness = (12.0 * plate.ei / plate.ea).sqrt();
        if !(thickness > 0.0 && thickness.is_finite()) {
            // What is not positive has been told already.
            return None;
        }
        let length: f64 = plate.axis.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum();
        if thickness > length {
            let problem = format!("makes the plate {thickness:.4} m thick, √(12 EI/EA), and it is {length:.4} m long");
            let remedy = "check the units of `EA` (kN/m) and `EI` (kNm²/m), both of a metre";
            self.issue(&path.key("EI"), At::Value, problem, remedy);
            return None;
        }
        let size = plate.size.unwrap_or(thickness);
        let axis = path.key("axis");
        for (k, pair) in plate.axis.windows(2).enumerate() {
            if distance(&pair[0], &pair[1]) <= OFF * thickness {
                let problem = format!("is at the place before it, for a plate {thickness:.4} m thick");
                self.issue(&axis.index(k + 1), At::Value, problem, "take it out");
                return None;
            }
        }
        let points: Vec<(String, [f64; 2])> = plate.points.iter().map(|(name, x)| (name.clone(), *x)).collect();
        let stops: Vec<[f64; 2]> = plate.points.values().copied().collect();
        if let Err((at, problem)) = Strip::new(&plate.axis, thickness, size, &stops) {
            let (path, remedy) = match points.iter().find(|(_, x)| *x == at) {
                Some((name, _)) if problem.contains("beside") => {
                    (path.key("points").key(name), "give a place on the straight lines between the places of `axis`")
                }
                _ => (
                    axis,
                    "round the corner by more places, a little longer each than the plate is thick, or part the plate there",
                ),
            };
            let problem = format!("{problem}, at [{}, {}] m of a plate {thickness:.4} m thick", at[0], at[1]);
            self.issue(&path, At::Value, problem, remedy);
            return None;
        }
        Some(Plate { region, axis: plate.axis.clone(), thickness, size, points })
    }

    /// The material that gives a strip the stiffnesses of a plate, where strain across the plane is held.
    fn stiffness(
        &mut self,
        file: &raw::CaseFile,
        name: &str,
        plate: &raw::Plate,
        thickness: f64,
        path: &Path,
    ) -> Option<Material> {
        let gravity = [file.gravity.x, file.gravity.y];
        let g = gravity[0].hypot(gravity[1]);
        if plate.weight > 0.0 && g == 0.0 {
            let remedy = "set `gravity`, or take `weight` out";
            self.issue(&path.key("weight"), At::Key, "without gravity a plate has no weight", remedy);
        }
        let inertia = file.phases.iter().any(|phase| Analysis::has_inertia(phase.analysis));
        if plate.weight == 0.0 && inertia {
            let remedy = "give it a `weight` above 0, or make the phases quasi_static";
            self.issue(path, At::Key, "a dynamic phase needs plates with mass", remedy);
        }
        let density = if g > 0.0 { plate.weight / (thickness * g) } else { 0.0 };
        let young = plate.ea / thickness * (1.0 - plate.poisson.powi(2));
        let of = |value: f64| InDepth::Constant(value);
        let material = raw::Material {
            model: "linear_elastic".to_owned(),
            density: Some(of(density)),
            unit_weight: None,
            drainage: None,
            undrained_poisson: None,
            permeability: None,
            porosity: None,
            water_bulk_modulus: None,
            water_unit_weight: None,
            random_strength: None,
            parameters: BTreeMap::from([("young".to_owned(), of(young)), ("poisson".to_owned(), of(plate.poisson))]),
        };
        self.material(&self::material(name), &material, &gravity, None, path)
    }
}

impl Case {
    /// The plates with their names.
    pub fn named_plates(&self) -> impl Iterator<Item = (&str, &Plate)> {
        self.plates.iter().map(|plate| (self.regions[plate.region].name.as_str(), plate))
    }

    /// The plate that is the region of this name.
    pub fn plate(&self, region: &str) -> Option<&Plate> {
        self.named_plates().find(|(name, _)| *name == region).map(|(_, plate)| plate)
    }
}

impl Plate {
    fn strip(&self) -> Strip {
        let stops: Vec<[f64; 2]> = self.points.iter().map(|(_, x)| *x).collect();
        Strip::new(&self.axis, self.thickness, self.size, &stops).expect("a checked axis")
    }
}

/// The regions of the mesh that are left empty for plates in the region `soil`, by number.
pub(super) fn slots(case: &Case, mesh: &Mesh<2>, soil: &str) -> Vec<u16> {
    case.named_plates().filter_map(|(plate, _)| region_index(mesh, &slot(plate, soil)).ok()).collect()
}

/// Appends the strips of the plates to the mesh, and empties the cells of soil in their places.
///
/// # Errors
/// Input: cells of soil that do not follow the sides of a strip; a strip beyond the axis of symmetry.
pub fn append(case: &Case, mesh: &mut Mesh<2>) -> Result<()> {
    let structures: Vec<&str> =
        case.regions.iter().filter(|r| r.content.is_structure()).map(|r| r.name.as_str()).collect();
    let grid = mesh.part(|c| !structures.contains(&mesh.regions[mesh.cells.region[c] as usize].as_str()));
    let locator = Locator::new(&grid);
    for (name, plate) in case.named_plates() {
        let strip = plate.strip();
        let curves = plate.curves(name);
        let points = || plate.points.iter().map(|(point, _)| point);
        if let Some(taken) = curves.iter().chain(points()).find(|own| mesh.group(own).is_some()) {
            let problem = format!("a curve or point of the .geo is called `{taken}`, as one of the plate is");
            return Err(Error::input(format!("region `{name}`"), problem, "give it another name"));
        }
        let outline = strip.outline();
        let beyond = |x: &[f64; 2]| x[0] < -OFF * plate.thickness;
        if case.geometry == Geometry::Axisymmetric && outline.iter().flatten().any(beyond) {
            let remedy = "let the axis of the plate keep half the thickness from x = 0, or end it there";
            return Err(Error::input(
                format!("region `{name}`"),
                "the plate reaches beyond the axis of symmetry",
                remedy,
            ));
        }
        empty(case, mesh, (name, plate), (&strip, &outline))?;
        for x in strip.middles() {
            let Some((cell, _)) = locator.locate(&grid, &x, None) else { continue };
            let centre = grid.centre(cell as usize);
            let soil = &grid.regions[grid.cells.region[cell as usize] as usize];
            if is_soil(case, soil) && Strip::depth(&outline, &centre) < 0.0 {
                return Err(apart((name, plate), &strip, soil, centre));
            }
        }
        let region = mesh.regions.len() as u16;
        mesh.regions.push(name.to_owned());
        strip.append(mesh, region, &curves, &plate.points);
    }
    Ok(())
}

/// A warning of each plate in soil whose cells are so coarse that they reach from one of its sides to the other.
pub(super) fn coarse(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let soils = || case.regions.iter().filter(|region| matches!(region.content, Content::Mpm { .. }));
    let warning = |(name, plate): (&str, &Plate)| {
        let places: Vec<u16> = soils().flat_map(|soil| region_index(mesh, &slot(name, &soil.name)).ok()).collect();
        let own: Vec<usize> = (0..mesh.cells.len()).filter(|&c| places.contains(&mesh.cells.region[c])).collect();
        let h = own.iter().map(|&c| cell_size(mesh, c)).sum::<f64>() / own.len().max(1) as f64 / 2f64.sqrt();
        (plate.thickness < FEW_CELLS * h).then(|| {
            format!(
                "warning: the cells in the place of the plate `{name}` are {h:.3} m, and it is {:.3} m thick: soil on both of its sides holds \
                 together through them; make them {:.3} m or finer there and beside it",
                plate.thickness,
                plate.thickness / GOOD_CELLS
            )
        })
    };
    case.named_plates().filter_map(warning).collect()
}

fn is_soil(case: &Case, region: &str) -> bool {
    matches!(case.content(region), Some(Content::Mpm { .. } | Content::Fem { .. }))
}

/// Makes the cells of soil within a strip regions without material.
fn empty(
    case: &Case,
    mesh: &mut Mesh<2>,
    (name, plate): (&str, &Plate),
    (strip, outline): (&Strip, &[crate::geometry::Line<2>]),
) -> Result<()> {
    let off = OFF * plate.thickness;
    let low = |d: usize| outline.iter().flatten().map(|x| x[d]).fold(f64::INFINITY, f64::min) - off;
    let high = |d: usize| outline.iter().flatten().map(|x| x[d]).fold(f64::NEG_INFINITY, f64::max) + off;
    let bounds = [0, 1].map(|d| [low(d), high(d)]);
    let depth = |x: &[f64; 2]| {
        let near = (0..2).all(|d| (bounds[d][0]..=bounds[d][1]).contains(&x[d]));
        if near { Strip::depth(outline, x) } else { f64::NEG_INFINITY }
    };
    let of_node: Vec<f64> = mesh.nodes.iter().map(depth).collect();
    for c in 0..mesh.cells.len() {
        let soil = mesh.regions[mesh.cells.region[c] as usize].clone();
        if !is_soil(case, &soil) {
            continue;
        }
        let depths = || mesh.cells.nodes(c).iter().map(|&n| of_node[n as usize]);
        let within = depth(&mesh.centre(c)) > 0.0;
        let fits = if within { depths().all(|depth| depth >= -off) } else { depths().all(|depth| depth <= off) };
        if !fits {
            return Err(apart((name, plate), strip, &soil, mesh.centre(c)));
        }
        if within {
            let slot = slot(name, &soil);
            let number = mesh.regions.iter().position(|region| *region == slot).unwrap_or_else(|| {
                mesh.regions.push(slot);
                mesh.regions.len() - 1
            });
            mesh.cells.region[c] = number as u16;
        }
    }
    Ok(())
}

fn apart((name, plate): (&str, &Plate), strip: &Strip, soil: &str, [x, y]: [f64; 2]) -> Error {
    let corners = strip.corners();
    let mut listed: Vec<String> = corners.iter().take(LISTED).map(|[x, y]| format!("[{x:.4}, {y:.4}]")).collect();
    if corners.len() > LISTED {
        listed.push("…".to_owned());
    }
    Error::input(
        format!("region `{name}`"),
        format!(
            "the plate is {:.4} m thick, and the cell of `{soil}` at [{x:.4}, {y:.4}] m lies across its sides: soil in its place cannot be left out",
            plate.thickness
        ),
        format!(
            "in the .geo, draw the outline of the plate as curves that bound the surfaces of the soil: {}",
            listed.join(", ")
        ),
    )
}
