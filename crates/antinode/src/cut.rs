//! How the windows of a wave are cut into blocks.

use crate::block::Layout;
use crate::scalar::lesser;

/// Fewest blocks of a window: a regression over K blocks keeps all but 1/K² of the samples' information on the frequency.
const MIN_BLOCKS: f32 = 5.0;
/// Periods of a block at most: a reference off by the detector's 5 % then costs 2 % of the sums.
const MAX_BLOCK_PERIODS: f32 = 2.0;
/// Sample pairs of a block at most, whatever a front has room for: an even number, counted in 16 bits.
const MAX_BLOCK_PAIRS: f32 = 65_534.0;
/// A window has at most this many blocks, or as many as periods if these are more.
pub(crate) const MAX_BLOCKS: u16 = 11;
/// Periods above which a block may have an offset of its own: in shorter ones the wave itself looks like one.
pub(crate) const MIN_HUM_PERIODS: f32 = 0.9;
/// Fewest sample pairs of a window.
const MIN_PAIRS: u16 = 6;
/// Error of a window's length, as a share of it, beyond which other block lengths are tried.
const MAX_LENGTH_ERROR: f32 = 0.05;

/// Error of a block's length, as a share of it, for which a search is worth its gap: more of a wave's harmonics is then in its sums.
const MAX_MISMATCH: f32 = 1.0 / 32.0;

/// The settings that determine the blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cut {
    /// Periods a window.
    pub periods: u16,
    /// True if windows move on by a hop and not by their length.
    pub has_hop: bool,
    /// True if blocks are to have offsets of their own, for which those of a window of [`min_hum_periods`](Self::min_hum_periods) or more
    /// are then long enough.
    pub own_offsets: bool,
}

impl Cut {
    /// Sample pairs of a block for a wave of `period` samples: two periods, or a fifth of a window if that is less; with a hop half of
    /// that, so that windows move in finer steps. At most `max_length`.
    pub(crate) fn length(self, period: f32, max_length: u16) -> u16 {
        let window = period * f32::from(self.periods);
        let ideal = self.ideal(period);
        let length = if self.has_hop || ideal < 16.0 {
            rounded(ideal)
        } else {
            // Even, as samples are summed in twos.
            2 * rounded(0.5 * lesser(ideal, MAX_BLOCK_PAIRS))
        };
        let least = if self.own_offsets && self.periods >= self.min_hum_periods() {
            (MIN_HUM_PERIODS * period) as u16 + 1
        } else {
            1
        };
        self.fitting(window, length, least).min(max_length)
    }

    /// The length of a block if samples could be split.
    fn ideal(self, period: f32) -> f32 {
        let window = period * f32::from(self.periods);
        let longest = lesser(MAX_BLOCK_PERIODS * period, window / MIN_BLOCKS);
        if self.has_hop { 0.5 * longest } else { longest }
    }

    /// True if blocks of `layout` are off the length that they would have if the period were `period` by [`MAX_MISMATCH`] more than need be.
    pub(crate) fn mismatches(self, layout: Layout, period: f32) -> bool {
        let ideal = self.ideal(period);
        let off = |length: u16| (f32::from(length) - ideal).abs();
        let gain = off(layout.length) - off(self.length(period, u16::MAX));
        // If a front has no room for longer ones, there is nothing to gain.
        gain > MAX_MISMATCH * ideal && layout.length == self.length(layout.step.period(), u16::MAX)
    }

    /// Fewest periods of a window whose blocks have a period each, or up to a tenth less if that is no whole number of samples, as hum needs.
    pub(crate) const fn min_hum_periods(self) -> u16 {
        let blocks = MIN_BLOCKS as u16;
        if self.has_hop { 2 * blocks } else { blocks }
    }

    /// The first length, from `length` down to half of it and to `least`, of which whole blocks come near enough to `window` samples, else
    /// the nearest.
    fn fitting(self, window: f32, mut length: u16, least: u16) -> u16 {
        let max_count = self.periods.max(MAX_BLOCKS);
        if length < least || nearest_count(window, length) > max_count {
            length += 1;
        }
        let off = |length: u16, count: u16| (f32::from(count) * f32::from(length) - window).abs();
        let (shortest, mut nearest) = (length.div_ceil(2).max(least), length);
        let mut nearest_off = off(length, nearest_count(window, length));
        while nearest_off > MAX_LENGTH_ERROR * window && length > shortest {
            length -= 1;
            let count = nearest_count(window, length);
            if count > max_count {
                break;
            }
            let off = off(length, count);
            if off < nearest_off {
                (nearest, nearest_off) = (length, off);
            }
        }
        nearest
    }

    /// Number of blocks of `layout` that comes nearest to a window.
    pub(crate) fn blocks(self, layout: Layout) -> u16 {
        let window = layout.step.period() * f32::from(self.periods);
        let count = nearest_count(window, layout.length);
        // Five pairs give as many numbers as there are unknowns, and tell nothing of the noise.
        if layout.length == 1 && count < MIN_PAIRS {
            MIN_PAIRS
        } else {
            count
        }
    }
}

/// Number of blocks of `length` that comes nearest to a window.
#[inline(never)]
fn nearest_count(window: f32, length: u16) -> u16 {
    rounded(window / f32::from(length))
}

/// The nearest whole number to one from 0 to 65 535.
fn rounded(x: f32) -> u16 {
    (x + 0.5) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::PhaseStep;

    #[test]
    fn blocks_of_any_length_make_a_window_and_fit_the_smallest_ring_that_is_accepted() {
        // The longest block of a front; two of the longest periods do not fit in it.
        for max_length in [200u16, 1024, 32_766, 65_534] {
            for (has_hop, own_offsets) in
                [(false, false), (true, false), (false, true), (true, true)]
            {
                for periods in (2..=100).chain([1000]) {
                    let cut = Cut {
                        periods,
                        has_hop,
                        own_offsets,
                    };
                    let most_off = if own_offsets { 0.112 } else { 0.1 };
                    for i in 0..=400 {
                        let period =
                            2.5 * libm::powf(f32::from(max_length) / 2.5, i as f32 / 400.0);
                        let length = cut.length(period, max_length);
                        let blocks =
                            cut.blocks(Layout::unrounded(PhaseStep::from_period(period), length));
                        let samples = f32::from(blocks) * f32::from(length);
                        let off = (samples / (period * f32::from(periods)) - 1.0).abs();
                        let least = f32::from(MIN_PAIRS);
                        assert!(
                            length <= max_length
                                && (4..=periods.max(MAX_BLOCKS)).contains(&blocks)
                                && samples >= least
                                && (off < most_off || samples == least),
                            "{period} samples a period, {periods} periods, hop {has_hop}, blocks up to {max_length}: {blocks} of {length}"
                        );
                        // As the C header states.
                        let block = f32::from(length) / period;
                        let is_about_a_period = (0.87..1.34).contains(&block);
                        assert!(
                            !has_hop || periods < 10 || is_about_a_period,
                            "{period} samples a period, {periods} periods: a block of {block}"
                        );
                        let is_long = block > MIN_HUM_PERIODS || length == max_length;
                        assert!(
                            !own_offsets || periods < cut.min_hum_periods() || is_long,
                            "{period} samples a period, {periods} periods: a block of {block} for hum"
                        );
                    }
                }
            }
        }
    }
}
