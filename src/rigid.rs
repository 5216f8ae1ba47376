//! Rigid bodies: structures that keep their shape, and walls.
//!
//! A body moves by its reference point, the centroid of its mass, and turns about it: `x = c + R(θ) (X − C)`. Two nodes
//! of no cell, after those of the mesh, have its unknowns: the *reference*, with the displacement of `c`, and the
//! *turning* node, whose first component is the arc `ℓ θ` (m) with `ℓ` the distance of the farthest node, so that all
//! unknowns are lengths and all equations forces. Anticlockwise is positive. Without rotation (axisymmetry) there is no
//! turning node.

use crate::mesh::Mesh;
use crate::points::Points;

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body<const D: usize> {
    /// Its region of the mesh; that of a wall has no cells.
    pub region: u16,
    /// The nodes that move with it.
    pub nodes: Vec<u32>,
    /// The first node that it adds to the mesh.
    pub first: u32,
    pub reference: u32,
    pub turning: Option<u32>,
    /// ℓ (m).
    pub arm: f64,
    /// Mass (t) and moment of inertia about the reference point (t m²).
    pub mass: f64,
    pub inertia: f64,
}

/// Where a body is: how far its reference point has moved (m), and its rotation (rad), since the run began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<const D: usize> {
    pub moved: [f64; D],
    pub turned: f64,
}

/// `v` turned by 90° in the plane: `e_z × v`.
pub fn across<const D: usize>(v: &[f64; D]) -> [f64; D] {
    const { assert!(D == 2, "bodies turn by one angle in the plane only") };
    std::array::from_fn(|d| match d {
        0 => -v[1],
        1 => v[0],
        _ => 0.0,
    })
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<const D: usize> Pose<D> {
    /// `R v`.
    pub fn turn(&self, v: &[f64; D]) -> [f64; D] {
        let (sin, cos) = self.turned.sin_cos();
        let across = across(v);
        std::array::from_fn(|d| if d < 2 { cos * v[d] + sin * across[d] } else { v[d] })
    }
}

impl<const D: usize> Body<D> {
    /// Appends the nodes of a body to a mesh: one with the centroid, mass and inertia of `points`, or of no mass at the
    /// middle of its `nodes`. Without `turns` it moves along the axis of symmetry only, and its reference point lies there.
    pub fn append(mesh: &mut Mesh<D>, region: u16, nodes: Vec<u32>, points: &Points<D>, turns: bool) -> Self {
        let mass: f64 = points.mass.iter().sum();
        // Without mass the volume tells the centroid.
        let weight = if mass > 0.0 { &points.mass } else { &points.initial_volume };
        let mut centre = [0.0; D];
        if weight.is_empty() {
            for &n in &nodes {
                centre = std::array::from_fn(|d| centre[d] + mesh.nodes[n as usize][d] / nodes.len() as f64);
            }
        }
        let whole: f64 = weight.iter().sum();
        for (x, weight) in points.position.iter().zip(weight) {
            centre = std::array::from_fn(|d| centre[d] + weight / whole * x[d]);
        }
        if !turns {
            centre[0] = 0.0;
        }
        let from = |x: &[f64; D]| -> [f64; D] { std::array::from_fn(|d| x[d] - centre[d]) };
        let square = |x: &[f64; D]| dot(&from(x), &from(x));
        let inertia = points.position.iter().zip(&points.mass).map(|(x, m)| m * square(x)).sum();
        let arm = nodes.iter().map(|&n| square(&mesh.nodes[n as usize])).fold(0.0, f64::max).sqrt();
        let reference = mesh.nodes.len() as u32;
        mesh.nodes.push(centre);
        let turning = turns.then(|| {
            mesh.nodes.push(centre);
            reference + 1
        });
        Self { region, nodes, first: reference, reference, turning, arm, mass, inertia }
    }

    /// The nodes with its unknowns.
    pub fn carriers(&self) -> impl Iterator<Item = u32> {
        std::iter::once(self.reference).chain(self.turning)
    }

    /// Its pose, given how far (m) nodes have come since the run began.
    pub fn pose(&self, travel: impl Fn(u32) -> [f64; D]) -> Pose<D> {
        Pose { moved: travel(self.reference), turned: self.turning.map_or(0.0, |n| travel(n)[0] / self.arm) }
    }

    /// Where in a `pose` it has what was at `origin` when the run began; `mesh` is that of then.
    pub fn place(&self, mesh: &Mesh<D>, pose: &Pose<D>, origin: &[f64; D]) -> [f64; D] {
        let centre = &mesh.nodes[self.reference as usize];
        let arm = pose.turn(&std::array::from_fn(|d| origin[d] - centre[d]));
        std::array::from_fn(|d| centre[d] + pose.moved[d] + arm[d])
    }

    /// The derivatives by its unknowns, reference then turning node, of a quantity with the derivative `by` by the
    /// displacement of a place of the body, `arm` (m) away from the reference point.
    pub fn hand_on(&self, arm: &[f64; D], by: &[f64; D]) -> [[f64; D]; 2] {
        let mut turning = [0.0; D];
        turning[0] = dot(by, &across(arm)) / self.arm;
        [*by, turning]
    }

    /// The motion (m/s or m/s²) of a place `arm` (m) away from the reference point, given that of the nodes.
    pub fn motion(&self, arm: &[f64; D], nodal: &[[f64; D]]) -> [f64; D] {
        let spin = self.turning.map_or(0.0, |n| nodal[n as usize][0] / self.arm);
        let (along, across) = (nodal[self.reference as usize], across(arm));
        std::array::from_fn(|d| along[d] + spin * across[d])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body() -> (Mesh<2>, Body<2>) {
        let mut mesh = Mesh { nodes: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ..Mesh::default() };
        let points = Points {
            position: vec![[0.5, 0.5], [1.5, 0.5]],
            mass: vec![1.0, 3.0],
            initial_volume: vec![1.0, 1.0],
            ..Points::default()
        };
        let body = Body::append(&mut mesh, 0, vec![0, 1, 2, 3], &points, true);
        (mesh, body)
    }

    #[test]
    fn mass_and_inertia_are_those_of_the_points() {
        let (mesh, body) = body();
        assert_eq!(mesh.nodes[4..], [[1.25, 0.5]; 2]);
        assert_eq!((body.mass, body.inertia), (4.0, 0.75f64.powi(2) + 3.0 * 0.25f64.powi(2)));
        assert_eq!(body.arm, 1.25f64.hypot(0.5));
    }

    #[test]
    fn a_quarter_turn_is_exact_and_its_rates_are_its_derivatives() {
        let (mesh, body) = body();
        let pose = Pose { moved: [1.0, 0.0], turned: std::f64::consts::FRAC_PI_2 };
        let x = body.place(&mesh, &pose, &[2.25, 0.5]);
        assert!((x[0] - 2.25).abs() < 1e-15 && (x[1] - 1.5).abs() < 1e-15, "{x:?}");
        // The arm is (0, 1) now: a turn by dθ takes its end along −x.
        let [moved, turned] = body.hand_on(&[0.0, 1.0], &[3.0, 5.0]);
        assert_eq!((moved, turned), ([3.0, 5.0], [-3.0 / body.arm, 0.0]));
        let mut nodal = vec![[0.0; 2]; 6];
        (nodal[4], nodal[5]) = ([1.0, 2.0], [3.0 * body.arm, 0.0]);
        assert_eq!(body.motion(&[0.0, 1.0], &nodal), [-2.0, 2.0]);
    }
}
