//! When a wave is given up and a new period searched.

use crate::estimate::Flags;

/// What may be left of a wave's amplitude after a fault.
pub(super) const LEFT: f32 = 0.25;

/// What failed in the last windows: two without a wave are enough, or eight with little of one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Failures(u8);

impl Failures {
    pub(super) const NONE: Self = Self(0);
    pub(super) const ENOUGH: Self = Self(8);
    /// That of a window without a wave.
    const LOSS: u8 = 4;

    pub(super) fn are_enough(self) -> bool {
        self.0 >= Self::ENOUGH.0
    }

    /// Takes the next window: its flags, whether its fit settled, and whether there is much less of the wave in it than of all else, or than
    /// there was. Noise that was there before is no failure, however much it is.
    pub(super) fn take(&mut self, flags: Flags, settled: bool, is_little: bool) {
        self.0 = if flags.contains(Flags::LOST) || !settled {
            self.0.saturating_add(Self::LOSS)
        } else if is_little && flags.contains(Flags::MISFIT) {
            self.0.saturating_add(1)
        } else {
            0
        };
    }
}
