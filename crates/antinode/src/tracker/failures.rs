//! When a wave is given up and a new period searched.

use crate::estimate::Flags;

/// What may be left of a wave's amplitude after a fault.
pub(super) const LEFT: f32 = 0.25;

/// What failed in the last windows: two without a wave or a fit are enough, or eight with little of a wave. Each counts as many blocks as
/// are not in the next one, for a fault is in all windows that overlap there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Failures(u32);

impl Failures {
    pub(super) const NONE: Self = Self(0);
    pub(super) const ENOUGH: Self = Self(u32::MAX);
    /// More windows with little of a wave than these are enough.
    const MOST: u32 = 7;
    /// So many of them is one without a wave.
    const LOSS: u32 = 4;

    /// True where they are enough for windows of `blocks`.
    pub(super) fn are_enough(self, blocks: u16) -> bool {
        self.0 > Self::MOST * u32::from(blocks)
    }

    /// Takes the next window: its flags, whether its fit settled, and whether there is much less of the wave in it than of all else, or than
    /// there was. Noise that was there before is no failure, however much it is. `advance` of its blocks are not in the next one.
    pub(super) fn take(&mut self, flags: Flags, settled: bool, is_little: bool, advance: u16) {
        let weight = if flags.contains(Flags::LOST) || !settled {
            Self::LOSS
        } else {
            u32::from(is_little && flags.contains(Flags::MISFIT))
        };
        let failed = weight * u32::from(advance);
        self.0 = if failed > 0 {
            self.0.saturating_add(failed)
        } else {
            0
        };
    }
}
