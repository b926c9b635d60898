//! Everything that the owner of another gyro may want to change, with units. Values that are not allowed do not compile, and the error
//! message tells which are.

use antinode::{Calibration, Settings, SettingsError};
use antinode_telemetry::{Configuration, FrontEnd, MAX_FRAME};

use crate::clocks::restart_ms;
use crate::sampling::DUAL_ADC_RAILS;

/// Arithmetic of the samples: 16-bit integers, or f32 with the feature `f32`. The samples are 16-bit codes in both cases.
#[cfg(not(feature = "f32"))]
pub type Arithmetic = i16;
/// Arithmetic of the samples: 16-bit codes in f32.
#[cfg(feature = "f32")]
pub type Arithmetic = f32;

/// Sample pairs a second, Hz: for the converters of the chip 1300 to 150 000, and a divisor of 21 MHz; for the AD7380 2600 to 168 000,
/// and a divisor of 168 MHz. It is as exact as the crystal.
pub const SAMPLE_RATE: u32 = 100_000;
/// Initial length of a window, periods; 2 to `RING` − 2.
pub const PERIODS: u16 = 10;
/// Initial hop, blocks from window to window; with `None` windows follow each other.
pub const HOP: Option<u16> = None;
/// The wave's frequency, Hz, if it is known within 5 %; with `None` it is searched for.
pub const FREQUENCY: Option<f32> = None;
/// True if the signals carry mains hum, or an offset that wanders.
pub const HUM: bool = false;
/// True if the noise is not white, as behind a tuned front end or a filter that cuts off below three times the wave's frequency.
pub const COLOURED: bool = false;
/// How the pick-offs differ from ideal ones: gain ratio, skew in s, angle in rad.
pub const CALIBRATION: Calibration = Calibration::IDEAL;

/// Sample pairs in each half of the DMA's ring: they take 1.28 ms, the time that the interrupt has for them.
pub const HALF: usize = 128;
/// Longest period, sample pairs: even, 8 or more.
pub const LONGEST_PERIOD: usize = 200;
/// Blocks that the tracker holds: two more than the periods of the longest window.
pub const RING: usize = 24;
/// One more than the blocks of 72 bytes that may wait for the main loop. A power of two, because the interrupt divides by it. The interrupt
/// hands over the blocks of `HALF` pairs at once, for which there is room if a block has 2 pairs or more; if it has 1, as with a hop in
/// windows of 2 periods of fewer than 7.5 samples, one block of 128 is dropped. Blocks of 6 pairs and more can wait out the 5 ms that the
/// methods take in the main loop. Dropped blocks are counted.
pub const QUEUE: usize = 128;
/// One more than the requests that may wait for the interrupt.
pub const REQUESTS: usize = 4;
/// Bytes that may wait for the line: a dozen estimates of 110 bytes, 14 ms, and the reserve for more urgent reports. At least six frames.
pub const OUTBOX: usize = 2048;
/// One more than the bytes that may wait for the main loop: two frames, 2.8 ms. At least a frame.
pub const INBOX: usize = 256;

/// The serial line's rate, baud, 8N1. An estimate takes 1100 bits: 921 600 baud carry 800 a second, and those in excess are dropped and
/// counted.
pub const BAUD: u32 = 921_600;
/// Frequency of the board's crystal, MHz: 4 to 26, whole. If it is not that of the crystal, every rate is wrong, that of the line too.
pub const CRYSTAL_MHZ: u32 = 8;
/// True if an oscillator of `CRYSTAL_MHZ` drives PH0, rather than a crystal between PH0 and PH1.
pub const OSCILLATOR: bool = false;
/// The firmware's version, as `antinode monitor` shows it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Time without a pair after which sampling is restarted, ms: longer than two halves of the ring take.
pub const STALL_MS: u32 = 20;
/// Time without a live pipeline after which the watchdog resets the chip, ms.
pub const WATCHDOG_MS: u32 = 250;
/// Longest time that a requested restart waits for the line, ms: twice that of a full outbox, and at least 100.
pub const RESTART_MS: u32 = restart_ms(OUTBOX, BAUD);
/// Time between reports of the counters, ms.
pub const COUNTERS_MS: u32 = 1000;
/// Shortest time between reports of the counters, if they show a new fault, ms.
pub const SOONEST_MS: u32 = 50;

/// The initial configuration of an image, by its front end and the lowest and highest code of its converters.
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

// Settings that tracker and front would otherwise refuse on the board only.
const _: () = {
    match configuration(FrontEnd::DualAdc, DUAL_ADC_RAILS)
        .settings
        .check(RING)
    {
        Ok(()) => {}
        Err(SettingsError::PeriodsTooFew(_) | SettingsError::PeriodsTooMany { .. }) => {
            panic!("PERIODS must be 2 to RING - 2: make RING greater for longer windows")
        }
        Err(SettingsError::Hop) => panic!("HOP must be None, or Some of 1 or more"),
        Err(SettingsError::Frequency(_)) => {
            panic!("FREQUENCY must be None, or have 2.5 samples a period or more")
        }
        Err(SettingsError::GainRatio(_)) => panic!("CALIBRATION: gain_ratio must be 0.1 to 10"),
        Err(SettingsError::Skew(_)) => panic!("CALIBRATION: skew must be -1e-3 to 1e-3 s"),
        Err(SettingsError::PickOffAngle(_)) => {
            panic!("CALIBRATION: pick_off_angle must be -0.3 to 0.3 rad")
        }
        Err(SettingsError::HumPeriods { .. }) => {
            panic!("HUM: PERIODS must be 5 or more, or 10 with a HOP")
        }
        Err(_) => panic!("see antinode::Settings"),
    }
    if let Some(frequency) = FREQUENCY {
        assert!(
            SAMPLE_RATE as f32 / frequency <= LONGEST_PERIOD as f32,
            "FREQUENCY must be SAMPLE_RATE / LONGEST_PERIOD or more: make LONGEST_PERIOD greater for less"
        );
    }
};

// Sizes and times that depend on each other.
const _: () = {
    assert!(
        HALF >= 16 && HALF <= 16_000,
        "HALF must be 16 to 16_000: the DMA counts four half-words a pair in 16 bits"
    );
    assert!(
        2_000 * HALF as u64 <= STALL_MS as u64 * SAMPLE_RATE as u64,
        "STALL_MS must be 2_000 * HALF / SAMPLE_RATE or more: pairs come by halves of the ring"
    );
    assert!(
        WATCHDOG_MS >= 3 * STALL_MS,
        "WATCHDOG_MS must be 3 * STALL_MS or more: sampling is started anew before the chip is"
    );
    assert!(
        LONGEST_PERIOD >= 8 && LONGEST_PERIOD.is_multiple_of(2),
        "LONGEST_PERIOD must be even, 8 or more"
    );
    assert!(
        QUEUE >= 2 && QUEUE.is_power_of_two() && REQUESTS >= 2,
        "QUEUE must be a power of two, and REQUESTS 2 or more"
    );
    assert!(
        OUTBOX >= 6 * MAX_FRAME && OUTBOX < 1 << 16,
        "OUTBOX must be 6 * MAX_FRAME to 65_535: an estimate leaves room for four frames, and the DMA counts in 16 bits"
    );
    assert!(
        INBOX > MAX_FRAME && INBOX < 1 << 16,
        "INBOX must be MAX_FRAME + 1 to 65_535"
    );
};
