//! Where the time goes: wall time by activity, summed over a run. Only the main thread is timed, and only
//! around whole activities, so that the clock costs nothing.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// What the main thread is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Finding points, filling the stencil, mapping between points and nodes.
    Transfer,
    /// Stress and tangent of the points, and the sums into the system.
    Assembly,
    /// Symbolic analysis of a new pattern.
    Analysis,
    /// Numeric factorisation.
    Factorisation,
    /// Back-substitution and refinement.
    Solution,
    /// Handing results to the writer, and waiting for it.
    Output,
}

impl Activity {
    pub const ALL: [Self; 6] =
        [Self::Transfer, Self::Assembly, Self::Analysis, Self::Factorisation, Self::Solution, Self::Output];
}

static NANOSECONDS: [AtomicU64; 6] = [const { AtomicU64::new(0) }; 6];

/// Runs `work` and books its time.
pub fn timed<T>(activity: Activity, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    NANOSECONDS[activity as usize].fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
    result
}

/// Seconds booked on an activity so far.
pub fn seconds(activity: Activity) -> f64 {
    NANOSECONDS[activity as usize].load(Ordering::Relaxed) as f64 * 1e-9
}
