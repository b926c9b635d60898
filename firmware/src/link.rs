//! The serial line's side of the main loop: reports go out while there is room, commands come in byte by byte.

use antinode_telemetry::{CommandFrame, Decoder, MAX_FRAME, Report, Reporter};
use bbqueue::nicknames::Churrasco;
use bbqueue::prod_cons::stream::{StreamConsumer, StreamGrantR, StreamProducer};

use crate::counts::Count;
use crate::inbox::Inbox;
use crate::settings::OUTBOX;

/// Bytes that counters leave free: two frames, such as an acknowledgement and the hello before it, and one that may not fit before the
/// ring's end. Estimates and methods leave one more, for counters: on a busy line these tell what is dropped.
const RESERVE: usize = 3 * MAX_FRAME;

/// Bytes on their way to the line; they lie in runs that a DMA can fetch.
pub type Outbox = Churrasco<OUTBOX>;
/// A run of bytes for the line.
pub type Run<'q> = StreamGrantR<&'q Outbox>;

/// The line's end of the outbox.
pub struct Outgoing<'q> {
    runs: StreamConsumer<&'q Outbox>,
    sent: &'q Count,
}

impl<'q> Outgoing<'q> {
    /// The end of an outbox, which counts the bytes that were `sent`.
    pub fn new(outbox: &'q Outbox, sent: &'q Count) -> Self {
        Self {
            runs: outbox.stream_consumer(),
            sent,
        }
    }

    /// The next run, if there is one.
    pub fn run(&mut self) -> Option<Run<'q>> {
        self.runs.read().ok()
    }

    /// Gives back a run that was sent.
    pub fn release(&mut self, run: Run<'q>) {
        let length = run.len();
        run.release(length);
        self.sent.add(length as u32);
    }
}

/// Reports out and commands in.
pub struct Link<'q> {
    out: StreamProducer<&'q Outbox>,
    sent: &'q Count,
    inbox: &'q Inbox,
    /// Where the next byte lies in it.
    at: usize,
    reporter: Reporter,
    decoder: Decoder<CommandFrame>,
    /// Bytes put into the outbox; they wrap.
    put: u32,
    dropped: u32,
    damaged: u32,
    closed: bool,
}

impl<'q> Link<'q> {
    /// A link whose next report is number 0.
    pub fn new(outbox: &'q Outbox, sent: &'q Count, inbox: &'q Inbox) -> Self {
        Self {
            out: outbox.stream_producer(),
            sent,
            inbox,
            at: 0,
            reporter: Reporter::new(),
            decoder: Decoder::new(),
            put: 0,
            dropped: 0,
            damaged: 0,
            closed: false,
        }
    }

    /// Sends a report; false where there is no room for any frame, or none beside the reserve: a slow reader stalls nothing. The report is
    /// dropped then and counted, but for counters, which come again.
    pub fn send(&mut self, report: &Report) -> bool {
        if self.closed {
            return false;
        }
        let reserve = match report {
            Report::Hello(_) | Report::State(_) | Report::Acknowledgement(_) => 0,
            Report::Counters(_) => RESERVE,
            _ => RESERVE + MAX_FRAME,
        };
        let is_free = self.waiting() + reserve + MAX_FRAME <= OUTBOX;
        let grant = || self.out.grant_exact(MAX_FRAME).ok();
        let Some(mut room) = is_free.then(grant).flatten() else {
            if !matches!(report, Report::Counters(_)) {
                self.reporter.skip();
                self.dropped = self.dropped.wrapping_add(1);
            }
            return false;
        };
        // It never fails with that much room.
        let length = self
            .reporter
            .frame(report, &mut room)
            .map_or(0, |frame| frame.len());
        room.commit(length);
        self.put = self.put.wrapping_add(length as u32);
        true
    }

    /// Sends no more reports than those that wait already.
    pub fn close(&mut self) {
        self.closed = true;
    }

    /// The next command that has arrived whole.
    pub fn command(&mut self) -> Option<CommandFrame> {
        while let Some(byte) = self.inbox.take(&mut self.at) {
            match self.decoder.push(byte) {
                None => {}
                Some(Ok(command)) => return Some(command),
                Some(Err(_)) => self.damaged = self.damaged.wrapping_add(1),
            }
        }
        None
    }

    /// True when all bytes were sent.
    pub fn is_empty(&self) -> bool {
        self.put == self.sent.get()
    }

    /// Bytes that wait for the line.
    pub fn waiting(&self) -> usize {
        self.put.wrapping_sub(self.sent.get()) as usize
    }

    /// Reports that found no room.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Command frames that were damaged.
    pub fn damaged(&self) -> u32 {
        self.damaged
    }
}
