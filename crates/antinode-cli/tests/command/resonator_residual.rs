//! `antinode resonator`: its warnings if rows differ from the motion by more than their noise, or by less.

use crate::common::done;
use crate::common::ring_downs::{four_seconds, resonator, rows};

#[test]
fn rows_that_differ_by_less_than_their_noise_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let told = "times their noise: if noise is below half a converter step";
    for (noise, bits, is_told) in [
        // 0.01, 0.13 and 0.5 of the steps of 8 bits.
        ("1e-4", "--bits 8", true),
        ("1e-3", "--bits 8", true),
        ("4e-3", "--bits 8", false),
        ("1e-3", "", false),
    ] {
        for seed in 1..=3 {
            let simulated = format!(
                "--seconds 4 --frequency 5321.7 --decay-rate 0.1 --angle-rate 0.4 --noise {noise} {bits} --seed {seed}"
            );
            rows(here, &simulated, "--periods 50");
            let found = done(here, "resonator rows.csv");
            assert_eq!(
                found.err.contains(told),
                is_told,
                "{noise} {bits}: {}",
                found.err
            );
        }
    }
}

#[test]
fn feed_through_of_a_drive_is_named_among_the_causes() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(
        here,
        "--decay-rate 0.5 --angle-rate 0.4 --hum 0.005 --hum-frequency 5332",
    );
    let fed = resonator(here, &rows, "").err;
    for part in ["times their noise", "feed-through"] {
        assert!(fed.contains(part), "{fed}");
    }
}
