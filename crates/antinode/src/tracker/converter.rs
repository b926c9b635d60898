//! Effects of the converter on a window: its steps, its rails, and channels that stand still.

use core::f32::consts::LN_2;

use super::record::Record;
use super::standing::Standing;
use crate::arch::square_root;
use crate::estimate::Flags;
use crate::exponential::exponential;
use crate::phase::PhaseStep;
use crate::scalar::{greater, lesser};
use crate::settings::Settings;
use crate::window::{Fit, Model, Seen};

/// 4π²: noise of variance step²/4π² reduces the variance of repeating rounding errors to 1/e.
const DITHER_FACTOR: f32 = 39.5;

/// Noise variance a sample that the converter's steps add.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Coding {
    /// Expected of this wave.
    pub expected: f32,
    /// Upper bound: every period of the wave has the same few errors, of up to a third of a step.
    pub max: f32,
}

impl Coding {
    /// Errors that repeat with the wave do not average out: a wave that visits Q distinct phases has Q errors of variance step²/12, not one
    /// a sample. Noise breaks them up as exp(−4π²σ²/step²). `noise` is its variance, and the least that this may be, as it may contain
    /// these errors.
    #[inline]
    pub(super) fn new(settings: &Settings, noise: [f32; 2], model: &Model, fit: &Fit) -> Self {
        match settings.resolution {
            Some(step) => Self::of_step(step, noise, model, fit),
            None => Self::default(),
        }
    }

    #[inline(never)]
    fn of_step(step: f32, [noise, least]: [f32; 2], model: &Model, fit: &Fit) -> Self {
        let square = step * step;
        let own = square / 12.0;
        // The noise of the steps themselves breaks up nothing.
        let share = |noise: f32| exponential(-DITHER_FACTOR * greater(noise - own, 0.0) / square);
        let repeated = share(noise);
        let white = greater(own - noise, 0.0);
        let max = white + 0.09 * square * share(least) * model.half;
        let mut expected = white;
        if repeated > 1e-3 {
            let samples = 2.0 * model.half;
            let amplitude = square_root(lesser(fit.reach[0], fit.reach[1]));
            let frequency = model.carrier.shifted(fit.waves.drift() * model.per_half);
            // In a period a wave crosses `4 * amplitude / step` codes.
            let phases = distinct_phases(frequency, samples, step / (4.0 * amplitude));
            expected += own * repeated * (samples / phases - 1.0);
        }
        Self { expected, max }
    }
}

/// Number of phases, further apart than `width` turns, that the samples of a wave visit; at least 2.
///
/// After as many samples as the denominator of a fraction near the frequency the phases repeat, but for the error of the fraction.
#[inline(never)]
fn distinct_phases(frequency: PhaseStep, samples: f32, width: f32) -> f32 {
    let (mut far, mut near) = (0u32, frequency.0);
    let (mut before, mut count) = (0u32, 1u32);
    let mut least = lesser(samples, 1.0 / width);
    while (count as f32) < least {
        let slipped = samples * (near as f32 * (1.0 / 4_294_967_296.0)) / width;
        // With an even count, each half wave has the errors of the other.
        let share = if count.is_multiple_of(2) { 0.5 } else { 1.0 };
        least = lesser(least, share * (count as f32 + slipped));
        // A step of Euclid's algorithm; a first `far` of zero is a whole turn. No step is left if the fraction is exact.
        let Some(more) = far.wrapping_sub(near).checked_div(near) else {
            break;
        };
        let times = more.wrapping_add(1);
        (far, near) = (near, far.wrapping_sub(times.wrapping_mul(near)));
        (before, count) = (count, count.saturating_mul(times).saturating_add(before));
    }
    greater(least, 2.0)
}

/// Standard deviations of the noise by which a sample may lie beyond the wave: fewer than one in 10¹⁴ lie further.
const SAMPLE_SIGMAS: f32 = 8.0;
/// Standard deviation of loud noise, as a share of a_A.
const LOUD_NOISE: f32 = 0.25;
/// How far hum may take samples beyond the wave, from its one extreme to the other, in multiples of its rms.
const HUM_REACH: f32 = 4.0;
/// The same for samples of every block: hum swings, and is not at its extreme in all of them.
const EVERY_BLOCK_HUM_REACH: f32 = 1.5;
/// How far harmonics of common electronics may take samples beyond the wave and its noise, as a share of a_A.
const HARMONICS: f32 = 0.01;

/// Flags of the faults that single samples show, in a window of `blocks` with a wave of `step` a sample and a noise variance of `noise`;
/// `before` is the last clean window.
#[inline(always)]
pub(super) fn sample_flags(
    settings: &Settings,
    blocks: &[Seen],
    step: PhaseStep,
    fit: &Fit,
    wave: &Standing,
    noise: f32,
    before: Option<&Record>,
) -> Flags {
    let is_broken = !wave.record.main.value.is_finite();
    let flags = Flags::empty().with_if(is_broken, Flags::NOT_FINITE.with(Flags::LOST));
    if !blocks.first().is_some_and(Seen::is_watched) {
        return flags;
    }
    let range = Range::of(blocks);
    let (main, deviation) = (wave.record.main.value, square_root(noise));
    let is_well_resolved = main > 100.0 * settings.resolution.unwrap_or(0.0);
    let at_rail = settings.rails.is_some_and(|[least, most]| {
        (0..2).any(|i| range.high[i] >= most || range.low[i] <= least)
    });
    // Samples that stay at an extreme for longer than a crest show a limit, known or not.
    let clipped = at_rail
        || range.longest > 2 && is_well_resolved && {
            // A run spans one step less than it has samples, and noise of one converter step makes a crest wider by chance.
            let crest = greater(step.period() / 16.0, 1.0) + 1.5;
            let crest = crest as u16;
            let arc = f32::from(crest) * step.radians();
            range.longest > crest && range.is_flat(blocks, main, crest, [arc, deviation])
        };
    let misfit = range.is_beyond(fit, SAMPLE_SIGMAS * deviation + HARMONICS * main)
        || (before.is_none() || deviation > LOUD_NOISE * main)
            && are_all_beyond(
                blocks,
                fit,
                every_block_sigmas(wave.record.samples.get(), blocks.len()) * deviation
                    + LOUD_NOISE * main,
            );
    flags
        .with_if(clipped, Flags::CLIPPED)
        .with_if(misfit, Flags::MISFIT)
        .with_if(
            (0..2).any(|i| {
                // A wave that was within a step of the converter may leave a constant code: that of a pattern on the other pick-off's axis.
                let step = settings.resolution.unwrap_or(0.0);
                range.low[i] == range.high[i]
                    && !before.is_some_and(|before| before.channel_power[i] < step * step)
            }),
            Flags::DEAD_CHANNEL,
        )
}

/// The range of both pick-offs' samples in a window.
struct Range {
    low: [f32; 2],
    high: [f32; 2],
    /// Upper bound of the longest run of equal samples at an extreme of a block: all such lengths, joined by a bitwise or.
    longest: u16,
}

impl Range {
    #[inline]
    fn of(blocks: &[Seen]) -> Self {
        let mut range = Self {
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
            longest: 0,
        };
        let mut runs = 0;
        for watched in blocks.iter().filter_map(|block| block.watched.as_ref()) {
            for (i, seen) in watched.extremes.iter().enumerate() {
                range.low[i] = lesser(seen.low, range.low[i]);
                range.high[i] = greater(seen.high, range.high[i]);
                runs |= seen.runs;
            }
        }
        range.longest = (runs | runs >> 16) as u16;
        range
    }

    /// True when a pick-off with a range wider than `main` stays at an end of it for more than `crest` samples: twice, or once if noise
    /// cannot be the cause. `arc` is the angle of the wave over a crest, `deviation` that of the noise.
    #[cold]
    #[inline(never)]
    fn is_flat(&self, blocks: &[Seen], main: f32, crest: u16, [arc, deviation]: [f32; 2]) -> bool {
        let mut ends = 0;
        for watched in blocks.iter().filter_map(|block| block.watched.as_ref()) {
            for (i, seen) in watched.extremes.iter().enumerate() {
                let (low, high) = (self.low[i], self.high[i]);
                if high - low > main {
                    let above = seen.high == high && (seen.runs >> 16) as u16 > crest;
                    let below = seen.low == low && seen.runs as u16 > crest;
                    ends += u32::from(above) + u32::from(below);
                }
            }
        }
        // A crest is lower by this at its ends. Three samples of it are equal by chance if noise makes up for that: the mean of the outer
        // two and the one between differ by √1.5 standard deviations.
        let drop = 0.125 * arc * arc * main;
        ends > u32::from(drop < SAMPLE_SIGMAS * deviation)
    }

    /// True when samples lie more than `margin` beyond the wave, as by a tone that the sums of whole blocks do not see.
    #[inline(always)]
    fn is_beyond(&self, fit: &Fit, margin: f32) -> bool {
        (0..2).any(|i| is_beyond(fit, i, [self.low[i], self.high[i]], margin, HUM_REACH))
    }
}

/// Standard deviations of the noise by which, besides [`LOUD_NOISE`] of a_A, samples of every block may lie beyond a first wave or one in
/// loud noise, in `blocks` of `samples` pairs in all: those of a wave at another frequency lie further, though its sums look like noise.
/// √(2 ln 2n) or a little more: 2n samples of noise hardly exceed it in every block.
fn every_block_sigmas(samples: u32, blocks: usize) -> f32 {
    let pairs = samples / blocks as u32;
    square_root(2.0 * LN_2 * (u32::BITS + 1 - pairs.leading_zeros()) as f32)
}

/// True when every block has samples more than `margin` beyond the wave.
#[cold]
#[inline(never)]
pub(super) fn are_all_beyond(blocks: &[Seen], fit: &Fit, margin: f32) -> bool {
    blocks.iter().all(|block| {
        block.watched.as_ref().is_some_and(|watched| {
            let mut extremes = (0..2).zip(&watched.extremes);
            extremes.any(|(i, seen)| {
                is_beyond(fit, i, [seen.low, seen.high], margin, EVERY_BLOCK_HUM_REACH)
            })
        })
    })
}

/// True when samples of pick-off `i`, from `low` to `high`, lie more than `margin` and `hum` times the rms of its hum beyond the wave.
#[inline(never)]
fn is_beyond(fit: &Fit, i: usize, [low, high]: [f32; 2], margin: f32, hum: f32) -> bool {
    let offset = fit.offsets[i & 1];
    let wander = square_root(fit.remains.wander[i & 1]);
    let rest = greater(high - offset, offset - low) - margin - hum * wander;
    rest > 0.0 && rest * rest > fit.reach[i & 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distinct_phases_are_counted() {
        let count = |period: f32, samples: u32, width: f32| {
            distinct_phases(PhaseStep::from_period(period), samples as f32, width)
        };
        // 75 samples are four periods; the frequency is rounded to 24 bits. Of 20 phases ten have the errors of the others.
        assert_eq!(count(20.0, 2000, 1e-3).round(), 10.0);
        assert_eq!(count(18.75, 1875, 1e-3).round(), 75.0);
        // A period of 16 samples is an exact fraction, at which the search ends.
        assert_eq!(count(16.0, 2000, 1e-3), 8.0);
        assert_eq!(count(18.75, 30, 1e-3), 30.0);
        // No more phases than a turn has room for.
        assert_eq!(count(18.72, 100_000, 0.01), 100.0);
        // A little beyond 20 samples: 100 times 0.002 of 20 are 0.01 turn, two widths from each of ten.
        let slipped = count(20.002, 2000, 5e-3);
        assert!((slipped - 30.0).abs() < 0.1, "{slipped}");
        assert_eq!(count(2.0, 1000, 0.9), 2.0);
    }
}
