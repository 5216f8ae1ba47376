//! The contacts of a case: who touches whom, and by which law.

use super::check::Checker;
use super::checked::{Contact, Touched, Touching};
use super::locate::{At, Path};
use super::raw::{self, RegionKind};
use super::structure::suggest;
use crate::contact::Law;

impl Checker {
    pub(super) fn contacts(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<Contact> {
        let mut checked = Vec::new();
        for (i, contact) in file.contacts.iter().enumerate() {
            let path = path.index(i);
            let structure = self.touching(file, contact, &path);
            let on = self.touched(file, contact, &path);
            let law = Law {
                friction: contact.friction,
                adhesion: contact.adhesion,
                factor: contact.adhesion_factor,
                tension: contact.tension.limit(),
            };
            if contact.against.is_some() && contact.adhesion_factor.is_some() {
                let remedy = "give the contact an `adhesion` (kPa)";
                self.issue(&path.key("adhesion_factor"), At::Key, "it is a share of the strength of soil", remedy);
            }
            if let (Some(structure), Some(on)) = (structure, on) {
                checked.push(Contact { name: contact.name.clone(), structure, on, law });
            }
        }
        checked
    }

    /// Whose boundary it is.
    fn touching(&mut self, file: &raw::CaseFile, contact: &raw::Contact, path: &Path) -> Option<Touching> {
        match (&contact.structure, &contact.wall) {
            (Some(name), None) => {
                self.region_of(file, name, &[RegionKind::Structure], &path.key("structure")).map(Touching::Structure)
            }
            (None, Some(curve)) => Some(Touching::Wall(curve.clone())),
            (structure, _) => {
                let what = if structure.is_some() { "both a structure and a wall" } else { "no structure" };
                let remedy = "add `structure: …`, a region of kind structure, or `wall: …`, a physical curve";
                self.issue(path, At::Value, format!("the contact names {what}"), remedy);
                None
            }
        }
    }

    /// What it touches.
    fn touched(&mut self, file: &raw::CaseFile, contact: &raw::Contact, path: &Path) -> Option<Touched> {
        match (&contact.soil, &contact.against) {
            (Some(soil), None) => {
                let names = soil.names().iter();
                let found = names.map(|name| self.region_of(file, name, &[RegionKind::Mpm], &path.key("soil")));
                found.collect::<Option<_>>().map(Touched::Soil)
            }
            (None, Some(name)) => {
                let path = path.key("against");
                if contact.structure.as_ref() == Some(name) {
                    self.issue(&path, At::Value, "a structure does not touch itself", "name another region");
                }
                let kinds = [RegionKind::Structure, RegionKind::Fem];
                self.region_of(file, name, &kinds, &path).map(Touched::Body)
            }
            (soil, _) => {
                let what = if soil.is_some() { "both soil and a body" } else { "nothing that is touched" };
                let remedy = "add `soil: …`, regions of kind mpm, or `against: …`, one of kind structure or fem";
                self.issue(path, At::Value, format!("the contact names {what}"), remedy);
                None
            }
        }
    }

    /// The index of the region called `name`, if it is of one of some kinds.
    fn region_of(&mut self, file: &raw::CaseFile, name: &str, kinds: &[RegionKind], path: &Path) -> Option<usize> {
        let known = || file.regions.iter().filter(|(_, region)| kinds.contains(&region.kind)).map(|(known, _)| known);
        if !known().any(|known| known == name) {
            let words = kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(" or ");
            let problem = match file.regions.get(name) {
                Some(other) => format!("the region `{name}` is of kind {}, not {words}", other.kind.name()),
                None => format!("there is no region `{name}`"),
            };
            let remedy = format!("of kind {words}: {}", suggest(name, known().map(String::as_str)));
            self.issue(path, At::Value, problem, remedy);
            return None;
        }
        file.regions.keys().position(|known| known == name)
    }
}
