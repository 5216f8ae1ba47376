//! How many material points there are: where soil is stretched a point is split in two, where it is crowded two become one.
//!
//! Nothing is summed over the material points, but the state of a cell is fitted to them. So no room of [`ROOM`] seeded points within the surface is to be
//! without a point: neither a part of a cell that is full, as far as it was seeded with so many, nor a cell in need of more to have as many points as such rooms. And no
//! cell is to hold more than [`ROOM`] times as many as it was seeded with. Both bound the number of points: none that is smaller than half a seeded one is split.
//!
//! The point that is split is the one whose domain is nearest to the empty room, and its two halves lie on both sides of where it was, one of them in
//! the room. They have its state, its velocity and half of its mass and volume: mass, momentum (linear and angular) and energy are those before, and so is
//! `Σ V σ`. They were seeded on both sides of where it was, too.
//!
//! Two points that become one are near to each other and alike. Mass, volume, `Σ V σ`, the centre of mass and linear momentum are kept; the spin of the two about
//! their centre is handed to the points of the cell as a rigid rotation.

use super::fields::{Fields, Materials, ORIGIN, PLASTIC, STRESS, VOLUME};
use super::fit::{Around, Held};
use super::places::Place;
use crate::kinematics::Kinematics;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::quadrature::Restored;
use crate::surface::Geometry;

/// Seeded points whose room has a point at least, and how many times as many as seeded a cell has at most: half, and twice the
/// spacing in both directions.
pub const ROOM: f64 = 4.0;

/// The material points after some were split and merged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Renewed<const D: usize> {
    pub points: Points<D>,
    /// Parametric coordinates in their cells.
    pub parametric: Vec<[f64; 3]>,
    /// The number that each had before, or that of the point it was split from or merged into.
    pub from: Vec<u32>,
}

/// What was done to the points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    pub split: u32,
    pub merged: u32,
    /// Cells that are short of points and stay so, for no point near can be split.
    pub starved: u32,
}

/// What a material fills of a cell.
pub struct Part {
    pub cell: u32,
    pub region: u16,
    /// Share of the volume of the cell (-).
    pub share: f64,
    /// Whether the cell is full, of this material alone.
    pub full: bool,
    /// Where its integration points are.
    pub places: Vec<Place>,
}

/// The grid on which points are split and merged.
pub struct Ground<'a> {
    pub geometry: &'a Geometry,
    pub around: &'a Around,
    pub grid: &'a Restored<'a, 2>,
    pub level_set: &'a [f64],
    /// Cells that the surface leaves out.
    pub outside: &'a [bool],
    /// Ascending by cell and region.
    pub parts: &'a [Part],
    /// The points that a cell of each region was seeded with.
    pub seeded: &'a [u32],
    pub held: &'a Held,
}

impl Ground<'_> {
    fn seeded(&self, part: &Part) -> f64 {
        self.seeded.get(usize::from(part.region)).map_or(0.0, |&n| f64::from(n))
    }

    /// The least number of points of a part.
    fn least(&self, part: &Part) -> usize {
        let rooms = (self.seeded(part) * part.share / ROOM) as usize;
        if part.full { rooms.max(1) } else { rooms }
    }

    fn most(&self, part: &Part) -> usize {
        (ROOM * self.seeded(part)) as usize
    }

    /// Whether the quarters of a part are rooms.
    fn has_quarters(&self, part: &Part) -> bool {
        part.full && self.seeded(part) >= ROOM * ROOM
    }

    /// Places within the rooms of a part that have none of its `points`, given where these are.
    fn empty(&self, part: &Part, points: &[([f64; 2], [f64; 3])]) -> Vec<[f64; 2]> {
        let kind = self.grid.mesh.cells.kind[part.cell as usize];
        if self.has_quarters(part) {
            let mut has = [false; 4];
            points.iter().for_each(|(_, xi)| has[quarter(kind.is_simplex(), xi)] = true);
            let centres = quarters(kind.is_simplex());
            let lacking = centres.iter().zip(has).filter(|(_, has)| !has);
            return lacking.map(|(xi, _)| self.place(part.cell, xi)).collect();
        }
        if points.len() >= self.least(part) {
            return Vec::new();
        }
        let square = |place: &Place| points.iter().map(|(x, _)| distance2(x, &place.x)).fold(f64::INFINITY, f64::min);
        let far = part.places.iter().map(|place| (square(place), place));
        far.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.weight.total_cmp(&b.1.weight)))
            .map(|(_, place)| place.x)
            .into_iter()
            .collect()
    }

    /// The place (m) of parametric coordinates in a cell.
    fn place(&self, cell: u32, xi: &[f64; 3]) -> [f64; 2] {
        let mesh = self.grid.mesh;
        let mut n = [0.0; MAX_NODES];
        mesh.cells.kind[cell as usize].values(xi, &mut n);
        let nodes = mesh.cells.nodes(cell as usize);
        [0, 1].map(|d| nodes.iter().zip(&n).map(|(&node, n)| n * mesh.nodes[node as usize][d]).sum())
    }

    /// The cell of a place (m) at which a point of a region can be, and its coordinates there: within the surface, where the region is, and
    /// no nearer to the end of the grid than the faces of cells reach.
    fn room_at(&self, x: &[f64; 2], region: u16, hint: u32) -> Option<(u32, [f64; 3])> {
        let Restored { mesh, locator, active, .. } = *self.grid;
        let (cell, xi) = locator.locate(mesh, x, Some(hint))?;
        let c = cell as usize;
        let takes_part = active[c] && self.geometry.faces.neighbours(cell).iter().all(|&o| active[o as usize]);
        let filled = self.parts.binary_search_by_key(&(cell, region), |part| (part.cell, part.region)).is_ok();
        if !takes_part || !filled || self.outside[c] {
            return None;
        }
        let mut n = [0.0; MAX_NODES];
        mesh.cells.kind[c].values(&xi, &mut n);
        let nodes = mesh.cells.nodes(c);
        let level: f64 = nodes.iter().zip(&n).map(|(&node, n)| n * self.level_set[node as usize]).sum();
        (level > 0.0).then_some((cell, xi))
    }
}

/// Points on the way from one population to the next.
struct Crowd {
    points: Points<2>,
    parametric: Vec<[f64; 3]>,
    from: Vec<u32>,
    /// The points of each cell.
    of_cell: Vec<Vec<u32>>,
    gone: Vec<bool>,
}

impl Crowd {
    fn of(ground: &Ground) -> Self {
        let Restored { mesh, points, parametric, .. } = *ground.grid;
        Self {
            points: points.clone(),
            parametric: parametric.to_vec(),
            from: (0..points.len() as u32).collect(),
            of_cell: (0..mesh.cells.len() as u32).map(|c| ground.held.points(c).to_vec()).collect(),
            gone: vec![false; points.len()],
        }
    }

    /// The points of a part.
    fn members(&self, part: &Part) -> Vec<u32> {
        let own = |p: &u32| self.points.region[*p as usize] == part.region;
        self.of_cell[part.cell as usize].iter().copied().filter(own).collect()
    }

    fn lacks(&self, ground: &Ground, part: &Part) -> Vec<[f64; 2]> {
        let at = |p: u32| (self.points.position[p as usize], self.parametric[p as usize]);
        ground.empty(part, &self.members(part).into_iter().map(at).collect::<Vec<_>>())
    }

    /// Splits points until no room of a part is empty, or none can be split. Returns how many were.
    fn fill<K: Kinematics<2>>(&mut self, ground: &Ground, part: &Part, materials: &Materials<K>) -> u32 {
        let mut count = 0;
        // Halves may leave a room that had a point: no more are split than there are rooms.
        for _ in 0..ground.least(part).max(4) {
            let split = self.lacks(ground, part).iter().any(|spot| self.split_towards(ground, part, spot, materials));
            if !split {
                break;
            }
            count += 1;
        }
        count
    }

    /// Splits the point that is nearest to a place, in its own size, such that a half is there.
    fn split_towards<K: Kinematics<2>>(
        &mut self,
        ground: &Ground,
        part: &Part,
        spot: &[f64; 2],
        materials: &Materials<K>,
    ) -> bool {
        let least = 0.5 * ground.geometry.volume(part.cell as usize) / ground.seeded(part);
        let near = std::iter::once(part.cell).chain(ground.around.cells(part.cell).iter().copied());
        let mut donors: Vec<(f64, u32)> = near
            .filter(|&c| !ground.outside[c as usize])
            .flat_map(|c| &self.of_cell[c as usize])
            .filter(|&&p| self.points.region[p as usize] == part.region && self.points.volume(p as usize) >= least)
            .map(|&p| (nearness::<K>(&self.points, p as usize, spot), p))
            .collect();
        donors.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (_, p) in donors {
            let (x, hint) = (self.points.position[p as usize], self.points.cell[p as usize]);
            let by = [0, 1].map(|d| spot[d] - x[d]);
            let halves =
                [1.0, -1.0].map(|sign| ground.room_at(&[0, 1].map(|d| x[d] + sign * by[d]), part.region, hint));
            if let [Some(there), Some(back)] = halves {
                self.split(p as usize, by, [there, back], materials);
                return true;
            }
        }
        false
    }

    /// Splits point `p` into halves at `by` and `-by` (m) from it, with their cells.
    fn split<K: Kinematics<2>>(
        &mut self,
        p: usize,
        by: [f64; 2],
        [there, back]: [(u32, [f64; 3]); 2],
        materials: &Materials<K>,
    ) {
        let q = self.points.split::<K>(p, by);
        self.of_cell[self.points.cell[p] as usize].retain(|&other| other as usize != p);
        self.parametric.push([0.0; 3]);
        self.from.push(self.from[p]);
        self.gone.push(false);
        for (half, (cell, xi)) in [(q, there), (p, back)] {
            self.points.cell[half] = cell;
            self.parametric[half] = xi;
            self.of_cell[cell as usize].push(half as u32);
            materials.vary(&mut self.points, half);
        }
    }

    /// Merges pairs of the points of a crowded part, each point at most once. Returns how many.
    fn thin<K: Kinematics<2>>(&mut self, ground: &Ground, part: &Part, materials: &Materials<K>) -> u32 {
        let members = self.members(part);
        let compared = |&p: &u32| -> Vec<f64> {
            let fields = materials.fields(&self.points, p as usize);
            let own = fields[STRESS..STRESS + 4].iter().chain([&fields[PLASTIC]]);
            own.chain(self.points.internal_of(p as usize)).copied().collect()
        };
        let compared: Vec<Vec<f64>> = members.iter().map(compared).collect();
        let range = |k: usize| {
            let (low, high) =
                compared.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), f| (l.min(f[k]), h.max(f[k])));
            if high > low { high - low } else { 1.0 }
        };
        let ranges: Vec<f64> = (0..compared.first().map_or(0, Vec::len)).map(range).collect();
        let area = ground.geometry.frame[part.cell as usize].length.powi(2);
        let mut pairs = Vec::new();
        for (i, &p) in members.iter().enumerate() {
            for (j, &q) in members.iter().enumerate().skip(i + 1) {
                let [x, y] = [p, q].map(|p| self.points.position[p as usize]);
                let both = compared[i].iter().zip(&compared[j]).zip(&ranges);
                let unlike: f64 = both.map(|((a, b), range)| ((a - b) / range).powi(2)).sum();
                pairs.push((distance2(&x, &y) / area + unlike, i, j));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let (mut free, mut count, mut spin) = (vec![true; members.len()], 0, [0.0; 2]);
        for (_, i, j) in pairs {
            if members.len() - count as usize <= ground.most(part) {
                break;
            }
            if free[i] && free[j] && self.merge::<K>(ground, part, [members[i], members[j]], materials, &mut spin) {
                (free[i], free[j]) = (false, false);
                count += 1;
            }
        }
        if !K::HOOP && count > 0 {
            let left = self.members(part);
            let Points { position, mass, velocity, acceleration, .. } = &mut self.points;
            for (field, spin) in [velocity, acceleration].into_iter().zip(spin) {
                turn(&left, position, mass, field, spin);
            }
        }
        count
    }

    /// Makes one point of two, and adds their spin, in velocity and acceleration, about their centre to `spin`.
    fn merge<K: Kinematics<2>>(
        &mut self,
        ground: &Ground,
        part: &Part,
        [p, q]: [u32; 2],
        materials: &Materials<K>,
        spin: &mut [f64; 2],
    ) -> bool {
        let [p, q] = [p as usize, q as usize];
        let points = &self.points;
        if points.model_of(p) != points.model_of(q) {
            return false;
        }
        let (mut one, lost) = points.joined(p, q);
        // Kirchhoff stresses by their volume when seeded, as all that is fitted.
        let [a, b] = [p, q].map(|p| (points.initial_volume[p], materials.fields(points, p)));
        let mut fields: Fields = std::array::from_fn(|k| (a.0 * a.1[k] + b.0 * b.1[k]) / (a.0 + b.0));
        let internal = points.internal_of(p).iter().zip(points.internal_of(q));
        let internal: Vec<f64> = internal.map(|(x, y)| (a.0 * x + b.0 * y) / (a.0 + b.0)).collect();
        fields[VOLUME] = one.deformation[0].determinant().ln();
        fields[ORIGIN..].copy_from_slice(&one.origin[0]);
        materials.vary(&mut one, 0);
        let place = ground.room_at(&one.position[0], part.region, part.cell).filter(|(cell, _)| *cell == part.cell);
        let (Some((_, xi)), Some((elastic, stress))) =
            (place, materials.state(points.model_of(p), &fields, &internal, one.strength_of(0)))
        else {
            return false;
        };
        (one.elastic[0], one.stress[0]) = (elastic, stress);
        one.cell[0] = part.cell;
        let new = self.points.len();
        self.points.append(&one);
        self.parametric.push(xi);
        self.from.push(self.from[p]);
        self.gone.push(false);
        (self.gone[p], self.gone[q]) = (true, true);
        let own = &mut self.of_cell[part.cell as usize];
        own.retain(|&other| other as usize != p && other as usize != q);
        own.push(new as u32);
        spin.iter_mut().zip(lost).for_each(|(spin, lost)| *spin += lost);
        true
    }

    fn finish(self) -> Renewed<2> {
        let left: Vec<usize> = (0..self.points.len()).filter(|&p| !self.gone[p]).collect();
        Renewed {
            points: self.points.select(&left),
            parametric: left.iter().map(|&p| self.parametric[p]).collect(),
            from: left.iter().map(|&p| self.from[p]).collect(),
        }
    }
}

/// The population that a grid asks for; `None` where it is the one that there is.
pub fn renew<K: Kinematics<2>>(ground: &Ground, materials: &Materials<K>) -> (Option<Renewed<2>>, Count) {
    let Restored { points, parametric, .. } = *ground.grid;
    let mut count = Count::default();
    let own = |part: &Part| -> Vec<([f64; 2], [f64; 3])> {
        let own =
            ground.held.points(part.cell).iter().map(|&p| p as usize).filter(|&p| points.region[p] == part.region);
        own.map(|p| (points.position[p], parametric[p])).collect()
    };
    let wanting = |part: &&Part| {
        let own = own(part);
        ground.seeded(part) > 0.0 && (own.len() > ground.most(part) || !ground.empty(part, &own).is_empty())
    };
    let wanting: Vec<&Part> = ground.parts.iter().filter(wanting).collect();
    if wanting.is_empty() {
        return (None, count);
    }
    let mut crowd = Crowd::of(ground);
    for part in &wanting {
        count.split += crowd.fill(ground, part, materials);
    }
    for part in &wanting {
        if crowd.members(part).len() > ground.most(part) {
            count.merged += crowd.thin::<K>(ground, part, materials);
        }
    }
    count.starved =
        ground.parts.iter().filter(|part| ground.seeded(part) > 0.0 && !crowd.lacks(ground, part).is_empty()).count()
            as u32;
    ((count.split + count.merged > 0).then(|| crowd.finish()), count)
}

fn distance2(x: &[f64; 2], y: &[f64; 2]) -> f64 {
    (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)
}

/// Distance (-) of a place from a point in the half widths of its domain, which is taken to be at most [`ROOM`] times as long as wide: the
/// soil beyond has long been that of other points.
fn nearness<K: Kinematics<2>>(points: &Points<2>, p: usize, place: &[f64; 2]) -> f64 {
    let (f, x) = (&points.deformation[p], &points.position[p]);
    let [a, b, c, d] = [f[(0, 0)], f[(0, 1)], f[(1, 0)], f[(1, 1)]];
    let [xx, yy, xy] = [a * a + b * b, c * c + d * d, a * c + b * d];
    let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    let longest = ((mean + radius) / (a * d - b * c).abs()).clamp(1.0, ROOM);
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let by = [0, 1].map(|i| place[i] - x[i]);
    let (along, across) = (angle.cos() * by[0] + angle.sin() * by[1], angle.cos() * by[1] - angle.sin() * by[0]);
    let area = 0.25 * points.volume(p) / K::measure(x);
    ((along * along / longest + across * across * longest) / area).sqrt()
}

/// Adds a rigid rotation about the centre of mass of some points to a field of motion, with the moment of momentum `spin`.
fn turn(of: &[u32], position: &[[f64; 2]], mass: &[f64], field: &mut [[f64; 2]], spin: f64) {
    let whole: f64 = of.iter().map(|&p| mass[p as usize]).sum();
    if field.is_empty() || spin == 0.0 {
        return;
    }
    let centre = [0, 1].map(|d| of.iter().map(|&p| mass[p as usize] * position[p as usize][d]).sum::<f64>() / whole);
    let inertia: f64 = of.iter().map(|&p| mass[p as usize] * distance2(&position[p as usize], &centre)).sum();
    let rate = spin / inertia;
    for p in of.iter().map(|&p| p as usize) {
        let [x, y] = [0, 1].map(|d| position[p][d] - centre[d]);
        field[p][0] -= rate * y;
        field[p][1] += rate * x;
    }
}

/// The quarter of a cell that parametric coordinates are in, in the order of [`quarters`].
fn quarter(simplex: bool, [x, y, _]: &[f64; 3]) -> usize {
    if !simplex {
        return usize::from(*x > 0.0) + 2 * usize::from(*y > 0.0);
    }
    if *x > 0.5 {
        1
    } else if *y > 0.5 {
        2
    } else if x + y < 0.5 {
        0
    } else {
        3
    }
}

/// The centres of the quarters of a cell.
fn quarters(simplex: bool) -> [[f64; 3]; 4] {
    let places = if simplex {
        [[1.0 / 6.0, 1.0 / 6.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0], [1.0 / 3.0, 1.0 / 3.0]]
    } else {
        [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]]
    };
    places.map(|[x, y]| [x, y, 0.0])
}

#[cfg(test)]
mod tests;
