//! What soil and structure do at a contact node.

/// Places in [0, 1] of a segment at which the gap is measured where it may vary under a contact node.
pub const PARTS: [f64; 4] = [0.125, 0.375, 0.625, 0.875];

/// A part of the area under a contact node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Share of the area (-).
    pub share: f64,
    /// Arc length (m) from the mean place of the contact node, and how much more than the mean the gap (m) is.
    pub along: f64,
    pub open: f64,
}

impl Spot {
    /// Spots with their areas (m²) for shares, places along a boundary and gaps (m), about the mean of these, where it is a loop on one of so many metres.
    pub fn about_mean(spots: &[Self], around: Option<f64>) -> Vec<Self> {
        let Some(first) = spots.first() else { return Vec::new() };
        let near = |along: f64| match around {
            Some(whole) => along - whole * ((along - first.along) / whole).round(),
            None => along,
        };
        let area: f64 = spots.iter().map(|spot| spot.share).sum();
        let mean = |of: &dyn Fn(&Self) -> f64| spots.iter().map(|s| s.share * of(s)).sum::<f64>() / area;
        let (along, open) = (mean(&|spot| near(spot.along)), mean(&|spot| spot.open));
        let about = |s: &Self| Self { share: s.share / area, along: near(s.along) - along, open: s.open - open };
        spots.iter().map(about).collect()
    }
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
