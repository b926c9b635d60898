//! Whether the pipeline lives, and why the device started.

use antinode_telemetry::Cause;

use crate::settings::STALL_MS;

/// Watches whether pairs arrive.
#[derive(Debug, Clone, Copy, Default)]
pub struct Liveness {
    pairs: u32,
    fresh: bool,
    /// When pairs last arrived, or sampling was last to be started anew, ms.
    since: u32,
}

impl Liveness {
    /// No pair yet.
    pub const fn new() -> Self {
        Self {
            pairs: 0,
            fresh: false,
            since: 0,
        }
    }

    /// Takes the count of pairs; true where it has moved since it was last asked.
    pub fn sees(&mut self, pairs: u32) -> bool {
        self.fresh = pairs != self.pairs;
        self.pairs = pairs;
        self.fresh
    }

    /// True where sampling must be started anew: once in every [`STALL_MS`] without pairs.
    pub fn stalled(&mut self, now: u32) -> bool {
        if self.fresh {
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

/// The flags of RCC_CSR that tell a reset's cause, reference manual RM0090, 7.3.21.
const LPWRRSTF: u32 = 1 << 31;
const WWDGRSTF: u32 = 1 << 30;
const IWDGRSTF: u32 = 1 << 29;
const SFTRSTF: u32 = 1 << 28;
const PORRSTF: u32 = 1 << 27;
const PINRSTF: u32 = 1 << 26;
const BORRSTF: u32 = 1 << 25;

/// Why the chip was reset, by RCC_CSR; `noted` is what the firmware itself left behind, where it did.
///
/// Power-on sets BORRSTF and every reset sets PINRSTF, so the special ones are asked first. From the factory the brown-out reset is off:
/// then every loss of power sets PORRSTF. BORRSTF comes alone where a level is set in the option bytes, see `firmware/docs/wiring.md`.
pub const fn cause(csr: u32, noted: Option<Cause>) -> Cause {
    // Memory survives no loss of power: what it then seems to say is chance.
    if csr & PORRSTF != 0 {
        return Cause::PowerOn;
    }
    if csr & (IWDGRSTF | WWDGRSTF) != 0 {
        return Cause::Watchdog;
    }
    match noted {
        Some(cause) => cause,
        None if csr & BORRSTF != 0 => Cause::BrownOut,
        // The firmware notes why it resets itself: this was a debug probe.
        None if csr & SFTRSTF != 0 => Cause::Software,
        None if csr & LPWRRSTF != 0 => Cause::Unknown,
        None if csr & PINRSTF != 0 => Cause::ResetPin,
        None => Cause::Unknown,
    }
}

/// The number that stands for a cause over a reset; only those that the firmware notes have one.
pub const fn number(cause: Cause) -> u32 {
    match cause {
        Cause::Command => 1,
        Cause::Panic => 2,
        Cause::HardFault => 3,
        Cause::Clock => 4,
        _ => 0,
    }
}

/// The cause of [`number`]; `None` for any other.
pub const fn numbered(number: u32) -> Option<Cause> {
    match number {
        1 => Some(Cause::Command),
        2 => Some(Cause::Panic),
        3 => Some(Cause::HardFault),
        4 => Some(Cause::Clock),
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
        // Sampling is given as long again before it is started once more.
        assert!(!liveness.stalled(5 + STALL_MS + 1));
        assert!(liveness.stalled(5 + 2 * STALL_MS));
    }

    #[test]
    fn causes_of_resets() {
        assert_eq!(
            cause(PORRSTF | BORRSTF | PINRSTF, Some(Cause::Panic)),
            Cause::PowerOn
        );
        assert_eq!(cause(IWDGRSTF | PINRSTF, None), Cause::Watchdog);
        assert_eq!(cause(SFTRSTF | PINRSTF, Some(Cause::Panic)), Cause::Panic);
        // What a probe leaves behind it, as after flashing.
        assert_eq!(cause(SFTRSTF | PINRSTF, None), Cause::Software);
        assert_eq!(cause(LPWRRSTF | PINRSTF, None), Cause::Unknown);
        assert_eq!(cause(BORRSTF | PINRSTF, None), Cause::BrownOut);
        assert_eq!(cause(PINRSTF, None), Cause::ResetPin);
        for noted in [Cause::Command, Cause::Panic, Cause::HardFault, Cause::Clock] {
            assert_eq!(numbered(number(noted)), Some(noted));
        }
        // What no firmware notes has no number, and no other number is a cause.
        for other in [
            Cause::PowerOn,
            Cause::Software,
            Cause::Watchdog,
            Cause::Converter,
            Cause::Unknown,
        ] {
            assert_eq!(numbered(number(other)), None);
        }
        assert_eq!([0, 5, 6, u32::MAX].map(numbered), [None; 4]);
    }
}
