//! What the core does with samples of a type at sample rate, and with their sums at block rate.

use core::fmt::Debug;

use super::{Form, Sample, SamplePair, Zero};
use crate::block::{ChannelSums, ChannelWatch, Reference};
use crate::period::Lags;

/// The arithmetic of a [`Sample`]. It has no public path: no other type can have one.
pub trait Arithmetic: Zero {
    /// A running sum of weighted samples.
    type Sum: Copy + Debug + PartialEq + Send + Zero;
    /// The runs of equal samples that are kept.
    type Runs: Copy + Debug + PartialEq + Default + Send;
    /// The reference at every sample of a block, and its third harmonic unless that is computed from the reference.
    type Weights<const N: usize>: Copy + Debug + Send + Zero;
    /// A running sum of squared differences.
    type Square: Copy + Debug + Send + Zero;
    /// A mean squared difference, to be compared with others.
    type Level: Copy + Debug + PartialOrd + Send;
    /// A pair less its offsets, as the sums of products take it.
    type Centred: Copy + Debug + Default + Send;
    /// A running sum of products.
    type Product: Copy + Debug + Default + Send;

    /// Layout of a pair in memory.
    const FORM: Form;
    /// No sample is less than the first or more than the second.
    const EXTREMES: [Self; 2];
    /// Singly pushed pairs that are summed and watched together, at most 32: no more than fit between two samples of a fast converter.
    const WATCHED_AT_ONCE: u16;
    /// Power that rounding adds to a pair in [`search_form`](Self::search_form), less the three tenths of it that a short trial of the
    /// search takes for a wave.
    const ROUNDING: f32;

    /// The sample in f32.
    fn to_f32(self) -> f32;
    /// A sum in f32.
    fn sum_to_f32(sum: Self::Sum) -> f32;
    /// The weight that stands for one in a block of `length`: the largest whose sums cannot overflow; 0 for weights not rounded.
    fn scale(length: u16) -> u16;
    /// Puts the weights of sample `index` into their places.
    fn set_weights<const N: usize>(
        weights: &mut Self::Weights<N>,
        index: usize,
        reference: Reference,
    );
    /// Adds pairs, the first of which is sample `index` of its block, to sums and watch, both of which begin anew if `index` is 0.
    ///
    /// The table must have weights for all of them; else what is added means nothing.
    fn add_slice<P: SamplePair<Self>, const N: usize>(
        sums: &mut [ChannelSums<Self>; 2],
        watch: &mut Option<[ChannelWatch<Self>; 2]>,
        pairs: &[P],
        weights: &Self::Weights<N>,
        index: u16,
    ) where
        Self: Sample;
    /// Σ S cos 3φ and Σ S sin 3φ, in f32.
    #[inline(always)]
    fn third(_: &ChannelSums<Self>, watch: &ChannelWatch<Self>) -> [f32; 2]
    where
        Self: Sample,
    {
        [watch.third_cosine, watch.third_sine].map(Self::sum_to_f32)
    }

    /// The longest runs at the low and the high extreme; 1 where they are not counted, as for codes.
    #[inline(always)]
    fn runs(_: &ChannelWatch<Self>) -> [u16; 2]
    where
        Self: Sample,
    {
        [1; 2]
    }

    /// Offsets in input units, to be taken off by [`centred`](Self::centred).
    fn offsets(offsets: [f32; 2]) -> Self::Centred;
    /// A pair less its offsets.
    fn centred(pair: [Self; 2], offsets: Self::Centred) -> Self::Centred;
    /// Adds the products of C with C, D with D and C with D of a pair.
    fn add_products(sums: &mut [Self::Product; 3], pair: Self::Centred);
    /// Adds the products of a pair with one before it: of C with C and D with D together, and of C with D.
    fn add_delayed(sums: &mut [Self::Product; 2], now: Self::Centred, before: Self::Centred);
    /// A sum of products in input units squared.
    fn product_to_f64(sum: Self::Product) -> f64;

    /// The sample as the search for a period takes it: of 16-bit codes, less two bits.
    fn search_form(self) -> Self;
    /// Adds the squared difference of two pairs, both in [`search_form`](Self::search_form).
    fn add_difference(sum: &mut Self::Square, a: [Self; 2], b: [Self; 2]);
    /// The mean of two pairs, for the next octave of the period search.
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2];
    /// A sum of squared differences in f32, input units squared.
    fn square_to_f32(square: Self::Square) -> f32;
    /// Shift of the sums, in bits, with which [`level`](Self::level) loses none of their digits.
    fn shift(sums: &Lags<Self>) -> u32;
    /// A sum of `count` pairs, at most a frame of the search, as a mean: only the ratios of levels mean anything.
    fn level(sum: Self::Square, shift: u32, count: usize) -> Self::Level;
    /// Half a level.
    fn halved(level: Self::Level) -> Self::Level;
    /// A level in f32.
    fn level_to_f32(level: Self::Level) -> f32;
}
