//! The noise level of the windows before, with which that of each window is compared, and how far variances may differ by chance.

use crate::arch::square_root;
use crate::scalar::{greater, lesser};

/// Standard deviations that chance may explain in a ratio of variances: three in 10¹⁰ exceed them, as several parts of a window are tested.
pub(super) const NOISE_SIGMAS: f32 = 6.2;
/// The same for one that is tested only once, where no windows before are known: one in a million.
pub(super) const FIRST_NOISE_SIGMAS: f32 = 4.75;
/// Highest ratio of a window's noise variance to that of the windows before that is no fault in itself.
pub(super) const MAX_RISE: f32 = 4.0;

/// The noise variance of the clean windows before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub(super) variance: f32,
    /// Mean of `variance` and of that about the third harmonic, weighted by degrees of freedom.
    pub(super) wide: f32,
    pub(super) freedom: f32,
    /// Noise variance for which the last of them stated its standard deviations.
    stated: f32,
    /// Blocks by which the latest windows with a raised residual moved on.
    raised: u32,
}

impl Noise {
    /// No noise known.
    pub(super) const NONE: Self = Self {
        variance: 0.0,
        wide: 0.0,
        freedom: 0.0,
        stated: 0.0,
        raised: 0,
    };
    /// Successive windows with a raised residual that make a new level of noise, if the noise about the third harmonic agrees. Windows that
    /// overlap count in part: a fault is in all that contain it.
    pub(super) const NEW_LEVEL: u32 = 3;
    /// Windows whose degrees of freedom are remembered, at most.
    const MAX_WINDOWS: f32 = 16.0;
    /// Highest weight of the windows before, relative to the window's own degrees of freedom.
    const MAX_WEIGHT: f32 = 2.0;
    /// Degrees of freedom that the windows before may weigh in any case: they know the noise to a sixth.
    const ALWAYS_WEIGHED: f32 = 40.0;
    /// Fewest degrees of freedom with which a single window can show that noise has changed: five blocks have 20.
    const MIN_TELLING: f32 = 16.0;
    /// Chance explains a difference between a window's noise variance and the one stated before if its square is below this times the
    /// stated one times the sum of both, over the degrees of freedom.
    const CHANCE_SQUARE: f32 = 3.0;

    /// The noise variance of a window, from its own of `freedom` degrees and, unless that exceeds them, those of the windows before: one
    /// for tests, and one for the stated standard deviations, which follows noise that changes.
    #[inline]
    pub(super) fn blended(&self, variance: f32, freedom: f32) -> [f32; 2] {
        if self.is_exceeded(variance, freedom, 0.0) {
            return [variance; 2];
        }
        let before = lesser(
            self.freedom,
            greater(Self::MAX_WEIGHT * freedom, Self::ALWAYS_WEIGHED),
        );
        let share = before / (freedom + before);
        let apart = self.stated - variance;
        let square = apart * apart;
        // A variance of few degrees of freedom is often near zero, so that less noise is believed later than more.
        let chance = Self::CHANCE_SQUARE * self.stated * (self.stated + variance);
        let agreed = if freedom >= Self::MIN_TELLING && share * square * freedom > chance {
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

    /// Counts a window of `blocks` whose only fault is a raised residual; `advance` of them are not in the next one.
    pub(super) fn count_raised(&mut self, advance: u16, blocks: u16) {
        self.raised += u32::from(advance);
        if self.raised >= Self::NEW_LEVEL * u32::from(blocks) {
            *self = Self::NONE;
        }
    }

    /// Forgets the windows with a raised residual.
    pub(super) fn clear_raised(&mut self) {
        self.raised = 0;
    }

    /// Learns the noise of a clean window, and the variance for which it states its standard deviations.
    #[inline(always)]
    pub(super) fn learn(&mut self, variance: f32, stated: f32, wide: f32, freedom: f32) {
        self.stated = stated;
        // Noise that comes and goes must not be forgotten each time it goes: only that of a single window has the lower limit.
        let sigmas = if self.freedom > freedom {
            NOISE_SIGMAS
        } else {
            FIRST_NOISE_SIGMAS
        };
        // A level so far above this window's was no noise, but a fault that a first window could not tell.
        if self.variance > MAX_RISE * variance
            && self.variance > limit_of(sigmas, self.freedom, freedom) * variance
        {
            self.freedom = 0.0;
            self.stated = variance;
        }
        self.freedom = lesser(self.freedom + freedom, Self::MAX_WINDOWS * freedom);
        let share = freedom / self.freedom;
        self.variance += (variance - self.variance) * share;
        self.wide += (wide - self.wide) * share;
        self.raised = 0;
    }

    /// True when a variance of `freedom` degrees, less a floor, exceeds the one remembered by more than chance explains.
    #[inline]
    pub(super) fn is_exceeded(&self, variance: f32, freedom: f32, floor: f32) -> bool {
        // If none is known, the limit is infinite and the level zero: their product is NaN, which nothing exceeds.
        is_louder(variance - floor, self.variance, freedom, self.freedom)
    }
}

/// True when a variance of `freedom` degrees exceeds a level of `level_freedom` by more than noise may rise, and than chance explains.
#[inline]
pub(super) fn is_louder(variance: f32, level: f32, freedom: f32, level_freedom: f32) -> bool {
    variance > MAX_RISE * level && is_beyond_chance(variance, level, freedom, level_freedom)
}

/// True when it exceeds the level by more than chance explains.
#[cold]
#[inline(never)]
fn is_beyond_chance(variance: f32, level: f32, freedom: f32, level_freedom: f32) -> bool {
    variance > limit(freedom, level_freedom) * level
}

/// Ratio that a variance of `freedom` degrees to another of `other` exceeds by chance three times in 10¹⁰.
fn limit(freedom: f32, other: f32) -> f32 {
    limit_of(NOISE_SIGMAS, freedom, other)
}

/// The same for a chance of `sigmas` standard deviations, by Paulson's approximation.
///
/// Infinite if the other has too few degrees of freedom for that.
#[cold]
#[inline(never)]
pub(super) fn limit_of(sigmas: f32, freedom: f32, other: f32) -> f32 {
    // The cube root of a variance is nearly normal, with a mean of one less its own variance.
    let (own, others) = (2.0 / (9.0 * freedom), 2.0 / (9.0 * other));
    let (mean, other_mean) = (1.0 - own, 1.0 - others);
    let squared = sigmas * sigmas;
    let known = other_mean * other_mean - squared * others;
    if known.is_nan() || known <= 0.0 {
        return f32::INFINITY;
    }
    let deviation =
        square_root(own * other_mean * other_mean + others * mean * mean - squared * own * others);
    let root = (mean * other_mean + sigmas * deviation) / known;
    root * root * root
}

#[cfg(test)]
mod tests {
    use super::{Noise, limit};

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

    #[test]
    fn a_clean_window_between_raised_ones_keeps_the_level() {
        let mut noise = Noise::NONE;
        let raised =
            |noise: &mut Noise, count: u32| (0..count).for_each(|_| noise.count_raised(5, 5));
        for _ in 0..2 {
            noise.learn(1.0, 1.0, 1.0, 20.0);
            raised(&mut noise, Noise::NEW_LEVEL - 1);
        }
        assert_eq!(noise.freedom, 40.0);
        raised(&mut noise, 1);
        assert_eq!(noise.freedom, 0.0);
    }
}
