//! Says whether a stretch of samples is one wave of about the period proposed, and refines the period.

use num_complex::Complex32;

use crate::block::Pair;
use crate::phase::PhaseStep;
use crate::window::Normal;

/// The share of the signal's power that a wave may leave unexplained; 20 % noise leaves 14 %.
const UNEXPLAINED: f32 = 0.3;
/// Chance that white noise passes, for each trial.
const FALSE_ALARM: f32 = 1e-11;
/// Unexplained share above which the rest must look like noise, not like a second tone.
const TONE: f32 = 2e-3;

/// A wave, its slope and an offset, fitted to a stretch of samples of known length.
#[derive(Debug, Clone)]
pub(crate) struct Trial {
    step: PhaseStep,
    length: usize,
    count: usize,
    normal: Normal,
    gradient: [[f32; 5]; 2],
    sum: [f32; 2],
    square: f32,
}

/// What a trial says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Confirmed {
    /// Period in samples.
    pub period: f32,
    /// Variance of the samples, both pick-offs together.
    pub power: f32,
}

impl Trial {
    /// A trial of `period` samples over a stretch of `length`.
    pub(crate) fn new(period: f32, length: usize) -> Self {
        Self {
            step: PhaseStep::from_period(period),
            length,
            count: 0,
            normal: Normal::ZERO,
            gradient: [[0.0; 5]; 2],
            sum: [0.0; 2],
            square: 0.0,
        }
    }

    fn row(&self, index: usize) -> [f32; 5] {
        let twice = 2 * index as i64 + 1 - self.length as i64;
        let u = twice as f32 / self.length as f32;
        let Complex32 { re: c, im: s } = self.step.after_half_samples(twice).unit();
        [c, -s, u * c, -u * s, 1.0]
    }

    /// Takes the next sample; true when the stretch is whole.
    pub(crate) fn push(&mut self, sample: Pair) -> bool {
        let row = self.row(self.count);
        self.normal.add(&row);
        for (channel, value) in sample.into_iter().enumerate() {
            self.sum[channel] += value;
            self.square += value * value;
            for (sum, weight) in self.gradient[channel].iter_mut().zip(row) {
                *sum += weight * value;
            }
        }
        self.count += 1;
        self.count == self.length
    }

    /// The verdict, once the stretch is whole; `samples` are the same again where they are at hand, to tell noise from a tone.
    pub(crate) fn verdict(&self, samples: &[Pair]) -> Option<Confirmed> {
        let mut normal = self.normal;
        normal.factorise();
        let n = self.length as f32;
        let fits = self.gradient.map(|gradient| normal.solve(gradient));
        let mut explained = 0.0;
        let mut turned = 0.0;
        let mut size = 0.0;
        for (gradient, x) in self.gradient.iter().zip(&fits) {
            explained += gradient.iter().zip(x).map(|(g, x)| g * x).sum::<f32>();
            let (z, change) = (Complex32::new(x[0], x[1]), Complex32::new(x[2], x[3]));
            turned += (change * z.conj()).im;
            size += z.norm_sqr();
        }
        let power = self.square - (self.sum[0] * self.sum[0] + self.sum[1] * self.sum[1]) / n;
        if !(power > 1e-6 * self.square && size > 0.0) {
            return None;
        }
        let rest = ((self.square - explained) / power).max(1e-6);
        let drift = turned / size;
        if !(rest < UNEXPLAINED && by_chance(rest, self.length) < FALSE_ALARM && drift.abs() < 1.0)
        {
            return None;
        }
        if rest > TONE {
            let [one, two] = correlations(samples.iter().enumerate().map(|(k, sample)| {
                let row = self.row(k);
                core::array::from_fn(|channel| {
                    let wave = fits[channel].iter().zip(row).map(|(x, weight)| x * weight);
                    sample[channel] - wave.sum::<f32>()
                })
            }));
            // Noise has neither; a second tone slower than twice the wave has one or the other.
            if one > 0.5 || two < -0.6 {
                return None;
            }
        }
        let period = self.step.shifted(2.0 * drift / n).period();
        Some(Confirmed {
            period,
            power: power / n,
        })
    }
}

/// The chance that noise leaves less than `rest` of 2n numbers less ten parameters: rest^(n−5).
fn by_chance(rest: f32, n: usize) -> f32 {
    // Longer stretches only make it smaller.
    (5..n.min(64)).fold(1.0, |chance, _| chance * rest)
}

/// Correlation of residuals with those one and two samples before; zeros when there are none.
fn correlations(rests: impl Iterator<Item = Pair>) -> [f32; 2] {
    let mut sums = [f32::MIN_POSITIVE, 0.0, 0.0];
    let mut before = [[0.0f32; 2]; 2];
    for rest in rests {
        for (sum, other) in sums.iter_mut().zip([rest, before[0], before[1]]) {
            *sum += rest[0] * other[0] + rest[1] * other[1];
        }
        before = [rest, before[0]];
    }
    [sums[1] / sums[0], sums[2] / sums[0]]
}
