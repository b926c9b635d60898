//! What the user chooses, and its checks.

mod error;

pub use error::SettingsError;

use crate::calibration::Calibration;
use crate::cut::Cut;
use crate::double::to_single;

/// How the period is found from cold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Detection {
    /// Formula (10): takes about three periods; offsets may be up to 100 a_A, and noise 20 % of a_A and more.
    #[default]
    Difference,
    /// Formula (9), with the feature `mean-return`: takes about eleven periods; for signals with little noise and periods of 4.6 samples and
    /// more. [Shorter ones](crate::period::MeanReturnDetector) may take up to 400 periods, or for ever.
    #[cfg(feature = "mean-return")]
    MeanReturn,
}

/// Settings of an identification. Start from [`Settings::new`] and change what differs; later versions may have more of them. With the
/// feature `serde`, any field that stored settings lack, except the sample rate, is read as `new` sets it, in formats that name their
/// fields, such as JSON. In others, such as postcard, settings can be read only by a version with the same fields.
///
/// # Example
///
/// ```
/// use antinode::{Calibration, Identifier, Settings};
///
/// let base = Settings::new(100_000.0);
/// // A wave that is known within 5 %: no search, and windows from the first sample on.
/// let known = Settings { frequency: Some(5_332.0), ..base };
/// // Windows of 50 periods, one every 5 blocks, which then are about a period each.
/// let overlapping = Settings { periods: 50, hop: Some(5), ..base };
/// // Mains hum on the lines.
/// let hum = Settings { periods: 20, hum: true, ..base };
/// // Noise through a band-pass about the wave.
/// let tuned = Settings { coloured: true, ..base };
/// // Pick-offs that differ, as the command `antinode calibrate` finds them.
/// let calibration = Calibration { gain_ratio: 1.02, skew: 150e-9, pick_off_angle: -0.004 };
/// let calibrated = Settings { calibration, ..base };
/// // Codes of a signed converter of 24 bits.
/// let rails = Some([-8_388_608.0, 8_388_607.0]);
/// let codes = Settings { rails, resolution: Some(1.0), ..base };
/// for settings in [known, overlapping, hum, tuned, calibrated, codes] {
///     Identifier::<i32, 200, 64>::new(settings)?;
/// }
/// # Ok::<(), antinode::SettingsError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Settings {
    /// Sample rate in Hz, 10⁻³ to 10¹².
    pub sample_rate: f64,
    /// Length of a window in periods: from 2 to two fewer than the ring's blocks, and at most 60 000; 10 unless changed. A window is a
    /// whole number of blocks, so its length may be up to a tenth off, or a ninth with `hum`, and has at least 6 sample pairs. A block has
    /// up to two periods, or a fifth of the window if that is less.
    #[cfg_attr(feature = "serde", serde(default = "crate::serial::periods"))]
    pub periods: u16,
    /// Blocks from the start of one window to the start of the next, 1 or more. With a hop, blocks are half as long, about a period, or a
    /// tenth of a window of fewer than ten periods, so that windows move in finer steps. A hop longer than the window leaves gaps. `None`:
    /// windows follow each other without gap or overlap.
    pub hop: Option<u16>,
    /// Initial angle of the pattern, rad, within ±10⁴. The angle is known modulo π/2 only: the first window takes the value nearest to
    /// this. With π/4, the default, the first angle lies in 0…π/2.
    #[cfg_attr(feature = "serde", serde(default = "crate::serial::start_angle"))]
    pub start_angle: f32,
    /// The lowest and the highest sample that the converter can give, input units: a window with a sample at or beyond either is flagged as
    /// clipped. `None` if they are not known. A signed converter of 12 bits, taken as codes, has −2048 and 2047.
    pub rails: Option<[f32; 2]>,
    /// Step between neighbouring codes of the converter, input units, > 0; 1 if samples are codes, `None` if it is not known. With less
    /// noise than a step, rounding errors repeat with the signal and do not average out: deviations include them only if the step is given.
    pub resolution: Option<f32>,
    /// The wave's frequency in Hz, if it is known within 5 %: no period is searched for, and the first window begins with the first sample,
    /// even in noise nearly as large as the wave. A period may then have 2.5 samples to as many as a block holds, `N`. If the wave is at
    /// another frequency there is no window, or a flagged one, but for one wave in some thousands: its windows, with a fraction of its
    /// amplitude, may all be clean. `None`: the period is found as `detection` says, but that of a wave of fewer than 12 codes, or 16 if
    /// samples are `i32`, may not be found at all.
    pub frequency: Option<f32>,
    /// How the period is found from cold.
    #[cfg_attr(feature = "serde", serde(default))]
    pub detection: Detection,
    /// True, unless changed, to watch the third harmonic and the extremes of the samples. [`Flags::CLIPPED`](crate::Flags::CLIPPED) needs
    /// it; without it, a second tone or a wave at another frequency is hardly ever flagged as a [`Flags::MISFIT`](crate::Flags::MISFIT),
    /// and other faults are found later. It about doubles the work at sample rate.
    #[cfg_attr(feature = "serde", serde(default = "crate::serial::watch"))]
    pub watch: bool,
    /// True if the signals carry hum or another slow wander: each block, then of at least 0.9 periods, has an offset of its own, and what
    /// only moves an offset is neither noise nor a fault. Windows must have at least 5 periods for it, or 10 with a hop.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hum: bool,
    /// True if the noise is not white. Behind a tuned front end, or a filter that cuts off below three times the frequency, noise about
    /// that third harmonic may have less than a sixteenth of its power about the wave: with this setting that is no misfit, and blocks have
    /// offsets of their own as with `hum`. In return, nothing that is in every window is flagged: a second tone counts as noise, and so
    /// does a fault in the first window.
    #[cfg_attr(feature = "serde", serde(default))]
    pub coloured: bool,
    /// How the pick-offs differ from ideal ones.
    #[cfg_attr(feature = "serde", serde(default = "crate::serial::calibration"))]
    pub calibration: Calibration,
}

/// Samples in the shortest period that may be known.
const SHORTEST_PERIOD: f32 = 2.5;

impl Settings {
    /// The settings of what has none yet: zeros.
    pub(crate) const UNSET: Self = Self {
        sample_rate: 0.0,
        periods: 0,
        hop: None,
        start_angle: 0.0,
        rails: None,
        resolution: None,
        frequency: None,
        detection: Detection::Difference,
        watch: false,
        hum: false,
        coloured: false,
        calibration: Calibration {
            gain_ratio: 0.0,
            skew: 0.0,
            pick_off_angle: 0.0,
        },
    };

    /// Windows of 10 periods that follow each other, ideal pick-offs, no known rails, everything watched.
    pub const fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            periods: 10,
            hop: None,
            start_angle: core::f32::consts::FRAC_PI_4,
            rails: None,
            resolution: None,
            frequency: None,
            detection: Detection::Difference,
            watch: true,
            hum: false,
            coloured: false,
            calibration: Calibration::IDEAL,
        }
    }

    /// Checks every value for a ring of `blocks`, the `BLOCKS` of a [`Tracker`](crate::Tracker), 11 to 65 535. Whether a block holds a
    /// period of a known frequency is checked by [`Front::check`](crate::Front::check).
    ///
    /// ```
    /// use antinode::Settings;
    ///
    /// const SETTINGS: Settings = Settings { periods: 20, ..Settings::new(100_000.0) };
    /// // Settings that are not allowed do not compile.
    /// const _: () = assert!(SETTINGS.check(24).is_ok());
    /// ```
    ///
    /// # Errors
    ///
    /// The first value that is not allowed; its message says what is.
    pub const fn check(&self, blocks: usize) -> Result<(), SettingsError> {
        let most = blocks.saturating_sub(2);
        let most = if most < 60_000 { most as u16 } else { 60_000 };
        if !is_rate(self.sample_rate) {
            return Err(SettingsError::SampleRate(self.sample_rate));
        }
        if self.periods < 2 {
            return Err(SettingsError::PeriodsTooFew(self.periods));
        }
        if self.periods > most {
            return Err(SettingsError::PeriodsTooMany {
                periods: self.periods,
                most,
            });
        }
        if let Some(0) = self.hop {
            return Err(SettingsError::Hop);
        }
        // Blocks of less than a period have no offsets of their own.
        let least = self.cut().min_hum_periods();
        if self.hum && self.periods < least {
            return Err(SettingsError::HumPeriods {
                periods: self.periods,
                least,
            });
        }
        if !within(self.start_angle, -1e4, 1e4) {
            return Err(SettingsError::StartAngle(self.start_angle));
        }
        if let Some([low, high]) = self.rails
            && !is_less(low, high)
        {
            return Err(SettingsError::Rails([low, high]));
        }
        if let Some(resolution) = self.resolution
            && !within(resolution, f32::MIN_POSITIVE, f32::MAX)
        {
            return Err(SettingsError::Resolution(resolution));
        }
        // A period that overflows is one too long for the front.
        if let (Some(frequency), Some(period)) = (self.frequency, self.period())
            && !(frequency > 0.0 && period >= SHORTEST_PERIOD)
        {
            return Err(SettingsError::Frequency(frequency));
        }
        let Calibration {
            gain_ratio,
            skew,
            pick_off_angle,
        } = self.calibration;
        if !within(gain_ratio, 0.1, 10.0) {
            return Err(SettingsError::GainRatio(gain_ratio));
        }
        if !within(skew, -1e-3, 1e-3) {
            return Err(SettingsError::Skew(skew));
        }
        if !within(pick_off_angle, -0.3, 0.3) {
            return Err(SettingsError::PickOffAngle(pick_off_angle));
        }
        Ok(())
    }

    /// How windows are cut into blocks.
    pub(crate) const fn cut(&self) -> Cut {
        Cut {
            periods: self.periods,
            has_hop: self.hop.is_some(),
            own_offsets: self.hum || self.coloured,
        }
    }

    /// Samples in a period, where the frequency is known.
    pub(crate) const fn period(&self) -> Option<f32> {
        match self.frequency {
            Some(frequency) => Some(to_single(self.sample_rate) / frequency),
            None => None,
        }
    }
}

/// True for rates in the valid range. Positive numbers are ordered as their bits, and those of negative ones and NaN lie beyond: no
/// comparison in f64 is linked in.
const fn is_rate(rate: f64) -> bool {
    rate.to_bits() >= 1e-3f64.to_bits() && rate.to_bits() <= 1e12f64.to_bits()
}

/// False if the value is NaN.
const fn within(value: f32, low: f32, high: f32) -> bool {
    value >= low && value <= high
}

/// False if either is NaN.
const fn is_less(low: f32, high: f32) -> bool {
    low < high
}
