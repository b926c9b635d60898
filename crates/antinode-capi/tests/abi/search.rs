//! A new search, by a call of the thread or after the loss of the wave: the wave is dropped, and found again.

use antinode_capi::*;

use crate::core_rows::{Halves, RATE, TURN, codes, same};
use crate::gyro::{Arithmetic, Gyro, Way};

fn a_wave_is_dropped_and_found_again<S: Arithmetic>(frequency: f32) {
    let codes = codes(10_000, 5_332.0);
    // The start angle is far from the default, to which a first window's angle would go.
    let settings = Settings {
        frequency_hz: frequency,
        start_angle_rad: 10.0,
        ..antinode_settings_default(RATE)
    };
    let searched = u32::from(frequency == 0.0);
    let mut gyro = Gyro::<S>::new(&settings);
    let mut ours = gyro.run(Way::Interleaved, 100, &codes[..5_000]);
    let last = *ours.last().unwrap();
    // Two windows wait.
    assert_eq!(gyro.push(Way::Packed, &codes[5_000..5_500]), Status::Ready);
    let before = gyro.health();
    assert_eq!((before.searching, before.has_wave), (0, 1));
    assert!(before.waiting > 10);

    assert_eq!(gyro.search(), Status::Ok);
    let asked = Health {
        has_wave: 0,
        ..before
    };
    assert_eq!(gyro.health(), asked);
    assert_eq!(gyro.push(Way::Single, &codes[5_500..5_501]), Status::Ok);
    let heard = Health {
        searching: searched,
        ..asked
    };
    assert_eq!(gyro.health(), heard);
    // The blocks that waited belong to the old search, and are discarded.
    assert_eq!(gyro.solve().0, Status::Ok);
    let dropped = Health {
        waiting: 0,
        ..heard
    };
    assert_eq!(gyro.health(), dropped);

    let found = ours.len();
    ours.extend(gyro.run(Way::Separate, 100, &codes[5_501..]));
    let tracked = Health {
        searching: 0,
        has_wave: 1,
        ..dropped
    };
    let waiting = gyro.health().waiting;
    assert_eq!(gyro.health(), Health { waiting, ..tracked });
    let first = ours[found];
    assert_eq!(first.flags, ANTINODE_FLAG_REACQUIRED);
    assert!(ours[found + 1..].iter().all(|row| row.flags == 0));
    assert!((last.angle_rad - 10.0).abs() < 0.8, "{last:?}");
    let turned = TURN * (first.time_s - last.time_s);
    let off = first.angle_rad - last.angle_rad - turned;
    assert!(off.abs() < 1e-3, "{last:?} {first:?}");

    let mut core = Halves::<S>::new(&settings);
    let mut expected = core.run(&codes[..5_000]);
    core.blocks(&codes[5_000..5_500]);
    core.tracker.search();
    expected.extend(core.run(&codes[5_500..]));
    same(&format!("{frequency} Hz"), &ours, &expected);
}

#[test]
fn a_wave_is_dropped_and_found_again_in_both() {
    for frequency in [0.0, 5_400.0] {
        a_wave_is_dropped_and_found_again::<i16>(frequency);
        a_wave_is_dropped_and_found_again::<f32>(frequency);
    }
}

fn a_lost_wave_is_searched_by_itself<S: Arithmetic>() {
    let silence = vec![[0; 2]; 3_000];
    let codes = [codes(5_000, 5_332.0), silence, codes(6_000, 4_100.0)].concat();
    let settings = antinode_settings_default(RATE);
    let mut gyro = Gyro::<S>::new(&settings);
    let mut core = Halves::<S>::new(&settings);
    let (mut ours, mut expected) = (Vec::new(), Vec::new());
    let mut dropped = Vec::new();
    // The thread is late: it sees the loss while later blocks wait, and the interrupt learns of it with the next piece.
    for piece in codes.chunks(400) {
        let found = expected.len();
        let blocks = core.blocks(piece);
        for (i, block) in blocks.iter().enumerate() {
            let before = core.tracker.wanted_search();
            expected.extend(core.tracker.push(block));
            if core.tracker.wanted_search() != before {
                dropped.push(blocks.len() - 1 - i);
                break;
            }
        }
        ours.extend(gyro.run(Way::Packed, piece.len(), piece));
        same("lost", &ours[found..], &expected[found..]);
        let health = gyro.health();
        let has_wave = u32::from(core.tracker.has_wave());
        assert_eq!((health.has_wave, health.waiting), (has_wave, 0));
    }
    assert!(dropped.len() == 1 && dropped[0] > 2, "{dropped:?}");
    let last = ours.last().unwrap();
    assert!((last.frequency_hz - 4_100.0).abs() < 1.0, "{last:?}");
    let mut firsts = ours
        .iter()
        .filter(|row| row.flags & ANTINODE_FLAG_REACQUIRED != 0);
    assert!(firsts.next().unwrap().start >= 8_000);
    assert_eq!(firsts.next(), None);
}

#[test]
fn a_lost_wave_is_searched_by_itself_in_both() {
    a_lost_wave_is_searched_by_itself::<i16>();
    a_lost_wave_is_searched_by_itself::<f32>();
}

fn any_call_of_the_interrupt_obeys_a_search<S: Arithmetic>() {
    let codes = codes(1_000, 5_332.0);
    let calls: [fn(&mut Gyro<S>) -> Status; 5] = [
        |gyro| gyro.skip(100),
        |gyro| gyro.push(Way::Single, &[[100, 200]]),
        |gyro| gyro.push(Way::Separate, &[[100, 200]]),
        |gyro| gyro.push(Way::Interleaved, &[[100, 200]]),
        |gyro| gyro.push(Way::Packed, &[[100, 200]]),
    ];
    for (i, call) in calls.iter().enumerate() {
        let mut gyro = Gyro::<S>::new(&antinode_settings_default(RATE));
        gyro.run(Way::Interleaved, 100, &codes);
        assert_eq!(gyro.search(), Status::Ok);
        assert_eq!(gyro.health().searching, 0);
        assert_eq!(call(&mut gyro), Status::Ok);
        assert_eq!(gyro.health().searching, 1, "call {i}");
    }
}

#[test]
fn any_call_of_the_interrupt_obeys_a_search_in_both() {
    any_call_of_the_interrupt_obeys_a_search::<i16>();
    any_call_of_the_interrupt_obeys_a_search::<f32>();
}

#[test]
fn health_tells_whether_there_is_a_wave_with_and_without_a_search() {
    let (codes, silence) = (codes(5_000, 5_332.0), [[0; 2]; 5_000]);
    for (frequency_hz, is_there) in [(0.0, 1), (5_300.0, 1), (6_500.0, 0)] {
        let settings = Settings {
            frequency_hz,
            ..antinode_settings_default(RATE)
        };
        let mut gyro = Gyro::<i16>::new(&settings);
        let told = [&[], &codes[..], &silence].map(|codes| {
            gyro.run(Way::Interleaved, 128, codes);
            gyro.health().has_wave
        });
        assert_eq!(told, [0, is_there, 0], "{frequency_hz} Hz");
    }
}
