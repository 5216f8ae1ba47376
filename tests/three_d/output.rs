//! VTK numbers the nodes of solid cells in an order of its own (`vtkQuadraticTetra.h`, `vtkTriQuadraticHexahedron.h`).

use mpm::io::vtu::Topology;
use mpm::mesh::brick::brick;
use mpm::mesh::shape::CellKind;

type Place = [f64; 3];

fn middle(x: &[Place]) -> Place {
    [0, 1, 2].map(|d| x.iter().map(|x| x[d]).sum::<f64>() / x.len() as f64)
}

/// The places of the nodes of a cell in the order of VTK, given those of its corners.
fn in_order(kind: CellKind, corner: &[Place]) -> Vec<Place> {
    const OF_TETRAHEDRON: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    const OF_HEXAHEDRON: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    // Across x, y and z, the lower one first.
    const FACES: [[usize; 4]; 6] = [[0, 3, 7, 4], [1, 2, 6, 5], [0, 1, 5, 4], [3, 2, 6, 7], [0, 1, 2, 3], [4, 5, 6, 7]];
    let (edges, faces) = match kind {
        CellKind::T10 => (&OF_TETRAHEDRON[..], &[][..]),
        _ => (&OF_HEXAHEDRON[..], &FACES[..]),
    };
    let mut places = corner.to_vec();
    places.extend(edges.iter().map(|edge| middle(&edge.map(|i| corner[i]))));
    places.extend(faces.iter().map(|face| middle(&face.map(|i| corner[i]))));
    places.extend((kind == CellKind::H27).then(|| middle(corner)));
    places
}

#[test]
fn nodes_stand_where_vtk_has_them() {
    for (kind, number) in [(CellKind::T10, 24), (CellKind::H27, 29)] {
        let mesh = brick(kind, [3.0, 2.0, 1.0], [2; 3], 0.1, 3);
        let Topology { connectivity, offsets, types } = Topology::of_mesh(&mesh);
        assert!(types.iter().all(|&t| t == number));
        let mut begin = 0;
        for &end in &offsets {
            let found: Vec<Place> = connectivity[begin..end as usize].iter().map(|&n| mesh.nodes[n as usize]).collect();
            let wanted = in_order(kind, &found[..kind.corner_count()]);
            assert_eq!(found.len(), wanted.len());
            let off = found.iter().zip(&wanted).flat_map(|(x, y)| [0, 1, 2].map(|d| (x[d] - y[d]).abs()));
            assert!(off.fold(0.0, f64::max) < 1e-14, "{kind:?}: {found:?} {wanted:?}");
            begin = end as usize;
        }
    }
}
