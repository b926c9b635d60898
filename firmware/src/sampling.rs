//! The interface between converters and the pipeline. It is a trait of this crate because embedded-hal 1.0 has none for converters.

use antinode::{Packed, SamplePair};
use antinode_telemetry::Cause;

use crate::settings::HALF;

/// A gap in the samples: they were not fetched in time, or the converter stopped. Sampling has already been resumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lapse {
    /// Cause of the gap.
    pub cause: Cause,
    /// Sample pairs that are missing between the last one handed out and the next one.
    pub lost: u32,
}

/// Event of a source's interrupt.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ready {
    /// No new pairs.
    Nothing,
    /// The next pairs of the stream are in [`Source::pairs`].
    Pairs,
    /// Pairs are missing.
    Lapse(Lapse),
}

/// A source of simultaneous sample pairs, in buffers, at a steady rate. Its methods are called from the source's own interrupt only.
///
/// Failures are reported: an overrun or a stopped converter by a [`Lapse`] with the number of pairs lost, pairs overwritten while they
/// were read by [`Source::is_intact`], saturation by [`Source::is_at_rail`].
pub trait Source {
    /// A sample pair in the converter's format, S_C first.
    type Pair: Copy;

    /// Acknowledges the interrupt and gives its event. After a lapse it has already restarted sampling.
    fn next(&mut self) -> Ready;

    /// The pairs that the last [`Ready::Pairs`] announced.
    fn pairs(&self) -> &[Self::Pair];

    /// True if the converter has not begun to overwrite [`Source::pairs`]: to be checked after they are read.
    fn is_intact(&self) -> bool;

    /// Stops, clears and restarts sampling, and gives the loss since the last of [`Source::pairs`].
    fn restart(&mut self, cause: Cause) -> Lapse;

    /// The lowest and the highest code, each as a pair for both converters.
    fn rails(&self) -> [Self::Pair; 2];

    /// True for a pair with a sample at either end of the converter's range.
    fn is_at_rail(&self, pair: Self::Pair) -> bool;
}

/// Count of pairs written beyond the end of one half of a ring, the first or the second, when `left` pairs of the round are to come.
pub const fn beyond(second: bool, left: u32) -> u32 {
    let half = HALF as u32;
    let from_end = if second { 2 * half } else { 3 * half };
    from_end.wrapping_sub(left) % (2 * half)
}

/// True if the count of pairs does not match that of triggers: each pair comes after its trigger and before the next one.
pub const fn has_slipped(triggers: u32, pairs: u32) -> bool {
    triggers.wrapping_sub(pairs) > 1
}

/// Both codes, each as a pair with that code in both channels.
pub fn both([low, high]: [i16; 2]) -> [Packed; 2] {
    [low, high].map(|code| Packed::from([code; 2]))
}

/// Lowest and highest code of the STM32F405's 12-bit converters.
pub const DUAL_ADC_RAILS: [i16; 2] = [0, 4095];
/// Lowest and highest code of the AD7380.
pub const AD7380_RAILS: [i16; 2] = [i16::MIN, i16::MAX];

/// True for a pair with a code of [`DUAL_ADC_RAILS`].
#[inline]
pub fn is_at_rail_12(pair: Packed) -> bool {
    // Plus 1 modulo 4096, the rails are 0 and 1. Subtracting 2 borrows for these only; a low half that borrows is at a rail itself.
    let next = pair.0.wrapping_add(0x0001_0001) & 0x0FFF_0FFF;
    next.wrapping_sub(0x0002_0002) & 0x8000_8000 != 0
}

/// True for a pair with a code of [`AD7380_RAILS`].
#[inline]
pub fn is_at_rail_16(pair: Packed) -> bool {
    let codes: [i16; 2] = pair.pair();
    codes.iter().any(|code| AD7380_RAILS.contains(code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_beyond_a_half_are_counted_around_the_ring() {
        let half = HALF as u32;
        for pairs in 0..2 * half {
            // The DMA's count in a round from the first half on; 0 is reloaded at once.
            let left = |end: u32| match (end + pairs) % (2 * half) {
                0 => [2 * half, 0],
                written => [2 * half - written; 2],
            };
            for (second, end) in [(false, half), (true, 2 * half)] {
                assert_eq!(left(end).map(|left| beyond(second, left)), [pairs; 2]);
            }
        }
    }

    #[test]
    fn one_pair_too_few_or_too_many_is_a_slip() {
        for pairs in [0, 5, 2 * HALF as u32 - 1] {
            let slips = |ahead: i32| has_slipped(pairs.wrapping_add_signed(ahead), pairs);
            assert_eq!(
                [-1, 0, 1, 2, 1000].map(slips),
                [true, false, false, true, true]
            );
        }
    }

    #[test]
    fn rails_are_the_first_and_the_last_code() {
        for (code, at_rail) in (0..4096).map(|code| (code, code == 0 || code == 4095)) {
            for other in [1, 2, 3, 2048, 4094] {
                assert_eq!(is_at_rail_12(Packed(code << 16 | other)), at_rail);
                assert_eq!(is_at_rail_12(Packed(other << 16 | code)), at_rail);
            }
        }
    }

    #[test]
    fn rails_of_16_bits_are_the_first_and_the_last_code() {
        for code in i16::MIN..=i16::MAX {
            let at_rail = code == i16::MIN || code == i16::MAX;
            let code = u32::from(code as u16);
            // The other half differs from a rail in one bit.
            for other in [0, 1, 0x7FFE, 0x8001, 0xFFFF] {
                assert_eq!(is_at_rail_16(Packed(code << 16 | other)), at_rail);
                assert_eq!(is_at_rail_16(Packed(other << 16 | code)), at_rail);
            }
        }
    }
}
