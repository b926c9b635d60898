//! A board on the host: its pipeline at the pace of the DMA's ring, and a serial line that takes time.

use std::mem;

use antinode::Packed;
use antinode_telemetry::{Cause, Command, Configuration, Counters, FrontEnd, Receiver, Report};
use firmware::gather::Gatherer;
use firmware::inbox::Inbox;
use firmware::instrument::Instrument;
use firmware::link::{Outgoing, Run};
use firmware::pipeline::{Places, Queues};
use firmware::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both};
use firmware::settings::{BAUD, HALF, SAMPLE_RATE, configuration};

use crate::emulator::bytes;
use crate::mirror::Recorded;
use crate::recordings;
use crate::told::{acknowledgements, counters};

/// A DMA that sends run after run at the line's rate.
pub struct Wire<'q> {
    out: Outgoing<'q>,
    run: Option<Run<'q>>,
    /// Bytes that there has been time for since the run began.
    time: usize,
    pub receiver: Receiver,
    /// Bytes received at the line's other end.
    pub reports: Vec<Report>,
}

impl<'q> Wire<'q> {
    /// An idle line.
    pub fn new(out: Outgoing<'q>) -> Self {
        Self {
            out,
            run: None,
            time: 0,
            receiver: Receiver::new(),
            reports: Vec::new(),
        }
    }

    /// Lets the time of `bytes` bytes pass.
    pub fn pass(&mut self, bytes: usize) {
        self.time += bytes;
        loop {
            if let Some(run) = self.run.take_if(|run| run.len() <= self.time) {
                self.time -= run.len();
                for &byte in run.iter() {
                    let report = self.receiver.push(byte);
                    self.reports
                        .extend(report.map(|r| r.expect("a sound frame")));
                }
                self.out.release(run);
            }
            if self.run.is_some() {
                return;
            }
            self.run = self.out.run();
            if self.run.is_none() {
                self.time = 0;
                return;
            }
        }
    }

    /// The counters received.
    pub fn counters(&self) -> Vec<Counters> {
        counters(&self.reports)
    }

    /// The ids of the acknowledgements received.
    pub fn acknowledged(&self) -> Vec<u16> {
        acknowledgements(&self.reports)
            .iter()
            .map(|acknowledgement| acknowledgement.id)
            .collect()
    }
}

/// Bytes that the line takes while half of the ring fills.
pub const BYTES: usize = (BAUD / 10) as usize * HALF / SAMPLE_RATE as usize;

/// A configuration with a hop of `blocks`: with 5 the reports are slightly more than the line carries, with 1 six times as much.
pub fn hop_of(blocks: u16) -> Configuration {
    let mut configuration = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS);
    configuration.settings.hop = Some(blocks);
    configuration
}

/// A configuration with windows of `periods`, and this hop.
pub fn windows_of(periods: u16, hop: Option<u16>) -> Configuration {
    let mut configuration = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS);
    (configuration.settings.periods, configuration.settings.hop) = (periods, hop);
    configuration
}

/// Parts of a board that a test uses.
pub struct Board<'q> {
    pub instrument: &'q mut Instrument<'q, i16>,
    pub inbox: &'q Inbox,
    pub wire: Wire<'q>,
    /// Halves of the ring so far, and the time, ms.
    pub half: usize,
    pub now: u32,
    /// Additional halves that fill before the main loop's next turn.
    pub missed: usize,
}

impl Board<'static> {
    /// A board at rest, with the gatherer for its converter's interrupt. It is never freed: a test has only a few.
    pub fn new(configuration: Configuration) -> (&'static mut Gatherer<'static, i16>, Self) {
        let queues = Box::leak(Box::new(Queues::new()));
        let parts = queues
            .split(
                Box::leak(Box::new(Places::new())),
                configuration,
                Cause::Unknown,
            )
            .expect("the settings can be");
        let board = Self {
            instrument: parts.instrument,
            inbox: parts.inbox,
            wire: Wire::new(parts.out),
            half: 0,
            now: 0,
            missed: 0,
        };
        (parts.gatherer, board)
    }
}

impl Board<'_> {
    pub fn command(&self, id: u16, command: Command) {
        for byte in bytes(id, command) {
            self.inbox.put(byte);
        }
    }
}

/// Runs a board that samples a wave for up to 2 s. After each half of the ring it calls `go_on`, and stops if that gives false.
pub fn board(configuration: Configuration, go_on: impl FnMut(&mut Board<'_>) -> bool) {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 200_000);
    board_on(&recording, configuration, go_on);
}

/// The same on a recording.
pub fn board_on(
    recording: &[Packed],
    configuration: Configuration,
    mut go_on: impl FnMut(&mut Board<'_>) -> bool,
) {
    let (gatherer, mut board) = Board::new(configuration);
    let mut source = Recorded::new(recording);
    while go_on(&mut board) {
        for _ in 0..=mem::take(&mut board.missed) {
            gatherer.serve(&mut source);
            board.half += 1;
        }
        board.now = (board.half * HALF * 1000 / SAMPLE_RATE as usize) as u32;
        assert!(board.half * HALF < recording.len(), "it does not end");
        board.instrument.poll(board.now, |_| {});
    }
}

/// A source that loses this many pairs at every call.
pub struct Losing(pub u32);

impl Source for Losing {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        Ready::Lapse(self.restart(Cause::Overrun))
    }

    fn pairs(&self) -> &[Packed] {
        &[]
    }

    fn is_intact(&self) -> bool {
        true
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        Lapse {
            cause,
            lost: self.0,
        }
    }

    fn rails(&self) -> [Packed; 2] {
        both(DUAL_ADC_RAILS)
    }

    fn is_at_rail(&self, _: Packed) -> bool {
        false
    }
}
