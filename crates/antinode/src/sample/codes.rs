//! What codes of any width share.

use crate::period::LAGS;

/// D(T) a pair of samples, to a common scale.
pub(super) type Levels = [u32; LAGS];

/// 2³¹/n up to a frame of the period search.
static RECIPROCALS: [u32; 33] = {
    let mut table = [0; 33];
    let mut n = 1;
    while n < table.len() {
        table[n] = (1 << 31) / n as u32;
        n += 1;
    }
    table
};

/// Sums over `count` − lag pairs as means, the largest sum brought to 32 bits.
#[inline(always)]
pub(super) fn means(sums: &[u64; LAGS], count: usize) -> Levels {
    let used = sums.iter().fold(0, |all, &sum| all | sum);
    let shift = 32u32.saturating_sub(used.leading_zeros());
    let mut means = [0; LAGS];
    for ((lag, mean), &sum) in (1..).zip(&mut means).zip(sums) {
        let reciprocal = RECIPROCALS.get(count - lag).copied().unwrap_or(0);
        *mean = (((sum >> shift) as u32 as u64 * u64::from(reciprocal)) >> 32) as u32;
    }
    means
}
