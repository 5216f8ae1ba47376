//! A pressure on the whole boundary of the material, as the work it does in the material (reference 1 of docs/theory.md, §2.5): by the theorem of
//! Gauss, `−∮ p N_I n dS = −∫ (p ∇N_I + N_I ∇p) dV`, so that
//!
//! `R_I = Σ_p w_p J_p (p ∇_x N_I + N_I ∇p)` at the places of the points in the trial state.
//!
//! The weights are those of the internal force: material with the stress `−p 1` and the weight `∇p` is in balance to
//! rounding wherever its points lie and however jagged its surface. Where regions of the material meet, and where it
//! meets finite elements with the same pressure on them, it cancels; on a wall it presses on the support.
//! A pressure in space alone has a potential, and the tangent is symmetric.
//!
//! In cells where the pressure bends, the points integrate its growth as a polynomial, which it is not. Where the surface is
//! known within the cells the growth is summed there over places of its own ([`visit_layers`]), with the volume of the points.
//!
//! Water in the pores has the pressure `u` in space inside of the material, whose models answer for the effective stress `σ + u 1`: it takes
//! `u ∇_x N_I` away, and where it is the water outside nothing is left but the buoyancy `N_I ∇p`. Its volume is that of the soil and not
//! kept, so that the tangent is not symmetric.

use super::extended::{Kept, scatter_functions};
use super::hydrostatic::{Hydrostatic, Momentary};
use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::{Error, Result};
use crate::interpolation::{CellPoints, MAX_FUNCTIONS};
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh;
use crate::mesh::shape::{self, MAX_NODES};
use crate::surface::{Triangles, visit_layers};
use crate::system::Local;
use crate::tensor::Tensor;
use std::marker::PhantomData;

/// A cell is integrated in layers if the volume of its points over that of its part in the material is between this and its inverse. Where the part is a
/// sliver, its points stand for material beside it, and it does not tell where they are.
const LEAST_SHARE: f64 = 0.5;

/// The band over which the pressure is rounded at the water level, over the height of a cell (-), where the surface within the cells is known: what
/// moves by more than the band in a step has the force of the wrong side until the next one.
const BAND: f64 = 0.005;
/// Its least value over the largest (-); what of a cell is less than this above or below the level is left out.
const LEAST_BAND: f64 = 0.25;

/// A pressure on the boundary of all material points.
pub struct VirtualPressure<K> {
    /// What acts from outside in each phase.
    heads: Vec<Option<Hydrostatic>>,
    /// What acts in the pores in each phase, and whether each material by number has such pores; both empty without.
    inside: Vec<Option<Hydrostatic>>,
    porous: Vec<bool>,
    /// Whether the cells are full of material, as finite elements are.
    full: bool,
    kinematics: PhantomData<K>,
}

impl<K> VirtualPressure<K> {
    /// `heads[i]` acts in phase `i`.
    pub fn new(heads: Vec<Option<Hydrostatic>>) -> Self {
        Self { heads, inside: Vec::new(), porous: Vec::new(), full: false, kinematics: PhantomData }
    }

    /// With water in the pores: `inside[i]` in phase `i`, in material `m` ([`crate::points::Points::model_of`]) where `porous[m]`.
    pub fn with_pores(self, inside: Vec<Option<Hydrostatic>>, porous: Vec<bool>) -> Self {
        Self { inside, porous, ..self }
    }

    /// In cells that are full of material.
    pub fn in_full_cells(self) -> Self {
        Self { full: true, ..self }
    }
}

/// What acts at one time.
#[derive(Clone, Copy)]
struct Acting {
    outside: Option<Momentary>,
    inside: Option<Momentary>,
}

/// The pressures (kPa) at a place, by its height.
struct Pressures {
    /// The slope of that outside, and its slope (kPa/m, kPa/m²).
    slope: f64,
    second: f64,
    /// What is left of it in the material beside that in the pores, and the slope of that.
    left: f64,
    left_slope: f64,
}

impl Acting {
    /// That which acts on material with or without pores.
    fn on(self, porous: bool) -> Self {
        Self { inside: self.inside.filter(|_| porous), ..self }
    }

    fn map(self, to: impl Fn(Momentary) -> Momentary) -> Self {
        Self { outside: self.outside.map(&to), inside: self.inside.map(&to) }
    }

    /// That at height `y` (m); `None` where there is nothing.
    fn at(self, y: f64) -> Option<Pressures> {
        let at = |head: Option<Momentary>| head.map_or([0.0; 3], |head| head.at(y));
        let ([p, slope, second], [u, growth, _]) = (at(self.outside), at(self.inside));
        let nothing = [p, slope, u, growth] == [0.0; 4];
        (!nothing).then_some(Pressures { slope, second, left: p - u, left_slope: slope - growth })
    }
}

/// A place over which the term is summed.
struct Place<'a, const D: usize> {
    /// The values of functions at the nodes, and the gradients of all, in the configuration of the grid.
    value: &'a [f64],
    gradient: &'a [Gradient<D>],
    /// The inverse of the deformation of the grid there by these gradients.
    inverse: Tensor,
    /// The gradients that strains are taken with and the inverse by them, where these are others.
    strained: Option<(&'a [Gradient<D>], Tensor)>,
    /// The volume (m³) in the trial state.
    volume: f64,
    pressures: Pressures,
}

impl<const D: usize> Place<'_, D> {
    /// Adds the force, and the tangent by `share` of the displacement.
    fn add<K: Kinematics<D>>(&self, share: f64, local: &mut Local) {
        let Self { volume, pressures: Pressures { slope, second, left, left_slope }, .. } = *self;
        let count = self.gradient.len();
        let mut spatial = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_FUNCTIONS];
        let mut divergence = [[0.0; D]; MAX_FUNCTIONS];
        for i in 0..count {
            spatial[i] = K::push_forward(&self.gradient[i], &self.inverse);
            divergence[i] = K::force(&Tensor::identity(), &spatial[i]);
        }
        let swollen: Option<Vec<[f64; D]>> = self.strained.map(|(gradients, inverse)| {
            let strains = gradients.iter().map(|gradient| K::push_forward(gradient, &inverse));
            strains.map(|strain| K::force(&Tensor::identity(), &strain)).collect()
        });
        let value = |i: usize| self.value.get(i).copied().unwrap_or(0.0);
        for i in 0..count {
            for d in 0..D {
                local.vector[i * D + d] += volume * left * divergence[i][d];
            }
            local.vector[i * D + 1] += volume * slope * value(i);
        }
        if local.matrix.is_empty() {
            return;
        }
        let weight = share * volume;
        for i in 0..count {
            for j in 0..count {
                let (a, b, size) = (&spatial[i], &spatial[j], local.size);
                let swelling = swollen.as_ref().map_or(&divergence[j], |swollen| &swollen[j]);
                for d in 0..D {
                    for e in 0..D {
                        let mut entry = left * (divergence[i][d] * swelling[e] - a.g[e] * b.g[d]);
                        if d == 0 && e == 0 {
                            entry -= left * a.hoop * b.hoop;
                        }
                        if e == 1 {
                            entry += left_slope * divergence[i][d] * value(j);
                        }
                        if d == 1 {
                            entry += slope * value(i) * swelling[e];
                        }
                        if d == 1 && e == 1 {
                            entry += second * value(i) * value(j);
                        }
                        local.matrix[(i * D + d) * size + j * D + e] += weight * entry;
                    }
                }
            }
        }
    }
}

/// A cell where pressures bend, summed over places of its own.
struct Layered<'a, const D: usize> {
    level_set: [f64; MAX_NODES],
    /// The heights (m) of the nodes at the last converged step: places do not move in Newton's method.
    height: [f64; MAX_NODES],
    /// The nodes (m) in the configuration of the grid.
    x: [[f64; D]; MAX_NODES],
    frame: &'a Frame<'a, D>,
    cell: usize,
    acting: Acting,
    /// The volume of the points over that of the active part.
    scale: f64,
}

impl<'a, const D: usize> Layered<'a, D> {
    /// That of a cell; what acts on its points where they do: where nothing bends, or nothing is known of the surface.
    fn of<K: Kinematics<D>>(
        term: &VirtualPressure<K>,
        frame: &'a Frame<D>,
        trial: &Trial<D>,
        cell_points: &CellPoints,
        acting: Acting,
    ) -> std::result::Result<Self, Acting> {
        if (frame.level_set.is_empty() && !term.full)
            || frame.interpolation.extension.is_some()
            || frame.interpolation.support.is_some()
        {
            return Err(acting);
        }
        let cell = cell_points.cell as usize;
        let nodes = frame.mesh.cells.nodes(cell);
        let mut height = [0.0; MAX_NODES];
        for (height, &n) in height.iter_mut().zip(nodes) {
            *height = mesh::height(&frame.mesh.nodes[n as usize]) + mesh::height(&trial.converged[n as usize]);
        }
        let own = &height[..nodes.len()];
        let [low, high] =
            [own.iter().copied().fold(f64::INFINITY, f64::min), own.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
        // The band does not leave the cell: one beside it, or air, would not have its part.
        let most = BAND * (high - low);
        let within = |head: &Momentary| (high - head.datum).min(head.datum - low);
        let narrow = acting.map(|head| Momentary { band: within(&head).clamp(LEAST_BAND * most, most), ..head });
        let bends = |head: &Momentary| head.gradient != 0.0 && within(head) > LEAST_BAND * most;
        if ![narrow.outside, narrow.inside].iter().flatten().any(bends) {
            return Err(narrow);
        }
        let mut porous = frame.interpolation.points(cell_points).iter().map(|&p| term.porous_at(frame, p as usize));
        let first = porous.next().ok_or(acting)?;
        if porous.any(|other| other != first) {
            return Err(acting);
        }
        let mut layered = Self {
            level_set: [0.0; MAX_NODES],
            height,
            x: frame.mesh.coordinates(cell),
            frame,
            cell,
            acting: narrow.on(first),
            scale: 1.0,
        };
        for (i, &n) in nodes.iter().enumerate() {
            layered.level_set[i] = if term.full { 1.0 } else { frame.level_set[n as usize] };
        }
        if layered.level_set.iter().all(|&value| value >= 0.0) {
            // Full, as [`crate::surface::Filling`] has it: triangles with all corners on the surface belong to it.
            layered.level_set = [1.0; MAX_NODES];
        }
        let before = frame.interpolation.gather(frame.mesh, cell_points, trial.converged);
        let of_points: f64 = frame
            .interpolation
            .entries::<K>(cell_points)
            .map(|entries| {
                let known = entries.deformation::<K>(&before);
                entries.weight * frame.points.deformation[entries.point].determinant() / known.determinant()
            })
            .sum();
        let mut active = 0.0;
        layered.visit::<K>(&[], |_, _, volume| active += volume);
        layered.scale = of_points / active;
        (LEAST_SHARE..1.0 / LEAST_SHARE).contains(&layered.scale).then_some(layered).ok_or(acting)
    }

    /// Calls `place` with the values, the gradients and the volume (m³) of the places in the configuration of the grid.
    fn visit<K: Kinematics<D>>(&self, breaks: &[f64], mut place: impl FnMut(&[f64], &[Gradient<D>], f64)) {
        let kind = self.frame.mesh.cells.kind[self.cell];
        let count = kind.node_count();
        let (mut n, mut slope) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
        let mut gradient = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_NODES];
        let nodes = self.x.map(|x| [x[0], x[1]]);
        let split = Triangles::of(kind, &nodes[..count]);
        visit_layers(&split, &self.level_set[..count], &self.height[..count], breaks, |xi, weight| {
            let det = shape::map(kind, &self.x[..count], xi, &mut n, &mut slope);
            let area = if split.in_space() { weight } else { weight * det };
            let mut x = [0.0; D];
            for (n, node) in n.iter().zip(&self.x[..count]) {
                (0..D).for_each(|d| x[d] += n * node[d]);
            }
            for i in 0..count {
                gradient[i] = Gradient { g: slope[i], hoop: if K::HOOP { n[i] / x[0] } else { 0.0 } };
            }
            place(&n[..count], &gradient[..count], area * K::measure(&x));
        });
    }

    fn add<K: Kinematics<D>>(&self, trial: &Trial<D>, now: &[[f64; D]], local: &mut Local) -> Result<()> {
        let breaks =
            [self.acting.outside, self.acting.inside].map(|head| head.map_or([f64::INFINITY; 2], |h| h.breaks()));
        let mut breaks = [breaks[0][0], breaks[0][1], breaks[1][0], breaks[1][1]];
        breaks.sort_by(f64::total_cmp);
        let acting = self.acting.map(|head| Momentary { top: 0.0, ..head });
        let mut inverted = None;
        self.visit::<K>(&breaks, |value, gradient, volume| {
            let y: f64 =
                value.iter().enumerate().map(|(i, n)| n * (mesh::height(&self.x[i]) + mesh::height(&now[i]))).sum();
            let Some(pressures) = acting.at(y) else { return };
            let mut deformed = Tensor::identity();
            for (i, gradient) in gradient.iter().enumerate() {
                K::deform(&mut deformed, &now[i], gradient);
            }
            match invert(&deformed) {
                Ok((inverse, ratio)) => {
                    let volume = self.scale * volume * ratio;
                    Place { value, gradient, inverse, strained: None, volume, pressures }
                        .add::<K>(1.0 - trial.alpha_f, local);
                }
                Err(determinant) => inverted = Some(determinant),
            }
        });
        inverted.map_or(Ok(()), |determinant| Err(inside_out(format!("cell {}", self.cell), determinant)))
    }
}

/// The inverse and the determinant of a deformation; an error where the latter is not positive.
fn invert(deformed: &Tensor) -> std::result::Result<(Tensor, f64), f64> {
    let determinant = deformed.determinant();
    let inverse = deformed.try_inverse().filter(|_| determinant > 0.0);
    inverse.map(|inverse| (inverse, determinant)).ok_or(determinant)
}

fn inside_out(what: String, determinant: f64) -> Error {
    Error::analysis(
        what,
        format!("is turned inside out (det F {determinant:.3})"),
        "take smaller steps or refine the mesh",
    )
}

impl<K> VirtualPressure<K> {
    fn porous_at<const D: usize>(&self, frame: &Frame<D>, point: usize) -> bool {
        self.porous.get(frame.points.model_of(point)).copied().unwrap_or(false)
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for VirtualPressure<K> {
    fn source(&self) -> Source {
        Source::Water
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn symmetric(&self) -> bool {
        self.inside.iter().all(Option::is_none)
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let [outside, inside] = [&self.heads, &self.inside]
            .map(|heads| heads.get(trial.phase).and_then(Option::as_ref).map(|head| head.at(trial.time)));
        if outside.is_none() && inside.is_none() {
            return Ok(());
        }
        let acting = Acting { outside, inside };
        let compute = |cell_points: &CellPoints, local: &mut Local, _: &mut [f64]| {
            let now = frame.interpolation.gather(frame.mesh, cell_points, trial.between);
            let before = frame.interpolation.gather(frame.mesh, cell_points, trial.converged);
            let nodes = frame.interpolation.nodes(frame.mesh, cell_points.cell);
            let by_points = match Layered::of(self, frame, trial, cell_points, acting) {
                Ok(layered) => {
                    layered.add::<K>(trial, &now, local)?;
                    acting.map(|head| Momentary { gradient: 0.0, ..head })
                }
                Err(acting) => acting,
            };
            for entries in frame.interpolation.entries::<K>(cell_points) {
                let height = |(n, &node): (&f64, &u32)| {
                    n * (mesh::height(&frame.mesh.nodes[node as usize]) + mesh::height(&trial.between[node as usize]))
                };
                let y = entries.value.iter().zip(nodes).map(height).sum();
                let porous = self.porous_at(frame, entries.point);
                let Some(pressures) = by_points.on(porous).at(y) else { continue };
                let [deformed, known] = [&now, &before].map(|u| entries.deformation::<K>(u));
                let count = entries.functions();
                let mut gradient = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_FUNCTIONS];
                (0..count).for_each(|i| gradient[i] = entries.gradient(i));
                let (inverse, determinant) = invert(&deformed)
                    .map_err(|determinant| inside_out(frame.points.name(entries.point), determinant))?;
                let ratio = determinant / known.determinant();
                let volume = entries.weight * ratio * frame.points.deformation[entries.point].determinant();
                let mut place = Place {
                    value: entries.value,
                    gradient: &gradient[..count],
                    inverse,
                    strained: None,
                    volume,
                    pressures,
                };
                let strains: Vec<_>;
                if entries.strains_apart() {
                    strains = (0..count).map(|i| entries.strain_gradient(i)).collect();
                    let of_forces = entries.deformation_of_forces::<K>(&now);
                    place.inverse = invert(&of_forces)
                        .map_err(|determinant| inside_out(frame.points.name(entries.point), determinant))?
                        .0;
                    place.strained = Some((&strains, inverse));
                }
                place.add::<K>(1.0 - trial.alpha_f, local);
            }
            Ok(())
        };
        scatter_functions(frame, Kept::Matrix, compute, out)
    }
}
