//! Contact of rigid bodies: the conditions of an interface by the unknowns of the bodies in place of their nodes.
//!
//! A node at `r` from the reference point moves by `Δc + Δθ e_z × r`, so that the derivatives of gap and slip by its
//! displacement add up to one by that of the reference point and one by the rotation.

use super::along::Mark;
use super::constraint::{Constraint, Entry, add};
use super::interface::{Ground, Interface, Pushed};
use super::multipliers::Multipliers;
use super::sides::Sides;
use super::surface::Run;
use crate::points::Points;
use crate::rigid::Body;
use crate::surface::{ContactStatus, Cover};

/// An interface with a rigid side, or two.
pub struct Rigid<const D: usize> {
    interface: Box<dyn Interface<D>>,
    bodies: Vec<Body<D>>,
    /// The number of the body of each node, else `u32::MAX`.
    body: Vec<u32>,
}

impl<const D: usize> Rigid<D> {
    /// `interface` with `bodies` that keep their shape, in a mesh with so many nodes.
    pub fn new(interface: Box<dyn Interface<D>>, bodies: &[Body<D>], nodes: usize) -> Self {
        let mut body = vec![u32::MAX; nodes];
        for (b, of) in (0..).zip(bodies) {
            for &n in &of.nodes {
                body[n as usize] = b;
            }
        }
        Self { interface, bodies: bodies.to_vec(), body }
    }

    /// How far (m) in front of the reference point of the structure its boundary is at a contact node, if that turns with it.
    fn distance(&self, constraint: &Constraint<D>, position: &dyn Fn(u32) -> [f64; D]) -> Option<f64> {
        let mut distance = 0.0;
        for (&n, normal) in constraint.nodes.iter().zip(&constraint.by_normal).take(constraint.own) {
            let body = self.bodies.get(self.body[n as usize] as usize)?;
            let (x, c) = (position(n), position(body.dofs.translation));
            distance -= (0..D).map(|d| normal[d] * (x[d] - c[d])).sum::<f64>();
        }
        (distance > 0.0).then_some(distance)
    }

    /// The constraint by the unknowns of the bodies: first the nodes of the structure that move it, then those that turn it,
    /// then those of the other side.
    fn condense(&self, constraint: Constraint<D>, position: &dyn Fn(u32) -> [f64; D]) -> Constraint<D> {
        let mut sides: [Vec<Entry<D, 3>>; 3] = Default::default();
        for (k, &n) in constraint.nodes.iter().enumerate() {
            let own = k < constraint.own;
            let [moving, turning] = if own { [0, 1] } else { [2, 2] };
            let (normal, tangent, arc) = (&constraint.by_normal[k], &constraint.by_tangent[k], &constraint.by_arc[k]);
            let Some(body) = self.bodies.get(self.body[n as usize] as usize) else {
                sides[moving].push((n, [*normal, *tangent, *arc]));
                continue;
            };
            let (x, c) = (position(n), position(body.dofs.translation));
            let arm = std::array::from_fn(|d| x[d] - c[d]);
            // A round body that turns takes no normal with it.
            let handed = [body.hand_on(&arm, normal), body.hand_on(&arm, tangent), [*arc, [0.0; D]]];
            for (i, (number, side)) in body.dofs.numbers().zip([moving, turning]).enumerate() {
                add(&mut sides[side], number, &handed.map(|of| of[i]));
            }
        }
        // Where the other side is a body: how the gap varies under the contact node is by how the two turn to each other, and a place at the
        // distance ρ in front of the reference point gets ½ ρ Δθ² farther away as the body turns.
        let mut curvature = constraint.curvature;
        if let (Some(distance), true) = (self.distance(&constraint, position), self.interface.sides().against.is_some())
        {
            curvature = 1.0 / distance;
            for (side, sign) in sides.iter_mut().zip([1.0, 1.0, -1.0]) {
                for (n, by) in side {
                    if let Some(body) = self.bodies.iter().find(|body| body.dofs.rotation == Some(*n)) {
                        by[2] = body.dofs.force(sign * distance);
                    }
                }
            }
        }
        let own = sides[0].len();
        let entries = || sides.iter().flatten();
        Constraint {
            own,
            curvature,
            nodes: entries().map(|e| e.0).collect(),
            by_normal: entries().map(|e| e.1[0]).collect(),
            by_tangent: entries().map(|e| e.1[1]).collect(),
            by_arc: entries().map(|e| e.1[2]).collect(),
            ..constraint
        }
    }
}

impl<const D: usize> Interface<D> for Rigid<D> {
    fn sides(&self) -> &Sides {
        self.interface.sides()
    }

    fn contact_nodes(&self) -> usize {
        self.interface.contact_nodes()
    }

    fn runs(&self) -> &[Run] {
        self.interface.runs()
    }

    fn constraints(
        &self,
        ground: &Ground<D>,
        position: &dyn Fn(u32) -> [f64; D],
        held: &Multipliers,
    ) -> Vec<Constraint<D>> {
        self.interface
            .constraints(ground, position, held)
            .into_iter()
            .map(|constraint| self.condense(constraint, position))
            .collect()
    }

    fn outlines(&self, position: &dyn Fn(u32) -> [f64; D]) -> Vec<Vec<[f64; D]>> {
        self.interface.outlines(position)
    }

    fn status(&self, held: &Multipliers) -> Vec<Vec<ContactStatus>> {
        self.interface.status(held)
    }

    fn lines(&self, position: &dyn Fn(u32) -> [f64; D]) -> Vec<Vec<Mark<D>>> {
        self.interface.lines(position)
    }

    fn covers(&self, constraints: &[Constraint<D>], position: &dyn Fn(u32) -> [f64; D]) -> Vec<Cover<D>> {
        self.interface.covers(constraints, position)
    }

    fn project_out(&self, points: &mut Points<D>, position: &dyn Fn(u32) -> [f64; D]) -> Pushed {
        self.interface.project_out(points, position)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{Law, Penalty};
    use super::*;
    use crate::mesh::Mesh;

    /// An interface with one constraint, between nodes 0 and 1 of a body and node 2 of soil.
    struct One(Sides);

    impl Interface<2> for One {
        fn sides(&self) -> &Sides {
            &self.0
        }

        fn contact_nodes(&self) -> usize {
            1
        }

        fn runs(&self) -> &[Run] {
            &[]
        }

        fn constraints(&self, _: &Ground<2>, _: &dyn Fn(u32) -> [f64; 2], _: &Multipliers) -> Vec<Constraint<2>> {
            vec![constraint()]
        }

        fn outlines(&self, _: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
            Vec::new()
        }

        fn lines(&self, _: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<Mark<2>>> {
            Vec::new()
        }

        fn project_out(&self, _: &mut Points<2>, _: &dyn Fn(u32) -> [f64; 2]) -> Pushed {
            Pushed::default()
        }
    }

    fn sides() -> Sides {
        let law = Law { friction: 0.0, adhesion: 0.0, factor: None, tension: 0.0, sealed: false };
        Sides { structure: 0, against: None, soils: Vec::new(), laws: law.into(), is_support: false }
    }

    fn constraint() -> Constraint<2> {
        Constraint {
            contact_node: 0,
            area: 1.0,
            gap: 0.3,
            wet: None,
            nodes: vec![0, 1, 2],
            own: 2,
            by_normal: vec![[-0.2, -0.3], [-0.4, -0.1], [0.6, 0.4]],
            by_tangent: vec![[0.3, -0.2], [0.1, -0.4], [-0.4, 0.6]],
            curvature: 0.0,
            by_arc: vec![[0.3, -0.2], [0.1, -0.4], [-0.4, 0.6]],
            spots: Vec::new(),
            looks_ahead: false,
            penalty: Penalty {
                pressure: 0.0,
                shear: 0.0,
                normal: 1.0,
                tangential: 1.0,
                rounding: 0.0,
                fading: 0.0,
                bonded: true,
                strength: 0.0,
                water: 0.0,
            },
        }
    }

    /// Gap and slip under a small motion of the body are those that its nodes give.
    #[test]
    fn a_body_opens_the_gap_as_its_nodes_do() {
        let mesh = Mesh { nodes: vec![[1.0, 0.5], [2.0, -0.5], [1.0, -2.0], [3.0, 1.5]], ..Mesh::default() };
        let body = Body::new(&mesh, 4, 0, vec![0, 1, 3], &Points::default(), true);
        let interface = Rigid::new(Box::new(One(sides())), std::slice::from_ref(&body), mesh.nodes.len());
        let condensed = interface.condense(constraint(), &|n| *mesh.nodes.get(n as usize).unwrap_or(&body.centre));
        assert_eq!((condensed.own, &condensed.nodes[..]), (1, &[4, 5, 2][..]));
        let (moved, turned, soil) = ([2e-6, -3e-6], 1e-6, [1e-6, 5e-6]);
        let pose = crate::rigid::Pose { moved, turned };
        let by_nodes = constraint().measure(|n| match n {
            2 => soil,
            n => {
                let x = mesh.nodes[n as usize];
                let to = body.place(&pose, &x);
                [to[0] - x[0], to[1] - x[1]]
            }
        });
        let by_body = condensed.measure(|n| match n {
            2 => soil,
            4 => moved,
            _ => body.dofs.arc(turned),
        });
        assert!((by_nodes.gap - by_body.gap).abs() < 1e-11 && (by_nodes.slip - by_body.slip).abs() < 1e-11);
        assert!((by_body.gap - 0.3).abs() > 1e-6 && by_body.slip.abs() > 1e-6, "{by_body:?}");
    }

    /// Soil that goes along a round body keeps its distance to third order in the way, seen from the body; the body may turn meanwhile.
    #[test]
    fn soil_that_flows_around_a_round_body_opens_no_gap() {
        let radius = 2.0;
        let round = Constraint {
            gap: 0.0,
            nodes: vec![0, 1],
            own: 1,
            by_normal: vec![[-1.0, 0.0], [1.0, 0.0]],
            by_tangent: vec![[0.0, -1.0], [0.0, 1.0]],
            curvature: 1.0 / radius,
            by_arc: vec![[0.0, -1.0], [0.0, 1.0]],
            ..constraint()
        };
        let gap_after = |angle: f64| {
            let along = [radius * (angle.cos() - 1.0), radius * angle.sin()];
            let motion = round.measure(|n| if n == 1 { along } else { [0.0; 2] });
            assert!((motion.turn - angle).abs() < angle.powi(2));
            motion.gap
        };
        let [coarse, fine] = [0.1, 0.05].map(gap_after);
        assert!(coarse.abs() < 1e-4 * radius && fine.abs() < coarse.abs() / 7.0, "{coarse} {fine}");

        let mesh = Mesh { nodes: vec![[radius, 0.0], [radius, 0.0], [-radius, 0.0]], ..Mesh::default() };
        let body = Body::new(&mesh, 3, 0, vec![0, 2], &Points::default(), true);
        let interface = Rigid::new(Box::new(One(sides())), std::slice::from_ref(&body), mesh.nodes.len());
        let condensed = interface.condense(round.clone(), &|n| *mesh.nodes.get(n as usize).unwrap_or(&body.centre));
        let turned = condensed.measure(|n| if Some(n) == body.dofs.rotation { body.dofs.arc(0.1) } else { [0.0; 2] });
        assert!(turned.gap == 0.0 && turned.turn == 0.0 && turned.slip != 0.0, "{turned:?}");
    }
}
