//! Configuration of the chip. Every value of these types is valid: combinations that the chip lacks cannot be expressed.

use crate::alert::Thresholds;
use crate::register::{ALERT_ENABLE, BOOST, EXTERNAL_REFERENCE, RATIO_SHIFT, ROLLING};
use crate::timing::{
    CONVERSION_NS, FIRST_OVERSAMPLE_NS, NEXT_OVERSAMPLE_NS, POWER_UP_EXTERNAL_MS,
    POWER_UP_INTERNAL_MS,
};

/// Settings of the chip. The defaults are those after a reset, except for 1-wire mode: internal reference, no oversampling, no alert.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// Source of the reference voltage.
    pub reference: Reference,
    /// Averaging on the chip.
    pub oversampling: Oversampling,
    /// Codes beyond which the chip raises an alert: in its register, and by pulling the pin SDOB/ALERT low from the end of a
    /// conversion to the next falling edge of CS. With `None` the pin stays SDOB and the register shows no alert.
    pub alert: Option<Thresholds>,
}

impl Config {
    /// The data of CONFIGURATION1.
    pub(crate) const fn configuration1(&self) -> u16 {
        let reference = match self.reference {
            Reference::Internal => 0,
            Reference::External => EXTERNAL_REFERENCE,
        };
        let alert = if self.alert.is_some() {
            ALERT_ENABLE
        } else {
            0
        };
        reference | alert | self.oversampling.configuration1()
    }
}

/// The source of VREF.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reference {
    /// The chip's own 2.5 V.
    #[default]
    Internal,
    /// 2.5 V to 3.3 V at the pin REFIO.
    External,
}

impl Reference {
    /// Wait for it and the supply to settle, milliseconds.
    pub(crate) const fn power_up_ms(self) -> u32 {
        match self {
            Self::Internal => POWER_UP_INTERNAL_MS,
            Self::External => POWER_UP_EXTERNAL_MS,
        }
    }
}

/// Averaging on the chip. `boost` is the resolution boost: results of 18 bits, for [`crate::Ad7380::read_boosted_pair`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Oversampling {
    /// One conversion a frame.
    #[default]
    Off,
    /// Each falling edge of CS starts `ratio` conversions one after the other, and the result is their mean.
    Normal {
        /// The number of conversions.
        ratio: Ratio,
        /// 18 bits instead of 16.
        boost: bool,
    },
    /// Each falling edge of CS starts one conversion, and the result is the mean of the last `ratio` ones.
    Rolling {
        /// The number of conversions.
        ratio: RollingRatio,
        /// 18 bits instead of 16.
        boost: bool,
    },
}

impl Oversampling {
    /// The time from the falling edge of CS to the end of the last conversion that it starts, in nanoseconds: CS must not fall again
    /// before. For normal averages it is the wait of Linux's driver with one data line, longer than the data sheet's figure.
    pub const fn conversion_ns(self) -> u32 {
        match self {
            Self::Normal { ratio, .. } => {
                FIRST_OVERSAMPLE_NS + NEXT_OVERSAMPLE_NS * ((1 << ratio as u32) - 1)
            }
            Self::Off | Self::Rolling { .. } => CONVERSION_NS,
        }
    }

    /// True if results have 18 bits.
    pub const fn boost(self) -> bool {
        match self {
            Self::Off => false,
            Self::Normal { boost, .. } | Self::Rolling { boost, .. } => boost,
        }
    }

    /// Count of frames after a reset with results from conversions before it.
    pub(crate) const fn stale_frames(self) -> u32 {
        match self {
            Self::Off | Self::Normal { .. } => 1,
            Self::Rolling { ratio, .. } => 1 << ratio as u32,
        }
    }

    const fn configuration1(self) -> u16 {
        let mode = match self {
            Self::Off => 0,
            Self::Normal { ratio, .. } => (ratio as u16) << RATIO_SHIFT,
            Self::Rolling { ratio, .. } => ROLLING | (ratio as u16) << RATIO_SHIFT,
        };
        if self.boost() { mode | BOOST } else { mode }
    }
}

/// Conversions in a normal average. The discriminant is the ratio's logarithm to base 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ratio {
    /// Two.
    X2 = 1,
    /// Four.
    X4 = 2,
    /// Eight.
    X8 = 3,
    /// Sixteen.
    X16 = 4,
    /// Thirty-two.
    X32 = 5,
}

/// Conversions in a rolling average: the chip remembers eight at most. The discriminant is the ratio's logarithm to base 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RollingRatio {
    /// Two.
    X2 = 1,
    /// Four.
    X4 = 2,
    /// Eight.
    X8 = 3,
}
