//! Priority of reports on a line without room for all of them, without loss of blocks.

use antinode_sim::Wave;
use antinode_telemetry::{Command, Configuration, Counters, Report};
use firmware::settings::{COUNTERS_MS, HALF, SAMPLE_RATE, SOONEST_MS};

use crate::board::{BYTES, Board, board, board_on, windows_of};
use crate::recordings;
use crate::told::estimates;

#[test]
fn counters_come_every_second_however_busy_the_line_is() {
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
fn counters_of_drops_leave_room_on_the_line_for_estimates() {
    // Blocks of so few pairs that five halves of the ring have more blocks than the queue holds.
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

#[test]
fn a_drop_is_reported_soon() {
    // So many blocks in six halves that one queue does not hold them.
    let (mut times, mut at) = (Vec::new(), 0);
    board(windows_of(2, Some(30)), |board| {
        board.wire.pass(10 * BYTES);
        if board.half == 300 {
            (board.missed, at) = (5, board.now);
        }
        let dropped =
            |counters: &Counters| (counters.blocks_dropped > 0).then_some(counters.uptime_ms);
        times = board.wire.counters().iter().map(dropped).collect();
        board.now < 900
    });
    assert!(
        matches!(times[..], [Some(told)] if told < u64::from(at + SOONEST_MS)),
        "{at}: {times:?}"
    );
}

/// Count of blocks dropped in 1.8 s of a wave of `frequency` Hz; `each` is called after every half of the ring.
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
        // The line is no bottleneck.
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
fn methods_drop_no_block() {
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
            // Methods take 5 ms of the main loop per window.
            board.missed = 4 * (now - compared);
            compared = now;
        });
        assert!(compared > 100, "{compared}");
        assert_eq!(dropped, 0, "{frequency} Hz, {periods} periods, {hop:?}");
    }
}

#[test]
fn counters_without_room_come_as_soon_as_there_is_some() {
    let [healthy, dead] = [false, true].map(|is_dead| {
        let (mut times, mut sent) = (Vec::new(), 0);
        board(windows_of(10, None), |board| {
            let is_asked = (600..900).contains(&board.half);
            if is_asked {
                // Answers may use the room that other reports reserve for counters.
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
    // After the first run of bytes is sent.
    let first = (900 * HALF * 1000 / SAMPLE_RATE as usize) as u64;
    assert!(dead.0.len() == 1 && dead.0[0] < first + 5, "{dead:?}");
    // A report that is put off does not count as dropped.
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
