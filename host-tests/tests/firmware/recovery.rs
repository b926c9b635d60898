//! Losses, stalls and delays on the host: the pipeline recovers and keeps counting.

use antinode::{Calibration, Flags, Packed, SamplePair};
use antinode_sim::Wave;
use antinode_telemetry::{Cause, Command, CommandError, Report, State};
use firmware::gather::Gatherer;
use firmware::instrument::Event;
use firmware::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both};
use firmware::settings::{HALF, QUEUE, REQUESTS, SAMPLE_RATE, SOONEST_MS, STALL_MS, WATCHDOG_MS};

use crate::board::{BYTES, Board, Losing, hop_of, windows_of};
use crate::emulator::bytes;
use crate::mirror::{MISSED, Recorded, reports_of};
use crate::recordings;
use crate::told::{acknowledgements, estimates, last_counters};

/// A converter that stalls until it has been restarted a number of times; its triggers continue.
struct Halting<'a> {
    codes: &'a [Packed],
    half: &'a [Packed],
    /// Pairs triggered, and pairs handed out or lost.
    triggered: usize,
    taken: usize,
    still: u32,
}

impl<'a> Halting<'a> {
    /// A converter of these codes that does not stall.
    fn new(codes: &'a [Packed]) -> Self {
        Self {
            codes,
            half: &[],
            triggered: 0,
            taken: 0,
            still: 0,
        }
    }

    /// Runs 400 half-buffers; from the middle one on the converter stalls until `still` restarts. Before each, `put` adds bytes received.
    fn stand_still(
        &mut self,
        still: u32,
        gatherer: &mut Gatherer<'_, i16>,
        board: &mut Board<'_>,
        put: impl Fn(&Board<'_>, usize),
    ) {
        for half in 1..=400 {
            self.triggered += HALF;
            if half == 200 {
                self.still = still;
            }
            put(board, half);
            // While it stalls no interrupt of its own comes.
            if self.still == 0 || board.instrument.asks_for_source() {
                gatherer.serve(self);
            }
            let now = half * HALF * 1000 / SAMPLE_RATE as usize;
            board.instrument.poll(now as u32, |_| {});
            board.wire.pass(4 * BYTES);
        }
    }
}

impl Source for Halting<'_> {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        if self.still > 0 || self.triggered - self.taken < HALF {
            return Ready::Nothing;
        }
        self.half = &self.codes[self.taken..self.taken + HALF];
        self.taken += HALF;
        Ready::Pairs
    }

    fn pairs(&self) -> &[Packed] {
        self.half
    }

    fn is_intact(&self) -> bool {
        true
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        let lost = (self.triggered - self.taken) as u32;
        self.taken = self.triggered;
        self.still = self.still.saturating_sub(1);
        Lapse { cause, lost }
    }

    fn rails(&self) -> [Packed; 2] {
        both(DUAL_ADC_RAILS)
    }

    fn is_at_rail(&self, _: Packed) -> bool {
        false
    }
}

#[test]
fn a_stalled_converter_is_restarted() {
    let wave = Wave {
        angle_rate: 20.0,
        ..recordings::WAVE
    };
    let codes = recordings::codes(wave, recordings::quiet(), 60_000);
    for still in [1, 3] {
        let (gatherer, mut board) = Board::new(hop_of(5));
        let mut source = Halting::new(&codes);
        source.stand_still(still, gatherer, &mut board, |_, _| {});
        let told = last_counters(&board.wire.reports);
        board.instrument.report_counters();
        board.wire.pass(100 * BYTES);
        let counters = last_counters(&board.wire.reports);
        assert_eq!((counters.restarts, counters.overruns), (still, 0));
        assert_eq!(counters.saturated_blocks, 0);
        assert_eq!(counters.pairs + counters.pairs_lost, source.taken as u64);
        let least = u64::from(still * STALL_MS * SAMPLE_RATE / 1000);
        let lost = counters.pairs_lost;
        let halves = u64::from(still + 1) * HALF as u64;
        assert!((least..least + halves).contains(&lost), "{lost}");
        // The restart is reported at once.
        assert!(told.restarts > 0 && told.uptime_ms < 400, "{told:?}");
        let is_told =
            |r: &&Report| **r == Report::State(State::SamplingRestarted(Cause::Converter));
        let restarts = board.wire.reports.iter().filter(is_told).count();
        assert_eq!(restarts, still as usize);
        // Time includes the gap.
        let estimates = estimates(&board.wire.reports);
        assert!(estimates.last().is_some_and(|last| last.time > 0.5));
        for estimate in estimates {
            let off = estimate.angle - wave.angle - wave.angle_rate * estimate.time;
            assert!(off.abs() < 0.01, "{off} at {} s", estimate.time);
        }
    }
}

#[test]
fn waiting_requests_do_not_prevent_a_restart_of_the_converter() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 60_000);
    let (gatherer, mut board) = Board::new(hop_of(5));
    let mut source = Halting::new(&codes);
    source.stand_still(1, gatherer, &mut board, |board, half| {
        if (200..200 + 2 * REQUESTS).contains(&half) {
            // No interrupt comes to take the request from the queue.
            board.command(half as u16, Command::SetWindow { periods: 12 });
        }
    });
    assert_eq!(source.still, 0);
}

#[test]
fn a_device_that_does_not_sample_still_executes_commands() {
    let (_, mut board) = Board::new(hop_of(5));
    let fault = State::Fault(Cause::Clock);
    board.instrument.fault(Cause::Clock, |_| {});
    // For as long as the watchdog allows, with more commands than requests may wait.
    for now in 0..WATCHDOG_MS {
        if now % STALL_MS == STALL_MS / 2 {
            board.command(1, Command::SetWindow { periods: 12 });
        }
        board.instrument.poll(now, |_| {});
        board.wire.pass(BYTES);
    }
    let answers = acknowledgements(&board.wire.reports);
    assert!(answers.len() > 2 * REQUESTS, "{answers:?}");
    assert!(answers.iter().all(|a| a.result.is_ok()), "{answers:?}");
    // Its state remains a fault.
    let is_state = |report: &&Report| matches!(report, Report::State(_));
    let last = board.wire.reports.iter().rfind(is_state);
    assert_eq!(last, Some(&Report::State(fault)));
}

#[test]
fn commands_are_logged_as_done_or_not() {
    let (_, board) = Board::new(hop_of(5));
    board.command(1, Command::Get);
    board.command(2, Command::SetHop { blocks: Some(0) });
    let mut events = Vec::new();
    board.instrument.poll(0, |event| events.push(event));
    let answered = |id, done| Event::Answered { id, done };
    let expected = [
        answered(1, true),
        answered(2, false),
        Event::State(State::Searching),
    ];
    assert_eq!(events, expected);
}

#[test]
fn losses_while_the_queue_is_full_add_up() {
    let (gatherer, board) = Board::new(hop_of(5));
    let (mut told, mut count) = (0, 0);
    let mut tell = |event| {
        if let Event::Lapse(lapse) = event {
            (told, count) = (told + lapse.lost, count + 1);
        }
    };
    for _ in 0..QUEUE + 10 {
        gatherer.serve(&mut Losing(7));
    }
    board.instrument.poll(0, &mut tell);
    gatherer.serve(&mut Losing(7));
    board.instrument.poll(1, &mut tell);
    assert_eq!((told, count), (7 * (QUEUE as u32 + 11), QUEUE));
}

#[test]
fn counts_and_time_continue_beyond_32_bits() {
    let (gatherer, mut board) = Board::new(hop_of(5));
    // 25 days each.
    for now in [1 << 31, u32::MAX, 999] {
        gatherer.serve(&mut Losing(1_000_000_000));
        board.instrument.poll(now, |_| {});
        board.wire.pass(10 * BYTES);
    }
    let counters = last_counters(&board.wire.reports);
    assert_eq!(counters.uptime_ms, (1 << 32) + 999);
    // In the second and the third case sampling is restarted first.
    assert_eq!(counters.pairs_lost, 5_000_000_000);
}

#[test]
fn a_fault_right_after_a_report_of_counters_is_reported_soon() {
    let (gatherer, mut board) = Board::new(hop_of(5));
    let mut told = Vec::new();
    for now in 0..200 {
        if now == 10 || now == 20 {
            gatherer.serve(&mut Losing(7));
        }
        board.instrument.poll(now, |_| {});
        board.wire.pass(BYTES);
        let is_counters = |report: &Report| matches!(report, Report::Counters(_));
        told.extend(
            board
                .wire
                .reports
                .drain(..)
                .filter(is_counters)
                .map(|_| now),
        );
    }
    let expected = [10, 10 + SOONEST_MS];
    let late = told.iter().zip(expected).map(|(told, at)| told - at);
    assert!(told.len() == 2 && late.max() < Some(5), "{told:?}");
}

#[test]
fn blocks_before_the_last_answer_are_discarded() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 60_000);
    let (gatherer, mut board) = Board::new(hop_of(5));
    let mut source = Recorded::new(&codes);
    let mut asked = 0;
    for round in 0..40 {
        // At the second command the answer to the first is still in the queue, followed by blocks of the first one's settings.
        if round == 20 || round == 21 {
            asked = round * 10 * HALF;
            let hop = Command::SetHop {
                blocks: Some(round as u16 - 17),
            };
            board.command(round as u16, hop);
        }
        board.instrument.poll(0, |_| {});
        board.wire.pass(40 * BYTES);
        for _ in 0..10 {
            gatherer.serve(&mut source);
        }
    }
    let is_last = |report: &Report| matches!(report, Report::Acknowledgement(a) if a.id == 21);
    let at = board
        .wire
        .reports
        .iter()
        .position(is_last)
        .expect("it answers");
    let (before, after) = (
        estimates(&board.wire.reports[..at]),
        estimates(&board.wire.reports[at..]),
    );
    assert!(before.len() > 50 && after.len() > 50);
    assert!(
        after[0].start >= asked as u64,
        "{} is before {asked}",
        after[0].start
    );
    assert_eq!(after[0].flags, Flags::REACQUIRED);
}

#[test]
fn one_sample_at_any_rail_saturates_its_block() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 40_000);
    let [low, high] = DUAL_ADC_RAILS;
    for rail in [
        [Some(low), None],
        [Some(high), None],
        [None, Some(low)],
        [None, Some(high)],
    ] {
        let mut codes = codes.clone();
        let [c, d]: [i16; 2] = codes[20_000].pair();
        codes[20_000] = Packed::from([rail[0].unwrap_or(c), rail[1].unwrap_or(d)]);
        // The overrun has the counters reported.
        let counters = last_counters(&reports_of::<i16>(Recorded::torn(&codes, 300), (0, &[]), 1));
        let saturated = (counters.saturated_pairs, counters.saturated_blocks);
        assert_eq!(saturated, (1, 1), "{rail:?}");
    }
}

#[test]
fn a_rail_in_a_block_cut_short_by_a_gap_saturates_no_block() {
    let mut codes = recordings::codes(recordings::WAVE, recordings::quiet(), 40_000);
    codes[199 * HALF - 1] = Packed(0);
    let mut source = Recorded::torn(&codes, 200);
    let (gatherer, mut board) = Board::new(windows_of(10, None));
    for _ in 0..210 {
        gatherer.serve(&mut source);
        board.instrument.poll(0, |_| {});
        board.wire.pass(10 * BYTES);
    }
    // Those of the gap came before the next block.
    board.instrument.report_counters();
    board.wire.pass(10 * BYTES);
    let counters = last_counters(&board.wire.reports);
    let saturated = (counters.saturated_pairs, counters.saturated_blocks);
    assert_eq!((counters.restarts, saturated), (1, (1, 0)));
}

#[test]
fn no_period_from_a_torn_half_is_kept() {
    let false_wave = Wave {
        frequency: 9000.0,
        ..recordings::WAVE
    };
    let torn = recordings::codes(false_wave, recordings::quiet(), HALF);
    let wave = recordings::codes(recordings::WAVE, recordings::quiet(), 10_000);
    let codes = [torn, wave].concat();
    let missed = HALF + MISSED as usize;
    let all = estimates(&reports_of::<i16>(Recorded::torn(&codes, 1), (0, &[]), 1));
    let rest = estimates(&reports_of::<i16>(
        Recorded::new(&codes[missed..]),
        (0, &[]),
        1,
    ));
    // As if the device had been switched on after it.
    let starts: Vec<_> = all.iter().map(|estimate| estimate.start).collect();
    let late = rest.iter().map(|estimate| estimate.start + missed as u64);
    assert_eq!(starts, late.collect::<Vec<_>>());
    assert!(starts.len() > 40);
}

#[test]
fn methods_and_a_calibration_exclude_each_other() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 1000);
    let calibration = Command::SetCalibration(Calibration {
        gain_ratio: 1.05,
        ..Calibration::IDEAL
    });
    let on = |on| Command::SetMethods { on };
    let refused = Err(CommandError::Calibrated);
    let script = [
        (on(true), Ok(())),
        (calibration, refused),
        (on(false), Ok(())),
        (calibration, Ok(())),
        (on(true), refused),
    ];
    let commands: Vec<u8> = (0..)
        .zip(script)
        .flat_map(|(id, (command, _))| bytes(id, command))
        .collect();
    let reports = reports_of::<i16>(Recorded::new(&codes), (0, &commands), 1);
    let answers = acknowledgements(&reports);
    let results: Vec<_> = answers.iter().map(|answer| answer.result).collect();
    assert_eq!(results, script.map(|(_, result)| result));
}
