//! Decides when a wave is given up and a new period is searched for.

use crate::estimate::Flags;

/// Share of its last clean amplitude below which little is left of a wave.
pub(super) const LITTLE: f32 = 0.25;

/// Failures of the last windows in a row: two without a wave or a settled fit are enough to give it up, or eight with little of it. Each
/// window counts by the blocks that the next one does not share, for a fault is in all windows that overlap it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Failures(u32);

impl Failures {
    pub(super) const NONE: Self = Self(0);
    pub(super) const ENOUGH: Self = Self(u32::MAX);
    /// Most windows with little of a wave that are not yet enough.
    const MAX: u32 = 7;
    /// Weight of a window without a wave, in windows with little of one.
    const LOSS: u32 = 4;

    /// True if they are enough to give up the wave, with windows of `blocks`.
    pub(super) fn are_enough(self, blocks: u16) -> bool {
        self.0 > Self::MAX * u32::from(blocks)
    }

    /// Takes the next window: its flags, whether its fit settled, and whether it has little of the wave, compared with all else or with
    /// before. Noise that was there before is no failure, however much it is. `advance` of its blocks are not in the next one.
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
