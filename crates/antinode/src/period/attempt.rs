//! A frame of the search that may hold a wave, tried a few samples at a time: no single call pays for all of it.

use super::confirm::{Fitted, Rests, Trial};
use super::difference::FRAME;
use crate::sample::Sample;

/// Samples tried in one call.
const STRIDE: usize = 16;

/// A copy of a frame under trial, which the stream meanwhile overwrites.
#[derive(Debug, Clone)]
pub(super) struct Attempt<S: Sample> {
    frame: [[S; 2]; FRAME],
    length: usize,
    /// Samples seen in this pass.
    seen: usize,
    trial: Trial,
    doubt: Option<(Fitted, Rests)>,
}

/// Where an attempt stands.
pub(super) enum Verdict {
    Open,
    Refused,
    Accepted(Fitted),
}

impl<S: Sample> Attempt<S> {
    /// An attempt at nothing.
    pub(super) fn new() -> Self {
        Self {
            frame: [[S::EXTREMES[0]; 2]; FRAME],
            length: 0,
            seen: 0,
            trial: Trial::new(4.0, 0),
            doubt: None,
        }
    }

    /// Begins an attempt at a wave of `period` samples in the first `length` of `frame`.
    pub(super) fn begin(&mut self, frame: &[[S; 2]; FRAME], length: usize, period: f32) {
        self.frame = *frame;
        self.length = length;
        self.seen = 0;
        self.trial = Trial::new(period, length);
        self.doubt = None;
    }

    /// Goes on by a few samples.
    pub(super) fn advance(&mut self) -> Verdict {
        let to = (self.seen + STRIDE).min(self.length);
        let samples = self.frame.get(self.seen..to).unwrap_or(&[]);
        for pair in samples {
            let pair = pair.map(S::to_f32);
            match &mut self.doubt {
                None => {
                    self.trial.push(pair);
                }
                Some((_, rests)) => rests.push(pair),
            }
        }
        self.seen = to;
        if self.seen < self.length {
            return Verdict::Open;
        }
        match self.doubt.take() {
            None => match self.trial.fitted() {
                None => Verdict::Refused,
                Some(fitted) if fitted.is_doubtful => {
                    self.seen = 0;
                    let rests = self.trial.again(&fitted);
                    self.doubt = Some((fitted, rests));
                    Verdict::Open
                }
                Some(fitted) => Verdict::Accepted(fitted),
            },
            Some((fitted, rests)) if rests.are_noise() => Verdict::Accepted(fitted),
            Some(_) => Verdict::Refused,
        }
    }
}
