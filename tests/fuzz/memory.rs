//! An allocator that counts what is in use and ends the program where it is more than a reader may take.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Bytes that reading a file of a few kilobytes may take.
const MOST: usize = 1 << 30;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// The mutant in hand, for the message.
static MUTANT: AtomicU64 = AtomicU64::new(0);

pub struct Counting;

// SAFETY: every call is handed to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let live = LIVE.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(live, Ordering::Relaxed);
        if live > MOST {
            too_much();
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(place, layout) }
    }
}

/// Ends the program, without allocating.
fn too_much() -> ! {
    let mut number = [b'0'; 20];
    let mut rest = MUTANT.load(Ordering::Relaxed);
    for digit in number.iter_mut().rev() {
        *digit += (rest % 10) as u8;
        rest /= 10;
    }
    let mut out = std::io::stderr();
    for part in [&b"more than 1 GB is in use; the mutant in hand is "[..], &number, b"\n"] {
        let _ = out.write_all(part);
    }
    std::process::abort()
}

/// Notes the number of the mutant in hand.
pub fn note(mutant: u64) {
    MUTANT.store(mutant, Ordering::Relaxed);
}

/// The most bytes that were in use at once since the program began.
pub fn peak() -> usize {
    PEAK.load(Ordering::Relaxed)
}
