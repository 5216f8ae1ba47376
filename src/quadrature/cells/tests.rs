//! A uniform stress must exert no force on nodes inside the material, wherever the points have moved.

use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use crate::mesh::locate::Locator;
use crate::stencil::Scheme;
use crate::tensor::Tensor;
use std::f64::consts::PI;

const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

/// Points of equal volume, which together have that of the mesh, and the stencil over them.
fn place<K: Kinematics<2>>(mesh: &Mesh<2>, geometry: &Geometry, places: Vec<[f64; 2]>) -> (Points<2>, Stencil<2>) {
    let locator = Locator::new(mesh);
    let found: Vec<_> = places.iter().map(|x| locator.locate(mesh, x, None).unwrap()).collect();
    let measure = |x: &[f64; 2]| K::measure(x);
    let all: f64 = places.iter().map(measure).sum();
    let volume: f64 = geometry.whole.iter().map(|m| m[0]).sum();
    let points = Points {
        initial_volume: places.iter().map(|x| volume * measure(x) / all).collect(),
        deformation: vec![Tensor::identity(); places.len()],
        cell: found.iter().map(|f| f.0).collect(),
        position: places,
        ..Points::default()
    };
    let parametric: Vec<_> = found.iter().map(|f| f.1).collect();
    let mut stencil = Stencil::default();
    stencil.fill::<K>(Scheme::Mpm, mesh, &points.cell, &parametric, &vec![true; mesh.cells.len()]);
    (points, stencil)
}

/// Centres of `n × n` boxes of the unit square.
fn lattice(n: usize) -> Vec<[f64; 2]> {
    (0..n * n).map(|k| [(k % n) as f64 + 0.5, (k / n) as f64 + 0.5].map(|x| x / n as f64)).collect()
}

/// The lattice sheared by `gamma`; what leaves the square on one side enters on the other.
fn sheared(n: usize, gamma: f64) -> Vec<[f64; 2]> {
    lattice(n).into_iter().map(|[x, y]| [(x + gamma * y).rem_euclid(1.0), y]).collect()
}

/// The lattice carried by the vortex with stream function `sin²πx sin²πy` until the points near its middle have
/// turned `turns` times (fourth-order Runge–Kutta).
fn in_vortex(n: usize, turns: f64) -> Vec<[f64; 2]> {
    let velocity = |[x, y]: [f64; 2]| {
        let (sx, sy) = ((PI * x).sin(), (PI * y).sin());
        [sx * sx * (2.0 * PI * y).sin(), -sy * sy * (2.0 * PI * x).sin()].map(|v| v / (2.0 * PI))
    };
    let steps = 100 * turns.ceil() as usize;
    // Near the middle the vorticity is 2π, hence a turn takes 2.
    let dt = 2.0 * turns / steps as f64;
    let along = |x: [f64; 2], v: [f64; 2], t: f64| [x[0] + t * v[0], x[1] + t * v[1]];
    let advance = |x: [f64; 2]| {
        let a = velocity(x);
        let b = velocity(along(x, a, dt / 2.0));
        let c = velocity(along(x, b, dt / 2.0));
        let d = velocity(along(x, c, dt));
        [0, 1].map(|i| x[i] + dt / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    lattice(n).into_iter().map(|x| (0..steps).fold(x, |x, _| advance(x))).collect()
}

/// `Σ w ∇N` of a cell's nodes.
fn forces<K: Kinematics<2>>(stencil: &Stencil<2>, weight: &[f64], nodes: usize, k: usize) -> Vec<[f64; 2]> {
    let patch = &stencil.patches[k];
    let mut sum = vec![[0.0; 2]; nodes];
    let weight = &weight[patch.first_point as usize..];
    for (entries, w) in stencil.entries::<K>(patch).zip(weight) {
        for (i, sum) in sum.iter_mut().enumerate() {
            let g = entries.gradient(i).g;
            *sum = [sum[0] + w * g[0], sum[1] + w * g[1]];
        }
    }
    sum
}

/// The largest residual of a uniform stress at a node inside the mesh around which all cells hold points, for
/// volumes and for fitted weights, in units of the stress times the spacing; and the cells by degree, after the empty ones.
fn crossing(mesh: &Mesh<2>, places: Vec<[f64; 2]>) -> ([f64; 2], [usize; 4]) {
    let geometry = Geometry::new::<PlaneStrain>(mesh);
    let (points, mut stencil) = place::<PlaneStrain>(mesh, &geometry, places);
    let volume: Vec<f64> = stencil.points.iter().map(|&p| points.volume(p as usize)).collect();
    let residual = |stencil: &Stencil<2>, weight: &[f64]| {
        let mut force = vec![[0.0; 2]; mesh.nodes.len()];
        let mut around = vec![0; mesh.nodes.len()];
        mesh.cells.nodes.iter().for_each(|&n| around[n as usize] += 1);
        for (k, patch) in stencil.patches.iter().enumerate() {
            let nodes = mesh.cells.nodes(patch.cell as usize);
            for (&n, f) in nodes.iter().zip(forces::<PlaneStrain>(stencil, weight, nodes.len(), k)) {
                around[n as usize] -= 1;
                (0..2).for_each(|d| force[n as usize][d] += f[d]);
            }
        }
        let inside = |n: &usize| around[*n] == 0 && mesh.nodes[*n].iter().all(|&x| x > 0.0 && x < 1.0);
        (0..mesh.nodes.len()).filter(inside).flat_map(|n| force[n]).fold(0.0, |m: f64, f| m.max(f.abs()))
            / geometry.frame[0].length
    };
    let before = residual(&stencil, &volume);
    let mut weight = Vec::new();
    let fits = fit::<PlaneStrain>(mesh, &geometry, &geometry.whole, &points, &stencil, &mut weight);
    let shift: Vec<_> = fits.iter().filter_map(|f| Some((f.cell, f.shift.clone()?))).collect();
    stencil.weigh(&vec![0.0; points.len()], &shift);
    let mut cells = [mesh.cells.len() - fits.len(), 0, 0, 0];
    fits.iter().for_each(|f| cells[1 + f.degree as usize] += 1);
    ([before, residual(&stencil, &weight)], cells)
}

#[test]
fn uniform_stress_is_in_balance_however_the_points_have_moved() {
    let mut most_poor = [0.0f64; 2];
    for per_cell in [9.0, 16.0, 25.0] {
        for seed in [1, 2] {
            let mesh = rectangle(CellKind::T6, 1.0, 1.0, 12, 12, 0.2, seed);
            let n = (per_cell * mesh.cells.len() as f64).sqrt().round() as usize;
            let layouts = [
                ("lattice", lattice(n)),
                ("shear 1.03", sheared(n, 1.03)),
                ("shear 2.02", sheared(n, 2.02)),
                ("shear 4.01", sheared(n, 4.01)),
                ("vortex 1", in_vortex(n, 1.0)),
                ("vortex 4", in_vortex(n, 4.0)),
            ];
            for (name, places) in layouts {
                let ([before, after], cells) = crossing(&mesh, places);
                println!(
                    "{per_cell} points a cell, {name}: residual {before:.1e} -> {after:.1e}; empty / constant / linear / quadratic {cells:?}"
                );
                assert!(before > 1e-3 && after < 1e-10, "{name}: {before:e} {after:e}");
                if per_cell == 16.0 {
                    let poor = (cells[0] + cells[1]) as f64 / mesh.cells.len() as f64;
                    let most = &mut most_poor[usize::from(name.starts_with("vortex"))];
                    *most = most.max(poor);
                }
            }
        }
    }
    // Shear, and up to four turns of a vortex.
    assert!(most_poor[0] < 0.01 && most_poor[1] < 0.04, "{most_poor:?} of the cells have no fit of degree 1");
}

/// Every kind of cell, curved or distorted, in both kinds of kinematics.
#[test]
fn whole_cells_of_every_kind_balance_a_uniform_stress() {
    for (kind, curved) in KINDS.into_iter().flat_map(|kind| [(kind, false), (kind, true)]) {
        let mut mesh = rectangle(kind, 1.0, 1.0, 5, 5, 0.2, 3);
        if kind.order() == 2 && curved {
            // Curved sides.
            let corners: Vec<u32> =
                (0..mesh.cells.len()).flat_map(|c| &mesh.cells.nodes(c)[..kind.corner_count()]).copied().collect();
            for n in (0..mesh.nodes.len()).filter(|n| !corners.contains(&(*n as u32))) {
                if mesh.nodes[n].iter().all(|&x| x > 0.0 && x < 1.0) {
                    mesh.nodes[n][0] += 0.008 * (7.0 * n as f64).sin();
                    mesh.nodes[n][1] += 0.008 * (5.0 * n as f64).sin();
                }
            }
        }
        for n in [12, 23, 30] {
            balanced::<PlaneStrain>(&mesh, n, 1e-12);
            balanced::<Axisymmetric>(&mesh, n, 1e-11);
        }
    }
}

fn balanced<K: Kinematics<2>>(mesh: &Mesh<2>, n: usize, tolerance: f64) {
    let geometry = Geometry::new::<K>(mesh);
    let plane = Geometry::new::<PlaneStrain>(mesh);
    let (points, mut stencil) = place::<K>(mesh, &geometry, sheared(n, 1.3));
    let mut weight = Vec::new();
    let fits = fit::<K>(mesh, &plane, &plane.whole, &points, &stencil, &mut weight);
    let shift: Vec<_> = fits.iter().filter_map(|f| Some((f.cell, f.shift.clone()?))).collect();
    stencil.weigh(&vec![0.0; points.len()], &shift);
    let (mut hoop, mut exact_hoop) = (0.0f64, 0.0f64);
    for (k, fit) in fits.iter().enumerate() {
        let c = fit.cell as usize;
        let nodes = mesh.cells.nodes(c).len();
        let mut exact = vec![[0.0; 2]; nodes];
        let mut hoops = vec![0.0; nodes];
        integrate::<2, K>(mesh, c, |weight, n, gradient| {
            add(&mut exact, weight, gradient);
            if K::HOOP {
                let r: f64 = n.iter().zip(mesh.cells.nodes(c)).map(|(n, &i)| n * mesh.nodes[i as usize][0]).sum();
                hoops.iter_mut().zip(n).for_each(|(sum, n)| *sum += weight * n / r);
            }
        });
        let size = geometry.volume(c) / geometry.frame[c].length;
        for (sum, exact) in forces::<K>(&stencil, &weight, nodes, k).iter().zip(&exact) {
            for d in 0..2 {
                assert!(
                    (sum[d] - exact[d]).abs() < tolerance * size,
                    "{:?} cell {c} ({:?}, {} points): {sum:?} {exact:?}",
                    mesh.cells.kind[c],
                    fit.degree,
                    fit.points
                );
            }
        }
        if K::HOOP {
            let patch = &stencil.patches[k];
            for (entries, w) in stencil.entries::<K>(patch).zip(&weight[patch.first_point as usize..]) {
                (0..nodes).for_each(|i| hoops[i] -= w * entries.gradient(i).hoop);
            }
            let kind = mesh.cells.kind[c];
            let quadratic = plane.affine[c] && matches!(kind, CellKind::T3 | CellKind::T6 | CellKind::Q4);
            let kept = if quadratic && fit.degree == wanted(kind) { &mut exact_hoop } else { &mut hoop };
            *kept = hoops.iter().fold(*kept, |m, h| m.max(h.abs() / size));
        }
        assert!((fit.fitted / geometry.volume(c) - 1.0).abs() < 1e-12);
    }
    if K::HOOP {
        println!("{:?}, {n}²: largest miss of the hoop forces {hoop:.1e}, {exact_hoop:.0e}", mesh.cells.kind[0]);
        assert!(exact_hoop < tolerance, "{exact_hoop:e}");
    }
}

/// Cells that a straight surface cuts: the part below it, clipped and integrated by the midpoints of triangles, which is
/// exact for the linear gradients.
#[test]
fn cut_cells_balance_a_uniform_stress() {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, 6, 6, 0.2, 5);
    let geometry = Geometry::new::<PlaneStrain>(&mesh);
    let mut cut = [0; 3];
    for level in [0.3, 0.41, 0.5, 0.501, 0.6, 0.777] {
        for per_cell in [1.0, 4.0, 16.0] {
            let n = (per_cell * mesh.cells.len() as f64).sqrt().round() as usize;
            let places: Vec<_> = sheared(n, 2.0).into_iter().filter(|x| x[1] < level).collect();
            let (points, mut stencil) = place::<PlaneStrain>(&mesh, &geometry, places);
            let moments: Vec<Moments> = (0..mesh.cells.len())
                .map(|c| {
                    let values: Vec<f64> =
                        mesh.cells.nodes(c).iter().map(|&n| level - mesh.nodes[n as usize][1]).collect();
                    geometry.cell(&mesh, c, c).clipped::<PlaneStrain>(&values)
                })
                .collect();
            let mut weight = Vec::new();
            let fits = fit::<PlaneStrain>(&mesh, &geometry, &moments, &points, &stencil, &mut weight);
            let shift: Vec<_> = fits.iter().filter_map(|f| Some((f.cell, f.shift.clone()?))).collect();
            stencil.weigh(&vec![0.0; points.len()], &shift);
            for (k, fit) in fits.iter().enumerate() {
                let c = fit.cell as usize;
                let x: Vec<[f64; 2]> = mesh.cells.nodes(c).iter().map(|&n| mesh.nodes[n as usize]).collect();
                let exact = clipped_gradients(&x, level);
                let size = geometry.volume(c) / geometry.frame[c].length;
                for (sum, exact) in forces::<PlaneStrain>(&stencil, &weight, 6, k).iter().zip(&exact) {
                    for d in 0..2 {
                        assert!((sum[d] - exact[d]).abs() < 1e-12 * size, "cell {c}: {fit:?} {sum:?} {exact:?}");
                    }
                }
                if moments[c] != geometry.whole[c] {
                    cut[fit.degree as usize] += 1;
                }
            }
        }
    }
    println!("cut cells with points by degree: {cut:?}");
    assert!(cut.iter().all(|&n| n > 5), "{cut:?}");
}

/// `∫∇N` over the part of a straight six-node triangle below `level`.
fn clipped_gradients(x: &[[f64; 2]], level: f64) -> [[f64; 2]; 6] {
    let mut polygon: Vec<[f64; 2]> = Vec::new();
    for i in 0..3 {
        let (a, b) = (x[i], x[(i + 1) % 3]);
        if a[1] <= level {
            polygon.push(a);
        }
        if (a[1] <= level) != (b[1] <= level) {
            let t = (level - a[1]) / (b[1] - a[1]);
            polygon.push([a[0] + t * (b[0] - a[0]), level]);
        }
    }
    let area =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
    let whole = area(x[0], x[1], x[2]);
    let mut sum = [[0.0; 2]; 6];
    for k in 2..polygon.len() {
        let t = [polygon[0], polygon[k - 1], polygon[k]];
        let part = area(t[0], t[1], t[2]);
        for i in 0..3 {
            let m = [0, 1].map(|d| 0.5 * (t[i][d] + t[(i + 1) % 3][d]));
            let xi = [area(x[0], m, x[2]) / whole, area(x[0], x[1], m) / whole, 0.0];
            let (mut n, mut gradient) = ([0.0; 6], [[0.0; 2]; 6]);
            shape::map(CellKind::T6, x, &xi, &mut n, &mut gradient);
            add(&mut sum, part / 3.0, &gradient);
        }
    }
    sum
}

#[test]
fn threads_do_not_matter() {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, 12, 12, 0.2, 5);
    let geometry = Geometry::new::<PlaneStrain>(&mesh);
    let (points, stencil) = place::<PlaneStrain>(&mesh, &geometry, sheared(40, 3.0));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut weight = Vec::new();
        let fits =
            pool.install(|| fit::<PlaneStrain>(&mesh, &geometry, &geometry.whole, &points, &stencil, &mut weight));
        (fits, weight)
    };
    assert!(run(1) == run(3));
}
