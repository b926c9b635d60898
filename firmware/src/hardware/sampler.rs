//! A converter that is triggered by a timer and fetched by the DMA, as a source of pairs.

use core::sync::atomic::{Ordering, compiler_fence};

use antinode::Packed;
use antinode_telemetry::Cause;

use crate::hardware::pair_clock::PairClock;
use crate::hardware::ring::Ring;
use crate::sampling::{Lapse, Ready, Source, beyond, both, has_slipped};
use crate::settings::HALF;

/// A converter that follows a timer.
pub trait Converter {
    /// Makes it give no more data, after the ring was stopped.
    fn stop(&mut self);

    /// Makes it give data from the next trigger on, after the ring was started. It returns between that trigger and the one before,
    /// well away from both, so that the count of triggers tells which pair comes first.
    fn arm(&mut self);

    /// True where it gave data that nobody fetched.
    fn has_overrun(&self) -> bool;

    /// Fails to compile where it cannot have [`SAMPLE_RATE`](crate::settings::SAMPLE_RATE); evaluated for an image that samples with it.
    const RATE: ();

    /// The least and the greatest code.
    const RAILS: [i16; 2];

    /// True for a pair with a sample at either end of the range.
    fn is_at_rail(pair: Packed) -> bool;
}

/// Waits until a timer of `ticks` a period, which `count` reads, stands within `quiet`: at most two periods, and for ever neither, as a dead
/// timer must not hang the interrupt.
pub fn wait_for(quiet: [u32; 2], ticks: u32, count: impl Fn() -> u32) {
    let _ = (0..4 * ticks).any(|_| (quiet[0]..quiet[1]).contains(&count()));
}

/// The source: a converter, the ring that it fills, and the count of its triggers.
pub struct Sampler<C: Converter> {
    converter: C,
    ring: Ring,
    clock: PairClock,
    /// The count of triggers at the end of what was handed out.
    taken: u32,
    /// The half that was handed out last.
    second: bool,
}

impl<C: Converter> Sampler<C> {
    /// Starts sampling.
    pub fn new(mut converter: C, mut ring: Ring, clock: PairClock) -> Self {
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

    /// True where pairs were lost and no flag told: those beyond the end of a half do not fit the triggers beyond `taken`, the count there.
    #[inline]
    fn has_slipped(&self, taken: u32, second: bool) -> bool {
        let look = || [self.clock.now(), self.ring.left()];
        let mut seen = look();
        // A trigger between the two would count in one of them alone; the next is far away.
        if self.clock.now() != seen[0] {
            seen = look();
        }
        let [now, left] = seen;
        has_slipped(now.wrapping_sub(taken), beyond(second, left))
    }
}

impl<C: Converter> Source for Sampler<C> {
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
        // The halves take turns: neither twice, nor both at once.
        match (done.first, done.second) {
            (false, false) => Ready::Nothing,
            (first, second) if first != second && second != self.second => {
                let taken = self.taken.wrapping_add(HALF as u32);
                if self.has_slipped(taken, second) {
                    return Ready::Lapse(self.restart(Cause::Overrun));
                }
                (self.second, self.taken) = (second, taken);
                Ready::Pairs
            }
            _ => Ready::Lapse(self.restart(Cause::Overrun)),
        }
    }

    #[inline]
    fn pairs(&self) -> &[Packed] {
        self.ring.half(self.second)
    }

    #[inline]
    fn is_intact(&self) -> bool {
        // The pairs are read before the clock is.
        compiler_fence(Ordering::SeqCst);
        // The other half holds the pairs after those handed out: one trigger more, and the DMA may come round.
        self.clock.now().wrapping_sub(self.taken) <= HALF as u32
    }

    #[cold]
    fn restart(&mut self, cause: Cause) -> Lapse {
        // An overrun leaves the SPI deaf: no more pairs come, and no interrupt of the DMA that would have told of it.
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
