//! Timing limits of the chip, and the SPI clock that a rate of pairs needs.

use crate::config::Oversampling;

/// The largest SPI clock, Hz.
pub const MAX_SCLK_HZ: u32 = 80_000_000;
/// The largest rate of conversions, Hz, out of reach in 1-wire mode: see [`max_pair_rate_hz`].
pub const MAX_CONVERSION_HZ: u32 = 4_000_000;
/// One conversion, nanoseconds.
pub const CONVERSION_NS: u32 = 190;
/// Shortest time that CS must be high between two frames, nanoseconds.
pub const CS_HIGH_NS: u32 = 10;
/// Clocks of a frame that carries a pair.
pub const FRAME_CLOCKS: u32 = 32;
/// Clocks of a frame that carries a pair of 18 bits each, in whole bytes.
pub const BOOSTED_FRAME_CLOCKS: u32 = 40;

/// Normal average: from CS to the first conversion, nanoseconds.
pub(crate) const FIRST_OVERSAMPLE_NS: u32 = 10;
/// Normal average: time of each further conversion, nanoseconds. In Linux it is 500 times the count of channels over that of data lines.
pub(crate) const NEXT_OVERSAMPLE_NS: u32 = 500 * 2;
/// Wait for the supply and the internal reference to settle, within 1 % by the data sheet, milliseconds.
pub(crate) const POWER_UP_INTERNAL_MS: u32 = 11;
/// The same with an external reference.
pub(crate) const POWER_UP_EXTERNAL_MS: u32 = 5;
/// Wait after a reset, microseconds: the data sheet demands less than one.
pub(crate) const RESET_US: u32 = 10;

/// The shortest time from one falling edge of CS to the next, nanoseconds, rounded up.
///
/// It is that of the frame's clocks and [`CS_HIGH_NS`], or of the conversions if they take longer; `u32::MAX`, 4.3 s, if it is longer than
/// that, as with clocks of 1 to 7 Hz, or 9 Hz with resolution boost. `None` if `sclk_hz` is 0 or above [`MAX_SCLK_HZ`].
///
/// ```
/// use ad7380::{Oversampling, timing::min_frame_ns};
/// assert_eq!(min_frame_ns(80_000_000, Oversampling::Off), Some(410));
/// assert_eq!(min_frame_ns(10_000_000, Oversampling::Off), Some(3_210));
/// ```
pub const fn min_frame_ns(sclk_hz: u32, oversampling: Oversampling) -> Option<u32> {
    if sclk_hz == 0 || sclk_hz > MAX_SCLK_HZ {
        return None;
    }
    let clocks = frame_clocks(oversampling);
    let shifting = (clocks as u64 * 1_000_000_000).div_ceil(sclk_hz as u64) + CS_HIGH_NS as u64;
    let converting = oversampling.conversion_ns() as u64;
    let frame = if shifting > converting {
        shifting
    } else {
        converting
    };
    Some(if frame > u32::MAX as u64 {
        u32::MAX
    } else {
        frame as u32
    })
}

/// The largest rate of pairs with an SPI clock, Hz, rounded down: with the clock of [`min_sclk_hz`], at least the rate that it was asked
/// for. 0 if no whole number of pairs a second is possible. `None` as in [`min_frame_ns`].
///
/// ```
/// use ad7380::{Oversampling, timing::max_pair_rate_hz};
/// assert_eq!(max_pair_rate_hz(80_000_000, Oversampling::Off), Some(2_439_024));
/// ```
pub const fn max_pair_rate_hz(sclk_hz: u32, oversampling: Oversampling) -> Option<u32> {
    if sclk_hz == 0 || sclk_hz > MAX_SCLK_HZ {
        return None;
    }
    // Not from the frame's time, which is rounded; multiplied by the clock · 1e9, all numbers are integers.
    let clocks = frame_clocks(oversampling) as u64;
    let frame = clocks * 1_000_000_000 + CS_HIGH_NS as u64 * sclk_hz as u64;
    let shifting = sclk_hz as u64 * 1_000_000_000 / frame;
    let converting = 1_000_000_000 / oversampling.conversion_ns() as u64;
    Some(if shifting < converting {
        shifting
    } else {
        converting
    } as u32)
}

/// The smallest SPI clock that serves a rate of pairs, Hz, rounded up.
///
/// `None` if `pair_rate_hz` is 0, or so large that it needs more than [`MAX_SCLK_HZ`] or leaves no time to convert. Software needs time
/// between frames, and so a considerably faster clock.
///
/// ```
/// use ad7380::{Oversampling, timing::min_sclk_hz};
/// assert_eq!(min_sclk_hz(100_000, Oversampling::Off), Some(3_203_204));
/// assert_eq!(min_sclk_hz(2_500_000, Oversampling::Off), None);
/// ```
pub const fn min_sclk_hz(pair_rate_hz: u32, oversampling: Oversampling) -> Option<u32> {
    if pair_rate_hz == 0 || pair_rate_hz > MAX_CONVERSION_HZ {
        return None;
    }
    if oversampling.conversion_ns() as u64 * pair_rate_hz as u64 > 1_000_000_000 {
        return None;
    }
    // The clocks have 1 / rate less the time that CS is high; multiplied by rate · 1e9, all numbers are integers.
    let shifting = 1_000_000_000 - CS_HIGH_NS as u64 * pair_rate_hz as u64;
    let clocks = frame_clocks(oversampling) as u64;
    let sclk = (clocks * pair_rate_hz as u64 * 1_000_000_000).div_ceil(shifting);
    if sclk > MAX_SCLK_HZ as u64 {
        None
    } else {
        Some(sclk as u32)
    }
}

/// Clocks of a frame that carries a pair.
const fn frame_clocks(oversampling: Oversampling) -> u32 {
    if oversampling.boost() {
        BOOSTED_FRAME_CLOCKS
    } else {
        FRAME_CLOCKS
    }
}
