//! The layers of the crate (see the table in `src/lib.rs`): a module imports from its own layer and lower
//! ones only. Also which files alone may name the sparse solver's crate and call foreign code.

mod circles;

use std::fs;
use std::path::{Path, PathBuf};

/// The modules by layer, lowest first.
const LAYERS: [&[&str]; 7] = [
    &[
        "error",
        "expression",
        "geometry",
        "gravity",
        "machine",
        "profile",
        "program",
        "reading",
        "tensor",
        "time_integration",
        "time_value",
        "water_table",
    ],
    &["material", "mesh"],
    &["contact", "dofs", "kinematics", "points", "quadrature", "rigid", "seed", "interpolation", "surface", "system"],
    &["soil", "term"],
    &["draw", "io", "run", "step"],
    &["case", "report"],
    &["cli", "main"],
];

/// Imports within a layer that are not wanted either: a run joins steps and files, which do not know each other,
/// nor the run; pictures do not know how they were computed; meshes and materials have nothing to do with each other.
const APART: [(&str, &str); 11] = [
    ("step", "io"),
    ("io", "step"),
    ("step", "run"),
    ("io", "run"),
    ("step", "draw"),
    ("io", "draw"),
    ("run", "draw"),
    ("draw", "step"),
    ("case", "report"),
    ("mesh", "material"),
    ("material", "mesh"),
];

#[test]
fn modules_import_from_their_own_layer_and_lower_ones() {
    let mut wrong = Vec::new();
    for (file, code) in sources() {
        let module = module(&file);
        let Some(own) = layer(&module) else {
            wrong.push(format!("{}: `{module}` has no layer; give it one in tests/architecture", file.display()));
            continue;
        };
        // The program sees the crate from outside; elsewhere `mpm` may be a module of the scheme.
        let root = if module == "main" { "mpm::" } else { "crate::" };
        for import in imports(&code, root) {
            let allowed = layer(&import).is_some_and(|other| other <= own);
            if !allowed || APART.contains(&(module.as_str(), import.as_str())) {
                wrong.push(format!("{}: `{module}` must not import `{import}`", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let module = |file: &Path| {
        let names = file.strip_prefix(root()).unwrap().with_extension("");
        let mut names: Vec<String> = names.iter().map(|name| name.to_string_lossy().into_owned()).collect();
        names.pop_if(|name| name == "mod");
        names
    };
    let code = sources().into_iter().filter(|(file, _)| !is_of_tests(file));
    let code = code.map(|(file, code)| (module(&file), without_tests(&code).to_owned())).collect();
    let circles = circles::circles(&code);
    assert!(circles.is_empty(), "{circles:#?}");
}

#[test]
fn the_table_of_the_crate_names_every_module_in_its_layer() {
    let text = fs::read_to_string(root().join("lib.rs")).unwrap();
    for (number, modules) in LAYERS.iter().enumerate() {
        let row = text.lines().find(|line| line.starts_with(&format!("//! | {number} |")));
        let row = row.unwrap_or_else(|| panic!("src/lib.rs has no row for layer {number}"));
        for module in modules.iter().filter(|&&module| module != "main") {
            assert!(row.contains(&format!("[`{module}`]")), "`{module}` is not in the row of layer {number}: {row}");
        }
    }
}

#[test]
fn factors_alone_name_the_sparse_solver_and_one_file_calls_gmsh() {
    let holds = |word: &str| {
        let mut files: Vec<String> = sources()
            .into_iter()
            .filter(|(_, code)| words(code).any(|found| found == word))
            .map(|(file, _)| file.strip_prefix(root()).unwrap().display().to_string())
            .collect();
        files.sort();
        files
    };
    assert_eq!(holds("faer"), ["dissection", "lu", "supernodes", "whole"].map(|file| format!("system/{file}.rs")));
    assert_eq!(holds("unsafe"), ["mesh/gmsh/session.rs"]);
    assert_eq!(holds("OUT_DIR"), ["mesh/gmsh/session.rs"], "the bindings that build.rs makes");
    assert_eq!(holds("extern"), [""; 0]);
}

/// Opening a file elsewhere would follow a link to a device, or wait for a pipe. The system's own files are opened where they are named.
#[test]
fn files_are_opened_for_reading_in_one_place() {
    let of_system = ["cli/signals.rs", "io/lock.rs", "machine.rs", "reading.rs"];
    for (file, _) in sources().into_iter().filter(|(file, _)| !is_of_tests(file)) {
        let name = file.strip_prefix(root()).unwrap().display().to_string();
        let text = fs::read_to_string(&file).unwrap();
        let opens = ["File::open(", "fs::read(", "fs::read_to_string("]
            .iter()
            .flat_map(|call| without_tests(&text).matches(call).collect::<Vec<_>>())
            .count();
        // A folder is opened to wait until it is on the disk, and a mesh for the same.
        let to_sync = usize::from(["io/atomic.rs", "mesh/gmsh/session.rs"].contains(&&*name));
        assert!(of_system.contains(&&*name) || opens == to_sync, "{name}: use `crate::reading`");
    }
}

/// Words of the code that have a standard name, and that name.
const REPLACED: [(&str, &str); 29] = [
    ("hat", "contact node or shape function"),
    ("hats", "contact nodes or shape functions"),
    ("guess", "predictor"),
    ("set_out", "first_iterations"),
    ("laid", "initially_closed"),
    ("put_back", "project_onto_boundary"),
    ("let_fall", "switch_to_dynamics"),
    ("let_rest", "switch_to_quasi_static"),
    ("poor", "ill_conditioned"),
    ("SoftCell", "PartlyFilled"),
    ("soft_cells", "partly_filled_cells"),
    ("taking_part", "active"),
    ("per_second", "inverse_dt"),
    ("lean", "conform"),
    ("weighing", "weights"),
    ("stencil", "interpolation"),
    ("Stencil", "Interpolation"),
    ("Patch", "CellPoints"),
    ("clique", "coupling"),
    ("Cliques", "Connectivity"),
    ("Reach", "Extension"),
    ("Beyond", "MatrixFree"),
    ("Share", "Mixed"),
    ("Carried", "MixedPressure"),
    ("Levels", "WaterLevels"),
    ("WaterBond", "PoreStabilisation"),
    ("push_out", "project_out"),
    ("bearer", "host"),
    ("remembers", "internal_variables"),
];

#[test]
fn what_has_a_standard_name_is_called_by_it() {
    let mut wrong = Vec::new();
    for (file, code) in sources() {
        for (word, standard) in REPLACED {
            if words(&code).any(|found| found == word) {
                wrong.push(format!("{}: `{word}` is `{standard}`", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Lines of a file: what is longer is two things.
const LONGEST: usize = 450;

#[test]
fn no_file_is_long() {
    let lines = |(file, code): (PathBuf, String)| (file.display().to_string(), code.lines().count());
    let long: Vec<_> = sources().into_iter().map(lines).filter(|(_, lines)| *lines > LONGEST).collect();
    assert!(long.is_empty(), "{long:?}");
}

#[test]
fn every_number_that_was_chosen_says_what_it_is() {
    let mut wrong = Vec::new();
    for (file, _) in sources().into_iter().filter(|(file, _)| !is_of_tests(file)) {
        let text = fs::read_to_string(&file).unwrap();
        let lines: Vec<&str> = without_tests(&text).lines().map(str::trim).collect();
        for (above, line) in lines.iter().zip(&lines[1.min(lines.len())..]) {
            let line = line.trim_start_matches("pub").trim_start_matches("(super)").trim_start();
            if line.starts_with("const ") && line.contains(": f64 = ") && !above.starts_with("///") {
                wrong.push(format!("{}: {line}", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn imports_are_found_wherever_they_stand() {
    let code = "use crate::{error::{self, Error}, tensor::Tensor};\nuse crate::io::{\n    frame,\n};\n\
        fn f(x: &crate::step::Report) {}\n// crate::case\n    /// [`crate::cli`]\npub(crate) fn g() {}";
    assert_eq!(imports(&without_comments(code), "crate::"), ["error", "tensor", "io", "step"]);
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file but `lib.rs`, without its comments.
fn sources() -> Vec<(PathBuf, String)> {
    let (mut found, mut folders) = (Vec::new(), vec![root()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|kind| kind == "rs") && path != root().join("lib.rs") {
                let code = without_comments(&fs::read_to_string(&path).unwrap());
                found.push((path, code));
            }
        }
    }
    assert!(found.len() > 50, "the sources were not found");
    found
}

/// A line comment ends the code of its line; `//` in a string does too, and costs nothing here.
fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Whether all of a file is tests.
fn is_of_tests(file: &Path) -> bool {
    let parts = file.strip_prefix(root()).unwrap().components();
    parts.into_iter().any(|part| part.as_os_str().to_string_lossy().starts_with("tests"))
}

/// The code before the tests of the file.
fn without_tests(code: &str) -> &str {
    code.split("#[cfg(test)]").next().unwrap_or_default()
}

/// The module of the crate that a file belongs to.
fn module(file: &Path) -> String {
    let first = file.strip_prefix(root()).unwrap().components().next().unwrap();
    first.as_os_str().to_string_lossy().trim_end_matches(".rs").to_owned()
}

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// The modules named behind `root`, in order.
fn imports(code: &str, root: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices(root) {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + root.len()..];
        match rest.strip_prefix('{') {
            Some(group) => found.extend(heads(group)),
            None => found.extend(words(rest).next().map(str::to_owned)),
        }
    }
    found
}

/// The first names of the entries of a `{…}` whose opening brace has been read.
fn heads(group: &str) -> Vec<String> {
    let (mut depth, mut entry, mut heads) = (0, String::new(), Vec::new());
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                heads.extend(words(&std::mem::take(&mut entry)).next().map(str::to_owned));
                continue;
            }
            _ => {}
        }
        entry.push(c);
    }
    heads.extend(words(&entry).next().map(str::to_owned));
    heads
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}
