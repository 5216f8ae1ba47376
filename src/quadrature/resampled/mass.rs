//! The mass of the integration points: that of the material points.
//!
//! The density is fitted, and the volume is that within the surface; both make a small error in the mass of a body. So
//! the masses of each material of a body are multiplied by one factor, close to one, and those of the body by another where
//! a material has no integration point in it.

use super::samples::Samples;
use crate::mesh::{Bodies, Mesh};
use crate::points::Points;
use std::collections::BTreeMap;

/// Brings the masses of the integration points to those of the material points.
pub fn conserve(mesh: &Mesh<2>, points: &Points<2>, samples: &mut Samples<2>) {
    let cells = samples.points.cell.iter().chain(&points.cell).copied();
    let bodies = Bodies::of(mesh, cells, &samples.outside);
    scale(points, &mut samples.points, |of, p| Some((bodies.of_cell(of.cell[p])?, of.region[p])));
    scale(points, &mut samples.points, |of, p| Some((bodies.of_cell(of.cell[p])?, 0)));
}

/// Gives each group of integration points the mass (t) of the material points of the group, where both have any.
fn scale(points: &Points<2>, samples: &mut Points<2>, group: impl Fn(&Points<2>, usize) -> Option<(usize, u16)>) {
    let mut masses: BTreeMap<(usize, u16), [f64; 2]> = BTreeMap::new();
    for (k, of) in [points, &*samples].into_iter().enumerate() {
        for p in 0..of.len() {
            if let Some(group) = group(of, p) {
                masses.entry(group).or_default()[k] += of.mass[p];
            }
        }
    }
    for q in 0..samples.len() {
        let Some([wanted, has]) = group(samples, q).map(|group| masses[&group]) else { continue };
        if wanted > 0.0 && has > 0.0 {
            samples.mass[q] *= wanted / has;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    #[test]
    fn each_material_of_each_body_keeps_its_mass() {
        let mesh = rectangle(CellKind::Q9, 6.0, 1.0, 6, 1, 0.0, 1);
        // Two bodies, in the second of which region 1 has no integration point, and a drop beside it.
        let of = |entries: &[(u32, u16, f64)]| Points {
            position: vec![[0.0; 2]; entries.len()],
            cell: entries.iter().map(|e| e.0).collect(),
            region: entries.iter().map(|e| e.1).collect(),
            mass: entries.iter().map(|e| e.2).collect(),
            ..Points::default()
        };
        let points = of(&[(0, 0, 2.0), (1, 1, 3.0), (3, 0, 4.0), (4, 1, 1.0), (5, 0, 7.0)]);
        let points_of_cells = of(&[(0, 0, 1.0), (1, 0, 0.5), (1, 1, 2.9), (3, 0, 1.0), (4, 0, 3.0), (5, 0, 7.0)]);
        let mut samples = Samples { points: points_of_cells, outside: vec![5], ..Samples::default() };
        conserve(&mesh, &points, &mut samples);
        let (mass, expected) = (&samples.points.mass, [4.0 / 3.0, 2.0 / 3.0, 3.0, 1.25, 3.75, 7.0]);
        assert!(mass.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{mass:?}");
    }
}
