//! Rigid bodies: structures that keep their shape, and walls.
//!
//! A body moves by its reference point, the centroid of its mass, and turns about it: `x = c + R(θ) (X − C)`. Its unknowns ([`RigidDofs`]) are the
//! displacement of `c` and, but in axisymmetry, the angle `θ`.

use crate::dofs::RigidDofs;
use crate::geometry::dot;
use crate::mesh::Mesh;
use crate::points::Points;

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body<const D: usize> {
    /// Its region of the mesh; that of a wall has no cells.
    pub region: u16,
    /// Whether it is a wall, without mass and cells.
    pub is_wall: bool,
    /// The nodes that move with it, ascending; those of a wall are of no cell, at the end of the mesh.
    pub nodes: Vec<u32>,
    /// The reference point (m) when the run began.
    pub centre: [f64; D],
    pub dofs: RigidDofs,
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

impl<const D: usize> Pose<D> {
    /// `R v`.
    pub fn turn(&self, v: &[f64; D]) -> [f64; D] {
        let (sin, cos) = self.turned.sin_cos();
        let across = across(v);
        std::array::from_fn(|d| if d < 2 { cos * v[d] + sin * across[d] } else { v[d] })
    }
}

impl<const D: usize> Body<D> {
    /// A body with the centroid, mass and inertia of `points`, or a wall of no mass with its centroid at the middle of its `nodes`, whose unknowns
    /// have the numbers from `first` on. Without `turns` it moves along the axis of symmetry only, and its reference point lies there.
    pub fn new(mesh: &Mesh<D>, first: u32, region: u16, nodes: Vec<u32>, points: &Points<D>, turns: bool) -> Self {
        let mass: f64 = points.mass.iter().sum();
        // Without mass the volume tells the centroid.
        let weight = if mass > 0.0 { &points.mass } else { &points.initial_volume };
        let mut centre = [0.0; D];
        let is_wall = weight.is_empty();
        if is_wall {
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
        Self { region, is_wall, nodes, centre, dofs: RigidDofs::new(first, turns, arm), mass, inertia }
    }

    /// Its pose, given how far (m) its unknowns have come since the run began.
    pub fn pose(&self, travel: impl Fn(u32) -> [f64; D]) -> Pose<D> {
        let (moved, turned) = self.dofs.motion(travel);
        Pose { moved, turned }
    }

    /// Its pose, given where (m) all nodes and bodies were at the last grid reset, which nothing is before the first, and how far they have come
    /// `since`.
    pub fn pose_since(&self, reset: &[[f64; D]], since: &[[f64; D]]) -> Pose<D> {
        self.pose(|n| {
            let (from, by) = (reset.get(n as usize).unwrap_or(&self.centre), &since[n as usize]);
            std::array::from_fn(|d| from[d] + by[d] - self.centre[d])
        })
    }

    /// Where in a `pose` it has what was at `origin` when the run began.
    pub fn place(&self, pose: &Pose<D>, origin: &[f64; D]) -> [f64; D] {
        let arm = pose.turn(&std::array::from_fn(|d| origin[d] - self.centre[d]));
        std::array::from_fn(|d| self.centre[d] + pose.moved[d] + arm[d])
    }

    /// Where (m) its reference point is, given how far (m) all nodes and bodies have come since the run began.
    pub fn centre_after(&self, travel: &[[f64; D]]) -> [f64; D] {
        self.place(&self.pose(|n| travel[n as usize]), &self.centre)
    }

    /// The derivatives by translation and rotation of a quantity with the derivative `by` by the displacement of a place of the body,
    /// `arm` (m) away from the reference point.
    pub fn hand_on(&self, arm: &[f64; D], by: &[f64; D]) -> [[f64; D]; 2] {
        [*by, self.dofs.force(dot(by, &across(arm)))]
    }

    /// Mass (t) that resists the translation, and that which resists the arc of the rotation.
    pub fn masses(&self) -> impl Iterator<Item = (u32, f64)> {
        self.dofs.numbers().zip([self.mass, self.inertia / self.dofs.arm.powi(2)])
    }

    /// The motion (m/s or m/s²) of a place `arm` (m) away from the reference point, given that of all nodes and bodies.
    pub fn motion(&self, arm: &[f64; D], all: &[[f64; D]]) -> [f64; D] {
        let ((along, spin), across) = (self.dofs.motion(|n| all[n as usize]), across(arm));
        std::array::from_fn(|d| along[d] + spin * across[d])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body() -> Body<2> {
        let mesh = Mesh { nodes: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ..Mesh::default() };
        let points = Points {
            position: vec![[0.5, 0.5], [1.5, 0.5]],
            mass: vec![1.0, 3.0],
            initial_volume: vec![1.0, 1.0],
            ..Points::default()
        };
        Body::new(&mesh, 4, 0, vec![0, 1, 2, 3], &points, true)
    }

    #[test]
    fn mass_and_inertia_are_those_of_the_points() {
        let body = body();
        assert_eq!((body.centre, body.dofs.numbers().collect()), ([1.25, 0.5], vec![4, 5]));
        assert_eq!((body.mass, body.inertia), (4.0, 0.75f64.powi(2) + 3.0 * 0.25f64.powi(2)));
        assert_eq!(body.dofs.arm, 1.25f64.hypot(0.5));
    }

    #[test]
    fn a_quarter_turn_is_exact_and_its_rates_are_its_derivatives() {
        let body = body();
        let pose = Pose { moved: [1.0, 0.0], turned: std::f64::consts::FRAC_PI_2 };
        let x = body.place(&pose, &[2.25, 0.5]);
        assert!((x[0] - 2.25).abs() < 1e-15 && (x[1] - 1.5).abs() < 1e-15, "{x:?}");
        // The arm is (0, 1) now: a turn by dθ takes its end along −x.
        let [moved, turned] = body.hand_on(&[0.0, 1.0], &[3.0, 5.0]);
        assert_eq!((moved, turned), ([3.0, 5.0], [-3.0 / body.dofs.arm, 0.0]));
        let mut all = vec![[0.0; 2]; 6];
        (all[4], all[5]) = ([1.0, 2.0], body.dofs.arc(3.0));
        assert_eq!(body.motion(&[0.0, 1.0], &all), [-2.0, 2.0]);
    }
}
