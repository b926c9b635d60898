//! Cortex-M4 instructions without a stable Rust intrinsic, and the sample-rate kernels in assembly. Each has a portable twin that agrees
//! with it bit for bit.
//!
//! This is the only module with `unsafe` code. A word holds two 16-bit codes, the first in its low half.

#![allow(
    unsafe_code,
    reason = "single instructions, and sums over slices with bounds checked beforehand"
)]

#[cfg(has_dsp)]
mod dsp;
#[cfg(has_vsqrt)]
mod fpu;
#[cfg_attr(
    any(has_dsp, has_vsqrt),
    allow(dead_code, reason = "the instructions take their place")
)]
pub mod portable;
#[cfg(all(has_dsp, has_vsqrt))]
mod watched;

#[cfg(has_dsp)]
pub use dsp::{
    add_delayed, add_pairs, add_products, dual_multiply_add, half_difference, half_sum,
    limited_difference, watch_pairs,
};
#[cfg(not(has_dsp))]
pub use portable::{
    add_delayed, add_pairs, add_products, dual_multiply_add, half_difference, half_sum,
    limited_difference, watch_pairs,
};

#[cfg(has_vsqrt)]
pub use fpu::{add_floats, square_root};
#[cfg(not(has_vsqrt))]
pub use portable::{add_floats, square_root};

#[cfg(not(all(has_dsp, has_vsqrt)))]
pub use portable::watch_floats;
#[cfg(all(has_dsp, has_vsqrt))]
pub use watched::watch_floats;

#[cfg(test)]
mod tests {
    use super::portable::*;

    #[test]
    fn extreme_halves_are_halved_limited_and_multiplied_without_overflow() {
        let (least, most) = (0x8000_8000, 0x7fff_7fff);
        assert_eq!(half_difference(most, least), 0x7fff_7fff);
        assert_eq!(half_difference(least, most), 0x8000_8000);
        assert_eq!(half_sum(least, least), least);
        assert_eq!(limited_difference(most, least), most);
        assert_eq!(limited_difference(least, 0x0001_ffff), 0x8000_8001);
        assert_eq!(half_sum(0x0001_ffff, 0x0000_0000), 0x0000_ffff);
        assert_eq!(dual_multiply_add(least, least, 5), 5 + (1 << 31));
        assert_eq!(
            add_delayed([i64::MIN, -1], least, 0x7fff_8000),
            [i64::MIN + 32_768, -1 - 32_768 * 32_767]
        );
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
