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

/// The table of a sweep of the block: its run, one that sank by 10 % more in the end, and one that is not finished.
fn table(last: f64, hostile: &str) -> String {
    format!(
        "run,h,name,state,time [s],block.uy last [m],block.uy min [m],block.uy max [m]\na,1,x,finished,1.0,{last:?},{last:?},0.0\n\
         b,0.5,{hostile},finished,1.0,{:?},{:?},0.0\nc,0.25,x,ended early: no step,0.5,{last:?},{last:?},0.0\nd,0.125,x,not run,,,,\n",
        1.1 * last,
        1.1 * last
    )
}

#[test]
fn the_variants_of_a_sweep_are_shown_with_their_changes() {
    let scene = solved();
    assert!(!page(scene.path(), &[]).contains("What the results depend on"));
    let history = fs::read_to_string(scene.path().join("out/history.csv")).unwrap();
    let k = history.lines().next().unwrap().split(',').position(|name| name == "block.uy [m]").unwrap();
    let last: f64 = history.lines().last().unwrap().split(',').nth(k).unwrap().parse().unwrap();
    assert!(last < 0.0);
    for folder in ["sweep", "other"] {
        fs::create_dir(scene.path().join(folder)).unwrap();
    }
    fs::write(scene.path().join("sweep/table.csv"), table(last, "<script>alert(2)</script>")).unwrap();
    let found = page(scene.path(), &[]);
    assert!(!found.contains("<script") && found.contains("&lt;script&gt;alert(2)&lt;/script&gt;"));
    for text in [
        "What the results depend on",
        "2 of 4 variants are not finished",
        // The most that it changes, and with what.
        "-10.00 %</td><td>h = 0.5, name = &lt;script",
        "+0.00 %</td><td>h = 1, name = x",
        "<td>0.25</td><td>x</td><td>ended early: no step</td>",
        "<td>0.125</td><td>x</td><td>not run</td><td></td><td></td>",
    ] {
        assert!(found.contains(text), "{text}");
    }
    let elsewhere = found.replace("http://www.w3.org/", "");
    assert!(!elsewhere.contains("http://") && !elsewhere.contains("https://"));

    // Values that are none have no change; the table itself may be named.
    let wrong = table(last, "nan").replace(&format!("{:?},{:?},0.0\nc", 1.1 * last, 1.1 * last), "nan,-inf,0.0\nc");
    fs::write(scene.path().join("other/wrong.csv"), wrong).unwrap();
    let found = page(scene.path(), &["--sweep", "other/wrong.csv"]);
    assert!(found.contains("2 values are not finite"), "{found}");
    assert!(found.contains("<td>finished</td><td>NaN</td><td>-</td><td>-inf</td><td>-</td>"));
    assert!(!found.contains("NaN %") && !found.contains("inf %"));

    // A folder that is asked for must have a table of a sweep.
    for (text, problem) in [(None, "table.csv"), (Some("a,b\n1,2\n"), "is not the table of a sweep")] {
        if let Some(text) = text {
            fs::write(scene.path().join("other/table.csv"), text).unwrap();
        }
        let output = in_folder(scene.path(), &["report", ".", "--set", HISTORY, "--sweep", "other"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains(problem), "{}", said(&output));
    }
    // One that happens to be there has a line.
    let whole = fs::read_to_string(scene.path().join("sweep/table.csv")).unwrap();
    for (text, problem) in [
        ("a,b\n1,2\n", "is not the table of a sweep"),
        ("run,h,state\na,1\n", "it is not a table"),
        ("run,h,state,block.uy last [m]\na,1,finished,x\n", "is not numeric"),
    ] {
        fs::write(scene.path().join("sweep/table.csv"), text).unwrap();
        let found = page(scene.path(), &[]);
        assert!(found.contains("The variants cannot be shown: ") && found.contains(problem), "{problem}");
    }
    fs::write(scene.path().join("sweep/table.csv"), whole).unwrap();
    // A case that was changed after it.
    let case = fs::read_to_string(scene.path().join("case.yaml")).unwrap();
    std::thread::sleep(std::time::Duration::from_millis(20));
    fs::write(scene.path().join("case.yaml"), case).unwrap();
    assert!(page(scene.path(), &[]).contains("was changed after the table of its variants"));
}
