//! Where samples lie between times that are rounded to about a sample or more.

use super::super::printed::Printed;
use super::{RATE_LINES, STEP_TOLERANCE, TimeAxis};

/// How fast a clock may drift: by half a sample in [`RATE_LINES`].
const DRIFT: f64 = 0.5 / RATE_LINES as f64;

/// The earliest and the latest time, s, at which a sample may have been taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phase {
    earliest: f64,
    latest: f64,
}

impl Phase {
    /// That of a sample whose printed time has this `error` at most, both in s.
    pub fn near(printed: f64, error: f64) -> Self {
        Self {
            earliest: printed - error,
            latest: printed + error,
        }
    }

    /// The time amid these, s.
    pub fn middle(self) -> f64 {
        0.5 * (self.earliest + self.latest)
    }

    /// The time between these, s.
    pub fn width(self) -> f64 {
        self.latest - self.earliest
    }
}

impl TimeAxis {
    /// The fewest samples lost before the next one that explain its time, and its phase; none if no number of them does.
    pub(super) fn fewest_lost(&self, now: f64, printed: Printed) -> Option<(u64, Phase)> {
        let last = self
            .phase
            .unwrap_or_else(|| Phase::near(self.last, printed.error(self.last)));
        let here = Phase::near(now, printed.error(now) + STEP_TOLERANCE * self.step);
        let uncertainty = self.uncertainty + DRIFT * self.step;
        let (shortest, longest) = (self.step - uncertainty, self.step + uncertainty);
        let steps = ((here.earliest - last.latest) / longest).ceil();
        let steps = steps.max(1.0);
        let earliest = last.earliest + steps * shortest;
        let latest = last.latest + steps * longest;
        let phase = Phase {
            earliest: earliest.max(here.earliest),
            latest: latest.min(here.latest),
        };
        (phase.earliest <= phase.latest).then_some((steps as u64 - 1, phase))
    }
}
