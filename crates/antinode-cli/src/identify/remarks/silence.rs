//! Check how much of a recording's beginning and end has no wave.

use antinode::{Estimate, Flags};

use crate::digits::seconds;

/// Windows or periods that a search and the window after it may take.
const SEARCH_WINDOWS: f64 = 3.0;
const SEARCH_PERIODS: f64 = 20.0;

/// Silence is reported from this share of the recording on, or from this many seconds.
const MIN_SHARE: f64 = 0.01;
const MIN_SECONDS: f64 = 1.0;

/// The beginning and the end of the rows with a wave.
#[derive(Debug, Default)]
pub(super) struct Silence {
    /// Since the first sample, s.
    rows: Option<[f64; 2]>,
    /// Time that may have no row though there is a wave, s.
    usual: f64,
}

impl Silence {
    /// Takes a row of a recording of this sample rate, whose windows are `hop` blocks apart.
    pub fn see(&mut self, estimate: &Estimate, rate: f64, hop: Option<u16>) {
        if estimate.flags.contains(Flags::LOST) {
            return;
        }
        let window = f64::from(estimate.samples) / rate;
        // A window reaches half a sample beyond its first and its last sample.
        let begin = (estimate.time - 0.5 * window).max(0.0);
        let end = estimate.time + 0.5 * window;
        self.rows = Some([self.rows.map_or(begin, |rows| rows[0]), end]);
        let blocks = f64::from(hop.unwrap_or(0)).max(SEARCH_PERIODS);
        self.usual = self
            .usual
            .max(SEARCH_WINDOWS * window)
            .max(blocks / estimate.frequency);
    }

    /// A warning for a recording of this length, s, whose first sample has the time `start`.
    pub fn warning(&self, length: f64, start: f64) -> Option<String> {
        let [begin, end] = self.rows?;
        let min = self.usual.max(MIN_SECONDS.min(MIN_SHARE * length));
        let in_whole = |time: f64| seconds(time, length);
        let parts: Vec<String> = [("first", begin), ("last", length - end)]
            .into_iter()
            .filter(|&(_, length)| length > min)
            .map(|(name, length)| format!("the {name} {} s", in_whole(length)))
            .collect();
        (!parts.is_empty()).then(|| {
            format!(
                "no wave was found in {} of {} s: rows with a wave go from {} s to {} s",
                parts.join(" and "),
                in_whole(length),
                seconds(start + begin, end - begin),
                seconds(start + end, end - begin)
            )
        })
    }
}
