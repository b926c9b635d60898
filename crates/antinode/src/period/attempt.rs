//! The trial of a frame that may hold a wave, spread over calls of a few samples each, so that no single call bears its cost.

use super::octave::{FRAME, Frame};
use super::rests::Residuals;
use super::trial::{Fitted, Trial};
use crate::sample::Sample;

/// Samples tried in one call, an even number.
const STRIDE: usize = 12;
/// A call that tries no more samples than this also judges the fit.
const JUDGING_STRIDE: usize = 2;

/// A frame under trial: a copy, because the stream meanwhile overwrites the original.
#[derive(Debug, Clone)]
pub(super) struct Attempt<S: Sample> {
    frame: Frame<S>,
    length: usize,
    period: f32,
    /// Samples seen in this pass.
    seen: usize,
    trial: Trial,
    /// A fit whose residuals must still be shown to be noise, by a second pass over the samples.
    doubtful: Option<Fitted>,
    residuals: Residuals,
}

/// State of an attempt after a call.
pub(super) enum Verdict {
    Open,
    Refused,
    Accepted(Fitted),
}

impl<S: Sample> Attempt<S> {
    /// An attempt without a frame.
    pub(super) const fn new() -> Self {
        Self {
            frame: [[[S::ZERO; 2]; 2]; FRAME / 2],
            length: 0,
            period: 0.0,
            seen: 0,
            trial: Trial::NONE,
            doubtful: None,
            residuals: Residuals::NONE,
        }
    }

    /// Begins an attempt at a wave of `period` samples in the first `length` samples of `frame`, an even number. Nothing is tried yet:
    /// this call has already paid for finding the frame.
    pub(super) fn begin(&mut self, frame: &Frame<S>, length: usize, period: f32) {
        self.frame = *frame;
        self.length = length;
        self.period = period;
        self.seen = 0;
        self.doubtful = None;
    }

    /// Tries the next few samples.
    pub(super) fn advance(&mut self) -> Verdict {
        let from = self.seen;
        self.seen = (from + STRIDE).min(self.length);
        // Samples are taken from both ends at once, towards the middle.
        let halves = self.frame.as_flattened().split_at_checked(self.length / 2);
        let (first, last) = halves.unwrap_or((&[], &[]));
        let first = first.get(from / 2..self.seen / 2).unwrap_or(&[]);
        let last = last.get(..(self.length - from) / 2).unwrap_or(&[]);
        let ends = first.iter().zip(last.iter().rev());
        // Written out: `map` becomes a loop when compiled for size.
        let long = |[c, d]: [S; 2]| [c.to_f32(), d.to_f32()];
        let ends = ends.map(|(&a, &b)| [long(a), long(b)]);
        let Some(fitted) = &self.doubtful else {
            if from == 0 {
                self.trial.begin(self.period, self.length);
            }
            self.trial.push_ends(ends);
            // Only the last call of a pass takes so few.
            return if self.seen - from <= JUDGING_STRIDE {
                self.judge()
            } else {
                Verdict::Open
            };
        };
        self.residuals.push_ends(ends, fitted);
        if self.seen < self.length {
            Verdict::Open
        } else if self.residuals.are_noise() {
            Verdict::Accepted(fitted.clone())
        } else {
            Verdict::Refused
        }
    }

    /// Refuses or accepts the fit, or begins the second pass.
    fn judge(&mut self) -> Verdict {
        match self.trial.fitted(S::ROUNDING) {
            None => Verdict::Refused,
            Some(fitted) if fitted.doubt > 0.0 => {
                self.seen = 0;
                self.residuals.begin(&self.trial);
                self.doubtful = Some(fitted);
                Verdict::Open
            }
            Some(fitted) => Verdict::Accepted(fitted),
        }
    }
}
