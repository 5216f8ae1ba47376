//! The surface of the material as a level set at the nodes of a grid.

use super::super::Restored;
use super::super::surface::{follow, largest_offset, smoothed};
use crate::kinematics::Kinematics;
use crate::mesh::Bodies;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::surface::{Contour, Distance, Geometry, HIGHEST, MarkerFront};
use crate::tensor::IDENTITY;
use rayon::prelude::*;

/// Iterations of the offset at most.
const OFFSETS: usize = 8;
/// The first offset tried, as a share of the range.
const FIRST_OFFSET: f64 = 1e-3;
/// The part (-) of the volume to which the volume within the surface is that of the material points.
const VOLUME_TOLERANCE: f64 = 1e-12;
/// Strain (-) up to which is rounding.
const STRAINED: f64 = 1e-9;

/// The surface of the material.
pub struct Surface {
    /// Its level set (m) at the nodes, positive inside.
    pub level_set: Vec<f64>,
    /// Cells with material points that are outside it.
    pub outside: Vec<bool>,
    /// Why the surface is followed no longer, where it just ceased to be.
    pub lost: Option<String>,
}

impl Surface {
    /// The surface of the material: one that is followed, else the smoothed contour of the points, or that contour.
    pub fn of<K: Kinematics<2>>(geometry: &Geometry, grid: &Restored<2>, front: &mut Option<MarkerFront>) -> Self {
        let Restored { mesh, locator, points, parametric, active, .. } = *grid;
        let lost = follow::<K>(geometry, grid, front).err().map(|lost| {
            *front = None;
            lost.to_string()
        });
        let to = |front: &MarkerFront, cells: &[u32]| {
            let mut distance = Distance::default();
            distance.update(mesh, geometry, locator, front, cells, active);
            distance.level_set
        };
        // Points that neither the surface nor the contour that it smooths reaches are outside. Where structures touch the material,
        // such points are in these, by as much as contact lets them.
        let apart = apart(mesh.cells.len(), points);
        let outside = |level_set: &[f64], within: &[u32]| {
            let mut outside = vec![false; mesh.cells.len()];
            if !grid.outlines.is_empty() {
                return outside;
            }
            points.cell.iter().for_each(|&c| outside[c as usize] = true);
            let reached = |c: usize| mesh.cells.nodes(c).iter().any(|&n| level_set[n as usize] > 0.0);
            (0..outside.len())
                .filter(|&c| reached(c))
                .chain(within.iter().map(|&c| c as usize))
                .for_each(|c| outside[c] = false);
            outside.iter_mut().zip(&apart).for_each(|(outside, apart)| *outside |= apart);
            outside
        };
        let at = |front: &MarkerFront, level_set: Vec<f64>, within: &[u32]| {
            let outside = outside(&level_set, within);
            let most = largest_offset::<K>(front, geometry, grid);
            let level_set = keep_volume::<K>(geometry, grid, [-most, most], &outside, level_set);
            Self { level_set, outside, lost: lost.clone() }
        };
        if let Some(front) = front {
            return at(front, to(front, &points.cell), &[]);
        }
        let mut contour = Contour::default();
        contour.update::<K>(mesh, geometry, points, parametric, active);
        if let Some((front, cells)) = smoothed::<K>(geometry, grid, &contour.level_set) {
            return at(&front, to(&front, &cells), &cells);
        }
        // A contour encloses the volume of all points that it is made of: those outside are not among them.
        let (mut out, mut count) = (outside(&contour.level_set, &[]), points.len());
        loop {
            let numbers: Vec<usize> = (0..points.len()).filter(|&p| !out[points.cell[p] as usize]).collect();
            if numbers.len() == count {
                let limits = [contour.level - HIGHEST, contour.level];
                let level_set = keep_volume::<K>(geometry, grid, limits, &out, contour.level_set);
                return Self { level_set, outside: out, lost };
            }
            count = numbers.len();
            let places: Vec<_> = numbers.iter().map(|&p| parametric[p]).collect();
            contour.update::<K>(mesh, geometry, &points.select(&numbers), &places, active);
            let more = outside(&contour.level_set, &[]);
            out.iter_mut().zip(more).for_each(|(out, more)| *out |= more);
        }
    }
}

/// Adds an offset within `limits` to the level set of each body such that the volume inside is that of its material points that are not
/// outside: a front that only moves with the grid would sink or rise a little in every reset. Where structures touch the
/// material, the surface is theirs and stays. What has no material point is not material: its mass would come from nowhere, and no point would
/// carry its momentum on.
fn keep_volume<K: Kinematics<2>>(
    geometry: &Geometry,
    grid: &Restored<2>,
    [least, most]: [f64; 2],
    outside: &[bool],
    level_set: Vec<f64>,
) -> Vec<f64> {
    let Restored { mesh, points, active, .. } = *grid;
    if !grid.outlines.is_empty() || most <= least {
        return level_set;
    }
    let counts = |c: u32| active[c as usize] && !outside[c as usize];
    let near = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| level_set[n as usize] > -most);
    let cells: Vec<u32> = (0..mesh.cells.len() as u32).filter(|c| counts(*c) && near(c)).collect();
    let inside = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| level_set[n as usize] > 0.0);
    let held = cells.iter().filter(|c| inside(c)).chain(&points.cell).copied().filter(|&c| counts(c));
    let bodies = Bodies::of(mesh, held, &[]);
    let body_of = |c: u32| mesh.cells.nodes(c as usize).iter().find_map(|&n| bodies.of_node(n as usize));
    let by_body = |volumes: &mut dyn Iterator<Item = (u32, f64)>| {
        let mut sums = vec![0.0; bodies.count()];
        volumes.filter(|(c, _)| counts(*c)).for_each(|(c, volume)| {
            body_of(c).into_iter().for_each(|body| sums[body] += volume);
        });
        sums
    };
    let wanted = by_body(&mut points.cell.iter().enumerate().map(|(p, &c)| (c, points.volume(p))));
    let shifted = |offsets: &[f64], n: usize| level_set[n] + bodies.of_node(n).map_or(0.0, |body| offsets[body]);
    let lacking = |offsets: &[f64]| -> Vec<f64> {
        let of_cell = |&c: &u32| {
            let mut values = [0.0; MAX_NODES];
            let nodes = mesh.cells.nodes(c as usize);
            values.iter_mut().zip(nodes).for_each(|(value, &n)| *value = shifted(offsets, n as usize));
            (c, geometry.filled::<K>(mesh, c as usize, &values[..nodes.len()]))
        };
        let volumes: Vec<(u32, f64)> = cells.par_iter().with_min_len(64).map(of_cell).collect();
        by_body(&mut volumes.into_iter()).iter().zip(&wanted).map(|(has, wanted)| wanted - has).collect()
    };
    // The secant method, body by body; a slope that is not positive is one of rounding.
    let first = FIRST_OFFSET * (most - least);
    let mut lacks = lacking(&vec![0.0; bodies.count()]);
    let shifted_first = lacking(&vec![first; bodies.count()]);
    let slopes: Vec<f64> = shifted_first.iter().zip(&lacks).map(|(then, now)| (now - then) / first).collect();
    let (mut offsets, mut now) = (vec![0.0; bodies.count()], slopes.clone());
    for _ in 0..OFFSETS {
        let next = |b: usize| {
            let has_surface = wanted[b] > 0.0 && slopes[b] > 0.0 && lacks[b].abs() > VOLUME_TOLERANCE * wanted[b];
            if has_surface { (offsets[b] + lacks[b] / now[b]).clamp(least, most) } else { offsets[b] }
        };
        let tried: Vec<f64> = (0..bodies.count()).map(next).collect();
        if tried == offsets {
            break;
        }
        for (b, then) in lacking(&tried).into_iter().enumerate() {
            let slope = (lacks[b] - then) / (tried[b] - offsets[b]);
            if slope > 0.0 && slope.is_finite() {
                now[b] = slope;
            }
            if then.abs() < lacks[b].abs() {
                (offsets[b], lacks[b]) = (tried[b], then);
            }
        }
    }
    let value = |n: usize| match bodies.of_node(n) {
        Some(body) if wanted[body] == 0.0 => level_set[n].min(0.0),
        _ => shifted(&offsets, n),
    };
    (0..level_set.len()).map(value).collect()
}

/// The cells whose material points have all come apart: without elastic strain, in more room than they were seeded in.
fn apart(cells: usize, points: &Points<2>) -> Vec<bool> {
    let (mut holds, mut bears) = (vec![false; cells], vec![false; cells]);
    for (p, &c) in points.cell.iter().enumerate() {
        let strained = points.elastic[p].iter().zip(&IDENTITY).any(|(b, one)| (b - one).abs() > STRAINED);
        holds[c as usize] = true;
        bears[c as usize] |= strained || points.deformation[p].determinant() <= 1.0 + STRAINED;
    }
    holds.iter().zip(bears).map(|(holds, bears)| *holds && !bears).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use crate::quadrature::fixture::{on_grid, undeformed};

    /// A block whose points say that it is a little larger, and a place far from it that the level set encloses without any.
    #[test]
    fn what_has_no_material_point_is_not_material() {
        let mesh = rectangle(CellKind::T6, 6.0, 1.0, 12, 2, 0.0, 1);
        let geometry = Geometry::new::<PlaneStrain>(&mesh);
        let position = (0..80).map(|k| [0.1 + 0.1 * (k % 19) as f64, 0.125 + 0.25 * (k / 20) as f64]).collect();
        let points = undeformed(&mesh, position, 2.02 / 80.0);
        let level_set: Vec<f64> =
            mesh.nodes.iter().map(|x| (2.0 - x[0]).max(0.05 - (x[0] - 5.0).hypot(x[1]))).collect();
        let far = |n: &usize| mesh.nodes[*n][0] > 3.0;
        assert!((0..level_set.len()).filter(far).any(|n| level_set[n] > 0.0));
        let outside = vec![false; mesh.cells.len()];
        let found = on_grid(&mesh, &points, |grid| {
            keep_volume::<PlaneStrain>(&geometry, grid, [-0.03, 0.03], &outside, level_set)
        });
        assert!((0..found.len()).filter(far).all(|n| found[n] <= 0.0), "{found:?}");
        let of_cell = |c: usize| {
            let values: Vec<f64> = mesh.cells.nodes(c).iter().map(|&n| found[n as usize]).collect();
            geometry.filled::<PlaneStrain>(&mesh, c, &values)
        };
        let volume: f64 = (0..mesh.cells.len()).map(of_cell).sum();
        assert!((volume - 2.02).abs() < 1e-10, "{volume}");
    }
}
