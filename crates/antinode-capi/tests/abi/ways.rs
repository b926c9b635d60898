//! Every push function takes every pair, however many a call has, and returns the same status.

use antinode_capi::*;

use crate::core_rows::{Halves, RATE, codes, rows, same};
use crate::gyro::{Arithmetic, Gyro, Way};

/// The status of a push that took the state from one health to another.
fn answer(before: Health, after: Health) -> Status {
    if after.dropped != before.dropped {
        Status::Dropped
    } else if after.waiting != before.waiting {
        Status::Ready
    } else {
        Status::Ok
    }
}

fn pieces_of_any_length_give_the_cores_rows<S: Arithmetic>() {
    // A slow wave: a thousand pairs of it fill half the queue.
    let codes = codes(30_000, 1_670.0);
    let settings = antinode_settings_default(RATE);
    let expected = rows::<S>(&settings, &codes);
    assert!(expected.len() > 45);
    for way in Way::BLOCKS {
        for step in [1, 7, 64, 65, 1_000] {
            let ours = Gyro::<S>::new(&settings).run(way, step, &codes);
            same(&format!("{way:?}, {step} at once"), &ours, &expected);
        }
    }
}

#[test]
fn pieces_of_any_length_give_the_cores_rows_in_both() {
    pieces_of_any_length_give_the_cores_rows::<i16>();
    pieces_of_any_length_give_the_cores_rows::<f32>();
}

fn the_status_of_a_call_covers_all_its_blocks<S: Arithmetic>(way: Way) {
    let codes = codes(900, 5_332.0);
    let mut gyro = Gyro::<S>::new(&antinode_settings_default(RATE));
    let mut seen = Vec::new();
    // From a call that finishes no block to one that fills the queue early and finishes none at its end. Blocks that already wait must not
    // count.
    for count in 1..800 {
        for first in [0, 100] {
            assert_eq!(gyro.reset(), Status::Ok);
            gyro.push(way, &codes[..first]);
            let before = gyro.health();
            let status = gyro.push(way, &codes[first..first + count]);
            let expected = answer(before, gyro.health());
            assert_eq!(status, expected, "{way:?}, {first} pairs, then {count}");
            if !seen.contains(&status) {
                seen.push(status);
            }
        }
    }
    assert_eq!(seen, [Status::Ok, Status::Ready, Status::Dropped]);
}

#[test]
fn the_status_of_a_call_covers_all_its_blocks_in_both() {
    for way in Way::ALL {
        the_status_of_a_call_covers_all_its_blocks::<i16>(way);
        the_status_of_a_call_covers_all_its_blocks::<f32>(way);
    }
}

fn a_full_queue_keeps_the_oldest_blocks<S: Arithmetic>() {
    let codes = codes(14_000, 5_332.0);
    let settings = antinode_settings_default(RATE);
    let mut core = Halves::<S>::new(&settings);
    let blocks = core.blocks(&codes[..10_000]);
    let mut expected = core.solve(&blocks[..ANTINODE_QUEUE_BLOCKS]);
    // The dropped blocks leave a gap, which shows only at the next block.
    expected.extend(core.run(&codes[10_000..]));
    assert!(expected.len() > 20);
    for way in Way::ALL {
        let mut gyro = Gyro::<S>::new(&settings);
        let status = gyro.push(way, &codes[..10_000]);
        assert_eq!(status, Status::Dropped, "{way:?}");
        let health = gyro.health();
        assert_eq!(health.waiting as usize, ANTINODE_QUEUE_BLOCKS, "{way:?}");
        let dropped = blocks.len() - ANTINODE_QUEUE_BLOCKS;
        assert_eq!(health.dropped as usize, dropped, "{way:?}");
        let mut ours = gyro.rows();
        ours.extend(gyro.run(way, 100, &codes[10_000..]));
        same(&format!("{way:?}"), &ours, &expected);
        assert_eq!(gyro.health().dropped as usize, dropped, "{way:?}");
    }
}

#[test]
fn a_full_queue_keeps_the_oldest_blocks_in_both() {
    a_full_queue_keeps_the_oldest_blocks::<i16>();
    a_full_queue_keeps_the_oldest_blocks::<f32>();
}
