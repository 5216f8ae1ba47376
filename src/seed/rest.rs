//! The stress of soil at rest: what the weight above each point gives.

use crate::material::Profile;
use crate::mesh::Mesh;
use crate::mesh::faces::{BOUNDARY, Faces};
use crate::points::Points;
use crate::tensor::Symmetric;

/// The weight of the soil in one region, for [`k0_stress`].
#[derive(Clone, Debug, PartialEq)]
pub struct RegionWeight {
    /// Index into [`Mesh::regions`].
    pub region: u16,
    /// Unit weight (kN/m³) at the height y.
    pub unit_weight: Profile,
}

/// The stress of soil at rest, in kPa: `σ_y = −∫ γ dy` over the soil vertically above the point, `σ_x = σ_z =
/// k0 σ_y`, with `k0` by the number of the point, one entry a point. Points of regions that are not in `soils` have none.
///
/// The integral is exact for layers, for `γ` that grows with depth and for curved boundaries: per region it
/// is the signed sum of `γ`'s primitive where the vertical crosses the region's boundary.
pub fn k0_stress(
    mesh: &Mesh<2>,
    soils: &[RegionWeight],
    k0: impl Fn(usize) -> f64,
    points: &Points<2>,
) -> Vec<Symmetric> {
    let faces = Faces::of(mesh);
    let boundaries: Vec<Vec<Arc>> = soils.iter().map(|soil| boundary(mesh, &faces, soil.region)).collect();
    let stress = |(p, x): (usize, &[f64; 2])| {
        if soils.iter().all(|soil| soil.region != points.region[p]) {
            return [0.0; 6];
        }
        let k0 = k0(p);
        let layers = soils.iter().zip(&boundaries);
        let weight: f64 = layers.map(|(soil, boundary)| weight_above(boundary, &soil.unit_weight, x)).sum();
        [-k0 * weight, -weight, -k0 * weight, 0.0, 0.0, 0.0]
    };
    points.position.iter().enumerate().map(stress).collect()
}

/// A piece of a region's boundary, counter-clockwise, on which `x` is monotone: the quadratic `a + b t + c t²`
/// between two parameters.
struct Arc {
    a: [f64; 2],
    b: [f64; 2],
    c: [f64; 2],
    parameters: [f64; 2],
    /// `x` (m) of its ends. Pieces that meet have the same number there, so that a vertical crosses one of them or both: that of the node,
    /// from which the quadratic differs by rounding, or of the place where the tangent is vertical.
    ends: [f64; 2],
}

/// The boundary of a region, cut where its tangent is vertical.
fn boundary(mesh: &Mesh<2>, faces: &Faces, region: u16) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for cell in (0..mesh.cells.len()).filter(|&c| mesh.cells.region[c] == region) {
        let facets = mesh.cells.kind[cell].facets().1;
        for (facet, &other) in facets.iter().zip(faces.across(cell as u32)) {
            if other != BOUNDARY && mesh.cells.region[other as usize] == region {
                continue;
            }
            let x: Vec<[f64; 2]> = facet.iter().map(|&i| mesh.nodes[mesh.cells.nodes(cell)[i] as usize]).collect();
            let a = x.get(2).copied().unwrap_or([0, 1].map(|d| 0.5 * (x[0][d] + x[1][d])));
            let b = [0, 1].map(|d| 0.5 * (x[1][d] - x[0][d]));
            let c = [0, 1].map(|d| 0.5 * (x[0][d] + x[1][d]) - a[d]);
            let arc = |parameters, ends| Arc { a, b, c, parameters, ends };
            let turn = -0.5 * b[0] / c[0];
            if turn > -1.0 && turn < 1.0 {
                let there = a[0] + turn * (b[0] + turn * c[0]);
                arcs.extend([arc([-1.0, turn], [x[0][0], there]), arc([turn, 1.0], [there, x[1][0]])]);
            } else {
                arcs.push(arc([-1.0, 1.0], [x[0][0], x[1][0]]));
            }
        }
    }
    arcs
}

impl Arc {
    /// The height at which the piece crosses the vertical at `x`, which lies between its ends.
    fn height(&self, x: f64) -> f64 {
        let (a, b, c) = (self.a[0] - x, self.b[0], self.c[0]);
        // Both roots without cancellation; the one on the piece is wanted.
        let q = -0.5 * (b + (b * b - 4.0 * a * c).max(0.0).sqrt().copysign(b));
        let [low, high] = self.parameters;
        let outside = |t: f64| if t.is_nan() { f64::INFINITY } else { (low - t).max(t - high).max(0.0) };
        let (r, s) = (q / c, a / q);
        let t = if outside(r) < outside(s) { r } else { s };
        let t = t.clamp(low, high);
        self.a[1] + t * (self.b[1] + t * self.c[1])
    }
}

/// `∫ γ dy` (kPa) over the part of a region vertically above `x`.
fn weight_above(boundary: &[Arc], unit_weight: &Profile, x: &[f64; 2]) -> f64 {
    let primitive = |y: f64| {
        let below = (unit_weight.datum - y).max(0.0);
        unit_weight.top * y - 0.5 * unit_weight.gradient * below * below
    };
    let floor = primitive(x[1]);
    let mut weight = 0.0;
    for arc in boundary {
        // Counter-clockwise: the region lies below a piece that runs to the left. Half-open intervals count a
        // vertex once.
        let sign = match arc.ends.map(|end| end <= x[0]) {
            [true, false] => -1.0,
            [false, true] => 1.0,
            _ => continue,
        };
        let y = arc.height(x[0]);
        if y > x[1] {
            weight += sign * (primitive(y) - floor);
        }
    }
    weight
}
