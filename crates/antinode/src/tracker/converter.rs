//! What the converter does to a window: its steps, its rails, and channels that stand still.

use crate::arch::square_root;
use crate::estimate::Flags;
use crate::order::{greater, lesser};
use crate::settings::Settings;
use crate::wave::Standing;
use crate::window::{Fit, Seen};

/// What the converter's steps add to the noise variance a sample, in a window of `half` samples each side.
///
/// A quantised wave has errors of up to a third of a step that repeat with it; noise breaks them up as exp(−2π²σ²/step²).
pub(super) fn coding(settings: &Settings, noise: f32, half: f32) -> f32 {
    let Some(step) = settings.resolution else {
        return 0.0;
    };
    let square = step * step;
    // The steps' own noise does not break up anything.
    let apart = greater(noise - square / 12.0, 0.0);
    let repeated = 0.09 * square * libm::expf(-39.5 * apart / square);
    greater(square / 12.0 - noise, 0.0) + repeated * half
}

/// Deviations of the noise that a sample may lie beyond the wave: less than one in 10¹⁴ lies further.
const SIGMAS: f32 = 8.0;
/// How far samples may lie beyond the wave and its noise, as a share of a_A: common electronics have harmonics.
const BEYOND: f32 = 0.01;

/// Faults that single samples show, in a window of blocks of a wave of `period` samples and with a noise variance of `noise`.
pub(super) fn sample_flags(
    settings: &Settings,
    blocks: &[Seen],
    period: f32,
    fit: &Fit,
    wave: &Standing,
    noise: f32,
) -> Flags {
    let broken = !(wave.main + wave.quadrature).is_finite();
    let flags = Flags::empty().with_if(broken, Flags::NOT_FINITE.with(Flags::LOST));
    let range = Range::of(blocks);
    if range.longest == 0 {
        return flags;
    }
    // Where no rail is known, samples that stay at the extreme for longer than a crest does show one.
    let crest = greater(period / 16.0, 2.0) as u16;
    let fine = wave.main > 100.0 * settings.resolution.unwrap_or(0.0);
    let clipped = match settings.rails {
        Some([least, most]) => (0..2).any(|i| range.high[i] >= most || range.low[i] <= least),
        None => range.longest > crest && fine && range.is_flat(blocks, wave.main, crest),
    };
    let apart = SIGMAS * square_root(noise) + BEYOND * wave.main;
    flags
        .with_if(clipped, Flags::CLIPPED)
        .with_if(range.is_beyond(fit, apart), Flags::MISFIT)
        .with_if(
            (0..2).any(|i| range.low[i] == range.high[i]),
            Flags::DEAD_CHANNEL,
        )
}

/// The range of both pick-offs' samples in a window.
struct Range {
    low: [f32; 2],
    high: [f32; 2],
    /// Most samples in a row that were equal to either end of a block; 0 where none was watched.
    longest: u16,
}

impl Range {
    #[inline(never)]
    fn of(blocks: &[Seen]) -> Self {
        let mut range = Self {
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
            longest: 0,
        };
        for watched in blocks.iter().filter_map(|block| block.watched.as_ref()) {
            for (i, seen) in watched.extremes.iter().enumerate() {
                range.low[i] = lesser(seen.low, range.low[i]);
                range.high[i] = greater(seen.high, range.high[i]);
                range.longest = range.longest.max(seen.low_run.max(seen.high_run));
            }
        }
        range
    }

    /// True when more samples of a pick-off in a row than a crest has were equal to an end of a range wider than `main`.
    #[cold]
    #[inline(never)]
    fn is_flat(&self, blocks: &[Seen], main: f32, crest: u16) -> bool {
        let watched = blocks.iter().filter_map(|block| block.watched.as_ref());
        watched.map(|watched| &watched.extremes).any(|extremes| {
            (0..2).any(|i| {
                let (low, high, seen) = (self.low[i], self.high[i], &extremes[i]);
                let above = seen.high == high && seen.high_run > crest;
                let below = seen.low == low && seen.low_run > crest;
                high - low > main && (above || below)
            })
        })
    }

    /// True when samples lie `apart` beyond the wave: what does is not of it, but a tone, say, that the sums of whole blocks do not see.
    fn is_beyond(&self, fit: &Fit, apart: f32) -> bool {
        (0..2).any(|i| {
            let (above, below) = (self.high[i] - fit.offsets[i], fit.offsets[i] - self.low[i]);
            let rest = greater(above, below) - apart;
            rest > 0.0 && rest * rest > fit.reach[i]
        })
    }
}
