use std::fs;
use std::path::PathBuf;

use super::*;
use crate::error::Kind;
use crate::io::checkpoint::tests::{same_bits, sample_points};

fn regions() -> Vec<String> {
    vec!["clay_near".to_string(), "sand -- \"lower\" <2> & so --->".to_string()]
}

fn source() -> Source {
    Source { mesh: "1f".to_string(), case: "2e".to_string() }
}

fn written(n: usize, dynamic: bool) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.vtu");
    write(&path, &sample_points(n, dynamic), &regions(), &source()).unwrap();
    (folder, path)
}

#[test]
fn every_bit_and_the_regions_come_back() {
    for (n, dynamic) in [(1, true), (37, false), (1000, true), (0, false)] {
        let (_folder, path) = written(n, dynamic);
        let read = read::<2>(&path).unwrap();
        assert!(same_bits(&read.points, &sample_points(n, dynamic)), "{n} points");
        assert_eq!((read.regions, read.source), (regions(), source()));
    }
}

#[test]
fn a_number_that_is_not_finite_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.vtu");
    let mut points = sample_points(20, false);
    points.stress[13][2] = f64::NAN;
    let e = write(&path, &points, &regions(), &source()).unwrap_err();
    assert_eq!(e.kind, Kind::Analysis);
    assert!(e.to_string().starts_with("material point 13: `stress` is NaN"), "{e}");
    assert!(!path.exists());
}

fn reads_as_error(path: &Path, bytes: &[u8]) -> Error {
    fs::write(path, bytes).unwrap();
    let e = read::<2>(path).unwrap_err();
    assert_eq!(e.kind, Kind::Input);
    assert!(e.to_string().contains("points.vtu") && e.remedy.contains("mpm seed"), "{e}");
    e
}

#[test]
fn a_cut_file_is_an_error_wherever_it_is_cut() {
    let (_folder, path) = written(40, true);
    let bytes = fs::read(&path).unwrap();
    for n in (0..bytes.len()).step_by(97).chain(bytes.len() - 200..bytes.len()) {
        reads_as_error(&path, &bytes[..n]);
    }
    let e = read::<2>(&path.with_file_name("none/points.vtu")).unwrap_err();
    assert!(e.kind == Kind::Input && e.remedy.contains("mpm seed"), "{e}");
    fs::write(&path, bytes).unwrap();
    let e = read::<3>(&path).unwrap_err();
    assert!(e.problem.contains("2 dimensions"), "{e}");
}

#[test]
fn a_changed_byte_is_noticed_wherever_it_is() {
    let (_folder, path) = written(10, true);
    let bytes = fs::read(&path).unwrap();
    for i in (0..bytes.len()).step_by(13).chain(bytes.len() - 300..bytes.len()) {
        for flip in [1, 0x20, 0xff] {
            let mut changed = bytes.clone();
            changed[i] ^= flip;
            fs::write(&path, &changed).unwrap();
            match read::<2>(&path) {
                Err(e) => assert_eq!(e.kind, Kind::Input),
                // The case of a hexadecimal digit in the last line.
                Ok(Seeded { points, regions: names, source: from }) => {
                    assert!(same_bits(&points, &sample_points(10, true)));
                    assert_eq!((names, from), (regions(), source()));
                }
            }
        }
    }
}

/// An edited file whose checksum somebody made right again.
fn edited(path: &Path, change: impl Fn(&str) -> String) -> Error {
    let bytes = fs::read(path).unwrap();
    let (xml, mut trailer) = split_trailer(&bytes).unwrap();
    let xml = change(std::str::from_utf8(xml).unwrap());
    trailer.checksum = trailer_checksum(&trailer, xml.as_bytes());
    let trailer = serde_json::to_string(&trailer).unwrap().replace("--", "-\\u002d");
    let e = reads_as_error(path, format!("{xml}{OPEN}{trailer}{CLOSE}").as_bytes());
    fs::write(path, bytes).unwrap();
    e
}

#[test]
fn an_edited_file_with_a_right_checksum_is_checked_too() {
    let (_folder, path) = written(10, true);
    let e = edited(&path, |xml| xml.replace("Name=\"mass [t]\"", "Name=\"weight\""));
    assert!(e.problem.contains("`mass` is missing"), "{e}");
    let e = edited(&path, |xml| xml.replace("Name=\"cell [-]\"", "Name=\"region [-]\""));
    assert!(e.problem.contains("`region` twice"), "{e}");
    let forged: [(&str, &str, &str); 9] = [
        ("UnstructuredGrid", "PolyData", "unstructured grid"),
        ("</Piece>", "</Piece>\n<Piece>\n<PointData>\n</PointData>\n</Piece>", "`PointData`"),
        ("<Points>", "<Points a=\"\" b=\"\">", "`Points`"),
        ("</PointData>", "<z>\n</z>\n</PointData>", "no array"),
        ("Name=\"mass [t]\" ", "", "without a name"),
        (
            "Name=\"stress [kPa]\" NumberOfComponents=\"6\"",
            "Name=\"stress [kPa]\" NumberOfComponents=\"7\"",
            "`stress`",
        ),
        (
            "Name=\"stress [kPa]\" NumberOfComponents=\"6\"",
            "Name=\"stress [kPa]\" NumberOfComponents=\"0\"",
            "`stress`",
        ),
        ("type=\"Float64\" Name=\"mass", "type=\"Int64\" Name=\"mass", "`mass`"),
        ("Name=\"mass [t]\" format=\"binary\">", "Name=\"mass [t]\" format=\"binary\">AAAA", "`mass`"),
    ];
    for (from, to, problem) in forged {
        let e = edited(&path, |xml| xml.replace(from, to));
        assert!(e.problem.contains(problem), "{from} -> {to}: {e}");
    }
}
