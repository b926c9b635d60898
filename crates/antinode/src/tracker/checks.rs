//! General tests of one window's residuals, by themselves and against the noise of the windows before.
//!
//! Thresholds are set for fewer than 10⁻⁹ false alarms a window in white noise, about 10⁻⁵ in a first window of 10 to 25 sample pairs (more
//! near six samples a period, where sums about the third harmonic are nearly real), plus a floor below which a deviation is no fault. Where
//! noise alone may seem to change the wave by a_A, as 20 % in windows of 22 pairs, there are 3·10⁻⁵.

use super::noise::{FIRST_NOISE_SIGMAS, MAX_RISE, NOISE_SIGMAS, Noise, is_louder, limit_of};
use super::standing::Standing;
use crate::arch::square_root;
use crate::estimate::Flags;
use crate::scalar::{greater, lesser};
use crate::window::{Covariance, Fit, Model, Remains};

/// Standard deviations beyond which a deviation is a fault.
pub(super) const SIGMAS: f32 = 7.0;
/// Square of an amplitude over its variance beyond which it stands out of its noise: six standard deviations.
pub(super) const SIGNIFICANT: f32 = 36.0;
/// Share of a_A below which the smaller travelling wave is none, and the pattern a circle.
const CIRCULAR_RATIO: f32 = 2e-3;
/// Margin on the third harmonic's share of a sample's noise, which is taken to be the wave's.
const THIRD_NOISE_MARGIN: f32 = 1.2;
/// Third harmonic that common electronics may have, as a share of a_A.
const HARMONIC_FLOOR: f32 = 1e-3;
/// Variance that hum adds to a third harmonic, as a share of its mean square: [`SIGMAS`] times the root is 0.1. Its slopes within blocks
/// leave up to 0.05 of its rms there, as seen at a twentieth of the wave's frequency in windows of five periods.
const HUM_IN_HARMONIC: f32 = 2e-4;
/// Standard deviations that the rate of an amplitude must have for its size to be no chance.
const PARTIAL_SIGMAS: f32 = 4.0;
/// Residual variance that rounding and converters may leave, as a share of a_A²: (2·10⁻⁴)².
const RESIDUAL_FLOOR: f32 = 4e-8;
/// Residual of a window's blocks, as a share of the wave's power in them, beyond which there is no wave: 20 % noise leaves 0.1.
const MAX_STRANGE_RATIO: f32 = 0.25;
/// Highest ratio of the residual variance about the carrier to that about the third harmonic, unless noise is set to be coloured.
pub(super) const MAX_COLOUR: f32 = 16.0;

/// True when a window holds no wave, or too much else beside it, such as a second tone.
pub(crate) fn is_no_wave(model: &Model, fit: &Fit, wave: &Standing) -> bool {
    let remains = &fit.remains;
    let explained = model.half
        * (wave.record.main.value * wave.record.main.value
            + wave.record.quadrature.value * wave.record.quadrature.value);
    let strange = greater(
        remains.residual,
        remains.third_noise * remains.third_freedom,
    );
    // In a long window white noise may exceed any share of the wave. Without the watch nothing is known to be white.
    let (own, third) = (wave.record.residual, remains.third_noise);
    let is_white = own < MAX_RISE * third && third < MAX_RISE * own;
    // Long blocks show little of a wave at another frequency; the rest of it is left, and as white as noise, unlike what a step leaves.
    let alias = is_hidden(wave) && MAX_COLOUR * third > own;
    !is_significant(wave) || strange > MAX_STRANGE_RATIO * explained && !is_white || alias
}

/// True when the residual variance exceeds a_A²: more noise than wave.
pub(crate) fn is_hidden(wave: &Standing) -> bool {
    wave.record.residual > wave.record.main.value * wave.record.main.value
}

/// True when the main amplitude stands out of its noise.
fn is_significant(wave: &Standing) -> bool {
    wave.record.main.value * wave.record.main.value > SIGNIFICANT * wave.record.main.variance
}

/// Noise variances of a window, per sample, and the limit of their ratio.
#[derive(Clone, Copy)]
pub(crate) struct Levels {
    /// Variance of its own residual.
    pub own: f32,
    /// Variance for which its standard deviations are stated.
    pub stated: f32,
    /// The most that the converter's steps may add.
    pub coding: f32,
    /// Highest ratio of `own` to the variance about the third harmonic.
    pub colour: f32,
}

/// Tests one window by itself and against the noise of those before, and learns its noise if it is clean; `advance` of its blocks are not
/// in the next one.
#[inline(always)]
pub(crate) fn within(
    model: &Model,
    fit: &Fit,
    wave: &Standing,
    Levels {
        own,
        stated,
        coding,
        colour,
    }: Levels,
    noise: &mut Noise,
    advance: u16,
) -> Flags {
    let remains = &fit.remains;
    let power = wave.record.main.value * wave.record.main.value;
    let floor = RESIDUAL_FLOOR * power + 3.0 * coding;
    let mut flags = Flags::empty();

    let significant = is_significant(wave);
    flags = flags.with_if(!significant, Flags::LOST);

    // White noise is the same about the carrier and about the third harmonic. A first window has nothing else to be compared with, and a
    // fault in one block may raise both: leaving out the worst of n blocks makes chance at most n times as likely.
    let (about_third, sigmas) = if noise.freedom > 0.0 {
        (remains.third_noise, NOISE_SIGMAS)
    } else {
        let least = lesser(remains.third_noise, remains.third_without_worst);
        (least, FIRST_NOISE_SIGMAS)
    };
    let beyond = own - 4.0 * floor;
    // Without the watch there is no third harmonic: the limit is infinite and the noise zero, and their product NaN, which nothing exceeds.
    let coloured = beyond > colour * about_third
        && beyond > limit_of(sigmas, remains.freedom, remains.third_freedom) * about_third;
    // White noise is known better from both together.
    let total_freedom = remains.freedom + remains.third_freedom;
    let per_total = 1.0 / total_freedom;
    let over_total = |third: f32| (remains.residual + third * remains.third_freedom) * per_total;
    let wide = over_total(remains.third_noise);
    // Blocks of a few samples have more sums than samples: there are no more degrees of freedom than samples of both pick-offs, less ten
    // unknowns.
    let wide_freedom = lesser(total_freedom, 4.0 * model.half - 10.0);
    // Neither is true if no noise is known.
    let louder = noise.is_exceeded(own, remains.freedom, floor)
        || is_louder(wide - floor, noise.wide, wide_freedom, noise.freedom);
    // Compares a part of the residual with the noise of the windows before, or with the rest of the residual if that is known better.
    let stands_out = |part: f32, degrees: f32, floor: f32| {
        let (rest, beyond) = (remains.freedom - degrees, part - floor);
        if noise.freedom > rest && !louder {
            is_louder(beyond, degrees * noise.variance, degrees, noise.freedom)
        } else {
            let others = greater(remains.residual - part, 0.0);
            // Both sides are times the degrees of freedom: a product costs less than a division.
            is_louder(beyond * rest, degrees * others, degrees, rest)
        }
    };
    // One block out of line with all others: a step, a spike or a short dropout. A block has three sums a pick-off, or two besides an
    // offset of its own.
    let sums = 4.0 + 2.0 * model.shared;
    let outlier = stands_out(remains.worst_block, sums, 6.0 * floor);
    // A step within the window, or rates that change.
    let stepped = stands_out(remains.step, 4.0, (8.0 + 0.1 * remains.freedom) * floor);
    let misfit = coloured || louder || outlier || stepped || !fit.settled;
    flags = flags.with_if(misfit, Flags::MISFIT);
    // By itself this takes less flash than as one more of the causes above.
    flags = flags.with_if(is_partial(model, wave), Flags::MISFIT);

    let alone = over_total(remains.third_without_image);
    let third_noise = greater(remains.third_without_image, lesser(alone, noise.wide));
    let harmonic = has_harmonic(model, remains, wave, coding, third_noise);
    flags = flags.with_if(harmonic, Flags::CLIPPED);

    let (main, quadrature) = (&wave.record.main, &wave.record.quadrature);
    // The smaller travelling wave; its variance is taken to be the mean of both.
    let size = main.value - quadrature.value.abs();
    let round = size * size < SIGNIFICANT * (main.variance + quadrature.variance)
        || size < CIRCULAR_RATIO * main.value;
    flags = flags.with_if(round && significant, Flags::CIRCULAR);

    if flags.with(Flags::CIRCULAR) == Flags::CIRCULAR {
        noise.learn(own, stated, wide, remains.freedom);
    } else if flags.with(Flags::CIRCULAR) == Flags::MISFIT.with(Flags::CIRCULAR)
        && !(coloured || outlier || stepped)
        && fit.settled
    {
        noise.count_raised(advance, model.blocks);
    }
    flags
}

/// True when the wave seems to change by more than a_A, as one that begins or ends within the window. In a first window nothing else may
/// tell.
fn is_partial(model: &Model, wave: &Standing) -> bool {
    let main = &wave.record.main;
    let change = 2.0 * model.half * main.rate;
    change.abs() > main.value
        && main.rate * main.rate > PARTIAL_SIGMAS * PARTIAL_SIGMAS * main.rate_variance
}

/// True when a pick-off shows a third harmonic beyond its noise and beyond what electronics with its gain may have.
#[inline(never)]
fn has_harmonic(
    model: &Model,
    remains: &Remains,
    wave: &Standing,
    coding: f32,
    noise: f32,
) -> bool {
    // The share of a sample's noise variance in the amplitude of a raw pick-off.
    let Covariance { even, odd } = &model.covariance;
    let share = greater(even[0][0], odd[0][0]);
    let floor = HARMONIC_FLOOR * wave.record.main.value;
    let steady = share * coding + HUM_IN_HARMONIC * greater(remains.wander[0], remains.wander[1]);
    let [per_gain, _] = model.correction.noise_gains;
    // Scaled to C's gain.
    [1.0, per_gain]
        .iter()
        .zip(&remains.third)
        .any(|(gain, third)| {
            let chance = square_root(THIRD_NOISE_MARGIN * share * noise) + square_root(steady);
            let limit = SIGMAS * gain * chance + floor;
            gain * gain * third > limit * limit
        })
}

#[cfg(test)]
mod tests;
