//! The numerical method as it is written, and what it is where nothing is.

use schemars::JsonSchema;
use serde::Deserialize;

/// The numerical method.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Numerics {
    /// How gradients at the material points are formed: mpm (those of the cell), ddmp (continuous from cell to cell), bspline
    /// (B-splines of the degree that is the order of the cells, on one rectangle of Q9 or Q16 cells), or means over the domains of the
    /// points: cpdi and cpdi2 on any mesh, ugimp, cpgimp (or gimp) and composite on grids of rectangles (docs/schemes.md).
    pub gradient: String,
    /// What integrals are summed over: resampled (integration points of the cells, which take their state from the material points
    /// when the grid is restored), or points (the material points, by their volumes). Default: resampled, but points with
    /// all gradients except mpm and bspline.
    pub quadrature: Option<Quadrature>,
    /// Whether pressure unknowns carry the mean stress of nearly incompressible and undrained materials: field or none. Default: field
    /// where Poisson's ratio is 0.45 or more (in drained mohr_coulomb and cam_clay 0.495 or more) or a material is undrained, else none.
    pub pressure: Option<Pressure>,
    /// When the grid is moved back to its initial shape: every_step, never (updated Lagrangian), or by {min_quality: q, max_stretch: s}; then also where
    /// Newton's method fails.
    pub restore: Restore,
    /// Spectral radius ρ∞ of generalised-α at high frequencies: 1 conserves energy, less damps what the mesh cannot
    /// resolve (-).
    #[schemars(range(min = 0, max = 1))]
    pub spectral_radius: f64,
    /// Newton's iteration ends when the residual is this small relative to the forces; results have an error of that size (-).
    #[schemars(extend("exclusiveMinimum" = 0), extend("maximum" = 0.01))]
    pub tolerance: f64,
    /// Where sand and other soil with friction follows prescribed displacements, without inertia and under constant loads, a step that was halved
    /// twice in vain is accepted with a residual this small, and a warning says so; the next steps contain the unbalanced force (-).
    #[schemars(extend("minimum" = 0), extend("maximum" = 0.01))]
    pub acceptable_tolerance: f64,
    /// Iterations after which a step is halved; twice as many where residuals of soil with friction may rise.
    #[schemars(range(min = 1, max = 1000))]
    pub max_iterations: usize,
    /// Stiffness of empty cells over that of the stiffest soil of any phase, or in a step with inertia over that of its mass where this is less (-).
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub empty_stiffness: f64,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            gradient: "mpm".into(),
            quadrature: None,
            pressure: None,
            restore: Restore::Quality(RestoreQuality { min_quality: 0.5, max_stretch: None }),
            spectral_radius: 0.9,
            tolerance: 1e-8,
            acceptable_tolerance: 1e-3,
            max_iterations: 25,
            empty_stiffness: 1e-5,
        }
    }
}

/// What integrals are summed over.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quadrature {
    Points,
    Resampled,
}

/// Who carries the mean stress.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Pressure {
    Field,
    None,
}

/// When the grid goes back to its first shape.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Restore {
    Named(RestoreName),
    Quality(RestoreQuality),
}

/// The restorations that need no number.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RestoreName {
    EveryStep,
    Never,
}

/// Restoration by quality.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestoreQuality {
    /// The grid is restored when the quality of a cell falls below this part of its first one (-).
    #[schemars(range(min = 0, max = 1))]
    pub min_quality: f64,
    /// The grid is also restored when an edge becomes this many times longer or shorter than at first (-). Default: 1.3, and 1.5
    /// in a case with contacts.
    #[schemars(extend("exclusiveMinimum" = 1))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_stretch: Option<f64>,
}
