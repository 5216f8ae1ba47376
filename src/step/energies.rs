//! The balance of energy of a run, as numbers (docs/theory.md, section 5, *Energy*).

/// An entry of the balance. All but [`Item::Kinetic`] and [`Item::Stored`] are sums over the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    Initial,
    Changes,
    Gravity,
    Loads,
    Water,
    Supports,
    Outflow,
    Inflow,
    Kinetic,
    Stored,
    Plastic,
    Seepage,
    Friction,
    Contact,
    Impact,
    Steps,
    Resets,
    Equilibration,
    Penalties,
    Residual,
}

/// Where an entry stands: what was brought in is what is held and what was dissipated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Brought in, from outside or as the run or a phase began.
    Supplied,
    Held,
    /// Dissipated by the material and at contacts.
    Dissipated,
    /// Dissipated by the method.
    Numerical,
}

impl Side {
    pub fn name(self) -> &'static str {
        match self {
            Self::Supplied => "supplied",
            Self::Held => "held",
            Self::Dissipated => "dissipated",
            Self::Numerical => "numerical",
        }
    }
}

/// The entries with their names, in the order of [`Item`].
pub const ITEMS: [(Item, &str, Side); 20] = [
    (Item::Initial, "initial", Side::Supplied),
    (Item::Changes, "changes", Side::Supplied),
    (Item::Gravity, "gravity", Side::Supplied),
    (Item::Loads, "loads", Side::Supplied),
    (Item::Water, "water", Side::Supplied),
    (Item::Supports, "supports", Side::Supplied),
    (Item::Outflow, "outflow", Side::Supplied),
    (Item::Inflow, "inflow", Side::Supplied),
    (Item::Kinetic, "kinetic", Side::Held),
    (Item::Stored, "stored", Side::Held),
    (Item::Plastic, "plastic", Side::Dissipated),
    (Item::Seepage, "seepage", Side::Dissipated),
    (Item::Friction, "friction", Side::Dissipated),
    (Item::Contact, "contact", Side::Dissipated),
    (Item::Impact, "impact", Side::Numerical),
    (Item::Steps, "steps", Side::Numerical),
    (Item::Resets, "resets", Side::Numerical),
    (Item::Equilibration, "equilibration", Side::Numerical),
    (Item::Penalties, "penalties", Side::Numerical),
    (Item::Residual, "residual", Side::Numerical),
];

/// The balance (kJ; of a metre in plane strain, of the full circle in axisymmetry).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies(pub [f64; ITEMS.len()]);

impl Energies {
    pub fn of(&self, item: Item) -> f64 {
        self.0[item as usize]
    }

    pub fn set(&mut self, item: Item, value: f64) {
        self.0[item as usize] = value;
    }

    pub fn add(&mut self, item: Item, value: f64) {
        self.0[item as usize] += value;
    }

    /// The sum of the entries on a side.
    pub fn sum(&self, of: Side) -> f64 {
        self.0.iter().zip(&ITEMS).filter(|(_, (_, _, side))| *side == of).map(|(value, _)| value).sum()
    }

    /// The energy in play (kJ): kinetic energy, and what is done from outside.
    pub fn in_play(&self) -> f64 {
        let done = [Item::Gravity, Item::Loads, Item::Water, Item::Supports, Item::Kinetic];
        done.iter().map(|item| self.of(*item).abs()).sum()
    }

    /// Whether nothing has happened since the run began.
    pub fn is_new(&self) -> bool {
        let began = [Item::Initial, Item::Kinetic, Item::Stored];
        self.0.iter().zip(&ITEMS).all(|(value, (item, _, _))| *value == 0.0 || began.contains(item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_entries_stand_in_their_order() {
        assert!(ITEMS.iter().enumerate().all(|(i, (item, _, _))| *item as usize == i));
    }
}
