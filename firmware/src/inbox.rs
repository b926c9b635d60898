//! Bytes on their way from the line to the main loop: a ring that a DMA can fill.

use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

use crate::settings::INBOX;

/// The ring. Bytes that nobody took in time are overwritten, which their frames' checksums tell.
pub struct Inbox {
    bytes: [AtomicU8; INBOX],
    /// Where the next byte goes.
    end: AtomicUsize,
}

impl Inbox {
    /// No bytes.
    pub const fn new() -> Self {
        Self {
            bytes: [const { AtomicU8::new(0) }; INBOX],
            end: AtomicUsize::new(0),
        }
    }

    /// Where a DMA writes, from the first place on, round and round.
    pub const fn places(&self) -> &[AtomicU8; INBOX] {
        &self.bytes
    }

    /// Says how many places are left before the DMA's round ends: none is as good as all.
    pub fn left(&self, places: usize) {
        let end = INBOX.wrapping_sub(places) % INBOX;
        self.end.store(end, Ordering::Release);
    }

    /// Adds a byte by hand.
    pub fn put(&self, byte: u8) {
        let end = self.end.load(Ordering::Relaxed);
        if let Some(place) = self.bytes.get(end) {
            place.store(byte, Ordering::Relaxed);
        }
        self.end.store((end + 1) % INBOX, Ordering::Release);
    }

    /// The byte at a place, which moves on; `None` where no byte has come yet.
    pub fn take(&self, at: &mut usize) -> Option<u8> {
        if *at == self.end.load(Ordering::Acquire) {
            return None;
        }
        let byte = self.bytes.get(*at)?.load(Ordering::Relaxed);
        *at = (*at + 1) % INBOX;
        Some(byte)
    }
}

impl Default for Inbox {
    fn default() -> Self {
        Self::new()
    }
}
