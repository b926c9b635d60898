//! A frame of the search that may hold a wave, tried a few samples at a time: no single call pays for all of it.

use super::octave::{FRAME, Frame};
use super::rests::Rests;
use super::trial::{Fitted, Trial};
use crate::sample::Sample;

/// Samples tried in one call, an even number.
const STRIDE: usize = 12;
/// Samples tried in a call that also judges.
const LAST: usize = 2;

/// A copy of a frame under trial, which the stream meanwhile overwrites.
#[derive(Debug, Clone)]
pub(super) struct Attempt<S: Sample> {
    frame: Frame<S>,
    length: usize,
    period: f32,
    /// Samples seen in this pass.
    seen: usize,
    trial: Trial,
    /// The fit that is to be shown to leave noise.
    doubt: Option<Fitted>,
    rests: Rests,
}

/// Where an attempt stands.
pub(super) enum Verdict {
    Open,
    Refused,
    Accepted(Fitted),
}

impl<S: Sample> Attempt<S> {
    /// An attempt at nothing.
    pub(super) const fn new() -> Self {
        Self {
            frame: [[[S::ZERO; 2]; 2]; FRAME / 2],
            length: 0,
            period: 0.0,
            seen: 0,
            trial: Trial::NONE,
            doubt: None,
            rests: Rests::NONE,
        }
    }

    /// Begins an attempt at a wave of `period` samples in the first `length` of `frame`, an even number. Nothing is tried yet: to
    /// find the frame took long enough.
    pub(super) fn begin(&mut self, frame: &Frame<S>, length: usize, period: f32) {
        self.frame = *frame;
        self.length = length;
        self.period = period;
        self.seen = 0;
        self.doubt = None;
    }

    /// Goes on by a few samples.
    pub(super) fn advance(&mut self) -> Verdict {
        let from = self.seen;
        self.seen = (from + STRIDE).min(self.length);
        // From both ends at once: of the two halves, what comes next.
        let halves = self.frame.as_flattened().split_at_checked(self.length / 2);
        let (first, last) = halves.unwrap_or((&[], &[]));
        let first = first.get(from / 2..self.seen / 2).unwrap_or(&[]);
        let last = last.get(..(self.length - from) / 2).unwrap_or(&[]);
        let ends = first.iter().zip(last.iter().rev());
        // Not by `map`: compiled for size, it is a loop.
        let long = |[c, d]: [S; 2]| [c.to_f32(), d.to_f32()];
        let ends = ends.map(|(&a, &b)| [long(a), long(b)]);
        let Some(fitted) = &self.doubt else {
            if from == 0 {
                self.trial.begin(self.period, self.length);
            }
            self.trial.push_ends(ends);
            // No other call takes so few.
            return if self.seen - from <= LAST {
                self.judge()
            } else {
                Verdict::Open
            };
        };
        self.rests.push_ends(ends, fitted);
        if self.seen < self.length {
            Verdict::Open
        } else if self.rests.are_noise() {
            Verdict::Accepted(fitted.clone())
        } else {
            Verdict::Refused
        }
    }

    /// What the fit says.
    fn judge(&mut self) -> Verdict {
        match self.trial.fitted(S::ROUNDING) {
            None => Verdict::Refused,
            Some(fitted) if fitted.doubt > 0.0 => {
                self.seen = 0;
                self.rests.begin(&self.trial);
                self.doubt = Some(fitted);
                Verdict::Open
            }
            Some(fitted) => Verdict::Accepted(fitted),
        }
    }
}
