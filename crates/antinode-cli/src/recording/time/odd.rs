//! Which times follow the last one, and which are wrong.

use super::super::printed::Printed;
use super::{MAX_ROUNDING, STEP_TOLERANCE, TimeAxis};

impl TimeAxis {
    /// Rounding near this time, in samples.
    pub(super) fn rounding(&self, now: f64, printed: Printed) -> f64 {
        printed.step(now).max(self.rounding) / self.step
    }

    /// Whether a time follows the last one without a gap.
    pub fn is_next(&self, now: f64, printed: Printed) -> bool {
        let rounding = self.rounding(now, printed);
        if self.is_coarse(rounding) {
            let lost = self.fewest_lost(now, printed);
            return lost.is_some_and(|(lost, _)| lost == 0);
        }
        let off = ((now - self.last) / self.step - 1.0).abs();
        off <= STEP_TOLERANCE + rounding.min(0.5 - STEP_TOLERANCE)
    }

    /// Whether a time that does not follow the last one is wrong by the times `ahead`, behind it; none if more of these are needed to tell.
    /// One between samples is wrong only if `may_be_between`: where many are, samples are not taken at a constant rate.
    pub fn is_odd(
        &self,
        now: f64,
        ahead: &[f64],
        printed: Printed,
        may_be_between: bool,
    ) -> Option<bool> {
        let rounding = self.rounding(self.last, printed);
        let is_coarse = self.is_coarse(rounding);
        let samples = |time: f64| (time - self.last) / self.step;
        let is_whole = |time: f64| {
            if is_coarse {
                self.fewest_lost(time, printed).is_some()
            } else {
                is_forward(samples(time), self.tolerance(samples(time), rounding))
            }
        };
        let goes_on = |from: f64, to: f64| from < to || is_coarse && from == to;
        let is_resumed =
            |pair: &[f64]| is_whole(pair[0]) && is_whole(pair[1]) && goes_on(pair[0], pair[1]);
        let mut pairs = ahead.windows(2);
        // A whole number of samples later it is a gap: only if time runs back behind it may it be none.
        if now > self.last && ahead.first().is_some_and(|&next| goes_on(now, next)) {
            let is_between = may_be_between && !is_whole(now);
            return Some(is_between && pairs.next().is_some_and(is_resumed));
        }
        pairs.any(is_resumed).then_some(true)
    }

    /// Whether rounding, in samples, hides lost samples from a look at two neighbouring times.
    pub(super) fn is_coarse(&self, rounding: f64) -> bool {
        rounding > MAX_ROUNDING && rounding * self.step > self.harmless
    }

    /// Largest deviation of a time so many samples later from a whole number of these.
    pub(super) fn tolerance(&self, samples: f64, rounding: f64) -> f64 {
        STEP_TOLERANCE + rounding.min(MAX_ROUNDING) + samples * self.uncertainty / self.step
    }
}

/// Whether this is a whole number of samples, at least 1, within a tolerance.
pub(super) fn is_forward(samples: f64, tolerance: f64) -> bool {
    samples > 0.5 && (samples - samples.round()).abs() <= tolerance
}
