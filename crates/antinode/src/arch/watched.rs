//! Sums and watch in f32 in one pass, by the floating-point unit and, for 16-bit codes, the DSP extension.

use core::arch::naked_asm;

use super::portable;
use crate::block::{ChannelSums, ChannelWatch};
use crate::sample::{Form, SamplePair};

/// The portable kernel of the same name.
#[inline(always)]
pub fn watch_floats<P: SamplePair<f32>>(
    sums: &mut [ChannelSums<f32>; 2],
    watch: &mut [ChannelWatch<f32>; 2],
    pairs: &[P],
    weights: &[[f32; 2]],
    index: u16,
) {
    if P::FORM == Form::Other {
        return portable::watch_floats(sums, watch, pairs, weights, index);
    }
    let Some(by) = begin(sums, watch, pairs, weights, index) else {
        return;
    };
    let (from, by) = (pairs.as_ptr(), by.as_ptr());
    let place = (pairs.len() as u32) << 16 | u32::from(index);
    if P::FORM == Form::Codes {
        // SAFETY: each pair is one word, `begin` has found weights for all pairs, and the sizes of sums and watch are asserted below.
        let extremes = unsafe { watch_codes(sums, from.cast(), by, place, watch) };
        let halves = |word: u32| [f32::from(word as i16), f32::from((word >> 16) as i16)];
        let (most, least) = (halves(extremes as u32), halves((extremes >> 32) as u32));
        for (watch, (low, high)) in watch.iter_mut().zip(least.into_iter().zip(most)) {
            watch.reach(low, high);
        }
    } else {
        // SAFETY: as above, except that each pair is two words.
        unsafe { watch_pairs(sums, from.cast(), by, place, watch) };
    }
    if let Some(last) = pairs.last() {
        for (watch, sample) in watch.iter_mut().zip(last.pair()) {
            watch.end(sample);
        }
    }
}

/// Begins sums and watch at the start of a block, and compares the first pair with the last one before it. Gives the weights from sample
/// `index` on; `None` if there is no pair or if weights are missing.
#[inline(always)]
fn begin<'w, P: SamplePair<f32>>(
    sums: &mut [ChannelSums<f32>; 2],
    watch: &mut [ChannelWatch<f32>; 2],
    pairs: &[P],
    weights: &'w [[f32; 2]],
    index: u16,
) -> Option<&'w [[f32; 2]]> {
    let by = weights.get(usize::from(index)..)?;
    let first = pairs.first().filter(|_| pairs.len() <= by.len())?;
    if index == 0 {
        *sums = [ChannelSums::empty(); 2];
        *watch = [ChannelWatch::empty(); 2];
    }
    for (watch, sample) in watch.iter_mut().zip(first.pair()) {
        if sample == watch.last() {
            watch.see_again(sample, index);
        }
    }
    Some(by)
}

/// Size of the watch of one pick-off, in bytes.
const WATCH: u32 = 40;

const _: () = assert!(size_of::<ChannelWatch<f32>>() == WATCH as usize);
const _: () = assert!(size_of::<[ChannelSums<f32>; 2]>() == 24);

/// Counts the second of two pairs as repeated, in each pick-off where it equals the first.
extern "C" fn see_again<P: SamplePair<f32>>(
    watch: &mut [ChannelWatch<f32>; 2],
    pairs: &[P; 2],
    index: u32,
) {
    let [before, pair] = pairs.map(P::pair);
    for (watch, (before, sample)) in watch.iter_mut().zip(before.into_iter().zip(pair)) {
        if sample == before {
            watch.see_again(sample, index as u16);
        }
    }
}

/// Macro that adds a pair to the sums, s16 to s21, and to those of the third harmonic, s22 to s25.
macro_rules! add {
    () => {
        ".macro ADD cosine, sine, c, d
        vmul.f32 s10, \\c, \\cosine
        vmul.f32 s11, \\c, \\sine
        vmul.f32 s8, \\cosine, \\cosine
        vmul.f32 s12, \\d, \\cosine
        vmul.f32 s13, \\d, \\sine
        vadd.f32 s16, s16, s10
        vadd.f32 s17, s17, s11
        vadd.f32 s18, s18, \\c
        vmul.f32 s10, s10, s8
        vmul.f32 s11, s11, s8
        vadd.f32 s19, s19, s12
        vadd.f32 s20, s20, s13
        vadd.f32 s21, s21, \\d
        vmul.f32 s12, s12, s8
        vmul.f32 s13, s13, s8
        vadd.f32 s22, s22, s10
        vadd.f32 s23, s23, s11
        vadd.f32 s24, s24, s12
        vadd.f32 s25, s25, s13
        .endm"
    };
}

/// r0: six sums; r1: at least one word of two codes, unaligned or not; r2: their weights; r3: the count of pairs in the high half, and
/// the index of the first in the low half; on the stack: the watch.
///
/// Gives the highest codes in r0 and the lowest in r1. The first pair is not compared with the one before it: `begin` does that.
#[unsafe(naked)]
unsafe extern "C" fn watch_codes(
    sums: *mut [ChannelSums<f32>; 2],
    pairs: *const [i16; 2],
    weights: *const [f32; 2],
    place: u32,
    watch: *mut [ChannelWatch<f32>; 2],
) -> u64 {
    naked_asm!(
        ".fpu fpv4-sp-d16",
        add!(),
        ".macro CONVERT c, d, word",
        "asr r12, \\word, #16",
        "vmov \\c, \\d, \\word, r12",
        // A conversion of 16 bits: it reads only the low half of the register.
        "vcvt.f32.s16 \\c, \\c, #0",
        "vcvt.f32.s16 \\d, \\d, #0",
        ".endm",
        // r7: highest codes, r8: lowest.
        ".macro REACH most, least",
        "ssub16 r12, \\most, r7",
        "sel r7, \\most, r7",
        "ssub16 r12, r8, \\least",
        "sel r8, \\least, r8",
        ".endm",
        // Compares the two pairs from so many bytes before r4 on.
        ".macro AGAIN back",
        "ldr r0, [sp, #80]",
        "sub r1, r4, #\\back",
        "sub r2, r1, r11",
        "lsr r2, r2, #2",
        "bl {again}",
        ".endm",
        // r4: pairs, r5: weights, r6: count of pairs left, r9: previous pair, r10: two ones, r11: where the pair before
        // the block would lie.
        "push {{r0, r4-r11, lr}}",
        "vpush {{s16-s25}}",
        "mov r4, r1",
        "mov r5, r2",
        "lsrs r6, r3, #16",
        "uxth r3, r3",
        "sub r11, r1, r3, lsl #2",
        "sub r11, #4",
        "ldr r1, [sp, #80]",
        "vldmia r0, {{s16-s21}}",
        "vldmia r1, {{s22-s23}}",
        "add r1, r1, #{watch}",
        "vldmia r1, {{s24-s25}}",
        "mov r10, #0x00010001",
        "ldr r7, [r4]",
        "mov r8, r7",
        "mvn r9, r7",
        "subs r6, #2",
        "blo 3f",
        "1:",
        "ldr r1, [r4, #4]",
        "ldr r0, [r4], #8",
        // Of halves that equal those before, the exclusive or is 0 and leaves a one.
        "eor r2, r0, r9",
        "uqsub16 r2, r10, r2",
        "ssub16 r3, r0, r1",
        "uqsub16 r3, r10, r3",
        "orrs r12, r2, r3",
        "bne 6f",
        // The halves that SEL takes are those of SSUB16: what lies between leaves its flags alone.
        "2:",
        "mov r9, r1",
        "sel r2, r0, r1",
        "sel r3, r1, r0",
        "REACH r2, r3",
        "CONVERT s0, s1, r0",
        "CONVERT s2, s3, r1",
        "vldmia r5!, {{s4-s7}}",
        "ADD s4, s5, s0, s1",
        "ADD s6, s7, s2, s3",
        "subs r6, #2",
        "bhs 1b",
        "3:",
        "lsls r6, r6, #31",
        "beq 5f",
        "ldr r0, [r4]",
        "eor r2, r0, r9",
        "uqsub16 r2, r10, r2",
        "cmp r2, #0",
        "bne 7f",
        "4:",
        "REACH r0, r0",
        "CONVERT s0, s1, r0",
        "vldmia r5, {{s4-s5}}",
        "ADD s4, s5, s0, s1",
        "5:",
        "ldr r0, [sp, #40]",
        "ldr r1, [sp, #80]",
        "vstmia r0, {{s16-s21}}",
        "vstmia r1, {{s22-s23}}",
        "add r1, r1, #{watch}",
        "vstmia r1, {{s24-s25}}",
        "mov r0, r7",
        "mov r1, r8",
        "vpop {{s16-s25}}",
        "pop {{r3, r4-r11, pc}}",
        // Repeated samples. The call clobbers r0 to r3 and the flags: both pairs are loaded and compared again.
        "6:",
        "cbz r2, 8f",
        "AGAIN 12",
        "8:",
        "AGAIN 8",
        "ldr r0, [r4, #-8]",
        "ldr r1, [r4, #-4]",
        "ssub16 r3, r0, r1",
        "b 2b",
        "7:",
        "AGAIN 4",
        "ldr r0, [r4]",
        "b 4b",
        ".purgem ADD",
        ".purgem CONVERT",
        ".purgem REACH",
        ".purgem AGAIN",
        watch = const WATCH,
        again = sym see_again::<[i16; 2]>,
    )
}

/// As `watch_codes`, for pairs of f32, but it updates the extremes in the watch itself. NaN is no extreme.
#[unsafe(naked)]
unsafe extern "C" fn watch_pairs(
    sums: *mut [ChannelSums<f32>; 2],
    pairs: *const [f32; 2],
    weights: *const [f32; 2],
    place: u32,
    watch: *mut [ChannelWatch<f32>; 2],
) {
    naked_asm!(
        ".fpu fpv4-sp-d16",
        add!(),
        ".macro REACH sample, least, most",
        "vcmp.f32 \\sample, \\least",
        "vmrs APSR_nzcv, fpscr",
        "it mi",
        "vmovmi.f32 \\least, \\sample",
        "vcmp.f32 \\sample, \\most",
        "vmrs APSR_nzcv, fpscr",
        "it gt",
        "vmovgt.f32 \\most, \\sample",
        ".endm",
        // s26, s27: lowest and highest of C; s28, s29: of D; s14, s15: previous pair; r4: pairs, r5: weights, r6: count of pairs left,
        // r7: watch, r8: where the pair before the block would lie, r9: sums.
        "push {{r4-r9, lr}}",
        "ldr r7, [sp, #28]",
        "sub sp, #4",
        "vpush {{s16-s29}}",
        "mov r4, r1",
        "mov r5, r2",
        "mov r9, r0",
        "lsrs r6, r3, #16",
        "uxth r3, r3",
        "sub r8, r1, r3, lsl #3",
        "sub r8, #8",
        "vldmia r0, {{s16-s21}}",
        "vldmia r7, {{s22-s23}}",
        "vldr s26, [r7, #8]",
        "vldr s27, [r7, #12]",
        "vldr s24, [r7, #{watch}]",
        "vldr s25, [r7, #{watch} + 4]",
        "vldr s28, [r7, #{watch} + 8]",
        "vldr s29, [r7, #{watch} + 12]",
        "mvn r0, #0",
        "vmov s14, s15, r0, r0",
        "1:",
        "vldmia r4!, {{s0-s1}}",
        "vcmp.f32 s0, s14",
        "vmrs APSR_nzcv, fpscr",
        "beq 3f",
        "vcmp.f32 s1, s15",
        "vmrs APSR_nzcv, fpscr",
        "beq 3f",
        "2:",
        "vmov.f32 s14, s0",
        "vmov.f32 s15, s1",
        "REACH s0, s26, s27",
        "REACH s1, s28, s29",
        "vldmia r5!, {{s4-s5}}",
        "ADD s4, s5, s0, s1",
        "subs r6, #1",
        "bne 1b",
        "vstmia r9, {{s16-s21}}",
        "vstmia r7, {{s22-s23}}",
        "vstr s26, [r7, #8]",
        "vstr s27, [r7, #12]",
        "vstr s24, [r7, #{watch}]",
        "vstr s25, [r7, #{watch} + 4]",
        "vstr s28, [r7, #{watch} + 8]",
        "vstr s29, [r7, #{watch} + 12]",
        "vpop {{s16-s29}}",
        "add sp, #4",
        "pop {{r4-r9, pc}}",
        // Repeated samples. The call clobbers s0 to s15, and the pair is loaded again.
        "3:",
        "mov r0, r7",
        "sub r1, r4, #16",
        "sub r2, r1, r8",
        "lsr r2, r2, #3",
        "bl {again}",
        "sub r1, r4, #8",
        "vldmia r1, {{s0-s1}}",
        "b 2b",
        ".purgem ADD",
        ".purgem REACH",
        watch = const WATCH,
        again = sym see_again::<[f32; 2]>,
    )
}
