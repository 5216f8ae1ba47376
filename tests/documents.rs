//! What the documents say holds: the README's first case runs and its list has every case, every link leads to a file, every script is run, the sources
//! that the theory and the tour name exist, the bill of materials is of what is linked. `manual.rs` has the manual.

use crate::support::{in_folder, python, succeeds};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The text of the first block of code after `heading` that is marked as `language`.
fn block(text: &str, heading: &str, language: &str) -> String {
    let after = &text[text.find(heading).unwrap_or_else(|| panic!("no `{heading}`"))..];
    let start = after.find(&format!("```{language}\n")).unwrap_or_else(|| panic!("no {language} after `{heading}`"));
    let code = &after[start + language.len() + 4..];
    code[..code.find("```").expect("the end of the block")].to_owned()
}

#[test]
fn the_first_case_runs_as_it_is_printed() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bank.geo"), block(&text, "## A first case", "c")).unwrap();
    fs::write(folder.path().join("case.yaml"), block(&text, "## A first case", "yaml")).unwrap();
    for stage in ["check", "run"] {
        succeeds(&in_folder(folder.path(), &[stage, "."]));
    }
    let out = folder.path().join("out");
    let series = fs::read_to_string(out.join("points.pvd")).unwrap();
    assert_eq!(series.matches("<DataSet").count(), 31, "a frame each 0.1 s for 3 s, and the first");
    let log = fs::read_to_string(out.join("solve.log")).unwrap();
    assert!(log.lines().last().unwrap().contains(" fall t 3.000000000 "), "{log}");
}

#[test]
fn the_readme_has_every_case() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let list = &readme[readme.find("| topic | cases |").expect("the list of cases")..];
    for entry in fs::read_dir(root.join("cases")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().to_string_lossy().into_owned();
        let link = format!("](cases/{name}/README.md)");
        assert!(!entry.path().is_dir() || list.contains(&link), "README.md does not list the case {name}");
    }
}

/// The files in `folder` and the folders in it whose names end so, but for what is built or installed.
fn files(folder: &Path, end: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let ours = !name.starts_with('.') && name != "target" && !name.starts_with("out");
        if path.is_dir() && ours {
            files(&path, end, found);
        } else if name.ends_with(end) {
            found.push(path);
        }
    }
}

#[test]
fn every_link_leads_to_a_file() {
    let mut pages = Vec::new();
    files(Path::new(env!("CARGO_MANIFEST_DIR")), ".md", &mut pages);
    assert!(pages.len() > 10, "{pages:?}");
    for file in pages {
        let text = fs::read_to_string(&file).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            let inside = !link.is_empty() && !link.contains("://");
            assert!(!inside || file.with_file_name(link).exists(), "{}: {link} is not there", file.display());
        }
    }
}

/// A script that nothing runs is wrong before long: it is named in a test or the Makefile, or another script imports or starts it.
#[test]
fn every_script_is_run_by_a_test_or_by_make() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut scripts, mut tests) = (Vec::new(), vec![root.join("Makefile")]);
    files(&root.join("cases"), ".py", &mut scripts);
    files(&root.join("benches"), ".py", &mut scripts);
    files(&root.join("tests"), ".rs", &mut tests);
    assert!(scripts.len() > 50, "{scripts:?}");
    let run: String = tests.iter().map(|file| fs::read_to_string(file).unwrap()).collect();
    let sources: Vec<String> = scripts.iter().map(|script| fs::read_to_string(script).unwrap()).collect();
    for (number, script) in scripts.iter().enumerate() {
        let name = script.strip_prefix(root).unwrap().to_str().unwrap();
        let stem = script.file_stem().unwrap().to_str().unwrap();
        let folder = script.parent().unwrap().file_name().unwrap().to_str().unwrap();
        let imports = |line: &str| {
            let line = line.trim_start();
            let import = line.starts_with("import ") || line.starts_with("from ");
            import && line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == stem)
        };
        let used = sources.iter().enumerate().any(|(other, source)| {
            let named = !["run", "study"].contains(&stem) && source.lines().any(imports);
            let started = source.contains(&format!("{folder}/{stem}.py\""));
            let studied = stem == "study" && source.contains(&format!("study(\"{folder}\")"));
            other != number && (named || started || studied)
        });
        // The study of fast flow runs by the folder of its case (`study` of tests/mpm/scripts.rs).
        let case = stem == "study" && run.contains(&format!("study(\"cases/{folder}\""));
        assert!(stem == "__init__" || run.contains(name) || used || case, "nothing runs {name}");
    }
}

#[test]
fn every_source_that_theory_and_tour_name_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for page in ["docs/theory.md", "docs/code-tour.md"] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        let names = text.split('`').filter(|name| name.starts_with("src/") && !name.contains([' ', '*']));
        let missing: BTreeSet<&str> = names.filter(|name| !root.join(name).exists()).collect();
        assert!(missing.is_empty(), "{page} names {missing:?}");
    }
}

#[test]
fn the_bill_of_materials_is_of_what_is_linked() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let check = |file: &Path| {
        let script = root.join("pipeline/sbom.py");
        python().arg(script).arg("--check").arg(file).output().unwrap()
    };
    let file = root.join("docs/sbom.cdx.json");
    let output = check(&file);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    // A list that lacks a crate, or has another version of one, is told with its name.
    let bill: Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    let faer = bill["components"].as_array().unwrap().iter().find(|c| c["name"] == "faer").expect("faer is linked");
    let mut other = bill.clone();
    other["components"].as_array_mut().unwrap().retain(|c| c["name"] != "faer");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.json");
    fs::write(&path, other.to_string()).unwrap();
    let output = check(&path);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("make sbom"), "{said}");
    assert!(said.contains(&format!("+ faer {}", faer["version"].as_str().unwrap())), "{said}");
}

#[test]
fn the_legal_note_has_every_licence() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let note = fs::read_to_string(docs.join("legal.md")).unwrap();
    let bill: Value = serde_json::from_str(&fs::read_to_string(docs.join("sbom.cdx.json")).unwrap()).unwrap();
    for component in bill["components"].as_array().unwrap() {
        let entry = &component["licenses"][0];
        let licence = entry["expression"].as_str().or(entry["license"]["name"].as_str()).expect("a licence");
        assert!(note.contains(&format!("`{licence}`")), "docs/legal.md lacks {licence} of {}", component["name"]);
    }
}
