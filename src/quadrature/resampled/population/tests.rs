use super::super::places::Places;
use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::material::spatial::elastic_from_stress;
use crate::material::{Correlation, Elasticity, LinearElastic, Model, Profile, RandomStrength, Randomness};
use crate::mesh::Mesh;
use crate::mesh::builder::rectangle;
use crate::mesh::locate::Locator;
use crate::mesh::shape::CellKind;
use crate::quadrature::fixture::on_grid;
use crate::quadrature::{Quadrature, Resampled};
use crate::seed::{RegionSeed, seed};
use crate::tensor::Tensor;
use std::sync::Arc;

fn model() -> Arc<dyn Model> {
    Arc::new(LinearElastic::new(Elasticity::new(Profile::constant(1000.0), 0.3).unwrap()))
}

fn strength() -> Arc<RandomStrength> {
    let (correlation, lengths) = (Correlation::Markov, [1.0, 0.3]);
    Arc::new(RandomStrength::new(&Randomness { variation: 0.5, lengths, correlation, seed: 11 }))
}

/// Gives the points a state that differs from one to the next.
fn stir(points: &mut Points<2>) {
    let wave = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64).sin();
    let count = points.len();
    points.velocity = (0..count).map(|i| [wave(i, 0), wave(i, 1)]).collect();
    points.acceleration = (0..count).map(|i| [wave(i, 2), wave(i, 3)]).collect();
    points.internal = (0..2 * count).map(|i| wave(i / 2, 4 + 6 * (i % 2)).abs()).collect();
    points.reference = points.position.iter().map(|x| [x[0] - 0.1, x[1] + 0.2]).collect();
    points.pressure = (0..count).map(|i| wave(i, 9)).collect();
    points.pore_pressure = (0..count).map(|i| wave(i, 8)).collect();
    points.vary(&[Some(strength())]);
    let model = model();
    for i in 0..count {
        let [a, b] = [0.1 * wave(i, 5), 0.4 * wave(i, 6)];
        points.deformation[i] = Tensor::new(1.2 + a, b, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0);
        let kirchhoff = [10.0 * wave(i, 7), -3.0, wave(i, 8), 2.0 * wave(i, 9), 0.0, 0.0];
        points.elastic[i] = elastic_from_stress(model.as_ref(), points.seeded_height(i), &kirchhoff);
        // Beside the model, the field carries its pressure.
        let volume_ratio = points.deformation[i].determinant();
        let beside = |k: usize| if k < 3 { points.pressure[i] } else { 0.0 };
        points.stress[i] = std::array::from_fn(|k| (kirchhoff[k] + beside(k)) / volume_ratio);
    }
}

/// Population for points on a mesh that is full, seeded with `seeded` points a cell.
fn renewed<K: Kinematics<2>>(mesh: &Mesh<2>, points: &Points<2>, seeded: u32) -> (Option<Renewed<2>>, Count) {
    let (geometry, around) = (Geometry::new::<K>(mesh), Around::of(mesh));
    let cells = mesh.cells.len();
    let (level_set, outside) = (vec![1.0; mesh.nodes.len()], vec![false; cells]);
    let part = |c: usize| {
        let mut places = Vec::new();
        Places::new().full::<K>(mesh, c, &mut places);
        Part { cell: c as u32, region: 0, share: 1.0, full: true, places }
    };
    let parts: Vec<Part> = (0..cells).map(part).collect();
    on_grid(mesh, points, |grid| {
        let ground = Ground {
            geometry: &geometry,
            around: &around,
            grid,
            level_set: &level_set,
            outside: &outside,
            parts: &parts,
            seeded: &[seeded],
            held: &Held::new(cells, &points.cell),
        };
        renew(&ground, &Materials::<K>::new(vec![Some(model())]).varying(vec![Some(strength())]))
    })
}

/// Every point has the strength of the place where it was seeded.
#[track_caller]
fn assert_strength(points: &Points<2>) {
    let expected: Vec<f64> = points.origin.iter().map(|x| strength().factor(x)).collect();
    assert_eq!(points.strength, expected);
}

#[test]
fn integration_points_have_the_strength_of_where_they_were_seeded() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let mesh = rectangle(kind, 2.0, 2.0, 4, 4, 0.1, 7);
        let mut points = filled(&mesh, false, 9);
        // The soil has come two metres from the left.
        points.origin.iter_mut().for_each(|x| x[0] -= 2.0);
        points.vary(&[Some(strength())]);
        let quadrature =
            Resampled::<PlaneStrain>::new(&mesh, vec![Some(model())], false).varying(vec![Some(strength())]);
        let samples = on_grid(&mesh, &points, |grid| quadrature.weigh(grid, &mut None)).samples.unwrap().points;
        assert!(samples.len() >= 3 * mesh.cells.len(), "{}", samples.len());
        assert_strength(&samples);
        for (x, seeded) in samples.position.iter().zip(&samples.origin) {
            assert!((x[0] - 2.0 - seeded[0]).abs() + (x[1] - seeded[1]).abs() < 1e-12, "{x:?} {seeded:?}");
        }
    }
}

fn filled(mesh: &Mesh<2>, axisymmetric: bool, each: u32) -> Points<2> {
    let density = Profile::constant(1.7);
    seed(mesh, axisymmetric, &[RegionSeed { region: 0, points_per_cell: each, density }]).unwrap()
}

/// What is kept: mass, volume when seeded and now; Σ m x, Σ m X, Σ m x₀, Σ V₀ β and Σ V₀ p, Σ V p_w; Σ V σ; linear momentum and its rate.
fn sums(points: &Points<2>) -> Vec<f64> {
    let mut sums = vec![0.0; 24];
    for p in 0..points.len() {
        let (m, v0, v) = (points.mass[p], points.initial_volume[p], points.volume(p));
        let vectors = [
            (m, points.position[p]),
            (m, points.origin[p]),
            (m, points.reference[p]),
            (m, points.velocity[p]),
            (m, points.acceleration[p]),
            (1.0, [m, v0]),
            (1.0, [v, v0 * points.internal_of(p)[1]]),
            (1.0, [v0 * points.pressure[p], v * points.pore_pressure[p]]),
        ];
        let vectors = vectors.iter().flat_map(|(w, x)| x.map(|x| w * x));
        let stresses = points.stress[p].map(|s| v * s);
        sums.iter_mut().zip(vectors.chain(stresses)).for_each(|(sum, value)| *sum += value);
    }
    sums
}

/// Moment of momentum and of its rate, and energy of motion.
fn moments(points: &Points<2>) -> [f64; 3] {
    let of = |p: usize| {
        let (m, [x, y]) = (points.mass[p], points.position[p]);
        let ([u, v], [a, b]) = (points.velocity[p], points.acceleration[p]);
        [m * (x * v - y * u), m * (x * b - y * a), 0.5 * m * (u * u + v * v)]
    };
    (0..points.len()).map(of).fold([0.0; 3], |sum, of| [0, 1, 2].map(|k| sum[k] + of[k]))
}

fn assert_alike(before: &[f64], after: &[f64]) {
    for (k, (a, b)) in before.iter().zip(after).enumerate() {
        assert!((a - b).abs() < 1e-12 * (1.0 + a.abs()), "{k}: {a} {b}");
    }
}

/// Each kind of cell without points in a quarter of one, or with next to none in it: no room stays empty, and all that is to be kept is.
fn fills<K: Kinematics<2>>(kind: CellKind, each: u32) {
    let mesh = rectangle(kind, 2.0, 2.0, 4, 4, 0.1, 7);
    let points = filled(&mesh, K::HOOP, each);
    let locator = Locator::new(&mesh);
    let emptied = |p: &usize| {
        let (c, xi) = locator.locate(&mesh, &points.position[*p], Some(points.cell[*p])).unwrap();
        c == 5 && (each < 16 || quarter(kind.is_simplex(), &xi) == 1)
    };
    let left: Vec<usize> = (0..points.len()).filter(|p| !emptied(p)).collect();
    let mut points = points.select(&left);
    stir(&mut points);
    let (renewed, count) = renewed::<K>(&mesh, &points, each);
    let after = renewed.unwrap();
    assert!(count.split > 0 && count.merged == 0 && count.starved == 0, "{kind:?} {count:?}");
    let after_points = &after.points;
    assert_eq!(after_points.len(), points.len() + count.split as usize);
    assert_strength(after_points);
    assert_alike(&sums(&points), &sums(after_points));
    assert_alike(&moments(&points), &moments(after_points));
    let [before, now] = [&points, after_points].map(|points| points.mass.iter().sum::<f64>());
    assert!((before - now).abs() < 1e-14 * before, "{before} {now}");
    for (p, &from) in after.from.iter().enumerate() {
        assert_eq!(after_points.internal_of(p), points.internal_of(from as usize));
        assert_eq!(after_points.elastic[p], points.elastic[from as usize]);
        let (c, _) = locator.locate(&mesh, &after_points.position[p], None).unwrap();
        assert_eq!(c, after_points.cell[p]);
    }
}

#[test]
fn halves_fill_empty_rooms_and_keep_mass_momentum_and_stress() {
    for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
        for each in [4, 9, 16, 25] {
            fills::<PlaneStrain>(kind, each);
            fills::<Axisymmetric>(kind, each);
        }
    }
}

#[test]
fn a_population_as_seeded_stays() {
    let mesh = rectangle(CellKind::T6, 2.0, 2.0, 4, 4, 0.1, 7);
    for each in [3, 4, 9, 16, 25] {
        let (renewed, count) = renewed::<PlaneStrain>(&mesh, &filled(&mesh, false, each), each);
        assert!(renewed.is_none() && count == Count::default(), "{each}: {count:?}");
    }
}

/// Cells with 25 points where 4 were seeded come to 16 at most, and all that is to be kept is, in the plane spin too.
fn thins<K: Kinematics<2>>() {
    let mesh = rectangle(CellKind::T6, 2.0, 2.0, 2, 2, 0.1, 7);
    let mut points = filled(&mesh, K::HOOP, 25);
    stir(&mut points);
    let (renewed, count) = renewed::<K>(&mesh, &points, 4);
    let after = renewed.unwrap();
    let cells = mesh.cells.len();
    assert!(count.merged as usize == 9 * cells && after.points.len() == 16 * cells, "{count:?}");
    assert_strength(&after.points);
    assert_alike(&sums(&points), &sums(&after.points));
    let ([spin, rate, energy], [spin_after, rate_after, energy_after]) = (moments(&points), moments(&after.points));
    assert!(energy_after <= energy, "{energy_after} {energy}");
    if !K::HOOP {
        assert_alike(&[spin, rate], &[spin_after, rate_after]);
    }
}

#[test]
fn crowded_points_merge_and_keep_mass_momentum_and_stress() {
    thins::<PlaneStrain>();
    thins::<Axisymmetric>();
}

/// A point that was sheared is split along its domain: its halves were seeded where the deformation has them from.
#[test]
fn halves_were_seeded_within_the_point() {
    let shear = Tensor::new(1.0, 3.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let mut points = Points::<2> {
        position: vec![[1.0, 2.0]],
        origin: vec![[0.5, 2.0]],
        mass: vec![2.0],
        initial_volume: vec![0.04],
        deformation: vec![shear],
        ..Points::default()
    };
    // A distance of 0.03 that F brings to this one.
    assert_eq!(points.split::<PlaneStrain>(0, [0.09, 0.03]), 1);
    assert!((points.origin[1][0] - 0.5).abs() < 1e-15 && (points.origin[1][1] - 2.03).abs() < 1e-15, "{points:?}");
    assert_eq!((points.mass[0], points.mass[1]), (1.0, 1.0));
    // One across the domain is bounded by a quarter of its width.
    points.split::<PlaneStrain>(0, [0.0, 0.5]);
    let seeded = [0, 1].map(|d| 0.5 * (points.origin[2][d] - points.origin[0][d]));
    assert!((seeded[0].hypot(seeded[1]) - 0.25 * 0.02f64.sqrt()).abs() < 1e-15, "{seeded:?}");
}

#[test]
fn the_nearest_point_is_the_one_that_is_stretched_towards_a_place() {
    let stretched = Tensor::new(4.0, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 1.0);
    let points = Points::<2> {
        position: vec![[0.0, 0.0], [0.2, 0.15]],
        initial_volume: vec![0.01; 2],
        deformation: vec![stretched, Tensor::identity()],
        ..Points::default()
    };
    let [a, b] = [0, 1].map(|p| nearness::<PlaneStrain>(&points, p, &[0.2, 0.0]));
    // Half widths 0.05 (2, 1/2) and 0.05.
    assert!((a - 2.0).abs() < 1e-12 && (b - 3.0).abs() < 1e-12, "{a} {b}");
}
