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

/// What the chip itself tells of its reset.
#[derive(Debug, Clone, Copy, Default)]
pub struct ResetFlags {
    /// Power came on.
    pub power_on: bool,
    /// Either watchdog.
    pub watchdog: bool,
    /// The supply fell below the chip's brown-out level.
    pub brown_out: bool,
    /// The core's own request, by software or a debug probe.
    pub software: bool,
    /// Illegal use of a low-power mode.
    pub low_power: bool,
    /// The reset pin, which every other reset may pull too.
    pub pin: bool,
}

/// Cause of the chip's reset, by its flags and the note that the firmware itself may have left before it.
///
/// Power-on may also raise the brown-out flag, and every reset that of the pin, so that the more specific flags are checked first.
pub const fn cause(flags: ResetFlags, noted: Option<Cause>) -> Cause {
    // Memory does not survive a loss of power: a note would be there by chance.
    if flags.power_on {
        return Cause::PowerOn;
    }
    if flags.watchdog {
        return Cause::Watchdog;
    }
    match noted {
        Some(cause) => cause,
        None if flags.brown_out => Cause::BrownOut,
        // The firmware leaves a note when it resets itself: without one it was a debug probe.
        None if flags.software => Cause::Software,
        None if flags.low_power => Cause::Unknown,
        None if flags.pin => Cause::ResetPin,
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
        // Every reset pulls the pin.
        let pin = ResetFlags {
            pin: true,
            ..ResetFlags::default()
        };
        let (power_on, brown_out) = (true, true);
        let dead = ResetFlags {
            power_on,
            brown_out,
            ..pin
        };
        assert_eq!(cause(dead, Some(Cause::Panic)), Cause::PowerOn);
        let watchdog = ResetFlags {
            watchdog: true,
            ..pin
        };
        assert_eq!(cause(watchdog, None), Cause::Watchdog);
        let software = ResetFlags {
            software: true,
            ..pin
        };
        assert_eq!(cause(software, Some(Cause::Panic)), Cause::Panic);
        // By a debug probe, as after flashing.
        assert_eq!(cause(software, None), Cause::Software);
        let low_power = ResetFlags {
            low_power: true,
            ..pin
        };
        assert_eq!(cause(low_power, None), Cause::Unknown);
        let dipped = ResetFlags { brown_out, ..pin };
        assert_eq!(cause(dipped, None), Cause::BrownOut);
        assert_eq!(cause(pin, None), Cause::ResetPin);
        assert_eq!(cause(pin, Some(Cause::BrownOut)), Cause::BrownOut);
        assert_eq!(cause(ResetFlags::default(), None), Cause::Unknown);
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
