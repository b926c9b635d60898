//! The serial line's side of the main loop: reports go out while there is room, commands come in byte by byte.

use antinode_telemetry::{CommandFrame, Decoder, MAX_FRAME, Report, Reporter};
use heapless::spsc::{Consumer, Producer};

use crate::settings::{INBOX, OUTBOX};

/// Reports out and commands in, through two queues of bytes that the line's interrupt empties and fills.
pub struct Link<'q> {
    out: Producer<'q, u8, OUTBOX>,
    bytes: Consumer<'q, u8, INBOX>,
    reporter: Reporter,
    decoder: Decoder<CommandFrame>,
    dropped: u32,
    damaged: u32,
}

impl<'q> Link<'q> {
    /// A link whose next report is number 0.
    pub const fn new(out: Producer<'q, u8, OUTBOX>, bytes: Consumer<'q, u8, INBOX>) -> Self {
        Self {
            out,
            bytes,
            reporter: Reporter::new(),
            decoder: Decoder::new(),
            dropped: 0,
            damaged: 0,
        }
    }

    /// Sends a report, or drops and counts it where there is no room for all of it: a slow reader stalls nothing.
    pub fn send(&mut self, report: Report) {
        let mut buffer = [0; MAX_FRAME];
        let room = self.out.capacity() - self.out.len();
        match self.reporter.frame(report, &mut buffer) {
            Ok(frame) if frame.len() <= room => {
                for &byte in frame {
                    let _ = self.out.enqueue(byte);
                }
            }
            _ => self.dropped = self.dropped.wrapping_add(1),
        }
    }

    /// The next command that has arrived whole.
    pub fn command(&mut self) -> Option<CommandFrame> {
        while let Some(byte) = self.bytes.dequeue() {
            match self.decoder.push(byte) {
                None => {}
                Some(Ok(command)) => return Some(command),
                Some(Err(_)) => self.damaged = self.damaged.wrapping_add(1),
            }
        }
        None
    }

    /// True when all bytes are with the line.
    pub fn is_empty(&self) -> bool {
        self.out.len() == 0
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
