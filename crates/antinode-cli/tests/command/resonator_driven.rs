//! `antinode resonator`: runs in which something drives the wave, between the ring-downs of one recording.

use std::path::Path;

use crate::common::ring_downs::{in_one, of_resonator, of_run};
use crate::common::{Run, run_with};

/// The result for one recording of these waves, each of 3 s.
fn found_in(here: &Path, waves: &[String]) -> Run {
    let waves = waves
        .iter()
        .map(|wave| format!("--seconds 3 --noise 0.002 {wave}"));
    run_with(here, "resonator - --output csv", in_one(here, waves))
}

#[test]
fn runs_that_are_driven_are_left_out_of_the_resonator() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let splits = "--damping-split 0.01 --damping-angle 0.5";
    // The wave is excited, or held, at the angle at which it then rings down.
    for driven in ["--decay-rate -0.3", "--decay-rate 0"] {
        let waves: Vec<_> = ["0.3", "0.7", "1.1"]
            .iter()
            .flat_map(|angle| {
                [
                    format!("{driven} --angle {angle} --main-amplitude 0.3"),
                    format!("--decay-rate 0.1 {splits} --angle {angle} --phase 2"),
                ]
            })
            .collect();
        let found = found_in(here, &waves);
        assert_eq!(found.code, 0, "{}", found.err);
        let (time, std) = of_resonator(&found.out, "decay_time_s");
        assert!(
            (time - 10.0).abs() < 4.0 * std && std < 0.02,
            "{driven}: {}",
            found.out
        );
        let (split, std) = of_resonator(&found.out, "damping_split_s");
        assert!(
            (split - 0.01).abs() < 4.0 * std && std < 4e-4,
            "{driven}: {}",
            found.out
        );
        let told = "warning: left out: 3 runs in which something drives the wave, as it does not decay there but does in others: standard \
                    input, 3.0 s from 0.0 s on; standard input, 3.0 s from 6.0 s on; standard input, 3.0 s from 12.0 s on\n";
        assert_eq!(found.err, told, "{driven}");
        assert!(!found.out.contains("\n4,"), "{}", found.out);
    }
}

#[test]
fn a_drive_that_is_switched_off_without_a_jump_is_left_out_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let splits = "--damping-split 0.01 --damping-angle 0.5";
    // Amplitude, angle and phase are continuous, as 3 s are whole periods.
    let waves: Vec<_> = ["0.3", "0.7", "1.1"]
        .iter()
        .flat_map(|angle| {
            [
                "--decay-rate 0".to_owned(),
                format!("--decay-rate 0.1 {splits}"),
            ]
            .map(|wave| format!("{wave} --frequency 5332 --angle {angle}"))
        })
        .collect();
    let found = found_in(here, &waves);
    assert_eq!(found.code, 0, "{}", found.err);
    for (quantity, truth, most) in [
        ("decay_time_s", 10.0, 0.02),
        ("damping_split_s", 0.01, 4e-4),
    ] {
        let (value, std) = of_resonator(&found.out, quantity);
        let is_found = (value - truth).abs() < 4.0 * std && std < most;
        assert!(is_found, "{}", found.out);
    }
    assert!(
        found.err.starts_with("warning: left out: 3 runs") && found.err.lines().count() == 1,
        "{}",
        found.err
    );
}

#[test]
fn a_slow_ring_down_beside_fast_ones_is_not_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // As if a resonator were damped before it is excited anew.
    let waves = ["0.05", "1", "0.05", "1"]
        .map(|rate| format!("--decay-rate {rate} --angle 0.3 --phase {rate}"));
    let found = found_in(here, &waves);
    assert!(!found.err.contains("left out"), "{}", found.err);
    for (run, time) in [("1", 20.0), ("2", 1.0), ("3", 20.0), ("4", 1.0)] {
        let (value, std) = of_run(&found.out, run, "decay_time_s");
        assert!((value - time).abs() < 4.0 * std, "{}", found.out);
    }
}

#[test]
fn a_wave_that_only_seems_to_grow_while_it_turns_is_not_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // With uncalibrated pick-offs, two runs seem to grow and one to decay; or each does both, in turn.
    let slowly = [
        "--angle 0.1 --angle-rate 0.15",
        "--angle 0.1 --angle-rate -0.15",
        "--angle 0.9 --angle-rate 0.15",
    ]
    .map(|turn| format!("--decay-rate 0.001 --gain-ratio 1.05 {turn}"));
    let fast = ["--angle-rate 0.8", "--angle-rate -0.8"]
        .map(|turn| format!("--decay-rate 0.01 --gain-ratio 1.25 --angle 0.1 {turn}"));
    for waves in [&slowly[..], &fast[..]] {
        let found = found_in(here, waves);
        assert!(
            !found.err.contains("left out") && found.err.contains("times their noise"),
            "{}",
            found.err
        );
    }
}
