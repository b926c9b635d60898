//! Kernels in f32, by the single-precision floating-point unit.

use core::arch::naked_asm;

use super::portable;
use crate::block::ChannelSums;
use crate::sample::{Form, SamplePair};

/// VSQRT.
#[inline(always)]
pub fn square_root(x: f32) -> f32 {
    let mut bits = x.to_bits();
    // SAFETY: only `s15`, declared as clobbered, is changed: Rust has no operands of this register class for this core. Rounding is that
    // of IEEE 754, as in the portable twin.
    unsafe {
        core::arch::asm!("vmov s15, {x}", "vsqrt.f32 s15, s15", "vmov {x}, s15",
            x = inout(reg) bits, out("s15") _, options(pure, nomem, nostack, preserves_flags));
    }
    f32::from_bits(bits)
}

/// The portable kernel of the same name.
#[inline(always)]
pub fn add_floats<P: SamplePair<f32>>(
    sums: &mut [ChannelSums<f32>; 2],
    pairs: &[P],
    weights: &[[f32; 2]],
    index: u16,
) {
    const { assert!(size_of::<[ChannelSums<f32>; 2]>() == 24) };
    let Some(by) = portable::weights_from(weights, index, pairs.len()) else {
        return;
    };
    // The lowest bit asks for new sums, at the first pair of a block.
    let count = pairs.len() << 1 | usize::from(index == 0);
    let (from, by) = (pairs.as_ptr(), by.as_ptr());
    match P::FORM {
        // SAFETY: each pair is one word, there are weights for all pairs, and the sums are six words.
        Form::Codes => unsafe { add_codes(sums, from.cast(), by, count) },
        // SAFETY: as above, except that each pair is two words.
        Form::Floats => unsafe { add_pairs(sums, from.cast(), by, count) },
        Form::Other => portable::add_floats(sums, pairs, weights, index),
    }
}

/// Macro that adds a pair to the sums, s0 to s5.
macro_rules! add {
    () => {
        ".macro ADD cosine, sine, c, d
        vmul.f32 s14, \\c, \\cosine
        vmul.f32 s15, \\c, \\sine
        vadd.f32 s0, s0, s14
        vmul.f32 s14, \\d, \\cosine
        vadd.f32 s1, s1, s15
        vmul.f32 s15, \\d, \\sine
        vadd.f32 s2, s2, \\c
        vadd.f32 s3, s3, s14
        vadd.f32 s4, s4, s15
        vadd.f32 s5, s5, \\d
        .endm"
    };
}

/// r0: six sums; r1: words of two codes, unaligned or not; r2: weights; r3: twice the count of pairs, which is at least one, plus one if
/// the sums begin.
#[unsafe(naked)]
unsafe extern "C" fn add_codes(
    sums: *mut [ChannelSums<f32>; 2],
    pairs: *const u32,
    weights: *const [f32; 2],
    count: usize,
) {
    naked_asm!(
        ".fpu fpv4-sp-d16",
        add!(),
        ".macro LOAD c, d, word, high",
        "asr \\high, \\word, #16",
        "vmov \\c, \\d, \\word, \\high",
        // A conversion of 16 bits: it reads only the low half of the register.
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
        "lsrs r3, r3, #1",
        "bcs 5f",
        "vldmia r0, {{s0-s5}}",
        "6:",
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
        "5:",
        "mov r12, #0",
        "vmov s0, s1, r12, r12",
        "vmov s2, s3, r12, r12",
        "vmov s4, s5, r12, r12",
        "b 6b",
        ".purgem ADD",
        ".purgem LOAD",
        ".purgem ADD_TWO",
    )
}

/// As `add_codes`, for pairs of f32.
#[unsafe(naked)]
unsafe extern "C" fn add_pairs(
    sums: *mut [ChannelSums<f32>; 2],
    pairs: *const [f32; 2],
    weights: *const [f32; 2],
    count: usize,
) {
    naked_asm!(
        ".fpu fpv4-sp-d16",
        add!(),
        "lsrs r3, r3, #1",
        "bcs 5f",
        "vldmia r0, {{s0-s5}}",
        "6:",
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
        "5:",
        "mov r12, #0",
        "vmov s0, s1, r12, r12",
        "vmov s2, s3, r12, r12",
        "vmov s4, s5, r12, r12",
        "b 6b",
        ".purgem ADD",
    )
}
