//! Checks whether the pipeline is alive, and why the device started.

use antinode_telemetry::Cause;

use crate::settings::STALL_MS;

/// Monitor of arriving pairs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Liveness {
    pairs: u32,
    arrived: bool,
    /// Time of the last arrival of pairs, or of the last request to restart sampling, ms.
    since: u32,
}

impl Liveness {
    /// No pair yet.
    pub const fn new() -> Self {
        Self {
            pairs: 0,
            arrived: false,
            since: 0,
        }
    }

    /// Takes the count of pairs; true if it has changed since the last call.
    pub fn sees(&mut self, pairs: u32) -> bool {
        self.arrived = pairs != self.pairs;
        self.pairs = pairs;
        self.arrived
    }

    /// True if sampling must be restarted: once in every [`STALL_MS`] without pairs.
    pub fn stalled(&mut self, now: u32) -> bool {
        if self.arrived {
            self.since = now;
            return false;
        }
        let stalled = now.wrapping_sub(self.since) >= STALL_MS;
        if stalled {
            self.since = now;
        }
        stalled
    }
}

// Flags of RCC_CSR for the cause of a reset, reference manual RM0090, 7.3.21.
const LPWRRSTF: u32 = 1 << 31;
const WWDGRSTF: u32 = 1 << 30;
const IWDGRSTF: u32 = 1 << 29;
const SFTRSTF: u32 = 1 << 28;
const PORRSTF: u32 = 1 << 27;
const PINRSTF: u32 = 1 << 26;
const BORRSTF: u32 = 1 << 25;

/// Cause of the chip's reset, by RCC_CSR and the note that the firmware itself may have left before it.
///
/// Power-on also sets BORRSTF, and every reset sets PINRSTF, so that the more specific flags are checked first. By default the brown-out
/// reset is off, and every loss of power sets PORRSTF. BORRSTF comes alone if a level is set in the option bytes, see
/// `firmware/docs/wiring.md`; where the supply falls less, the firmware leaves a note of it.
pub const fn cause(csr: u32, noted: Option<Cause>) -> Cause {
    // Memory does not survive a loss of power: a note would be there by chance.
    if csr & PORRSTF != 0 {
        return Cause::PowerOn;
    }
    if csr & (IWDGRSTF | WWDGRSTF) != 0 {
        return Cause::Watchdog;
    }
    match noted {
        Some(cause) => cause,
        None if csr & BORRSTF != 0 => Cause::BrownOut,
        // The firmware leaves a note when it resets itself: without one it was a debug probe.
        None if csr & SFTRSTF != 0 => Cause::Software,
        None if csr & LPWRRSTF != 0 => Cause::Unknown,
        None if csr & PINRSTF != 0 => Cause::ResetPin,
        None => Cause::Unknown,
    }
}

/// The number that encodes a cause over a reset, or 0 if the firmware leaves no note of it.
pub const fn number(cause: Cause) -> u32 {
    match cause {
        Cause::Command => 1,
        Cause::Panic => 2,
        Cause::HardFault => 3,
        Cause::Clock => 4,
        Cause::BrownOut => 5,
        _ => 0,
    }
}

/// The inverse of [`number`]; `None` for other numbers.
pub const fn numbered(number: u32) -> Option<Cause> {
    match number {
        1 => Some(Cause::Command),
        2 => Some(Cause::Panic),
        3 => Some(Cause::HardFault),
        4 => Some(Cause::Clock),
        5 => Some(Cause::BrownOut),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_new_pairs_are_a_sign_of_life() {
        let mut liveness = Liveness::new();
        assert!(!liveness.sees(0));
        assert!(liveness.sees(128));
        assert!(!liveness.stalled(5));
        assert!(!liveness.sees(128));
        assert!(!liveness.stalled(5 + STALL_MS - 1));
        assert!(liveness.stalled(5 + STALL_MS));
        // The same time passes again before the next restart.
        assert!(!liveness.stalled(5 + STALL_MS + 1));
        assert!(liveness.stalled(5 + 2 * STALL_MS));
    }

    #[test]
    fn causes_of_resets_follow_from_flags_and_notes() {
        assert_eq!(
            cause(PORRSTF | BORRSTF | PINRSTF, Some(Cause::Panic)),
            Cause::PowerOn
        );
        assert_eq!(cause(IWDGRSTF | PINRSTF, None), Cause::Watchdog);
        assert_eq!(cause(SFTRSTF | PINRSTF, Some(Cause::Panic)), Cause::Panic);
        // By a debug probe, as after flashing.
        assert_eq!(cause(SFTRSTF | PINRSTF, None), Cause::Software);
        assert_eq!(cause(LPWRRSTF | PINRSTF, None), Cause::Unknown);
        assert_eq!(cause(BORRSTF | PINRSTF, None), Cause::BrownOut);
        assert_eq!(cause(PINRSTF, None), Cause::ResetPin);
        assert_eq!(
            cause(SFTRSTF | PINRSTF, Some(Cause::BrownOut)),
            Cause::BrownOut
        );
        for noted in [
            Cause::Command,
            Cause::Panic,
            Cause::HardFault,
            Cause::Clock,
            Cause::BrownOut,
        ] {
            assert_eq!(numbered(number(noted)), Some(noted));
        }
        // Causes without a note have no number, and other numbers no cause.
        for other in [
            Cause::PowerOn,
            Cause::Software,
            Cause::Watchdog,
            Cause::Converter,
            Cause::Unknown,
        ] {
            assert_eq!(numbered(number(other)), None);
        }
        assert_eq!([0, 6, 7, u32::MAX].map(numbered), [None; 4]);
    }
}
