//! The main loop's half of the pipeline: it solves and tracks blocks, sends reports, and executes commands.

mod commands;

use core::mem::MaybeUninit;
use core::sync::atomic::Ordering;

use antinode::{Estimate, Sample, Tracker};
use antinode_telemetry::{
    Cause, CommandError, Configuration, Counters, Hello, Methods, Report, State,
};
use heapless::spsc::{Consumer, Producer};

use crate::counts::Counts;
use crate::gather::{Item, Request};
use crate::link::Link;
use crate::methods::{AVAILABLE, History, Tuning};
use crate::sampling::Lapse;
use crate::settings::{COUNTERS_MS, OUTBOX, QUEUE, RESTART_MS, RING, SOONEST_MS, VERSION};
use crate::supervision::Liveness;

/// Event for the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event {
    /// The device is in another state.
    State(State),
    /// Sample pairs are missing.
    Lapse(Lapse),
    /// A command was answered.
    Answered {
        /// Id of the command.
        id: u16,
        /// True if it was executed.
        done: bool,
    },
}

/// Solves, tracks and reports.
pub struct Instrument<'q, S: Sample> {
    tracker: &'q mut Tracker<RING>,
    items: Consumer<'q, Item<S>>,
    requests: Producer<'q, Request>,
    counts: &'q Counts,
    link: Link<'q>,
    configuration: Configuration,
    history: History<S>,
    tuning: Option<Tuning>,
    state: State,
    /// Time at which a command asked for a restart, ms.
    restart: Option<u32>,
    /// True if the source's interrupt must be pended, as it does not come by itself.
    needs_source: bool,
    answered: u32,
    liveness: Liveness,
    counters: Counters,
    /// True if something went wrong that has not been reported by the counters yet.
    has_news: bool,
    /// Time of the last report of the counters, ms.
    reported: u32,
    now: u32,
}

impl<'q, S: Sample> Instrument<'q, S> {
    /// Constructs in `place` an instrument with a tracker that has the configuration's settings; it sends a hello and the cause of the
    /// start.
    #[cold]
    #[inline(never)]
    pub fn make(
        place: &'q mut MaybeUninit<Self>,
        (tracker, configuration): (&'q mut Tracker<RING>, Configuration),
        items: Consumer<'q, Item<S>>,
        requests: Producer<'q, Request>,
        counts: &'q Counts,
        link: Link<'q>,
        cause: Cause,
    ) -> &'q mut Self {
        let instrument = place.write(Self {
            tracker,
            items,
            requests,
            counts,
            link,
            configuration,
            history: History::new(),
            tuning: None,
            state: State::Started(cause),
            restart: None,
            needs_source: false,
            answered: 0,
            liveness: Liveness::new(),
            counters: Counters::default(),
            has_news: false,
            // Faults at the start can then be reported without delay.
            reported: 0_u32.wrapping_sub(SOONEST_MS),
            now: 0,
        });
        instrument.hello();
        instrument.link.send(&Report::State(State::Started(cause)));
        instrument
    }

    /// One round of the main loop at `now`, ms since the start: it processes all that waits, but not what arrives meanwhile.
    ///
    /// True if the pipeline is alive, that is if pairs have arrived since the last round.
    pub fn poll(&mut self, now: u32, mut log: impl FnMut(Event)) -> bool {
        let passed = now.wrapping_sub(self.now);
        self.counters.uptime_ms += u64::from(passed);
        self.now = now;
        while let Some(frame) = self.link.command() {
            let done = self.answer(frame);
            log(Event::Answered { id: frame.id, done });
        }
        // Only from `Tracking`: a device that does not sample must keep its `Fault`.
        if self.wants_search() && self.state == State::Tracking {
            self.enter(State::Searching, &mut log);
        }
        // No more than the queue holds: under overload it is never empty, and line and watchdog need their turn.
        let _ = (1..QUEUE).all(|_| self.take(&mut log));
        if matches!(self.state, State::Started(_)) {
            self.enter(State::Searching, &mut log);
        }
        self.update();
        let due = if self.has_news {
            SOONEST_MS
        } else {
            COUNTERS_MS
        };
        if now.wrapping_sub(self.reported) >= due {
            self.report_counters();
        }
        let alive = self.liveness.sees(self.counts.pairs.get());
        self.needs_source = self.liveness.stalled(now);
        if self.needs_source {
            // If the queue is full, the interrupt that is pended empties it, and the next stall finds room.
            let _ = self.ask(Request::Resample);
        }
        alive
    }

    /// Sends a request to the interrupt; [`CommandError::Busy`] if the queue is full.
    fn ask(&mut self, request: Request) -> Result<(), CommandError> {
        // Without sampling there is no interrupt to take it from the queue.
        if matches!(self.state, State::Fault(_)) {
            return Ok(());
        }
        let asked = self.requests.enqueue(request);
        asked.map_err(|_| CommandError::Busy)
    }

    /// Takes the next item; false if there is none.
    fn take(&mut self, log: &mut impl FnMut(Event)) -> bool {
        let mut estimate = None;
        match self.items.peek() {
            None => return false,
            Some(Item::Block(block, extra)) if block.search == self.tracker.wanted_search() => {
                self.history.keep(extra);
                estimate = self.tracker.push(block);
            }
            Some(Item::Block(..)) => {}
            Some(Item::Lapse(lapse)) => {
                log(Event::Lapse(*lapse));
                let restarted = State::SamplingRestarted(lapse.cause);
                self.link.send(&Report::State(restarted));
            }
        }
        // Not before: the block is read in place.
        self.items.dequeue();
        if let Some(estimate) = estimate {
            self.enter(State::Tracking, log);
            let methods = self.methods(&estimate);
            self.link.send(&Report::Estimate(estimate));
            if let Some(methods) = methods {
                self.link.send(&Report::Methods(methods));
            }
        }
        if self.wants_search() {
            self.enter(State::Searching, log);
        }
        true
    }

    /// Publishes the wanted search to the interrupt; true if it is a new one.
    fn wants_search(&mut self) -> bool {
        let (wanted, published) = (self.tracker.wanted_search(), &self.counts.wanted_search);
        let is_new = wanted != published.load(Ordering::Relaxed);
        published.store(wanted, Ordering::Relaxed);
        is_new
    }

    /// The methods over an estimate's window, if they are wanted and neither the blocks' queue nor the outbox is filling up.
    fn methods(&mut self, estimate: &Estimate) -> Option<Methods> {
        let rate = self.configuration.settings.sample_rate;
        if !AVAILABLE || !self.configuration.methods {
            return None;
        }
        let tuned = self
            .tuning
            .is_some_and(|tuning| tuning.serves(estimate, rate));
        if !tuned && estimate.flags.is_empty() {
            let tuning = Some(Tuning::of(estimate, rate));
            if self.ask(Request::Tune(tuning)).is_ok() {
                self.tuning = tuning;
            }
        }
        let hurry = self.items.len() > QUEUE / 8 || self.link.waiting() > OUTBOX / 2;
        if hurry {
            None
        } else {
            self.history.compare(estimate, rate)
        }
    }

    fn enter(&mut self, state: State, log: &mut impl FnMut(Event)) {
        if self.state != state {
            self.state = state;
            self.link.send(&Report::State(state));
            log(Event::State(state));
        }
    }

    /// Reports that the device does not sample, and why.
    pub fn fault(&mut self, cause: Cause, mut log: impl FnMut(Event)) {
        self.enter(State::Fault(cause), &mut log);
    }

    fn hello(&mut self) {
        let hello = Hello::new(VERSION, self.configuration);
        self.link.send(&Report::Hello(hello));
    }

    /// Updates the counters.
    fn update(&mut self) {
        let (counts, c) = (self.counts, &mut self.counters);
        let before = *c;
        // The interrupt's 32-bit counts wrap, their differences do not.
        for (total, count) in [
            (&mut c.pairs, &counts.pairs),
            (&mut c.pairs_lost, &counts.pairs_lost),
            (&mut c.saturated_pairs, &counts.saturated_pairs),
        ] {
            *total += u64::from(count.get().wrapping_sub(*total as u32));
        }
        c.saturated_blocks = counts.saturated_blocks.get();
        c.overruns = counts.overruns.get();
        c.blocks_dropped = counts.blocks_dropped.get();
        c.restarts = counts.restarts.get();
        c.commands_damaged = self.link.damaged();
        c.reports_dropped = self.link.dropped();
        self.has_news |= c.blocks_dropped != before.blocks_dropped || c.restarts != before.restarts;
    }

    /// Sends the current counters; if there is no room they remain due.
    pub fn report_counters(&mut self) {
        self.update();
        if self.link.send(&Report::Counters(self.counters)) {
            self.has_news = false;
            self.reported = self.now;
        }
    }

    /// True once a command has asked for a restart, and all reports are sent or [`RESTART_MS`] have passed.
    pub fn wants_restart(&self) -> bool {
        self.restart
            .is_some_and(|asked| self.link.is_empty() || self.now.wrapping_sub(asked) >= RESTART_MS)
    }

    /// True if the source's interrupt must be pended, because no pairs have come for too long.
    pub fn asks_for_source(&self) -> bool {
        self.needs_source
    }

    /// True if all reports are sent.
    pub fn is_flushed(&self) -> bool {
        self.link.is_empty()
    }

    /// Commands answered so far.
    pub fn answered(&self) -> u32 {
        self.answered
    }
}
