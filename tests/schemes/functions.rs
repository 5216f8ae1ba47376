//! The functions by themselves: what they sum up to, what they reproduce, where they are continuous, and that they are the means they claim to be.

use crate::schemes::shapes::{Field, Seen};
use mpm::interpolation::{Basis, Composite, Cpdi, Cpdi2, Gimp, Mpm};
use mpm::kinematics::Axisymmetric;
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::{CellKind, map, rule};
use std::f64::consts::TAU;

pub const UGIMP: &dyn Basis<2> = &Gimp::UNIFORM;
pub const CPGIMP: &dyn Basis<2> = &Gimp::STRETCHED;
pub const COMPOSITE: &dyn Basis<2> = &Composite;
pub const CPDI: &dyn Basis<2> = &Cpdi;
pub const CPDI2: &dyn Basis<2> = &Cpdi2;

const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

/// Lines of a graded grid (m).
const LINES: [[f64; 6]; 2] = [[0.0, 1.0, 1.8, 3.0, 4.5, 5.0], [0.0, 0.7, 1.5, 2.0, 3.0, 4.0]];

/// A grid of rectangles with those lines.
fn graded() -> Mesh<2> {
    let mut mesh = rectangle(CellKind::Q4, 5.0, 5.0, 5, 5, 0.0, 1);
    for x in &mut mesh.nodes {
        *x = [0, 1].map(|d| LINES[d][x[d].round() as usize]);
    }
    mesh
}

/// The grid without its upper right cells: a corner enters it.
fn with_a_corner() -> Field {
    let mut field = Field::new(graded());
    let mesh = field.mesh.part(|_| true);
    field.active = (0..mesh.cells.len())
        .map(|c| {
            let first = mesh.nodes[mesh.cells.nodes(c)[0] as usize];
            first[0] < 3.0 || first[1] < 2.0
        })
        .collect();
    field
}

/// Deformation gradients: none, a stretch, a shear, a rotation with a stretch.
const DEFORMED: [[[f64; 2]; 2]; 4] =
    [[[1.0, 0.0], [0.0, 1.0]], [[1.3, 0.0], [0.0, 0.8]], [[1.0, 0.4], [0.1, 1.0]], [[0.6, -0.9], [0.8, 0.5]]];

/// Schemes with the grids that they support: a graded one of rectangles, and jittered ones of each kind.
fn all() -> Vec<(&'static dyn Basis<2>, Field)> {
    let jittered = |kind| Field::new(rectangle(kind, 5.0, 4.0, 5, 4, 0.2, 5));
    let mut all: Vec<(&'static dyn Basis<2>, Field)> = Vec::new();
    for scheme in [UGIMP, CPGIMP, COMPOSITE, CPDI, CPDI2] {
        all.push((scheme, Field::new(graded())));
        all.push((scheme, with_a_corner()));
    }
    for kind in KINDS {
        all.push((CPDI, jittered(kind)));
        all.push((CPDI2, jittered(kind)));
    }
    all
}

/// Places all over a grid of 5 by 4, on its boundary and its corners too.
fn places() -> Vec<[f64; 2]> {
    let mut places = Vec::new();
    for i in 0..14 {
        for j in 0..14 {
            let t = |k: usize| (k as f64 / 13.0 + 0.03 * ((k * 7 + 3) as f64).sin()).clamp(0.0, 1.0);
            places.push([5.0 * t(i), 4.0 * t(j)]);
        }
    }
    places.extend([[0.0, 0.0], [5.0, 4.0], [1e-9, 2.0], [2.0, 4.0 - 1e-7]]);
    places
}

/// Values sum up to one and gradients to zero. A linear field has its gradient, and its value at the point, also where a domain is longer than a
/// cell or reaches beyond the grid. The value is that at the centroid of the rest where GIMP leaves out a part beyond a corner.
#[test]
fn linear_fields_come_back() {
    for (scheme, field) in all() {
        let corner = field.active.contains(&false);
        let is_gimp = scheme == UGIMP || scheme == CPGIMP || scheme == COMPOSITE;
        for x in places() {
            let (cell, _) = field.locator.locate(&field.mesh, &x, None).unwrap();
            if !field.active[cell as usize] {
                continue;
            }
            for f in DEFORMED {
                for area in [0.09, 1.5] {
                    let (mut points, xi) = field.begun(scheme, x, area);
                    field.deform(scheme, &mut points, f);
                    let seen = field.seen(scheme, &points, &xi);
                    let (one, zero) = seen.of(&field.mesh, |_| 1.0);
                    let case = || format!("{} at {x:?}, F = {f:?}, {area} m²", scheme.name());
                    assert!((one - 1.0).abs() < 1e-12, "{}: {one}", case());
                    assert!(zero.iter().all(|g| g.abs() < 1e-9), "{}: {zero:?}", case());
                    let (value, gradient) = seen.of(&field.mesh, |x| 2.0 * x[0] - 3.0 * x[1]);
                    let error = [gradient[0] - 2.0, gradient[1] + 3.0];
                    assert!(error.iter().all(|e| e.abs() < 1e-8), "{}: {error:?}", case());
                    let strain = seen.strain_of(&field.mesh, |x| 7.0 + 2.0 * x[0] - 3.0 * x[1]);
                    let error = [strain[0] - 2.0, strain[1] + 3.0];
                    assert!(error.iter().all(|e| e.abs() < 1e-8), "{}: {error:?}", case());
                    if !(corner && is_gimp) {
                        let error = value - (2.0 * x[0] - 3.0 * x[1]);
                        assert!(error.abs() < 2e-6, "{}: {error:e}", case());
                    }
                }
            }
        }
    }
}

/// The mean over a rectangle of the functions of the cells, by Gauss points in each part between lines of the grid.
fn mean_over(field: &Field, low: [f64; 2], high: [f64; 2]) -> Seen {
    let count = field.mesh.nodes.len();
    let mut mean = Seen::zero(count);
    let cuts = [0, 1].map(|d| {
        let mut cuts: Vec<f64> = LINES[d].iter().copied().filter(|&x| x > low[d] && x < high[d]).collect();
        cuts.extend([low[d], high[d]]);
        cuts.sort_by(f64::total_cmp);
        cuts
    });
    let area = (high[0] - low[0]) * (high[1] - low[1]);
    for x in cuts[0].windows(2) {
        for y in cuts[1].windows(2) {
            for (xi, weight) in rule(CellKind::Q4, 3) {
                let at = |w: &[f64], t: f64| 0.5 * (w[0] + w[1]) + 0.5 * t * (w[1] - w[0]);
                let part = 0.25 * (x[1] - x[0]) * (y[1] - y[0]) / area;
                mean.add(weight * part, &field.at([at(x, xi[0]), at(y, xi[1])]));
            }
        }
    }
    mean
}

#[test]
fn gimp_has_the_means_over_its_rectangles() {
    let field = Field::new(graded());
    for x in [[2.2, 1.6], [1.05, 0.75], [3.9, 2.4], [2.9, 1.99]] {
        for (scheme, stretch) in [(UGIMP, [1.0, 1.0]), (CPGIMP, [1.3, 0.8])] {
            let (mut points, xi) = field.begun(scheme, x, 0.2);
            let lengths = [points.domain[0], points.domain[1]];
            field.deform(scheme, &mut points, [[1.3, 0.0], [0.0, 0.8]]);
            let half = [0, 1].map(|d| 0.5 * lengths[d] * stretch[d]);
            let mean = mean_over(&field, [x[0] - half[0], x[1] - half[1]], [x[0] + half[0], x[1] + half[1]]);
            let apart = field.seen(scheme, &points, &xi).apart(&mean);
            assert!(apart.iter().all(|e| *e < 1e-11), "{} at {x:?}: {apart:?}", scheme.name());
        }
    }
}

/// Close to a side of the grid, and with a length of several cells, a domain ends at the side and at the next but one line of the grid, on both
/// sides of its point alike.
#[test]
fn gimp_domains_keep_their_centre_where_they_are_cut() {
    let field = Field::new(graded());
    let seen = |x, area| {
        let (points, xi) = field.begun(UGIMP, x, area);
        field.seen(UGIMP, &points, &xi)
    };
    // The cell is 1 by 0.8, the domain 0.5 by 0.4. Then 4.8 by 2 in a cell of 1.2 by 0.5, with the cells beside it ending at 1, 4.5, 0.7 and 3.
    for (x, area, low, high) in [([0.1, 1.2], 0.2, [0.0, 1.0], [0.2, 1.4]), ([2.3, 1.7], 9.6, [1.0, 0.7], [3.6, 2.7])] {
        let apart = seen(x, area).apart(&mean_over(&field, low, high));
        assert!(apart.iter().all(|e| *e < 1e-11), "{x:?}: {apart:?}");
    }
}

/// The strains of composite points within a body are those of polynomials through the nodes: of third degree along each axis inside, of second one at
/// the boundary of the grid. Their forces have the functions of GIMP.
#[test]
fn composite_points_have_the_strains_of_polynomials_over_a_patch() {
    let cubic = |[x, y]: [f64; 2]| (x * x * x - 4.0 * x) * (1.0 + 0.3 * y - 0.2 * y * y * y);
    let gradient = |[x, y]: [f64; 2]| {
        let (along, across) = (x * x * x - 4.0 * x, 1.0 + 0.3 * y - 0.2 * y * y * y);
        [(3.0 * x * x - 4.0) * across, along * (0.3 - 0.6 * y * y)]
    };
    let quadratic = |[x, y]: [f64; 2]| x * x - 0.7 * x * y + 1.3 * y * y;
    let slope = |[x, y]: [f64; 2]| [2.0 * x - 0.7 * y, 2.6 * y - 0.7 * x];
    let [whole, corner] = [Field::new(graded()), with_a_corner()];
    let off = |field: &Field, x, f: &dyn Fn([f64; 2]) -> f64, exact: [f64; 2]| {
        let (points, xi) = field.within_a_body(COMPOSITE, x, 0.2);
        let seen = field.seen(COMPOSITE, &points, &xi);
        let forces = seen.apart(&field.seen(CPGIMP, &points, &xi));
        assert!(forces == [0.0; 2], "{forces:?}");
        let strain = seen.strain_of(&field.mesh, f);
        [0, 1].map(|d| (strain[d] - exact[d]).abs())
    };
    for x in [[2.2, 1.6], [1.05, 0.75], [3.9, 2.4], [1.0, 2.0]] {
        let error = off(&whole, x, &cubic, gradient(x));
        assert!(error.iter().all(|e| *e < 1e-11), "{x:?}: {error:?}");
    }
    for x in [[0.3, 0.2], [4.9, 1.1], [2.2, 3.9], [5.0, 4.0]] {
        let error = off(&whole, x, &quadratic, slope(x));
        assert!(error.iter().all(|e| *e < 1e-11), "{x:?}: {error:?}");
        let error = off(&whole, x, &cubic, gradient(x));
        assert!(error.iter().any(|e| *e > 1e-2), "{x:?}: {error:?}");
    }
    // Beside empty cells, as at the corner of the body at (3, 2), strains are those of GIMP.
    for x in [[2.2, 1.8], [2.2, 2.4], [3.7, 1.8]] {
        let (points, xi) = corner.within_a_body(COMPOSITE, x, 0.2);
        let seen = corner.seen(COMPOSITE, &points, &xi);
        assert!(seen.strain == seen.gradient, "{x:?}");
    }
    let error = off(&corner, [1.2, 1.2], &cubic, gradient([1.2, 1.2]));
    assert!(error.iter().all(|e| *e < 1e-11), "{error:?}");
    // A grid that ends in a corner: three lines are left along both axes in the cell at it, and in those on its sides.
    let end = Field::new(with_a_corner().mesh.part(|c| with_a_corner().active[c]));
    for x in [[2.2, 1.8], [2.2, 2.4], [3.7, 1.8]] {
        let error = off(&end, x, &quadratic, slope(x));
        assert!(error.iter().all(|e| *e < 1e-11), "{x:?}: {error:?}");
    }
    // A point that is alone has the strain of GIMP.
    let (points, xi) = whole.begun(COMPOSITE, [2.2, 1.49], 0.2);
    let alone = whole.seen(COMPOSITE, &points, &xi);
    assert!(alone.strain == alone.gradient);
}

/// A body that has turned by a right angle has domains as before; with `F_ii` in place of `U_ii` they would have vanished.
#[test]
fn gimp_domains_do_not_shrink_as_they_turn() {
    let field = Field::new(graded());
    for angle in [0.3f64, 1.0, 1.5, 3.0] {
        let (s, c) = angle.sin_cos();
        let (mut points, _) = field.begun(CPGIMP, [2.2, 1.6], 0.2);
        let before = points.domain.clone();
        field.deform(CPGIMP, &mut points, [[c, -s], [s, c]]);
        let most = points.domain.iter().zip(&before).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        assert!(most < 1e-9, "{angle}: {most:e}");
    }
}

/// `1/V ∫ f dV` of what is bilinear between values at corners, and of its gradient, by Gauss points.
fn mean_of_bilinear(corners: [[f64; 2]; 4], values: [f64; 4]) -> (f64, [f64; 2]) {
    let (mut volume, mut mean, mut slope) = (0.0, 0.0, [0.0; 2]);
    let (mut n, mut g) = ([0.0; 4], [[0.0; 2]; 4]);
    for (xi, weight) in rule(CellKind::Q4, 5) {
        let weight = weight * map(CellKind::Q4, &corners, &xi, &mut n, &mut g);
        volume += weight;
        for c in 0..4 {
            mean += weight * n[c] * values[c];
            (0..2).for_each(|d| slope[d] += weight * g[c][d] * values[c]);
        }
    }
    (mean / volume, slope.map(|s| s / volume))
}

/// The corners of a domain of CPDI (m): `x ± F r₁ ± F r₂` on a grid of unit squares, `r` half the edges of a square of area `area`.
fn parallelogram(x: [f64; 2], f: [[f64; 2]; 2], area: f64) -> [[f64; 2]; 4] {
    let r = 0.5 * area.sqrt();
    [[-r, -r], [r, -r], [r, r], [-r, r]].map(|s| [0, 1].map(|d| x[d] + f[d][0] * s[0] + f[d][1] * s[1]))
}

/// The mean in a domain of the function of each node, with `N` interpolated from the corners, by Gauss points.
fn from_corners(field: &Field, corners: [[f64; 2]; 4]) -> Seen {
    let at = corners.map(|x| field.at(x));
    let nodes = 0..field.mesh.nodes.len();
    let means: Vec<_> = nodes.map(|n| mean_of_bilinear(corners, [0, 1, 2, 3].map(|c| at[c].value[n]))).collect();
    let (value, gradient) = means.into_iter().unzip();
    Seen { value, gradient, ..Seen::default() }
}

/// On unit squares, with domains in several cells.
#[test]
fn cpdi_and_cpdi2_have_the_means_of_what_is_bilinear_between_their_corners() {
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    for f in DEFORMED {
        for x in [[2.3, 1.6], [1.9, 2.05], [3.5, 1.5]] {
            let expected = from_corners(&field, parallelogram(x, f, 0.3));
            for scheme in [CPDI, CPDI2] {
                let (mut points, xi) = field.begun(scheme, x, 0.3);
                field.deform(scheme, &mut points, f);
                let apart = field.seen(scheme, &points, &xi).apart(&expected);
                assert!(apart.iter().all(|e| *e < 1e-9), "{} at {x:?}, F = {f:?}: {apart:?}", scheme.name());
            }
        }
    }
}

/// A displacement that makes a general quadrilateral of a square.
fn bent([x, y]: [f64; 2]) -> [f64; 2] {
    [0.1 * x - 0.2 * y + 0.25 * (x - 2.0) * (y - 1.5), 0.3 * (x - 2.0) * (y - 1.5) + 0.1 * y]
}

/// The quadrilateral of CPDI2 after a bilinear displacement, by Gauss points and by the closed forms of Sadeghirad, Brannon & Guilkey (2013).
#[test]
fn cpdi2_has_the_means_over_its_quadrilateral() {
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    for x in [[2.3, 1.6], [1.9, 2.05], [2.5, 1.5]] {
        let (mut points, xi) = field.begun(CPDI2, x, 0.4);
        let first = parallelogram(x, [[1.0, 0.0], [0.0, 1.0]], 0.4);
        assert!(field.reset(CPDI2, &mut points, bent).is_none());
        // Cell by cell the displacement is bilinear, so that corners move exactly; the point stays where it is, and its domain with it.
        let moved = first.map(|x| [0, 1].map(|d| x[d] + bent(x)[d]));
        let mean = |f: &dyn Fn([f64; 2]) -> f64| mean_of_bilinear(moved, moved.map(f)).0;
        let centre = [mean(&|x| x[0]), mean(&|x| x[1])];
        let c = moved.map(|m| [0, 1].map(|d| m[d] + x[d] - centre[d]));
        let seen = field.seen(CPDI2, &points, &xi);
        let apart = seen.apart(&from_corners(&field, c));
        assert!(apart.iter().all(|e| *e < 1e-11), "{x:?}: {apart:?}");

        let [[x1, y1], [x2, y2], [x3, y3], [x4, y4]] = c;
        let volume = 0.5 * ((x1 - x3) * (y2 - y4) - (x2 - x4) * (y1 - y3));
        let a = (x4 - x1) * (y2 - y3) - (x2 - x3) * (y4 - y1);
        let b = (x3 - x4) * (y1 - y2) - (x1 - x2) * (y3 - y4);
        let n = c.map(|x| field.at(x).value);
        for node in 0..field.mesh.nodes.len() {
            let [n1, n2, n3, n4] = [0, 1, 2, 3].map(|c: usize| n[c][node]);
            let weighted = (6.0 * volume - a - b) * n1
                + (6.0 * volume - a + b) * n2
                + (6.0 * volume + a + b) * n3
                + (6.0 * volume + a - b) * n4;
            assert!((weighted / (24.0 * volume) - seen.value[node]).abs() < 1e-11);
            let gradient = [
                ((n1 - n3) * (y2 - y4) + (n2 - n4) * (y3 - y1)) / (2.0 * volume),
                ((n1 - n3) * (x4 - x2) + (n2 - n4) * (x1 - x3)) / (2.0 * volume),
            ];
            assert!((0..2).all(|d| (gradient[d] - seen.gradient[node][d]).abs() < 1e-11));
        }
    }
}

/// In a straight cell of second order that holds the domain, Simpson's rule is exact: the means of the cell's own functions, by Gauss points. In Q9,
/// whose functions have terms up to `x²y²`, it is for domains along the axes.
#[test]
fn in_a_cell_of_second_order_the_means_are_those_of_its_functions() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let field = Field::new(rectangle(kind, 5.0, 4.0, 5, 4, 0.0, 1));
        for f in DEFORMED {
            if kind == CellKind::Q9 && f[0][1] != 0.0 {
                continue;
            }
            for scheme in [CPDI, CPDI2] {
                let x = [2.35, 1.3];
                let (mut points, xi) = field.begun(scheme, x, 0.01);
                let first = field.begun(CPDI, x, 0.01).0.domain;
                field.deform(scheme, &mut points, f);
                let corner = |c: usize| [0, 1].map(|i| x[i] + f[i][0] * first[2 * c] + f[i][1] * first[2 * c + 1]);
                let corners = [0, 1, 2, 3].map(corner);
                let count = field.mesh.nodes.len();
                let mut mean = Seen::zero(count);
                let (mut n, mut g, mut volume) = ([0.0; 4], [[0.0; 2]; 4], 0.0);
                let quadrature = rule(CellKind::Q4, 5).into_iter().map(|(at, weight)| {
                    let weight = weight * map(CellKind::Q4, &corners, &at, &mut n, &mut g);
                    volume += weight;
                    (weight, [0, 1].map(|d| n.iter().zip(&corners).map(|(n, x)| n * x[d]).sum()))
                });
                let quadrature: Vec<(f64, [f64; 2])> = quadrature.collect();
                quadrature.iter().for_each(|(weight, at)| mean.add(weight / volume, &field.at(*at)));
                let apart = field.seen(scheme, &points, &xi).apart(&mean);
                assert!(apart.iter().all(|e| *e < 1e-10), "{} {kind:?}, F = {f:?}: {apart:?}", scheme.name());
            }
        }
    }
}

/// The mean of a function over a domain, by Gauss points.
fn second_moments(corners: [[f64; 2]; 4], f: impl Fn([f64; 2]) -> f64) -> f64 {
    let (mut sum, mut volume, mut n, mut g) = (0.0, 0.0, [0.0; 4], [[0.0; 2]; 4]);
    for (at, weight) in rule(CellKind::Q4, 5) {
        let weight = weight * map(CellKind::Q4, &corners, &at, &mut n, &mut g);
        volume += weight;
        sum += weight * f([0, 1].map(|d| n.iter().zip(&corners).map(|(n, x)| n * x[d]).sum()));
    }
    sum / volume
}

/// On cells of second order a quadratic has its mean and that of its gradient, in one cell or several: with the corners alone its mean would be three
/// times as far from its value at the point.
#[test]
fn quadratics_have_their_means_on_cells_of_second_order() {
    let quadratic = |[x, y]: [f64; 2]| x * x - 0.7 * x * y + 1.3 * y * y;
    for kind in [CellKind::T6, CellKind::Q9, CellKind::Q8] {
        let field = Field::new(rectangle(kind, 5.0, 4.0, 5, 4, 0.0, 1));
        for scheme in [CPDI, CPDI2] {
            let x = [2.2, 1.95];
            let (mut points, xi) = field.begun(scheme, x, 0.3);
            field.deform(scheme, &mut points, [[1.1, 0.4], [0.1, 1.0]]);
            let about = if scheme == CPDI { [0.0; 2] } else { x };
            let corners: Vec<[f64; 2]> =
                points.domain[8..].chunks_exact(2).map(|c| [c[0] - about[0], c[1] - about[1]]).collect();
            let moments = second_moments(corners.try_into().unwrap(), quadratic);
            let (mean, gradient) = field.seen(scheme, &points, &xi).of(&field.mesh, quadratic);
            assert!((mean - quadratic(x) - moments).abs() < 1e-11, "{kind:?} {}: {mean}", scheme.name());
            let exact = [2.0 * x[0] - 0.7 * x[1], 2.6 * x[1] - 0.7 * x[0]];
            let error = [0, 1].map(|d| gradient[d] - exact[d]);
            assert!(error.iter().all(|e| e.abs() < 1e-11), "{kind:?} {}: {error:?}", scheme.name());
        }
    }
}

/// The largest changes of a value and of a gradient (1/m) along a line over the grid in steps of `step` (m).
fn jumps(scheme: &dyn Basis<2>, field: &Field, step: f64) -> [f64; 2] {
    let (from, to) = ([1.2, 1.2], [3.6, 2.9]);
    let (first, _) = field.begun(scheme, from, 0.2);
    let length = (2.4f64 * 2.4 + 1.7 * 1.7).sqrt();
    let mut most = [0.0f64; 2];
    // Some places of the line, each with the next one a step on.
    for k in 0..400 {
        let seen = [0.0, 1.0].map(|next| {
            let t = (k as f64 + 0.5) / 400.0 + next * step / length;
            let x = [0, 1].map(|d| from[d] + t * (to[d] - from[d]));
            let (mut points, xi) = field.point(x, 0.2);
            points.domain = first.domain.clone();
            if scheme == CPDI2 {
                for corner in points.domain[8..].chunks_exact_mut(2) {
                    (0..2).for_each(|d| corner[d] += x[d] - from[d]);
                }
            }
            field.seen(scheme, &points, &xi)
        });
        let apart = seen[0].apart(&seen[1]);
        most = [0, 1].map(|i| most[i].max(apart[i]));
    }
    most
}

/// As a point goes on by a twentieth of a cell and by a hundredth of that, the gradients change in proportion; those of the plain method jump.
#[test]
fn gradients_are_continuous_over_the_walls_of_cells() {
    for (scheme, kind) in [
        (UGIMP, CellKind::Q4),
        (CPGIMP, CellKind::Q4),
        (CPDI, CellKind::T3),
        (CPDI, CellKind::T6),
        (CPDI, CellKind::Q9),
        (CPDI2, CellKind::T6),
    ] {
        let field = Field::new(rectangle(kind, 5.0, 4.0, 5, 4, 0.0, 1));
        // Every place of the line is tried with a step that crosses walls at some.
        let coarse = jumps(scheme, &field, 0.006);
        let fine = jumps(scheme, &field, 0.0006);
        println!("{} on {kind:?}: {coarse:?}, {fine:?}", scheme.name());
        for (fine, coarse) in fine.iter().zip(&coarse) {
            assert!(*fine < 0.2 * coarse, "{} on {kind:?}: {fine:e} of {coarse:e}", scheme.name());
        }
    }
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    let plain = jumps(&Mpm, &field, 0.006)[1];
    assert!(plain > 0.5, "{plain}");
}

/// Hoop strain is by the radius of the point.
#[test]
fn hoop_strain_is_the_value_over_the_radius_of_the_point() {
    let field = Field::new(graded());
    for scheme in [UGIMP, CPGIMP, COMPOSITE, CPDI, CPDI2] {
        let (points, xi) = field.begun(scheme, [2.2, 1.6], 0.2);
        let (_, radius) = field.seen_in::<Axisymmetric>(scheme, &points, &xi);
        assert!((radius - 2.2).abs() < 1e-12, "{}: {radius}", scheme.name());
    }
}

/// The same simple shear in each of many steps leaves the domains of CPDI and CPDI2 alike, far beyond what their points can reach, and sums right.
#[test]
fn simple_shear_to_five_leaves_parallelograms() {
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    let x = [2.4, 1.8];
    let (mut points, xi) = field.begun(CPDI2, x, 0.25);
    for step in 1..=50 {
        let shear = 0.1 * f64::from(step);
        assert!(field.reset(CPDI2, &mut points, |at| [0.1 * (at[1] - x[1]), 0.0]).is_none());
        let expected = parallelogram(x, [[1.0, shear], [0.0, 1.0]], 0.25);
        let corners = points.domain[8..].chunks_exact(2).zip(expected);
        let error = corners.fold(0.0, |m: f64, (a, b)| m.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs()));
        assert!(error < 1e-12, "sheared by {shear}: {error:e}");
        let (mut parallel, _) = field.begun(CPDI, x, 0.25);
        field.deform(CPDI, &mut parallel, [[1.0, shear], [0.0, 1.0]]);
        let apart = field.seen(CPDI2, &points, &xi).apart(&field.seen(CPDI, &parallel, &xi));
        // Longer domains are scaled, to 1e-9.
        assert!(apart.iter().all(|e| *e < 1e-7), "sheared by {shear}: {apart:?}");
        let (value, gradient) = field.seen(CPDI2, &points, &xi).of(&field.mesh, |[x, y]| 2.0 * x - 3.0 * y);
        let error = [value - 2.0 * x[0] + 3.0 * x[1], gradient[0] - 2.0, gradient[1] + 3.0];
        assert!(error.iter().all(|e| e.abs() < 1e-8), "sheared by {shear}: {error:?}");
    }
}

/// In shear that varies over a domain, that of CPDI2 bends until its corners are nearly in line: it then becomes that of CPDI, and is reported. Linear fields are exact all the way.
#[test]
fn a_domain_that_tangles_becomes_that_of_cpdi() {
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    let x = [2.4, 1.8];
    let (mut points, xi) = field.begun(CPDI2, x, 0.25);
    let mut notes = Vec::new();
    for step in 1..=40 {
        // The material turns faster the farther right it is.
        if let Some(note) = field.reset(CPDI2, &mut points, |at| [0.0, 0.2 * (at[0] - x[0]) * (at[1] - x[1])]) {
            notes.push((step, note));
        }
        let (value, gradient) = field.seen(CPDI2, &points, &xi).of(&field.mesh, |[x, y]| 2.0 * x - 3.0 * y);
        let error = [value - 2.0 * x[0] + 3.0 * x[1], gradient[0] - 2.0, gradient[1] + 3.0];
        assert!(error.iter().all(|e| e.abs() < 1e-8), "step {step}: {error:?}");
    }
    let (step, note) = &notes[0];
    println!("after {step} steps: {note}");
    assert!(*step > 10 && note.contains("nearly in line") && note.contains("material point 0"), "{notes:?}");
}

/// A domain that the grid folds at once, too.
#[test]
fn a_folded_domain_becomes_that_of_cpdi() {
    let field = Field::new(rectangle(CellKind::Q4, 5.0, 4.0, 5, 4, 0.0, 1));
    let x = [2.5, 2.0];
    let (mut points, xi) = field.begun(CPDI2, x, 0.5);
    let fold = |x: [f64; 2]| if x[0] > 2.6 && x[1] > 2.6 { [-1.9, -1.9] } else { [0.0, 0.0] };
    assert!(field.reset(CPDI2, &mut points, fold).is_some());
    let (plain, _) = field.begun(CPDI2, x, 0.5);
    // Its point has not been deformed.
    let most = points.domain.iter().zip(&plain.domain).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    assert!(most < 1e-12, "{most:e}");
    let (one, _) = field.seen(CPDI2, &points, &xi).of(&field.mesh, |_| 1.0);
    assert!((one - 1.0).abs() < 1e-12);
}

/// What a mesh has to be like is said.
#[test]
fn meshes_that_a_scheme_does_not_support_are_refused() {
    assert!(CPGIMP.refusal(&graded()).is_none());
    let [problem, remedy] = CPGIMP.refusal(&rectangle(CellKind::Q4, 3.0, 3.0, 3, 3, 0.2, 5)).unwrap();
    assert!(problem.contains("rectangles along the axes") && remedy.contains("cpdi"), "{problem}; {remedy}");
    let fan = |count: u32| {
        let mut fan = Mesh { nodes: vec![[0.0; 2]], ..Mesh::default() };
        let angle = |k: u32| TAU * f64::from(k) / f64::from(count);
        fan.nodes.extend((0..count).map(|k| [angle(k).cos(), angle(k).sin()]));
        (0..count).for_each(|k| fan.cells.push(CellKind::T3, 0, &[0, 1 + k, 1 + (k + 1) % count]));
        fan
    };
    assert!(CPDI.refusal(&fan(40)).is_none());
    let [problem, _] = CPDI.refusal(&fan(70)).unwrap();
    assert!(problem.contains("at most 64, and there are 71"), "{problem}");
}
