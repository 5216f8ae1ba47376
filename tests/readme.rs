//! The first case of the README, taken from there, checks and runs.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The text of the first block of code after `heading` that is marked as `language`.
fn block(text: &str, heading: &str, language: &str) -> String {
    let after = &text[text.find(heading).unwrap_or_else(|| panic!("no `{heading}`"))..];
    let start = after.find(&format!("```{language}\n")).unwrap_or_else(|| panic!("no {language} after `{heading}`"));
    let code = &after[start + language.len() + 4..];
    code[..code.find("```").expect("the end of the block")].to_owned()
}

fn mpm(stage: &str, case: &Path) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_mpm")).arg(stage).arg(case).output().unwrap();
    assert!(output.status.success(), "mpm {stage}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

#[test]
fn the_first_case_runs_as_it_is_printed() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bank.geo"), block(&text, "## A first case", "c")).unwrap();
    fs::write(folder.path().join("case.yaml"), block(&text, "## A first case", "yaml")).unwrap();
    mpm("check", folder.path());
    mpm("run", folder.path());
    let out = folder.path().join("out");
    let series = fs::read_to_string(out.join("points.pvd")).unwrap();
    assert_eq!(series.matches("<DataSet").count(), 31, "a frame each 0.1 s for 3 s, and the first");
    let log = fs::read_to_string(out.join("solve.log")).unwrap();
    assert!(log.lines().last().unwrap().contains(" fall t 3.000000000 "), "{log}");
}
