//! Domains with four corners of material points, over which the functions of the grid are averaged from their values at a few places.
//!
//! A domain `Ω` has straight edges between its corners. With the functions `N_I` of the cells,
//!
//! ```text
//! S_I = 1/V ∫_Ω N_I dV = Σ_q w_q N_I(x_q),      ∇S_I = 1/V ∫_Ω ∇N_I dV = 1/V ∮ N_I n ds = Σ_q g_q N_I(x_q)
//! ```
//!
//! On cells of first order `N_I` is interpolated from the corners (Sadeghirad, Brannon & Burghardt 2011; Sadeghirad, Brannon &
//! Guilkey 2013): bilinearly in the domain, and with the trapezoidal rule on its edges. On cells of second order the middles of the edges
//! and the centre are places too, with Simpson's rule in the domain and on its edges: both are exact for functions of second
//! order, such as those of a straight cell that holds the domain.
//!
//! A domain that reaches farther than its point can act is scaled about the point, see [`Averages::fill`].

use super::{First, Interpolation, Located, MAX_FUNCTIONS, Place, Support};
use crate::geometry::{cross, way};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::{MAX_NODES, map};
use crate::points::Points;
use crate::tensor::Tensor;

/// Vectors from the point to the corners of its domain (m), counterclockwise.
pub(super) type Corners = [[f64; 2]; 4];

/// Numbers of a domain (m): from the point to its corners at first, and the corners as of the last reset.
pub(super) const NUMBERS: usize = 16;

/// The signs of the parametric coordinates of the corners.
const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The corners of a triangle about its centroid, by its sides along the axes. A triangle is a quadrilateral whose last two corners are one: the
/// bilinear functions of these add up to a linear one.
const TRIANGLE: [[f64; 2]; 4] =
    [[-1.0 / 3.0, -1.0 / 3.0], [2.0 / 3.0, -1.0 / 3.0], [-1.0 / 3.0, 2.0 / 3.0], [-1.0 / 3.0, 2.0 / 3.0]];

/// The part (-) of its size that a domain keeps at least when it is scaled: a point nearer to the boundary sees the functions at its place,
/// which are the limit. Smaller domains would lose more of the gradient to rounding than they differ from that limit.
const LEAST: f64 = 1e-6;

/// A place this little inside its cell (parametric) may have been moved there.
const ON_SIDE: f64 = 1e-12;

/// Bisections that find the largest domain: to 1e-9 of its size.
const BISECTIONS: usize = 30;

/// A place of a domain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    /// From the point (m).
    pub offset: [f64; 2],
    /// Weight (-) of a function there in its mean.
    pub value: f64,
    /// Weight (1/m) in the mean of its gradient.
    pub gradient: [f64; 2],
}

/// The corners of the first domain of a point: the part of its cell that it stands for, which is a box or a triangle in parametric coordinates,
/// shifted so that its centroid is the point. The part has the area of the point; in a triangle it points up as the cell does, or down where
/// only that fits the place. Points that were seeded evenly then fill a straight cell.
pub(super) fn first_corners(first: &First<2>, points: &Points<2>, p: usize) -> Corners {
    let (cell, xi) = (points.cell[p] as usize, first.xi[p]);
    let (kind, x) = (first.mesh.cells.kind[cell], first.mesh.coordinates(cell));
    let count = kind.node_count();
    let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
    let determinant = map(kind, &x[..count], &xi, &mut n, &mut gradient);
    let area = points.initial_volume[p] / (first.measure)(&points.position[p]);
    let part = if kind.is_simplex() {
        let side = (2.0 * area / determinant).sqrt();
        // Centroids of parts that point down are two thirds of a part from the sides, of others one third.
        let down = xi[..2].iter().all(|t| ((t / side).fract() - 2.0 / 3.0).abs() < 1.0 / 6.0);
        TRIANGLE.map(|t| t.map(|t| if down { -side * t } else { side * t }))
    } else {
        let half = (area / (4.0 * determinant)).sqrt();
        SIGNS.map(|s| s.map(|s| half * s))
    };
    let corners = part.map(|by| {
        kind.values(&[xi[0] + by[0], xi[1] + by[1], 0.0], &mut n);
        [0, 1].map(|d| n.iter().zip(&x).take(count).map(|(n, x)| n * x[d]).sum())
    });
    let centre = centroid(&corners);
    corners.map(|x| way(&centre, &x))
}

/// A domain that has followed a deformation gradient.
pub(super) fn deformed(f: &Tensor, x: &Corners) -> Corners {
    x.map(|x| [0, 1].map(|i| f[(i, 0)] * x[0] + f[(i, 1)] * x[1]))
}

/// The corners in eight of the numbers of a domain.
pub(super) fn corners(numbers: &[f64]) -> Corners {
    std::array::from_fn(|c| [numbers[2 * c], numbers[2 * c + 1]])
}

/// The Jacobian determinant `J₀ + J₁ ξ + J₂ η` (m²) of the bilinear map from `[-1, 1]²` to a domain: `[J₀, J₁, J₂]`. A quarter of its area is `J₀`.
pub(super) fn jacobian(x: &Corners) -> [f64; 3] {
    // x(ξ, η) = mean + a ξ + b η + c ξη.
    let of = |sign: fn(&[f64; 2]) -> f64| {
        [0, 1].map(|d| SIGNS.iter().zip(x).map(|(s, x)| 0.25 * sign(s) * x[d]).sum::<f64>())
    };
    let (a, b, c) = (of(|s| s[0]), of(|s| s[1]), of(|s| s[0] * s[1]));
    [cross(&a, &b), cross(&a, &c), cross(&c, &b)]
}

/// The least Jacobian determinant of a domain over its mean: one in a parallelogram, not positive where the domain is not convex. A
/// triangle is always convex: one, or −1 where it is turned inside out.
pub(super) fn convexity(x: &Corners) -> f64 {
    let [j0, j1, j2] = jacobian(x);
    if j0 <= 0.0 {
        -1.0
    } else if x[2] == x[3] {
        1.0
    } else {
        (j0 - j1.abs() - j2.abs()) / j0
    }
}

/// The centroid of a domain.
pub(super) fn centroid(x: &Corners) -> [f64; 2] {
    let weight = corner_weights(x);
    [0, 1].map(|d| weight.iter().zip(x).map(|(w, x)| w * x[d]).sum())
}

/// `1/V ∫_Ω M_c dV` with the bilinear functions `M_c` of the corners: `(6V ∓ a ∓ b)/24V` of Sadeghirad et al. (2013).
fn corner_weights(x: &Corners) -> [f64; 4] {
    let [j0, j1, j2] = jacobian(x);
    SIGNS.map(|[a, b]| 0.25 * (1.0 + (a * j1 + b * j2) / (3.0 * j0)))
}

/// The places of a domain for cells of an order.
pub(super) fn samples(x: &Corners, order: usize) -> ([Sample; 9], usize) {
    let mut samples = [Sample::default(); 9];
    let [j0, j1, j2] = jacobian(x);
    let volume = 4.0 * j0;
    for c in 0..4 {
        // The outward normal of the edge to the next corner, by its length, over the area.
        let next = (c + 1) % 4;
        let edge = way(&x[c], &x[next]);
        let normal = [edge[1] / volume, -edge[0] / volume];
        let (ends, middle) = if order == 2 { (1.0 / 6.0, 4.0 / 6.0) } else { (0.5, 0.0) };
        for (q, part) in [(c, ends), (next, ends), (4 + c, middle)] {
            (0..2).for_each(|d| samples[q].gradient[d] += part * normal[d]);
        }
    }
    if order != 2 {
        for (c, weight) in corner_weights(x).into_iter().enumerate() {
            (samples[c].offset, samples[c].value) = (x[c], weight);
        }
        return (samples, 4);
    }
    for c in 0..4 {
        let ([a, b], next) = (SIGNS[c], (c + 1) % 4);
        let [p, q] = [0, 1].map(|d| 0.5 * (SIGNS[c][d] + SIGNS[next][d]));
        let share = |xi: f64, eta: f64| 1.0 + (xi * j1 + eta * j2) / j0;
        (samples[c].offset, samples[c].value) = (x[c], share(a, b) / 36.0);
        samples[4 + c].offset = [0, 1].map(|d| 0.5 * (x[c][d] + x[next][d]));
        samples[4 + c].value = share(p, q) / 9.0;
    }
    samples[8].offset = [0, 1].map(|d| 0.25 * x.iter().map(|x| x[d]).sum::<f64>());
    samples[8].value = 4.0 / 9.0;
    (samples, 9)
}

/// Means over the domains of points on a grid.
pub(super) struct Averages<'a> {
    pub mesh: &'a Mesh<2>,
    pub locator: &'a Locator<2>,
}

impl Averages<'_> {
    /// Writes the values and gradients of a point with a domain. A domain that reaches beyond the grid, its active cells or the cells around that of
    /// its point is scaled about the point until it does not: a linear field stays exact, and the functions change continuously.
    pub fn fill(&self, place: &Place<2>, corners: &Corners, value: &mut [f64], gradient: &mut [[f64; 2]]) {
        let order = self.mesh.cells.kind[place.cell].order();
        let (samples, count) = samples(corners, order);
        let samples = &samples[..count];
        let mut factor = 1.0;
        if !self.add(place, samples, factor, value, gradient) {
            let mut beyond = 1.0;
            factor = 0.0;
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (factor + beyond);
                if self.add(place, samples, middle, value, gradient) { factor = middle } else { beyond = middle }
            }
            if factor < LEAST || !self.add(place, samples, factor, value, gradient) {
                at_the_place(place, value, gradient);
            }
        }
    }

    /// Sums over the places of a domain scaled by `factor`; false where the point does not act on the nodes of the cell of one.
    fn add(
        &self,
        place: &Place<2>,
        samples: &[Sample],
        factor: f64,
        value: &mut [f64],
        gradient: &mut [[f64; 2]],
    ) -> bool {
        value.fill(0.0);
        gradient.fill([0.0; 2]);
        let x = place.position();
        let mut n = [0.0; MAX_NODES];
        for sample in samples {
            let at = [0, 1].map(|d| x[d] + factor * sample.offset[d]);
            let Some((cell, xi)) = self.locator.locate(self.mesh, &at, Some(place.cell as u32)) else { return false };
            let kind = self.mesh.cells.kind[cell as usize];
            // A place that rounding has put outside of the grid was moved to its side: a small domain would feel that.
            let inside = kind.depth(&xi).0 > ON_SIDE;
            let xi = if inside { xi } else { self.locator.extend(self.mesh, cell, &at).unwrap_or(xi) };
            kind.values(&xi, &mut n);
            for (&node, n) in self.mesh.cells.nodes(cell as usize).iter().zip(&n) {
                let Some(to) = place.nodes.iter().position(|&other| other == node) else { return false };
                value[to] += sample.value * n;
                (0..2).for_each(|d| gradient[to][d] += sample.gradient[d] / factor * n);
            }
        }
        true
    }
}

/// The functions of the cell at the place of a point, which those of a domain tend to as it shrinks.
pub(super) fn at_the_place(place: &Place<2>, value: &mut [f64], gradient: &mut [[f64; 2]]) {
    value.fill(0.0);
    gradient.fill([0.0; 2]);
    value[..place.shape.len()].copy_from_slice(place.shape);
    gradient[..place.shape.len()].copy_from_slice(place.shape_gradient);
}

/// Fills what points see whose domain has `corners`, given its numbers.
pub(super) fn fill(
    points: &Located<2>,
    interpolation: &mut Interpolation<2>,
    corners: impl Fn(&Place<2>, &[f64]) -> Corners + Sync,
) {
    let support = Support::with_neighbours(points.mesh, points.active);
    interpolation.fill_support(points, support, |place, value, gradient| match &points.domains {
        Some(domains) => {
            let averages = Averages { mesh: points.mesh, locator: domains.locator };
            averages.fill(place, &corners(place, domains.get(place.point)), value, gradient);
        }
        None => at_the_place(place, value, gradient),
    });
}

/// Refuses a mesh in which a point could act on more nodes than there is room for.
pub(super) fn crowded(mesh: &Mesh<2>) -> Option<[String; 2]> {
    let support = Support::with_neighbours(mesh, &vec![true; mesh.cells.len()]);
    let cell = (0..mesh.cells.len()).find(|&c| support.nodes(c as u32).len() > MAX_FUNCTIONS)?;
    let (nodes, corner) = (support.nodes(cell as u32).len(), mesh.nodes[mesh.cells.nodes(cell)[0] as usize]);
    let problem = format!(
        "lets a point act on the nodes of the cells around its own, of which there are at most {MAX_FUNCTIONS}, and there are {nodes} \
         around the cell at {corner:.3?} m"
    );
    Some([problem, "mesh more evenly there, or choose `gradient: mpm`".into()])
}
