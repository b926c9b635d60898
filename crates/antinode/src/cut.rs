//! How the windows of a wave are cut into blocks.

use crate::block::Layout;
use crate::scalar::lesser;

/// Blocks that a window is cut into at least: regression over K blocks keeps all but 1/K² of what its samples know of frequency.
const BLOCKS_A_WINDOW: f32 = 5.0;
/// Periods of a block at most: a reference that is off by the detector's 5 % then costs 2 % of its sums.
const LONGEST_BLOCK: f32 = 2.0;
/// Sample pairs of a block at most, whatever a front has room for: they are counted in 16 bits, and are even.
const LONGEST_LENGTH: f32 = 65_534.0;
/// A window has no more blocks than this or than periods, whichever is more.
pub(crate) const MOST_BLOCKS: u16 = 11;
/// Sample pairs of a window at least.
const LEAST_PAIRS: u16 = 6;
/// How far a window may be from what was asked, as a share of it, if another length of blocks brings it nearer.
const NEAR: f32 = 0.05;

/// What of the settings tells the blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cut {
    /// Periods a window.
    pub periods: u16,
    /// True where windows move on by other than their length.
    pub has_hop: bool,
}

impl Cut {
    /// Sample pairs of a block for a wave of `period` samples: two periods, or a fifth of a window where that is less; where there is a
    /// hop, half of it, so that windows move in finer steps. At most `most`.
    pub(crate) fn length(self, period: f32, most: u16) -> u16 {
        let window = period * f32::from(self.periods);
        let longest = lesser(LONGEST_BLOCK * period, window / BLOCKS_A_WINDOW);
        let length = if self.has_hop {
            rounded(0.5 * longest)
        } else if longest < 16.0 {
            rounded(longest)
        } else {
            // Samples are summed in twos.
            2 * rounded(0.5 * lesser(longest, LONGEST_LENGTH))
        };
        self.fitting(window, length.max(1)).min(most).max(1)
    }

    /// Periods of a window from which on its blocks have one each, a little less where that is no whole number of samples.
    pub(crate) const fn least_periods(self) -> u16 {
        let blocks = BLOCKS_A_WINDOW as u16;
        if self.has_hop { 2 * blocks } else { blocks }
    }

    /// The length from `length` down to half of it that brings whole blocks near enough to `window` samples.
    fn fitting(self, window: f32, mut length: u16) -> u16 {
        let most = self.periods.max(MOST_BLOCKS);
        if nearest_count(window, length) > most {
            length += 1;
        }
        let off = |length: u16, count: u16| (f32::from(count) * f32::from(length) - window).abs();
        let (least, mut nearest) = (length.div_ceil(2), length);
        let mut least_off = off(length, nearest_count(window, length));
        while least_off > NEAR * window && length > least {
            length -= 1;
            let count = nearest_count(window, length);
            if count > most {
                break;
            }
            let off = off(length, count);
            if off < least_off {
                (nearest, least_off) = (length, off);
            }
        }
        nearest
    }

    /// How many blocks of `layout` come nearest to a window.
    pub(crate) fn blocks(self, layout: Layout) -> u16 {
        let window = layout.step.period() * f32::from(self.periods);
        let count = nearest_count(window, layout.length);
        // Five pairs are as many numbers as unknowns, and tell nothing of the noise.
        if layout.length == 1 && count < LEAST_PAIRS {
            LEAST_PAIRS
        } else {
            count
        }
    }
}

/// How many lengths come nearest to a window.
#[inline(never)]
fn nearest_count(window: f32, length: u16) -> u16 {
    rounded(window / f32::from(length))
}

/// The nearest whole number, of numbers from 0 to 65 535.
fn rounded(x: f32) -> u16 {
    (x + 0.5) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::PhaseStep;

    #[test]
    fn blocks_of_any_length_make_a_window_and_fit_the_smallest_ring_that_is_accepted() {
        // The longest block that a front may have; of the longest periods two do not fit.
        for most in [200u16, 1024, 32_766, 65_534] {
            for has_hop in [false, true] {
                for periods in (2..=100).chain([1000]) {
                    let cut = Cut { periods, has_hop };
                    for i in 0..=400 {
                        let period = 2.5 * libm::powf(f32::from(most) / 2.5, i as f32 / 400.0);
                        let length = cut.length(period, most);
                        let blocks =
                            cut.blocks(Layout::unrounded(PhaseStep::from_period(period), length));
                        let samples = f32::from(blocks) * f32::from(length);
                        let off = (samples / (period * f32::from(periods)) - 1.0).abs();
                        let least = f32::from(LEAST_PAIRS);
                        assert!(
                            length <= most
                                && (4..=periods.max(MOST_BLOCKS)).contains(&blocks)
                                && samples >= least
                                && (off < 0.1 || samples == least),
                            "{period} samples a period, {periods} periods, hop {has_hop}, blocks up to {most}: {blocks} of {length}"
                        );
                    }
                }
            }
        }
    }
}
