use super::*;
use crate::error::Kind;
use crate::io::columns;
use crate::points::Points;
use crate::tensor::Tensor;
use std::fs;
use std::path::Path;

/// Points with every column filled with numbers that are all different, and awkward ones among them.
pub(in crate::io) fn sample_points(n: usize, dynamic: bool) -> Points<2> {
    let x = |i: usize, k: usize| ((i * 97 + k) as f64 * 0.618).sin() * 10_f64.powi((i + k) as i32 % 7 - 3);
    let vectors = |k: usize| (0..n).map(|i| [x(i, k), -0.0 * x(i, k + 1)]).collect::<Vec<_>>();
    let symmetric = |k: usize| (0..n).map(|i| std::array::from_fn(|j| x(i, k + j))).collect::<Vec<_>>();
    Points {
        position: vectors(1),
        origin: vectors(3),
        reference: if dynamic { vectors(36) } else { Vec::new() },
        velocity: if dynamic { vectors(5) } else { Vec::new() },
        acceleration: if dynamic { vectors(7) } else { Vec::new() },
        mass: (0..n).map(|i| x(i, 9)).collect(),
        initial_volume: (0..n).map(|i| x(i, 10)).collect(),
        deformation: (0..n).map(|i| Tensor::from_fn(|r, c| x(i, 11 + 3 * r + c))).collect(),
        elastic: symmetric(20),
        stress: symmetric(26),
        plastic_increment: if dynamic { (0..n).map(|i| x(i, 33)).collect() } else { Vec::new() },
        internal: if dynamic { (0..2 * n).map(|i| x(i / 2, 35 + i % 2)).collect() } else { Vec::new() },
        pressure: if dynamic { (0..n).map(|i| x(i, 34)).collect() } else { Vec::new() },
        pore_pressure: if dynamic { (0..n).map(|i| x(i, 35)).collect() } else { Vec::new() },
        domain: if dynamic { (0..8 * n).map(|i| x(i / 8, 37 + i % 8)).collect() } else { Vec::new() },
        strength: if dynamic { (0..n).map(|i| x(i, 45)).collect() } else { Vec::new() },
        plastic_strain: (0..n).map(|i| if i % 3 == 0 { 5e-324 } else { x(i, 32) }).collect(),
        region: (0..n).map(|i| (i % 2) as u16).collect(),
        model: if dynamic { (0..n).map(|i| (i % 5) as u16).collect() } else { Vec::new() },
        cell: (0..n).map(|i| u32::MAX - i as u32).collect(),
    }
}

/// Equality to the bit: `==` does not tell -0 from 0.
pub(in crate::io) fn same_bits<const D: usize>(a: &Points<D>, b: &Points<D>) -> bool {
    let bits = |p: &Points<D>| {
        let f = [
            p.position.concat(),
            p.origin.concat(),
            p.reference.concat(),
            p.velocity.concat(),
            p.acceleration.concat(),
            p.mass.clone(),
            p.initial_volume.clone(),
            p.deformation.iter().flat_map(|t| t.iter().copied()).collect(),
            p.elastic.concat(),
            p.stress.concat(),
            p.plastic_strain.clone(),
            p.plastic_increment.clone(),
            p.internal.clone(),
            p.pressure.clone(),
            p.pore_pressure.clone(),
            p.domain.clone(),
            p.strength.clone(),
        ];
        (f.map(|v| v.into_iter().map(f64::to_bits).collect::<Vec<_>>()), p.region.clone(), p.cell.clone())
    };
    bits(a) == bits(b)
}

fn save(checkpoints: &Checkpoints, step: u64) {
    let mut store = Checkpoints::store();
    store.put_text("phase", "push");
    store.put("time", 1, vec![step as f64 * 0.1]);
    columns::put(&mut store, "points/", &sample_points(50, step.is_multiple_of(2)));
    checkpoints.save(step, store).unwrap();
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_last_two_are_kept_and_the_newest_comes_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("checkpoints"), Fingerprint::of(&[b"case", b"mesh"]));
    assert!(checkpoints.latest().unwrap().is_none());
    for step in [1, 2, 3, 11] {
        save(&checkpoints, step);
        let mut loaded = checkpoints.latest().unwrap().unwrap();
        assert_eq!((loaded.step, loaded.warnings.len()), (step, 0));
        let points: Points<2> = columns::take(&mut loaded.store, "points/").unwrap();
        assert!(same_bits(&points, &sample_points(50, step.is_multiple_of(2))));
        assert_eq!(loaded.store.take::<f64>("time", 1).unwrap(), [step as f64 * 0.1]);
    }
    assert_eq!(files(&checkpoints.folder), ["step-000000003.mpmc", "step-000000011.mpmc"]);
    checkpoints.clear().unwrap();
    assert!(checkpoints.latest().unwrap().is_none());
}

#[test]
fn a_torn_newest_gives_way_to_the_one_before() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path(), Fingerprint::of(&[b"case"]));
    save(&checkpoints, 7);
    save(&checkpoints, 8);
    let newest = checkpoints.path(8);
    let bytes = fs::read(&newest).unwrap();
    fs::write(&newest, &bytes[..bytes.len() / 2]).unwrap();
    let loaded = checkpoints.latest().unwrap().unwrap();
    assert_eq!(loaded.step, 7);
    assert!(loaded.warnings.len() == 1 && loaded.warnings[0].contains("step-000000008"), "{:?}", loaded.warnings);
    fs::write(checkpoints.path(7), b"").unwrap();
    let e = checkpoints.latest().unwrap_err();
    assert_eq!(e.kind, Kind::Input);
    assert!(e.problem.contains("step-000000007") && e.problem.contains("step-000000008"), "{e}");
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    save(&Checkpoints::new(folder.path(), Fingerprint::of(&[b"case"])), 7);
    let e = Checkpoints::new(folder.path(), Fingerprint::of(&[b"case", b""])).latest().unwrap_err();
    assert_eq!(e.kind, Kind::Input);
    assert!(e.to_string().contains("another case") && e.remedy.contains("--resume"), "{e}");
    assert_ne!(Fingerprint::of(&[b"ab", b"c"]), Fingerprint::of(&[b"a", b"bc"]));
}

#[test]
fn columns_of_different_lengths_are_an_error() {
    for name in ["velocity", "mass", "deformation", "cell"] {
        let mut store = Checkpoints::store();
        for array in columns::to_arrays(&sample_points(5, true)) {
            if array.name != name {
                store.put_array(array);
            }
        }
        let other = columns::to_arrays(&sample_points(4, true)).into_iter().find(|a| a.name == name).unwrap();
        store.put_array(other);
        let e = columns::take::<2>(&mut store, "").unwrap_err();
        assert_eq!(e.kind, Kind::Input);
        assert!(e.problem.contains(&format!("`{name}` has 4 entries for 5")), "{e}");
    }
}
