//! Contact: the forces of contact nodes that are apart, stick, slide and are limited, and their tangent.

use crate::support::Random;
use crate::support::stand::{Field, Stand, mesh, points, resultant, size};
use crate::terms::loads::anywhere;
use mpm::contact::{Constraint, Law, Penalty, Spot};
use mpm::kinematics::PlaneStrain;
use mpm::mesh::shape::CellKind;
use mpm::term::{Contact, Hydrostatic, Phreatic, PlacedConstraint, WaterLevels};
use mpm::time_value::TimeValue;

fn law(friction: f64, adhesion: f64, factor: Option<f64>) -> Law {
    Law { friction, adhesion, factor, tension: 0.0, sealed: false }
}

/// A stand with contact nodes between the first nodes of a cell, as a structure, and the rest of them: each moves as one where
/// the weights of each sum to one. The first contact node is `apart`, the others overlap by up to a millimetre.
fn stand(law: Law, apart: f64) -> Stand<PlaneStrain> {
    stand_in_water(law, apart, None)
}

/// The same where water stands otherwise in the pores than outside.
fn stand_in_water(law: Law, apart: f64, levels: Option<WaterLevels>) -> Stand<PlaneStrain> {
    let mesh = mesh(CellKind::T6);
    let points = points(&mesh, |_| true);
    let mut stand = Stand::new(mesh, points, Box::new(Contact::new(0, law, levels)), true, law.friction > 0.0);
    let mut random = Random(7);
    for contact_node in 0..4u32 {
        let cell = 2 * contact_node;
        let nodes = stand.scene.mesh.cells.nodes(cell as usize).to_vec();
        let mut share = || {
            let values: Vec<f64> = (0..3).map(|_| 1.5 + random.next()).collect();
            let sum: f64 = values.iter().sum();
            values.into_iter().map(move |v| v / sum)
        };
        let weights: Vec<f64> = share().map(|v| -v).collect::<Vec<_>>().into_iter().chain(share()).collect();
        let angle = f64::from(contact_node);
        let normal = [angle.cos(), angle.sin()];
        let constraint = Constraint {
            contact_node,
            area: 0.3 + 0.1 * angle,
            wet: Some([0.0, angle]),
            gap: if contact_node == 0 { apart } else { -1e-3 * angle },
            by_normal: weights.iter().map(|w| normal.map(|n| w * n)).collect(),
            by_tangent: weights.iter().map(|w| [-normal[1] * w, normal[0] * w]).collect(),
            curvature: 40.0 * (angle - 1.0),
            by_arc: weights.iter().map(|w| [-normal[1] * w, 1.1 * normal[0] * w]).collect(),
            // A part of the contact node may bear while the rest is apart.
            spots: [-1.0, 1.0].map(|side| Spot { share: 0.5, along: 0.02 * side, open: 1e-3 * side }).to_vec(),
            looks_ahead: contact_node.is_multiple_of(2),
            own: 3,
            nodes,
            penalty: Penalty {
                pressure: 20.0,
                shear: angle - 2.0,
                normal: 5e3,
                tangential: 5e2,
                rounding: 0.5,
                fading: 5e-3,
                bonded: true,
                strength: 30.0,
                water: 0.0,
            },
        };
        let coupling = stand.grid.coupling[cell as usize];
        let place = (0..6).collect();
        stand.grid.constraints.push(PlacedConstraint {
            interface: 0,
            condition: constraint,
            initially_closed: false,
            coupling,
            place,
        });
    }
    stand
}

/// A motion `size` times as large as any.
fn small(stand: &Stand<PlaneStrain>, size: f64) -> (Field, Field) {
    let (trial, converged) = anywhere(stand);
    let nearer = |(u, c): (&[f64; 2], &[f64; 2])| [0, 1].map(|d| c[d] + size * (u[d] - c[d]));
    (trial.iter().zip(&converged).map(nearer).collect(), converged)
}

#[test]
fn the_tangent_is_the_derivative() {
    for law in [law(0.0, 0.0, None), law(0.4, 0.0, None), law(0.3, 2.0, Some(0.3)), law(0.0, 0.0, Some(0.5))] {
        let stand = stand(law, 10.0);
        // Small motions stick, larger ones slide.
        for size in [1e-5, 1e-3, 3e-2] {
            let (trial, converged) = small(&stand, size);
            let error = stand.tangent_error(&trial, &converged);
            assert!(error < 1e-6, "{law:?} {size}: {error:.1e}");
            if law.friction == 0.0 {
                assert!(stand.asymmetry(&trial, &converged) < 1e-14, "{law:?}");
            }
        }
    }
}

/// Nor does it matter whether water stands higher in the pores or outside.
#[test]
fn water_levels_do_not_change_with_the_motion() {
    let below = |level: f64| {
        let [top, gradient, datum] = [0.0, 5.0, level].map(TimeValue::Constant);
        vec![Some(Hydrostatic { top, gradient, datum, band: 0.1 })]
    };
    for [outside, inside] in [[1.0, 4.0], [4.0, 1.0]] {
        let in_pores = || below(inside).into_iter().map(|head| head.map(Phreatic::from)).collect();
        let levels = || Some(WaterLevels::new(below(outside), in_pores()));
        let stand = stand_in_water(law(0.02, 0.0, None), 10.0, levels());
        let dry = stand_in_water(law(0.02, 0.0, None), 10.0, None);
        let mut differ = false;
        for size in [1e-5, 1e-3, 3e-2] {
            let (trial, converged) = small(&stand, size);
            let error = stand.tangent_error(&trial, &converged);
            assert!(error < 1e-6, "{outside} {inside} {size}: {error:.1e}");
            let [wet, dry] = [&stand, &dry].map(|stand| stand.evaluate(&trial, &converged, 0, false).0);
            differ |= wet != dry;
        }
        assert!(differ, "{outside} {inside}");
    }
}

/// Held contact nodes that lie there without pressure stick by the friction that they have none of yet, as those with adhesion enough do; where the
/// gap varies under them, at their nearest place.
#[test]
fn initially_closed_contact_nodes_stick() {
    let unpressed = |law: Law, held: bool, even: bool| {
        let mut stand = stand(law, 10.0);
        stand.held = held;
        for constraint in &mut stand.grid.constraints {
            (constraint.initially_closed, constraint.condition.penalty.pressure, constraint.condition.penalty.shear) =
                (true, 0.0, 0.0);
            constraint.condition.gap = constraint.condition.gap.abs();
            if even {
                constraint.condition.spots.clear();
            }
        }
        stand
    };
    let rough = law(0.3, 0.0, None);
    let held = unpressed(rough, true, true);
    let (trial, converged) = small(&held, 1e-3);
    let answer = |stand: &Stand<PlaneStrain>| stand.evaluate(&trial, &converged, 0, false).0;
    let bonded = unpressed(Law { tension: f64::INFINITY, adhesion: 1e9, ..rough }, false, true);
    assert_eq!(answer(&held), answer(&bonded));
    assert_ne!(answer(&held), answer(&unpressed(law(0.0, 0.0, None), true, true)));
    for stand in [held, unpressed(rough, true, false)] {
        assert!(stand.tangent_error(&trial, &converged) < 1e-6);
    }
}

/// Held together, contact nodes that pressed bear what those that cannot part bear, with its tangent; others do as ever.
#[test]
fn contact_nodes_that_touched_are_held_together() {
    for law in [law(0.0, 0.0, None), law(0.3, 2.0, Some(0.3)), law(0.0, 0.0, Some(0.5))] {
        let held = || {
            let mut stand = stand(law, 10.0);
            stand.held = true;
            stand
        };
        let (trial, converged) = anywhere(&held());
        let answer = |stand: &Stand<PlaneStrain>| stand.evaluate(&trial, &converged, 0, false).0;
        let bonded = stand(Law { tension: f64::INFINITY, ..law }, 10.0);
        assert_eq!(answer(&held()), answer(&bonded));
        assert_ne!(answer(&held()), answer(&stand(law, 10.0)));
        assert!(held().tangent_error(&trial, &converged) < 1e-6, "{law:?}");
        let [mut strange, mut free] = [held(), stand(law, 10.0)];
        for constraint in strange.grid.constraints.iter_mut().chain(&mut free.grid.constraints) {
            constraint.condition.penalty.pressure = 0.0;
        }
        assert_eq!(answer(&strange), answer(&free));
    }
}

#[test]
fn what_the_soil_bears_the_structure_gives() {
    let stand = stand(law(0.4, 0.0, None), -1e-3);
    let (_, converged) = anywhere(&stand);
    let force = stand.evaluate(&converged, &converged, 0, false).0;
    let (sum, whole) = (resultant(&force), size(&force));
    assert!(whole > 1.0 && sum[0].hypot(sum[1]) < 1e-12 * whole, "{sum:?} {whole}");
    // Of the contact node that is apart nothing comes.
    let mut alone = self::stand(law(0.4, 0.0, None), 10.0);
    alone.grid.constraints.truncate(1);
    assert_eq!(size(&alone.evaluate(&converged, &converged, 0, false).0), 0.0);
}
