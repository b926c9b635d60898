//! The blocks of the window in progress.

use super::seen::Seen;

/// Up to `BLOCKS` blocks, in order and in one piece.
#[derive(Debug, Clone)]
pub(crate) struct Gathered<const BLOCKS: usize> {
    seen: [Seen; BLOCKS],
    length: usize,
    /// Blocks still to be left out before the next window begins.
    gap: u16,
}

impl<const BLOCKS: usize> Gathered<BLOCKS> {
    pub(crate) const fn new() -> Self {
        Self {
            seen: [Seen::EMPTY; BLOCKS],
            length: 0,
            gap: 0,
        }
    }

    /// Begins a new window with the next block.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
        self.gap = 0;
    }

    /// The place of the next block, to be filled; `None` if the block is to be left out.
    #[inline]
    pub(crate) fn next(&mut self) -> Option<&mut Seen> {
        if self.gap > 0 {
            self.gap -= 1;
            return None;
        }
        let place = self.seen.get_mut(self.length)?;
        self.length += 1;
        Some(place)
    }

    pub(crate) fn length(&self) -> usize {
        self.length
    }

    pub(crate) fn blocks(&self) -> &[Seen] {
        self.seen.get(..self.length).unwrap_or(&self.seen)
    }

    /// Moves on by `hop` blocks: those that the next window shares with this one are kept.
    pub(crate) fn advance(&mut self, hop: u16) {
        // The first bound is there for the compiler: with it no check is left that could panic.
        let length = self.length.min(BLOCKS);
        let skipped = usize::from(hop).min(length);
        self.gap = hop.saturating_sub(skipped as u16);
        if skipped < length {
            self.seen.copy_within(skipped..length, 0);
        }
        self.length = length - skipped;
    }
}
