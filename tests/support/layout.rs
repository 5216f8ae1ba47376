//! Layouts of points that owe nothing to the cells they lie in, and the parts of a scene that go with them.

#![allow(dead_code)] // each topic takes a part of it

use crate::support::Random;
use crate::support::bench::{Bench, constant};
use mpm::kinematics::Kinematics;
use mpm::mesh::Mesh;
use mpm::mesh::faces::Faces;
use mpm::mesh::locate::Locator;
use mpm::points::Points;
use mpm::quadrature::Resampled;
use mpm::seed::{RegionSeed, seed};
use mpm::step::Restore;
use mpm::tensor::{IDENTITY, Tensor};
use mpm::term::GhostPenalty;

/// Gives a scene resampled quadrature and, where it is restored, the penalty that goes with it, as a case has them.
pub fn resample<K: Kinematics<2> + 'static>(bench: &mut Bench) {
    let models = vec![Some(bench.model.clone())];
    bench.quadrature = Some(Box::new(Resampled::<K>::new(&bench.background(), models, false)));
    if bench.restore != Restore::Never {
        let faces = Faces::of(&bench.background()).inner.len();
        let penalty = GhostPenalty::<K>::new(0.1, vec![Some(bench.model.clone())], faces);
        bench.extra.push(Box::new(if bench.dynamic { penalty } else { penalty.saturating(0.1) }));
    }
}

/// Puts the middle nodes of all edges, and those inside cells, back to their middles once corners have moved.
pub fn straighten(mesh: &mut Mesh<2>) {
    for c in 0..mesh.cells.len() {
        let corners = mesh.cells.kind[c].corner_count();
        let nodes: Vec<usize> = mesh.cells.nodes(c).iter().map(|&n| n as usize).collect();
        let mean = |of: &[usize], mesh: &Mesh<2>| {
            [0, 1].map(|d| of.iter().map(|&n| mesh.nodes[n][d]).sum::<f64>() / of.len() as f64)
        };
        for (i, &middle) in nodes.iter().enumerate().skip(corners) {
            let side = [nodes[i % corners], nodes[(i + 1) % corners]];
            mesh.nodes[middle] = if i < 2 * corners { mean(&side, mesh) } else { mean(&nodes[..corners], mesh) };
        }
    }
}

/// Adds a point of undeformed material without stress, with a mass (t) and a volume (m³), in a cell.
pub fn add_point(points: &mut Points<2>, x: [f64; 2], [mass, volume]: [f64; 2], cell: u32) {
    points.position.push(x);
    points.origin.push(x);
    points.mass.push(mass);
    points.initial_volume.push(volume);
    points.deformation.push(Tensor::identity());
    points.elastic.push(IDENTITY);
    points.stress.push([0.0; 6]);
    points.plastic_strain.push(0.0);
    points.region.push(0);
    points.cell.push(cell);
}

/// Points at rest at the places (m) with the areas (m²), as far as they lie on the mesh.
pub fn at<K: Kinematics<2>>(mesh: &Mesh<2>, places: &[([f64; 2], f64)], density: f64) -> Points<2> {
    let locator = Locator::new(mesh);
    let mut points = Points::default();
    for (place, area) in places {
        let Some((cell, _)) = locator.locate(mesh, place, None) else { continue };
        let volume = area * K::measure(place);
        add_point(&mut points, *place, [density * volume, volume], cell);
    }
    points
}

/// Places and areas of the points that a mesh of its own is seeded with, `each` to a cell.
pub fn seeded(mesh: &Mesh<2>, each: u32) -> Vec<([f64; 2], f64)> {
    let region = RegionSeed { region: 0, points_per_cell: each, density: constant(1.0) };
    let points = seed(mesh, false, &[region]).unwrap();
    points.position.iter().copied().zip(points.initial_volume.iter().copied()).collect()
}

/// A lattice over `[0, lx] × [0, ly]` of a spacing near `spacing`, moved at random by up to 0.3 of it.
pub fn lattice(lx: f64, ly: f64, spacing: f64, random: &mut Random) -> Vec<([f64; 2], f64)> {
    let (nx, ny) = ((lx / spacing).round(), (ly / spacing).round());
    let (dx, dy) = (lx / nx, ly / ny);
    let mut out = Vec::new();
    for j in 0..ny as usize {
        for i in 0..nx as usize {
            let (a, b) = (0.3 * random.next(), 0.3 * random.next());
            out.push(([(i as f64 + 0.5 + a) * dx, (j as f64 + 0.5 + b) * dy], dx * dy));
        }
    }
    out
}

/// What a scene in plane strain says of its weights, for the log of a test.
pub fn describe(tally: &mpm::quadrature::Tally, lost: Option<&String>) -> String {
    format!(
        "linear {}, constant {}, ΣV/Σw − 1 = {:+.1e}{}",
        tally.linear,
        tally.constant,
        tally.point_volume / tally.volume - 1.0,
        lost.map_or(String::new(), |why| format!(", front lost: {why}"))
    )
}

/// Gives a scene resampled quadrature that finds the boundary of the material.
pub fn resample_bounded<K: Kinematics<2> + 'static>(bench: &mut Bench) {
    let models = vec![Some(bench.model.clone())];
    bench.quadrature = Some(Box::new(Resampled::<K>::new(&bench.background(), models, true)));
}
