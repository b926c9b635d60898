//! Arithmetic at sample rate on 16-bit codes: two products an instruction where the core has them, sums in 32 bits.

use super::codes::{self, Levels};
use super::{Sample, SamplePair};
use crate::arch;
use crate::block::{ChannelSums, ChannelWatch};
use crate::period::{LAGS, Lags};

/// Both halves one: the weights of a plain sum.
const ONES: u32 = 0x0001_0001;

/// Two 16-bit halves as a word.
#[inline(always)]
fn word(pair: [i16; 2]) -> u32 {
    u32::from(pair[0] as u16) | u32::from(pair[1] as u16) << 16
}

/// The pair of a word.
#[inline(always)]
fn pair(word: u32) -> [i16; 2] {
    [word as i16, (word >> 16) as i16]
}

/// What a pass over pairs does with two of them at once: a word of two samples for each pick-off, words of two weights.
#[inline(always)]
fn by_two<P: SamplePair<i16>>(
    pairs: &[P],
    cosine: &[i16],
    sine: &[i16],
    mut each: impl FnMut([u32; 2], [u32; 2], u32, u32),
) {
    let ((pairs, last), (cosine, last_cosine), (sine, last_sine)) =
        (pairs.as_chunks(), cosine.as_chunks(), sine.as_chunks());
    for ((&[first, second], &cosine), &sine) in pairs.iter().zip(cosine).zip(sine) {
        let pairs = [word(first.pair()), word(second.pair())];
        let samples = [
            arch::low_halves(pairs[0], pairs[1]),
            arch::high_halves(pairs[0], pairs[1]),
        ];
        each(pairs, samples, word(cosine), word(sine));
    }
    for ((single, &cosine), &sine) in last.iter().zip(last_cosine).zip(last_sine) {
        let single = single.pair();
        let samples = single.map(|sample| word([sample, 0]));
        each(
            [word(single); 2],
            samples,
            word([cosine, 0]),
            word([sine, 0]),
        );
    }
}

impl Sample for i16 {
    type Sum = i32;
    type Weight = i16;
    type Square = u64;
    type Level = u32;

    const EXTREMES: [Self; 2] = [i16::MIN, i16::MAX];

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
    fn weight(value: f32) -> i16 {
        value as i16
    }

    #[inline(always)]
    fn add<P: SamplePair<Self>>(
        sums: &mut [ChannelSums<Self>; 2],
        pairs: &[P],
        cosine: &[i16],
        sine: &[i16],
    ) {
        let [mut c, mut d] = *sums;
        by_two(pairs, cosine, sine, |_, samples, cosine, sine| {
            c.cosine = arch::dual_multiply_add(samples[0], cosine, c.cosine);
            c.sine = arch::dual_multiply_add(samples[0], sine, c.sine);
            c.sum = arch::dual_multiply_add(samples[0], ONES, c.sum);
            d.cosine = arch::dual_multiply_add(samples[1], cosine, d.cosine);
            d.sine = arch::dual_multiply_add(samples[1], sine, d.sine);
            d.sum = arch::dual_multiply_add(samples[1], ONES, d.sum);
        });
        *sums = [c, d];
    }

    #[inline(always)]
    fn watch<P: SamplePair<Self>>(
        watch: &mut [ChannelWatch<Self>; 2],
        pairs: &[P],
        _: u16,
        third_cosine: &[i16],
        third_sine: &[i16],
    ) {
        let [mut c, mut d] = *watch;
        let mut high = word([c.high, d.high]);
        let mut low = word([c.low, d.low]);
        by_two(
            pairs,
            third_cosine,
            third_sine,
            |pairs, samples, cosine, sine| {
                c.third_cosine = arch::dual_multiply_add(samples[0], cosine, c.third_cosine);
                c.third_sine = arch::dual_multiply_add(samples[0], sine, c.third_sine);
                d.third_cosine = arch::dual_multiply_add(samples[1], cosine, d.third_cosine);
                d.third_sine = arch::dual_multiply_add(samples[1], sine, d.third_sine);
                high = arch::greater(arch::greater(high, pairs[0]), pairs[1]);
                low = arch::lesser(arch::lesser(low, pairs[0]), pairs[1]);
            },
        );
        [c.high, d.high] = pair(high);
        [c.low, d.low] = pair(low);
        *watch = [c, d];
    }

    #[inline(always)]
    fn add_differences(sums: &mut Lags<Self>, pair: [Self; 2], before: &[[Self; 2]]) {
        // Halved, a difference of any two codes fits in 16 bits; 32 of 2³¹ fit in the sum.
        let pair = word(pair);
        for (sum, &before) in sums.iter_mut().zip(before.iter().rev()) {
            let half = arch::half_difference(pair, word(before));
            *sum = arch::dual_multiply_add_long(half, half, *sum);
        }
    }

    #[inline(always)]
    fn mean(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        pair(arch::half_sum(word(a), word(b)))
    }

    #[inline(always)]
    fn means(sums: &Lags<Self>, count: usize) -> Levels {
        codes::means(sums, count)
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
        4.0 * square as f32
    }
}

const _: () = assert!(LAGS < 16);
