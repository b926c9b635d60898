//! A line that is too slow, too dead or too busy, and a main loop that is: the pipeline on the host, at the pace of a board.

use std::mem;
use std::sync::atomic::Ordering;

use antinode::Packed;
use antinode_sim::Wave;
use antinode_telemetry::{Cause, Command, Configuration, Counters, FrontEnd, Receiver, Report};
use firmware::inbox::Inbox;
use firmware::instrument::{Event, Instrument};
use firmware::link::{Outgoing, Run};
use firmware::pipeline::{Places, Queues};
use firmware::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both};
use firmware::settings::{
    BAUD, COUNTERS_MS, HALF, INBOX, QUEUE, RESTART_MS, SAMPLE_RATE, SOONEST_MS, configuration,
};

use crate::emulator::bytes;
use crate::mirror::Recorded;
use crate::recordings;
use crate::same::estimates;

/// A DMA that sends run after run at the line's rate.
pub struct Wire<'q> {
    out: Outgoing<'q>,
    run: Option<Run<'q>>,
    /// Bytes that there was time for since the run began.
    time: usize,
    receiver: Receiver,
    /// What came out at its end.
    pub reports: Vec<Report>,
}

impl<'q> Wire<'q> {
    /// A line on which nothing is.
    pub fn new(out: Outgoing<'q>) -> Self {
        Self {
            out,
            run: None,
            time: 0,
            receiver: Receiver::new(),
            reports: Vec::new(),
        }
    }

    /// Time for so many bytes passes.
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

    /// The counters that came.
    fn counters(&self) -> Vec<Counters> {
        let counters = |report: &Report| match report {
            Report::Counters(counters) => Some(*counters),
            _ => None,
        };
        self.reports.iter().filter_map(counters).collect()
    }

    /// The acknowledgements that came.
    fn acknowledged(&self) -> Vec<u16> {
        let id = |report: &Report| match report {
            Report::Acknowledgement(acknowledgement) => Some(acknowledgement.id),
            _ => None,
        };
        self.reports.iter().filter_map(id).collect()
    }
}

/// Bytes that the line takes while half of the ring fills.
pub const BYTES: usize = (BAUD / 10) as usize * HALF / SAMPLE_RATE as usize;

/// A window at every so many blocks: at 5 the reports are a little more than the line takes, at 1 six times as much.
pub fn hop_of(blocks: u16) -> Configuration {
    let mut configuration = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS);
    configuration.settings.hop = Some(blocks);
    configuration
}

/// What a test has of a board.
struct Board<'q> {
    instrument: &'q mut Instrument<'q, i16>,
    inbox: &'q Inbox,
    wire: Wire<'q>,
    /// Halves of the ring so far, and the time, ms.
    half: usize,
    now: u32,
    /// Halves that fill before the main loop has its next turn, beside one.
    missed: usize,
}

impl Board<'_> {
    fn command(&self, id: u16, command: Command) {
        for byte in bytes(id, command) {
            self.inbox.put(byte);
        }
    }
}

/// A board that samples a wave for up to 2 s; after each half of the ring `go_on` does what it likes, and says whether to go on.
fn board(configuration: Configuration, go_on: impl FnMut(&mut Board<'_>) -> bool) {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 200_000);
    board_on(&recording, configuration, go_on);
}

/// The same on a recording.
fn board_on(
    recording: &[Packed],
    configuration: Configuration,
    mut go_on: impl FnMut(&mut Board<'_>) -> bool,
) {
    let (mut queues, mut places) = (Queues::<i16>::new(), Places::new());
    let parts = queues
        .split(&mut places, configuration, Cause::Unknown)
        .expect("the settings can be");
    let mut board = Board {
        instrument: parts.instrument,
        inbox: parts.inbox,
        wire: Wire::new(parts.out),
        half: 0,
        now: 0,
        missed: 0,
    };
    let mut source = Recorded::new(recording);
    while go_on(&mut board) {
        for _ in 0..=mem::take(&mut board.missed) {
            parts.gatherer.serve(&mut source);
            board.half += 1;
        }
        board.now = (board.half * HALF * 1000 / SAMPLE_RATE as usize) as u32;
        assert!(board.half * HALF < recording.len(), "it does not end");
        board.instrument.poll(board.now, |_| {});
    }
}

#[test]
fn a_saturated_line_acknowledges() {
    let (mut asked, mut answered, mut lost) = (Vec::new(), Vec::new(), 0);
    board(hop_of(1), |board| {
        board.wire.pass(BYTES);
        if board.half % 50 == 49 {
            asked.push(board.half as u16);
            board.command(board.half as u16, Command::Get);
        }
        (answered, lost) = (board.wire.acknowledged(), board.wire.receiver.lost());
        board.half < 1000
    });
    assert!(lost > 500, "the line is not saturated: {lost} lost");
    assert_eq!(answered, asked[..answered.len()]);
    // The last may still be on its way.
    assert!(asked.len() - answered.len() <= 1, "{answered:?}");
}

#[test]
fn a_busy_line_does_not_hold_a_restart_up() {
    for (hop, half) in (1..=5).flat_map(|hop| (400..420).map(move |half| (hop, half))) {
        let (mut asked, mut restarted, mut answered) = (0, 0, Vec::new());
        board(hop_of(hop), |board| {
            board.wire.pass(BYTES);
            if board.half == half {
                board.command(7, Command::Restart);
                asked = board.now;
            }
            (restarted, answered) = (board.now, board.wire.acknowledged());
            !board.instrument.wants_restart()
        });
        assert_eq!(answered, [7], "hop {hop}");
        // What the outbox holds takes 22 ms.
        let took = restarted - asked;
        assert!(took < 30, "hop {hop}: it took {took} ms");
    }
}

#[test]
fn a_dead_line_does_not_hold_a_restart_up() {
    let (mut asked, mut restarted) = (0, 0);
    board(hop_of(1), |board| {
        if board.half == 100 {
            board.command(7, Command::Restart);
            asked = board.now;
        }
        restarted = board.now;
        !board.instrument.wants_restart()
    });
    let took = restarted - asked;
    assert!(
        (RESTART_MS..RESTART_MS + 5).contains(&took),
        "it took {took} ms"
    );
}

#[test]
fn a_dma_fills_the_inbox_round_and_round() {
    let (mut place, mut asked, mut answered) = (0, Vec::new(), Vec::new());
    board(hop_of(1), |board| {
        board.wire.pass(10 * BYTES);
        if board.half < 100 {
            asked.push(board.half as u16);
            for byte in bytes(board.half as u16, Command::Get) {
                board.inbox.places()[place].store(byte, Ordering::Relaxed);
                place = (place + 1) % INBOX;
            }
            // Delimiters, now and then, to the ring's very end.
            while board.half % 10 == 5 && place != 0 {
                board.inbox.places()[place].store(0, Ordering::Relaxed);
                place = (place + 1) % INBOX;
            }
            // NDTR counts down; at a round's end it may be seen at nothing.
            board.inbox.left((INBOX - place) % INBOX);
        }
        answered = board.wire.acknowledged();
        board.half < 200
    });
    assert_eq!(answered, asked);
    assert!(asked.len() * bytes(0, Command::Get).len() > 2 * INBOX);
}

/// A source that loses so many pairs whenever it is asked.
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

#[test]
fn a_queue_that_never_empties_does_not_hold_the_main_loop_up() {
    let (mut queues, mut places) = (Queues::<i16>::new(), Places::new());
    let parts = queues
        .split(&mut places, hop_of(1), Cause::Unknown)
        .expect("the settings can be");
    parts.gatherer.serve(&mut Losing(1));
    for now in 0..3 {
        let mut taken = 0;
        // The interrupt comes again whenever an item is taken.
        parts.instrument.poll(now, |event| {
            if matches!(event, Event::Lapse(_)) {
                taken += 1;
                assert!(taken < QUEUE, "it takes what has come meanwhile");
                parts.gatherer.serve(&mut Losing(1));
            }
        });
        assert_eq!(taken, QUEUE - 1);
    }
}

/// Windows of so many periods, at every so many blocks.
fn windows_of(periods: u16, hop: Option<u16>) -> Configuration {
    let mut configuration = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS);
    (configuration.settings.periods, configuration.settings.hop) = (periods, hop);
    configuration
}

#[test]
fn counters_come_every_second_however_busy_the_line() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 1_000_000);
    for (periods, hop) in [(10, None), (10, Some(1)), (10, Some(2)), (2, None)] {
        let (mut times, mut lost) = (vec![0], 0);
        board_on(&recording, windows_of(periods, hop), |board| {
            board.wire.pass(BYTES);
            let counters = board.wire.counters();
            times.truncate(1);
            times.extend(counters.iter().map(|counters| counters.uptime_ms));
            lost = board.wire.receiver.lost();
            board.now < 9900
        });
        assert_eq!(lost > 1000, periods == 2 || hop.is_some(), "{lost} lost");
        assert_eq!(times.len(), 10, "{periods}, {hop:?}: {times:?}");
        let most = u64::from(COUNTERS_MS) + 10;
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] <= most));
    }
}

#[test]
fn counters_that_tell_of_drops_leave_the_line_to_estimates() {
    // Blocks of so few pairs that five halves of the ring have more of them than the queue holds.
    let configuration = windows_of(2, Some(30));
    let (mut counters, mut estimated, mut lost) = (Vec::new(), 0, 0);
    let mut end = 0;
    board(configuration, |board| {
        board.missed = 4;
        board.wire.pass(5 * BYTES);
        (counters, lost) = (board.wire.counters(), board.wire.receiver.lost());
        estimated = estimates(&board.wire.reports).len();
        end = board.now;
        board.now < 1800
    });
    let dropped = counters.last().expect("there are some").blocks_dropped;
    assert!(dropped > 1000 && estimated > 1000, "{dropped}, {estimated}");
    assert_eq!(lost, 0);
    assert!(
        counters.len() as u32 <= end / SOONEST_MS + 1,
        "{}",
        counters.len()
    );
}

/// What a board counts of its blocks that are dropped, in 1.8 s of a wave of so many Hz; after each half of the ring `each` does what it
/// likes.
fn blocks_dropped(
    frequency: f64,
    configuration: Configuration,
    mut each: impl FnMut(&mut Board<'_>),
) -> u32 {
    let wave = Wave {
        frequency,
        ..recordings::WAVE
    };
    let recording = recordings::codes(wave, recordings::quiet(), 200_000);
    let mut dropped = 0;
    board_on(&recording, configuration, |board| {
        // The line is not in the way.
        board.wire.pass(100 * BYTES);
        each(board);
        let last = board.wire.counters().last().copied();
        dropped = last.map_or(0, |counters| counters.blocks_dropped);
        board.now < 1800
    });
    dropped
}

#[test]
fn a_half_of_the_ring_has_no_more_blocks_than_the_queue_holds() {
    for (frequency, hop) in [
        (5332.0, Some(1)),
        (9000.0, None),
        // Blocks of two pairs.
        (13_000.0, Some(40)),
        (24_000.0, None),
    ] {
        let dropped = blocks_dropped(frequency, windows_of(2, hop), |_| {});
        assert_eq!(dropped, 0, "{frequency} Hz, {hop:?}");
    }
}

#[test]
fn methods_cost_no_block() {
    for (frequency, periods, hop) in [
        (5332.0, 10, None),
        (5332.0, 10, Some(10)),
        (5332.0, 20, Some(20)),
        (8000.0, 20, None),
        (8000.0, 20, Some(20)),
        (12_000.0, 22, None),
        (12_000.0, 20, Some(20)),
    ] {
        let mut compared = 0;
        let dropped = blocks_dropped(frequency, windows_of(periods, hop), |board| {
            if board.half == 1 {
                board.command(1, Command::SetMethods { on: true });
            }
            let is_methods = |report: &&Report| matches!(report, Report::Methods(_));
            let now = board.wire.reports.iter().filter(is_methods).count();
            // 5 ms of the main loop for each.
            board.missed = 4 * (now - compared);
            compared = now;
        });
        assert!(compared > 100, "{compared}");
        assert_eq!(dropped, 0, "{frequency} Hz, {periods} periods, {hop:?}");
    }
}

#[test]
fn counters_that_find_no_room_come_as_soon_as_there_is_some() {
    let [healthy, dead] = [false, true].map(|is_dead| {
        let (mut times, mut sent) = (Vec::new(), 0);
        board(windows_of(10, None), |board| {
            let is_asked = (600..900).contains(&board.half);
            if is_asked {
                // Answers take the room that other reports leave to counters.
                board.command(1, Command::Get);
            }
            if !(is_dead && is_asked) {
                board.wire.pass(10 * BYTES);
            }
            let counters = board.wire.counters();
            times = counters.iter().map(|counters| counters.uptime_ms).collect();
            sent = board.wire.reports.len() as u64 + board.wire.receiver.lost();
            board.now < 1250
        });
        (times, sent)
    });
    assert_eq!(healthy.0, [951]);
    // With the first run of bytes that has left.
    let first = (900 * HALF * 1000 / SAMPLE_RATE as usize) as u64;
    assert!(dead.0.len() == 1 && dead.0[0] < first + 5, "{dead:?}");
    // A report that was put off is none that was lost.
    assert_eq!(healthy.1, dead.1);
}

#[test]
fn methods_give_way_to_estimates() {
    let (mut estimated, mut compared, mut lost) = (0, 0, 0);
    board(windows_of(10, None), |board| {
        board.wire.pass(BYTES);
        if board.half == 1 {
            board.command(1, Command::SetMethods { on: true });
        }
        let is_methods = |report: &&Report| matches!(report, Report::Methods(_));
        compared = board.wire.reports.iter().filter(is_methods).count();
        estimated = estimates(&board.wire.reports).len();
        lost = board.wire.receiver.lost();
        board.now < 1800
    });
    assert_eq!(lost, 0);
    assert!(
        compared > 100 && compared < estimated,
        "{compared} of {estimated}"
    );
}
