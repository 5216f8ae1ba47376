//! Points with domains on a grid, and what they see of it.

use mpm::interpolation::{Basis, CellPoints, Domains, First, Interpolation, Located, Reset};
use mpm::kinematics::{Kinematics, PlaneStrain};
use mpm::mesh::Mesh;
use mpm::mesh::locate::Locator;
use mpm::points::Points;
use mpm::tensor::Tensor;

/// A grid with all of its cells active.
pub struct Field {
    pub mesh: Mesh<2>,
    pub locator: Locator<2>,
    pub active: Vec<bool>,
}

/// What a point sees: a value and a gradient for each node of the grid.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    pub value: Vec<f64>,
    pub gradient: Vec<[f64; 2]>,
    /// The gradients that strains are taken with.
    pub strain: Vec<[f64; 2]>,
}

impl Field {
    pub fn new(mesh: Mesh<2>) -> Self {
        let (locator, active) = (Locator::new(&mesh), vec![true; mesh.cells.len()]);
        Self { mesh, locator, active }
    }

    /// A point at `x` of the area `area`.
    pub fn point(&self, x: [f64; 2], area: f64) -> (Points<2>, Vec<[f64; 3]>) {
        let (cell, xi) = self.locator.locate(&self.mesh, &x, None).unwrap();
        let points = Points {
            position: vec![x],
            origin: vec![x],
            initial_volume: vec![area],
            deformation: vec![Tensor::identity()],
            cell: vec![cell],
            ..Points::default()
        };
        (points, vec![xi])
    }

    /// As [`Field::point`], with the first domain of a scheme.
    pub fn begun(&self, scheme: &dyn Basis<2>, x: [f64; 2], area: f64) -> (Points<2>, Vec<[f64; 3]>) {
        let (mut points, xi) = self.point(x, area);
        let first = First { mesh: &self.mesh, xi: &xi, measure: PlaneStrain::measure };
        scheme.begin_domains(&first, &mut points);
        assert_eq!(points.domain.len(), scheme.domain_size());
        (points, xi)
    }

    /// As [`Field::begun`], in a body that fills the active cells: behind the point is another one in the middle of each, of its area.
    pub fn within_a_body(&self, scheme: &dyn Basis<2>, x: [f64; 2], area: f64) -> (Points<2>, Vec<[f64; 3]>) {
        let (mut points, mut xi) = self.point(x, area);
        for c in (0..self.mesh.cells.len()).filter(|&c| self.active[c]) {
            let corners = self.mesh.cells.nodes(c)[..4].iter().map(|&n| self.mesh.nodes[n as usize]);
            let corners: Vec<[f64; 2]> = corners.collect();
            let (other, place) = self.point([0, 1].map(|d| 0.5 * (corners[0][d] + corners[2][d])), 1.0);
            points.position.extend(&other.position);
            points.origin.extend(&other.position);
            points.initial_volume.push((corners[2][0] - corners[0][0]) * (corners[2][1] - corners[0][1]));
            points.deformation.push(Tensor::identity());
            points.cell.extend(&other.cell);
            xi.extend(place);
        }
        let first = First { mesh: &self.mesh, xi: &xi, measure: PlaneStrain::measure };
        scheme.begin_domains(&first, &mut points);
        (points, xi)
    }

    /// Deforms a point and the grid around it by `x ↦ x_p + F (x − x_p)`, and resets the grid.
    pub fn deform(&self, scheme: &dyn Basis<2>, points: &mut Points<2>, f: [[f64; 2]; 2]) -> Option<String> {
        let at = points.position[0];
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            points.deformation[0][(i, j)] = f[i][j];
        }
        self.reset(scheme, points, |x| {
            let r = [x[0] - at[0], x[1] - at[1]];
            [0, 1].map(|d| f[d][0] * r[0] + f[d][1] * r[1] - r[d])
        })
    }

    /// Moves the grid by `u` and resets it; the point itself stays, and so does its deformation gradient.
    pub fn reset(
        &self,
        scheme: &dyn Basis<2>,
        points: &mut Points<2>,
        u: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Option<String> {
        let displacement: Vec<[f64; 2]> = self.mesh.nodes.iter().map(|&x| u(x)).collect();
        let before =
            Reset { mesh: &self.mesh, locator: &self.locator, active: &self.active, displacement: &displacement };
        scheme.renew_domains(&before, points)
    }

    /// What the first point sees, and the radius that its hoop strain is by where there is one.
    pub fn seen_in<K: Kinematics<2>>(&self, scheme: &dyn Basis<2>, points: &Points<2>, xi: &[[f64; 3]]) -> (Seen, f64) {
        let mut interpolation = Interpolation::default();
        let located = Located::new::<K>(&self.mesh, &self.active, &points.cell, xi);
        let domains = Domains::of(points, &self.locator);
        scheme.fill(&Located { domains, ..located }, &mut interpolation);
        let count = self.mesh.nodes.len();
        let mut seen = Seen::zero(count);
        let own = |cell_points: &&CellPoints| cell_points.cell == points.cell[0];
        let cell_points = *interpolation.filled.iter().find(own).unwrap();
        let nodes = interpolation.nodes(&self.mesh, cell_points.cell).to_vec();
        let entries = interpolation.entries::<K>(&cell_points).find(|entries| entries.point == 0).unwrap();
        let mut radius = 0.0;
        for (i, &n) in nodes.iter().enumerate() {
            seen.value[n as usize] += entries.value[i];
            let gradient = entries.gradient(i);
            (0..2).for_each(|d| seen.gradient[n as usize][d] += gradient.g[d]);
            (0..2).for_each(|d| seen.strain[n as usize][d] += entries.strain_gradient(i).g[d]);
            if gradient.hoop != 0.0 {
                radius = entries.value[i] / gradient.hoop;
            }
        }
        (seen, radius)
    }

    pub fn seen(&self, scheme: &dyn Basis<2>, points: &Points<2>, xi: &[[f64; 3]]) -> Seen {
        self.seen_in::<PlaneStrain>(scheme, points, xi).0
    }

    /// The functions of the cell at a place.
    pub fn at(&self, x: [f64; 2]) -> Seen {
        let (points, xi) = self.point(x, 1.0);
        self.seen(&mpm::interpolation::Mpm, &points, &xi)
    }
}

impl Seen {
    /// Nothing of `count` nodes.
    pub fn zero(count: usize) -> Self {
        Self { value: vec![0.0; count], gradient: vec![[0.0; 2]; count], strain: vec![[0.0; 2]; count] }
    }

    /// The gradient of a field on the nodes that strains are taken with.
    pub fn strain_of(&self, mesh: &Mesh<2>, f: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
        let terms = mesh.nodes.iter().zip(&self.strain);
        terms.fold([0.0; 2], |[gx, gy], (&x, g)| [gx + g[0] * f(x), gy + g[1] * f(x)])
    }

    /// The mean of a field on the nodes, and of its gradient.
    pub fn of(&self, mesh: &Mesh<2>, f: impl Fn([f64; 2]) -> f64) -> (f64, [f64; 2]) {
        let terms = mesh.nodes.iter().zip(self.value.iter().zip(&self.gradient));
        terms.fold((0.0, [0.0; 2]), |(value, [gx, gy]), (&x, (n, g))| {
            (value + n * f(x), [gx + g[0] * f(x), gy + g[1] * f(x)])
        })
    }

    /// Adds another, by a weight.
    pub fn add(&mut self, weight: f64, other: &Self) {
        for (own, n) in self.value.iter_mut().zip(&other.value) {
            *own += weight * n;
        }
        for (own, g) in self.gradient.iter_mut().zip(&other.gradient) {
            (0..2).for_each(|d| own[d] += weight * g[d]);
        }
    }

    /// The largest differences of a value and of a component of a gradient.
    pub fn apart(&self, other: &Self) -> [f64; 2] {
        let most =
            |values: &mut dyn Iterator<Item = (f64, f64)>| values.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        let value = most(&mut self.value.iter().copied().zip(other.value.iter().copied()));
        let components = |s: &Self| s.gradient.as_flattened().to_vec();
        [value, most(&mut components(self).into_iter().zip(components(other)))]
    }
}
