//! The paper's four methods beside every estimate, with the feature `methods`: their sums are gathered in the interrupt, block by block
//! like the front's, and compared in the main loop.
//!
//! The sums use offsets and a delay from an earlier estimate. Samples are not calibrated, so that the methods are excluded by a calibration
//! other than the ideal one.

use antinode::block::Demodulator;
use antinode::methods::comparison::{Reference, Sums, compare};
use antinode::methods::{Delayed, DelayedSums, MomentSums, Moments, Products, algorithm2};
use antinode::phase::PhaseStep;
use antinode::{Block, Estimate, Flags, Sample, SamplePair};
use antinode_telemetry::Methods;
use heapless::Deque;

use crate::settings::{LONGEST_PERIOD, RING};

/// True if the methods are built in.
pub const AVAILABLE: bool = true;

/// Parameters of the sums, from an estimate of the wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// Delay of a quarter period, samples.
    lag: u16,
    /// Offsets, input units.
    offsets: [f32; 2],
    /// Phase step of the wave's frequency, which the front's demodulator only approximates.
    step: PhaseStep,
}

impl Tuning {
    /// The tuning by an estimate, at a sample rate in Hz.
    pub fn of(estimate: &Estimate, sample_rate: f64) -> Self {
        let step = PhaseStep::from_period((sample_rate / estimate.frequency) as f32);
        Self {
            lag: algorithm2::quarter_lag(step.period()),
            offsets: estimate.offsets,
            step,
        }
    }

    /// True if sums of this tuning serve for an estimate: neither its offsets nor its phase over a window differ beyond their noise.
    pub fn serves(&self, estimate: &Estimate, sample_rate: f64) -> bool {
        let now = Self::of(estimate, sample_rate);
        let samples = estimate.samples as f32;
        let noise = 7.0 * estimate.residual_rms / libm::sqrtf(samples);
        let near = |i: usize| match (self.offsets.get(i), now.offsets.get(i)) {
            (Some(a), Some(b)) => (a - b).abs() <= noise,
            _ => false,
        };
        let turned = (self.step.radians() - now.step.radians()) * samples;
        let unsure = estimate.frequency_std * samples / sample_rate as f32 * core::f32::consts::TAU;
        let still = turned.abs() < 0.01 + 7.0 * unsure;
        self.lag.abs_diff(now.lag) <= 1 && near(0) && near(1) && still
    }
}

/// The sums of one block.
#[derive(Debug, Clone, Copy)]
pub struct BlockSums<S: Sample> {
    tuning: Tuning,
    moments: Moments,
    delayed: Delayed,
    /// The same pairs as the front's block, demodulated at the wave's own frequency.
    block: Block<S>,
}

/// Sums that go with a block, if the methods are on.
pub type Extra<S> = Option<BlockSums<S>>;

/// Unfinished sums.
struct Running<S: Sample> {
    tuning: Tuning,
    moments: MomentSums<S>,
    delayed: DelayedSums<{ LONGEST_PERIOD / 4 }, S>,
    demodulator: Demodulator<S, LONGEST_PERIOD>,
}

/// Gathers the sums of blocks, in the interrupt.
pub struct Gathering<S: Sample> {
    tuning: Option<Tuning>,
    running: Option<Running<S>>,
}

impl<S: Sample> Default for Gathering<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Sample> Gathering<S> {
    /// A gathering that does nothing until it is tuned.
    pub const fn new() -> Self {
        Self {
            tuning: None,
            running: None,
        }
    }

    /// Gathers with this tuning from the next block on, or with `None` nothing.
    pub fn tune(&mut self, tuning: Option<Tuning>) {
        self.tuning = tuning;
        self.running = None;
    }

    /// Discards the unfinished sums, as is necessary after missing pairs.
    pub fn restart(&mut self) {
        self.running = None;
    }

    /// Adds pairs that the front has put into one block, and gives their sums if `block` is finished.
    pub fn add<P: SamplePair<S>>(&mut self, pairs: &[P], block: Option<&Block<S>>) -> Extra<S> {
        let sums = self.running.as_mut().and_then(|running| running.add(pairs));
        let block = block?;
        if sums.is_none() {
            let end = block.start + u64::from(block.layout.length);
            self.running = self
                .tuning
                .map(|tuning| Running::new(tuning, end, block.layout.length));
        }
        sums.filter(|sums| sums.block.start == block.start)
    }
}

impl<S: Sample> Running<S> {
    fn new(tuning: Tuning, start: u64, length: u16) -> Self {
        Self {
            tuning,
            moments: MomentSums::new(tuning.offsets),
            delayed: DelayedSums::new(tuning.lag, tuning.offsets),
            demodulator: Demodulator::new(tuning.step, length, start, false),
        }
    }

    fn add<P: SamplePair<S>>(&mut self, pairs: &[P]) -> Extra<S> {
        self.moments.extend(pairs);
        self.delayed.extend(pairs);
        // This demodulator's blocks begin and end with those of the front.
        let (_, block) = self.demodulator.push_slice(pairs);
        block.map(|&block| BlockSums {
            tuning: self.tuning,
            moments: self.moments.take(),
            delayed: self.delayed.take(),
            block,
        })
    }
}

/// The sums of the last blocks, in the main loop.
pub struct History<S: Sample>(Deque<BlockSums<S>, RING>);

impl<S: Sample> Default for History<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Sample> History<S> {
    /// An empty history.
    pub const fn new() -> Self {
        Self(Deque::new())
    }

    /// Keeps the sums of a block; a block without sums clears the history.
    pub fn keep(&mut self, extra: &Extra<S>) {
        let Some(sums) = extra else {
            return self.0.clear();
        };
        if self.0.is_full() {
            self.0.pop_front();
        }
        let _ = self.0.push_back(*sums);
    }

    /// The methods over the window of an estimate; `None` if the window is not covered by sums of one tuning, or holds no wave.
    pub fn compare(&self, estimate: &Estimate, sample_rate: f64) -> Option<Methods> {
        if estimate.flags.contains(Flags::LOST) {
            return None;
        }
        let pairs = estimate.start..estimate.end();
        let window = |sums: &&BlockSums<S>| pairs.contains(&sums.block.start);
        let inside = || self.0.iter().filter(window);
        let first = inside().next()?;
        let alike = inside().all(|sums| sums.tuning == first.tuning);
        let mut sums = (first.moments, first.delayed);
        for next in inside().skip(1) {
            sums = (sums.0.with(&next.moments), sums.1.with(&next.delayed));
        }
        let (moments, delayed) = sums;
        // After a tuning, delayed products are missing until the delay line is filled.
        let whole = [moments.count, delayed.count] == [estimate.samples; 2];
        if !alike || !whole {
            return None;
        }
        let offsets = first.tuning.offsets.map(f64::from);
        let sums = Sums {
            moments,
            delayed,
            products: Products::from_blocks(inside().map(|sums| &sums.block))?.centred(offsets),
        };
        let reference = Reference::of(estimate, sample_rate);
        Some(Methods::new(estimate.start, &compare(&sums, &reference)))
    }
}
