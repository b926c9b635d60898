//! What can be said of a time column only once all of it is read.

use super::TimeAxis;

impl TimeAxis {
    /// The warning about a rate that drifts or differs from the one `used`, Hz, which is none if the rate in use is not that of the times.
    pub fn late_warning(&self, used: Option<f64>) -> Option<String> {
        // Where the time column is late, rows are early.
        let side = |late: f64| if late < 0.0 { "later" } else { "earlier" };
        if let Some((rate, late)) = self.drift() {
            return Some(format!(
                "the sample rate in the time column drifts slowly from {:.3} Hz to {rate:.3} Hz; times and frequencies of rows use the \
                 first of these, and at the last sample times of rows are {:.1e} s {} than the time column; resample the recording to a \
                 constant rate if that matters",
                self.rate(),
                late.abs(),
                side(late)
            ));
        }
        let used = used?;
        let (rate, late) = self.beside(used)?;
        Some(format!(
            "the whole time column gives a sample rate of {rate} Hz; times and frequencies of rows use {used} Hz, and at the last \
             sample times of rows are {:.1e} s {} than the time column; give --rate {rate} if that matters",
            late.abs(),
            side(late)
        ))
    }
}
