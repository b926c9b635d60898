//! The few instructions of the Cortex-M4 that Rust has no stable name for, each with a portable twin that agrees with it bit for bit.
//!
//! This is the only module with `unsafe` code. A word holds two 16-bit codes: the first in its low half.

#![allow(
    unsafe_code,
    reason = "instructions by name: registers in, registers out, no memory"
)]

/// The portable twins: what runs where the instructions are not there, and what they are tested against.
#[cfg_attr(
    has_dsp,
    allow(dead_code, reason = "the instructions take their place")
)]
pub mod portable {
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

    /// The square root, correctly rounded; NaN below zero.
    #[inline(always)]
    pub fn square_root(x: f32) -> f32 {
        libm::sqrtf(x)
    }

    /// Adds pairs to the sums, from a sample of even index on: `weights` are words of two cosines and of two sines in turn.
    ///
    /// None is taken where there are weights for fewer.
    #[inline(always)]
    pub fn add_pairs<P: SamplePair<i16>>(
        sums: &mut [ChannelSums<i16>; 2],
        pairs: &[P],
        weights: &[u32],
    ) {
        let mut sums = sums.each_mut();
        for ((pair, cosine), sine) in each(pairs, weights) {
            for (sums, sample) in sums.iter_mut().zip(pair.pair()) {
                let sample = i32::from(sample);
                sums.cosine = sums.cosine.wrapping_add(sample * cosine);
                sums.sine = sums.sine.wrapping_add(sample * sine);
                sums.sum = sums.sum.wrapping_add(sample);
            }
        }
    }

    /// Watches pairs, as [`add_pairs`] adds them.
    #[inline(always)]
    pub fn watch_pairs<P: SamplePair<i16>>(
        watch: &mut [ChannelWatch<i16>; 2],
        pairs: &[P],
        weights: &[u32],
    ) {
        for ((pair, cosine), sine) in each(pairs, weights) {
            for (watch, sample) in watch.iter_mut().zip(pair.pair()) {
                let product = i32::from(sample);
                watch.third_cosine = watch.third_cosine.wrapping_add(product * cosine);
                watch.third_sine = watch.third_sine.wrapping_add(product * sine);
                watch.low = watch.low.min(sample);
                watch.high = watch.high.max(sample);
            }
        }
    }

    /// Adds pairs in f32 to the sums, each product rounded before it is added: `weights` are cosine and sine of each.
    ///
    /// None is taken where there are weights for fewer.
    #[inline(always)]
    pub fn add_floats<P: SamplePair<f32>>(
        sums: &mut [ChannelSums<f32>; 2],
        pairs: &[P],
        weights: &[[f32; 2]],
    ) {
        if weights.len() < pairs.len() {
            return;
        }
        let mut now = *sums;
        for (pair, [cosine, sine]) in pairs.iter().zip(weights) {
            for (sums, sample) in now.iter_mut().zip(pair.pair()) {
                sums.cosine += sample * cosine;
                sums.sine += sample * sine;
                sums.sum += sample;
            }
        }
        *sums = now;
    }

    /// Pairs with a cosine and a sine for each.
    #[inline(always)]
    fn each<P: Copy>(pairs: &[P], weights: &[u32]) -> impl Iterator<Item = ((P, i32), i32)> {
        let pairs = if pairs.len() > weights.len() {
            &[]
        } else {
            pairs
        };
        let weights = weights.as_chunks().0;
        let cosines = weights
            .iter()
            .flat_map(|&[cosine, _]: &[u32; 2]| halves(cosine));
        let sines = weights.iter().flat_map(|&[_, sine]| halves(sine));
        pairs.iter().copied().zip(cosines).zip(sines)
    }

    fn halves(word: u32) -> [i32; 2] {
        [i32::from(word as i16), (word as i32) >> 16]
    }

    fn both(a: u32, b: u32, of: impl Fn(i32, i32) -> i32) -> u32 {
        let ([a_low, a_high], [b_low, b_high]) = (halves(a), halves(b));
        (of(a_low, b_low) as u32 & 0xffff) | ((of(a_high, b_high) as u32) << 16)
    }
}

#[cfg(has_dsp)]
mod dsp {
    use core::arch::{asm, naked_asm};

    use crate::block::{ChannelSums, ChannelWatch};
    use crate::sample::SamplePair;

    /// SMLAD.
    #[inline(always)]
    pub fn dual_multiply_add(a: u32, b: u32, mut sum: u32) -> u32 {
        // SAFETY: reads and writes the named registers, and the flag Q.
        unsafe {
            asm!("smlad {sum}, {a}, {b}, {sum}", sum = inout(reg) sum, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack));
        }
        sum
    }

    /// SHSUB16.
    #[inline(always)]
    pub fn half_difference(a: u32, b: u32) -> u32 {
        let out;
        // SAFETY: reads and writes the named registers only.
        unsafe {
            asm!("shsub16 {out}, {a}, {b}", out = lateout(reg) out, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack, preserves_flags));
        }
        out
    }

    /// SMLALBB, SMLALTT and SMLALBT.
    #[inline(always)]
    pub fn add_products(sums: [i64; 3], a: u32, b: u32) -> [i64; 3] {
        let mut low = sums.map(|sum| sum as u32);
        let mut high = sums.map(|sum| (sum >> 32) as u32);
        // SAFETY: reads and writes the named registers only.
        unsafe {
            asm!("smlalbb {l0}, {h0}, {a}, {b}", "smlaltt {l1}, {h1}, {a}, {b}", "smlalbt {l2}, {h2}, {a}, {b}",
                l0 = inout(reg) low[0], h0 = inout(reg) high[0], l1 = inout(reg) low[1], h1 = inout(reg) high[1],
                l2 = inout(reg) low[2], h2 = inout(reg) high[2], a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack, preserves_flags));
        }
        core::array::from_fn(|i| ((u64::from(high[i]) << 32) | u64::from(low[i])) as i64)
    }

    /// QSUB16.
    #[inline(always)]
    pub fn limited_difference(a: u32, b: u32) -> u32 {
        let out;
        // SAFETY: reads and writes the named registers only.
        unsafe {
            asm!("qsub16 {out}, {a}, {b}", out = lateout(reg) out, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack, preserves_flags));
        }
        out
    }

    /// SHADD16.
    #[inline(always)]
    pub fn half_sum(a: u32, b: u32) -> u32 {
        let out;
        // SAFETY: reads and writes the named registers only.
        unsafe {
            asm!("shadd16 {out}, {a}, {b}", out = lateout(reg) out, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack, preserves_flags));
        }
        out
    }

    /// The portable kernel of the same name.
    #[inline(always)]
    pub fn add_pairs<P: SamplePair<i16>>(
        sums: &mut [ChannelSums<i16>; 2],
        pairs: &[P],
        weights: &[u32],
    ) {
        const { assert!(size_of::<P>() == 4 && size_of::<[ChannelSums<i16>; 2]>() == 24) };
        let count = pairs.len();
        if count > 0 && count <= weights.len() {
            // SAFETY: `count` pairs are words of memory, as many words of weights are there, and the sums are six words.
            unsafe { add_words(sums, pairs.as_ptr().cast(), weights.as_ptr(), count) };
        }
    }

    /// The portable kernel of the same name.
    #[inline(always)]
    pub fn watch_pairs<P: SamplePair<i16>>(
        watch: &mut [ChannelWatch<i16>; 2],
        pairs: &[P],
        weights: &[u32],
    ) {
        const { assert!(size_of::<P>() == 4 && size_of::<[ChannelWatch<i16>; 2]>() == 24) };
        let count = pairs.len();
        if count > 0 && count <= weights.len() {
            // SAFETY: `count` pairs are words of memory, as many words of weights are there, and the watch is six words: two sums
            // and the halves low and high, twice.
            unsafe { watch_words(watch, pairs.as_ptr().cast(), weights.as_ptr(), count) };
        }
    }

    /// r0: six sums; r1: words of pairs; r2: weights, an even number; r3: pairs, at least one.
    ///
    /// Two pairs are turned into a word of samples for each channel, and six SMLADs add them. Pairs of halves need no alignment:
    /// only where they have it are they loaded by LDM.
    #[unsafe(naked)]
    unsafe extern "C" fn add_words(
        sums: *mut [ChannelSums<i16>; 2],
        pairs: *const u32,
        weights: *const u32,
        count: usize,
    ) {
        naked_asm!(
            // Two pairs in r10 and r11.
            ".macro ADD_TWO",
            "pkhbt r12, r10, r11, lsl #16",
            "pkhtb r11, r11, r10, asr #16",
            "ldrd r0, r10, [r2], #8",
            "smlad r4, r12, r0, r4",
            "smlad r7, r11, r0, r7",
            "smlad r5, r12, r10, r5",
            "smlad r8, r11, r10, r8",
            "smlad r6, r12, lr, r6",
            "smlad r9, r11, lr, r9",
            ".endm",
            ".macro LOAD_ANY",
            "ldr r11, [r1, #4]",
            "ldr r10, [r1], #8",
            ".endm",
            "push {{r0, r4-r11, lr}}",
            "ldmia r0, {{r4-r9}}",
            "mov lr, #0x00010001",
            "subs r3, #4",
            "blo 2f",
            "tst r1, #3",
            "bne 6f",
            "1:",
            "ldmia r1!, {{r10, r11}}",
            "ADD_TWO",
            "ldmia r1!, {{r10, r11}}",
            "ADD_TWO",
            "subs r3, #4",
            "bhs 1b",
            "2:",
            "lsls r3, r3, #31",
            "bcc 3f",
            "LOAD_ANY",
            "ADD_TWO",
            "3:",
            "bpl 4f",
            // A last pair alone: the other halves are zero.
            "ldr r10, [r1]",
            "ldrd r0, r11, [r2]",
            "uxth r12, r10",
            "lsrs r10, r10, #16",
            "smlad r4, r12, r0, r4",
            "smlad r7, r10, r0, r7",
            "smlad r5, r12, r11, r5",
            "smlad r8, r10, r11, r8",
            "smlad r6, r12, lr, r6",
            "smlad r9, r10, lr, r9",
            "4:",
            "pop {{r0}}",
            "stmia r0, {{r4-r9}}",
            "pop {{r4-r11, pc}}",
            "6:",
            "LOAD_ANY",
            "ADD_TWO",
            "LOAD_ANY",
            "ADD_TWO",
            "subs r3, #4",
            "bhs 6b",
            "b 2b",
            ".purgem ADD_TWO",
            ".purgem LOAD_ANY",
        )
    }

    /// As `add_words`, of a watch: four SMLADs, and extremes by SSUB16 with SEL.
    #[unsafe(naked)]
    unsafe extern "C" fn watch_words(
        watch: *mut [ChannelWatch<i16>; 2],
        pairs: *const u32,
        weights: *const u32,
        count: usize,
    ) {
        naked_asm!(
            ".macro SEE most, least",
            "ssub16 lr, r8, \\most",
            "sel r8, r8, \\most",
            "ssub16 lr, \\least, r9",
            "sel r9, r9, \\least",
            ".endm",
            ".macro ADD c, d, cosine, sine",
            "smlad r4, \\c, \\cosine, r4",
            "smlad r6, \\d, \\cosine, r6",
            "smlad r5, \\c, \\sine, r5",
            "smlad r7, \\d, \\sine, r7",
            ".endm",
            "push {{r0, r4-r11, lr}}",
            "ldmia r0, {{r4-r9}}",
            // r6: extremes of C, r9: of D; made words of low and of high.
            "mov r10, r6",
            "mov r6, r7",
            "mov r7, r8",
            "pkhtb r8, r9, r10, asr #16",
            "pkhbt r9, r10, r9, lsl #16",
            "subs r3, #2",
            "blo 2f",
            "1:",
            "ldr r11, [r1, #4]",
            "ldr r10, [r1], #8",
            "ssub16 r12, r10, r11",
            "sel r0, r10, r11",
            "sel r12, r11, r10",
            "SEE r0, r12",
            "pkhbt r12, r10, r11, lsl #16",
            "pkhtb r11, r11, r10, asr #16",
            "ldrd r0, r10, [r2], #8",
            "ADD r12, r11, r0, r10",
            "subs r3, #2",
            "bhs 1b",
            "2:",
            "adds r3, #2",
            "beq 3f",
            "ldr r10, [r1]",
            "SEE r10, r10",
            "ldrd r0, r11, [r2]",
            "uxth r12, r10",
            "lsrs r10, r10, #16",
            "ADD r12, r10, r0, r11",
            "3:",
            "pkhbt r10, r9, r8, lsl #16",
            "pkhtb r9, r8, r9, asr #16",
            "mov r8, r7",
            "mov r7, r6",
            "mov r6, r10",
            "ldr r0, [sp]",
            "stmia r0, {{r4-r9}}",
            "pop {{r0, r4-r11, pc}}",
            ".purgem SEE",
            ".purgem ADD",
        )
    }
}

#[cfg(has_vsqrt)]
mod fpu {
    use core::arch::naked_asm;

    use crate::block::ChannelSums;
    use crate::sample::{Form, SamplePair};

    /// VSQRT.
    #[inline(always)]
    pub fn square_root(x: f32) -> f32 {
        let mut bits = x.to_bits();
        // SAFETY: `s0` is put back; Rust has no name for its register class on this core. IEEE 754 rounding, as the portable twin.
        unsafe {
            core::arch::asm!("vmov {kept}, s0", "vmov s0, {x}", "vsqrt.f32 s0, s0", "vmov {x}, s0", "vmov s0, {kept}",
                x = inout(reg) bits, kept = out(reg) _, options(pure, nomem, nostack, preserves_flags));
        }
        f32::from_bits(bits)
    }

    /// The portable kernel of the same name.
    #[inline(always)]
    pub fn add_floats<P: SamplePair<f32>>(
        sums: &mut [ChannelSums<f32>; 2],
        pairs: &[P],
        weights: &[[f32; 2]],
    ) {
        const { assert!(size_of::<[ChannelSums<f32>; 2]>() == 24) };
        let count = pairs.len();
        if count == 0 || count > weights.len() {
            return;
        }
        let (from, by) = (pairs.as_ptr(), weights.as_ptr());
        match P::FORM {
            // SAFETY: `count` pairs are words of memory, as many weights are there, and the sums are six words.
            Form::Codes => unsafe { add_codes(sums, from.cast(), by, count) },
            // SAFETY: as above, and a pair is two words.
            Form::Floats => unsafe { add_pairs(sums, from.cast(), by, count) },
            Form::Other => super::portable::add_floats(sums, pairs, weights),
        }
    }

    /// r0: six sums; r1: words of two codes, which need no alignment; r2: weights; r3: pairs, at least one.
    #[unsafe(naked)]
    unsafe extern "C" fn add_codes(
        sums: *mut [ChannelSums<f32>; 2],
        pairs: *const u32,
        weights: *const [f32; 2],
        count: usize,
    ) {
        naked_asm!(
            ".fpu fpv4-sp-d16",
            ".macro ADD cosine, sine, c, d",
            "vmul.f32 s14, \\c, \\cosine",
            "vmul.f32 s15, \\c, \\sine",
            "vadd.f32 s0, s0, s14",
            "vmul.f32 s14, \\d, \\cosine",
            "vadd.f32 s1, s1, s15",
            "vmul.f32 s15, \\d, \\sine",
            "vadd.f32 s2, s2, \\c",
            "vadd.f32 s3, s3, s14",
            "vadd.f32 s4, s4, s15",
            "vadd.f32 s5, s5, \\d",
            ".endm",
            ".macro LOAD c, d, word, high",
            "asr \\high, \\word, #16",
            "vmov \\c, \\d, \\word, \\high",
            // Of 16 bits: it takes the low half of the register as it is.
            "vcvt.f32.s16 \\c, \\c, #0",
            "vcvt.f32.s16 \\d, \\d, #0",
            ".endm",
            ".macro ADD_TWO",
            "ldr r5, [r1, #4]",
            "ldr r4, [r1], #8",
            "LOAD s6, s7, r4, r12",
            "LOAD s8, s9, r5, r12",
            "vldmia r2!, {{s10-s13}}",
            "ADD s10, s11, s6, s7",
            "ADD s12, s13, s8, s9",
            ".endm",
            "push {{r4, r5}}",
            "vldmia r0, {{s0-s5}}",
            "subs r3, #4",
            "blo 2f",
            "1:",
            "ADD_TWO",
            "ADD_TWO",
            "subs r3, #4",
            "bhs 1b",
            "2:",
            "lsls r3, r3, #31",
            "bcc 3f",
            "ADD_TWO",
            "3:",
            "cbz r3, 4f",
            "ldr r4, [r1]",
            "LOAD s6, s7, r4, r12",
            "vldmia r2!, {{s10-s11}}",
            "ADD s10, s11, s6, s7",
            "4:",
            "vstmia r0, {{s0-s5}}",
            "pop {{r4, r5}}",
            "bx lr",
            ".purgem ADD",
            ".purgem LOAD",
            ".purgem ADD_TWO",
        )
    }

    /// As `add_codes`, of pairs of f32.
    #[unsafe(naked)]
    unsafe extern "C" fn add_pairs(
        sums: *mut [ChannelSums<f32>; 2],
        pairs: *const [f32; 2],
        weights: *const [f32; 2],
        count: usize,
    ) {
        naked_asm!(
            ".fpu fpv4-sp-d16",
            ".macro ADD cosine, sine, c, d",
            "vmul.f32 s14, \\c, \\cosine",
            "vmul.f32 s15, \\c, \\sine",
            "vadd.f32 s0, s0, s14",
            "vmul.f32 s14, \\d, \\cosine",
            "vadd.f32 s1, s1, s15",
            "vmul.f32 s15, \\d, \\sine",
            "vadd.f32 s2, s2, \\c",
            "vadd.f32 s3, s3, s14",
            "vadd.f32 s4, s4, s15",
            "vadd.f32 s5, s5, \\d",
            ".endm",
            "vldmia r0, {{s0-s5}}",
            "subs r3, #2",
            "blo 2f",
            "1:",
            "vldmia r1!, {{s6-s9}}",
            "vldmia r2!, {{s10-s13}}",
            "ADD s10, s11, s6, s7",
            "ADD s12, s13, s8, s9",
            "subs r3, #2",
            "bhs 1b",
            "2:",
            "lsls r3, r3, #31",
            "beq 3f",
            "vldmia r1!, {{s6-s7}}",
            "vldmia r2!, {{s10-s11}}",
            "ADD s10, s11, s6, s7",
            "3:",
            "vstmia r0, {{s0-s5}}",
            "bx lr",
            ".purgem ADD",
        )
    }
}

#[cfg(has_dsp)]
pub use dsp::{
    add_pairs, add_products, dual_multiply_add, half_difference, half_sum, limited_difference,
    watch_pairs,
};
#[cfg(not(has_dsp))]
pub use portable::{
    add_pairs, add_products, dual_multiply_add, half_difference, half_sum, limited_difference,
    watch_pairs,
};

#[cfg(has_vsqrt)]
pub use fpu::{add_floats, square_root};
#[cfg(not(has_vsqrt))]
pub use portable::{add_floats, square_root};

#[cfg(test)]
mod tests {
    use super::portable::*;

    #[test]
    fn extremes_of_the_halves() {
        let (least, most) = (0x8000_8000, 0x7fff_7fff);
        assert_eq!(half_difference(most, least), 0x7fff_7fff);
        assert_eq!(half_difference(least, most), 0x8000_8000);
        assert_eq!(half_sum(least, least), least);
        assert_eq!(limited_difference(most, least), most);
        assert_eq!(limited_difference(least, 0x0001_ffff), 0x8000_8001);
        assert_eq!(half_sum(0x0001_ffff, 0x0000_0000), 0x0000_ffff);
        assert_eq!(dual_multiply_add(least, least, 5), 5 + (1 << 31));
        assert_eq!(
            add_products([1, i64::MAX, -1], least, 0x7fff_8000),
            [
                1 + (1 << 30),
                i64::MAX - 32_768 * 32_767,
                -1 - 32_768 * 32_767
            ]
        );
    }
}
