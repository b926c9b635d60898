//! Two 16-bit products an instruction: the DSP extension of ARMv7E-M.

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
