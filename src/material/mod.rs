//! Material models: pure functions from elastic trial strain to stress, tangent and new state.
//!
//! Those of the list work in principal axes of the elastic trial left Cauchy–Green tensor with Hencky strains
//! `ε_A = ½ ln b_A` and Kirchhoff stresses `τ_A`: the return maps are those of small strain theory.
//!
//! A model is a file with its [`Kind`] and one line in [`MODELS`]; the shared tests find it there. It may have any number of internal
//! variables ([`Model::internal_variables`]).

pub mod cam_clay;
pub mod cavitation;
pub mod driver;
pub mod elasticity;
pub mod linear_elastic;
pub mod model;
pub mod mohr_coulomb;
pub mod parameters;
pub mod polyhedral;
pub mod profile;
pub mod random_strength;
pub mod softening_tresca;
pub mod spatial;
pub mod spectral;
pub mod tresca;
pub mod von_mises;

pub use cam_clay::{CamClay, Swelling};
pub use elasticity::{Elasticity, Moduli};
pub use linear_elastic::LinearElastic;
pub use model::{
    Model, Plasticity, Response, State, Variable, VariableKind, internal_count, is_beyond_yield, odd_poisson,
    on_poisson,
};
pub use mohr_coulomb::{Friction, MohrCoulomb};
pub use parameters::{Kind, Parameter, Parameters};
pub use profile::Profile;
pub use random_strength::{Correlation, RandomStrength, RandomStrengths, Randomness, strength_at};
pub use softening_tresca::{Softening, SofteningTresca};
pub use tresca::Tresca;
pub use von_mises::VonMises;

/// Every model a case can name.
pub const MODELS: &[Kind] =
    &[linear_elastic::KIND, mohr_coulomb::KIND, tresca::KIND, von_mises::KIND, softening_tresca::KIND, cam_clay::KIND];
