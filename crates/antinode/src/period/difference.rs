//! Period by the squared difference of the signals from themselves a lag before, formula (10).
//!
//! D(T) = Σ |S(t) − S(t−T)|² over both pick-offs has its first minimum after its first maximum at the period, whatever the
//! offsets. All lags from 4 to 200 samples would cost hundreds of products a sample. Here the stream is halved again and again,
//! each octave sees lags of 1 to 10 of its own samples, and so all octaves together cost no more than twenty lags.

use super::PERIODS;
use super::confirm::Trial;
use crate::block::Pair;
use crate::phase::Phase;

/// Lags of an octave.
const LAGS: usize = 10;
/// Samples of a frame: more than three of the longest periods of its octave.
const FRAME: usize = 32;
/// Octaves: periods of 4 to 8, 8 to 16, … 128 to 256 samples.
const OCTAVES: usize = 6;
/// Periods that an octave answers for, in its own samples: wider than an octave, so that neighbours overlap.
const RANGE: core::ops::RangeInclusive<f32> = 3.7..=9.2;
/// Power lost by halving beyond the wave's own, as a share of the wave's: noise of 20 % loses 0.2.
const STRANGER: f32 = 0.4;
/// Periods that a frame must hold before it is tried.
const HELD: f32 = 2.5;

/// One octave of the stream: a frame of samples and its D(T).
#[derive(Debug, Clone)]
struct Octave {
    frame: [Pair; FRAME],
    count: usize,
    /// D(1)…D(10) over the frame so far.
    difference: [f32; LAGS],
    /// Power that halving takes away, from the last frame that was long enough.
    lost: f32,
    /// The first of two samples that make one of the next octave.
    waiting: Option<Pair>,
}

impl Octave {
    const NEW: Self = Self {
        frame: [[0.0; 2]; FRAME],
        count: 0,
        difference: [0.0; LAGS],
        lost: 0.0,
        waiting: None,
    };

    /// The frame so far.
    fn samples(&self) -> &[Pair] {
        self.frame.get(..self.count).unwrap_or(&[])
    }

    /// Takes a sample; gives the next octave's.
    fn push(&mut self, sample: Pair) -> Option<Pair> {
        if self.count == FRAME {
            self.count = 0;
            self.difference = [0.0; LAGS];
        }
        let past = self.samples().iter().rev();
        let mut difference = self.difference;
        for (sum, before) in difference.iter_mut().zip(past) {
            let (c, d) = (sample[0] - before[0], sample[1] - before[1]);
            *sum += c * c + d * d;
        }
        self.difference = difference;
        if let Some(place) = self.frame.get_mut(self.count) {
            *place = sample;
            self.count += 1;
        }
        if self.count >= 8 {
            // The mean square of half a difference of neighbours.
            self.lost = 0.25 * self.difference[0] / (self.count - 1) as f32;
        }
        match self.waiting.take() {
            None => {
                self.waiting = Some(sample);
                None
            }
            Some(first) => Some([0.5 * (first[0] + sample[0]), 0.5 * (first[1] + sample[1])]),
        }
    }

    /// D(T) a pair of samples, T = 1 to 10; 0 where the frame is too short.
    fn mean_difference(&self, lag: usize) -> f32 {
        match self.difference.get(lag - 1) {
            Some(sum) if self.count > lag => sum / (self.count - lag) as f32,
            _ => 0.0,
        }
    }

    /// The first minimum of D(T) after its first maximum, between samples.
    fn first_minimum(&self) -> Option<f32> {
        let d = |lag| self.mean_difference(lag);
        let mut greatest = d(1);
        for lag in 2..LAGS {
            greatest = greatest.max(d(lag));
            let (before, here, after) = (d(lag - 1), d(lag), d(lag + 1));
            if self.count < lag + 2 || !(here < 0.5 * greatest && here <= before && here < after) {
                continue;
            }
            // About its minimum D(T) = level − depth·cos ω(T − P): three lags give P.
            let ratio = (after - before) / (after + before - 2.0 * here);
            let mut period = lag as f32;
            for _ in 0..2 {
                let omega = core::f32::consts::TAU / period;
                let half = Phase::from_radians(0.5 * omega).unit();
                period = lag as f32 - libm::atan2f(ratio * half.im, half.re) / omega;
            }
            return Some(period);
        }
        None
    }

    /// The period of the frame, in this octave's samples, when there is one; the octaves below, `halvings` of them, lost
    /// `lost_below` of the signal's power.
    fn period(&self, halvings: usize, lost_below: f32) -> Option<f32> {
        if self.count < 12 || self.count % 2 == 1 {
            return None;
        }
        let rough = self.first_minimum().filter(|p| RANGE.contains(p))?;
        if HELD * rough > self.count as f32 {
            return None;
        }
        let samples = self.samples();
        let mut trial = Trial::new(rough, samples.len());
        for &sample in samples {
            trial.push(sample);
        }
        let found = trial.verdict(samples)?;
        // Halving takes little from this wave, and all from a faster one that folds down to the same period or hides it.
        let mut kept = 1.0;
        let mut turn = core::f32::consts::PI / found.period;
        for _ in 0..halvings {
            turn *= 0.5;
            let cosine = Phase::from_radians(turn).unit().re;
            kept *= cosine * cosine;
        }
        let whole = lost_below < found.power * (1.0 / kept - 1.0 + STRANGER);
        (whole && RANGE.contains(&found.period)).then_some(found.period)
    }
}

/// The streaming detector of formula (10): periods of 4 to 200 samples, from cold, with any offset.
///
/// Work a sample: ten lags of an octave, on average of two octaves. White noise is taken for a wave with a chance below 10⁻⁹ a
/// frame; a wave in 20 % noise is found within about four periods, and never at a fraction or a multiple of its period.
#[derive(Debug, Clone)]
pub struct DifferenceDetector {
    octaves: [Octave; OCTAVES],
}

impl DifferenceDetector {
    /// A detector at rest.
    pub const fn new() -> Self {
        Self {
            octaves: [Octave::NEW; OCTAVES],
        }
    }

    /// Takes a sample pair; gives the period in samples once it is sure.
    pub fn push(&mut self, pair: Pair) -> Option<f32> {
        let mut next = Some(pair);
        let mut lost = 0.0;
        let mut scale = 1.0;
        for (halvings, octave) in self.octaves.iter_mut().enumerate() {
            let sample = next?;
            next = octave.push(sample);
            if let Some(period) = octave.period(halvings, lost) {
                return Some(period * scale).filter(|p| PERIODS.contains(p));
            }
            lost += octave.lost;
            scale *= 2.0;
        }
        None
    }
}

impl Default for DifferenceDetector {
    fn default() -> Self {
        Self::new()
    }
}
