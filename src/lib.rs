//! Implicit second-order Material Point Method for geotechnics, from a Gmsh `.geo` file to ParaView.
//!
//! # Where things are
//!
//! A module imports from its own layer and lower ones only; `tests/architecture` keeps it so.
//!
//! | layer | modules | what |
//! |---|---|---|
//! | 0 | [`error`], [`expression`], [`tensor`], [`geometry`], [`time_value`], [`gravity`], [`water_table`], [`time_integration`], [`profile`], [`program`], [`machine`], [`reading`] | errors and exit status; formulas; the order of tensor components; places, lines and polygons; values in time; gravity in a phase; the water table; generalised-α; time by activity; which program this is; what the machine has; how files are opened |
//! | 1 | [`mesh`], [`material`] | cells and shape functions, Gmsh, location of points; stress and tangent of a point |
//! | 2 | [`points`], [`seed`], [`kinematics`], [`surface`], [`rigid`], [`contact`], [`quadrature`], [`interpolation`], [`system`], [`dofs`] | the material points and how cells are filled with them; plane strain, axisymmetry and three dimensions; where the material ends; bodies that keep their shape; how structures touch soil; what the points weigh in integrals; what a point sees of the grid; sparse systems and their solution; the map of unknowns |
//! | 3 | [`term`], [`soil`] | the terms of the equations of motion, each with its residual and tangent; the soil as a body with continuous fields, for pictures |
//! | 4 | [`step`], [`io`], [`run`], [`draw`] | the time step (**read this first**); files; a run from the first state or a checkpoint to the end; pictures |
//! | 5 | [`case`], [`report`] | from `case.yaml` to a scene: the only place that decides which terms exist; a page on a run |
//! | 6 | [`cli`] | the commands |
//!
//! `docs/code-tour.md` follows the data from a `.geo` to ParaView; `docs/theory.md` has the equations that
//! the sources refer to.
//!
//! # Symbols
//!
//! Fields are named in words; locals in formulas are the symbols of the theory. Units are kN, m, s, t.
//! Stress and strain are positive in tension.
//!
//! | symbol | in code | meaning |
//! |---|---|---|
//! | x, X | `position`, `origin` | place of a point now and when it was seeded (m) |
//! | u | `displacement`, `u` | displacement of the nodes since the grid was restored (m) |
//! | v, a | `velocity`, `acceleration` | (m/s), (m/s²) |
//! | N, ∇N | `value`, `gradient` of [`interpolation::Entries`] | shape functions at a point (-), (1/m) |
//! | F | `deformation` | deformation gradient of a point since it was seeded (-) |
//! | ΔF | `increment` | that of a step (-) |
//! | J | `volume_ratio` | det F (-) |
//! | b | `elastic` | elastic left Cauchy–Green tensor (-) |
//! | ε_A | `strain` | principal Hencky strains ½ ln λ_A (-) |
//! | τ | `kirchhoff` | Kirchhoff stress (kPa) |
//! | σ | `stress` | Cauchy stress τ/J (kPa) |
//! | C, a | `tangent` | material tangent, spatial tangent (kPa) |
//! | V₀, m | `initial_volume`, `mass` | volume when seeded (m³) and mass (t), per metre or per full turn |
//! | Δt | `dt` | size of the step (s) |
//! | α_m, α_f, β, γ, ρ∞ | of [`time_integration::GeneralisedAlpha`] | generalised-α (-) |
//! | W, A | `w`, `a` of [`term::Internal`] | stress within a dynamic step, and where it acts |
//! | ε E, 1 − fill | `stiffness`, `emptiness` | soft stiffness (kPa) and emptiness (-) of a cell |
//! | s_u, c, φ, ψ, σ_t | of [`material`] | strengths (kPa), angles (°), tension cut-off (kPa) |

pub mod case;
pub mod cli;
pub mod contact;
pub mod dofs;
pub mod draw;
pub mod error;
pub mod expression;
pub mod geometry;
pub mod gravity;
pub mod interpolation;
pub mod io;
pub mod kinematics;
pub mod machine;
pub mod material;
pub mod mesh;
pub mod points;
pub mod profile;
pub mod program;
pub mod quadrature;
pub mod reading;
pub mod report;
pub mod rigid;
pub mod run;
pub mod seed;
pub mod soil;
pub mod step;
pub mod surface;
pub mod system;
pub mod tensor;
pub mod term;
pub mod time_integration;
pub mod time_value;
pub mod water_table;
