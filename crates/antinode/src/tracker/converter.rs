//! What the converter does to a window: its steps, its rails, and channels that stand still.

use crate::estimate::Flags;
use crate::order::{greater, lesser};
use crate::settings::Settings;
use crate::wave::Standing;
use crate::window::{Extremes, Seen};

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

/// Faults that single samples show, in a window of blocks of a wave of `period` samples.
pub(super) fn sample_flags(
    settings: &Settings,
    blocks: &[Seen],
    period: f32,
    wave: &Standing,
) -> Flags {
    let broken = !(wave.main + wave.quadrature).is_finite();
    let flags = Flags::empty().with_if(broken, Flags::NOT_FINITE.with(Flags::LOST));
    let mut low = [f32::INFINITY; 2];
    let mut high = [f32::NEG_INFINITY; 2];
    let mut longest = 0;
    for watched in blocks.iter().filter_map(|block| block.watched.as_ref()) {
        for (i, extremes) in watched.extremes.iter().enumerate() {
            low[i] = lesser(extremes.low, low[i]);
            high[i] = greater(extremes.high, high[i]);
            longest = longest.max(extremes.low_run.max(extremes.high_run));
        }
    }
    if longest == 0 {
        return flags;
    }
    // Where no rail is known, samples that stay at the extreme for longer than a crest does show one.
    let crest = greater(period / 16.0, 2.0) as u16;
    let fine = wave.main > 100.0 * settings.resolution.unwrap_or(0.0);
    let flat = |block: &Seen| {
        block.watched.as_ref().is_some_and(|watched| {
            (0..2).any(|i| {
                let seen: &Extremes = &watched.extremes[i];
                let wide = fine && high[i] - low[i] > wave.main;
                let above = seen.high == high[i] && seen.high_run > crest;
                let below = seen.low == low[i] && seen.low_run > crest;
                wide && (above || below)
            })
        })
    };
    let clipped = match settings.rails {
        Some([least, most]) => (0..2).any(|i| high[i] >= most || low[i] <= least),
        None => longest > crest && blocks.iter().any(flat),
    };
    let dead = (0..2).any(|i| low[i] == high[i]);
    flags
        .with_if(clipped, Flags::CLIPPED)
        .with_if(dead, Flags::DEAD_CHANNEL)
}
