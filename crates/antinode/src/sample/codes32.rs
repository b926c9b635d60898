//! Arithmetic at sample rate on codes of up to 32 bits: sums in 64 bits.

use super::codes;
use super::{Arithmetic, Form, SamplePair};
use crate::block::{ChannelSums, ChannelWatch, Reference};
use crate::period::Lags;
use crate::sum::{self, Sum};

#[inline(always)]
fn product(sample: i32, weight: i16) -> i64 {
    i64::from(sample) * i64::from(weight)
}

impl Arithmetic for i32 {
    type Sum = i64;
    type Runs = ();
    type Weights<const N: usize> = [[[i16; 2]; N]; 2];
    type Square = u64;
    type Level = u32;
    type Centred = [f32; 2];
    type Product = Sum;

    const FORM: Form = Form::Other;
    const EXTREMES: [Self; 2] = [i32::MIN, i32::MAX];
    const WATCHED_AT_ONCE: u16 = 14;
    // A search does not see differences of less than a dozen codes: their squares are below the bits that it drops.
    const ROUNDING: f32 = 0.0;

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self as f32
    }

    #[inline(always)]
    fn sum_to_f32(sum: i64) -> f32 {
        sum as f32
    }

    fn scale(_: u16) -> u16 {
        i16::MAX as u16
    }

    #[inline(always)]
    fn set_weights<const N: usize>(
        [carrier, third]: &mut [[[i16; 2]; N]; 2],
        index: usize,
        reference: Reference,
    ) {
        if let (Some(carrier), Some(third)) = (carrier.get_mut(index), third.get_mut(index)) {
            *carrier = [reference.cosine as i16, reference.sine as i16];
            *third = [reference.third_cosine as i16, reference.third_sine as i16];
        }
    }

    #[inline(always)]
    fn add_slice<P: SamplePair<Self>, const N: usize>(
        sums: &mut [ChannelSums<Self>; 2],
        watch: &mut Option<[ChannelWatch<Self>; 2]>,
        pairs: &[P],
        [carrier, third]: &[[[i16; 2]; N]; 2],
        index: u16,
    ) {
        add_pairs(sums, pairs, carrier, index);
        if let Some(watch) = watch {
            watch_pairs(watch, pairs, third, index);
        }
    }

    #[inline(always)]
    fn offsets(offsets: [f32; 2]) -> [f32; 2] {
        offsets
    }

    #[inline(always)]
    fn centred(pair: [Self; 2], offsets: [f32; 2]) -> [f32; 2] {
        [pair[0] as f32 - offsets[0], pair[1] as f32 - offsets[1]]
    }

    #[inline(always)]
    fn add_products(sums: &mut [Sum; 3], pair: [f32; 2]) {
        sum::add_products(sums, pair);
    }

    #[inline(always)]
    fn add_delayed(sums: &mut [Sum; 2], now: [f32; 2], before: [f32; 2]) {
        sum::add_delayed(sums, now, before);
    }

    fn product_to_f64(sum: Sum) -> f64 {
        sum.value()
    }

    #[inline(always)]
    fn search_form(self) -> Self {
        self
    }

    #[inline(always)]
    fn add_difference(sum: &mut u64, a: [i32; 2], b: [i32; 2]) {
        // A square of up to 2⁶⁴, less its last 7 bits, fits in the sum 64 times.
        let square = |a: i32, b: i32| {
            let apart = u64::from(a.abs_diff(b));
            (apart * apart) >> 7
        };
        *sum += square(a[0], b[0]) + square(a[1], b[1]);
    }

    #[inline(always)]
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        // Without overflow: the sum of halves, and the bit that both halvings dropped.
        let mean = |a: i32, b: i32| (a >> 1) + (b >> 1) + (a & b & 1);
        [mean(a[0], b[0]), mean(a[1], b[1])]
    }

    #[inline(always)]
    fn shift(sums: &Lags<Self>) -> u32 {
        // The 32 highest bits that any of the sums uses.
        let used = sums.iter().fold(1, |all, &sum| all | sum);
        used.leading_zeros()
    }

    #[inline(always)]
    fn level(sum: u64, shift: u32, count: usize) -> u32 {
        codes::mean(((sum << shift) >> 32) as u32, 0, count)
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
    fn square_to_f32(square: u64) -> f32 {
        128.0 * square as f32
    }
}

#[inline(never)]
fn add_pairs<P: SamplePair<i32>>(
    sums: &mut [ChannelSums<i32>; 2],
    pairs: &[P],
    table: &[[i16; 2]],
    index: u16,
) {
    let mut now = if index == 0 {
        [ChannelSums::empty(); 2]
    } else {
        *sums
    };
    let weights = table.get(usize::from(index)..).unwrap_or(&[]);
    for (pair, &[cosine, sine]) in pairs.iter().zip(weights) {
        for (sums, sample) in now.iter_mut().zip(pair.pair()) {
            sums.cosine += product(sample, cosine);
            sums.sine += product(sample, sine);
            sums.sum += i64::from(sample);
        }
    }
    *sums = now;
}

#[inline(never)]
fn watch_pairs<P: SamplePair<i32>>(
    watch: &mut [ChannelWatch<i32>; 2],
    pairs: &[P],
    table: &[[i16; 2]],
    index: u16,
) {
    let mut now = if index == 0 {
        [ChannelWatch::empty(); 2]
    } else {
        *watch
    };
    let weights = table.get(usize::from(index)..).unwrap_or(&[]);
    for (pair, &[cosine, sine]) in pairs.iter().zip(weights) {
        for (watch, sample) in now.iter_mut().zip(pair.pair()) {
            watch.third_cosine += product(sample, cosine);
            watch.third_sine += product(sample, sine);
            watch.high = watch.high.max(sample);
            watch.low = watch.low.min(sample);
        }
    }
    *watch = now;
}
