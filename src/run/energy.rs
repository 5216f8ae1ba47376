//! Energy from nowhere: what the method adds in all, by steps, resets, penalties and supports, is a mistake of the analysis beyond a part of the energy
//! in play (docs/theory.md, section 5, *Balance of energy*).

use super::warning::WARNING;
use crate::step::{Energies, ITEMS, Item, Report, Scene, Side, State, energy_of_fall};

/// How much may be added (-), over the energy in play and over the stored one: what a sound run may come to.
const PARTS: [f64; 2] = [0.02, 0.01];

/// A warning after a step with inertia, or where a phase `ends` without: contact that closes on stress at rest is an error of its first step alone.
pub fn found<const D: usize>(scene: &Scene<D>, state: &State<D>, report: &Report<D>, ends: bool) -> Option<String> {
    let (phase, energies) = (scene.phases.get(state.phase)?, state.energies.as_ref()?);
    let (added, item, name) = added(energies, state.in_play)?;
    let counts = match state.dynamic(scene) {
        // What a step does not resolve says nothing.
        true => added > energy_of_fall(scene, report.motion.mass, report.dt),
        false => ends,
    };
    if !counts {
        return None;
    }
    let cure = match item {
        Item::Resets => "smaller cells around what moves fast, or smaller steps (`step.max`)",
        _ => "smaller steps (`step.max`), or more numerical damping (`numerics: {spectral_radius: 0.6}`)",
    };
    Some(format!(
        "{WARNING}phase `{}`: at t = {:.4} s the method has added {added:.3e} kJ of energy from nowhere, {:.0} % of the energy that is in play, most of \
         it by `numerical.{name}` (energy.csv): the results since then have errors of that order; take {cure}",
        phase.name,
        state.time,
        100.0 * added / state.in_play
    ))
}

/// The energy (kJ) that the method has added, and the entry that has most of it; none where that is little of the energy `in_play` (kJ).
fn added(energies: &Energies, in_play: f64) -> Option<(f64, Item, &'static str)> {
    let added = -energies.sum(Side::Numerical);
    if added <= PARTS[0] * in_play || added <= PARTS[1] * energies.of(Item::Stored) {
        return None;
    }
    let numerical = ITEMS.iter().filter(|(_, _, side)| *side == Side::Numerical);
    let (item, name, _) = numerical.min_by(|a, b| energies.of(a.0).total_cmp(&energies.of(b.0)))?;
    Some((added, *item, name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_method_adds_is_told_where_it_counts() {
        let mut energies = Energies::default();
        for (item, value) in [(Item::Gravity, 10.0), (Item::Kinetic, 8.0), (Item::Stored, 20.0)] {
            energies.set(item, value);
        }
        assert_eq!((energies.in_play(), added(&energies, 18.0)), (18.0, None));
        energies.set(Item::Steps, 1.0);
        energies.set(Item::Resets, -1.25);
        assert_eq!(added(&energies, 18.0), None);
        energies.set(Item::Resets, -1.5);
        assert_eq!(added(&energies, 18.0), Some((0.5, Item::Resets, "resets")));
        // Little of what stresses at rest store.
        energies.set(Item::Stored, 300.0);
        assert_eq!(added(&energies, 18.0), None);
    }
}
