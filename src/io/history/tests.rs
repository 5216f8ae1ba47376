use super::*;
use crate::error::Kind;

fn columns() -> Vec<String> {
    vec!["time [s]".to_string(), "head, \"left\".uy [m]".to_string()]
}

#[test]
fn a_resumed_history_is_the_undisturbed_one() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<[f64; 2]> = (0..20).map(|i| [f64::from(i) * 0.1, -1e-300 * f64::from(i)]).collect();
    let whole = folder.path().join("whole.csv");
    let mut history = History::create(&whole, &columns()).unwrap();
    rows.iter().for_each(|row| history.row(row).unwrap());
    assert_eq!(history.rows(), 20);
    let whole = fs::read(&whole).unwrap();
    assert!(whole.starts_with(b"time [s],\"head, \"\"left\"\".uy [m]\"\n0.0,-0.0\n0.1,-1e-300\n"));

    for kept in [0, 1, 7, 12] {
        let path = folder.path().join("cut.csv");
        let mut history = History::create(&path, &columns()).unwrap();
        rows[..12].iter().for_each(|row| history.row(row).unwrap());
        drop(history);
        // A row that a kill cut short.
        OpenOptions::new().append(true).open(&path).unwrap().write_all(b"1.2000").unwrap();
        let mut history = History::resume(&path, &columns(), kept).unwrap();
        assert_eq!(history.rows(), kept);
        rows[kept as usize..].iter().for_each(|row| history.row(row).unwrap());
        assert_eq!(fs::read(&path).unwrap(), whole, "{kept} rows kept");
    }
}

#[test]
fn what_cannot_be_resumed_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    assert_eq!(History::resume(&path, &columns(), 0).unwrap_err().kind, Kind::Input);
    History::create(&path, &columns()).unwrap().row(&[1.0, 2.0]).unwrap();
    for rows in [2, u64::MAX] {
        let e = History::resume(&path, &columns(), rows).unwrap_err();
        assert!(e.kind == Kind::Input && e.problem.contains("2 whole lines"), "{e}");
    }
    let e = History::resume(&path, &["time [s]".to_string()], 1).unwrap_err();
    assert!(e.kind == Kind::Input && e.to_string().contains("history.csv:1: "), "{e}");
    fs::write(&path, b"").unwrap();
    assert_eq!(History::resume(&path, &columns(), 0).unwrap_err().kind, Kind::Input);
}

#[test]
fn a_number_that_is_not_finite_names_its_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.csv");
    let mut history = History::create(&path, &columns()).unwrap();
    let e = history.row(&[0.0, f64::NAN]).unwrap_err();
    assert!(e.kind == Kind::Analysis && e.to_string().contains(".uy [m]`: the value is NaN"), "{e}");
    assert_eq!(history.rows(), 0);
}

#[test]
fn a_log_is_cut_to_its_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solve.log");
    let mut log = Log::create(&path).unwrap();
    for text in ["one", "two\nlines", "three"] {
        log.line(text).unwrap();
    }
    drop(log);
    let mut log = Log::resume(&path, 2).unwrap();
    log.line("four").unwrap();
    assert_eq!((fs::read_to_string(&path).unwrap().as_str(), log.lines()), ("one\ntwo lines\nfour\n", 3));
    assert_eq!(Log::resume(&path, 0).unwrap().lines(), 0);
    assert_eq!(fs::read(&path).unwrap(), b"");
}

#[test]
fn a_full_disk_is_an_error_of_the_machine() {
    let full = Path::new("/dev/full");
    if full.exists() {
        let e = History::create(full, &columns()).unwrap_err();
        assert!(e.kind == Kind::Machine && e.remedy.contains("free some space"), "{e}");
    }
}
