//! The law of contact: normal pressure and shear from gap and slip, by an augmented Lagrangian.
//!
//! `p = ⟨λ − ε_n g⟩`, shear `τ = λ_t − ε_t s` limited to `|τ| ≤ τ_max`, `τ_max = min(c_a + p′ tan δ, α s_u)`, `p′` without what the water in the pores bears. With the
//! multipliers `λ`, `λ_t` of the step before, gaps close and sticking soil creeps no farther (Alart & Curnier 1991).
//!
//! Surfaces part smoothly: `⟨q⟩` is rounded over `|q| < d`, and adhesion, which would vanish at once where they
//! part, fades over a gap `w`, `τ_max (1 − ⟨g⟩/w)`; without adhesion only friction without pressure does, `⟨−w_p⟩ tan δ`
//! of water that presses the two together from outside. Without the one Newton's method may go back and forth at a contact node that
//! neither bears nor is open; without the other there may be no equilibrium: soil that touches is dragged away, and
//! soil that is not dragged touches.

use super::motion::{Motion, Spot};

/// What is not much farther apart than the nearest place (-), in the gap over which adhesion fades.
const NEAREST: f64 = 0.02;

/// What two surfaces exert on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// tan δ (-).
    pub friction: f64,
    /// c_a (kPa).
    pub adhesion: f64,
    /// α (-): the shear is at most α times the shear strength of the soil, and without friction and adhesion just that.
    pub factor: Option<f64>,
    /// The tension (kPa) at which the surfaces part, without end where they cannot.
    pub tension: f64,
    /// Whether no water enters the gap where they have parted: the tension stays until the gap closes.
    pub sealed: bool,
}

/// The law of an interface in each phase: they may change as one begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    first: Law,
    /// The number of the phase that each other one begins with, ascending.
    later: Vec<(usize, Law)>,
}

impl From<Law> for Laws {
    fn from(first: Law) -> Self {
        Self { first, later: Vec::new() }
    }
}

impl Laws {
    /// These, with `law` from a phase on that comes after those that changed it before.
    pub fn then(mut self, phase: usize, law: Law) -> Self {
        self.later.push((phase, law));
        self
    }

    /// The law in a phase, by its number.
    pub fn at(&self, phase: usize) -> &Law {
        self.later.iter().rfind(|(from, _)| *from <= phase).map_or(&self.first, |(_, law)| law)
    }

    /// Whether the tangent is symmetric in every state of every phase.
    pub fn symmetric(&self) -> bool {
        self.first.symmetric() && self.later.iter().all(|(_, law)| law.symmetric())
    }
}

/// Multipliers and penalties of a contact node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Pressure and shear (kPa) so far.
    pub pressure: f64,
    pub shear: f64,
    /// ε_n and ε_t (kPa/m).
    pub normal: f64,
    pub tangential: f64,
    /// Pressure `d` (kPa) over which parting is rounded.
    pub rounding: f64,
    /// Gap `w` (m) over which adhesion fades.
    pub fading: f64,
    /// Whether the surfaces bear the tension that they can: not before they have touched.
    pub bonded: bool,
    /// Shear strength of the soil (kPa) as the step begins.
    pub strength: f64,
    /// What of the pressure (kPa) the water in the pores bears beyond the water outside: friction has no share in it. Negative where
    /// the water outside presses the grains together.
    pub water: f64,
}

/// Pressure (compression positive) and shear (kPa) with their slopes by gap and slip (kPa/m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Answer {
    pub pressure: f64,
    /// On the soil, along the tangent.
    pub shear: f64,
    pub pressure_by_gap: f64,
    pub shear_by_gap: f64,
    pub shear_by_slip: f64,
    /// The first moment of the pressure under the contact node (kN/m), and the slopes of pressure (kPa) and moment (kN/m) by the angle by which the
    /// boundary turns.
    pub moment: f64,
    pub moment_by_gap: f64,
    pub pressure_by_turn: f64,
    pub moment_by_turn: f64,
    /// The slope of the shear (kPa) by that angle.
    pub shear_by_turn: f64,
}

/// Where under a contact node (m, along it) the two are nearest, and how that goes with the angle (m): the mean over what is not much farther apart.
fn nearest(fading: f64, spots: &[Spot], open: &dyn Fn(&Spot) -> f64) -> (f64, f64) {
    let (width, least) = (NEAREST * fading, spots.iter().map(open).fold(f64::INFINITY, f64::min));
    let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
    for spot in spots {
        let weight = (-(open(spot) - least) / width).exp();
        (sum, first, second) = (sum + weight, first + weight * spot.along, second + weight * spot.along.powi(2));
    }
    let place = first / sum;
    (place, (place * place - second / sum) / width)
}

/// How far (m, beyond the mean gap) the two have to approach each other under a contact node for a mean overlap (m) of its area.
fn level(spots: &[Spot], overlap: f64) -> f64 {
    let beneath = |level: f64| spots.iter().map(|spot| spot.share * (level - spot.open).max(0.0)).sum::<f64>();
    let mut level = spots.iter().map(|spot| spot.open).fold(f64::INFINITY, f64::min);
    // The overlap is convex in the level: Newton's method from below the root passes it once, then comes down to it.
    for _ in spots {
        let share: f64 = spots.iter().filter(|spot| spot.open <= level).map(|spot| spot.share).sum();
        level += (overlap - beneath(level)) / share;
    }
    level
}

impl Penalty {
    /// These with the water in the pores at rest `beyond` (kPa) the pressure of that outside, to which the excess pressure of the pores is
    /// added. Suction does not press the grains on a structure that may part from them: the pores count with no less than the lower of the two.
    pub fn in_water(&self, beyond: f64) -> Self {
        Self { water: (beyond + self.water).max(beyond.min(0.0)), ..*self }
    }
}

impl Law {
    /// Whether the tangent is symmetric in every state.
    pub fn symmetric(&self) -> bool {
        self.friction == 0.0 && !(self.separates() && self.adheres())
    }

    /// The law with friction, adhesion and the part of the soil's strength divided by `factor` (-).
    pub fn reduced(&self, factor: f64) -> Self {
        let Self { friction, adhesion, .. } = *self;
        let part = self.factor.map(|part| part / factor);
        Self { friction: friction / factor, adhesion: adhesion / factor, factor: part, ..*self }
    }

    fn separates(&self) -> bool {
        self.tension.is_finite()
    }

    /// Whether the surfaces bear shear without pressure in any water.
    fn adheres(&self) -> bool {
        self.adhesion > 0.0 || self.friction == 0.0 && self.factor.is_some_and(|factor| factor > 0.0)
    }

    /// The answer to a mean gap and slip (m).
    pub fn respond(&self, at: &Penalty, gap: f64, slip: f64) -> Answer {
        let (pressure, pressure_by_gap) = self.pressure(at, gap);
        self.shear(at, (gap, 0.0), slip, Answer { pressure, pressure_by_gap, ..Answer::default() })
    }

    /// The answer of a contact node with a frozen status: the part of its area that bears the multiplier as the step begins goes on to bear, in
    /// compression or tension. Surfaces that bear tension do so on the whole area. `stick` is for a contact node without pressure, and so without friction.
    pub fn frozen(&self, at: &Penalty, spots: &[Spot], motion: &Motion, stick: bool) -> Answer {
        let law = Self { tension: f64::INFINITY, adhesion: if stick { f64::INFINITY } else { self.adhesion }, ..*self };
        let bonded = at.bonded && self.tension > 0.0;
        let level = if bonded { f64::INFINITY } else { level(spots, at.pressure.max(0.0) / at.normal) };
        law.respond_where(&|spot| spot.open <= level, at, spots, motion, 0.0)
    }

    /// The answer half a step after a motion, `slope` (-) being what a motion adds to itself until then. The gap varies under the contact node:
    /// a part of it may bear while the rest is apart.
    pub fn respond_over(&self, at: &Penalty, spots: &[Spot], motion: &Motion, slope: f64) -> Answer {
        self.respond_where(&|_| true, at, spots, motion, slope)
    }

    /// The answer of that part of the area to which `bears` applies.
    fn respond_where(
        &self,
        bears: &dyn Fn(&Spot) -> bool,
        at: &Penalty,
        spots: &[Spot],
        motion: &Motion,
        slope: f64,
    ) -> Answer {
        let &Motion { gap, slip, turn, ahead, ahead_turn } = motion;
        if spots.is_empty() {
            return self.respond(at, gap + ahead, slip);
        }
        let open = |spot: &Spot| spot.open + turn * spot.along;
        let (place, place_by_turn) = nearest(at.fading, spots, &open);
        let mut answer = Answer::default();
        let gap = gap + ahead + ahead_turn * place;
        for spot in spots.iter().filter(|spot| bears(spot)) {
            let (pressure, by_gap) = self.pressure(at, gap + open(spot));
            let (share, lever) = (spot.share, spot.share * spot.along);
            let by_turn = by_gap * (spot.along + ahead_turn * place_by_turn + slope * place);
            answer.pressure += share * pressure;
            answer.moment += lever * pressure;
            answer.pressure_by_gap += share * by_gap;
            answer.pressure_by_turn += share * by_turn;
            answer.moment_by_gap += lever * by_gap;
            answer.moment_by_turn += lever * by_turn;
        }
        let least = spots
            .iter()
            .map(|spot| (open(spot), spot.along))
            .fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        let by_turn = least.1 + ahead_turn * place_by_turn + slope * place;
        self.shear(at, (gap + least.0, by_turn), slip, answer)
    }

    /// The answer with the shear that its pressure allows, given the least gap (m) and the slope of that by the turn (m).
    fn shear(&self, at: &Penalty, (gap, gap_by_turn): (f64, f64), slip: f64, mut answer: Answer) -> Answer {
        let (effective, by_pressure, by_gap) = self.effective(at, gap, answer.pressure);
        let (full, slope) = self.limit(effective, at.strength);
        let (share, share_by_gap) = if self.adheres() { self.share(at, gap) } else { (1.0, 0.0) };
        // The full one may be infinite: soil without limit of strength.
        if full == 0.0 || share == 0.0 {
            return answer;
        }
        let limit = full * share;
        let shear = at.shear - at.tangential * slip;
        if shear.abs() <= limit {
            answer.shear = shear;
            answer.shear_by_slip = -at.tangential;
        } else {
            answer.shear = limit.copysign(shear);
            let [by_pressure, by_gap] = [slope * share * by_pressure, slope * share * by_gap + full * share_by_gap]
                .map(|by| by * shear.signum());
            answer.shear_by_gap = by_pressure * answer.pressure_by_gap + by_gap;
            answer.shear_by_turn = by_pressure * answer.pressure_by_turn + by_gap * gap_by_turn;
        }
        answer
    }

    /// The effective pressure (kPa), and its slopes by the pressure (-) and by the gap (kPa/m). The part of it that a higher water level outside
    /// causes vanishes as the surfaces separate; with adhesion the whole shear does.
    fn effective(&self, at: &Penalty, gap: f64, pressure: f64) -> (f64, f64, f64) {
        let (mut effective, mut by_gap) = (pressure - at.water, 0.0);
        if !self.adheres() {
            let (share, share_by_gap) = self.share(at, gap);
            let drawn = (-at.water).max(0.0);
            (effective, by_gap) = (effective - (1.0 - share) * drawn, share_by_gap * drawn);
        }
        // Friction is never negative, also where the surfaces bear tension.
        if effective > 0.0 { (effective, 1.0, by_gap) } else { (0.0, 0.0, 0.0) }
    }

    /// The pressure (kPa) and its slope by the gap (kPa/m).
    fn pressure(&self, at: &Penalty, gap: f64) -> (f64, f64) {
        let pressure = at.pressure - at.normal * gap;
        let around = at.rounding;
        if pressure >= around {
            (pressure, -at.normal)
        } else if at.bonded && self.tension > 0.0 {
            if pressure >= -self.tension { (pressure, -at.normal) } else { (-self.tension, 0.0) }
        } else if pressure <= -around {
            (0.0, 0.0)
        } else {
            let above = pressure + around;
            (above * above / (4.0 * around), -at.normal * above / (2.0 * around))
        }
    }

    /// The part that an open gap leaves (-) of what does not come of the pressure, and its slope by the gap (1/m).
    fn share(&self, at: &Penalty, gap: f64) -> (f64, f64) {
        if !self.separates() {
            (f64::from(u8::from(at.bonded)), 0.0)
        } else if gap <= 0.0 {
            (1.0, 0.0)
        } else if gap >= at.fading {
            (0.0, 0.0)
        } else {
            (1.0 - gap / at.fading, -1.0 / at.fading)
        }
    }

    /// The largest shear (kPa) under a pressure, and its slope by the pressure (-).
    fn limit(&self, pressure: f64, strength: f64) -> (f64, f64) {
        let own = self.adhesion + self.friction * pressure;
        // A strength without limit limits nothing, not even where α is zero.
        match self.factor.map(|factor| if factor > 0.0 { factor * strength } else { 0.0 }) {
            Some(most) if own > most || (self.friction == 0.0 && self.adhesion == 0.0) => (most, 0.0),
            _ => (own, self.friction),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: Penalty = Penalty {
        pressure: 3.0,
        shear: 0.5,
        normal: 100.0,
        tangential: 50.0,
        rounding: 0.2,
        fading: 0.045,
        bonded: true,
        strength: 2.0,
        water: 0.0,
    };

    fn laws() -> Vec<Law> {
        let law = |friction, adhesion, factor, tension| Law { friction, adhesion, factor, tension, sealed: false };
        vec![
            law(0.0, 0.0, None, 0.0),
            law(0.4, 0.0, None, 0.0),
            law(0.4, 0.3, Some(0.5), 0.0),
            law(0.0, 0.0, Some(0.5), 0.0),
            law(0.2, 0.1, None, f64::INFINITY),
            law(0.4, 0.0, Some(0.6), 0.0),
            law(0.0, 0.0, None, 0.7),
            law(0.4, 0.0, None, 0.7),
        ]
    }

    #[test]
    fn slopes_are_those_of_the_answer() {
        let step = 1e-7;
        let in_water = [0.0, 1.3, -1.3].map(|water| Penalty { water, ..AT });
        for (law, at) in laws().into_iter().flat_map(|law| in_water.map(|at| (law, at))) {
            for gap in [-0.02, 0.011, 0.029, 0.0315, 0.04] {
                for slip in [-0.1, -0.004, 0.0, 0.003, 0.2] {
                    let answer = law.respond(&at, gap, slip);
                    let [up, down] = [step, -step].map(|d| law.respond(&at, gap + d, slip));
                    let slope = |f: fn(&Answer) -> f64| (f(&up) - f(&down)) / (2.0 * step);
                    assert!((slope(|a| a.pressure) - answer.pressure_by_gap).abs() < 1e-5, "{law:?} {gap} {slip}");
                    assert!((slope(|a| a.shear) - answer.shear_by_gap).abs() < 1e-5, "{law:?} {gap} {slip}");
                    let [up, down] = [step, -step].map(|d| law.respond(&at, gap, slip + d));
                    let by_slip = (up.shear - down.shear) / (2.0 * step);
                    assert!((by_slip - answer.shear_by_slip).abs() < 1e-5, "{law:?} {gap} {slip}");
                }
            }
        }
    }

    /// Shear does not jump where the level outside passes that in the pores, at any gap.
    #[test]
    fn water_that_passes_that_outside_changes_nothing_at_once() {
        for law in laws() {
            for gap in [-0.02, 0.011, 0.029, 0.0315, 0.04] {
                let [above, below] = [1e-9, -1e-9].map(|water| law.respond(&Penalty { water, ..AT }, gap, 0.2));
                assert!((above.shear - below.shear).abs() < 1e-8, "{law:?} {gap}: {above:?} {below:?}");
            }
        }
    }

    /// Suction takes the pores no lower than the lower of their water at rest and that outside.
    #[test]
    fn excess_pressure_is_on_top_of_the_water_at_rest() {
        for (excess, beyond, water) in [
            (2.0, 0.0, 2.0),
            (-2.0, 0.0, 0.0),
            (2.0, 3.0, 5.0),
            (-2.0, 3.0, 1.0),
            (-4.0, 3.0, 0.0),
            (2.0, -3.0, -1.0),
            (-2.0, -3.0, -3.0),
        ] {
            assert_eq!(Penalty { water: excess, ..AT }.in_water(beyond).water, water, "{excess} {beyond}");
        }
    }

    #[test]
    fn shear_has_its_limits() {
        let [smooth, rough, capped, clay, bonded, _, glued, tied] = laws().try_into().unwrap();
        assert_eq!(smooth.respond(&AT, 0.0, 1.0).shear, 0.0);
        assert!((rough.respond(&AT, 0.0, 1.0).shear + 0.4 * 3.0).abs() < 1e-15);
        assert!((rough.respond(&Penalty { water: 1.0, ..AT }, 0.0, 1.0).shear + 0.4 * 2.0).abs() < 1e-15);
        assert_eq!(rough.respond(&Penalty { water: 4.0, ..AT }, 0.0, 1.0).shear, 0.0);
        assert_eq!(rough.respond(&Penalty { water: -5.0, ..AT }.in_water(0.0), 0.0, 1.0), rough.respond(&AT, 0.0, 1.0));
        // Water that stands higher outside presses the grains together, until the two have parted.
        let drawn = Penalty { water: -1.0, ..AT };
        assert!((rough.respond(&drawn, 0.0, 1.0).shear + 0.4 * 4.0).abs() < 1e-15);
        assert!((rough.respond(&drawn, 0.036, 1.0).shear + 0.2 * 0.4).abs() < 1e-12);
        assert_eq!(rough.respond(&drawn, 0.05, 1.0), Answer::default());
        assert_eq!(capped.respond(&AT, 0.0, -1.0).shear, 1.0);
        assert_eq!(clay.respond(&AT, 0.0, 1.0).shear, -1.0);
        assert_eq!(clay.respond(&AT, 0.05, 1.0), Answer::default());
        assert_eq!(clay.respond(&Penalty { strength: f64::INFINITY, ..AT }, 0.05, 1.0), Answer::default());
        assert_eq!(bonded.respond(&AT, 0.05, 0.0).pressure, -2.0);
        // What has not touched yet is pulled by nothing.
        assert_eq!(bonded.respond(&Penalty { bonded: false, ..AT }, 0.05, 1.0), Answer::default());
        // Tension up to its limit, until they have parted.
        assert_eq!(glued.respond(&Penalty { pressure: -0.5, ..AT }, 0.0, 0.0).pressure, -0.5);
        assert_eq!(glued.respond(&Penalty { pressure: -3.0, ..AT }, 0.0, 0.0).pressure, -0.7);
        assert_eq!(glued.respond(&Penalty { bonded: false, ..AT }, 0.05, 0.0).pressure, 0.0);
        // No friction under tension, whatever the water outside presses.
        for gap in [0.0, 0.02, 0.04, 0.06] {
            let pulled = tied.respond(&Penalty { pressure: -3.0, water: -0.6, ..AT }, gap, 1.0);
            assert_eq!((pulled.pressure, pulled.shear), (-0.7, 0.0), "{gap}");
        }
        // Parted, but not far: adhesion has faded by a fifth.
        let parted = clay.respond(&AT, 0.036, 1.0);
        assert!(parted.pressure == 0.0 && (parted.shear + 0.2).abs() < 1e-12, "{parted:?}");
    }

    /// With a frozen status the part of the area answers that bears the multiplier in the geometry of the step: linearly, pressed or pulled. Where no
    /// pressure is yet, that is the nearest place alone, which sticks.
    #[test]
    fn a_frozen_contact_node_closes_where_it_is_nearest() {
        let [smooth, rough, ..]: [Law; 8] = laws().try_into().unwrap();
        let spots = [0.3, 0.1, 0.0, 0.2].map(|open| Spot { share: 0.25, along: 0.0, open });
        let at = |pressure: f64| Penalty { pressure, shear: 0.0, rounding: 0.0, ..AT };
        let answer = |law: &Law, pressure: f64, gap: f64, slip: f64| {
            law.frozen(&at(pressure), &spots, &Motion { gap, slip, ..Motion::default() }, pressure == 0.0)
        };
        for (pressure, bearing) in [(0.0, 1), (1.0, 1), (4.0, 2), (30.0, 4)] {
            let slope = -100.0 * 0.25 * f64::from(bearing);
            let [there, beyond] = [0.0, 0.5].map(|gap| answer(&smooth, pressure, gap, 0.0));
            assert!((there.pressure_by_gap - slope).abs() < 1e-12, "{pressure}: {there:?}");
            assert!((beyond.pressure - there.pressure - 0.5 * slope).abs() < 1e-12, "{pressure}: {beyond:?}");
            // At the gap at which the pressure equals the multiplier, both laws agree.
            let gap = there.pressure_by_gap.recip() * (pressure - there.pressure);
            let exact = smooth.respond_over(&at(pressure), &spots, &Motion { gap, ..Motion::default() }, 0.0).pressure;
            assert!((exact - pressure).abs() < 1e-12, "{pressure}: {exact}");
        }
        assert!((answer(&rough, 0.0, 0.0, 0.3).shear + 50.0 * 0.3).abs() < 1e-12);
        // Surfaces that cannot separate do not, pulled or not.
        let glued = Law { tension: f64::INFINITY, ..smooth };
        for pressure in [-2.0, 0.0, 2.0] {
            let motion = Motion { gap: 0.01, ..Motion::default() };
            let of_law = glued.respond_over(&at(pressure), &spots, &motion, 0.0);
            assert_eq!(glued.frozen(&at(pressure), &spots, &motion, false), of_law, "{pressure}");
        }
    }
}
