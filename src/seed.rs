//! Material points in the cells of a mesh, and the stress they start with.
//!
//! Triangles take 4, 9, 16 or 25 equal points (centroids of the k × k sub-triangles) or the 3, 6, 7 or 12
//! points of a quadrature rule; quadrilaterals k × k points at the centres of equal parametric boxes. A
//! point's volume is that of its part of the cell, integrated exactly also in curved cells and, in
//! axisymmetry, with `2πr`: the volumes of a cell sum to its own.

use std::f64::consts::TAU;

use crate::error::{Error, Result};
use crate::material::Profile;
use crate::mesh::Mesh;
use crate::mesh::locate::{Locator, OUTSIDE};
use crate::mesh::shape::{self, CellKind, MAX_NODES, rule};
use crate::points::Points;
use crate::tensor::{IDENTITY, Symmetric, Tensor};

/// In place of a number of points: those of a quadrature rule for polynomials of degree 4, six in a triangle and nine in a
/// quadrilateral. Finite elements have them.
pub const QUADRATURE: u32 = 0;

/// How one region is filled with points.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionSeed {
    /// Index into [`Mesh::regions`].
    pub region: u16,
    /// Or [`QUADRATURE`].
    pub points_per_cell: u32,
    /// Density (t/m³) at the height y.
    pub density: Profile,
}

/// The weight of the soil in one region, for [`k0_stress`].
#[derive(Clone, Debug, PartialEq)]
pub struct RegionWeight {
    /// Index into [`Mesh::regions`].
    pub region: u16,
    /// Unit weight (kN/m³) at the height y.
    pub unit_weight: Profile,
}

/// A part of the parametric domain with its point.
struct Part {
    point: [f64; 3],
    /// Places and weights that integrate over the part exactly; the weights sum to its parametric measure.
    quadrature: Vec<([f64; 3], f64)>,
}

/// Fills the cells of `regions` with points at rest, undeformed and free of stress, in the order of the cells.
///
/// Masses are density at the point × volume, in t; volumes per metre in plane strain and per full turn (2π)
/// in axisymmetry, where `x` is the radius. Velocities and accelerations are left empty.
///
/// # Errors
/// Input: a number of points that the region's cells have no rule for; in axisymmetry, a cell at negative
/// radius; an inverted cell.
pub fn seed<const D: usize>(mesh: &Mesh<D>, axisymmetric: bool, regions: &[RegionSeed]) -> Result<Points<D>> {
    let mut points = Points::default();
    let mut x = Vec::new();
    // Rules by kind and number of points, each made once.
    let mut rules: Vec<(CellKind, u32, Vec<Part>)> = Vec::new();
    for c in 0..mesh.cells.len() {
        let kind = mesh.cells.kind[c];
        let Some(wanted) = regions.iter().find(|r| r.region == mesh.cells.region[c]) else { continue };
        let count = wanted.points_per_cell;
        let known = rules.iter().position(|(k, n, _)| (*k, *n) == (kind, count));
        let known = match known {
            Some(known) => known,
            None => {
                let parts = parts(kind, count).ok_or_else(|| no_rule(mesh, wanted, kind))?;
                rules.push((kind, count, parts));
                rules.len() - 1
            }
        };
        mesh.cell_coordinates(c, &mut x);
        fill(&mut points, kind, &x, &rules[known].2, axisymmetric).map_err(|problem| {
            let region = &mesh.regions[wanted.region as usize];
            let place = format!("cell {c} of region {region}, at {:?}", x[0]);
            Error::input(place, problem, "mend the geometry, or refine the mesh where it is curved")
        })?;
        let new = points.mass.len()..points.len();
        for p in new {
            let density = wanted.density.at(points.position[p][1]);
            points.mass.push(density * points.initial_volume[p]);
            points.region.push(wanted.region);
            points.cell.push(c as u32);
        }
    }
    let count = points.len();
    points.origin = points.position.clone();
    points.deformation = vec![Tensor::identity(); count];
    points.elastic = vec![IDENTITY; count];
    points.stress = vec![[0.0; 6]; count];
    points.plastic_strain = vec![0.0; count];
    Ok(points)
}

/// Appends positions and volumes of the points of one cell.
fn fill<const D: usize>(
    points: &mut Points<D>,
    kind: CellKind,
    x: &[[f64; D]],
    parts: &[Part],
    axisymmetric: bool,
) -> std::result::Result<(), &'static str> {
    let measure = |xi: &[f64; 3]| {
        let (y, determinant) = place(kind, x, xi);
        (determinant * if axisymmetric { TAU * y[0] } else { 1.0 }, determinant)
    };
    let first = points.initial_volume.len();
    for part in parts {
        let mut volume = 0.0;
        for (xi, weight) in &part.quadrature {
            let (measure, determinant) = measure(xi);
            if determinant.is_nan() || determinant <= 0.0 {
                return Err("the cell is inverted");
            }
            volume += weight * measure;
        }
        if volume <= 0.0 {
            return Err("the cell lies at negative radius");
        }
        points.position.push(place(kind, x, &part.point).0);
        points.initial_volume.push(volume);
    }
    // The points of a quadrature rule represent no parts: in a curved cell, or with 2πr, their sum is exact
    // only to the rule's degree.
    let exact: f64 = exact_rule(kind).iter().map(|(xi, weight)| weight * measure(xi).0).sum();
    let sum: f64 = points.initial_volume[first..].iter().sum();
    for volume in &mut points.initial_volume[first..] {
        *volume *= exact / sum;
    }
    Ok(())
}

/// Position and Jacobian determinant at `xi`.
fn place<const D: usize>(kind: CellKind, x: &[[f64; D]], xi: &[f64; 3]) -> ([f64; D], f64) {
    let (mut n, mut grad) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
    let determinant = shape::map(kind, x, xi, &mut n, &mut grad);
    let mut y = [0.0; D];
    for (x, n) in x.iter().zip(&n) {
        for d in 0..D {
            y[d] += n * x[d];
        }
    }
    (y, determinant)
}

/// A rule that integrates `r det J` exactly: degree 4 on T6; degree 5 in each direction on Q9.
fn exact_rule(kind: CellKind) -> Vec<([f64; 3], f64)> {
    rule(kind, if kind.is_simplex() { 4 } else { 5 })
}

/// The parts of a cell with `count` points; `None` where there is no rule.
fn parts(kind: CellKind, count: u32) -> Option<Vec<Part>> {
    if kind.dimension() != 2 {
        return None;
    }
    let gauss = |degree| {
        let points = rule(kind, degree).into_iter();
        Some(points.map(|(point, w)| Part { point, quadrature: vec![(point, w)] }).collect())
    };
    if count == QUADRATURE {
        return gauss(4);
    }
    if kind.is_simplex() {
        let degree = match count {
            4 | 9 | 16 | 25 => return Some(sub_triangles(kind, count.isqrt())),
            3 => 2,
            6 => 4,
            7 => 5,
            12 => 6,
            _ => return None,
        };
        return gauss(degree);
    }
    match count {
        1 | 4 | 9 | 16 | 25 => Some(sub_boxes(kind, count.isqrt())),
        _ => None,
    }
}

/// The `k²` triangles into which `k` parallels to every side cut the parametric triangle.
fn sub_triangles(kind: CellKind, k: u32) -> Vec<Part> {
    let size = 1.0 / f64::from(k);
    let part = |corner: [f64; 2], sign: f64| {
        let at = |xi: &[f64; 3]| [corner[0] + sign * size * xi[0], corner[1] + sign * size * xi[1], 0.0];
        let quadrature = exact_rule(kind).iter().map(|(xi, w)| (at(xi), w * size * size)).collect();
        Part { point: at(&kind.centre()), quadrature }
    };
    let mut parts = Vec::new();
    for j in 0..k {
        for i in 0..k - j {
            let corner = |i: u32, j: u32| [size * f64::from(i), size * f64::from(j)];
            parts.push(part(corner(i, j), 1.0));
            if i + 1 < k - j {
                parts.push(part(corner(i + 1, j + 1), -1.0));
            }
        }
    }
    parts
}

/// The `k × k` equal boxes of the parametric square.
fn sub_boxes(kind: CellKind, k: u32) -> Vec<Part> {
    let size = 1.0 / f64::from(k);
    let mut parts = Vec::new();
    for j in 0..k {
        for i in 0..k {
            let centre = |i: u32| size * f64::from(2 * i + 1) - 1.0;
            let at = |xi: &[f64; 3]| [centre(i) + size * xi[0], centre(j) + size * xi[1], 0.0];
            let quadrature = exact_rule(kind).iter().map(|(xi, w)| (at(xi), w * size * size)).collect();
            parts.push(Part { point: at(&[0.0; 3]), quadrature });
        }
    }
    parts
}

fn no_rule<const D: usize>(mesh: &Mesh<D>, wanted: &RegionSeed, kind: CellKind) -> Error {
    let rules = if kind.is_simplex() { "3, 4, 6, 7, 9, 12, 16 or 25" } else { "4, 9, 16 or 25" };
    Error::input(
        format!("region {}, points_per_cell", mesh.regions[wanted.region as usize]),
        format!("{} points are not possible in its {kind:?} cells", wanted.points_per_cell),
        format!("use {rules}"),
    )
}

/// The stress of soil at rest, in kPa: `σ_y = −∫ γ dy` over the soil vertically above the point, `σ_x = σ_z =
/// k0 σ_y`, one entry a point. Points of regions that are not in `soils` have none.
///
/// The integral is exact for layers, for `γ` that grows with depth and for curved boundaries: per region it
/// is the signed sum of `γ`'s primitive where the vertical crosses the region's boundary.
///
/// # Errors
/// Input: `k0` that is negative or not finite.
pub fn k0_stress(mesh: &Mesh<2>, soils: &[RegionWeight], k0: f64, points: &Points<2>) -> Result<Vec<Symmetric>> {
    if !k0.is_finite() || k0 < 0.0 {
        return Err(Error::input("initial_stress.k0", format!("{k0} is no earth pressure coefficient"), "use 0.3 … 1"));
    }
    let boundaries: Vec<Vec<Arc>> = soils.iter().map(|soil| boundary(mesh, soil.region)).collect();
    let stress = |(x, region): (&[f64; 2], &u16)| {
        if soils.iter().all(|soil| soil.region != *region) {
            return [0.0; 6];
        }
        let layers = soils.iter().zip(&boundaries);
        let weight: f64 = layers.map(|(soil, boundary)| weight_above(boundary, &soil.unit_weight, x)).sum();
        [-k0 * weight, -weight, -k0 * weight, 0.0, 0.0, 0.0]
    };
    Ok(points.position.iter().zip(&points.region).map(stress).collect())
}

/// A piece of a region's boundary, counter-clockwise, on which `x` is monotone: ends at the parameters
/// `from` and `to` of the quadratic `a + b t + c t²`.
struct Arc {
    a: [f64; 2],
    b: [f64; 2],
    c: [f64; 2],
    from: f64,
    to: f64,
}

/// The boundary of a region, cut where its tangent is vertical.
fn boundary(mesh: &Mesh<2>, region: u16) -> Vec<Arc> {
    let locator = Locator::new(mesh);
    let mut arcs = Vec::new();
    for cell in (0..mesh.cells.len()).filter(|&c| mesh.cells.region[c] == region) {
        let facets = mesh.cells.kind[cell].facets().1;
        for (facet, &other) in facets.iter().zip(locator.neighbours(cell as u32)) {
            if other != OUTSIDE && mesh.cells.region[other as usize] == region {
                continue;
            }
            let x: Vec<[f64; 2]> = facet.iter().map(|&i| mesh.nodes[mesh.cells.nodes(cell)[i] as usize]).collect();
            let middle = x.get(2).copied().unwrap_or([0, 1].map(|d| 0.5 * (x[0][d] + x[1][d])));
            let b = [0, 1].map(|d| 0.5 * (x[1][d] - x[0][d]));
            let c = [0, 1].map(|d| 0.5 * (x[0][d] + x[1][d]) - middle[d]);
            let arc = |from, to| Arc { a: middle, b, c, from, to };
            let turn = -0.5 * b[0] / c[0];
            if turn > -1.0 && turn < 1.0 {
                arcs.extend([arc(-1.0, turn), arc(turn, 1.0)]);
            } else {
                arcs.push(arc(-1.0, 1.0));
            }
        }
    }
    arcs
}

impl Arc {
    fn at(&self, t: f64, d: usize) -> f64 {
        self.a[d] + t * (self.b[d] + t * self.c[d])
    }

    /// The height at which the piece crosses the vertical at `x`, which lies between its ends.
    fn height(&self, x: f64) -> f64 {
        let (a, b, c) = (self.a[0] - x, self.b[0], self.c[0]);
        // Both roots without cancellation; the one on the piece is wanted.
        let q = -0.5 * (b + (b * b - 4.0 * a * c).max(0.0).sqrt().copysign(b));
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let outside = |t: f64| if t.is_nan() { f64::INFINITY } else { (low - t).max(t - high).max(0.0) };
        let (r, s) = (q / c, a / q);
        let t = if outside(r) < outside(s) { r } else { s };
        self.at(t.clamp(low, high), 1)
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
        let (from, to) = (arc.at(arc.from, 0), arc.at(arc.to, 0));
        // Counter-clockwise: the region lies below a piece that runs to the left. Half-open intervals count a
        // vertex once.
        let sign = match (from <= x[0], to <= x[0]) {
            (true, false) => -1.0,
            (false, true) => 1.0,
            _ => continue,
        };
        let y = arc.height(x[0]);
        if y > x[1] {
            weight += sign * (primitive(y) - floor);
        }
    }
    weight
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use std::f64::consts::PI;

    const TRIANGLE_COUNTS: [u32; 8] = [3, 4, 6, 7, 9, 12, 16, 25];
    const BOX_COUNTS: [u32; 5] = [1, 4, 9, 16, 25];

    fn counts(kind: CellKind) -> &'static [u32] {
        if kind.is_simplex() { &TRIANGLE_COUNTS } else { &BOX_COUNTS }
    }

    fn plane_kinds() -> impl Iterator<Item = CellKind> {
        CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
    }

    fn all(points_per_cell: u32, density: f64) -> Vec<RegionSeed> {
        vec![RegionSeed { region: 0, points_per_cell, density: Profile::constant(density) }]
    }

    /// A quarter of a ring of radii 1 and 2 about the origin.
    fn ring(kind: CellKind, n: usize) -> Mesh<2> {
        let mut mesh = rectangle(kind, 1.0, 1.0, n, n, 0.15, 3);
        for x in &mut mesh.nodes {
            let (r, t) = (1.0 + x[0], x[1] * 0.5 * PI);
            *x = [r * t.cos(), r * t.sin()];
        }
        mesh
    }

    /// What the message offers is what the schema of a case allows.
    #[test]
    fn a_number_of_points_that_cells_cannot_have_is_told_with_those_they_can() {
        let mesh = rectangle(CellKind::Q9, 1.0, 1.0, 1, 1, 0.0, 3);
        let error = seed(&mesh, false, &all(6, 1.0)).unwrap_err().to_string();
        assert!(error.contains("6 points are not possible in its Q9 cells; use 4, 9, 16 or 25"), "{error}");
        let error = no_rule(&mesh, &all(5, 1.0)[0], CellKind::T6).to_string();
        assert!(error.contains("use 3, 4, 6, 7, 9, 12, 16 or 25"), "{error}");
    }

    #[test]
    fn the_mass_is_density_times_area_or_revolved_volume() {
        for kind in plane_kinds() {
            let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.2, 11);
            for &count in counts(kind) {
                for (axisymmetric, measure) in [(false, 6.0), (true, PI * 9.0 * 2.0)] {
                    let points = seed(&mesh, axisymmetric, &all(count, 1.7)).unwrap();
                    assert_eq!(points.len(), count as usize * mesh.cells.len());
                    let mass: f64 = points.mass.iter().sum();
                    assert!((mass / (1.7 * measure) - 1.0).abs() < 1e-12, "{kind:?} {count}: {mass}");
                }
            }
        }
    }

    #[test]
    fn finite_elements_have_points_that_integrate_degree_4() {
        for kind in plane_kinds() {
            let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.0, 11);
            let points = seed(&mesh, false, &all(QUADRATURE, 1.0)).unwrap();
            assert_eq!(points.len(), mesh.cells.len() * if kind.is_simplex() { 6 } else { 9 });
            let terms =
                points.position.iter().zip(&points.initial_volume).map(|(x, v)| v * x[0].powi(2) * x[1].powi(2));
            assert!((terms.sum::<f64>() / (9.0 * 8.0 / 3.0) - 1.0).abs() < 1e-12, "{kind:?}");
        }
    }

    #[test]
    fn curved_cells_keep_their_exact_measure() {
        for kind in plane_kinds().filter(|k| k.order() == 2) {
            let mesh = ring(kind, 3);
            let mut x = Vec::new();
            for &count in counts(kind) {
                let points = seed(&mesh, true, &all(count, 1.0)).unwrap();
                for c in 0..mesh.cells.len() {
                    mesh.cell_coordinates(c, &mut x);
                    let sum: f64 =
                        (0..points.len()).filter(|&p| points.cell[p] as usize == c).map(|p| points.mass[p]).sum();
                    // Pappus over the boundary: 2π ∫ r dA = π ∮ r² dy, by Gauss on the quadratic edges.
                    let mut exact = 0.0;
                    for facet in kind.facets().1 {
                        let edge: Vec<[f64; 2]> = facet.iter().map(|&i| x[i]).collect();
                        for (xi, w) in rule(CellKind::Line3, 6) {
                            let (mut n, mut dn) = ([0.0; 3], [[0.0; 3]; 3]);
                            CellKind::Line3.values(&xi, &mut n);
                            CellKind::Line3.derivatives(&xi, &mut dn);
                            let r: f64 = edge.iter().zip(&n).map(|(x, n)| n * x[0]).sum();
                            let dy: f64 = edge.iter().zip(&dn).map(|(x, dn)| dn[0] * x[1]).sum();
                            exact += PI * w * r * r * dy;
                        }
                    }
                    assert!((sum / exact - 1.0).abs() < 1e-13, "{kind:?} {count}: {sum} {exact}");
                }
            }
        }
    }

    #[test]
    fn points_are_equal_inside_their_cell_and_balanced() {
        for kind in plane_kinds() {
            let mesh = rectangle(kind, 1.0, 1.0, 2, 2, 0.0, 0);
            let locator = Locator::new(&mesh);
            for &count in counts(kind) {
                let points = seed(&mesh, false, &all(count, 1.0)).unwrap();
                let each = points.initial_volume[0];
                let equal = points.initial_volume.iter().all(|v| (v / each - 1.0).abs() < 1e-13);
                assert_eq!(equal, ![6, 7, 12].contains(&count), "{kind:?} {count}");
                for p in 0..points.len() {
                    let found = locator.locate(&mesh, &points.position[p], None).unwrap().0;
                    assert_eq!(found, points.cell[p]);
                }
                // First moments of the points are those of the square.
                let mut moment = [0.0; 2];
                for (x, v) in points.position.iter().zip(&points.initial_volume) {
                    moment = [moment[0] + v * x[0], moment[1] + v * x[1]];
                }
                assert!((moment[0] - 0.5).abs() < 1e-14 && (moment[1] - 0.5).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn only_the_regions_asked_for_are_filled_each_with_its_density() {
        let mut mesh = rectangle(CellKind::T6, 2.0, 1.0, 4, 2, 0.0, 0);
        mesh.regions = ["clay", "water", "sand"].map(String::from).to_vec();
        for c in 0..mesh.cells.len() {
            mesh.cells.region[c] = (c % 3) as u16;
        }
        let sand = Profile { top: 2.0, gradient: 0.5, datum: 1.0 };
        let seeds = [
            RegionSeed { region: 0, points_per_cell: 16, density: Profile::constant(1.0) },
            RegionSeed { region: 2, points_per_cell: 3, density: sand },
        ];
        let points = seed(&mesh, false, &seeds).unwrap();
        assert!(points.region.iter().all(|&r| r != 1));
        for p in 0..points.len() {
            let density = if points.region[p] == 0 { 1.0 } else { 2.0 + 0.5 * (1.0 - points.position[p][1]) };
            assert!((points.mass[p] - density * points.initial_volume[p]).abs() < 1e-16);
        }
        assert_eq!(points.deformation.len(), points.len());
        assert_eq!(points.origin, points.position);
        assert!(points.velocity.is_empty() && points.acceleration.is_empty());
    }

    #[test]
    fn impossible_seeds_are_refused() {
        let mesh = rectangle(CellKind::T6, 1.0, 1.0, 1, 1, 0.0, 0);
        let message = seed(&mesh, false, &all(5, 1.0)).unwrap_err().to_string();
        assert!(message.contains("region soil") && message.contains("5 points") && message.contains("16"), "{message}");
        let mut left = mesh.clone();
        left.nodes.iter_mut().for_each(|x| x[0] -= 2.0);
        assert!(seed(&left, true, &all(16, 1.0)).unwrap_err().to_string().contains("negative radius"));
        let mut inverted = mesh;
        inverted.nodes.iter_mut().for_each(|x| x[0] = -x[0]);
        assert!(seed(&inverted, false, &all(16, 1.0)).unwrap_err().to_string().contains("inverted"));
    }

    #[test]
    fn stress_at_rest_of_layers_is_exact() {
        for kind in plane_kinds() {
            let mut mesh = rectangle(kind, 2.0, 4.0, 3, 8, 0.0, 0);
            mesh.regions = vec!["sand".into(), "clay".into()];
            // Clay below y = 2, sand above; the sand's weight grows below y = 3.
            for c in 0..mesh.cells.len() {
                let nodes = mesh.cells.nodes(c);
                let top = nodes.iter().map(|&n| mesh.nodes[n as usize][1]).fold(0.0, f64::max);
                mesh.cells.region[c] = u16::from(top <= 2.0);
            }
            let soils = [
                RegionWeight { region: 0, unit_weight: Profile { top: 8.0, gradient: 3.0, datum: 3.0 } },
                RegionWeight { region: 1, unit_weight: Profile::constant(6.0) },
            ];
            let seeds = [0, 1].map(|region| RegionSeed { region, points_per_cell: 9, density: Profile::constant(1.0) });
            let points = seed(&mesh, false, &seeds).unwrap();
            let stress = k0_stress(&mesh, &soils, 0.5, &points).unwrap();
            for (x, s) in points.position.iter().zip(&stress) {
                let y = x[1];
                let sand = |y: f64| 8.0 * (4.0 - y) + 1.5 * (3.0 - y).max(0.0).powi(2);
                let expected = if y > 2.0 { sand(y) } else { sand(2.0) + 6.0 * (2.0 - y) };
                assert!((s[1] + expected).abs() < 1e-12 * expected, "{kind:?} {y}: {} {expected}", s[1]);
                assert_eq!((s[0], s[2]), (0.5 * s[1], 0.5 * s[1]));
                assert_eq!(s[3..], [0.0; 3]);
            }
            assert!(k0_stress(&mesh, &soils, -0.1, &points).is_err());
            let clay_only = k0_stress(&mesh, &soils[1..], 0.5, &points).unwrap();
            assert!(clay_only.iter().zip(&points.region).all(|(s, &r)| (r == 0) == (s[1] == 0.0)));
        }
    }

    #[test]
    fn stress_at_rest_follows_a_curved_surface_and_skips_a_gap() {
        // Under a quarter ring the soil above a point ends at the outer circle; left of x = 1 its vertical
        // leaves the soil at the inner circle.
        let mesh = ring(CellKind::T6, 24);
        let points = seed(&mesh, false, &all(4, 1.0)).unwrap();
        let soil = [RegionWeight { region: 0, unit_weight: Profile::constant(10.0) }];
        let stress = k0_stress(&mesh, &soil, 1.0, &points).unwrap();
        for (x, s) in points.position.iter().zip(&stress) {
            let height = (4.0 - x[0] * x[0]).max(0.0).sqrt() - x[1];
            // Piecewise quadratics keep the circle to 1e-7, worst where it is steep.
            assert!((s[1] + 10.0 * height).abs() < 1e-4, "{x:?} {} {height}", s[1]);
        }
        // Two cells one above the other with a gap between them.
        let mut mesh = rectangle(CellKind::Q4, 1.0, 3.0, 1, 3, 0.0, 0);
        mesh.regions.push("water".into());
        mesh.cells.region[1] = 1;
        let points = seed(&mesh, false, &all(1, 1.0)).unwrap();
        let stress = k0_stress(&mesh, &soil, 1.0, &points).unwrap();
        assert!((stress[0][1] + 15.0).abs() < 1e-13 && (stress[1][1] + 5.0).abs() < 1e-13, "{stress:?}");
    }
}
