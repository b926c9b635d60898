//! Counters of 32 bits, which begin anew after 2^32 counts: after 72 minutes if they count microseconds.

/// The counts after which a counter begins anew.
const WRAP: f64 = (1u64 << 32) as f64;

/// Most counts about a wrap that belong to samples or to a gap, so that one of a counter that is reset is not taken for it.
const MAX_STEP: f64 = (1u64 << 24) as f64;

/// A counter that may begin anew.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Wrapped {
    last: f64,
    /// The counts up to where it last began anew.
    before: f64,
}

impl Wrapped {
    /// This count, and all counts before the counter began anew.
    pub fn unwrapped(&mut self, count: f64) -> f64 {
        let back = self.last - (self.before + count);
        if (WRAP - MAX_STEP..WRAP).contains(&back) {
            self.before += WRAP;
        }
        self.last = self.before + count;
        self.last
    }
}
