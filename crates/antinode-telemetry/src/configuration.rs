//! The configuration of the device.

use antinode::{Calibration, Settings};
use serde::{Deserialize, Serialize};

use crate::command::{Command, CommandError};

/// Source of the device's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum FrontEnd {
    /// Two converters of the microcontroller that sample both pick-offs at once.
    DualAdc,
    /// One converter of the microcontroller that samples the pick-offs in turn: the calibration's skew is not 0.
    SequencedAdc,
    /// An external converter on SPI.
    Spi,
    /// An external converter or codec on I²S or SAI.
    Sai,
    /// Sigma-delta modulators behind the microcontroller's own filters (DFSDM).
    Dfsdm,
    /// A wave computed on the device itself: no converter is read.
    Synthetic,
}

/// Configuration of the device.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Configuration {
    /// The identification's settings: those of the build, as changed by commands.
    pub settings: Settings,
    /// Source of the samples.
    pub front_end: FrontEnd,
    /// True if [`Report::Methods`](crate::Report::Methods) are sent too.
    pub methods: bool,
}

impl Configuration {
    /// A configuration without the paper's methods.
    pub const fn new(settings: Settings, front_end: FrontEnd) -> Self {
        Self {
            settings,
            front_end,
            methods: false,
        }
    }

    /// This configuration after a command, checked for a ring of `blocks` blocks; unchanged by commands that change none.
    ///
    /// Whether a front can hold a period of a known frequency is for [`Front::check`](antinode::Front::check). The core
    /// [takes new settings in a certain order](antinode#on-a-microcontroller), and more simply those that change no block: calibration,
    /// hum and coloured noise.
    ///
    /// # Errors
    ///
    /// [`CommandError::Settings`] names the value that is out of range, and the range; [`CommandError::Calibrated`] if methods and a
    /// calibration other than the ideal one would be on together.
    pub fn after(self, command: &Command, blocks: usize) -> Result<Self, CommandError> {
        let mut new = self;
        match *command {
            Command::SetWindow { periods } => new.settings.periods = periods,
            Command::SetHop { blocks } => new.settings.hop = blocks,
            Command::SetCalibration(calibration) => new.settings.calibration = calibration,
            Command::SetFrequency { hertz } => new.settings.frequency = hertz,
            Command::SetHum { on } => new.settings.hum = on,
            Command::SetColoured { on } => new.settings.coloured = on,
            Command::SetMethods { on } => new.methods = on,
            Command::Get | Command::Restart => {}
        }
        new.settings.check(blocks)?;
        if new.methods && new.settings.calibration != Calibration::IDEAL {
            return Err(CommandError::Calibrated);
        }
        Ok(new)
    }
}

#[cfg(test)]
mod tests {
    use antinode::SettingsError;

    use super::*;

    const PLAIN: Configuration = Configuration::new(Settings::new(1e5), FrontEnd::DualAdc);

    #[test]
    fn commands_change_only_what_they_name() {
        let calibration = Calibration {
            gain_ratio: 1.1,
            skew: 1e-6,
            pick_off_angle: -0.01,
        };
        let commands = [
            Command::SetWindow { periods: 20 },
            Command::SetHop { blocks: Some(5) },
            Command::SetCalibration(calibration),
            Command::SetFrequency {
                hertz: Some(5332.0),
            },
            Command::SetHum { on: true },
            Command::SetColoured { on: true },
            Command::Get,
            Command::Restart,
        ];
        let new = commands
            .iter()
            .fold(PLAIN, |c, command| c.after(command, 64).expect("it can be"));
        assert_eq!(
            new,
            Configuration {
                settings: Settings {
                    periods: 20,
                    hop: Some(5),
                    calibration,
                    frequency: Some(5332.0),
                    hum: true,
                    coloured: true,
                    ..PLAIN.settings
                },
                ..PLAIN
            }
        );
        let on = PLAIN.after(&Command::SetMethods { on: true }, 64);
        let with_methods = Configuration {
            methods: true,
            ..PLAIN
        };
        assert_eq!(on, Ok(with_methods));
        // The methods ignore calibrations.
        let refused = Err(CommandError::Calibrated);
        assert_eq!(new.after(&Command::SetMethods { on: true }, 64), refused);
        let calibrate = Command::SetCalibration(calibration);
        assert_eq!(with_methods.after(&calibrate, 64), refused);
        assert!(new.after(&Command::SetMethods { on: false }, 64).is_ok());
    }

    #[test]
    fn values_out_of_range_are_refused() {
        assert_eq!(
            PLAIN.after(&Command::SetWindow { periods: 63 }, 64),
            Err(CommandError::Settings(SettingsError::PeriodsTooMany {
                periods: 63,
                most: 62
            }))
        );
        assert_eq!(
            PLAIN.after(&Command::SetHop { blocks: Some(0) }, 64),
            Err(CommandError::Settings(SettingsError::Hop))
        );
        let hertz = 40_001.0;
        let too_high = Command::SetFrequency { hertz: Some(hertz) };
        assert_eq!(
            PLAIN.after(&too_high, 64),
            Err(CommandError::Settings(SettingsError::Frequency(hertz)))
        );
    }
}
