//! What samples are, and with it the arithmetic at sample rate: f32, or integers of 16 or 32 bits.

mod codes;
mod codes16;
mod codes32;
mod float;
mod zero;

use core::fmt::Debug;

use crate::block::{ChannelSums, ChannelWatch};
use crate::period::Lags;
pub use zero::Zero;

mod sealed {
    pub trait Sealed {
        /// Of a pair of these.
        const FORM: super::Form;
    }
    pub trait Pair {
        const FORM: super::Form;
    }
    impl Pair for super::Packed {
        const FORM: super::Form = super::Form::Codes;
    }
    impl Pair for u32 {
        const FORM: super::Form = super::Form::Codes;
    }
    impl<S: Sealed> Pair for [S; 2] {
        const FORM: super::Form = S::FORM;
    }
    impl Pair for [u16; 2] {
        const FORM: super::Form = super::Form::Other;
    }
    impl Pair for [i8; 2] {
        const FORM: super::Form = super::Form::Other;
    }
    #[cfg(feature = "fixed")]
    impl Pair for [fixed::types::I1F15; 2] {
        const FORM: super::Form = super::Form::Codes;
    }
    #[cfg(feature = "fixed")]
    impl Pair for [fixed::types::I1F31; 2] {
        const FORM: super::Form = super::Form::Other;
    }
    impl Sealed for f32 {
        const FORM: super::Form = super::Form::Floats;
    }
    impl Sealed for i16 {
        const FORM: super::Form = super::Form::Codes;
    }
    impl Sealed for i32 {
        const FORM: super::Form = super::Form::Other;
    }
}

/// What a pair is in memory: the kernels of `arch` rest on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[doc(hidden)]
pub enum Form {
    /// Two signed halves of a little-endian word.
    Codes,
    /// Two f32.
    Floats,
    Other,
}

/// A sample of a pick-off as the core takes it; it decides the arithmetic at sample rate.
///
/// | type | for | sums of a block |
/// |---|---|---|
/// | `f32` | any input unit | f32 |
/// | `i16` | converter codes of up to 16 bits | i32, reference weights as large as cannot overflow |
/// | `i32` | converter codes of up to 32 bits | i64 |
///
/// With integers the input unit is the code. All three reach the same accuracy: the reference's own rounding is part of the
/// window's equations. Integers need no floating point at sample rate once the period is known.
///
/// No other type can be one.
pub trait Sample:
    Copy + Debug + Default + PartialEq + Send + Zero + sealed::Sealed + 'static
{
    /// A running sum of weighted samples.
    type Sum: Copy + Debug + PartialEq + Send + Zero;
    /// The reference at one sample of a block: cosine and sine.
    #[doc(hidden)]
    type Weight: Copy + Debug + Send + Zero;
    /// The reference's third harmonic at one sample of a block, where it is not made of the reference itself.
    #[doc(hidden)]
    type Third: Copy + Debug + Send + Zero;
    /// What is kept of runs of equal samples.
    type Runs: Copy + Debug + PartialEq + Default + Send;
    /// A running sum of squared differences.
    #[doc(hidden)]
    type Square: Copy + Debug + Send + Zero;
    /// A pair less its offsets, as the sums of products take it.
    #[doc(hidden)]
    type Centred: Copy + Debug + Default + Send;
    /// Three running sums of products.
    #[doc(hidden)]
    type Products: Copy + Debug + Default + Send;
    /// Two running sums of products with what was before.
    #[doc(hidden)]
    type Delayed: Copy + Debug + Default + Send;
    /// A mean squared difference, to be compared with others.
    #[doc(hidden)]
    type Level: Copy + Debug + PartialOrd + Send;

    /// The sample in f32.
    #[doc(hidden)]
    fn to_f32(self) -> f32;
    /// A sum in f32.
    #[doc(hidden)]
    fn sum_to_f32(sum: Self::Sum) -> f32;
    /// The weight that stands for one in a block of `length`: the largest whose sums cannot overflow; 0 for weights not rounded.
    #[doc(hidden)]
    fn scale(length: u16) -> u16;
    /// Puts the weights of sample `index` into a table, from cosine and sine in f32: whole numbers where there is a scale.
    #[doc(hidden)]
    fn set_weight(table: &mut [Self::Weight], index: usize, weight: [f32; 2]);
    /// Puts the weights of the third harmonic into their table, where there is one.
    #[doc(hidden)]
    fn set_third(table: &mut [Self::Third], index: usize, weight: [f32; 2]);
    /// Adds pairs, the first of which is sample `index` of its block, to sums and watch, which begin anew at 0. The tables are those of
    /// the reference and of its third harmonic.
    ///
    /// Nothing is done where a table is too short.
    #[doc(hidden)]
    fn add_slice<P: SamplePair<Self>>(
        sums: &mut [ChannelSums<Self>; 2],
        watch: &mut Option<[ChannelWatch<Self>; 2]>,
        pairs: &[P],
        tables: (&[Self::Weight], &[Self::Third]),
        index: u16,
    );
    /// The longest runs at the extremes, low and high: 1 where they are not counted.
    #[doc(hidden)]
    fn runs(watch: &ChannelWatch<Self>) -> [u16; 2];
    /// Single pairs that are summed and watched together, at most 32: no more than fit between two samples of a fast converter.
    #[doc(hidden)]
    const WATCHED_AT_ONCE: u16;
    /// No sample is less than the first or more than the second: the extremes of none, greatest and least.
    #[doc(hidden)]
    const EXTREMES: [Self; 2];
    /// Offsets in input units, to be taken off by [`centred`](Self::centred).
    #[doc(hidden)]
    fn offsets(offsets: [f32; 2]) -> Self::Centred;
    /// A pair less its offsets.
    #[doc(hidden)]
    fn centred(pair: [Self; 2], offsets: Self::Centred) -> Self::Centred;
    /// Adds the products of C with C, D with D and C with D of a pair.
    #[doc(hidden)]
    fn add_products(sums: &mut Self::Products, pair: Self::Centred);
    /// Adds the products of a pair with one before it: of C with C and D with D together, and of C with D.
    #[doc(hidden)]
    fn add_delayed(sums: &mut Self::Delayed, now: Self::Centred, before: Self::Centred);
    /// The sums in input units squared.
    #[doc(hidden)]
    fn products(sums: Self::Products) -> [f64; 3];
    /// The sums in input units squared.
    #[doc(hidden)]
    fn delayed(sums: Self::Delayed) -> [f64; 2];
    /// The sample as the search for a period takes it: of 16-bit codes, less two bits.
    #[doc(hidden)]
    fn search_form(self) -> Self;
    /// Adds the squared difference of two pairs, both in [`search_form`](Self::search_form).
    #[doc(hidden)]
    fn add_difference(sum: &mut Self::Square, a: [Self; 2], b: [Self; 2]);
    /// The mean of two pairs, for the next octave of the period search.
    #[doc(hidden)]
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2];
    /// What the sums must be shifted by for [`level`](Self::level) to lose none of their digits.
    #[doc(hidden)]
    fn shift(sums: &Lags<Self>) -> u32;
    /// A sum of `count` pairs, at most a frame of the search, as a mean: only the ratios of levels mean anything.
    #[doc(hidden)]
    fn level(sum: Self::Square, shift: u32, count: usize) -> Self::Level;
    /// Half a level.
    #[doc(hidden)]
    fn halved(level: Self::Level) -> Self::Level;
    /// A level in f32.
    #[doc(hidden)]
    fn level_to_f32(level: Self::Level) -> f32;
    /// A sum of squared differences in f32, input units squared.
    #[doc(hidden)]
    fn square_to_f32(square: Self::Square) -> f32;
}

/// A sample pair, S_C and S_D sampled together, in a form that holds samples of type `S` without loss.
///
/// | for | forms |
/// |---|---|
/// | `f32` | `[f32; 2]`, `[i16; 2]`, `[u16; 2]`, `[i8; 2]`, [`Packed`], `u32` |
/// | `i16` | `[i16; 2]`, `[I1F15; 2]`, [`Packed`], `u32` |
/// | `i32` | `[i32; 2]`, `[i16; 2]`, `[u16; 2]`, `[I1F31; 2]`, [`Packed`], `u32` |
///
/// A `u32` is what a [`Packed`] holds: a DMA's buffer of words is taken as it is.
///
/// No other type can be one. `I1F15` and `I1F31` are those of the crate `fixed`, with the feature of that name; a unit of the estimates is then 2⁻¹⁵ or 2⁻³¹.
pub trait SamplePair<S>: Copy + sealed::Pair {
    /// S_C and S_D.
    fn pair(self) -> [S; 2];
}

/// A pair of 16-bit codes in one word, S_C in its low half: as a dual converter's DMA leaves it.
///
/// The codes are signed. Unsigned ones of up to 15 bits are the same; of 16 bits, `word ^ 0x8000_8000` makes them signed, and the
/// offsets of the estimates are then less by 32 768.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct Packed(pub u32);

impl From<[i16; 2]> for Packed {
    /// S_C and S_D in one word.
    fn from([c, d]: [i16; 2]) -> Self {
        Self(u32::from(c as u16) | u32::from(d as u16) << 16)
    }
}

impl<S> SamplePair<S> for [S; 2]
where
    S: Sample,
{
    #[inline(always)]
    fn pair(self) -> [S; 2] {
        self
    }
}

impl SamplePair<i16> for Packed {
    #[inline(always)]
    fn pair(self) -> [i16; 2] {
        [self.0 as i16, (self.0 >> 16) as i16]
    }
}

impl SamplePair<f32> for Packed {
    #[inline(always)]
    fn pair(self) -> [f32; 2] {
        SamplePair::<i16>::pair(self).map(f32::from)
    }
}

impl SamplePair<i32> for Packed {
    #[inline(always)]
    fn pair(self) -> [i32; 2] {
        SamplePair::<i16>::pair(self).map(i32::from)
    }
}

impl<S> SamplePair<S> for u32
where
    Packed: SamplePair<S>,
{
    #[inline(always)]
    fn pair(self) -> [S; 2] {
        Packed(self).pair()
    }
}

impl SamplePair<f32> for [i16; 2] {
    #[inline(always)]
    fn pair(self) -> [f32; 2] {
        self.map(f32::from)
    }
}

impl SamplePair<f32> for [u16; 2] {
    #[inline(always)]
    fn pair(self) -> [f32; 2] {
        self.map(f32::from)
    }
}

impl SamplePair<f32> for [i8; 2] {
    #[inline(always)]
    fn pair(self) -> [f32; 2] {
        self.map(f32::from)
    }
}

impl SamplePair<i32> for [i16; 2] {
    #[inline(always)]
    fn pair(self) -> [i32; 2] {
        self.map(i32::from)
    }
}

impl SamplePair<i32> for [u16; 2] {
    #[inline(always)]
    fn pair(self) -> [i32; 2] {
        self.map(i32::from)
    }
}

#[cfg(feature = "fixed")]
impl SamplePair<i16> for [fixed::types::I1F15; 2] {
    #[inline(always)]
    fn pair(self) -> [i16; 2] {
        self.map(fixed::types::I1F15::to_bits)
    }
}

#[cfg(feature = "fixed")]
impl SamplePair<i32> for [fixed::types::I1F31; 2] {
    #[inline(always)]
    fn pair(self) -> [i32; 2] {
        self.map(fixed::types::I1F31::to_bits)
    }
}
