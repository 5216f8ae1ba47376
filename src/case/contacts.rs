//! The contacts of a case: who touches whom, and by which law.

use super::check::Checker;
use super::checked::{Case, Contact, ContactChange, Phase, Touched, Touching};
use super::locate::{At, Path};
use super::raw::{self, RegionKind};
use super::structure::suggest;
use crate::contact::Law;
use std::collections::BTreeMap;

const OF_SOIL: &str = "it is a share of the strength of soil";

impl raw::Contact {
    pub(super) fn law(&self) -> Law {
        let &Self { friction, adhesion, adhesion_factor: factor, tension, .. } = self;
        Law { friction, adhesion, factor, tension: tension.limit(), sealed: tension.is_sealed() }
    }
}

impl Checker {
    /// The laws that contacts take as a phase begins, given those `now`, by the names of contacts, which they replace.
    pub(super) fn contact_changes(
        &mut self,
        phase: &raw::Phase,
        file: &raw::CaseFile,
        now: &mut BTreeMap<String, Law>,
        path: &Path,
    ) -> Vec<ContactChange> {
        let mut changes = Vec::new();
        for (name, change) in &phase.contacts {
            let path = path.key("contacts").key(name);
            let Some(law) = now.get_mut(name) else {
                let problem = format!("there is no contact with the name `{name}`");
                let remedy = match now.is_empty() {
                    true => "give the entry of `contacts` a `name`".to_owned(),
                    false => suggest(name, now.keys().map(String::as_str)),
                };
                self.issue(&path, At::Key, problem, remedy);
                continue;
            };
            let &raw::ContactChange { friction, adhesion, adhesion_factor, tension } = change;
            if friction.is_none() && adhesion.is_none() && adhesion_factor.is_none() && tension.is_none() {
                let remedy = "add `friction`, `adhesion`, `adhesion_factor` or `tension`, or take it out";
                self.issue(&path, At::Key, "nothing of the contact changes", remedy);
            }
            let factor_path = path.key("adhesion_factor");
            let factor = match adhesion_factor {
                None => law.factor,
                Some(raw::AdhesionFactor::Named(raw::NoFactor::None)) => None,
                Some(raw::AdhesionFactor::Number(share)) => {
                    if !(0.0..=1.0).contains(&share) {
                        let remedy = "give a share from 0 to 1, or `none`";
                        self.issue(&factor_path, At::Value, format!("{share} is no share of the strength"), remedy);
                    }
                    let on_body = |c: &raw::Contact| c.name.as_ref() == Some(name) && c.against.is_some();
                    if file.contacts.iter().any(on_body) {
                        self.issue(&factor_path, At::Key, OF_SOIL, "give the contact an `adhesion` (kPa)");
                    }
                    Some(share)
                }
            };
            *law = Law {
                friction: friction.unwrap_or(law.friction),
                adhesion: adhesion.unwrap_or(law.adhesion),
                factor,
                tension: tension.map_or(law.tension, raw::Tension::limit),
                sealed: tension.map_or(law.sealed, raw::Tension::is_sealed),
            };
            changes.push(ContactChange { name: name.clone(), law: *law });
        }
        changes
    }

    pub(super) fn contacts(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<Contact> {
        let mut checked = Vec::new();
        for (i, contact) in file.contacts.iter().enumerate() {
            let path = path.index(i);
            let structure = self.touching(file, contact, &path);
            let on = self.touched(file, contact, &path);
            let law = contact.law();
            if contact.against.is_some() && contact.adhesion_factor.is_some() {
                self.issue(&path.key("adhesion_factor"), At::Key, OF_SOIL, "give the contact an `adhesion` (kPa)");
            }
            let same = |other: &raw::Contact| contact.name.is_some() && other.name == contact.name;
            if file.contacts[..i].iter().any(same) && file.phases.iter().any(|phase| !phase.contacts.is_empty()) {
                let problem = "two contacts have this name, and phases change contacts by it";
                self.issue(&path.key("name"), At::Value, problem, "give each contact a name of its own");
            }
            if let (Some(structure), Some(on)) = (structure, on) {
                checked.push(Contact { name: contact.name.clone(), structure, on, law });
            }
        }
        checked
    }

    /// What holds soil across curves (`un`): smooth walls that it does not part from.
    pub(super) fn rollers(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<Contact> {
        let mut rollers = Vec::new();
        for (curve, held) in file.supports.iter().filter(|(_, held)| held.un.is_some()) {
            let path = path.key(curve).key("un");
            if file.regions.contains_key(curve) {
                self.issue(&path, At::Key, "a region has no direction", "name a curve, or hold `ux` and `uy`");
            }
            if held.ux.is_some() || held.uy.is_some() || held.rotation.is_some() {
                self.issue(
                    &path,
                    At::Key,
                    "`un` holds the soil across the curve alone",
                    "take it or the other components out",
                );
            }
            if file.contacts.iter().any(|contact| contact.wall.as_ref() == Some(curve)) {
                self.issue(
                    &path,
                    At::Key,
                    format!("`{curve}` is a wall of `contacts`, too"),
                    "take one of the two out",
                );
            }
            if file.mesh.order == Some(3) {
                let problem = "soil is held across curves of cells of first and second order only";
                self.issue(&path, At::Key, problem, "set `order: 2` under `mesh`, or hold `ux` or `uy`");
            }
            let of_kind = |kind: RegionKind| {
                file.regions.values().enumerate().filter(move |(_, region)| region.kind == kind).map(|(index, _)| index)
            };
            let points: Vec<usize> = of_kind(RegionKind::Mpm).collect();
            let soil = (!points.is_empty()).then_some(Touched::Soil(points));
            let law = Law { friction: 0.0, adhesion: 0.0, factor: None, tension: f64::INFINITY, sealed: false };
            rollers.extend(soil.into_iter().chain(of_kind(RegionKind::Fem).map(Touched::Body)).map(|on| Contact {
                name: None,
                structure: Touching::Wall(curve.clone()),
                on,
                law,
            }));
        }
        rollers
    }

    /// Refuses a contact that another one has already, in a phase in which both are there: it would act twice.
    pub(super) fn contacts_twice(&mut self, case: &Case, file: &raw::CaseFile) {
        // Where one is not sound, the numbers of the entries differ.
        if case.contacts.len() != file.contacts.len() {
            return;
        }
        let bodies = |contact: &Contact| match (&contact.structure, &contact.on) {
            (Touching::Structure(a), Touched::Body(b)) => Some([*a.min(b), *a.max(b)]),
            _ => None,
        };
        let is_there = |contact: &Contact, phase: &Phase| {
            let named = match &contact.structure {
                Touching::Structure(region) => &case.regions[*region].name,
                Touching::Wall(curve) => curve,
            };
            !phase.absent.iter().any(|absent| absent == named || contact.name.as_ref() == Some(absent))
        };
        for (i, contact) in case.contacts.iter().enumerate() {
            for (j, other) in case.contacts[..i].iter().enumerate() {
                let name = |region: &usize| format!("`{}`", case.regions[*region].name);
                let common: Vec<String> = match (&contact.on, &other.on) {
                    (Touched::Soil(own), Touched::Soil(others)) if contact.structure == other.structure => {
                        own.iter().filter(|region| others.contains(region)).map(name).collect()
                    }
                    (Touched::Body(body), Touched::Body(others)) => {
                        let same = contact.structure == other.structure && body == others
                            || bodies(contact).is_some() && bodies(contact) == bodies(other);
                        if same { vec![name(body)] } else { Vec::new() }
                    }
                    _ => Vec::new(),
                };
                let together = case.phases.iter().find(|phase| is_there(contact, phase) && is_there(other, phase));
                let Some(phase) = together.filter(|_| !common.is_empty()) else { continue };
                let structure = match &contact.structure {
                    Touching::Structure(region) => name(region),
                    Touching::Wall(curve) => format!("`{curve}`"),
                };
                let problem = format!(
                    "contacts[{j}] has {structure} on {} already: both would act in phase `{}`, the contact twice",
                    common.join(" and "),
                    phase.name
                );
                let remedy = "take one out, or deactivate one of them by its `name` in each phase";
                self.issue(&Path::default().key("contacts").index(i), At::Value, problem, remedy);
            }
        }
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

    /// What it touches: all soil where it does not say.
    fn touched(&mut self, file: &raw::CaseFile, contact: &raw::Contact, path: &Path) -> Option<Touched> {
        let regions = file.regions.values().enumerate();
        let known_soil =
            || regions.clone().filter(|(_, region)| region.kind == RegionKind::Mpm).map(|(index, _)| index);
        match (&contact.soil, &contact.against) {
            (Some(soil), None) => {
                let names = soil.names().iter();
                let found = names.map(|name| self.region_of(file, name, &[RegionKind::Mpm], &path.key("soil")));
                found.collect::<Option<_>>().map(Touched::Soil)
            }
            (None, None) if known_soil().next().is_some() => Some(Touched::Soil(known_soil().collect())),
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
