//! Where the time goes: wall time by activity, summed over a run. The main thread is timed around whole
//! activities; the material, which works inside the assembly on all threads, once a cell: so the clock costs
//! next to nothing. And how large the systems of equations are.

use std::cell::Cell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// What the main thread is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Finding points, filling the interpolation, mapping between points and nodes.
    Transfer,
    /// Strain, stress and tangent of the points, and the sums into the system.
    Assembly,
    /// Symbolic analysis of a new pattern.
    Analysis,
    /// Numeric factorisation.
    Factorisation,
    /// Back-substitution and refinement.
    Solution,
    /// Handing results to the writer, and waiting for it.
    Output,
    /// Finding what structures touch, and moving points out of them; what contact adds to the system is assembly.
    Contact,
}

impl Activity {
    pub const ALL: [Self; 7] = [
        Self::Transfer,
        Self::Assembly,
        Self::Analysis,
        Self::Factorisation,
        Self::Solution,
        Self::Output,
        Self::Contact,
    ];
}

static NANOSECONDS: [AtomicU64; 7] = [const { AtomicU64::new(0) }; 7];

thread_local! {
    /// Time of the activities within the one in hand, which is theirs and not its.
    static WITHIN: Cell<u64> = const { Cell::new(0) };
}

/// Time of the material models, the sum over all threads.
static MATERIAL: AtomicU64 = AtomicU64::new(0);

/// Equations of the largest system so far and entries of its matrix.
static SYSTEM: Mutex<(usize, usize)> = Mutex::new((0, 0));

/// Notes a system of so many equations, with the entries of both triangles of its matrix.
pub fn note_system(equations: usize, entries: usize) {
    if let Ok(mut most) = SYSTEM.lock() {
        *most = (*most).max((equations, entries));
    }
}

/// Equations of the largest system so far, and entries a row of its matrix; `None` before there is one.
pub fn largest_system() -> Option<(usize, f64)> {
    let (equations, entries) = *SYSTEM.lock().ok()?;
    (equations > 0).then(|| (equations, entries as f64 / equations as f64))
}

/// Runs `work` and books its time, less that of activities within it.
pub fn timed<T>(activity: Activity, work: impl FnOnce() -> T) -> T {
    let before = WITHIN.replace(0);
    let start = Instant::now();
    let result = work();
    let elapsed = start.elapsed().as_nanos() as u64;
    let own = elapsed.saturating_sub(WITHIN.replace(before + elapsed));
    NANOSECONDS[activity as usize].fetch_add(own, Ordering::Relaxed);
    result
}

/// Seconds booked on an activity so far.
pub fn seconds(activity: Activity) -> f64 {
    NANOSECONDS[activity as usize].load(Ordering::Relaxed) as f64 * 1e-9
}

/// Runs `work`, the evaluation of a material model on any thread, and books its time.
pub fn timed_material<T>(work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    MATERIAL.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
    result
}

/// Seconds of the material models so far, the mean over the threads: the part of [`Activity::Assembly`], and
/// to a small extent of [`Activity::Transfer`], that is theirs.
pub fn material_seconds() -> f64 {
    MATERIAL.load(Ordering::Relaxed) as f64 * 1e-9 / rayon::current_num_threads() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;
    use std::time::Duration;

    /// Nothing else in the tests of the library books on these two.
    #[test]
    fn time_is_booked_once() {
        let [output, contact] = [Activity::Output, Activity::Contact].map(seconds);
        let start = Instant::now();
        timed(Activity::Output, || {
            timed(Activity::Contact, || sleep(Duration::from_millis(30)));
            sleep(Duration::from_millis(10));
        });
        let all = start.elapsed().as_secs_f64();
        let [output, contact] = [seconds(Activity::Output) - output, seconds(Activity::Contact) - contact];
        assert!(contact >= 0.03 && output >= 0.01 && output + contact <= all, "{contact} {output} of {all}");
    }
}
