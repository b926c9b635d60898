//! Every setting reaches the core, and refused settings leave the state not initialised.

use std::f64::consts::TAU;

use antinode_capi::*;

use crate::core_rows::{RATE, codes, rows, same};
use crate::gyro::{Arithmetic, Gyro, UNWRITTEN, Way};

type Change = fn(&mut Settings);

/// A change of each field, and one of both rails.
const CHANGES: [(&str, Change); 16] = [
    ("sample rate", |s| s.sample_rate_hz = 90_000.0),
    ("periods", |s| s.periods = 13),
    ("hop", |s| s.hop_blocks = 3),
    ("start angle", |s| s.start_angle_rad = -20.0),
    ("low rail", |s| s.rail_low = -7_500.0),
    ("high rail", |s| s.rail_high = 7_500.0),
    ("both rails", |s| {
        (s.rail_low, s.rail_high) = (-7_500.0, 7_500.0);
    }),
    ("resolution", |s| s.resolution = 2_000.0),
    ("frequency", |s| s.frequency_hz = 5_400.0),
    ("detection", |s| {
        s.detection = ANTINODE_DETECTION_MEAN_RETURN
    }),
    ("watch", |s| s.watch = 0),
    ("gain ratio", |s| s.calibration.gain_ratio = 1.2),
    ("skew", |s| s.calibration.skew_s = 3e-6),
    ("pick-off angle", |s| s.calibration.pick_off_angle_rad = 0.1),
    ("hum", |s| s.hum = 1),
    ("coloured", |s| s.coloured = 1),
];

fn every_setting_reaches_the_core<S: Arithmetic>() {
    let mut codes = codes(8_000, 5_332.0);
    for (k, pair) in codes.iter_mut().enumerate() {
        // Hum and clipped crests, without which `hum`, `coloured` and `watch` would make no difference.
        let hum = 200.0 * (TAU * 300.0 / RATE * k as f64).sin();
        *pair = pair.map(|code| (code / 2).clamp(-8_000, 8_000) + hum as i16);
    }
    let plain = antinode_settings_default(RATE);
    let plainly = format!("{:?}", Gyro::<S>::new(&plain).run(Way::Packed, 100, &codes));
    for (name, change) in CHANGES {
        let mut settings = plain;
        change(&mut settings);
        let ours = Gyro::<S>::new(&settings).run(Way::Packed, 100, &codes);
        assert!(ours.len() > 30, "{name}");
        assert!(format!("{ours:?}") != plainly, "{name} changes nothing");
        same(name, &ours, &rows::<S>(&settings, &codes));
    }
}

#[test]
fn every_setting_reaches_the_core_in_both() {
    every_setting_reaches_the_core::<i16>();
    every_setting_reaches_the_core::<f32>();
}

fn refused_settings_leave_no_state<S: Arithmetic>() {
    let codes = codes(100, 5_332.0);
    let plain = antinode_settings_default(RATE);
    let refused: [(Status, Change); 24] = [
        (Status::ErrorSampleRate, |s| s.sample_rate_hz = 0.5),
        (Status::ErrorSampleRate, |s| s.sample_rate_hz = f64::NAN),
        (Status::ErrorSampleRate, |s| s.sample_rate_hz = 1e300),
        (Status::ErrorPeriods, |s| s.periods = 51),
        // In 16 bits these would be 10.
        (Status::ErrorPeriods, |s| s.periods = 65_536 + 10),
        (Status::ErrorHop, |s| s.hop_blocks = 65_536),
        (Status::ErrorStartAngle, |s| s.start_angle_rad = 10_001.0),
        (Status::ErrorStartAngle, |s| s.start_angle_rad = f32::NAN),
        (Status::ErrorRails, |s| s.rail_low = 1.0),
        (Status::ErrorRails, |s| s.rail_high = f32::NAN),
        (Status::ErrorResolution, |s| s.resolution = -1.0),
        (Status::ErrorFrequency, |s| s.frequency_hz = 498.0),
        (Status::ErrorFrequency, |s| s.frequency_hz = 40_001.0),
        (Status::ErrorFrequency, |s| s.frequency_hz = -1.0),
        (Status::ErrorFrequency, |s| s.frequency_hz = f32::NAN),
        (Status::ErrorDetection, |s| s.detection = 2),
        (Status::ErrorWatch, |s| s.watch = 2),
        (Status::ErrorHum, |s| s.hum = 2),
        (Status::ErrorHum, |s| (s.hum, s.periods) = (1, 4)),
        (Status::ErrorHum, |s| {
            (s.hum, s.periods, s.hop_blocks) = (1, 9, 3);
        }),
        (Status::ErrorColoured, |s| s.coloured = 2),
        (Status::ErrorGainRatio, |s| s.calibration.gain_ratio = 0.0),
        (Status::ErrorSkew, |s| s.calibration.skew_s = 1.0),
        (Status::ErrorPickOffAngle, |s| {
            s.calibration.pick_off_angle_rad = 1.0
        }),
    ];
    let mut gyro = Gyro::<S>::new(&plain);
    let mut is_refused = |settings: Option<&Settings>, status: Status| {
        // A state that was in use before.
        assert_eq!(gyro.init(Some(&plain)), Status::Ok);
        assert_eq!(gyro.push(Way::Interleaved, &codes), Status::Ready);
        assert_eq!(gyro.init(settings), status);
        for way in Way::ALL {
            let answer = gyro.push(way, &codes);
            assert_eq!(answer, Status::ErrorNotInitialised, "{status:?} {way:?}");
        }
        let (solved, estimate) = gyro.solve();
        assert_eq!(estimate.reserved, UNWRITTEN);
        let (identified, taken, estimate) = gyro.identify(&codes);
        assert_eq!((taken, estimate.reserved), (usize::MAX, UNWRITTEN));
        let answers = [
            solved,
            identified,
            gyro.skip(1),
            gyro.search(),
            gyro.set_calibration(plain.calibration),
            gyro.try_health().0,
            gyro.reset(),
        ];
        assert_eq!(answers, [Status::ErrorNotInitialised; 7], "{status:?}");
    };
    is_refused(None, Status::ErrorNull);
    for (status, change) in refused {
        let mut settings = plain;
        change(&mut settings);
        is_refused(Some(&settings), status);
    }
}

#[test]
fn refused_settings_leave_no_state_in_both() {
    refused_settings_leave_no_state::<i16>();
    refused_settings_leave_no_state::<f32>();
}
