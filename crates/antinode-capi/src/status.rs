//! The status that functions return, and the version of the library.

use core::ffi::{CStr, c_char};

use antinode::SettingsError;

/// What a function returns: zero or above if it was done; below zero if it failed and nothing was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, and a block was finished: it waits for a `_solve` function.
    Ready = 1,
    /// Done, and an estimate was written.
    Estimate = 2,
    /// Done, and blocks wait as after ANTINODE_READY; but the queue was full, and at least one finished block was dropped, which leaves a
    /// gap as a `_skip` function does. Call `_solve` more often, or push fewer pairs at once: see ANTINODE_QUEUE_BLOCKS.
    Dropped = 3,
    /// A pointer is NULL.
    ErrorNull = -1,
    /// A pointer is not aligned as its type demands.
    ErrorAlignment = -2,
    /// The state was never initialised, its last `_init` failed, or it belongs to the other arithmetic. In memory that a reset does not
    /// clear, a state from before it, perhaps half written, counts as initialised: enable the interrupt after `_init`.
    ErrorNotInitialised = -3,
    /// An array would be larger than the address space.
    ErrorCount = -4,
    /// `sample_rate_hz` is not within 1 to 1e10.
    ErrorSampleRate = -10,
    /// `periods` is not within 2 to ANTINODE_MOST_PERIODS.
    ErrorPeriods = -11,
    /// `hop_blocks` is not within 0 to 65535.
    ErrorHop = -12,
    /// `start_angle_rad` is not within ±10000.
    ErrorStartAngle = -13,
    /// `rail_low` is not below `rail_high`.
    ErrorRails = -14,
    /// `resolution` is neither 0 nor a positive number.
    ErrorResolution = -15,
    /// `detection` is not one of ANTINODE_DETECTION_….
    ErrorDetection = -16,
    /// `watch` is neither 0 nor 1.
    ErrorWatch = -17,
    /// `gain_ratio` is not within 0.1 to 10.
    ErrorGainRatio = -18,
    /// `skew_s` is not within ±0.001.
    ErrorSkew = -19,
    /// `pick_off_angle_rad` is not within ±0.3.
    ErrorPickOffAngle = -20,
    /// `hum` is neither 0 nor 1, or windows with it have fewer than 5 periods, or 10 with a hop.
    ErrorHum = -21,
    /// `frequency_hz` is neither 0 nor within `sample_rate_hz` / ANTINODE_LONGEST_PERIOD, or half a sample pair more, to
    /// `sample_rate_hz` / 2.5.
    ErrorFrequency = -22,
    /// `coloured` is neither 0 nor 1.
    ErrorColoured = -23,
}

impl Status {
    const ALL: [(Self, &'static CStr); 22] = [
        (Self::Ok, c"done"),
        (Self::Ready, c"done: finished blocks wait to be solved"),
        (Self::Estimate, c"done: an estimate was written"),
        (
            Self::Dropped,
            c"done, but the queue was full and a finished block was dropped: solve more often, or push less at once",
        ),
        (Self::ErrorNull, c"a pointer is NULL"),
        (
            Self::ErrorAlignment,
            c"a pointer is not aligned as its type demands",
        ),
        (
            Self::ErrorNotInitialised,
            c"the state is not initialised, or is of the other arithmetic: call _init",
        ),
        (
            Self::ErrorCount,
            c"the array would be larger than the address space",
        ),
        (
            Self::ErrorSampleRate,
            c"sample_rate_hz must lie within 1 to 1e10",
        ),
        (
            Self::ErrorPeriods,
            c"periods must lie within 2 to ANTINODE_MOST_PERIODS",
        ),
        (Self::ErrorHop, c"hop_blocks must lie within 0 to 65535"),
        (
            Self::ErrorStartAngle,
            c"start_angle_rad must lie within +-10000",
        ),
        (Self::ErrorRails, c"rail_low must lie below rail_high"),
        (
            Self::ErrorResolution,
            c"resolution must be 0 or a positive number",
        ),
        (
            Self::ErrorDetection,
            c"detection must be 0 or 1, ANTINODE_DETECTION_*",
        ),
        (Self::ErrorWatch, c"watch must be 0 or 1"),
        (
            Self::ErrorGainRatio,
            c"gain_ratio must lie within 0.1 to 10",
        ),
        (Self::ErrorSkew, c"skew_s must lie within +-0.001"),
        (
            Self::ErrorPickOffAngle,
            c"pick_off_angle_rad must lie within +-0.3",
        ),
        (
            Self::ErrorHum,
            c"hum must be 0 or 1, and 0 where periods < 5, or < 10 with a hop",
        ),
        (
            Self::ErrorFrequency,
            c"frequency_hz must be 0 or lie within sample_rate_hz / ANTINODE_LONGEST_PERIOD and sample_rate_hz / 2.5",
        ),
        (Self::ErrorColoured, c"coloured must be 0 or 1"),
    ];
}

impl From<SettingsError> for Status {
    fn from(error: SettingsError) -> Self {
        match error {
            SettingsError::PeriodsTooFew(_) | SettingsError::PeriodsTooMany { .. } => {
                Self::ErrorPeriods
            }
            SettingsError::Hop => Self::ErrorHop,
            SettingsError::StartAngle(_) => Self::ErrorStartAngle,
            SettingsError::Rails(_) => Self::ErrorRails,
            SettingsError::Frequency(_) | SettingsError::FrequencyTooLow { .. } => {
                Self::ErrorFrequency
            }
            SettingsError::Resolution(_) => Self::ErrorResolution,
            SettingsError::GainRatio(_) => Self::ErrorGainRatio,
            SettingsError::Skew(_) => Self::ErrorSkew,
            SettingsError::PickOffAngle(_) => Self::ErrorPickOffAngle,
            SettingsError::HumPeriods { .. } => Self::ErrorHum,
            // `SettingsError` may grow; today only the errors of the sample rate remain.
            _ => Self::ErrorSampleRate,
        }
    }
}

/// What a status means, in English; never NULL. Takes any number. May be called from anywhere.
#[allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]
#[unsafe(no_mangle)]
pub extern "C" fn antinode_status_string(status: i32) -> *const c_char {
    let known = Status::ALL
        .iter()
        .find(|(known, _)| *known as i32 == status);
    known.map_or(c"unknown status", |(_, text)| text).as_ptr()
}

/// The version of this header: major × 65536 + minor × 256 + patch.
pub const ANTINODE_HEADER_VERSION: u32 = 0x00_0100_u32;

/// The version of the library that is linked. ANTINODE_HEADER_VERSION may differ from it in the last eight bits, the patch, which changes no
/// type and no function; otherwise header and library do not belong together. Compare the size of a state too, which depends on how the
/// library was built, before its `_init`. May be called from anywhere.
#[allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]
#[unsafe(no_mangle)]
pub extern "C" fn antinode_version() -> u32 {
    ANTINODE_HEADER_VERSION
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_is_that_of_the_package() {
        let [major, minor, patch] = [
            env!("CARGO_PKG_VERSION_MAJOR"),
            env!("CARGO_PKG_VERSION_MINOR"),
            env!("CARGO_PKG_VERSION_PATCH"),
        ]
        .map(|part| part.parse::<u32>().unwrap());
        assert_eq!(ANTINODE_HEADER_VERSION, major << 16 | minor << 8 | patch);
    }

    #[test]
    fn every_number_has_a_text() {
        assert_eq!(text(-12), "hop_blocks must lie within 0 to 65535");
        assert_eq!(text(i32::MIN), "unknown status");
        for (status, string) in Status::ALL {
            assert_eq!(text(status as i32), string.to_str().unwrap());
        }
    }

    #[allow(unsafe_code, reason = "a C string is read back")]
    fn text(status: i32) -> &'static str {
        // SAFETY: the function gives static C strings only.
        unsafe { CStr::from_ptr(antinode_status_string(status)) }
            .to_str()
            .unwrap()
    }
}
