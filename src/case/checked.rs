//! A case that cannot be wrong: what the rest of the program builds a scene from.
//!
//! Only the checker makes one. Units are kN, m, s and t. The names of curves and regions are known
//! to the mesh once [`super::names::check`] found no fault.

pub use super::raw::{Axis, Encoding, Field, Quantity};
use crate::contact::Law;
use crate::interpolation::Basis;
use crate::material::{Model, Profile};
use crate::term::{MixedPressure, Porous};
use crate::time_value::TimeValue;
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// A checked case.
#[derive(Clone, Debug)]
pub struct Case {
    pub title: String,
    pub geometry: Geometry,
    pub mesh: Mesh,
    /// The regions, sorted by name.
    pub regions: Vec<Region>,
    /// The materials, sorted by name.
    pub materials: Vec<Material>,
    pub contacts: Vec<Contact>,
    pub supports: Vec<Support>,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 2],
    /// Horizontal over vertical stress (-) of the initial stress; `None` for no stress.
    pub k0: Option<f64>,
    pub water: Option<Water>,
    /// Excess pore pressure (kPa) before the first phase, by index into `regions`.
    pub initial_pore_pressure: Vec<(usize, Profile)>,
    /// The surface of material points that drains.
    pub drained_surface: Option<Surface>,
    /// The velocities of the regions that do not start at rest.
    pub initial_velocity: Vec<InitialVelocity>,
    pub numerics: Numerics,
    pub phases: Vec<Phase>,
    pub output: Output,
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
    /// The `.geo` file, relative to the working directory or absolute.
    pub geo: PathBuf,
    pub order: Order,
    /// Values for the parameters of the `.geo`, by name.
    pub parameters: BTreeMap<String, f64>,
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

/// A material.
#[derive(Clone)]
pub struct Material {
    pub name: String,
    /// The name of its model.
    pub model_name: String,
    /// Density (t/m³).
    pub density: Profile,
    pub model: Arc<dyn Model>,
    /// What the pressure field carries of its stress.
    pub carried: Option<MixedPressure>,
    /// The water in its pores, where that flows or has a stiffness of its own.
    pub porous: Option<Porous>,
}

impl Material {
    /// Whether the excess pressure of its pore water is found.
    pub fn has_pore_pressure(&self) -> bool {
        self.porous.is_some() || self.carried.as_ref().is_some_and(|carried| carried.water > 0.0)
    }

    /// Whether it has a density anywhere.
    pub fn has_mass(&self) -> bool {
        self.density.top > 0.0 || self.density.gradient > 0.0
    }
}

impl fmt::Debug for Material {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Material").field("name", &self.name).field("density", &self.density).finish_non_exhaustive()
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
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Support {
    pub curve: String,
    pub fixed: [bool; 2],
    pub rotation: bool,
    /// Whether water leaves there.
    pub drained: bool,
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

/// A velocity `amplitude · sin(wave_number · x[along])` in the direction `component`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingWave {
    pub component: usize,
    pub along: usize,
    /// Largest velocity (m/s).
    pub amplitude: f64,
    /// Wave number (rad/m).
    pub wave_number: f64,
}

impl InitialVelocity {
    /// The velocity (m/s) at `x` (m).
    pub fn at(&self, x: &[f64; 2]) -> [f64; 2] {
        let from = [x[0] - self.centre[0], x[1] - self.centre[1]];
        let mut v = [0, 1].map(|i| self.velocity[i] + self.gradient[i][0] * from[0] + self.gradient[i][1] * from[1]);
        if let Some(wave) = self.standing_wave {
            v[wave.component] += wave.amplitude * (wave.wave_number * x[wave.along]).sin();
        }
        v
    }
}

/// The numerical method.
#[derive(Clone, Debug, PartialEq)]
pub struct Numerics {
    /// What the points see of the grid.
    pub basis: &'static dyn Basis<2>,
    /// What integrals are summed over.
    pub quadrature: super::raw::Quadrature,
    pub restore: Restore,
    /// ρ∞ (-) of generalised-α.
    pub spectral_radius: f64,
    /// Relative residual (-) at which Newton's iteration ends.
    pub tolerance: f64,
    /// Iterations after which a step is halved.
    pub max_iterations: usize,
    /// Stiffness of empty cells over that of the soil (-).
    pub empty_stiffness: f64,
}

/// When the grid goes back to its first shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restore {
    EveryStep,
    /// When a cell with points has less than the share `least` (-) of its first quality, or an edge of it is `stretch`
    /// times (-) as long as at first, or as short.
    Quality {
        least: f64,
        stretch: f64,
    },
    /// Updated Lagrangian: the grid moves with the material.
    Never,
}

/// A phase of the analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    pub name: String,
    pub analysis: Analysis,
    /// Duration (s).
    pub duration: f64,
    pub step: StepSize,
    pub prescribed: Vec<Prescribed>,
    pub tractions: Vec<Traction>,
    pub surface_loads: Vec<SurfaceLoad>,
    /// Factor (-) on gravity.
    pub gravity: TimeValue,
    /// What strengths are divided by (-); absent where they are as given.
    pub reduction: Option<TimeValue>,
    /// Structures, walls and contacts that are not there in the phase.
    pub absent: Vec<String>,
    /// The materials that regions take as it begins.
    pub changes: Vec<Change>,
    /// Whether displacements are counted from its beginning.
    pub reset: bool,
    pub until: Vec<Until>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    QuasiStatic,
    Dynamic,
    /// Quasi-static, and dynamic where there is no equilibrium until there is rest.
    Auto,
    /// Quasi-static while water flows.
    Consolidation,
    /// Quasi-static, with strengths that fall until no equilibrium is left.
    StrengthReduction,
}

impl Analysis {
    /// Whether inertia may come in.
    pub fn has_inertia(self) -> bool {
        matches!(self, Self::Dynamic | Self::Auto)
    }
}

/// A material that a region takes: indices into [`Case::regions`] and [`Case::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    pub region: usize,
    pub material: usize,
}

/// What ends a phase before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// A quantity of the entry of [`Output::history`] with this index is at least, or where `below` at most `bound`.
    Reached { history: usize, quantity: Quantity, bound: f64, below: bool },
    /// The kinetic energy has fallen to this part (-) of its largest in the phase, or all forces are in balance but for this part from its
    /// beginning at rest on.
    Equilibrium(f64),
}

/// Time steps (s), `min ≤ initial ≤ max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSize {
    pub initial: f64,
    pub min: f64,
    pub max: f64,
}

/// A component of the displacement (m) of a curve or a rigid structure since the beginning of the phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    pub curve: String,
    /// 0 for x, 1 for y, 2 for the rotation (rad) of a rigid structure.
    pub component: usize,
    pub displacement: TimeValue,
}

/// A dead load (kPa) on a curve, per area of the undeformed curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction {
    pub curve: String,
    pub components: [TimeValue; 2],
}

/// A load on the surface of the material points, per area of the surface as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceLoad {
    /// Index into [`Case::regions`]; `None` for all of the surface.
    pub region: Option<usize>,
    pub pressure: Option<Pressure>,
    /// Along the surface (kPa), positive in the sense that has the material on its left.
    pub shear: TimeValue,
    /// In fixed directions (kPa).
    pub components: [TimeValue; 2],
    /// From and to (m) in x and y.
    pub within: Option<[[f64; 2]; 2]>,
}

/// A pressure (kPa, compression positive): uniform, or growing with depth.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressure {
    pub top: TimeValue,
    pub gradient: TimeValue,
    pub datum: f64,
}

/// Water around soil and structures, and in the pores of soil.
#[derive(Clone, Debug, PartialEq)]
pub struct Water {
    /// Unit weight (kN/m³).
    pub unit_weight: f64,
    /// Height y (m) of its level in each phase; `None` without any outside.
    pub level: Option<Vec<TimeValue>>,
    /// Height y (m) up to which the pores have it in each phase; `None` where they have none.
    pub phreatic: Option<Vec<TimeValue>>,
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
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct History {
    pub name: String,
    /// A physical curve, a physical point or a region.
    pub on: String,
    pub quantities: Vec<Quantity>,
}
