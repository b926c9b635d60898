//! Samples become block sums: the only work done at sample rate while a wave is tracked, formulas (7) and (24).
//!
//! A block is a fixed count of sample pairs, about one period. Its reference starts anew at every block, centred on the block's
//! middle, so there is no oscillator to run: the phase of the block is applied to its sums later, at block rate. No block need
//! fit the period, because the window solution takes exact sums for any length.

use crate::phase::PhaseStep;

/// One sample pair: pick-offs S_C and S_D, sampled together, in input units.
pub type Pair = [f32; 2];

/// What a block is: its reference frequency and its count of sample pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Reference frequency. Within 1 % of the wave's for the stated accuracy.
    pub step: PhaseStep,
    /// Sample pairs in a block, 1 to the capacity of the [`Demodulator`].
    pub length: u16,
}

/// The reference at one sample of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Reference {
    pub cosine: f32,
    pub sine: f32,
    pub third_cosine: f32,
    pub third_sine: f32,
}

impl Layout {
    /// Twice the time from the middle of the block to sample `index`, in samples.
    pub(crate) fn twice_from_middle(self, index: u16) -> i64 {
        2 * i64::from(index) + 1 - i64::from(self.length)
    }

    /// The reference at sample `index`: the same on the demodulator's side and the solution's, so nothing is handed over.
    pub(crate) fn reference(self, index: u16) -> Reference {
        let phase = self.step.after_half_samples(self.twice_from_middle(index));
        let first = phase.unit();
        let third = crate::phase::Phase(phase.0.wrapping_mul(3)).unit();
        Reference {
            cosine: first.re,
            sine: first.im,
            third_cosine: third.re,
            third_sine: third.im,
        }
    }
}

/// The running sums of one pick-off over one block, in input units times samples.
///
/// Bound: each sum is at most `length` × the largest |sample|; with 65 535 samples of ±1 the f32 sums stay exact to 2⁻²⁴ of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelSums {
    /// Σ S cos φ, the C sum of (24).
    pub cosine: f32,
    /// Σ S sin φ, the S sum of (24).
    pub sine: f32,
    /// Σ S, which carries the offset.
    pub sum: f32,
    /// Σ S cos 3φ: the third harmonic, where clipping and nonlinearity show.
    pub third_cosine: f32,
    /// Σ S sin 3φ.
    pub third_sine: f32,
    /// The least sample.
    pub low: f32,
    /// The greatest sample.
    pub high: f32,
    /// Most samples in a row that were equal to `low`: one, unless the signal is cut off.
    pub low_run: u16,
    /// Most samples in a row that were equal to `high`.
    pub high_run: u16,
    last: f32,
    run: u16,
}

impl ChannelSums {
    const EMPTY: Self = Self {
        cosine: 0.0,
        sine: 0.0,
        sum: 0.0,
        third_cosine: 0.0,
        third_sine: 0.0,
        low: f32::INFINITY,
        high: f32::NEG_INFINITY,
        low_run: 0,
        high_run: 0,
        last: f32::NAN,
        run: 0,
    };

    #[inline(always)]
    fn add(&mut self, sample: f32, reference: &Reference) {
        self.cosine += sample * reference.cosine;
        self.sine += sample * reference.sine;
        self.sum += sample;
        self.third_cosine += sample * reference.third_cosine;
        self.third_sine += sample * reference.third_sine;
        self.run = if sample == self.last { self.run + 1 } else { 1 };
        self.last = sample;
        if sample <= self.low {
            self.low_run = if sample < self.low {
                self.run
            } else {
                self.low_run.max(self.run)
            };
            self.low = sample;
        }
        if sample >= self.high {
            self.high_run = if sample > self.high {
                self.run
            } else {
                self.high_run.max(self.run)
            };
            self.high = sample;
        }
    }
}

/// A finished block: the sums of both pick-offs, and where it lies in the stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Index in the stream of the block's first sample pair.
    pub start: u64,
    /// Reference frequency and length.
    pub layout: Layout,
    /// Sums of S_C and of S_D.
    pub channels: [ChannelSums; 2],
}

/// Gathers sample pairs into blocks of up to `N` pairs.
#[derive(Debug, Clone)]
pub struct Demodulator<const N: usize> {
    layout: Layout,
    table: [Reference; N],
    start: u64,
    count: u16,
    sums: [ChannelSums; 2],
}

impl<const N: usize> Demodulator<N> {
    /// A demodulator whose first block starts at sample pair `start` of the stream. A length beyond 1…`N` is brought into it.
    pub fn new(layout: Layout, start: u64) -> Self {
        let length = layout.length.clamp(1, N as u16);
        let layout = Layout { length, ..layout };
        let mut table = [Reference::default(); N];
        for (index, entry) in (0..length).zip(&mut table) {
            *entry = layout.reference(index);
        }
        Self {
            layout,
            table,
            start,
            count: 0,
            sums: [ChannelSums::EMPTY; 2],
        }
    }

    /// Reference frequency and length of the blocks.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Takes one sample pair; gives the block that it finished.
    #[inline]
    pub fn push(&mut self, pair: Pair) -> Option<Block> {
        self.push_slice(&[pair]).1
    }

    /// Takes the first pairs of a slice up to the end of the present block; gives how many it took and the block if it is finished.
    ///
    /// Call it again with the rest: the sums are the same to the bit however a stream is cut.
    #[inline]
    pub fn push_slice(&mut self, pairs: &[Pair]) -> (usize, Option<Block>) {
        let open = usize::from(self.layout.length - self.count).min(pairs.len());
        let from = usize::from(self.count);
        let mut sums = self.sums;
        let table = self.table.get(from..from + open).unwrap_or(&[]);
        for (pair, reference) in pairs.iter().zip(table) {
            sums[0].add(pair[0], reference);
            sums[1].add(pair[1], reference);
        }
        self.sums = sums;
        self.count += open as u16;
        (open, self.finished())
    }

    /// Drops the block begun; the next one starts at sample pair `start` of the stream.
    pub(crate) fn restart(&mut self, start: u64) {
        self.start = start;
        self.count = 0;
        self.sums = [ChannelSums::EMPTY; 2];
    }

    #[inline]
    fn finished(&mut self) -> Option<Block> {
        if self.count < self.layout.length {
            return None;
        }
        let block = Block {
            start: self.start,
            layout: self.layout,
            channels: self.sums,
        };
        self.restart(self.start + u64::from(self.layout.length));
        Some(block)
    }
}
