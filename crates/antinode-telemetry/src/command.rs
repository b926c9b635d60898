//! Commands from the PC to the device.

use core::fmt;

use antinode::{Calibration, SettingsError};
use serde::{Deserialize, Serialize};

/// Command from the PC to the device. Settings that none of these changes, such as the sample rate and the rails, are those of the build.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Send a [`Hello`](crate::Hello).
    Get,
    /// Change the window's length.
    SetWindow {
        /// Periods a window, 2 to the device's ring of blocks less 2.
        periods: u16,
    },
    /// Change the hop from window to window.
    SetHop {
        /// Blocks from the start of one window to that of the next, at least 1; with `None` windows follow each other.
        blocks: Option<u16>,
    },
    /// Change the correction of the pick-offs; its ranges are those of [`Calibration`].
    SetCalibration(Calibration),
    /// Change what is known of the frequency.
    SetFrequency {
        /// The wave's frequency, Hz, known within 5 %, with 2.5 sample pairs a period or more; with `None` it is searched for.
        hertz: Option<f32>,
    },
    /// Allow for mains hum or a wandering offset, or no longer: [`Settings::hum`](antinode::Settings::hum).
    SetHum {
        /// True to allow for it.
        on: bool,
    },
    /// Allow for noise that is not white, or no longer: [`Settings::coloured`](antinode::Settings::coloured).
    SetColoured {
        /// True to allow for it.
        on: bool,
    },
    /// Switch the computation of the paper's methods beside every estimate on or off.
    SetMethods {
        /// True to send them.
        on: bool,
    },
    /// Reset the device, once the command is acknowledged.
    Restart,
}

/// Why the device refused a command; nothing was changed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum CommandError {
    /// A value out of its range; the error names the range.
    Settings(SettingsError),
    /// The firmware was built without the feature.
    Unsupported,
    /// The paper's methods would run with a calibration, which they ignore: turn them off, or set the ideal one.
    Calibrated,
    /// Another change is in progress: try again in a moment.
    Busy,
}

impl From<SettingsError> for CommandError {
    fn from(error: SettingsError) -> Self {
        Self::Settings(error)
    }
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settings(error) => error.fmt(f),
            Self::Unsupported => f.write_str("this firmware was built without it"),
            Self::Calibrated => f.write_str(
                "the paper's methods cannot be used with a calibration: turn the methods off, or set an ideal calibration",
            ),
            Self::Busy => f.write_str("another change is under way: ask again in a moment"),
        }
    }
}

impl core::error::Error for CommandError {}
