//! What soil and structure do at a contact node.

/// A part of the area under a contact node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Share of the area (-).
    pub share: f64,
    /// Arc length (m) from the mean place of the contact node, and how much more than the mean the gap (m) is.
    pub along: f64,
    pub open: f64,
}

/// What the soil did at a contact node in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Mean gap and slip (m) at its end.
    pub gap: f64,
    pub slip: f64,
    /// The angle (rad) by which the normal turned.
    pub turn: f64,
    /// How far the gap (m) opens and the normal turns (rad) in half a step more.
    pub ahead: f64,
    pub ahead_turn: f64,
}
