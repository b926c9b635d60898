//! Portable twins of the kernels: they run on cores without the instructions, and are the reference of their tests.

use crate::block::{ChannelSums, ChannelWatch};
use crate::sample::SamplePair;

/// `sum` + low·low + high·high of two words of signed halves, wrapping.
#[inline(always)]
pub fn dual_multiply_add(a: u32, b: u32, sum: u32) -> u32 {
    let [a_low, a_high] = halves(a);
    let [b_low, b_high] = halves(b);
    sum.wrapping_add((a_low * b_low) as u32)
        .wrapping_add((a_high * b_high) as u32)
}

/// Half the difference of each half, rounded down.
#[inline(always)]
pub fn half_difference(a: u32, b: u32) -> u32 {
    both(a, b, |a, b| (a - b) >> 1)
}

/// Half the sum of each half, rounded down.
#[inline(always)]
pub fn half_sum(a: u32, b: u32) -> u32 {
    both(a, b, |a, b| (a + b) >> 1)
}

/// The difference of each half, limited to 16 bits.
#[inline(always)]
pub fn limited_difference(a: u32, b: u32) -> u32 {
    both(a, b, |a, b| (a - b).clamp(-32_768, 32_767))
}

/// Adds low·low, high·high and low·high of two words of signed halves to three sums, wrapping.
#[inline(always)]
pub fn add_products(sums: [i64; 3], a: u32, b: u32) -> [i64; 3] {
    let ([a_low, a_high], [b_low, b_high]) = (halves(a), halves(b));
    let add = |sum: i64, product: i32| sum.wrapping_add(i64::from(product));
    [
        add(sums[0], a_low * b_low),
        add(sums[1], a_high * b_high),
        add(sums[2], a_low * b_high),
    ]
}

/// Adds low·low + high·high, and low·high, of two words of signed halves to two sums, wrapping.
#[inline(always)]
pub fn add_delayed(sums: [i64; 2], a: u32, b: u32) -> [i64; 2] {
    let [low, high, mixed] = add_products([sums[0], 0, sums[1]], a, b);
    [low.wrapping_add(high), mixed]
}

/// The square root, correctly rounded; NaN below zero.
#[inline(always)]
pub fn square_root(x: f32) -> f32 {
    libm::sqrtf(x)
}

/// Adds pairs to the sums. The first pair is sample `index` of its block: at 0 the sums begin anew. `weights` are those of the whole
/// block, alternately a word of two cosines and one of two sines.
///
/// Does nothing if weights are missing.
#[inline(always)]
pub fn add_pairs<P: SamplePair<i16>>(
    sums: &mut [ChannelSums<i16>; 2],
    pairs: &[P],
    weights: &[u32],
    index: u16,
) {
    let Some(weighted) = weighted(pairs, weights, index) else {
        return;
    };
    if index == 0 {
        *sums = [ChannelSums::empty(); 2];
    }
    for (pair, [cosine, sine]) in weighted {
        for (sums, sample) in sums.iter_mut().zip(pair.pair()) {
            let sample = i32::from(sample);
            sums.cosine = sums.cosine.wrapping_add(sample * cosine);
            sums.sine = sums.sine.wrapping_add(sample * sine);
            sums.sum = sums.sum.wrapping_add(sample);
        }
    }
}

/// Adds pairs to the watch, with the arguments of [`add_pairs`].
#[inline(always)]
pub fn watch_pairs<P: SamplePair<i16>>(
    watch: &mut [ChannelWatch<i16>; 2],
    pairs: &[P],
    weights: &[u32],
    index: u16,
) {
    let Some(weighted) = weighted(pairs, weights, index) else {
        return;
    };
    if index == 0 {
        *watch = [ChannelWatch::empty(); 2];
    }
    for (pair, [cosine, sine]) in weighted {
        for (watch, sample) in watch.iter_mut().zip(pair.pair()) {
            let product = i32::from(sample);
            watch.third_cosine = watch.third_cosine.wrapping_add(product * cosine);
            watch.third_sine = watch.third_sine.wrapping_add(product * sine);
            watch.low = watch.low.min(sample);
            watch.high = watch.high.max(sample);
        }
    }
}

/// As [`add_pairs`], in f32, with each product rounded before it is added; `weights` are cosine and sine of each sample of the block.
#[inline(always)]
pub fn add_floats<P: SamplePair<f32>>(
    sums: &mut [ChannelSums<f32>; 2],
    pairs: &[P],
    weights: &[[f32; 2]],
    index: u16,
) {
    let Some(weights) = weights_from(weights, index, pairs.len()) else {
        return;
    };
    let mut now = if index == 0 {
        [ChannelSums::empty(); 2]
    } else {
        *sums
    };
    for (pair, [cosine, sine]) in pairs.iter().zip(weights) {
        for (sums, sample) in now.iter_mut().zip(pair.pair()) {
            sums.cosine += sample * cosine;
            sums.sine += sample * sine;
            sums.sum += sample;
        }
    }
    *sums = now;
}

/// Adds pairs to the sums, as [`add_floats`] does, and to the watch.
#[inline(never)]
pub fn watch_floats<P: SamplePair<f32>>(
    sums: &mut [ChannelSums<f32>; 2],
    watch: &mut [ChannelWatch<f32>; 2],
    pairs: &[P],
    weights: &[[f32; 2]],
    index: u16,
) {
    let Some(weights) = weights_from(weights, index, pairs.len()) else {
        return;
    };
    if index == 0 {
        *sums = [ChannelSums::empty(); 2];
        *watch = [ChannelWatch::empty(); 2];
    }
    for ((pair, [cosine, sine]), index) in pairs.iter().zip(weights).zip(index..) {
        let square = cosine * cosine;
        for ((sums, watch), sample) in sums.iter_mut().zip(&mut *watch).zip(pair.pair()) {
            let (even, odd) = (sample * cosine, sample * sine);
            sums.cosine += even;
            sums.sine += odd;
            sums.sum += sample;
            watch.third_cosine += even * square;
            watch.third_sine += odd * square;
            watch.see(sample, index);
        }
    }
}

/// The weights from sample `index` on; `None` if there is no pair, or if weights are missing for some of the `count` pairs.
#[inline(always)]
pub fn weights_from<W>(weights: &[W], index: u16, count: usize) -> Option<&[W]> {
    let weights = weights.get(usize::from(index)..)?;
    (count > 0 && count <= weights.len()).then_some(weights)
}

/// Pairs, each with its cosine and sine; `None` if weights are missing.
#[inline(always)]
fn weighted<P: Copy>(
    pairs: &[P],
    weights: &[u32],
    index: u16,
) -> Option<impl Iterator<Item = (P, [i32; 2])>> {
    let (twos, odd) = (usize::from(index / 2), usize::from(index % 2));
    let weights = weights.as_chunks().0.get(twos..)?;
    if odd + pairs.len() > 2 * weights.len() {
        return None;
    }
    let each = weights.iter().flat_map(|&[cosines, sines]| {
        let ([c0, c1], [s0, s1]) = (halves(cosines), halves(sines));
        [[c0, s0], [c1, s1]]
    });
    Some(pairs.iter().copied().zip(each.skip(odd)))
}

/// The signed halves of a word, the low one first.
fn halves(word: u32) -> [i32; 2] {
    [i32::from(word as i16), (word as i32) >> 16]
}

/// A word of `of` both low halves and of both high halves.
fn both(a: u32, b: u32, of: impl Fn(i32, i32) -> i32) -> u32 {
    let ([a_low, a_high], [b_low, b_high]) = (halves(a), halves(b));
    (of(a_low, b_low) as u32 & 0xffff) | ((of(a_high, b_high) as u32) << 16)
}
