//! The stress of soil at rest where verticals through points meet ends of edges.

use super::*;

/// Random numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Adds a mesh to another one as a region of its own, its nodes moved by `place`.
fn add(mesh: &mut Mesh<2>, part: &Mesh<2>, place: impl Fn(&[f64; 2]) -> [f64; 2]) {
    let (first, region) = (mesh.nodes.len() as u32, mesh.regions.len() as u16);
    mesh.nodes.extend(part.nodes.iter().map(place));
    mesh.regions.push(format!("layer {region}"));
    for c in 0..part.cells.len() {
        let nodes: Vec<u32> = part.cells.nodes(c).iter().map(|n| n + first).collect();
        mesh.cells.push(part.cells.kind[c], region, &nodes);
    }
}

/// The mesh seen in a mirror, `x` to `−x`.
fn mirrored(mesh: &Mesh<2>) -> Mesh<2> {
    let mut cells = crate::mesh::Cells::default();
    for c in 0..mesh.cells.len() {
        let order: &[usize] = match mesh.cells.kind[c] {
            CellKind::T3 => &[0, 2, 1],
            CellKind::T6 => &[0, 2, 1, 5, 4, 3],
            CellKind::Q4 => &[0, 3, 2, 1],
            CellKind::Q8 => &[0, 3, 2, 1, 7, 6, 5, 4],
            _ => &[0, 3, 2, 1, 7, 6, 5, 4, 8],
        };
        let nodes: Vec<u32> = order.iter().map(|&i| mesh.cells.nodes(c)[i]).collect();
        cells.push(mesh.cells.kind[c], mesh.cells.region[c], &nodes);
    }
    let nodes = mesh.nodes.iter().map(|x| [-x[0], x[1]]).collect();
    Mesh { nodes, cells, regions: mesh.regions.clone(), groups: Vec::new() }
}

fn seeded(mesh: &Mesh<2>, each: u32) -> Points<2> {
    let density = Profile::constant(1.0);
    let of = |region: usize| RegionSeed { region: region as u16, points_per_cell: each, density };
    seed(mesh, false, &(0..mesh.regions.len()).map(of).collect::<Vec<_>>()).unwrap()
}

fn kinds() -> impl Iterator<Item = CellKind> {
    [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9].into_iter()
}

/// Level layers of random thickness and weight, each in cells of its own width: the columns of points in one are below nodes of another, but for
/// rounding. The vertical stress is the weight above at each of them, wherever the ground lies and on which side it is seen from.
#[test]
fn level_layers_bear_what_is_above_wherever_their_nodes_are() {
    let mut random = Random(7);
    for kind in kinds() {
        for _ in 0..20 {
            let (width, left) = (random.between(0.1, 30.0), random.between(-20.0, 20.0));
            let mut mesh =
                Mesh::<2> { nodes: Vec::new(), cells: Default::default(), regions: Vec::new(), groups: Vec::new() };
            let (mut top, mut soils, mut layers) = (random.between(-5.0, 5.0), Vec::new(), Vec::new());
            // Centres of thirds and quarters of cells are nodes of the layer above.
            for columns in [12, 24, 4, 3] {
                let thick = random.between(0.1, 3.0);
                let part = rectangle(kind, width, thick, columns, 2, 0.0, 0);
                add(&mut mesh, &part, |x| [left + x[0], top - thick + x[1]]);
                let weight = random.between(5.0, 25.0);
                layers.push((top, top - thick, weight));
                soils.push(RegionWeight { region: soils.len() as u16, unit_weight: Profile::constant(weight) });
                top -= thick;
            }
            for mesh in [mirrored(&mesh), mesh] {
                for each in [4, 9] {
                    let points = seeded(&mesh, each);
                    for (x, s) in points.position.iter().zip(k0_stress(&mesh, &soils, |_| 0.7, &points)) {
                        let above =
                            |(top, bottom, weight): &(f64, f64, f64)| weight * (top - bottom.max(x[1])).max(0.0);
                        let expected: f64 = layers.iter().map(above).sum();
                        assert!(
                            (s[1] + expected).abs() < 1e-10 * (1.0 + expected),
                            "{kind:?} {x:?}: {} {expected}",
                            s[1]
                        );
                    }
                }
            }
        }
    }
}

/// Layers between curves that are parabolas from column to column, with a weight that grows with depth.
#[test]
fn curved_layers_are_exact_on_both_sides_of_a_mirror() {
    let mut random = Random(11);
    for kind in kinds() {
        let (columns, width) = (5, random.between(3.0, 9.0));
        // Lines between the layers, with their height at the nodes along them, ends and middles of the cells.
        let lines: Vec<Vec<f64>> =
            (0..4).map(|k| (0..=2 * columns).map(|_| f64::from(k) + random.between(-0.3, 0.3)).collect()).collect();
        let height = |line: &[f64], x: f64| {
            let along = x / width * columns as f64;
            let column = (along.floor().max(0.0) as usize).min(columns - 1);
            let t = 2.0 * (along - column as f64) - 1.0;
            let [a, b, c] = [0, 1, 2].map(|i| line[2 * column + i]);
            if kind.order() == 1 {
                0.5 * ((1.0 - t) * a + (1.0 + t) * c)
            } else {
                b + t * (0.5 * (c - a) + t * (0.5 * (a + c) - b))
            }
        };
        let mut mesh = rectangle(kind, width, 3.0, columns, 3, 0.0, 0);
        mesh.regions = (0..3).map(|k| format!("layer {k}")).collect();
        for c in 0..mesh.cells.len() {
            mesh.cells.region[c] = mesh.centre(c)[1] as u16;
        }
        for x in &mut mesh.nodes {
            let level = (x[1] + 1e-9).floor() as usize;
            let share = x[1] - level as f64;
            let upper = &lines[(level + 1).min(3)];
            x[1] = (1.0 - share) * height(&lines[level], x[0]) + share * height(upper, x[0]);
        }
        let weights = [(18.0, 0.5), (12.0, 0.0), (15.0, 2.0)];
        let weight = |(top, gradient): (f64, f64)| Profile::growing(top, gradient, 2.5);
        let soils: Vec<_> =
            (0..3).map(|k| RegionWeight { region: k as u16, unit_weight: weight(weights[k]) }).collect();
        for (mesh, side) in [(mirrored(&mesh), -1.0), (mesh, 1.0)] {
            let points = seeded(&mesh, 9);
            for (x, s) in points.position.iter().zip(k0_stress(&mesh, &soils, |_| 0.5, &points)) {
                let mut expected = 0.0;
                for (k, (top, gradient)) in weights.into_iter().enumerate() {
                    let [low, high] = [k, k + 1].map(|line| height(&lines[line], side * x[0]));
                    let (low, below) = (low.max(x[1]), |y: f64| (2.5 - y).max(0.0).powi(2));
                    if high > low {
                        expected += top * (high - low) + 0.5 * gradient * (below(low) - below(high));
                    }
                }
                assert!((s[1] + expected).abs() < 1e-9 * (1.0 + expected), "{kind:?} {x:?}: {} {expected}", s[1]);
            }
        }
    }
}

/// Stars with random rays, as triangles about their middle that are cut into smaller ones: soil above gaps and below overhangs counts what
/// the vertical goes through.
#[test]
fn in_any_polygon_the_vertical_is_measured() {
    let mut random = Random(3);
    for kind in [CellKind::T3, CellKind::T6] {
        for _ in 0..30 {
            let (rays, middle) =
                (5 + (7.0 * random.next()) as usize, [random.between(-9.0, 9.0), random.between(-9.0, 9.0)]);
            let corners: Vec<[f64; 2]> = (0..rays)
                .map(|k| {
                    let (angle, r) = (2.0 * PI * k as f64 / rays as f64, random.between(0.5, 3.0));
                    [middle[0] + r * angle.cos(), middle[1] + r * angle.sin()]
                })
                .collect();
            let mut mesh =
                Mesh::<2> { nodes: Vec::new(), cells: Default::default(), regions: Vec::new(), groups: Vec::new() };
            for k in 0..rays {
                // Half of the unit square, as a triangle of the star.
                let (a, b) = (corners[k], corners[(k + 1) % rays]);
                let half = rectangle(kind, 1.0, 1.0, 1, 1, 0.0, 0).part(|c| c == 0);
                let at = |[s, t]: &[f64; 2]| {
                    [0, 1].map(|d| middle[d] + (s - t) * (a[d] - middle[d]) + t * (b[d] - middle[d]))
                };
                add(&mut mesh, &half, at);
            }
            let weight = |k: usize| RegionWeight { region: k as u16, unit_weight: Profile::constant(10.0) };
            let soils: Vec<_> = (0..rays).map(weight).collect();
            let points = seeded(&mesh, 25);
            for (x, s) in points.position.iter().zip(k0_stress(&mesh, &soils, |_| 0.5, &points)) {
                let mut heights: Vec<f64> = (0..rays)
                    .map(|k| (corners[k], corners[(k + 1) % rays]))
                    .filter(|(a, b)| (a[0] <= x[0]) != (b[0] <= x[0]))
                    .map(|(a, b)| a[1] + (x[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1]))
                    .filter(|y| *y > x[1])
                    .collect();
                heights.sort_by(f64::total_cmp);
                let ends = std::iter::once(&x[1]).chain(&heights).copied().collect::<Vec<_>>();
                let expected: f64 = ends.chunks_exact(2).map(|pair| 10.0 * (pair[1] - pair[0])).sum();
                assert!((s[1] + expected).abs() < 1e-9 * (1.0 + expected), "{kind:?} {x:?}: {} {expected}", s[1]);
            }
        }
    }
}
