//! The types of samples, f32 or integers of 16 or 32 bits, each with its arithmetic at sample rate.

mod arithmetic;
mod codes;
mod codes16;
mod codes32;
mod float;
mod zero;

use core::fmt::Debug;

pub use arithmetic::Arithmetic;
pub use zero::Zero;

mod sealed {
    use super::{Arithmetic, Form, Packed};

    pub trait Pair {
        const FORM: Form;
    }
    impl<S: Arithmetic> Pair for [S; 2] {
        const FORM: Form = S::FORM;
    }
    impl Pair for Packed {
        const FORM: Form = Form::Codes;
    }
    impl Pair for u32 {
        const FORM: Form = Form::Codes;
    }
    impl Pair for [u16; 2] {
        const FORM: Form = Form::Other;
    }
    impl Pair for [i8; 2] {
        const FORM: Form = Form::Other;
    }
    #[cfg(feature = "fixed")]
    impl Pair for [fixed::types::I1F15; 2] {
        const FORM: Form = Form::Codes;
    }
    #[cfg(feature = "fixed")]
    impl Pair for [fixed::types::I1F31; 2] {
        const FORM: Form = Form::Other;
    }
}

/// Layout of a pair in memory, on which the kernels of `arch` rely.
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
/// | `i16` | signed codes of up to 16 bits | i32, with the largest reference weights that cannot overflow |
/// | `i32` | signed codes of up to 32 bits | i64 |
///
/// With integers the input unit is the code. Codes of 24 bits in the upper bits of 32, as audio converters send them, are in steps of 256:
/// set [`Settings::resolution`](crate::Settings::resolution) to this. All three reach the same accuracy: the reference's own rounding is
/// part of the window's equations. Integers need no floating point at sample rate once the period is known.
///
/// No other type can be a sample: what the core does with samples has no public path.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no sample",
    label = "not `f32`, `i16` or `i32`",
    note = "unsigned codes of up to 15 bits are the same numbers as `i16`; those of 16 bits are taken as pairs `[u16; 2]` for `i32` or `f32`, or as \
            words `u32`, each `^ 0x8000_8000`, for `i16`"
)]
pub trait Sample: Copy + Debug + Default + PartialEq + Send + Arithmetic + 'static {}

impl Sample for f32 {}
impl Sample for i16 {}
impl Sample for i32 {}

/// A sample pair, S_C and S_D sampled together, in a form that holds samples of type `S` without loss.
///
/// | for | forms |
/// |---|---|
/// | `f32` | `[f32; 2]`, `[i16; 2]`, `[u16; 2]`, `[i8; 2]`, [`Packed`], `u32` |
/// | `i16` | `[i16; 2]`, `[I1F15; 2]`, [`Packed`], `u32` |
/// | `i32` | `[i32; 2]`, `[i16; 2]`, `[u16; 2]`, `[I1F31; 2]`, [`Packed`], `u32` |
///
/// A `u32` is what a [`Packed`] holds, so that a DMA's buffer of words is taken as it is. A buffer of alternating samples, C, D, C, D,
/// becomes pairs by `as_chunks::<2>().0`.
///
/// No other type can be a pair. `I1F15` and `I1F31` are those of the crate `fixed`, with the feature of that name; a unit of the estimates
/// is then 2⁻¹⁵ or 2⁻³¹.
///
/// | there are | take |
/// |---|---|
/// | unsigned codes of up to 15 bits, as of a 12-bit converter | them as `i16`: the same numbers; in a DMA's buffer, as words `u32` |
/// | unsigned codes of 16 bits | words `u32`, each `^ 0x8000_8000`, or `[u16; 2]` for `i32` and `f32` |
/// | codes of 24 bits | `[i32; 2]`, with the sign carried to the upper bits, or left as they are if in the upper bits of 32 |
/// | a slice of S_C and one of S_D | [`Front::extend_separate`](crate::Front::extend_separate) |
///
/// On a Cortex-M4F slices of `[i16; 2]` are read as words, aligned or not: if `CCR.UNALIGN_TRP` makes that a fault, take `Packed`, or align
/// the buffer to 4 bytes.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no pair of samples `{S}`",
    label = "not a form of a pair of `{S}`",
    note = "pairs are `[{S}; 2]`, `Packed` or `u32`; a slice of samples in turn becomes pairs by `as_chunks::<2>().0`; unsigned 16-bit codes \
            are taken as words `u32`, each `^ 0x8000_8000`; two slices by `extend_separate`"
)]
pub trait SamplePair<S>: Copy + sealed::Pair {
    /// S_C and S_D.
    fn pair(self) -> [S; 2];
}

/// A pair of 16-bit codes in one word, S_C in its low half: as a dual converter's DMA leaves it.
///
/// If a converter on SPI sends S_C first, in the high half of a word, swap the halves: `Packed(word.rotate_left(16))`.
///
/// The codes are signed. Unsigned codes of up to 15 bits are the same numbers; those of 16 bits are made signed by `word ^ 0x8000_8000`,
/// and the offsets of the estimates are then less by 32 768.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct Packed(pub u32);

impl From<[i16; 2]> for Packed {
    /// S_C and S_D in one word.
    #[inline(always)]
    fn from([c, d]: [i16; 2]) -> Self {
        Self(u32::from(c as u16) | u32::from(d as u16) << 16)
    }
}

/// Pairs made from two slices at a time.
const PAIRS_AT_A_TIME: usize = 32;

/// Hands over the samples of two slices in pairs, up to the end of the shorter one.
#[inline]
pub(crate) fn in_pairs<S: Sample>(c: &[S], d: &[S], mut take: impl FnMut(&[[S; 2]])) {
    let mut pairs = [[S::ZERO; 2]; PAIRS_AT_A_TIME];
    for (c, d) in c.chunks(PAIRS_AT_A_TIME).zip(d.chunks(PAIRS_AT_A_TIME)) {
        for (pair, (&c, &d)) in pairs.iter_mut().zip(c.iter().zip(d)) {
            *pair = [c, d];
        }
        let count = c.len().min(d.len());
        take(pairs.get(..count).unwrap_or(&pairs));
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

#[cfg(test)]
mod forms {
    use super::*;

    #[test]
    fn every_form_of_a_pair_gives_its_numbers() {
        let f32_of = |pair: [f32; 2]| pair;
        let i32_of = |pair: [i32; 2]| pair;
        let word = 5u32 << 16 | u32::from(-3i16 as u16);
        assert_eq!(f32_of([-3i16, 5].pair()), [-3.0, 5.0]);
        assert_eq!(f32_of([-3i8, 5].pair()), [-3.0, 5.0]);
        assert_eq!(f32_of([65_533u16, 5].pair()), [65_533.0, 5.0]);
        assert_eq!(f32_of(word.pair()), [-3.0, 5.0]);
        assert_eq!(f32_of(Packed(word).pair()), [-3.0, 5.0]);
        assert_eq!(i32_of([-3i16, 5].pair()), [-3, 5]);
        assert_eq!(i32_of([65_533u16, 5].pair()), [65_533, 5]);
        assert_eq!(i32_of(word.pair()), [-3, 5]);
        assert_eq!(i32_of(Packed(word).pair()), [-3, 5]);
        assert_eq!(SamplePair::<i16>::pair(word), [-3, 5]);
        assert_eq!(SamplePair::<i16>::pair([-3i16, 5]), [-3, 5]);
    }

    #[test]
    fn offsets_are_taken_off() {
        let offsets = [2.0, -3.0];
        assert_eq!(<i32 as Arithmetic>::centred([7, -5], offsets), [5.0, -2.0]);
        assert_eq!(
            <f32 as Arithmetic>::centred([7.0, -5.0], offsets),
            [5.0, -2.0]
        );
        let word = <i16 as Arithmetic>::centred([7, -5], <i16 as Arithmetic>::offsets(offsets));
        assert_eq!(SamplePair::<i16>::pair(word), [5, -2]);
    }
}

#[cfg(all(test, feature = "fixed"))]
mod tests {
    use std::vec::Vec;

    use fixed::types::{I1F15, I1F31};

    use super::*;
    use crate::identifier::Identifier;
    use crate::settings::Settings;

    fn estimates<S: Sample>(pairs: &[impl SamplePair<S>]) -> Vec<crate::Estimate> {
        let mut identifier = Identifier::<S, 200, 16>::new(Settings::new(1e5)).unwrap();
        let mut all = Vec::new();
        identifier.extend(pairs, |estimate| all.push(estimate));
        assert_eq!(all.len(), 5);
        all
    }

    #[test]
    fn numbers_of_fixed_are_taken_as_their_codes() {
        let signal = |k: u16| {
            let (sine, cosine) = libm::sincos(0.335 * f64::from(k));
            [0.8 * cosine, 0.4 * cosine + 0.1 * sine]
        };
        let signals: Vec<_> = (0..1100).map(signal).collect();
        let short: Vec<_> = signals.iter().map(|s| s.map(I1F15::from_num)).collect();
        let codes: Vec<_> = short.iter().map(|s| s.map(I1F15::to_bits)).collect();
        let found = estimates::<i16>(&short);
        assert_eq!(found, estimates::<i16>(&codes));
        let unit = 1.0 / 32_768.0;
        let [c, d] = [0.8, f32::hypot(0.4, 0.1)];
        let power = f32::hypot(found[0].main_amplitude, found[0].quadrature_amplitude) * unit;
        assert!((power - f32::hypot(c, d)).abs() < 1e-4, "{power}");

        let long: Vec<_> = signals.iter().map(|s| s.map(I1F31::from_num)).collect();
        let codes: Vec<_> = long.iter().map(|s| s.map(I1F31::to_bits)).collect();
        assert_eq!(estimates::<i32>(&long), estimates::<i32>(&codes));
    }
}
