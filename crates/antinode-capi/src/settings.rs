//! The settings as C structs, and their conversion to the core's.

use antinode as core_crate;
use core_crate::Calibration as CoreCalibration;

use crate::status::Status;

/// The period is found from the squared difference, in about three periods, with offsets of up to 100 amplitudes, and in noise of 20 % and
/// more.
pub const ANTINODE_DETECTION_DIFFERENCE: u32 = 0_u32;
/// The period is found from the return of the running sum, in about eleven periods; for signals with little noise.
pub const ANTINODE_DETECTION_MEAN_RETURN: u32 = 1_u32;

/// How pick-off D differs from an ideal one that stands 45° from C, has C's gain and is sampled with C.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Calibration {
    /// Gain of channel D over that of channel C. 0.1 to 10; 1 is ideal.
    pub gain_ratio: f32,
    /// How much later channel D is sampled than channel C, s. Within ±0.001; 0 is ideal. If it is more than a tenth of a window, the
    /// uncertainty of the frequency adds to those of a_B and the angle, and the stated deviations do not include it.
    pub skew_s: f32,
    /// Pick-off D stands at 45° plus this angle from C, rad. Within ±0.3; 0 is ideal.
    pub pick_off_angle_rad: f32,
}

/// Settings of an identification. Start from antinode_settings_default() and change what differs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Settings {
    /// Sample rate, Hz. 1 to 1e10.
    pub sample_rate_hz: f64,
    /// Length of a window, periods. 2 to ANTINODE_MOST_PERIODS; default 10. A window is a whole number of blocks, a block a whole number of
    /// samples: so the length may be off by up to a tenth, with `hum` a ninth, and by more if a known frequency has few samples a period: 2
    /// periods of 2.6 samples become 2.31.
    pub periods: u32,
    /// Blocks from the start of one window to the start of the next, 1 to 65535; a block is then about a period, or a tenth of a window of
    /// less than ten periods, rounded to whole samples: 0.87 to 1.33 periods if these are short. For windows that follow each other without
    /// gap or overlap give 0, the default, not the number of periods.
    pub hop_blocks: u32,
    /// The first window's angle is chosen within π/4 of this angle, rad. Within ±10000: subtract whole turns from a greater one. Default
    /// π/4, which puts the first angle in 0…π/2.
    pub start_angle_rad: f32,
    /// The least value that the converter gives, input units: a window with a sample at or below it is flagged as clipped. Default 0, as
    /// for a converter with unsigned codes.
    pub rail_low: f32,
    /// The greatest value that the converter gives, input units, above `rail_low`: 4095 for 12 bits. Both rails 0, the default: not known.
    pub rail_high: f32,
    /// Step between neighbouring codes of the converter, input units, > 0: standard deviations then include the error of rounding to it. 0,
    /// the default: not known. In noise of less than 0.3 of a step, errors may then be many times the standard deviations, and windows
    /// without a fault be flagged ANTINODE_FLAG_CLIPPED or ANTINODE_FLAG_MISFIT: give it.
    pub resolution: f32,
    /// The wave's frequency, Hz, if it is known, and stays so, within 5 %: it is then never searched for, and the first window begins with
    /// the first sample. `sample_rate_hz` / ANTINODE_LONGEST_PERIOD to `sample_rate_hz` / 2.5; 0, the default: the period is found as
    /// `detection` says.
    pub frequency_hz: f32,
    /// How the period is found: ANTINODE_DETECTION_DIFFERENCE, the default, or ANTINODE_DETECTION_MEAN_RETURN.
    pub detection: u32,
    /// 1, the default: the third harmonic and the extremes of the samples are watched. 0: they are not, which about halves the work at
    /// sample rate; ANTINODE_FLAG_CLIPPED is then never set, ANTINODE_FLAG_DEAD_CHANNEL only when a wave is lost, and ANTINODE_FLAG_MISFIT
    /// hardly ever for a second tone or a wave at another frequency.
    pub watch: u32,
    /// How the pick-offs differ from ideal ones. Default: ideal.
    pub calibration: Calibration,
    /// 1 if the signals carry hum or another slow wander: each block, of 0.9 periods or more, then has an offset of its own, and what only
    /// moves offsets is neither noise nor a fault. Windows must then have at least 5 periods, or 10 with a hop. 0, the default: they do
    /// not.
    pub hum: u32,
    /// 1 if the noise is not white. Behind a tuned front end, or a filter that cuts off below three times the wave's frequency, noise at
    /// three times the frequency has less than a sixteenth of its power about the wave: with this setting that is no fault, and blocks have
    /// offsets of their own, as with `hum`. In return, what is in every window is not flagged: a second tone counts as noise, and so does a
    /// fault in the first window. 0, the default: the noise is white.
    pub coloured: u32,
}

/// Settings with every default: windows of 10 periods that follow each other, ideal pick-offs, no known rails, everything watched.
/// The sample rate is checked by the `_init` functions. May be called from anywhere.
#[allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]
#[unsafe(no_mangle)]
pub extern "C" fn antinode_settings_default(sample_rate_hz: f64) -> Settings {
    let plain = core_crate::Settings::new(sample_rate_hz);
    Settings {
        sample_rate_hz,
        periods: u32::from(plain.periods),
        hop_blocks: 0,
        start_angle_rad: plain.start_angle,
        rail_low: 0.0,
        rail_high: 0.0,
        resolution: 0.0,
        frequency_hz: 0.0,
        detection: ANTINODE_DETECTION_DIFFERENCE,
        watch: u32::from(plain.watch),
        calibration: Calibration {
            gain_ratio: plain.calibration.gain_ratio,
            skew_s: plain.calibration.skew,
            pick_off_angle_rad: plain.calibration.pick_off_angle,
        },
        hum: u32::from(plain.hum),
        coloured: u32::from(plain.coloured),
    }
}

impl From<Calibration> for CoreCalibration {
    fn from(calibration: Calibration) -> Self {
        Self {
            gain_ratio: calibration.gain_ratio,
            skew: calibration.skew_s,
            pick_off_angle: calibration.pick_off_angle_rad,
        }
    }
}

impl Settings {
    /// The core's settings, checked for a ring of `blocks`.
    pub(crate) fn checked(&self, blocks: usize) -> Result<core_crate::Settings, Status> {
        // Compared as bits, whose order is that of positive numbers, with all others beyond: this links in no comparison of f64.
        if !(1f64.to_bits()..=1e10f64.to_bits()).contains(&self.sample_rate_hz.to_bits()) {
            return Err(Status::ErrorSampleRate);
        }
        let settings = core_crate::Settings {
            periods: u16::try_from(self.periods).map_err(|_| Status::ErrorPeriods)?,
            hop: match u16::try_from(self.hop_blocks).map_err(|_| Status::ErrorHop)? {
                0 => None,
                hop => Some(hop),
            },
            start_angle: self.start_angle_rad,
            rails: (self.rail_low != 0.0 || self.rail_high != 0.0)
                .then_some([self.rail_low, self.rail_high]),
            resolution: (self.resolution != 0.0).then_some(self.resolution),
            frequency: (self.frequency_hz != 0.0).then_some(self.frequency_hz),
            detection: match self.detection {
                ANTINODE_DETECTION_DIFFERENCE => core_crate::Detection::Difference,
                ANTINODE_DETECTION_MEAN_RETURN => core_crate::Detection::MeanReturn,
                _ => return Err(Status::ErrorDetection),
            },
            watch: switched(self.watch).ok_or(Status::ErrorWatch)?,
            hum: switched(self.hum).ok_or(Status::ErrorHum)?,
            coloured: switched(self.coloured).ok_or(Status::ErrorColoured)?,
            calibration: self.calibration.into(),
            ..core_crate::Settings::new(self.sample_rate_hz)
        };
        settings.check(blocks)?;
        Ok(settings)
    }
}

/// A switch: false for 0, true for 1, and `None` for any other number.
fn switched(value: u32) -> Option<bool> {
    (value < 2).then_some(value == 1)
}
