//! Period by formula (10): the squared difference between the signals and themselves one lag earlier.
//!
//! D(T) = Σ |S(t) − S(t−T)|² over both pick-offs has its first minimum after its first maximum at the period, whatever the
//! offsets. All lags from 4 to 200 samples would cost hundreds of products a sample. Here the stream is decimated by two again and
//! again, each octave compares lags of 1 to 10 of its own samples, and all octaves together cost no more than twenty lags.

use super::PERIODS;
use super::attempt::{Attempt, Verdict};
use super::octave::Octave;
use crate::sample::{Sample, SamplePair};

/// Count of octaves, for periods of 4 to 8, 8 to 16, … 128 to 256 samples.
const OCTAVES: usize = 6;
/// Most power that halving may take besides the wave's own, as a share of the wave's; of noise of 20 % it takes 0.2.
const MAX_FOREIGN_LOSS: f32 = 0.4;

/// What a trial adds to the weariness of a search. A look that finds nothing, or is left out, takes 1 away.
const TRIAL_WEARINESS: u8 = 6;
/// Weariness above which looks are left out, as after five refused trials in a row. Signals that look like a wave for ever, such as two
/// tones, would otherwise be on trial for ever.
const MAX_WEARINESS: u8 = 24;

/// A frame under trial, and the octave where it was found.
#[derive(Debug, Clone)]
struct Candidate<S: Sample> {
    is_open: bool,
    halvings: u8,
    /// Power that halving took in the faster octaves.
    lost: f32,
    attempt: Attempt<S>,
}

impl<S: Sample> Candidate<S> {
    /// Period in samples of the stream, if halving took little more than its part of the wave found. It would have taken nearly all
    /// of a faster wave that folds down to the same period or hides it.
    fn accept(&self, period: f32, power: f32) -> Option<f32> {
        let scale = (1u32 << self.halvings) as f32;
        let found = period * scale;
        // Halvings multiply the amplitude by cos ½t cos ¼t … = sin t/(n sin(t/n)), n = 2^halvings: series do, as t < 0.86.
        let turn = core::f32::consts::PI / period;
        let square = turn * turn;
        let rest = square / (scale * scale);
        let attenuation =
            (1.0 - rest * (1.0 / 6.0)) / (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)));
        let is_whole = self.lost < power * (attenuation * attenuation - 1.0 + MAX_FOREIGN_LOSS);
        (is_whole && PERIODS.contains(&found)).then_some(found)
    }
}

/// Streaming detector of formula (10): periods of 4 to 200 samples, from cold, with offsets of up to 100 a_A.
///
/// - Work: ten lags in each of two octaves per sample on average, and a few samples of a trial while there is a candidate; on codes all
///   but the trial is done in integers.
/// - False alarms: white noise is taken for a wave with a probability of 3·10⁻⁸ per frame; the residual of codes is never taken to be
///   below their own rounding. If f32 samples have coarse steps, or codes come in steps of several, noise below half a step has only a
///   few values. It is taken for a wave some 3·10⁻⁶ times per pair, and the first window shows that it is none.
/// - Small waves: one of a dozen codes is found a third of a period later than a greater one. One of fewer codes, or 16 in i32, may not be
///   found at all: in i16 a tenth of those of four codes is missed in 60 periods, and a hundredth of those of six; in i32 all of those of
///   four, and a third of those of eight.
/// - Speed: a wave in 20 % noise is found within three periods on average, or five if they have 4 samples, and 8 at the latest, one with
///   a tone of 20 % beside it within 5.5, and never at a fraction or a multiple of its period.
/// - Other signals: one that looks like a wave for ever, such as two tones, is examined less often after five trials. It then takes at
///   most 2.4 times the work of a wave, and a wave that begins meanwhile is found at most a fraction of a period later.
#[derive(Debug, Clone)]
pub struct DifferenceDetector<S: Sample> {
    octaves: [Octave<S>; OCTAVES],
    /// Octaves that have yet to take two samples into their D(T), one bit each.
    waiting: u8,
    /// Grows with each trial: see [`MAX_WEARINESS`].
    weariness: u8,
    candidate: Candidate<S>,
}

impl<S: Sample> DifferenceDetector<S> {
    /// A detector at rest, all zeros.
    pub const fn new() -> Self {
        Self {
            octaves: [Octave::new(); OCTAVES],
            waiting: 0,
            weariness: 0,
            candidate: Candidate {
                is_open: false,
                halvings: 0,
                lost: 0.0,
                attempt: Attempt::new(),
            },
        }
    }

    /// Forgets all samples.
    pub fn restart(&mut self) {
        self.candidate.is_open = false;
        self.waiting = 0;
        self.weariness = 0;
        for octave in &mut self.octaves {
            octave.restart();
        }
    }

    /// Takes a sample pair, and gives the period in samples once it is certain.
    ///
    /// One call updates and examines at most one octave, the fastest first: each octave has half the work of the one before it, so all
    /// are done before their next samples come.
    #[must_use = "the period is given once"]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<f32> {
        let [first, ..] = &mut self.octaves;
        if first.keep(pair.pair().map(S::search_form)) {
            self.waiting |= 1;
        }
        let due = if self.waiting > 0 {
            self.compare()
        } else {
            None
        };
        if self.candidate.is_open {
            return self.attempt();
        }
        if let Some(halvings) = due {
            self.look(halvings);
        }
        None
    }

    /// Takes two samples into the D(T) of the fastest octave that waits, and passes their mean to the next octave. Gives the octave if
    /// it is due to be examined.
    #[inline(never)]
    fn compare(&mut self) -> Option<usize> {
        let halvings = self.waiting.trailing_zeros() as usize;
        self.waiting &= self.waiting.wrapping_sub(1);
        let octave = self.octaves.get_mut(halvings)?;
        let mean = octave.compare()?;
        let is_due = octave.is_due();
        if let Some(next) = self.octaves.get_mut(halvings + 1)
            && next.keep(mean)
        {
            self.waiting |= 2 << halvings;
        }
        is_due.then_some(halvings)
    }

    /// Searches an octave's D(T) for a period, unless the search is weary.
    #[inline(never)]
    fn look(&mut self, halvings: usize) {
        if self.weariness <= MAX_WEARINESS {
            let octave = self.octaves.get_mut(halvings);
            if let Some(period) = octave.and_then(Octave::period) {
                return self.propose(halvings, period);
            }
        }
        self.weariness = self.weariness.saturating_sub(1);
    }

    /// Puts the frame of an octave on trial: a function of its own, so that a look that finds nothing stays short.
    #[inline(never)]
    fn propose(&mut self, halvings: usize, period: f32) {
        if let Some((below, [octave, ..])) = self.octaves.split_at_checked(halvings) {
            let candidate = &mut self.candidate;
            candidate.is_open = true;
            candidate.halvings = halvings as u8;
            candidate.lost = below.iter().map(Octave::lost).sum();
            let length = usize::from(octave.count);
            candidate.attempt.begin(&octave.frame, length, period);
        }
    }

    /// Continues the trial of the candidate; gives the period if it is accepted.
    #[inline(never)]
    fn attempt(&mut self) -> Option<f32> {
        let candidate = &mut self.candidate;
        let period = match candidate.attempt.advance() {
            Verdict::Open => return None,
            Verdict::Refused => None,
            Verdict::Accepted(fitted) => candidate.accept(fitted.period, fitted.power),
        };
        candidate.is_open = false;
        self.weariness += TRIAL_WEARINESS;
        period
    }
}

impl<S: Sample> Default for DifferenceDetector<S> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::PhaseStep;

    #[test]
    fn two_tones_are_on_trial_for_less_than_a_quarter_of_the_time() {
        let tones = [18.75, 11.3].map(PhaseStep::from_period);
        let mut detector = DifferenceDetector::<f32>::new();
        let (mut on_trial, pairs) = (0, 20_000);
        for k in 0..pairs {
            let [one, two] = tones.map(|step| step.after_half_samples(2 * k).unit());
            let pair = [one.re + two.re, one.im + two.im];
            assert!(detector.push(pair).is_none());
            on_trial += i64::from(detector.candidate.is_open);
        }
        // If no look were left out, it would be a third of the time.
        assert!(
            on_trial > 0 && 4 * on_trial < pairs,
            "{on_trial} of {pairs}"
        );
    }
}
