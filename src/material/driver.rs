//! The single-point driver: a model led along a path of principal strains or stresses, without a mesh.
//!
//! ```
//! use mpm::material::{Elasticity, Profile, Tresca, driver::{Control, drive}};
//!
//! // Uniaxial compression of undrained clay: the stress stops at twice the shear strength.
//! let clay = Tresca::new(Elasticity::new(Profile::constant(1000.0), 0.49)?, Profile::constant(5.0))?;
//! let path = (1..=20).map(|n| [Control::Strain(-0.001 * n as f64), Control::Stress(0.0), Control::Stress(0.0)]);
//! let history = drive(&clay, 0.0, path)?;
//! assert!((history[4].stress[0] + 5.0).abs() < 1e-9);
//! assert!((history[19].stress[0] + 10.0).abs() < 1e-9);
//! # Ok::<(), mpm::error::Error>(())
//! ```

use super::{Model, Response, State, Variable};
use crate::error::{Error, Result};
use nalgebra::{Matrix3, Vector3};

/// What is prescribed along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Total Hencky strain (-) since the start.
    Strain(f64),
    /// Kirchhoff stress (kPa), tension positive.
    Stress(f64),
}

/// Newton iterations a step may take.
const ITERATIONS: usize = 50;

/// The responses of `model` at height `y` (m), stress-free at first, at each point of `path`; the axes stay.
///
/// # Errors
/// If the prescribed stresses cannot be reached, beyond the strength for example.
pub fn drive(model: &dyn Model, y: f64, path: impl IntoIterator<Item = [Control; 3]>) -> Result<Vec<Response>> {
    drive_from(model, y, [0.0; 3], path)
}

/// As [`drive`], from an elastic Hencky strain `elastic` (-) that the model begins with; the strains of the path are since then.
///
/// # Errors
/// As [`drive`].
pub fn drive_from(
    model: &dyn Model,
    y: f64,
    mut elastic: [f64; 3],
    path: impl IntoIterator<Item = [Control; 3]>,
) -> Result<Vec<Response>> {
    let mut history = Vec::new();
    let (mut strain, mut plastic_strain) = ([0.0; 3], 0.0);
    let mut internal = vec![0.0; model.internal_variables().iter().map(Variable::components).sum()];
    model.begin(y, &mut internal);
    for (number, controls) in path.into_iter().enumerate() {
        let mut increment = [0.0; 3];
        for k in 0..3 {
            if let Control::Strain(target) = controls[k] {
                increment[k] = target - strain[k];
            }
        }
        let before = internal.clone();
        let state = State { plastic_strain, internal: &before, ..State::default() };
        let response =
            step(model, y, &controls, &elastic, &state, (&mut increment, &mut internal)).ok_or_else(|| {
                Error::analysis(
                    format!("material driver, step {number}"),
                    format!("no strain gives {controls:?}"),
                    "take smaller steps, or stresses within the strength",
                )
            })?;
        for k in 0..3 {
            strain[k] += increment[k];
        }
        (elastic, plastic_strain) = (response.elastic_strain, response.plastic_strain);
        history.push(response);
    }
    Ok(history)
}

/// Newton's method for the strains of the axes whose stress is prescribed.
fn step(
    model: &dyn Model,
    y: f64,
    controls: &[Control; 3],
    elastic: &[f64; 3],
    state: &State,
    (increment, internal): (&mut [f64; 3], &mut [f64]),
) -> Option<Response> {
    let tolerance = 1e-12 * model.young(y);
    for _ in 0..ITERATIONS {
        let trial = std::array::from_fn(|k| elastic[k] + increment[k]);
        internal.copy_from_slice(state.internal);
        let response = model.respond(y, &trial, state, internal);
        let mut residual = Vector3::zeros();
        let mut tangent = Matrix3::identity();
        for a in 0..3 {
            if let Control::Stress(target) = controls[a] {
                residual[a] = target - response.stress[a];
                for b in 0..3 {
                    tangent[(a, b)] = response.tangent[a][b];
                }
            }
        }
        if residual.amax() <= tolerance {
            return Some(response);
        }
        // At failure with free axes the tangent is singular along the flow: the least change will do.
        let change = tangent.svd(true, true).solve(&residual, 1e-10 * model.young(y)).ok()?;
        for k in 0..3 {
            increment[k] += change[k];
        }
    }
    None
}
