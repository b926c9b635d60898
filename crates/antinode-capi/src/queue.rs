//! Finished blocks on their way from the interrupt to the thread: a ring for one producer and one consumer, without a lock.
//!
//! Loads and stores of words are all it needs, so it serves cores without exclusive access too (Cortex-M0).
#![allow(
    unsafe_code,
    reason = "the two sides share slots; the counters say whose a slot is"
)]

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

use antinode::{Block, Sample};

use crate::capacity::ANTINODE_QUEUE_BLOCKS;

/// Counters run freely; a slot is their value modulo the length.
pub(crate) struct Queue<S: Sample> {
    /// Blocks ever put in; written by the producer only.
    put: AtomicU32,
    /// Blocks ever taken out; written by the consumer only.
    taken: AtomicU32,
    slots: [UnsafeCell<MaybeUninit<Block<S>>>; ANTINODE_QUEUE_BLOCKS],
}

const _: () = assert!(ANTINODE_QUEUE_BLOCKS.is_power_of_two());

impl<S: Sample> Queue<S> {
    /// Writes an empty queue; the slots stay as they are.
    ///
    /// # Safety
    /// `place` is writable and nobody else's.
    pub(crate) unsafe fn write(place: *mut Self) {
        // SAFETY: the caller's contract; a slot may hold anything.
        unsafe {
            (&raw mut (*place).put).write(AtomicU32::new(0));
            (&raw mut (*place).taken).write(AtomicU32::new(0));
        }
    }

    /// An empty queue.
    #[cfg(test)]
    pub(crate) const fn new() -> Self {
        Self {
            put: AtomicU32::new(0),
            taken: AtomicU32::new(0),
            slots: [const { UnsafeCell::new(MaybeUninit::uninit()) }; ANTINODE_QUEUE_BLOCKS],
        }
    }

    /// The slot of a counter's value.
    #[inline]
    fn slot(&self, counter: u32) -> *mut MaybeUninit<Block<S>> {
        self.slots[counter as usize % ANTINODE_QUEUE_BLOCKS].get()
    }

    /// How many blocks wait. From any context, also one that both sides break into.
    pub(crate) fn len(&self) -> u32 {
        waiting(
            || self.put.load(Ordering::Acquire),
            || self.taken.load(Ordering::Acquire),
        )
    }

    /// Blocks ever put in; it wraps. For the producer.
    #[inline]
    pub(crate) fn count(&self) -> u32 {
        self.put.load(Ordering::Relaxed)
    }

    /// Puts a block in; false when the queue is full.
    ///
    /// # Safety
    /// One caller at a time.
    #[inline]
    pub(crate) unsafe fn put(&self, block: &Block<S>) -> bool {
        let put = self.put.load(Ordering::Relaxed);
        if put.wrapping_sub(self.taken.load(Ordering::Acquire)) >= ANTINODE_QUEUE_BLOCKS as u32 {
            return false;
        }
        // SAFETY: the slot is free: the consumer has done with what was in it and reads it no more before `put` moves on.
        unsafe {
            let place = self.slot(put).cast::<Block<S>>();
            // Field by field: each is moved in registers, while a whole block would be a call of memcpy.
            (&raw mut (*place).start).write(block.start);
            (&raw mut (*place).search).write(block.search);
            (&raw mut (*place).layout).write(block.layout);
            (&raw mut (*place).sums).write(block.sums);
            // Where nothing is watched there is nothing to move.
            let watch = &raw mut (*place).watch;
            match block.watch {
                Some(channels) => watch.write(Some(channels)),
                None => watch.write(None),
            }
        }
        self.put.store(put.wrapping_add(1), Ordering::Release);
        true
    }

    /// Looks at the oldest block where it lies, by `look`, and frees its slot; `None` when there is none.
    ///
    /// # Safety
    /// One caller at a time, beside one caller of [`Queue::put`].
    #[inline]
    pub(crate) unsafe fn take<T>(&self, look: impl FnOnce(&Block<S>) -> T) -> Option<T> {
        let taken = self.taken.load(Ordering::Relaxed);
        if taken == self.put.load(Ordering::Acquire) {
            return None;
        }
        // SAFETY: the slot was written before `put` passed it, and the producer leaves it alone until `taken` has.
        let seen = look(unsafe { (*self.slot(taken)).assume_init_ref() });
        self.taken.store(taken.wrapping_add(1), Ordering::Release);
        Some(seen)
    }
}

/// Blocks between two counters that may move on between the looks: of those seen put in, what is not taken yet.
fn waiting(put: impl FnOnce() -> u32, taken: impl FnOnce() -> u32) -> u32 {
    // This order, or entries that came since would count, and more than there is room for.
    let count = put().wrapping_sub(taken());
    // More were taken since than were seen.
    if count > ANTINODE_QUEUE_BLOCKS as u32 {
        0
    } else {
        count
    }
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;
    use antinode::block::Demodulator;
    use antinode::phase::PhaseStep;

    struct Shared(Queue<f32>);

    // SAFETY: as the state of a C program that an interrupt and a thread share.
    unsafe impl Sync for Shared {}

    /// A block that begins at `start`, of a search of the same number.
    fn block(start: u32) -> Block<f32> {
        let step = PhaseStep::from_period(4.0);
        let mut demodulator = Demodulator::<f32, 2>::new(step, 1, u64::from(start), false);
        let block = *demodulator.push([0.0; 2]).unwrap();
        Block {
            search: start,
            ..block
        }
    }

    #[test]
    fn a_full_queue_refuses() {
        let queue = Queue::new();
        for i in 0..ANTINODE_QUEUE_BLOCKS as u32 {
            assert_eq!(queue.len(), i);
            // SAFETY: one thread.
            assert!(unsafe { queue.put(&block(i)) });
        }
        // SAFETY: one thread.
        unsafe {
            assert!(!queue.put(&block(99)));
            assert_eq!(queue.take(|block| block.start), Some(0));
            assert!(queue.put(&block(99)));
        }
    }

    #[test]
    fn a_slot_is_not_free_while_it_is_looked_at() {
        let queue = Queue::new();
        for i in 0..ANTINODE_QUEUE_BLOCKS as u32 {
            // SAFETY: one thread.
            assert!(unsafe { queue.put(&block(i)) });
        }
        // An interrupt that comes meanwhile.
        // SAFETY: one caller of each.
        let seen = unsafe { queue.take(|taken| (queue.put(&block(99)), taken.start)) };
        assert_eq!(seen, Some((false, 0)));
    }

    #[test]
    fn what_waits_is_told_though_both_sides_go_on_between_the_looks() {
        const FULL: u32 = ANTINODE_QUEUE_BLOCKS as u32;
        let (put, taken) = (Cell::new(0u32), Cell::new(0u32));
        // A full queue, of which `since` are solved after the first look, and as many come anew.
        let told = |since: u32| {
            taken.set(u32::MAX - 3);
            put.set(taken.get().wrapping_add(FULL));
            let go_on = || {
                put.set(put.get().wrapping_add(since));
                taken.set(taken.get().wrapping_add(since));
            };
            let look = |counter: &Cell<u32>| {
                let seen = counter.get();
                go_on();
                seen
            };
            waiting(|| look(&put), || look(&taken))
        };
        assert_eq!(
            [0, 5, FULL, FULL + 1, 3 * FULL].map(told),
            [FULL, FULL - 5, 0, 0, 0]
        );
    }

    #[test]
    fn two_threads_lose_nothing() {
        const COUNT: u32 = 100_000;
        let shared = Shared(Queue::new());
        std::thread::scope(|scope| {
            let shared = &shared;
            scope.spawn(move || {
                for i in 0..COUNT {
                    let block = block(i);
                    // SAFETY: the only producer.
                    while !unsafe { shared.0.put(&block) } {
                        std::thread::yield_now();
                    }
                }
            });
            // Counted, not asserted: a consumer that stopped would leave the producer waiting for ever.
            let mut wrong = 0;
            for i in 0..COUNT {
                let block = loop {
                    // SAFETY: the only consumer.
                    match unsafe { shared.0.take(|block| *block) } {
                        Some(block) => break block,
                        None => std::thread::yield_now(),
                    }
                };
                wrong += u32::from((block.search, block.start) != (i, u64::from(i)));
            }
            assert_eq!(wrong, 0);
        });
        assert_eq!(shared.0.len(), 0);
    }
}
