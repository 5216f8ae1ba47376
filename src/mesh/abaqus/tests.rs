//! What input files of Abaqus and others become.

use super::parse;
use crate::mesh::shape::CellKind;
use crate::mesh::{Mesh, msh, quality};
use std::path::Path;

/// The mesh of a file, with its notes; its cells are sound.
fn read(text: &str) -> (Mesh<2>, Vec<String>) {
    let (out, notes) = parse(text.as_bytes(), "model.inp").unwrap_or_else(|e| panic!("{e}"));
    let mesh = msh::parse(out.as_bytes(), "model.inp").unwrap_or_else(|e| panic!("{e}\n{out}"));
    quality::check(&mesh, Path::new("model.inp")).unwrap_or_else(|e| panic!("{e}\n{out}"));
    (mesh, notes)
}

/// The area (m²) of each region, by name.
fn areas(mesh: &Mesh<2>) -> Vec<(String, f64)> {
    let summary = quality::check(mesh, Path::new("model.inp")).unwrap();
    summary.regions.into_iter().map(|(name, _, area)| (name, (area * 1e6).round() / 1e6)).collect()
}

/// The places (m) of the nodes of a group, ascending.
fn places(mesh: &Mesh<2>, group: &str) -> Vec<[f64; 2]> {
    let group = mesh.group(group).unwrap_or_else(|| panic!("no {group}: {:?}", mesh.groups));
    let mut places: Vec<_> =
        group.nodes.iter().map(|&n| mesh.nodes[n as usize].map(|v| (v * 1e6).round() / 1e6 + 0.0)).collect();
    places.sort_by(|a, b| a.partial_cmp(b).unwrap());
    places
}

fn said(text: &str) -> String {
    parse(text.as_bytes(), "model.inp").map(|(out, _)| out).unwrap_err().to_string()
}

/// A strip of three quadrilaterals, 3 m × 1 m.
const STRIP: &str = "*Node\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 3, 0\n5, 0, 1\n6, 1, 1\n7, 2, 1\n8, 3, 1\n";

const CELLS: &str = "1, 1, 2, 6, 5\n2, 2, 3, 7, 6\n3, 3, 4, 8, 7\n";

#[test]
fn parts_count_for_themselves_and_are_where_their_instances_put_them() {
    let ground = format!(
        "*Part, name=Ground\n{STRIP}*Element, type=CPE4R, elset=Soil\n{CELLS}*Solid Section, elset=Soil, material=M\n,\n*End Part\n"
    );
    let pile = "*Part, name=\"Pile part\"\n*Node\n1, 0, 0\n2, 0.5, 0\n3, 0, 2\n*Element, type=CPE3\n7, 1, 2, 3\n*Nset, nset=Foot\n1, 2\n\
                *Elset, elset=Set-1\n7,\n*Solid Section, elset=Set-1, material=Steel\n,\n*End Part\n";
    let assembly = "*Assembly, name=Assembly\n*Instance, name=Ground-1, part=Ground\n*End Instance\n\
                    *Instance, name=Left, part=\"Pile part\"\n0., 1.\n*End Instance\n\
                    *Instance, name=Right, part=\"Pile part\"\n2., 1., 0.\n2., 1., 0., 2., 1., 1., 90.\n*End Instance\n\
                    *Nset, nset=Ends, instance=Left\n3\n*Nset, nset=Ends, instance=Right\n3\n*End Assembly\n";
    let (mesh, notes) = read(&format!("*Heading\n{ground}{pile}{assembly}"));
    assert_eq!(areas(&mesh), [("Soil".into(), 3.0), ("Left.Steel".into(), 0.5), ("Right.Steel".into(), 0.5)]);
    assert_eq!(notes, [""; 0]);
    assert_eq!(places(&mesh, "Left.Foot"), [[0.0, 1.0], [0.5, 1.0]]);
    // Moved by 2 m, 1 m and turned by 90° about the place where it is then.
    assert_eq!(places(&mesh, "Right.Foot"), [[2.0, 1.0], [2.0, 1.5]]);
    // (0, 2) of the part: turned from (2, 3) about (2, 1).
    assert_eq!(places(&mesh, "Ends"), [[0.0, 1.0], [0.0, 3.0]]);
    assert_eq!(mesh.group("Ends").unwrap().dimension, 0);
    // The order of the parts does not matter.
    let (other, _) = read(&format!("*Heading\n{pile}{ground}{assembly}"));
    assert_eq!(areas(&other), areas(&mesh));
    assert_eq!(places(&other, "Right.Foot"), places(&mesh, "Right.Foot"));
}

#[test]
fn sections_sets_and_what_the_elements_are_written_with_name_the_regions() {
    let named = |text: &str| {
        let (mesh, _) = read(&format!("{STRIP}{text}"));
        areas(&mesh).into_iter().map(|(name, area)| format!("{name} {area}")).collect::<Vec<_>>()
    };
    let cells = format!("*ELEMENT, TYPE=CPE4, ELSET=All\n{CELLS}");
    assert_eq!(named(&cells), ["All 3"]);
    assert_eq!(named(&format!("*Element, type=CPE4\n{CELLS}")), ["domain 3"]);
    // A row of elements beside.
    assert_eq!(named(&format!("{cells}*ELSET, ELSET=Row\n2\n")), ["All 3"]);
    let both = format!("{cells}*ELSET, ELSET=a\n1\n*ELSET, ELSET=b, generate\n2, 3\n");
    assert_eq!(named(&both), ["a 1", "b 2"]);
    assert_eq!(named(&format!("{both}*ELSET, ELSET=ab\na, b\n")), ["a 1", "b 2"]);
    assert_eq!(named(&format!("{both}*Solid Section, elset=B, material=m\n,\n")), ["All 1", "b 2"]);
    let automatic = format!(
        "{both}*Elset, elset=_PickedSet2, internal\na,\n*Solid Section, elset=_PickedSet2, material=Clay\n*Solid Section, elset=b, material=m\n"
    );
    assert_eq!(named(&automatic), ["Clay 1", "b 2"]);
    let unclear = said(&format!("{STRIP}*ELEMENT, TYPE=CPE4\n{CELLS}*ELSET, ELSET=a\n1, 2\n*ELSET, ELSET=b\n2\n"));
    assert!(unclear.contains("model.inp, element 2: it is in the sets a and b"), "{unclear}");
    let twice =
        said(&format!("{STRIP}{both}*Solid Section, elset=All, material=m\n*Solid Section, elset=a, material=m\n"));
    assert!(twice.contains("element 1: it is in two sections, those of All and of a"), "{twice}");
}

#[test]
fn surfaces_and_sets_of_nodes_become_curves() {
    let strip = format!("{STRIP}*ELEMENT, TYPE=CPE4, ELSET=Soil\n{CELLS}");
    let (mesh, notes) = read(&format!(
        "{strip}*Surface, type=ELEMENT, name=Top\nSoil, S3\n*Surface, type=ELEMENT, name=Around\nSoil,\n*Nset, nset=Corner\n4\n\
         *Nset, nset=Base, generate\n1, 4\n*Nset, nset=Inner\n2, 6\n*Nset, nset=Soil, generate\n1, 8\n*Nset, nset=Stray\n1, 2, 8\n"
    ));
    assert_eq!(places(&mesh, "Top"), [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [3.0, 1.0]]);
    assert_eq!((mesh.group("Top").unwrap().facets.len(), mesh.group("Around").unwrap().facets.len()), (3, 8));
    assert_eq!(places(&mesh, "Base"), [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
    assert_eq!((places(&mesh, "Corner"), mesh.group("Corner").unwrap().dimension), (vec![[3.0, 0.0]], 0));
    assert_eq!((places(&mesh, "Inner"), mesh.group("Inner").unwrap().facets.len()), (vec![[1.0, 0.0], [1.0, 1.0]], 1));
    assert!(mesh.group("Soil").is_none() && mesh.group("Stray").is_none());
    let [note] = notes.try_into().unwrap();
    assert!(note.contains("`Stray` is left out: 1 of its 3 nodes lie on no edge"), "{note}");
    // The edge across a corner is no part of the two sides that meet there.
    let corner = "*Node\n1, 0, 0\n2, 1, 0\n3, 0, 1\n4, 1, 1\n*Element, type=CAX3, elset=a\n1, 1, 2, 3\n2, 2, 4, 3\n*Nset, nset=Sides\n1, 2, 3\n";
    assert_eq!(read(corner).0.group("Sides").unwrap().facets.len(), 2);
}

#[test]
fn cells_of_second_order_take_sets_with_and_without_the_nodes_between() {
    let text = "*Node\n1, 0, 0\n2, 2, 0\n3, 2, 2\n4, 0, 2\n5, 1, 0\n6, 2, 1\n7, 1, 2\n8, 0, 1\n*Element, type=CPE8RP, elset=Soil\n1, 1, 2, 3, 4, 5,\n6, 7, 8\n\
                *Nset, nset=With\n1, 5, 2\n*Nset, nset=Without\n1, 2\n";
    let (mesh, _) = read(text);
    assert_eq!(mesh.cells.kind, [CellKind::Q8]);
    for set in ["With", "Without"] {
        assert_eq!(places(&mesh, set), [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]);
    }
}

/// Gmsh writes the sets of its groups beside those of its surfaces, lines as trusses with the middle node between the ends, and comments of its own.
#[test]
fn files_of_gmsh_have_the_regions_and_curves_of_their_physical_groups() {
    let text = "*Heading\n model\n*NODE\n1, 0, 0, 0\n2, 2, 0, 0\n3, 2, 2, 0\n4, 0, 2, 0\n5, 1, 0, 0\n6, 2, 1, 0\n7, 1, 1, 0\n8, 1, 2, 0\n9, 0, 1, 0\n\
                ******* E L E M E N T S *************\n*ELEMENT, type=T3D3, ELSET=Line1\n1, 1, 5, 2\n*ELEMENT, type=CPS6, ELSET=Surface1\n2, 1, 2, 3, 5, 6, 7\n\
                *ELEMENT, type=CPS6, ELSET=Surface2\n3, 1, 3, 4, 7, 8, 9\n*ELSET,ELSET=Bottom\n1, \n*ELSET,ELSET=Clay\n2, \n*ELSET,ELSET=Sand_fill\n3, \n\
                *NSET,NSET=Bottom\n1, 2, 5, \n*NSET,NSET=Clay\n1, 2, 3, 5, 6, 7, \n";
    let (mesh, notes) = read(text);
    assert_eq!(areas(&mesh), [("Clay".into(), 2.0), ("Sand_fill".into(), 2.0)]);
    assert_eq!(places(&mesh, "Bottom"), [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]);
    assert_eq!((mesh.group("Clay").is_none(), notes), (true, Vec::new()));
}

#[test]
fn what_is_left_out_is_told_and_what_is_not_understood_refused() {
    let strip = format!("{STRIP}*ELEMENT, TYPE=CPE4, ELSET=Soil\n{CELLS}");
    let (_, notes) = read(&format!(
        "{strip}*Element, type=B21, elset=wall\n11, 1, 2\n12, 2, 3\n*Nset, nset=Base\n1, 2\n*Elset, elset=walls\n11, 12\n"
    ));
    assert_eq!(notes, ["note: 2 elements of type B21 are left out: mpm takes plane ones"]);
    for (text, part) in [
        ("a mesh\n", "line 1: it is no input file of Abaqus"),
        (STRIP, "it has no plane elements"),
        ("*Node\n1, 0, 0\n1, 1, 0\n", "line 3: node 1 is there twice"),
        ("*Node\n1, zero, 0\n", "line 2: it is no node"),
        ("*Node, system=C\n1, 0, 0\n", "polar coordinates"),
        ("*Node, input=nodes.txt\n", "`*NODE` takes nodes or elements from elsewhere"),
        ("*Elgen\n1, 2\n", "`*ELGEN`"),
        ("*Include, input=a.inp\n", "`*INCLUDE`"),
        ("*Element, type=CPE4\n1, 1, 2, 6, 5\n", "element 1 has node 1, which is not there"),
        ("*Element, type=C3D8\n", "elements of type C3D8 are solid"),
        ("*Instance, name=a, part=b\n*End Instance\n", "there is no part \"b\" before it"),
        ("*Nset, nset=a\n7\n", "there is no node 7"),
        ("*Nset, nset=a, instance=b\n7\n", "there is no instance \"b\""),
    ] {
        let error = said(text);
        assert!(error.contains("model.inp") && error.contains(part), "{error}");
    }
    let error = said(&format!("{STRIP}*Element, type=CPE4\n1, 1, 2, 6, 5\n1, 2, 3, 7, 6\n"));
    assert!(error.contains("line 12: element 1 is there twice"), "{error}");
    let error = said(&format!("{STRIP}*Element, type=CPE4\n1, 1, 2, 6\n"));
    assert!(error.contains("the last element of type CPE4 lacks nodes"), "{error}");
}

/// A file of a few lines must not stand for more than it has room for.
#[test]
fn sets_of_sets_do_not_grow_without_bound() {
    let many: String = (1..=2000).map(|n| format!("{n}, {n}, 0\n")).collect();
    let sets: String = (1..=600).map(|i| format!("*Nset, nset=s{i}, generate\n1, 2000\n")).collect();
    let error = said(&format!("*Node\n{many}{sets}"));
    assert!(error.contains("stand for the same nodes or elements too often"), "{error}");
}
