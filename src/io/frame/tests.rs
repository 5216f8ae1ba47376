use super::*;
use crate::error::Kind;
use std::fs;

pub(in crate::io) fn sample(k: usize) -> Frame {
    let t = k as f64 * 0.1;
    let x = |i: usize, j: usize| ((i * 31 + j) as f64 * 0.377 + t).sin() * 10_f64.powi((i % 5) as i32 - 2);
    let column = |name: &str, unit: &str, components: usize, n: usize| Column {
        name: name.to_string(),
        unit: unit.to_string(),
        components,
        values: (0..n * components).map(|i| x(i, components)).collect(),
    };
    Frame {
        time: t,
        phase: "push".to_string(),
        step: 3 * k as u64,
        points: Part {
            position: (0..20).map(|i| [x(i, 0), x(i, 1), -0.0]).collect(),
            columns: vec![
                column("displacement", "m", 3, 20),
                column("stress", "kPa", 6, 20),
                column("plastic_strain", "-", 1, 20),
            ],
        },
        origin: Origin { run: Fingerprint::from(7), mesh: 11 },
        grid: Part { position: Vec::new(), columns: vec![column("displacement", "m", 3, 6)] },
        elements: Part::default(),
        contact: Part::default(),
        surface: Part::default(),
    }
}

fn bytes(folder: &Path, index: usize) -> Vec<u8> {
    fs::read(path(folder, index)).unwrap()
}

#[test]
fn frames_come_back_in_order() {
    let folder = tempfile::tempdir().unwrap();
    for k in [2, 0, 11, 1, 3, 4, 5, 6, 7, 8, 9, 10] {
        sample(k).write(folder.path(), k).unwrap();
        assert_eq!(format!("{:?}", Frame::read(&path(folder.path(), k)).unwrap()), format!("{:?}", sample(k)));
    }
    let infos = list(folder.path()).unwrap();
    assert_eq!(infos.len(), 12);
    for (k, info) in infos.iter().enumerate() {
        assert_eq!(info.time.to_bits(), sample(k).time.to_bits());
        assert_eq!((info.step, info.points, info.phase.as_str()), (3 * k as u64, 20, "push"));
    }
    // Written again after a resume: the same bytes.
    let before = bytes(folder.path(), 7);
    prepare(folder.path(), 5).unwrap();
    assert_eq!(list(folder.path()).unwrap().len(), 5);
    sample(7).write(folder.path(), 7).unwrap();
    assert_eq!(bytes(folder.path(), 7), before);
}

#[test]
fn frames_that_do_not_belong_together_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let check = |part: &str| {
        let e = list(folder.path()).unwrap_err();
        assert_eq!(e.kind, Kind::Input);
        assert!(e.to_string().contains(part) && !e.remedy.is_empty(), "{e}");
    };
    check("no result frames");
    sample(0).write(folder.path(), 0).unwrap();
    sample(2).write(folder.path(), 2).unwrap();
    check("frame-000001.mpmf: this frame is missing");
    sample(5).write(folder.path(), 1).unwrap();
    check("frame-000002.mpmf: does not belong");
    let mut foreign = sample(1);
    foreign.origin.mesh += 1;
    foreign.write(folder.path(), 1).unwrap();
    check("it is of another run");
    // Material points may have been split and merged.
    let mut fewer = sample(1);
    fewer.points.position.pop();
    fewer.points.columns.clear();
    fewer.write(folder.path(), 1).unwrap();
    assert_eq!(list(folder.path()).unwrap()[1].points, 19);
    fs::write(path(folder.path(), 1), b"\x89MPM").unwrap();
    check("frame-000001.mpmf: is cut off");
    assert_eq!(list(&folder.path().join("none")).unwrap_err().kind, Kind::Input);
}

#[test]
fn a_value_that_is_not_finite_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut frame = sample(0);
    frame.points.columns[1].values[6 * 8 + 3] = f64::NAN;
    let e = frame.write(folder.path(), 0).unwrap_err();
    assert_eq!(e.kind, Kind::Analysis);
    assert!(e.to_string().starts_with("material point 8: `stress` is NaN"), "{e}");
    let mut frame = sample(0);
    frame.grid.columns[0].values[4] = f64::INFINITY;
    let e = frame.write(folder.path(), 0).unwrap_err();
    assert!(e.to_string().starts_with("grid node 1: `displacement` is inf"), "{e}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn columns_of_different_lengths_are_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut frame = sample(0);
    frame.points.columns[2].values.pop();
    frame.write(folder.path(), 0).unwrap();
    let e = Frame::read(&path(folder.path(), 0)).unwrap_err();
    assert!(e.problem.contains("`plastic_strain` has 19 entries where 20"), "{e}");
}
