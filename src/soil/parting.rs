//! Where soil ends once a part of it is taken away: the places where the two met at first, seen through the map that the points carry.

use super::ON_NODE;
use super::origin::{Origin, Outline};
use super::recover::{Ground, Nodal, Sizes, Values};
use crate::geometry::Line;
use crate::kinematics::Kinematics;
use crate::mesh::locate::Locator;
use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::quadrature::{self, Around, Held};
use crate::surface::{ActiveBoundary, Behind, Distance, Geometry, MarkerFront, NO_REGION};
use rayon::prelude::*;
use std::marker::PhantomData;

/// Soil of which some regions are taken away.
pub struct Parting<K> {
    origin: Origin,
    removed: Vec<bool>,
    /// Where what is taken away meets the rest.
    between: Outline,
    around: Around,
    kinematics: PhantomData<fn() -> K>,
}

impl<K> Parting<K> {
    /// The soil of the regions `there` on the grid `mesh`, of which some are `removed`.
    pub fn new(mesh: Mesh<2>, there: &[bool], removed: &[bool]) -> Self {
        let around = Around::of(&mesh);
        let size = (0..mesh.cells.len()).map(|c| cell_size(&mesh, c)).fold(0.0, f64::max);
        let origin = Origin::new(mesh, there);
        let of = |c: u32| origin.mesh.cells.region[c as usize] as usize;
        let apart = |a: u32, b: u32| there[of(a)] && there[of(b)] && removed[of(a)] != removed[of(b)];
        let lines: Vec<Line<2>> = origin.lines(apart).collect();
        let between = Outline::new(lines, 2.0 * size);
        Self { removed: removed.to_vec(), between, around, origin, kinematics: PhantomData }
    }

    /// How far (m) each node of the reset grid is within what is left, negative within what is taken away; no more than a few cells.
    fn remains(&self, mesh: &Mesh<2>, points: &Points<2>) -> Vec<f64> {
        let held = Held::new(mesh.cells.len(), &points.cell);
        let filled = (0..mesh.cells.len() as u32).filter(|&c| !held.points(c).is_empty());
        let mut active: Vec<u32> = filled.flat_map(|c| self.around.cells(c).iter().copied().chain([c])).collect();
        active.sort_unstable();
        active.dedup();
        let ground = Ground { mesh, points, around: &self.around, held: &held, active: &active };
        let of: Vec<f64> = points.origin.iter().flatten().copied().collect();
        let origins = Nodal::of(&ground, None, Values { width: 2, of: &of });
        let sizes = Sizes::new(&ground);
        let level = |n: usize| {
            // The surface knows of places that no points are near.
            let Some(at) = origins.at(n as u32) else { return f64::INFINITY };
            let first = [at.value[0], at.value[1]];
            let (distance, _) = self.between.distance(&first);
            if distance < ON_NODE * sizes.of(n) {
                return 0.0;
            }
            let region = self.origin.seeded_cell(&first).map(|(c, _)| self.origin.mesh.cells.region[c as usize]);
            if region.is_some_and(|region| self.removed[region as usize]) { -distance } else { distance }
        };
        (0..mesh.nodes.len()).into_par_iter().with_min_len(256).map(level).collect()
    }
}

impl<K: Kinematics<2>> quadrature::Parting<2> for Parting<K> {
    fn part(
        &self,
        (mesh, locator): (&Mesh<2>, &Locator<2>),
        points: &Points<2>,
        active: &[bool],
        front: &mut MarkerFront,
    ) {
        let geometry = Geometry::new::<K>(mesh);
        let mut distance = Distance::default();
        distance.update(mesh, &geometry, locator, front, &points.cell, active);
        let remains = self.remains(mesh, points);
        let level: Vec<f64> =
            distance.level_set.iter().zip(&remains).map(|(soil, remains)| soil.min(*remains)).collect();
        let nothing = |host: u32, _: &[f64; 2]| Behind { region: NO_REGION, host };
        let boundary = ActiveBoundary::of(mesh, &geometry, &level, active, nothing);
        *front = boundary.front(mesh);
    }
}
