//! The noise of the windows before, beside which one window's own is looked at, and by how much variances may differ by chance.

use crate::arch::square_root;
use crate::scalar::{greater, lesser};

/// Standard deviations of an innocent variance: three in 10¹⁰, as a window has several parts.
pub(super) const REACH: f32 = 6.2;
/// Standard deviations of one that is looked at only once, where no windows before are known: one in a million.
pub(super) const REACH_ONCE: f32 = 4.75;
/// By how much a window's noise variance may exceed that of the windows before and be no fault.
pub(super) const RISE: f32 = 4.0;

/// The noise variance of the clean windows before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub(super) variance: f32,
    /// The mean of that and of the noise about the third harmonic, by degrees of freedom.
    pub(super) wide: f32,
    pub(super) freedom: f32,
    /// The noise variance for which the last of them stated its deviations.
    stated: f32,
    /// Blocks by which windows moved on that raised their residual together.
    refused: u32,
}

impl Noise {
    /// None known.
    pub(super) const NONE: Self = Self {
        variance: 0.0,
        wide: 0.0,
        freedom: 0.0,
        stated: 0.0,
        refused: 0,
    };
    /// Windows that raise their residual together are a new level of noise, if the third harmonic's neighbourhood agrees. So many that do
    /// not overlap: a fault is in all that overlap it.
    pub(super) const NEW_LEVEL: u32 = 3;
    /// Degrees of freedom remembered, in windows.
    const MEMORY: f32 = 16.0;
    /// How much more the windows before may weigh than one window, which knows its noise by few degrees of freedom.
    const SHARE: f32 = 2.0;
    /// Degrees of freedom that are enough to know noise to a sixth: fewer weigh all the same.
    const ENOUGH: f32 = 40.0;
    /// Degrees of freedom from which on one window tells that noise has changed: five blocks have 20.
    const TELLING: f32 = 16.0;
    /// How far a window's noise is by chance from what the one before stated, of one degree of freedom: squared, over that one times the sum
    /// of both.
    const CHANCE: f32 = 3.0;

    /// The noise variance of a window, from its own of `freedom` degrees and that of the windows before, unless it is a new one: for tests,
    /// and for the deviations that are stated, which follow noise that changes.
    #[inline]
    pub(super) fn beside(&self, variance: f32, freedom: f32) -> [f32; 2] {
        if self.is_exceeded(variance, freedom, 0.0) {
            return [variance; 2];
        }
        let before = lesser(self.freedom, greater(Self::SHARE * freedom, Self::ENOUGH));
        let share = before / (freedom + before);
        let apart = self.stated - variance;
        let square = apart * apart;
        // By chance both are so far apart. The noise of few degrees is often next to nothing: less noise is believed later than more.
        let chance = Self::CHANCE * self.stated * (self.stated + variance);
        let agreed = if freedom >= Self::TELLING && share * square * freedom > chance {
            chance / (square * freedom)
        } else {
            share
        };
        [
            variance + (self.variance - variance) * share,
            variance + apart * agreed,
        ]
    }

    /// The lesser of `variance` and that of the windows before.
    #[inline(always)]
    pub(super) fn least(&self, variance: f32) -> f32 {
        if self.freedom > 0.0 {
            lesser(variance, self.variance)
        } else {
            variance
        }
    }

    /// Takes a window of `blocks` that raised its residual, and in nothing else differs; `advance` of them are not in the next one.
    pub(super) fn refuse(&mut self, advance: u16, blocks: u16) {
        self.refused += u32::from(advance);
        if self.refused >= Self::NEW_LEVEL * u32::from(blocks) {
            *self = Self::NONE;
        }
    }

    /// Forgets that windows raised their residual.
    pub(super) fn refuse_none(&mut self) {
        self.refused = 0;
    }

    /// Takes the noise of a window that is otherwise clean, and that for which it states its deviations.
    #[inline(always)]
    pub(super) fn learn(&mut self, variance: f32, stated: f32, wide: f32, freedom: f32) {
        self.stated = stated;
        // Noise that comes and goes is not to be forgotten whenever it goes: only one window's is asked less of.
        let reach = if self.freedom > freedom {
            REACH
        } else {
            REACH_ONCE
        };
        // What is so much more than this was no noise, but a fault that a first window could not tell.
        if self.variance > RISE * variance
            && self.variance > limit_of(reach, self.freedom, freedom) * variance
        {
            self.freedom = 0.0;
            self.stated = variance;
        }
        self.freedom = lesser(self.freedom + freedom, Self::MEMORY * freedom);
        let share = freedom / self.freedom;
        self.variance += (variance - self.variance) * share;
        self.wide += (wide - self.wide) * share;
        self.refused = 0;
    }

    /// True when a variance of `freedom` exceeds the one remembered, and a floor.
    #[inline]
    pub(super) fn is_exceeded(&self, variance: f32, freedom: f32, floor: f32) -> bool {
        // Where none is known the limit is infinite, and of a level of zero that is no number.
        is_louder(variance - floor, self.variance, freedom, self.freedom)
    }
}

/// True when a variance exceeds a level by more than noise may rise, and by more than chance explains from their degrees of freedom.
#[inline]
pub(super) fn is_louder(variance: f32, level: f32, freedom: f32, other: f32) -> bool {
    variance > RISE * level && is_beyond_chance(variance, level, freedom, other)
}

/// True when a variance of `freedom` degrees exceeds a level of `other` by more than chance explains.
#[cold]
#[inline(never)]
fn is_beyond_chance(variance: f32, level: f32, freedom: f32, other: f32) -> bool {
    variance > limit(freedom, other) * level
}

/// How many times a variance of `freedom` degrees may exceed another of `other` by chance, three times in 10¹⁰.
fn limit(freedom: f32, other: f32) -> f32 {
    limit_of(REACH, freedom, other)
}

/// The same for a chance of so many standard deviations: Paulson's approximation.
///
/// Infinite where the other is known too badly for that.
#[cold]
#[inline(never)]
pub(super) fn limit_of(reach: f32, freedom: f32, other: f32) -> f32 {
    // The cube root of a variance is nearly normal, its mean less than one by its own variance.
    let (own, others) = (2.0 / (9.0 * freedom), 2.0 / (9.0 * other));
    let (mean, other_mean) = (1.0 - own, 1.0 - others);
    let squared = reach * reach;
    let known = other_mean * other_mean - squared * others;
    if known.is_nan() || known <= 0.0 {
        return f32::INFINITY;
    }
    let deviation =
        square_root(own * other_mean * other_mean + others * mean * mean - squared * own * others);
    let root = (mean * other_mean + reach * deviation) / known;
    root * root * root
}

#[cfg(test)]
mod tests {
    use super::limit;

    #[test]
    fn limits_are_those_of_the_f_distribution_or_a_little_above() {
        // Quantiles of F for a chance of 2.82·10⁻¹⁰, by scipy's `f.isf`.
        for (freedom, other, exact) in [
            (4.0, 320.0, 13.634),
            (6.0, 320.0, 10.145),
            (20.0, 40.0, 10.480),
            (20.0, 320.0, 4.8260),
            (36.0, 576.0, 3.4453),
            (50.0, 800.0, 2.9354),
        ] {
            let ratio = limit(freedom, other) / exact;
            assert!(
                (1.0..1.1).contains(&ratio),
                "F of {freedom}, {other}: {ratio}"
            );
        }
        assert!(limit(20.0, 8.0).is_infinite() && limit(20.0, 0.0).is_infinite());
    }
}
