//! Operations on whole states: copying, `_identify`, initialisation of any memory, reset.

use antinode_capi::*;

use crate::core_rows::{RATE, codes, rows, same};
use crate::gyro::{Arithmetic, Gyro, UNWRITTEN, Way};

fn a_copy_goes_on_by_itself<S: Arithmetic>() {
    let settings = antinode_settings_default(RATE);
    let (ours, others) = (codes(8_000, 5_332.0), codes(8_000, 4_100.0));
    let mut gyro = Gyro::<S>::new(&settings);
    let mut rows_here = gyro.run(Way::Interleaved, 100, &ours[..4_000]);
    // The copy includes blocks in the queue.
    gyro.push(Way::Interleaved, &ours[4_000..4_300]);
    let mut copy = gyro.copy();
    assert_eq!(copy.health(), gyro.health());
    let mut rows_there = rows_here.clone();
    // A third state is used in between: none of the three affects another.
    let mut other = Gyro::<S>::new(&settings);
    let mut rows_other = other.run(Way::Interleaved, 100, &others[..4_300]);
    rows_there.extend(copy.rows());
    rows_here.extend(gyro.rows());
    for (our, others) in ours[4_300..].chunks(30).zip(others[4_300..].chunks(30)) {
        rows_here.extend(gyro.run(Way::Interleaved, 30, our));
        rows_other.extend(other.run(Way::Interleaved, 30, others));
        rows_there.extend(copy.run(Way::Interleaved, 30, our));
    }
    let expected = rows::<S>(&settings, &ours);
    assert!(expected.len() > 35);
    same("here", &rows_here, &expected);
    same("there", &rows_there, &expected);
    same("other", &rows_other, &rows::<S>(&settings, &others));
}

#[test]
fn a_copy_goes_on_by_itself_in_both() {
    a_copy_goes_on_by_itself::<i16>();
    a_copy_goes_on_by_itself::<f32>();
}

fn identify_takes_what_waits_first<S: Arithmetic>(frequency: f32) {
    // The wave is lost, and searched again unless its frequency is known.
    let silence = vec![[0; 2]; 4_000];
    let codes = [codes(6_000, 5_332.0), silence, codes(6_000, 4_100.0)].concat();
    let settings = Settings {
        frequency_hz: frequency,
        ..antinode_settings_default(RATE)
    };
    let mut gyro = Gyro::<S>::new(&settings);
    assert_eq!(gyro.push(Way::Packed, &codes[..500]), Status::Ready);
    let (mut ours, mut at) = (Vec::new(), 500);
    let mut before = 0;
    while at < codes.len() {
        let end = codes.len().min(at + 70);
        let (status, taken, row) = gyro.identify(&codes[at..end]);
        assert!(taken <= end - at);
        at += taken;
        if status == Status::Estimate {
            before += u32::from(taken == 0);
            ours.push(row);
            // It takes no pairs beyond the window's end.
            let window = row.start + u64::from(row.samples);
            assert!(taken == 0 || window == at as u64, "{row:?} {at}");
        } else {
            assert_eq!((status, at), (Status::Ok, end));
            assert_eq!(row.reserved, UNWRITTEN);
        }
    }
    assert_eq!(before, 2);
    assert!(ours.len() > if frequency == 0.0 { 50 } else { 25 });
    same("identify", &ours, &rows::<S>(&settings, &codes));
    let (status, taken, _) = gyro.identify(&[]);
    assert_eq!((status, taken), (Status::Ok, 0));
}

#[test]
fn identify_takes_what_waits_first_in_both() {
    for frequency in [0.0, 5_400.0] {
        identify_takes_what_waits_first::<i16>(frequency);
        identify_takes_what_waits_first::<f32>(frequency);
    }
}

/// Searching, no wave, nothing waiting, nothing dropped.
const COLD: Health = Health {
    searching: 1,
    has_wave: 0,
    waiting: 0,
    dropped: 0,
};

fn any_memory_becomes_a_state<S: Arithmetic>() {
    let codes = codes(3_000, 5_332.0);
    let settings = antinode_settings_default(RATE);
    let expected = rows::<S>(&settings, &codes);
    assert!(expected.len() > 10);
    for byte in [0x00, 0x01, 0x55, 0x7f, 0x80, 0xff] {
        let mut gyro = Gyro::<S>::filled(byte);
        assert_eq!(gyro.init(Some(&settings)), Status::Ok);
        assert_eq!(gyro.health(), COLD, "{byte:#x}");
        let ours = gyro.run(Way::Interleaved, 100, &codes);
        same(&format!("{byte:#x}"), &ours, &expected);
    }
}

#[test]
fn any_memory_becomes_a_state_in_both() {
    any_memory_becomes_a_state::<i16>();
    any_memory_becomes_a_state::<f32>();
}

fn a_reset_is_as_from_cold<S: Arithmetic>() {
    let codes = codes(3_000, 5_332.0);
    let settings = antinode_settings_default(RATE);
    let mut gyro = Gyro::<S>::new(&settings);
    // All that a reset has to undo: lost pairs, a wave, blocks that wait, blocks dropped, and a search not yet obeyed.
    for is_asked in [false, true] {
        gyro.run(Way::Interleaved, 100, &codes);
        gyro.skip(1_000_000);
        let status = gyro.push(Way::Interleaved, &codes);
        assert_eq!(status, Status::Dropped);
        assert_eq!(gyro.health().has_wave, 1);
        if is_asked {
            gyro.search();
        }
        assert_eq!(gyro.reset(), Status::Ok);
        assert_eq!(gyro.health(), COLD);
        assert_eq!(gyro.solve().0, Status::Ok);
        let ours = gyro.run(Way::Interleaved, 100, &codes);
        same("reset", &ours, &rows::<S>(&settings, &codes));
        assert_eq!(gyro.reset(), Status::Ok);
    }
}

#[test]
fn a_reset_is_as_from_cold_in_both() {
    a_reset_is_as_from_cold::<i16>();
    a_reset_is_as_from_cold::<f32>();
}
