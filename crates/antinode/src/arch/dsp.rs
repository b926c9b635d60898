//! Kernels for 16-bit codes by the DSP extension of ARMv7E-M, which multiplies two pairs of halves in one instruction.

use core::arch::{asm, naked_asm};

use crate::block::{ChannelSums, ChannelWatch};
use crate::sample::SamplePair;

/// SMLAD.
#[inline(always)]
pub fn dual_multiply_add(a: u32, b: u32, mut sum: u32) -> u32 {
    // SAFETY: it reads and writes only the named registers and the flag Q.
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

/// Splits sums into their low and high words.
#[inline(always)]
fn halves<const N: usize>(sums: [i64; N]) -> [[u32; N]; 2] {
    [
        sums.map(|sum| sum as u32),
        sums.map(|sum| (sum >> 32) as u32),
    ]
}

/// Joins sums from their low and high words.
#[inline(always)]
fn whole<const N: usize>(low: [u32; N], high: [u32; N]) -> [i64; N] {
    core::array::from_fn(|i| ((u64::from(high[i]) << 32) | u64::from(low[i])) as i64)
}

/// SMLALBB, SMLALTT and SMLALBT.
#[inline(always)]
pub fn add_products(sums: [i64; 3], a: u32, b: u32) -> [i64; 3] {
    let [mut low, mut high] = halves(sums);
    // SAFETY: reads and writes the named registers only.
    unsafe {
        asm!("smlalbb {l0}, {h0}, {a}, {b}", "smlaltt {l1}, {h1}, {a}, {b}", "smlalbt {l2}, {h2}, {a}, {b}",
            l0 = inout(reg) low[0], h0 = inout(reg) high[0], l1 = inout(reg) low[1], h1 = inout(reg) high[1],
            l2 = inout(reg) low[2], h2 = inout(reg) high[2], a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack, preserves_flags));
    }
    whole(low, high)
}

/// SMLALD and SMLALBT.
#[inline(always)]
pub fn add_delayed(sums: [i64; 2], a: u32, b: u32) -> [i64; 2] {
    let [mut low, mut high] = halves(sums);
    // SAFETY: reads and writes the named registers only.
    unsafe {
        asm!("smlald {l0}, {h0}, {a}, {b}", "smlalbt {l1}, {h1}, {a}, {b}",
            l0 = inout(reg) low[0], h0 = inout(reg) high[0], l1 = inout(reg) low[1], h1 = inout(reg) high[1],
            a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack, preserves_flags));
    }
    whole(low, high)
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
    index: u16,
) {
    const { assert!(size_of::<P>() == 4 && size_of::<[ChannelSums<i16>; 2]>() == 24) };
    if let Some(place) = place(pairs.len(), weights.len(), index) {
        // SAFETY: each pair is one word, `place` has found weights for all pairs, and the sums are six words.
        unsafe { add_words(sums, pairs.as_ptr().cast(), weights.as_ptr(), place) };
    }
}

/// The portable kernel of the same name.
#[inline(always)]
pub fn watch_pairs<P: SamplePair<i16>>(
    watch: &mut [ChannelWatch<i16>; 2],
    pairs: &[P],
    weights: &[u32],
    index: u16,
) {
    const { assert!(size_of::<P>() == 4 && size_of::<[ChannelWatch<i16>; 2]>() == 24) };
    if let Some(place) = place(pairs.len(), weights.len(), index) {
        // SAFETY: each pair is one word, `place` has found weights for all pairs, and the watch is six words: two sums and a word of
        // lowest and highest sample, for each pick-off.
        unsafe { watch_words(watch, pairs.as_ptr().cast(), weights.as_ptr(), place) };
    }
}

/// A word of the index of the first pair in its low half and the count of pairs in its high half; `None` if weights are missing.
#[inline(always)]
fn place(count: usize, weights: usize, index: u16) -> Option<u32> {
    let is_within = usize::from(index) + count <= weights & !1 && count <= usize::from(u16::MAX);
    is_within.then_some((count as u32) << 16 | u32::from(index))
}

/// r0: six sums; r1: pairs as words, unaligned or not; r2: the block's weights; r3: the word from `place`.
///
/// Two pairs are rearranged into one word of samples per channel, and added by six SMLADs.
#[unsafe(naked)]
unsafe extern "C" fn add_words(
    sums: *mut [ChannelSums<i16>; 2],
    pairs: *const u32,
    weights: *const u32,
    place: u32,
) {
    naked_asm!(
        // Adds samples of C in r12 and of D in \\d; cosines are in r0, sines in \\sine, two ones in lr.
        ".macro ADD d, sine",
        "smlad r4, r12, r0, r4",
        "smlad r7, \\d, r0, r7",
        "smlad r5, r12, \\sine, r5",
        "smlad r8, \\d, \\sine, r8",
        "smlad r6, r12, lr, r6",
        "smlad r9, \\d, lr, r9",
        ".endm",
        ".macro LOAD_TWO",
        "ldr r11, [r1, #4]",
        "ldr r10, [r1], #8",
        "pkhbt r12, r10, r11, lsl #16",
        "pkhtb r11, r11, r10, asr #16",
        "ldrd r0, r10, [r2], #8",
        ".endm",
        ".macro ADD_TWO",
        "LOAD_TWO",
        "ADD r11, r10",
        ".endm",
        "push {{r0, r4-r11, lr}}",
        "mov lr, #0x00010001",
        "lsls r12, r3, #16",
        "bne 6f",
        // The block begins. If there are eight pairs, the products of the first two begin the sums.
        "subs r3, #0x80000",
        "blo 7f",
        "LOAD_TWO",
        "smuad r4, r12, r0",
        "smuad r7, r11, r0",
        "smuad r5, r12, r10",
        "smuad r8, r11, r10",
        "smuad r6, r12, lr",
        "smuad r9, r11, lr",
        "b 8f",
        "7:",
        "movs r4, #0",
        "movs r5, #0",
        "movs r6, #0",
        "movs r7, #0",
        "mov r8, r4",
        "mov r9, r4",
        "b 3f",
        "1:",
        "subs r3, #0x80000",
        "blo 3f",
        "2:",
        "ADD_TWO",
        "8:",
        "ADD_TWO",
        "ADD_TWO",
        "ADD_TWO",
        "subs r3, #0x80000",
        "bhs 2b",
        // Flag C: four more pairs are left. Flag N: two more.
        "3:",
        "lsls r3, r3, #14",
        "bcc 4f",
        "ADD_TWO",
        "ADD_TWO",
        "4:",
        "bpl 5f",
        "ADD_TWO",
        "5:",
        "lsls r3, r3, #1",
        "bpl 5f",
        // A single last pair: the high halves are zero.
        "ldr r10, [r1]",
        "ldrd r0, r11, [r2]",
        "uxth r12, r10",
        "lsrs r10, r10, #16",
        "ADD r10, r11",
        "5:",
        "pop {{r0}}",
        "stmia r0, {{r4-r9}}",
        "pop {{r4-r11, pc}}",
        "6:",
        "ldmia r0, {{r4-r9}}",
        "lsrs r12, r12, #17",
        "add r2, r2, r12, lsl #3",
        "bcc 1b",
        "cmp r3, #0x10000",
        "blo 5b",
        // A first pair of odd index: the low halves are zero.
        "ldr r10, [r1], #4",
        "ldrd r0, r11, [r2], #8",
        "lsls r12, r10, #16",
        "bfc r10, #0, #16",
        "ADD r10, r11",
        "subs r3, #0x10000",
        "b 1b",
        ".purgem ADD",
        ".purgem LOAD_TWO",
        ".purgem ADD_TWO",
    )
}

/// As `add_words`, for the watch: four SMLADs, and extremes by SSUB16 with SEL.
#[unsafe(naked)]
unsafe extern "C" fn watch_words(
    watch: *mut [ChannelWatch<i16>; 2],
    pairs: *const u32,
    weights: *const u32,
    place: u32,
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
        ".macro WATCH_TWO",
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
        ".endm",
        "push {{r0, r4-r11, lr}}",
        "lsls r12, r3, #16",
        "bne 6f",
        // The block begins.
        "movs r4, #0",
        "movs r5, #0",
        "movs r6, #0",
        "movs r7, #0",
        "mov r8, #0x80008000",
        "mvn r9, r8",
        "1:",
        "subs r3, #0x40000",
        "blo 3f",
        "2:",
        "WATCH_TWO",
        "WATCH_TWO",
        "subs r3, #0x40000",
        "bhs 2b",
        // Flag C: two more pairs are left. Flag N: one more.
        "3:",
        "lsls r3, r3, #15",
        "bcc 4f",
        "WATCH_TWO",
        "4:",
        "bpl 5f",
        "ldr r10, [r1]",
        "SEE r10, r10",
        "ldrd r0, r11, [r2]",
        "uxth r12, r10",
        "lsrs r10, r10, #16",
        "ADD r12, r10, r0, r11",
        "5:",
        "pop {{r0}}",
        "pkhbt r10, r9, r8, lsl #16",
        "pkhtb r9, r8, r9, asr #16",
        "mov r8, r7",
        "mov r7, r6",
        "mov r6, r10",
        "stmia r0, {{r4-r9}}",
        "pop {{r4-r11, pc}}",
        "6:",
        "ldmia r0, {{r4-r9}}",
        // r6 has both extremes of C, r9 those of D: rearranged into highest in r8 and lowest in r9.
        "mov r10, r6",
        "mov r6, r7",
        "mov r7, r8",
        "pkhtb r8, r9, r10, asr #16",
        "pkhbt r9, r10, r9, lsl #16",
        "lsrs r12, r12, #17",
        "add r2, r2, r12, lsl #3",
        "bcc 1b",
        "cmp r3, #0x10000",
        "blo 5b",
        // A first pair of odd index: the low halves are zero.
        "ldr r10, [r1], #4",
        "SEE r10, r10",
        "ldrd r0, r11, [r2], #8",
        "lsls r12, r10, #16",
        "bfc r10, #0, #16",
        "ADD r12, r10, r0, r11",
        "subs r3, #0x10000",
        "b 1b",
        ".purgem SEE",
        ".purgem ADD",
        ".purgem WATCH_TWO",
    )
}
