//! A frame of the search that may hold a wave, tried a few samples at a time: no single call pays for all of it.

use super::octave::{FRAME, Frame};
use super::trial::{Fitted, Rests, Trial};
use crate::sample::Sample;

/// Samples tried in one call, an even number.
const STRIDE: usize = 12;
/// Samples looked at once more in one call: each takes as long as three that are tried.
const LOOKED_AT: usize = 4;
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
    /// A wave that is to be looked at once more, and what it leaves of the samples so far.
    doubt: Option<Fitted>,
    rests: Option<Rests>,
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
            rests: None,
        }
    }

    /// Begins an attempt at a wave of `period` samples in the first `length` of `frame`, an even number. Nothing is tried yet, and of
    /// the frame no more is copied than the next sample may overwrite: to find it took long enough.
    pub(super) fn begin(&mut self, frame: &Frame<S>, length: usize, period: f32) {
        self.frame[0] = frame[0];
        self.length = length;
        self.period = period;
        self.seen = 0;
        self.doubt = None;
        self.rests = None;
    }

    /// Copies the rest of the frame, before the next sample but one.
    pub(super) fn complete(&mut self, frame: &Frame<S>) {
        self.frame[1..].copy_from_slice(&frame[1..]);
    }

    /// Goes on by a few samples.
    pub(super) fn advance(&mut self) -> Verdict {
        let Some(fitted) = &self.doubt else {
            let from = self.seen;
            if from == 0 {
                self.trial.begin(self.period, self.length);
            }
            self.try_some();
            // No other call takes so few.
            return if self.seen - from <= LAST {
                self.judge()
            } else {
                Verdict::Open
            };
        };
        // Once more from the first sample on, in a call of its own: to judge took long enough.
        let Some(rests) = &mut self.rests else {
            self.rests = Some(self.trial.again());
            self.seen = 0;
            return Verdict::Open;
        };
        let from = self.seen;
        self.seen = (from + LOOKED_AT).min(self.length);
        let samples = self.frame.as_flattened();
        for pair in samples.get(from..self.seen).unwrap_or(&[]) {
            rests.push(pair.map(S::to_f32), fitted);
        }
        if self.seen < self.length {
            Verdict::Open
        } else if rests.are_noise() {
            Verdict::Accepted(fitted.clone())
        } else {
            Verdict::Refused
        }
    }

    /// Takes the next samples into the trial, from both ends at once: of the two halves, what comes next.
    fn try_some(&mut self) {
        let from = self.seen;
        self.seen = (from + STRIDE).min(self.length);
        let halves = self.frame.as_flattened().split_at_checked(self.length / 2);
        let (first, last) = halves.unwrap_or((&[], &[]));
        let first = first.get(from / 2..self.seen / 2).unwrap_or(&[]);
        let last = last.get(..(self.length - from) / 2).unwrap_or(&[]);
        let ends = first.iter().zip(last.iter().rev());
        let ends = ends.map(|(&a, &b)| [a.map(S::to_f32), b.map(S::to_f32)]);
        self.trial.push_ends(ends);
    }

    /// What the fit says.
    fn judge(&mut self) -> Verdict {
        match self.trial.fitted() {
            None => Verdict::Refused,
            Some(fitted) if fitted.doubt > 0.0 => {
                self.doubt = Some(fitted);
                Verdict::Open
            }
            Some(fitted) => Verdict::Accepted(fitted),
        }
    }
}
