//! What frames hold of the surface of the material: the corners of its loops, with what acts there.

use super::boundary::nodes;
use crate::io::frame::{Column, LINE, Part, REGION, triples};
use crate::step::{Scene, State};
use crate::surface::{NO_REGION, Piece, place};
use crate::term::{Hydrostatic, SurfaceLoad};

/// What acts on the surface of the material.
#[derive(Clone, Debug, Default)]
pub struct Acting {
    pub loads: Vec<SurfaceLoad>,
    /// The pressure of water in each phase.
    pub water: Vec<Option<Hydrostatic>>,
}

/// The corners of all loops where they are now, in their order; empty where the surface is not known.
///
/// Normals (-) out of the material are the mean of the pieces on both sides; where a free surface begins, that of it.
/// Pressure (kPa, compression positive) is what acts at right angles to the surface, traction (kPa) all that acts. The
/// column `wall` is 1 where a loop goes on along the boundary of the mesh, where no load but water is shown, else 0.
pub fn part<const D: usize>(scene: &Scene<D>, state: &State<D>, acting: &Acting) -> Part {
    const { assert!(D == 2, "the surface is a line in the plane only") };
    let boundary = &state.weights.boundary;
    let nodes = nodes(scene, state);
    let corner = |piece: &Piece| {
        let x = place(&scene.mesh, &nodes, piece, 0.0);
        [x[0], x[1]]
    };

    let mut corners: Vec<[f64; 2]> = Vec::new();
    let [mut normal, mut traction] = [const { Vec::new() }; 2];
    let [mut pressure, mut number, mut region, mut wall] = [const { Vec::new() }; 4];
    for l in 0..boundary.loops() {
        let pieces = boundary.pieces(l);
        let x: Vec<[f64; 2]> = pieces.iter().map(corner).collect();
        // A quarter turn to the right of the way from corner to corner.
        let outwards = |i: usize| {
            let (a, b) = (x[i], x[(i + 1) % x.len()]);
            [b[1] - a[1], a[0] - b[0]]
        };
        for (i, piece) in pieces.iter().enumerate() {
            let before = (i + pieces.len() - 1) % pieces.len();
            let free = !piece.wall || !pieces[before].wall;
            let mut n = [0.0; 2];
            for k in [before, i].into_iter().filter(|&k| !free || !pieces[k].wall) {
                let out = outwards(k);
                n = [n[0] + out[0], n[1] + out[1]];
            }
            let length = n[0].hypot(n[1]);
            let n = n.map(|n| if length > 0.0 { n / length } else { 0.0 });
            let [p, q] =
                acts(acting, state, &x[i], free.then_some(if piece.wall { &pieces[before] } else { piece }), &n);
            corners.push(x[i]);
            normal.extend([n[0], n[1], 0.0]);
            traction.extend([q[0], q[1], 0.0]);
            pressure.push(p[0]);
            number.push(l as f64);
            region.push(if piece.region == NO_REGION { -1.0 } else { f64::from(piece.region) });
            wall.push(f64::from(u8::from(piece.wall)));
        }
    }
    let columns = vec![
        Column::new("normal", "-", 3, normal),
        Column::new("pressure", "kPa", 1, pressure),
        Column::new("traction", "kPa", 3, traction),
        Column::new("wall", "-", 1, wall),
        Column::new(REGION, "-", 1, region),
        Column::new(LINE, "-", 1, number),
    ];
    if corners.is_empty() { Part::default() } else { Part { position: triples(&corners), columns } }
}

/// Pressure (kPa, in the first component) and traction at the place `x` with the normal `n`, on a free `piece` if it is
/// one.
fn acts<const D: usize>(
    acting: &Acting,
    state: &State<D>,
    x: &[f64; 2],
    piece: Option<&Piece>,
    n: &[f64; 2],
) -> [[f64; 2]; 2] {
    let time = state.phase_time;
    let water = acting.water.get(state.phase).and_then(Option::as_ref).map_or(0.0, |head| head.at(time).at(x[1])[0]);
    let mut sum = n.map(|n| -water * n);
    for load in &acting.loads {
        let within = |d: usize| load.within.is_none_or(|w| w[d][0] <= x[d] && x[d] <= w[d][1]);
        if piece.is_some_and(|piece| load.acts_on(state.phase, piece)) && within(0) && within(1) {
            let (p, s, q) = load.at(x, time);
            let along = [-n[1], n[0]];
            for d in 0..2 {
                sum[d] += q[d] - p * n[d] + s * along[d];
            }
        }
    }
    [[-(sum[0] * n[0] + sum[1] * n[1]), 0.0], sum]
}
