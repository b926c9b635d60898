//! After lost pairs time has advanced and a new window begins, as in the core.

use antinode_capi::*;

use crate::core_rows::{Identifier, RATE, codes, core_settings, same};
use crate::gyro::{Arithmetic, Gyro, Way, samples};

/// Index of a pair, and the count of pairs lost before it: before the first, during the search, none, twice in a row, and many.
const SKIPS: [(usize, u32); 8] = [
    (0, 5),
    (20, 7),
    (1_000, 0),
    (3_000, 3),
    (3_010, 11),
    (3_010, 12),
    (6_000, 40_000),
    (9_000, u32::MAX),
];

fn gaps_are_those_of_the_core<S: Arithmetic>(frequency: f32) {
    let codes = codes(12_000, 5_332.0);
    let settings = Settings {
        frequency_hz: frequency,
        ..antinode_settings_default(RATE)
    };
    let mut core = Box::new(Identifier::<S>::new(core_settings(&settings)).unwrap());
    let mut gyro = Gyro::<S>::new(&settings);
    let (mut ours, mut expected) = (Vec::new(), Vec::new());
    let mut searching = Vec::new();
    for (i, &(at, count)) in SKIPS.iter().enumerate() {
        searching.push(core.is_searching());
        core.skip(count.into());
        assert_eq!(gyro.skip(count), Status::Ok);
        assert_eq!(gyro.health().searching, u32::from(core.is_searching()));
        let end = SKIPS.get(i + 1).map_or(codes.len(), |&(next, _)| next);
        core.extend(&samples::<S>(&codes[at..end]), |row| expected.push(row));
        ours.extend(gyro.run(Way::Interleaved, 16, &codes[at..end]));
    }
    // There were skips both during the search and after it.
    assert_eq!(searching[1], frequency == 0.0);
    assert!(!searching[3]);
    assert!(expected.len() > 50);
    assert!(ours.last().unwrap().start > u64::from(u32::MAX));
    same(&format!("{frequency} Hz"), &ours, &expected);
}

#[test]
fn gaps_are_those_of_the_core_in_both() {
    for frequency in [0.0, 5_400.0] {
        gaps_are_those_of_the_core::<i16>(frequency);
        gaps_are_those_of_the_core::<f32>(frequency);
    }
}
