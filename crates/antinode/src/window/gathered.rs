//! The blocks of the window in progress.

use super::seen::Seen;

/// Counts the blocks at the start of a memory for them, which are in order and in one piece.
#[derive(Debug, Clone)]
pub(crate) struct Gathered {
    length: usize,
    /// Blocks still to be left out before the next window begins.
    gap: u16,
}

impl Gathered {
    pub(crate) const fn new() -> Self {
        Self { length: 0, gap: 0 }
    }

    /// Begins a new window with the next block.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
        self.gap = 0;
    }

    /// The place of the next block, to be filled; `None` if the block is to be left out.
    #[inline]
    pub(crate) fn next<'s>(&mut self, seen: &'s mut [Seen]) -> Option<&'s mut Seen> {
        if self.gap > 0 {
            self.gap -= 1;
            return None;
        }
        let place = seen.get_mut(self.length)?;
        self.length += 1;
        Some(place)
    }

    pub(crate) fn length(&self) -> usize {
        self.length
    }

    pub(crate) fn blocks<'s>(&self, seen: &'s [Seen]) -> &'s [Seen] {
        seen.get(..self.length).unwrap_or(seen)
    }

    /// Moves on by `hop` blocks: those that the next window shares with this one are kept.
    pub(crate) fn advance(&mut self, seen: &mut [Seen], hop: u16) {
        // The first bound is there for the compiler: with it no check is left that could panic.
        let length = self.length.min(seen.len());
        let skipped = usize::from(hop).min(length);
        self.gap = hop.saturating_sub(skipped as u16);
        if let Some(kept) = seen.get_mut(..length)
            && skipped < kept.len()
        {
            kept.copy_within(skipped.., 0);
        }
        self.length = length - skipped;
    }
}
