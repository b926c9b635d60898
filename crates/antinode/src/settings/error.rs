//! What was wrong with settings, and what would be right.

use core::fmt;

/// Settings that cannot work.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SettingsError {
    /// The sample rate is not a number from 10⁻³ to 10¹² Hz.
    SampleRate(f64),
    /// Fewer than 2 periods a window.
    PeriodsTooFew(u16),
    /// More periods a window than the ring of blocks holds.
    PeriodsTooMany {
        /// The periods asked for.
        periods: u16,
        /// The most that the ring holds: its blocks less 2, but not more than 60 000.
        most: u16,
    },
    /// A hop of no blocks.
    Hop,
    /// The start angle is not a number within ±10⁴ rad.
    StartAngle(f32),
    /// The lower rail is not below the upper one.
    Rails([f32; 2]),
    /// The resolution is not a positive number.
    Resolution(f32),
    /// The frequency is not a positive number, or has fewer than 2.5 samples a period.
    Frequency(f32),
    /// The gain ratio is outside 0.1 to 10.
    GainRatio(f32),
    /// The skew is not a number within ±1 ms.
    Skew(f32),
    /// The pick-off angle is outside ±0.3 rad.
    PickOffAngle(f32),
    /// Windows too short to tell the wave from hum.
    HumPeriods {
        /// The periods asked for.
        periods: u16,
        /// The fewest with hum: 5, or 10 with a hop.
        least: u16,
    },
    /// A period of the known frequency does not fit in a block.
    FrequencyTooLow {
        /// The frequency asked for, Hz.
        frequency: f32,
        /// The most sample pairs of a block, `N` of a [`Front`](crate::Front).
        most: u16,
    },
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SampleRate(rate) => {
                write!(
                    f,
                    "sample rate {rate} Hz: it must be a number from 0.001 to 1e12"
                )
            }
            Self::PeriodsTooFew(n) => write!(f, "{n} periods a window: there must be at least 2"),
            Self::PeriodsTooMany { periods, most } => {
                write!(
                    f,
                    "{periods} periods a window: the ring of blocks holds at most {most}"
                )
            }
            Self::Hop => write!(
                f,
                "a hop of 0 blocks: windows must move on by at least 1 block"
            ),
            Self::StartAngle(angle) => {
                write!(f, "start angle {angle} rad: it must lie within ±10000")
            }
            Self::Rails([low, high]) => {
                write!(
                    f,
                    "rails {low} and {high}: the first must lie below the second"
                )
            }
            Self::Resolution(value) => {
                write!(f, "resolution {value}: it must be a positive number")
            }
            Self::Frequency(frequency) => {
                write!(
                    f,
                    "frequency {frequency} Hz: it must be a positive number, and at most 0.4 of the sample rate"
                )
            }
            Self::GainRatio(ratio) => write!(f, "gain ratio {ratio}: it must lie within 0.1 to 10"),
            Self::Skew(skew) => write!(f, "skew {skew} s: it must lie within ±0.001 s"),
            Self::PickOffAngle(angle) => {
                write!(f, "pick-off angle {angle} rad: it must lie within ±0.3")
            }
            Self::HumPeriods { periods, least } => {
                write!(
                    f,
                    "{periods} periods a window: with hum there must be at least {least}"
                )
            }
            Self::FrequencyTooLow { frequency, most } => {
                write!(
                    f,
                    "frequency {frequency} Hz: a period must have at most {most} sample pairs, the capacity of a block"
                )
            }
        }
    }
}

impl core::error::Error for SettingsError {}
