//! The numbers that the header states: ranges of settings, periods, and how much may be pushed at once.

use antinode_capi::*;

use crate::core_rows::{RATE, codes, core_settings};
use crate::gyro::{Arithmetic, Gyro, Way};

#[test]
fn defaults_are_those_that_the_header_states() {
    let default = antinode_settings_default(RATE);
    assert_eq!(core_settings(&default), antinode::Settings::new(RATE));
    assert_eq!((default.periods, default.hop_blocks), (10, 0));
    assert_eq!(default.start_angle_rad, std::f32::consts::FRAC_PI_4);
    assert_eq!((default.watch, default.hum, default.coloured), (1, 0, 0));
    assert_eq!(default.detection, ANTINODE_DETECTION_DIFFERENCE);
}

/// One end of a setting's range: how the setting is changed, a value at the end, and one just beyond.
type End = (fn(&mut Settings, f32), f32, f32);

const ENDS: [End; 14] = [
    (|s, x| s.sample_rate_hz = x.into(), 1.0, 0.999),
    (|s, x| s.sample_rate_hz = x.into(), 1e10, 1.000_1e10_f32),
    (|s, x| s.periods = x as u32, 2.0, 1.0),
    (|s, x| s.periods = x as u32, 50.0, 51.0),
    (|s, x| s.hop_blocks = x as u32, 65_535.0, 65_536.0),
    (|s, x| s.start_angle_rad = x, 10_000.0, 10_000.01),
    (|s, x| s.start_angle_rad = x, -10_000.0, -10_000.01),
    (|s, x| s.frequency_hz = x, 500.0, 497.0),
    (|s, x| s.frequency_hz = x, 40_000.0, 40_001.0),
    (|s, x| s.calibration.gain_ratio = x, 0.1, 0.099),
    (|s, x| s.calibration.gain_ratio = x, 10.0, 10.01),
    (|s, x| s.calibration.skew_s = x, -0.001, -0.001_001),
    (|s, x| s.calibration.pick_off_angle_rad = x, -0.3, -0.301),
    (|s, x| s.rail_low = x, -1e-3, 1e-3),
];

#[test]
fn ranges_end_where_the_header_says() {
    for (i, (set, within, beyond)) in ENDS.into_iter().enumerate() {
        let of = |value| {
            let mut settings = antinode_settings_default(RATE);
            set(&mut settings, value);
            Gyro::<i16>::cold().init(Some(&settings))
        };
        assert_eq!(of(within), Status::Ok, "end {i}");
        assert!((of(beyond) as i32) < 0, "end {i}");
    }
}

fn periods_are_found_within_the_bounds<S: Arithmetic>() {
    let (shortest, longest) = (
        ANTINODE_SHORTEST_PERIOD as f64,
        ANTINODE_LONGEST_PERIOD as f64,
    );
    let ends = [
        (shortest + 0.02, true),
        (shortest - 0.5, false),
        (longest - 1.0, true),
        (longest + 8.0, false),
    ];
    for (period, is_found) in ends {
        let mut gyro = Gyro::<S>::new(&antinode_settings_default(RATE));
        let rows = gyro.run(Way::Interleaved, 20, &codes(10_000, RATE / period));
        let health = gyro.health();
        assert_eq!(health.has_wave == 1, is_found, "{period} pairs a period");
        assert_eq!(rows.is_empty(), !is_found, "{period} pairs a period");
        for row in rows {
            assert!((row.frequency_hz * period / RATE - 1.0).abs() < 1e-3);
        }
    }
}

#[test]
fn periods_are_found_within_the_bounds_in_both() {
    periods_are_found_within_the_bounds::<i16>();
    periods_are_found_within_the_bounds::<f32>();
}

/// As the header says at `periods` and `hop_blocks`: the length of a window in periods, and of a hop's block in periods.
#[test]
fn windows_and_blocks_are_as_long_as_the_header_says() {
    let run = |period: f64, settings: Settings| {
        let hop = settings.hop_blocks as f64;
        let codes = codes(80 * (period as usize + 1) * 5 / 2, RATE / period);
        let rows = Gyro::<i16>::new(&settings).run(Way::Interleaved, 5, &codes);
        let [first, second, ..] = rows[..] else {
            panic!("{period} pairs a period: {} windows", rows.len());
        };
        let step = (second.start - first.start) as f64;
        let is_next = step == f64::from(first.samples);
        (
            f64::from(first.samples) / period,
            step / hop / period,
            is_next,
        )
    };
    let default = antinode_settings_default(RATE);
    for period in [4.1, 4.4, 5.3, 7.7, 18.75, 60.0, 101.0, 150.0, 190.0] {
        for periods in [2, 3, 10, 17, 50] {
            let settings = Settings { periods, ..default };
            let (length, _, is_next) = run(period, settings);
            let off = length / f64::from(periods) - 1.0;
            assert!(off.abs() <= 0.1, "{period}, {periods}: {off} off");
            assert!(is_next, "{period}, {periods}");
            let settings = Settings {
                hop_blocks: periods,
                ..settings
            };
            let (_, block, _) = run(period, settings);
            let is_short = periods < 10;
            assert!(
                is_short || (0.9..=1.25).contains(&block),
                "{period}, {periods}: {block}"
            );
        }
    }
    // A known frequency with few samples a period.
    let known = |period: f64| Settings {
        periods: 2,
        frequency_hz: (RATE / period) as f32,
        ..default
    };
    let (length, ..) = run(2.6, known(2.6));
    assert!((2.3..2.32).contains(&length), "{length}");
}

/// With 18.75 samples a period, as at ANTINODE_QUEUE_BLOCKS: blocks have 37.5 pairs, give or take a tenth, or 6 in windows of two periods.
#[test]
fn fifteen_blocks_at_once_fit_the_queue() {
    let codes = codes(20_000, RATE / 18.75);
    let cases = [
        (2, 90, 110),
        (10, 560, 650),
        (11, 560, 650),
        (13, 560, 650),
        (50, 560, 650),
    ];
    for (periods, most, too_many) in cases {
        let settings = Settings {
            periods,
            ..antinode_settings_default(RATE)
        };
        let mut gyro = Gyro::<i16>::new(&settings);
        gyro.run(Way::Packed, most, &codes);
        assert_eq!(gyro.health().dropped, 0, "windows of {periods}");
        let status = gyro.push(Way::Packed, &codes[..too_many]);
        assert_eq!(status, Status::Dropped, "windows of {periods}");
        // The status was not Ready, though blocks wait.
        assert!(gyro.health().waiting > 0, "windows of {periods}");
    }
}
