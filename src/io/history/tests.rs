use super::*;
use crate::error::Kind;
use std::fs;

fn columns() -> Vec<String> {
    vec!["time [s]".to_string(), "head, \"left\".uy [m]".to_string()]
}

#[test]
fn a_resumed_history_is_the_undisturbed_one() {
    let folder = tempfile::tempdir().unwrap();
    let place = |i: u32| if i == 12 { None } else { Some(-1e-300 * f64::from(i)) };
    let rows: Vec<[Option<f64>; 2]> = (0..20).map(|i| [Some(f64::from(i) * 0.1), place(i)]).collect();
    let whole = folder.path().join("whole.csv");
    let mut history = History::create(&whole, &columns()).unwrap();
    rows.iter().for_each(|row| history.row(row).unwrap());
    assert_eq!(history.mark().lines, 21);
    let whole = fs::read(&whole).unwrap();
    assert!(whole.starts_with(b"time [s],\"head, \"\"left\"\".uy [m]\"\n0.0,-0.0\n0.1,-1e-300\n"));

    for kept in [0, 1, 7, 12] {
        let path = folder.path().join("cut.csv");
        let mut history = History::create(&path, &columns()).unwrap();
        rows[..kept as usize].iter().for_each(|row| history.row(row).unwrap());
        let mark = history.mark();
        rows[kept as usize..12].iter().for_each(|row| history.row(row).unwrap());
        drop(history);
        // A row that a kill cut short.
        OpenOptions::new().append(true).open(&path).unwrap().write_all(b"1.2000").unwrap();
        let mut history = History::resume(&path, &columns(), mark).unwrap();
        assert_eq!(history.mark().lines, kept + 1);
        rows[kept as usize..].iter().for_each(|row| history.row(row).unwrap());
        assert_eq!(fs::read(&path).unwrap(), whole, "{kept} rows kept");
    }
}

#[test]
fn what_cannot_be_resumed_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    assert_eq!(History::resume(&path, &columns(), Mark::default()).unwrap_err().kind, Kind::Input);
    let mut history = History::create(&path, &columns()).unwrap();
    history.row(&[1.0, 2.0].map(Some)).unwrap();
    let mark = history.mark();
    drop(history);
    for lines in [3, u64::MAX] {
        let e = History::resume(&path, &columns(), Mark { lines, ..mark }).unwrap_err();
        assert!(e.kind == Kind::Input && e.problem.contains("2 whole lines"), "{e}");
    }
    let e = History::resume(&path, &["time [s]".to_string()], mark).unwrap_err();
    assert!(e.kind == Kind::Input && e.to_string().contains("history.csv:1: "), "{e}");
    fs::write(&path, b"").unwrap();
    assert_eq!(History::resume(&path, &columns(), Mark::default()).unwrap_err().kind, Kind::Input);
}

#[test]
fn rows_that_were_changed_are_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    let mut history = History::create(&path, &columns()).unwrap();
    (0..4).for_each(|i| history.row(&[f64::from(i), 2.5].map(Some)).unwrap());
    let mark = history.mark();
    drop(history);
    let whole = fs::read(&path).unwrap();
    for at in 0..whole.len() {
        let mut changed = whole.clone();
        changed[at] ^= 1;
        fs::write(&path, &changed).unwrap();
        assert_eq!(History::resume(&path, &columns(), mark).unwrap_err().kind, Kind::Input, "byte {at}");
        assert_eq!(fs::read(&path).unwrap(), changed, "a file that is refused stays as it is");
    }
    fs::write(&path, &whole).unwrap();
    History::resume(&path, &columns(), mark).unwrap();
}

#[test]
fn a_link_in_place_of_a_log_is_replaced_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let (path, target) = (folder.path().join("solve.log"), folder.path().join("precious"));
    fs::write(&target, b"kept\n").unwrap();
    std::os::unix::fs::symlink(&target, &path).unwrap();
    let mark = Mark { lines: 1, hash: XxHash64::oneshot(0, b"kept\n") };
    assert!(Log::resume(&path, mark).unwrap_err().problem.contains("symbolic link"));
    Log::create(&path).unwrap().line("one").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"kept\n");
    assert_eq!(fs::read(&path).unwrap(), b"one\n");
}

#[test]
fn a_number_that_is_not_finite_names_its_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    let mut history = History::create(&path, &columns()).unwrap();
    let e = history.row(&[0.0, f64::NAN].map(Some)).unwrap_err();
    assert!(e.kind == Kind::Analysis && e.to_string().contains(".uy [m]`: the value is NaN"), "{e}");
    assert_eq!(history.mark().lines, 1);
}

#[test]
fn a_log_is_cut_to_its_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solve.log");
    let mut log = Log::create(&path).unwrap();
    let none = log.mark();
    for text in ["one", "two\nlines"] {
        log.line(text).unwrap();
    }
    let two = log.mark();
    log.line("three").unwrap();
    drop(log);
    let mut log = Log::resume(&path, two).unwrap();
    log.line("four").unwrap();
    assert_eq!((fs::read_to_string(&path).unwrap().as_str(), log.mark().lines), ("one\ntwo lines\nfour\n", 3));
    assert_eq!(Log::resume(&path, none).unwrap().mark(), none);
    assert_eq!(fs::read(&path).unwrap(), b"");
}

#[test]
fn a_full_disk_is_an_error_of_the_machine() {
    if let Ok(file) = OpenOptions::new().write(true).open("/dev/full") {
        let mut log = Log { file, path: "solve.log".into(), lines: 0, hasher: XxHash64::with_seed(0) };
        let e = log.line("one").unwrap_err();
        assert!(e.kind == Kind::Machine && e.remedy.contains("free some space"), "{e}");
    }
}
