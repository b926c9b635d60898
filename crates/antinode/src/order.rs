//! The greater and the lesser of two numbers, in two instructions: `f32::max` is a call on a core without one.

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
