//! Counters of the interrupt, which the main loop reports, and the search that the main loop wants.

use core::sync::atomic::{AtomicU32, Ordering};

/// A wrapping count with one writer and any number of readers.
#[derive(Debug, Default)]
pub struct Count(AtomicU32);

impl Count {
    /// Zero.
    pub const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// Adds `more`; only one context may call it.
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

/// Counts of the interrupt half, and the search that it should be in.
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
    /// Blocks with a pair at a rail.
    pub saturated_blocks: Count,
    /// Overruns: samples were not fetched in time.
    pub overruns: Count,
    /// Blocks dropped because the queue was full.
    pub blocks_dropped: Count,
    /// Restarts of sampling.
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
