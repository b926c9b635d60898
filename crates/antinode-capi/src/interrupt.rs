//! The interrupt's side of a state: samples become queued blocks.
#![allow(
    unsafe_code,
    reason = "the front is written in place, and the caller's contract is handed on to the queue"
)]

use core::sync::atomic::Ordering;

use antinode::{Sample, SamplePair, Settings};
use antinode_capi_slow::{Front, Slow};

use crate::state::Shared;
use crate::status::Status;

/// Pairs converted to one form at a time, on the stack.
pub(crate) const AT_ONCE: usize = 64;
/// The same during the search, whose calls are deep: more would take stack, and save little beside its hundreds of instructions a pair.
const SEARCHED_AT_ONCE: usize = 16;

/// Pairs aligned to four bytes: pairs of codes are read as words, and a core may trap unaligned words.
#[repr(align(4))]
pub(crate) struct Words<T>(pub T);

/// The part of a state that belongs to the interrupt alone.
pub(crate) struct Interrupt<S: Sample> {
    front: Front<S>,
}

impl<S: Slow> Interrupt<S> {
    /// Writes a front that searches.
    ///
    /// # Safety
    /// `place` is writable and nobody else's.
    #[inline(never)]
    pub(crate) unsafe fn write(place: *mut Self, settings: Settings) -> Result<(), Status> {
        // `UNSET` is all zeros, so it is cleared in place and never passes over the stack.
        // SAFETY: the caller's contract.
        let interrupt = unsafe {
            (&raw mut (*place).front).write(Front::UNSET);
            &mut *place
        };
        interrupt.front.configure(settings)?;
        Ok(())
    }

    /// Searches anew if the thread has asked for it.
    #[inline]
    fn obey(&mut self, shared: &Shared<S>) {
        // Relaxed order will do: the number is all that the thread passes.
        let wanted = shared.wanted.load(Ordering::Relaxed);
        if wanted != self.front.search_number() {
            self.search_anew(shared, wanted);
        }
    }

    /// Searches anew under this number. Rare, so its code is kept out of the pushes.
    #[cold]
    #[inline(never)]
    fn search_anew(&mut self, shared: &Shared<S>, wanted: u32) {
        S::search_wanted(&mut self.front, wanted);
        self.tell(shared);
    }

    /// Takes one pair and queues the block that it finishes.
    ///
    /// # Safety
    /// One caller at a time.
    #[inline]
    pub(crate) unsafe fn push_one(&mut self, shared: &Shared<S>, pair: [S; 2]) -> Status {
        self.obey(shared);
        if self.front.is_searching() {
            self.search_in(shared, &[pair]);
            return Status::Ok;
        }
        let Some(block) = self.front.push(pair) else {
            return Status::Ok;
        };
        let before = shared.counts();
        // SAFETY: the caller is the only producer.
        unsafe { shared.queue_block(block) };
        shared.status_since(before)
    }

    /// Takes all pairs and queues the blocks that they finish. Compiled once for each form of pairs, with the sums inlined.
    ///
    /// # Safety
    /// One caller at a time.
    #[inline(never)]
    pub(crate) unsafe fn push<P: SamplePair<S>>(
        &mut self,
        shared: &Shared<S>,
        mut pairs: &[P],
    ) -> Status {
        self.obey(shared);
        let before = shared.counts();
        while !pairs.is_empty() {
            let (taken, block) = if self.front.is_searching() {
                (self.search_some(shared, pairs), None)
            } else {
                self.front.push_slice(pairs)
            };
            if let Some(block) = block {
                // SAFETY: the caller is the only producer.
                unsafe { shared.queue_block(block) };
            }
            pairs = pairs.get(taken..).unwrap_or(&[]);
        }
        shared.status_since(before)
    }

    /// Searches for a period in the first pairs; returns how many it took. A function of its own, so that once the period is known nothing
    /// is paid for it.
    #[inline(never)]
    fn search_some<P: SamplePair<S>>(&mut self, shared: &Shared<S>, pairs: &[P]) -> usize {
        let mut buffer = Words([[S::default(); 2]; SEARCHED_AT_ONCE]);
        let mut count = 0;
        for (place, pair) in buffer.0.iter_mut().zip(pairs) {
            *place = pair.pair();
            count += 1;
        }
        self.search_in(shared, buffer.0.get(..count).unwrap_or(&[]))
    }

    /// As [`Self::search_some`], for pairs that need no conversion.
    fn search_in(&mut self, shared: &Shared<S>, pairs: &[[S; 2]]) -> usize {
        let taken = S::search(&mut self.front, pairs);
        self.tell(shared);
        taken
    }

    fn tell(&self, shared: &Shared<S>) {
        let searching = u32::from(self.front.is_searching());
        shared.searching.store(searching, Ordering::Relaxed);
    }

    pub(crate) fn skip(&mut self, shared: &Shared<S>, count: u32) {
        self.obey(shared);
        S::skip(&mut self.front, count);
    }
}
