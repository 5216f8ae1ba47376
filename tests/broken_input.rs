//! Broken input: each gets one message with its place and a remedy, exit status 2 or 3, and leaves what was
//! computed before as it was. The table is run through the real program.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use tempfile::TempDir;

const GEO: &str = r#"DefineConstant[ h = {1, Min 1e-6, Name "Parameters/h"} ];
Point(1) = {0, -2, 0, h};
Point(2) = {2, -2, 0, h};
Point(3) = {2, 0, 0, h};
Point(4) = {0, 0, 0, h};
Point(5) = {2, 1, 0, h};
Point(6) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, -3};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("water") = {2};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 4};
Physical Curve("surface") = {3};
Physical Point("corner") = {4};
"#;

const CASE: &str = "\
title: Block
geometry: plane_strain
mesh:
  geo: scene.geo
  order: 2
  parameters: {h: 1}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  water: {kind: buffer}
materials:
  clay: {model: tresca, young: {top: 100, gradient: 10}, poisson: 0.49, shear_strength: 1, density: 1.8}
supports:
  bottom: {ux: 0, uy: 0}
  side: {ux: 0}
gravity: {y: -9.81}
initial_stress: {k0: 0.8}
numerics: {restore: every_step, tolerance: 1.0e-8}
phases:
  - name: load
    analysis: quasi_static
    duration: 1
    step: {initial: 0.1, min: 0.001, max: 0.2}
    prescribe: {surface: {uy: {table: [[0, 0], [1, -0.01]]}}}
output:
  every: 0.5
  fields: [stress, displacement]
  history:
    - {name: head, on: surface, quantities: [uy, reaction_y]}
";

/// A broken input: what is changed in a sound case, and what the program must say to it.
struct Broken {
    change: Change,
    /// The subcommand with its arguments after the case.
    command: &'static [&'static str],
    status: i32,
    /// What the one message contains: the place, the problem and the remedy.
    says: &'static [&'static str],
}

enum Change {
    /// A piece of the case, and what stands in its place.
    Case(&'static str, &'static str),
    /// The same for the `.geo`.
    Geo(&'static str, &'static str),
    /// Something done to the folder of the case.
    Do(fn(&Path)),
    Nothing,
}

use Change::{Case, Do, Geo, Nothing};

const fn check(change: Change, says: &'static [&'static str]) -> Broken {
    Broken { change, command: &["check"], status: 2, says }
}

const fn run(change: Change, command: &'static [&'static str], status: i32, says: &'static [&'static str]) -> Broken {
    Broken { change, command, status, says }
}

/// A second phase that changes a material, before the output.
macro_rules! changed {
    ($change:literal) => {
        concat!(
            "  - {name: on, analysis: quasi_static, duration: 1, step: {initial: 1}, materials: {",
            $change,
            "}}\noutput:"
        )
    };
}

/// The text of the case, its YAML and its keys.
const TEXT: &[Broken] = &[
    check(Do(|d| fs::write(d.join("case.yaml"), "").unwrap()), &["case.yaml", "empty", "mpm schema"]),
    check(Do(|d| fs::write(d.join("case.yaml"), "# nothing\n").unwrap()), &["case.yaml", "empty"]),
    check(Do(|d| fs::write(d.join("case.yaml"), b"title: \xff\n").unwrap()), &["case.yaml:1", "UTF-8", "save"]),
    check(Do(|d| fs::write(d.join("case.yaml"), "- 1\n").unwrap()), &["case.yaml:1:1", "a list", "must be"]),
    check(Do(|d| fs::remove_file(d.join("case.yaml")).unwrap()), &["case.yaml", "cannot be read", "name a case.yaml"]),
    check(Case("{kind: buffer}", "{kind: buffer"), &["case.yaml:10", "mend the YAML"]),
    check(Case("  order: 2", "\torder: 2"), &["case.yaml:5", "mend the YAML"]),
    check(Case("title: Block", "title: \"Block"), &["case.yaml", "mend the YAML"]),
    check(Case("title: Block", "title: a: b"), &["case.yaml:1", "mend the YAML"]),
    check(Case("geometry: plane_strain", "geometry: plane_strain\ngeometry: plane_strain"), &["geometry", "duplicate"]),
    check(Case("  water:", "  soil:"), &["soil", "duplicate"]),
    check(Do(|d| fs::write(d.join("case.yaml"), "[".repeat(100_000)).unwrap()), &["case.yaml:1", "nested", "take"]),
    check(Do(|d| fs::write(d.join("case.yaml"), laughs()).unwrap()), &["case.yaml:7", "aliases repeat", "write fewer"]),
    check(
        Do(|d| fs::write(d.join("case.yaml"), repeated()).unwrap()),
        &["case.yaml:2", "aliases repeat", "write fewer"],
    ),
    check(Do(|d| fs::write(d.join("case.yaml"), " ".repeat(5 << 20)).unwrap()), &["case.yaml", "bytes", "thin"]),
    check(Do(|d| fs::write(d.join("case.yaml"), b"\xff\xfet\0").unwrap()), &["case.yaml", "UTF-16", "as UTF-8"]),
    check(Case("title: Block", "title: Block\0"), &["case.yaml:1:13", "control character, U+0000", "take it out"]),
    check(Case("title: Block", "title: \x1b[2J"), &["case.yaml:1:8", "control character, U+001B", "take it out"]),
    check(Case("name: load", "name: \"lo\\e[31mad\""), &["case.yaml:19:11", "U+001B", "take it out"]),
    check(Case("name: load", "name: \"lo\\nad\""), &["case.yaml:19:11", "line break", "on one line"]),
    check(
        Case("title: Block", "\u{202e}eltit: B"),
        &["case.yaml:1:1 (\\u{202e}eltit)", "unknown key `\\u{202e}eltit`"],
    ),
    check(
        Case("title: Block", "título: 土"),
        &["case.yaml:1:1 (título)", "unknown key `título`", "\n 1 | título: 土\n"],
    ),
    check(Case("{kind: buffer}", "{kind: buffer}\n---\na: 1"), &["case.yaml:10", "more than one document", "keep one"]),
    check(Case("title: Block", "title: !text Block"), &["case.yaml:1", "tag", "without a tag"]),
    check(Case("order: 2", "ordr: 2"), &["case.yaml:5:3 (mesh.ordr)", "unknown key", "did you mean `order`?"]),
    check(Case("numerics:", "numeric:"), &["case.yaml:17:1", "unknown key", "did you mean `numerics`?"]),
    check(
        Case("shear_strength:", "shear_strenght:"),
        &["case.yaml:11", "`shear_strenght`", "did you mean `shear_strength`?"],
    ),
    check(Case("max: 0.2", "maks: 0.2"), &["case.yaml:22", "phases[0].step.maks", "choose from"]),
    check(Case("title: Block", "title: 3"), &["case.yaml:1:8 (title)", "the number 3", "must be text"]),
    check(Case("order: 2", "order: two"), &["case.yaml:5:10 (mesh.order)", "must be a whole number"]),
    check(Case("order: 2", "order: 3"), &["case.yaml:5:10 (mesh.order)", "at most 2"]),
    check(Case("{h: 1}", "{h: fine}"), &["case.yaml:6:19", "the text `fine`", "must be a number"]),
    check(Case("{h: 1}", "[1]"), &["case.yaml:6:15", "a list", "must be"]),
    check(Case("phases:", "phase:"), &["case.yaml:18:1", "did you mean `phases`?"]),
    check(Case("geometry: plane_strain", "# none"), &["case.yaml", "`geometry` is missing", "add `geometry"]),
];

/// What the entries mean.
const MEANING: &[Broken] = &[
    check(Case("plane_strain", "plane_stress"), &["case.yaml:2:11", "`plane_stress`", "did you mean `plane_strain`?"]),
    check(Case("plane_strain", "solid"), &["case.yaml:2:11 (geometry)", "not available yet", "axisymmetric"]),
    check(Case("kind: buffer", "kind: fem"), &["case.yaml:9:3 (regions.water)", "no `material`", "add `material"]),
    check(Case("kind: buffer", "kind: buffer, rigid: true"), &["case.yaml:9", "only a structure can be rigid"]),
    check(Case("kind: buffer", "kind: buffer, material: clay"), &["regions.water.material", "empty", "kind: mpm"]),
    check(Case("material: clay", "material: caly"), &["case.yaml:8:31", "no material `caly`", "did you mean `clay`?"]),
    check(Case(", points_per_cell: 4", ", points_per_cell: 5"), &["case.yaml:8", "5", "choose from `3`, `4`"]),
    check(Case(" material: clay,", ""), &["case.yaml:8:3 (regions.soil)", "no `material`", "add `material"]),
    check(
        Case("soil: {kind: mpm, material: clay, points_per_cell: 4}", "soil: {kind: buffer}"),
        &["(regions)", "no region holds material"],
    ),
    check(Case("model: tresca", "model: trescka"), &["case.yaml:11:17", "`trescka`", "did you mean `tresca`?"]),
    check(Case("poisson: 0.49", "poisson: 0.5"), &["case.yaml:11:67", "0.5", "0.49"]),
    check(Case("{top: 100, gradient: 10}", "-100"), &["case.yaml:11:32", "-100 is not positive"]),
    check(Case("top: 100", "top: .nan"), &["case.yaml:11", "not a finite number", "write a number"]),
    check(Case("top: 100", "top: 1e999"), &["case.yaml:11", "must be a number"]),
    check(Case("gradient: 10", "gradient: -10"), &["case.yaml:11", "young.gradient", "at least 0"]),
    check(Case("shear_strength: 1,", ""), &["case.yaml:11:3 (materials.clay)", "tresca needs `shear_strength`", "add"]),
    check(Case("shear_strength: 1", "shear_strength: 0"), &["shear_strength", "0 is not positive"]),
    check(
        Case("poisson: 0.49", "poisson: 0.49, cohesion: 1"),
        &["materials.clay.cohesion", "tresca has no `cohesion`", "take it out"],
    ),
    check(Case(", density: 1.8", ""), &["case.yaml:11:3", "neither `density` nor `unit_weight`", "t/m³"]),
    check(Case("density: 1.8", "density: 1.8, unit_weight: 18"), &["unit_weight", "both", "keep one"]),
    check(Case("density: 1.8", "density: -1.8"), &["materials.clay.density", "-1.8", "at least 0"]),
    check(Case("side: {ux: 0}", "side: {ux: 0.1}"), &["case.yaml:14:14", "does not move", "prescribe"]),
    check(Case("side: {ux: 0}", "side: {}"), &["case.yaml:14:3", "nothing is held", "ux: 0"]),
    check(Case("gravity: {y: -9.81}", "gravity: {x: 1, y: -9.81}"), &["case.yaml:15", "vertical gravity"]),
    check(Case("gravity: {y: -9.81}", "gravity: 9.81"), &["case.yaml:15:10", "the number 9.81", "{x, y}"]),
    check(Case("k0: 0.8", "k0: -1"), &["case.yaml:16:22", "at least 0"]),
    check(
        Case("restore: every_step", "restore: sometimes"),
        &["case.yaml:17", "`sometimes`", "choose from `every_step`, `never`"],
    ),
    check(Case("restore: every_step", "restore: {min_quality: 1.3}"), &["case.yaml:17", "at most 1"]),
    check(Case("restore: every_step", "gradient: gimp"), &["case.yaml:17", "no gradient `gimp`", "mpm or ddmp"]),
    check(Case("tolerance: 1.0e-8", "tolerance: 0.5"), &["case.yaml:17", "numerics.tolerance", "at most 0.01"]),
    check(
        Case("density: 1.8", "density: 0"),
        &["case.yaml:11", "materials.clay.density", "nothing has weight", "take `gravity`"],
    ),
    run(
        Nothing,
        &[
            "check",
            "--set",
            "regions.water={kind: structure, material: steel}",
            "--set",
            "materials.steel={model: linear_elastic, young: 1.0e+8, poisson: 0.2, density: 7.8}",
            "--set",
            "materials.clay.density=0",
        ],
        2,
        &["materials.clay.density", "soil without weight", "initial_stress", "above 0"],
    ),
    check(
        Case("gravity: {y: -9.81}", "gravity: {y: 9.81}"),
        &["case.yaml:15:14 (gravity.y)", "points down", "negative"],
    ),
    check(Case("tolerance: 1.0e-8", "tolerance: 0"), &["case.yaml:17", "numerics.tolerance", "above 0"]),
    check(
        Case("quasi_static", "consolidation"),
        &["case.yaml:20", "no material has a permeability", "choose quasi_static"],
    ),
    check(Case("duration: 1", "duration: -1"), &["case.yaml:21:15", "above 0"]),
    check(Case("initial: 0.1", "initial: 0"), &["case.yaml:22", "above 0"]),
    check(Case("min: 0.001", "min: 0.5"), &["phases[0].step.min", "above `initial`", "lower `min`"]),
    check(Case("[1, -0.01]]", "[0, -0.01]]"), &["case.yaml:23", "does not come after", "sort the table"]),
    check(Case("[1, -0.01]]", "[1]]"), &["case.yaml:23", "1 items", "must have 2"]),
    check(
        Case("{table: [[0, 0], [1, -0.01]]}", "{tabel: [[0, 0], [1, -0.01]]}"),
        &["unknown key `tabel`", "did you mean `table`?"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{on: surface, ty: -1}]\n    prescribe:"),
        &["tractions[0].on", "restore: never"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{on: surface, surface: all, ty: -1}]\n    prescribe:"),
        &["tractions[0]", "one of the two", "`surface`"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{surface: sol, ty: -1}]\n    prescribe:"),
        &["tractions[0].surface", "not a region of kind mpm", "did you mean `soil`?"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{surface: all}]\n    prescribe:"),
        &["tractions[0]", "there is no load", "add `pressure"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{surface: all, ty: -1, where: {x: [1, 0]}}]\n    prescribe:"),
        &["tractions[0].where.x", "is empty", "smaller one first"],
    ),
    check(
        Case("    prescribe:", "    tractions: [{surface: all, pressure: 1, factor: 2}]\n    prescribe:"),
        &["tractions[0].factor", "grows with depth"],
    ),
    check(
        Case("    prescribe:", "    water_level: 1\n    prescribe:"),
        &["phases[0].water_level", "no water", "add `water"],
    ),
    check(Case("gravity: {y: -9.81}", "water: {level: 1, unit_weight: 0}"), &["water.unit_weight", "above 0"]),
    check(
        Case("side: {ux: 0}", "surface: {uy: 0}"),
        &["prescribe.surface.uy", "held in this direction", "take `uy` out"],
    ),
    check(Case("every: 0.5", "every: 0"), &["case.yaml:25", "output.every", "above 0"]),
    check(Case("[stress, displacement]", "[stress, stress]"), &["case.yaml:26", "named twice"]),
    check(Case("[stress, displacement]", "[strain]"), &["case.yaml:26", "`strain`"]),
    check(Case("[uy, reaction_y]", "[]"), &["case.yaml:28", "0 items", "at least 1"]),
    check(Case("[uy, reaction_y]", "[uz]"), &["case.yaml:28", "`uz`", "choose from `ux`"]),
    check(
        Case("gravity: {y: -9.81}", "initial_velocity: {soil: {velocity: {x: 1}}}"),
        &["initial_velocity.soil", "no phase is dynamic"],
    ),
    check(
        Case("    prescribe: {surface", "    materials: {soil: clay}\n    prescribe: {surface"),
        &["case.yaml:23", "phases[0].materials.soil", "first phase begins with the materials of `regions`"],
    ),
    check(
        Case("    prescribe: {surface", "    phreatic_level: 1\n    prescribe: {surface"),
        &["case.yaml:23", "phases[0].phreatic_level", "no water with a `phreatic_level`", "or take it out"],
    ),
    check(
        Case("gravity:", "water: {unit_weight: 10}\ngravity:"),
        &["case.yaml:15", "the water has no level", "phreatic_level"],
    ),
    check(Case("output:", changed!("sol: clay")), &["case.yaml:24", "no region `sol`", "did you mean `soil`?"]),
    check(Case("output:", changed!("soil: caly")), &["no material `caly`", "did you mean `clay`?"]),
    check(Case("output:", changed!("water: clay")), &["materials.water", "a buffer region holds no material"]),
    check(Case("output:", changed!("soil: clay")), &["phases[1].materials.soil", "`clay` already", "take it out"]),
];

/// The `.geo` and its groups.
const GEOMETRY: &[Broken] = &[
    check(
        Case("geo: scene.geo", "geo: scenery.geo"),
        &["case.yaml:4:8", "no file", "scenery.geo", "relative to the case"],
    ),
    check(Case("{h: 1}", "{g: 1}"), &["scene.geo", "no DefineConstant for the parameter g", "it declares h"]),
    check(
        Case("  bottom: {ux", "  botom: {ux"),
        &["case.yaml:13:3", "no physical curve `botom`", "did you mean `bottom`?"],
    ),
    check(Case("  water:", "  wate:"), &["case.yaml:9:3", "no physical surface `wate`", "did you mean `water`?"]),
    check(Case("  water: {kind: buffer}\n", ""), &["(regions)", "surface `water`", "add `water: {kind: buffer}`"]),
    check(Case("{surface: {uy", "{surfase: {uy"), &["case.yaml:23", "no physical curve `surfase`", "`surface`?"]),
    check(Case("on: surface", "on: somewhere"), &["case.yaml:28", "`somewhere`", "choose from"]),
    check(Case("on: surface", "on: soil"), &["case.yaml:28", "a region has no reaction", "take it out"]),
    check(
        Case("[uy, reaction_y]", "[uy, contact_y]"),
        &["case.yaml:28", "only a structure has contact", "a wall, or a region that a contact names under `against`"],
    ),
    check(
        Case("[uy, reaction_y]", "[uy, rotation]"),
        &["case.yaml:28", "only a rigid structure turns", "name a wall, or a region of kind structure"],
    ),
    check(Geo("Line(1) = {1, 2};", "Line(1) = {1, 2;"), &["scene.geo, line 8", "syntax error", "correct the file"]),
    check(Geo("Line(1) = {1, 2};", "Line(1) = {1, 99};"), &["scene.geo", "99"]),
    check(Geo("Physical Surface(\"water\") = {2};", ""), &["scene.geo, surface 2", "no physical surface", "add it"]),
    run(Geo("Curve Loop(1) = {1, 2, 3, 4};", "Curve Loop(1) = {1, 2, 3};"), &["mesh"], 2, &["scene.geo"]),
    run(Geo("Line(1) = {1, 2};", "Line(1) = {1, 2;"), &["mesh"], 2, &["scene.geo, line 8", "syntax error"]),
    run(Case("  bottom: {ux", "  botom: {ux"), &["mesh"], 2, &["case.yaml:13:3", "did you mean `bottom`?"]),
];

/// The command line.
const ARGUMENTS: &[Broken] = &[
    run(Nothing, &["check", "--set", "mesh.parameters.h"], 2, &["--set mesh.parameters.h", "no `=`", "write it as"]),
    run(Nothing, &["check", "--set", "title.more=1"], 2, &["--set title.more=1", "`title` is the text `Block`"]),
    run(
        Nothing,
        &["check", "--set", "phases[3].duration=1"],
        2,
        &["--set phases[3].duration=1", "no item `3`", "it has the items 0 to 0, by name load"],
    ),
    run(
        Nothing,
        &["check", "--set", "contacts=[]", "--set", "contacts[0].friction=1"],
        2,
        &["--set contacts[0].friction=1", "`contacts` has no item `0`", "it is empty: write the whole list"],
    ),
    run(
        Nothing,
        &["check", "--set", "output.history[0].quantities.head=uy"],
        2,
        &["`output.history[0].quantities` has no item `head`", "it has the items 0 to 1"],
    ),
    run(
        Nothing,
        &[
            "check",
            "--set",
            "numerics.pressure=field",
            "--set",
            "materials.clay={model: mohr_coulomb, young: 100, poisson: 0.3, cohesion: 1, friction: 20, density: 1}",
        ],
        2,
        &[
            "no material has a share",
            "and for `linear_elastic`, `tresca`, `von_mises`, `tresca_softening`; take it out",
        ],
    ),
    run(Nothing, &["check", "--set", "mesh..h=1"], 2, &["--set mesh..h=1", "an empty name"]),
    run(Nothing, &["check", "--set", "title=[1"], 2, &["--set title=[1", "not YAML"]),
    run(Nothing, &["check", "--set", "mesh.ordre=1"], 2, &["--set mesh.ordre=1", "did you mean `order`?"]),
    run(Nothing, &["check", "--set", "phases.load.duration=-1"], 2, &["--set phases.load.duration=-1", "above 0"]),
    run(
        Nothing,
        &["check", "--set", "materials.clay.young=.inf"],
        2,
        &["--set materials.clay.young=.inf", "not a finite"],
    ),
];

/// Where the regions lie, which only the mesh tells.
const LAYOUT: &[Broken] = &[
    run(
        Do(|d| {
            let geo = GEO.replace("Curve Loop(2) = {5, 6, 7, -3};\nPlane Surface(2) = {2};", "Plane Surface(2) = {1};");
            fs::write(d.join("scene.geo"), geo).unwrap();
        }),
        &["mesh"],
        2,
        &["of region soil", "its neighbour of region water lie on one another", "mend the geometry"],
    ),
    run(
        Do(|d| {
            remesh(
                d,
                &(GEO.to_owned() + &rectangle("more", [1.3, -1.2])),
                &format!("{WATER}  more: {{kind: buffer}}\n"),
            )
        }),
        &["seed"],
        2,
        &["regions `", "`more`", "upon each other at [", "a hole in the Plane Surface"],
    ),
    run(
        Do(|d| remesh(d, &(GEO.to_owned() + &rectangle("block", [5.0, -1.0])), &format!("{WATER}{BLOCK}"))),
        &["seed"],
        2,
        &["region `block`", "3.0000 m beside the grid", "touches no soil", "move the structure"],
    ),
    run(Case("k0: 0.8", "k0: 1e300"), &["seed"], 2, &["initial_stress.k0", "sideways", "strained", "0.3 to 3"]),
];

const WATER: &str = "  water: {kind: buffer}\n";
const BLOCK: &str = "  block: {kind: structure, material: clay}\ncontacts: [{structure: block, soil: soil}]\n";

/// Files of earlier stages, and the machine.
const FILES: &[Broken] = &[
    run(
        Do(|d| fs::remove_file(d.join("out/mesh.msh")).unwrap()),
        &["seed"],
        2,
        &["mesh.msh", "no mesh yet", "run `mpm mesh`"],
    ),
    run(Do(|d| truncate(&d.join("out/mesh.msh"))), &["seed"], 2, &["mesh.msh", "cut short", "`mpm mesh`"]),
    run(Do(|d| fs::write(d.join("out/mesh.msh"), "not a mesh\n").unwrap()), &["seed"], 2, &["mesh.msh", "`mpm mesh`"]),
    run(Case("  bottom: {ux", "  botom: {ux"), &["seed"], 2, &["case.yaml:13:3", "did you mean `bottom`?"]),
    run(
        Case("points_per_cell: 4", "points_per_cell: 9"),
        &["seed", "-o", "case.yaml/out"],
        2,
        &["mesh.msh", "`mpm mesh`"],
    ),
    run(Do(|d| fs::remove_file(d.join("out/points.vtu")).unwrap()), &["solve"], 2, &["points.vtu", "`mpm seed`"]),
    run(Do(|d| truncate(&d.join("out/points.vtu"))), &["solve"], 2, &["points.vtu", "`mpm seed`"]),
    run(
        Do(|d| fs::write(d.join("out/points.vtu"), "<VTKFile>").unwrap()),
        &["solve"],
        2,
        &["points.vtu", "`mpm seed`"],
    ),
    run(Do(|d| fs::write(d.join("out/points.vtu"), "").unwrap()), &["solve"], 2, &["points.vtu", "`mpm seed`"]),
    run(Do(other_mesh), &["solve"], 2, &["points.vtu", "`mpm seed` again"]),
    run(
        Nothing,
        &["solve", "--resume", "--set", "materials.clay.poisson=0.4"],
        2,
        &["checkpoint", "another case", "--resume"],
    ),
    run(Do(|d| each(&d.join("out/checkpoints"), truncate)), &["solve", "--resume"], 2, &["checkpoint", "--resume"]),
    run(Do(|d| fs::remove_dir_all(d.join("out/results")).unwrap()), &["export"], 2, &["results", "run `mpm solve`"]),
    run(Do(|d| truncate(&d.join("out/results/frame-000001.mpmf"))), &["export"], 2, &["frame-000001", "`mpm solve`"]),
    run(Nothing, &["export", "--set", "output.fields=[velocity]"], 2, &["velocity", "output.fields"]),
    run(Nothing, &["mesh", "-o", "case.yaml/out"], 3, &["case.yaml/out", "cannot be written", "-o"]),
    run(Nothing, &["mesh", "-o", "/proc/mpm"], 3, &["/proc/mpm", "cannot be written", "-o"]),
];

#[test]
fn the_text_of_the_case() {
    try_all(TEXT);
}

#[test]
fn the_meaning_of_the_case() {
    try_all(MEANING);
}

#[test]
fn the_geometry() {
    try_all(GEOMETRY);
}

#[test]
fn the_arguments() {
    try_all(ARGUMENTS);
}

#[test]
fn the_layout_of_the_regions() {
    try_all(LAYOUT);
}

#[test]
fn the_files_and_the_machine() {
    try_all(FILES);
}

#[test]
fn the_sound_case_passes() {
    let scene = Scene::new();
    for command in ["check", "mesh", "seed", "solve", "export"] {
        let output = scene.mpm(&[command]);
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
    }
}

#[test]
fn every_mistake_is_told_in_one_go() {
    let scene = Scene::new();
    let mistakes = [
        ("plane_strain", "plane_strian", "(geometry)"),
        ("order: 2", "ordr: 2", "(mesh.ordr)"),
        ("points_per_cell: 4", "points_per_cell: 5", "(regions.soil.points_per_cell)"),
        ("poisson: 0.49", "poisson: half", "(materials.clay.poisson)"),
        ("tolerance: 1.0e-8", "tolerance: -1", "(numerics.tolerance)"),
        ("duration: 1", "duration: .inf", "(phases[0].duration)"),
    ];
    mistakes.iter().for_each(|(from, to, _)| scene.replace("case.yaml", from, to));
    let output = scene.mpm(&["check"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    for (_, _, place) in mistakes {
        assert!(said.contains(place), "{place} is not in:\n{said}");
    }
    assert_eq!(said.matches("error: ").count(), mistakes.len(), "{said}");
}

#[test]
fn of_many_mistakes_the_first_are_told_and_the_others_counted() {
    let scene = Scene::new();
    let keys: String = (0..9_000).map(|i| format!("key{i}: {i}\n")).collect();
    let unknown = scene.attach("case.yaml", &keys);
    assert_eq!(unknown.matches("error: ").count(), 51, "{unknown}");
    assert!(unknown.contains("case.yaml:29:1 (key0)") && unknown.contains("(key49)"), "{unknown}");
    assert!(unknown.contains("there are 8950 more mistakes; correct these first"), "{unknown}");
    let scene = Scene::new();
    let names: String = (0..100).map(|i| format!("    - {{name: n{i}, on: nowhere{i}, quantities: [uy]}}\n")).collect();
    let nowhere = scene.attach("case.yaml", &names);
    assert_eq!(nowhere.matches("error: ").count(), 51, "{nowhere}");
    assert!(nowhere.contains("there are 50 more mistakes"), "{nowhere}");
}

#[test]
fn large_cases_are_read_in_time_that_grows_with_their_size() {
    let scene = Scene::new();
    let rows: Vec<String> = (0..100_000).map(|i| format!("[{i}, {i}.5]")).collect();
    scene.replace("case.yaml", "{table: [[0, 0], [1, -0.01]]}", &format!("{{table: [{}]}}", rows.join(", ")));
    let names: String = (0..9_000).map(|i| format!("    - {{name: n{i}, on: surface, quantities: [uy]}}\n")).collect();
    assert_eq!(scene.attach("case.yaml", &names), "");
}

#[test]
fn a_byte_order_mark_is_no_mistake() {
    let scene = Scene::new();
    let case = fs::read_to_string(scene.path().join("case.yaml")).unwrap();
    fs::write(scene.path().join("case.yaml"), format!("\u{feff}{case}")).unwrap();
    let output = scene.mpm(&["check"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    scene.replace("case.yaml", "title: Block", "titel: Block");
    let said = text(&scene.mpm(&["check"]).stderr);
    assert!(said.contains("case.yaml:1:1 (titel)"), "{said}");
}

#[test]
fn more_threads_than_cores_are_not_started() {
    let scene = Scene::new();
    let output = scene.mpm(&["seed", "--threads", "1024"]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    let cores = std::thread::available_parallelism().unwrap().get();
    if cores < 1024 {
        assert!(said.contains(&format!("--threads 1024 is more than the {cores} cores there are")), "{said}");
    }
}

/// A name of a group or a file may hold what a terminal obeys.
#[test]
fn names_reach_the_terminal_as_text() {
    let scene = Scene::new();
    scene.replace("scene.geo", "Physical Surface(\"water\")", "Physical Surface(\"wa\x1b[2J\u{202e}ter\")");
    let folder = scene.path().join("\x1b]0;title\x07");
    fs::create_dir(&folder).unwrap();
    for (name, command) in [("scene.geo", vec!["check"]), ("none", vec!["check", "--set", "mesh.geo=a\u{202e}b"])] {
        let output = scene.mpm(&command);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {said}");
        assert!(!said.contains(['\x1b', '\x07', '\u{202e}']), "{name}: {said:?}");
        assert!(said.contains("\\u{202e}"), "{name}: {said}");
    }
    let output = mpm(&folder, &["check"]);
    let nothing = text(&output.stderr) + &text(&output.stdout);
    assert!(nothing.contains("case.yaml") && !nothing.contains(['\x1b', '\x07']), "{nothing:?}");
    let output = Command::new(env!("CARGO_BIN_EXE_mpm")).arg("check").arg(&folder).output().unwrap();
    let said = text(&output.stderr);
    assert!(said.contains("\\u{1b}]0;title\\u{7}") && !said.contains(['\x1b', '\x07']), "{said:?}");
}

#[test]
fn mistakes_of_the_case_and_its_geometry_are_told_together() {
    let scene = Scene::new();
    for (from, to) in [("poisson: 0.49", "poisson: 0.5"), ("top: 100", "top: -1"), ("bottom: {ux", "botom: {ux")] {
        scene.replace("case.yaml", from, to);
    }
    let said = text(&scene.mpm(&["check"]).stderr);
    for place in ["(materials.clay.poisson)", "(materials.clay.young.top)", "(supports.botom)"] {
        assert!(said.contains(place), "{place} is not in:\n{said}");
    }
}

#[test]
fn the_line_is_shown_with_a_caret_under_the_place() {
    let scene = Scene::new();
    scene.replace("case.yaml", "order: 2", "ordr: 2");
    let said = text(&scene.mpm(&["check"]).stderr);
    assert!(said.contains("\n 5 |   ordr: 2\n   |   ^\n"), "{said}");
}

#[test]
fn a_full_disk_leaves_the_earlier_files() {
    for command in ["mesh", "seed", "export"] {
        let scene = Scene::new();
        let before = scene.out();
        // No file may grow beyond 4 blocks of 512 bytes: writing fails as on a full disk.
        let script = format!("trap '' XFSZ; ulimit -f 4; exec '{}' {command} case.yaml", env!("CARGO_BIN_EXE_mpm"));
        let output = Command::new("sh").args(["-c", &script]).current_dir(scene.path()).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{command}: {said}");
        assert!(said.contains("-o") && !said.contains("panicked"), "{command}: {said}");
        assert_eq!(scene.out(), before, "{command}");
    }
}

#[test]
fn a_disk_that_fills_while_solving_loses_nothing_that_is_needed_to_go_on() {
    let whole = Scene::new();
    let scene = Scene::new();
    for part in ["results", "checkpoints"] {
        fs::remove_dir_all(scene.path().join("out").join(part)).unwrap();
    }
    let script = format!("trap '' XFSZ; ulimit -f 2; exec '{}' solve case.yaml", env!("CARGO_BIN_EXE_mpm"));
    let output = Command::new("sh").args(["-c", &script]).current_dir(scene.path()).output().unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("cannot be written") && said.contains("-o") && !said.contains("panicked"), "{said}");
    let output = scene.mpm(&["solve", "--resume"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let frame = |scene: &Scene| fs::read(scene.path().join("out/results/frame-000002.mpmf")).unwrap();
    assert!(frame(&scene) == frame(&whole), "the last frame is another one");
}

#[test]
fn standard_output_that_is_full_or_gone_is_no_panic() {
    let scene = Scene::new();
    let sh = |script: &str| Command::new("sh").args(["-c", script]).current_dir(scene.path()).output().unwrap();
    let mpm = env!("CARGO_BIN_EXE_mpm");
    let full = sh(&format!("'{mpm}' schema > /dev/full"));
    assert_eq!(full.status.code(), Some(3), "{}", text(&full.stderr));
    assert!(text(&full.stderr).contains("standard output"));
    let gone = sh(&format!("'{mpm}' schema | head -c 1"));
    assert_eq!(text(&gone.stderr), "");
    let closed = sh(&format!("'{mpm}' check case.yaml >&- 2>&-"));
    assert!(closed.status.code().is_some(), "killed by a signal");
}

fn try_all(table: &[Broken]) {
    let failures: Vec<String> = table.iter().filter_map(|broken| broken.attempt().err()).collect();
    assert!(failures.is_empty(), "{} of {}:\n\n{}", failures.len(), table.len(), failures.join("\n\n"));
}

impl Broken {
    fn attempt(&self) -> Result<(), String> {
        let scene = Scene::new();
        let what = match self.change {
            Case(from, to) => {
                scene.replace("case.yaml", from, to);
                format!("case: {from:?} → {to:?}")
            }
            Geo(from, to) => {
                scene.replace("scene.geo", from, to);
                format!("geo: {from:?} → {to:?}")
            }
            Do(action) => {
                action(scene.path());
                "an action".to_owned()
            }
            Nothing => "nothing".to_owned(),
        };
        let before = scene.out();
        let output = scene.mpm(self.command);
        let said = text(&output.stderr);
        let fault = |fault: &str| Err(format!("{what}, {:?}: {fault}\n{said}", self.command));
        if output.status.code() != Some(self.status) {
            return fault(&format!("status {:?} in place of {}", output.status.code(), self.status));
        }
        if let Some(missing) = self.says.iter().find(|&&piece| !said.contains(piece)) {
            return fault(&format!("{missing:?} is not said"));
        }
        if said.matches("error: ").count() != 1 || said.contains("panicked") || said.contains("NaN") {
            return fault("not one message");
        }
        // Place, problem and remedy.
        let first = said.lines().next().unwrap_or_default();
        if !first.contains(": ") || first.rsplit_once("; ").is_none_or(|(_, remedy)| remedy.trim().is_empty()) {
            return fault("no remedy");
        }
        if scene.out() != before {
            return fault("the output folder was touched");
        }
        Ok(())
    }
}

/// A folder with a case, its `.geo` and what was computed before.
struct Scene(TempDir);

impl Scene {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.yaml"), CASE).unwrap();
        fs::write(folder.path().join("scene.geo"), GEO).unwrap();
        fs::create_dir(folder.path().join("out")).unwrap();
        for (name, content) in computed() {
            let file = folder.path().join("out").join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, content).unwrap();
        }
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn replace(&self, file: &str, from: &str, to: &str) {
        let file = self.path().join(file);
        let text = fs::read_to_string(&file).unwrap();
        assert_eq!(text.matches(from).count(), 1, "{from:?} is not once in {}", file.display());
        fs::write(file, text.replace(from, to)).unwrap();
    }

    /// Runs the program on the case with a subcommand and its options.
    fn mpm(&self, command: &[&str]) -> Output {
        mpm(self.path(), command)
    }

    /// Appends to a file and checks the case: what is said then.
    fn attach(&self, file: &str, more: &str) -> String {
        let file = self.path().join(file);
        let before = fs::read_to_string(&file).unwrap();
        fs::write(&file, before + more).unwrap();
        text(&self.mpm(&["check"]).stderr)
    }

    /// Every file of the output folder with its content.
    fn out(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        files(&self.path().join("out"))
    }
}

fn mpm(folder: &Path, command: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_mpm");
    Command::new(program).arg(command[0]).arg("case.yaml").args(&command[1..]).current_dir(folder).output().unwrap()
}

/// The files of the stages up to the solution, made once.
fn computed() -> &'static BTreeMap<PathBuf, Vec<u8>> {
    static FILES: OnceLock<BTreeMap<PathBuf, Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.yaml"), CASE).unwrap();
        fs::write(folder.path().join("scene.geo"), GEO).unwrap();
        for command in ["mesh", "seed", "solve"] {
            let output = mpm(folder.path(), &[command]);
            assert!(output.status.success(), "{command}: {}", text(&output.stderr));
        }
        let out = folder.path().join("out");
        let named = |(path, content): (PathBuf, _)| (path.strip_prefix(&out).unwrap().to_owned(), content);
        files(&out).into_iter().map(named).collect()
    })
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            let content = fs::read(&path).unwrap();
            found.insert(path, content);
        }
    }
    found
}

fn truncate(file: &Path) {
    let content = fs::read(file).unwrap();
    fs::write(file, &content[..content.len() / 2]).unwrap();
}

/// Lists of lists of aliases, a thousand million entries when written out.
fn laughs() -> String {
    let line = |i: usize| format!("a{i}: &a{i} [{}]\n", vec![format!("*a{}", i - 1); 10].join(", "));
    "a0: &a0 [1]\n".to_owned() + &(1..10).map(line).collect::<String>()
}

/// 130 000 bytes that are nine hundred million when written out.
fn repeated() -> String {
    format!("a: &a {}\nb: [{}]\n", "x".repeat(100_000), vec!["*a"; 9_000].join(", "))
}

/// A surface of its own for a `.geo`: a square of 1 m with its lower left corner at `x`.
fn rectangle(name: &str, x: [f64; 2]) -> String {
    let [[a, b], [c, d]] = [x, [x[0] + 1.0, x[1] + 1.0]];
    format!(
        "Point(11) = {{{a}, {b}, 0, h}};\nPoint(12) = {{{c}, {b}, 0, h}};\nPoint(13) = {{{c}, {d}, 0, h}};\n\
         Point(14) = {{{a}, {d}, 0, h}};\nLine(11) = {{11, 12}};\nLine(12) = {{12, 13}};\nLine(13) = {{13, 14}};\n\
         Line(14) = {{14, 11}};\nCurve Loop(11) = {{11, 12, 13, 14}};\nPlane Surface(11) = {{11}};\n\
         Physical Surface(\"{name}\") = {{11}};\n"
    )
}

/// Gives the case another `.geo` with other regions beside the soil, and meshes it.
fn remesh(folder: &Path, geo: &str, regions: &str) {
    fs::write(folder.join("scene.geo"), geo).unwrap();
    fs::write(folder.join("case.yaml"), CASE.replace(WATER, regions)).unwrap();
    let output = mpm(folder, &["mesh"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// Does something to each file of a folder.
fn each(folder: &Path, action: fn(&Path)) {
    files(folder).keys().for_each(|file| action(file));
}

/// Puts a finer mesh of the same groups in the place of the one the points were seeded in.
fn other_mesh(folder: &Path) {
    let points = fs::read(folder.join("out/points.vtu")).unwrap();
    assert!(mpm(folder, &["mesh", "--set", "mesh.parameters.h=2"]).status.success());
    fs::write(folder.join("out/points.vtu"), points).unwrap();
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
