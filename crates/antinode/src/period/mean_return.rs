//! Period by the return of the running sum to zero, formula (9).
//!
//! Summed from any start, a centred wave returns to zero after every whole period, moving as it did at the start; the one inner
//! zero of each period is crossed the other way, and is skipped by that. An offset makes the sum run away, so the mean over two
//! whole periods is taken off first, (4). The return rests on few samples: with noise it is rougher than formula (10), and it
//! takes about eleven periods; formula (10) is the default.

use core::f32::consts::TAU;

use super::PERIODS;
use super::trial::Trial;
use crate::block::Pair;
use crate::scalar::{greater, lesser};

/// Whole periods that the mean and the return are measured over.
const SPAN: u16 = 2;
/// Periods that the found period is tried on.
const TRIED: f32 = 3.0;
/// Samples of the longest stage: beyond it there is no period.
const LONGEST: u16 = 800;

/// Tells when a signal has crossed zero upwards, by more than a margin on both sides.
#[derive(Debug, Clone, Copy, Default)]
struct Upward {
    below: bool,
}

impl Upward {
    fn crossed(&mut self, value: f32, margin: f32) -> bool {
        let crossed = self.below && value > margin;
        self.below = value < -margin || self.below && !crossed;
        crossed
    }
}

/// Finds the range of both signals, until the stronger one has crossed its middle twice.
#[derive(Debug, Clone)]
struct Range {
    low: Pair,
    high: Pair,
    upward: [Upward; 2],
    crossings: [u8; 2],
}

impl Range {
    const START: Self = Self {
        low: [f32::INFINITY; 2],
        high: [f32::NEG_INFINITY; 2],
        upward: [Upward { below: false }; 2],
        crossings: [0; 2],
    };

    /// Takes a pair; gives the channel of the stronger signal in the end, and what takes its mean.
    #[inline(always)]
    fn push(&mut self, pair: Pair) -> Option<(usize, Mean)> {
        let mut swing = [0.0; 2];
        let mut middle = [0.0; 2];
        for i in 0..2 {
            self.low[i] = lesser(pair[i], self.low[i]);
            self.high[i] = greater(pair[i], self.high[i]);
            swing[i] = 0.5 * (self.high[i] - self.low[i]);
            middle[i] = 0.5 * (self.high[i] + self.low[i]);
            let crossed = self.upward[i].crossed(pair[i] - middle[i], 0.25 * swing[i]);
            // Those of the weaker pick-off, which may only seem to swing, have no end.
            self.crossings[i] = self.crossings[i].saturating_add(u8::from(crossed));
        }
        let strong = usize::from(swing[1] > swing[0]);
        let mean = || Mean {
            middle: middle[strong],
            swing: swing[strong],
            upward: Upward::default(),
            crossings: 0,
            before: 0.0,
            area: 0.0,
            lead: 0.0,
        };
        (self.crossings[strong] >= 2).then(|| (strong, mean()))
    }
}

/// Takes the mean from one upward crossing of the middle to another.
#[derive(Debug, Clone)]
struct Mean {
    middle: f32,
    swing: f32,
    upward: Upward,
    crossings: u16,
    before: f32,
    area: f32,
    lead: f32,
}

impl Mean {
    /// Takes a sample, so many after the first crossing, which begins the count; gives what waits for the crest in the end.
    #[inline(always)]
    fn push(&mut self, value: f32, time: &mut u16) -> Option<Crest> {
        let height = value - self.middle;
        let rise = height - self.before;
        self.area += 0.5 * (height + self.before);
        self.before = height;
        if !self.upward.crossed(height, 0.25 * self.swing) {
            return None;
        }
        // The crossing itself lies on the line through the last two samples, so long before this one.
        let late = height / rise;
        let triangle = 0.5 * height * late;
        self.crossings += 1;
        if self.crossings == 1 {
            (self.area, self.lead) = (triangle, late);
            *time = 0;
        }
        if self.crossings <= SPAN {
            return None;
        }
        let span = f32::from(*time) + self.lead - late;
        let period = span / f32::from(SPAN);
        Some(Crest {
            mean: self.middle + (self.area - triangle) / span,
            margin: 0.25 * self.swing * period / TAU,
            // The sum's first sample is to stand half a sample past the crest after the next.
            samples: (1.25 * period - late) as u16,
        })
    }
}

/// Waits until `samples` have passed: the crest, where the sum leaves and meets zero steeply.
#[derive(Debug, Clone)]
struct Crest {
    mean: f32,
    margin: f32,
    samples: u16,
}

/// Sums until the sum has returned.
#[derive(Debug, Clone)]
struct Return {
    mean: f32,
    margin: f32,
    upward: Upward,
    sum: f32,
    returns: u16,
}

impl Return {
    /// Takes the sample that is so many after the first; gives the period in the end.
    #[inline(always)]
    fn push(&mut self, value: f32, time: u16) -> Option<f32> {
        let step = value - self.mean;
        self.sum += step;
        // The return itself is the crossing of zero: the margin only arms it.
        self.upward.below |= self.sum < -self.margin;
        if self.upward.below && self.sum >= 0.0 {
            self.upward.below = false;
            self.returns += 1;
        }
        if self.returns < SPAN {
            return None;
        }
        // Of the step that took the sum over zero.
        let late = self.sum / step;
        Some((f32::from(time) - late) / f32::from(SPAN))
    }
}

/// What the detector does with the stronger signal.
#[derive(Debug, Clone)]
enum Stage {
    Range(Range),
    Mean(Mean),
    Crest(Crest),
    Return(Return),
    /// Tries the period found.
    Try,
}

/// The streaming detector of formula (9): periods of 4 to 200 samples. Bounded work a sample: a few additions.
#[derive(Debug, Clone)]
pub struct MeanReturnDetector {
    stage: Stage,
    channel: usize,
    /// Samples in this stage.
    time: u16,
    /// Beside the stage, where it is begun in place.
    trial: Trial,
}

impl MeanReturnDetector {
    /// A detector at rest.
    pub const fn new() -> Self {
        Self {
            stage: Stage::Range(Range::START),
            channel: 0,
            time: 0,
            trial: Trial::NONE,
        }
    }

    /// Forgets all samples.
    #[inline(never)]
    pub fn restart(&mut self) {
        self.stage = Stage::Range(Range::START);
        self.time = 0;
    }

    /// Takes a sample pair; gives the period in samples once it is sure.
    #[must_use = "the period is given once"]
    pub fn push(&mut self, pair: Pair) -> Option<f32> {
        self.time += 1;
        let value = pair[self.channel & 1];
        let next = match &mut self.stage {
            Stage::Range(range) => range.push(pair).map(|(strong, mean)| {
                self.channel = strong;
                Stage::Mean(mean)
            }),
            Stage::Mean(mean) => mean.push(value, &mut self.time).map(Stage::Crest),
            &mut Stage::Crest(Crest {
                mean,
                margin,
                samples,
            }) => (self.time >= samples).then_some(Stage::Return(Return {
                mean,
                margin,
                upward: Upward::default(),
                sum: 0.0,
                returns: 0,
            })),
            Stage::Return(sum) => sum.push(value, self.time).map(|period| {
                let length = (TRIED * period) as usize + 1;
                self.trial.begin(period, length.max(12));
                Stage::Try
            }),
            Stage::Try => {
                self.trial.push(pair);
                if self.trial.is_whole() {
                    self.restart();
                    let found = self.trial.fitted(0.0).map(|found| found.period);
                    return found.filter(|period| PERIODS.contains(period));
                }
                None
            }
        };
        if let Some(next) = next {
            self.stage = next;
            self.time = 0;
        } else if self.time > LONGEST {
            self.restart();
        }
        None
    }
}

impl Default for MeanReturnDetector {
    fn default() -> Self {
        Self::new()
    }
}
