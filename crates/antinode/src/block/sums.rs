//! What a block keeps of its samples.

use crate::sample::{Sample, Zero};

/// The running sums of one pick-off over one block: formula (24), in input units times the layout's scale.
///
/// Bounds at full scale: in f32 each sum is at most `length` × the largest |sample|. Of `i16` codes, 32 768 × scale × length is at
/// most 32 768 × 65 535 < 2³¹; of `i32` codes, 2³¹ × 32 767 × 65 535 < 2⁶².
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct ChannelSums<S: Sample> {
    /// Σ S cos φ, the C sum of (24).
    pub cosine: S::Sum,
    /// Σ S sin φ, the S sum of (24).
    pub sine: S::Sum,
    /// Σ S, which carries the offset; without the scale.
    pub sum: S::Sum,
}

impl<S: Sample> ChannelSums<S> {
    /// The sums of no samples.
    pub const fn empty() -> Self {
        Self {
            cosine: S::Sum::ZERO,
            sine: S::Sum::ZERO,
            sum: S::Sum::ZERO,
        }
    }
}

/// What is watched of one pick-off over one block besides its sums: clipping, nonlinearity and dead channels show there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct ChannelWatch<S: Sample> {
    /// Σ S cos 3φ of codes; of f32, which need no second table then, Σ S cos φ cos² φ. Within the same bounds as the sums of the carrier.
    pub third_cosine: S::Sum,
    /// Σ S sin 3φ of codes; of f32, Σ S sin φ cos² φ.
    pub third_sine: S::Sum,
    /// The least sample.
    pub low: S,
    /// The greatest sample.
    pub high: S,
    /// Runs of equal samples at the extremes, for f32 only: codes have known rails.
    pub runs: S::Runs,
}

impl<S: Sample> ChannelWatch<S> {
    /// The watch of no samples.
    pub fn empty() -> Self {
        let [high, low] = S::EXTREMES;
        Self {
            third_cosine: S::Sum::ZERO,
            third_sine: S::Sum::ZERO,
            low,
            high,
            runs: S::Runs::default(),
        }
    }
}
