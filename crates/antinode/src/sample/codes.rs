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

/// Sums over `count` − lag pairs as means, with the last digits of small ones.
#[inline(always)]
pub(super) fn means(sums: &[u32; LAGS], count: usize) -> Levels {
    // The greatest sum is brought to the top, so that a mean keeps 24 bits and more.
    let used = sums.iter().fold(0, |all, &sum| all | sum);
    let shift = used.leading_zeros();
    let first = count.saturating_sub(LAGS);
    let mut means = [0; LAGS];
    let Some(reciprocals) = RECIPROCALS.get(first..first + LAGS) else {
        return means;
    };
    for ((mean, &sum), &reciprocal) in means.iter_mut().zip(sums).zip(reciprocals.iter().rev()) {
        *mean = ((u64::from(sum << shift) * u64::from(reciprocal)) >> 32) as u32;
    }
    means
}
