//! From keywords to nodes, elements and sets.

use super::keywords::{Block, entries};
use super::model::{Element, Instance, Model, Section, Set, Sets, Surface};
use super::place::{Shift, number};
use super::types::{Type, type_of};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, HashMap};

/// Keywords that make nodes and elements, or read them from elsewhere.
const REFUSED: [&str; 9] =
    ["ngen", "nfill", "ncopy", "nmap", "elgen", "elcopy", "include", "import", "symmetric model generation"];

/// Fills a [`Model`].
pub struct Reader<'a> {
    pub model: Model,
    pub place: &'a str,
    /// Where the instance in hand is.
    pub shift: Shift,
    /// How many members sets may still be given.
    pub left: usize,
    /// The instances, by their names in small letters.
    pub named: HashMap<String, usize>,
    /// How many elements of which type are left out.
    pub unknown: BTreeMap<String, usize>,
}

impl Reader<'_> {
    pub fn wrong(&self, line: usize, problem: impl std::fmt::Display, remedy: &str) -> Error {
        Error::input(format!("{}, line {line}", self.place), problem, remedy)
    }

    /// A new instance, which numbers nodes and elements of its own.
    pub fn instance(&mut self, block: &Block, shift: Shift) -> usize {
        self.shift = shift;
        self.model
            .instances
            .push(Instance { name: block.get("name").unwrap_or_default().to_owned(), ..Instance::default() });
        let (number, key) = (self.model.instances.len() - 1, block.get("name").unwrap_or_default().to_lowercase());
        self.named.insert(key, number);
        number
    }

    /// Takes what a keyword says of an instance.
    ///
    /// # Errors
    /// Input: as [`super::to_msh`].
    pub fn take(&mut self, block: &Block, instance: usize) -> Result<()> {
        let mut elsewhere = ["input", "file"].into_iter().filter(|parameter| block.has(parameter));
        match block.name.as_str() {
            name if REFUSED.contains(&name)
                || matches!(name, "node" | "element" | "nset" | "elset") && elsewhere.next().is_some() =>
            {
                let problem =
                    format!("`*{}` takes nodes or elements from elsewhere, or makes them", name.to_uppercase());
                Err(self.wrong(
                    block.line,
                    problem,
                    "write the file with all nodes and elements in it, as Abaqus/CAE does",
                ))
            }
            "system" if !block.data.is_empty() => {
                Err(self.wrong(block.line, "the nodes are in a system of their own", "write them in that of the model"))
            }
            "node" => self.nodes(block, instance),
            "element" => self.elements(block, instance),
            "nset" | "elset" => self.set(block, instance),
            "surface" => self.surface(block, instance),
            "solid section" | "membrane section" | "shell section" => {
                let [set, material] = ["elset", "material"].map(|key| block.get(key).unwrap_or_default());
                let (set, material) = (set.to_lowercase(), material.to_owned());
                self.model.sections.push(Section { line: block.line, instance, set, material });
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn nodes(&mut self, block: &Block, instance: usize) -> Result<()> {
        if block.get("system").is_some_and(|system| !system.eq_ignore_ascii_case("R")) {
            return Err(self.wrong(block.line, "the nodes are in polar coordinates", "write x, y and z"));
        }
        let mut added = Vec::new();
        for &(line, data) in &block.data {
            let values: Option<Vec<f64>> = entries(data).map(number).collect();
            let is_number = |tag: f64| tag >= 0.0 && tag.fract() == 0.0 && tag < 1e15;
            let (tag, x) = match values.as_deref() {
                Some([tag, x, y]) if is_number(*tag) => (*tag, [*x, *y, 0.0]),
                Some([tag, x, y, z, ..]) if is_number(*tag) => (*tag, [*x, *y, *z]),
                _ => return Err(self.wrong(line, "it is no node: a number with x and y", "mend the line")),
            };
            let index = self.model.nodes.len() as u32;
            if self.model.instances[instance].nodes.insert(tag as u64, index).is_some() {
                return Err(self.wrong(line, format!("node {tag} is there twice"), "number the nodes of a part once"));
            }
            self.model.nodes.push(self.shift.put(x));
            added.push(index);
        }
        self.spend(block.line, added.len())?;
        if let Some(name) = block.get("nset").filter(|name| !name.is_empty()) {
            add(&mut self.model.node_sets, instance, name).members.extend(added);
        }
        Ok(())
    }

    fn elements(&mut self, block: &Block, instance: usize) -> Result<()> {
        let name = block.get("type").unwrap_or_default();
        let kind = match type_of(name) {
            Type::Plane(kind) | Type::Line(kind) => kind,
            Type::Solid => {
                let remedy = "export the mesh of a plane or axisymmetric model (CPE, CAX, CPS)";
                return Err(self.wrong(
                    block.line,
                    format!("elements of type {name} are solid, and mpm takes plane ones"),
                    remedy,
                ));
            }
            Type::Other => {
                *self.unknown.entry(name.to_uppercase()).or_default() += block.data.len();
                return Ok(());
            }
        };
        let own = block.get("elset").filter(|name| !name.is_empty());
        let mut added = Vec::new();
        let mut numbers: Vec<u64> = Vec::new();
        for &(line, data) in &block.data {
            for entry in entries(data) {
                numbers.push(
                    entry
                        .parse()
                        .map_err(|_| self.wrong(line, format!("{entry:?} is no number of a node"), "mend the line"))?,
                );
            }
            // It may go on in the next line.
            if numbers.len() <= kind.node_count() {
                continue;
            }
            let [tag, corners @ ..] = &numbers[..] else { continue };
            if corners.len() > kind.node_count() {
                let problem =
                    format!("element {tag} of type {name} has {} nodes, not {}", corners.len(), kind.node_count());
                return Err(self.wrong(line, problem, "mend the line, or its type"));
            }
            let known = &self.model.instances[instance].nodes;
            let found =
                corners.iter().map(|n| known.get(n).copied().ok_or(n)).collect::<std::result::Result<Vec<u32>, _>>();
            let nodes = found.map_err(|n| {
                self.wrong(line, format!("element {tag} has node {n}, which is not there"), "write the nodes first")
            })?;
            if (1..nodes.len()).any(|i| nodes[..i].contains(&nodes[i])) {
                let remedy = "give it the type of its corners, such as CPE3";
                return Err(self.wrong(line, format!("element {tag} has a node twice"), remedy));
            }
            let index = self.model.elements.len() as u32;
            if self.model.instances[instance].elements.insert(*tag, index).is_some() {
                return Err(self.wrong(
                    line,
                    format!("element {tag} is there twice"),
                    "number the elements of a part once",
                ));
            }
            self.model.elements.push(Element { kind, nodes, number: *tag, instance, own: own.map(str::to_lowercase) });
            added.push(index);
            numbers.clear();
        }
        if !numbers.is_empty() {
            return Err(self.wrong(
                block.line,
                format!("the last element of type {name} lacks nodes"),
                "mend the lines below",
            ));
        }
        self.spend(block.line, added.len())?;
        if let Some(name) = own {
            add(&mut self.model.element_sets, instance, name).members.extend(added);
        }
        Ok(())
    }

    /// The instance whose numbers a keyword of the assembly uses.
    fn numbers_of(&self, block: &Block, instance: usize) -> Result<usize> {
        let Some(name) = block.get("instance") else { return Ok(instance) };
        let found = self.named.get(&name.to_lowercase()).copied();
        found.ok_or_else(|| self.wrong(block.line, format!("there is no instance {name:?}"), "correct the name"))
    }

    fn set(&mut self, block: &Block, instance: usize) -> Result<()> {
        let of_nodes = block.name == "nset";
        let Some(name) = block.get(&block.name).filter(|name| !name.is_empty()) else {
            return Err(self.wrong(block.line, "the set has no name", "add one"));
        };
        let from = self.numbers_of(block, instance)?;
        let mut members = Vec::new();
        if let (true, Some(elements)) = (of_nodes, block.get("elset")) {
            let elements = self.model.element_sets.get(&(from, elements.to_lowercase()));
            let nodes =
                elements.iter().flat_map(|set| &set.members).flat_map(|&e| &self.model.elements[e as usize].nodes);
            members.extend(nodes.copied());
        }
        for &(line, data) in &block.data {
            if block.has("generate") {
                let range: Option<Vec<u64>> = entries(data).map(|entry| entry.parse().ok()).collect();
                let (first, last, by) = match range.as_deref() {
                    Some([first, last]) => (*first, *last, 1),
                    Some([first, last, by]) if *by > 0 => (*first, *last, *by),
                    _ => return Err(self.wrong(line, "it is no range: first, last and step", "mend the line")),
                };
                let numbers =
                    if of_nodes { &self.model.instances[from].nodes } else { &self.model.instances[from].elements };
                if first <= last {
                    let range = numbers.range(first..=last).take(self.left + 1);
                    let before = members.len();
                    let mut passed = 0;
                    members.extend(
                        range.inspect(|_| passed += 1).filter(|(n, _)| (*n - first) % by == 0).map(|(_, index)| *index),
                    );
                    self.spend(line, passed.max(members.len() - before))?;
                }
                continue;
            }
            for entry in entries(data) {
                let before = members.len();
                self.member(entry, from, of_nodes, &mut members)
                    .map_err(|problem| self.wrong(line, problem, "correct the set, or take the entry out"))?;
                self.spend(line, members.len() - before)?;
            }
        }
        let sets = if of_nodes { &mut self.model.node_sets } else { &mut self.model.element_sets };
        let set = add(sets, instance, name);
        set.members.extend(members);
        set.internal |= block.has("internal");
        set.listed = true;
        Ok(())
    }

    /// Counts members of sets, which must not grow as the square of the file.
    fn spend(&mut self, line: usize, members: usize) -> Result<()> {
        match self.left.checked_sub(members) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(self.wrong(
                line,
                "parts or sets stand for the same nodes or elements too often",
                "take parts or sets out that are not needed",
            )),
        }
    }

    /// Adds what an entry of a set stands for: a number, a set, or one of an instance, `Soil-1.5`.
    fn member(
        &self,
        entry: &str,
        from: usize,
        of_nodes: bool,
        members: &mut Vec<u32>,
    ) -> std::result::Result<(), String> {
        let dotted = entry.split_once('.').and_then(|(instance, rest)| {
            self.named.get(&instance.to_lowercase()).filter(|_| !instance.is_empty()).map(|found| (*found, rest))
        });
        let (from, entry) = dotted.unwrap_or((from, entry));
        let (sets, instance) =
            (if of_nodes { &self.model.node_sets } else { &self.model.element_sets }, &self.model.instances[from]);
        let numbers = if of_nodes { &instance.nodes } else { &instance.elements };
        if let Some(set) = sets.get(&(from, entry.to_lowercase())) {
            members.extend(&set.members);
            return Ok(());
        }
        match entry.parse::<u64>() {
            Ok(number) => match numbers.get(&number) {
                Some(&index) => members.push(index),
                // Elements that are left out, and nodes of them alone.
                None if self.unknown.is_empty() => {
                    return Err(format!("there is no {} {number}", if of_nodes { "node" } else { "element" }));
                }
                None => {}
            },
            Err(_) => return Err(format!("there is no set {entry:?} before it")),
        }
        Ok(())
    }

    fn surface(&mut self, block: &Block, instance: usize) -> Result<()> {
        let name = block.get("name").unwrap_or_default().to_owned();
        if block.get("type").is_some_and(|kind| !kind.eq_ignore_ascii_case("ELEMENT")) {
            return Ok(());
        }
        let mut sides = Vec::new();
        for &(line, data) in &block.data {
            let mut words = entries(data);
            let (Some(of), side) = (words.next(), words.next()) else { continue };
            let side = match side.map(|side| side.trim_start_matches(['S', 's', 'E', 'e']).parse::<usize>()) {
                None => None,
                Some(Ok(side @ 1..=4)) => Some(side),
                Some(_) => return Err(self.wrong(line, "it is no side of an element: S1 to S4", "mend the line")),
            };
            let mut members = Vec::new();
            self.member(of, instance, false, &mut members)
                .map_err(|problem| self.wrong(line, problem, "correct the name"))?;
            self.spend(line, members.len())?;
            sides.extend(members.into_iter().map(|element| (element, side)));
        }
        self.model.surfaces.push(Surface { name, instance, sides });
        Ok(())
    }
}

/// The set of that name, made where there is none.
fn add<'a>(sets: &'a mut Sets, instance: usize, name: &str) -> &'a mut Set {
    let set = sets.entry((instance, name.to_lowercase())).or_default();
    if set.name.is_empty() {
        name.clone_into(&mut set.name);
    }
    set
}
