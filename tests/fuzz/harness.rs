//! One mutant after another through a reader.

use crate::memory;
use crate::mutate::{self, Random};
use mpm::error::Kind;
use std::collections::HashSet;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Mutants of each reader where no time is given.
const MUTANTS: u64 = 300;

/// What no file of a few kilobytes takes (s); a reader that takes longer hangs.
const HANG: u64 = 30;

/// What became of a file: what it means as a number, or why it was refused.
pub type Read = Result<u64, mpm::error::Error>;

/// A reader of files.
pub trait Reader: Sync {
    /// The name of its folder of faults.
    fn name(&self) -> &'static str;

    /// Sound files.
    fn corpus(&self) -> &[Vec<u8>];

    /// Whether a change of a file is refused, unless its checksums are made right.
    fn has_checksums(&self) -> bool {
        true
    }

    /// Changes file `number` of the corpus; true where its checksums are right.
    fn mutate(&self, random: &mut Random, number: usize) -> (Vec<u8>, bool) {
        let mut file = self.corpus()[number].clone();
        mutate::bytes(random, &mut file, self.corpus());
        (file, false)
    }

    /// File `number` of the corpus, its checksums made anew as those of mutants are.
    fn again(&self, number: usize) -> Vec<u8> {
        self.corpus()[number].clone()
    }

    /// The file that a text in the folder of faults describes: mostly itself.
    fn fault(&self, text: &[u8]) -> Vec<u8> {
        text.to_vec()
    }

    /// Reads a file and uses what it holds.
    fn read(&self, bytes: &[u8]) -> Read;
}

/// One reader at a time: memory and panics are those of the program.
static ALONE: Mutex<()> = Mutex::new(());
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Reads the corpus, all faults and as many mutants as there is time for.
pub fn fuzz(reader: &dyn Reader) {
    let alone = ALONE.lock().unwrap_or_else(|e| e.into_inner());
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(|info| {
        *PANIC.lock().unwrap_or_else(|e| e.into_inner()) = info.to_string();
    }));
    let told = catch_unwind(AssertUnwindSafe(|| run(reader)));
    std::panic::set_hook(before);
    drop(alone);
    let wrong = told.unwrap_or_else(|_| vec![PANIC.lock().unwrap_or_else(|e| e.into_inner()).clone()]);
    assert!(wrong.is_empty(), "{}: {} faults\n{}", reader.name(), wrong.len(), wrong.join("\n"));
}

fn run(reader: &dyn Reader) -> Vec<String> {
    let mut wrong = Vec::new();
    let sound: Vec<u64> = reader.corpus().iter().map(|file| reader.read(file).expect("a sound file")).collect();
    for (number, sound) in sound.iter().enumerate() {
        let again = reader.read(&reader.again(number)).expect("checksums that are right");
        assert_eq!(again, *sound, "file {number} means something else with its checksums made anew");
    }
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/faults").join(reader.name());
    let mut faults: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    faults.sort();
    for path in faults {
        let file = reader.fault(&fs::read(&path).unwrap());
        match guarded(reader, &file) {
            Ok(Err(e)) if e.kind == Kind::Input && !e.remedy.is_empty() => {}
            Ok(Err(e)) => wrong.push(format!("{}: {:?}: {e}", path.display(), e.kind)),
            Ok(Ok(_)) => wrong.push(format!("{}: it was read", path.display())),
            Err(panic) => wrong.push(format!("{}: {panic}", path.display())),
        }
    }
    let number_of = |name: &str| std::env::var(name).ok().map(|v| v.parse::<u64>().expect("a number"));
    let time = number_of("FUZZ_SECONDS").map(|s| Duration::from_secs(s) / crate::READERS);
    let seed = number_of("FUZZ_SEED").unwrap_or(1);
    let only = number_of("FUZZ_MUTANT");
    let (start, mut seen) = (Instant::now(), HashSet::new());
    let (mut refused, mut slowest) = (0, (Duration::ZERO, 0));
    let mut number = only.unwrap_or(0);
    while only.is_none_or(|only| number == only)
        && time.map_or(number < MUTANTS || only.is_some(), |t| start.elapsed() < t)
    {
        memory::note(number);
        // Each follows from its number alone, so that it can be made again.
        let mut random = Random::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ number);
        let file = random.below(sound.len());
        let (mutant, repaired) = reader.mutate(&mut random, file);
        let begin = Instant::now();
        let told = guarded(reader, &mutant);
        slowest = slowest.max((begin.elapsed(), number));
        let fault = match told {
            Err(panic) => Some(panic),
            Ok(Err(_)) => {
                refused += 1;
                None
            }
            Ok(Ok(meaning)) if reader.has_checksums() && !repaired && !sound.contains(&meaning) => {
                Some("it was changed and is read as something else".to_string())
            }
            Ok(Ok(_)) => None,
        };
        // One mutant a fault is enough.
        let known = |fault: &String| seen.contains(fault.lines().next().unwrap_or_default());
        if let Some(fault) = fault.filter(|fault| !known(fault)) {
            seen.insert(fault.lines().next().unwrap_or_default().to_string());
            let path = std::env::temp_dir().join(format!("fuzz-{}-{seed}-{number}", reader.name()));
            fs::write(&path, &mutant).unwrap();
            wrong.push(format!("FUZZ_SEED={seed} FUZZ_MUTANT={number} ({}): {fault}", path.display()));
        }
        number += 1;
    }
    eprintln!(
        "{}: {number} mutants, {refused} refused, the slowest (number {}) in {:.2} s, at most {} MB in use",
        reader.name(),
        slowest.1,
        slowest.0.as_secs_f64(),
        memory::peak() >> 20
    );
    wrong
}

/// Reads a file; the message of a panic, and the end of the program where it hangs.
fn guarded(reader: &dyn Reader, file: &[u8]) -> Result<Read, String> {
    static READS: AtomicU64 = AtomicU64::new(0);
    static WATCHED: std::sync::Once = std::sync::Once::new();
    WATCHED.call_once(|| {
        drop(std::thread::spawn(|| {
            let mut last = u64::MAX;
            loop {
                let now = READS.load(Ordering::Relaxed);
                // Odd while a file is being read.
                if now == last && now % 2 == 1 {
                    eprintln!("a reader hangs");
                    std::process::abort();
                }
                last = now;
                std::thread::sleep(Duration::from_secs(HANG));
            }
        }));
    });
    READS.fetch_add(1, Ordering::Relaxed);
    let told = catch_unwind(AssertUnwindSafe(|| reader.read(file)));
    READS.fetch_add(1, Ordering::Relaxed);
    told.map_err(|_| std::mem::take(&mut *PANIC.lock().unwrap_or_else(|e| e.into_inner())))
}
