//! The time column of a text recording: its sample rate, and the check that its times keep to that rate.

mod late;
mod meaning;
mod odd;
mod phase;
mod rounded;
mod still;

pub(super) use meaning::Meaning;
pub(super) use still::{are_paired, standstill};

use odd::is_forward;
use phase::Phase;
use rounded::Steps;
use still::{backwards, coarse};

use super::printed::Printed;
use crate::digits::{exponent, significant};
use crate::median::median;

/// Largest deviation of a step from whole samples, in samples.
const STEP_TOLERANCE: f64 = 0.01;

/// Rounding of times, in samples, beyond which it hides a lost sample.
const MAX_ROUNDING: f64 = 0.25;

/// Rounding, in samples, from which on neighbouring times do not tell a lost sample from none.
const MOST_UNCHECKED: f64 = 0.5;

/// Times that may look coarse among the first: one that is wrong, or a round one in shortest form.
const FEW_COARSE: usize = 2;

/// Fewest uneven steps whose equal distances are no chance.
const MIN_REGULAR: usize = 6;

/// Number of samples over which the rate is averaged before it is compared.
const RATE_LINES: u64 = 1 << 16;

/// Largest relative difference of two rates that count as the same.
const SAME_RATE: f64 = 1e-3;

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
    /// Where the sample lies with which the current stretch begins.
    anchor: Phase,
    /// The number of samples since then, lost ones included.
    lines: u64,
    /// The uncertainty of `step` from the rounding of the times that it was found from, s.
    uncertainty: f64,
    /// Rounding up to this, s, does no harm: the first steps are even in spite of it.
    harmless: f64,
    /// Where the true time of the last sample lies, if rounding hides it.
    phase: Option<Phase>,
    /// The coarsest rounding, s, that did harm.
    coarsest: f64,
}

impl TimeAxis {
    /// Finds the rate of the `first` times; none if there are not two, or if these do not show a rate.
    pub fn of(first: &[f64], printed: Printed) -> Option<Self> {
        let even = Self::of_even_steps(first, printed);
        let is_coarse = |axis: &Self, time: f64| axis.is_coarse(axis.rounding(time, printed));
        let is_even = |axis: &Self| {
            let mut coarse = first.iter().filter(|&&time| is_coarse(axis, time));
            coarse.nth(FEW_COARSE).is_none()
        };
        if even.as_ref().is_some_and(is_even) {
            return even;
        }
        let rounded = Steps::of(first, printed);
        let rounded = rounded.map(|steps| Self::of_rounded(first, printed, steps));
        rounded.or_else(|| {
            // Steps of fewer than two last digits may be those of another rate.
            let mut axis = even?;
            axis.harmless = MOST_UNCHECKED * axis.step;
            is_even(&axis).then_some(axis)
        })
    }

    /// Finds the rate from the median of the steps; none if time mostly stands still.
    fn of_even_steps(first: &[f64], printed: Printed) -> Option<Self> {
        let [start, .., _] = first else { return None };
        let steps: Vec<f64> = first.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let median = median(&mut steps.clone())?;
        if median <= 0.0 {
            return None;
        }
        // Half of the median is near: where samples are 1.5 last digits apart, steps have one and two.
        let is_near = |step: f64| (step - median).abs() < 0.51 * median;
        // The first time may be wrong like any other.
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
            .filter(|&at| is_off(steps[at], median))
            .filter(|&at| at == 0 || is_off(steps[at], steps[at - 1]))
            .collect();
        // Rounding makes uneven steps at equal distances if the step is no multiple of the last digit; faults do not.
        let mut apart: Vec<_> = ragged.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let is_regular = ragged.len() >= MIN_REGULAR && are_mostly_alike(&mut apart);
        let mut axis = Self::new(start, rate, uncertainty, printed);
        // A few uneven steps are faults; many or regular ones come from the rounding.
        if !(is_regular || ragged.len() > 2 && 10 * ragged.len() > steps.len()) {
            let is_even = ragged.len() < MIN_REGULAR;
            let late = if is_even { rounding.min(mean) } else { 0.0 };
            axis.harmless = 2.0 * late.max(printed.step(start));
        }
        Some(axis)
    }

    /// The axis of rounded times, explained by these steps.
    fn of_rounded(first: &[f64], printed: Printed, steps: Steps) -> Self {
        let [least, most] = steps.range;
        let (slow, fast) = (1.0 / most, 1.0 / least);
        let rate = roundest(0.5 * (slow + fast), 0.5 * (fast - slow));
        // The first time may be wrong like any other.
        let is_late = first.iter().skip(1).take(2).all(|next| *next < first[0]);
        let from = usize::from(is_late);
        let mut axis = Self::new(first[from], rate, most - least, printed);
        let before = &first[from..=steps.at.max(from)];
        axis.phase = axis.first_phase(before, printed, steps.phase);
        axis
    }

    /// An axis of this `rate`, Hz, whose step has an `uncertainty`, s.
    fn new(start: f64, rate: f64, uncertainty: f64, printed: Printed) -> Self {
        Self {
            rate,
            rate_uncertainty: uncertainty,
            start,
            count: 0,
            drifted: None,
            step: 1.0 / rate,
            last: start,
            rounding: printed.step(start),
            anchor: Phase::near(start, printed.error(start)),
            lines: 0,
            uncertainty,
            harmless: 0.0,
            phase: None,
            coarsest: 0.0,
        }
    }

    /// The sample rate of the first lines, Hz.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Whether the column counts the samples, one by one.
    pub fn is_count(&self, printed: Printed) -> bool {
        self.rate == 1.0 && printed.is_whole()
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
        let is_coarse = self.is_coarse(rounding);
        let lost = if is_coarse {
            let (lost, phase) = self.fewest_lost(now, printed).ok_or_else(|| {
                if now > self.last {
                    coarse(rounding * self.step, self.step)
                } else {
                    backwards(self.last, now, printed)
                }
            })?;
            self.phase = Some(phase);
            // A round time in shortest form looks coarse, but its neighbours do not.
            let of_both = printed.step(now).min(self.rounding);
            if self.is_coarse(of_both / self.step) {
                self.coarsest = self.coarsest.max(of_both);
            }
            lost
        } else {
            self.phase = None;
            if self.is_next(now, printed) {
                0
            } else {
                self.lost(now, rounding, printed)?
            }
        };
        self.last = now;
        self.rounding = printed.step(now);
        self.lines += 1 + lost;
        self.count += 1 + lost;
        if self.lines < RATE_LINES {
            return Ok(lost);
        }
        let here = self.last_phase(printed);
        let length = here.middle() - self.anchor.middle();
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
        self.uncertainty = 0.5 * (self.anchor.width() + here.width()) / lines;
        self.anchor = here;
        self.lines = 0;
        Ok(lost)
    }

    /// The number of samples lost before a time that is off, or what else is wrong with it.
    fn lost(&self, now: f64, rounding: f64, printed: Printed) -> Result<u64, String> {
        let (from, to, usual) = (self.last, now, self.step);
        let step = to - from;
        let samples = step / usual;
        if step <= 0.0 {
            Err(backwards(from, to, printed))
        } else if samples > 1.5 && is_forward(samples, self.tolerance(samples, rounding)) {
            Ok(samples.round() as u64 - 1)
        } else {
            Err(format!(
                "time steps by {step:.4e} s here, but by {usual:.4e} s elsewhere; sample at a constant rate, resample the recording to one"
            ))
        }
    }
}

/// Whether most of these distances are equal but for a line: a fault among the lines spoils one or two.
fn are_mostly_alike(distances: &mut [usize]) -> bool {
    distances.sort_unstable();
    let usual = distances[distances.len() / 2];
    let alike = distances.iter().filter(|one| one.abs_diff(usual) <= 1);
    4 * alike.count() >= 3 * distances.len()
}

/// The number of fewest digits within `uncertainty` of `value`.
pub(super) fn roundest(value: f64, uncertainty: f64) -> f64 {
    let last_digit = 10f64.powf(exponent(value) - 14.0);
    (1..=16)
        .map(|digits| significant(value, digits))
        .find(|round| (round - value).abs() <= uncertainty.max(last_digit))
        .unwrap_or(value)
}

#[cfg(test)]
mod tests;
