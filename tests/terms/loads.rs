//! Everything but the internal force: resultants and tangents.

use crate::support::stand::{Field, KINDS, Stand, mesh, points, resultant, size};
use crate::terms::ghost;
use mpm::gravity::Gravity;
use mpm::interpolation::Ddmp;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::mesh::Mesh;
use mpm::mesh::faces::Faces;
use mpm::mesh::shape::CellKind;
use mpm::surface::{ActiveBoundary, Path, Piece};
use mpm::term::{BodyForce, EmptyCells, FacetPressure, Hydrostatic, Inertia, Phreatic, Role, Term, Traction};
use mpm::term::{Source, Spring, Springs, SurfaceLoad, SurfaceTraction, VirtualPressure};
use mpm::time_value::TimeValue;
use mpm::water_table::WaterLine;
use std::f64::consts::{PI, TAU};

pub type Make = fn(&Mesh<2>) -> Box<dyn Term<2>>;

/// 3 kPa inwards and 2·0.5 kPa upwards at the time of the test, in the first phase.
fn traction<K: Kinematics<2>>(mesh: &Mesh<2>, group: &str) -> Box<dyn Term<2>> {
    let value = [TimeValue::Constant(-3.0), TimeValue::Rate(2.0)];
    Box::new(Traction::<K, 2>::new(mesh, mesh.group(group).unwrap(), 0, value))
}

fn body_force<K: Kinematics<2>>(_: &Mesh<2>) -> Box<dyn Term<2>> {
    let factors = [TimeValue::Rate(1.5), TimeValue::Constant(0.0)];
    let gravity = factors.map(|factor| Gravity::Scaled { whole: [0.5, -10.0], factor });
    Box::new(BodyForce::<K, 2>::new(gravity.to_vec()))
}

/// Springs and dashpots at an angle under two nodes.
fn springs(_: &Mesh<2>) -> Box<dyn Term<2>> {
    let of = |node, [across, along]: [f64; 2]| {
        [[across + along, across - along], [across - along, across + along]]
            .map(|row| row.map(|k| 0.5 * k + f64::from(node)))
    };
    let spring = |node| Spring { node, stiffness: of(node, [70.0, 20.0]), damping: of(node, [0.3, 0.8]) };
    Box::new(Springs([spring(0), spring(3)].into()))
}

/// The points fill every third cell, so that there are soft ones of all kinds.
pub fn stand<K: Kinematics<2>>(kind: CellKind, make: Make, whole: bool) -> Stand<K> {
    let mesh = mesh(kind);
    let term = make(&mesh);
    let points = points(&mesh, |c| c % 3 == 0);
    Stand::new(mesh, points, term, true, whole)
}

pub fn anywhere<K: Kinematics<2>>(stand: &Stand<K>) -> (Field, Field) {
    let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.1 * y, 0.1 * x]);
    let trial = stand.field(0.02, 2, |[x, y]| [0.2 * x - 0.4 * y, 0.5 * x - 0.2 * y]);
    (trial, converged)
}

fn every_tangent<K: Kinematics<2>>() {
    let terms: [(&str, Make); 7] = [
        ("springs", springs),
        ("body force", body_force::<K>),
        ("inertia", |_| Box::new(Inertia::<K>::default())),
        ("empty cells", |mesh| Box::new(EmptyCells::<K>::new(70.0, mesh.cells.len()))),
        ("ghost penalty", ghost::penalty::<K>),
        ("ghost inertia", ghost::inertia::<K>),
        ("traction", |mesh| traction::<K>(mesh, "right")),
    ];
    for (name, make) in terms {
        for kind in KINDS {
            let whole = stand::<K>(kind, make, true);
            let (trial, converged) = anywhere(&whole);
            let error = whole.tangent_error(&trial, &converged);
            // Residuals that are linear in u: the difference is exact but for rounding.
            assert!(error < 1e-8, "{name}, {kind:?}: {error:.1e}");
            assert!(whole.term().symmetric());
            let asymmetry = whole.asymmetry(&trial, &converged);
            assert!(asymmetry < 1e-13, "{name}, {kind:?}: {asymmetry:.1e}");
            let half = stand::<K>(kind, make, false);
            let (a, b) = [&whole, &half].map(|s| s.evaluate(&trial, &converged, 0, true).1).into();
            let largest = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(largest < 1e-9, "{name}, {kind:?}: {largest:.1e}");
        }
    }
}

#[test]
fn every_tangent_is_the_derivative_and_symmetric() {
    every_tangent::<PlaneStrain>();
    every_tangent::<Axisymmetric>();
}

#[test]
fn the_body_force_is_the_weight_times_its_factor() {
    for kind in KINDS {
        let stand = stand::<PlaneStrain>(kind, body_force::<PlaneStrain>, false);
        assert_eq!(stand.term().role(), Role::External);
        let mass: f64 = stand.state.points.mass.iter().sum();
        let (trial, converged) = anywhere(&stand);
        let sum = resultant(&stand.evaluate(&trial, &converged, 0, false).0);
        // An applied force has the other sign in the residual.
        for (sum, g) in sum.iter().zip([0.5, -10.0]) {
            let weight = -1.5 * 0.5 * mass * g;
            assert!((sum - weight).abs() < 1e-12 * weight.abs(), "{kind:?}: {sum} {weight}");
        }
        assert_eq!(size(&stand.evaluate(&trial, &converged, 1, false).0), 0.0);
    }
}

#[test]
fn inertia_is_mass_times_acceleration() {
    for kind in KINDS {
        let stand = stand::<Axisymmetric>(kind, |_| Box::new(Inertia::<Axisymmetric>::default()), false);
        assert_eq!(stand.term().role(), Role::Inertia);
        let mass: f64 = stand.state.points.mass.iter().sum();
        let rest = stand.field(0.0, 1, |_| [0.0; 2]);
        let sum = resultant(&stand.evaluate(&rest, &rest, 0, false).0);
        for (sum, a) in sum.iter().zip([1.3, -0.7]) {
            assert!((sum - mass * a).abs() < 1e-12 * mass, "{kind:?}: {sum} {}", mass * a);
        }
    }
}

/// The penalty resists strain: not what moves by without turning in the step, with next to nothing what turns, and not what happened
/// before it.
#[test]
fn empty_cells_resist_strain_in_the_step() {
    for kind in KINDS {
        let stand =
            stand::<PlaneStrain>(kind, |mesh| Box::new(EmptyCells::<PlaneStrain>::new(70.0, mesh.cells.len())), false);
        assert_eq!(stand.term().role(), Role::Internal);
        assert!(stand.partly_filled_cells() > stand.scene.mesh.cells.len() / 2);
        let (strained, converged) = anywhere(&stand);
        let resisted = size(&stand.evaluate(&strained, &converged, 0, false).0);
        assert!(resisted > 1.0);
        let moved = |by: fn([f64; 2]) -> [f64; 2]| {
            let step = stand.field(0.0, 1, by);
            let trial: Field = converged.iter().zip(&step).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
            stand.evaluate(&trial, &converged, 0, false).0
        };
        let shifted = size(&moved(|_| [0.3, -0.4]));
        assert!(shifted < 1e-13 * resisted, "{kind:?}: {shifted:.1e}");
        // A turn has the gradients of a shear, of which a millionth acts.
        let turned = size(&moved(|[x, y]| [-0.2 * y, 0.2 * x]));
        let sheared = size(&moved(|[x, y]| [0.2 * y, 0.2 * x]));
        assert!((turned / sheared - 1e-6).abs() < 0.5e-6, "{kind:?}: {turned:.3e} of {sheared:.3e}");
        let sum = resultant(&moved(|[x, y]| [x * y, x - y]));
        assert!(sum.iter().all(|s| s.abs() < 1e-11), "{kind:?}: {sum:?}");
    }
}

/// The rectangle is `[2, 4] × [0, 1.5]` m.
#[test]
fn a_traction_adds_up_to_its_value_times_the_area() {
    let ring = PI * (4.0 * 4.0 - 2.0 * 2.0);
    for kind in KINDS {
        for (group, length, turned) in
            [("right", 1.5, TAU * 4.0 * 1.5), ("left", 1.5, TAU * 2.0 * 1.5), ("top", 2.0, ring), ("bottom", 2.0, ring)]
        {
            check_traction::<PlaneStrain>(kind, group, length);
            check_traction::<Axisymmetric>(kind, group, turned);
        }
    }
}

fn check_traction<K: Kinematics<2>>(kind: CellKind, group: &str, area: f64) {
    let mesh = mesh(kind);
    let (term, points) = (traction::<K>(&mesh, group), points(&mesh, |_| true));
    let stand = Stand::<K>::new(mesh, points, term, false, false);
    assert_eq!(stand.term().role(), Role::External);
    // A dead load: the same whatever the deformation.
    let (trial, converged) = anywhere(&stand);
    let sum = resultant(&stand.evaluate(&trial, &converged, 0, false).0);
    for (sum, t) in sum.iter().zip([-3.0, 1.0]) {
        let force = -t * area;
        assert!((sum - force).abs() < 1e-12 * force.abs(), "{kind:?}, {group}: {sum} {force}");
    }
    assert_eq!(size(&stand.evaluate(&trial, &converged, 1, false).0), 0.0, "another phase");
}

/// Water up to the middle of the mesh, and 2 kPa above.
fn head() -> Vec<Option<Hydrostatic>> {
    let [top, gradient, datum] = [2.0, 10.0, 0.8].map(TimeValue::Constant);
    vec![Some(Hydrostatic { top, gradient, datum, band: 0.2 }), None]
}

fn pressures<K: Kinematics<2>>() {
    let terms: [(&str, Make); 2] = [
        ("points", |_| Box::new(VirtualPressure::<K>::new(head()))),
        ("facets", |mesh| Box::new(FacetPressure::<K>::new(mesh, |_| true, head()))),
    ];
    for (name, make) in terms {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let mut stand = stand::<K>(kind, make, true);
                stand.alpha_f = alpha_f;
                let (trial, converged) = afloat(&stand);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{name}, {kind:?}: {error:.1e}");
                // The whole boundary of a body: the pressure has a potential.
                let asymmetry = stand.asymmetry(&trial, &converged);
                assert!(asymmetry < 1e-11, "{name}, {kind:?}: {asymmetry:.1e}");
                assert!(stand.term().symmetric());
                assert_eq!(size(&stand.evaluate(&trial, &converged, 1, false).0), 0.0);
            }
        }
    }
}

/// A pressure on the right side of the mesh, which has ends: the tangent is the derivative, and not symmetric.
#[test]
fn a_pressure_on_a_curve_has_its_tangent() {
    for kind in KINDS {
        let on_side = |mesh: &Mesh<2>| {
            let right = mesh.nodes.iter().map(|x| x[0]).fold(f64::MIN, f64::max);
            let on = |&(c, side): &(u32, u8)| {
                let of_facet = mesh.cells.kind[c as usize].facets().1[side as usize];
                of_facet.iter().all(|&i| mesh.nodes[mesh.cells.nodes(c as usize)[i] as usize][0] > right - 1e-9)
            };
            Faces::of(mesh).boundary.into_iter().filter(on).collect::<Vec<_>>()
        };
        let mesh = mesh(kind);
        let facets = on_side(&mesh);
        let points = points(&mesh, |c| c % 3 == 0);
        let mut stand = Stand::<PlaneStrain>::new(
            mesh,
            points,
            Box::new(FacetPressure::<PlaneStrain>::on(facets, head())),
            true,
            true,
        );
        for alpha_f in [0.0, 0.4] {
            stand.alpha_f = alpha_f;
            let (trial, converged) = anywhere(&stand);
            let error = stand.tangent_error(&trial, &converged);
            assert!(error < 1e-6, "{kind:?}: {error:.1e}");
            assert!(!stand.term().symmetric() && stand.term().source() == Source::Load);
        }
    }
}

/// Water in the lower third of the mesh.
fn lower() -> Vec<Option<Hydrostatic>> {
    let [top, gradient, datum] = [0.0, 10.0, 0.5].map(TimeValue::Constant);
    vec![Some(Hydrostatic { top, gradient, datum, band: 0.1 }), None]
}

/// The same as water in the pores.
fn in_pores(heads: Vec<Option<Hydrostatic>>) -> Vec<Option<Phreatic>> {
    heads.into_iter().map(|head| head.map(Phreatic::from)).collect()
}

/// Water in the pores below a line without corners within the mesh.
fn inclined() -> Vec<Option<Phreatic>> {
    let [top, gradient, datum] = [0.0, 10.0, 0.0].map(TimeValue::Constant);
    let line = WaterLine(vec![[-5.0, -0.5], [9.0, 2.3]].into());
    vec![Some(Phreatic::under(line, Hydrostatic { top, gradient, datum, band: 0.1 })), None]
}

/// Water in the pores up to another level than outside, up to the same, without any outside, and below a line.
fn water_in_pores<K: Kinematics<2>>() {
    let terms: [Make; 6] = [
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(inclined(), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(Vec::new()).with_pores(inclined(), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(in_pores(head()), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(in_pores(head()), vec![false])),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(in_pores(lower()), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(Vec::new()).with_pores(in_pores(head()), vec![true])),
    ];
    for (number, make) in terms.into_iter().enumerate() {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let mut stand = stand::<K>(kind, make, true);
                stand.alpha_f = alpha_f;
                let (trial, converged) = afloat(&stand);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{number}, {kind:?}: {error:.1e}");
                assert!(!stand.term().symmetric());
            }
        }
    }
}

/// As [`anywhere`], with the levels of [`head`] and [`lower`] within the mesh in both states.
fn afloat<K: Kinematics<2>>(stand: &Stand<K>) -> (Field, Field) {
    let trial = stand.field(0.02, 2, |[x, y]| [0.2 * x - 0.4 * y, 0.1 * x - 0.2 * y]);
    (trial, anywhere(stand).1)
}

/// A stand whose points weigh what their cells do, with a level set that is `inside` at the nodes.
fn filled<K: Kinematics<2>>(kind: CellKind, make: Make, inside: fn(&[f64; 2]) -> f64) -> Stand<K> {
    let mesh = mesh(kind);
    let mut points = points(&mesh, |_| true);
    for (volume, &c) in points.initial_volume.iter_mut().zip(&points.cell) {
        let kind = mesh.cells.kind[c as usize];
        let corners: Vec<_> =
            mesh.cells.nodes(c as usize)[..kind.corner_count()].iter().map(|&n| mesh.nodes[n as usize]).collect();
        let n = corners.len();
        let centre = [0, 1].map(|d| corners.iter().map(|x| x[d]).sum::<f64>() / n as f64);
        let turned = |i: usize| corners[i][0] * corners[(i + 1) % n][1] - corners[i][1] * corners[(i + 1) % n][0];
        *volume = K::measure(&centre) * 0.5 * (0..n).map(turned).sum::<f64>() / 3.0;
    }
    let term = make(&mesh);
    let mut stand = Stand::new(mesh, points, term, true, true);
    stand.state.weights.level_set = stand.scene.mesh.nodes.iter().map(inside).collect();
    stand
}

/// Where it bends in the cells and the surface is known, the pressure is summed over other places than the points.
fn in_layers<K: Kinematics<2>>() {
    let terms: [Make; 5] = [
        |_| Box::new(VirtualPressure::<K>::new(head())),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(inclined(), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(Vec::new()).with_pores(inclined(), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(in_pores(head()), vec![true])),
        |_| Box::new(VirtualPressure::<K>::new(head()).with_pores(in_pores(lower()), vec![true])),
    ];
    for (number, make) in terms.into_iter().enumerate() {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let mut stand = filled::<K>(kind, make, |x| x[0] - 2.2 + 0.2 * x[1]);
                stand.alpha_f = alpha_f;
                let (trial, converged) = afloat(&stand);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{number}, {kind:?}: {error:.1e}");
                if number == 0 {
                    let asymmetry = stand.asymmetry(&trial, &converged);
                    assert!(asymmetry < 1e-11, "{kind:?}: {asymmetry:.1e}");
                }
                let by_places = stand.evaluate(&trial, &converged, 0, false).0;
                stand.state.weights.level_set.clear();
                let by_points = stand.evaluate(&trial, &converged, 0, false).0;
                let difference = by_places.iter().zip(&by_points).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]);
                let difference = size(&difference.collect::<Vec<_>>()) / size(&by_points);
                assert!(difference > 1e-3, "{number}, {kind:?}: {difference:.1e}");
            }
        }
    }
}

#[test]
fn the_tangent_of_a_pressure_that_bends_within_cells_is_its_derivative() {
    in_layers::<PlaneStrain>();
    in_layers::<Axisymmetric>();
}

/// The level of the water lies in cells that are full: it is felt on the boundary alone.
fn felt_within<K: Kinematics<2>>() {
    for kind in [CellKind::T3, CellKind::T6] {
        let stand = filled::<K>(kind, |_| Box::new(VirtualPressure::<K>::new(lower())), |_| 1.0);
        let rest = stand.field(0.0, 1, |_| [0.0; 2]);
        let force = stand.evaluate(&rest, &rest, 0, false).0;
        let within = |x: &[f64; 2]| x[0] > 2.0 + 1e-9 && x[0] < 4.0 - 1e-9 && x[1] > 1e-9 && x[1] < 1.5 - 1e-9;
        let felt: Vec<_> =
            stand.scene.mesh.nodes.iter().zip(&force).filter(|(x, _)| within(x)).map(|(_, f)| *f).collect();
        assert!(!felt.is_empty() && size(&felt) < 1e-13 * size(&force), "{kind:?}: {:.1e}", size(&felt));
    }
}

#[test]
fn a_level_within_full_cells_is_felt_on_their_boundary_alone() {
    felt_within::<PlaneStrain>();
    felt_within::<Axisymmetric>();
}

#[test]
fn the_tangent_of_water_in_pores_is_its_derivative() {
    water_in_pores::<PlaneStrain>();
    water_in_pores::<Axisymmetric>();
}

#[test]
fn the_tangent_of_a_pressure_all_around_is_its_derivative_and_symmetric() {
    pressures::<PlaneStrain>();
    pressures::<Axisymmetric>();
}

#[test]
fn the_tangent_of_a_pressure_is_its_derivative_with_smooth_gradients() {
    for kind in [CellKind::T6, CellKind::Q4] {
        let mesh = mesh(kind);
        let points = points(&mesh, |_| true);
        let term = Box::new(VirtualPressure::<Axisymmetric>::new(head()));
        let scheme = &Ddmp;
        let stand = Stand::<Axisymmetric>::with(scheme, mesh, points, term, false, true, None);
        let (trial, converged) = afloat(&stand);
        let error = stand.tangent_error(&trial, &converged);
        assert!(error < 1e-6, "{kind:?}: {error:.1e}");
    }
}

/// Pressure, shear and a fixed traction on a part of pieces in all cells, one of them in_host beyond its cell.
fn on_pieces<K: Kinematics<2>>() {
    let constant = TimeValue::Constant;
    let none = || SurfaceLoad {
        phase: 0,
        region: None,
        pressure: None,
        shear: constant(0.0),
        components: [constant(0.0), constant(0.0)],
        within: None,
    };
    let all = SurfaceLoad {
        pressure: head().remove(0),
        shear: TimeValue::Rate(3.0),
        components: [constant(2.0), TimeValue::Rate(-5.0)],
        within: Some([[2.3, 3.5], [0.1, 1.7]]),
        ..none()
    };
    let loads =
        [SurfaceLoad { pressure: head().remove(0), ..none() }, SurfaceLoad { shear: constant(4.0), ..none() }, all];
    for load in loads {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let mesh = mesh(kind);
                let points = points(&mesh, |_| true);
                let cells = mesh.cells.len() as u32;
                let term = Box::new(SurfaceTraction::<K>::new(vec![load.clone()]));
                let mut stand = Stand::<K>::new(mesh, points, term, true, true);
                stand.alpha_f = alpha_f;
                let piece = |cell: u32| {
                    let in_host = Path {
                        ends: if cell == 0 { [[1.1, -0.2], [0.4, 0.9]] } else { [[0.2, 0.1], [0.3, 0.6]] },
                        rates: [[0.1, 0.4], [-0.1, 0.6]],
                    };
                    let path = Path::straight([[0.2, 0.1], [0.3, 0.6]]);
                    Piece { cell, path, wall: false, region: 0, host: cell, in_host }
                };
                stand.state.weights.boundary =
                    ActiveBoundary { pieces: (0..cells).map(piece).collect(), first: vec![0, cells] };
                let (trial, converged) = anywhere(&stand);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{kind:?}: {error:.1e}");
                assert!(size(&stand.evaluate(&trial, &converged, 0, false).0) > 0.1 && !stand.term().symmetric());
                assert_eq!(size(&stand.evaluate(&trial, &converged, 1, false).0), 0.0);
            }
        }
    }
}

#[test]
fn the_tangent_of_loads_on_the_surface_is_their_derivative() {
    on_pieces::<PlaneStrain>();
    on_pieces::<Axisymmetric>();
}
