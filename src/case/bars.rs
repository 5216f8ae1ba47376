//! Anchors, struts and springs: what a case says of them, checked, and the bars of a scene.

use super::check::Checker;
use super::checked::{Bar, BarEnd, Case, Content};
use super::find::{group, regions};
use super::locate::{At, Path};
use super::raw;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::quality::SAME;
use crate::term::{self, End, Mode};

impl Checker {
    pub(super) fn bars(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<Bar> {
        if file.geometry == raw::Geometry::Axisymmetric && !file.bars.is_empty() {
            let remedy = "give a strut or an anchor of a ring as a `plate`, or take `bars` out";
            self.issue(path, At::Key, "bars are of plane strain", remedy);
        }
        if file.start_from.is_some() && !file.bars.is_empty() {
            let problem = "the other run does not know the lengths of the bars";
            self.issue(path, At::Key, problem, "put the phases into one case, without `start_from`");
        }
        let mut bars = Vec::new();
        for (name, bar) in &file.bars {
            let path = path.key(name);
            let is_taken = file.regions.contains_key(name)
                || file.contacts.iter().any(|c| [&c.name, &c.wall].into_iter().flatten().any(|other| other == name));
            if is_taken {
                let problem = format!("a region, a contact or a wall is called `{name}`, too");
                self.issue(
                    &path,
                    At::Key,
                    problem,
                    "give the bar a name of its own: phases and the history know it by that",
                );
            }
            let limits = [-bar.compression_limit.unwrap_or(f64::INFINITY), bar.tension_limit.unwrap_or(f64::INFINITY)];
            if let Some(force) = bar.prestress.filter(|force| *force < limits[0] || *force > limits[1]) {
                let problem = format!("is {force}, beyond the force at which the bar yields");
                self.issue(&path.key("prestress"), At::Value, problem, "give a smaller force, or a larger limit");
            }
            let to = match &bar.to {
                raw::BarEnd::Point(point) if *point == bar.from => {
                    self.issue(&path.key("to"), At::Value, "is the point that the bar is `from`", "name another one");
                    BarEnd::Point(point.clone())
                }
                raw::BarEnd::Point(point) => BarEnd::Point(point.clone()),
                raw::BarEnd::Place(place) => BarEnd::Place(*place),
            };
            let (from, name) = (bar.from.clone(), name.clone());
            bars.push(Bar { name, from, to, ea: bar.ea, length: bar.length, prestress: bar.prestress, limits });
        }
        bars
    }
}

/// The bars of a case whose nodes are those of `mesh`, given the part with the finite elements.
///
/// # Errors
/// Input: a point that is not one node of finite elements, ends at the same place.
pub fn bars(case: &Case, mesh: &Mesh<2>, elements: Option<&Mesh<2>>) -> Result<Vec<term::Bar<2>>> {
    let rigid = regions(case, mesh, Content::is_rigid);
    let node = |bar: &Bar, name: &str| {
        let nodes = &group(mesh, name)?.nodes;
        let fault = |problem: String| {
            let remedy = "name a point of a plate, or a Physical Point of a structure that is not rigid";
            Err(Error::input(format!("bars.{}", bar.name), problem, remedy))
        };
        let &[node] = &nodes[..] else {
            return fault(format!("`{name}` is {} points", nodes.len()));
        };
        let deforms = |of: &Mesh<2>| {
            (0..of.cells.len()).any(|c| !rigid[of.cells.region[c] as usize] && of.cells.nodes(c).contains(&node))
        };
        if elements.is_some_and(deforms) { Ok(node) } else { fault(format!("`{name}` is no point of finite elements")) }
    };
    let size = mesh.nodes.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
    let bar = |bar: &Bar| {
        let to = match &bar.to {
            BarEnd::Point(name) => End::Node(node(bar, name)?),
            BarEnd::Place(x) => End::Fixed(*x),
        };
        let mode = |number: usize| match (case.phases[number].absent.contains(&bar.name), bar.prestress) {
            (true, _) => Mode::Absent,
            (false, Some(force)) if number == 0 || case.phases[number - 1].absent.contains(&bar.name) => {
                Mode::Tensioned(force)
            }
            (false, _) => Mode::Elastic,
        };
        let mut made = term::Bar {
            ends: [End::Node(node(bar, &bar.from)?), to],
            stiffness: bar.ea,
            limits: bar.limits,
            modes: (0..case.phases.len()).map(mode).collect(),
        };
        let (length, _) = made.line(|n| mesh.nodes[n as usize]);
        if length <= SAME * size {
            let remedy = "let it end elsewhere: its force acts along the line between its ends";
            return Err(Error::input(format!("bars.{}", bar.name), "both of its ends are at the same place", remedy));
        }
        made.stiffness /= bar.length.unwrap_or(length);
        Ok(made)
    };
    case.bars.iter().map(bar).collect()
}
