//! A structure that is given by its axis.

/// A wall, lining or slab.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Index into [`super::Case::regions`].
    pub region: usize,
    /// Places (m) of the axis, no two that follow each other the same; of a ring the last is the first.
    pub axis: Vec<[f64; 2]>,
    /// Thickness (m) of the strip that stands for it.
    pub thickness: f64,
    /// Greatest length (m) of an element.
    pub size: f64,
    /// Points on the axis (m), by name.
    pub points: Vec<(String, [f64; 2])>,
}

/// The names of the curves of a plate: its sides seen along the axis, and its ends, which a ring does not have.
pub const SIDES: [&str; 2] = ["right", "left"];
pub const ENDS: [&str; 2] = ["start", "end"];

impl Plate {
    /// Whether it is a ring.
    pub fn is_closed(&self) -> bool {
        self.axis.first() == self.axis.last()
    }

    /// The names of its curves, given its own.
    pub fn curves(&self, name: &str) -> Vec<String> {
        let ends = ENDS.iter().filter(|_| !self.is_closed());
        SIDES.iter().chain(ends).map(|part| format!("{name}_{part}")).collect()
    }
}

/// An anchor, a strut or a spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    pub name: String,
    /// The name of a point of a structure.
    pub from: String,
    pub to: BarEnd,
    /// Stiffness (kN/m) of a metre out of the plane.
    pub ea: f64,
    /// The length (m) that stretches; `None` for the distance of its ends.
    pub length: Option<f64>,
    /// The force (kN) that it is tensioned to.
    pub prestress: Option<f64>,
    /// The largest force (kN) in compression, as a negative number, and in tension.
    pub limits: [f64; 2],
}

/// The end of a bar.
#[derive(Clone, Debug, PartialEq)]
pub enum BarEnd {
    Point(String),
    /// A place (m).
    Place([f64; 2]),
}
