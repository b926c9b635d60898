//! How much of a recording's beginning and end has no wave.

use antinode::{Estimate, Flags};

/// A search and the window that follows it may take so many windows or periods.
const WINDOWS: f64 = 3.0;
const PERIODS: f64 = 20.0;

/// Silence is worth a word from this share of the whole on, or from this many seconds.
const SHARE: f64 = 0.01;
const LONG: f64 = 1.0;

/// Where the rows with a wave begin and end.
#[derive(Debug, Default)]
pub(super) struct Silence {
    /// From the first sample on, s.
    rows: Option<[f64; 2]>,
    /// What may have no row where there is a wave, s.
    usual: f64,
}

impl Silence {
    /// Takes a row of a recording of this sample rate, in windows so many blocks apart.
    pub fn see(&mut self, estimate: &Estimate, rate: f64, hop: Option<u16>) {
        if estimate.flags.contains(Flags::LOST) {
            return;
        }
        let window = f64::from(estimate.samples) / rate;
        // A window reaches half a sample beyond its first and its last.
        let begin = (estimate.time - 0.5 * window).max(0.0);
        let end = estimate.time + 0.5 * window;
        self.rows = Some([self.rows.map_or(begin, |rows| rows[0]), end]);
        let blocks = f64::from(hop.unwrap_or(0)).max(PERIODS);
        self.usual = self
            .usual
            .max(WINDOWS * window)
            .max(blocks / estimate.frequency);
    }

    /// What to tell of a recording of so many seconds, whose first sample has this time.
    pub fn told(&self, seconds: f64, start: f64) -> Option<String> {
        let [begin, end] = self.rows?;
        let least = self.usual.max(LONG.min(SHARE * seconds));
        let parts: Vec<String> = [("first", begin), ("last", seconds - end)]
            .into_iter()
            .filter(|&(_, length)| length > least)
            .map(|(name, length)| format!("the {name} {length:.4} s"))
            .collect();
        let (begin, end) = (start + begin, start + end);
        (!parts.is_empty()).then(|| {
            format!(
                "no wave was found in {} of {seconds:.4} s: the rows that show one go from {begin:.4} s to {end:.4} s",
                parts.join(" and ")
            )
        })
    }
}
