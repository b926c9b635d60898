//! The time column of a text recording: its sample rate, and the check that its times keep to that rate.

mod odd;

use odd::is_forward;

use super::printed::Printed;
use crate::digits::significant;
use crate::median::median;

/// Largest deviation of a step from whole samples, in samples.
const STEP_TOLERANCE: f64 = 0.01;

/// Rounding of times, in samples, beyond which it hides a lost sample.
const MAX_ROUNDING: f64 = 0.25;

/// Fewest lines in which times that each stand twice are no accident.
const MIN_PAIRED: usize = 8;

/// Fewest uneven steps whose equal distances, to two lines, are no chance.
const MIN_REGULAR: usize = 6;

/// Number of samples over which the rate is averaged before it is compared.
const RATE_LINES: u64 = 1 << 16;

/// Largest relative difference of two rates that count as the same.
const SAME_RATE: f64 = 1e-3;

/// The meaning of a time column in view of the rate asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    /// The samples' times.
    Time,
    /// Seconds, or the numbers of the lines.
    PerhapsIndex,
    /// The numbers of the lines.
    Index,
    /// Times of another rate than the one asked for; both in Hz.
    OtherRate { own: f64, asked: f64 },
}

impl Meaning {
    /// The meaning of times with their `own` rate if a rate is `asked` for, both in Hz.
    pub fn of_rate(own: f64, asked: Option<f64>) -> Self {
        match asked {
            Some(asked) if (asked / own - 1.0).abs() > SAME_RATE => Self::OtherRate { own, asked },
            _ => Self::Time,
        }
    }
}

/// The sample rate, which is as steady as a clock, and the last time that kept to it.
pub(super) struct TimeAxis {
    /// The rate of the first lines, Hz, and its uncertainty as that of the step, s.
    rate: f64,
    rate_uncertainty: f64,
    /// The first time, s.
    start: f64,
    /// The number of samples after the first, lost ones included.
    count: u64,
    /// The latest average of the rate, Hz, if it is no longer that of the first lines.
    drifted: Option<f64>,
    /// The average step of the stretch before this one, s.
    step: f64,
    /// The last time, s.
    last: f64,
    /// The step between neighbouring printed times near the last, s.
    rounding: f64,
    /// The time at which the current stretch begins, s.
    anchor: f64,
    /// The number of samples since then, lost ones included.
    lines: u64,
    /// The uncertainty of `step` from the rounding of the first lines, s.
    uncertainty: f64,
    /// Rounding up to this, s, does no harm: the first steps are even in spite of it.
    harmless: f64,
}

impl TimeAxis {
    /// Finds the rate of the `first` times; none if there are not two, or if time mostly stands still.
    pub fn of(first: &[f64], printed: Printed) -> Option<Self> {
        let [start, .., _] = first else { return None };
        let steps: Vec<f64> = first.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let median = median(&mut steps.clone())?;
        if median <= 0.0 {
            return None;
        }
        // The first time may be wrong like any other.
        let is_near = |step: f64| (step - median).abs() < 0.5 * median;
        let start = match steps[..] {
            [own, next, after, ..]
                if !is_forward(own / median, MAX_ROUNDING) && is_near(next) && is_near(after) =>
            {
                first[1]
            }
            _ => *start,
        };
        let end = start + steps.len() as f64 * median;
        let rounding = printed.step(start).max(printed.step(end));
        // The mean of all but the uneven ones: a lost sample or a wrong time must not bias the rate it is to be measured by.
        let tolerance = 1.5 * rounding + STEP_TOLERANCE * median;
        let is_usual = |step: f64| is_near(step) && (step - median).abs() <= tolerance;
        let usual = steps.iter().filter(|&&step| is_usual(step));
        let (count, sum) = usual.fold((0.0, 0.0), |(count, sum), step| (count + 1.0, sum + step));
        let runs = (steps.len() + 1) as f64 - count;
        let uncertainty = runs * rounding / count;
        let mean = sum / count;
        let rate = roundest(1.0 / mean, uncertainty / mean / mean);
        // A change of the rate makes many uneven steps too, but these are alike: only the first of them counts.
        let is_off = |step: f64, usual: f64| ((step - usual) / mean).abs() > STEP_TOLERANCE;
        let ragged: Vec<usize> = (0..steps.len())
            .filter(|&at| is_off(steps[at], mean))
            .filter(|&at| at == 0 || is_off(steps[at], steps[at - 1]))
            .collect();
        // Rounding makes uneven steps at equal distances if the step is no multiple of the last digit; faults do not.
        let apart = || ragged.windows(2).map(|pair| pair[1] - pair[0]);
        let is_regular = ragged.len() >= MIN_REGULAR
            && apart()
                .max()
                .zip(apart().min())
                .is_some_and(|(most, least)| most - least <= 2);
        let rounding = printed.step(start);
        Some(Self {
            rate,
            rate_uncertainty: uncertainty,
            start,
            count: 0,
            drifted: None,
            step: 1.0 / rate,
            last: start,
            rounding,
            anchor: start,
            lines: 0,
            uncertainty,
            // A few uneven steps are faults; many or regular ones come from the rounding.
            harmless: if is_regular || ragged.len() > 2 && 10 * ragged.len() > steps.len() {
                0.0
            } else {
                2.0 * rounding
            },
        })
    }

    /// The sample rate of the first lines, Hz.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Whether the column counts the samples, one by one.
    pub fn is_count(&self, printed: Printed) -> bool {
        self.rate == 1.0 && printed.is_whole()
    }

    /// The meaning of the column if the rate `asked` is asked for, Hz.
    pub fn meaning(&self, printed: Printed, asked: Option<f64>) -> Meaning {
        let meaning = Meaning::of_rate(self.rate, asked);
        // An index goes up by one whole a line; so may seconds.
        let is_like_index = self.is_count(printed);
        match (asked, meaning) {
            (None, _) if is_like_index => Meaning::PerhapsIndex,
            (Some(_), Meaning::OtherRate { .. }) if is_like_index => Meaning::Index,
            _ => meaning,
        }
    }

    /// The latest rate, Hz, if it is no longer that of the first lines, and how much later than by the rate of the first lines the last
    /// time is, s.
    fn drift(&self) -> Option<(f64, f64)> {
        let late = self.last - self.start - self.count as f64 / self.rate;
        self.drifted.map(|rate| (rate, late))
    }

    /// The rate of all lines, Hz, and how much later than by another `rate` the last time is, s; none if rounding and half a sample explain
    /// the difference.
    fn beside(&self, rate: f64) -> Option<(f64, f64)> {
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

    /// The last time taken.
    pub fn last(&self) -> f64 {
        self.last
    }

    /// The first time, s.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Checks the time of the next line: gives the number of samples lost before it, or how it breaks the rate.
    pub fn check(&mut self, now: f64, printed: Printed) -> Result<u64, String> {
        let rounding = self.rounding(now, printed);
        let lost = if self.is_next(now, printed) {
            0
        } else {
            self.lost(now, rounding)?
        };
        self.last = now;
        self.rounding = printed.step(now);
        self.lines += 1 + lost;
        self.count += 1 + lost;
        if self.lines < RATE_LINES {
            return Ok(lost);
        }
        let length = now - self.anchor;
        let lines = self.lines as f64;
        // A clock may drift by a few ppm, but not by half a sample in [`RATE_LINES`].
        let is_off = |step: f64, uncertainty: f64| {
            let allowed = (0.5 + 2.0 * rounding) * step + 2.0 * lines * uncertainty;
            (length - lines * step).abs() > allowed
        };
        if is_off(self.step, self.uncertainty) {
            let (from, to) = (1.0 / self.step, lines / length);
            return Err(format!(
                "the sample rate has changed from {from:.3} Hz to {to:.3} Hz; sample at a constant rate, resample the recording to one"
            ));
        }
        if is_off(1.0 / self.rate, self.rate_uncertainty) {
            self.drifted = Some(lines / length);
        }
        // The next stretch is compared with this one: a clock that warms up drifts far in the end, but never at once.
        self.step = length / lines;
        self.uncertainty = 0.0;
        self.anchor = now;
        self.lines = 0;
        Ok(lost)
    }

    /// The number of samples lost before a time that is off, or what else is wrong with it.
    fn lost(&self, now: f64, rounding: f64) -> Result<u64, String> {
        let (from, to, usual) = (self.last, now, self.step);
        let step = to - from;
        let samples = step / usual;
        if self.is_coarse(rounding) {
            Err(coarse(rounding * usual, usual))
        } else if step <= 0.0 {
            Err(backwards(from, to))
        } else if samples > 1.5 && is_forward(samples, self.tolerance(samples, rounding)) {
            Ok(samples.round() as u64 - 1)
        } else {
            Err(format!(
                "time steps by {step:.4e} s here, but by {usual:.4e} s elsewhere; sample at a constant rate, resample the recording to one"
            ))
        }
    }
}

/// Whether each of `times` stands in two lines, as for a minimum and a maximum; the first or the last may stand alone.
pub(super) fn are_paired(times: &[f64]) -> bool {
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let are_turns = |first: usize| {
        let mut steps = steps().enumerate();
        steps.all(|(index, step)| (index % 2 == first) == (step == 0.0) && step >= 0.0)
    };
    times.len() >= MIN_PAIRED && (are_turns(0) || are_turns(1))
}

/// The index of the first of `times` that does not go up, and its fault.
pub(super) fn standstill(times: &[f64], printed: Printed) -> Option<(usize, String)> {
    let at = 1 + times.windows(2).position(|pair| pair[1] <= pair[0])?;
    let (from, to) = (times[at - 1], times[at]);
    let usual = (times.last()? - times.first()?) / (times.len() - 1) as f64;
    let fault = if from == to && usual > 0.0 {
        coarse(printed.step(to), usual)
    } else {
        backwards(from, to)
    };
    Some((at, fault))
}

/// What is wrong with times printed with too few digits.
fn coarse(step: f64, usual: f64) -> String {
    format!(
        "times are given to {step:.0e} s only, too coarse for samples {usual:.4e} s apart; print more digits, and keep times in double precision"
    )
}

/// What is wrong if time stands still or runs backwards.
fn backwards(from: f64, to: f64) -> String {
    format!(
        "time goes from {from} s to {to} s, but must increase, and what follows is not read; sort the lines, cut the recording here, \
         print times with more digits"
    )
}

/// The number of fewest digits within `uncertainty` of `value`.
pub(super) fn roundest(value: f64, uncertainty: f64) -> f64 {
    let magnitude = value.log10().floor() as i32;
    (1..=16)
        .map(|digits| significant(value, digits))
        .find(|round| (round - value).abs() <= uncertainty.max(10f64.powi(magnitude - 14)))
        .unwrap_or(value)
}

#[cfg(test)]
mod tests;
