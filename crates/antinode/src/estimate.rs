//! The result of a window: the wave's parameters and flags.

use core::fmt::{self, Alignment, Write};
use core::ops::{BitAnd, BitOr, BitOrAssign};

/// What is wrong or noteworthy about a window. A clean window has none.
#[derive(Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Flags(u16);

impl Flags {
    /// Samples at the converter's rail, or flattened crests, or the third harmonic that a limiter leaves: amplitudes are wrong. Near 3 and
    /// 4 samples a period only known [rails](crate::Settings::rails) tell.
    pub const CLIPPED: Self = Self(1);
    /// No significant wave: the other numbers mean nothing.
    pub const LOST: Self = Self(1 << 1);
    /// The phase does not continue from the last window without [`LOST`](Self::LOST), [`MISFIT`](Self::MISFIT),
    /// [`DEAD_CHANNEL`](Self::DEAD_CHANNEL) and [`NOT_FINITE`](Self::NOT_FINITE): samples are missing since that one or within this. Half
    /// of the jumps that exceed 0.02 rad by 20 of the deviations stated are flagged, and all that exceed it by 30; within a window, where
    /// [`MISFIT`](Self::MISFIT) may stand instead, these limits are 50 and 70.
    pub const PHASE_JUMP: Self = Self(1 << 2);
    /// Amplitude, angle or offset stepped between the window before and this one. Half of the steps that exceed 0.2 % of a_A or 2 mrad by
    /// 20 of the deviations stated are flagged, and all that exceed it by 30, or by 36 and 54 if a hop leaves a gap as long as a window,
    /// and more in proportion if it is longer. In the middle of a window, where [`MISFIT`](Self::MISFIT) may stand instead, these limits are
    /// 25 and 45 deviations for an amplitude, and 60 and 85 for the angle, where a step looks like a turn; a tenth of a window from its ends
    /// they are 35 and 55 for both. In windows of 10 to 16 pairs, 0.4 % of a_A takes the place of 0.2 %. An offset that goes on moving as
    /// it did over the windows before wanders, and does not step.
    pub const STEP: Self = Self(1 << 3);
    /// |a_B| ≈ a_A: the pattern is circular, and the angle has no meaning.
    pub const CIRCULAR: Self = Self(1 << 4);
    /// The samples are not one wave with steady rates plus noise: a step, a dropout, a second tone within the window.
    pub const MISFIT: Self = Self(1 << 5);
    /// One pick-off gave one and the same value for the whole window, though before its wave was larger than a step of the converter, if
    /// that is [known](crate::Settings::resolution), or lost its wave while the other kept it. Half of such losses are flagged if the wave
    /// lost exceeds 0.4 % of a_A by 20 deviations of an amplitude between windows, or by 30 within one, and all if it does by 30 or 55.
    /// After a new search a dead pick-off looks like a pattern on the other's axis, and is not flagged.
    pub const DEAD_CHANNEL: Self = Self(1 << 6);
    /// First window after a lost wave was searched for, or after a gap, misfits or circular windows in which the pattern may have turned by
    /// a quarter turn more or less: the angle is known modulo π/2 only. Also the first window after a second search, because a disturbed
    /// start had misled the first, and after a change of calibration or settings, unless it is the first of all, or the change was by
    /// `configure`, which begins at the start angle. The flag stands up to and in the first window without a misfit, whose angle later
    /// windows continue.
    pub const REACQUIRED: Self = Self(1 << 7);
    /// A sample is NaN or infinite, or so large that its square is infinite.
    pub const NOT_FINITE: Self = Self(1 << 8);

    const NAMES: [&'static str; 9] = [
        "clipped",
        "lost",
        "phase_jump",
        "step",
        "circular",
        "misfit",
        "dead_channel",
        "reacquired",
        "not_finite",
    ];

    /// No flag.
    pub const fn empty() -> Self {
        Self(0)
    }

    /// True when no flag stands.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True when every flag of `other` stands.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// True when any flag of `other` stands.
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Both sets together, as `|` gives them.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// This set without the flags of `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// This set, with `other` added when `condition` holds.
    pub(crate) fn with_if(self, condition: bool, other: Self) -> Self {
        if condition { self.with(other) } else { self }
    }

    /// The names of the flags that stand, in the order of the constants: each is its constant's in small letters, such as `phase_jump`.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let names = Self::NAMES.into_iter().enumerate();
        names.filter_map(move |(bit, name)| (self.0 >> bit & 1 == 1).then_some(name))
    }

    /// The flag of this name, as [`names`](Self::names) gives it.
    pub fn from_name(name: &str) -> Option<Self> {
        let bit = Self::NAMES.iter().position(|one| *one == name)?;
        Some(Self(1 << bit))
    }

    /// The flags as bits: bit 0 is the first constant above, and so on.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The flags of [`Flags::bits`]; bits that stand for no flag are dropped.
    pub const fn from_bits_truncate(bits: u16) -> Self {
        Self(bits & ((1 << Self::NAMES.len()) - 1))
    }
}

impl BitOr for Flags {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.with(other)
    }
}

impl BitOrAssign for Flags {
    fn bitor_assign(&mut self, other: Self) {
        *self = self.with(other);
    }
}

impl BitAnd for Flags {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl fmt::Display for Flags {
    /// The [`names`](Self::names) joined by `+`; nothing when clean. Width, fill and alignment are as those of text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = self.names().map(|name| name.len() + 1).sum::<usize>();
        let (fill, room) = (f.fill(), f.width().unwrap_or(0));
        let room = room.saturating_sub(length.saturating_sub(1));
        let before = match f.align() {
            Some(Alignment::Right) => room,
            Some(Alignment::Center) => room / 2,
            _ => 0,
        };
        (0..before).try_for_each(|_| f.write_char(fill))?;
        let mut join = "";
        for name in self.names() {
            f.write_str(join)?;
            f.write_str(name)?;
            join = "+";
        }
        (before..room).try_for_each(|_| f.write_char(fill))
    }
}

impl fmt::Debug for Flags {
    /// As [`Display`](fmt::Display), in `Flags()`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Flags({self})")
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Flags {
    /// As [`Display`](fmt::Display).
    fn format(&self, f: defmt::Formatter<'_>) {
        let mut join = "";
        for name in self.names() {
            defmt::write!(f, "{=str}{=str}", join, name);
            join = "+";
        }
    }
}

/// The wave over one window, at the window's middle. Amplitudes, offsets and residual are in input units.
///
/// Each `_std` is one standard deviation, from how well the window's samples determine the value and from their noise. The noise is taken
/// from the window's own residual and from the clean windows before, which together count up to twice as much as the window itself (more if
/// it has few samples), and less if they do not agree with it. When noise suddenly halves, the first two windows state a third too much;
/// when it grows, they state a tenth too little.
///
/// Of a window without a wave, [`Flags::LOST`], no number means anything, and some may be NaN or infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Estimate {
    /// Index in the stream of the window's first sample pair.
    pub start: u64,
    /// Sample pairs in the window.
    pub samples: u32,
    /// Time of the window's middle, s from the stream's first sample, as if every pair had come at the present sample rate.
    pub time: f64,
    /// a_A, amplitude of the main standing wave, > 0.
    pub main_amplitude: f32,
    /// a_B, amplitude of the quadrature wave, signed, |a_B| ≤ a_A.
    pub quadrature_amplitude: f32,
    /// θ_A, pattern angle in rad: it begins at the value nearest to the start angle, and is continued from window to window. If it leaves
    /// ±3.37·10⁹, which are 2³¹ quarter turns, it goes on from the other end.
    pub angle: f64,
    /// α in rad, (−π, π]: the main wave is a_A cos(2πf·(t − `time`) − α).
    pub phase: f32,
    /// f, resonant frequency in Hz.
    pub frequency: f64,
    /// θ̇, precession of the pattern in rad/s, from this window alone.
    pub angle_rate: f32,
    /// −ȧ_A/a_A in 1/s: positive while the wave decays.
    pub decay_rate: f32,
    /// Offsets of the raw S_C and S_D; in white noise their standard deviation is `residual_rms`/√`samples`, and up to 20 % more in the
    /// shortest windows.
    pub offsets: [f32; 2],
    /// Standard deviation of a_A.
    pub main_amplitude_std: f32,
    /// Standard deviation of a_B.
    pub quadrature_amplitude_std: f32,
    /// Standard deviation of θ_A, rad.
    pub angle_std: f32,
    /// Standard deviation of α, rad.
    pub phase_std: f32,
    /// Standard deviation of f, Hz. In a wave's first window the pattern has to be taken to be at rest: if it turns, rms errors may be up
    /// to twice this with a quadrature of up to 0.7 a_A, and six times at 0.95 a_A, single ones up to 10 and 60 times.
    pub frequency_std: f32,
    /// Standard deviation of θ̇, rad/s.
    pub angle_rate_std: f32,
    /// Standard deviation of the decay rate, 1/s.
    pub decay_rate_std: f32,
    /// Rms of what the wave does not explain, per sample and channel, as seen about the wave's frequency: it equals the noise if that is
    /// white.
    pub residual_rms: f32,
    /// What is wrong; empty when clean.
    pub flags: Flags,
}

impl Estimate {
    /// Index in the stream of the sample pair after the window's last.
    pub const fn end(&self) -> u64 {
        self.start.wrapping_add(self.samples as u64)
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn bits_give_their_flags_back() {
        let mut flags = Flags::CLIPPED;
        flags |= Flags::NOT_FINITE;
        assert_eq!(flags, Flags::CLIPPED.with(Flags::NOT_FINITE));
        assert_eq!(Flags::from_bits_truncate(flags.bits()), flags);
        assert_eq!(flags.to_string(), "clipped+not_finite");
        assert_eq!(std::format!("{flags:?}"), "Flags(clipped+not_finite)");
        assert_eq!(flags & Flags::CLIPPED, Flags::CLIPPED);
        assert!((flags & Flags::LOST).is_empty());
        for flags in [Flags::empty(), Flags::LOST, flags] {
            let text = flags.to_string();
            assert_eq!(std::format!("{flags:20}|"), std::format!("{text:20}|"));
            assert_eq!(std::format!("{flags:->9}"), std::format!("{text:->9}"));
            assert_eq!(std::format!("{flags:^7}"), std::format!("{text:^7}"));
        }
        assert!(flags.names().eq(["clipped", "not_finite"]));
        // All bits that have a name are kept, and no others.
        assert_eq!(Flags::from_bits_truncate(u16::MAX).bits(), 0x1ff);
        assert!(Flags::from_bits_truncate(0xfe00).is_empty());
    }
}
