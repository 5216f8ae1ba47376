//! The boundary of a structure as lines along which the values of its contact nodes are drawn.

use super::multipliers::Multipliers;
use super::place::Segments;
use super::smoothing::smooth;
use super::surface::{Run, Surface};
use crate::kinematics::Kinematics;

/// A place on a boundary: the two contact nodes over it, with their values there (-), which add up to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark<const D: usize> {
    /// (m)
    pub place: [f64; D],
    pub contact_nodes: [(u32, f64); 2],
    /// Its area (m², per metre or full turn): what is linear between marks has the integral over the line that its values times these
    /// add up to.
    pub area: f64,
}

impl<const D: usize> Mark<D> {
    /// The function that is `values` at the contact nodes, here.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.contact_nodes.iter().map(|&(contact_node, share)| share * values[contact_node as usize]).sum()
    }

    /// The same of a function with three components.
    pub fn vector(&self, values: &[[f64; 3]]) -> [f64; 3] {
        std::array::from_fn(|d| {
            self.contact_nodes.iter().map(|&(contact_node, share)| share * values[contact_node as usize][d]).sum()
        })
    }
}

/// What the contact nodes of a boundary exert on the structure.
#[derive(Clone, Debug, Default)]
pub struct Tractions {
    /// (kPa) As a function along the lines it has the integral that the forces add up to, also where these are of a part of their contact node only, or not
    /// along the normal of the place.
    pub traction: Vec<[f64; 3]>,
    /// The component against the normal out of the structure (kPa), compression positive; where no contact node pulls, not below zero.
    pub pressure: Vec<f64>,
}

impl Tractions {
    /// Those of the forces that the contact nodes came to, over the area of `lines` under them, smoothed along the `runs`.
    pub fn new<const D: usize>(lines: &[Vec<Mark<D>>], runs: &[Run], held: &Multipliers) -> Self {
        let (area, normal) = areas(lines, held.force.len());
        let over = |(force, &area): (&[f64; 3], &f64)| if area > 0.0 { force.map(|f| f / area) } else { [0.0; 3] };
        let of_nodes: Vec<[f64; 3]> = held.force.iter().zip(&area).map(over).collect();
        let against =
            |t: &[f64; 3], n: &[f64; 2]| -(t[0] * n[0] + t[1] * n[1]) / n[0].hypot(n[1]).max(f64::MIN_POSITIVE);
        let traction = smooth(&of_nodes, runs, &area);
        let least = if held.pressure.iter().any(|pressure| *pressure < 0.0) { f64::NEG_INFINITY } else { 0.0 };
        let pressure = traction.iter().zip(&normal).map(|(t, n)| against(t, n).max(least) + 0.0).collect();
        Self { traction, pressure }
    }
}

/// Area (m², per metre or full turn) that `lines` have under each of `count` contact nodes, and the same times the normal out of the structure.
fn areas<const D: usize>(lines: &[Vec<Mark<D>>], count: usize) -> (Vec<f64>, Vec<[f64; 2]>) {
    let (mut area, mut normal) = (vec![0.0; count], vec![[0.0; 2]; count]);
    for line in lines {
        for (i, mark) in line.iter().enumerate() {
            let [from, to] = [i.saturating_sub(1), (i + 1).min(line.len() - 1)].map(|k| line[k].place);
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = along[0].hypot(along[1]);
            for &(contact_node, share) in &mark.contact_nodes {
                let weight = share * mark.area;
                area[contact_node as usize] += weight;
                normal[contact_node as usize][0] += weight * along[1] / length;
                normal[contact_node as usize][1] -= weight * along[0] / length;
            }
        }
    }
    (area, normal)
}

/// A line for each smooth stretch of the boundary, with a mark where segments meet and at both ends; one without ends
/// is closed by a last mark at the place of the first. The structure is on the left of the way along them.
pub fn lines<K: Kinematics<2>>(surface: &Surface, segments: &Segments) -> Vec<Vec<Mark<2>>> {
    let line = |piece: &std::ops::Range<usize>| {
        let cut = &surface.segments[piece.clone()];
        let (Some(first), Some(last)) = (cut.first(), cut.last()) else { return Vec::new() };
        let base = first.contact_nodes[0].0;
        let closed = last.contact_nodes[1].0 == base;
        // Distances are in contact nodes from the beginning. The middle of a segment, whose contact nodes are known, is the mean of its ends.
        let intervals = last.contact_nodes[0].0 + 1 - base;
        let mark = |at: f64, place| {
            let left = (at.max(0.0) as u32).min(intervals - 1);
            let right = if closed && left + 1 == intervals { 0 } else { left + 1 };
            let share = at - f64::from(left);
            Mark { place, contact_nodes: [(base + left, 1.0 - share), (base + right, share)], area: 0.0 }
        };
        let mut at = 0.0;
        let mut marks = Vec::with_capacity(cut.len() + 1);
        for (segment, placed) in cut.iter().zip(&segments.0[piece.clone()]) {
            marks.push(mark(at, placed.from));
            at = 2.0 * (f64::from(segment.contact_nodes[0].0 - base) + segment.contact_nodes[1].1) - at;
        }
        marks.push(mark(at, segments.0[piece.end - 1].to));
        for i in 1..marks.len() {
            let [a, b] = [i - 1, i].map(|i| marks[i].place);
            let (length, [m, n]) = ((b[0] - a[0]).hypot(b[1] - a[1]), [a, b].map(|x| K::measure(&x)));
            marks[i - 1].area += length * (2.0 * m + n) / 6.0;
            marks[i].area += length * (m + 2.0 * n) / 6.0;
        }
        marks
    };
    surface.pieces.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Axisymmetric, PlaneStrain};
    use crate::mesh::Mesh;
    use crate::mesh::shape::CellKind;

    fn lines_of(mesh: &Mesh<2>, spacing: f64) -> (Surface, Vec<Vec<Mark<2>>>) {
        let surface = Surface::new(mesh, 0, spacing, |_| false).unwrap();
        let segments = Segments::new::<PlaneStrain>(&surface, |n| mesh.nodes[n as usize]);
        let lines = lines::<PlaneStrain>(&surface, &segments);
        (surface, lines)
    }

    /// On each side of a square a function that is linear along it is found again, up to the corners.
    #[test]
    fn values_are_linear_between_contact_nodes_and_break_at_corners() {
        let mut mesh = Mesh {
            nodes: vec![[0., 0.], [1., 0.], [1., 1.], [0., 1.]],
            regions: vec!["pile".to_string()],
            ..Mesh::default()
        };
        mesh.cells.push(CellKind::Q4, 0, &[0, 1, 2, 3]);
        let (surface, lines) = lines_of(&mesh, 0.3);
        assert_eq!((lines.len(), surface.contact_nodes), (4, 16));
        // Four contact nodes a side, the first and last at its corners.
        let values: Vec<f64> = (0..16).map(|k| f64::from(k / 4) + f64::from(k % 4) / 3.0).collect();
        for line in &lines {
            let (begin, end) = (line[0], line[line.len() - 1]);
            for mark in line {
                let along = (0..2).map(|d| (mark.place[d] - begin.place[d]).abs()).sum::<f64>();
                assert!((mark.value(&values) - begin.value(&values) - along).abs() < 1e-14, "{mark:?}");
                assert!((mark.contact_nodes[0].1 + mark.contact_nodes[1].1 - 1.0).abs() < 1e-15);
            }
            assert!((end.value(&values) - begin.value(&values) - 1.0).abs() < 1e-14);
        }
    }

    /// The traction is linear between contact nodes, and its integral over a full turn is the sum of the forces, also that of a contact node with soil under a part of it.
    #[test]
    fn traction_adds_up_to_the_forces() {
        let mut mesh = Mesh {
            nodes: vec![[0., 0.], [1., 0.5], [1., 2.], [0., 2.]],
            regions: vec!["cone".to_string()],
            ..Mesh::default()
        };
        mesh.cells.push(CellKind::Q4, 0, &[0, 1, 2, 3]);
        let on_axis = |facet: &[u32]| facet.iter().all(|&n| mesh.nodes[n as usize][0] == 0.0);
        let surface = Surface::new(&mesh, 0, 0.3, on_axis).unwrap();
        let segments = Segments::new::<Axisymmetric>(&surface, |n| mesh.nodes[n as usize]);
        let lines = lines::<Axisymmetric>(&surface, &segments);
        let force: Vec<[f64; 3]> =
            (0..surface.contact_nodes).map(|k| [(k as f64).sin(), 1.0 + (k % 3) as f64, 0.0]).collect();
        let Tractions { traction, .. } = Tractions::new(
            &lines,
            &surface.runs,
            &Multipliers { force: force.clone(), ..Multipliers::new(force.len()) },
        );
        let mut sum = [0.0; 3];
        for ends in lines.iter().flat_map(|line| line.windows(2)) {
            let [a, b] = [&ends[0], &ends[1]];
            let length = (b.place[0] - a.place[0]).hypot(b.place[1] - a.place[1]);
            let (from, to) = (a.vector(&traction), b.vector(&traction));
            // Simpson's rule is exact for what is quadratic.
            for (weight, t) in [(1.0, 0.0), (4.0, 0.5), (1.0, 1.0)] {
                let radius = a.place[0] + t * (b.place[0] - a.place[0]);
                let area = std::f64::consts::TAU * radius * length * weight / 6.0;
                (0..3).for_each(|d| sum[d] += area * (from[d] + t * (to[d] - from[d])));
            }
        }
        let whole = force.iter().fold([0.0; 3], |sum, f| [sum[0] + f[0], sum[1] + f[1], 0.0]);
        assert!((0..3).all(|d| (sum[d] - whole[d]).abs() < 1e-12 * whole[1]), "{sum:?} {whole:?}");
    }

    /// A disc has one line that ends where it begins.
    #[test]
    fn a_boundary_without_corners_closes() {
        let count = 12;
        let on = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            [cos, sin]
        };
        let mut mesh =
            Mesh { nodes: (0..count).map(on).collect(), regions: vec!["pipe".to_string()], ..Mesh::default() };
        mesh.nodes.push([0.0; 2]);
        for k in 0..count as u32 {
            mesh.cells.push(CellKind::T3, 0, &[k, (k + 1) % count as u32, count as u32]);
        }
        let (surface, lines) = lines_of(&mesh, 0.4);
        let [line] = &lines[..] else { panic!("{} lines", lines.len()) };
        let values: Vec<f64> = (0..surface.contact_nodes).map(|k| k as f64).collect();
        let (first, last) = (line[0], line[line.len() - 1]);
        assert!((0..2).all(|d| (first.place[d] - last.place[d]).abs() < 1e-15), "{last:?}");
        assert!((first.value(&values) - last.value(&values)).abs() < 1e-12);
    }
}
