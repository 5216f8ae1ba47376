//! The balance of energy of a step: who did work in it, and where that went (docs/theory.md, section 5, *Energy*).
//!
//! It is that of the equations of the step: forces on nodes along their displacement increments, the kinetic energy of the nodes, the energy stored at
//! the integration points. In a step with inertia the forces are those within it that the equations have; without inertia they are the mean of those at
//! its ends (the trapezoidal rule), so that a load which grows evenly does the work of its mean in steps of any number.

use super::balance::{by_equation, kinetic, works_at_start};
use super::contact;
use super::drainage;
use super::driven_work::by_record;
use super::energies::{Energies, Item};
use super::grid::Grid;
use super::problem::Solution;
use super::scene::Scene;
use super::start::Start;
use super::state::State;
use crate::dofs::Dof;
use crate::error::{Error, Result};
use crate::points::Points;
use crate::term::{Dissipated, Source, Term, Works};

/// The kinetic energy (kJ) of a mass (t) that falls freely for a time (s).
pub fn energy_of_fall<const D: usize>(scene: &Scene<D>, mass: f64, time: f64) -> f64 {
    0.5 * mass * (time * scene.strongest_gravity).powi(2)
}

/// What is held (kJ): the kinetic energy of the nodes, and what the integration points and finite elements store.
fn held<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &State<D>) -> Result<[f64; 2]> {
    let moves = state.velocity.iter().flatten().any(|&v| v != 0.0);
    let kinetic = if moves { kinetic(scene, grid, state, &state.velocity)? } else { 0.0 };
    let of = |terms: &[Box<dyn Term<D>>], points: &Points<D>| terms.iter().map(|term| term.energy(points)).sum::<f64>();
    let of_elements = scene.fem.as_ref().map_or(0.0, |fem| of(&fem.terms, &state.fem));
    Ok([kinetic, of(&scene.terms, state.integration()) + of_elements])
}

/// Notes what is held as a run, a phase, or the part of a phase without inertia begins.
///
/// # Errors
/// As [`kinetic`].
pub fn begin<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>) -> Result<()> {
    match &state.energies {
        None => {
            state.energies = Some(Energies::default());
            note(scene, grid, state, Item::Initial)
        }
        Some(before) if state.phase_time == 0.0 || (state.velocity.is_empty() && before.of(Item::Kinetic) != 0.0) => {
            note(scene, grid, state, Item::Changes)
        }
        Some(_) => Ok(()),
    }
}

/// Notes what is held now; what was added since it was last noted is that of `item`, as brought in, or what was lost as dissipated by it.
///
/// # Errors
/// As [`kinetic`].
pub fn note<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>, item: Item) -> Result<()> {
    let [kinetic, stored] = held(scene, grid, state)?;
    let Some(energies) = &mut state.energies else { return Ok(()) };
    let added = kinetic - energies.of(Item::Kinetic) + stored - energies.of(Item::Stored);
    let brings = matches!(item, Item::Initial | Item::Changes);
    energies.add(item, if brings { added } else { -added });
    energies.set(Item::Kinetic, kinetic);
    energies.set(Item::Stored, stored);
    Ok(())
}

/// Notes the motion as inertia comes in: that which a run begins with, or what a phase is given.
///
/// # Errors
/// As [`kinetic`].
pub fn note_motion<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>) -> Result<()> {
    let new = state.energies.as_ref().is_some_and(Energies::is_new);
    note(scene, grid, state, if new { Item::Initial } else { Item::Changes })
}

/// How much energy a step with inertia may create (-), over that in play, and over the stored one.
const PARTS: [f64; 2] = [0.1, 0.01];

/// What was done in a converged step, with the sign of [`Works`].
pub struct Done {
    /// Displacement (m) in the step, and the equations of them that are given.
    way: Vec<f64>,
    given: Vec<usize>,
    works: Works,
    /// Work (kJ) of normal and tangential forces of contact.
    contact: [f64; 2],
    /// That of the supports on the nodes, and of the unbalanced force that is held back.
    supports: f64,
    ramp: f64,
    /// What Newton's method has left.
    residual: f64,
    dissipated: Dissipated,
    /// What is lost as the velocities of supported and prescribed nodes take their values at once, and what those that prescribe them give to it.
    impact: f64,
    driven: f64,
    /// What [`by_record`] gives.
    of_record: f64,
    /// What a step with inertia does not resolve (kJ): what gravity gives in it to all that falls freely.
    unresolved: f64,
    /// Without inertia: the part of the work that the forces at the beginning of the step do, in which all of them are in balance.
    at_start: Option<AtStart>,
}

/// Works of the forces as they are at the beginning of a step.
struct AtStart {
    works: Works,
    contact: [f64; 2],
    supports: f64,
    ramp: f64,
}

impl Done {
    /// That of a converged step of `dt` (s) whose state is still that before it. `dissipated` is what its points dissipate.
    ///
    /// # Errors
    /// As [`kinetic`].
    pub fn of<const D: usize>(
        scene: &Scene<D>,
        grid: &mut Grid<D>,
        state: &State<D>,
        (solution, start): (&Solution<D>, Option<&Start<D>>),
        mut dissipated: Dissipated,
        dt: f64,
    ) -> Result<Self> {
        let mut way = Vec::new();
        let increment = |n: u32| {
            let (now, before) = (&solution.displacement[n as usize], &state.displacement[n as usize]);
            std::array::from_fn(|d| now[d] - before[d])
        };
        by_equation(grid, increment, &mut way);
        let fixed = scene.fixed(state.phase);
        let mut given: Vec<usize> = fixed
            .flat_map(|fixed| fixed.nodes.iter().map(move |&n| (n, fixed.component)))
            .filter_map(|(n, component)| grid.dofs.displacement(n, component))
            .collect();
        given.sort_unstable();
        given.dedup();
        let sum = |force: &[f64]| way.iter().zip(force).map(|(u, f)| u * f).sum::<f64>();
        let of_given = |force: &dyn Fn(usize) -> f64| given.iter().map(|&e| way[e] * force(e)).sum::<f64>();
        let supports = of_given(&|e| solution.residual[e]);
        let residual = sum(&solution.residual) - supports;
        dissipated.seepage += drained(scene, grid, state, solution);
        let held_back = match &state.ramp.force[..] {
            [] => 0.0,
            force => {
                let force = grid.dofs.on_blocks(force).concat();
                sum(&force) - of_given(&|e| force[e])
            }
        };
        let (mut impact, mut driven, mut at_start, mut of_record) = (0.0, 0.0, None, 0.0);
        if let Some(start) = start {
            of_record = by_record(scene, grid, state, (solution, start), dt)?;
            if start.velocity != state.velocity {
                let jump: Vec<[f64; D]> = start
                    .velocity
                    .iter()
                    .zip(&state.velocity)
                    .map(|(now, before)| std::array::from_fn(|d| now[d] - before[d]))
                    .collect();
                // Their impulse does its work with the velocity that they have from then on.
                impact = kinetic(scene, grid, state, &jump)?;
                driven = impact + kinetic(scene, grid, state, &start.velocity)?
                    - kinetic(scene, grid, state, &state.velocity)?;
            }
        } else {
            let before = |e: usize| match grid.dofs.dof(e) {
                Dof::Displacement { node, component } => state.reaction.get(node).map_or(0.0, |force| force[component]),
                Dof::Pressure(_) => 0.0,
            };
            at_start = Some(AtStart {
                supports: of_given(&before),
                works: works_at_start(scene, grid, state, &way)?,
                contact: contact::works(scene, grid, state, (solution, None), dt, true),
                ramp: state.ramp.share(state.phase_time) * held_back,
            });
        }
        let mass: f64 = state.points.mass.iter().chain(&state.fem.mass).sum();
        Ok(Self {
            works: solution.work,
            unresolved: if start.is_some() { energy_of_fall(scene, mass, dt) } else { 0.0 },
            contact: contact::works(scene, grid, state, (solution, start), dt, false),
            supports,
            ramp: if start.is_some() { 0.0 } else { state.ramp.share(state.phase_time + dt) * held_back },
            residual,
            dissipated,
            impact,
            driven,
            of_record,
            at_start,
            way,
            given,
        })
    }

    /// The balance after the step, given that before it, the `residual` of the nodes without what numbers of contact its equations have, and what is held
    /// `now`, as kinetic and as stored energy (kJ).
    ///
    /// # Errors
    /// Analysis: a step with inertia creates more energy than it may of the most that was `in_play` (kJ).
    pub fn close(self, before: Energies, residual: &[f64], now: [f64; 2], in_play: f64) -> Result<Energies> {
        let Self {
            way,
            given,
            works,
            contact,
            supports,
            ramp,
            dissipated,
            impact,
            driven,
            of_record,
            unresolved,
            at_start,
            ..
        } = self;
        // What the supports bear of contact that counts otherwise in the equations.
        let of_supports = given.iter().map(|&e| way[e] * residual[e]).sum::<f64>();
        let mean =
            |end: f64, start: &dyn Fn(&AtStart) -> f64| at_start.as_ref().map_or(end, |at| 0.5 * (end + start(at)));
        let of = |source: Source| mean(works.of(source), &|at| at.works.of(source));
        let contact = [0, 1].map(|i| mean(contact[i], &|at| at.contact[i]));
        // As the step began, these were in balance with the stress.
        let stress = mean(works.of(Source::Stress), &|at| {
            at.supports - at.works.sum() - at.contact.iter().sum::<f64>() - at.ramp
        });
        let kinetic = now[0] - (before.of(Item::Kinetic) - impact + driven);
        let stored = now[1] - before.of(Item::Stored);
        let weighted = match &at_start {
            None => works.of(Source::Contact) - contact.iter().sum::<f64>() - (supports - of_supports),
            Some(_) => 0.0,
        };
        let steps = works.of(Source::Inertia) - kinetic + stress - stored - dissipated.plastic - dissipated.seepage
            + weighted
            + of_record
            + mean(ramp, &|at| at.ramp);
        let supplied = [
            (Item::Gravity, -of(Source::Gravity)),
            (Item::Loads, -of(Source::Load)),
            (Item::Water, -of(Source::Water)),
            (Item::Supports, mean(of_supports, &|at| at.supports) + of_record),
        ];
        let mut after = before;
        for (item, value) in supplied.into_iter().chain([
            (Item::Plastic, dissipated.plastic),
            (Item::Seepage, dissipated.seepage),
            (Item::Contact, contact[0]),
            (Item::Friction, contact[1]),
            (Item::Impact, impact),
            (Item::Supports, driven),
            (Item::Steps, steps),
            (Item::Penalties, of(Source::Penalty)),
            (Item::Residual, -mean(self.residual, &|_| 0.0)),
        ]) {
            after.add(item, value);
        }
        after.set(Item::Kinetic, now[0]);
        after.set(Item::Stored, now[1]);
        let created = kinetic + stored - supplied.iter().map(|(_, value)| value).sum::<f64>();
        let in_play = in_play.max(after.in_play());
        // Without inertia, contact that closes may push soil: a structure that comes back, or one that bears stress at rest.
        if at_start.is_none() && created > unresolved.max(PARTS[0] * in_play).max(PARTS[1] * now[1]) {
            let part = 100.0 * created / in_play;
            return Err(Error::analysis(
                "energy",
                format!("the step creates {created:.3e} kJ, {part:.0} % of the energy in play"),
                "take smaller steps (step.max), smaller cells, or more numerical damping (numerics: {spectral_radius: 0.6})",
            ));
        }
        Ok(after)
    }
}

/// What water dissipates (kJ) that leaves where its pressure is given, from the pressure that does work in the step.
fn drained<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, state: &State<D>, solution: &Solution<D>) -> f64 {
    if scene.water.is_none() || !scene.phases[state.phase].flows {
        return 0.0;
    }
    let nodes = drainage::nodes(scene, state, grid.integrated(scene, state));
    let alpha_f = state.alpha_f(scene);
    let unit = scene.pressure_unit.unwrap_or(1.0) * (1.0 - alpha_f);
    let before = if alpha_f > 0.0 { alpha_f } else { 0.5 };
    let places = scene.places()[0];
    let given = grid.dofs.pores().filter(|(_, node)| nodes.binary_search(node).is_ok());
    given
        .map(|(equation, node)| {
            let place = places.pore(node);
            let pressure = (1.0 - before) * solution.pressure[place] + before * state.pressure[place];
            pressure * solution.residual[equation] / unit
        })
        .sum()
}
