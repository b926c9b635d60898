//! Sums samples in blocks: the only work done at sample rate while a wave is tracked, formulas (7) and (24).
//!
//! A block is a fixed count of sample pairs, up to about two periods. Its reference starts anew at every block, centred on the block's
//! middle, so there is no oscillator to run: the phase of the block is applied to its sums later, at block rate. Blocks need not fit the
//! period, and weights need not be exact: the window's solution uses exact sums of the weights as they are.

mod layout;
mod runs;
mod sums;

pub use layout::Layout;
pub(crate) use layout::Reference;
pub use runs::Runs;
pub use sums::{ChannelSums, ChannelWatch};

use crate::phase::PhaseStep;
use crate::sample::{Sample, SamplePair, Zero};

/// One sample pair in f32: pick-offs S_C and S_D, sampled together, in input units.
pub type Pair = [f32; 2];

/// A finished block: the sums of both pick-offs, and where it lies in the stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block<S: Sample> {
    /// Index in the stream of the block's first sample pair.
    pub start: u64,
    /// Number of the search that found its wave, as given to [`Front::search_if_wanted`](crate::Front::search_if_wanted); 0 before the
    /// first.
    pub search: u32,
    /// Reference frequency, length and scale.
    pub layout: Layout,
    /// Sums of S_C and of S_D.
    pub sums: [ChannelSums<S>; 2],
    /// What was watched of S_C and of S_D; `None` without the watch.
    pub watch: Option<[ChannelWatch<S>; 2]>,
}

/// Pairs held back at most when they are pushed singly: a slice of them costs far less than each by itself.
const MAX_HELD: usize = 32;

/// Gathers sample pairs into blocks of up to `N` pairs. `N` is even, 4 to 65 534.
#[derive(Debug, Clone)]
pub struct Demodulator<S: Sample, const N: usize> {
    /// Pairs held back, and the count at which they are summed together: at the latest when the block ends.
    held: u16,
    room: u16,
    holding: [[S; 2]; MAX_HELD],
    summing: Summing<S, N>,
}

/// The block in progress and its weights.
#[derive(Debug, Clone)]
#[repr(C)]
struct Summing<S: Sample, const N: usize> {
    /// Sample pairs in `block`; when it is full, the next pair begins a new block.
    count: u16,
    /// Samples for which the tables have weights: they grow with the first block, so that no call makes all of them.
    known: u16,
    block: Block<S>,
    weights: S::Weights<N>,
}

impl<S: Sample, const N: usize> Demodulator<S, N> {
    /// A demodulator that has not begun: all zeros.
    pub(crate) const fn unset() -> Self {
        const {
            assert!(
                N.is_multiple_of(2) && N >= 4 && N <= u16::MAX as usize,
                "N, the most sample pairs of a block, must be even and 4 to 65 534"
            );
        }
        Self {
            held: 0,
            room: 0,
            holding: [[S::ZERO; 2]; MAX_HELD],
            summing: Summing {
                count: 0,
                known: 0,
                block: Block {
                    start: 0,
                    search: 0,
                    layout: Layout::unrounded(PhaseStep(0), 0),
                    sums: [ChannelSums::empty(); 2],
                    watch: None,
                },
                weights: S::Weights::ZERO,
            },
        }
    }

    /// A demodulator for blocks of `length` pairs about the frequency `step`, which watches the samples if `watch` is true.
    ///
    /// Its first block starts at sample pair `start` of the stream. A length outside 1…`N` is clamped.
    pub fn new(step: PhaseStep, length: u16, start: u64, watch: bool) -> Self {
        let mut demodulator = Self::unset();
        demodulator.set_watch(watch);
        demodulator.begin(step, length, start);
        demodulator
    }

    /// Reference frequency, length and scale of the blocks.
    pub fn layout(&self) -> Layout {
        self.summing.block.layout
    }

    /// Takes one sample pair; gives the block, if this finished one.
    #[must_use = "the next pair overwrites the block"]
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<&Block<S>> {
        let held = self.held;
        if let Some(place) = self.holding.get_mut(usize::from(held)) {
            *place = pair.pair();
        }
        self.held = held + 1;
        if held + 1 < self.room {
            return None;
        }
        self.sum_held()
    }

    /// Takes the first pairs of a slice up to the end of the present block; gives how many it took and the block if it is finished.
    ///
    /// Call it again with the rest: the sums are the same to the bit however a stream is cut.
    #[must_use = "it stops at the end of a block: call it again with the rest, and hand the block on"]
    #[inline]
    pub fn push_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<&Block<S>>) {
        // With slices nothing is held back, nor is the next single pair: summing it makes room again.
        if self.room > 0 {
            self.hold_no_more();
        }
        let (taken, is_full) = self.summing.sum(pairs);
        (taken, is_full.then_some(&self.summing.block))
    }

    #[cold]
    #[inline(never)]
    fn hold_no_more(&mut self) {
        self.sum_held();
        self.room = 0;
    }

    /// Sums the pairs held back.
    #[inline(never)]
    fn sum_held(&mut self) -> Option<&Block<S>> {
        let held = self.holding.get(..usize::from(self.held));
        self.held = 0;
        let (_, is_full) = self.summing.sum(held.unwrap_or(&[]));
        self.room = self.summing.room();
        is_full.then_some(&self.summing.block)
    }

    /// Number of the search that found the wave of its blocks.
    #[inline(always)]
    pub(crate) fn search(&self) -> u32 {
        self.summing.block.search
    }

    /// Sets the search number of its blocks, from the next beginning on.
    pub(crate) fn set_search(&mut self, number: u32) {
        self.summing.block.search = number;
    }

    /// Begins anew, with blocks of another frequency and length from sample pair `start` of the stream on.
    pub(crate) fn begin(&mut self, step: PhaseStep, length: u16, start: u64) {
        let length = length.clamp(1, N as u16);
        self.summing.block.layout = Layout {
            step,
            length,
            scale: S::scale(length),
        };
        self.summing.known = 0;
        self.restart(start);
    }

    /// Sets whether samples are watched, from the next beginning on.
    pub(crate) fn set_watch(&mut self, watch: bool) {
        self.summing.block.watch = watch.then_some([ChannelWatch::empty(); 2]);
    }

    /// Drops the block begun; the next one starts at sample pair `start` of the stream.
    pub(crate) fn restart(&mut self, start: u64) {
        self.held = 0;
        self.summing.block.start = start;
        self.summing.count = 0;
        self.room = self.summing.room();
    }
}

impl<S: Sample, const N: usize> Summing<S, N> {
    /// Takes pairs up to the end of the block; gives how many, and whether the block is full. The first pair of a block begins its sums and
    /// its watch anew.
    #[inline(always)]
    fn sum<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, bool) {
        let length = usize::from(self.block.layout.length);
        let mut index = usize::from(self.count);
        if index >= length {
            self.block.start = self.block.start.wrapping_add(length as u64);
            index = 0;
        }
        let pairs = pairs.get(..length - index).unwrap_or(pairs);
        let count = index + pairs.len();
        self.count = count as u16;
        if usize::from(self.known) < count {
            self.extend_table();
        }
        let index = index as u16;
        let Block { sums, watch, .. } = &mut self.block;
        S::add_slice(sums, watch, pairs, &self.weights, index);
        (pairs.len(), count == length)
    }

    /// Count at which held pairs are summed, so that no call takes long: one while the tables grow, and never beyond the end of the block.
    #[inline(always)]
    fn room(&self) -> u16 {
        let length = self.block.layout.length;
        if self.known < length {
            return 1;
        }
        let left = if self.count < length {
            length - self.count
        } else {
            length
        };
        let max_held = if self.block.watch.is_some() {
            S::WATCHED_AT_ONCE
        } else {
            MAX_HELD as u16
        };
        left.min(max_held)
    }

    /// Makes the tables as long as the block so far.
    #[cold]
    #[inline(never)]
    fn extend_table(&mut self) {
        for index in self.known..self.count {
            let reference = self.block.layout.reference(index);
            S::set_weights(&mut self.weights, usize::from(index), reference);
        }
        self.known = self.count;
    }
}
