//! The broken inputs, a table a kind of mistake, and what the program must say to each.

use super::Change::{Case, Do, Geo, Nothing};
use super::{Broken, CASE, Change, GEO, files, mpm, truncate};
use crate::support::succeeds;
use std::fs;
use std::path::Path;

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
pub const TEXT: &[Broken] = &[
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
    check(
        Case("order: 2", "order: 3"),
        &["case.yaml:17:1 (numerics.gradient)", "does not support cells of third order"],
    ),
    check(Case("order: 2", "order: 4"), &["case.yaml:5:10 (mesh.order)", "at most 3"]),
    check(Case("{h: 1}", "{h: fine}"), &["case.yaml:6:19", "the text `fine`", "must be a number"]),
    check(Case("{h: 1}", "[1]"), &["case.yaml:6:15", "a list", "must be"]),
    check(Case("phases:", "phase:"), &["case.yaml:18:1", "did you mean `phases`?"]),
    check(Case("geometry: plane_strain", "# none"), &["case.yaml", "`geometry` is missing", "add `geometry"]),
];

/// What the entries mean.
pub const MEANING: &[Broken] = &[
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
    check(Case("gradient: 10", "gradient: -10"), &["case.yaml:11", "young.gradient", "no `least`"]),
    check(Case("gradient: 10", "gradient: 10, least: 5"), &["case.yaml:11", "young.least", "does not fall"]),
    check(Case("gradient: 10", "gradient: -10, least: 500"), &["case.yaml:11", "young.least", "above the `top`"]),
    check(Case("density: 1.8", "density: {top: 1.8, gradient: -1, least: 1}"), &["density.gradient", "at least 0"]),
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
    check(Case("restore: every_step", "gradient: fem"), &["case.yaml:17", "no gradient `fem`", "mpm or ddmp"]),
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
        Case("    prescribe:", "    tractions: [{surface: all, pressure: 1}, {on: nowhere, fx: 1}]\n    prescribe:"),
        &["tractions[1].on", "no physical point `nowhere`"],
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
        &["tractions[0].factor", "varies with depth"],
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
    check(Case("[stress, displacement]", "[strains]"), &["case.yaml:26", "`strains`"]),
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
pub const GEOMETRY: &[Broken] = &[
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
pub const ARGUMENTS: &[Broken] = &[
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
        &["no material has a share", "`tresca_softening`, and for others from Poisson's ratio 0.495 on; take it out"],
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
pub const LAYOUT: &[Broken] = &[
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
pub const FILES: &[Broken] = &[
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
    succeeds(&output);
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
