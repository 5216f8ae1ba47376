//! Circles between the files of the crate: a file imports what it names, and none of that may lead back to it.
//!
//! A name that a parent only re-exports (`pub use`) is that of the file which has it. A parent that declares its children does not import
//! them; one that names what they have does.

use std::collections::{BTreeMap, BTreeSet};

/// A file by the path of its module in the crate.
type Module = Vec<String>;

/// The imports of each file, given the code of all by module.
struct Imports {
    of: BTreeMap<Module, BTreeSet<Module>>,
}

/// Each circle of files, as their modules.
pub fn circles(code: &BTreeMap<Module, String>) -> Vec<Vec<String>> {
    let imports = Imports::of(code);
    let reach: BTreeMap<&Module, BTreeSet<&Module>> = code.keys().map(|file| (file, imports.reached(file))).collect();
    let mut found: Vec<Vec<String>> = Vec::new();
    let mut seen: BTreeSet<&Module> = BTreeSet::new();
    for file in code.keys() {
        let circle: Vec<&Module> = reach[file].iter().copied().filter(|other| reach[other].contains(file)).collect();
        if !circle.is_empty() && !seen.contains(file) {
            seen.extend(&circle);
            found.push(circle.iter().map(|module| module.join("/")).collect());
        }
    }
    found
}

impl Imports {
    fn of(code: &BTreeMap<Module, String>) -> Self {
        let named: BTreeMap<&Module, Vec<(bool, Module)>> =
            code.iter().map(|(file, text)| (file, named(file, text))).collect();
        let mut exported: BTreeMap<(&Module, &str), &Module> = BTreeMap::new();
        for (&file, paths) in &named {
            for (_, path) in paths.iter().filter(|(public, _)| *public) {
                exported.extend(path.last().map(|name| ((file, name.as_str()), path)));
            }
        }
        // The file that has what a path names, by way of what others re-export.
        let owner = |path: &Module| {
            let mut path = path;
            for _ in 0..8 {
                let file = (1..=path.len()).rev().map(|n| &path[..n]).find(|start| code.contains_key(*start))?;
                let next = path.get(file.len()).and_then(|name| {
                    let (file, _) = code.get_key_value(file)?;
                    exported.get(&(file, name.as_str()))
                });
                match next {
                    Some(next) if *next != path => path = next,
                    _ => return Some(file.to_vec()),
                }
            }
            None
        };
        let of = named.iter().map(|(&file, paths)| {
            let re_exports = |public: bool, path: &Module| public && path.starts_with(file);
            let others = paths.iter().filter(|(public, path)| !re_exports(*public, path));
            (file.clone(), others.filter_map(|(_, path)| owner(path)).filter(|other| other != file).collect())
        });
        Self { of: of.collect() }
    }

    /// All files that a file imports, and those that these import.
    fn reached(&self, file: &Module) -> BTreeSet<&Module> {
        let (mut reached, mut next) = (BTreeSet::new(), vec![file]);
        while let Some(from) = next.pop() {
            for to in self.of.get(from).into_iter().flatten() {
                if reached.insert(to) {
                    next.push(to);
                }
            }
        }
        reached
    }
}

/// What a file names of the crate, as whole paths, and whether it re-exports it.
fn named(file: &Module, text: &str) -> Vec<(bool, Module)> {
    let (mut found, mut rest) = (Vec::new(), String::new());
    let mut children = Vec::new();
    for statement in text.split_inclusive(';') {
        let words: Vec<&str> = statement.trim_end_matches(';').split_whitespace().collect();
        let at = words.iter().rposition(|word| *word == "use" || *word == "mod");
        match at.map(|at| (words[at], &words[at + 1..])) {
            Some(("use", path)) => {
                let public = at.is_some_and(|at| at > 0 && words[at - 1].starts_with("pub"));
                found.extend(expanded(&path.join(" ")).into_iter().map(|path| (public, path)));
            }
            Some((_, [child])) => children.push(*child),
            _ => rest.push_str(statement),
        }
    }
    // Paths in the code itself.
    let part = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':');
    let roots = ["crate", "super"].into_iter().chain(children);
    let roots: Vec<String> = roots.map(|root| format!("{root}::")).collect();
    let paths = rest.split(part).filter(|path| roots.iter().any(|root| path.starts_with(root.as_str())));
    found.extend(paths.map(|path| (false, path.to_owned())));
    found.into_iter().filter_map(|(public, path)| Some((public, absolute(file, &path)?))).collect()
}

/// The paths of a `use` with braces.
fn expanded(tree: &str) -> Vec<String> {
    let Some((root, inner)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or_default();
        return vec![path.trim().to_owned()];
    };
    let (root, inner) = (root.trim(), inner.trim_end().strip_suffix('}').unwrap_or(inner));
    let (mut depth, mut parts) = (0, vec![String::new()]);
    for c in inner.chars() {
        match c {
            ',' if depth == 0 => parts.push(String::new()),
            _ => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                parts.last_mut().unwrap().push(c);
            }
        }
    }
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| expanded(part)).map(|part| format!("{root}{part}")).collect()
}

/// A path from the root of the crate; none where it leads out of it.
fn absolute(file: &Module, path: &str) -> Option<Module> {
    let mut names = path.split("::").filter(|name| !name.is_empty()).peekable();
    let mut module = file.clone();
    match *names.peek()? {
        "crate" => {
            names.next();
            module.clear();
        }
        "self" => {
            names.next();
        }
        "std" | "core" => return None,
        _ => {}
    }
    while names.next_if_eq(&"super").is_some() {
        module.pop()?;
    }
    module.extend(names.map(str::to_owned));
    Some(module)
}

#[test]
fn circles_are_found_by_way_of_what_is_re_exported() {
    let files = [
        ("a", "mod one;\nmod two;\npub use one::One;\npub use two::Two;"),
        ("a/one", "use super::Two;\npub struct One;"),
        ("a/two", "use crate::{\n    a::One as First,\n    tensor,\n};\npub struct Two;"),
        ("b", "mod child;\nfn f() { child::g() }\npub const X: f64 = 0.0;"),
        ("b/child", "use super::X;\npub fn g() {}"),
        ("c", "mod child;\npub use child::g;\nuse crate::a::One;"),
        ("c/child", "use super::super::b::X;\npub fn g() {}"),
    ];
    let code = files.iter().map(|(file, code)| (file.split('/').map(str::to_owned).collect(), code.to_string()));
    assert_eq!(circles(&code.collect()), [vec!["a/one", "a/two"], vec!["b", "b/child"]]);
}
