use super::*;
use crate::kinematics::PlaneStrain;
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use crate::surface::fixture::volumes;
use std::f64::consts::PI;

struct Scene {
    mesh: Mesh<2>,
    front: MarkerFront,
    distance: Distance,
    /// What of each cell is within the front (m³).
    volume: Vec<f64>,
}

/// The front of the cells with centres `inside` after `steps` displacements by `step`. Cells that are `inside` after
/// that (by `later`) hold points.
fn scene(
    mesh: Mesh<2>,
    inside: impl Fn(&[f64; 2]) -> bool,
    (step, steps): (impl Fn(&[f64; 2]) -> [f64; 2], usize),
    later: impl Fn(&[f64; 2]) -> f64,
) -> Scene {
    let (geometry, locator) = (Geometry::new::<PlaneStrain>(&mesh), Locator::new(&mesh));
    let filled: Vec<bool> = geometry.frame.iter().map(|f| inside(&f.centre)).collect();
    let mut front = MarkerFront::around(&mesh, &geometry.faces, &filled);
    let u: Vec<_> = mesh.nodes.iter().map(&step).collect();
    for _ in 0..steps {
        front.advance((&mesh, &locator), (&mesh, &locator), &geometry, &u).unwrap();
    }
    // A cell holds points if the surface leaves anything of it.
    let holds = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| later(&mesh.nodes[n as usize]) > 1e-3);
    let cell: Vec<u32> = (0..mesh.cells.len() as u32).filter(holds).collect();
    let mut distance = Distance::default();
    let all = vec![true; mesh.cells.len()];
    for _ in 0..2 {
        distance.update(&mesh, &geometry, &locator, &front, &cell, &all);
    }
    let volume = volumes::<PlaneStrain>(&mesh, &geometry, &distance.level_set, &all);
    Scene { mesh, front, distance, volume }
}

#[test]
fn a_front_that_has_not_moved_cuts_nothing() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
        let inside = |x: &[f64; 2]| x[1] < 0.9 || (x[0] > 0.6 && x[0] < 1.6);
        let mesh = rectangle(kind, 2.0, 2.0, 10, 10, 0.2, 5);
        let geometry = Geometry::new::<PlaneStrain>(&mesh);
        let cell: Vec<u32> =
            (0..mesh.cells.len()).filter(|&c| inside(&geometry.frame[c].centre)).map(|c| c as u32).collect();
        let filled: Vec<bool> = (0..mesh.cells.len()).map(|c| cell.contains(&(c as u32))).collect();
        let front = MarkerFront::around(&mesh, &geometry.faces, &filled);
        let mut distance = Distance::default();
        let all = vec![true; mesh.cells.len()];
        distance.update(&mesh, &geometry, &Locator::new(&mesh), &front, &cell, &all);
        let total: f64 = volumes::<PlaneStrain>(&mesh, &geometry, &distance.level_set, &all).iter().sum();
        let wanted: f64 = cell.iter().map(|&c| geometry.volume(c as usize)).sum();
        assert!((total / wanted - 1.0).abs() < 1e-12, "{kind:?} {total} {wanted}");
    }
}

#[test]
fn the_level_set_of_a_sliding_slab_is_linear_up_to_the_wall() {
    for slope in [-0.7, 0.0, 0.7] {
        // A slab of height 1 in a channel of that height, its ends inclined, moved along both walls.
        let mut mesh = rectangle(CellKind::T6, 4.0, 1.0, 32, 8, 0.0, 0);
        mesh.nodes.iter_mut().for_each(|x| x[0] += slope * x[1] * (x[0] * (4.0 - x[0])).min(1.0));
        let moved = 23.0 * 0.0317;
        let (low, high) = (1.0 + moved, 2.5 + moved);
        let level = |x: &[f64; 2]| {
            let s = x[0] - slope * x[1];
            (s - low).min(high - s) / 1f64.hypot(slope)
        };
        let inside = |x: &[f64; 2]| (1.0..2.5).contains(&(x[0] - slope * x[1]));
        let scene = scene(mesh, inside, (|_: &[f64; 2]| [0.0317, 0.0], 23), level);
        let mut near = 0;
        for (x, found) in scene.mesh.nodes.iter().zip(&scene.distance.level_set) {
            let wanted = level(x);
            if wanted.abs() < 0.13 {
                near += 1;
                assert!((found - wanted).abs() < 1e-12, "{slope} {x:?}: {found} {wanted}");
            }
            assert!(wanted * found >= 0.0, "{slope} {x:?}: {found} {wanted}");
        }
        assert!(near > 40);
        let total: f64 = scene.volume.iter().sum();
        assert!((total - 1.5).abs() < 1e-12, "{slope} {total}");
        assert!((scene.front.volume::<PlaneStrain>() - 1.5).abs() < 1e-12);
    }
}

/// The signed distance to a polygon, counter-clockwise, by the sum of the angles and all of its sides.
fn polygon(corners: &[[f64; 2]], x: &[f64; 2]) -> f64 {
    let (mut least, mut angle) = (f64::INFINITY, 0.0);
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (d, r, s) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]], [x[0] - b[0], x[1] - b[1]]);
        let t = ((r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        least = least.min((r[0] - t * d[0]).hypot(r[1] - t * d[1]));
        angle += (r[0] * s[1] - r[1] * s[0]).atan2(r[0] * s[0] + r[1] * s[1]);
    }
    if angle.abs() > PI { least } else { -least }
}

#[test]
fn a_turned_and_a_sheared_square_have_their_exact_distance() {
    let turn: f64 = PI / 3.0 / 40.0;
    let rotate = move |x: &[f64; 2]| {
        let [a, b] = [x[0] - 1.5, x[1] - 1.0];
        [a * turn.cos() - b * turn.sin() - a, a * turn.sin() + b * turn.cos() - b]
    };
    let shear = |x: &[f64; 2]| [(x[1] - 1.0) / 40.0, 0.0];
    for (name, step) in [("rotation", &rotate as &dyn Fn(&[f64; 2]) -> [f64; 2]), ("shear", &shear)] {
        let mut corners = [[1.0, 0.5], [2.0, 0.5], [2.0, 1.5], [1.0, 1.5]];
        for x in &mut corners {
            for _ in 0..40 {
                let u = step(x);
                *x = [x[0] + u[0], x[1] + u[1]];
            }
        }
        let inside = |x: &[f64; 2]| (x[0] - 1.5).abs() < 0.5 && (x[1] - 1.0).abs() < 0.5;
        let mesh = rectangle(CellKind::T6, 3.0, 2.0, 24, 16, 0.0, 8);
        let scene = scene(mesh, inside, (step, 40), |x| polygon(&corners, x));
        let mut worst = 0.0f64;
        for (x, found) in scene.mesh.nodes.iter().zip(&scene.distance.level_set) {
            let wanted = polygon(&corners, x);
            if wanted.abs() < 0.125 {
                worst = worst.max((found - wanted).abs());
            }
            assert!(wanted * found > 0.0 || wanted.abs() < 1e-3, "{name} {x:?}: {found} {wanted}");
        }
        let total: f64 = scene.volume.iter().sum();
        println!("{name}: level set {:.1e} h, active volume {:.1e}", 8.0 * worst, total - 1.0);
        assert!(worst < 1e-3 && (total - 1.0).abs() < 5e-3, "{name} {worst} {total}");
    }
}

/// A body on a floor that is hollow beneath stands on two toes. What its underside is continued by below the floor is nearer to places beside
/// the toes than their outside is, and says nothing of them.
#[test]
fn the_underside_of_a_toe_says_nothing_of_its_outside() {
    let body: [[f64; 2]; 7] =
        [[0.9, 0.0], [0.953, 0.0], [1.5, 0.255], [2.047, 0.0], [2.1, 0.0], [2.19, 0.5], [0.81, 0.5]];
    let within = |x: &[f64; 2]| {
        let ends = body.iter().zip(body.iter().cycle().skip(1));
        let crosses = |(a, b): &(&[f64; 2], &[f64; 2])| {
            (a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        };
        ends.filter(crosses).count() % 2 == 1
    };
    let mesh = rectangle(CellKind::T6, 3.0, 1.0, 24, 8, 0.0, 0);
    let (geometry, locator) = (Geometry::new::<PlaneStrain>(&mesh), Locator::new(&mesh));
    let front = MarkerFront { position: body.to_vec(), first: vec![0, body.len() as u32] };
    let holds = |c: &u32| within(&geometry.frame[*c as usize].centre);
    let cell: Vec<u32> = (0..mesh.cells.len() as u32).filter(holds).collect();
    let mut distance = Distance::default();
    distance.update(&mesh, &geometry, &locator, &front, &cell, &vec![true; mesh.cells.len()]);
    for (x, found) in mesh.nodes.iter().zip(&distance.level_set) {
        assert!((*found > 0.0) == within(&[x[0], x[1] + 1e-9]), "{x:?}: {found}");
    }
}

/// Soil that flows around the edge of an opening: straight on, its surface would go on through the soil above the floor.
#[test]
fn soil_around_a_corner_of_the_wall_is_not_cut() {
    // The last free marker is at the edge, or a chord cuts the edge off.
    let edges = [[0.4991, 0.4997], [0.4988, 0.4864], [0.4921, 0.4626]];
    for (mirrored, edge) in edges.into_iter().flat_map(|edge| [(false, edge), (true, edge)]) {
        let turn = |x: f64| if mirrored { 2.0 - x } else { x };
        let whole = rectangle(CellKind::T6, 2.0, 1.5, 16, 12, 0.0, 0);
        let mesh = whole.part(|c| whole.centre(c)[1] > 0.5 || turn(whole.centre(c)[0]) < 0.5);
        let (geometry, locator) = (Geometry::new::<PlaneStrain>(&mesh), Locator::new(&mesh));
        // Ahead of the opening, around its edge, along the floor and back.
        let ahead = [[0.0, 0.47], [0.25, 0.44], [0.42, 0.43], [0.4853, 0.4395], edge, [0.5141, 0.5]];
        let around = [[0.6, 0.5], [1.0, 0.5], [2.0, 0.5], [2.0, 1.2], [0.0, 1.2]];
        let mut body: Vec<[f64; 2]> = ahead.iter().chain(&around).map(|x| [turn(x[0]), x[1]]).collect();
        if mirrored {
            body.reverse();
        }
        let front = MarkerFront { first: vec![0, body.len() as u32], position: body };
        let holds = |c: &u32| (0.5..1.2).contains(&mesh.centre(*c as usize)[1]);
        let cell: Vec<u32> = (0..mesh.cells.len() as u32).filter(holds).collect();
        let mut distance = Distance::default();
        distance.update(&mesh, &geometry, &locator, &front, &cell, &vec![true; mesh.cells.len()]);
        for (&[x, y], found) in mesh.nodes.iter().zip(&distance.level_set) {
            let ahead = turn(x) < 0.51 && (y - 0.45).abs() < 0.06;
            assert!(ahead || (*found > 0.0) == (y > 0.49 && y < 1.2), "{mirrored} {edge:?} [{x}, {y}]: {found}");
        }
    }
}
