//! The queue of finished blocks from the interrupt to the thread: a ring for one producer and one consumer, without a lock.
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

/// A ring of blocks. Its counters run freely; a counter modulo the ring's length is a slot.
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

    /// The slot that a counter points to.
    #[inline]
    fn slot(&self, counter: u32) -> *mut MaybeUninit<Block<S>> {
        self.slots[counter as usize % ANTINODE_QUEUE_BLOCKS].get()
    }

    /// Blocks that wait. Callable from any context, even one that both sides may interrupt.
    pub(crate) fn len(&self) -> u32 {
        waiting(
            || self.put.load(Ordering::Acquire),
            || self.taken.load(Ordering::Acquire),
        )
    }

    /// Blocks ever put in; it wraps. For the producer only.
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
        // SAFETY: the slot is free: the consumer has finished with what was in it, and reads it again only after `put` has moved on.
        unsafe {
            let place = self.slot(put).cast::<Block<S>>();
            // Field by field, which is done in registers; a whole block would be copied by a call of memcpy.
            (&raw mut (*place).start).write(block.start);
            (&raw mut (*place).search).write(block.search);
            (&raw mut (*place).layout).write(block.layout);
            (&raw mut (*place).sums).write(block.sums);
            // Written in two branches so that nothing is copied if nothing is watched.
            let watch = &raw mut (*place).watch;
            match block.watch {
                Some(channels) => watch.write(Some(channels)),
                None => watch.write(None),
            }
        }
        self.put.store(put.wrapping_add(1), Ordering::Release);
        true
    }

    /// Passes the oldest block to `look` in place, then frees its slot; `None` if the queue is empty.
    ///
    /// # Safety
    /// One caller at a time, beside one caller of [`Queue::put`].
    #[inline]
    pub(crate) unsafe fn take<T>(&self, look: impl FnOnce(&Block<S>) -> T) -> Option<T> {
        let taken = self.taken.load(Ordering::Relaxed);
        let put = self.put.load(Ordering::Acquire);
        if put.wrapping_sub(taken) > ANTINODE_QUEUE_BLOCKS as u32 {
            // Something else has written to a counter: what waits is not known.
            self.taken.store(put, Ordering::Release);
            return None;
        }
        if taken == put {
            return None;
        }
        // SAFETY: the slot was written before `put` passed it, and the producer leaves it alone until `taken` has.
        let seen = look(unsafe { (*self.slot(taken)).assume_init_ref() });
        self.taken.store(taken.wrapping_add(1), Ordering::Release);
        Some(seen)
    }
}

/// Blocks that wait, from two counters that may advance between the two reads: of the blocks read as put in, those not taken yet.
fn waiting(put: impl FnOnce() -> u32, taken: impl FnOnce() -> u32) -> u32 {
    // `put` is read first: blocks put in between the reads would count otherwise, and the result could exceed the queue's length.
    let count = put().wrapping_sub(taken());
    // Between the reads more blocks were taken than the first read saw: the difference has wrapped.
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

    // SAFETY: like the state of a C program that an interrupt and a thread share.
    unsafe impl Sync for Shared {}

    /// A block that begins at `start`, and whose search number is `start` too.
    fn block(start: u32) -> Block<f32> {
        let step = PhaseStep::from_period(4.0);
        let mut demodulator = Demodulator::<f32, 4>::new(step, 1, u64::from(start), false);
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
    fn a_counter_that_something_else_has_written_to_empties_the_queue() {
        for bit in 5..32 {
            let queue = Queue::new();
            // SAFETY: one thread.
            unsafe {
                assert!(queue.put(&block(1)));
                queue.put.fetch_xor(1 << bit, Ordering::Relaxed);
                assert_eq!(queue.take(|block| block.start), None);
                assert_eq!(queue.len(), 0);
                assert!(queue.put(&block(2)));
                assert_eq!(queue.take(|block| block.start), Some(2));
            }
        }
    }

    #[test]
    fn a_slot_is_not_free_while_it_is_looked_at() {
        let queue = Queue::new();
        for i in 0..ANTINODE_QUEUE_BLOCKS as u32 {
            // SAFETY: one thread.
            assert!(unsafe { queue.put(&block(i)) });
        }
        // As by an interrupt during `take`.
        // SAFETY: one caller of each.
        let seen = unsafe { queue.take(|taken| (queue.put(&block(99)), taken.start)) };
        assert_eq!(seen, Some((false, 0)));
    }

    #[test]
    fn the_count_of_waiting_blocks_is_right_though_both_sides_go_on_between_the_reads() {
        const FULL: u32 = ANTINODE_QUEUE_BLOCKS as u32;
        let (put, taken) = (Cell::new(0u32), Cell::new(0u32));
        // The count of a full queue when after each read `since` blocks are taken and as many are put in.
        let count = |since: u32| {
            taken.set(u32::MAX - 3);
            put.set(taken.get().wrapping_add(FULL));
            let go_on = || {
                put.set(put.get().wrapping_add(since));
                taken.set(taken.get().wrapping_add(since));
            };
            let read = |counter: &Cell<u32>| {
                let seen = counter.get();
                go_on();
                seen
            };
            waiting(|| read(&put), || read(&taken))
        };
        assert_eq!(
            [0, 5, FULL, FULL + 1, 3 * FULL].map(count),
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
            // Counted, not asserted: if the consumer panicked, the producer would wait for ever.
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
