//! A calibration that is changed during identification.

use antinode_capi::*;

use crate::core_rows::{Halves, RATE, codes, core_calibration, rows, same};
use crate::gyro::{Arithmetic, Gyro, Way};

const NEW: Calibration = Calibration {
    gain_ratio: 0.9,
    skew_s: 2e-6,
    pick_off_angle_rad: 0.05,
};

/// Settings that differ from the defaults, so that a reset to defaults would be noticed.
fn settings() -> Settings {
    Settings {
        periods: 7,
        start_angle_rad: 3.0,
        calibration: Calibration {
            gain_ratio: 1.1,
            skew_s: -1e-6,
            pick_off_angle_rad: -0.02,
        },
        ..antinode_settings_default(RATE)
    }
}

fn one_out_of_range_changes_nothing<S: Arithmetic>() {
    let codes = codes(6_000, 5_332.0);
    let settings = settings();
    let good = NEW;
    let (gain, skew, angle) = (
        Status::ErrorGainRatio,
        Status::ErrorSkew,
        Status::ErrorPickOffAngle,
    );
    // Beside each bad value stand good new ones, which must not be adopted either.
    let of_gain = |gain_ratio| Calibration { gain_ratio, ..good };
    let of_skew = |skew_s| Calibration { skew_s, ..good };
    let of_angle = |pick_off_angle_rad| Calibration {
        pick_off_angle_rad,
        ..good
    };
    let bad = [
        (of_gain(0.0), gain),
        (of_gain(10.1), gain),
        (of_gain(f32::NAN), gain),
        (of_skew(0.0011), skew),
        (of_skew(f32::NAN), skew),
        (of_angle(0.31), angle),
        (of_angle(-f32::INFINITY), angle),
    ];
    let expected = rows::<S>(&settings, &codes);
    assert!(expected.len() > 40);
    let mut gyro = Gyro::<S>::new(&settings);
    for name in ["at first", "after a reset"] {
        let mut ours = Vec::new();
        for piece in codes.chunks(50) {
            for (calibration, status) in bad {
                assert_eq!(gyro.set_calibration(calibration), status);
            }
            ours.extend(gyro.run(Way::Interleaved, 50, piece));
        }
        same(name, &ours, &expected);
        assert_eq!(gyro.reset(), Status::Ok);
    }
}

#[test]
fn one_out_of_range_changes_nothing_in_both() {
    one_out_of_range_changes_nothing::<i16>();
    one_out_of_range_changes_nothing::<f32>();
}

fn a_new_one_holds_from_the_next_block_on<S: Arithmetic>() {
    let codes = codes(8_000, 5_332.0);
    let settings = settings();
    let mut gyro = Gyro::<S>::new(&settings);
    let mut ours = gyro.run(Way::Interleaved, 100, &codes[..3_000]);
    // Blocks that wait at the change are solved with the new calibration.
    gyro.push(Way::Interleaved, &codes[3_000..3_400]);
    assert!(gyro.health().waiting > 5);
    assert_eq!(gyro.set_calibration(NEW), Status::Ok);
    let first = ours.len();
    ours.extend(gyro.rows());
    assert!(ours.len() > first);
    ours.extend(gyro.run(Way::Interleaved, 100, &codes[3_400..]));
    for (i, row) in ours.iter().enumerate() {
        let flags = if i == first {
            ANTINODE_FLAG_REACQUIRED
        } else {
            0
        };
        assert_eq!(row.flags, flags, "row {i}");
    }

    let mut core = Halves::<S>::new(&settings);
    let mut expected = core.run(&codes[..3_000]);
    core.tracker.calibrate(core_calibration(NEW)).unwrap();
    expected.extend(core.run(&codes[3_000..]));
    same("changed", &ours, &expected);

    // A reset keeps the new calibration, and all other settings.
    let expected = rows::<S>(
        &Settings {
            calibration: NEW,
            ..settings
        },
        &codes,
    );
    assert_eq!(gyro.reset(), Status::Ok);
    let ours = gyro.run(Way::Interleaved, 100, &codes);
    same("reset", &ours, &expected);
}

#[test]
fn a_new_one_holds_from_the_next_block_on_in_both() {
    a_new_one_holds_from_the_next_block_on::<i16>();
    a_new_one_holds_from_the_next_block_on::<f32>();
}
