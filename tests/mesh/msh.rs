//! Mesh files: text and binary give the same mesh, what is damaged is refused with its place, nothing in a file is
//! executed, and other programs read what `mpm mesh` writes.

use crate::support::{self, in_folder, succeeds};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use mpm::error::{Kind, Result};
use mpm::mesh::Mesh;
use mpm::mesh::faces::Faces;
use mpm::mesh::gmsh::{Options, generate};
use mpm::mesh::msh::{parse, read, seal};
use mpm::mesh::quality;
use mpm::mesh::shape::CellKind;
use tempfile::TempDir;

/// Two triangles beside a quadrilateral, a curve below and a point in a corner.
const SMALL: &str = "\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
0 7 \"corner\"
1 5 \"bottom\"
2 1 \"soil\"
2 2 \"clay\"
$EndPhysicalNames
$Entities
1 1 2 0
1 0 0 0 1 7
1 0 0 0 2 0 0 1 5 0
1 0 0 0 1 1 0 1 2 0
2 1 0 0 2 1 0 1 1 1 1
$EndEntities
$Nodes
1 6 11 16
2 1 0 6
11
12
13
14
15
16
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
4 6 1 6
0 1 15 1
1 11
1 1 1 2
2 11 12
3 12 13
2 1 2 2
4 11 12 15
5 11 15 14
2 2 3 1
6 12 13 16 15
$EndElements
";

const BOX: &str = "\
h = 0.5;
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface(\"soil\") = {1}; Physical Curve(\"bottom\") = {1}; Physical Curve(\"right\") = {2};
Physical Point(\"corner\") = {3};
";

const CASE: &str = "\
title: Box
geometry: plane_strain
mesh: {geo: scene.geo, order: 2}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
materials:
  clay: {model: linear_elastic, young: 100, poisson: 0.3, density: 1}
supports:
  bottom: {ux: 0, uy: 0}
gravity: {y: -9.81}
phases:
  - {name: load, analysis: quasi_static, duration: 1, step: {initial: 1}}
output:
  every: 1
";

/// A command line in a mesh file, which makes the file `executed`.
const SCRIPT: &str = "SystemCall \"touch executed\"; Abort;\n$EndElements\n";

fn python(script: &str, arguments: &[&Path]) -> String {
    let output = support::python().args(["-c", script]).args(arguments).output().unwrap();
    succeeds(&output);
    String::from_utf8(output.stdout).unwrap()
}

/// A folder with the mesh of a `.geo` as `mesh.msh`, not sealed.
fn meshed(geo: &str, order: u8) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (folder.path().join("scene.geo"), folder.path().join("mesh.msh"));
    fs::write(&scene, geo).unwrap();
    let options = Options { order, incomplete: false, parameters: Vec::new() };
    generate(&scene, &options, &out, u64::MAX, &mut |_| Ok(true)).unwrap();
    (folder, out)
}

fn parsed(text: &str) -> Result<Mesh<2>> {
    parse(text.as_bytes(), "out/mesh.msh")
}

/// The message of a failure that is the input's fault.
fn refusal(result: Result<Mesh<2>>) -> String {
    let error = result.unwrap_err();
    assert_eq!(error.kind, Kind::Input, "{error}");
    assert!(!error.remedy.is_empty(), "{error}");
    error.to_string()
}

/// All of a mesh: the text of a number tells every bit of it.
fn bits(mesh: &Mesh<2>) -> String {
    format!("{mesh:?}")
}

#[test]
fn a_small_file_by_hand() {
    let mesh = parsed(SMALL).unwrap();
    assert_eq!(mesh.nodes, [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]);
    // Regions by their numbers: the quadrilateral of surface 2 is in physical surface 1.
    assert_eq!(mesh.regions, ["soil", "clay"]);
    assert_eq!(mesh.cells.kind, [CellKind::Q4, CellKind::T3, CellKind::T3]);
    assert_eq!(mesh.cells.nodes, [1, 2, 5, 4, 0, 1, 4, 0, 4, 3]);
    let (bottom, corner) = (mesh.group("bottom").unwrap(), mesh.group("corner").unwrap());
    assert_eq!(bottom.facets, [(CellKind::Line2, vec![0, 1]), (CellKind::Line2, vec![1, 2])]);
    assert_eq!((corner.dimension, &corner.nodes[..]), (0, &[0][..]));
    quality::check(&mesh, Path::new("mesh.msh")).unwrap();
    let comments = "$Comments\nby hand\n$EndComments\n";
    let more = "$Periodic\n0\n$EndPeriodic\n$NodeData\n$End of nothing\n$EndNodeData\n";
    assert_eq!(bits(&parsed(&format!("\n{comments}{SMALL}{more}{comments}")).unwrap()), bits(&mesh));
    assert_eq!(bits(&parsed(&SMALL.replace('\n', "\r\n")).unwrap()), bits(&mesh));
}

#[test]
fn nodes_without_cells_are_left_out_and_clockwise_cells_turned() {
    let text = SMALL.replace("1 6 11 16\n2 1 0 6\n", "2 7 3 16\n0 1 0 1\n3\n9 9 9\n2 1 0 6\n");
    assert_eq!(bits(&parsed(&text).unwrap()), bits(&parsed(SMALL).unwrap()));
    let turned = parsed(&SMALL.replace("6 12 13 16 15", "6 12 15 16 13")).unwrap();
    assert_eq!(turned.cells.nodes(0), [1, 2, 5, 4]);
    // Tags in any order, a negative number of a group, groups without names.
    let text = SMALL.replace("11\n12\n13", "13\n12\n11").replace("0 0 0\n1 0 0\n2 0 0", "2 0 0\n1 0 0\n0 0 0");
    assert_eq!(bits(&parsed(&text).unwrap()), bits(&parsed(SMALL).unwrap()));
    assert_eq!(bits(&parsed(&SMALL.replace("0 0 1 5 0", "0 0 1 -5 0")).unwrap()), bits(&parsed(SMALL).unwrap()));
    assert_eq!(parsed(&SMALL.replace("\"soil\"", "\"\"")).unwrap().regions, ["1", "clay"]);
    assert_eq!(parsed(&SMALL.replace("2 2 \"clay\"", "2 9 \"clay\"")).unwrap().regions, ["soil", "2"]);
}

/// The sections with numbers of a text file, as binary numbers.
fn binary(text: &str, big_endian: bool) -> Vec<u8> {
    let order = |mut bytes: Vec<u8>| {
        if big_endian {
            bytes.reverse();
        }
        bytes
    };
    let mut out = b"$MeshFormat\n4.1 1 8\n".to_vec();
    out.extend(order(1i32.to_le_bytes().to_vec()));
    out.extend(b"\n$EndMeshFormat\n");
    let section = |name: &str| text.split_once(&format!("${name}\n")).unwrap().1.split_once("$End").unwrap().0;
    out.extend(format!("$PhysicalNames\n{}$EndPhysicalNames\n", section("PhysicalNames")).bytes());
    for name in ["Entities", "Nodes", "Elements"] {
        let mut words = section(name).split_whitespace();
        let mut body = Vec::new();
        // Copies the next words by their types, and returns the last as a count.
        let mut copy = |types: &str| {
            let mut last = 0;
            for kind in types.chars() {
                let word = words.next().unwrap();
                body.extend(order(match kind {
                    'i' => word.parse::<i32>().unwrap().to_le_bytes().to_vec(),
                    'u' => word.parse::<u64>().unwrap().to_le_bytes().to_vec(),
                    _ => word.parse::<f64>().unwrap().to_le_bytes().to_vec(),
                }));
                last = word.parse::<f64>().unwrap() as usize;
            }
            last
        };
        match name {
            "Entities" => {
                let counts = ["u", "u", "u", "u"].map(&mut copy);
                for (dimension, count) in counts.into_iter().enumerate() {
                    for _ in 0..count {
                        let groups = copy(if dimension == 0 { "idddu" } else { "iddddddu" });
                        copy(&"i".repeat(groups));
                        let bounds = if dimension == 0 { 0 } else { copy("u") };
                        copy(&"i".repeat(bounds));
                    }
                }
            }
            _ => {
                let blocks = copy("u");
                copy("uuu");
                for _ in 0..blocks {
                    copy("ii");
                    let kind = copy("i");
                    let count = copy("u");
                    let nodes = [0, 2, 3, 4, 0, 0, 0, 0, 3, 6, 9, 0, 0, 0, 0, 1, 8][kind];
                    match name {
                        "Nodes" => copy(&("u".repeat(count) + &"ddd".repeat(count))),
                        _ => copy(&"u".repeat(count * (1 + nodes))),
                    };
                }
            }
        }
        out.extend(format!("${name}\n").bytes());
        out.extend(body);
        out.extend(format!("\n$End{name}\n").bytes());
    }
    out
}

#[test]
fn text_and_binary_of_both_byte_orders_give_the_same_mesh() {
    let disc = "SetFactory(\"OpenCASCADE\"); Disk(1) = {0, 0, 0, 1}; MeshSize{:} = 0.4; Recombine Surface{:};\n\
                Physical Surface(\"disc\") = {1}; Physical Curve(\"rim\") = {1};\n";
    for (geo, order) in [(BOX, 1), (BOX, 2), (disc, 1), (disc, 2)] {
        let (folder, out) = meshed(geo, order);
        let mesh = bits(&read(&out).unwrap());
        let text = fs::read_to_string(&out).unwrap();
        for big_endian in [false, true] {
            assert_eq!(bits(&parse(&binary(&text, big_endian), "mesh.msh").unwrap()), mesh, "{big_endian}");
        }
        // As Gmsh itself writes it, also with the parameters of nodes on curves and surfaces.
        let other = folder.path().join("binary.msh");
        let script = "import gmsh, sys\n\
                      gmsh.initialize()\n\
                      gmsh.option.setNumber('General.Terminal', 0)\n\
                      gmsh.open(sys.argv[1])\n\
                      gmsh.option.setNumber('Mesh.Binary', 1)\n\
                      gmsh.write(sys.argv[2])";
        python(script, &[&out, &other]);
        assert_eq!(bits(&read(&other).unwrap()), mesh);
    }
}

#[test]
fn other_programs_read_a_sealed_mesh() {
    let (_folder, out) = meshed(BOX, 2);
    let before = bits(&read(&out).unwrap());
    seal(&out).unwrap();
    let mesh = read(&out).unwrap();
    assert_eq!(bits(&mesh), before);
    let said = python(
        "import meshio, sys\n\
         m = meshio.read(sys.argv[1])\n\
         print(sum(len(c.data) for c in m.cells if c.type == 'triangle6'), sorted(m.field_data))",
        &[&out],
    );
    let mut names: Vec<_> = mesh.regions.iter().chain(mesh.groups.iter().map(|g| &g.name)).cloned().collect();
    names.sort();
    let expected = format!("{} {:?}", mesh.cells.len(), names).replace('"', "'");
    assert!(said.trim_end().ends_with(&expected), "{said}");
    let said = python(
        "import gmsh, sys\n\
         gmsh.initialize()\n\
         gmsh.option.setNumber('General.Terminal', 0)\n\
         gmsh.logger.start()\n\
         gmsh.open(sys.argv[1])\n\
         print(gmsh.model.mesh.getElements(2)[1][0].size, [x for x in gmsh.logger.get() if 'Info' not in x])",
        &[&out],
    );
    assert!(said.trim_end().ends_with(&format!("{} []", mesh.cells.len())), "{said}");
}

#[test]
fn a_sealed_mesh_with_any_byte_changed_is_refused_or_the_same() {
    let (_folder, out) = meshed(BOX, 2);
    let unsealed = fs::read(&out).unwrap();
    seal(&out).unwrap();
    let whole = fs::read(&out).unwrap();
    let mesh = bits(&parse(&whole, "mesh.msh").unwrap());
    for at in (0..whole.len()).step_by(11).chain(unsealed.len()..whole.len()) {
        let mut changed = whole.clone();
        changed[at] ^= 1;
        match parse(&changed, "mesh.msh") {
            // White space in the lines of the seal.
            Ok(read) => assert!(at >= unsealed.len() && bits(&read) == mesh, "byte {at}"),
            Err(error) => assert_eq!(error.kind, Kind::Input),
        }
    }
    let text = String::from_utf8(whole).unwrap();
    let changed = text.replacen("\n2 0 0\n", "\n2.1 0 0\n", 1);
    assert_ne!(changed, text);
    assert!(refusal(parsed(&changed)).contains("out/mesh.msh: it was changed after it was written; make the file"));
    assert!(refusal(parsed(&format!("{text}$Periodic\n0\n$EndPeriodic\n"))).contains("changed"));
}

/// What was found in version 0.1.0: other results, a panic where jumps over faces are made, gigabytes of memory.
#[test]
fn a_mesh_with_a_changed_digit_is_refused_or_sound() {
    for geo in [BOX.to_owned(), BOX.to_owned() + "Recombine Surface{1};\n"] {
        let (_folder, out) = meshed(&geo, 2);
        let whole = fs::read(&out).unwrap();
        let (mut refused, mut sound) = (0, 0);
        for (round, at) in (0..whole.len()).filter(|&at| whole[at].is_ascii_digit()).step_by(5).enumerate() {
            let mut changed = whole.clone();
            changed[at] = b"9130e-2 $"[round % 9];
            let result = catch_unwind(AssertUnwindSafe(|| {
                let mesh = parse(&changed, "mesh.msh")?;
                quality::check(&mesh, Path::new("mesh.msh"))?;
                // Jumps of derivatives look for the nodes of a face in both of its cells.
                for face in &Faces::of(&mesh).inner {
                    let [first, second] = face.cells.map(|c| mesh.cells.nodes(c as usize));
                    let facet = mesh.cells.kind[face.cells[0] as usize].facets().1[usize::from(face.sides[0])];
                    assert!(facet.iter().all(|&i| second.contains(&first[i])), "byte {at} in round {round}");
                }
                Ok(())
            }));
            match result.unwrap_or_else(|_| panic!("a panic for a change of byte {at} in round {round}")) {
                Ok(()) => sound += 1,
                Err(error) => {
                    let error: mpm::error::Error = error;
                    assert_eq!(error.kind, Kind::Input, "{error}");
                    refused += 1;
                }
            }
        }
        assert!(refused > 100 && sound > 10, "{refused} refused, {sound} sound");
    }
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    for bytes in [SMALL.as_bytes().to_vec(), binary(SMALL, false)] {
        // Without the line feed at the end it is whole.
        for length in 0..bytes.len() - 1 {
            let message = refusal(parse(&bytes[..length], "mesh.msh"));
            assert!(message.contains("cut short") || message.contains("no mesh file"), "{length}: {message}");
        }
        parse(&bytes[..bytes.len() - 1], "mesh.msh").unwrap();
    }
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let refused = |from: &str, to: &str, said: &str| {
        assert_eq!(SMALL.matches(from).count(), 1, "{from:?}");
        let message = refusal(parsed(&SMALL.replace(from, to)));
        assert!(message.starts_with("out/mesh.msh") && message.contains(said), "{message}\n should say {said}");
    };
    // The file as a whole.
    for text in ["", " \n", SCRIPT, "not a mesh\n", "$Nodes\n1\n$EndNodes\n", "$NOD\n1\n$ENDNOD\n"] {
        assert!(refusal(parsed(text)).contains("no mesh file: its first line is not $MeshFormat"), "{text}");
    }
    let scripted = format!("$Comments\n$EndComments\n{SCRIPT}{SMALL}");
    assert!(refusal(parsed(&scripted)).contains("no mesh file"));
    refused("4.1 0 8", "2.2 0 8", "line 2: it is of MSH version \"2.2\"");
    refused("4.1 0 8", "4 0 8", "save it from Gmsh with Mesh.MshFileVersion = 4.1");
    refused("4.1 0 8", "4.1 0 4", "line 2: a file of type 0 with data size 4");
    refused("$EndMeshFormat\n", "", "line 3: \"$PhysicalNames\" stands where $MeshFormat should end");
    refused("$EndNodes\n", &format!("$EndNodes\n{SCRIPT}"), "is no section");
    refused("$Nodes\n", "$Nods\n", "cut short in its section $Nods");
    refused("$EndNodes\n", "$EndNodes\n$Nodes\n", "line 34: $Nodes is there twice");
    refused("\n$Entities", "\n$Elements\n0 0 0 0\n$EndElements\n$Entities", "$Elements comes before $Nodes");
    assert!(refusal(parse(&[SMALL.as_bytes(), b"\xff"].concat(), "mesh.msh")).contains("is no section"));
    // Names and entities.
    refused("1 5 \"bottom\"", "1 5 bottom", "line 7: \"bottom\" is no name in double quotes");
    refused("1 5 \"bottom\"", "4 5 \"bottom\"", "line 7: there is no dimension 4");
    refused("2 2 \"clay\"", "2 1 \"clay\"", "line 9: physical group 1 of dimension 2 has two names");
    refused("\"clay\"", "\"soil\"", "the physical surfaces have the name soil twice");
    refused("2 1 0 0 2 1 0 1 1 1 1", "1 1 0 0 2 1 0 1 1 1 1", "entity 1 of dimension 2 is there twice");
    refused("2 1 0 0 2 1 0 1 1 1 1", "2 1 0 0 2 1 0 0 1 1", "surface 2: it is in no physical surface");
    refused("2 1 0 0 2 1 0 1 1 1 1", "2 1 0 0 2 1 0 2 1 2 1 1", "surface 2: it is in two physical surfaces, 1 and 2");
    refused("0 0 1 5 0", "0 0 2000000000 5 0", "line 14: it is cut short or damaged: it has no room for 2000000000");
    refused("0 0 1 5 0", "0 x 1 5 0", "line 14: \"x\" stands where a number should be");
    assert!(
        refusal(parsed(&SMALL.replace("0 1 1 1 1\n", "0 0 1 1\n").replace("0 1 2 0\n", "0 0 0\n"))).contains("no phy")
    );
    // Nodes.
    refused("1 6 11 16", "1 7 11 16", "6 nodes instead of 7");
    refused("1 6 11 16", "1 18446744073709551615 11 16", "no room for 18446744073709551615 nodes");
    refused("2 1 0 6", "2 1 0 600000000", "line 20: it is cut short or damaged: it has no room for 600000000 nodes");
    refused("2 1 0 6", "2 1 2 6", "2 stands where 0 or 1 should be");
    refused("14\n15\n16\n", "14\n15\n15\n", "node 15 is there twice");
    refused("2 0 0\n0 1 0\n", "nan 0 0\n0 1 0\n", "line 29: a coordinate is not a finite number");
    refused("2 0 0\n0 1 0\n", "2 0 1e-3\n0 1 0\n", "node 13 at (2, 0, 0.001): it is not in the plane z = 0");
    // Elements.
    refused("4 6 1 6\n", "4 7 1 6\n", "6 elements instead of 7");
    refused("4 6 1 6\n", "4000000000 6 1 6\n", "no room for 4000000000 blocks of elements");
    refused("2 2 3 1\n", "2 2 3 7000000000\n", "no room for 7000000000 elements");
    refused("2 2 3 1\n", "2 2 21 1\n", "elements of Gmsh's type 21; mesh it in two dimensions");
    refused("2 2 3 1\n", "2 2 8 1\n", "Line3 elements of an entity of dimension 2");
    refused("2 2 3 1\n6 12 13 16 15", "2 2 16 1\n6 12 13 16 15 11 14 13 16", "element 6 has node 13 twice");
    refused("4 11 12 15", "4 11 11 15", "element 4 has node 11 twice");
    refused("4 11 12 15", "4 11 17 15", "line 42: element 4 has node 17, which is not there");
    refused("1 1 1 2\n", "1 3 1 2\n", "elements of entity 3 of dimension 1, which is not there");
    refused("2 2 3 1\n", "2 3 3 1\n", "surface 3: it is in no physical surface");
    refused("2 1 2 2\n", "2 2 2 2\n", "its physical surface clay has no cells");
    refused("0 1 15 1\n1 11", "1 1 1 1\n1 11 14", "physical group corner: it has no elements");
    let mixed = SMALL.replace("2 11 12\n3 12 13", "2 11 13 12").replace("1 1 1 2", "1 1 8 1").replace("4 6 1", "4 5 1");
    assert!(refusal(parsed(&mixed)).contains("group bottom: it has Line3 elements beside cells of order 1"));
    let outside =
        SMALL.replace("1 6 11", "1 7 11").replace("2 1 0 6\n", "2 1 0 7\n17\n").replace("16\n0", "16\n5 5 0\n0");
    let message = refusal(parsed(&outside.replace("2 11 12\n", "2 11 17\n")));
    assert!(message.contains("physical group bottom: it has nodes that belong to no cell; embed it"), "{message}");
    // A binary file has no lines.
    let mut bytes = binary(SMALL, false);
    let at = bytes.windows(7).position(|word| word == b"\n$Nodes").unwrap() + 8;
    bytes[at + 7] = 0xff;
    assert!(refusal(parse(&bytes, "mesh.msh")).contains("mesh.msh, section $Nodes: it is cut short or damaged"));
    // The file itself.
    let folder = tempfile::tempdir().unwrap();
    assert!(refusal(read(&folder.path().join("none.msh"))).contains("none.msh"));
    assert!(refusal(read(folder.path())).contains("folder"));
    assert!(refusal(read(Path::new("/dev/zero"))).contains("no regular file"));
}

/// Groups that all hold the same elements would need memory that grows as the square of the file.
#[test]
fn a_curve_in_very_many_groups_is_refused() {
    let groups = 100_000;
    let numbers: String = (1..=groups).map(|i| format!(" {i}")).collect();
    let lines: String = "2 11 12\n3 12 13\n".repeat(10_000);
    let text = SMALL
        .replace("0 0 1 5 0", &format!("0 0 {groups}{numbers} 0"))
        .replace("1 1 1 2\n2 11 12\n3 12 13\n", &format!("1 1 1 20000\n{lines}"))
        .replace("4 6 1 6", "4 20004 1 6");
    assert!(refusal(parsed(&text)).contains("in too many groups"));
}

/// Version 0.1.0 executed the first of these and ended with 0, and went on with other results after the last.
#[test]
fn a_hostile_or_changed_mesh_executes_nothing_in_any_stage() {
    let folder = tempfile::tempdir().unwrap();
    let inside = |name: &str| folder.path().join(name);
    fs::write(inside("scene.geo"), BOX).unwrap();
    fs::write(inside("case.yaml"), CASE).unwrap();
    for command in ["mesh", "seed", "solve", "export"] {
        let output = in_folder(folder.path(), &[command, "case.yaml"]);
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let whole = fs::read_to_string(inside("out/mesh.msh")).unwrap();
    fs::write(inside("real.msh"), &whole).unwrap();
    let changed = whole.replacen("\n2 0 0\n", "\n2.1 0 0\n", 1);
    assert_ne!(changed, whole);
    for mesh in [
        format!("Merge \"{}\"; {SCRIPT}", inside("real.msh").display()),
        format!("{SCRIPT}{whole}"),
        format!("$Comments\n$EndComments\n{SCRIPT}{whole}"),
        whole.replacen("$EndMeshFormat\n", &format!("$EndMeshFormat\n{SCRIPT}"), 1),
        format!("{whole}{SCRIPT}"),
        changed,
    ] {
        fs::write(inside("out/mesh.msh"), mesh).unwrap();
        for command in ["seed", "solve", "export"] {
            let output = in_folder(folder.path(), &[command, "case.yaml"]);
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{command}: {message}");
            assert!(message.contains("mesh.msh") && message.contains("`mpm mesh`"), "{command}: {message}");
            assert!(!inside("executed").exists() && !inside("out/executed").exists(), "{command} executed it");
        }
    }
}
