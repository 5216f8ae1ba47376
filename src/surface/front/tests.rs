mod conform;

use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use std::f64::consts::TAU;

struct Grid {
    mesh: Mesh<2>,
    geometry: Geometry,
    locator: Locator<2>,
}

fn grid(mesh: Mesh<2>) -> Grid {
    Grid { geometry: Geometry::new::<PlaneStrain>(&mesh), locator: Locator::new(&mesh), mesh }
}

impl Grid {
    /// The front of the cells whose centres satisfy `inside`.
    fn front(&self, inside: impl Fn(&[f64; 2]) -> bool) -> MarkerFront {
        let filled: Vec<bool> = self.geometry.frame.iter().map(|f| inside(&f.centre)).collect();
        MarkerFront::around(&self.mesh, &self.geometry.faces, &filled)
    }

    fn advance(&self, front: &mut MarkerFront, displacement: impl Fn(&[f64; 2]) -> [f64; 2]) -> Result<(), Lost> {
        let u: Vec<_> = self.mesh.nodes.iter().map(displacement).collect();
        {
            let grid = (&self.mesh, &self.locator);
            front.advance(grid, grid, &self.geometry, &u)
        }
    }

    fn join(&self, front: &mut MarkerFront) {
        front.join(&self.mesh, &self.geometry, &self.locator, &[]).unwrap();
    }
}

fn plane_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
}

#[test]
fn a_front_is_the_boundary_of_the_filled_cells() {
    for kind in plane_kinds() {
        let grid = grid(rectangle(kind, 3.0, 2.0, 12, 8, 0.2, 3));
        // A body with a hole, on the bottom of the mesh, and a second body.
        let inside = |x: &[f64; 2]| {
            let hole = (x[0] - 0.8).abs() < 0.26 && (x[1] - 0.7).abs() < 0.26;
            (x[0] < 1.6 && x[1] < 1.4 && !hole) || x[0] > 2.3
        };
        let front = grid.front(inside);
        let cells = || (0..grid.mesh.cells.len()).filter(|&c| inside(&grid.geometry.frame[c].centre));
        let filled: f64 = cells().map(|c| grid.geometry.volume(c)).sum();
        assert_eq!(front.loops(), 3, "{kind:?}");
        assert!((front.volume::<PlaneStrain>() / filled - 1.0).abs() < 1e-13);
        let geometry = Geometry::new::<Axisymmetric>(&grid.mesh);
        let filled: f64 = cells().map(|c| geometry.volume(c)).sum();
        assert!((front.volume::<Axisymmetric>() / filled - 1.0).abs() < 1e-13);
        // Walls are what lies on the boundary, at both ends.
        let walls = front.walls(&grid.mesh, &grid.geometry, &grid.locator);
        let at_wall = |x: &[f64; 2]| [x[0] == 0.0, x[0] == 3.0, x[1] == 0.0, x[1] == 2.0];
        for l in 0..front.loops() {
            let x = front.markers(l);
            for (i, a) in x.iter().enumerate() {
                let (a, b) = (at_wall(a), at_wall(&x[(i + 1) % x.len()]));
                assert_eq!(walls[front.first[l] as usize + i], (0..4).any(|k| a[k] && b[k]), "{kind:?} {l} {i}");
            }
        }
    }
}

#[test]
fn a_front_follows_curved_cells_and_parts_bodies_that_touch_in_a_node() {
    let mut mesh = rectangle(CellKind::T6, 1.0, 1.0, 6, 8, 0.0, 0);
    for x in &mut mesh.nodes {
        let (r, t) = (1.0 + x[0], x[1] * 0.5 * PI);
        *x = [r * t.cos(), r * t.sin()];
    }
    let grid_of_ring = grid(mesh);
    let front = grid_of_ring.front(|x| x[0].hypot(x[1]) < 1.5);
    let exact = 0.25 * PI * (1.5 * 1.5 - 1.0);
    assert!((front.volume::<PlaneStrain>() / exact - 1.0).abs() < 2e-3, "{}", front.volume::<PlaneStrain>());
    let grid = grid(rectangle(CellKind::Q4, 2.0, 2.0, 2, 2, 0.0, 0));
    let front = grid.front(|x| (x[0] < 1.0) == (x[1] < 1.0));
    assert_eq!((front.loops(), front.volume::<PlaneStrain>()), (2, 2.0));
    assert_eq!(MarkerFront::default().volume::<PlaneStrain>(), 0.0);
}

#[test]
fn a_slab_slides_along_a_wall_and_leaves_no_marker_behind() {
    let grid = grid(rectangle(CellKind::T6, 3.0, 1.0, 24, 8, 0.0, 0));
    let mut front = grid.front(|x| x[0] < 1.0 && x[1] < 0.5);
    for _ in 0..37 {
        grid.advance(&mut front, |_| [0.0321, 0.0]).unwrap();
    }
    assert!((front.volume::<PlaneStrain>() - 0.5).abs() < 1e-13);
    let walls = front.walls(&grid.mesh, &grid.geometry, &grid.locator);
    for (i, x) in front.position.iter().enumerate() {
        let y = front.position[(i + 1) % front.position.len()];
        assert_eq!(walls[i], x[1] == 0.0 && y[1] == 0.0, "{x:?} {y:?}");
        assert!(x[0] > 37.0 * 0.0321 - 1e-12 && x[0] < 1.0 + 37.0 * 0.0321 + 1e-12);
    }
}

#[test]
fn rotation_and_shear_keep_the_volume_and_the_sides() {
    let grid = grid(rectangle(CellKind::T6, 3.0, 2.0, 24, 16, 0.2, 8));
    // A turn of 60° in one, shear 1 in the other case, in 40 steps; both maps are linear, so that the T6 has them.
    let turn: f64 = PI / 3.0 / 40.0;
    let rotate = |x: &[f64; 2]| {
        let [a, b] = [x[0] - 1.5, x[1] - 1.0];
        [a * turn.cos() - b * turn.sin() - a, a * turn.sin() + b * turn.cos() - b]
    };
    let shear = |x: &[f64; 2]| [(x[1] - 1.0) / 40.0, 0.0];
    for (name, step) in [("rotation", &rotate as &dyn Fn(&[f64; 2]) -> [f64; 2]), ("shear", &shear)] {
        let mut front = grid.front(|x| (x[0] - 1.5).abs() < 0.5 && (x[1] - 1.0).abs() < 0.5);
        let volume = front.volume::<PlaneStrain>();
        let (mut corners, count) = (front.position.clone(), front.position.len());
        for _ in 0..40 {
            grid.advance(&mut front, step).unwrap();
            for x in &mut corners {
                let u = step(x);
                *x = [x[0] + u[0], x[1] + u[1]];
            }
        }
        let error = front.volume::<PlaneStrain>() / volume - 1.0;
        println!("{name}: volume {error:.1e}, markers {count} -> {}", front.position.len());
        assert!(error.abs() < 1e-3, "{name} {error}");
        // The markers are on the lines between those that were carried along exactly.
        for x in &front.position {
            let gap = (0..corners.len()).map(|i| to_segment(x, &corners[i], &corners[(i + 1) % corners.len()]));
            assert!(gap.fold(f64::INFINITY, f64::min) < 1e-3, "{name} {x:?}");
        }
    }
}

fn to_segment(x: &[f64; 2], a: &[f64; 2], b: &[f64; 2]) -> f64 {
    let (d, r) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let t = ((r[0] * d[0] + r[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
    (r[0] - t * d[0]).hypot(r[1] - t * d[1])
}

#[test]
fn a_vortex_and_back_returns_the_front() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 2.0, 24, 24, 0.0, 0));
    // Stream function sin²(πx/2) sin²(πy/2) / π on a square of 2 m; the nodes move as it carries them for `dt`.
    let velocity = |x: &[f64; 2]| {
        let (a, b) = (0.5 * PI * x[0], 0.5 * PI * x[1]);
        [a.sin().powi(2) * (2.0 * b).sin() * 0.5, -(2.0 * a).sin() * b.sin().powi(2) * 0.5]
    };
    let flow = |x: &[f64; 2], dt: f64| {
        let at = |k: &[f64; 2], f: f64| velocity(&[x[0] + f * k[0], x[1] + f * k[1]]);
        let (k1, mut sum) = (velocity(x), [0.0; 2]);
        let k2 = at(&k1, 0.5 * dt);
        let k3 = at(&k2, 0.5 * dt);
        let k4 = at(&k3, dt);
        for d in 0..2 {
            sum[d] = dt / 6.0 * (k1[d] + 2.0 * k2[d] + 2.0 * k3[d] + k4[d]);
        }
        sum
    };
    let mut front = grid.front(|x| (x[0] - 1.0).abs() < 0.33 && (x[1] - 1.4).abs() < 0.33);
    let start = front.clone();
    let volume = front.volume::<PlaneStrain>();
    let (mut length, mut error) = (0, 0.0f64);
    for (dt, steps) in [(0.05, 30), (-0.05, 30)] {
        for _ in 0..steps {
            grid.advance(&mut front, |x| flow(x, dt)).unwrap();
            grid.join(&mut front);
            assert_eq!(front.loops(), 1);
            error = error.max((front.volume::<PlaneStrain>() / volume - 1.0).abs());
        }
        length = length.max(front.position.len());
    }
    assert!(error < 1e-3, "{error}");
    let gap = |x: &[f64; 2]| {
        let x0 = &start.position;
        (0..x0.len()).map(|i| to_segment(x, &x0[i], &x0[(i + 1) % x0.len()])).fold(f64::INFINITY, f64::min)
    };
    let worst = front.position.iter().map(gap).fold(0.0, f64::max);
    let h = 2.0 / 24.0;
    println!("vortex: {} -> {length} markers, back to {:.4} h, volume {error:.1e}", start.position.len(), worst / h);
    assert!(worst < 0.15 * h, "{}", worst / h);
}

/// Two bodies that come within a fifth of a cell of each other are one from then on, and the gap that is left between them closes.
#[test]
fn bodies_that_meet_are_joined() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let mut front = grid.front(|x| x[1] < 0.5 && (x[0] - 1.0).abs() > 0.25);
    let gap = |front: &MarkerFront| {
        let side = |left: bool| front.position.iter().filter(move |x| x[1] < 0.45 && (x[0] < 1.0) == left);
        let left = side(true).map(|x| x[0]).fold(0.0, f64::max);
        side(false).map(|x| x[0]).fold(2.0, f64::min) - left
    };
    let mut apart = 0.0;
    while front.loops() == 2 {
        assert!(gap(&front) > 0.19 / 8.0, "{}", gap(&front));
        grid.advance(&mut front, |x| [0.01 * (1.0 - x[0]), 0.0]).unwrap();
        apart = front.volume::<PlaneStrain>();
        grid.join(&mut front);
    }
    let closed = (front.volume::<PlaneStrain>() - apart) / (0.5 * 0.2 / 8.0);
    assert!(front.loops() == 1 && (0.9..1.1).contains(&closed), "{} {closed}", front.loops());
}

/// Loops that overlap become one around both, a loop that folds loses what is inside out, and a void that two sides have closed goes.
#[test]
fn loops_that_cross_bound_what_lies_on_their_left() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let square = |low: [f64; 2], high: [f64; 2]| {
        let count = 12;
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let side = move |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            (0..count)
                .map(move |i| f64::from(i) / f64::from(count))
                .map(move |t| [0, 1].map(|d| a[d] + t * (b[d] - a[d])))
        };
        (0..4).flat_map(side).collect::<Vec<_>>()
    };
    let front = |loops: &[Vec<[f64; 2]>]| {
        let mut first = vec![0];
        loops.iter().for_each(|x| first.push(first[first.len() - 1] + x.len() as u32));
        MarkerFront { position: loops.concat(), first }
    };
    let mut two = front(&[square([0.3, 0.2], [1.0, 0.7]), square([0.81, 0.33], [1.52, 0.84])]);
    grid.join(&mut two);
    let union = 0.7 * 0.5 + 0.71 * 0.51 - 0.19 * 0.37;
    assert_eq!(two.loops(), 1);
    assert!((two.volume::<PlaneStrain>() - union).abs() < 1e-12, "{}", two.volume::<PlaneStrain>() - union);

    // Markers of one side that have passed through the other side.
    let mut folded = front(&[square([0.3, 0.2], [1.0, 0.7])]);
    let through = folded.position.iter().position(|x| x[1] == 0.7 && (x[0] - 0.65).abs() < 1e-9).unwrap();
    folded.position[through][1] = 0.1;
    grid.join(&mut folded);
    let (loops, volume) = (folded.loops(), folded.volume::<PlaneStrain>());
    // The fold is as wide as two markers at the top, and ends at the lower side.
    let fold = 0.5 * 2.0 * (0.7 / 12.0) * 0.5;
    assert!(loops == 1 && (volume - 0.35 + fold).abs() < 1e-9, "{loops} {volume}");

    let mut void = square([0.6, 0.4], [0.61, 0.42]);
    void.reverse();
    let mut holed = front(&[square([0.3, 0.2], [1.0, 0.7]), void]);
    grid.join(&mut holed);
    assert!(holed.loops() == 1 && (holed.volume::<PlaneStrain>() - 0.35).abs() < 1e-12, "{}", holed.loops());

    // A body that is thinner than the spacing of the markers is none, and that nothing is left is said.
    let join = |front: &mut MarkerFront| front.join(&grid.mesh, &grid.geometry, &grid.locator, &[]);
    let crumb = square([0.6, 0.4], [0.61, 0.42]);
    let mut crumbs = front(&[square([0.8, 0.2], [1.4, 0.7]), crumb.clone()]);
    grid.join(&mut crumbs);
    assert_eq!(crumbs.loops(), 1);
    assert_eq!(join(&mut front(&[crumb])), Err(Lost::Vanished));
    assert_eq!(join(&mut MarkerFront::default()), Ok(()));
}

#[test]
fn a_marker_outside_the_mesh_is_found() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let mut lost = grid.front(|x| x[1] < 0.5);
    let top = lost.position.iter().position(|x| x[1] == 0.5 && x[0] > 1.0).unwrap();
    lost.position[top][1] = 1.5;
    let error = grid.advance(&mut lost, |_| [0.0; 2]).unwrap_err();
    assert!(error.to_string().contains("left the mesh at"), "{error}");
}

/// What crosses the boundary of the mesh by less than half the diagonal of a cell is put back onto it; what goes farther is not.
#[test]
fn markers_return_to_the_boundary() {
    for kind in plane_kinds() {
        let grid = grid(rectangle(kind, 2.0, 1.0, 16, 8, 0.0, 0));
        let first = grid.front(|x| x[0] < 1.0);
        let mut front = first.clone();
        grid.advance(&mut front, |_| [-0.04, 0.0]).unwrap();
        let least = front.position.iter().map(|x| x[0]).fold(1.0, f64::min);
        assert!(least == 0.0 && (front.volume::<PlaneStrain>() - 0.96).abs() < 1e-12, "{kind:?}");
        assert!(matches!(grid.advance(&mut front, |_| [-0.15, 0.0]), Err(Lost::Outside(_))));
    }
}

/// The radii of a rough circle of 48 markers.
fn rough_circle() -> Vec<[f64; 2]> {
    let radius = |k: usize| 1.0 + 0.02 * (((k * 7919 + 13) % 101) as f64 / 50.0 - 1.0);
    (0..48).map(|k| (k, TAU * k as f64 / 48.0)).map(|(k, t)| [radius(k) * t.cos(), radius(k) * t.sin()]).collect()
}

#[test]
fn smoothing_takes_what_is_rough_and_keeps_the_volume() {
    for turned in [false, true] {
        // A body, and a hole.
        let mut x = rough_circle();
        if turned {
            x.reverse();
        }
        let mut front = MarkerFront { first: vec![0, 48], position: x };
        let volume = front.volume::<PlaneStrain>();
        let free = front.smoothen(&[false; 48], |_| 0.75).unwrap();
        assert!(free.iter().all(|&free| free) && front.position.len() == free.len());
        front.offset::<PlaneStrain>(&free, volume);
        assert!(
            (front.volume::<PlaneStrain>() / volume - 1.0).abs() < 1e-4,
            "{} {volume}",
            front.volume::<PlaneStrain>()
        );
        let radius: Vec<f64> = front.position.iter().map(|x| x[0].hypot(x[1])).collect();
        let jump = (1..radius.len()).map(|i| (radius[i] - radius[i - 1]).abs()).fold(0.0, f64::max);
        assert!(jump < 4e-3, "{jump}");
    }
    // Too small for the cells that it lies in.
    let mut front = MarkerFront { first: vec![0, 48], position: rough_circle() };
    assert!(front.smoothen(&[false; 48], |_| 0.85).is_none());
}

#[test]
fn a_straight_stretch_between_walls_stays() {
    // A rectangle on a floor, whose sides are walls, too.
    let corners = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.3, 1.0], [0.0, 1.0]];
    let wall = [true, true, false, false, true];
    let mut front = MarkerFront { first: vec![0, 5], position: corners.clone() };
    let free = front.smoothen(&wall, |_| 0.5).unwrap();
    front.offset::<PlaneStrain>(&free, 4.0);
    assert!((front.volume::<PlaneStrain>() - 4.0).abs() < 1e-13);
    assert_eq!(free.iter().filter(|free| !**free).count(), 4);
    assert!(corners.iter().filter(|x| x[0] != 2.3).all(|x| front.position.contains(x)));
    assert!(front.position.iter().zip(&free).all(|(x, free)| !free || (x[1] - 1.0).abs() < 1e-13));
}
