//! Everything that an owner of another gyro may want to change, in one place, with units.

use antinode::{Calibration, Settings};
use antinode_telemetry::{Configuration, FrontEnd};

/// Samples and their arithmetic: 16-bit codes, or the same codes in f32 with the feature `f32`.
#[cfg(not(feature = "f32"))]
pub type Arithmetic = i16;
/// Samples and their arithmetic: 16-bit codes in f32.
#[cfg(feature = "f32")]
pub type Arithmetic = f32;

/// Sample pairs a second, Hz. It must divide the timers' clocks: 84 MHz for the converters of the chip, 168 MHz for the AD7380.
pub const SAMPLE_RATE: u32 = 100_000;
/// Periods a window at the start; 2 to `RING` − 2.
pub const PERIODS: u16 = 10;
/// Blocks from window to window at the start; `None`: windows follow each other.
pub const HOP: Option<u16> = None;
/// The wave's frequency, Hz, within 5 %, where it need not be searched; `None`: it is.
pub const FREQUENCY: Option<f32> = None;
/// Whether the signals carry mains hum, or an offset that wanders.
pub const HUM: bool = false;
/// Whether the noise is not white: a tuned front end, or a filter that ends below three times the wave's frequency.
pub const COLOURED: bool = false;
/// How the pick-offs differ from ideal ones: gain ratio, skew in s, angle in rad.
pub const CALIBRATION: Calibration = Calibration::IDEAL;

/// Sample pairs of half of the DMA's ring: 1.28 ms, the time that the interrupt has for them.
pub const HALF: usize = 128;
/// Longest period, sample pairs.
pub const LONGEST_PERIOD: usize = 200;
/// Blocks that the tracker holds: a window has up to two periods less.
pub const RING: usize = 24;
/// Blocks that may wait for the main loop, and one more; comparing the methods over a window takes as long as 15 blocks.
pub const QUEUE: usize = if cfg!(feature = "methods") { 32 } else { 16 };
/// Requests that may wait for the interrupt, and one more.
pub const REQUESTS: usize = 4;
/// Bytes that may wait for the line: 15 estimates of 110 bytes, 18 ms, and what goes before them.
pub const OUTBOX: usize = 2048;
/// Bytes that may wait for the main loop, and one more: two frames, 2.8 ms.
pub const INBOX: usize = 256;

/// The serial line's rate, baud, 8N1.
pub const BAUD: u32 = 921_600;
/// The board's crystal, MHz: 4 to 26.
pub const CRYSTAL_MHZ: u32 = 8;
/// Without a pair for so long, ms, sampling is started anew.
pub const STALL_MS: u32 = 20;
/// Without a live pipeline for so long, ms, the watchdog resets the chip.
pub const WATCHDOG_MS: u32 = 250;
/// A restart that was asked for waits for the line so long, ms, at most.
pub const RESTART_MS: u32 = 100;
/// From one report of the counters to the next, ms.
pub const COUNTERS_MS: u32 = 1000;

/// Least and greatest code of the STM32F405's 12-bit converters.
pub const DUAL_ADC_RAILS: [i16; 2] = [0, 4095];
/// Least and greatest code of the AD7380.
pub const AD7380_RAILS: [i16; 2] = [i16::MIN, i16::MAX];

/// What an image is set to at its start, by its front end and the codes of its rails.
pub const fn configuration(front_end: FrontEnd, rails: [i16; 2]) -> Configuration {
    let settings = Settings {
        periods: PERIODS,
        hop: HOP,
        rails: Some([rails[0] as f32, rails[1] as f32]),
        resolution: Some(1.0),
        frequency: FREQUENCY,
        hum: HUM,
        coloured: COLOURED,
        calibration: CALIBRATION,
        ..Settings::new(SAMPLE_RATE as f64)
    };
    Configuration::new(settings, front_end)
}
