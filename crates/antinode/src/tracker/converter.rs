//! What the converter does to a window: its steps, its rails, and channels that stand still.

use crate::block::Block;
use crate::estimate::Flags;
use crate::settings::Settings;
use crate::wave::Standing;

/// What the converter's steps add to the noise variance a sample, in a window of `half` samples each side.
///
/// A quantised wave has errors of up to a third of a step that repeat with it; noise breaks them up as exp(−2π²σ²/step²).
pub(super) fn coding(settings: &Settings, noise: f32, half: f32) -> f32 {
    let Some(step) = settings.resolution else {
        return 0.0;
    };
    let square = step * step;
    // The steps' own noise does not break up anything.
    let apart = (noise - square / 12.0).max(0.0);
    let repeated = 0.09 * square * libm::expf(-39.5 * apart / square);
    (square / 12.0 - noise).max(0.0) + repeated * half
}

/// Faults that single samples show, in a window of blocks that holds `wave`.
pub(super) fn sample_flags<'a>(
    settings: &Settings,
    blocks: impl Iterator<Item = &'a Block> + Clone,
    wave: &Standing,
) -> Flags {
    let mut low = [f32::INFINITY; 2];
    let mut high = [f32::NEG_INFINITY; 2];
    let mut period = f32::INFINITY;
    for block in blocks.clone() {
        period = block.layout.step.period();
        for (channel, sums) in block.channels.iter().enumerate() {
            low[channel] = low[channel].min(sums.low);
            high[channel] = high[channel].max(sums.high);
        }
    }
    // Where no rail is known, samples that stay at the extreme for longer than a crest does show one.
    let crest = (period / 16.0).max(2.0) as u16;
    let fine = wave.main > 100.0 * settings.resolution.unwrap_or(0.0);
    let flat = |block: &Block| {
        (0..2).any(|i| {
            let sums = &block.channels[i];
            let wide = fine && high[i] - low[i] > wave.main;
            let above = sums.high == high[i] && sums.high_run > crest;
            let below = sums.low == low[i] && sums.low_run > crest;
            wide && (above || below)
        })
    };
    let clipped = match settings.full_scale {
        Some(rail) => (0..2).any(|i| high[i] >= rail || low[i] <= -rail),
        None => blocks.clone().any(flat),
    };
    let dead = (0..2).any(|i| low[i] == high[i]);
    Flags::empty()
        .with_if(clipped, Flags::CLIPPED)
        .with_if(dead, Flags::DEAD_CHANNEL)
        .with_if(
            !(wave.main + wave.quadrature).is_finite(),
            Flags::NOT_FINITE.with(Flags::LOST),
        )
}
