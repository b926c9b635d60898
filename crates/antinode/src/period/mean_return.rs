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

/// What the detector does with the stronger signal.
#[derive(Debug, Clone)]
enum Stage {
    /// Finds the range of both signals, until one of them has crossed its middle twice.
    Range {
        low: Pair,
        high: Pair,
        upward: [Upward; 2],
        crossings: [u8; 2],
    },
    /// Takes the mean from one upward crossing of the middle to another.
    Mean {
        middle: f32,
        swing: f32,
        upward: Upward,
        crossings: u16,
        before: f32,
        area: f32,
        lead: f32,
    },
    /// Waits until `samples` have passed: the crest, where the sum leaves and meets zero steeply.
    Crest {
        mean: f32,
        margin: f32,
        samples: u16,
    },
    /// Sums until the sum has returned.
    Sum {
        mean: f32,
        margin: f32,
        upward: Upward,
        sum: f32,
        returns: u16,
    },
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
            trial: Trial::NONE,
        }
    }

    /// Forgets all samples.
    #[inline(never)]
    pub fn restart(&mut self) {
        self.stage = Self::START;
        self.time = 0;
    }

    /// Takes a sample pair; gives the period in samples once it is sure.
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
                    // Those of the weaker pick-off, which may only seem to swing, have no end.
                    crossings[i] = crossings[i].saturating_add(u8::from(crossed));
                }
                let strong = usize::from(swing[1] > swing[0]);
                if crossings[strong] < 2 {
                    return self.wait();
                }
                self.channel = strong;
                Stage::Mean {
                    middle: 0.5 * (high[strong] + low[strong]),
                    swing: swing[strong],
                    upward: Upward::default(),
                    crossings: 0,
                    before: 0.0,
                    area: 0.0,
                    lead: 0.0,
                }
            }
            Stage::Mean {
                middle,
                swing,
                upward,
                crossings,
                before,
                area,
                lead,
            } => {
                let height = value - *middle;
                let rise = height - *before;
                *area += 0.5 * (height + *before);
                *before = height;
                if !upward.crossed(height, 0.25 * *swing) {
                    return self.wait();
                }
                // The crossing itself lies on the line through the last two samples, so long before this one.
                let late = height / rise;
                let triangle = 0.5 * height * late;
                *crossings += 1;
                if *crossings == 1 {
                    (*area, *lead) = (triangle, late);
                    self.time = 0;
                }
                if *crossings <= SPAN {
                    return self.wait();
                }
                let span = f32::from(self.time) + *lead - late;
                let mean = *middle + (*area - triangle) / span;
                let period = span / f32::from(SPAN);
                Stage::Crest {
                    mean,
                    margin: 0.25 * *swing * period / TAU,
                    // The sum's first sample is to stand half a sample past the crest after the next.
                    samples: (1.25 * period - late) as u16,
                }
            }
            Stage::Crest {
                mean,
                margin,
                samples,
            } => {
                if self.time < *samples {
                    return self.wait();
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
                    return self.wait();
                }
                // Of the step that took the sum over zero.
                let late = *sum / step;
                let period = (f32::from(self.time) - late) / f32::from(SPAN);
                let length = (TRIED * period) as usize + 1;
                self.trial.begin(period, length.max(12));
                Stage::Try
            }
            Stage::Try => {
                self.trial.push(pair);
                if !self.trial.is_whole() {
                    return self.wait();
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

    /// Stays in the stage, unless that has taken too long.
    fn wait(&mut self) -> Option<f32> {
        if self.time > LONGEST {
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
