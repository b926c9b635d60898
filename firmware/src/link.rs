//! The main loop's end of the serial line: reports go out while there is room, commands come in byte by byte.

use antinode_telemetry::{CommandFrame, Decoder, MAX_FRAME, Report, Reporter};
use bbqueue::nicknames::Churrasco;
use bbqueue::prod_cons::stream::{StreamConsumer, StreamGrantR, StreamProducer};

use crate::counts::Count;
use crate::inbox::Inbox;
use crate::settings::OUTBOX;

/// Bytes that a report of counters leaves free: two frames, such as an acknowledgement and the hello before it, and one for a frame that
/// does not fit before the ring's end. Estimates and methods leave one more, for counters: on a busy line these report what is dropped.
const RESERVE: usize = 3 * MAX_FRAME;

/// Bytes for the line, in contiguous runs that a DMA can fetch.
pub type Outbox = Churrasco<OUTBOX>;
/// A contiguous run of bytes for the line.
pub type Run<'q> = StreamGrantR<&'q Outbox>;

/// The line's end of the outbox.
pub struct Outgoing<'q> {
    runs: StreamConsumer<&'q Outbox>,
    sent: &'q Count,
}

impl<'q> Outgoing<'q> {
    /// The line's end of `outbox`; it adds the bytes sent to `sent`.
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

    /// Frees a run that was sent.
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
    /// Index in the inbox of the next byte to take.
    at: usize,
    reporter: Reporter,
    decoder: Decoder<CommandFrame>,
    /// Count of bytes put into the outbox; it wraps.
    put: u32,
    dropped: u32,
    damaged: u32,
    closed: bool,
}

impl<'q> Link<'q> {
    /// A link whose first report is number 0.
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

    /// Sends a report; false if there is no room for a frame of any length and the reserve, so that a slow reader stalls nothing. The
    /// report is then dropped and counted, except for counters, which will be sent later.
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
        // Never fails, as there is room for the longest frame.
        let length = self
            .reporter
            .frame(report, &mut room)
            .map_or(0, |frame| frame.len());
        room.commit(length);
        self.put = self.put.wrapping_add(length as u32);
        true
    }

    /// Closes the link: only reports that wait already are still sent.
    pub fn close(&mut self) {
        self.closed = true;
    }

    /// The next command that has arrived completely.
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

    /// True if all bytes are sent.
    pub fn is_empty(&self) -> bool {
        self.put == self.sent.get()
    }

    /// Bytes that wait for the line.
    pub fn waiting(&self) -> usize {
        self.put.wrapping_sub(self.sent.get()) as usize
    }

    /// Reports dropped for lack of room.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    /// Damaged command frames.
    pub fn damaged(&self) -> u32 {
        self.damaged
    }
}
