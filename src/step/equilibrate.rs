//! Balance on a restored grid, before a step without inertia.
//!
//! The stresses that integration points take from the material points balance the forces of the step before only as well as the cells
//! can tell. In soil that yields, what is missing becomes displacement in every restoration: a load that is held creeps, and a body that
//! is pushed meets less for a while. So the soil is brought to balance first, under the loads of the step before, with nothing moving that is
//! prescribed. It keeps the stresses, contacts go on from where they are then, and the displacements are discarded.
//!
//! The material points answer for the displacements themselves, and penalties on increments are gone with them: what both make of the
//! balance is brought to balance once more.

use super::grid::{self, Grid};
use super::newton;
use super::problem::Problem;
use super::scene::Scene;
use super::state::{Span, State};
use super::transfer;
use crate::error::{Kind, Result};
use crate::term::{Trial, contact_answer};

/// Solutions. A load held at 0.90 of what clay bears creeps by 1.9 % in 100 restorations with one and 0.6 % with two; at 0.91 by 5.0 and 2.5 %,
/// and by 1.1 % with four.
const ROUNDS: usize = 2;

/// Whether restoring the grid leaves what is to be brought to balance under the loads of the `last` step: soil that yields, in a phase
/// without inertia and without water that flows, that has the materials, the structures and the supports which that step had.
fn is_due<const D: usize>(scene: &Scene<D>, state: &State<D>, last: Span) -> bool {
    let [now, then] = [state.phase, last.phase].map(|phase| &scene.phases[phase]);
    let changes = scene.phases[last.phase + 1..=state.phase].iter().any(|phase| !phase.changes.is_empty());
    let fixed = |phase| scene.fixed(phase).map(|fixed| (&fixed.nodes, fixed.component)).collect::<Vec<_>>();
    let alike = last.phase == state.phase || fixed(last.phase) == fixed(state.phase);
    let same = !changes && now.held == then.held && now.apart == then.apart && alike;
    scene.terms.iter().any(|term| term.yields()) && !state.dynamic(scene) && !now.flows && same
}

/// Brings the soil to balance under the loads of the `last` step on the restored grid. Returns whether it was due and not found: the step
/// that comes begins out of balance then.
///
/// # Errors
/// When memory does not suffice.
pub fn equilibrate<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
    last: Span,
) -> Result<bool> {
    if !is_due(scene, state, last) {
        return Ok(false);
    }
    let given = grid::given_increments(scene, state, grid, 0.0);
    let Span { phase, from, to } = last;
    for round in 0..ROUNDS {
        let problem = Problem { given: &given, phase, from, to, ..Problem::at_rest(scene, state) };
        let solution = match newton::solve(&problem, grid) {
            Ok(solution) => solution,
            Err(error) if error.kind != Kind::Analysis => return Err(error),
            // The balance of the round before stands.
            Err(_) => return Ok(round == 0),
        };
        go_on(scene, grid, state, (&solution.displacement, last));
        transfer::commit_stresses(scene, grid, state, &solution, last);
        state.pressure.clone_from(&solution.pressure);
    }
    Ok(false)
}

/// Lets contacts begin with the gaps, the normals and the shear that they have after the displacement (m) of the nodes: with the multipliers
/// that there are the pressures are the same then, too.
fn go_on<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    (displacement, Span { phase, to, .. }): (&[[f64; D]], Span),
) {
    let trial = Trial {
        phase,
        time: to,
        reduction: scene.phases[phase].reduction_at(to),
        ..Trial::at_rest(displacement, &state.displacement)
    };
    for constraint in &mut grid.constraints {
        let law = scene.interfaces[constraint.interface as usize].law();
        let (answer, motion) = contact_answer(law, scene.levels.as_ref(), constraint, &trial);
        if answer.pressure != 0.0 || answer.shear != 0.0 {
            constraint.condition.penalty.shear = answer.shear;
            constraint.condition.go_on(motion);
        }
    }
}
