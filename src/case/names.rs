//! The names in a case against the physical groups of its mesh.

use super::checked::{BarEnd, Case, Content, Quantity, Touched, Touching, Traction};
use super::issue::Issue;
use super::locate::{At, Path};
use super::structure::{nearest, suggest};

/// The names of the physical groups of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    pub surfaces: Vec<String>,
    pub curves: Vec<String>,
    pub points: Vec<String>,
    pub of: Of,
}

/// What has physical groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Of {
    #[default]
    Geo,
    /// A mesh that is given in place of a `.geo`.
    Given,
    /// The `mesh.msh` of an earlier stage, which may be older than that.
    Made,
}

impl Of {
    fn name(self) -> &'static str {
        match self {
            Self::Geo => "the .geo",
            Self::Given => "the mesh",
            Self::Made => "mesh.msh",
        }
    }
}

/// Every name in `case` that the mesh does not have, and every surface that the case does not fill.
pub fn check(case: &Case, groups: &Groups) -> Vec<Issue> {
    let root = Path::default();
    let groups = &with_plates(case, groups);
    let mut names = Names { groups, issues: Vec::new() };
    for region in &case.regions {
        names.surface(&region.name, &root.key("regions").key(&region.name));
    }
    for surface in &groups.surfaces {
        // A region that is nearly called so has been reported.
        let meant = |name: &str| name == surface || nearest(name, [surface.as_str()]).is_some() && names.lacks(name);
        if !case.regions.iter().any(|region| meant(&region.name)) {
            let problem = format!("the physical surface `{surface}` of {} is not among the regions", groups.of.name());
            let remedy = format!("add `{surface}: {{kind: buffer}}`, or fill it with `kind: mpm`");
            names.issues.push(Issue::new(&root.key("regions"), At::Key, problem, remedy));
        }
    }
    for support in &case.supports {
        let path = root.key("supports").key(&support.curve);
        if support.across {
            names.curve(&support.curve, &path, At::Key);
        } else {
            names.held(case, &support.curve, &path);
        }
        if let Some(other) = &support.tied {
            names.curve(other, &path.key("tied"), At::Value);
        }
    }
    let across = |curve: &str| case.supports.iter().any(|support| support.across && support.curve == curve);
    for (i, contact) in case.contacts.iter().enumerate() {
        if let Touching::Wall(curve) = &contact.structure
            && !across(curve)
        {
            names.curve(curve, &root.key("contacts").index(i).key("wall"), At::Value);
        }
    }
    for bar in &case.bars {
        let path = root.key("bars").key(&bar.name);
        names.one_of(&bar.from, &groups.points, "physical point", &path.key("from"), At::Value);
        if let BarEnd::Point(point) = &bar.to {
            names.one_of(point, &groups.points, "physical point", &path.key("to"), At::Value);
        }
    }
    for (i, phase) in case.own_phases() {
        let path = root.key("phases").index(i);
        let mut curves: Vec<&str> = phase.prescribed.iter().map(|p| p.curve.as_str()).collect();
        curves.dedup();
        for curve in curves {
            names.held(case, curve, &path.key("prescribe").key(curve));
        }
        for inflow in &phase.inflows {
            names.curve(&inflow.curve, &path.key("inflow").key(&inflow.curve), At::Key);
        }
        for traction in &phase.tractions {
            names.loaded(traction, &path.key("tractions").index(traction.entry).key("on"));
        }
    }
    for (i, entry) in case.output.history.iter().enumerate() {
        if let Some(on) = entry.named() {
            names.history(case, on, &entry.quantities, &root.key("output").key("history").index(i));
        }
    }
    names.issues
}

/// The names of the groups of a mesh, with those of the plates.
fn with_plates(case: &Case, groups: &Groups) -> Groups {
    let mut groups = groups.clone();
    for (name, plate) in case.named_plates() {
        groups.surfaces.push(name.to_owned());
        groups.curves.extend(plate.curves(name));
        groups.points.extend(plate.points.iter().map(|(point, _)| point.clone()));
    }
    groups
}

fn is_wall(case: &Case, name: &str) -> bool {
    case.contacts.iter().any(|contact| matches!(&contact.structure, Touching::Wall(wall) if wall == name))
}

/// Whether that is a rigid structure or a wall.
fn is_rigid(case: &Case, name: &str) -> bool {
    is_wall(case, name) || case.content(name).is_some_and(|content| content.is_rigid())
}

/// Whether a region has a boundary where contact may be.
fn touches(case: &Case, region: usize) -> bool {
    let structure = matches!(case.regions[region].content, Content::Structure { .. });
    structure || case.contacts.iter().any(|contact| contact.on == Touched::Body(region))
}

struct Names<'a> {
    groups: &'a Groups,
    issues: Vec<Issue>,
}

impl Names<'_> {
    /// Whether the mesh has no such surface.
    fn lacks(&self, surface: &str) -> bool {
        !self.groups.surfaces.iter().any(|known| known == surface)
    }

    fn surface(&mut self, name: &str, path: &Path) {
        self.one_of(name, &self.groups.surfaces, "physical surface", path, At::Key);
    }

    fn curve(&mut self, name: &str, path: &Path, at: At) {
        self.one_of(name, &self.groups.curves, "physical curve", path, at);
    }

    /// What bears a load: a curve, or a point with a force.
    fn loaded(&mut self, load: &Traction, path: &Path) {
        let (wanted, others) = match load.force {
            Some(_) => (&self.groups.points, &self.groups.curves),
            None => (&self.groups.curves, &self.groups.points),
        };
        if wanted.contains(&load.curve) || !others.contains(&load.curve) {
            let kind = if load.force.is_some() { "physical point" } else { "physical curve" };
            return self.one_of(&load.curve, wanted, kind, path, At::Value);
        }
        let (problem, remedy) = match load.force {
            Some(_) => (
                "is a physical curve, and a force acts at a point",
                "give `tx` and `ty` (kPa), or name a physical point",
            ),
            None => {
                ("is a physical point, and a traction acts on a curve", "give `fx` and `fy`, the force at the point")
            }
        };
        self.issues.push(Issue::new(path, At::Value, format!("`{}` {problem}", load.curve), remedy));
    }

    /// What is held or moved: a curve, or a rigid structure as a whole.
    fn held(&mut self, case: &Case, name: &str, path: &Path) {
        let is_point = case.plates.iter().flat_map(|plate| &plate.points).any(|(point, _)| point == name);
        if !is_rigid(case, name) && !is_point {
            self.curve(name, path, At::Key);
        }
    }

    /// What the history has of a curve, a point, a region or a rigid structure.
    fn history(&mut self, case: &Case, on: &str, quantities: &[Quantity], path: &Path) {
        let groups = self.groups;
        let has = |names: &[String]| names.iter().any(|name| name == on);
        let bars: Vec<String> = case.bars.iter().map(|bar| bar.name.clone()).collect();
        let known = groups.curves.iter().chain(&groups.points).chain(&groups.surfaces).chain(&bars);
        let kinds = match bars.is_empty() {
            true => "physical curve, physical point or region",
            false => "physical curve, physical point, region or bar",
        };
        self.one_of(on, known, kinds, &path.key("on"), At::Value);
        let (has_nodes, is_surface) = (has(&groups.curves) || has(&groups.points), has(&groups.surfaces));
        let is_bar = has(&bars) && !has_nodes;
        if !has_nodes && !is_surface && !is_bar {
            return;
        }
        let rigid = is_wall(case, on) || !has_nodes && is_rigid(case, on);
        let touches =
            rigid || !has_nodes && case.regions.iter().enumerate().any(|(i, r)| r.name == on && touches(case, i));
        let structures = case.contacts.iter().any(|contact| matches!(contact.structure, Touching::Structure(_)));
        for (i, quantity) in quantities.iter().enumerate() {
            let (problem, remedy) = match quantity {
                quantity if is_bar && *quantity != Quantity::BarForce => {
                    ("of a bar there is the force alone", "write `quantities: [force]`, or name something else")
                }
                Quantity::BarForce if !is_bar => ("only a bar has a force", "take it out, or name an entry of `bars`"),
                Quantity::Section(_) if case.plate(on).is_none() => {
                    ("only a plate has forces in sections", "take it out, or name a region with a `plate`")
                }
                // Whether a curve is one of a structure is known with the mesh.
                Quantity::Contact(_) if structures && has(&groups.curves) => continue,
                Quantity::ContactMoment if structures && has(&groups.curves) && !touches => {
                    ("a curve has contact forces, but no moment", "take it out, or name the structure")
                }
                Quantity::Rotation | Quantity::ReactionMoment if !rigid => (
                    "only a rigid structure turns",
                    "take it out, or name a wall, or a region of kind structure with `rigid: true`",
                ),
                Quantity::Reaction(_) if !has_nodes && !rigid => {
                    ("a region has no reaction", "take it out, or name the curve that is held")
                }
                Quantity::Contact(_) | Quantity::ContactMoment if !touches => (
                    "only a structure has contact",
                    "take it out, or name a structure, a wall, or a region that a contact names under `against`",
                ),
                quantity if quantity.is_of_points() && (has_nodes || rigid) => (
                    "only soil and regions that deform have it",
                    "take it out, or name a region, or give `at`, `box` or `line` in place of `on`",
                ),
                _ => continue,
            };
            self.issues.push(Issue::new(&path.key("quantities").index(i), At::Value, problem, remedy));
        }
    }

    fn one_of<'n>(
        &mut self,
        name: &str,
        known: impl IntoIterator<Item = &'n String> + Clone,
        kind: &str,
        path: &Path,
        at: At,
    ) {
        if known.clone().into_iter().any(|k| k == name) {
            return;
        }
        let mut remedy = suggest(name, known.into_iter().map(String::as_str));
        if self.groups.of == Of::Made {
            remedy.push_str(" (or run `mpm mesh` again, if the .geo has it by now)");
        }
        let problem = format!("{} has no {kind} `{name}`", self.groups.of.name());
        self.issues.push(Issue::new(path, at, problem, remedy));
    }
}
