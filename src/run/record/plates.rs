//! Forces in the sections of plates during a run.

use crate::mesh::sections::{Element, Forces, Section, sections};
use crate::run::boundary;
use crate::step::{Scene, State};

/// A force in a section of a plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    Normal,
    Shear,
    Moment,
}

impl Force {
    /// The name and unit of its column.
    pub fn column(self) -> &'static str {
        match self {
            Self::Normal => "normal_force [kN/m]",
            Self::Shear => "shear_force [kN/m]",
            Self::Moment => "bending_moment [kN m/m]",
        }
    }

    fn of(self, forces: &Forces) -> f64 {
        match self {
            Self::Normal => forces.normal,
            Self::Shear => forces.shear,
            Self::Moment => forces.moment,
        }
    }
}

/// The force of a plate that is largest in amount, with its sign.
pub fn largest<const D: usize>(scene: &Scene<D>, state: &State<D>, plate: (u16, bool), force: Force) -> f64 {
    let forces = sections_of(scene, state, plate).into_iter().map(|section| force.of(&section.forces));
    forces.fold(0.0, |largest, f| if f.abs() > f64::abs(largest) { f } else { largest })
}

/// The sections of the plate that is a region, by its number, with displacements from the drawn place.
fn sections_of<const D: usize>(scene: &Scene<D>, state: &State<D>, (region, turned): (u16, bool)) -> Vec<Section> {
    const { assert!(D == 2, "plates are lines in the plane") };
    let Some(fem) = &scene.fem else { return Vec::new() };
    let now = boundary::nodes(scene, state);
    let mut own = (0..state.fem.len()).filter(|&p| state.fem.region[p] == region);
    let cells = (0..fem.mesh.cells.len()).filter(|&c| fem.mesh.cells.region[c] == region);
    let element = |c: usize| {
        let nodes = <[u32; 8]>::try_from(fem.mesh.cells.nodes(c)).ok()?.map(|n| n as usize);
        let points: Vec<usize> = own.by_ref().take(4).collect();
        let places = |of: &[[f64; D]]| nodes.map(|n| [of[n][0], of[n][1]]);
        let stress = <[usize; 4]>::try_from(points).ok()?.map(|p| state.fem.stress[p]);
        let drawn = places(&scene.mesh.nodes);
        Some(Element { drawn, from: drawn, now: places(&now), stress })
    };
    sections(cells.filter_map(element), turned)
}
