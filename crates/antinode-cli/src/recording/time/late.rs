//! What can be said of a time column only once all of it is read.

use super::TimeAxis;

impl TimeAxis {
    /// The warning about a rate that drifts or differs from the one `used`, Hz, which is none if the rate in use is not that of the times.
    pub fn late_warning(&self, used: Option<f64>) -> Option<String> {
        let side = |late: f64| if late < 0.0 { "before" } else { "after" };
        if let Some((rate, late)) = self.drift() {
            return Some(format!(
                "in the time column the sample rate has gone slowly from {:.3} Hz to {rate:.3} Hz; times and frequencies of rows are by \
                 the first of them, and the last sample's own time is {:.1e} s {} that: resample it to a constant rate where that matters",
                self.rate(),
                late.abs(),
                side(late)
            ));
        }
        let used = used?;
        let (rate, late) = self.beside(used)?;
        Some(format!(
            "by all of the time column the sample rate is {rate} Hz; times and frequencies of rows are by {used} Hz, and the last \
             sample's own time is {:.1e} s {} that: give --rate {rate} where that matters",
            late.abs(),
            side(late)
        ))
    }
}
