//! Arithmetic at sample rate in f32.

use super::{Arithmetic, Form, SamplePair};
use crate::arch;
use crate::block::{ChannelSums, ChannelWatch, Reference, Runs};
use crate::period::{FRAME, Lags};
use crate::sum::{self, Sum};

impl Arithmetic for f32 {
    type Sum = f32;
    type Runs = Runs;
    type Weights<const N: usize> = [[f32; 2]; N];
    type Square = f32;
    type Level = f32;
    type Centred = [f32; 2];
    type Product = Sum;

    const FORM: Form = Form::Floats;
    const EXTREMES: [Self; 2] = [f32::NEG_INFINITY, f32::INFINITY];
    // A signal in which every sample comes twice costs twice the usual.
    const WATCHED_AT_ONCE: u16 = 8;
    const ROUNDING: f32 = 0.0;

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }

    #[inline(always)]
    fn sum_to_f32(sum: f32) -> f32 {
        sum
    }

    /// cos 3φ = 4 cos φ cos² φ − 3 cos φ, sin 3φ = 4 sin φ cos² φ − sin φ.
    #[inline(always)]
    fn third(sums: &ChannelSums<Self>, watch: &ChannelWatch<Self>) -> [f32; 2] {
        [
            4.0 * watch.third_cosine - 3.0 * sums.cosine,
            4.0 * watch.third_sine - sums.sine,
        ]
    }

    #[inline(always)]
    fn runs(watch: &ChannelWatch<Self>) -> [u16; 2] {
        watch.longest()
    }

    fn scale(_: u16) -> u16 {
        0
    }

    #[inline(always)]
    fn set_weights<const N: usize>(
        weights: &mut [[f32; 2]; N],
        index: usize,
        reference: Reference,
    ) {
        if let Some(weight) = weights.get_mut(index) {
            *weight = [reference.cosine, reference.sine];
        }
    }

    #[inline(always)]
    fn add_slice<P: SamplePair<Self>, const N: usize>(
        sums: &mut [ChannelSums<Self>; 2],
        watch: &mut Option<[ChannelWatch<Self>; 2]>,
        pairs: &[P],
        weights: &[[f32; 2]; N],
        index: u16,
    ) {
        match watch {
            Some(watch) => arch::watch_floats(sums, watch, pairs, weights, index),
            None => arch::add_floats(sums, pairs, weights, index),
        }
    }

    #[inline(always)]
    fn offsets(offsets: [f32; 2]) -> [f32; 2] {
        offsets
    }

    #[inline(always)]
    fn centred(pair: [Self; 2], offsets: [f32; 2]) -> [f32; 2] {
        [pair[0] - offsets[0], pair[1] - offsets[1]]
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
    fn add_difference(sum: &mut f32, a: [f32; 2], b: [f32; 2]) {
        let (c, d) = (a[0] - b[0], a[1] - b[1]);
        *sum += c * c + d * d;
    }

    #[inline(always)]
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }

    #[inline(always)]
    fn shift(_: &Lags<Self>) -> u32 {
        0
    }

    #[inline(always)]
    fn level(sum: f32, _: u32, count: usize) -> f32 {
        sum * RECIPROCALS[count % FRAME]
    }

    #[inline(always)]
    fn halved(level: f32) -> f32 {
        0.5 * level
    }

    #[inline(always)]
    fn level_to_f32(level: f32) -> f32 {
        level
    }

    #[inline(always)]
    fn square_to_f32(square: f32) -> f32 {
        square
    }
}

/// 1/n for every count of pairs that a frame of the period search has at a lag.
static RECIPROCALS: [f32; FRAME] = {
    let mut table = [0.0; FRAME];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f32;
        n += 1;
    }
    table
};
