//! The chip's registers and the 16-bit frames that access them.

/// A register of the chip: an address of 3 bits, 12 bits of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Register {
    /// CONFIGURATION1: oversampling, CRC, alert, resolution, reference, power.
    Configuration1 = 1,
    /// CONFIGURATION2: the number of data lines, and the resets.
    Configuration2 = 2,
    /// ALERT: which channel left its range. Read only.
    Alert = 3,
    /// ALERT_LOW_THRESHOLD: the upper 12 of the threshold's 16 bits.
    AlertLowThreshold = 4,
    /// ALERT_HIGH_THRESHOLD: the upper 12 of the threshold's 16 bits.
    AlertHighThreshold = 5,
}

impl Register {
    /// The frame that writes the lower 12 bits of `value`: bit 15 means write, bits 14 to 12 are the address.
    pub const fn write_frame(self, value: u16) -> [u8; 2] {
        (1 << 15 | (self as u16) << 12 | value & 0xFFF).to_be_bytes()
    }

    /// The frame that requests this register; the chip answers in the next frame.
    pub const fn read_frame(self) -> [u8; 2] {
        ((self as u16) << 12).to_be_bytes()
    }

    /// The 12 bits of data in the answer to a [`Self::read_frame`].
    pub const fn value(answer: [u8; 2]) -> u16 {
        u16::from_be_bytes(answer) & 0xFFF
    }

    /// Bits that must read as written, without reserved bits and the reset field, which is a command.
    pub(crate) const fn read_back_mask(self) -> u16 {
        match self {
            Self::Configuration1 => 0x3FF,
            Self::Configuration2 => ONE_WIRE,
            _ => 0xFFF,
        }
    }
}

/// CONFIGURATION1, OS_MODE: rolling instead of normal average.
pub(crate) const ROLLING: u16 = 1 << 9;
/// CONFIGURATION1, OSR: lowest bit of the logarithm of the oversampling ratio.
pub(crate) const RATIO_SHIFT: u16 = 6;
/// CONFIGURATION1, ALERT_EN: the pin SDOB is the alert.
pub(crate) const ALERT_ENABLE: u16 = 1 << 3;
/// CONFIGURATION1, RES: two more bits a result.
pub(crate) const BOOST: u16 = 1 << 2;
/// CONFIGURATION1, REFSEL: external reference.
pub(crate) const EXTERNAL_REFERENCE: u16 = 1 << 1;
/// CONFIGURATION2, SDO: both results on SDOA.
pub(crate) const ONE_WIRE: u16 = 1 << 8;
/// CONFIGURATION2, RESET: averages and ALERT are cleared, the other registers stay.
pub(crate) const SOFT_RESET: u16 = 0x3C;
/// CONFIGURATION2, RESET: everything is reset.
pub(crate) const HARD_RESET: u16 = 0xFF;
