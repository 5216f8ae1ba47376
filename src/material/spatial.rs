//! From the elastic trial left Cauchy–Green tensor to Kirchhoff stress and spatial tangent: what takes a
//! model from principal axes to the grid.
//!
//! With `b = ΔF b_n ΔFᵀ` and the velocity-like gradient `l = δF F⁻¹`, `δb = l b + b lᵀ`, the stress changes
//! by `δτ_ij = C_ijkl l_kl` where, in the axes of `b` with roots `λ_A`,
//! `C_AABB = ∂τ_A/∂ε_B`, `C_ABAB = κ λ_B`, `C_ABBA = κ λ_A`, `κ = (τ_A − τ_B)/(λ_A − λ_B)` (A ≠ B), and the
//! internal force `f_I = V0 τ·∇N_I` by `δf_Ii = V0 N_I,j a_ijkl l_kl`, `a_ijkl = C_ijkl − τ_il δ_jk`
//! (Simo & Hughes, *Computational Inelasticity*, 1998, §8.3, §9.3; de Souza Neto et al., *Computational
//! Methods for Plasticity*, 2008, §14.5, appendix A).
//!
//! For equal roots `κ = (C_AA − C_AB − C_BA + C_BB)/(4λ)`. Here `κ` is split into the secant modulus
//! `(τ_A − τ_B)/(ε_A − ε_B)`, exactly 2G in elasticity, and `(ε_A − ε_B)/(λ_A − λ_B)`, which is smooth.

pub use super::model::{SolidTangent, Spatial};
use super::{Model, Response, State, spectral};
use crate::tensor::Symmetric;

/// Hencky strains closer than this count as equal in the secant modulus of a yielding point. Above it
/// rounding of the stress difference leaves 1e-9 of the stress in the modulus; below it the modulus, even
/// in the strain difference, is its limit to 1e-14.
const EQUAL: f64 = 1e-7;

/// Components of a plane gradient in the order of [`PlaneTangent`]: xx, xy, yx, yy, zz.
pub const PLANE: usize = 5;

/// The tangent `a_ijkl` (kPa) in the plane: row (i, j), column (k, l) in the order xx, xy, yx, yy, zz.
///
/// With `g_Ij = N_I,j` the stiffness between nodes is `K_IiJk = V0 Σ_jl g_Ij a_(ij)(kl) g_Jl`; the last row
/// and column are the hoop, with `N_I/r` for the gradient and the component x for i.
pub type PlaneTangent = [[f64; PLANE]; PLANE];

/// The response at a point seeded at height `y` (m) in plane strain or axisymmetry to the elastic trial
/// left Cauchy–Green tensor `trial`, whose components yz and xz are taken as zero. The internal variables at the end of the step
/// go into `internal`, which is as long as those of the state.
///
/// `None` where `trial` is not positive definite and finite: the step was too large.
pub fn plane(
    model: &dyn Model,
    y: f64,
    trial: &Symmetric,
    state: &State,
    internal: &mut [f64],
) -> Option<Spatial<PlaneTangent>> {
    begin(model, y, state, internal);
    let b = spectral::Plane::of(trial);
    let roots = b.roots();
    if !roots.iter().all(|&x| x > 0.0 && x.is_finite()) {
        return None;
    }
    let strain = roots.map(|x| 0.5 * x.ln());
    let r = model.respond(y, &strain, state, internal);
    let kirchhoff = b.with_roots(&r.stress);
    let elastic = if r.yielding { b.with_roots(&r.elastic_strain.map(|e| (2.0 * e).exp())) } else { *trial };
    let tangent = plane_tangent(&b, &strain, &stiffened(model, y, &strain, state, &r), &kirchhoff);
    Some(Spatial { kirchhoff, elastic, tangent, plastic_strain: r.plastic_strain, yielding: r.yielding })
}

/// The internal variables as a step begins.
#[inline]
fn begin(model: &dyn Model, y: f64, state: &State, internal: &mut [f64]) {
    if internal.is_empty() {
        return;
    }
    if state.internal.is_empty() {
        model.begin(y, internal);
    } else {
        internal.copy_from_slice(state.internal);
    }
}

/// A response with the tangents of `τ + θ C ε`, the modulus of turning among them, where the state wants a part `θ` of the elastic stiffness added to what
/// a point of soil with friction has left as it yields.
#[inline]
fn stiffened(model: &dyn Model, y: f64, strain: &[f64; 3], state: &State, r: &Response) -> Response {
    let mut response = *r;
    if state.stiffening > 0.0 && r.yielding && model.has_friction() {
        let moduli = model.elasticity().at(y);
        let (stress, tangent) = (moduli.stress(strain), moduli.tangent());
        for i in 0..3 {
            response.stress[i] += state.stiffening * stress[i];
            for j in 0..3 {
                response.tangent[i][j] += state.stiffening * tangent[i][j];
            }
        }
    }
    response
}

/// In the plane, with I the identity, S as in [`spectral::Plane`], its quarter turn T = [[-s, c], [c, s]] and
/// W = [[0, 1], [-1, 0]]: the axes' dyads are (I ± S)/2 and (T ± W)/2, so that `C` becomes a sum of products
/// of I, S and z for the normal part and `κ T ⊗ (mean T − radius W)` for the shear part.
#[inline]
fn plane_tangent(b: &spectral::Plane, strain: &[f64; 3], r: &Response, t: &Symmetric) -> PlaneTangent {
    let d = &r.tangent;
    let ii = 0.25 * (d[0][0] + d[0][1] + d[1][0] + d[1][1]);
    let is = 0.25 * (d[0][0] - d[0][1] + d[1][0] - d[1][1]);
    let si = 0.25 * (d[0][0] + d[0][1] - d[1][0] - d[1][1]);
    let ss = 0.25 * (d[0][0] - d[0][1] - d[1][0] + d[1][1]);
    let (iz, sz) = (0.5 * (d[0][2] + d[1][2]), 0.5 * (d[0][2] - d[1][2]));
    let (zi, zs) = (0.5 * (d[2][0] + d[2][1]), 0.5 * (d[2][0] - d[2][1]));

    // κ·mean = secant · (ε₁ − ε₂)/(2x), x = radius/mean, since λ₁ − λ₂ = 2·radius.
    let x = b.radius / b.mean;
    let tt = 0.5 * secant(r, strain, 0, 1) * spectral::half_log_ratio(x, strain[0] - strain[1]);
    let tw = -x * tt;

    let (c, s) = (b.c, b.s);
    let unit = [1.0, 0.0, 0.0, 1.0];
    let axes = [c, s, s, -c];
    let turned = [-s, c, c, s];
    let spin = [0.0, 1.0, -1.0, 0.0];
    let mut a = [[0.0; PLANE]; PLANE];
    for (row, a) in a.iter_mut().take(4).enumerate() {
        let (u, v, w) = (unit[row], axes[row], turned[row]);
        let (on_unit, on_axes) = (ii * u + si * v, is * u + ss * v);
        let (on_turned, on_spin) = (tt * w, tw * w);
        for col in 0..4 {
            a[col] = on_unit * unit[col] + on_axes * axes[col] + on_turned * turned[col] + on_spin * spin[col];
        }
        a[4] = iz * u + sz * v;
    }
    for col in 0..4 {
        a[4][col] = zi * unit[col] + zs * axes[col];
    }
    a[4][4] = d[2][2];

    // − τ_il δ_jk: (ij)(jl) for every i, j, l in the plane, and the hoop.
    let (xx, yy, xy) = (t[0], t[1], t[3]);
    a[0][0] -= xx;
    a[0][1] -= xy;
    a[1][2] -= xx;
    a[1][3] -= xy;
    a[2][0] -= xy;
    a[2][1] -= yy;
    a[3][2] -= xy;
    a[3][3] -= yy;
    a[4][4] -= t[2];
    a
}

/// As [`plane`], in three dimensions.
pub fn solid(
    model: &dyn Model,
    y: f64,
    trial: &Symmetric,
    state: &State,
    internal: &mut [f64],
) -> Option<Spatial<SolidTangent>> {
    begin(model, y, state, internal);
    if !trial.iter().all(|x| x.is_finite()) {
        return None;
    }
    let (roots, axes) = spectral::solid(trial);
    if !roots.iter().all(|&x| x > 0.0) {
        return None;
    }
    let strain = roots.map(|x| 0.5 * x.ln());
    let r = model.respond(y, &strain, state, internal);
    let kirchhoff = spectral::compose(&r.stress, &axes);
    let elastic =
        if r.yielding { spectral::compose(&r.elastic_strain.map(|e| (2.0 * e).exp()), &axes) } else { *trial };

    let acting = stiffened(model, y, &strain, state, &r);
    // C in the axes of b, as its non-zero blocks, turned one dyad at a time.
    let dyad = |p: usize, q: usize| -> [f64; 9] { std::array::from_fn(|n| axes[(n / 3, p)] * axes[(n % 3, q)]) };
    let mut tangent = [[0.0; 9]; 9];
    let mut add = |factor: f64, left: &[f64; 9], right: &[f64; 9]| {
        for (row, l) in tangent.iter_mut().zip(left) {
            for (entry, r) in row.iter_mut().zip(right) {
                *entry += factor * l * r;
            }
        }
    };
    for p in 0..3 {
        for q in 0..3 {
            if p == q {
                add(acting.tangent[p][p], &dyad(p, p), &dyad(p, p));
                continue;
            }
            add(acting.tangent[p][q], &dyad(p, p), &dyad(q, q));
            let (sum, difference) = (roots[p] + roots[q], roots[p] - roots[q]);
            let kappa = secant(&acting, &strain, p, q)
                * spectral::half_log_ratio(difference / sum, strain[p] - strain[q])
                / sum;
            add(kappa * roots[q], &dyad(p, q), &dyad(p, q));
            add(kappa * roots[p], &dyad(p, q), &dyad(q, p));
        }
    }
    let t = crate::tensor::full(&kirchhoff);
    for i in 0..3 {
        for j in 0..3 {
            for l in 0..3 {
                tangent[3 * i + j][3 * j + l] -= t[(i, l)];
            }
        }
    }
    Some(Spatial { kirchhoff, elastic, tangent, plastic_strain: r.plastic_strain, yielding: r.yielding })
}

/// The elastic left Cauchy–Green tensor `exp 2ε` that carries the Kirchhoff stress (kPa), without a check of
/// yield: how an initial stress enters.
pub fn elastic_from_stress(model: &dyn Model, y: f64, kirchhoff: &Symmetric) -> Symmetric {
    spectral::map_roots(kirchhoff, |t| model.elastic_strain(y, t).map(|e| (2.0 * e).exp()))
}

/// `(τ_A − τ_B)/(ε_A − ε_B)`, ε the trial strains.
#[inline]
fn secant(r: &Response, strain: &[f64; 3], a: usize, b: usize) -> f64 {
    let difference = strain[a] - strain[b];
    if !r.yielding || difference.abs() < EQUAL {
        0.5 * (r.tangent[a][a] - r.tangent[a][b] - r.tangent[b][a] + r.tangent[b][b])
    } else {
        (r.stress[a] - r.stress[b]) / difference
    }
}
