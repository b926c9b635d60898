//! Period by the return of the running sum to zero, formula (9).
//!
//! The sum of a centred wave, from any start, returns to zero after every whole period, in the direction in which it left; its one
//! zero within a period is crossed in the other direction, and so is told apart. An offset would make the sum run away, so the mean
//! over two whole periods is subtracted first, (4). The return depends on few samples: in noise it is less precise than formula (10),
//! the default, and it takes about eleven periods.

use core::f32::consts::TAU;

use super::PERIODS;
use super::trial::Trial;
use crate::block::Pair;
use crate::scalar::{greater, lesser};

/// Whole periods over which the mean and the return are measured.
const SPAN: u16 = 2;
/// Length of the trial of a period found, in periods.
const TRIAL_PERIODS: f32 = 3.0;
/// Samples that a stage may take: after more, the search begins anew.
const MAX_STAGE: u16 = 800;
/// Periods in which the sum of a wave has returned [`SPAN`] times.
const MAX_SUM: f32 = 3.0;

/// Detects upward crossings of zero that exceed a margin on both sides.
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

/// Stage of the search; all but the first follow the stronger signal.
#[derive(Debug, Clone)]
enum Stage {
    /// Finds the range of both signals, until one of them has crossed its middle twice.
    Range {
        low: Pair,
        high: Pair,
        upward: [Upward; 2],
        crossings: [u8; 2],
    },
    /// Measures the mean between two upward crossings of the middle.
    Mean {
        middle: f32,
        swing: f32,
        upward: Upward,
        crossings: u16,
        before: f32,
        area: f32,
        first_overshoot: f32,
    },
    /// Waits `samples` samples, until the crest: a sum that begins there leaves and meets zero steeply.
    Crest {
        mean: f32,
        margin: f32,
        samples: u16,
    },
    /// Sums until the sum has returned to zero.
    Sum {
        mean: f32,
        margin: f32,
        upward: Upward,
        sum: f32,
        returns: u16,
    },
    /// Fits a wave of the period found.
    Try,
}

/// Streaming detector of formula (9): periods of 4.6 to 200 samples. From 4 samples on it finds shorter ones too, but one wave in six of
/// fewer than 4.2 samples, and one in twenty of more, takes 20 to 400 periods, and one in ten of exactly 4 samples is never found. The work
/// per sample is bounded: a few additions.
#[derive(Debug, Clone)]
pub struct MeanReturnDetector {
    stage: Stage,
    channel: usize,
    /// Samples since this stage began, or since the first crossing in `Stage::Mean`.
    time: u16,
    /// Samples that `Stage::Sum` may take: with the mean of noise or of a wave's beginning the sum never returns.
    longest_sum: u16,
    /// Not in `Stage::Try`, so that it can be begun in place.
    trial: Trial,
}

impl MeanReturnDetector {
    const START: Stage = Stage::Range {
        low: [f32::INFINITY; 2],
        high: [f32::NEG_INFINITY; 2],
        upward: [Upward { below: false }; 2],
        crossings: [0; 2],
    };

    /// A detector at rest.
    pub const fn new() -> Self {
        Self {
            stage: Self::START,
            channel: 0,
            time: 0,
            longest_sum: 0,
            trial: Trial::NONE,
        }
    }

    /// Forgets all samples.
    #[inline(never)]
    pub fn restart(&mut self) {
        self.stage = Self::START;
        self.time = 0;
    }

    /// Takes a sample pair, and gives the period in samples once it is certain.
    #[must_use = "the period is given once"]
    pub fn push(&mut self, pair: Pair) -> Option<f32> {
        self.time += 1;
        let value = pair[self.channel & 1];
        let next = match &mut self.stage {
            Stage::Range {
                low,
                high,
                upward,
                crossings,
            } => {
                let mut swing = [0.0; 2];
                for i in 0..2 {
                    low[i] = lesser(pair[i], low[i]);
                    high[i] = greater(pair[i], high[i]);
                    swing[i] = 0.5 * (high[i] - low[i]);
                    let height = pair[i] - 0.5 * (high[i] + low[i]);
                    let crossed = upward[i].crossed(height, 0.25 * swing[i]);
                    // Saturating: the weaker pick-off, in which there may be only noise, can cross any number of times.
                    crossings[i] = crossings[i].saturating_add(u8::from(crossed));
                }
                let strong = usize::from(swing[1] > swing[0]);
                if crossings[strong] < 2 {
                    return self.wait(MAX_STAGE);
                }
                self.channel = strong;
                Stage::Mean {
                    middle: 0.5 * (high[strong] + low[strong]),
                    swing: swing[strong],
                    upward: Upward::default(),
                    crossings: 0,
                    before: 0.0,
                    area: 0.0,
                    first_overshoot: 0.0,
                }
            }
            Stage::Mean {
                middle,
                swing,
                upward,
                crossings,
                before,
                area,
                first_overshoot,
            } => {
                let height = value - *middle;
                let rise = height - *before;
                *area += 0.5 * (height + *before);
                *before = height;
                if !upward.crossed(height, 0.25 * *swing) {
                    return self.wait(MAX_STAGE);
                }
                // Time from the crossing to this sample, by the line through the last two samples.
                let overshoot = height / rise;
                let triangle = 0.5 * height * overshoot;
                *crossings += 1;
                if *crossings == 1 {
                    (*area, *first_overshoot) = (triangle, overshoot);
                    self.time = 0;
                }
                if *crossings <= SPAN {
                    return self.wait(MAX_STAGE);
                }
                let span = f32::from(self.time) + *first_overshoot - overshoot;
                let mean = *middle + (*area - triangle) / span;
                let period = span / f32::from(SPAN);
                self.longest_sum = (MAX_SUM * period) as u16 + 2;
                Stage::Crest {
                    mean,
                    margin: 0.25 * *swing * period / TAU,
                    // The sum's first sample should lie half a sample past the second crest from here.
                    samples: (1.25 * period - overshoot) as u16,
                }
            }
            Stage::Crest {
                mean,
                margin,
                samples,
            } => {
                if self.time < *samples {
                    return self.wait(MAX_STAGE);
                }
                Stage::Sum {
                    mean: *mean,
                    margin: *margin,
                    upward: Upward::default(),
                    sum: 0.0,
                    returns: 0,
                }
            }
            Stage::Sum {
                mean,
                margin,
                upward,
                sum,
                returns,
            } => {
                let step = value - *mean;
                *sum += step;
                // The return itself is the crossing of zero: the margin only arms it.
                upward.below |= *sum < -*margin;
                if upward.below && *sum >= 0.0 {
                    upward.below = false;
                    *returns += 1;
                }
                if *returns < SPAN {
                    return self.wait(self.longest_sum);
                }
                // Part of the last step that lies beyond zero.
                let overshoot = *sum / step;
                let period = (f32::from(self.time) - overshoot) / f32::from(SPAN);
                let length = (TRIAL_PERIODS * period) as usize + 1;
                self.trial.begin(period, length.max(12));
                Stage::Try
            }
            Stage::Try => {
                self.trial.push(pair);
                if !self.trial.is_whole() {
                    return self.wait(MAX_STAGE);
                }
                self.restart();
                let found = self.trial.fitted(0.0).map(|found| found.period);
                return found.filter(|period| PERIODS.contains(period));
            }
        };
        self.stage = next;
        self.time = 0;
        None
    }

    /// Stays in the stage, or restarts if it has taken more than `longest` samples.
    fn wait(&mut self, longest: u16) -> Option<f32> {
        if self.time > longest {
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
