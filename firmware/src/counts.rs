//! What the interrupt counts and the main loop reports, and which search the main loop wants.

use core::sync::atomic::{AtomicU32, Ordering};

/// A count with one writer and any readers; it wraps.
#[derive(Debug, Default)]
pub struct Count(AtomicU32);

impl Count {
    /// Zero.
    pub const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// Adds; only one context may do so.
    #[inline]
    pub fn add(&self, more: u32) {
        let count = self.0.load(Ordering::Relaxed);
        self.0.store(count.wrapping_add(more), Ordering::Relaxed);
    }

    /// The count.
    #[inline]
    pub fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// What the interrupt half counts, and which search it is to have.
#[derive(Debug, Default)]
pub struct Counts {
    /// [`antinode::Tracker::wanted_search`], which the main loop writes.
    pub wanted_search: AtomicU32,
    /// Sample pairs taken.
    pub pairs: Count,
    /// Sample pairs lost.
    pub pairs_lost: Count,
    /// Sample pairs at a rail.
    pub saturated_pairs: Count,
    /// Blocks with such a pair.
    pub saturated_blocks: Count,
    /// Times that samples were not fetched in time.
    pub overruns: Count,
    /// Blocks that found no room in the queue.
    pub blocks_dropped: Count,
    /// Times that sampling was started anew.
    pub restarts: Count,
}

impl Counts {
    /// Nothing counted.
    pub const fn new() -> Self {
        Self {
            wanted_search: AtomicU32::new(0),
            pairs: Count::new(),
            pairs_lost: Count::new(),
            saturated_pairs: Count::new(),
            saturated_blocks: Count::new(),
            overruns: Count::new(),
            blocks_dropped: Count::new(),
            restarts: Count::new(),
        }
    }
}
