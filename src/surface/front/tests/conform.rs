//! Where the front meets structures.

use super::*;
use ContactStatus::{Closed, Mixed, Open};

/// A thin layer of soil on a structure stays in the surface. One that is nearer than 0.15 of a cell lies on the structure and is gone, but where
/// contact is open.
#[test]
fn a_layer_on_a_structure_stays() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let (cell, wall) = (grid.geometry.size(&grid.mesh, 0), 0.4);
    // The structure is on the left of its outline, and of the soil.
    let outline = [vec![[wall, 0.0], [wall, 1.0]]];
    let layer = |thickness: f64, status: ContactStatus| {
        let [low, high] = [0.3, 0.9];
        let corners = [[wall, low], [wall + thickness, low], [wall + thickness, high], [wall, high]];
        let between = |k: usize, t: f64| [0, 1].map(|d| corners[k][d] + t * (corners[(k + 1) % 4][d] - corners[k][d]));
        let position: Vec<_> = (0..120).map(|i| between(i / 30, (i % 30) as f64 / 30.0)).collect();
        let mut front = MarkerFront { first: vec![0, position.len() as u32], position };
        front.conform(&grid.mesh, &grid.geometry, &grid.locator, (&outline, &[vec![status]])).unwrap();
        front.volume::<PlaneStrain>()
    };
    for (thickness, status) in [(0.3, Closed), (0.3, Mixed), (0.3, Open), (0.1, Open)] {
        let whole = thickness * cell * 0.6;
        let volume = layer(thickness * cell, status);
        assert!((volume / whole - 1.0).abs() < 0.05, "{thickness} {status:?}: {volume} of {whole}");
    }
    for status in [Closed, Mixed] {
        assert_eq!(layer(0.1 * cell, status), 0.0);
    }
}

/// Markers a twentieth of a cell outside a structure are put onto it, but where contact is open; those within it everywhere.
#[test]
fn soil_that_parts_from_a_structure_is_not_put_onto_it() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let (cell, wall) = (grid.geometry.size(&grid.mesh, 0), 0.4);
    let outline = [vec![[wall, 0.0], [wall, 0.5], [wall, 1.0]]];
    for beside in [0.05 * cell, -0.05 * cell] {
        let rise = (0..=80).map(|k| [wall + beside, 1.0 - f64::from(k) / 80.0]);
        let position: Vec<_> = rise.chain([[1.5, 0.0], [1.5, 1.0]]).collect();
        let mut front = MarkerFront { first: vec![0, position.len() as u32], position };
        front.conform(&grid.mesh, &grid.geometry, &grid.locator, (&outline, &[vec![Closed, Open]])).unwrap();
        let away = |low: f64, high: f64| {
            let between = front.position.iter().filter(|x| x[0] < 1.0 && x[1] > low && x[1] < high);
            between.map(|x| (x[0] - wall).abs()).fold(0.0, f64::max)
        };
        let wanted = if beside > 0.0 { beside } else { 0.0 };
        assert!(away(0.1, 0.45) < 1e-12 && (away(0.55, 0.9) - wanted).abs() < 1e-12, "{beside}: {front:?}");
    }
}

/// A void on a structure is filled where contact is closed all along it, and else it stays.
#[test]
fn a_void_where_contact_is_closed_is_filled() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let (cell, wall) = (grid.geometry.size(&grid.mesh, 0), 0.4);
    let outline = [vec![[wall, 0.0], [wall, 0.4], [wall, 0.6], [wall, 1.0]]];
    let void =
        [0.6, 0.55, 0.5, 0.45, 0.4].map(|y: f64| [wall + 0.8 * cell * (1.0 - 100.0 * (y - 0.5).powi(2)).max(0.0), y]);
    let position: Vec<_> =
        [[wall, 1.0], [wall, 0.8]].into_iter().chain(void).chain([[wall, 0.0], [1.5, 0.0], [1.5, 1.0]]).collect();
    let full = MarkerFront { first: vec![0, 4], position: vec![[wall, 1.0], [wall, 0.0], [1.5, 0.0], [1.5, 1.0]] };
    for (middle, is_filled) in [(Closed, true), (Mixed, false), (Open, false)] {
        let mut front = MarkerFront { first: vec![0, position.len() as u32], position: position.clone() };
        let before = front.volume::<PlaneStrain>();
        front.conform(&grid.mesh, &grid.geometry, &grid.locator, (&outline, &[vec![Mixed, middle, Mixed]])).unwrap();
        let wanted = if is_filled { full.volume::<PlaneStrain>() } else { before };
        assert!((front.volume::<PlaneStrain>() - wanted).abs() < 1e-12, "{middle:?}: {front:?}");
    }
}

/// The same around the place where a closed outline begins, at any angle.
#[test]
fn a_void_across_the_beginning_of_a_closed_outline_is_filled() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 2.0, 16, 16, 0.0, 0));
    let (cell, count) = (grid.geometry.size(&grid.mesh, 0), 120);
    let at = |r: f64, t: f64| [1.0 + r * t.cos(), 1.0 + r * t.sin()];
    for begin in [0.0, 0.7, 2.0] {
        let angle = |i: usize| begin + TAU * i as f64 / f64::from(count);
        let outline = [(0..=count as usize).map(|i| at(0.5, angle(i % count as usize))).collect::<Vec<_>>()];
        // The soil is around the structure: clockwise, with a bump away from it within 5 pieces of the beginning.
        let radius = |i: usize| {
            let from = i.min(count as usize - i) as f64;
            0.5 + 0.8 * cell * (1.0 - from / 5.0).max(0.0)
        };
        let hole: Vec<_> = (0..count as usize).rev().map(|i| at(radius(i), angle(i))).collect();
        let walls = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let farthest = |open: bool| {
            let mut contact = vec![Closed; count as usize];
            contact[2] = if open { Open } else { Closed };
            let position = [&walls[..], &hole].concat();
            let mut front = MarkerFront { first: vec![0, 4, position.len() as u32], position };
            front.conform(&grid.mesh, &grid.geometry, &grid.locator, (&outline, &[contact])).unwrap();
            let away = |x: &[f64; 2]| distance(x, &[1.0, 1.0]);
            front.position[front.first[1] as usize..].iter().map(away).fold(0.0, f64::max)
        };
        assert!((farthest(false) - 0.5).abs() < 1e-3 && farthest(true) > 0.5 + 0.7 * cell, "{begin}");
    }
}

/// Beyond a corner of less than 90° a marker is outside of both sides, though it is on the left of the extension of one.
#[test]
fn a_marker_beyond_an_acute_corner_is_outside() {
    let grid = grid(rectangle(CellKind::T6, 2.0, 1.0, 16, 8, 0.0, 0));
    let cell = grid.geometry.size(&grid.mesh, 0);
    // A wedge of 60° that points down to (1, 0.5).
    let (half, tip) = (0.5 / 3f64.sqrt(), [1.0, 0.5]);
    let outline = [vec![[1.0 - half, 1.0], tip, [1.0 + half, 1.0]]];
    for turn in [-50f64, -20.0, 20.0, 50.0] {
        let (sine, cosine) = turn.to_radians().sin_cos();
        let bump = [tip[0] + 0.4 * cell * sine, tip[1] - 0.4 * cell * cosine];
        let position = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 0.1], bump, [0.0, 0.1]];
        let mut front = MarkerFront { first: vec![0, 5], position };
        front.conform(&grid.mesh, &grid.geometry, &grid.locator, (&outline, &[vec![Open; 2]])).unwrap();
        let nearest = front.position.iter().map(|x| distance(x, &tip)).fold(1.0, f64::min);
        assert!((nearest - 0.4 * cell).abs() < 1e-12, "{turn}°: {nearest}");
    }
}
