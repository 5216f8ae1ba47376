//! The readers of the program, each with its corpus.

use crate::files::{self, Container};
use crate::harness::{Read, Reader};
use crate::mutate::{self, Random};
use crate::scenes::{self, Ready};
use mpm::error::Error;
use mpm::io::checkpoint::{Checkpoints as Kept, Fingerprint};
use mpm::io::export::Regions;
use mpm::io::frame::{self, Column, Frame, Part};
use mpm::io::history::{History, Log, Mark};
use mpm::io::points_vtu::{Seeded, Source};
use mpm::io::provenance::Origin;
use mpm::io::vtu::Encoding;
use mpm::io::{columns, export, points_vtu};
use mpm::mesh::{abaqus, msh, quality};
use mpm::run::checkpoint;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use twox_hash::XxHash64;

/// A number for what something means, as far as its `Debug` shows it.
fn meaning(of: &impl std::fmt::Debug) -> u64 {
    XxHash64::oneshot(0, format!("{of:?}").as_bytes())
}

/// The lines of a text of edits: the name of a scene or file, then the edits.
fn edits(text: &[u8]) -> (String, Vec<String>) {
    let text = String::from_utf8(text.to_vec()).unwrap();
    let mut lines =
        text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).map(String::from);
    (lines.next().unwrap(), lines.collect())
}

/// `case.yaml`.
pub struct Cases {
    folder: TempDir,
    corpus: Vec<Vec<u8>>,
}

impl Cases {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.geo"), "").unwrap();
        Self { folder, corpus: scenes::texts() }
    }
}

impl Reader for Cases {
    fn name(&self) -> &'static str {
        "case"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn has_checksums(&self) -> bool {
        false
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let path = self.folder.path().join("case.yaml");
        fs::write(&path, bytes).unwrap();
        let loaded = mpm::case::load(&path, &[]).map_err(|mut errors| errors.remove(0))?;
        Ok(meaning(&loaded.source.tree()))
    }
}

/// `mesh.msh`, and the first step on it.
pub struct Meshes {
    folder: TempDir,
    plain: Vec<Vec<u8>>,
    sealed: Vec<Vec<u8>>,
}

impl Meshes {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let corpus = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/mesh");
        let mut paths: Vec<PathBuf> = fs::read_dir(corpus).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        let plain: Vec<Vec<u8>> = paths.iter().map(|path| fs::read(path).unwrap()).collect();
        let sealed = plain.iter().map(|file| Self::seal(folder.path(), file)).collect();
        Self { folder, plain, sealed }
    }

    fn seal(folder: &Path, file: &[u8]) -> Vec<u8> {
        let path = folder.join("sealed.msh");
        fs::write(&path, file).unwrap();
        msh::seal(&path).unwrap();
        fs::read(&path).unwrap()
    }
}

impl Reader for Meshes {
    fn name(&self) -> &'static str {
        "mesh"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.sealed
    }

    fn mutate(&self, random: &mut Random, number: usize) -> (Vec<u8>, bool) {
        let mut file = self.plain[number].clone();
        match random.below(3) {
            0 => {
                mutate::bytes(random, &mut file, &self.plain);
                (Self::seal(self.folder.path(), &file), true)
            }
            1 => {
                mutate::bytes(random, &mut file, &self.plain);
                (file, true)
            }
            _ => {
                let sealed = &self.sealed[number];
                file.clone_from(sealed);
                mutate::bytes(random, &mut file, &self.sealed);
                // A file whose seal is gone is one that was never sealed.
                let gone = !file.ends_with(&sealed[self.plain[number].len()..]);
                (file, gone)
            }
        }
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let mesh = msh::parse(bytes, "mesh.msh")?;
        quality::check(&mesh, Path::new("mesh.msh"))?;
        let meaning = meaning(&mesh);
        scenes::on_mesh(mesh)?;
        Ok(meaning)
    }
}

/// Input files of Abaqus.
pub struct Abaqus {
    corpus: Vec<Vec<u8>>,
}

impl Abaqus {
    pub fn new() -> Self {
        let read = |path: &str| fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
        Self { corpus: vec![read("tests/data/abaqus/ground.inp"), read("tests/fuzz/corpus/abaqus/piles.inp")] }
    }
}

impl Reader for Abaqus {
    fn name(&self) -> &'static str {
        "abaqus"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn has_checksums(&self) -> bool {
        false
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let (text, _) = abaqus::parse(bytes, "model.inp")?;
        let mesh = msh::parse(text.as_bytes(), "model.inp")?;
        quality::check(&mesh, Path::new("model.inp"))?;
        Ok(meaning(&mesh))
    }
}

/// `points.vtu`, and the first step with them.
pub struct Points {
    folder: TempDir,
    scenes: Vec<Ready>,
    corpus: Vec<Vec<u8>>,
}

impl Points {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scenes = scenes::all();
        let path = folder.path().join("points.vtu");
        let written = |ready: &Ready| {
            points_vtu::write(&path, &ready.seeds, &ready.mesh.regions, &Source::default()).unwrap();
            fs::read(&path).unwrap()
        };
        let corpus = scenes.iter().map(written).collect();
        Self { folder, scenes, corpus }
    }
}

impl Reader for Points {
    fn name(&self) -> &'static str {
        "points"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn mutate(&self, random: &mut Random, number: usize) -> (Vec<u8>, bool) {
        let mut file = self.corpus[number].clone();
        match random.below(4) {
            0 => mutate::bytes(random, &mut file, &self.corpus),
            1 => {
                mutate::bytes(random, &mut file, &self.corpus);
                return (files::repair_points(file), true);
            }
            _ => return (files::mutate_points(random, &file), true),
        }
        (file, false)
    }

    fn again(&self, number: usize) -> Vec<u8> {
        files::repair_points(self.corpus[number].clone())
    }

    fn fault(&self, text: &[u8]) -> Vec<u8> {
        let (name, edits) = edits(text);
        let number = self.scenes.iter().position(|ready| ready.name == name).unwrap();
        edits.iter().fold(self.corpus[number].clone(), |file, line| files::edit_points(&file, line))
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let path = self.folder.path().join("points.vtu");
        fs::write(&path, bytes).unwrap();
        let Seeded { points, regions, .. } = points_vtu::read::<2>(&path)?;
        let is_of = |ready: &&Ready| ready.mesh.regions == regions && ready.seeds.len() == points.len();
        let Some(ready) = self.scenes.iter().find(is_of) else {
            return Err(Error::input("points.vtu", "is of another mesh", "run `mpm seed` again"));
        };
        let meaning = meaning(&columns::to_arrays(&points));
        let state = ready.begin(points)?;
        // That the analysis cannot go on from there may be.
        let _ = ready.step(state);
        Ok(meaning)
    }
}

/// Frames of results, and their export.
pub struct Frames {
    folder: TempDir,
    scene: Ready,
    corpus: Vec<Vec<u8>>,
}

impl Frames {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = scenes::all().swap_remove(1);
        let corpus = vec![Self::write(folder.path(), &Self::sample(&scene))];
        Self { folder, scene, corpus }
    }

    /// A frame with all that one can hold.
    fn sample(ready: &Ready) -> Frame {
        let column = |name: &str, components: usize, count: usize| Column {
            name: name.to_string(),
            unit: "-".to_string(),
            components,
            values: vec![0.25; components * count],
        };
        let part = |position: Vec<[f64; 3]>, columns: Vec<Column>| Part { position, columns };
        let triples = |x: &[[f64; 2]]| x.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>();
        let (points, elements) = (triples(&ready.first.points.position), triples(&ready.first.fem.position));
        let nodes = triples(&ready.scene.mesh.nodes[..ready.scene.mesh_nodes()]);
        let (n, m, g) = (points.len(), elements.len(), nodes.len());
        let cells = ready.first.fem.cell.iter().map(|&c| f64::from(c)).collect();
        let cell = Column { values: cells, ..column(frame::CELL, 1, m) };
        let line: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let along = || vec![column("pressure", 1, 6), column(frame::LINE, 1, 6), column(frame::REGION, 1, 6)];
        let faces = column(frame::FACES, 1, 6);
        Frame {
            time: 0.5,
            phase: "press".to_string(),
            step: 3,
            origin: Origin { run: Fingerprint::of(&[b"fuzz"]), mesh: 5 },
            points: part(
                points,
                vec![column("stress", 6, n), column("displacement", 3, n), column(frame::VOLUME, 1, n)],
            ),
            grid: part(nodes, vec![column("displacement", 3, g), column(frame::UNCOUNTED, 3, g)]),
            elements: part(elements, vec![column("stress", 6, m), column("displacement", 3, m), cell]),
            contact: part(line.clone(), along().into_iter().chain([faces]).collect()),
            surface: part(line, along().into_iter().chain([column("normal", 3, 6)]).collect()),
        }
    }

    fn write(folder: &Path, frame: &Frame) -> Vec<u8> {
        frame::prepare(folder, 0).unwrap();
        frame.clone().write(folder, 0).unwrap();
        fs::read(frame::path(folder, 0)).unwrap()
    }
}

impl Reader for Frames {
    fn name(&self) -> &'static str {
        "frame"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn mutate(&self, random: &mut Random, number: usize) -> (Vec<u8>, bool) {
        mutate_container(random, &self.corpus, number, "frame", self.folder.path())
    }

    fn again(&self, number: usize) -> Vec<u8> {
        edited(&self.corpus[number], &[], "frame", self.folder.path())
    }

    fn fault(&self, text: &[u8]) -> Vec<u8> {
        let (_, edits) = edits(text);
        edited(&self.corpus[0], &edits, "frame", self.folder.path())
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let results = self.folder.path().join("results");
        fs::create_dir_all(&results).unwrap();
        let path = frame::path(&results, 0);
        fs::write(&path, bytes).unwrap();
        let meaning = meaning(&Frame::read(&path)?);
        let mut regions = mpm::case::parts::of_series(&self.scene.case, &self.scene.mesh);
        let fields = ["stress", "displacement"].map(String::from);
        let export = |regions: &Regions| {
            export::export(&results, &self.scene.mesh, regions, self.folder.path(), &fields, Encoding::Lz4)
        };
        frame::prepare(&results, 1).unwrap();
        let alone = export(&regions);
        // Between frames of the same run, before a phase that counts displacements from there.
        let sound = Self::sample(&self.scene);
        sound.clone().write(&results, 0).unwrap();
        fs::write(frame::path(&results, 1), bytes).unwrap();
        Frame { phase: "pull".to_string(), ..sound }.write(&results, 2).unwrap();
        regions.resets.push("pull".to_string());
        export(&regions)?;
        alone?;
        Ok(meaning)
    }
}

/// `history.csv` and `solve.log`, as a run that continues opens them.
pub struct Histories {
    folder: TempDir,
    corpus: Vec<Vec<u8>>,
    /// What a checkpoint knows of the file.
    mark: Mark,
}

const ROWS: u64 = 5;

impl Histories {
    fn columns() -> Vec<String> {
        ["time [s]", "no_equilibrium_at [-]", "head.uy [m]"].map(String::from).to_vec()
    }

    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut history = History::create(&path, &Self::columns()).unwrap();
        let mut row = |i: u64| history.row(&[0.1 * i as f64, 0.0, -1.0 / 3.0].map(Some)).unwrap();
        (0..ROWS).for_each(&mut row);
        let mark = history.mark();
        history.row(&[0.1 * ROWS as f64, 0.0, -1.0 / 3.0].map(Some)).unwrap();
        let corpus = vec![fs::read(&path).unwrap()];
        Self { folder, corpus, mark }
    }

    /// Opens the file as a log and as a table, and writes on.
    fn go_on(&self, bytes: &[u8], mark: Mark) -> Read {
        let path = self.folder.path().join("history.csv");
        fs::write(&path, bytes).unwrap();
        Log::resume(&path, mark)?.line("and so on")?;
        fs::write(&path, bytes).unwrap();
        let mut history = History::resume(&path, &Self::columns(), mark)?;
        history.row(&[1.0, 0.0, 0.5].map(Some))?;
        Ok(meaning(&fs::read(&path).unwrap()))
    }
}

impl Reader for Histories {
    fn name(&self) -> &'static str {
        "history"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn read(&self, bytes: &[u8]) -> Read {
        let read = self.go_on(bytes, self.mark);
        if read.is_err() {
            // The same with a mark that fits: it may be refused, and must not do harm.
            let lines = bytes.split_inclusive(|&b| b == b'\n').take(self.mark.lines as usize);
            let known: Vec<u8> = lines.flatten().copied().collect();
            let _ = self.go_on(bytes, Mark { hash: XxHash64::oneshot(0, &known), ..self.mark });
        }
        read
    }
}

/// Checkpoints, and a step from each.
pub struct Checkpoints {
    folder: TempDir,
    scenes: Vec<Ready>,
    corpus: Vec<Vec<u8>>,
    /// The scene of each file of the corpus.
    scene_of: Vec<usize>,
}

impl Checkpoints {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scenes = scenes::all();
        let (mut corpus, mut scene_of) = (Vec::new(), Vec::new());
        let new = Self { folder, scenes: Vec::new(), corpus: Vec::new(), scene_of: Vec::new() };
        for (number, ready) in scenes.iter().enumerate() {
            for state in &ready.states {
                // The scene goes along in a text, for the reader to find it.
                let mut store = checkpoint::put(Kept::store(), state).unwrap();
                store.put_text("scene", ready.name);
                new.kept().save(1, store).unwrap();
                corpus.push(fs::read(new.path()).unwrap());
                scene_of.push(number);
            }
        }
        Self { scenes, corpus, scene_of, ..new }
    }

    fn kept(&self) -> Kept {
        Kept::new(self.folder.path(), Fingerprint::of(&[]))
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("step-000000001.mpmc")
    }
}

impl Reader for Checkpoints {
    fn name(&self) -> &'static str {
        "checkpoint"
    }

    fn corpus(&self) -> &[Vec<u8>] {
        &self.corpus
    }

    fn mutate(&self, random: &mut Random, number: usize) -> (Vec<u8>, bool) {
        mutate_container(random, &self.corpus, number, "checkpoint", self.folder.path())
    }

    fn again(&self, number: usize) -> Vec<u8> {
        edited(&self.corpus[number], &[], "checkpoint", self.folder.path())
    }

    fn fault(&self, text: &[u8]) -> Vec<u8> {
        let (name, edits) = edits(text);
        let last = self.scene_of.iter().rposition(|&number| self.scenes[number].name == name).unwrap();
        edited(&self.corpus[last], &edits, "checkpoint", self.folder.path())
    }

    fn read(&self, bytes: &[u8]) -> Read {
        fs::write(self.path(), bytes).unwrap();
        let loaded = self.kept().latest()?.expect("a checkpoint is there");
        let of = loaded.store.text("scene")?;
        let Some(ready) = self.scenes.iter().find(|ready| ready.name == of) else {
            return Err(Error::input("checkpoint", "is of another scene", "start the analysis afresh"));
        };
        let state = checkpoint::take(loaded.store, &ready.scene, &ready.first)?;
        let meaning = meaning(&state);
        // Nor may the same do harm as the end of a phase.
        let again = self.kept().latest()?.expect("a checkpoint is there");
        let _ = checkpoint::after_phase(again.store, &ready.scene, &ready.first, state.phase + 1);
        // That the analysis cannot go on from there may be.
        let _ = ready.step(state);
        Ok(meaning)
    }
}

/// A file of arrays changed in its bytes, in these with the checksum of the header made right, or in its arrays.
fn mutate_container(
    random: &mut Random,
    corpus: &[Vec<u8>],
    number: usize,
    kind: &str,
    folder: &Path,
) -> (Vec<u8>, bool) {
    let mut file = corpus[number].clone();
    match random.below(4) {
        0 => mutate::bytes(random, &mut file, corpus),
        1 => {
            mutate::bytes(random, &mut file, corpus);
            files::repair_container(&mut file);
            return (file, true);
        }
        _ => {
            let mut container = container(&file, kind, folder);
            container.mutate(random);
            return (container.bytes(), true);
        }
    }
    (file, false)
}

fn edited(file: &[u8], edits: &[String], kind: &str, folder: &Path) -> Vec<u8> {
    let mut container = container(file, kind, folder);
    edits.iter().for_each(|line| container.edit(line));
    container.bytes()
}

fn container(file: &[u8], kind: &str, folder: &Path) -> Container {
    let path = folder.join("sound");
    fs::write(&path, file).unwrap();
    Container::read(&path, kind)
}
