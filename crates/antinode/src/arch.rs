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
    /// `sum` + low·low + high·high of two words of signed halves, wrapping.
    #[inline(always)]
    pub fn dual_multiply_add(a: u32, b: u32, sum: i32) -> i32 {
        let [a_low, a_high] = halves(a);
        let [b_low, b_high] = halves(b);
        sum.wrapping_add(a_low * b_low)
            .wrapping_add(a_high * b_high)
    }

    /// `sum` + low·low + high·high of two words of signed halves, in 64 bits.
    #[inline(always)]
    pub fn dual_multiply_add_long(a: u32, b: u32, sum: u64) -> u64 {
        let [a_low, a_high] = halves(a);
        let [b_low, b_high] = halves(b);
        let products = i64::from(a_low * b_low) + i64::from(a_high * b_high);
        sum.wrapping_add(products as u64)
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

    /// The greater of each half.
    #[inline(always)]
    pub fn greater(a: u32, b: u32) -> u32 {
        both(a, b, i32::max)
    }

    /// The lesser of each half.
    #[inline(always)]
    pub fn lesser(a: u32, b: u32) -> u32 {
        both(a, b, i32::min)
    }

    /// The square root, correctly rounded; NaN below zero.
    #[inline(always)]
    pub fn square_root(x: f32) -> f32 {
        libm::sqrtf(x)
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
    use core::arch::asm;

    /// SMLAD.
    #[inline(always)]
    pub fn dual_multiply_add(a: u32, b: u32, sum: i32) -> i32 {
        let out;
        // SAFETY: reads and writes the named registers, and the flag Q.
        unsafe {
            asm!("smlad {out}, {a}, {b}, {sum}", out = lateout(reg) out, a = in(reg) a, b = in(reg) b, sum = in(reg) sum,
                options(pure, nomem, nostack));
        }
        out
    }

    /// SMLALD.
    #[inline(always)]
    pub fn dual_multiply_add_long(a: u32, b: u32, sum: u64) -> u64 {
        let (mut low, mut high) = (sum as u32, (sum >> 32) as u32);
        // SAFETY: reads and writes the named registers only.
        unsafe {
            asm!("smlald {low}, {high}, {a}, {b}", low = inout(reg) low, high = inout(reg) high, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack, preserves_flags));
        }
        u64::from(low) | u64::from(high) << 32
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

    /// SSUB16 and SEL, which passes the flags GE from one to the other.
    #[inline(always)]
    pub fn greater(a: u32, b: u32) -> u32 {
        let out;
        // SAFETY: reads and writes the named registers; `out` is written before the inputs are read last.
        unsafe {
            asm!("ssub16 {out}, {a}, {b}", "sel {out}, {a}, {b}", out = out(reg) out, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack));
        }
        out
    }

    /// SSUB16 and SEL the other way.
    #[inline(always)]
    pub fn lesser(a: u32, b: u32) -> u32 {
        let out;
        // SAFETY: as in `greater`.
        unsafe {
            asm!("ssub16 {out}, {a}, {b}", "sel {out}, {b}, {a}", out = out(reg) out, a = in(reg) a, b = in(reg) b,
                options(pure, nomem, nostack));
        }
        out
    }
}

#[cfg(has_vsqrt)]
mod fpu {
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
}

#[cfg(has_dsp)]
pub use dsp::{
    dual_multiply_add, dual_multiply_add_long, greater, half_difference, half_sum, lesser,
};
#[cfg(not(has_dsp))]
pub use portable::{
    dual_multiply_add, dual_multiply_add_long, greater, half_difference, half_sum, lesser,
};

#[cfg(has_vsqrt)]
pub use fpu::square_root;
#[cfg(not(has_vsqrt))]
pub use portable::square_root;

/// The low halves of two words, the first below: PKHBT.
#[inline(always)]
pub fn low_halves(first: u32, second: u32) -> u32 {
    (first & 0xffff) | (second << 16)
}

/// The high halves of two words, the first below: PKHTB.
#[inline(always)]
pub fn high_halves(first: u32, second: u32) -> u32 {
    (first >> 16) | (second & 0xffff_0000)
}

#[cfg(test)]
mod tests {
    use super::portable::*;

    #[test]
    fn extremes_of_the_halves() {
        let (least, most) = (0x8000_8000, 0x7fff_7fff);
        assert_eq!(half_difference(most, least), 0x7fff_7fff);
        assert_eq!(half_difference(least, most), 0x8000_8000);
        assert_eq!(half_sum(least, least), least);
        assert_eq!(half_sum(0x0001_ffff, 0x0000_0000), 0x0000_ffff);
        assert_eq!(greater(0x8000_7fff, 0x7fff_8000), most);
        assert_eq!(lesser(0x8000_7fff, 0x7fff_8000), least);
        assert_eq!(dual_multiply_add(least, least, -1), 0x7fff_ffff);
        assert_eq!(dual_multiply_add_long(least, least, 5), 5 + (1 << 31));
        assert_eq!(
            dual_multiply_add_long(least, 0x0001_0001, 0),
            (-65_536i64) as u64
        );
    }
}
