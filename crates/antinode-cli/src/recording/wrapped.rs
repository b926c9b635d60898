//! Counters of 32 bits, which begin anew after 2^32 counts: after 72 minutes if they count microseconds. Clocks without a date do so at
//! midnight.

/// The counts after which a counter of 32 bits begins anew.
const COUNTS: f64 = (1u64 << 32) as f64;

/// Largest part of these that belongs to samples or to a gap about a wrap, so that one of a counter that is reset is not taken for it.
const MAX_STEP: f64 = 1.0 / (1u64 << 8) as f64;

/// A counter that may begin anew.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wrapped {
    /// The counts after which it does so.
    wrap: f64,
    last: f64,
    /// The counts up to where it last began anew.
    before: f64,
}

impl Default for Wrapped {
    fn default() -> Self {
        Self::after(COUNTS)
    }
}

impl Wrapped {
    /// One that begins anew after so many counts.
    pub fn after(wrap: f64) -> Self {
        Self {
            wrap,
            last: 0.0,
            before: 0.0,
        }
    }

    /// This count, and all counts before the counter began anew.
    pub fn unwrapped(&mut self, count: f64) -> f64 {
        let back = self.last - (self.before + count);
        if (self.wrap * (1.0 - MAX_STEP)..self.wrap).contains(&back) {
            self.before += self.wrap;
        }
        self.last = self.before + count;
        self.last
    }
}
