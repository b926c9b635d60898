//! A line that is too slow, dead or busy, and a busy main loop.

use std::sync::atomic::Ordering;

use antinode_telemetry::Command;
use firmware::instrument::Event;
use firmware::settings::{INBOX, QUEUE, RESTART_MS};

use crate::board::{BYTES, Board, Losing, board, hop_of};
use crate::emulator::bytes;

#[test]
fn a_saturated_line_still_acknowledges_commands() {
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
    // The last acknowledgement may still be under way.
    assert!(asked.len() - answered.len() <= 1, "{answered:?}");
}

#[test]
fn a_busy_line_does_not_delay_a_restart() {
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
        // The content of the outbox takes 22 ms.
        let took = restarted - asked;
        assert!(took < 30, "hop {hop}: it took {took} ms");
    }
}

#[test]
fn a_dead_line_does_not_delay_a_restart_for_ever() {
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
fn a_dma_can_fill_the_inbox_endlessly() {
    let (mut place, mut asked, mut answered) = (0, Vec::new(), Vec::new());
    board(hop_of(1), |board| {
        board.wire.pass(10 * BYTES);
        if board.half < 100 {
            asked.push(board.half as u16);
            for byte in bytes(board.half as u16, Command::Get) {
                board.inbox.places()[place].store(byte, Ordering::Relaxed);
                place = (place + 1) % INBOX;
            }
            // Delimiters now and then, up to the ring's very end.
            while board.half % 10 == 5 && place != 0 {
                board.inbox.places()[place].store(0, Ordering::Relaxed);
                place = (place + 1) % INBOX;
            }
            // NDTR counts down; at a round's end it may be read as 0.
            board.inbox.left((INBOX - place) % INBOX);
        }
        answered = board.wire.acknowledged();
        board.half < 200
    });
    assert_eq!(answered, asked);
    assert!(asked.len() * bytes(0, Command::Get).len() > 2 * INBOX);
}

#[test]
fn a_queue_that_never_empties_does_not_block_the_main_loop() {
    let (gatherer, board) = Board::new(hop_of(1));
    gatherer.serve(&mut Losing(1));
    for now in 0..3 {
        let mut taken = 0;
        // The interrupt refills the queue whenever an item is taken.
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
