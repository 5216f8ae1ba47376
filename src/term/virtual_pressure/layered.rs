//! Cells in which the pressure bends, integrated in layers above and below the level of the water.

use super::place::{Acting, Place, inside_out, invert};
use crate::error::Result;
use crate::interpolation::CellPoints;
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh;
use crate::mesh::shape::{self, MAX_NODES};
use crate::surface::{Triangles, visit_layers};
use crate::system::Local;
use crate::tensor::Tensor;
use crate::term::hydrostatic::{Momentary, MomentaryPhreatic};
use crate::term::{Frame, Trial};

/// A cell is integrated in layers if the volume of its points over that of its part in the material is between this and its inverse. Where the part is a
/// sliver, its points stand for material beside it, and it does not tell where they are.
const LEAST_SHARE: f64 = 0.5;

/// The band over which the pressure is rounded at the water level, over the height of a cell (-), where the surface within the cells is known: what
/// moves by more than the band in a step has the force of the wrong side until the next one.
const BAND: f64 = 0.005;
/// Its least value over the largest (-); what of a cell is less than this above or below the level is left out.
const LEAST_BAND: f64 = 0.25;

/// A cell where pressures bend, summed over places of its own.
pub struct Layered<'a, const D: usize> {
    level_set: [f64; MAX_NODES],
    /// The heights (m) of the nodes at the last converged step: places do not move in Newton's method. Below a line where nothing but the
    /// pressure in the pores bends, those above it.
    height: [f64; MAX_NODES],
    /// The heights (m) that layers end at.
    breaks: Vec<f64>,
    /// The nodes (m) in the configuration of the grid.
    x: [[f64; D]; MAX_NODES],
    frame: &'a Frame<'a, D>,
    cell: usize,
    acting: Acting<'a>,
    /// The volume of the points over that of the active part.
    scale: f64,
}

impl<'a, const D: usize> Layered<'a, D> {
    /// That of a cell, which is `full` of material or not, given which points have pores; what acts on its points where they do: where
    /// nothing bends, or nothing is known of the surface.
    pub fn of<K: Kinematics<D>>(
        full: bool,
        porous: impl Fn(usize) -> bool,
        frame: &'a Frame<D>,
        trial: &Trial<D>,
        cell_points: &CellPoints,
        acting: Acting<'a>,
    ) -> std::result::Result<Self, Acting<'a>> {
        if (frame.level_set.is_empty() && !full)
            || frame.interpolation.extension.is_some()
            || frame.interpolation.support.is_some()
        {
            return Err(acting);
        }
        let cell = cell_points.cell as usize;
        let nodes = frame.mesh.cells.nodes(cell);
        let place = |n: u32| {
            let (at, moved) = (&frame.mesh.nodes[n as usize], &trial.converged[n as usize]);
            [at[0] + moved[0], mesh::height(at) + mesh::height(moved)]
        };
        let heights = |of: &dyn Fn([f64; 2]) -> f64| {
            let mut height = [0.0; MAX_NODES];
            height.iter_mut().zip(nodes).for_each(|(height, &n)| *height = of(place(n)));
            height
        };
        let [outer, inner] =
            [heights(&|x| x[1]), heights(&|[x, y]| acting.inside.map_or(y, |inside| inside.height(x, y)))];
        // The band does not leave the cell: one beside it, or air, would not have its part.
        let narrow = |height: &[f64; MAX_NODES], head: Momentary| {
            let own = || height[..nodes.len()].iter().copied();
            let [low, high] = [own().fold(f64::INFINITY, f64::min), own().fold(f64::NEG_INFINITY, f64::max)];
            let (most, within) = (BAND * (high - low), (high - head.datum).min(head.datum - low));
            let bends = head.gradient != 0.0 && within > LEAST_BAND * most;
            (Momentary { band: within.clamp(LEAST_BAND * most, most), ..head }, bends)
        };
        let outside = acting.outside.map(|head| narrow(&outer, head));
        let inside = acting.inside.map(|inside| (inside, narrow(&inner, inside.head)));
        let narrow = Acting {
            outside: outside.map(|(head, _)| head),
            inside: inside.map(|(inside, (head, _))| MomentaryPhreatic { head, ..inside }),
        };
        let bends = |head: Option<(Momentary, bool)>| head.is_some_and(|(_, bends)| bends);
        if !bends(outside) && !bends(inside.map(|(_, head)| head)) {
            return Err(narrow);
        }
        // Where the surface of the water outside is in the cell, the layers are its own.
        let inclined = acting.inside.is_some_and(|inside| inside.is_inclined());
        let by_line = inclined && !bends(outside);
        let height = if by_line { inner } else { outer };
        let outside = narrow.outside.filter(|_| !by_line);
        let inside = narrow.inside.filter(|_| by_line || !inclined).map(|inside| inside.head);
        let mut breaks: Vec<f64> = [outside, inside].iter().flatten().flat_map(Momentary::breaks).collect();
        breaks.sort_by(f64::total_cmp);
        let mut porous = frame.interpolation.points(cell_points).iter().map(|&p| porous(p as usize));
        let first = porous.next().ok_or(acting)?;
        if porous.any(|other| other != first) {
            return Err(acting);
        }
        let mut layered = Self {
            level_set: [0.0; MAX_NODES],
            height,
            breaks,
            x: frame.mesh.coordinates(cell),
            frame,
            cell,
            acting: narrow.on(first),
            scale: 1.0,
        };
        for (i, &n) in nodes.iter().enumerate() {
            layered.level_set[i] = if full { 1.0 } else { frame.level_set[n as usize] };
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

    /// Adds force and tangent.
    pub fn add<K: Kinematics<D>>(&self, trial: &Trial<D>, now: &[[f64; D]], local: &mut Local) -> Result<()> {
        let acting = self.acting.map(|head| Momentary { top: 0.0, ..head });
        let mut inverted = None;
        self.visit::<K>(&self.breaks, |value, gradient, volume| {
            let sum = |of: &dyn Fn(usize) -> f64| value.iter().enumerate().map(|(i, n)| n * of(i)).sum();
            let x = sum(&|i| self.x[i][0] + now[i][0]);
            let y = sum(&|i| mesh::height(&self.x[i]) + mesh::height(&now[i]));
            let Some(pressures) = acting.at([x, y]) else { return };
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
