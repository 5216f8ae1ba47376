//! Geometries that would execute, write, crash or never end: each gets one message, and nothing happens.

use crate::support::{PROGRAM, in_folder};
use mpm::error::{Error, Kind};
use mpm::mesh::gmsh::{Groups, Options, Worker, sources};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tempfile::TempDir;

/// Six lines; what a test appends stands in the seventh.
const GEO: &str = r#"DefineConstant[ h = {1, Name "Parameters/h"} ];
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("soil") = {1};
// What follows is what a test appends.
"#;

const CASE: &str = "\
title: Block
geometry: plane_strain
mesh: {geo: scene.geo, order: 2, parameters: {h: 1}}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
materials:
  clay: {model: tresca, young: 100, poisson: 0.49, shear_strength: 1, density: 1.8}
phases:
  - {name: load, analysis: quasi_static, duration: 1, step: {initial: 0.5}}
output: {every: 0.5, fields: [stress]}
";

/// Statements that execute or write, and a word of the message. What they make is called canary.
const EXECUTE_OR_WRITE: &[(&str, &str)] = &[
    ("SystemCall \"touch canary\";", "SystemCall executes"),
    ("SystemCall'touch canary';", "SystemCall executes"),
    ("System \"touch canary\";", "System executes"),
    ("SystemCall Str(\"touch canary\");", "SystemCall executes"),
    ("/* harmless */ SystemCall /* and */ \"touch canary\";", "SystemCall executes"),
    ("NonBlockingSystemCall \"touch canary\";", "NonBlockingSystemCall executes"),
    ("OnelabRun(\"x\", \"touch canary\");", "OnelabRun executes"),
    ("OnelabRun \"touch canary\";", "OnelabRun executes"),
    ("Field[1] = ExternalProcess; Field[1].CommandLine = \"touch canary\"; Background Field = 1;", "ExternalProcess"),
    ("Printf(\"x\") > \"canary\";", "Printf writes"),
    ("Printf(\"x\") >> \"canary\";", "Printf writes"),
    ("Printf(\"%g\", 1)\n> \"canary\";", "Printf writes"),
    ("Save \"canary.msh\";", "Save writes"),
    ("Print \"canary.geo_unrolled\";", "Print writes"),
    ("Print StrCat(\"canary\", \".geo_unrolled\");", "Print writes"),
    ("View \"v\" { SP(0,0,0){1}; }; Save View[0] \"canary.pos\";", "Save writes"),
    ("CreateDir \"canary\";", "CreateDir makes"),
    ("Plugin(HomologyComputation).Run;", "Plugin may write"),
    ("General.LogFileName = \"canary\";", "General.LogFileName"),
    ("General.SaveOptions = 1; General.OptionsFileName = \"canary\";", "General.SaveOptions"),
    ("Solver.Executable0 = \"touch canary\";", "Solver"),
    ("StringToName[\"SystemCall\"] \"touch canary\";", "StringToName computes"),
    ("If(0) E\" \nEndIf SystemCall \"touch canary\"; \"", "overlooks"),
    ("If(0) If(1)/*\nEndIf EndIf SystemCall \"touch canary\";\n*/", "overlooks"),
    ("For i In {1:2} /*\nSystemCall \"touch canary\";\n*/\nEndFor", "over several lines"),
];

/// The same in a place of its own: the file it stands in, and how the `.geo` comes to it.
const BY_WAYS: &[(&str, &str)] = &[
    ("scene.geo.opt", ""),
    ("part.geo", "Include \"part.geo\";"),
    ("part.geo", "  Include\n  'part.geo' ;"),
    ("part.txt", "Merge \"part.txt\";"),
    ("part.msh", "Include \"part.msh\";"),
    ("part.dat", "/* */ Include Str(\"part.dat\");"),
    ("part.geo.opt", "Merge \"good.geo\";\nMerge \"part.geo\";"),
    ("part.inc", "If(0)\nInclude \"part.inc\";\nEndIf"),
];

/// Statements that break, stop or mislead Gmsh, and what is said.
const REFUSED: &[(&str, &str)] = &[
    ("Exit;", "Exit ends"),
    ("Abort;", "Abort ends"),
    ("Include \"scene.geo\";", "includes itself"),
    ("Printf(\"%n%n\");", "the conversion %n"),
    ("Printf(\"%s\", 1);", "the conversion %s"),
    ("a = 1; b = Sprintf(\"%99999g\", a);", "the conversion %99999g"),
    ("name = \"good.geo\"; Include name;", "is computed"),
    ("Include StrCat(\"good\", \".geo\");", "is computed"),
    ("Include \"absent.geo\";", "absent.geo"),
    ("Include \"/dev/zero\";", "no regular file"),
    ("Merge \"packed.geo.gz\";", "neither a script"),
    ("Merge \"program.py\";", "neither a script"),
    (
        "x = \"long\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      ......................................................................................................................\
      \";",
        "longer than",
    ),
    ("Include \"good.geo\"; Save\n= 1;", "in another order"),
    ("Macro m\n  a = 1;\nReturn\nCall m; Save\n= 1;", "in another order"),
    ("a = GetEnv(\"HOME\");", "GetEnv reads"),
    ("/* no end", "no end"),
    ("For i In {1:2.0e+8}\nEndFor", "line 7: a range of about 2.0e8 numbers"),
    ("a[] = {0 : -1e8 : -1};", "a range of about 1.0e8 numbers"),
    ("a[] = {2, 0:1:1e-300, 3};", "a range of about 1.0e300 numbers"),
];

/// A folder with a case whose `.geo` ends with `statement`.
fn scene(statement: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let d = folder.path();
    fs::write(d.join("case.yaml"), CASE).unwrap();
    fs::write(d.join("scene.geo"), format!("{GEO}{statement}\n")).unwrap();
    fs::write(d.join("good.geo"), "a = 1;\n").unwrap();
    fs::write(d.join("packed.geo.gz"), "a = 1;\n").unwrap();
    fs::write(d.join("program.py"), "a = 1\n").unwrap();
    folder
}

/// The one message of a run that the input is to blame for.
fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = in_folder(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert_eq!(said.matches("error:").count(), 1, "{arguments:?}: {said}");
    said
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn nothing_is_executed_or_written_by_any_stage() {
    for (statement, says) in EXECUTE_OR_WRITE {
        let folder = scene(statement);
        let before = names(folder.path());
        for command in ["check", "mesh", "run"] {
            let said = refusal(folder.path(), &[command, "."]);
            assert!(said.contains(says) && said.contains("scene.geo, line "), "{statement}: {said}");
            assert_eq!(names(folder.path()), before, "{command}: {statement}");
        }
    }
}

#[test]
fn what_breaks_or_stops_gmsh_is_refused_with_its_place() {
    for (statement, says) in REFUSED {
        let folder = scene(statement);
        let said = refusal(folder.path(), &["check", "."]);
        assert!(said.contains(says), "{statement}: {said}");
        assert!(said.contains(".geo") || said.contains(".py"), "{said}");
    }
}

#[test]
fn files_that_gmsh_opens_by_the_way_are_refused_too() {
    for (file, way) in BY_WAYS {
        for (statement, says) in [EXECUTE_OR_WRITE[0], EXECUTE_OR_WRITE[9]] {
            let folder = scene(way);
            let d = folder.path();
            if file == &"part.geo.opt" {
                fs::write(d.join("part.geo"), "b = 1;\n").unwrap();
            }
            fs::write(d.join(file), format!("\n{statement}\n")).unwrap();
            for command in ["check", "run"] {
                let said = refusal(d, &[command, "."]);
                assert!(said.contains(says) && said.contains(&format!("{file}, line 2")), "{way}: {said}");
            }
            assert!(!d.join("canary").exists(), "{way}");
        }
    }
}

#[test]
fn a_pipe_in_place_of_a_file_does_not_hang() {
    for name in ["scene.geo.opt", "scene.geo"] {
        let folder = scene("");
        let path = folder.path().join(name);
        let _ = fs::remove_file(&path);
        assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
        assert!(refusal(folder.path(), &["check", "."]).contains(name));
    }
}

#[test]
fn honest_scripts_pass() {
    for statement in [
        "// SystemCall \"touch canary\"; Save \"x\";",
        "/* Print \"x\"; */ text = \"SystemCall\";",
        "/*\nSystemCall \"x\";\n*/",
        "Save = 1; If (Save) b = 2; EndIf // a comment",
        "Printf(\"h = %g, %.3f m\", h, 2 > 1);",
        "Include \"good.geo\"; // its constants\nInclude Str(\"good.geo\");\nMerge \"good.geo\";",
        "Mesh.Algorithm = 6; General.Terminal = 0; Print.Background = 1; General.LogFileName = \"\";",
        "Field[1] = MathEval; Field[1].F = \"0.5 + 0 * x\"; Background Field = 1;",
        "For i In {1:3} // three\n  b~{i} = i; // each\nEndFor",
        "// caf\u{e9} 'one quotation mark",
    ] {
        let folder = scene(statement);
        let output = in_folder(folder.path(), &["mesh", "."]);
        assert!(output.status.success(), "{statement}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(names(&folder.path().join("out")), ["mesh.msh", "provenance"], "{statement}");
    }
}

#[test]
fn the_sources_are_all_files_that_gmsh_opens() {
    let folder = scene("Include\n\n'a.geo'; /* x */\nInclude Str(\"b.geo\");\nlist[] = ListFromFile(\"numbers.dat\");");
    let d = folder.path();
    fs::write(d.join("a.geo"), "Merge \"good.geo\"; // Include \"c.geo\";\n").unwrap();
    for file in ["b.geo", "c.geo", "scene.geo.opt", "numbers.dat"] {
        fs::write(d.join(file), "// 1 2 3\n").unwrap();
    }
    let found: Vec<_> = sources(&d.join("scene.geo")).unwrap().files;
    let expected = ["a.geo", "b.geo", "good.geo", "numbers.dat", "scene.geo", "scene.geo.opt"];
    assert_eq!(found, expected.map(|file| d.join(file)));
}

#[test]
fn a_change_of_an_included_file_meshes_again() {
    let folder = scene("Include Str(\"good.geo\");");
    let mesh = || in_folder(folder.path(), &["mesh", "."]);
    assert!(mesh().status.success());
    let run = || String::from_utf8(in_folder(folder.path(), &["run", "."]).stdout).unwrap();
    assert!(run().contains("mesh: nothing has changed"));
    fs::write(folder.path().join("good.geo"), "a = 2;\n").unwrap();
    assert!(!run().contains("mesh: nothing has changed"));
}

#[test]
fn an_option_allows_a_file_that_is_trusted_what_gmsh_does() {
    let folder = scene("SystemCall \"touch canary\";");
    for _ in 0..2 {
        let output = in_folder(folder.path(), &["mesh", ".", "--allow-system-calls"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // In the folder of the process, as Gmsh itself has it; and again, for nobody knows whether it is current.
        fs::remove_file(folder.path().join("canary")).unwrap();
    }
    let said = refusal(folder.path(), &["check", ".", "--allow-system-calls"]);
    assert!(said.contains("unexpected argument") || said.contains("--allow-system-calls"), "{said}");
    for (statement, says) in [("Exit;", "such as Exit"), ("Printf(\"%n%n%n%n\");", "Gmsh crashed")] {
        let folder = scene(statement);
        let said = refusal(folder.path(), &["mesh", ".", "--allow-system-calls"]);
        assert!(said.contains(says), "{said}");
        assert_eq!(names(folder.path()), names(scene(statement).path()));
    }
}

/// A worker without the filter: the sandbox alone.
fn unfiltered<'a>(program: &'a Path, stop: &'a AtomicBool) -> Worker<'a> {
    Worker {
        program,
        seconds: 60,
        memory: 4 << 30,
        analysis: 1 << 40,
        filter: false,
        sandbox: true,
        stop,
        warn: |_| (),
    }
}

fn options() -> Options {
    Options { order: 2, incomplete: false, parameters: vec![] }
}

/// What comes of meshing `statement` in a folder of its own: whether a mesh was made, and the folder.
fn meshed(worker: &Worker, folder: &Path) -> Result<(), Vec<Error>> {
    let scratch = folder.join("scratch");
    fs::create_dir_all(&scratch).unwrap();
    worker.mesh(&folder.join("scene.geo"), &options(), &scratch.join("mesh.msh"), |_: &Groups| Ok(()))
}

fn has_landlock() -> bool {
    // The kernel says so where the security file system is mounted; elsewhere its version has to do.
    let modules = fs::read_to_string("/sys/kernel/security/lsm");
    let release = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let mut numbers = release.split(['.', '-']).filter_map(|n| n.parse::<u32>().ok());
    let version = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    modules.map_or(version >= (6, 2), |modules| modules.contains("landlock"))
}

#[test]
fn the_sandbox_alone_stops_what_the_filter_refuses() {
    if !has_landlock() {
        println!("not tested: this kernel has no Landlock");
        return;
    }
    let (program, stop) = (PathBuf::from(PROGRAM), AtomicBool::new(false));
    // A few wait for a program that never answers.
    let worker = Worker { seconds: 2, ..unfiltered(&program, &stop) };
    for (statement, _) in EXECUTE_OR_WRITE {
        let folder = scene("");
        let d = folder.path();
        let statement = statement.replace("canary", &d.join("canary").display().to_string());
        fs::write(d.join("scene.geo"), format!("{GEO}{statement}\n")).unwrap();
        let before = names(d);
        // Gmsh reports that it could not, or goes on: either way nothing was done.
        let _ = meshed(&worker, d);
        fs::remove_dir_all(d.join("scratch")).unwrap();
        assert_eq!(names(d), before, "{statement}");
    }
    // The same statements do what they say where nothing stops them: the test can tell.
    let folder = scene("SystemCall \"touch canary\";");
    let d = folder.path();
    let text =
        fs::read_to_string(d.join("scene.geo")).unwrap().replace("canary", &d.join("canary").display().to_string());
    fs::write(d.join("scene.geo"), text).unwrap();
    meshed(&Worker { sandbox: false, ..worker }, d).unwrap();
    assert!(d.join("canary").exists());
}

#[test]
fn the_sandbox_reads_the_files_of_the_geometry_alone() {
    if !has_landlock() {
        println!("not tested: this kernel has no Landlock");
        return;
    }
    let (program, stop) = (PathBuf::from(PROGRAM), AtomicBool::new(false));
    let folder = scene("Include \"good.geo\";\nPhysical Surface(\"clay\") = {a};");
    let worker = unfiltered(&program, &stop);
    assert!(meshed(&worker, folder.path()).is_err(), "good.geo was not given to it");
    let folder = scene("Include \"good.geo\";\nb = a;");
    meshed(&Worker { filter: true, ..worker }, folder.path()).unwrap();
    // A link is followed to the file that it names.
    let other = tempfile::tempdir().unwrap();
    fs::rename(folder.path().join("good.geo"), other.path().join("far.geo")).unwrap();
    symlink(other.path().join("far.geo"), folder.path().join("good.geo")).unwrap();
    meshed(&Worker { filter: true, ..worker }, folder.path()).unwrap();
}

#[test]
fn a_mesh_size_that_is_too_small_is_an_error_with_numbers() {
    for (size, says) in [
        ("1e-12", &["point 1", "mesh size 1e-12", "below the tolerance", "larger mesh size"][..]),
        ("1e-9", &["point 1", "mesh size 1e-9", "below the tolerance"]),
        ("1e-8", &["mesh size 1e-8", "segments", "larger mesh size"]),
        ("1e-4", &["about 4.6e8 cells", "GiB", "larger mesh size"]),
    ] {
        let folder = scene("");
        let said = refusal(folder.path(), &["mesh", ".", "--set", &format!("mesh.parameters.h={size}")]);
        assert!(says.iter().all(|part| said.contains(part)), "{size}: {said}");
    }
    // Where an option sets it right again, the size of the points does not count.
    let folder = scene("Mesh.MeshSizeMin = 0.5;");
    assert!(in_folder(folder.path(), &["mesh", ".", "--set", "mesh.parameters.h=1e-12"]).status.success());
}

#[test]
fn the_parent_stops_the_process_and_says_so() {
    let (program, stop) = (PathBuf::from(PROGRAM), AtomicBool::new(false));
    let folder = scene("Sleep 1000;");
    let worker = unfiltered(&program, &stop);
    std::thread::scope(|scope| {
        let work = scope.spawn(|| meshed(&worker, folder.path()));
        std::thread::sleep(Duration::from_millis(300));
        stop.store(true, Ordering::Relaxed);
        let errors = work.join().unwrap().unwrap_err();
        assert_eq!(errors[0].kind, Kind::Interrupted);
    });
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn a_loop_without_end_and_a_list_without_measure_meet_limits() {
        let endless = "Macro again\n  Call again;\nReturn\nCall again;";
        let slow = "d = 1e-300;\nFor i In {0:1:d}\nEndFor";
        for (statement, limit, says) in [
            (slow, ["--mesh-timeout", "1"], &["stopped after 1 s", "--mesh-timeout"][..]),
            ("Sleep 1000;", ["--mesh-timeout", "1"], &["stopped after 1 s", "--mesh-timeout"]),
            (endless, ["--mesh-timeout", "1"], &["scene.geo"]),
            ("n = 1e12; a[] = {1:n};", ["--mesh-memory", "1"], &["scene.geo", "--mesh-memory"]),
            ("n = 1e9; a[] = {1:n};", ["--mesh-memory", "1"], &["scene.geo", "--mesh-memory"]),
        ] {
            let folder = scene(statement);
            for command in ["mesh", "check"] {
                let said = refusal(folder.path(), &[&[command, "."], &limit[..]].concat());
                assert!(says.iter().all(|part| said.contains(part)), "{statement}: {said}");
                assert!(!folder.path().join("out").exists(), "{statement}");
            }
        }
    }
}
