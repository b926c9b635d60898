//! The interrupt half of the pipeline: turns a source's pairs into blocks in a queue.

use core::mem::MaybeUninit;
use core::sync::atomic::Ordering;

use antinode::block::ChannelWatch;
use antinode::{Block, Front, Sample, SamplePair, Settings};
use antinode_telemetry::Cause;
use heapless::spsc::{Consumer, Producer};

use crate::counts::Counts;
use crate::methods::{Extra, Gathering, Tuning};
use crate::sampling::{Lapse, Ready, Source};
use crate::settings::LONGEST_PERIOD;

/// Item from the interrupt to the main loop.
#[derive(Debug, Clone, Copy)]
#[allow(
    clippy::large_enum_variant,
    reason = "nearly every item is a block; there is no heap"
)]
pub enum Item<S: Sample> {
    /// The next block, and the methods' sums over it.
    Block(Block<S>, Extra<S>),
    /// Sample pairs are missing before the next block.
    Lapse(Lapse),
}

/// Request from the main loop to the interrupt.
#[derive(Debug, Clone, Copy)]
pub enum Request {
    /// Continue with other settings.
    Configure(Settings),
    /// Gather the methods' sums with this tuning, or with `None` no longer.
    Tune(Option<Tuning>),
    /// Restart sampling, because no pair has come for too long.
    Resample,
}

/// The queue to the main loop.
struct Outlet<'q, S: Sample> {
    items: Producer<'q, Item<S>>,
    counts: &'q Counts,
    /// A lapse that awaits room in the queue: it goes before any block.
    lapse: Option<Lapse>,
    /// True if the unfinished block has a pair at a rail.
    saturated: bool,
}

impl<S: Sample> Outlet<'_, S> {
    /// False if no sample of the block can be at a rail, the converter's lowest or highest code.
    #[inline]
    fn may_be_saturated(block: &Block<S>, [low, high]: [S; 2]) -> bool {
        let watched = |[c, d]: &[ChannelWatch<S>; 2]| {
            c.low == low || d.low == low || c.high == high || d.high == high
        };
        block.watch.as_ref().is_none_or(watched)
    }

    /// Counts pairs at a rail, which may belong to a block or, during a search, to none.
    #[cold]
    fn saturate(&mut self, pairs: usize, are_of_block: bool) {
        self.counts.saturated_pairs.add(pairs as u32);
        self.saturated |= are_of_block && pairs > 0;
    }

    #[inline]
    fn hand_over(&mut self, block: &Block<S>, extra: Extra<S>) {
        if core::mem::take(&mut self.saturated) {
            self.counts.saturated_blocks.add(1);
        }
        // The tracker detects the gap from the next block's start, and begins a new window after it.
        if !self.deliver_lapse() || !self.items.ready() {
            self.counts.blocks_dropped.add(1);
            return;
        }
        self.put(block, extra);
    }

    /// Copies a block into the queue, which must have room: with the queue's own check it would be copied twice.
    #[allow(unsafe_code, reason = "there must be room")]
    #[inline]
    fn put(&mut self, block: &Block<S>, extra: Extra<S>) {
        // Field by field: a few words each go through registers, not through memcpy.
        let &Block {
            start,
            search,
            layout,
            sums,
            watch,
        } = block;
        let block = Block {
            start,
            search,
            layout,
            sums,
            watch,
        };
        // SAFETY: the caller has checked that there is room, and nobody else fills it.
        unsafe { self.items.enqueue_unchecked(Item::Block(block, extra)) };
    }

    /// Queues the lapse that waits, if any; false while there is no room for it.
    #[inline]
    fn deliver_lapse(&mut self) -> bool {
        self.lapse.is_none_or(|lapse| self.enqueue_lapse(lapse))
    }

    #[cold]
    fn enqueue_lapse(&mut self, lapse: Lapse) -> bool {
        let done = self.items.enqueue(Item::Lapse(lapse)).is_ok();
        if done {
            self.lapse = None;
        }
        done
    }

    fn note_lapse(&mut self, lapse: Lapse) {
        self.saturated = false;
        self.counts.pairs_lost.add(lapse.lost);
        self.counts.restarts.add(1);
        if lapse.cause == Cause::Overrun {
            self.counts.overruns.add(1);
        }
        let before = self.lapse.map_or(0, |earlier| earlier.lost);
        self.lapse = Some(Lapse {
            lost: lapse.lost.wrapping_add(before),
            ..lapse
        });
        self.deliver_lapse();
    }
}

/// Gathers blocks at sample rate. It never waits.
pub struct Gatherer<'q, S: Sample> {
    front: &'q mut Front<S, LONGEST_PERIOD>,
    methods: Gathering<S>,
    requests: Consumer<'q, Request>,
    outlet: Outlet<'q, S>,
}

impl<'q, S: Sample> Gatherer<'q, S> {
    /// Constructs in `place` a gatherer for a configured front.
    // Not inlined, like the instrument's: the stack then holds one of them at a time.
    #[cold]
    #[inline(never)]
    pub fn make(
        place: &'q mut MaybeUninit<Self>,
        front: &'q mut Front<S, LONGEST_PERIOD>,
        items: Producer<'q, Item<S>>,
        requests: Consumer<'q, Request>,
        counts: &'q Counts,
    ) -> &'q mut Self {
        place.write(Self {
            front,
            methods: Gathering::new(),
            requests,
            outlet: Outlet {
                items,
                counts,
                lapse: None,
                saturated: false,
            },
        })
    }

    /// Serves the source's interrupt: executes requests, begins a search if the main loop wants one, then takes the source's pairs.
    #[inline]
    pub fn serve<R: Source>(&mut self, source: &mut R)
    where
        R::Pair: SamplePair<S>,
    {
        if self.requests.ready() {
            self.obey(source);
        }
        let wanted = self.outlet.counts.wanted_search.load(Ordering::Relaxed);
        if self.front.search_if_wanted(wanted) {
            self.begin_anew();
        }
        match source.next() {
            Ready::Nothing => {}
            Ready::Pairs => self.gather(source),
            Ready::Lapse(lapse) => self.skip(lapse),
        }
    }

    #[cold]
    #[inline(never)]
    fn obey<R: Source>(&mut self, source: &mut R) {
        while let Some(request) = self.requests.dequeue() {
            match request {
                Request::Configure(settings) => {
                    // The main loop has checked the settings; on an error, which cannot occur, the old ones would remain.
                    let _ = self.front.configure(settings);
                    self.begin_anew();
                }
                Request::Tune(tuning) => self.methods.tune(tuning),
                Request::Resample => {
                    let lapse = source.restart(Cause::Converter);
                    self.skip(lapse);
                }
            }
        }
    }

    /// Discards the unfinished block.
    #[cold]
    fn begin_anew(&mut self) {
        self.methods.restart();
        self.outlet.saturated = false;
    }

    // Not inlined: its stack then need not hold that of `obey` too.
    #[inline(never)]
    fn gather<R: Source>(&mut self, source: &mut R)
    where
        R::Pair: SamplePair<S>,
    {
        let Self {
            front,
            methods,
            outlet,
            ..
        } = self;
        let rails = source.rails().map(|pair| pair.pair()[0]);
        let mut rest = source.pairs();
        while !rest.is_empty() {
            let is_searching = front.is_searching();
            let (taken, block) = front.push_slice(rest);
            outlet.counts.pairs.add(taken as u32);
            let (done, after) = rest.split_at_checked(taken).unwrap_or((rest, &[]));
            rest = after;
            let extra = methods.add(done, block);
            // The extremes of a watched block show whether pairs at a rail need to be counted.
            if block.is_none_or(|block| Outlet::may_be_saturated(block, rails)) {
                let pairs = done.iter().filter(|&&pair| source.is_at_rail(pair)).count();
                outlet.saturate(pairs, !is_searching);
            }
            // Checked before the block is handed over: pairs overwritten meanwhile must not pass for a wave.
            if !source.is_intact() {
                let left = rest.len() as u32;
                if is_searching {
                    // A period found in overwritten pairs would otherwise be kept.
                    front.search();
                }
                let lapse = source.restart(Cause::Overrun);
                self.skip(Lapse {
                    lost: lapse.lost.wrapping_add(left),
                    ..lapse
                });
                return;
            }
            if let Some(block) = block {
                outlet.hand_over(block, extra);
            }
        }
    }

    /// Continues after missing pairs, which are counted as time passed.
    #[cold]
    fn skip(&mut self, lapse: Lapse) {
        self.front.skip(u64::from(lapse.lost));
        self.methods.restart();
        self.outlet.note_lapse(lapse);
    }
}
