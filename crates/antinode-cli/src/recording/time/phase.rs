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
        Self::between(printed - error, printed + error)
    }

    /// That between these two, s.
    pub fn between(earliest: f64, latest: f64) -> Self {
        Self { earliest, latest }
    }

    /// One that is this much wider on each side, s.
    pub fn widened(self, by: f64) -> Self {
        Self::between(self.earliest - by, self.latest + by)
    }

    /// That in a time which runs backwards.
    pub fn reversed(self) -> Self {
        Self::between(-self.latest, -self.earliest)
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
        self.followed(self.last_phase(printed), self.printed_at(now, printed))
    }

    /// Where the last sample lies.
    pub(super) fn last_phase(&self, printed: Printed) -> Phase {
        self.phase
            .unwrap_or_else(|| Phase::near(self.last, printed.error(self.last)))
    }

    /// Where the sample of the first of these times lies, if that of the last lies there; none if a time among them leads astray.
    pub(super) fn first_phase(
        &self,
        times: &[f64],
        printed: Printed,
        last: Phase,
    ) -> Option<Phase> {
        let (mut phase, mut is_reached) = (last.reversed(), true);
        for &time in times.iter().rev().skip(1) {
            let next = self.followed(phase, self.printed_at(time, printed).reversed());
            is_reached = next.is_some();
            // A time that is wrong may not fit, and the one before it does.
            phase = next.map_or(phase, |(_, phase)| phase);
        }
        is_reached.then(|| phase.reversed())
    }

    /// Where a sample may lie whose printed time is this.
    fn printed_at(&self, time: f64, printed: Printed) -> Phase {
        Phase::near(time, printed.error(time) + STEP_TOLERANCE * self.step)
    }

    /// The fewest samples between two phases, and where the second lies if so; none if no number of them does.
    fn followed(&self, last: Phase, here: Phase) -> Option<(u64, Phase)> {
        let uncertainty = self.uncertainty + DRIFT * self.step;
        let (shortest, longest) = (self.step - uncertainty, self.step + uncertainty);
        let steps = ((here.earliest - last.latest) / longest).ceil();
        let steps = steps.max(1.0);
        if steps * uncertainty > 0.5 * self.step {
            // So long a pause tells nothing of the phase, and of its samples only about how many there are.
            let steps = ((here.middle() - last.middle()) / self.step).round();
            return Some((steps as u64 - 1, here));
        }
        let earliest = last.earliest + steps * shortest;
        let latest = last.latest + steps * longest;
        let phase = Phase::between(earliest.max(here.earliest), latest.min(here.latest));
        (phase.earliest <= phase.latest).then_some((steps as u64 - 1, phase))
    }
}
