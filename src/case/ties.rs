//! Sides whose nodes at the same height move alike (tied degrees of freedom): a column of them is soil that goes on beside it.

use super::check::Checker;
use super::checked::Case;
use super::locate::{At, Path};
use super::{parts, raw};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, height};
use std::collections::BTreeSet;

/// How far apart heights may be that are one (-), over the height of the curves: the digits that a mesh file may not have.
const MATCH: f64 = 1e-6;

impl Checker {
    /// Refuses a curve that is tied and held in another way.
    pub(super) fn tied(&mut self, file: &raw::CaseFile, curve: &str, held: &raw::Components, path: &Path) {
        let Some(other) = &held.tied else { return };
        let path = path.key("tied");
        if file.geometry != raw::Geometry::PlaneStrain {
            self.issue(&path, At::Key, "sides are tied in plane strain", "take it out");
        }
        if held.un.is_some() || held.rotation.is_some() {
            let remedy = "take `un` and `rotation` out here";
            self.issue(&path, At::Key, format!("`{curve}` is held across itself as well"), remedy);
        }
        if other == curve {
            self.issue(&path, At::Value, format!("`{curve}` is tied to itself"), "name the opposite side");
        }
        if file.supports.get(other).is_some_and(|other| other.tied.is_some() || other.un.is_some()) {
            let problem = format!("`{other}` has `tied` or `un` of its own");
            self.issue(&path, At::Value, problem, "tie one of the two sides to the other, once");
        }
        if file.numerics.gradient == "bspline" {
            let remedy = "choose `gradient: mpm`";
            self.issue(&path, At::Key, "ties are between nodes, and splines have none", remedy);
        }
    }
}

/// The pairs of nodes that are tied, the first of which follows the second.
///
/// # Errors
/// Input: curves of a grid that does not move with the material, or whose nodes are not at the same heights.
pub fn ties(case: &Case, (mesh, fem): (&Mesh<2>, Option<&Mesh<2>>)) -> Result<Vec<[u32; 2]>> {
    let mut ties: Vec<[u32; 2]> = Vec::new();
    for support in &case.supports {
        let Some(other) = &support.tied else { continue };
        let place = || format!("supports.{}.tied", support.curve);
        let names = [support.curve.as_str(), other.as_str()];
        let mut sides = [Vec::new(), Vec::new()];
        for (side, name) in sides.iter_mut().zip(names) {
            side.extend_from_slice(&parts::material_curve(case, (mesh, fem), name, place)?.nodes);
            side.sort_by(|a, b| height(&mesh.nodes[*a as usize]).total_cmp(&height(&mesh.nodes[*b as usize])));
        }
        let y = |n: u32| height(&mesh.nodes[n as usize]);
        let all = || sides.iter().flatten().map(|&n| y(n));
        let tall = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
        let same = |a: u32, b: u32| (y(a) - y(b)).abs() <= MATCH * tall;
        let alone = |[from, to]: [usize; 2]| {
            let partners = |n: u32| sides[to].iter().filter(|&&m| same(n, m)).count();
            let lost = sides[from].iter().find(|&&n| partners(n) != 1)?;
            let [x, y] = mesh.nodes[*lost as usize];
            let problem = match partners(*lost) {
                0 => format!(
                    "the node of `{}` at [{x:.6}, {y:.6}] m has no node of `{}` at its height",
                    names[from], names[to]
                ),
                _ => format!("`{}` has several nodes at the height y = {y:.6} m", names[to]),
            };
            Some(Error::input(
                place(),
                problem,
                "tie two vertical sides with the same nodes: give their curves in the .geo the same `Transfinite Curve`",
            ))
        };
        if let Some(error) = alone([0, 1]).or_else(|| alone([1, 0])) {
            return Err(error);
        }
        ties.extend(sides[0].iter().zip(&sides[1]).map(|(&follows, &followed)| [follows, followed]));
    }
    let mut follow = BTreeSet::new();
    let doubly =
        ties.iter().find(|[follows, followed]| follows == followed || !follow.insert(*follows)).map(|tie| tie[0]);
    let chained = ties.iter().map(|tie| tie[1]).find(|followed| follow.contains(followed));
    if let Some(n) = doubly.or(chained) {
        return Err(Error::input(
            "supports",
            format!("the node at {:.3?} m is tied more than once, or to itself", mesh.nodes[n as usize]),
            "tie each curve to one other, and curves that share no node",
        ));
    }
    Ok(ties)
}
