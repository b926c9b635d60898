//! The out-of-range indicator: its thresholds and its register.

/// Range of codes outside which the chip raises an alert, the same for A and B.
///
/// The chip compares every conversion, before any averaging. It keeps 12 of a threshold's 16 bits: a low one ends in 0x0, a high
/// one in 0xF.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Thresholds {
    low: i16,
    high: i16,
}

impl Thresholds {
    /// Within 16 codes of either rail: −32 752 to 32 751 is in range.
    pub const SATURATION: Self = Self {
        low: -32_752,
        high: 32_751,
    };

    /// Every code is in range: the chip's own after a reset.
    pub const FULL: Self = Self {
        low: i16::MIN,
        high: i16::MAX,
    };

    /// Thresholds for an alert below `low` and above `high`, with `low` rounded down and `high` up to values that the chip can hold.
    ///
    /// # Errors
    ///
    /// If `low` is above `high`.
    pub const fn new(low: i16, high: i16) -> Result<Self, ThresholdsError> {
        if low > high {
            return Err(ThresholdsError { low, high });
        }
        Ok(Self {
            low: low & !0xF,
            high: high | 0xF,
        })
    }

    /// The smallest code in range, a multiple of 16.
    pub const fn low(self) -> i16 {
        self.low
    }

    /// The largest code in range, 15 above a multiple of 16.
    pub const fn high(self) -> i16 {
        self.high
    }

    /// The data of ALERT_LOW_THRESHOLD and ALERT_HIGH_THRESHOLD.
    pub(crate) const fn registers(self) -> [u16; 2] {
        [self.low as u16 >> 4, self.high as u16 >> 4]
    }
}

/// The low threshold is above the high one: nothing would be in range. Swap them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThresholdsError {
    /// The low threshold asked for.
    pub low: i16,
    /// The high threshold asked for.
    pub high: i16,
}

impl core::fmt::Display for ThresholdsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "the low threshold, {}, must not be above the high one, {}",
            self.low, self.high
        )
    }
}

impl core::error::Error for ThresholdsError {}

/// Content of the register ALERT. Its bits are sticky (data sheet): they stay until they are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Alert {
    /// A conversion of `[A, B]` was above the high threshold.
    pub high: [bool; 2],
    /// A conversion of `[A, B]` was below the low threshold.
    pub low: [bool; 2],
    /// The chip rejected a write for its CRC: never, as this driver leaves the CRC off.
    pub crc_failed: bool,
    /// The chip did not load its factory settings at power-up: its results must not be trusted until a hard reset, as in
    /// [`crate::Ad7380::new`], brings this back to `false`.
    pub setup_failed: bool,
}

impl Alert {
    /// Decodes the register's 12 bits.
    pub const fn from_register(value: u16) -> Self {
        const fn bit(value: u16, n: u16) -> bool {
            value >> n & 1 == 1
        }
        Self {
            high: [bit(value, 1), bit(value, 5)],
            low: [bit(value, 0), bit(value, 4)],
            crc_failed: bit(value, 9),
            setup_failed: bit(value, 8),
        }
    }

    /// True for those of `[A, B]` that left the range on either side, that is saturated if the thresholds are [`Thresholds::SATURATION`].
    pub const fn out_of_range(self) -> [bool; 2] {
        [self.high[0] || self.low[0], self.high[1] || self.low[1]]
    }
}
