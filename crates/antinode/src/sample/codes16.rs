//! Arithmetic at sample rate on 16-bit codes: two products an instruction where the core has them, sums in 32 bits.

use super::codes;
use super::{Arithmetic, Form, Packed, SamplePair};
use crate::arch;
use crate::block::{ChannelSums, ChannelWatch, Reference};
use crate::period::Lags;

/// Two 16-bit halves as a word.
#[inline(always)]
fn word(pair: [i16; 2]) -> u32 {
    Packed::from(pair).0
}

/// Puts the weights of sample `index` into a table: cosines of two samples in its even entries, their sines in its odd ones.
#[inline(always)]
fn set_weight(table: &mut [u32], index: usize, weight: [f32; 2]) {
    let [cosine, sine] = weight.map(|value| value as i16);
    if let Some([cosines, sines, ..]) = table.get_mut(index & !1..) {
        let set = |two: u32, value: i16| {
            let [low, high] = two.pair();
            if index.is_multiple_of(2) {
                word([value, high])
            } else {
                word([low, value])
            }
        };
        (*cosines, *sines) = (set(*cosines, cosine), set(*sines, sine));
    }
}

impl Arithmetic for i16 {
    type Sum = i32;
    type Runs = ();
    type Weights<const N: usize> = [[u32; N]; 2];
    type Square = u32;
    type Level = u32;
    // Two halves of a word. Products are at most 2³⁰, sums of two at most 2³¹: 2³² of those stay below 2⁶³.
    type Centred = u32;
    type Product = i64;

    const FORM: Form = Form::Codes;
    const EXTREMES: [Self; 2] = [i16::MIN, i16::MAX];
    const WATCHED_AT_ONCE: u16 = 32;
    const ROUNDING: f32 = 0.7 * 2.0 / 12.0;

    #[inline(always)]
    fn to_f32(self) -> f32 {
        f32::from(self)
    }

    #[inline(always)]
    fn sum_to_f32(sum: i32) -> f32 {
        sum as f32
    }

    fn scale(length: u16) -> u16 {
        // 32 768 · scale · length stays below 2³¹.
        (u16::MAX / length.max(1)).min(i16::MAX as u16)
    }

    #[inline(always)]
    fn set_weights<const N: usize>(
        [carrier, third]: &mut [[u32; N]; 2],
        index: usize,
        reference: Reference,
    ) {
        set_weight(carrier, index, [reference.cosine, reference.sine]);
        set_weight(third, index, [reference.third_cosine, reference.third_sine]);
    }

    #[inline(always)]
    fn add_slice<P: SamplePair<Self>, const N: usize>(
        sums: &mut [ChannelSums<Self>; 2],
        watch: &mut Option<[ChannelWatch<Self>; 2]>,
        pairs: &[P],
        [carrier, third]: &[[u32; N]; 2],
        index: u16,
    ) {
        arch::add_pairs(sums, pairs, carrier, index);
        if let Some(watch) = watch {
            arch::watch_pairs(watch, pairs, third, index);
        }
    }

    #[inline(always)]
    fn offsets(offsets: [f32; 2]) -> u32 {
        word(offsets.map(|offset| libm::roundf(offset) as i16))
    }

    #[inline(always)]
    fn centred(pair: [Self; 2], offsets: u32) -> u32 {
        arch::limited_difference(word(pair), offsets)
    }

    #[inline(always)]
    fn add_products(sums: &mut [i64; 3], pair: u32) {
        *sums = arch::add_products(*sums, pair, pair);
    }

    #[inline(always)]
    fn add_delayed(sums: &mut [i64; 2], now: u32, before: u32) {
        *sums = arch::add_delayed(*sums, now, before);
    }

    fn product_to_f64(sum: i64) -> f64 {
        sum as f64
    }

    #[inline(always)]
    fn search_form(self) -> Self {
        self >> 2
    }

    #[inline(always)]
    fn add_difference(sum: &mut u32, a: [i16; 2], b: [i16; 2]) {
        // Half a difference of 14-bit codes is below 2¹³: 31 sums of two squares stay below 2³².
        let half = arch::half_difference(word(a), word(b));
        *sum = arch::dual_multiply_add(half, half, *sum);
    }

    #[inline(always)]
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        arch::half_sum(word(a), word(b)).pair()
    }

    #[inline(always)]
    fn shift(sums: &Lags<Self>) -> u32 {
        codes::shift(sums)
    }

    #[inline(always)]
    fn level(sum: u32, shift: u32, count: usize) -> u32 {
        codes::mean(sum, shift, count)
    }

    #[inline(always)]
    fn halved(level: u32) -> u32 {
        level / 2
    }

    #[inline(always)]
    fn level_to_f32(level: u32) -> f32 {
        level as f32
    }

    #[inline(always)]
    fn square_to_f32(square: u32) -> f32 {
        4.0 * square as f32
    }
}
