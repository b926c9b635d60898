//! Maximum, minimum, rounding and conversion in a few instructions each: the library's are calls on a core that lacks the instructions.

/// The greater of two numbers; `b` if `a` is NaN.
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser of two numbers; `b` if `a` is NaN.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The whole number nearest to one within ±2³¹; halves are rounded away from zero.
#[inline(always)]
pub(crate) fn nearest(x: f32) -> i32 {
    (x + if x < 0.0 { -0.5 } else { 0.5 }) as i32
}

/// A `u64` as f32, rounded twice if it has more than 32 bits.
#[inline(always)]
pub(crate) fn long(x: u64) -> f32 {
    (x >> 32) as u32 as f32 * 4_294_967_296.0 + x as u32 as f32
}
