//! Both halves of the pipeline and the queues between them, for every image and for the tests.

use core::mem::MaybeUninit;

use antinode::{Front, Sample, SettingsError, Tracker};
use antinode_telemetry::{Cause, Configuration};
use heapless::spsc::Queue;

use crate::counts::{Count, Counts};
use crate::gather::{Gatherer, Item, Request};
use crate::inbox::Inbox;
use crate::instrument::Instrument;
use crate::link::{Link, Outbox, Outgoing};
use crate::settings::{LONGEST_PERIOD, QUEUE, REQUESTS, RING};

/// Queues between the contexts; each image has one set, in a static.
pub struct Queues<S: Sample> {
    items: Queue<Item<S>, QUEUE>,
    requests: Queue<Request, REQUESTS>,
    out: Outbox,
    sent: Count,
    inbox: Inbox,
    counts: Counts,
}

/// Memory in which the large parts are constructed and stay; each image has one, in a static.
pub struct Places<'q, S: Sample> {
    front: Front<S, LONGEST_PERIOD>,
    tracker: Tracker<RING>,
    gatherer: MaybeUninit<Gatherer<'q, S>>,
    instrument: MaybeUninit<Instrument<'q, S>>,
}

impl<S: Sample> Places<'_, S> {
    /// Places without parts.
    pub const fn new() -> Self {
        Self {
            front: Front::UNSET,
            tracker: Tracker::UNSET,
            gatherer: MaybeUninit::uninit(),
            instrument: MaybeUninit::uninit(),
        }
    }
}

impl<S: Sample> Default for Places<'_, S> {
    fn default() -> Self {
        Self::new()
    }
}

/// Parts of the pipeline, each for one context.
pub struct Parts<'q, S: Sample> {
    /// For the source's interrupt.
    pub gatherer: &'q mut Gatherer<'q, S>,
    /// For the main loop.
    pub instrument: &'q mut Instrument<'q, S>,
    /// For the line's interrupt: bytes to send.
    pub out: Outgoing<'q>,
    /// For the line's interrupt: bytes received.
    pub inbox: &'q Inbox,
}

impl<S: Sample> Queues<S> {
    /// Empty queues.
    pub const fn new() -> Self {
        Self {
            items: Queue::new(),
            requests: Queue::new(),
            out: Outbox::new(),
            sent: Count::new(),
            inbox: Inbox::new(),
            counts: Counts::new(),
        }
    }

    /// Constructs the parts of a pipeline; `cause` is reported as that of the start.
    ///
    /// # Errors
    ///
    /// Those of [`antinode::Settings::check`].
    pub fn split<'q>(
        &'q mut self,
        places: &'q mut Places<'q, S>,
        configuration: Configuration,
        cause: Cause,
    ) -> Result<Parts<'q, S>, SettingsError> {
        let (items, taken) = self.items.split();
        let (requests, asked) = self.requests.split();
        let inbox = &self.inbox;
        let link = Link::new(&self.out, &self.sent, inbox);
        let counts = &self.counts;
        let settings = configuration.settings;
        let Places {
            front,
            tracker,
            gatherer,
            instrument,
        } = places;
        front.configure(settings)?;
        tracker.configure(settings)?;
        let gatherer = Gatherer::make(gatherer, front, items, asked, counts);
        let instrument = Instrument::make(
            instrument,
            (tracker, configuration),
            taken,
            requests,
            counts,
            link,
            cause,
        );
        Ok(Parts {
            gatherer,
            instrument,
            out: Outgoing::new(&self.out, &self.sent),
            inbox,
        })
    }
}

impl<S: Sample> Default for Queues<S> {
    fn default() -> Self {
        Self::new()
    }
}
