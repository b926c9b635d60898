//! Functions that codes of any width share.

use crate::period::{FRAME, LAGS};

/// 2³¹/n for every count of pairs that a frame of the period search has at a lag.
static RECIPROCALS: [u32; FRAME] = {
    let mut table = [0; FRAME];
    let mut n = 1;
    while n < table.len() {
        table[n] = (1 << 31) / n as u32;
        n += 1;
    }
    table
};

/// Shift that brings the largest sum to the top of its word, so that a mean keeps 24 bits and more.
#[inline(always)]
pub(super) fn shift(sums: &[u32; LAGS]) -> u32 {
    sums.iter().fold(1, |all, &sum| all | sum).leading_zeros()
}

/// The mean of a sum over `count` pairs; the shift keeps the last digits of small sums.
#[inline(always)]
pub(super) fn mean(sum: u32, shift: u32, count: usize) -> u32 {
    let reciprocal = RECIPROCALS[count % FRAME];
    ((u64::from(sum << shift) * u64::from(reciprocal)) >> 32) as u32
}
