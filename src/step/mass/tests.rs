//! What the mass keeps of the motion that is mapped with it.

use super::*;
use crate::interpolation::Mpm;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use crate::mesh::locate::Locator;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::quadrature::Volumes;
use crate::step::report::Motion;
use crate::step::{Numerics, Phase, Restore, StepSize, transfer};
use crate::tensor::{IDENTITY, Tensor};

fn scene<K: Kinematics<2>>(kind: CellKind) -> Scene<2> {
    let mut mesh = rectangle(kind, 4.0, 4.0, 8, 8, 0.2, 3);
    mesh.nodes.iter_mut().for_each(|x| x[0] += 1.0);
    Scene {
        locator: Locator::new(&mesh),
        pressure_unit: None,
        carried: Vec::new(),
        water: None,
        mesh,
        terms: Vec::new(),
        fem: None,
        bodies: Vec::new(),
        bars: Vec::new().into(),
        interfaces: Vec::new(),
        levels: None,
        quadrature: Box::new(Volumes::<K>::default()),
        supports: Vec::new(),
        traced: Vec::new(),
        removals: Vec::new(),
        placements: Vec::new(),
        outflows: Vec::new(),
        inflows: Vec::new(),
        absorbing: Vec::new(),
        springs: Vec::new().into(),
        ties: Vec::new(),
        loaded: Vec::new(),
        begins: 0.0,
        phases: vec![Phase {
            name: "flight".into(),
            dynamic: true,
            auto: false,
            flows: false,
            duration: 1.0,
            step: StepSize { initial: 1.0, min: 1.0, max: 1.0 },
            prescribed: Vec::new(),
            reduction: None,
            loads_change: false,
            by_formula: false,
            search: None,
            held: Vec::new(),
            apart: Vec::new(),
            changes: Vec::new(),
            reset_displacements: false,
            stops: Vec::new(),
        }],
        basis: &Mpm,
        numerics: Numerics {
            restore: Restore::EveryStep,
            spectral_radius: 1.0,
            tolerance: 1e-10,
            acceptable_tolerance: 0.0,
            max_iterations: 25,
        },
        gravity: [0.0; 2],
        strongest_gravity: 0.0,
        stiffness_scale: 1.0,
        density_scale: 2.0,
    }
}

/// A disc of points on a lattice of the given spacing (m) with the centre of the mesh, and one point on its own.
fn disc(spacing: f64, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> Points<2> {
    let mut points = Points::default();
    let mut add = |x: [f64; 2]| {
        points.position.push(x);
        points.origin.push(x);
        points.mass.push(2.0 * spacing * spacing);
        points.initial_volume.push(spacing * spacing);
        points.deformation.push(Tensor::identity());
        points.elastic.push(IDENTITY);
        points.stress.push([0.0; 6]);
        points.plastic_strain.push(0.0);
        points.region.push(0);
        points.cell.push(0);
        points.velocity.push(velocity(x));
    };
    let count = (1.0 / spacing) as i32;
    for i in -count..=count {
        for j in -count..=count {
            let (x, y) = ((f64::from(i) + 0.21) * spacing, (f64::from(j) - 0.13) * spacing);
            if x.hypot(y) < 1.0 {
                add([3.0 + x, 2.0 + y]);
            }
        }
    }
    add([4.713, 0.311]);
    points
}

/// The velocity of the nodes, interpolated back to the points.
fn through_the_grid<K: Kinematics<2>>(kind: CellKind, points: Points<2>) -> Points<2> {
    let scene = scene::<K>(kind);
    let mut state = State::new(points, scene.mesh.nodes.len(), 1.0);
    let mut grid = Grid::first::<K>(&scene, &mut state).unwrap();
    transfer::motion_to_grid::<2, K>(&scene, &mut grid, &mut state).unwrap();
    let mut mapped = state.points.clone();
    for cell_points in &grid.interpolations.integration.filled {
        let local = grid.interpolations.integration.gather(&scene.mesh, cell_points, &state.velocity);
        for entries in grid.interpolations.integration.entries::<K>(cell_points) {
            let v = &mut mapped.velocity[entries.point];
            *v = [0.0; 2];
            for (n, nodal) in entries.value.iter().zip(&local[..]) {
                (0..2).for_each(|d| v[d] += n * nodal[d]);
            }
        }
    }
    mapped
}

const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

/// From sixteen points a cell to less than one.
const SPACINGS: [f64; 4] = [0.1, 0.17, 0.31, 0.6];

#[test]
fn a_linear_velocity_field_passes_untouched() {
    fn check<K: Kinematics<2>>() {
        let spin = |[x, y]: [f64; 2]| [0.3 + 0.5 * x - 2.0 * y, -1.0 + 2.0 * x + 0.1 * y];
        for kind in KINDS {
            for spacing in SPACINGS {
                let mapped = through_the_grid::<K>(kind, disc(spacing, spin));
                let body = mapped.len() - 1;
                for (v, &x) in mapped.velocity.iter().zip(&mapped.position).take(body) {
                    let exact = spin(x);
                    let error = (v[0] - exact[0]).abs().max((v[1] - exact[1]).abs());
                    assert!(error < 1e-9, "{kind:?}, {spacing}: {error:.1e}");
                }
            }
        }
    }
    check::<PlaneStrain>();
    check::<Axisymmetric>();
}

fn motion(points: &Points<2>) -> Motion<2> {
    Motion::of(&State::new(points.clone(), 0, 1.0))
}

#[test]
fn linear_and_angular_momentum_are_kept() {
    for kind in KINDS {
        for spacing in SPACINGS {
            let noise = |[x, y]: [f64; 2]| [(50.0 * x).sin() + (31.0 * y).cos(), (43.0 * x * y).sin()];
            let points = disc(spacing, noise);
            let before = motion(&points);
            let mapped = through_the_grid::<PlaneStrain>(kind, points);
            let after = motion(&mapped);
            let scale = before.mass * 5.0;
            for (name, a, b) in [
                ("x", before.linear[0], after.linear[0]),
                ("y", before.linear[1], after.linear[1]),
                ("angular", before.angular, after.angular),
            ] {
                assert!((a - b).abs() < 1e-12 * scale, "{kind:?}, {spacing}, {name}: {a} {b}");
            }
            assert!(after.kinetic <= before.kinetic * (1.0 + 1e-12));
        }
    }
}
