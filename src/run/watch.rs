//! What the history watches.

use super::record::{Force, Side};
use crate::tensor::SYMMETRIC_NAMES;

/// A quantity of the history, with its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Displacement (m), the mean over what is watched.
    Displacement(usize),
    /// Velocity (m/s), the mean over what is watched.
    Velocity(usize),
    /// Force of the supports and prescribed displacements on the nodes (kN), the sum.
    Reaction(usize),
    /// Force of what a structure touches on it (kN), the sum.
    Contact(usize),
    /// Rotation of a rigid body (rad), and the moment (kN m) about its centroid of what holds it.
    Rotation,
    ReactionMoment,
    /// Moment (kN m) of what a structure touches on it about the centroid that it has now, in the plane, anticlockwise.
    ContactMoment,
    /// Excess pore pressure (kPa), the mean over what is watched.
    PorePressure,
    /// Cauchy stress (kPa), tension positive, as the points have it: a component, the mean stress and the deviator; means over what is watched.
    Stress(usize),
    MeanStress,
    DeviatoricStress,
    /// Hencky strain `½ ln FFᵀ` (-) since seeding, a component, and the accumulated plastic strain (-); means over what is watched.
    Strain(usize),
    PlasticStrain,
    /// Mass (t) and present volume (m³) of the points, the sums.
    Mass,
    Volume,
    /// Mass (t) and volume (m³) that have entered and left through a curve since the run began.
    In(usize),
    Out(usize),
    /// The least and the largest coordinate (m) of a point.
    Least(usize),
    Most(usize),
    /// Length (m) of a line within the surface of the material points.
    Thickness,
    /// Force of a bar (kN, tension positive).
    BarForce,
    /// The force in a section of a plate that is largest in amount.
    Section(Force),
}

impl Quantity {
    /// Whether it is one of points alone, and not of nodes or rigid bodies.
    pub fn is_of_points(self) -> bool {
        let of_state = matches!(self, Self::Stress(_) | Self::MeanStress | Self::DeviatoricStress | Self::Strain(_));
        of_state || self == Self::PlasticStrain || self.is_of_many()
    }

    /// Whether it is a sum or an extreme of points.
    pub fn is_of_many(self) -> bool {
        matches!(self, Self::Mass | Self::Volume | Self::Least(_) | Self::Most(_))
    }

    /// Whether it is one of bodies or curves: a force, a moment, a rotation, or what has passed.
    pub fn is_of_bodies(self) -> bool {
        let moment = matches!(self, Self::Rotation | Self::ReactionMoment | Self::ContactMoment);
        moment || matches!(self, Self::Reaction(_) | Self::Contact(_) | Self::In(_) | Self::Out(_))
    }
}

/// Where material points are watched (m).
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A point of space.
    Fixed([f64; 2]),
    /// The soil that was seeded at a point.
    Followed([f64; 2]),
    /// A box, by its lower left and its upper right corner.
    Box([[f64; 2]; 2]),
    /// A line, by its ends.
    Line([[f64; 2]; 2]),
}

/// What is watched.
#[derive(Clone, Debug, PartialEq)]
pub enum WatchedOn {
    /// Nodes of the grid: a curve or a point.
    Nodes(Vec<u32>),
    /// Nodes of a rigid body, and its number in the scene.
    Side(Vec<u32>, usize),
    /// A rigid body, by its number in the scene.
    Body(usize),
    /// The points of a region of the mesh.
    Region(u16),
    /// The material points at a place.
    Soil(Place),
    /// A curve of a structure with contact, and what it is in all else.
    Touched(Box<WatchedOn>, Side),
    /// A curve through which soil leaves or enters, by its number among those in the scene, and what it is in all else.
    Outflow(Box<WatchedOn>, usize),
    Inflow(Box<WatchedOn>, usize),
    /// A bar, by its number in the scene.
    Bar(usize),
    /// A plate, by the number of its region, and whether the plane is turned about its axis.
    Plate(u16, bool),
}

/// An entry of the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    pub name: String,
    pub on: WatchedOn,
    pub quantities: Vec<Quantity>,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The name of a column.
pub fn column_name(watch: &Watch, quantity: Quantity) -> String {
    match quantity {
        Quantity::Displacement(d) => format!("{}.u{} [m]", watch.name, AXES[d]),
        Quantity::Velocity(d) => format!("{}.v{} [m/s]", watch.name, AXES[d]),
        Quantity::Reaction(d) => format!("{}.reaction_{} [kN]", watch.name, AXES[d]),
        Quantity::Contact(d) => format!("{}.contact_{} [kN]", watch.name, AXES[d]),
        Quantity::Rotation => format!("{}.rotation [rad]", watch.name),
        Quantity::ReactionMoment => format!("{}.reaction_moment [kN m]", watch.name),
        Quantity::ContactMoment => format!("{}.contact_moment [kN m]", watch.name),
        Quantity::PorePressure => format!("{}.pore_pressure [kPa]", watch.name),
        Quantity::Stress(k) => format!("{}.stress_{} [kPa]", watch.name, SYMMETRIC_NAMES[k]),
        Quantity::MeanStress => format!("{}.mean_stress [kPa]", watch.name),
        Quantity::DeviatoricStress => format!("{}.deviatoric_stress [kPa]", watch.name),
        Quantity::Strain(k) => format!("{}.strain_{} [-]", watch.name, SYMMETRIC_NAMES[k]),
        Quantity::PlasticStrain => format!("{}.plastic_strain [-]", watch.name),
        Quantity::Mass => format!("{}.mass [t]", watch.name),
        Quantity::Volume => format!("{}.volume [m3]", watch.name),
        Quantity::In(k) => format!("{}.{}", watch.name, ["mass_in [t]", "volume_in [m3]"][k]),
        Quantity::Out(k) => format!("{}.{}", watch.name, ["mass_out [t]", "volume_out [m3]"][k]),
        Quantity::Least(d) => format!("{}.{}_min [m]", watch.name, AXES[d]),
        Quantity::Most(d) => format!("{}.{}_max [m]", watch.name, AXES[d]),
        Quantity::Thickness => format!("{}.thickness [m]", watch.name),
        Quantity::BarForce => format!("{}.force [kN]", watch.name),
        Quantity::Section(force) => format!("{}.{}", watch.name, force.column()),
    }
}
