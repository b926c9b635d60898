//! Period by the squared difference of the signals from themselves a lag before, formula (10).
//!
//! D(T) = Σ |S(t) − S(t−T)|² over both pick-offs has its first minimum after its first maximum at the period, whatever the
//! offsets. All lags from 4 to 200 samples would cost hundreds of products a sample. Here the stream is halved again and again,
//! each octave sees lags of 1 to 10 of its own samples, and so all octaves together cost no more than twenty lags.

use super::PERIODS;
use super::attempt::{Attempt, Verdict};
use super::octave::Octave;
use crate::sample::{Sample, SamplePair};

/// Octaves: periods of 4 to 8, 8 to 16, … 128 to 256 samples.
const OCTAVES: usize = 6;
/// Power lost by halving beyond the wave's own, as a share of the wave's: noise of 20 % loses 0.2.
const STRANGER: f32 = 0.4;

/// What a refused trial adds to the weariness of a search: looks that find nothing, or are left out, take 1 each.
const REFUSED: u8 = 6;
/// Weariness above which looks are left out: five trials refused in a row. Signals that look like a wave for ever, as two tones do, would
/// otherwise be on trial for ever.
const WEARY: u8 = 24;

/// A frame under trial, and what it was found under.
#[derive(Debug, Clone)]
struct Candidate<S: Sample> {
    is_open: bool,
    halvings: u8,
    /// Power that the octaves below lost.
    lost: f32,
    attempt: Attempt<S>,
}

impl<S: Sample> Candidate<S> {
    /// The period in samples of the stream, where halving took little of the wave found: it takes all of a faster one that folds
    /// down to the same period or hides it.
    fn accept(&self, period: f32, power: f32) -> Option<f32> {
        let scale = (1u32 << self.halvings) as f32;
        let found = period * scale;
        // cos ½t cos ¼t … is sin t over all halvings of t and the sine of what is left: both are series, for t is below 0.86.
        let turn = core::f32::consts::PI / period;
        let square = turn * turn;
        let rest = square / (scale * scale);
        let taken =
            (1.0 - rest * (1.0 / 6.0)) / (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)));
        let is_whole = self.lost < power * (taken * taken - 1.0 + STRANGER);
        (is_whole && PERIODS.contains(&found)).then_some(found)
    }
}

/// The streaming detector of formula (10): periods of 4 to 200 samples, from cold, with offsets of up to 100 a_A.
///
/// Work a sample: ten lags in each of two octaves on average, and a few samples of a trial while there is a candidate; on codes all but the
/// trial is done in integers. White noise is taken for a wave with a chance of 3·10⁻⁸ a frame, and codes are never taken to leave less than
/// their own rounding. If samples come in steps, in f32 or of several codes, noise of less than half a step has but a few values: it is
/// taken for a wave some 3·10⁻⁶ times a pair, and the first window tells that it is none. A wave of a dozen codes is found a third of a
/// period later than a greater one; one of four may not be found at all, nor one of eight in i32. A wave in 20 % noise is found within
/// three periods on average and 6.5 at the latest, one with a tone of 20 % beside it within five, and never at a fraction or a multiple of
/// its period. A signal that looks like a wave for ever but is none, such as two tones, is looked at less often after five trials: it takes
/// at most 2.4 times the work of a wave, and a wave that begins then is found at most a fraction of a period later.
#[derive(Debug, Clone)]
pub struct DifferenceDetector<S: Sample> {
    octaves: [Octave<S>; OCTAVES],
    /// The octaves that are still to take two samples into their D(T), as bits.
    waiting: u8,
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

    /// Takes a sample pair; gives the period in samples once it is sure.
    ///
    /// In one call one octave at most takes samples into its D(T) and is looked at, the lowest first: an octave has half of the work
    /// of the one below, so all of them are done before their next samples come.
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

    /// Lets the lowest octave that waits take two samples into its D(T), and the next one keep their mean. Gives it where it is to be
    /// looked at.
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

    /// Looks at D(T) of an octave, unless the search is weary.
    #[inline(never)]
    fn look(&mut self, halvings: usize) {
        if self.weariness <= WEARY {
            let octave = self.octaves.get_mut(halvings);
            if let Some(period) = octave.and_then(Octave::period) {
                return self.propose(halvings, period);
            }
        }
        self.weariness = self.weariness.saturating_sub(1);
    }

    /// Puts the frame of an octave on trial: by itself, so that a look that finds nothing is short.
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

    /// Goes on with the trial of the candidate.
    #[inline(never)]
    fn attempt(&mut self) -> Option<f32> {
        let candidate = &mut self.candidate;
        let period = match candidate.attempt.advance() {
            Verdict::Open => return None,
            Verdict::Refused => None,
            Verdict::Accepted(fitted) => candidate.accept(fitted.period, fitted.power),
        };
        candidate.is_open = false;
        self.weariness += REFUSED;
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
    fn looks_are_left_out_after_two_tones_were_refused() {
        let tones = [18.75, 11.3].map(PhaseStep::from_period);
        let mut detector = DifferenceDetector::<f32>::new();
        let (mut on_trial, pairs) = (0, 20_000);
        for k in 0..pairs {
            let [one, two] = tones.map(|step| step.after_half_samples(2 * k).unit());
            let pair = [one.re + two.re, one.im + two.im];
            assert!(detector.push(pair).is_none());
            on_trial += i64::from(detector.candidate.is_open);
        }
        // It would be for a third of the time if no look were left out.
        assert!(
            on_trial > 0 && 4 * on_trial < pairs,
            "{on_trial} of {pairs}"
        );
    }
}
