//! Generalised interpolation: a point sees the functions of the grid averaged over a rectangle along the axes around it.
//!
//! ```text
//! S_I = 1/V ∫_Ω N_I dV,    ∇S_I = 1/V ∫_Ω ∇N_I dV,    Ω = Π_d [x_d − l_d/2, x_d + l_d/2]
//! ```
//!
//! (Bardenhagen & Kober 2004). On a grid of rectangular Q4 these are tensor products of `S = (I(b) − I(a))/l` and `S′ = (N(b) − N(a))/l` over
//! `[a, b]`, with `I` the integral of the linear shape function; here they are summed over the parts of the domain in each cell, so that lines of the
//! grid may have any spacing. The lengths `l` are those of the first domains (uGIMP; Wallstedt & Guilkey 2008), or `l_d = l_d⁰ U_dd` with
//! the stretch `U` of `F = R U` (cpGIMP; Charlton, Coombs & Augarde 2017): with `F_dd` a domain would vanish as its body turns by a right angle.
//!
//! A domain keeps its centre, so that linear fields stay exact: along each axis it reaches no farther on either side than the end of the cell beside
//! that of its point, or of its own cell where that is the last one. What still lies outside (beside a corner that enters the grid) is left out of the
//! means; the values then have the centroid of the rest.

use super::domain::{at_the_place, first_corners};
use super::{Basis, Domains, First, Interpolation, Located, Place, Reset, Support};
use crate::geometry::box_around;
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::tensor::Tensor;

/// How far (-) the sides of a cell may be off the axes, over its size: what rounding and the coordinates of a mesh file leave.
const SLANT: f64 = 1e-9;

/// Least half length of a domain over the size of its cell (-), so that a point on the boundary has one; what it errs in is of that size.
const LEAST: f64 = 1e-7;

/// The scheme. The numbers of a domain are its lengths (m), and where these change the first ones too.
#[derive(Clone, Copy, Debug)]
pub struct Gimp {
    stretches: bool,
}

impl Gimp {
    /// With domains of constant size (`ugimp`).
    pub const UNIFORM: Self = Self { stretches: false };
    /// With domains that are stretched (`cpgimp`).
    pub const STRETCHED: Self = Self { stretches: true };
}

impl Basis<2> for Gimp {
    fn name(&self) -> &'static str {
        if self.stretches { "cpgimp" } else { "ugimp" }
    }

    fn alias(&self) -> Option<&'static str> {
        self.stretches.then_some("gimp")
    }

    fn takes(&self, kind: CellKind) -> bool {
        kind == CellKind::Q4
    }

    fn refusal(&self, mesh: &Mesh<2>) -> Option<[String; 2]> {
        slanted(mesh)
    }

    fn wants_first_shape(&self) -> bool {
        true
    }

    fn domain_size(&self) -> usize {
        if self.stretches { 4 } else { 2 }
    }

    fn begin_domains(&self, first: &First<2>, points: &mut Points<2>) {
        let lengths = |p| {
            // A rectangle along the axes, about the point.
            let lengths = first_corners(first, points, p)[0].map(|x| 2.0 * x.abs());
            std::iter::repeat_n(lengths, self.domain_size() / 2)
        };
        points.domain = (0..points.len()).flat_map(lengths).flatten().collect();
    }

    fn renew_domains(&self, _: &Reset<2>, points: &mut Points<2>) -> Option<String> {
        if self.stretches {
            for (numbers, f) in points.domain.chunks_exact_mut(4).zip(&points.deformation) {
                let stretch = stretch(f);
                (0..2).for_each(|d| numbers[d] = numbers[2 + d] * stretch[d]);
            }
        }
        None
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        fill(points, interpolation, &Surroundings::of(points.mesh));
    }
}

/// The cells of a mesh of rectangles.
pub(super) struct Surroundings {
    /// Each of them.
    pub boxes: Vec<Rectangle>,
    /// The cells around each node.
    around: Vec<Vec<u32>>,
}

impl Surroundings {
    pub fn of(mesh: &Mesh<2>) -> Self {
        let boxes = (0..mesh.cells.len()).map(|c| Rectangle::of(mesh, c)).collect();
        Self { boxes, around: mesh.cells_at_nodes(|_| true) }
    }

    /// The cells that share a node with a cell, itself too, each as often as they share one.
    pub fn beside<'a>(&'a self, mesh: &'a Mesh<2>, cell: usize) -> impl Iterator<Item = u32> + 'a {
        mesh.cells.nodes(cell).iter().flat_map(|&n| &self.around[n as usize]).copied()
    }
}

/// Fills in the means over the domains of the points.
pub(super) fn fill(points: &Located<2>, interpolation: &mut Interpolation<2>, surroundings: &Surroundings) {
    let support = Support::with_neighbours(points.mesh, points.active);
    interpolation.fill_support(points, support, |place, value, gradient| match &points.domains {
        Some(domains) => average(place, domains, surroundings, value, gradient),
        None => at_the_place(place, value, gradient),
    });
}

/// Says that a mesh has cells that are no rectangles along the axes, and a remedy.
pub(super) fn slanted(mesh: &Mesh<2>) -> Option<[String; 2]> {
    let cell = (0..mesh.cells.len()).find(|&c| !is_rectangle(mesh, c))?;
    let corner = mesh.nodes[mesh.cells.nodes(cell)[0] as usize];
    let problem = format!("needs cells that are rectangles along the axes, which that at {corner:.3?} m is not");
    Some([problem, "mesh with `Transfinite Curve`, `Transfinite Surface` and `Recombine Surface` in the .geo, or choose `gradient: cpdi`".into()])
}

/// Whether the sides of a cell lie along the axes.
fn is_rectangle(mesh: &Mesh<2>, cell: usize) -> bool {
    let Rectangle { low, high } = Rectangle::of(mesh, cell);
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let at_a_corner = |x: [f64; 2]| (0..2).all(|d| (x[d] - low[d]).min(high[d] - x[d]) <= SLANT * size);
    mesh.cells.nodes(cell).iter().all(|&n| at_a_corner(mesh.nodes[n as usize]))
}

/// The diagonal `U_11`, `U_22` of the stretch in the plane: `U = (C + det F 1)/√(tr C + 2 det F)` with `C = Fᵀ F`.
fn stretch(f: &Tensor) -> [f64; 2] {
    let c = [0, 1].map(|d| f[(0, d)].powi(2) + f[(1, d)].powi(2));
    let det = f[(0, 0)] * f[(1, 1)] - f[(0, 1)] * f[(1, 0)];
    let scale = (c[0] + c[1] + 2.0 * det).sqrt();
    c.map(|c| (c + det) / scale)
}

/// A rectangle along the axes (m).
#[derive(Clone, Copy)]
pub(super) struct Rectangle {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

impl Rectangle {
    /// That about the nodes of a cell.
    pub fn of(mesh: &Mesh<2>, cell: usize) -> Self {
        let nodes = mesh.cells.nodes(cell).iter().map(|&n| mesh.nodes[n as usize]);
        let [low, high] = box_around(nodes).unwrap_or_default();
        Self { low, high }
    }
}

/// Writes the means over the domain of a point.
fn average(
    place: &Place<2>,
    domains: &Domains<2>,
    surroundings: &Surroundings,
    value: &mut [f64],
    gradient: &mut [[f64; 2]],
) {
    let cells = &place.mesh.cells;
    let boxes = &surroundings.boxes;
    let to = |c: u32| -> Option<[usize; 4]> {
        let mut to = [0; 4];
        for (to, n) in to.iter_mut().zip(cells.nodes(c as usize)) {
            *to = place.nodes.iter().position(|other| other == n)?;
        }
        Some(to)
    };
    // How far the cells go on either side along each axis.
    let own = boxes[place.cell];
    let mut reach = own;
    for &c in domains.locator.faces.neighbours(place.cell as u32) {
        if let Some(beside) = boxes.get(c as usize).filter(|_| to(c).is_some()) {
            for d in 0..2 {
                let middle = 0.5 * (beside.low[d] + beside.high[d]);
                if middle < own.low[d] {
                    reach.low[d] = beside.low[d];
                } else if middle > own.high[d] {
                    reach.high[d] = beside.high[d];
                }
            }
        }
    }
    let (x, lengths) = (place.position(), domains.get(place.point));
    let half = [0, 1].map(|d| {
        let room = (x[d] - reach.low[d]).min(reach.high[d] - x[d]);
        (0.5 * lengths[d]).min(room).max(LEAST * (own.high[d] - own.low[d]))
    });
    let domain = Rectangle { low: [0, 1].map(|d| x[d] - half[d]), high: [0, 1].map(|d| x[d] + half[d]) };
    let mut volume = 0.0;
    // Four rectangles at most meet at each of the four nodes.
    let mut seen = [u32::MAX; 16];
    for (k, c) in surroundings.beside(place.mesh, place.cell).enumerate() {
        seen[k] = c;
        if seen[..k].contains(&c) {
            continue;
        }
        let cell = boxes[c as usize];
        let part = Rectangle {
            low: [0, 1].map(|d| domain.low[d].max(cell.low[d])),
            high: [0, 1].map(|d| domain.high[d].min(cell.high[d])),
        };
        let size = [0, 1].map(|d| part.high[d] - part.low[d]);
        if size[0] <= 0.0 || size[1] <= 0.0 {
            continue;
        }
        let Some(to) = to(c) else { continue };
        volume += size[0] * size[1];
        for (to, &n) in to.into_iter().zip(cells.nodes(c as usize)) {
            let node = place.mesh.nodes[n as usize];
            // Mean of the linear shape function along each axis, and its slope.
            let mean = [0, 1].map(|d| {
                let (width, middle) = (cell.high[d] - cell.low[d], 0.5 * (part.low[d] + part.high[d]));
                let slope = if 2.0 * node[d] < cell.low[d] + cell.high[d] { -1.0 / width } else { 1.0 / width };
                (1.0 + slope * (middle - node[d]), slope)
            });
            let area = size[0] * size[1];
            value[to] += area * mean[0].0 * mean[1].0;
            gradient[to][0] += area * mean[0].1 * mean[1].0;
            gradient[to][1] += area * mean[0].0 * mean[1].1;
        }
    }
    if volume > 0.0 {
        value.iter_mut().for_each(|value| *value /= volume);
        gradient.iter_mut().flatten().for_each(|gradient| *gradient /= volume);
    } else {
        at_the_place(place, value, gradient);
    }
}
