//! `mpm report`: a page that is whole in itself, of runs that are finished and that are not.

use super::plot::well_formed;
use crate::support::{block, in_folder, said, succeeds};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const TITLE: &str = "title='</title><script>alert(1)</script> & \"block\"'";
const HISTORY: &str = "output.history=[{name: block, on: block, quantities: [ux, uy]}]";

/// A block that has been solved, with a hostile title.
fn solved() -> TempDir {
    let scene = block::scene("1", "0.5", "0.5");
    succeeds(&in_folder(scene.path(), &["run", ".", "--set", HISTORY]));
    scene
}

fn page(folder: &Path, arguments: &[&str]) -> String {
    let arguments = [&["report", ".", "--set", TITLE, "--set", HISTORY], arguments].concat();
    succeeds(&in_folder(folder, &arguments));
    let path = folder.join("out/report.html");
    well_formed(&path);
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_report_of_a_finished_run_has_all_parts_and_loads_nothing() {
    let scene = solved();
    let page = page(scene.path(), &[]);
    assert!(!page.contains("<script") && page.contains("&lt;script&gt;alert(1)"));
    for text in
        ["The run is finished.", "Scene", "young [kPa]", "1000", "linear_elastic", "ux = uy = 0", "restore", "never"]
    {
        assert!(page.contains(text), "{text}");
    }
    for text in
        ["block.uy", "iterations of a step", "solve, finished", "x86_64", "duration [s]", "data:image/png;base64,"]
    {
        assert!(page.contains(text) || text == "x86_64" && page.contains("aarch64"), "{text}");
    }
    let elsewhere = page.replace("http://www.w3.org/", "");
    assert!(!elsewhere.contains("http://") && !elsewhere.contains("https://") && !elsewhere.contains("<link"));
    assert!(!page.contains("has changed since the run"));
}

#[test]
fn a_report_says_that_the_run_is_not_finished_or_the_case_another() {
    let scene = solved();
    let changed = page(scene.path(), &["--set", "materials.rock.young=2000"]);
    assert!(changed.contains("has changed since the run"));
    // As a killed run leaves its record.
    let record = scene.path().join("out/provenance/solve.json");
    let text = fs::read_to_string(&record).unwrap();
    fs::write(&record, text.replace("\"finished\": true", "\"finished\": false")).unwrap();
    let page = page(scene.path(), &[]);
    assert!(
        page.contains("The run is not finished, up to t = 1 s: it is running, or was killed."),
        "{}",
        &page[..3000]
    );
}

#[test]
fn a_report_needs_a_run_and_names_a_page() {
    let scene = block::scene("1", "0.5", "0.5");
    for (arguments, problem) in [(&[][..], "there is no run to report on"), (&["-o", "r.txt"], "a report is HTML")] {
        let output = in_folder(scene.path(), &[&["report", "."], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains(problem), "{}", said(&output));
    }
}

#[test]
fn a_field_that_is_not_there_is_told() {
    let scene = solved();
    let output = in_folder(scene.path(), &["report", ".", "--set", HISTORY, "--field", "temperature"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("temperature"), "{}", said(&output));
}
