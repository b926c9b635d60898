//! `antinode calibrate`: rows in which something drives the wave, between the ring-downs of one recording.

use std::path::Path;

use crate::common::ring_downs::in_one;
use crate::common::{Run, run_with};

/// Runs `calibrate` on these rows, which must give a calibration.
fn calibrate(here: &Path, rows: Vec<u8>) -> Run {
    let found = run_with(here, "calibrate - --output csv", rows);
    assert_eq!(found.code, 0, "{}", found.err);
    found
}

#[test]
fn driven_rows_are_left_out_of_the_calibration() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Amplitude, angle and phase are continuous, as 2 s are whole periods.
    let waves = [(1, "0.7"), (2, "-0.6")].into_iter().flat_map(|(seed, rate)| {
        [
            "--seconds 2 --decay-rate 0".to_owned(),
            format!("--seconds 3 --decay-rate 0.1 --angle-rate {rate}"),
        ]
        .map(|wave| {
            format!("{wave} --noise 0.002 --frequency 5332 --gain-ratio 1.03 --angle 0.3 --seed {seed}")
        })
    });
    let found = calibrate(here, in_one(here, waves));
    for (line, (quantity, truth, most)) in found.out.lines().skip(1).zip([
        ("gain_ratio", 1.03, 1e-4),
        ("skew_ns", 0.0, 2.0),
        ("pick_off_angle_rad", 0.0, 5e-5),
    ]) {
        let fields: Vec<_> = line.split(',').collect();
        let [value, std] = [1, 2].map(|i: usize| fields[i].parse::<f64>().unwrap());
        assert_eq!(fields[0], quantity);
        assert!((value - truth).abs() < 4.0 * std && std < most, "{line}");
    }
    assert!(
        found.err.starts_with("warning: left out: 2 runs")
            && found.err.matches("warning").count() == 1,
        "{}",
        found.err
    );
}

/// The rows of two recordings, in each of which a drive holds the wave for 5 s, but lets quadrature grow by so much a second; then the wave
/// decays, and the table turns. Amplitudes depend on the angle by the share `bent`.
fn with_drives(growth: f64, bent: f64) -> String {
    let mut rows = "time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,main_amplitude_std,quadrature_amplitude_std,\
                    angle_std_rad,flags,file\n"
        .to_owned();
    for (file, rate) in [("one", 0.6), ("other", -0.6)] {
        for row in 0..220 {
            let time = 0.05 * f64::from(row);
            let later = (time - 5.0).max(0.0);
            let angle = 0.4 + rate * later;
            let main = (-0.2 * later).exp() * (1.0 + bent * (8.0 * angle).cos());
            let quadrature = (0.02 + growth * time.min(5.0)) * main;
            rows += &format!("{time},{main},{quadrature},{angle},5332,1e-4,1e-4,1e-4,,{file}\n");
        }
    }
    rows
}

#[test]
fn driven_rows_that_leave_no_calibration_are_left_out_too() {
    let directory = tempfile::tempdir().unwrap();
    let found = calibrate(directory.path(), with_drives(0.15, 0.0).into_bytes());
    assert!(
        found.out.contains("gain_ratio,1.0000") || found.out.contains("gain_ratio,0.9999"),
        "{}",
        found.out
    );
    assert!(
        found.err.starts_with("warning: left out: 2 runs"),
        "{}",
        found.err
    );
}

#[test]
fn rows_are_kept_if_without_them_the_others_are_hardly_explained_better() {
    let directory = tempfile::tempdir().unwrap();
    let found = calibrate(directory.path(), with_drives(0.0, 0.03).into_bytes());
    assert!(
        found.err.contains("440 of 440 rows")
            && found.err.contains("times their noise")
            && !found.err.contains("left out")
            && !found.err.contains("look ideal"),
        "{}",
        found.err
    );
}
