//! Bytes from the line to the main loop, in a ring that a DMA can fill.

use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

use crate::settings::INBOX;

/// The ring. Bytes that are not taken in time are overwritten, which the checksums of their frames reveal.
pub struct Inbox {
    bytes: [AtomicU8; INBOX],
    /// Index of the next byte to come.
    end: AtomicUsize,
}

impl Inbox {
    /// An empty ring.
    pub const fn new() -> Self {
        Self {
            bytes: [const { AtomicU8::new(0) }; INBOX],
            end: AtomicUsize::new(0),
        }
    }

    /// The memory that a DMA writes to, in circular mode from the first place on.
    pub const fn places(&self) -> &[AtomicU8; INBOX] {
        &self.bytes
    }

    /// Takes the count of places left before the DMA's round ends; 0 means the same as all.
    pub fn left(&self, places: usize) {
        let end = INBOX.wrapping_sub(places) % INBOX;
        self.end.store(end, Ordering::Release);
    }

    /// Adds a byte by software.
    pub fn put(&self, byte: u8) {
        let end = self.end.load(Ordering::Relaxed);
        if let Some(place) = self.bytes.get(end) {
            place.store(byte, Ordering::Relaxed);
        }
        self.end.store((end + 1) % INBOX, Ordering::Release);
    }

    /// The byte at index `at`, which is advanced; `None` if no byte has come yet.
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
