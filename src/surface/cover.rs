//! What of the boundary of the material is open: the parts of its pieces that no structure covers.

use super::boundary::{Piece, place};
use crate::geometry::{Bins, distance, length};
use crate::mesh::Mesh;
use crate::mesh::cell_size;
use std::f64::consts::FRAC_1_SQRT_2;

/// Cosine of the angle between the ways of a piece and of a cover from which on they face each other.
const FACING: f64 = -0.3;
/// The least part of a piece (-) that counts as open: what is left beside a cover that ends where the piece does is none.
const LEAST: f64 = 1e-3;
/// How far apart (-), in the reach of covers, the ends of two may be that belong to one joint.
const JOINT: f64 = 0.2;

/// A straight part of the boundary of a structure that lies on the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover<const D: usize> {
    /// Its ends (m), with the structure on the left of the way from one to the other.
    pub ends: [[f64; D]; 2],
    /// Whether another one goes on from there.
    pub goes_on: [bool; 2],
    /// How far (m) across it the boundary of the material may be at least.
    pub reach: f64,
}

impl<const D: usize> Cover<D> {
    /// From which share of its way to which a line between two places (m) is covered, known to within `size` (m); nothing where the first
    /// is the larger one.
    fn share(&self, [a, b]: &[[f64; D]; 2], size: f64) -> [f64; 2] {
        let way = |from: &[f64; D], to: &[f64; D]| [to[0] - from[0], to[1] - from[1]];
        let dot = |v: [f64; 2], w: [f64; 2]| v[0] * w[0] + v[1] * w[1];
        let [from, to] = &self.ends;
        let (along, own) = (way(a, b), way(from, to));
        let square = dot(along, along);
        let length = square.sqrt();
        // The material is on the left of its boundary, as the structure is of its own: they run against each other.
        if dot(along, own) > FACING * length * own[0].hypot(own[1]) {
            return [1.0, 0.0];
        }
        let middle = [0, 1].map(|d| 0.5 * (from[d] + to[d]) - a[d]);
        let away = (along[0] * middle[1] - along[1] * middle[0]).abs() / length;
        if away > self.reach.max(size) {
            return [1.0, 0.0];
        }
        // Where the boundary turns and the two are apart their ends are not across each other.
        let more = self.goes_on.map(|goes_on| if goes_on { away / length } else { 0.0 });
        [dot(way(a, to), along) / square - more[1], dot(way(a, from), along) / square + more[0]]
    }
}

/// Closes the joints of structures: where a cover ends and another one begins beside it, one between the two goes on from both.
pub fn join<const D: usize>(covers: &mut Vec<Cover<D>>) {
    const { assert!(D == 2, "covers are lines in the plane") };
    let free = |k: usize| {
        let free = covers.iter().enumerate().filter(move |(_, cover)| !cover.goes_on[k]);
        free.map(move |(number, cover)| (number, cover.ends[k], cover.reach)).collect::<Vec<_>>()
    };
    let begins = free(0);
    for (before, from, reach) in free(1) {
        for &(after, to, other) in begins.iter().filter(|(after, ..)| *after != before) {
            let reach = reach.max(other);
            if distance(&from, &to) <= JOINT * reach {
                (covers[before].goes_on[1], covers[after].goes_on[0]) = (true, true);
                covers.push(Cover { ends: [from, to], goes_on: [true; 2], reach });
            }
        }
    }
}

/// The parts of `pieces` that no cover lies on, in their order, on a grid with its nodes in place; walls stay whole.
pub fn open<const D: usize>(mesh: &Mesh<D>, pieces: &[Piece], covers: &[Cover<D>]) -> Vec<Piece> {
    const { assert!(D == 2, "covers are lines in the plane") };
    let ends: Vec<[[f64; D]; 2]> =
        pieces.iter().map(|piece| [0.0, 1.0].map(|t| place(mesh, &mesh.nodes, piece, t))).collect();
    let longest = ends.iter().map(length).fold(0.0, f64::max);
    // The place of a piece is known to a part of its cell; the edge of a typical cell is its diagonal over √2.
    let known = |piece: &Piece| 0.5 * FRAC_1_SQRT_2 * cell_size(mesh, piece.cell as usize);
    let reach = covers.iter().map(|cover| cover.reach).chain(pieces.iter().map(known)).fold(0.0, f64::max);
    let boxes = covers.iter().map(|cover| cover.ends.map(|x| [x[0], x[1]])).map(|[a, b]| (a, b));
    let bins = Bins::new(boxes, longest + reach);
    let mut open = Vec::with_capacity(pieces.len());
    for (piece, ends) in pieces.iter().zip(&ends) {
        if piece.wall {
            open.push(*piece);
            continue;
        }
        let middle = [0, 1].map(|d| 0.5 * (ends[0][d] + ends[1][d]));
        let shares = bins.around(&middle).flatten().map(|&cover| covers[cover as usize].share(ends, known(piece)));
        let mut shares: Vec<[f64; 2]> = shares.filter(|[from, to]| from < to && *from < 1.0 && *to > 0.0).collect();
        shares.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut at = 0.0;
        for [from, to] in shares.into_iter().chain([[1.0, 1.0]]) {
            if from - at > LEAST {
                open.push(piece.part(at, from));
            }
            at = f64::max(at, to);
        }
    }
    open
}

#[cfg(test)]
mod tests {
    use super::super::path::Path;
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// A piece along the top of the square [0, 1]², from right to left; half a cell is 0.5 m.
    fn piece() -> Piece {
        let path = Path::straight([[1.0, 1.0], [-1.0, 1.0]]);
        Piece { cell: 0, path, wall: false, region: 0, host: 0, in_host: path }
    }

    fn mesh() -> Mesh<2> {
        rectangle(CellKind::Q4, 1.0, 1.0, 1, 1, 0.0, 0)
    }

    fn cover(from: [f64; 2], to: [f64; 2]) -> Cover<2> {
        Cover { ends: [from, to], goes_on: [false; 2], reach: 0.1 }
    }

    /// Where the open parts begin and end (m) in x.
    fn left(covers: &[Cover<2>]) -> Vec<[f64; 2]> {
        let mesh = mesh();
        let at = |piece: &Piece, t: f64| place(&mesh, &mesh.nodes, piece, t)[0];
        open(&mesh, &[piece()], covers).iter().map(|piece| [at(piece, 0.0), at(piece, 1.0)]).collect()
    }

    fn assert_are(found: &[[f64; 2]], wanted: &[[f64; 2]]) {
        let off = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        let same = found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| off(a, b) < 1e-12);
        assert!(same, "{found:?} {wanted:?}");
    }

    #[test]
    fn a_cover_leaves_what_is_beside_it() {
        assert_are(&left(&[]), &[[1.0, 0.0]]);
        assert_are(&left(&[cover([0.25, 1.0], [0.5, 1.0])]), &[[1.0, 0.5], [0.25, 0.0]]);
        assert_are(&left(&[cover([-0.3, 1.05], [0.5, 1.05]), cover([0.5, 0.95], [0.7, 0.95])]), &[[1.0, 0.7]]);
        assert_are(&left(&[cover([-0.1, 1.0], [1.1, 1.0])]), &[]);
    }

    #[test]
    fn what_is_far_or_faces_away_covers_nothing() {
        assert_are(&left(&[cover([0.2, 1.6], [0.5, 1.6])]), &[[1.0, 0.0]]);
        assert_are(&left(&[cover([0.5, 1.0], [0.2, 1.0])]), &[[1.0, 0.0]]);
        assert_are(&left(&[cover([0.5, 1.05], [0.5, 0.95])]), &[[1.0, 0.0]]);
    }

    /// Two that meet at an angle cover what lies between their feet.
    #[test]
    fn a_joint_stays_closed() {
        let joint = [0.5, 1.06];
        let turned = |goes_on| {
            let mut covers = [cover([-0.1, 1.0], joint), cover(joint, [1.1, 1.0])];
            (covers[0].goes_on[1], covers[1].goes_on[0]) = (goes_on, goes_on);
            // The piece turns the other way: two covers whose feet are apart.
            [covers[0], Cover { ends: [[0.55, 1.06], [1.1, 1.0]], ..covers[1] }]
        };
        assert_are(&left(&turned(false)), &[[0.55, 0.5]]);
        assert_are(&left(&turned(true)), &[]);
    }

    /// Structures that lie side by side leave no more open than one whose boundary turns, unless a gap is between them.
    #[test]
    fn joints_of_structures_are_closed() {
        for (beside, wanted) in [(0.5, vec![]), (0.515, vec![]), (0.53, vec![[0.53, 0.5]])] {
            let mut covers = vec![cover([-0.1, 1.0], [0.5, 1.06]), cover([beside, 1.06], [1.1, 1.0])];
            join(&mut covers);
            assert_are(&left(&covers), &wanted);
        }
    }

    /// A wall is none that water leaves through, covered or not.
    #[test]
    fn walls_stay() {
        let wall = Piece { wall: true, ..piece() };
        assert_eq!(open(&mesh(), &[wall], &[cover([-0.1, 1.0], [1.1, 1.0])]), [wall]);
    }
}
