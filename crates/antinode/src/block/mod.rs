//! Samples become block sums: the only work done at sample rate while a wave is tracked, formulas (7) and (24).
//!
//! A block is a fixed count of sample pairs, about one period. Its reference starts anew at every block, centred on the block's
//! middle, so there is no oscillator to run: the phase of the block is applied to its sums later, at block rate. No block need
//! fit the period, and no weight need be exact, because the window solution takes exact sums of the very weights for any length.

mod layout;
mod sums;

pub use layout::Layout;
pub use sums::{ChannelSums, ChannelWatch};

use core::ops::Range;

use crate::sample::{Sample, SamplePair};

/// One sample pair in f32: pick-offs S_C and S_D, sampled together, in input units.
pub type Pair = [f32; 2];

/// A finished block: the sums of both pick-offs, and where it lies in the stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block<S: Sample> {
    /// Index in the stream of the block's first sample pair.
    pub start: u64,
    /// Reference frequency, length and scale.
    pub layout: Layout,
    /// Sums of S_C and of S_D.
    pub sums: [ChannelSums<S>; 2],
    /// What was watched of S_C and of S_D, where it was.
    pub watch: Option<[ChannelWatch<S>; 2]>,
}

/// The weights of a block's samples.
#[derive(Debug, Clone)]
struct Table<W, const N: usize> {
    cosine: [W; N],
    sine: [W; N],
    third_cosine: [W; N],
    third_sine: [W; N],
}

/// Part of a table; nothing where it lies outside, which it never does.
#[inline(always)]
fn part<'a, W>(weights: &'a [W], range: &Range<usize>) -> &'a [W] {
    weights.get(range.clone()).unwrap_or(&[])
}

/// Gathers sample pairs into blocks of up to `N` pairs.
#[derive(Debug, Clone)]
pub struct Demodulator<S: Sample, const N: usize> {
    layout: Layout,
    table: Table<S::Weight, N>,
    /// How much of the table is there: it grows with the first block, so that no sample waits for all of it.
    known: u16,
    start: u64,
    count: u16,
    sums: [ChannelSums<S>; 2],
    watch: Option<[ChannelWatch<S>; 2]>,
}

impl<S: Sample, const N: usize> Demodulator<S, N> {
    /// A demodulator whose first block starts at sample pair `start` of the stream, and which watches the samples or does not.
    ///
    /// A length beyond 1…`N` is brought into it; the scale is that of `S`.
    pub fn new(layout: Layout, start: u64, watch: bool) -> Self {
        let length = layout.length.clamp(1, N.min(usize::from(u16::MAX)) as u16);
        let none = [S::Weight::default(); N];
        Self {
            layout: Layout::new::<S>(layout.step, length),
            table: Table {
                cosine: none,
                sine: none,
                third_cosine: none,
                third_sine: none,
            },
            known: 0,
            start,
            count: 0,
            sums: [ChannelSums::empty(); 2],
            watch: watch.then_some([ChannelWatch::empty(); 2]),
        }
    }

    /// Reference frequency, length and scale of the blocks.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Takes one sample pair; gives the block that it finished.
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<Block<S>> {
        self.push_slice(&[pair]).1
    }

    /// Takes the first pairs of a slice up to the end of the present block; gives how many it took and the block if it is finished.
    ///
    /// Call it again with the rest: the sums are the same to the bit however a stream is cut.
    #[inline]
    pub fn push_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<Block<S>>) {
        let from = usize::from(self.count);
        let open = usize::from(self.layout.length - self.count).min(pairs.len());
        let to = from + open;
        if usize::from(self.known) < to {
            self.extend_table(to);
        }
        let table = &self.table;
        let known = from..to;
        let pairs = pairs.get(..open).unwrap_or(&[]);
        let (cosine, sine) = (part(&table.cosine, &known), part(&table.sine, &known));
        S::add(&mut self.sums, pairs, cosine, sine);
        if let Some(watch) = &mut self.watch {
            let cosine = part(&table.third_cosine, &known);
            let sine = part(&table.third_sine, &known);
            S::watch(watch, pairs, self.count, cosine, sine);
        }
        self.count += open as u16;
        (open, self.finished())
    }

    /// Drops the block begun; the next one starts at sample pair `start` of the stream.
    pub(crate) fn restart(&mut self, start: u64) {
        self.start = start;
        self.count = 0;
        self.sums = [ChannelSums::empty(); 2];
        if let Some(watch) = &mut self.watch {
            *watch = [ChannelWatch::empty(); 2];
        }
    }

    #[cold]
    #[inline(never)]
    fn extend_table(&mut self, to: usize) {
        let table = &mut self.table;
        let entries = table.cosine.iter_mut().zip(&mut table.sine);
        let thirds = table.third_cosine.iter_mut().zip(&mut table.third_sine);
        let new = entries.zip(thirds).take(to).skip(usize::from(self.known));
        for ((cosine, sine), (third_cosine, third_sine)) in new {
            let reference = self.layout.reference(self.known);
            *cosine = S::weight(reference.cosine);
            *sine = S::weight(reference.sine);
            *third_cosine = S::weight(reference.third_cosine);
            *third_sine = S::weight(reference.third_sine);
            self.known += 1;
        }
    }

    #[inline]
    fn finished(&mut self) -> Option<Block<S>> {
        if self.count < self.layout.length {
            return None;
        }
        let block = Block {
            start: self.start,
            layout: self.layout,
            sums: self.sums,
            watch: self.watch,
        };
        self.restart(self.start + u64::from(self.layout.length));
        Some(block)
    }
}
