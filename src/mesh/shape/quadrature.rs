//! Quadrature rules on the parametric domains: Gauss–Legendre on lines and boxes, the symmetric rules of
//! Strang & Fix (1973) and Dunavant (1985) on triangles, those of Stroud (1971) and Keast (1986) with positive weights on
//! tetrahedra. Weights sum to the parametric measure (2, 4, 8, ½, ⅙).

use super::CellKind;

/// Points and weights that integrate polynomials up to `degree` over the domain of `kind`: at most 6 on triangles
/// and tetrahedra, 9 in each direction on lines and boxes.
pub fn rule(kind: CellKind, degree: usize) -> Vec<([f64; 3], f64)> {
    match kind.dimension() {
        0 => vec![([0.0; 3], 1.0)],
        1 => gauss(degree / 2 + 1).into_iter().map(|(t, w)| ([t, 0.0, 0.0], w)).collect(),
        2 if kind.is_simplex() => triangle(degree),
        3 if kind.is_simplex() => tetrahedron(degree),
        3 => {
            let line = gauss(degree / 2 + 1);
            let plane = line.iter().flat_map(|&(z, u)| line.iter().map(move |&(y, v)| (y, z, u * v)));
            plane.flat_map(|(y, z, v)| line.iter().map(move |&(x, w)| ([x, y, z], v * w))).collect()
        }
        _ => {
            let line = gauss(degree / 2 + 1);
            let grid = line.iter().flat_map(|&(y, v)| line.iter().map(move |&(x, w)| ([x, y, 0.0], v * w)));
            grid.collect()
        }
    }
}

/// Gauss–Legendre points and weights on `[-1, 1]`, exact to degree `2 count − 1`.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    match count {
        1 => vec![(0.0, 2.0)],
        2 => {
            let t = 1.0 / 3f64.sqrt();
            vec![(-t, 1.0), (t, 1.0)]
        }
        3 => {
            let t = 0.6f64.sqrt();
            vec![(-t, 5.0 / 9.0), (0.0, 8.0 / 9.0), (t, 5.0 / 9.0)]
        }
        4 => {
            let (r, s) = (2.0 / 7.0 * 1.2f64.sqrt(), 30f64.sqrt() / 36.0);
            let (t, u) = ((3.0 / 7.0 - r).sqrt(), (3.0 / 7.0 + r).sqrt());
            vec![(-u, 0.5 - s), (-t, 0.5 + s), (t, 0.5 + s), (u, 0.5 - s)]
        }
        _ => {
            let (r, s) = (2.0 * (10.0f64 / 7.0).sqrt(), 13.0 * 70f64.sqrt());
            let (t, u) = ((5.0 - r).sqrt() / 3.0, (5.0 + r).sqrt() / 3.0);
            let (v, w) = ((322.0 + s) / 900.0, (322.0 - s) / 900.0);
            vec![(-u, w), (-t, v), (0.0, 128.0 / 225.0), (t, v), (u, w)]
        }
    }
}

/// Rules with 1, 3, 6, 7 and 12 points on the unit triangle, the least that reaches `degree`.
fn triangle(degree: usize) -> Vec<([f64; 3], f64)> {
    let mut points = Vec::new();
    // The three points with barycentric coordinates (a, b, b), b = (1 − a)/2.
    let mut three = |a: f64, weight: f64| {
        let b = 0.5 * (1.0 - a);
        for xi in [[b, b, 0.0], [a, b, 0.0], [b, a, 0.0]] {
            points.push((xi, 0.5 * weight));
        }
    };
    match degree {
        0 | 1 => points.push(([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)),
        2 => three(2.0 / 3.0, 1.0 / 3.0),
        3 | 4 => {
            // Strang & Fix, degree 4, in closed form.
            let r = (38.0 - 44.0 * 0.4f64.sqrt()).sqrt();
            for sign in [1.0, -1.0] {
                let b = (8.0 - 10f64.sqrt() + sign * r) / 18.0;
                let w = (620.0 + sign * (213125.0 - 53320.0 * 10f64.sqrt()).sqrt()) / 3720.0;
                three(1.0 - 2.0 * b, w);
            }
        }
        5 => {
            let r = 15f64.sqrt();
            three(1.0 - 2.0 * (6.0 - r) / 21.0, (155.0 - r) / 1200.0);
            three(1.0 - 2.0 * (6.0 + r) / 21.0, (155.0 + r) / 1200.0);
            points.push(([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5 * 9.0 / 40.0));
        }
        _ => {
            // Dunavant, degree 6.
            three(0.501_426_509_658_179_2, 0.116_786_275_726_379_37);
            three(0.873_821_971_016_995_5, 0.050_844_906_370_206_82);
            let (a, b) = (0.053_145_049_844_816_95, 0.310_352_451_033_784_4);
            let c = 1.0 - a - b;
            for xi in [[a, b, 0.0], [b, a, 0.0], [a, c, 0.0], [c, a, 0.0], [b, c, 0.0], [c, b, 0.0]] {
                points.push((xi, 0.5 * 0.082_851_075_618_373_58));
            }
        }
    }
    points
}

/// Rules with 1, 4, 15 and 24 points on the unit tetrahedron, the least that reaches `degree`.
fn tetrahedron(degree: usize) -> Vec<([f64; 3], f64)> {
    let mut points = Vec::new();
    // The points whose barycentric coordinates are permutations of four: those of the corners of the last three.
    let mut all = |l: [f64; 4], weight: f64| {
        let mut found: Vec<[f64; 3]> = Vec::new();
        for (i, j, k) in (0..64).map(|n| (n / 16, n / 4 % 4, n % 4)) {
            let xi = [l[i], l[j], l[k]];
            if i != j && j != k && k != i && !found.contains(&xi) {
                found.push(xi);
            }
        }
        points.extend(found.into_iter().map(|xi| (xi, weight / 6.0)));
    };
    match degree {
        0 | 1 => all([0.25; 4], 1.0),
        2 => {
            let a = (5.0 - 5f64.sqrt()) / 20.0;
            all([a, a, a, 1.0 - 3.0 * a], 0.25);
        }
        3..=5 => {
            // Stroud, T3:5-1. The known rules of 5 and 11 points, of degree 3 and 4, have a negative weight.
            let r = 15f64.sqrt();
            all([0.25; 4], 16.0 / 135.0);
            for (a, w) in [(7.0 - r, 2665.0 + 14.0 * r), (7.0 + r, 2665.0 - 14.0 * r)] {
                let a = a / 34.0;
                all([a, a, a, 1.0 - 3.0 * a], w / 37800.0);
            }
            let a = (10.0 - 2.0 * r) / 40.0;
            all([a, a, 0.5 - a, 0.5 - a], 10.0 / 189.0);
        }
        _ => {
            // Keast, degree 6.
            for (a, w) in [
                (0.214_602_871_259_151_7, 0.039_922_750_258_167_48),
                (0.040_673_958_534_611_34, 0.010_077_211_055_320_657),
                (0.322_337_890_142_275_65, 0.055_357_181_543_654_39),
            ] {
                all([a, a, a, 1.0 - 3.0 * a], w);
            }
            let (a, b) = (0.063_661_001_875_017_53, 0.269_672_331_458_315_8);
            all([a, a, b, 1.0 - 2.0 * a - b], 27.0 / 560.0);
        }
    }
    points
}
