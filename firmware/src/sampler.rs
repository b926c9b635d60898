//! A source of pairs: a converter that a timer triggers, the ring that the DMA fills, and the count of triggers, of whichever chip.

use core::sync::atomic::{Ordering, compiler_fence};

use antinode::Packed;
use antinode_telemetry::Cause;

use crate::sampling::{Lapse, Ready, Source, beyond, both, has_slipped};
use crate::settings::HALF;

/// A converter triggered by a timer.
pub trait Converter {
    /// Stops the data; the ring must be stopped before.
    fn stop(&mut self);

    /// Starts the data with the next trigger; the ring must be started before. It returns between that trigger and the one before, well
    /// away from both, so that the count of triggers identifies the first pair.
    fn arm(&mut self);

    /// True if data were not fetched in time.
    fn has_overrun(&self) -> bool;

    /// Fails to compile if the converter cannot run at [`SAMPLE_RATE`](crate::settings::SAMPLE_RATE); evaluated only in images that use it.
    const RATE: ();

    /// The lowest and the highest code.
    const RAILS: [i16; 2];

    /// True for a pair with a sample at either end of the range.
    fn is_at_rail(pair: Packed) -> bool;
}

/// Events of the ring since they were last read.
#[derive(Debug, Clone, Copy, Default)]
pub struct Done {
    /// The first half is full.
    pub first: bool,
    /// The second half is full.
    pub second: bool,
    /// The transfer failed.
    pub error: bool,
}

/// Two halves of [`HALF`] pairs each, which the DMA fills in turn, with an interrupt at the end of each.
pub trait Ring {
    /// Stops the DMA.
    fn stop(&mut self);

    /// Starts the stopped DMA at the first half, without events.
    fn start(&mut self);

    /// Reads and clears the events.
    fn done(&self) -> Done;

    /// Pairs still to come in this round: 2·[`HALF`] at its beginning, and, if the DMA reloads its count later, 0 at its end.
    fn left(&self) -> u32;

    /// One of the halves. The DMA meanwhile writes to the other one; if it comes round too early, the words are valid but new.
    fn half(&self, second: bool) -> &[Packed];
}

/// The count of triggers, that is of the pairs that should have come, even if they were lost.
pub trait PairClock {
    /// Triggers so far, wrapping.
    fn now(&self) -> u32;
}

/// Waits until `count`, of a timer with a period of `ticks`, is within `quiet`. The wait is limited to a few periods, as a dead timer must
/// not hang the interrupt.
pub fn wait_for(quiet: [u32; 2], ticks: u32, count: impl Fn() -> u32) {
    let _ = (0..4 * ticks).any(|_| (quiet[0]..quiet[1]).contains(&count()));
}

/// A source of pairs: a converter, the ring that it fills, and the count of its triggers.
pub struct Sampler<C, R, T> {
    converter: C,
    ring: R,
    clock: T,
    /// Count of triggers at the end of the pairs handed out.
    taken: u32,
    /// True if the second half was handed out last.
    second: bool,
}

impl<C: Converter, R: Ring, T: PairClock> Sampler<C, R, T> {
    /// Starts sampling.
    pub fn new(mut converter: C, mut ring: R, clock: T) -> Self {
        const { C::RATE };
        ring.start();
        converter.arm();
        let taken = clock.now();
        Self {
            converter,
            ring,
            clock,
            taken,
            second: true,
        }
    }

    /// True if pairs were lost without a flag: the count of pairs beyond the end of a half does not match that of triggers beyond `taken`,
    /// the count there.
    #[inline]
    fn has_slipped(&self, taken: u32, second: bool) -> bool {
        let look = || [self.clock.now(), self.ring.left()];
        let mut seen = look();
        // A trigger between both reads would count in one of them only: then they are repeated, as the next trigger is far away.
        if self.clock.now() != seen[0] {
            seen = look();
        }
        let [now, left] = seen;
        has_slipped(now.wrapping_sub(taken), beyond(second, left))
    }
}

impl<C: Converter, R: Ring, T: PairClock> Source for Sampler<C, R, T> {
    type Pair = Packed;

    #[inline]
    fn next(&mut self) -> Ready {
        let done = self.ring.done();
        if done.error {
            return Ready::Lapse(self.restart(Cause::Dma));
        }
        if self.converter.has_overrun() {
            return Ready::Lapse(self.restart(Cause::Overrun));
        }
        match (done.first, done.second) {
            (false, false) => Ready::Nothing,
            // The DMA is about to write to the one that was full first.
            (true, true) => Ready::Lapse(self.restart(Cause::Overrun)),
            (_, second) => {
                let taken = self.taken.wrapping_add(HALF as u32);
                if self.has_slipped(taken, second) {
                    return Ready::Lapse(self.restart(Cause::Overrun));
                }
                (self.second, self.taken) = (second, taken);
                Ready::Pairs
            }
        }
    }

    #[inline]
    fn pairs(&self) -> &[Packed] {
        self.ring.half(self.second)
    }

    #[inline]
    fn is_intact(&self) -> bool {
        // Keeps the reads of the pairs before that of the clock.
        compiler_fence(Ordering::SeqCst);
        // The other half holds the next `HALF` pairs: with one more trigger the DMA may come round.
        self.clock.now().wrapping_sub(self.taken) <= HALF as u32
    }

    #[cold]
    fn restart(&mut self, cause: Cause) -> Lapse {
        // After an overrun the SPI gives no more pairs, and so the DMA no interrupt that would have reported it.
        let cause = if cause == Cause::Converter && self.converter.has_overrun() {
            Cause::Overrun
        } else {
            cause
        };
        self.ring.stop();
        self.converter.stop();
        self.ring.start();
        self.converter.arm();
        let now = self.clock.now();
        let lost = now.wrapping_sub(self.taken);
        self.taken = now;
        self.second = true;
        Lapse { cause, lost }
    }

    #[inline]
    fn rails(&self) -> [Packed; 2] {
        both(C::RAILS)
    }

    #[inline]
    fn is_at_rail(&self, pair: Packed) -> bool {
        C::is_at_rail(pair)
    }
}
