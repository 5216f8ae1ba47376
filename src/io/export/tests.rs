use super::*;
use crate::error::Kind;
use crate::mesh::shape::CellKind;

fn mesh() -> Mesh<2> {
    let mut mesh = Mesh {
        nodes: vec![[0., 0.], [1., 0.], [0., 1.], [0.5, 0.], [0.5, 0.5], [0., 0.5]],
        regions: vec!["soil".to_string()],
        ..Mesh::default()
    };
    mesh.cells.push(CellKind::T6, 0, &[0, 1, 2, 3, 4, 5]);
    mesh
}

fn fields(names: &[&str]) -> Vec<String> {
    names.iter().map(ToString::to_string).collect()
}

fn write_frames(folder: &Path, count: usize) {
    frame::prepare(folder, 0).unwrap();
    for k in 0..count {
        frame::tests::sample(k).write(folder, k).unwrap();
    }
}

#[test]
fn only_what_is_asked_for_is_written_and_stale_files_go() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    write_frames(&results, 4);
    fs::create_dir_all(out.join("vtu")).unwrap();
    fs::write(out.join("vtu/points_own.vtu"), b"").unwrap();
    let asked = fields(&["mean_stress", "plastic_strain"]);
    assert_eq!(export(&results, &mesh(), &out, &asked, Encoding::Plain).unwrap(), Summary { frames: 4, removed: 0 });
    let text = fs::read_to_string(out.join("vtu/points_000003.vtu")).unwrap();
    assert!(text.contains("Name=\"mean_stress [kPa]\"") && text.contains("Name=\"plastic_strain [-]\""));
    assert!(!text.contains("Name=\"stress") && !text.contains("displacement") && !text.contains("deviatoric"));

    write_frames(&results, 2);
    assert_eq!(export(&results, &mesh(), &out, &asked, Encoding::Raw).unwrap(), Summary { frames: 2, removed: 4 });
    let mut left: Vec<_> =
        fs::read_dir(out.join("vtu")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    left.sort();
    assert_eq!(
        left,
        ["grid_000000.vtu", "grid_000001.vtu", "points_000000.vtu", "points_000001.vtu", "points_own.vtu"]
    );
    assert_eq!(fs::read_to_string(out.join("grid.pvd")).unwrap().matches("<DataSet ").count(), 2);
}

#[test]
fn unknown_fields_and_other_meshes_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let (results, out) = (folder.path().join("results"), folder.path().join("out"));
    write_frames(&results, 1);
    let e = export(&results, &mesh(), &out, &fields(&["pore_pressure"]), Encoding::Raw).unwrap_err();
    assert_eq!(e.kind, Kind::Input);
    assert!(e.problem.contains("`pore_pressure`") && e.problem.contains("mean_stress, plastic_strain"), "{e}");
    let mut other = mesh();
    other.nodes.push([2., 2.]);
    let e = export(&results, &other, &out, &fields(&["stress"]), Encoding::Raw).unwrap_err();
    assert!(e.kind == Kind::Input && e.problem.contains("7 nodes"), "{e}");
    assert!(!out.join("points.pvd").exists());
}

#[test]
fn stress_invariants() {
    // Uniaxial tension: q is the stress itself; pure shear: √3 τ; a pressure adds nothing to q.
    assert_eq!((mean(&[6., 0., 0., 0., 0., 0.]), deviatoric(&[6., 0., 0., 0., 0., 0.])), (2.0, 6.0));
    for i in 3..6 {
        let mut s = [-7., -7., -7., 0., 0., 0.];
        s[i] = 2.0;
        assert_eq!(mean(&s), -7.0);
        assert!((deviatoric(&s) - 2.0 * 3_f64.sqrt()).abs() < 1e-15);
    }
}
