//! A line that is too slow, too dead or too busy, and a main loop that is.

use std::sync::atomic::Ordering;

use antinode_telemetry::Command;
use firmware::instrument::Event;
use firmware::settings::{INBOX, QUEUE, RESTART_MS};

use crate::board::{BYTES, Board, Losing, board, hop_of};
use crate::emulator::bytes;

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

#[test]
fn a_queue_that_never_empties_does_not_hold_the_main_loop_up() {
    let (gatherer, board) = Board::new(hop_of(1));
    gatherer.serve(&mut Losing(1));
    for now in 0..3 {
        let mut taken = 0;
        // The interrupt comes again whenever an item is taken.
        board.instrument.poll(now, |event| {
            if matches!(event, Event::Lapse(_)) {
                taken += 1;
                assert!(taken < QUEUE, "it takes what has come meanwhile");
                gatherer.serve(&mut Losing(1));
            }
        });
        assert_eq!(taken, QUEUE - 1);
    }
}
