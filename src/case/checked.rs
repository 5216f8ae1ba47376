//! A case that cannot be wrong: what the rest of the program builds a scene from.
//!
//! Only the checker makes one. Units are kN, m, s and t. The names of curves and regions are known
//! to the mesh once [`super::names::check`] found no fault.

mod phases;
mod plate;

pub use super::raw::{Analysis, Axis, Encoding, Field, StandingWave};
pub use crate::run::{Place, Quantity, Until};
pub use crate::step::{Material, Restore, StepSize};
pub use phases::*;
pub use plate::*;

use crate::contact::Law;
use crate::interpolation::Basis;
use crate::material::Profile;
use crate::step;
use crate::time_value::TimeValue;
use crate::water_table::WaterTable;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A checked case.
#[derive(Clone, Debug)]
pub struct Case {
    pub title: String,
    pub geometry: Geometry,
    pub mesh: Mesh,
    /// The regions, sorted by name.
    pub regions: Vec<Region>,
    pub plates: Vec<Plate>,
    /// The materials, sorted by name, and behind them those of the plates.
    pub materials: Vec<Material>,
    pub contacts: Vec<Contact>,
    pub bars: Vec<Bar>,
    pub supports: Vec<Support>,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 2],
    /// Horizontal over vertical stress of the initial stress, by index into `materials`; `None` for no stress.
    pub k0: Option<Vec<EarthPressure>>,
    pub water: Option<Water>,
    /// Excess pore pressure (kPa) before the first phase, by index into `regions`.
    pub initial_pore_pressure: Vec<(usize, Profile)>,
    /// The velocities of the regions that do not start at rest.
    pub initial_velocity: Vec<InitialVelocity>,
    pub numerics: Numerics,
    pub phases: Vec<Phase>,
    /// Whether the first of them brings the initial stress into equilibrium; it is not one of the case file.
    pub equilibrium: bool,
    pub output: Output,
    /// The surface that drains.
    pub drained_surface: Option<Surface>,
    /// Warnings of values that no soil has (`unlikely.rs`).
    pub unlikely: Vec<String>,
}

impl Case {
    /// The phases of the case file, each with its number there.
    pub fn own_phases(&self) -> impl Iterator<Item = (usize, &Phase)> {
        self.phases.iter().skip(usize::from(self.equilibrium)).enumerate()
    }

    /// What the region of this name is, if there is one.
    pub fn content(&self, region: &str) -> Option<Content> {
        self.regions.iter().find(|other| other.name == region).map(|region| region.content)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    PlaneStrain,
    Axisymmetric,
}

/// The surface of material points: of all, or of the region of that index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    All,
    Of(usize),
}

impl Surface {
    /// The index of its region; `None` for all.
    pub fn region(self) -> Option<usize> {
        match self {
            Self::All => None,
            Self::Of(region) => Some(region),
        }
    }
}

/// The background mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    pub source: Source,
    /// The order of the cells; `None` for that of a mesh that is given, the first or the second.
    pub order: Option<Order>,
    /// Values for the parameters of the `.geo`, by name.
    pub parameters: BTreeMap<String, f64>,
}

/// What a mesh comes from: a file, relative to the working directory or absolute.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A `.geo`.
    Geo(PathBuf),
    /// The mesh itself, of this or of another program.
    Mesh(PathBuf),
}

impl Source {
    /// The file.
    pub fn path(&self) -> &std::path::Path {
        let (Self::Geo(path) | Self::Mesh(path)) = self;
        path
    }
}

/// The order of the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// T3 and Q4.
    First,
    /// T6 and Q9.
    Second,
    /// T6 and Q8.
    SecondIncomplete,
    /// Q16.
    Third,
}

/// A physical surface and what fills it.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    pub name: String,
    pub content: Content,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Material points, of the material with this index in [`Case::materials`].
    Mpm { material: usize, points_per_cell: usize },
    /// Cells without points, that material may move into.
    Buffer,
    /// Finite elements, of the material with this index.
    Fem { material: usize },
    /// A structure: finite elements of its own, above the grid, or a rigid body.
    Structure { material: usize, rigid: bool },
}

impl Content {
    /// The index of the material, if there is one.
    pub fn material(&self) -> Option<usize> {
        match *self {
            Self::Mpm { material, .. } | Self::Fem { material } | Self::Structure { material, .. } => Some(material),
            Self::Buffer => None,
        }
    }

    /// Whether it is a structure that keeps its shape.
    pub fn is_rigid(&self) -> bool {
        matches!(self, Self::Structure { rigid: true, .. })
    }

    /// Whether it is a structure, rigid or not.
    pub fn is_structure(&self) -> bool {
        matches!(self, Self::Structure { .. })
    }

    /// Whether it is soil of finite elements, whose pores may hold water.
    pub fn is_soil_of_elements(&self) -> bool {
        matches!(self, Self::Fem { .. })
    }

    /// Whether the cells are beside the grid: finite elements, or those of a rigid structure.
    pub fn is_fem(&self) -> bool {
        matches!(self, Self::Fem { .. } | Self::Structure { .. })
    }
}

/// Contact between a structure or a wall and soil, or between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// By which phases take it away.
    pub name: Option<String>,
    pub structure: Touching,
    pub on: Touched,
    pub law: Law,
}

/// What has the boundary where a contact is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Touching {
    /// The structure with this index in [`Case::regions`].
    Structure(usize),
    /// A physical curve.
    Wall(String),
}

/// What that touches, by indices into [`Case::regions`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Touched {
    /// Material points.
    Soil(Vec<usize>),
    /// Finite elements or another structure.
    Body(usize),
}

/// Components of the displacement held at zero on a curve or a rigid structure, and the rotation of that.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    pub curve: String,
    pub fixed: [bool; 2],
    pub rotation: bool,
    /// Whether it is held across the curve, by a contact of a wall.
    pub across: bool,
    /// Whether water leaves there.
    pub drained: bool,
    /// Whether waves leave there.
    pub absorbing: bool,
    /// Springs (kN/m³) and dashpots (kPa s/m) across the curve and along it.
    pub springs: Option<[f64; 2]>,
    pub dashpots: Option<[f64; 2]>,
    /// The side that it is tied to.
    pub tied: Option<String>,
    /// Whether soil leaves there.
    pub outflow: bool,
}

/// The velocity of a region before the first phase.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialVelocity {
    /// Index into [`Case::regions`].
    pub region: usize,
    /// Velocity at the centre (m/s).
    pub velocity: [f64; 2],
    /// Velocity gradient (1/s), in rows.
    pub gradient: [[f64; 2]; 2],
    /// The point (m) the gradient is taken about.
    pub centre: [f64; 2],
    pub standing_wave: Option<StandingWave>,
}

impl InitialVelocity {
    /// The velocity (m/s) at `x` (m).
    pub fn at(&self, x: &[f64; 2]) -> [f64; 2] {
        let from = [x[0] - self.centre[0], x[1] - self.centre[1]];
        let mut v = [0, 1].map(|i| self.velocity[i] + self.gradient[i][0] * from[0] + self.gradient[i][1] * from[1]);
        if let Some(wave) = self.standing_wave {
            v[wave.component as usize] += wave.amplitude * (wave.wave_number * x[wave.along as usize]).sin();
        }
        v
    }
}

/// Horizontal over vertical effective stress (-) of soil at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EarthPressure {
    Given(Profile),
    /// By the angle of friction (°) and the overconsolidation ratio R (-): (1 − sin φ) R^(sin φ), Mayne & Kulhawy (1982).
    Overconsolidated {
        friction: Profile,
        ratio: Profile,
    },
}

impl EarthPressure {
    /// Its value at the height `y` (m).
    pub fn at(&self, y: f64) -> f64 {
        match self {
            Self::Given(value) => value.at(y),
            Self::Overconsolidated { friction, ratio } => {
                let sine = friction.at(y).to_radians().sin();
                (1.0 - sine) * ratio.at(y).powf(sine)
            }
        }
    }
}

/// The numerical method.
#[derive(Clone, Debug, PartialEq)]
pub struct Numerics {
    /// What the points see of the grid.
    pub basis: &'static dyn Basis<2>,
    /// What integrals are summed over.
    pub quadrature: super::raw::Quadrature,
    /// Stiffness of empty cells over that of the soil (-).
    pub empty_stiffness: f64,
    /// What the solver takes as it is.
    pub solver: step::Numerics,
}

/// Water around soil and structures, and in the pores of soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// Unit weight (kN/m³).
    pub unit_weight: f64,
    /// Height y (m) of its level in each phase; `None` without any outside.
    pub level: Option<Vec<TimeValue>>,
    /// Up to where the pores have it in each phase; `None` where they have none.
    pub phreatic: Option<Vec<WaterTable>>,
}

/// What is written, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Time between frames (s); `None` for one at the end of each phase.
    pub every: Option<f64>,
    pub fields: Vec<Field>,
    pub encoding: Encoding,
    /// Whether the surface of the material points is wanted where no load acts on it.
    pub surface: bool,
    pub history: Vec<History>,
}

/// Columns of `history.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    pub name: String,
    pub on: On,
    pub quantities: Vec<Quantity>,
}

/// What a history is of.
#[derive(Clone, Debug, PartialEq)]
pub enum On {
    /// A physical curve, a physical point or a region, by its name.
    Named(String),
    /// Soil at a place.
    Place(Place),
}

impl History {
    /// The name of what it is of.
    pub fn named(&self) -> Option<&str> {
        match &self.on {
            On::Named(name) => Some(name),
            On::Place(_) => None,
        }
    }
}
