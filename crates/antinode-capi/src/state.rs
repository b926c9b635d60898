//! The inside of an opaque state, and the work of its two sides.
#![allow(
    unsafe_code,
    reason = "parts are written in place, and each side hands its own contract on to the queue"
)]

use core::sync::atomic::{AtomicU32, Ordering};

use antinode::{Block, Calibration, Sample, Settings};
use antinode_capi_slow::{Slow, Tracker};

use crate::capacity::ANTINODE_QUEUE_BLOCKS;
use crate::estimate::Estimate;
use crate::interrupt::Interrupt;
use crate::queue::Queue;
use crate::status::Status;

/// The arithmetic of a state: fixed point or single precision.
pub(crate) trait Arithmetic: Slow {
    /// The first word of an initialised state.
    const MAGIC: u32;
}

impl Arithmetic for i16 {
    const MAGIC: u32 = 0xa2_7e_16_f1;
}

impl Arithmetic for f32 {
    const MAGIC: u32 = 0xa2_7e_32_f2;
}

/// A whole state. Its parts are borrowed one by one, never the whole.
#[repr(C)]
pub(crate) struct State<S: Sample> {
    pub magic: AtomicU32,
    pub shared: Shared<S>,
    pub interrupt: Interrupt<S>,
    pub thread: Thread,
}

/// What the two sides pass to each other.
pub(crate) struct Shared<S: Sample> {
    queue: Queue<S>,
    /// The search whose blocks the thread wants. Written by the thread.
    pub wanted: AtomicU32,
    /// 1 while a period is searched for. Written by the interrupt.
    pub searching: AtomicU32,
    /// 1 while there is a wave. Written by the thread.
    has_wave: AtomicU32,
    /// Blocks that found no place in the queue. Written by the interrupt.
    pub dropped: AtomicU32,
}

/// The part of a state that belongs to the thread alone.
pub(crate) struct Thread {
    tracker: Tracker,
}

/// How an identification is doing, from counters that either side may read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Health {
    /// 1 while a period is searched for, 0 while blocks are gathered; always 0 if `frequency_hz` is given.
    pub searching: u32,
    /// 1 once a window that shows a wave has been solved, until one that shows none, or `_search`. If it stays 0 there is no wave, or none
    /// with a period that is searched for, or none at the frequency given: nothing else shows this.
    pub has_wave: u32,
    /// Finished blocks that wait to be solved, 0 to ANTINODE_QUEUE_BLOCKS.
    pub waiting: u32,
    /// Finished blocks dropped since the start because the queue was full; it wraps.
    pub dropped: u32,
}

impl<S: Sample> Shared<S> {
    /// Writes an empty queue and counters at zero; `searching` is whether the front will search.
    ///
    /// # Safety
    /// `place` is writable and nobody else's.
    #[inline(never)]
    pub(crate) unsafe fn write(place: *mut Self, searching: bool) {
        // SAFETY: the caller's contract; the queue's slots stay as they are.
        unsafe {
            Queue::write(&raw mut (*place).queue);
            (&raw mut (*place).wanted).write(AtomicU32::new(0));
            (&raw mut (*place).searching).write(AtomicU32::new(searching.into()));
            (&raw mut (*place).has_wave).write(AtomicU32::new(0));
            (&raw mut (*place).dropped).write(AtomicU32::new(0));
        }
    }

    /// Queues a finished block, or counts it as dropped.
    ///
    /// # Safety
    /// One caller at a time, the interrupt.
    #[inline]
    pub(crate) unsafe fn queue_block(&self, block: &Block<S>) {
        // SAFETY: the caller is the only producer.
        if !unsafe { self.queue.put(block) } {
            let dropped = self.dropped.load(Ordering::Relaxed);
            self.dropped
                .store(dropped.wrapping_add(1), Ordering::Relaxed);
        }
    }

    /// Blocks ever queued and ever dropped. For the interrupt only.
    #[inline]
    pub(crate) fn counts(&self) -> [u32; 2] {
        [self.queue.count(), self.dropped.load(Ordering::Relaxed)]
    }

    /// The status of a push, from the counts before it.
    #[inline]
    pub(crate) fn status_since(&self, before: [u32; 2]) -> Status {
        let [queued, dropped] = self.counts();
        if dropped != before[1] {
            Status::Dropped
        } else if queued != before[0] {
            Status::Ready
        } else {
            Status::Ok
        }
    }

    pub(crate) fn health(&self) -> Health {
        Health {
            searching: self.searching.load(Ordering::Relaxed),
            has_wave: self.has_wave.load(Ordering::Relaxed),
            waiting: self.queue.len(),
            dropped: self.dropped.load(Ordering::Relaxed),
        }
    }
}

impl Thread {
    /// Writes a tracker that waits for its first block.
    ///
    /// # Safety
    /// `place` is writable and nobody else's.
    #[inline(never)]
    pub(crate) unsafe fn write(place: *mut Self, settings: Settings) -> Result<(), Status> {
        // In place, as the interrupt's front.
        // SAFETY: the caller's contract.
        let thread = unsafe {
            (&raw mut (*place).tracker).write(Tracker::UNSET);
            &mut *place
        };
        thread.tracker.configure(settings)?;
        Ok(())
    }

    /// The settings in use.
    pub(crate) fn settings(&self) -> &Settings {
        self.tracker.settings()
    }

    /// Solves queued blocks up to the next estimate, but no more than a queue holds: on a slow core blocks may come as fast as windows of
    /// noise are solved, and the call would not end.
    ///
    /// # Safety
    /// One caller at a time.
    #[inline(never)]
    pub(crate) unsafe fn solve<S: Slow>(&mut self, shared: &Shared<S>) -> Option<Estimate> {
        for _ in 0..ANTINODE_QUEUE_BLOCKS {
            // SAFETY: the caller is the only consumer.
            let estimate = unsafe { shared.queue.take(|block| self.push(shared, block)) }?;
            if estimate.is_some() {
                return estimate;
            }
        }
        None
    }

    fn push<S: Slow>(&mut self, shared: &Shared<S>, block: &Block<S>) -> Option<Estimate> {
        let estimate = S::solve(&mut self.tracker, block);
        self.tell(shared);
        estimate.map(Estimate::from)
    }

    /// Drops the wave and has the interrupt search anew.
    pub(crate) fn search<S: Sample>(&mut self, shared: &Shared<S>) {
        self.tracker.search();
        self.tell(shared);
    }

    fn tell<S: Sample>(&self, shared: &Shared<S>) {
        let wanted = self.tracker.wanted_search();
        shared.wanted.store(wanted, Ordering::Relaxed);
        let has_wave = u32::from(self.tracker.has_wave());
        shared.has_wave.store(has_wave, Ordering::Relaxed);
    }

    pub(crate) fn calibrate(&mut self, calibration: Calibration) -> Result<(), Status> {
        // Copied as a whole and then changed: with `..` the compiler would copy some parts at unaligned addresses.
        let mut settings = *self.settings();
        settings.calibration = calibration;
        antinode_capi_slow::change(&mut self.tracker, &settings)?;
        Ok(())
    }
}

/// Takes pairs up to the next estimate, in one thread; returns how many it took.
///
/// # Safety
/// No other call of this state at the same time.
pub(crate) unsafe fn identify<S: Slow>(
    (interrupt, thread, shared): (&mut Interrupt<S>, &mut Thread, &Shared<S>),
    pairs: &[[S; 2]],
) -> (usize, Option<Estimate>) {
    // SAFETY: the only consumer, by the contract.
    if let Some(estimate) = unsafe { thread.solve(shared) } {
        return (0, Some(estimate));
    }
    for (before, &pair) in pairs.iter().enumerate() {
        // SAFETY: the only producer and the only consumer; the queue is empty, so it has a place.
        let estimate = unsafe {
            match interrupt.push_one(shared, pair) {
                Status::Ready => thread.solve(shared),
                _ => None,
            }
        };
        if estimate.is_some() {
            return (before + 1, estimate);
        }
    }
    (pairs.len(), None)
}
