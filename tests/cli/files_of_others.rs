//! Files that mpm has not written stay, and no link leads out of the output folder.

use crate::support::{block, command, errors, in_folder, said, succeeds};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn scene() -> TempDir {
    block::scene("1", "0.5", "0.5")
}

fn refused(output: &Output, parts: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(parts.iter().all(|part| said.contains(part)), "{said}");
}

fn kept(path: &Path) {
    assert_eq!(fs::read_to_string(path).unwrap_or_default(), "years of work", "{}", path.display());
}

/// Writes files of a user, with their folders.
fn write(folder: &Path, names: &[&str]) {
    for name in names {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "years of work").unwrap();
    }
}

#[test]
fn a_folder_is_emptied_only_of_what_mpm_wrote() {
    let others = [
        "work/results/thesis.csv",
        "work/results/frame-1.png",
        "work/checkpoints/notes.txt",
        "work/phases/install.mpms",
        "work/vtu/other.vtu",
        "work/vtu/.hidden",
        "work/unfinished/notes.txt",
        "work/results/deep/notes.txt",
        "work/notes.txt",
    ];
    let scene = scene();
    write(scene.path(), &others);
    let run = |set: &[&str]| in_folder(scene.path(), &[&["run", ".", "-o", "work"], set].concat());
    // The first run, another one in its place, and one that fails beside that and is given up.
    for young in ["1000", "2000"] {
        succeeds(&run(&["--set", &format!("materials.rock.young={young}")]));
        others.iter().for_each(|name| kept(&scene.path().join(name)));
    }
    let failing = ["--set", "numerics.max_iterations=1", "--set", "phases.load.step={initial: 1, min: 1}"];
    assert_eq!(run(&failing).status.code(), Some(1));
    succeeds(&run(&["--set", "materials.rock.young=3000"]));
    others.iter().for_each(|name| kept(&scene.path().join(name)));
    assert!(!scene.path().join("work/.replaced").exists() && !scene.path().join("work/.vtu-old").exists());
}

#[test]
fn files_that_would_be_replaced_and_are_not_of_mpm_are_refused() {
    for (name, stage) in [
        ("mesh.msh", "mesh"),
        ("points.vtu", "seed"),
        ("history.csv", "solve"),
        ("solve.log", "solve"),
        ("unfinished/history.csv", "solve"),
        ("points.pvd", "export"),
        ("vtu/points_000001.vtu", "export"),
    ] {
        let scene = scene();
        write(scene.path(), &[&format!("work/{name}")]);
        for _ in 0..2 {
            let output = in_folder(scene.path(), &["run", ".", "-o", "work"]);
            refused(&output, &[name, "there already", &format!("mpm {stage}"), "-o"]);
            kept(&scene.path().join("work").join(name));
        }
    }
    let folder = super::sweep::scene();
    write(folder.path(), &["block/sweep/table.csv"]);
    let sweep = in_folder(folder.path(), &["sweep", "block", "materials.clay.young=100"]);
    refused(&sweep, &["table.csv", "there already"]);
    kept(&folder.path().join("block/sweep/table.csv"));
}

/// Whatever part of it is a link, nothing is read as a folder of results or written behind it.
#[test]
fn a_link_as_output_folder_is_refused() {
    let home = tempfile::tempdir().unwrap();
    write(home.path(), &["results/thesis.csv", "history.csv", "results/frame-000000.mpmf"]);
    let files = ["results/thesis.csv", "history.csv", "results/frame-000000.mpmf"].map(|name| home.path().join(name));
    let scene = scene();
    symlink(home.path(), scene.path().join("out")).unwrap();
    for command in ["run", "mesh", "seed", "solve", "export", "report", "plot"] {
        let more: &[&str] = if command == "plot" { &["--field", "stress.yy"] } else { &[] };
        refused(&in_folder(scene.path(), &[&[command, "."], more].concat()), &["out", "symbolic link"]);
    }
    for out in ["out/", "out/.", "./out"] {
        refused(&in_folder(scene.path(), &["run", ".", "-o", out]), &["out", "symbolic link"]);
    }
    let folder = super::sweep::scene();
    let (sweep, young) = (folder.path().join("block/sweep"), "materials.clay.young=100");
    fs::create_dir(&sweep).unwrap();
    symlink(home.path(), sweep.join("young=100")).unwrap();
    refused(&in_folder(folder.path(), &["sweep", "block", young]), &["young=100", "symbolic link"]);
    fs::remove_dir_all(&sweep).unwrap();
    symlink(home.path(), &sweep).unwrap();
    for only in [&[][..], &["--only", "young=100"]] {
        refused(&in_folder(folder.path(), &[&["sweep", "block", young], only].concat()), &["sweep", "symbolic link"]);
    }
    files.iter().for_each(|path| kept(path));
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 2);
}

#[test]
fn links_in_place_of_the_series_are_refused() {
    for name in ["vtu", ".vtu-new", ".vtu-old", "unfinished/results", ".replaced/results", "provenance"] {
        let (scene, home) = (scene(), tempfile::tempdir().unwrap());
        write(home.path(), &["thesis.csv", "points_000000.vtu", "frame-000000.mpmf"]);
        let link = scene.path().join("out").join(name);
        fs::create_dir_all(link.parent().unwrap()).unwrap();
        symlink(home.path(), &link).unwrap();
        refused(&in_folder(scene.path(), &["run", "."]), &["symbolic link"]);
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 3, "{name}");
        ["thesis.csv", "points_000000.vtu", "frame-000000.mpmf"].iter().for_each(|file| kept(&home.path().join(file)));
    }
}

/// A file without an end and a pipe that nobody writes to, in place of each file that a command reads.
#[test]
fn files_without_an_end_are_refused_at_once() {
    let scene = scene();
    succeeds(&in_folder(scene.path(), &["run", "."]));
    let frame = "out/results/frame-000000.mpmf";
    for (name, commands) in [
        ("case.yaml", &["check", "run"][..]),
        ("scene.geo", &["check", "mesh"]),
        ("out/mesh.msh", &["seed", "solve", "export", "run"]),
        ("out/points.vtu", &["solve"]),
        (frame, &["export", "report", "run"]),
        ("out/history.csv", &["report", "plot"]),
        ("out/solve.log", &["report", "export"]),
        ("out/provenance/solve.json", &["info", "export"]),
    ] {
        let path = scene.path().join(name);
        let sound = fs::read(&path).unwrap();
        for pipe in [false, true] {
            fs::remove_file(&path).unwrap();
            if pipe {
                assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
            } else {
                symlink("/dev/zero", &path).unwrap();
            }
            for verb in commands {
                // What is refused at once needs no memory; a command that waits is ended.
                let script = "ulimit -v 4000000; exec timeout 20 \"$0\" \"$@\"";
                let mut limited = Command::new("sh");
                limited.args(["-c", script]).arg(command(scene.path(), &[]).get_program()).args([verb, "."]);
                let output = limited.current_dir(scene.path()).env("RAYON_NUM_THREADS", "1").output().unwrap();
                let status = output.status.code();
                assert!(matches!(status, Some(0 | 2 | 3)), "{verb} of {name}: {status:?}: {}", errors(&output));
            }
            if fs::symlink_metadata(&path).is_ok() {
                fs::remove_file(&path).unwrap();
            }
            fs::write(&path, &sound).unwrap();
        }
    }
}

/// Names of a user in tables are texts to a spreadsheet, and names to this program.
#[test]
fn no_heading_is_a_formula() {
    let folder = super::sweep::scene();
    let case = folder.path().join("block/case.yaml");
    let name = "=HYPERLINK(1)";
    let text = fs::read_to_string(&case).unwrap().replace("name: top", &format!("name: '{name}'"));
    fs::write(&case, text).unwrap();
    succeeds(&in_folder(folder.path(), &["sweep", "block", "materials.clay.poisson=0.2,0.3"]));
    for table in ["table.csv", "poisson=0.2/history.csv"] {
        let text = fs::read_to_string(folder.path().join("block/sweep").join(table)).unwrap();
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        for field in reader.records().flat_map(|record| record.unwrap().iter().map(str::to_owned).collect::<Vec<_>>()) {
            let is_text = !field.starts_with(['=', '+', '-', '@']) || field.parse::<f64>().is_ok();
            assert!(is_text, "{table}: {field}");
        }
        assert!(text.contains(&format!("'{name}.uy")), "{text}");
    }
    let listed = in_folder(folder.path(), &["plot", "block/sweep/table.csv", "--list"]);
    assert!(said(&listed).contains(&format!("{name}.uy last")) && !said(&listed).contains('\''), "{}", said(&listed));
}
