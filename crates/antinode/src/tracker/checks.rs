//! What a window must satisfy by itself to be believed, and beside the noise of those before: general tests on its residuals.
//!
//! Every threshold is a false-alarm rate below 10⁻⁹ a window for white noise, plus a floor under which a deviation is no fault.

use super::noise::{Noise, REACH, REACH_ONCE, RISE, is_louder, limit_of};
use super::standing::Standing;
use crate::arch::square_root;
use crate::estimate::Flags;
use crate::scalar::{greater, lesser};
use crate::window::{Covariance, Fit, Model, Remains};

/// Standard deviations of an innocent deviation.
pub(super) const SIGMAS: f32 = 7.0;
/// The square of an amplitude over its variance from which on it stands out of its noise: six deviations.
pub(super) const SIGNIFICANT: f32 = 36.0;
/// Below this share of a_A the lesser of the travelling waves is none, and the pattern a circle.
const ROUND: f32 = 2e-3;
/// Degrees of freedom of the noise about the third harmonic from which on it is known: those of four blocks.
const LEAST_FREEDOM: f32 = 12.0;
/// Margin on the share of a sample's noise that the third harmonic has, which is taken to be that of the wave.
const THIRD_SHARE: f32 = 1.2;
/// Third harmonic, as a share of a_A, that common electronics may have.
const HARMONIC_FLOOR: f32 = 1e-3;
/// The square of what [`SIGMAS`] times is 0.1 of the hum's rms: its slopes within blocks leave up to 0.05 of that as third harmonic, seen of
/// a twentieth of the wave's frequency in windows of five periods.
const HUM_IN_HARMONIC: f32 = 2e-4;
/// Residual, as a share of a_A, that rounding and converters may leave: (2·10⁻⁴)².
const RESIDUAL_FLOOR: f32 = 4e-8;
/// Residual of a first window's blocks, as a share of the wave's own power, beyond which it is no wave: 20 % noise leaves 0.1.
const STRANGER: f32 = 0.25;
/// By how much the residual variance about the carrier may exceed that about the third harmonic, where noise is not coloured.
pub(super) const COLOUR: f32 = 16.0;

/// True when the first window after a search holds no wave, or as much else beside it: two tones, say.
pub(crate) fn is_no_wave(model: &Model, fit: &Fit, wave: &Standing) -> bool {
    let remains = &fit.remains;
    let explained = model.half
        * (wave.record.main.value * wave.record.main.value
            + wave.record.quadrature.value * wave.record.quadrature.value);
    let strange = greater(
        remains.residual,
        remains.third_noise * remains.third_freedom,
    );
    // White noise in a long window is more than any share of the wave; where none is watched, nothing is known to be white.
    let (own, third) = (wave.record.residual, remains.third_noise);
    let is_white = own < RISE * third && third < RISE * own;
    // Long blocks show a little of a wave at another frequency, and leave more, which is as white as noise: what a step leaves is not.
    let alias = is_hidden(wave) && COLOUR * third > own;
    !is_significant(wave) || strange > STRANGER * explained && !is_white || alias
}

/// True when there is more noise than wave.
pub(crate) fn is_hidden(wave: &Standing) -> bool {
    wave.record.residual > wave.record.main.value * wave.record.main.value
}

/// True when the main amplitude stands out of its own noise.
fn is_significant(wave: &Standing) -> bool {
    wave.record.main.value * wave.record.main.value > SIGNIFICANT * wave.record.main.variance
}

/// Noise variances of a window.
#[derive(Clone, Copy)]
pub(crate) struct Levels {
    /// What it leaves.
    pub own: f32,
    /// For which it states its deviations.
    pub stated: f32,
    /// What the converter's steps may add.
    pub coding: f32,
    /// How many times that about the third harmonic its own may be.
    pub colour: f32,
}

/// Tests of one window by itself and against the noise of those before; `advance` of its blocks are not in the next one.
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

    let known = noise.freedom > 0.0;
    // White noise is the same about the carrier and about its third harmonic, and what is coloured may be any times as much. A first
    // window has no other noise to be compared with, and one block's fault may be in that too: to leave out the worst of n makes chance
    // no more than n times as likely.
    let (about_third, reach) = if known {
        (remains.third_noise, REACH)
    } else {
        let least = lesser(remains.third_noise, remains.third_spared);
        (least, REACH_ONCE)
    };
    let beyond = own - 4.0 * floor;
    let coloured = remains.third_freedom >= LEAST_FREEDOM
        && beyond > colour * about_third
        && beyond > limit_of(reach, remains.freedom, remains.third_freedom) * about_third;
    // What is white is seen better in both together.
    let both = remains.freedom + remains.third_freedom;
    let per_both = 1.0 / both;
    let over_both = |third: f32| (remains.residual + third * remains.third_freedom) * per_both;
    let wide = over_both(remains.third_noise);
    // Blocks of a few samples have more sums than samples: no more is known than these tell, less ten unknowns.
    let wide_freedom = lesser(both, 4.0 * model.half - 10.0);
    let louder = known
        && (noise.is_exceeded(own, remains.freedom, floor)
            || is_louder(wide - floor, noise.wide, wide_freedom, noise.freedom));
    // A part of the residual beside the noise of the windows before, or beside the rest where that is known better.
    let stands_out = |part: f32, degrees: f32, floor: f32| {
        let (rest, beyond) = (remains.freedom - degrees, part - floor);
        if noise.freedom > rest && !louder {
            is_louder(beyond, degrees * noise.variance, degrees, noise.freedom)
        } else {
            let others = greater(remains.residual - part, 0.0);
            // Both sides times the degrees of freedom: a product is less than a division.
            is_louder(beyond * rest, degrees * others, degrees, rest)
        }
    };
    // One block out of line with all others: a step, a spike or a short dropout.
    // Of both pick-offs' sums of a block, those that its own offsets leave.
    let sums = 4.0 + 2.0 * model.shared;
    let outlier = stands_out(remains.worst_block, sums, 6.0 * floor);
    // A step within the window, or any course that bends.
    let stepped = stands_out(remains.step, 4.0, (8.0 + 0.1 * remains.freedom) * floor);
    let misfit = coloured || louder || outlier || stepped || !fit.settled;
    flags = flags.with_if(misfit, Flags::MISFIT);

    let alone = over_both(remains.third_alone);
    let third_noise = greater(remains.third_alone, lesser(alone, noise.wide));
    let harmonic = remains.third_freedom >= LEAST_FREEDOM
        && has_harmonic(model, remains, wave, coding, third_noise);
    flags = flags.with_if(harmonic, Flags::CLIPPED);

    let (main, quadrature) = (&wave.record.main, &wave.record.quadrature);
    // The lesser of the travelling waves; the variance is the mean of both of theirs.
    let size = main.value - quadrature.value.abs();
    let round = size * size < SIGNIFICANT * (main.variance + quadrature.variance)
        || size < ROUND * main.value;
    flags = flags.with_if(round && significant, Flags::CIRCULAR);

    if flags.with(Flags::CIRCULAR) == Flags::CIRCULAR {
        noise.learn(own, stated, wide, remains.freedom);
    } else if flags.with(Flags::CIRCULAR) == Flags::MISFIT.with(Flags::CIRCULAR)
        && !(coloured || outlier || stepped)
        && fit.settled
    {
        noise.refuse(advance, model.blocks);
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
    let steady = share * coding + HUM_IN_HARMONIC * greater(remains.wander[0], remains.wander[1]);
    let [per_gain, _] = model.correction.noise_gains;
    // As a pick-off of C's gain would see it.
    [1.0, per_gain]
        .iter()
        .zip(&remains.third)
        .any(|(gain, third)| {
            let square = gain * gain * third;
            square > floor * floor && {
                let chance = square_root(THIRD_SHARE * share * noise) + square_root(steady);
                let limit = SIGMAS * gain * chance + floor;
                square > limit * limit
            }
        })
}

#[cfg(test)]
mod tests {
    use num_complex::Complex32;

    use super::*;
    use crate::block::Layout;
    use crate::calibration::Calibration;
    use crate::phase::PhaseStep;

    const BLOCKS: u16 = 5;

    /// The fit of a window of a steady wave, in noise of such variances about the carrier and about its third harmonic.
    fn fit([own, third]: [f32; 2]) -> Fit {
        let mut fit = Fit {
            settled: true,
            ..Fit::default()
        };
        fit.waves.value = [Complex32::ONE; 2];
        fit.remains = Remains {
            residual: 20.0 * own,
            freedom: 20.0,
            worst_block: 4.0 * own,
            step: 4.0 * own,
            third_noise: third,
            third_freedom: 16.0,
            third_spared: third,
            third_alone: third,
            ..Remains::default()
        };
        fit
    }

    fn flags(fit: &Fit, noise: &mut Noise) -> Flags {
        let carrier = PhaseStep::from_period(18.75);
        let layout = Layout::unrounded(carrier, 37);
        let model = Model::new(layout, carrier, BLOCKS, Calibration::IDEAL, 1e5, false);
        let own = fit.remains.variance();
        let levels = Levels {
            own,
            stated: own,
            coding: 0.0,
            colour: COLOUR,
        };
        let wave = Standing::new(&model, fit, [own, 1.0], own, 0);
        within(&model, fit, &wave, levels, noise, BLOCKS)
    }

    #[test]
    fn a_fit_that_does_not_settle_is_a_misfit() {
        let mut noise = Noise::NONE;
        for _ in 0..3 {
            let mut fit = fit([1e-4; 2]);
            assert_eq!(flags(&fit, &mut noise), Flags::empty());
            fit.settled = false;
            assert_eq!(flags(&fit, &mut noise), Flags::MISFIT);
        }
    }

    #[test]
    fn only_white_noise_is_a_new_level() {
        let mut noise = Noise::NONE;
        for _ in 0..20 {
            assert_eq!(flags(&fit([1e-4; 2]), &mut noise), Flags::empty());
        }
        // A tone near the wave, which is not about its third harmonic.
        for _ in 0..10 {
            assert_eq!(flags(&fit([1e-2, 1e-4]), &mut noise), Flags::MISFIT);
        }
        assert!(noise.freedom > 0.0);
        for i in 0..6 {
            let is_new = i < Noise::NEW_LEVEL;
            let expected = Flags::empty().with_if(is_new, Flags::MISFIT);
            assert_eq!(flags(&fit([1e-2; 2]), &mut noise), expected, "{i}");
        }
    }
}
