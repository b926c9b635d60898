//! What is told about the times of all lines, at the end.

use super::{STEP_TOLERANCE, TimeAxis, roundest};
use crate::digits::counted;

impl TimeAxis {
    /// The latest rate, Hz, if it is no longer that of the first lines, and how much later than by the rate of the first lines the last
    /// time is, s.
    pub(super) fn drift(&self) -> Option<(f64, f64)> {
        let late = self.last - self.start - self.count as f64 / self.rate;
        self.drifted.map(|rate| (rate, late))
    }

    /// The rate of all lines, Hz, and how much later than by another `rate` the last time is, s; none if rounding and half a sample explain
    /// the difference.
    pub(super) fn beside(&self, rate: f64) -> Option<(f64, f64)> {
        let length = self.last - self.start;
        let late = length - self.count as f64 / rate;
        if late.abs() <= 0.5 / rate + 2.0 * self.rounding {
            return None;
        }
        let own = self.count as f64 / length;
        Some((roundest(own, own * self.rounding / length), late))
    }

    /// The warning about a rate that drifts or differs from the one `used`, Hz, which is none if the rate in use is not that of the times.
    pub fn late_warning(&self, used: Option<f64>) -> Option<String> {
        // Where the time column is late, rows are early.
        let apart = |late: f64| {
            let side = if late < 0.0 { "later" } else { "earlier" };
            format!(
                "at the last sample times of rows are {:.1e} s {side} than the time column",
                late.abs()
            )
        };
        if let Some((rate, late)) = self.drift() {
            return Some(format!(
                "the sample rate in the time column drifts slowly from {:.3} Hz to {rate:.3} Hz; times and frequencies of rows use the \
                 first of these, and {}; resample the recording to a constant rate if that matters",
                self.rate,
                apart(late)
            ));
        }
        let used = used?;
        let (rate, late) = self.beside(used)?;
        Some(format!(
            "the whole time column gives a sample rate of {rate} Hz; times and frequencies of rows use {used} Hz, and {}; give --rate {rate} \
             if that matters",
            apart(late)
        ))
    }

    /// The warning about times that were too coarse to show each gap at once.
    pub fn coarse_warning(&self) -> Option<String> {
        let samples = self.coarsest * self.rate;
        (samples > 1.0 - STEP_TOLERANCE).then(|| {
            format!(
                "times are given to {:.0e} s only: gaps of up to {} are seen late or not at all; print more digits if that matters",
                self.coarsest,
                counted(samples.round() as u64, "sample")
            )
        })
    }
}
