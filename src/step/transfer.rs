//! Transfer of the motion between points and grid (docs/theory.md, section 4, eq. 11 and 12), and of the converged state to the points.
//!
//! To the grid by consistent mass, `(M + P) v = Σ_p m_p N_I v_p` with the regularisation (11a); what that takes of linear and angular momentum is given back. To the points by increments of velocity (FLIP) and values of acceleration, with the momentum
//! that the nodal field has at the integration points ([`momentum`]).

use super::balance::static_force;
use super::family::{Family, interpolate};
use super::grid::Grid;
use super::impulse;
use super::mass::{Carrier, Mass, SEEN, accelerations, seen};
use super::momentum;
use super::problem::{Problem, Solution};
use super::rigid;
use super::scene::Scene;
use super::start::{Start, add};
use super::state::{Span, State};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::quadrature::Samples;
use crate::term::{Dissipated, Frame, Term, Trial, Update};
use crate::time_integration::GeneralisedAlpha;

/// Determines velocity and acceleration of the nodes: from the points (eq. 11), and at the first dynamic step the acceleration from the
/// forces.
///
/// # Errors
/// When the mass on the nodes cannot be inverted.
pub fn motion_to_grid<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
) -> Result<()> {
    for points in [&mut state.points, &mut state.fem] {
        let count = points.len();
        points.velocity.resize(count, [0.0; D]);
        points.acceleration.resize(count, [0.0; D]);
    }
    [state.velocity, state.acceleration] = to_nodes::<D, K>(scene, grid, state)?;
    if let Some(samples) = &mut state.weights.samples {
        samples.motion.clear();
    }
    drop_unrepresented::<D, K>(scene, grid, state);
    if !state.moving {
        state.acceleration = first_acceleration::<D, K>(scene, grid, state)?;
        accelerations_to_points::<D, K>(scene, grid, state);
        rigid::motion_to_points(scene, state);
        // The last increment without inertia predicts nothing for a step with inertia.
        state.increment.fill([0.0; D]);
    }
    Ok(())
}

/// Gives the material points in cells of second and third order the interpolated velocity of the grid. The part of their velocity that the grid cannot
/// represent moves nothing, but would stay with the points, also at rest, until another cell represents it as motion. In cells of first
/// order this part is bending, and it is kept.
fn drop_unrepresented<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, grid: &Grid<D>, state: &mut State<D>) {
    let (mesh, interpolation, coupling) = (&scene.mesh, grid.of_material(), &grid.coupling);
    let seen = interpolate::<D, K>(&Family { mesh, interpolation, coupling, points: &state.points }, &state.velocity);
    let Points { velocity, cell, .. } = &mut state.points;
    for ((own, seen), &cell) in velocity.iter_mut().zip(seen).zip(&*cell) {
        if mesh.cells.kind[cell as usize].order() > 1 {
            *own = seen;
        }
    }
}

/// The acceleration at the first dynamic step, `(M + P) a = −f` with the contact that the last step has left; zero where the displacement is prescribed.
fn first_acceleration<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
) -> Result<Vec<[f64; D]>> {
    let mut force = static_force(&Problem::at_rest(scene, state), grid)?.force;
    let at_rest = Trial { phase: state.phase, ..Trial::at_rest(&state.displacement, &state.displacement) };
    force.iter_mut().zip(impulse::force(scene, grid, &at_rest)).for_each(|(sum, own)| *sum += own);
    force.iter_mut().zip(impulse::held(grid)).for_each(|(sum, own)| *sum -= own);
    accelerations::<D, K>(scene, grid, state, &force)
}

/// The new values of the points that the terms compute from a converged state.
pub struct Answers {
    of_integration: Vec<Update>,
    /// Of the material points that integrals are not summed over.
    of_material: Vec<Update>,
    of_elements: Vec<Update>,
}

/// The energy (kJ) that points store with their new values.
pub fn stored_after<const D: usize>(scene: &Scene<D>, state: &State<D>, answers: &Answers) -> f64 {
    let of = |terms: &[Box<dyn Term<D>>], updates: &[Update], points: &Points<D>| {
        let mut points = points.clone();
        updates.iter().for_each(|update| update.apply(&mut points));
        terms.iter().map(|term| term.energy(&points)).sum::<f64>()
    };
    let of_elements = scene.fem.as_ref().map_or(0.0, |fem| of(&fem.terms, &answers.of_elements, &state.fem));
    of(&scene.terms, &answers.of_integration, state.integration()) + of_elements
}

/// The new values of all points in a step of `dt` (s).
///
/// # Errors
/// Analysis: a point that integrals are summed over has none, as its strain is beyond the range of its model.
pub fn answers<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    solution: &Solution<D>,
    dt: f64,
) -> Result<Answers> {
    let step = Span { phase: state.phase, from: state.phase_time, to: state.phase_time + dt };
    let answers = Answers::to(scene, grid, state, solution, step);
    for (updates, points) in [(&answers.of_integration, state.integration()), (&answers.of_elements, &state.fem)] {
        if let Some(p) = updates.iter().flat_map(Update::failed).next() {
            return Err(Error::analysis(
                "stress update",
                format!("the material at {:.3?} m is strained beyond the range of its model", points.position[p]),
                "take smaller steps (step.max)",
            ));
        }
    }
    Ok(answers)
}

impl Answers {
    /// What the step dissipates at all that integrals are summed over.
    pub fn dissipated(&self) -> Dissipated {
        let updates = self.of_integration.iter().chain(&self.of_elements).map(Update::dissipated);
        updates.fold(Dissipated::default(), |sum, more| Dissipated {
            plastic: sum.plastic + more.plastic,
            seepage: sum.seepage + more.seepage,
        })
    }

    /// Those to the `solution` of a step.
    fn to<const D: usize>(
        scene: &Scene<D>,
        grid: &Grid<D>,
        state: &State<D>,
        solution: &Solution<D>,
        step: Span,
    ) -> Self {
        let Span { phase, from, to } = step;
        let trial = Trial {
            pressure: &solution.pressure,
            converged_pressure: &state.pressure,
            phase,
            time: from,
            reduction: scene.phases[phase].reduction_at(to),
            inverse_dt: step.rate(),
            flow_time: if scene.phases[phase].flows { to - from } else { 0.0 },
            alpha_f: state.alpha_f(scene),
            geometry: state.geometry(),
            ..Trial::at_rest(&solution.displacement, &state.displacement)
        };
        let of = |terms: &[Box<dyn Term<D>>], frame: &Frame<D>| -> Vec<Update> {
            terms.iter().filter_map(|term| term.commit(frame, &trial)).collect()
        };
        let material = grid.frame_of_material(&scene.mesh, state);
        let elements = match (&scene.fem, &grid.elements) {
            (Some(fem), Some(elements)) => of(&fem.terms, &grid.frame_of_elements(scene, elements, state)),
            _ => Vec::new(),
        };
        Self {
            of_integration: of(&scene.terms, &grid.frame(&scene.mesh, state)),
            of_material: material.map_or_else(Vec::new, |frame| of(&scene.terms, &frame)),
            of_elements: elements,
        }
    }
}

/// Writes the new values of a step into the points. A material point that integrals are not summed over may be strained
/// beyond the range of its model: it takes the state of the nearest integration point. Returns how many did.
pub fn commit<const D: usize, K: Kinematics<D>>(state: &mut State<D>, answers: Answers) -> usize {
    let Answers { of_integration, of_material, of_elements } = answers;
    let lost: Vec<usize> = of_material.iter().flat_map(Update::failed).collect();
    of_integration.into_iter().for_each(|update| update.apply(state.integration_mut()));
    of_material.into_iter().for_each(|update| update.apply(&mut state.points));
    of_elements.into_iter().for_each(|update| update.apply(&mut state.fem));
    if let Some(samples) = &state.weights.samples {
        lost.iter().for_each(|&p| take_from_nearest::<D, K>(&mut state.points, p, &samples.points));
    }
    lost.len()
}

/// Writes the stresses and internal variables of the solution of a `step` into the points of the soil, but not their deformation.
pub fn commit_stresses<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &mut State<D>,
    solution: &Solution<D>,
    step: Span,
) {
    let Answers { of_integration, of_material, .. } = Answers::to(scene, grid, state, solution, step);
    of_integration.into_iter().for_each(|update| update.apply_stresses(state.integration_mut()));
    of_material.into_iter().for_each(|update| update.apply_stresses(&mut state.points));
}

/// Gives material point `p` the state of the integration point of its region that is nearest to it, in its cell if there is one.
fn take_from_nearest<const D: usize, K: Kinematics<D>>(points: &mut Points<D>, p: usize, samples: &Points<D>) {
    let square =
        |q: usize| points.position[p].iter().zip(&samples.position[q]).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    let ours = (0..samples.len()).filter(|&q| samples.region[q] == points.region[p]);
    let key = |q: usize| (samples.cell[q] != points.cell[p], square(q));
    let nearest = ours.map(|q| (key(q), q)).min_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let Some((_, q)) = nearest else { return };
    let ratio = samples.deformation[q].determinant() / points.deformation[p].determinant();
    K::stretch(&mut points.deformation[p], ratio);
    points.take_state(p, samples, q);
}

/// Moves the points with the grid.
pub fn move_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &mut State<D>,
    displacement: &[[f64; D]],
) {
    let increment: Vec<[f64; D]> = displacement
        .iter()
        .zip(&state.displacement)
        .map(|(now, before)| std::array::from_fn(|d| now[d] - before[d]))
        .collect();
    let of = |family: Family<D>| interpolate::<D, K>(&family, &increment);
    let moved: Vec<_> = grid.families(scene, state).map(of).collect();
    let of_integration = state.weights.samples.is_some().then(|| grid.integrated(scene, state).next().map(of));
    if let (Some(Some(moved)), Some(samples)) = (of_integration, &mut state.weights.samples) {
        add(&mut samples.points.position, &moved);
    }
    for (points, moved) in [&mut state.points, &mut state.fem].into_iter().zip(&moved) {
        add(&mut points.position, moved);
    }
    rigid::move_points(scene, state, displacement);
}

fn accelerations_to_points<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, grid: &Grid<D>, state: &mut State<D>) {
    let nowhere = vec![[0.0; D]; state.acceleration.len()];
    [state.points.acceleration, state.fem.acceleration] =
        to_points::<D, K>(scene, grid, state, &state.acceleration, &nowhere);
}

/// Acceleration (m/s²) and velocity (m/s) of a component of node `n` at the end of a step, `by` being its displacement in the step (m), `contact` what
/// contact alone accelerates.
pub fn end_motion<const D: usize>(
    integration: &GeneralisedAlpha,
    (start, contact): (&Start<D>, &[[f64; D]]),
    (n, d): (usize, usize),
    by: f64,
) -> [f64; 2] {
    if let Some(end) = start.driven.get(&(n as u32, d)) {
        return [end.acceleration, end.velocity];
    }
    let (v, a) = (start.velocity[n][d], start.acceleration[n][d]);
    let next = integration.acceleration(by, v, a);
    let [less, more] = integration.released(contact.get(n).map_or(0.0, |by_contact| by_contact[d]));
    [next + less, integration.velocity(v, a, next) + more]
}

/// The velocity (m/s) of the nodes at the end of such a step.
pub fn end_velocity<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    motion: (&Start<D>, &[[f64; D]]),
    displacement: &[[f64; D]],
    dt: f64,
) -> Vec<[f64; D]> {
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let ends = displacement.iter().zip(&state.displacement).enumerate();
    let velocity = |n, d, by| end_motion(&integration, motion, (n, d), by)[1];
    ends.map(|(n, (now, before))| std::array::from_fn(|d| velocity(n, d, now[d] - before[d]))).collect()
}

/// Gives the points the motion at the end of the step that began with `start` (eq. 12), `contact` being what contact alone accelerates. The increment is that since the velocity was
/// mapped to the nodes, so a point at a support stops with it.
pub fn motion_to_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &mut State<D>,
    (start, contact): (&Start<D>, &[[f64; D]]),
    displacement: &[[f64; D]],
    dt: f64,
) {
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let (mut change, mut half) = (vec![[0.0; D]; displacement.len()], vec![[0.0; D]; displacement.len()]);
    for n in 0..displacement.len() {
        for d in 0..D {
            let by = displacement[n][d] - state.displacement[n][d];
            let [next, velocity] = end_motion(&integration, (start, contact), (n, d), by);
            change[n][d] = velocity - state.velocity[n][d];
            half[n][d] = 0.5 * (displacement[n][d] - state.displacement[n][d]);
            state.velocity[n][d] = velocity;
            state.acceleration[n][d] = next;
        }
    }
    let [gained, fem] = to_points::<D, K>(scene, grid, state, &change, &half);
    add(&mut state.points.velocity, &gained);
    add(&mut state.fem.velocity, &fem);
    accelerations_to_points::<D, K>(scene, grid, state);
}

/// Velocity and acceleration of the points, mapped to the nodes by mass (eq. 11).
///
/// # Errors
/// As [`Mass::assemble`].
fn to_nodes<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
) -> Result<[Vec<[f64; D]>; 2]> {
    let mut right: [Vec<[f64; D]>; 2] = [0, 1].map(|_| vec![[0.0; D]; scene.displacements()]);
    for Family { mesh, interpolation, points, .. } in grid.families(scene, state) {
        let fields = [&points.velocity, &points.acceleration];
        for cell_points in &interpolation.filled {
            let nodes = interpolation.nodes(mesh, cell_points.cell);
            for entries in interpolation.entries::<K>(cell_points) {
                for (n, &node) in entries.value.iter().zip(nodes) {
                    let weight = points.mass[entries.point] * n;
                    for (right, field) in right.iter_mut().zip(&fields) {
                        for d in 0..D {
                            right[node as usize][d] += weight * field[entries.point][d];
                        }
                    }
                }
            }
        }
    }
    let mut weak: [Vec<[f64; D]>; 2] = [0, 1].map(|_| vec![[0.0; D]; scene.displacements()]);
    if let Some(Samples { points, motion, .. }) = seen(state) {
        let (mesh, interpolation) = (&scene.mesh, &grid.interpolations.integration);
        for cell_points in &interpolation.filled {
            let nodes = interpolation.nodes(mesh, cell_points.cell);
            for entries in interpolation.entries::<K>(cell_points) {
                for (n, &node) in entries.value.iter().zip(nodes) {
                    let weight = SEEN * points.mass[entries.point] * n;
                    for (weak, field) in weak.iter_mut().zip(&motion[entries.point]) {
                        for d in 0..D {
                            weak[node as usize][d] += weight * field[d];
                        }
                    }
                }
            }
        }
    }
    let [mut right, weak] = [right, weak].map(|fields| fields.map(|field| grid.dofs.on_blocks(&field)));
    rigid::momentum(scene, grid, state, &mut right);
    let mut mass = Mass::assemble::<D, K>(scene, grid, state, Carrier::MaterialPoints)?;
    let mut solution = [const { Vec::new() }; 2];
    for ((right, weak), solution) in right.iter().zip(&weak).zip(&mut solution) {
        for d in 0..D {
            let [mut x, weak] = [right, weak].map(|field| field.iter().map(|v| v[d]).collect::<Vec<f64>>());
            mass.solve(&mut x, &weak)?;
            solution.push(x);
        }
    }
    let mut nodal = [0, 1].map(|_| vec![[0.0; D]; scene.displacements()]);
    for (solution, nodal) in solution.iter().zip(&mut nodal) {
        solution.iter().enumerate().for_each(|(d, x)| grid.dofs.write(x, d, nodal));
    }
    momentum::keep_at_nodes::<D, K>(scene, grid, state, &state.points.velocity, &mut nodal[0]);
    momentum::complete_nodes::<D, K>(scene, grid, state, &state.points.acceleration, &mut nodal[1]);
    Ok(nodal)
}

/// The value of a nodal field of velocity or acceleration at the material points, with the momentum that it has at the integration points,
/// and at the points of the finite elements. Moments are taken at the positions less the nodal displacement `back` (m).
fn to_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    field: &[[f64; D]],
    back: &[[f64; D]],
) -> [Vec<[f64; D]>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for (out, family) in out.iter_mut().zip(grid.families(scene, state)) {
        *out = interpolate::<D, K>(&family, field);
    }
    momentum::complete_points::<D, K>(scene, grid, state, field, back, &mut out[0]);
    out
}
