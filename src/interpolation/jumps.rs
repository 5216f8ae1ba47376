//! Jumps of derivatives across the faces between cells, as quadratic forms of nodal values: what a ghost
//! penalty is made of (Burman 2010, *Ghost penalty*).
//!
//! `∫ (h [∂_n u]² + h³ [∂_nn u]²)` over a face, `[.]` the difference between its two cells and `h` their size
//! across it. It vanishes for every field that is one polynomial over both cells. One displacement component
//! at a time: the form is the same for each. Jumps of third derivatives, which quadrilaterals have, are left
//! out: the polynomials of second degree that the two forms leave free are those that both cells share. Cells of third order
//! have `h⁵ [∂_nnn u]²` as well: on cubic splines it alone does not vanish.

use crate::geometry::dot;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::Face;
use crate::mesh::shape::{CellKind, MAX_NODES, invert, jacobian, map_second, rule};
use std::sync::OnceLock;

/// The form of one face.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Size (m) of the two cells across the face, the mean of both.
    pub size: f64,
    /// The measure of the face times that size (m²; m³ in axisymmetry, for a full turn): the form of a jump of one.
    pub measure: f64,
    /// `h ∫[∂_n N_I][∂_n N_J] + h³ ∫[∂_nn N_I][∂_nn N_J]`, and `+ h⁵ ∫[∂_nnn N_I][∂_nnn N_J]` in third order (-; m in axisymmetry, for a full turn) over the nodes
    /// in the order of [`Face::nodes`], row-major.
    pub form: Box<[f64]>,
}

impl Jump {
    /// Computes the form of a face.
    pub fn of<const D: usize, K: Kinematics<D>>(mesh: &Mesh<D>, face: &Face) -> Self {
        let both: Vec<u32> = face.nodes(mesh).collect();
        let first = face.cells[0] as usize;
        let (facet, facets) = mesh.cells.kind[first].facets();
        let shared: Vec<u32> = facets[face.sides[0] as usize].iter().map(|&i| mesh.cells.nodes(first)[i]).collect();
        let sides = [(0, 1.0), (1, -1.0)].map(|(i, sign)| side(mesh, face.cells[i] as usize, &both, &shared, sign));
        let x: Vec<[f64; D]> = shared.iter().map(|&n| mesh.nodes[n as usize]).collect();
        let middle = place(facet, &x, &facet.centre());
        let size = 0.5 * (extent(&sides[0], &middle) + extent(&sides[1], &middle));

        let (count, mut measure) = (both.len(), 0.0);
        let mut form = vec![0.0; count * count];
        let (mut values, mut grad, mut second) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES], [[[0.0; D]; D]; MAX_NODES]);
        for (xi, weight) in rule(facet, 2 * facet.order() + 1) {
            facet.values(&xi, &mut values);
            let Place { x, normal, stretch } = place(facet, &x, &xi);
            let (mut kink, mut bend, mut third) = (vec![0.0; count], vec![0.0; count], Vec::new());
            for side in &sides {
                let at = [0, 1, 2].map(|d| side.facet.iter().zip(&values).map(|(c, n)| n * c[d]).sum());
                if side.kind.order() > 2 {
                    third.resize(count, 0.0);
                    side.add_third(&at, &normal, &mut third);
                }
                map_second(side.kind, &side.x, &at, &mut grad, &mut second);
                for (i, &slot) in side.place.iter().enumerate() {
                    kink[slot] += side.sign * dot(&grad[i], &normal);
                    bend[slot] += side.sign * dot(&second[i].map(|row| dot(&row, &normal)), &normal);
                }
            }
            let weight = weight * stretch * K::measure(&x) * size;
            measure += weight;
            for i in 0..count {
                for j in 0..count {
                    form[i * count + j] += weight * (kink[i] * kink[j] + size * size * bend[i] * bend[j]);
                    if !third.is_empty() {
                        form[i * count + j] += weight * size.powi(4) * third[i] * third[j];
                    }
                }
            }
        }
        Self { size, measure, form: form.into_boxed_slice() }
    }
}

/// The forms of the faces of a mesh, each made when it is first asked for: a restored grid keeps its shape, so
/// that it holds for the whole run.
#[derive(Debug, Default)]
pub struct Jumps(Vec<OnceLock<Jump>>);

impl Jumps {
    /// For a mesh with `faces` inner faces.
    pub fn new(faces: usize) -> Self {
        Self((0..faces).map(|_| OnceLock::new()).collect())
    }

    /// The form of `face`, number `number` of the inner faces.
    pub fn of<const D: usize, K: Kinematics<D>>(&self, mesh: &Mesh<D>, face: &Face, number: u32) -> &Jump {
        self.0[number as usize].get_or_init(|| Jump::of::<D, K>(mesh, face))
    }
}

/// One of the two cells of a face.
struct Side<const D: usize> {
    kind: CellKind,
    x: Vec<[f64; D]>,
    /// Where the nodes of the cell stand among those of both cells.
    place: Vec<usize>,
    /// Parametric coordinates, in this cell, of the nodes of the facet in the order of the first cell.
    facet: Vec<[f64; 3]>,
    sign: f64,
}

impl<const D: usize> Side<D> {
    /// Adds the third derivatives (1/m³) along `normal` at a place of the cell, by its sign: in a rectangle along the normal, second derivatives are
    /// linear along it, and their difference is exact.
    fn add_third(&self, at: &[f64; 3], normal: &[f64; D], third: &mut [f64]) {
        let mut dn = [[0.0; 3]; MAX_NODES];
        self.kind.derivatives(at, &mut dn);
        let (inverse, _) = invert(&jacobian(&self.x, &dn));
        let along: [f64; D] = std::array::from_fn(|k| (0..D).map(|j| inverse[k][j] * normal[j]).sum());
        // A step of one in the cell.
        let step = 1.0 / dot(&along, &along).sqrt();
        for sign in [1.0, -1.0] {
            let mut place = *at;
            (0..D).for_each(|d| place[d] += sign * step * along[d]);
            let (mut grad, mut second) = ([[0.0; D]; MAX_NODES], [[[0.0; D]; D]; MAX_NODES]);
            map_second(self.kind, &self.x, &place, &mut grad, &mut second);
            for (i, &slot) in self.place.iter().enumerate() {
                let bend = dot(&second[i].map(|row| dot(&row, normal)), normal);
                third[slot] += self.sign * sign * bend / (2.0 * step);
            }
        }
    }
}

/// A place on a facet.
struct Place<const D: usize> {
    x: [f64; D],
    normal: [f64; D],
    /// Length (area) for a unit of the parametric one.
    stretch: f64,
}

fn side<const D: usize>(mesh: &Mesh<D>, cell: usize, both: &[u32], shared: &[u32], sign: f64) -> Side<D> {
    let (kind, own) = (mesh.cells.kind[cell], mesh.cells.nodes(cell));
    // Both lists hold what is looked for: a face's nodes are those of its cells.
    let find = |list: &[u32], node: u32| list.iter().take_while(|&&n| n != node).count();
    Side {
        kind,
        x: own.iter().map(|&n| mesh.nodes[n as usize]).collect(),
        place: own.iter().map(|&n| find(both, n)).collect(),
        facet: shared.iter().map(|&n| kind.node_coordinates()[find(own, n)]).collect(),
        sign,
    }
}

/// The place `xi` of a facet with nodes at `nodes`.
fn place<const D: usize>(facet: CellKind, nodes: &[[f64; D]], xi: &[f64; 3]) -> Place<D> {
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    facet.values(xi, &mut n);
    facet.derivatives(xi, &mut dn);
    let (mut x, mut a, mut b) = ([0.0; D], [0.0; D], [0.0; D]);
    for (i, node) in nodes.iter().enumerate() {
        for d in 0..D {
            x[d] += n[i] * node[d];
            a[d] += dn[i][0] * node[d];
            b[d] += dn[i][1] * node[d];
        }
    }
    let mut normal = [0.0; D];
    match D {
        1 => normal[0] = 1.0,
        2 => (normal[0], normal[1]) = (a[1], -a[0]),
        _ => (0..D).for_each(|d| normal[d] = a[(d + 1) % D] * b[(d + 2) % D] - a[(d + 2) % D] * b[(d + 1) % D]),
    }
    let stretch = dot(&normal, &normal).sqrt();
    Place { x, normal: normal.map(|v| v / stretch), stretch }
}

/// How far the corners of a cell reach from a place along its normal (m).
fn extent<const D: usize>(side: &Side<D>, place: &Place<D>) -> f64 {
    let extension = |x: &[f64; D]| (dot(x, &place.normal) - dot(&place.x, &place.normal)).abs();
    side.x[..side.kind.corner_count()].iter().map(extension).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::{Axisymmetric, PlaneStrain};
    use crate::mesh::builder::rectangle;
    use crate::mesh::faces::Faces;
    use std::f64::consts::TAU;

    const PLANE: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

    /// `uᵀ G u` for `u` given by the place of the nodes, and the largest product that it is a sum of.
    fn energy<K: Kinematics<2>>(mesh: &Mesh<2>, face: &Face, u: impl Fn([f64; 2]) -> f64) -> (f64, f64) {
        let jump = Jump::of::<2, K>(mesh, face);
        let u: Vec<f64> = face.nodes(mesh).map(|n| u(mesh.nodes[n as usize])).collect();
        let (mut sum, mut largest) = (0.0, 0f64);
        for (row, a) in jump.form.chunks_exact(u.len()).zip(&u) {
            for (g, b) in row.iter().zip(&u) {
                sum += a * g * b;
                largest = largest.max((a * g * b).abs());
            }
        }
        (sum, largest)
    }

    /// The mid-side nodes inside moved, so that edges are curved.
    fn curved(kind: CellKind) -> Mesh<2> {
        let mut mesh = rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 5);
        for x in &mut mesh.nodes[20..] {
            if x[0] > 0.0 && x[0] < 3.0 && x[1] > 0.0 && x[1] < 2.0 {
                *x = [x[0] + 0.02 * (7.0 * x[1]).sin(), x[1] + 0.02 * (5.0 * x[0]).cos()];
            }
        }
        mesh
    }

    #[test]
    fn a_polynomial_over_both_cells_is_free() {
        let linear = |[x, y]: [f64; 2]| 1.0 + 2.0 * x - 3.0 * y;
        let quadratic = |[x, y]: [f64; 2]| linear([x, y]) + x * x - 0.7 * x * y + 1.3 * y * y;
        for kind in PLANE {
            let straight = rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 5);
            let meshes = if kind.order() == 2 { vec![straight, curved(kind)] } else { vec![straight] };
            for (mesh, bent) in meshes.iter().zip([false, true]) {
                for face in &Faces::of(mesh).inner {
                    let (e, of) = energy::<PlaneStrain>(mesh, face, linear);
                    assert!(e.abs() < 1e-12 * of, "{kind:?}: {e:.1e} of {of:.1e}");
                    let (e, of) = energy::<Axisymmetric>(mesh, face, linear);
                    assert!(e.abs() < 1e-12 * of, "{kind:?}: {e:.1e} of {of:.1e}");
                    if !bent && matches!(kind, CellKind::T6 | CellKind::Q9) {
                        let (e, of) = energy::<PlaneStrain>(mesh, face, quadratic);
                        assert!(e.abs() < 1e-12 * of, "{kind:?}: {e:.1e} of {of:.1e}");
                    }
                }
            }
        }
    }

    /// `u = a |x| + b x|x|/2` across the edge `x = 0` between boxes of one by one: `[∂_n u] = 2a`, `[∂_nn u] = 2b`,
    /// over a length of one, `∫ 2πr` being `2π · 3` around an axis at three to its left.
    #[test]
    fn a_kink_has_the_energy_of_its_jumps() {
        let (a, b) = (0.3, 0.8);
        for kind in PLANE {
            let mut mesh = rectangle(kind, 2.0, 1.0, 2, 1, 0.0, 0);
            mesh.nodes.iter_mut().for_each(|x| x[0] += 2.0);
            let faces = Faces::of(&mesh);
            let across = faces.inner.iter().find(|face| {
                let shared: Vec<u32> = mesh.cells.nodes(face.cells[0] as usize).to_vec();
                let other = mesh.cells.nodes(face.cells[1] as usize);
                shared.iter().filter(|n| other.contains(n)).all(|&n| mesh.nodes[n as usize][0] == 3.0)
            });
            let face = across.unwrap();
            let kink = |[x, _]: [f64; 2]| a * (x - 3.0).abs();
            let bend = |[x, _]: [f64; 2]| 0.5 * b * (x - 3.0) * (x - 3.0).abs();
            assert_eq!(Jump::of::<2, PlaneStrain>(&mesh, face).size, 1.0);
            for (e, turned) in [
                (energy::<PlaneStrain>(&mesh, face, kink).0, 1.0),
                (energy::<Axisymmetric>(&mesh, face, kink).0, TAU * 3.0),
            ] {
                assert!((e - turned * 4.0 * a * a).abs() < 1e-12, "{kind:?}: {e}");
            }
            if matches!(kind, CellKind::T6 | CellKind::Q9) {
                let e = energy::<PlaneStrain>(&mesh, face, bend).0;
                assert!((e - 4.0 * b * b).abs() < 1e-12, "{kind:?}: {e}");
            }
        }
    }

    #[test]
    fn forms_are_symmetric_and_positive_semidefinite() {
        for kind in PLANE {
            let mesh = if kind.order() == 2 { curved(kind) } else { rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 5) };
            for face in &Faces::of(&mesh).inner {
                let form = Jump::of::<2, Axisymmetric>(&mesh, face).form;
                let count = face.nodes(&mesh).count();
                let g = nalgebra::DMatrix::from_row_slice(count, count, &form);
                let largest = g.amax();
                assert!((&g - g.transpose()).amax() < 1e-14 * largest);
                let values = nalgebra::SymmetricEigen::new(g).eigenvalues;
                assert!(values.min() > -1e-13 * largest, "{kind:?}: {:.1e}", values.min());
                // On T6, all but the six polynomials of second degree and the field without such jumps.
                let free = values.iter().filter(|v| v.abs() < 1e-10 * largest).count();
                assert!(free >= 3 && free < count, "{kind:?}: {free} of {count}");
            }
        }
    }
}
