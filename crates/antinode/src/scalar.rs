//! The greater, the lesser, the nearest whole number and a long one in a few instructions: those of the library are calls on a core
//! without them.

/// The greater; `b` where `a` is not a number.
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser; `b` where `a` is not a number.
#[inline(always)]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The nearest whole number of one within ±2³¹; of halves the one further from zero.
#[inline(always)]
pub(crate) fn nearest(x: f32) -> i32 {
    (x + if x < 0.0 { -0.5 } else { 0.5 }) as i32
}

/// A long whole number, rounded twice where it has more than 32 bits.
#[inline(always)]
pub(crate) fn long(x: u64) -> f32 {
    (x >> 32) as u32 as f32 * 4_294_967_296.0 + x as u32 as f32
}
