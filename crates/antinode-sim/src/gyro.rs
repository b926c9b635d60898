//! The stream of samples.

use crate::adc::Adc;
use crate::dropouts::Dropouts;
use crate::error::{Error, positive};
use crate::flaws::Flaws;
use crate::front::{Front, Input};
use crate::spans::{Span, Spans, check_apart};
use crate::time::Instant;
use crate::timed::Channel;
use crate::wave::{Truth, Wave};

/// The last index that is an exact `f64`.
const MAX_INDEX: u64 = 1 << 53;

/// A synthetic gyro: an endless iterator of its sample pairs, [S_C, S_D] of (2), input units.
///
/// Sample `k` of true time is at `k` / sample rate s. It is a function of the arguments of [`Gyro::new`] and `k` alone, so lost samples
/// change none of the others. [`Iterator::nth`] and [`Iterator::skip`] jump at no cost, except that coloured noise is computed all the way.
#[derive(Debug, Clone)]
pub struct Gyro {
    wave: Wave,
    sample_rate: f64,
    front: Front,
    /// Dropouts of C and of D.
    dropouts: [Dropouts; 2],
    clip: f64,
    clip_spans: Spans<f64>,
    adc: Option<Adc>,
    lost: Spans<()>,
    next: u64,
}

impl Gyro {
    /// A gyro with this wave and these flaws, sampled at `sample_rate` Hz (above 0).
    ///
    /// `seed` chooses the noise and the jitter, which do not depend on each other or on any other flaw.
    ///
    /// # Errors
    ///
    /// The first of the faults listed in [`Error`] that is found, except [`Error::NoBits`].
    pub fn new(wave: Wave, flaws: Flaws, sample_rate: f64, seed: u64) -> Result<Gyro, Error> {
        positive("sample_rate", sample_rate)?;
        wave.check()?;
        flaws.check()?;
        let front = Front::new(wave, &flaws, sample_rate, seed);
        let dropouts = |channel| Dropouts::new(&flaws, channel, sample_rate);
        let dropouts = [dropouts(Channel::C)?, dropouts(Channel::D)?];
        let clips: Result<Vec<_>, _> = flaws
            .clip_spans
            .iter()
            .map(|clip| Span::of_times(clip.from, clip.to, sample_rate, clip.level, "clip_spans"))
            .collect();
        let clip_spans = Spans::new(clips?);
        check_apart(clip_spans.all(), "clip_spans")?;
        let lost: Result<Vec<_>, _> = flaws
            .lost
            .iter()
            .map(|loss| match loss.at.checked_add(loss.count) {
                Some(end) if end <= MAX_INDEX => Ok(Span {
                    first: loss.at,
                    end,
                    what: (),
                }),
                _ => Err(Error::EndlessLoss {
                    at: loss.at,
                    count: loss.count,
                }),
            })
            .collect();
        let mut gyro = Gyro {
            wave,
            sample_rate,
            front,
            dropouts,
            clip: flaws.clip.unwrap_or(f64::INFINITY),
            clip_spans,
            adc: Adc::new(&flaws),
            lost: Spans::new(lost?),
            next: 0,
        };
        gyro.pass_lost();
        Ok(gyro)
    }

    /// The index, in true time, of the next sample to be given (lost samples count, but are never given).
    pub fn index(&self) -> u64 {
        self.next
    }

    /// The true wave at sample `index` of true time, whether lost or not.
    pub fn truth_at(&self, index: u64) -> Truth {
        self.wave
            .at_instant(Instant::of_sample(index, self.sample_rate))
    }

    /// The ADC's codes [C, D] from the next sample on, in place of their values.
    ///
    /// # Errors
    ///
    /// [`Error::NoBits`] if [`Flaws::bits`] is `None`.
    pub fn codes(self) -> Result<Codes, Error> {
        let adc = self.adc.ok_or(Error::NoBits)?;
        Ok(Codes { gyro: self, adc })
    }

    /// Moves `next` past the losses in which it lies.
    fn pass_lost(&mut self) {
        while let Some(span) = self.lost.at(self.next) {
            self.next = span.end;
        }
    }

    /// The next sample before the ADC.
    fn analogue(&mut self) -> [f64; 2] {
        let index = self.next;
        let [c, d] = &mut self.dropouts;
        let fills = [c, d].map(|dropouts| dropouts.at(index, &mut self.front));
        let Input { signal, floor } = self.front.at(index);
        let mut pair = signal;
        for (i, fill) in fills.iter().enumerate() {
            if let Some(fill) = fill {
                pair[i] = fill.value(floor[i]);
            }
        }
        let level = self
            .clip_spans
            .at(index)
            .map_or(self.clip, |span| span.what.min(self.clip));
        self.next = self.next.saturating_add(1);
        self.pass_lost();
        pair.map(|s| s.max(-level).min(level))
    }

    /// Skips `count` samples that would have been given.
    fn pass(&mut self, mut count: u64) {
        while let Some(loss) = self.lost.from(self.next)
            && loss.first - self.next <= count
        {
            count -= loss.first - self.next;
            self.next = loss.end;
            self.pass_lost();
        }
        self.next = self.next.saturating_add(count);
    }
}

impl Iterator for Gyro {
    type Item = [f64; 2];

    fn next(&mut self) -> Option<[f64; 2]> {
        let pair = self.analogue();
        Some(match &self.adc {
            Some(adc) => pair.map(|s| adc.value(s)),
            None => pair,
        })
    }

    fn nth(&mut self, n: usize) -> Option<[f64; 2]> {
        self.pass(n as u64);
        self.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (usize::MAX, None)
    }
}

/// The ADC codes of a gyro, an endless iterator of [C, D]: see [`Gyro::codes`].
#[derive(Debug, Clone)]
pub struct Codes {
    gyro: Gyro,
    adc: Adc,
}

impl Codes {
    /// The index, in true time, of the next sample to be given.
    pub fn index(&self) -> u64 {
        self.gyro.index()
    }
}

impl Iterator for Codes {
    type Item = [i32; 2];

    fn next(&mut self) -> Option<[i32; 2]> {
        Some(self.gyro.analogue().map(|s| self.adc.code(s)))
    }

    fn nth(&mut self, n: usize) -> Option<[i32; 2]> {
        self.gyro.pass(n as u64);
        self.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (usize::MAX, None)
    }
}

#[cfg(test)]
mod tests;
