//! The pressure of water, or of a load on a curve, on a rigid body: `−∫ p n dS` over its boundary or a part of it in the trial pose, and the moment
//! of that about the reference point.
//!
//! The boundary turns with the body, its normals too. It is closed, so that water has a potential and its tangent is symmetric; that of a load on
//! a curve is not.

use super::facet_pressure::integrate;
use super::hydrostatic::Hydrostatic;
use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use crate::geometry::dot;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::rigid::{Body, Pose, across};
use crate::system::Local;
use std::f64::consts::TAU;
use std::marker::PhantomData;

/// The nodes (m) of a facet, ends and then the middle, and how many there are.
type Facet = ([[f64; 2]; 3], usize);

/// A pressure on a rigid body.
pub struct RigidPressure<K> {
    body: Body<2>,
    /// Its number in the scene.
    number: usize,
    heads: Vec<Option<Hydrostatic>>,
    /// The boundary when the run began, from the reference point.
    facets: Vec<Facet>,
    source: Source,
    kinematics: PhantomData<K>,
}

impl<K> RigidPressure<K> {
    /// Water: `heads[i]` acts in phase `i` on the body with that `number` in the scene, whose cells are in `mesh` as the run begins.
    pub fn new(body: &Body<2>, number: usize, mesh: &Mesh<2>, heads: Vec<Option<Hydrostatic>>) -> Self {
        let own = mesh.part(|c| mesh.cells.region[c] == body.region);
        let of_water = Self::on((body, number), &own, &Faces::of(&own).boundary, heads);
        Self { source: Source::Water, ..of_water }
    }

    /// A load: `heads[i]` acts in phase `i` on `facets` of `mesh`, by their cells and sides, which are those of the body with that number.
    pub fn on(
        (body, number): (&Body<2>, usize),
        mesh: &Mesh<2>,
        facets: &[(u32, u8)],
        heads: Vec<Option<Hydrostatic>>,
    ) -> Self {
        let facet = |&(c, side): &(u32, u8)| {
            let nodes = mesh.cells.nodes(c as usize);
            let of_facet = mesh.cells.kind[c as usize].facets().1[side as usize];
            let mut x = [[0.0; 2]; 3];
            for (x, &i) in x.iter_mut().zip(of_facet) {
                *x = [0, 1].map(|d| mesh.nodes[nodes[i] as usize][d] - body.centre[d]);
            }
            (x, of_facet.len())
        };
        let facets = facets.iter().map(facet).collect();
        Self { body: body.clone(), number, heads, facets, source: Source::Load, kinematics: PhantomData }
    }
}

impl<K: Kinematics<2>> RigidPressure<K> {
    /// Adds force and moment, and their tangent: `x = c + R(θ) r` and `n = R(θ) n₀`.
    fn add(&self, head: &Hydrostatic, trial: &Trial<2>, pose: &Pose<2>, local: &mut Local) {
        let head = head.at(trial.time).sharp();
        let centre = [0, 1].map(|d| self.body.centre[d] + pose.moved[d]);
        let (share, turns) = (1.0 - trial.alpha_f, self.body.dofs.rotation.is_some());
        for (from, count) in &self.facets {
            let x = from.map(|from| {
                let arm = pose.turn(&from);
                [centre[0] + arm[0], centre[1] + arm[1]]
            });
            integrate(&x[..*count], &head.breaks(), |place| {
                let [p, growth, _] = head.at(place.x[1]);
                let (measure, by_radius) = (K::measure(&place.x), if K::HOOP { TAU } else { 0.0 });
                let arm = [0, 1].map(|d| place.x[d] - centre[d]);
                let weighed = place.normal.map(|n| place.weight * n);
                let force = weighed.map(|n| p * measure * n);
                let [_, moment] = self.body.hand_on(&arm, &force);
                local.vector[0] += force[0];
                local.vector[1] += force[1];
                if turns {
                    local.vector[2] += moment[0];
                }
                if local.matrix.is_empty() {
                    return;
                }
                // By the place, and by the arc along which the body turns.
                let by_x = weighed.map(|n| [p * by_radius * n, growth * measure * n]);
                let way = across(&arm).map(|d| d / self.body.dofs.arm);
                let turned = across(&force).map(|f| f / self.body.dofs.arm);
                let by_arc = [0, 1].map(|d| dot(&by_x[d], &way) + turned[d]);
                let size = local.size;
                for d in 0..2 {
                    for e in 0..2 {
                        local.matrix[d * size + e] += share * by_x[d][e];
                    }
                    if turns {
                        local.matrix[d * size + 2] += share * by_arc[d];
                        local.matrix[2 * size + d] += share * (way[0] * by_x[0][d] + way[1] * by_x[1][d]);
                    }
                }
                if turns {
                    let bent = dot(&force, &arm) / self.body.dofs.arm.powi(2);
                    local.matrix[2 * size + 2] += share * (dot(&way, &by_arc) - bent);
                }
            });
        }
    }
}

impl<K: Kinematics<2>> Term<2> for RigidPressure<K> {
    fn source(&self) -> Source {
        self.source
    }

    fn symmetric(&self) -> bool {
        self.source == Source::Water
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        let Some(head) = self.heads.get(trial.phase).and_then(Option::as_ref) else { return Ok(()) };
        let pose = self.body.pose_since(frame.reset, trial.between);
        let compute = |_: &usize, local: &mut Local| {
            self.add(head, trial, &pose, local);
            Ok(())
        };
        let coupling = |&number: &usize| frame.bodies[number] as usize;
        out.scatter(frame.pattern, &[self.number], coupling, compute)
    }
}
