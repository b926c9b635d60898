//! What a window must satisfy by itself to be believed, and beside the noise of those before: general tests on its residuals.
//!
//! Every threshold is a false-alarm rate below 10⁻⁹ a window for white noise, plus a floor under which a deviation is no fault.

use super::standing::Standing;
use crate::arch::square_root;
use crate::estimate::Flags;
use crate::order::{greater, lesser};
use crate::window::{Covariance, Fit, Model, Remains};

/// Standard deviations of an innocent deviation.
pub(super) const SIGMAS: f32 = 7.0;
/// Standard deviations of an innocent variance: three in 10¹⁰, as a window has several parts.
const REACH: f32 = 6.2;
/// Standard deviations of one that is looked at only once, where no windows before are known: one in a million.
const REACH_ONCE: f32 = 4.75;
/// Third harmonic, as a share of a_A, that common electronics may have.
const HARMONIC_FLOOR: f32 = 1e-3;
/// Residual, as a share of a_A, that rounding and converters may leave: (2·10⁻⁴)².
const RESIDUAL_FLOOR: f32 = 4e-8;
/// Residual of a first window's blocks, as a share of the wave's own power, beyond which it is no wave: 20 % noise leaves 0.1.
const STRANGER: f32 = 0.25;
/// By how much the residual variance about the carrier may exceed that about the third harmonic.
const COLOUR: f32 = 16.0;
/// By how much a window's noise variance may exceed that of the windows before and be no fault.
const RISE: f32 = 4.0;

/// The noise variance of the clean windows before.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Noise {
    variance: f32,
    /// The mean of that and of the noise about the third harmonic, by degrees of freedom.
    wide: f32,
    freedom: f32,
    /// Blocks by which windows moved on that raised their residual together.
    refused: u32,
}

impl Noise {
    /// None known.
    pub(crate) const NONE: Self = Self {
        variance: 0.0,
        wide: 0.0,
        freedom: 0.0,
        refused: 0,
    };
    /// Windows that raise their residual together are a new level of noise, if the third harmonic's neighbourhood agrees. So many that do
    /// not overlap: a fault is in all that overlap it.
    const NEW_LEVEL: u32 = 3;
    /// Degrees of freedom remembered, in windows.
    const MEMORY: f32 = 16.0;
    /// How much more the windows before may weigh than one window, which knows its noise by few degrees of freedom.
    const SHARE: f32 = 2.0;

    /// The noise variance of a window, from its own of `freedom` degrees and that of the windows before, unless it is a new one.
    #[inline]
    pub(crate) fn beside(&self, variance: f32, freedom: f32) -> f32 {
        if self.is_exceeded(variance, freedom, 0.0) {
            return variance;
        }
        let before = lesser(self.freedom, Self::SHARE * freedom);
        variance + (self.variance - variance) * before / (freedom + before)
    }

    /// Forgets that windows raised their residual.
    pub(crate) fn refuse_none(&mut self) {
        self.refused = 0;
    }

    /// Takes the noise of a window that is otherwise clean.
    fn learn(&mut self, variance: f32, wide: f32, freedom: f32) {
        // What is so much more than this was no noise, but a fault that a first window could not tell.
        if is_louder(self.variance, variance, self.freedom, freedom) {
            self.freedom = 0.0;
        }
        self.freedom = lesser(self.freedom + freedom, Self::MEMORY * freedom);
        let share = freedom / self.freedom;
        self.variance += (variance - self.variance) * share;
        self.wide += (wide - self.wide) * share;
        self.refused = 0;
    }

    /// True when a variance of `freedom` exceeds the one remembered, and a floor.
    fn is_exceeded(&self, variance: f32, freedom: f32, floor: f32) -> bool {
        self.freedom > 0.0 && is_louder(variance - floor, self.variance, freedom, self.freedom)
    }
}

/// True when a variance exceeds a level by more than noise may rise, and by more than chance explains from their degrees of freedom.
fn is_louder(variance: f32, level: f32, freedom: f32, other: f32) -> bool {
    variance > RISE * level && variance > limit(freedom, other) * level
}

/// True when the first window after a search holds no wave, or as much else beside it: two tones, say.
pub(crate) fn is_no_wave(fit: &Fit, wave: &Standing, blocks: u16, length: u16) -> bool {
    let remains = &fit.remains;
    let samples = f32::from(blocks) * f32::from(length);
    let explained = 0.5
        * samples
        * (wave.record.main.value * wave.record.main.value
            + wave.record.quadrature.value * wave.record.quadrature.value);
    let strange = greater(
        remains.residual,
        remains.third_noise * remains.third_freedom,
    );
    // Long blocks show a little of a wave at another frequency, and leave more, which is as white as noise: what a step leaves is not.
    let alias = is_hidden(fit, wave) && COLOUR * remains.third_noise > remains.variance();
    !is_significant(wave) || strange > STRANGER * explained || alias
}

/// True when there is more noise than wave.
pub(crate) fn is_hidden(fit: &Fit, wave: &Standing) -> bool {
    fit.remains.variance() > wave.record.main.value * wave.record.main.value
}

/// True when the main amplitude stands out of its own noise.
fn is_significant(wave: &Standing) -> bool {
    wave.record.main.value * wave.record.main.value > 36.0 * wave.record.main.variance
}

/// Tests of one window by itself and against the noise of those before.
///
/// `variance` is the noise variance that it leaves, `coding` what the converter's steps may add; the next window begins `advance` blocks
/// later.
pub(crate) fn within(
    model: &Model,
    fit: &Fit,
    wave: &Standing,
    [variance, coding]: [f32; 2],
    noise: &mut Noise,
    advance: u16,
) -> Flags {
    let remains = &fit.remains;
    let power = wave.record.main.value * wave.record.main.value;
    let floor = RESIDUAL_FLOOR * power + 3.0 * coding;
    let mut flags = Flags::empty();

    let significant = is_significant(wave);
    flags = flags.with_if(!significant, Flags::LOST);

    let known = noise.freedom > 0.0;
    // White noise is the same about the carrier and about its third harmonic. A first window has no other noise to be compared with, and
    // one block's fault may be in that too: to leave out the worst of n makes chance no more than n times as likely.
    let (about_third, reach) = if known {
        (remains.third_noise, REACH)
    } else {
        let least = lesser(remains.third_noise, remains.third_spared);
        (least, REACH_ONCE)
    };
    let beyond = variance - 4.0 * floor;
    let coloured = remains.third_freedom >= 12.0
        && beyond > COLOUR * about_third
        && beyond > limit_of(reach, remains.freedom, remains.third_freedom) * about_third;
    // What is white is seen better in both together.
    let both = remains.freedom + remains.third_freedom;
    let wide = (remains.residual + remains.third_noise * remains.third_freedom) / both;
    // Blocks of a few samples have more sums than samples: no more is known than these tell, less ten unknowns.
    let wide_freedom = lesser(both, 4.0 * model.half - 10.0);
    let louder = known
        && (noise.is_exceeded(variance, remains.freedom, floor)
            || is_louder(wide - floor, noise.wide, wide_freedom, noise.freedom));
    // A part of the residual beside the noise of the windows before, or beside the rest where that is known better.
    let stands_out = |part: f32, degrees: f32, floor: f32| {
        let rest = remains.freedom - degrees;
        let (level, freedom) = if noise.freedom > rest && !louder {
            (noise.variance, noise.freedom)
        } else {
            (greater(remains.residual - part, 0.0) / rest, rest)
        };
        // Of so few degrees the limit is more than that.
        part > RISE * degrees * level + floor
            && part > limit(degrees, freedom) * degrees * level + floor
    };
    // One block out of line with all others: a step, a spike or a short dropout.
    // Of both pick-offs' sums of a block, those that its own offsets leave.
    let sums = 4.0 + 2.0 * model.shared;
    let outlier = stands_out(remains.worst_block, sums, 6.0 * floor);
    // A step within the window, or any course that bends.
    let stepped = stands_out(remains.step, 4.0, (8.0 + 0.1 * remains.freedom) * floor);
    let misfit = coloured || louder || outlier || stepped || !fit.settled;
    flags = flags.with_if(misfit, Flags::MISFIT);

    let third_noise = greater(remains.third_noise, lesser(wide, noise.wide));
    let harmonic =
        remains.third_freedom >= 12.0 && has_harmonic(model, remains, wave, coding, third_noise);
    flags = flags.with_if(harmonic, Flags::CLIPPED);

    let round = wave.lesser * wave.lesser < 36.0 * wave.lesser_variance
        || wave.lesser < 2e-3 * wave.record.main.value;
    flags = flags.with_if(round && significant, Flags::CIRCULAR);

    if flags.with(Flags::CIRCULAR) == Flags::CIRCULAR {
        noise.learn(variance, wide, remains.freedom);
    } else if flags.with(Flags::CIRCULAR) == Flags::MISFIT.with(Flags::CIRCULAR)
        && !(coloured || outlier || stepped)
        && fit.settled
    {
        noise.refused += u32::from(advance.min(model.blocks));
        if noise.refused >= Noise::NEW_LEVEL * u32::from(model.blocks) {
            *noise = Noise::NONE;
        }
    }
    flags
}

/// True when a pick-off shows a third harmonic beyond its noise and beyond what electronics with its gain may have.
fn has_harmonic(
    model: &Model,
    remains: &Remains,
    wave: &Standing,
    coding: f32,
    noise: f32,
) -> bool {
    // Of a raw pick-off: what of a sample's noise is in an amplitude.
    let Covariance { even, odd } = &model.covariance;
    let share = greater(even[0][0], odd[0][0]);
    let floor = HARMONIC_FLOOR * wave.record.main.value;
    let [per_gain, _] = model.correction.noise_gains;
    [floor, floor / per_gain]
        .iter()
        .zip(&remains.third)
        .any(|(floor, third)| {
            let square = third.norm_sqr();
            square > floor * floor && {
                let chance = square_root(1.2 * share * noise) + square_root(share * coding);
                let limit = SIGMAS * chance + floor;
                square > limit * limit
            }
        })
}

/// How many times a variance of `freedom` degrees may exceed another of `other` by chance, three times in 10¹⁰.
fn limit(freedom: f32, other: f32) -> f32 {
    limit_of(REACH, freedom, other)
}

/// The same for a chance of so many standard deviations: Paulson's approximation.
///
/// Infinite where the other is known too badly for that.
#[inline(never)]
fn limit_of(reach: f32, freedom: f32, other: f32) -> f32 {
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
