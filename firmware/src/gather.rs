//! The interrupt half of the pipeline: a source's pairs become blocks in a queue.

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

/// What the interrupt hands to the main loop.
#[derive(Debug, Clone, Copy)]
#[allow(
    clippy::large_enum_variant,
    reason = "nearly every item is a block; there is no heap"
)]
pub enum Item<S: Sample> {
    /// The next block, and what goes with it.
    Block(Block<S>, Extra<S>),
    /// Sample pairs are missing before the next block.
    Lapse(Lapse),
}

/// What the main loop asks of the interrupt.
#[derive(Debug, Clone, Copy)]
pub enum Request {
    /// Go on with other settings.
    Configure(Settings),
    /// Gather the methods' sums too, or no longer.
    Tune(Option<Tuning>),
    /// Start sampling anew: no pair came for too long.
    Resample,
}

/// The queue to the main loop.
struct Outlet<'q, S: Sample> {
    items: Producer<'q, Item<S>>,
    counts: &'q Counts,
    /// What found no room in the queue yet: it goes before any block.
    lapse: Option<Lapse>,
    /// True where the block begun has a pair at a rail.
    saturated: bool,
}

impl<S: Sample> Outlet<'_, S> {
    /// False where no sample of the block can be at a rail, the converter's least or greatest code.
    #[inline]
    fn may_be_saturated(block: &Block<S>, [low, high]: [S; 2]) -> bool {
        let watched = |[c, d]: &[ChannelWatch<S>; 2]| {
            c.low == low || d.low == low || c.high == high || d.high == high
        };
        block.watch.as_ref().is_none_or(watched)
    }

    /// Counts pairs at a rail, which are of a block or of none.
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
        // The tracker sees the hole by the next block's start, and begins a new window after it.
        if !self.pay() || !self.items.ready() {
            self.counts.blocks_dropped.add(1);
            return;
        }
        self.put(block, extra);
    }

    /// Copies a block into the queue, which has room: the queue's own check would have it copied twice.
    #[allow(unsafe_code, reason = "there must be room")]
    #[inline]
    fn put(&mut self, block: &Block<S>, extra: Extra<S>) {
        // Part by part: of few words each, they go through registers, not through memcpy.
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
        // SAFETY: the caller has asked whether there is room, and nobody else fills it.
        unsafe { self.items.enqueue_unchecked(Item::Block(block, extra)) };
    }

    /// Tells of what is missing; false while there is no room for it.
    #[inline]
    fn pay(&mut self) -> bool {
        self.lapse.is_none_or(|lapse| self.pay_out(lapse))
    }

    #[cold]
    fn pay_out(&mut self, lapse: Lapse) -> bool {
        let paid = self.items.enqueue(Item::Lapse(lapse)).is_ok();
        if paid {
            self.lapse = None;
        }
        paid
    }

    fn owe(&mut self, lapse: Lapse) {
        self.saturated = false;
        self.counts.pairs_lost.add(lapse.lost);
        self.counts.restarts.add(1);
        if lapse.cause == Cause::Overrun {
            self.counts.overruns.add(1);
        }
        let before = self.lapse.map_or(0, |owed| owed.lost);
        self.lapse = Some(Lapse {
            lost: lapse.lost.wrapping_add(before),
            ..lapse
        });
        self.pay();
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
    /// Makes in `place` a gatherer of a front that has its settings.
    // Not inlined, nor is the instrument's: the stack holds one part at a time.
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

    /// Serves the source's interrupt: obeys requests, searches where the main loop wants it, then takes what the source has.
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
                    // The main loop has checked them: an error, which never is, leaves the old ones.
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

    /// The block begun is no more.
    #[cold]
    fn begin_anew(&mut self) {
        self.methods.restart();
        self.outlet.saturated = false;
    }

    // Not inlined, and nor is what follows: its stack need not hold that of the requests too.
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
            // A watched block tells by its extremes whether it has pairs at a rail: they are looked for only there.
            if block.is_none_or(|block| Outlet::may_be_saturated(block, rails)) {
                let pairs = done.iter().filter(|&&pair| source.is_at_rail(pair)).count();
                outlet.saturate(pairs, !is_searching);
            }
            // Asked before the block is handed over: what was overwritten meanwhile must not be taken for a wave.
            if !source.is_intact() {
                let left = rest.len() as u32;
                if is_searching {
                    // A period found in it would be kept.
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

    /// Goes on after missing pairs, in the same count of pairs.
    #[cold]
    fn skip(&mut self, lapse: Lapse) {
        self.front.skip(u64::from(lapse.lost));
        self.methods.restart();
        self.outlet.owe(lapse);
    }
}
